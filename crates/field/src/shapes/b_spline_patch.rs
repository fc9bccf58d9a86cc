//! Sheet along a B-spline surface, which becomes triangles within a tolerance; the distance from these is exact outside.

use super::facets::{Facets, TOLERANCE, of_rows};
use super::spline_sheet::{CLOSED_U, CLOSED_V, DEGREE_U, DEGREE_V, KNOTS_U, KNOTS_V, KnottedSheet, Sheet, arguments};
use crate::shape_prelude::*;

/// See [`b_spline_patch`].
#[derive(Clone, Copy, Debug)]
pub struct BSplineSheet;

/// The descriptor of [`b_spline_patch`].
pub static B_SPLINE_PATCH: Shape = Shape::special::<BSplineSheet>();

/// A sheet, this thick to both sides, along the B-spline surface with these rows of control points, evenly spaced knots, and
/// degrees along u, which leads from row to row, and v, which leads along a row. `with("closed_u", ...)` and `with("closed_v",
/// ...)` close it; [`Form::knots_u`] and [`Form::knots_v`] give it other knots.
#[track_caller]
pub fn b_spline_patch<V: Into<Value>, R: IntoIterator<Item = [V; 3]>>(
    radius: impl Into<Value>,
    degrees: [u32; 2],
    rows: impl IntoIterator<Item = R>,
) -> Form<BSplineSheet> {
    Form::new(&B_SPLINE_PATCH, arguments(radius.into(), degrees, of_rows(rows)))
}

impl KnottedSheet for BSplineSheet {}

impl Special for BSplineSheet {
    type General = Facets;

    const ABOUT: About = About {
        name: "b_spline_patch",
        summary: "A sheet along a B-spline surface, with round edges: near its control points, and smoother the higher its degrees.",
        params: &[
            Param::required(
                "radius",
                ParamKind::Positive,
                "Half of its thickness: all that is so near to the surface is within.",
            ),
            DEGREE_U,
            DEGREE_V,
            CLOSED_U,
            CLOSED_V,
            KNOTS_U,
            KNOTS_V,
            TOLERANCE,
            Param::required(
                "points",
                ParamKind::Net,
                "The control points [x, y, z]: a list of rows, each of them a list of points.",
            ),
        ],
        elsewhere: &["B-spline surface", "bspline surface", "spline patch"],
        example: r#"{ "b_spline_patch": { "radius": 0.05, "degree_u": 2, "closed_v": true, "tolerance": 0.004, "points": [
            [[0.6, 0, -1], [0, 0.6, -1], [-0.6, 0, -1], [0, -0.6, -1]],
            [[1.4, 0, -0.6], [0, 1.4, -0.4], [-1.4, 0, -0.6], [0, -1.4, -0.4]],
            [[0.4, 0, 0.4], [0, 0.4, 0.4], [-0.4, 0, 0.4], [0, -0.4, 0.4]],
            [[1.2, 0, 1], [0, 0.9, 0.9], [-1.2, 0, 1], [0, -0.9, 0.9]] ] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        Sheet::of(args, ParamKind::Net).check("b_spline_patch")
    }

    fn general(args: &[f64]) -> Vec<f64> {
        Sheet::of(args, ParamKind::Net).facets("b_spline_patch", args)
    }
}
