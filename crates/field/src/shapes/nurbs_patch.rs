//! Sheet along a rational B-spline surface, which becomes triangles within a tolerance; the distance from these is exact outside.

use super::facets::{Facets, TOLERANCE, of_rows};
use super::spline_sheet::{CLOSED_U, CLOSED_V, DEGREE_U, DEGREE_V, KNOTS_U, KNOTS_V, KnottedSheet, Sheet, arguments};
use crate::shape_prelude::*;

/// See [`nurbs_patch`].
#[derive(Clone, Copy, Debug)]
pub struct NurbsSheet;

/// The descriptor of [`nurbs_patch`].
pub static NURBS_PATCH: Shape = Shape::special::<NurbsSheet>();

/// A sheet, this thick to both sides, along the rational B-spline surface with these rows of control points x, y, z and weights
/// above 0, evenly spaced knots, and degrees along u, which leads from row to row, and v, which leads along a row.
/// `with("closed_u", ...)` and `with("closed_v", ...)` close it; `with("knots_u", &[1.into()])` and the same along v make it of
/// rational Bézier patches; [`Form::knots_u`] and [`Form::knots_v`] give it other knots.
#[track_caller]
pub fn nurbs_patch<V: Into<Value>, R: IntoIterator<Item = [V; 4]>>(
    radius: impl Into<Value>,
    degrees: [u32; 2],
    rows: impl IntoIterator<Item = R>,
) -> Form<NurbsSheet> {
    Form::new(&NURBS_PATCH, arguments(radius.into(), degrees, of_rows(rows)))
}

impl KnottedSheet for NurbsSheet {}

impl Special for NurbsSheet {
    type General = Facets;

    const ABOUT: About = About {
        name: "nurbs_patch",
        summary: "A sheet along a rational B-spline surface, with round edges: also along parts of spheres and other quadrics.",
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
                ParamKind::WeightedNet,
                "The control points [x, y, z, weight]: a list of rows, each of them a list of points. Weights are above 0; the larger, \
                 the nearer the surface comes.",
            ),
        ],
        elsewhere: &["NURBS surface", "rational Bézier patch", "part of a sphere", "part of a quadric"],
        example: r#"{ "nurbs_patch": { "radius": 0.05, "degree_u": 2, "degree_v": 2, "knots_v": "pieces", "tolerance": 0.004, "points": [
            [[0, -0.9, 0, 1], [0.9, -0.9, 0, 0.70710678], [0.9, 0, 0, 1], [0.9, 0.9, 0, 0.70710678], [0, 0.9, 0, 1]],
            [[0, -0.9, 0.9, 0.70710678], [0.9, -0.9, 0.9, 0.5], [0.9, 0, 0.9, 0.70710678], [0.9, 0.9, 0.9, 0.5], [0, 0.9, 0.9, 0.70710678]],
            [[0, 0, 0.9, 1], [0, 0, 0.9, 0.70710678], [0, 0, 0.9, 1], [0, 0, 0.9, 0.70710678], [0, 0, 0.9, 1]] ] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        Sheet::of(args, ParamKind::WeightedNet).check("nurbs_patch")
    }

    fn general(args: &[f64]) -> Vec<f64> {
        Sheet::of(args, ParamKind::WeightedNet).facets("nurbs_patch", args)
    }
}
