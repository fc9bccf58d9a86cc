//! Formula: a surface where an expression in x, y and z is 0.

use crate::contract::{Contract, Dimension, Metric};
use crate::field::{Form, Node};
use crate::formula::Formula as Expression;
use crate::scalar::{Dual, Interval, Scalar};
use crate::shape::{About, Kind, Param, ParamKind, Shape};
use crate::vector::vec3;
use glam::DVec3;

/// See [`formula`].
#[derive(Clone, Copy, Debug)]
pub struct Formula;

/// The descriptor of [`formula`].
pub static FORMULA: Shape = Shape {
    about: About {
        name: "formula",
        summary: "The surface where a formula in x, y and z is 0. No scale is needed: it is found without steps.",
        params: &[
            Param::optional(
                "kind",
                ParamKind::Choice(&["solid", "sheet"]),
                &[0.0],
                "Whether it is solid where the formula is negative, or nothing but the surface.",
            ),
            Param::optional("within", ParamKind::Region, &[0.0; 4], "The part of space it is cut to."),
            Param::optional(
                "cut",
                ParamKind::Choice(&["capped", "open"]),
                &[0.0],
                "Whether the cut through a solid is closed. Left open, what remains is a sheet.",
            ),
        ],
        elsewhere: &["implicit", "isosurface", "function"],
        example: r#"{ "formula": { "f": "x^2 + y^2 - z^2 - 0.2", "within": { "sphere": 1.5 } } }"#,
    },
    kind: Kind::Formula,
    file: None,
};

/// The solid where the formula in `text` is negative.
#[track_caller]
pub fn formula(text: &str) -> Form<Formula> {
    Form::new(&FORMULA, []).map(|field| field.with_formula(Expression::parse(text)))
}

impl Form<Formula> {
    /// The surface alone, as a sheet.
    #[must_use]
    pub fn sheet(self) -> Self {
        self.with("kind", &[1.0.into()])
    }

    /// Cut to a sphere around the origin.
    #[must_use]
    pub fn within_sphere(self, radius: f64) -> Self {
        self.with("within", &[1.0, radius, 0.0, 0.0].map(Into::into))
    }

    /// Cut to a box around the origin with these full edge lengths.
    #[must_use]
    pub fn within_box(self, size: impl Into<DVec3>) -> Self {
        let size = size.into();
        self.with("within", &[2.0, size.x, size.y, size.z].map(Into::into))
    }

    /// Leaves the cut open, which makes a sheet of a solid.
    #[must_use]
    pub fn open(self) -> Self {
        self.with("cut", &[1.0.into()])
    }
}

impl From<Expression> for Form<Formula> {
    #[track_caller]
    fn from(expression: Expression) -> Self {
        Form::new(&FORMULA, []).map(|field| field.with_formula(Ok(expression)))
    }
}

/// What is known about a node of this kind.
///
/// Its slope is bounded by what interval arithmetic finds over all of space: for waves there is a bound, for polynomials
/// above degree 1 there is none. Over a box there nearly always is one: see [`crate::explore()`].
pub(crate) fn contract(node: &Node, args: &[f64]) -> Contract {
    let parts = Parts::of(args);
    let slope = node.formula(0).map_or(f64::INFINITY, slope_everywhere);
    let cut = if parts.region == Region::Everywhere { 0.0 } else { 1.0 };
    Contract {
        dimension: Dimension::Space,
        outside: Metric::Implicit,
        inside: Metric::Implicit,
        signed: !parts.is_sheet,
        lipschitz: Some(slope.max(cut)).filter(|slope| slope.is_finite()),
        within: None,
    }
}

/// An upper bound of the size of a formula's gradient over all of space; infinite if none is found.
pub(crate) fn slope_everywhere(formula: &Expression) -> f64 {
    let [x, y, z] = gradient_everywhere(formula);
    Interval::length3(x, y, z).hi()
}

/// An enclosure of a formula's gradients over all of space.
pub(crate) fn gradient_everywhere(formula: &Expression) -> [Interval; 3] {
    let all = Interval::new(-FARTHEST, FARTHEST);
    let input = |axis| Dual::input(all, axis);
    let gradient = formula.eval(vec3(input(0), input(1), input(2))).gradient;
    gradient.map(|side| if side.abs().hi() < STEEPEST { side } else { Interval::ENTIRE })
}

/// The largest coordinate. Infinite ones would make 0 times infinity of the derivative of a constant.
const FARTHEST: f64 = 1e100;

/// A bound of a slope as large as this is as good as none.
const STEEPEST: f64 = 1e9;

/// A node of this kind, taken apart.
pub(crate) struct Parts {
    pub(crate) is_sheet: bool,
    pub(crate) region: Region,
}

/// What a formula is cut to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Region {
    Everywhere,
    Sphere { radius: f64 },
    Box { size: DVec3 },
}

/// Where the numbers of the region begin among the arguments.
pub(crate) const REGION: usize = 1;

impl Parts {
    pub(crate) fn of(args: &[f64]) -> Self {
        let &[kind, ref region @ .., cut] = args else { unreachable!("six numbers") };
        let region = Region::of(region);
        Self { is_sheet: kind > 0.0 || (cut > 0.0 && region != Region::Everywhere), region }
    }
}

impl Region {
    /// The region that four numbers stand for: see [`ParamKind::Region`].
    pub(crate) fn of(numbers: &[f64]) -> Self {
        match *numbers {
            [1.0, radius, ..] => Self::Sphere { radius },
            [2.0, x, y, z] => Self::Box { size: DVec3::new(x, y, z) },
            _ => Self::Everywhere,
        }
    }

    /// As [`crate::shape::Primitive::support`].
    pub(crate) fn support(self, direction: DVec3, level: f64) -> f64 {
        let length = direction.length();
        match self {
            Self::Everywhere => f64::INFINITY,
            Self::Sphere { radius } => (radius + level) * length,
            Self::Box { size } => size.dot(direction.abs()) / 2.0 + level * length,
        }
    }
}
