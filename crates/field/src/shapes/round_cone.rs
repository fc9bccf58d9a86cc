//! Cone between two spheres that touches both. Exact.

use crate::shape_prelude::*;

/// See [`round_cone`].
#[derive(Clone, Copy, Debug)]
pub struct RoundCone;

/// The descriptor of [`round_cone`].
pub static ROUND_CONE: Shape = Shape::primitive::<RoundCone>();

/// All that spheres fill whose middle moves from one end of a line of length `height` to the other, while their radius changes
/// evenly. The middle of the line is the origin.
#[track_caller]
pub fn round_cone(bottom: impl Into<Value>, top: impl Into<Value>, height: impl Into<Value>) -> Form<RoundCone> {
    Form::new(&ROUND_CONE, [bottom.into(), top.into(), height.into()])
}

impl Primitive for RoundCone {
    const ABOUT: About = About {
        name: "round_cone",
        summary: "A cone with round ends: the hull of two spheres.",
        params: &[
            Param::required("bottom", ParamKind::Positive, "Radius of the lower sphere."),
            Param::required("top", ParamKind::Positive, "Radius of the upper sphere."),
            Param::required("height", ParamKind::Positive, "Distance of the middles of the two spheres."),
            AXIS,
        ],
        elsewhere: &["sdRoundCone", "tapered capsule", "uneven_capsule"],
        example: r#"{ "round_cone": { "bottom": 0.6, "top": 0.25, "height": 1.1 } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        if (args[0] - args[1]).abs() >= args[2] {
            return Err(
                "one sphere of `round_cone` holds the other: `height` must be above the difference of the radii".into(),
            );
        }
        Ok(())
    }

    /// The slope of the side as sine and cosine, half the height, and both radii.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let &[bottom, top, height, _axis] = args else { unreachable!("four numbers") };
        let sin = (bottom - top) / height;
        vec![sin, (1.0 - sin * sin).sqrt(), height / 2.0, bottom, top]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let &[bottom, top, height, _axis] = args else { unreachable!("four numbers") };
        let (up, length) = (direction.z * height / 2.0, direction.length());
        (up + (top + level) * length).max(-up + (bottom + level) * length)
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [sin, cos, half, bottom, top] = c.get();
        let zero = p.x.lift(0.0);
        let across = S::length2(p.x, p.y);
        let from_bottom = p.z + half;
        // How far along the side its nearest point lies.
        let along = from_bottom * cos - across * sin;
        let of_side = across * cos + from_bottom * sin - bottom;
        let of_top = S::length2(across, p.z - half) - top;
        let of_bottom = S::length2(across, from_bottom) - bottom;
        let upper = S::select(((half + half) * cos).lt(along), of_top, of_side);
        S::select(along.lt(zero), of_bottom, upper)
    }
}
