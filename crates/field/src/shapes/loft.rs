//! Loft: a body whose cross-section goes from one figure to the next.
//!
//! At each height the distances from two figures are mixed. How fast the mixture changes with the height depends on how much the
//! figures differ there, so that it has no slope that holds everywhere.

use super::plane::PLANE;
use super::product;
use super::slab::SLAB;
use crate::analysis::support as support_of;
use crate::contract::{Contract, Metric};
use crate::field::{Field, Node, Value};
use crate::shape::{About, Kind, Param, ParamKind, RangeCall, Shape};
use glam::DVec3;

/// The descriptor of [`loft`].
pub static LOFT: Shape = Shape {
    about: About {
        name: "loft",
        summary: "Makes a body whose cross-section goes from one plane figure to the next, at even heights from the bottom to the \
                  top; the middle of the body is at the origin.",
        params: &[
            Param::required("height", ParamKind::Positive, "Full height along z."),
            Param::optional(
                "ease",
                ParamKind::Choice(&["linear", "smooth"]),
                &[0.0],
                "Whether it goes on evenly, or starts and stops at each figure.",
            ),
        ],
        elsewhere: &["extrude_to", "morph extrude", "blend between sections", "transition"],
        example: r#"{ "loft": { "height": 1.6, "ease": "smooth", "shapes": [
            { "rectangle": { "size": [1.6, 1.6], "round": 0.1 } }, { "circle": { "radius": 0.4 } },
            { "star": { "tips": 6, "outer": 0.9, "inner": 0.6 } } ] } }"#,
    },
    kind: Kind::Loft,
    file: None,
};

/// The body of this height whose cross-section goes from the first figure to the last. `with("ease", &[1.into()])` starts and stops
/// at each figure.
#[track_caller]
pub fn loft<F: Into<Field>>(height: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&LOFT, [height.into()], shapes.into_iter().map(Into::into))
}

/// What is known about a node of this kind with these figures.
///
/// # Errors
/// If there is one figure only, or one without an inside.
pub(crate) fn contract(figures: &[Contract]) -> Result<Contract, String> {
    let [first, second, ..] = figures else {
        return Err("`loft` goes from one figure to another; for a single one there is `extrude`".into());
    };
    figures.iter().try_for_each(|&figure| product::contract(figure).map(drop))?;
    Ok(Contract { outside: Metric::Implicit, inside: Metric::Implicit, lipschitz: None, ..first.worse_of(*second) })
}

/// The support of a node of this kind; see [`crate::shape::Primitive::support`]. A mixture is never less than each of both.
pub(crate) fn support(node: &Node, direction: DVec3, level: f64) -> f64 {
    let (across, rise) = (direction.with_z(0.0), (node.argument(0)[0] / 2.0 + level) * direction.z.abs());
    if across == DVec3::ZERO {
        return rise;
    }
    let figures = node.children.iter().map(|child| support_of(child, across, level));
    figures.fold(f64::NEG_INFINITY, f64::max) + rise
}

/// The constants of the mixture that goes from figure `index` to the next of `count`; see [`crate::mix`].
pub(crate) fn mixture(args: &[f64], index: usize, count: usize) -> Vec<f64> {
    let &[height, ease] = args else { unreachable!("two numbers") };
    let steps = (count - 1) as f64;
    vec![steps / height, steps / 2.0 - index as f64, ease]
}

/// What gives the height: the distance from the plane in the middle.
pub(crate) fn height() -> RangeCall {
    (&PLANE, vec![0.0, 0.0, 1.0, 0.0])
}

/// What the body is cut to.
pub(crate) fn cut(args: &[f64]) -> RangeCall {
    (&SLAB, vec![args[0], 2.0])
}
