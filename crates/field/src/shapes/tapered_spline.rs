//! Tube along a smooth curve through points, whose radius changes as smoothly. It becomes arcs within a tolerance, along which the
//! radius changes evenly; the distance from these is exact outside.

use super::spline::pieces;
use super::tapered_tube::{TaperedTube, TaperedWire, balls};
use crate::curve::Bezier;
use crate::remember::remembered;
use crate::shape_prelude::*;
use crate::tapers::{of_curves, rows};
use glam::DVec4;

/// See [`tapered_spline`].
#[derive(Clone, Copy, Debug)]
pub struct TaperedSpline;

/// The descriptor of [`tapered_spline`].
pub static TAPERED_SPLINE: Shape = Shape::special::<TaperedSpline>();

/// A tube along a smooth curve through all points x, y, z, with the radius there. `with("closed", ...)` closes it.
#[track_caller]
pub fn tapered_spline<V: Into<Value>>(points: impl IntoIterator<Item = [V; 4]>) -> Form<TaperedSpline> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&TAPERED_SPLINE, [0.into()].into_iter().chain(points))
}

impl Special for TaperedSpline {
    type General = TaperedWire;

    const ABOUT: About = About {
        name: "tapered_spline",
        summary: "A round tube along a smooth curve through points, whose radius changes.",
        params: &[
            Param::optional(
                "closed",
                ParamKind::Flag,
                &[0.0],
                "Whether the curve leads from the last point back to the first.",
            ),
            Param::required(
                "points",
                ParamKind::Balls,
                "The points [x, y, z, radius] that it leads through: two at least. The radius changes as smoothly as the place.",
            ),
        ],
        elsewhere: &["sphere_sweep with cubic_spline", "Catmull-Rom spline with radii"],
        example: r#"{ "tapered_spline": { "points":
            [[-1, -0.6, -0.5, 0.03], [-0.8, 0.6, 0.4, 0.2], [-0.1, 0, -0.5, 0.08], [0.4, -0.6, 0.5, 0.25], [1, 0.6, 0, 0]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        TaperedTube::check(args).map_err(|fault| fault.replace("`tapered_tube`", "`tapered_spline`"))
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("tapered_spline", args, || {
            let curves = pieces(&balls(&args[1..]), args[0] != 0.0);
            rows(&of_curves(&curves.iter().map(without_negative).collect::<Vec<_>>()))
        })
    }
}

/// The same piece, but with radii that stop at 0 where they would swing below.
fn without_negative(curve: &Bezier<DVec4>) -> Bezier<DVec4> {
    Bezier::new(curve.points().iter().map(|ball| ball.with_w(ball.w.max(0.0))).collect())
}
