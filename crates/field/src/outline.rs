//! Programs as other back ends read them: what each step computes, with the functions it calls and where its constants are.
//!
//! An outline says nothing that depends on the numbers of a field, and holds for every program of its structure.

use crate::formula::{Binary, Unary};
use crate::operation::{NO_REGION, Run, Step, StepId};
use crate::program::Program;
use crate::shape::{Kind, Shape};
use crate::shapes;
use std::ops::Range;

/// The steps of a program, each of which reads only steps before it.
#[derive(Clone, Debug)]
pub struct Outline {
    /// What each step computes.
    pub steps: Vec<Action>,
    /// The step that yields the result; `None` if there is nothing, which is infinitely far.
    pub result: Option<usize>,
}

/// What a step computes. Operands are places of earlier steps, constants are places in the table of the program's
/// constants ([`Program::constants`], [`Program::single_constants`]).
#[derive(Clone, Debug)]
pub enum Action {
    /// The point itself: always the first step, and only that.
    Point,
    /// The point `M p + t`: nine constants for the matrix, by columns, then three for the translation.
    Affine {
        /// The point.
        from: usize,
        /// The first of the constants.
        constants: usize,
    },
    /// The point `map(p - at)`.
    Map {
        /// The function, which has a [`Shape::mapping`].
        shape: &'static Shape,
        /// The point.
        from: usize,
        /// The first of the three constants that are subtracted from the point.
        at: usize,
        /// The constants of the function.
        constants: Range<usize>,
    },
    /// The value `primitive(p - at)`.
    Primitive {
        /// The function, which has a [`Shape::distance`].
        shape: &'static Shape,
        /// The point.
        point: usize,
        /// The first of the three constants that are subtracted from the point.
        at: usize,
        /// The constants of the function.
        constants: Range<usize>,
        /// The part of the surface it is; `None` if it only cuts something.
        region: Option<usize>,
    },
    /// The value `combine(a, b)`.
    Combine {
        /// The function, which has a [`Shape::combination`].
        shape: &'static Shape,
        /// The first value.
        a: usize,
        /// The second value.
        b: usize,
        /// The constants of the function.
        constants: Range<usize>,
    },
    /// The mixture of two values, by the share that follows from a height: see [`mixed`](crate::mix::mixed).
    Mix {
        /// The function, whose kind is [`Kind::Loft`].
        shape: &'static Shape,
        /// The first value.
        a: usize,
        /// The second value.
        b: usize,
        /// What the share follows from.
        height: usize,
        /// The constants of the mixture.
        constants: Range<usize>,
    },
    /// The value `modify(from)`.
    Modify {
        /// The function, whose kind is [`Kind::Modify`].
        shape: &'static Shape,
        /// The value.
        from: usize,
        /// The constants of the function.
        constants: Range<usize>,
    },
    /// The value times a constant.
    Scale {
        /// The value.
        from: usize,
        /// The constant.
        factor: usize,
    },
    /// A coordinate of the point `p - at`.
    Coordinate {
        /// The point.
        point: usize,
        /// 0, 1 or 2.
        axis: usize,
        /// The first of the three constants that are subtracted from the point.
        at: usize,
    },
    /// A constant.
    Literal {
        /// The constant.
        constant: usize,
    },
    /// A function of one value.
    Unary {
        /// The function.
        op: Unary,
        /// The value.
        from: usize,
    },
    /// A function of two values.
    Binary {
        /// The function.
        op: Binary,
        /// The first value.
        a: usize,
        /// The second value.
        b: usize,
    },
    /// An integer power.
    Power {
        /// The base.
        from: usize,
        /// The exponent.
        exponent: i32,
    },
    /// A value that is a part of the surface as a whole, whatever it is made of.
    Surface {
        /// The value.
        from: usize,
        /// The part of the surface.
        region: usize,
    },
    /// The value `op(from, by)`, which is part of whatever surface `from` is part of.
    Altered {
        /// The function.
        op: Binary,
        /// The value that is altered.
        from: usize,
        /// What it is altered by.
        by: usize,
    },
    /// The point with three values as its coordinates.
    Warp {
        /// The values.
        from: [usize; 3],
    },
}

impl Program {
    /// What its steps compute.
    pub fn outline(&self) -> Outline {
        let steps = &self.whole.steps;
        Outline { steps: steps.list.iter().map(Action::of).collect(), result: steps.result.map(StepId::index) }
    }

    /// The constants of all steps in single precision, for points relative to [`Program::origin`].
    pub fn single_constants(&self) -> &[f32] {
        &self.single
    }
}

impl Action {
    fn of(step: &Step) -> Self {
        let range = |run: Run| run.range();
        match *step {
            Step::Point => Self::Point,
            Step::Affine { from, constants } => Self::Affine { from: from.index(), constants: constants.start() },
            Step::Map { table, from, at, constants } => Self::Map {
                shape: named(|shape| shape.mapping().is_some_and(|other| std::ptr::eq(other, table))),
                from: from.index(),
                at: at.start(),
                constants: range(constants),
            },
            Step::Primitive { table, point, at, constants, region, .. } => Self::Primitive {
                shape: named(|shape| shape.distance().is_some_and(|other| std::ptr::eq(other, table))),
                point: point.index(),
                at: at.start(),
                constants: range(constants),
                region: (region != NO_REGION).then_some(region as usize),
            },
            Step::Combine { table, a, b, constants } => Self::Combine {
                shape: named(|shape| shape.combination().is_some_and(|other| std::ptr::eq(other, table))),
                a: a.index(),
                b: b.index(),
                constants: range(constants),
            },
            Step::Mix { a, b, height, constants } => Self::Mix {
                shape: named(|shape| matches!(shape.kind, Kind::Loft)),
                a: a.index(),
                b: b.index(),
                height: height.index(),
                constants: range(constants),
            },
            Step::Modify { table, from, constants } => Self::Modify {
                shape: named(|shape| matches!(&shape.kind, Kind::Modify(other) if std::ptr::eq(other, table))),
                from: from.index(),
                constants: range(constants),
            },
            Step::Scale { from, factor } => Self::Scale { from: from.index(), factor: factor as usize },
            Step::Coordinate { point, axis, at } => {
                Self::Coordinate { point: point.index(), axis: axis.into(), at: at.start() }
            }
            Step::Literal { constant } => Self::Literal { constant: constant as usize },
            Step::Unary { op, from } => Self::Unary { op, from: from.index() },
            Step::Binary { op, a, b } => Self::Binary { op, a: a.index(), b: b.index() },
            Step::Power { from, exponent } => Self::Power { from: from.index(), exponent },
            Step::Surface { from, region } => Self::Surface { from: from.index(), region: region as usize },
            Step::Altered { op, from, by } => Self::Altered { op, from: from.index(), by: by.index() },
            Step::Warp { x, y, z } => Self::Warp { from: [x, y, z].map(StepId::index) },
        }
    }
}

/// The shape that this is said of.
fn named(is_it: impl Fn(&Shape) -> bool) -> &'static Shape {
    shapes::ALL.iter().find(|shape| is_it(shape)).expect("every function is one of the shapes")
}
