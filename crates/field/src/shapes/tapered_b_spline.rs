//! Tube along a B-spline, whose radius changes as the curve does. It becomes arcs within a tolerance, along which the radius
//! changes evenly; the distance from these is exact outside.

use super::b_spline::{KNOTS, Knots, Knotted};
use super::tapered_tube::{TaperedWire, balls};
use crate::curve::BSpline;
use crate::remember::remembered;
use crate::shape_prelude::*;
use crate::tapers::{of_curves, rows};
use glam::DVec4;

/// See [`tapered_b_spline`].
#[derive(Clone, Copy, Debug)]
pub struct TaperedBSpline;

/// The descriptor of [`tapered_b_spline`].
pub static TAPERED_B_SPLINE: Shape = Shape::special::<TaperedBSpline>();

/// A tube along the B-spline of a degree with these control points x, y, z, radius and evenly spaced knots, from the first to the
/// last. `with("closed", ...)` closes it; [`Form::knots`] gives it other knots.
#[track_caller]
pub fn tapered_b_spline<V: Into<Value>>(degree: u32, points: impl IntoIterator<Item = [V; 4]>) -> Form<TaperedBSpline> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&TAPERED_B_SPLINE, [degree.into(), 0.into(), 0.into()].into_iter().chain(points))
}

impl Knotted for TaperedBSpline {}

impl Special for TaperedBSpline {
    type General = TaperedWire;

    const ABOUT: About = About {
        name: "tapered_b_spline",
        summary: "A round tube along a B-spline, whose radius changes.",
        params: &[
            Param::optional("degree", ParamKind::Count(1, 9), &[3.0], "The degree; there are more points than that."),
            Param::optional("closed", ParamKind::Flag, &[0.0], "Whether the curve goes around and closes."),
            KNOTS,
            Param::required(
                "points",
                ParamKind::Balls,
                "The control points [x, y, z, radius], in order: more than the degree. The radius is a B-spline, too.",
            ),
        ],
        elsewhere: &["sphere_sweep with b_spline", "B-spline with radii"],
        example: r#"{ "tapered_b_spline": { "closed": true, "points":
            [[-1, -0.8, 0.5, 0.05], [0, -1.2, -0.6, 0.4], [1, -0.8, 0.5, 0.1], [1.2, 0.9, -0.6, 0.45], [0, 0.4, 0.9, 0.05], [-1.2, 0.9, -0.6, 0.3]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let points = balls(Knots::split(&args[2..]).1);
        if points.iter().all(|point| point.truncate() == points[0].truncate()) {
            return Err("all points of `tapered_b_spline` are in the same place".into());
        }
        spline(args).map(|_| ()).map_err(|fault| format!("`tapered_b_spline`: {fault}"))
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("tapered_b_spline", args, || {
            let pieces = spline(args).map(|spline| spline.beziers());
            rows(&of_curves(&pieces.unwrap_or_default()))
        })
    }
}

fn spline(args: &[f64]) -> Result<BSpline<DVec4>, String> {
    let (knots, points) = Knots::split(&args[2..]);
    knots.spline(args[0], args[1] != 0.0, balls(points))
}
