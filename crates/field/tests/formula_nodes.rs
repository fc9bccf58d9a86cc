//! Formulas as parts of fields: their values, cuts and enclosures.

mod common;

use common::Random;
use freikugel_field::shapes::*;
use freikugel_field::{Evaluator, Extent, Field, Formula, Interval, Points, Structure, analyse};
use glam::{DQuat, DVec3};

/// Formulas of all sorts, defined and bounded where they are tested.
const TEXTS: [&str; 7] = [
    "x^2 + 2y^2 + z^2 - 0.6",
    "x^4 + y^4 + z^4 - (x^2 + y^2 + z^2) / 2 + x*y / 5 - 0.1",
    "sin(3x) * cos(3y) + sin(3y) * cos(3z) + sin(3z) * cos(3x)",
    "max(abs(x) - 0.5, min(y, exp(z) - 1.2), abs(abs(z - 0.3) - 1) - 0.7)",
    "floor(2x) / 2 + ln(4 + y) - sqrt(abs(z)) + atan2(y, x + 4)",
    "1 / (4 + x) - tan(z / 4) * acos(y / 9) + asin(x / 9) - pow(4 + y, 1.3) / 5 + 0.2",
    "x^3 - 3x*y^2 + z^-2 / 9 + step(x, y) / 3",
];

/// The distance from a box, by its definition.
fn box_distance(p: DVec3, size: DVec3) -> f64 {
    let q = p.abs() - size / 2.0;
    q.max(DVec3::ZERO).length() + q.max_element().min(0.0)
}

#[test]
fn a_node_computes_its_formula_and_its_cut() {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 40f64.to_radians());
    let shift = DVec3::new(0.2, -0.3, 0.4);
    let size = DVec3::new(2.0, 3.0, 2.5);
    let mut random = Random::new(1);
    for text in TEXTS {
        let expression = Formula::parse(text).expect("a formula");
        let placed = |field: Field| field.rotate([1.0, 2.0, 3.0], 40.0).at(shift.to_array());
        let fields = [
            placed(formula(text).into()),
            placed(formula(text).within_sphere(1.5).into()),
            placed(formula(text).within_box(size).open().into()),
            placed(formula(text).sheet().into()),
        ];
        for p in (0..40).map(|_| random.point(2.0)) {
            let local = turn.inverse() * (p - shift);
            let value = expression.value(local.to_array());
            let expected =
                [value, value.max(local.length() - 1.5), value.abs().max(box_distance(local, size)), value.abs()];
            for (field, expected) in fields.iter().zip(expected) {
                let program =
                    Structure::compile(std::slice::from_ref(field)).expect("sound").program(DVec3::new(0.5, 0.1, -0.2));
                let near = |value: f64, tolerance: f64| (value - expected).abs() <= tolerance * (1.0 + expected.abs());
                let is_step = text.contains("floor") || text.contains("step");
                let exact = program.value(p);
                assert!(near(exact, 1e-9) || is_step, "{text} at {p}: {exact}, not {expected}");
                let [x, y, z] = (p - program.origin()).as_vec3().to_array().map(|c| [c]);
                let mut single = [0.0];
                Evaluator::new(&program).values(Points { x: &x, y: &y, z: &z }, &mut single);
                assert!(near(single[0].into(), 1e-4) || is_step, "{text} at {p}: {}, not {expected}", single[0]);
                let around = program.interval(p.to_array().map(|c| Interval::new(c - 0.01, c + 0.01)));
                assert!(around.contains(exact), "{text} at {p}: {exact} not in {around:?}");
            }
        }
    }
}

#[test]
fn a_cut_bounds_the_extent_and_a_fault_is_reported() {
    let cut: Field = formula("x + y").within_box([1.0, 2.0, 3.0]).at([1.0, 0.0, 0.0]);
    let Extent::Finite(aabb) = analyse(&cut).0.expect("sound").extent else { panic!("a cut formula is finite") };
    assert_eq!((aabb.min, aabb.max), (DVec3::new(0.5, -1.0, -1.5), DVec3::new(1.5, 1.0, 1.5)));
    let whole: Field = formula("x + y").into();
    assert_eq!(analyse(&whole).0.expect("sound").extent, Extent::Unbounded);
    let faulty: Field = formula("x + * y").into();
    let (analysis, diagnostics) = analyse(&faulty);
    assert!(analysis.is_none() && diagnostics[0].message.contains("column"), "{diagnostics:?}");
    let sheet: Field = formula("x").open().within_sphere(1.0).into();
    assert!(!analyse(&sheet).0.expect("sound").contract.signed);
}
