//! Tube along a smooth curve through points (Catmull and Rom, "A class of local interpolating splines", 1974), which becomes arcs
//! within a tolerance; the distance from these is exact outside.

use super::tube::{TOLERANCE, Tube, Wire, along};
use crate::arcs3::of_curve;
use crate::curve::{Bezier, Point};
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`spline`].
#[derive(Clone, Copy, Debug)]
pub struct SplineTube;

/// The descriptor of [`spline`].
pub static SPLINE: Shape = Shape::special::<SplineTube>();

/// A tube along a smooth curve through all points. `with("closed", ...)` closes it.
#[track_caller]
pub fn spline<V: Into<Value>>(radius: impl Into<Value>, points: impl IntoIterator<Item = [V; 3]>) -> Form<SplineTube> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&SPLINE, [radius.into(), 0.into()].into_iter().chain(points))
}

impl Special for SplineTube {
    type General = Wire;

    const ABOUT: About = About {
        name: "spline",
        summary: "A round tube along a smooth curve through points.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the tube."),
            Param::optional(
                "closed",
                ParamKind::Flag,
                &[0.0],
                "Whether the curve leads from the last point back to the first.",
            ),
            Param::required("points", ParamKind::Points3, "The points [x, y, z] that it leads through: two at least."),
        ],
        elsewhere: &["Catmull-Rom spline", "Hermite spline", "interpolating spline"],
        example: r#"{ "spline": { "radius": 0.12, "points":
            [[-1, -0.6, -0.5], [-0.8, 0.6, 0.4], [-0.1, 0, -0.5], [0.4, -0.6, 0.5], [1, 0.6, 0]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        Tube::check(args).map_err(|fault| fault.replace("`tube`", "`spline`"))
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("spline", args, || {
            let points: Vec<DVec3> = args[2..].chunks_exact(3).map(DVec3::from_slice).collect();
            let pieces = pieces(&points, args[1] != 0.0);
            along(args[0], pieces.iter().flat_map(|piece| of_curve(piece, args[0] * TOLERANCE)))
        })
    }
}

/// The curve's pieces from point to point. At each point it has the direction from the one before to the one after; at the ends
/// of an open curve, that which makes the first and the last piece parabolas.
pub(crate) fn pieces<P: Point>(points: &[P], is_closed: bool) -> Vec<Bezier<P>> {
    let count = points.len();
    let slope = |index: usize| {
        if is_closed || (index > 0 && index + 1 < count) {
            (points[(index + 1) % count] - points[(index + count - 1) % count]) * 0.5
        } else if count == 2 {
            points[1] - points[0]
        } else if index == 0 {
            (points[1] - points[0]) * 2.0 - (points[2] - points[0]) * 0.5
        } else {
            (points[index] - points[index - 1]) * 2.0 - (points[index] - points[index - 2]) * 0.5
        }
    };
    (0..count - usize::from(!is_closed))
        .map(|index| {
            let next = (index + 1) % count;
            let (a, b) = (points[index], points[next]);
            Bezier::new(vec![a, a + slope(index) * (1.0 / 3.0), b - slope(next) * (1.0 / 3.0), b])
        })
        .collect()
}
