//! Sweeps of figures along the outlines of others: beside what else makes the same bodies.

mod common;

use common::Random;
use freikugel_field::shapes::*;
use freikugel_field::{Extent, Field, Metric, Program, Structure, analyse, extent};
use glam::DVec3;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

/// A figure with no symmetry.
fn figure() -> Field {
    polygon([[-0.12, -0.08], [0.16, -0.1], [0.1, 0.02], [-0.05, 0.14]]).into()
}

#[test]
fn sweeps_along_perimeters_are_what_else_makes_the_same_body() {
    const ROUNDING: f64 = 1e-9;
    let polygon = figure().scale(2.0);
    let corners = [[0.9, 0.6, 0.0], [-0.9, 0.6, 0.0], [-0.9, -0.6, 0.0], [0.9, -0.6, 0.0]];
    let tube = Field::from(tube(0.2, corners)).with("closed", &[1.into()]);
    let turned = polygon.clone().revolve().with("offset", &[0.7.into()]);
    let cases = [
        ("around a circle", polygon.perimeter_sweep(circle(0.7)), turned),
        ("around a rectangle", circle(0.2).perimeter_sweep(rectangle(1.8, 1.2)), tube),
        ("a range of distances", rectangle(0.4, 0.6).perimeter_sweep(circle(0.7)), tube_of(0.5, 0.9, 0.6)),
    ];
    let mut random = Random::new(12);
    for (name, made, other) in cases {
        let contract = analyse(&made).0.expect("sound").contract;
        assert_eq!((contract.outside, contract.inside, contract.lipschitz), (Metric::Bound, Metric::Bound, Some(1.0)));
        let (Extent::Finite(a), Extent::Finite(b)) = (extent(&made), extent(&other)) else {
            panic!("{name} is finite")
        };
        assert!(
            (a.min - b.min).abs().max_element() < ROUNDING && (a.max - b.max).abs().max_element() < ROUNDING,
            "{name}"
        );
        let (made, other) = (program(&made), program(&other));
        for _ in 0..5000 {
            let p = random.point(1.5);
            let (made, other) = (made.value(p), other.value(p));
            // Around the corners of the rectangle the tube is a ball within as well.
            assert!((made - other).abs() < ROUNDING || other < 0.0 && made < 0.0, "{name} at {p}: {made}, not {other}");
        }
    }
}

/// What a rectangle turns into around the z axis.
fn tube_of(inner: f64, outer: f64, height: f64) -> Field {
    let middle = (inner + outer) / 2.0;
    rectangle(outer - inner, height).revolve().with("offset", &[middle.into()])
}

#[test]
fn sweeps_that_cannot_be_are_refused() {
    let refused = |field: &Field, part: &str| {
        let messages: Vec<String> = analyse(field).1.into_iter().map(|d| d.message).collect();
        assert!(messages.iter().any(|message| message.contains(part)), "{part}: {messages:?}");
    };
    refused(&sphere(1.0).perimeter_sweep(circle(1.0)), "takes plane figures, not bodies");
    let three = Field::new(&PERIMETER_SWEEP, [], [circle(1.0), circle(0.1), circle(0.2)].map(Field::from));
    refused(&three, "takes two figures, not 3");
}
