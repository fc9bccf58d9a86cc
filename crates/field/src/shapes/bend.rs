//! Bend: the x axis becomes an arc of a circle, and what lies beside it comes along. Lengths along the arc stay.

use crate::shape_prelude::*;
use std::f64::consts::PI;

/// See [`Bend::bend`].
#[derive(Clone, Copy, Debug)]
pub struct Bending;

/// The descriptor of [`Bend::bend`].
pub static BEND: Shape = Shape::map::<Bending>();

/// Bending a shape.
pub trait Bend: Into<Field> {
    /// The shape bent by so many degrees for each unit along x: its x axis becomes an arc that touches the old one at the origin
    /// and turns towards positive y.
    #[track_caller]
    fn bend(self, degrees: f64) -> Field {
        Field::new(&BEND, [degrees.to_radians().into()], [self.into()])
    }
}

impl<F: Into<Field>> Bend for F {}

impl Map for Bending {
    const ABOUT: About = About {
        name: "bend",
        summary: "Bends a shape in the plane of x and y: the x axis becomes an arc that turns towards positive y, and keeps its length.",
        params: &[Param::required(
            "rate",
            ParamKind::Angle,
            "Degrees for each unit along x, not 0; towards negative y if it is negative.",
        )],
        elsewhere: &["wrap_around", "bend cylinder", "arc bend"],
        example: r#"{ "bend": { "rate": 60, "shape": { "box": { "size": [3, 0.5, 0.8], "round": 0.1 } } } }"#,
    };

    const IS_SHORT: bool = false;

    const IS_PLANAR: bool = true;

    /// The curvature of the arc, and its radius.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let curvature = args[0];
        vec![curvature, 1.0 / curvature]
    }

    fn contract(args: &[f64], child: Contract, reach: Supports<'_>) -> Result<Contract, String> {
        let curvature = args[0];
        if curvature == 0.0 {
            return Err("`rate` of `bend` must not be 0".into());
        }
        let (ends, inward) = (reach(DVec3::X).max(reach(DVec3::NEG_X)), reach(DVec3::Y * curvature));
        if ends == f64::INFINITY || inward == f64::INFINITY {
            return Err(
                "the shape to be bent has no end along x, or towards the middle of the bend; intersect it with a box"
                    .into(),
            );
        }
        if ends * curvature.abs() > PI {
            return Err("the ends of the bent shape meet and overlap; a smaller `rate` keeps them apart".into());
        }
        if inward >= 1.0 {
            return Err("the shape reaches the middle of the bend; a smaller `rate` moves that away".into());
        }
        Ok(Contract { outside: Metric::Implicit, inside: Metric::Implicit, lipschitz: None, ..child })
    }

    fn support(args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        let rise = if direction.z == 0.0 { 0.0 } else { reach(DVec3::Z * direction.z) };
        if direction.x == 0.0 && direction.y == 0.0 {
            return rise;
        }
        let curvature = args[0];
        // A bend towards negative y is one towards positive y in a mirror.
        let (radius, side) = (1.0 / curvature.abs(), curvature.signum());
        let (left, right) = (-reach(DVec3::NEG_X), reach(DVec3::X));
        let (outer, inner) = (radius + reach(DVec3::NEG_Y * side), radius - reach(DVec3::Y * side));
        let (x, y) = (direction.x, direction.y * side);
        // How far the points of the unit circle between both ends reach, from its middle: at an end, or where the circle does.
        let at = |angle: f64| x * libm::sin(angle) - y * libm::cos(angle);
        let (from, to, farthest) = (left / radius, right / radius, libm::atan2(x, -y));
        let beside = at(from).max(at(to));
        let along = if (from..=to).contains(&farthest) { libm::hypot(x, y) } else { beside };
        y * radius + along * (if along > 0.0 { outer } else { inner }) + rise
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [curvature, radius] = c.get();
        let one = p.x.lift(1.0);
        let (along, towards) = (p.x * curvature, one - p.y * curvature);
        // The radius less the distance from the middle, without a difference of large numbers.
        let inward = (p.y * 2.0 - (p.x.square() + p.y.square()) * curvature) / (one + S::length2(along, towards));
        vec3(along.atan2(towards) * radius, inward, p.z)
    }
}
