//! Sets of points: beside all their points, one after another.

mod common;

use common::Random;
use freikugel_field::shapes::*;
use freikugel_field::{Evaluator, Extent, Field, Metric, Points, Program, Structure, analyse, extent, simd};
use glam::DVec3;

/// Rounding errors of a few operations in double precision on numbers of this size.
const ROUNDING: f64 = 1e-12;

/// The same in single precision.
const SINGLE: f64 = 2e-6;

const RADIUS: f64 = 0.05;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

fn set(points: &[DVec3]) -> Field {
    point_set(RADIUS, points.iter().map(DVec3::to_array)).into()
}

fn brute_force(points: &[DVec3], p: DVec3) -> f64 {
    points.iter().map(|point| point.distance(p)).fold(f64::INFINITY, f64::min) - RADIUS
}

/// Clouds of all kinds: scattered, on a line, on a grid (where many points are equally near), in heaps far from each other, in
/// one place; of numbers around those that fill trees.
fn clouds(random: &mut Random) -> Vec<(String, Vec<DVec3>)> {
    let mut clouds = Vec::new();
    for count in [1, 2, 7, 8, 9, 15, 16, 17, 24, 25, 100, 1000] {
        clouds.push((format!("{count} scattered"), (0..count).map(|_| random.point(1.0)).collect()));
        let line = (0..count).map(|i| DVec3::new(0.3, f64::from(i) / f64::from(count) - 0.5, -0.2)).collect();
        clouds.push((format!("{count} on a line"), line));
        let heap = |i: i32| DVec3::new(f64::from(i % 3), f64::from(i % 2), 0.0) - 1.0;
        clouds.push((format!("{count} in heaps"), (0..count).map(|i| heap(i) + random.point(0.01)).collect()));
        clouds.push((format!("{count} in one place"), vec![DVec3::new(0.1, 0.2, 0.3); count as usize]));
    }
    let side = || (0..7).map(|i| f64::from(i) * 0.25 - 0.75);
    let grid = side().flat_map(|x| side().flat_map(move |y| side().map(move |z| DVec3::new(x, y, z)))).collect();
    clouds.push(("a grid".into(), grid));
    clouds
}

/// Places near, far, at points of the cloud and half-way between two of them.
fn places(cloud: &[DVec3], random: &mut Random, count: usize) -> Vec<DVec3> {
    let of = |random: &mut Random| cloud[random.below(cloud.len())];
    let place = |i: usize, random: &mut Random| match i % 5 {
        0 => of(random),
        1 => (of(random) + of(random)) / 2.0,
        2 => of(random) + random.point(0.1),
        3 => random.point(1.5),
        _ => random.point(20.0),
    };
    (0..count).map(|i| place(i, random)).collect()
}

#[test]
fn the_nearest_point_is_found() {
    let mut random = Random::new(1);
    for (name, cloud) in clouds(&mut random) {
        let program = program(&set(&cloud));
        for p in places(&cloud, &mut random, 200) {
            let (found, known) = (program.value(p), brute_force(&cloud, p));
            assert!((found - known).abs() < ROUNDING * (1.0 + known.abs()), "{name} at {p}: {found}, not {known}");
        }
    }
}

/// Rays that are over may lie at infinity.
#[test]
fn places_without_numbers_are_far_away() {
    for count in [1, 6, 100] {
        let mut random = Random::new(3);
        let cloud: Vec<DVec3> = (0..count).map(|_| random.point(1.0)).collect();
        let program = program(&set(&cloud));
        for level in simd::available() {
            for far in [f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::NAN] {
                let (x, y) = ([0.1, far, far, 0.2, far], [0.1, 0.2, far, 0.3, -far]);
                let mut values = [0.0; 5];
                Evaluator::with_level(&program, level).values(Points { x: &x, y: &y, z: &[0.0; 5] }, &mut values);
                assert!([1, 2, 4].iter().all(|&index| values[index] > 1e18), "{far}: {values:?}");
                assert!([0, 3].iter().all(|&index| values[index] < 3.0), "{far}: {values:?}");
            }
        }
    }
}

/// A place has the same value and gradient to the bit on all instruction sets and in whatever company; the gradient leads away from
/// a nearest point.
#[test]
fn a_place_has_the_same_numbers_in_all_company() {
    let mut random = Random::new(2);
    for (name, cloud) in clouds(&mut random) {
        let program = program(&set(&cloud));
        let places = places(&cloud, &mut random, 150);
        let [x, y, z] = [0, 1, 2].map(|axis| places.iter().map(|p| p[axis] as f32).collect::<Vec<f32>>());
        let compute = |level, from: usize, to: usize| {
            let mut out = [(); 4].map(|()| vec![0.0; to - from]);
            let [value, dx, dy, dz] = &mut out;
            let points = Points { x: &x[from..to], y: &y[from..to], z: &z[from..to] };
            let mut evaluator = Evaluator::with_level(&program, level);
            evaluator.gradients(points, value, [dx, dy, dz]);
            let mut values = vec![0.0; to - from];
            evaluator.values(points, &mut values);
            assert_eq!(&values, value, "{name}");
            out
        };
        let whole = compute(simd::best(), 0, places.len());
        for level in simd::available() {
            assert_eq!(compute(level, 0, places.len()), whole, "{name}: {}", simd::name(level));
        }
        for index in 0..places.len() {
            let alone = compute(simd::best(), index, index + 1).map(|numbers| numbers[0]);
            assert_eq!(alone, [0, 1, 2, 3].map(|part| whole[part][index]), "{name} at {}", places[index]);
            let p = DVec3::new(x[index].into(), y[index].into(), z[index].into());
            let gradient = DVec3::new(alone[1].into(), alone[2].into(), alone[3].into());
            let distance = f64::from(alone[0]) + RADIUS;
            assert!((brute_force(&cloud, p) + RADIUS - distance).abs() < SINGLE * (1.0 + distance), "{name} at {p}");
            // From where the gradient says that the nearest point is.
            let from = brute_force(&cloud, p - gradient * distance) + RADIUS;
            assert!(from < 10.0 * SINGLE * (1.0 + distance), "{name} at {p}: {from} away from any point");
        }
    }
}

#[test]
fn contracts_and_extents_are_those_of_balls() {
    let contract = |points: &[DVec3]| analyse(&set(points)).0.expect("sound").contract;
    let one = contract(&[DVec3::ONE]);
    assert_eq!((one.outside, one.inside), (Metric::Exact, Metric::Exact));
    let two = contract(&[DVec3::ONE, DVec3::ZERO]);
    assert_eq!((two.outside, two.inside), (Metric::Exact, Metric::Bound));
    let Extent::Finite(aabb) = extent(&set(&[DVec3::ONE, DVec3::ZERO])) else { panic!("a finite set") };
    assert!(
        aabb.min.abs_diff_eq(DVec3::splat(-RADIUS), 1e-9) && aabb.max.abs_diff_eq(DVec3::splat(1.0 + RADIUS), 1e-9)
    );
    assert!(analyse(&set(&[])).0.is_none());
}

/// The sum that defines the smooth set.
fn sum(points: &[DVec3], p: DVec3, level: f64) -> f64 {
    points.iter().map(|point| (level - point.distance(p)).max(0.0).powi(2)).sum()
}

/// By bisection, where the sum of squares is that of `k`.
fn smooth(points: &[DVec3], p: DVec3, k: f64) -> f64 {
    let nearest = brute_force(points, p) + RADIUS;
    let (mut low, mut high) = (nearest, nearest + k);
    for _ in 0..100 {
        let middle = (low + high) / 2.0;
        if sum(points, p, middle) < k * k { low = middle } else { high = middle }
    }
    (low + high) / 2.0 - k - RADIUS
}

#[test]
fn smooth_sets_are_what_their_equation_says() {
    let mut random = Random::new(3);
    for (name, cloud) in clouds(&mut random) {
        for k in [0.0, 0.01, 0.3, 2.0] {
            let field: Field = smooth_point_set(RADIUS, k, cloud.iter().map(DVec3::to_array)).into();
            let program = program(&field);
            for p in places(&cloud, &mut random, 40) {
                let (found, known) = (program.value(p), smooth(&cloud, p, k));
                assert!((found - known).abs() < 1e-9 * (1.0 + k), "{name}, {k} at {p}: {found}, not {known}");
                let single = f64::from(program_values(&program, p));
                let rounding = 20.0 * SINGLE * (1.0 + known.abs());
                assert!((single - known).abs() < rounding, "{name}, {k} at {p}: {single}, not {known}");
            }
        }
    }
}

fn program_values(program: &Program, p: DVec3) -> f32 {
    let [x, y, z] = p.to_array().map(|c| [c as f32]);
    let mut out = [0.0];
    Evaluator::new(program).values(Points { x: &x, y: &y, z: &z }, &mut out);
    out[0]
}

/// Away from seams it is the sharp set, and it grows by less than `k` wherever there are seams.
#[test]
fn smooth_sets_are_near_to_sharp_ones() {
    let mut random = Random::new(4);
    let (pair, k) = ([DVec3::ZERO, DVec3::X], 0.2);
    let field: Field = smooth_point_set(RADIUS, k, pair.map(|point| point.to_array())).into();
    let (smooth, sharp) = (program(&field), program(&set(&pair)));
    for p in (0..500).map(|_| random.point(2.0)) {
        let (a, b) = (smooth.value(p), sharp.value(p));
        assert!(a <= b + ROUNDING && a > b - k, "at {p}: {a} beside {b}");
        if (p.distance(pair[0]) - p.distance(pair[1])).abs() > k {
            assert!((a - b).abs() < ROUNDING, "at {p}: {a}, not {b}");
        }
    }
}
