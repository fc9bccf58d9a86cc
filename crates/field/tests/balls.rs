//! Rays among balls, beside the field along them.

mod common;

use common::Random;
use freikugel_field::balls::Balls;
use freikugel_field::shapes::*;
use freikugel_field::{Field, MaterialId, Program, Structure};
use glam::DVec3;

/// Rounding errors of a few operations in double precision, and of the least ratio that sampling finds.
const ROUNDING: f64 = 1e-9;

const RADIUS: f64 = 0.05;

fn set(points: &[DVec3]) -> Field {
    point_set(RADIUS, points.iter().map(DVec3::to_array)).into()
}

fn scattered(random: &mut Random, count: usize, size: f64) -> Vec<DVec3> {
    (0..count).map(|_| random.point(size)).collect()
}

/// Sets of all kinds: few and many balls, over and beside each other, far from each other and from the origin, placed.
fn sets(random: &mut Random) -> Vec<Field> {
    let mut sets: Vec<Field> = [1, 2, 8, 9, 17, 200, 3000].map(|count| set(&scattered(random, count, 1.0))).to_vec();
    let cloud = scattered(random, 300, 1.0);
    sets.push(set(&vec![DVec3::ONE; 20]));
    sets.push(set(&[cloud.clone(), cloud.iter().map(|p| p + 1e6).collect()].concat()));
    sets.push(set(&cloud).at([1.0, -2.0, 0.5]).rotate([1.0, 1.0, 0.2], 70.0).painted(MaterialId(0)));
    sets.push(set(&cloud).scale(-2.5).reflect([1.0, 1.0, 0.0]).rotate_euler([10.0, 20.0, 30.0]));
    sets
}

/// Rays from afar, from among the balls and from inside of them, some along the axes.
fn rays(random: &mut Random, count: usize) -> Vec<(DVec3, DVec3)> {
    let origin = |i: usize, random: &mut Random| match i % 4 {
        0 => random.point(1.0),
        1 => random.point(0.3),
        2 => random.point(4.0),
        _ => random.point(300.0),
    };
    let ray = |i: usize, random: &mut Random| {
        let origin = origin(i, random);
        let toward = if i.is_multiple_of(5) {
            DVec3::AXES[i % 3] * if i.is_multiple_of(2) { 1.0 } else { -1.0 }
        } else {
            random.point(0.8) - origin
        };
        (origin, toward.normalize())
    };
    (0..count).map(|i| ray(i, random)).collect()
}

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

/// Where a ray first meets the surface of a field without any error, if it does within `limit`: by steps that are its values.
fn marched(program: &Program, origin: DVec3, direction: DVec3, limit: f64) -> Option<f64> {
    let mut t = 0.0;
    while t < limit {
        let value = program.value(origin + direction * t);
        if value < ROUNDING * (1.0 + t) {
            return Some(t);
        }
        t += value;
    }
    None
}

#[test]
fn hits_are_where_marching_ends() {
    let mut random = Random::new(11);
    let (mut hits, mut misses) = (0, 0);
    for field in sets(&mut random) {
        let (balls, program) = (Balls::of(&field).expect("nothing but balls"), program(&field));
        for (origin, direction) in rays(&mut random, 300) {
            let limit = 500.0;
            let known = marched(&program, origin, direction, limit);
            let found = balls.hit(origin, direction, limit);
            assert_eq!(balls.is_hit(origin, direction, limit), found.is_some());
            match (found, known) {
                (Some(found), Some(known)) => {
                    hits += 1;
                    // Where a ray grazes, the distance falls with the square of what is left to go.
                    let value = program.value(origin + direction * found);
                    assert!(found == 0.0 || value.abs() < ROUNDING * (1.0 + found), "{value} at {found}");
                    assert!(known < found + 1e-3, "{found} beyond {known}");
                    assert!((found - known).abs() < 1e-3, "{found}, not {known}");
                    assert_eq!(found == 0.0, program.value(origin) <= 0.0);
                    let before = found * (1.0 - ROUNDING);
                    assert!(balls.hit(origin, direction, before).is_none(), "nothing is nearer");
                    assert!(!balls.is_hit(origin, direction, before), "nothing is nearer");
                }
                (None, None) => misses += 1,
                // It passes by with less than the error of marching.
                (None, Some(t)) => assert!(program.value(origin + direction * t) > 0.0, "missed at {t}"),
                (Some(t), None) => panic!("nothing is there at {t}"),
            }
        }
    }
    assert!(hits > 500 && misses > 500, "{hits} hits, {misses} misses");
}

#[test]
fn the_least_clearance_is_that_of_samples() {
    let mut random = Random::new(12);
    let (mut dimmed, mut dark, mut open) = (0, 0, 0);
    for field in sets(&mut random) {
        let (balls, program) = (Balls::of(&field).expect("nothing but balls"), program(&field));
        for (index, (origin, direction)) in rays(&mut random, 120).into_iter().enumerate() {
            let far = [0.7, 3.0, 20.0, 500.0][index / 4 % 4];
            let most = [1.0, 0.3, 1.25][index % 3];
            let found = balls.least_clearance(origin, direction, far, most);
            assert!((0.0..=most).contains(&found));
            let ratio = |t: f64| program.value(origin + direction * t) / t;
            // Steps so long that the ratio falls by little on the way: it changes by no more than (1 + ratio) / t.
            let mut sampled = most;
            let mut t = far;
            while t > 1e-3 {
                sampled = f64::min(sampled, ratio(t).max(0.0));
                t /= 1.0 + 1e-3;
            }
            assert!(found <= sampled + ROUNDING, "{found}, but {sampled} is there");
            assert!(
                sampled - found < 2.1e-3 * (1.0 + sampled) || found == 0.0 && program.value(origin) < 1e-2,
                "{found}, but {sampled} is all there is"
            );
            if found == 0.0 {
                dark += 1;
                assert!(balls.is_hit(origin, direction, far));
            } else if found < most {
                dimmed += 1;
            } else {
                open += 1;
            }
        }
    }
    assert!(dimmed > 200 && dark > 100 && open > 200, "{dimmed} dimmed, {dark} dark, {open} open");
}

#[test]
fn what_is_more_than_balls_is_none() {
    let cloud = || set(&[DVec3::ZERO, DVec3::X]);
    let fields: [Field; 6] = [
        sphere(1.0).into(),
        cloud() | sphere(1.0),
        cloud().offset(0.1),
        cloud().stretch([1.0, 1.0, 2.0]),
        cloud().shear("xy", 0.5),
        smooth_point_set(RADIUS, 0.1, [[0.0, 0.0, 0.0]]).into(),
    ];
    assert!(fields.iter().all(|field| Balls::of(field).is_none()));
    assert!(Balls::of(&union([cloud().scale(3.0)])).is_some());
}
