//! Sector of a ball: a cone with a round end. Exact.

use crate::shape_prelude::*;
use std::f64::consts::PI;

/// See [`solid_angle`].
#[derive(Clone, Copy, Debug)]
pub struct SolidAngle;

/// The descriptor of [`solid_angle`].
pub static SOLID_ANGLE: Shape = Shape::primitive::<SolidAngle>();

/// What of a ball around the origin is seen from there at no more than an angle in degrees from the z axis.
#[track_caller]
pub fn solid_angle(degrees: f64, radius: impl Into<Value>) -> Form<SolidAngle> {
    Form::new(&SOLID_ANGLE, [degrees.to_radians().into(), radius.into()])
}

impl Primitive for SolidAngle {
    const ABOUT: About = About {
        name: "solid_angle",
        summary: "A sector of a ball: a cone with its tip at the origin and a round end.",
        params: &[
            Param::required("angle", ParamKind::Angle, "Degrees from the axis to the side, above 0 and below 180."),
            Param::required("radius", ParamKind::Positive, "Distance of the round end from the tip."),
            AXIS,
        ],
        elsewhere: &["sdSolidAngle", "spherical sector", "ice cream cone"],
        example: r#"{ "solid_angle": { "angle": 35, "radius": 1.2 } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let is_sound = args[0] > 0.0 && args[0] < PI;
        if is_sound { Ok(()) } else { Err("`angle` of `solid_angle` must be above 0 and below 180 degrees".into()) }
    }

    /// The direction of the side, and the radius.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let (sin, cos) = libm::sincos(args[0]);
        vec![sin, cos, args[1]]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let &[angle, radius, _axis] = args else { unreachable!("three numbers") };
        let across = libm::hypot(direction.x, direction.y);
        let length = direction.length();
        let farthest = if libm::atan2(across, direction.z) <= angle {
            radius * length
        } else {
            let (sin, cos) = libm::sincos(angle);
            (radius * (sin * across + cos * direction.z)).max(0.0)
        };
        farthest + level * length
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [sin, cos, radius] = c.get();
        let zero = p.x.lift(0.0);
        let across = S::length2(p.x, p.y);
        let of_ball = S::length2(across, p.z) - radius;
        let along = (across * sin + p.z * cos).max(zero).min(radius);
        let of_side = S::length2(across - sin * along, p.z - cos * along);
        // Negative within the cone.
        let is_within = (across * cos).lt(p.z * sin);
        of_ball.max(S::select(is_within, -of_side, of_side))
    }
}
