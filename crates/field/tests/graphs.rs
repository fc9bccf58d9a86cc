//! Graphs of polynomials: beside their points, close together.

mod common;

use common::Random;
use freikugel_field::shapes::*;
use freikugel_field::{Extent, Field, Metric, Program, Structure, analyse, extent};
use glam::{DVec2, DVec3};

/// The points are closer together than this, or farther apart than the fields' own tolerances.
const TOLERANCE: f64 = 1e-3;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

/// A polynomial by powers, as no code of the library computes it.
fn value(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().enumerate().map(|(power, coefficient)| coefficient * x.powi(power as i32)).sum()
}

/// Random graphs of all degrees, among them flat, straight and steep ones: where they begin and end, and their coefficients.
fn graphs(random: &mut Random) -> Vec<([f64; 2], Vec<f64>)> {
    let graph = |degree: usize| {
        let from = random.range(-1.5, 0.2);
        let coefficients = (0..=degree).map(|_| random.range(-1.5, 1.5)).collect();
        ([from, from + random.range(0.2, 1.5)], coefficients)
    };
    (0..=6).chain(0..=6).map(graph).chain([([0.1, 0.4], vec![0.0, 0.0, 30.0])]).collect()
}

/// Points of a graph, and its ends first and last.
fn points(ends: [f64; 2], coefficients: &[f64]) -> Vec<DVec2> {
    const STEPS: u32 = 40_000;
    let place = |step: u32| ends[0] + (ends[1] - ends[0]) * f64::from(step) / f64::from(STEPS);
    (0..=STEPS).map(|step| DVec2::new(place(step), value(coefficients, place(step)))).collect()
}

fn nearest(points: &[DVec2], p: DVec2) -> f64 {
    points.iter().map(|point| point.distance(p)).fold(f64::INFINITY, f64::min)
}

#[test]
fn graphs_are_as_far_as_the_nearest_of_their_points() {
    let mut random = Random::new(8);
    for (ends, coefficients) in graphs(&mut random) {
        let width = random.range(0.02, 0.2);
        let field = graph(width, ends[0], ends[1], coefficients.clone()).into();
        assert_eq!(analyse(&field).0.expect("sound").contract.outside, Metric::Exact);
        let points = points(ends, &coefficients);
        let program = program(&field);
        for _ in 0..60 {
            let p = points[random.below(points.len())] + random.point(0.5).truncate();
            let truth = nearest(&points, p) - width / 2.0;
            let found = program.value(p.extend(random.range(-1.0, 1.0)));
            assert!((found - truth).abs() < TOLERANCE, "{coefficients:?} over {ends:?} at {p}: {found}, not {truth}");
        }
    }
}

#[test]
fn what_lies_under_graphs_is_between_them_and_the_base() {
    let mut random = Random::new(9);
    for (ends, coefficients) in graphs(&mut random) {
        let base = if random.below(3) == 0 { 0.0 } else { random.range(-0.5, 0.5) };
        let field: Field = under_graph(ends[0], ends[1], coefficients.clone()).with("base", &[base.into()]).into();
        let contract = analyse(&field).0.expect("sound").contract;
        assert_eq!((contract.outside, contract.inside), (Metric::Exact, Metric::Exact));
        let points = points(ends, &coefficients);
        let size = points.iter().map(|point| (point.y - base).abs()).fold(1.0, f64::max);
        let program = program(&field);
        let border = |p: DVec2| {
            let [from, to] = ends;
            let along = DVec2::new(p.x.clamp(from, to), base);
            let side = |x: f64, y: f64| DVec2::new(x, p.y.clamp(y.min(base), y.max(base)));
            let sides = [side(from, points[0].y), side(to, points[points.len() - 1].y), along];
            sides.map(|point| point.distance(p)).into_iter().fold(nearest(&points, p), f64::min)
        };
        for _ in 0..60 {
            let near = points[random.below(points.len())];
            let p = DVec2::new(near.x, base + (near.y - base) * random.range(-0.2, 1.2)) + random.point(0.3).truncate();
            let truth = border(p);
            let found = program.value(p.extend(0.3));
            assert!(
                (found.abs() - truth).abs() < TOLERANCE * size,
                "{coefficients:?}, {base} at {p}: {found}, not {truth}"
            );
            let is_within = (p.y > base) != (p.y > value(&coefficients, p.x)) && ends[0] < p.x && p.x < ends[1];
            assert!(truth < TOLERANCE * size || (found < 0.0) == is_within, "{coefficients:?}, {base} at {p}: {found}");
        }
        let Extent::Finite(aabb) = extent(&field.extrude(1.0)) else { panic!("it is finite") };
        let (low, high) = points.iter().fold((base, base), |(low, high), point| (low.min(point.y), high.max(point.y)));
        assert!((aabb.min.y - low).abs() < TOLERANCE * size && (aabb.max.y - high).abs() < TOLERANCE * size);
    }
}

#[test]
fn graphs_that_cannot_be_are_refused() {
    for (field, part) in [
        (graph(0.1, 1.0, 1.0, [1.0]).into(), "`to` of `graph` is not above `from`"),
        (under_graph(1.0, 0.0, [1.0]).into(), "`to` of `under_graph` is not above `from`"),
        (graph(0.1, 0.0, 1.0, [0.5; 22]).into(), "has 22 coefficients; at most 21 are possible"),
        (under_graph(0.0, 1.0, [0.0, 0.0]).into(), "surrounds nothing"),
    ] {
        let field: Field = field;
        let messages: Vec<String> = analyse(&field).1.into_iter().map(|diagnostic| diagnostic.message).collect();
        assert!(messages.iter().any(|message| message.contains(part)), "{part}: {messages:?}");
    }
}
