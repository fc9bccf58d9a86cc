//! Pyramid over a rectangle, also without its tip. Exact.

use super::convex_polyhedron::ConvexPolyhedron;
use crate::shape_prelude::*;

/// See [`pyramid`].
#[derive(Clone, Copy, Debug)]
pub struct Pyramid;

/// The descriptor of [`pyramid`].
pub static PYRAMID: Shape = Shape::special::<Pyramid>();

/// A pyramid over a rectangle, with its tip on the z axis. Its box is centred at the origin. `with("top", ...)` cuts the tip off.
#[track_caller]
pub fn pyramid(width: impl Into<Value>, depth: impl Into<Value>, height: impl Into<Value>) -> Form<Pyramid> {
    Form::new(&PYRAMID, [width.into(), depth.into(), height.into()])
}

impl Special for Pyramid {
    type General = ConvexPolyhedron;

    const ABOUT: About = About {
        name: "pyramid",
        summary: "A pyramid over a rectangle, with its tip on the z axis or without one.",
        params: &[
            Param::required("size", ParamKind::Size2, "Full edge lengths of the base."),
            Param::required("height", ParamKind::Positive, "Full height."),
            Param::optional(
                "top",
                ParamKind::Length,
                &[0.0],
                "How large the upper face is, as a share of the base: 0 for a tip, below 1.",
            ),
        ],
        elsewhere: &["sdPyramid", "truncated_rect_pyramid", "frustum"],
        example: r#"{ "pyramid": { "size": [1.6, 1.2], "height": 1.2, "top": 0.2 } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        if args[3] >= 1.0 {
            return Err("`top` of `pyramid` must be below 1".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width, depth, height, top] = args else { unreachable!("four numbers") };
        let half = height / 2.0;
        let side = |x: f64, y: f64, edge: f64| {
            // Outward by the height, and up by what a side comes in.
            let (out, up) = (height, edge / 2.0 * (1.0 - top));
            let length = libm::hypot(out, up);
            [x * out, y * out, up, (edge / 2.0 * out - half * up) / length]
        };
        let sides = [side(1.0, 0.0, width), side(-1.0, 0.0, width), side(0.0, 1.0, depth), side(0.0, -1.0, depth)];
        let mut planes = sides.concat();
        planes.extend([0.0, 0.0, -1.0, half, 0.0, 0.0, 1.0, half]);
        planes
    }
}
