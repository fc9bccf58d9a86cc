//! Twist: a shape turned about an axis by an angle that grows along it.
//!
//! At distance r from the axis, the spectral norm of the inverse map's Jacobian matrix is (a + sqrt(a^2 + 4)) / 2, where a is
//! r times the rate. It grows without bound, so that a twist has no slope that holds everywhere.

use crate::analysis::extent_at;
use crate::contract::{Contract, Extent, Metric};
use crate::field::{Field, Node};
use crate::shape::{AXIS, About, Kind, Param, ParamKind, Shape};
use glam::DVec3;

/// The descriptor of [`Twist::twist`].
pub static TWIST: Shape = Shape {
    about: About {
        name: "twist",
        summary: "Twists a shape about an axis: cuts across the axis are turned, the more the farther along it they lie.",
        params: &[
            Param::required(
                "rate",
                ParamKind::Angle,
                "Degrees for each unit along the axis, counter-clockwise seen from its tip.",
            ),
            AXIS,
        ],
        elsewhere: &["screw", "torsion"],
        example: r#"{ "twist": { "rate": 60, "shape": { "box": { "size": [1.2, 0.6, 2], "round": 0.1 } } } }"#,
    },
    kind: Kind::Twist,
    file: None,
};

/// Twisting a shape.
pub trait Twist: Into<Field> {
    /// The shape twisted about the z axis by an angle in degrees for each unit along it. `with("axis", ...)` chooses
    /// another axis.
    #[track_caller]
    fn twist(self, degrees: f64) -> Field {
        Field::new(&TWIST, [degrees.to_radians().into()], [self.into()])
    }
}

impl<F: Into<Field>> Twist for F {}

/// The axes across and along, right-handed, the one along last.
pub(crate) fn axes(node: &Node) -> [usize; 3] {
    let along = node.axis().unwrap_or(2);
    [(along + 1) % 3, (along + 2) % 3, along]
}

/// What is known about a node of this kind.
///
/// # Errors
/// If its child reaches infinitely far from the axis, where it would be twisted infinitely strongly.
pub(crate) fn contract(node: &Node, child: Contract) -> Result<Contract, String> {
    if !radius(node, 0.0).is_finite() {
        return Err(
            "the shape to be twisted has no bound across the axis; intersect it with a cylinder or a box".into()
        );
    }
    let is_still = node.argument(0)[0] == 0.0;
    let lipschitz = child.lipschitz.filter(|_| is_still);
    Ok(Contract { outside: Metric::Implicit, inside: Metric::Implicit, lipschitz, ..child })
}

/// The support of the child's cylinder; see [`crate::shape::Primitive::support`].
pub(crate) fn support(node: &Node, direction: DVec3, level: f64) -> f64 {
    let [u, v, along] = axes(node);
    let across = direction[u].hypot(direction[v]);
    let mut axial = DVec3::ZERO;
    axial[along] = direction[along];
    let rise = if axial == DVec3::ZERO { 0.0 } else { crate::analysis::support(&node.children[0], axial, level) };
    (if across > 0.0 { across * radius(node, level) } else { 0.0 }) + rise
}

/// How far from the axis the child reaches at most.
fn radius(node: &Node, level: f64) -> f64 {
    let [u, v, _] = axes(node);
    let reach = |axis: usize| {
        let side = |sign: f64| crate::analysis::support(&node.children[0], DVec3::AXES[axis] * sign, level);
        side(1.0).abs().max(side(-1.0).abs())
    };
    match extent_at(&node.children[0], level) {
        Extent::Empty => 0.0,
        Extent::Finite(_) | Extent::Unbounded => reach(u).hypot(reach(v)),
    }
}
