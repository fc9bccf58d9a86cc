//! Tube along a Bézier curve, which becomes arcs within a tolerance; the distance from these is exact outside.

use super::tube::{TOLERANCE, Wire, along};
use crate::arcs3::of_curve;
use crate::curve::Bezier;
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`bezier`].
#[derive(Clone, Copy, Debug)]
pub struct BezierTube;

/// The descriptor of [`bezier`].
pub static BEZIER: Shape = Shape::special::<BezierTube>();

/// A tube along the Bézier curve with these control points; its degree is one less than their number.
#[track_caller]
pub fn bezier<V: Into<Value>>(radius: impl Into<Value>, points: impl IntoIterator<Item = [V; 3]>) -> Form<BezierTube> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&BEZIER, [radius.into()].into_iter().chain(points))
}

/// Curves of a higher degree are hardly ever wanted, and lose precision.
pub(crate) const MOST_POINTS: usize = 33;

impl Special for BezierTube {
    type General = Wire;

    const ABOUT: About = About {
        name: "bezier",
        summary: "A round tube along a Bézier curve.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the tube."),
            Param::required("points", ParamKind::Points3, "The control points [x, y, z], in order: two at least."),
        ],
        elsewhere: &["bezier3", "quadratic_bezier", "cubic_bezier", "sdBezier"],
        example: r#"{ "bezier": { "radius": 0.15, "points": [[-1, -0.6, -0.4], [-0.6, 1.8, 0.6], [0.6, -1.8, 0.4], [1, 0.6, -0.4]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let points: Vec<&[f64]> = args[1..].chunks_exact(3).collect();
        if points.len() < 2 || points.iter().all(|point| *point == points[0]) {
            return Err("`bezier` is a curve between two points at least".into());
        }
        if points.len() > MOST_POINTS {
            return Err(format!("`bezier` may have at most {MOST_POINTS} points; a `b_spline` takes more"));
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let points = args[1..].chunks_exact(3).map(DVec3::from_slice).collect();
        remembered("bezier", args, || along(args[0], of_curve(&Bezier::new(points), args[0] * TOLERANCE)))
    }
}
