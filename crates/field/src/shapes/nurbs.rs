//! Tube along a rational B-spline, whose pieces become arcs within a tolerance; the distance from these is exact outside.

use super::b_spline::{KNOTS, Knots, Knotted};
use super::tube::{TOLERANCE, Wire, along};
use crate::arcs3::{Rational, of_curve};
use crate::curve::Bezier;
use crate::remember::remembered;
use crate::shape_prelude::*;
use glam::DVec4;

/// See [`nurbs`].
#[derive(Clone, Copy, Debug)]
pub struct Nurbs;

/// The descriptor of [`nurbs`].
pub static NURBS: Shape = Shape::special::<Nurbs>();

/// A tube along the rational B-spline of a degree with these control points x, y, z and weights above 0, and evenly spaced knots,
/// from the first to the last. `with("closed", ...)` closes it; `with("knots", &[1.into()])` makes it a chain of rational Bézier
/// curves; [`Form::knots`] gives it other knots.
#[track_caller]
pub fn nurbs<V: Into<Value>>(
    radius: impl Into<Value>,
    degree: u32,
    points: impl IntoIterator<Item = [V; 4]>,
) -> Form<Nurbs> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&NURBS, [radius.into(), degree.into(), 0.into(), 0.into()].into_iter().chain(points))
}

impl Knotted for Nurbs {}

impl Special for Nurbs {
    type General = Wire;

    const ABOUT: About = About {
        name: "nurbs",
        summary: "A round tube along a rational B-spline: also along true circles and other conics.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the tube."),
            Param::optional("degree", ParamKind::Count(1, 9), &[3.0], "The degree; there are more points than that."),
            Param::optional("closed", ParamKind::Flag, &[0.0], "Whether the curve goes around and closes."),
            KNOTS,
            Param::required(
                "points",
                ParamKind::Weighted,
                "The control points [x, y, z, weight], in order: more than the degree. Weights are above 0; the larger, the nearer \
                 the curve comes.",
            ),
        ],
        elsewhere: &["NURBS", "rational B-spline", "rational Bézier curve", "conic", "elliptic arc"],
        example: r#"{ "nurbs": { "radius": 0.15, "degree": 2, "knots": "pieces", "points":
            [[-1, 0.6, 0, 1], [-1, -0.6, 0.6, 3], [0, -0.6, 0, 1], [0.4, -0.6, -0.3, 0.3], [0.4, 0, 0, 1],
            [0.4, 0.6, 0, 0.70710678], [1, 0.6, 0, 1]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let points: Vec<&[f64]> = Knots::split(&args[3..]).1.chunks_exact(4).map(|point| &point[..3]).collect();
        if points.iter().all(|point| *point == points[0]) {
            return Err("all points of `nurbs` are in the same place".into());
        }
        pieces(args).map(|_| ()).map_err(|fault| format!("`nurbs`: {fault}"))
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("nurbs", args, || {
            let pieces = pieces(args).unwrap_or_default();
            along(args[0], pieces.into_iter().flat_map(|piece| of_curve(&Rational(piece), args[0] * TOLERANCE)))
        })
    }
}

/// The curve as rational Bézier curves.
fn pieces(args: &[f64]) -> Result<Vec<Bezier<DVec4>>, String> {
    let (knots, points) = Knots::split(&args[3..]);
    let points = points.chunks_exact(4).map(weighted).collect();
    knots.spline(args[1], args[2] != 0.0, points).map(|spline| spline.beziers())
}

/// The point `(w x, w y, w z, w)` that the numbers x, y, z and w stand for.
pub(crate) fn weighted(point: &[f64]) -> DVec4 {
    (DVec3::from_slice(point) * point[3]).extend(point[3])
}
