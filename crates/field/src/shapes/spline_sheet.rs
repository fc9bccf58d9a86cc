//! What sheets along B-spline surfaces have in common, whether these are rational or not.

use super::b_spline::Knots;
use super::facets::{along, check, rows_of};
use crate::shape_prelude::*;
use crate::surface::BSplinePatch;
use crate::triangles::Patches;
use glam::DVec4;

/// The degree along u.
pub(crate) const DEGREE_U: Param = Param::optional(
    "degree_u",
    ParamKind::Count(1, 9),
    &[3.0],
    "The degree along u, from row to row; there are more rows than that.",
);

/// The degree along v.
pub(crate) const DEGREE_V: Param = Param::optional(
    "degree_v",
    ParamKind::Count(1, 9),
    &[3.0],
    "The degree along v, along a row; there are more points in a row than that.",
);

/// Whether the last row is joined to the first.
pub(crate) const CLOSED_U: Param =
    Param::optional("closed_u", ParamKind::Flag, &[0.0], "Whether the surface goes around along u and closes.");

/// Whether the last point of each row is joined to the first.
pub(crate) const CLOSED_V: Param =
    Param::optional("closed_v", ParamKind::Flag, &[0.0], "Whether the surface goes around along v and closes.");

/// The knots along u.
pub(crate) const KNOTS_U: Param = Param::optional(
    "knots_u",
    ParamKind::Knots,
    &[0.0],
    "Where its pieces meet along u: `even` makes it as smooth as the degree allows; `pieces` makes it of Bézier patches, which pass \
     through the first row and each one that is as many further as the degree. Or a list of numbers that never fall: as many as there \
     are rows, the degree and 1 together, each at most the degree and 1 times; for a closed surface one more than there are rows.",
);

/// The knots along v.
pub(crate) const KNOTS_V: Param = Param::optional(
    "knots_v",
    ParamKind::Knots,
    &[0.0],
    "Where its pieces meet along v, as `knots_u`; in place of rows count the points of a row.",
);

/// The arguments of an open sheet with knots at equal distances and the usual tolerance, by those of its net.
pub(crate) fn arguments(radius: Value, [degree_u, degree_v]: [u32; 2], net: Vec<Value>) -> impl Iterator<Item = Value> {
    let [closed_u, closed_v, knots_u, knots_v, tolerance] = [0; 5].map(Value::from);
    let before = [radius, degree_u.into(), degree_v.into(), closed_u, closed_v, knots_u, knots_v, tolerance];
    before.into_iter().chain(net)
}

/// A sheet that takes knots in both directions.
pub trait KnottedSheet: Special {}

impl<S: KnottedSheet> Form<S> {
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

/// A B-spline surface and the radius and tolerance of the sheet along it.
#[derive(Debug)]
pub(crate) struct Sheet<'a> {
    radius: f64,
    degrees: [f64; 2],
    is_closed: [bool; 2],
    knots: [Knots<'a>; 2],
    tolerance: f64,
    rows: Vec<Vec<DVec4>>,
}

impl<'a> Sheet<'a> {
    /// The sheet of these arguments, each sound by itself, with a net of this kind.
    pub(crate) fn of(args: &'a [f64], net: ParamKind) -> Self {
        let &[radius, degree_u, degree_v, closed_u, closed_v, ref rest @ ..] = args else {
            unreachable!("five numbers, knots and points")
        };
        let (knots_u, rest) = Knots::split(rest);
        let (knots_v, rest) = Knots::split(rest);
        Self {
            radius,
            degrees: [degree_u, degree_v],
            is_closed: [closed_u != 0.0, closed_v != 0.0],
            knots: [knots_u, knots_v],
            tolerance: rest[0],
            rows: rows_of(&rest[1..], net),
        }
    }

    /// What is wrong with the sheet of this name.
    ///
    /// # Errors
    /// The fault.
    pub(crate) fn check(&self, name: &str) -> Result<(), String> {
        check(name, self.patches(), self.tolerance)
    }

    /// The arguments of the triangles that stand for the sheet of this name with these arguments.
    pub(crate) fn facets(&self, name: &'static str, args: &[f64]) -> Vec<f64> {
        along(name, args, [self.radius, self.tolerance], || self.patches())
    }

    /// The surface in patches.
    fn patches(&self) -> Result<Patches, String> {
        let spline = |direction: usize, points: Vec<DVec4>| {
            let spline = self.knots[direction].spline(self.degrees[direction], self.is_closed[direction], points);
            spline.map_err(|fault| format!("along {}, {fault}", ["u", "v"][direction]))
        };
        let rows = self.rows.iter().map(|row| spline(1, row.clone())).collect::<Result<Vec<_>, _>>()?;
        // Of closed surfaces, rows and columns have their first points again at their ends.
        let column = |index: usize| rows.iter().map(|row| row.points()[index]).collect();
        let columns = 0..rows[0].points().len();
        let columns = columns.map(|index| spline(0, column(index))).collect::<Result<Vec<_>, _>>()?;
        let row = |index: usize| columns.iter().map(|column| column.points()[index]).collect();
        let net = (0..columns[0].points().len()).map(row).collect();
        let knots = [columns[0].knots().to_vec(), rows[0].knots().to_vec()];
        Ok(BSplinePatch::new([columns[0].degree(), rows[0].degree()], knots, net)?.beziers())
    }
}
