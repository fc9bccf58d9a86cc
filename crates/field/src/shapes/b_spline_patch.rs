//! Sheet along a B-spline surface, which becomes triangles within a tolerance; the distance from these is exact outside.

use super::facets::{Facets, TOLERANCE, of_rows};
use super::spline_sheet::{CLOSED_U, CLOSED_V, DEGREE_U, DEGREE_V, KNOTS_U, KNOTS_V, Sheet};
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
    [degree_u, degree_v]: [u32; 2],
    rows: impl IntoIterator<Item = R>,
) -> Form<BSplineSheet> {
    let [closed_u, closed_v, knots_u, knots_v, tolerance] = [0; 5].map(Value::from);
    let before = [radius.into(), degree_u.into(), degree_v.into(), closed_u, closed_v, knots_u, knots_v, tolerance];
    Form::new(&B_SPLINE_PATCH, before.into_iter().chain(of_rows(rows)))
}

impl Form<BSplineSheet> {
    /// Gives it knots along u that never fall: as many as there are rows, the degree and 1 together, none of them more than the
    /// degree and 1 times. If it is closed along u, those of one round: one more than there are rows.
    #[must_use]
    pub fn knots_u<V: Into<Value>>(self, knots: impl IntoIterator<Item = V>) -> Self {
        self.with_knots("knots_u", knots)
    }

    /// As [`Form::knots_u`] along v, where the points of a row count.
    #[must_use]
    pub fn knots_v<V: Into<Value>>(self, knots: impl IntoIterator<Item = V>) -> Self {
        self.with_knots("knots_v", knots)
    }
}

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
