//! Displace: a formula added to a shape's distance, f(p) + g(p).

use crate::contract::{Contract, Metric};
use crate::field::{Field, Node};
use crate::formula::Formula;
use crate::scalar::Interval;
use crate::shape::{About, Kind, Shape};
use crate::shapes::formula;

/// The descriptor of [`Displace::displace`].
pub static DISPLACE: Shape = Shape {
    about: About {
        name: "displace",
        summary: "Moves a shape's surface in and out by a formula in x, y and z, which is added to its distance.",
        params: &[],
        elsewhere: &["displacement", "bump", "perturb"],
        example: r#"{ "displace": { "by": "0.06*sin(12x)*sin(12y)*sin(12z)", "shape": { "sphere": { "radius": 1 } } } }"#,
    },
    kind: Kind::Displace,
    file: None,
};

/// Adding a formula to a distance.
pub trait Displace: Into<Field> {
    /// The shape with the formula in `text` added to its field.
    #[track_caller]
    fn displace(self, text: &str) -> Field {
        Field::new(&DISPLACE, [], [self.into()]).with_formula(Formula::parse(text))
    }
}

impl<F: Into<Field>> Displace for F {}

/// What is known about a node of this kind: the slopes add up.
pub(crate) fn contract(node: &Node, child: Contract) -> Contract {
    let added = node.formula(0).map_or(f64::INFINITY, formula::slope_everywhere);
    let slope = child.lipschitz.map(|slope| (slope + added).next_up());
    Contract {
        outside: Metric::Implicit,
        inside: Metric::Implicit,
        lipschitz: slope.filter(|slope| slope.is_finite()),
        ..child
    }
}

/// How far the formula lowers the child's values at most, as interval arithmetic finds over all of space.
pub(crate) fn depth(node: &Node) -> f64 {
    node.formula(0).map_or(f64::INFINITY, |formula| -formula.eval([Interval::ENTIRE; 3].into()).lo())
}
