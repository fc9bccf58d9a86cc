//! Ring in the plane: all between two circles. Exact.

use crate::shape_prelude::*;

/// See [`ring`].
#[derive(Clone, Copy, Debug)]
pub struct Ring;

/// The descriptor of [`ring`].
pub static RING: Shape = Shape::primitive::<Ring>();

/// All between two circles around the origin of the plane.
#[track_caller]
pub fn ring(outer: impl Into<Value>, inner: impl Into<Value>) -> Form<Ring> {
    Form::new(&RING, [outer.into(), inner.into()])
}

impl Primitive for Ring {
    const ABOUT: About = About {
        name: "ring",
        summary: "A plane figure: all between two circles around the origin.",
        params: &[
            Param::required("outer", ParamKind::Positive, "Radius of the outer circle."),
            Param::required("inner", ParamKind::Positive, "Radius of the inner circle."),
        ],
        elsewhere: &["annulus", "sdRing", "washer", "tube", "pipe"],
        example: r#"{ "extrude": { "height": 0.5, "shape": { "ring": { "outer": 0.9, "inner": 0.6 } } } }"#,
    };

    const DIMENSION: Dimension = Dimension::Plane;

    fn check(args: &[f64]) -> Result<(), String> {
        if args[1] >= args[0] { Err("`inner` of `ring` must be less than `outer`".into()) } else { Ok(()) }
    }

    /// The radius of the circle in the middle, and half the width.
    fn prepare(args: &[f64]) -> Vec<f64> {
        vec![(args[0] + args[1]) / 2.0, (args[0] - args[1]) / 2.0]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        in_plane(direction, |across| (args[0] + level) * across)
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [middle, half] = c.get();
        (S::length2(p.x, p.y) - middle).abs() - half
    }
}
