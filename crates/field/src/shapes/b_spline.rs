//! Tube along a B-spline, whose pieces become arcs within a tolerance; the distance from these is exact outside.

use super::tube::{TOLERANCE, Wire, along};
use crate::arcs3::of_curve;
use crate::curve::{BSpline, Point};
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`b_spline`].
#[derive(Clone, Copy, Debug)]
pub struct BSplineTube;

/// The descriptor of [`b_spline`].
pub static B_SPLINE: Shape = Shape::special::<BSplineTube>();

/// A tube along the B-spline of a degree with these control points and evenly spaced knots, from the first to the last.
/// `with("closed", ...)` closes it; [`Form::knots`] gives it other knots.
#[track_caller]
pub fn b_spline<V: Into<Value>>(
    radius: impl Into<Value>,
    degree: u32,
    points: impl IntoIterator<Item = [V; 3]>,
) -> Form<BSplineTube> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&B_SPLINE, [radius.into(), degree.into(), 0.into(), 0.into()].into_iter().chain(points))
}

impl Knotted for BSplineTube {}

/// A curve that takes knots.
pub trait Knotted: Special {}

impl<S: Knotted> Form<S> {
    /// Gives it knots that never fall: as many as there are points, the degree and 1 together, none of them more than the degree
    /// and 1 times. If it is closed, those of one round: one more than there are points.
    #[must_use]
    pub fn knots<V: Into<Value>>(self, knots: impl IntoIterator<Item = V>) -> Self {
        self.with_knots("knots", knots)
    }
}

/// Where the pieces of a spline meet.
pub(crate) const KNOTS: Param = Param::optional(
    "knots",
    ParamKind::Knots,
    &[0.0],
    "Where its pieces meet: `even` makes it as smooth as the degree allows; `pieces` is a chain of Bézier curves, which begins at \
     the first point and passes each time through the one that is as many further as the degree. Or a list of numbers that never \
     fall: as many as there are points, the degree and 1 together, each at most the degree and 1 times; for a closed curve one more \
     than there are points.",
);

impl Special for BSplineTube {
    type General = Wire;

    const ABOUT: About = About {
        name: "b_spline",
        summary: "A round tube along a B-spline: near its control points, and smoother the higher its degree.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the tube."),
            Param::optional("degree", ParamKind::Count(1, 9), &[3.0], "The degree; there are more points than that."),
            Param::optional("closed", ParamKind::Flag, &[0.0], "Whether the curve goes around and closes."),
            KNOTS,
            Param::required(
                "points",
                ParamKind::Points3,
                "The control points [x, y, z], in order: more than the degree.",
            ),
        ],
        elsewhere: &["B-spline", "bspline", "non-uniform B-spline", "NURBS with equal weights"],
        example: r#"{ "b_spline": { "radius": 0.15, "closed": true, "points":
            [[-1, -0.8, 0.5], [0, -1.2, -0.6], [1, -0.8, 0.5], [1.2, 0.9, -0.6], [0, 0.4, 0.9], [-1.2, 0.9, -0.6]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let spline = spline(args).map_err(|fault| format!("`b_spline`: {fault}"))?;
        if spline.points().iter().all(|point| *point == spline.points()[0]) {
            return Err("all points of `b_spline` are the same".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("b_spline", args, || {
            let pieces = spline(args).map(|spline| spline.beziers()).unwrap_or_default();
            along(args[0], pieces.iter().flat_map(|piece| of_curve(piece, args[0] * TOLERANCE)))
        })
    }
}

fn spline(args: &[f64]) -> Result<BSpline<DVec3>, String> {
    let (knots, points) = Knots::split(&args[3..]);
    knots.spline(args[1], args[2] != 0.0, points.chunks_exact(3).map(DVec3::from_slice).collect())
}

/// The knots of a spline: see [`ParamKind::Knots`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Knots<'a> {
    /// At equal distances.
    Even,
    /// Each piece is a Bézier curve of its own.
    Pieces,
    /// These.
    Listed(&'a [f64]),
}

impl<'a> Knots<'a> {
    /// The knots that some sound arguments begin with, and the arguments after these.
    pub(crate) fn split(args: &'a [f64]) -> (Self, &'a [f64]) {
        let (first, rest) = (args[0] as usize, &args[1..]);
        match first.checked_sub(ParamKind::KNOTS.len()) {
            Some(count) => (Self::Listed(&rest[..count]), &rest[count..]),
            None if first == 0 => (Self::Even, rest),
            None => (Self::Pieces, rest),
        }
    }

    /// The spline of a degree with these control points.
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn spline<P: Point>(
        self,
        degree: f64,
        is_closed: bool,
        mut points: Vec<P>,
    ) -> Result<BSpline<P>, String> {
        let degree = degree as usize;
        match self {
            Self::Even if is_closed => BSpline::closed(degree, &points),
            Self::Even => BSpline::clamped(degree, points),
            Self::Listed(knots) if is_closed => BSpline::closed_with(degree, knots, &points),
            Self::Listed(knots) => BSpline::new(degree, knots.to_vec(), points),
            Self::Pieces => {
                points.extend(is_closed.then_some(points[0]));
                let count = points.len() - 1;
                if count == 0 || !count.is_multiple_of(degree) {
                    let more = if is_closed { "" } else { " and one more" };
                    return Err(format!(
                        "a chain of pieces of degree {degree} has a multiple of {degree} points{more}"
                    ));
                }
                // Each as often as the degree, and at both ends once more.
                let knots =
                    (0..count + degree + 2).map(|index| (index.saturating_sub(1) / degree).min(count / degree) as f64);
                BSpline::new(degree, knots.collect(), points)
            }
        }
    }
}
