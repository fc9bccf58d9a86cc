//! Tube along a Bézier curve, whose radius changes as the curve does. It becomes arcs within a tolerance, along which the radius
//! changes evenly; the distance from these is exact outside.

use super::bezier::MOST_POINTS;
use super::tapered_tube::{TaperedWire, balls};
use crate::curve::Bezier;
use crate::remember::remembered;
use crate::shape_prelude::*;
use crate::tapers::{of_curves, rows};

/// See [`tapered_bezier`].
#[derive(Clone, Copy, Debug)]
pub struct TaperedBezier;

/// The descriptor of [`tapered_bezier`].
pub static TAPERED_BEZIER: Shape = Shape::special::<TaperedBezier>();

/// A tube along the Bézier curve with these control points x, y, z, radius; its degree is one less than their number.
#[track_caller]
pub fn tapered_bezier<V: Into<Value>>(points: impl IntoIterator<Item = [V; 4]>) -> Form<TaperedBezier> {
    Form::new(&TAPERED_BEZIER, points.into_iter().flat_map(|point| point.map(Into::into)))
}

impl Special for TaperedBezier {
    type General = TaperedWire;

    const ABOUT: About = About {
        name: "tapered_bezier",
        summary: "A round tube along a Bézier curve, whose radius changes.",
        params: &[Param::required(
            "points",
            ParamKind::Balls,
            "The control points [x, y, z, radius], in order: two at least. The radius is a Bézier curve, too.",
        )],
        elsewhere: &["Bézier tube with radii", "sphere_sweep"],
        example: r#"{ "tapered_bezier": { "points":
            [[-1, -0.6, -0.4, 0.4], [-0.6, 1.8, 0.6, 0.1], [0.6, -1.8, 0.4, 0.5], [1, 0.6, -0.4, 0]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let points: Vec<&[f64]> = args.chunks_exact(4).map(|ball| &ball[..3]).collect();
        if points.len() < 2 || points.iter().all(|point| *point == points[0]) {
            return Err("`tapered_bezier` is a curve between two points at least".into());
        }
        if points.len() > MOST_POINTS {
            return Err(format!(
                "`tapered_bezier` may have at most {MOST_POINTS} points; a `tapered_b_spline` takes more"
            ));
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("tapered_bezier", args, || rows(&of_curves(&[Bezier::new(balls(args))])))
    }
}
