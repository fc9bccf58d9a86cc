//! Formula: a surface where an expression in x, y and z is 0.

use crate::field::{Form, Node};
use crate::formula::Formula as Expression;
use crate::shape::{About, Kind, Param, ParamKind, Shape};
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
        let &[kind, shape, a, b, c, cut] = args else { unreachable!("six numbers") };
        let region = match shape {
            1.0 => Region::Sphere { radius: a },
            2.0 => Region::Box { size: DVec3::new(a, b, c) },
            _ => Region::Everywhere,
        };
        Self { is_sheet: kind > 0.0 || (cut > 0.0 && region != Region::Everywhere), region }
    }

    /// As [`crate::shape::Primitive::support`].
    pub(crate) fn support(&self, direction: DVec3, level: f64) -> f64 {
        let length = direction.length();
        match self.region {
            Region::Everywhere => f64::INFINITY,
            Region::Sphere { radius } => (radius + level) * length,
            Region::Box { size } => size.dot(direction.abs()) / 2.0 + level * length,
        }
    }
}

/// The node's expression, if it has a sound one.
pub(crate) fn expression(node: &Node) -> Option<&Expression> {
    node.formula.as_ref()?.as_ref().ok()
}
