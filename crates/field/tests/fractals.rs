//! Fractals of escaping orbits against membership by quaternion products and by angles.

mod common;

use common::Random;
use common::inside::{julia_contains, mandelbulb_contains};
use freikugel_field::shapes::*;
use freikugel_field::{Evaluator, Extent, Field, Points, Program, Structure, analyse, extent, simd};
use glam::DVec3;

/// A fractal and its arguments.
fn julia(c: [f64; 4], power: u32, iterations: u32, bailout: f64, w: f64) -> Field {
    Field::from(quaternion_julia(c))
        .with("power", &[power.into()])
        .with("iterations", &[iterations.into()])
        .with("bailout", &[bailout.into()])
        .with("w", &[w.into()])
}

fn bulb(power: u32, iterations: u32, bailout: f64) -> Field {
    let bulb = Field::from(mandelbulb(power));
    bulb.with("iterations", &[iterations.into()]).with("bailout", &[bailout.into()])
}

/// Connected, disconnected, dusty and degenerate sets; real c, where the tip of the set is a fixed point; slices beside the
/// middle; bailouts at and above the least.
fn fractals() -> Vec<Field> {
    vec![
        julia([-0.2, 0.6, 0.2, 0.2], 2, 10, 0.0, 0.0),
        julia([-0.083, 0.83, 0.0, -0.025], 2, 12, 4.0, 0.0),
        julia([-1.0, 0.2, 0.0, 0.0], 2, 20, 2.0, 0.1),
        julia([-2.0, 0.0, 0.0, 0.0], 2, 12, 0.0, 0.0),
        julia([0.25, 0.0, 0.0, 0.0], 2, 30, 0.0, 0.0),
        julia([0.5, 0.0, 0.0, 0.0], 2, 8, 0.0, 0.0),
        julia([0.0, 1.1, 0.4, 0.3], 2, 6, 3.0, -0.3),
        julia([3.0, 1.0, 2.0, 0.0], 2, 3, 0.0, 0.0),
        julia([0.0; 4], 2, 10, 2.0, 0.0),
        julia([0.0; 4], 2, 1, 1.5, 0.5),
        julia([0.3, 0.5, 0.4, 0.2], 3, 9, 0.0, 0.0),
        julia([-0.6, 0.1, 0.3, 0.5], 5, 7, 1.8, 0.2),
        bulb(8, 8, 0.0),
        bulb(8, 4, 2.0),
        bulb(2, 10, 0.0),
        bulb(3, 8, 4.0),
        bulb(9, 5, 1.2),
    ]
}

fn contains(field: &Field, p: DVec3) -> bool {
    let (name, args) = (field.node().shape.about.name, field.node().numbers());
    if name == "mandelbulb" { mandelbulb_contains(&args, p) } else { julia_contains(&args, p) }
}

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

/// Points far away, at middle distance, and ever nearer to the surface on either side, by bisection.
fn points(field: &Field, random: &mut Random) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = (0..70).map(|i| random.point(if i < 60 { 2.0 } else { 9.0 })).collect();
    let mut inside: Vec<DVec3> = (0..3000).map(|_| random.point(1.5)).filter(|&p| contains(field, p)).take(8).collect();
    inside.push(DVec3::ZERO);
    for mut near in inside.into_iter().filter(|&p| contains(field, p)) {
        let mut far = near + random.direction() * 4.0;
        for _ in 0..24 {
            let middle = 0.5 * (near + far);
            points.push(middle);
            if contains(field, middle) { near = middle } else { far = middle }
        }
    }
    points
}

/// Rounding errors of an orbit in double precision, in units of length.
const ROUNDING: f64 = 1e-12;

#[test]
fn the_sign_is_membership_and_the_ball_of_the_value_is_clear() {
    for (index, field) in fractals().iter().enumerate() {
        let program = program(field);
        let mut random = Random::new(index as u64 + 1);
        for p in points(field, &mut random) {
            let (value, here) = (program.value(p), contains(field, p));
            assert!(value.abs() < ROUNDING || here == (value < 0.0), "{field:?} at {p}: {value}");
            for i in 0..150 {
                // Every other point lies on the ball's surface.
                let share = if i % 2 == 0 { 1.0 } else { random.unit().cbrt() };
                let q = p + random.direction() * ((value.abs() - ROUNDING).max(0.0) * share);
                let there = program.value(q);
                assert!(here == contains(field, q) || there.abs() < ROUNDING, "{field:?}: {q} within {value} of {p}");
                assert!((there - value).abs() <= p.distance(q) + ROUNDING, "{field:?}: too steep from {p} to {q}");
            }
        }
    }
}

#[test]
fn without_c_the_shape_is_a_ball() {
    // |z_N| = |p|^(2^N), so that the radius is a root of the bailout.
    for (iterations, bailout) in [(1, 1.5), (3, 2.0), (10, 4.0)] {
        let radius = f64::powf(bailout, 0.5_f64.powi(iterations as i32));
        let program = program(&julia([0.0; 4], 2, iterations, bailout, 0.0));
        for i in 0..400 {
            let distance = f64::from(i) * 0.01;
            let p = DVec3::new(0.6, 0.0, -0.8) * distance;
            let (value, exact) = (program.value(p), distance - radius);
            let is_sound = if exact > 0.0 { (0.5 * exact..=exact + ROUNDING).contains(&value) } else { value <= 0.0 };
            assert!(
                is_sound && value >= exact - ROUNDING,
                "{iterations}, {bailout} at {distance}: {value} for {exact}"
            );
        }
    }
}

#[test]
fn the_bound_is_not_lazy() {
    // The estimate |z| ln |z| / |z'| at |z| > 16, from the same orbit in complex numbers: w and the parts along j and k are 0.
    let (c, iterations) = ([-0.2, 0.6], 12);
    let program = program(&julia([c[0], c[1], 0.0, 0.0], 2, iterations, 0.0, 0.0));
    let mut random = Random::new(3);
    let (mut sum, mut count) = (0.0, 0);
    while count < 2000 {
        let start = [random.range(-1.6, 1.6), random.range(-1.6, 1.6)];
        let ([mut x, mut y], mut slope, mut steps) = (start, 1.0, 0);
        while x.hypot(y) <= 16.0 && steps < iterations {
            slope *= 2.0 * x.hypot(y);
            [x, y] = [x * x - y * y + c[0], 2.0 * x * y + c[1]];
            steps += 1;
        }
        let length: f64 = x.hypot(y);
        if length <= 16.0 {
            continue;
        }
        let value = program.value(DVec3::new(start[0], start[1], 0.0));
        sum += value / (length * length.ln() / slope);
        count += 1;
    }
    let mean = sum / f64::from(count);
    assert!((0.2..1.0).contains(&mean), "{mean} of the estimate");
}

#[test]
fn the_extent_holds_the_shape_and_touches_it_at_a_fixed_point() {
    for (index, field) in fractals().iter().enumerate() {
        let Extent::Finite(aabb) = extent(field) else { panic!("{field:?} is finite") };
        let mut random = Random::new(index as u64);
        for _ in 0..3000 {
            let p = random.point(2.5);
            assert!(!contains(field, p) || (p.cmpge(aabb.min).all() && p.cmple(aabb.max).all()), "{field:?} at {p}");
        }
    }
    // z^2 - 2 has the fixed point 2, and its orbits from below stay.
    let Extent::Finite(aabb) = extent(&julia([-2.0, 0.0, 0.0, 0.0], 2, 40, 0.0, 0.0)) else { panic!("it is finite") };
    assert!((aabb.max.x - 2.0).abs() < 1e-9, "{aabb:?}");
    // A slice beside the ball holds nothing.
    assert_eq!(extent(&julia([0.0; 4], 2, 10, 0.0, 1.5)), Extent::Empty);
}

#[test]
fn single_precision_misplaces_the_surface_by_little() {
    // The orbit loses as many digits as the surface is fine.
    const OFF: f64 = 2e-6;
    for field in [julia([-0.083, 0.83, 0.0, -0.025], 2, 12, 0.0, 0.0), bulb(8, 8, 0.0)] {
        let program = program(&field);
        let mut random = Random::new(5);
        let points: Vec<DVec3> = points(&field, &mut random).into_iter().map(|p| p.as_vec3().as_dvec3()).collect();
        let [x, y, z] = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis] as f32).collect::<Vec<f32>>());
        for level in simd::available() {
            let mut values = vec![0.0; points.len()];
            Evaluator::with_level(&program, level).values(Points { x: &x, y: &y, z: &z }, &mut values);
            for (p, &value) in points.iter().zip(&values) {
                let exact = program.value(*p);
                assert!((f64::from(value) - exact).abs() < OFF, "{field:?} at {p}: {value}, not {exact}");
            }
        }
    }
}

#[test]
fn arguments_out_of_range_are_refused() {
    let faults = |field: Field| {
        let (analysis, faults) = analyse(&field);
        assert!(analysis.is_none());
        faults[0].message.clone()
    };
    assert_eq!(faults(bulb(1, 8, 0.0)), "`power` of `mandelbulb` must be from 2 to 16, but is 1");
    assert_eq!(faults(bulb(8, 65, 0.0)), "`iterations` of `mandelbulb` must be from 1 to 64, but is 65");
    let half = Field::from(quaternion_julia([0.0; 4])).with("iterations", &[2.5.into()]);
    assert_eq!(faults(half), "`iterations` of `quaternion_julia` must be a whole number, but is 2.5");
    let negative = Field::from(quaternion_julia([0.0; 4])).with("bailout", &[(-1.0).into()]);
    assert!(faults(negative).contains("`bailout`"));
}
