//! Figure within closed lines of straight edges and arcs. Exact.
//!
//! The nearest of all edges gives the distance. The side is that of the polygon with the same corners, and the other one between
//! an arc and its chord: both ask on which side of the chord a point lies in the same way, so that nothing shows where they meet.

use super::polygon::crosses;
use crate::arcs3::is_arc;
use crate::fill::components;
use crate::remember::remembered;
use crate::scalar::Mask;
use crate::shape_prelude::*;

/// See [`outline`].
#[derive(Clone, Copy, Debug)]
pub struct Outline;

/// The descriptor of [`outline`].
pub static OUTLINE: Shape = Shape::primitive::<Outline>();

/// The figure within closed lines: of each the corners x, y, and the angle in radians by which the edge to the next corner turns
/// to the left, 0 for a straight one. What lies inside of an even number of lines is outside.
#[track_caller]
pub fn outline(contours: impl IntoIterator<Item = Vec<[f64; 3]>>) -> Form<Outline> {
    Form::new(&OUTLINE, contours.into_iter().flat_map(|contour| closed(&contour)).map(Value::from))
}

/// The arguments for one closed line.
pub(crate) fn closed(corners: &[[f64; 3]]) -> Vec<f64> {
    let last = corners.len().wrapping_sub(1);
    let corner = |(index, &[x, y, turn]): (usize, &[f64; 3])| [x, y, turn, f64::from(u8::from(index == last))];
    corners.iter().enumerate().flat_map(corner).collect()
}

/// An edge: both ends, and the angle it turns by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub(crate) from: DVec2,
    pub(crate) to: DVec2,
    pub(crate) turn: f64,
}

/// The edges of all lines.
pub(crate) fn edges(args: &[f64]) -> Vec<Edge> {
    let corners: Vec<&[f64]> = args.chunks_exact(4).collect();
    let mut edges = Vec::with_capacity(corners.len());
    let mut first = 0;
    for (index, corner) in corners.iter().enumerate() {
        let ends = corner[3] != 0.0 || index + 1 == corners.len();
        let next = if ends { first } else { index + 1 };
        edges.push(Edge { from: DVec2::from_slice(corner), to: DVec2::from_slice(corners[next]), turn: corner[2] });
        if ends {
            first = index + 1;
        }
    }
    edges
}

impl Edge {
    /// The length of its chord.
    pub(crate) fn length(self) -> f64 {
        self.from.distance(self.to)
    }

    /// The point half way along it.
    pub(crate) fn middle(self) -> DVec2 {
        let chord = self.to - self.from;
        (self.from + self.to) / 2.0 - chord.perp() / 2.0 * libm::tan(self.turn / 4.0)
    }

    /// The direction to its left, half way along it.
    pub(crate) fn normal(self) -> DVec2 {
        (self.to - self.from).perp().normalize_or(DVec2::X)
    }

    /// Of an arc its centre and radius.
    pub(crate) fn circle(self) -> Option<(DVec2, f64)> {
        let chord = self.to - self.from;
        if self.turn == 0.0 || chord == DVec2::ZERO {
            return None;
        }
        let half = self.turn / 2.0;
        // The centre lies to the left of an arc that turns left by less than half a turn.
        let centre = (self.from + self.to) / 2.0 + chord.perp() / (2.0 * libm::tan(half));
        Some((centre, chord.length() / (2.0 * libm::sin(half)).abs()))
    }

    /// The largest of `direction . p` over its points; the direction has length 1.
    pub(crate) fn support(self, direction: DVec2) -> f64 {
        let ends = self.from.dot(direction).max(self.to.dot(direction));
        let Some((centre, radius)) = self.circle() else { return ends };
        // Of the circle, the arc has what lies beyond the chord on its right, or on its left if it turns right.
        let farthest = centre + direction * radius;
        let beyond = (self.to - self.from).perp_dot(farthest - self.from) * self.turn;
        if beyond <= 0.0 { ends.max(farthest.dot(direction)) } else { ends }
    }

    /// Both ends; the normal of the chord, towards the arc if it is one; sine and cosine of half the angle that it turns by; and
    /// the radius, 0 for a straight edge.
    pub(crate) fn constants(self) -> [f64; ROW] {
        let chord = self.to - self.from;
        let right = if chord == DVec2::ZERO { DVec2::X } else { -chord.perp().normalize() };
        let ends = [self.from.x, self.from.y, self.to.x, self.to.y];
        let (normal, (sin, cos), radius) = match self.circle() {
            Some((_, radius)) => (right * self.turn.signum(), libm::sincos(self.turn.abs() / 2.0), radius),
            None => (right, (0.0, 1.0), 0.0),
        };
        [ends[0], ends[1], ends[2], ends[3], normal.x, normal.y, sin, cos, radius]
    }
}

/// What stands in place of 1 at the last corner of the last line of a group.
const GROUP_ENDS: f64 = 2.0;

/// Lines that come nearer to each other than this share of the figure's size count as crossing.
const APART: f64 = 1e-5;

/// The arguments in an order in which the lines of each part of the figure follow one another.
fn grouped(args: &[f64]) -> Vec<f64> {
    remembered("outline", args, || {
        let size = args.chunks_exact(4).flat_map(|corner| [corner[0].abs(), corner[1].abs()]).fold(0.0, f64::max);
        let mut groups = components(args, size * APART);
        for end in groups.iter_mut().filter_map(|group| group.last_mut()) {
            *end = GROUP_ENDS;
        }
        groups.concat()
    })
}

/// How many constants an edge has.
pub(crate) const ROW: usize = 9;

impl Primitive for Outline {
    const ABOUT: About = About {
        name: "outline",
        summary: "A plane figure within closed lines of straight edges and arcs; lines within others are holes.",
        params: &[Param::required(
            "corners",
            ParamKind::Contours,
            "The corners [x, y] of the line, one after another; or [x, y, angle], after which an arc follows that turns to the \
             left by this angle in degrees (to the right if it is negative). Several lines are a list of such lists.",
        )],
        elsewhere: &["sketch", "path", "sdPolygon with holes", "rounded_x", "joint", "quad_circle"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "outline": { "corners": [
            [[-0.9, -0.5], [0.5, -0.5, 180], [0.5, 0.5], [-0.9, 0.5, -120]],
            [[0.25, 0, 180], [0.75, 0, 180]] ] } } } }"#,
    };

    const DIMENSION: Dimension = Dimension::Plane;

    fn check(args: &[f64]) -> Result<(), String> {
        if args.last() != Some(&1.0) {
            return Err("the last corner of `outline` does not end a line".into());
        }
        let (mut corners, mut is_round) = (0, false);
        for (index, (edge, corner)) in edges(args).iter().zip(args.chunks_exact(4)).enumerate() {
            if edge.from == edge.to {
                return Err(format!("corner {} of `outline` and the next one are the same", index + 1));
            }
            corners += 1;
            is_round |= edge.turn != 0.0;
            if corner[3] != 0.0 {
                if corners < 3 && !is_round {
                    return Err("a line of `outline` with fewer than three corners has no arc".into());
                }
                (corners, is_round) = (0, false);
            }
        }
        Ok(())
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        edges(&grouped(args)).into_iter().flat_map(Edge::constants).collect()
    }

    fn parts(args: &[f64]) -> Vec<usize> {
        let grouped = grouped(args);
        let corners: Vec<&[f64]> = grouped.chunks_exact(4).collect();
        corners.split_inclusive(|corner| corner[3] == GROUP_ENDS).map(|group| group.len() * ROW).collect()
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        in_plane(direction, |across| {
            let unit = direction.truncate() / across;
            let farthest = edges(args).into_iter().map(|edge| edge.support(unit)).fold(f64::NEG_INFINITY, f64::max);
            across * (farthest + level)
        })
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let (zero, one) = (p.x.lift(0.0), p.x.lift(1.0));
        let [ax, ay] = c.get();
        let [least, side, other_side] = S::fold_rows(
            c,
            ROW,
            [S::length2(p.x - ax, p.y - ay), one, one],
            #[inline(always)]
            |[least, side, other_side], edge| {
                let [ax, ay, bx, by, nx, ny, sin, cos, radius] = edge.get();
                let (ex, ey) = (ax - bx, ay - by);
                // From the middle of the chord: along it, never mind in which direction, and across it, towards the arc.
                let (mx, my) = (p.x - (ax + bx) * 0.5, p.y - (ay + by) * 0.5);
                let along = (mx * ny - my * nx).abs();
                let across = mx * nx + my * ny;
                let half = (ex * ny - ey * nx).abs() * 0.5;
                // Above 0 where neither end is nearest: where the angle from the middle of the arc is less than half of what it
                // turns by.
                let is_between = zero.lt(sin * across + cos * (half - along));
                let to_centre = radius * cos;
                // The square of the distance from the centre, less that of the radius, without a difference of large numbers.
                let excess = (along - half) * (along + half) + across * (across + to_centre * 2.0);
                let is_arc = is_arc(radius);
                let gap = S::select(is_arc, excess / (S::length2(along, across + to_centre) + radius), across);
                let distance = S::select(is_between, gap.abs(), S::length2(along - half, across));

                let (wx, wy) = (p.x - bx, p.y - by);
                let (one_way, other_way) = (ey * wx, ex * wy);
                // A point at the height of a corner counts as above it, and so does one on a horizontal chord.
                let is_right = is_less(one_way, other_way, zero.lt(ex));
                let is_right_too = is_less(one_way, other_way, ey.lt(zero));
                let bulges_right = (nx * ey).lt(ny * ex);
                let is_on_circle = is_arc & excess.lt(zero);
                let flips =
                    either(crosses(p.y.lt(by), p.y.lt(ay), is_right), is_on_circle & !either(is_right, bulges_right));
                let flips_too = either(
                    crosses(p.x.lt(bx), p.x.lt(ax), !is_right_too),
                    is_on_circle & !either(is_right_too, bulges_right),
                );
                [least.min(distance), S::select(flips, -side, side), S::select(flips_too, -other_side, other_side)]
            },
        );
        side.agreed(other_side) * least
    }
}

/// Whether one number is less than another one, or is the same if that counts as less.
#[inline(always)]
fn is_less<S: Scalar>(a: S, b: S, does_same: S::Mask) -> S::Mask {
    a.lt(b) | (does_same & !b.lt(a))
}

/// Whether just one of two is true.
#[inline(always)]
fn either<M: Mask>(a: M, b: M) -> M {
    (a & !b) | (!a & b)
}
