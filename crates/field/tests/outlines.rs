//! What other back ends read: outlines say what programs compute, and graphs of derivatives hold the gradient.

mod common;

use common::{Random, every_shape, tree};
use freikugel_field::expr::Graph;
use freikugel_field::{Action, Dual, Field, Program, Structure};
use glam::DVec3;

/// What the orders of additions and multiplications make, relative to the gradient: some of the last digits.
const ROUNDING: f64 = 1e-9;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

#[test]
fn graphs_of_derivatives_hold_the_gradient() {
    let trees = (0..6).map(|seed| ("tree", seed, tree(3, &mut Random::new(seed + 40))));
    for (name, seed, field) in every_shape(2).chain(trees) {
        let program = program(&field);
        let (graph, derivatives) = (Graph::new(), Graph::new());
        let result = program.expression(&graph);
        let Dual { value, gradient } = graph.differentiate::<3>(&[result], &derivatives)[0];
        let mut random = Random::new(seed + 7);
        for _ in 0..25 {
            let p = random.point(2.0);
            let at = |number| derivatives.evaluate(number, p.to_array(), program.constants());
            let (expected, slope) = program.gradient(p);
            let found = DVec3::from_array(gradient.map(at));
            let reach = ROUNDING * (1.0 + slope.length() + expected.abs());
            assert!((at(value) - expected).abs() < reach, "{name} {seed} at {p}: {} not {expected}", at(value));
            assert!(found.distance(slope) < reach, "{name} {seed} at {p}: {found}, not {slope}");
        }
    }
}

#[test]
fn steps_read_only_what_comes_before_them() {
    for (name, seed, field) in every_shape(3) {
        let program = program(&field);
        let outline = program.outline();
        assert!(matches!(outline.steps[0], Action::Point), "{name} {seed}");
        assert!(outline.result.is_some_and(|result| result < outline.steps.len()));
        assert_eq!(program.single_constants().len(), program.constants().len());
        let count = program.constants().len();
        for (index, action) in outline.steps.iter().enumerate() {
            let (operands, constants) = match action {
                Action::Point => (vec![], 0..0),
                Action::Affine { from, constants } => (vec![*from], *constants..constants + 12),
                Action::Primitive { point, constants, .. } => (vec![*point], constants.clone()),
                Action::Map { from, constants, .. } => (vec![*from], constants.clone()),
                Action::Combine { a, b, constants, .. } => (vec![*a, *b], constants.clone()),
                Action::Altered { from, by, .. } => (vec![*from, *by], 0..0),
                Action::Modify { from, constants, .. } => (vec![*from], constants.clone()),
                Action::Scale { from, factor } => (vec![*from], *factor..factor + 1),
                // Points whose coordinates are values: perimeter sweeps make some.
                Action::Coordinate { point, at, .. } => (vec![*point], *at..at + 3),
                Action::Literal { constant } => (vec![], *constant..constant + 1),
                Action::Warp { from } => (from.to_vec(), 0..0),
                other => panic!("{name} {seed}: {other:?} is of formulas"),
            };
            assert!(operands.iter().all(|&operand| operand < index), "{name} {seed} {action:?}");
            assert!(constants.end <= count, "{name} {seed} {action:?}");
        }
    }
}
