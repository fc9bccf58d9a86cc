//! Swirl: a shape turned about the z axis by an angle that falls off with the distance from it.
//!
//! At distance r the Jacobian matrix of the map is a rotation times a shear by r times the change of the angle, at most the angle
//! over e. The norm of a shear by a is (a + sqrt(a^2 + 4)) / 2.

use crate::shape_prelude::*;
use std::f64::consts::E;

/// See [`Swirl::swirl`].
#[derive(Clone, Copy, Debug)]
pub struct Swirling;

/// The descriptor of [`Swirl::swirl`].
pub static SWIRL: Shape = Shape::map::<Swirling>();

/// Swirling a shape.
pub trait Swirl: Into<Field> {
    /// The shape turned about the z axis by an angle in degrees that falls to 1/e of it at this distance from the axis, and so on.
    #[track_caller]
    fn swirl(self, degrees: f64, radius: impl Into<Value>) -> Field {
        Field::new(&SWIRL, [degrees.to_radians().into(), radius.into()], [self.into()])
    }
}

impl<F: Into<Field>> Swirl for F {}

impl Map for Swirling {
    const ABOUT: About = About {
        name: "swirl",
        summary: "Turns a shape about the z axis, the less the farther from it.",
        params: &[
            Param::required(
                "angle",
                ParamKind::Angle,
                "How far it is turned on the axis, in degrees, counter-clockwise.",
            ),
            Param::required(
                "radius",
                ParamKind::Positive,
                "The distance from the axis at which the angle has fallen to 1/e.",
            ),
        ],
        elsewhere: &["twirl", "twirl_axis", "vortex"],
        example: r#"{ "swirl": { "angle": 140, "radius": 0.8, "shape": { "box": { "size": [2, 0.6, 0.5], "round": 0.1 } } } }"#,
    };

    const IS_SHORT: bool = false;

    const IS_PLANAR: bool = true;

    /// The angle back, and one over the radius.
    fn prepare(args: &[f64]) -> Vec<f64> {
        vec![-args[0], -1.0 / args[1]]
    }

    fn contract(args: &[f64], child: Contract, _reach: Supports<'_>) -> Result<Contract, String> {
        let shear = args[0].abs() / E;
        let norm = (shear + (shear * shear + 4.0).sqrt()) / 2.0;
        if args[0] == 0.0 {
            return Ok(child);
        }
        let lipschitz = child.lipschitz.map(|slope| slope * norm);
        Ok(Contract { outside: Metric::Implicit, inside: Metric::Implicit, lipschitz, ..child })
    }

    fn support(_args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        on_circle(direction, reach)
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [angle, fall] = c.get();
        let (sin, cos) = ((S::length2(p.x, p.y) * fall).exp() * angle).sin_cos();
        vec3(p.x * cos - p.y * sin, p.x * sin + p.y * cos, p.z)
    }
}

/// The support of all that a shape becomes when each of its points is turned about the z axis by any angle.
pub(crate) fn on_circle(direction: DVec3, reach: Supports<'_>) -> f64 {
    let side = |axis: DVec3| reach(axis).abs().max(reach(-axis).abs());
    let across = libm::hypot(direction.x, direction.y);
    let flat = if across > 0.0 { across * libm::hypot(side(DVec3::X), side(DVec3::Y)) } else { 0.0 };
    flat + if direction.z == 0.0 { 0.0 } else { reach(DVec3::Z * direction.z) }
}
