//! A piece of a ring with round ends. Exact outside.

use crate::shape_prelude::*;
use std::f64::consts::PI;

/// See [`capped_torus`].
#[derive(Clone, Copy, Debug)]
pub struct CappedTorus;

/// The descriptor of [`capped_torus`].
pub static CAPPED_TORUS: Shape = Shape::primitive::<CappedTorus>();

/// A tube along a piece of a circle around the z axis, with round ends. The piece takes up an angle in degrees, half of it to
/// each side of the x axis.
#[track_caller]
pub fn capped_torus(degrees: f64, major: impl Into<Value>, minor: impl Into<Value>) -> Form<CappedTorus> {
    Form::new(&CAPPED_TORUS, [degrees.to_radians().into(), major.into(), minor.into()])
}

impl Primitive for CappedTorus {
    const ABOUT: About = About {
        name: "capped_torus",
        summary: "A piece of a ring with round ends, half of it to each side of the x axis.",
        params: &[
            Param::required(
                "angle",
                ParamKind::Angle,
                "How much of the ring there is: degrees, above 0 and up to 360.",
            ),
            Param::required("major", ParamKind::Positive, "Radius of the circle in the middle of the tube."),
            Param::required("minor", ParamKind::Positive, "Radius of the tube."),
            AXIS,
        ],
        elsewhere: &["sdCappedTorus", "arc", "torus segment"],
        example: r#"{ "capped_torus": { "angle": 250, "major": 0.8, "minor": 0.25 } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let is_sound = args[0] > 0.0 && args[0] <= 2.0 * PI * (1.0 + f64::EPSILON);
        if is_sound { Ok(()) } else { Err("`angle` of `capped_torus` must be above 0 and at most 360 degrees".into()) }
    }

    /// The direction of an end, and the radii.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let (sin, cos) = libm::sincos((args[0] / 2.0).min(PI));
        vec![sin, cos, args[1], args[2]]
    }

    fn contract(args: &[f64]) -> Contract {
        let &[angle, major, minor, _axis] = args else { unreachable!("four numbers") };
        // Whether the ends run into each other.
        let overlaps = minor > major || angle > PI && major * libm::sin(angle / 2.0) < minor;
        Contract { inside: if overlaps { Metric::Bound } else { Metric::Exact }, ..Contract::EXACT }
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let &[angle, major, minor, _axis] = args else { unreachable!("four numbers") };
        let half = (angle / 2.0).min(PI);
        // The direction of the circle's point that lies farthest, or the nearest end.
        let turn = libm::atan2(direction.y, direction.x);
        let at = turn.clamp(-half, half);
        let ends = [-half, half, at].map(|angle| libm::cos(angle - turn));
        let farthest = ends.into_iter().fold(-1.0, f64::max);
        major * libm::hypot(direction.x, direction.y) * farthest + (minor + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [sin, cos, major, minor] = c.get();
        let y = p.y.abs();
        let is_beside = (p.x * sin).lt(y * cos);
        let of_ring = S::length2(S::length2(p.x, y) - major, p.z);
        let of_end = S::length3(p.x - cos * major, y - sin * major, p.z);
        S::select(is_beside, of_end, of_ring) - minor
    }
}
