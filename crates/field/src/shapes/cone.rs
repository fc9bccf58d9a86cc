//! Capped cone. Exact outside and inside.
//!
//! In the half-plane of radius and height it is a convex quadrilateral with one side on the axis. Inside, the distance is
//! that of the nearest of its lines. Outside it is that of the nearest of its two remaining sides, where a point beside
//! the middle of a side has the line's distance: this form has no square root that vanishes on the surface, so its
//! derivative exists there.

use crate::shape_prelude::*;

/// See [`cone`].
#[derive(Clone, Copy, Debug)]
pub struct Cone;

/// The descriptor of [`cone`].
pub static CONE: Shape = Shape::primitive::<Cone>();

/// A cone, its lower end with radius `bottom`, its upper end with radius `top`, its middle at the origin.
#[track_caller]
pub fn cone(bottom: impl Into<Value>, top: impl Into<Value>, height: impl Into<Value>) -> Form<Cone> {
    Form::new(&CONE, [bottom.into(), top.into(), height.into()])
}

impl Primitive for Cone {
    const ABOUT: About = About {
        name: "cone",
        summary: "A cone or frustum with flat ends, its middle at the origin.",
        params: &[
            Param::required("bottom", ParamKind::Length, "Radius of the lower end; 0 for a tip."),
            Param::optional("top", ParamKind::Length, &[0.0], "Radius of the upper end; 0 for a tip."),
            Param::required("height", ParamKind::Positive, "Full height, from end to end."),
            AXIS,
        ],
        elsewhere: &["capped cone", "frustum", "sdCappedCone"],
        example: r#"{ "cone": { "bottom": 0.8, "top": 0.3, "height": 1.4 } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        if args[0] == 0.0 && args[1] == 0.0 {
            return Err("a cone needs a radius above 0 at one of its ends".into());
        }
        Ok(())
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        let &[bottom, top, height, _axis] = args else { unreachable!("four numbers") };
        let slant = libm::hypot(height, top - bottom);
        vec![bottom, top, height / 2.0, height / slant, (bottom - top) / slant, 1.0 / slant]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let &[bottom, top, height, _axis] = args else { unreachable!("four numbers") };
        let across = libm::hypot(direction.x, direction.y);
        let rise = direction.z * height / 2.0;
        (top * across + rise).max(bottom * across - rise) + level * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        // (nr, nz) is the outward normal of the slanted side, which starts at the lower rim.
        let [bottom, top, half_height, nr, nz, inverse_slant] = c.get();
        let (zero, one) = (p.x.lift(0.0), p.x.lift(1.0));
        let r = S::length2(p.x, p.y);
        let (from_rim, above_rim) = (r - bottom, p.z + half_height);
        let side = from_rim * nr + above_rim * nz;
        let along = (above_rim * nr - from_rim * nz) * inverse_slant;
        let end = p.z.abs() - half_height;

        let end_radius = S::select(p.z.lt(zero), bottom, top);
        let upper_rim = S::length2(r - top, p.z - half_height);
        let lower_rim = S::length2(from_rim, above_rim);
        let beside_side = zero.lt(along) & along.lt(one);
        let to_side = S::select(beside_side, side.abs(), lower_rim.min(upper_rim));
        let to_end = S::select(r.lt(end_radius), end.abs(), lower_rim.min(upper_rim));
        let inside = side.lt(zero) & end.lt(zero);
        S::select(inside, side.max(end), to_side.min(to_end))
    }
}
