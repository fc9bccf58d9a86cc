//! Tube along a B-spline, whose pieces become arcs within a tolerance; the distance from these is exact outside.

use super::tube::{TOLERANCE, Wire, along};
use crate::arcs3::of_curve;
use crate::curve::{BSpline, Point};
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`b_spline`].
#[derive(Clone, Copy, Debug)]
pub struct BSplineTube;

/// The descriptor of [`b_spline`].
pub static B_SPLINE: Shape = Shape::special::<BSplineTube>();

/// A tube along the B-spline of a degree with these control points and evenly spaced knots, from the first to the last.
/// `with("closed", ...)` closes it.
#[track_caller]
pub fn b_spline<V: Into<Value>>(
    radius: impl Into<Value>,
    degree: u32,
    points: impl IntoIterator<Item = [V; 3]>,
) -> Form<BSplineTube> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&B_SPLINE, [radius.into(), degree.into(), 0.into()].into_iter().chain(points))
}

impl Special for BSplineTube {
    type General = Wire;

    const ABOUT: About = About {
        name: "b_spline",
        summary: "A round tube along a B-spline: near its control points, and smoother the higher its degree.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the tube."),
            Param::optional("degree", ParamKind::Count(1, 9), &[3.0], "The degree; there are more points than that."),
            Param::optional("closed", ParamKind::Flag, &[0.0], "Whether the curve goes around and closes."),
            Param::required(
                "points",
                ParamKind::Points3,
                "The control points [x, y, z], in order: more than the degree.",
            ),
        ],
        elsewhere: &["B-spline", "bspline", "NURBS with equal weights"],
        example: r#"{ "b_spline": { "radius": 0.15, "closed": true, "points":
            [[-1, -0.8, 0.5], [0, -1.2, -0.6], [1, -0.8, 0.5], [1.2, 0.9, -0.6], [0, 0.4, 0.9], [-1.2, 0.9, -0.6]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let spline = with_even_knots(args[1], args[2], points(args)).map_err(|fault| format!("`b_spline`: {fault}"))?;
        if spline.points().iter().all(|point| *point == spline.points()[0]) {
            return Err("all points of `b_spline` are the same".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("b_spline", args, || {
            let spline = with_even_knots(args[1], args[2], points(args));
            let pieces = spline.map(|spline| spline.beziers()).unwrap_or_default();
            along(args[0], pieces.iter().flat_map(|piece| of_curve(piece, args[0] * TOLERANCE)))
        })
    }
}

fn points(args: &[f64]) -> Vec<DVec3> {
    args[3..].chunks_exact(3).map(DVec3::from_slice).collect()
}

/// The spline of a degree with these control points and evenly spaced knots, which is closed if `closed` isn't 0.
pub(crate) fn with_even_knots<P: Point>(degree: f64, closed: f64, points: Vec<P>) -> Result<BSpline<P>, String> {
    let degree = degree as usize;
    if closed == 0.0 { BSpline::clamped(degree, points) } else { BSpline::closed(degree, &points) }
}
