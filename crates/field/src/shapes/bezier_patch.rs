//! Sheet along a Bézier patch, which becomes triangles within a tolerance; the distance from these is exact outside.

use super::bezier::MOST_POINTS;
use super::facets::{Facets, TOLERANCE, along, check, of_rows, rows_of};
use crate::shape_prelude::*;
use crate::surface::BezierPatch;
use crate::triangles::Patches;
use glam::DVec4;

/// See [`bezier_patch`].
#[derive(Clone, Copy, Debug)]
pub struct BezierSheet;

/// The descriptor of [`bezier_patch`].
pub static BEZIER_PATCH: Shape = Shape::special::<BezierSheet>();

/// A sheet, this thick to both sides, along the Bézier patch with these rows of control points.
#[track_caller]
pub fn bezier_patch<V: Into<Value>, R: IntoIterator<Item = [V; 3]>>(
    radius: impl Into<Value>,
    rows: impl IntoIterator<Item = R>,
) -> Form<BezierSheet> {
    Form::new(&BEZIER_PATCH, [radius.into(), 0.into()].into_iter().chain(of_rows(rows)))
}

impl Special for BezierSheet {
    type General = Facets;

    const ABOUT: About = About {
        name: "bezier_patch",
        summary: "A sheet along a Bézier patch, with round edges.",
        params: &[
            Param::required(
                "radius",
                ParamKind::Positive,
                "Half of its thickness: all that is so near to the patch is within.",
            ),
            TOLERANCE,
            Param::required(
                "points",
                ParamKind::Net,
                "The control points [x, y, z]: a list of rows, each of them a list of points. Four rows of four make a bicubic patch.",
            ),
        ],
        elsewhere: &["bicubic_patch", "Bézier surface", "bilinear patch"],
        example: r#"{ "bezier_patch": { "radius": 0.06, "tolerance": 0.01, "points": [
            [[-1, -1, 0.3], [-0.3, -1, -0.6], [0.3, -1, 0.9], [1, -1, 0]],
            [[-1, -0.3, -0.4], [-0.3, -0.3, 1.4], [0.3, -0.3, 0.2], [1, -0.3, -0.3]],
            [[-1, 0.3, 0.5], [-0.3, 0.3, -0.8], [0.3, 0.3, -0.9], [1, 0.3, 0.6]],
            [[-1, 1, 0], [-0.3, 1, 0.6], [0.3, 1, -0.3], [1, 1, 0.4]] ] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let rows = rows_of(&args[BEFORE..], ParamKind::Net);
        if rows.len().max(rows[0].len()) > MOST_POINTS {
            return Err(format!(
                "`bezier_patch` may have at most {MOST_POINTS} points in each direction; a `b_spline_patch` takes more"
            ));
        }
        check("bezier_patch", Ok(patches(rows)), args[1])
    }

    fn general(args: &[f64]) -> Vec<f64> {
        along("bezier_patch", args, [args[0], args[1]], || Ok(patches(rows_of(&args[BEFORE..], ParamKind::Net))))
    }
}

/// How many arguments stand before the points.
const BEFORE: usize = 2;

/// The patch, as a surface of one.
fn patches(rows: Vec<Vec<DVec4>>) -> Patches {
    vec![vec![BezierPatch::new(rows)]]
}
