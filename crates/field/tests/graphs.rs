//! Graphs of polynomials and of formulas: beside their points, close together.

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

type Function = fn(f64) -> f64;

/// Formulas of all kinds with functions that compute the same: smooth and steep ones, with corners, with ends and places where they have
/// no slope, straight, nearly vertical, and with waves that get ever shorter.
fn functions() -> Vec<(&'static str, [f64; 2], Function)> {
    vec![
        ("sin(7 * x) / 2", [-1.0, 1.2], |x| (7.0 * x).sin() / 2.0),
        ("exp(-4 * x^2) - 0.3", [-2.0, 1.5], |x| (-4.0 * x * x).exp() - 0.3),
        ("abs(x - 0.2) - abs(3 * x)", [-0.7, 1.1], |x| (x - 0.2).abs() - (3.0 * x).abs()),
        ("abs(x)", [-1.0, 1.0], f64::abs),
        ("sqrt(1 - x^2)", [-1.0, 1.0], |x| (1.0 - x * x).max(0.0).sqrt()),
        ("sqrt(abs(x))", [-1.0, 1.0], |x| x.abs().sqrt()),
        ("min(x, 0.3) + max(-x, 0.1)", [-1.0, 1.0], |x| x.min(0.3) + (-x).max(0.1)),
        ("atan(60 * x)", [-1.0, 1.0], |x| (60.0 * x).atan()),
        ("1 / (x + 1.05)", [-1.0, 1.0], |x| 1.0 / (x + 1.05)),
        ("0.7", [0.0, 1.0], |_| 0.7),
        ("x^2 * sin(1 / (0.05 + abs(x)))", [-0.5, 0.6], |x| x * x * (1.0 / (0.05 + x.abs())).sin()),
    ]
}

/// Points of a graph, closer together where it is steep.
fn points_of(ends: [f64; 2], f: Function) -> Vec<DVec2> {
    const NEAR: f64 = 3e-4;
    let mut points = vec![DVec2::new(ends[0], f(ends[0]))];
    let mut waiting = vec![ends[1]];
    while let Some(&x) = waiting.last() {
        let (last, next) = (points[points.len() - 1], DVec2::new(x, f(x)));
        if last.distance(next) <= NEAR || x - last.x < 1e-14 {
            points.push(next);
            waiting.pop();
        } else {
            waiting.push(last.x.midpoint(x));
        }
    }
    points
}

#[test]
fn graphs_of_formulas_are_as_far_as_the_nearest_of_their_points() {
    let mut random = Random::new(18);
    for (formula, ends, f) in functions() {
        let width = 0.05;
        let field = formula_graph(width, ends[0], ends[1], formula).into();
        assert_eq!(analyse(&field).0.expect("sound").contract.outside, Metric::Exact);
        let points = points_of(ends, f);
        let program = program(&field);
        for index in 0..60 {
            let far = if index % 2 == 0 { 0.5 } else { 0.03 };
            let p = points[random.below(points.len())] + random.point(far).truncate();
            let truth = nearest(&points, p) - width / 2.0;
            let found = program.value(p.extend(random.range(-1.0, 1.0)));
            // Arcs are within 0.002 of half the width.
            assert!((found - truth).abs() < 1.5e-4, "{formula} at {p}: {found}, not {truth}");
        }
    }
}

#[test]
fn what_lies_under_graphs_of_formulas_is_between_them_and_the_base() {
    let mut random = Random::new(19);
    for (formula, ends, f) in functions() {
        for base in [0.0, -0.4] {
            let field = under_formula_graph(ends[0], ends[1], formula).with("base", &[base.into()]).into();
            let contract = analyse(&field).0.expect("sound").contract;
            assert_eq!((contract.outside, contract.inside), (Metric::Exact, Metric::Exact));
            let points = points_of(ends, f);
            let size = points.iter().map(|point| (point.y - base).abs()).fold(ends[1] - ends[0], f64::max);
            let program = program(&field);
            for _ in 0..40 {
                let near = points[random.below(points.len())];
                let p = DVec2::new(near.x, base + (near.y - base) * random.range(-0.2, 1.2));
                let along = DVec2::new(p.x.clamp(ends[0], ends[1]), base);
                let side = |point: DVec2| DVec2::new(point.x, p.y.clamp(point.y.min(base), point.y.max(base)));
                let sides = [side(points[0]), side(points[points.len() - 1]), along];
                let truth = sides.map(|point| point.distance(p)).into_iter().fold(nearest(&points, p), f64::min);
                let found = program.value(p.extend(0.3));
                let slack = 2e-4 * size + 2e-4;
                assert!((found.abs() - truth).abs() < slack, "{formula}, {base} at {p}: {found}, not {truth}");
                let is_within = (p.y > base) != (p.y > f(p.x)) && ends[0] < p.x && p.x < ends[1];
                assert!(truth < slack || (found < 0.0) == is_within, "{formula}, {base} at {p}: {found}");
            }
        }
    }
}

/// How many constants an arc of a line has.
const ARC: usize = 15;

/// Where a graph is hard it takes more arcs, but not thousands.
#[test]
fn graphs_of_formulas_are_short_lists() {
    for (formula, ends, _) in functions() {
        let field: Field = formula_graph(0.05, ends[0], ends[1], formula).into();
        let constants = program(&field).constants().len();
        assert!(constants < 200 * ARC, "{formula}: {constants} constants");
    }
}

#[test]
fn formulas_without_graphs_are_refused() {
    for (formula, part) in [
        ("1 / x", "at x = 0.000000"),
        ("sqrt(x)", "has no value at x = -1.0"),
        ("floor(x + 0.25)", "jumps at x = -0.250000"),
        ("ln(x + 1)", "has no value at x = -1.0"),
        ("x * y", "has y in it; a graph is that of a formula in x"),
        ("sin(x", "is no formula: column 4"),
        ("sin(30000 * x)", "takes more than 4096 arcs"),
    ] {
        for field in [formula_graph(0.02, -1.0, 1.0, formula).into(), under_formula_graph(-1.0, 1.0, formula).into()] {
            let messages: Vec<String> = analyse(&field).1.into_iter().map(|diagnostic| diagnostic.message).collect();
            assert!(messages.iter().any(|message| message.contains(part)), "{formula}: {messages:?}");
        }
    }
    let messages: Vec<String> =
        analyse(&under_formula_graph(-1.0, 1.0, "0 * x").into()).1.into_iter().map(|fault| fault.message).collect();
    assert!(messages.iter().any(|message| message.contains("surrounds nothing")), "{messages:?}");
}

#[test]
fn graphs_that_cannot_be_are_refused() {
    for (field, part) in [
        (graph(0.1, 1.0, 1.0, [1.0]).into(), "`to` of `graph` is not above `from`"),
        (under_graph(1.0, 0.0, [1.0]).into(), "`to` of `under_graph` is not above `from`"),
        (formula_graph(0.1, 1.0, 1.0, "x").into(), "`to` of `formula_graph` is not above `from`"),
        (under_formula_graph(1.0, 0.5, "x").into(), "`to` of `under_formula_graph` is not above `from`"),
        (graph(0.1, 0.0, 1.0, [0.5; 22]).into(), "has 22 coefficients; at most 21 are possible"),
        (under_graph(0.0, 1.0, [0.0, 0.0]).into(), "surrounds nothing"),
    ] {
        let field: Field = field;
        let messages: Vec<String> = analyse(&field).1.into_iter().map(|diagnostic| diagnostic.message).collect();
        assert!(messages.iter().any(|message| message.contains(part)), "{part}: {messages:?}");
    }
}
