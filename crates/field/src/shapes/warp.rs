//! Warp: a shape looked up at other points, which three formulas give.
//!
//! A point belongs to the result if the point that the formulas make of it belongs to the shape: the formulas are the inverse
//! of the deformation. Nothing has to be known about them. Their slopes are bounded by interval arithmetic wherever
//! a ray goes, so that a strongly warped spot slows nothing but itself.

use crate::contract::{Contract, Metric};
use crate::field::{Field, Node};
use crate::formula::Formula;
use crate::scalar::Interval;
use crate::shape::{About, Kind, Param, ParamKind, Shape};
use crate::shapes::formula;
use crate::slope::matrix_norm;
use glam::DVec3;

/// The descriptor of [`Warp::warp`].
pub static WARP: Shape = Shape {
    about: About {
        name: "warp",
        summary: "Looks a shape up at other points, which three formulas in x, y and z give.",
        params: &[Param::optional("within", ParamKind::Region, &[0.0; 4], "The part of space the result is cut to.")],
        elsewhere: &["deform", "domain warp", "distort", "remap"],
        example: r#"{ "warp": { "x": "x + 0.15*sin(3z)", "y": "y + 0.15*cos(3z)",
            "shape": { "box": { "size": [0.9, 0.9, 2], "round": 0.1 } } } }"#,
    },
    kind: Kind::Warp,
    file: None,
};

/// Deforming a shape.
pub trait Warp: Into<Field> {
    /// The shape looked up at the points that the formulas in these texts make of x, y and z.
    #[track_caller]
    fn warp(self, [x, y, z]: [&str; 3]) -> Field {
        Field::new(&WARP, [], [self.into()]).with_formulas([x, y, z].map(Formula::parse))
    }

    /// As [`Warp::warp`], cut to a sphere around the origin.
    #[track_caller]
    fn warp_within_sphere(self, formulas: [&str; 3], radius: f64) -> Field {
        self.warp(formulas).with("within", &[1.0, radius, 0.0, 0.0].map(Into::into))
    }
}

impl<F: Into<Field>> Warp for F {}

/// What is known about a node of this kind. The child's slope is multiplied with the largest stretching of the map, if
/// interval arithmetic finds a bound of that over all of space.
pub(crate) fn contract(node: &Node, args: &[f64], child: Contract) -> Contract {
    let rows = [0, 1, 2].map(|axis| node.formula(axis).map_or([Interval::ENTIRE; 3], formula::gradient_everywhere));
    let cut = if formula::Region::of(args) == formula::Region::Everywhere { 0.0 } else { 1.0 };
    let slope = child.lipschitz.map(|slope| (slope * matrix_norm(&rows)).next_up().max(cut));
    Contract {
        outside: Metric::Implicit,
        inside: Metric::Implicit,
        lipschitz: slope.filter(|slope| slope.is_finite()),
        ..child
    }
}

/// How far a warp moves a point along `direction` at most, if interval arithmetic finds a bound over all of space. The
/// shape can lie as much farther out as points are moved inwards.
pub(crate) fn reach(node: &Node, direction: DVec3) -> f64 {
    let moved = |axis: usize| match node.formula(axis) {
        Some(formula) if direction[axis] != 0.0 => {
            formula.minus_coordinate(axis).eval([Interval::ENTIRE; 3].into()) * -direction[axis]
        }
        _ => Interval::ZERO,
    };
    (moved(0) + moved(1) + moved(2)).hi()
}
