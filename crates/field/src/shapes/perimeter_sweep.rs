//! Sweep of one plane figure along the outline of another. A bound.
//!
//! The second figure is looked up where x is the distance from the first one and y the height. Neither grows faster than the way
//! that a point moves, and together they don't either, since they change in directions at a right angle: so the result is no
//! more than the distance. It is less where the outline has no point as far away as the second figure asks for: within, beyond
//! the middle of the first figure.

use super::product;
use crate::analysis::{contract as contract_of, support as support_of};
use crate::contract::{Contract, Dimension, Metric};
use crate::field::{Field, Node};
use crate::shape::{About, Kind, Shape};
use glam::DVec3;

/// The descriptor of [`PerimeterSweep::perimeter_sweep`].
pub static PERIMETER_SWEEP: Shape = Shape {
    about: About {
        name: "perimeter_sweep",
        summary: "Makes a body of two plane figures: the second one moves along the outline of the first, upright, with its x away \
                  from the outline and its y along z.",
        params: &[],
        elsewhere: &["perimeter_extrude", "moulding", "picture frame", "profile along an outline"],
        example: r#"{ "perimeter_sweep": [
            { "star": { "tips": 5, "outer": 0.85, "inner": 0.45 } },
            { "difference": [
                { "rectangle": { "size": [0.3, 0.3] } }, { "translate": { "by": [0.15, 0.15, 0], "shape": { "circle": { "radius": 0.2 } } } }
            ] } ] }"#,
    },
    kind: Kind::PerimeterSweep,
    file: None,
};

/// Sweeping figures along outlines.
pub trait PerimeterSweep: Into<Field> {
    /// What the figure fills when it moves along the outline of another one: upright, with its x away from the outline and its y
    /// along z.
    #[track_caller]
    fn perimeter_sweep(self, outline: impl Into<Field>) -> Field {
        Field::new(&PERIMETER_SWEEP, [], [outline.into(), self.into()])
    }
}

impl<F: Into<Field>> PerimeterSweep for F {}

/// What is known about a node of this kind with these figures.
///
/// # Errors
/// If there are not two figures, or the second one has no inside.
pub(crate) fn contract(figures: &[Contract]) -> Result<Contract, String> {
    let &[outline, moving] = figures else {
        return Err(format!("`perimeter_sweep` takes two figures, not {}", figures.len()));
    };
    let moving = product::contract(moving)?;
    let either = Contract { signed: true, ..outline }.worse_of(moving).at_most_bound();
    // Distances that are none on one side of the outline may lead to either side of the other figure.
    let metric = outline.outside.max(outline.inside).max(moving.outside).max(moving.inside).max(Metric::Bound);
    let lipschitz = outline.lipschitz.zip(moving.lipschitz).map(|(outline, moving)| outline.max(1.0) * moving);
    Ok(Contract { outside: metric, inside: metric, lipschitz, dimension: Dimension::Space, ..either })
}

/// The support of a node of this kind; see [`crate::shape::Primitive::support`].
pub(crate) fn support(node: &Node, direction: DVec3, level: f64) -> f64 {
    let (outline, moving) = (&node.children[0], &node.children[1]);
    let across = direction.with_z(0.0);
    let flat = across.length();
    let reach = |x: f64, y: f64| match (x, y) {
        (0.0, 0.0) => 0.0,
        (x, y) => support_of(moving, DVec3::new(x, y, 0.0), level),
    };
    if flat == 0.0 {
        return reach(0.0, direction.z);
    }
    let is_exact = contract_of(outline).is_some_and(|known| known.outside == Metric::Exact);
    if is_exact {
        return support_of(outline, across, 0.0) + reach(flat, direction.z);
    }
    // Where a bound has some value, the outline may be farther away than that.
    let farthest = support_of(moving, DVec3::X, level).max(0.0);
    support_of(outline, across, farthest) + reach(0.0, direction.z)
}
