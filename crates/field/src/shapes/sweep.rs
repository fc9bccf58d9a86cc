//! Sweep of a plane figure along a curve, which turns less sharply than the figure is wide. Exact outside where the figure is.
//!
//! The curve becomes arcs within a tolerance. The figure stands at a right angle to it and turns about it no more than it must
//! (Bishop, "There is more than one way to frame a curve", 1975). Along an arc such a frame turns about the arc's axis alone: each
//! arc sweeps part of a body of revolution, each straight piece an extrusion.
//!
//! Where one goes over into the next, neither has an end: within, a piece is as deep as the curve's ends are far away at least,
//! which grows from piece to piece and goes over from each into the next one.

use super::b_spline::Knots;
use super::plane::PLANE;
use super::product;
use super::spline;
use super::tube::joints;
use crate::arcs3::{self, Arc3, is_arc, of_curve};
use crate::curve::Bezier;
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`Sweep::sweep`].
#[derive(Clone, Copy, Debug)]
pub struct Sweeping;

/// The descriptor of [`Sweep::sweep`].
pub static SWEEP: Shape = Shape::product::<Sweeping>();

/// Making a body of a plane figure that moves along a curve.
pub trait Sweep: Into<Field> {
    /// What the figure sweeps when it moves, at a right angle, along a smooth curve through points. `with("up", ...)` says where its
    /// y axis points at the beginning, `with("curve", ...)` what the points are, and `with("closed", ...)` closes the curve.
    #[track_caller]
    fn sweep<V: Into<Value>>(self, points: impl IntoIterator<Item = [V; 3]>) -> Field {
        let before = [SPLINE, 0.0, 0.0, 0.0, 1.0].map(Value::from);
        let points = points.into_iter().flat_map(|point| point.map(Into::into));
        Field::new(&SWEEP, before.into_iter().chain(points), [self.into()])
    }
}

impl<F: Into<Field>> Sweep for F {}

/// What the points are: those that the curve leads through, or control points.
const CURVES: &[&str] = &["spline", "b_spline", "bezier"];
const SPLINE: f64 = 0.0;
const B_SPLINE: f64 = 1.0;

/// Of B-splines.
const DEGREE: usize = 3;

/// How many arguments stand before the points.
const BEFORE: usize = 5;

/// Arcs are within this share of the size of all points from the curve that they stand for.
const TOLERANCE: f64 = 1e-4;

/// How many constants a piece has: those of its arc, and cosine and sine of the angle from the direction across the arc to the
/// figure's x axis; then, for its beginning and for its end, -1 if the curve has an end there, or a corner, and otherwise how far
/// both pieces overlap there at least; and how far away, at least, all of the piece's beginning and all of its end are from what
/// lies before the beginning, and from what comes after the end.
const ROW: usize = arcs3::ROW + 8;

/// A figure reaches from the curve inwards by this share of the curve's radius at most.
const MOST_INWARD: f64 = 0.9;

/// Where pieces go on they count as longer by this share of the largest coordinate of the curve: enough that small boxes lie within
/// one of both, and little enough that what both differ by there, about the square of it over the radius of the curve, is nothing.
const OVERLAP: f64 = 1e-4;

/// Around a closed curve the figure may be turned by so much less than once: rounding errors.
const MOST_TWIST: f64 = 1e-4;

impl Combine for Sweeping {
    const ABOUT: About = About {
        name: "sweep",
        summary: "Makes a body of a plane figure that moves along a curve, at a right angle to it, and turns about it no more than \
                  it must.",
        params: &[
            Param::optional(
                "curve",
                ParamKind::Choice(CURVES),
                &[SPLINE],
                "What the points are: those that a smooth curve leads through, or control points of a cubic B-spline or of a \
                 Bézier curve.",
            ),
            Param::optional(
                "closed",
                ParamKind::Flag,
                &[0.0],
                "Whether the curve leads from its end back to its beginning.",
            ),
            Param::optional(
                "up",
                ParamKind::Direction,
                &[0.0, 0.0, 1.0],
                "Where the figure's y axis points at the beginning, as nearly as it can at a right angle to the curve.",
            ),
            Param::required("points", ParamKind::Points3, "The points [x, y, z]: two at least."),
        ],
        elsewhere: &["sweep along a curve", "path extrude", "follow me", "extrude along a spline", "loft along a path"],
        example: r#"{ "sweep": { "points": [[0.8, -0.4, -0.5], [0.7, 0.5, -0.4], [-0.1, 0.8, -0.2], [-0.8, 0.2, 0], [-0.5, -0.6, 0.2],
            [0.3, -0.6, 0.4], [0.5, 0.1, 0.6]], "shape": { "star": { "tips": 5, "outer": 0.2, "inner": 0.1 } } } }"#,
    };

    const HULL: Hull = Hull::Common;

    fn prepare(_args: &[f64]) -> Vec<f64> {
        Vec::new()
    }

    fn contract(_args: &[f64], figure: Contract, _range: Contract) -> Result<Contract, String> {
        product::contract(figure)
    }

    fn settle(figure: Interval, range: Interval, _constants: &[f64]) -> Settled {
        product::settle(figure, range)
    }

    #[inline(always)]
    fn combine<S: Scalar>(figure: S, range: S, _c: &Constants<'_, S>) -> S {
        if S::IS_ENCLOSURE {
            // Over the border of a piece, its depth is not known. What is outside of both is known from each by itself.
            let zero = figure.lift(0.0);
            return S::length2(figure.max(zero), range.max(zero)) + zero.min(figure.max(range));
        }
        product::distance(figure, range)
    }

    /// All of it looks as the figure does.
    #[inline(always)]
    fn share<S: Scalar>(figure: S, _range: S, _c: &Constants<'_, S>) -> S {
        figure.lift(0.0)
    }
}

impl Product for Sweeping {
    const FRAME: Option<MapTable> = Some(MapTable::of::<Self>());

    fn parts(args: &[f64]) -> usize {
        rows(args).len() / ROW
    }

    /// All that is not beyond an end.
    fn range(_args: &[f64]) -> RangeCall {
        (&PLANE, vec![0.0, 0.0, 1.0, 0.0])
    }
}

/// The frame of one piece: where a point lies in the plane of the figure, and how far beyond the nearer end of the piece; between both,
/// how deep.
impl Map for Sweeping {
    const ABOUT: About = <Self as Combine>::ABOUT;

    const TAKES: Dimension = Dimension::Plane;

    /// The constants of all pieces.
    fn prepare(args: &[f64]) -> Vec<f64> {
        rows(args)
    }

    fn contract(args: &[f64], figure: Contract, reach: Supports<'_>) -> Result<Contract, String> {
        check(args)?;
        let rows = rows(args);
        if rows.is_empty() {
            return Err("the curve of `sweep` has no length".into());
        }
        let twist = twist(args);
        if twist.abs() > MOST_TWIST {
            let degrees = twist.to_degrees().abs();
            return Err(format!(
                "the figure of `sweep` comes back turned by {degrees:.1} degrees, since the closed curve lies in no plane; leave it \
                 open, or move some points"
            ));
        }
        for row in rows.chunks_exact(ROW) {
            let [radius, cos, sin] = [row[arcs3::ROW - 1], row[arcs3::ROW], row[arcs3::ROW + 1]];
            let inward = reach(DVec3::new(-cos, sin, 0.0));
            if radius > 0.0 && inward > radius * MOST_INWARD {
                return Err(format!(
                    "the curve of `sweep` turns too sharply for its figure, which reaches {inward:.3} inwards where the radius of the \
                     curve is {radius:.3}, of which {MOST_INWARD} are possible: bend it less, or take a smaller figure"
                ));
            }
        }
        Ok(Contract { inside: figure.at_most_bound().inside, ..figure })
    }

    fn support(args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        rows(args).chunks_exact(ROW).map(|row| support(row, direction, reach)).fold(f64::NEG_INFINITY, f64::max)
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [mx, my, mz, ux, uy, uz, nx, ny, nz, half, sin, cos, radius] = c.get();
        let [cos_turn, sin_turn, begins, ends] = c.part(arcs3::ROW, 4).get();
        let (q, u, n) = (p - vec3(mx, my, mz), vec3(ux, uy, uz), vec3(nx, ny, nz));
        let zero = p.x.lift(0.0);
        let (along, across) = (q.dot(u), q.dot(n));
        let out = q.dot(vec3(uy * nz - uz * ny, uz * nx - ux * nz, ux * ny - uy * nx));
        // How far before the plane at the beginning, and how far beyond that at the end.
        let (before, after) = (-(along + half) * cos - across * sin, (along - half) * cos - across * sin);
        // From the arc, between its ends; in the plane of the nearer end, beyond it.
        let past = along.abs() - half;
        let is_arc = is_arc(radius);
        let beside = across * cos + past * sin;
        let is_near_side = zero.lt(S::select(is_arc, beside + radius, radius.lift(1.0)));
        let is_between = before.lt(begins.max(zero)) & after.lt(ends.max(zero)) & is_near_side;
        let to_centre = radius * cos;
        let excess = past * (along.abs() + half) + across * (across + to_centre * 2.0);
        let gap = S::select(is_arc, excess / (S::length2(along, across + to_centre) + radius), across);
        let x = S::select(is_between, gap, beside);
        // At an end of the curve, which is not away, depth goes over into height. Where the curve goes on, so does depth, as far as
        // both pieces overlap.
        let [before_begin, before_end, after_begin, after_end] = c.part(arcs3::ROW + 4, 4).get();
        let from_begin = before - S::select(before.lt(begins), before_begin, zero);
        let from_end = after - S::select(after.lt(ends), after_end, zero);
        let depth = from_begin.max(from_end).max(-before_end).max(-after_begin);
        vec3(x * cos_turn + out * sin_turn, out * cos_turn - x * sin_turn, depth)
    }
}

/// What is wrong with some arguments, as a sentence.
fn check(args: &[f64]) -> Result<(), String> {
    let points: Vec<&[f64]> = args[BEFORE..].chunks_exact(3).collect();
    let (curve, is_closed) = (args[0], args[1] != 0.0);
    if points.len() < 2 {
        return Err("`sweep` has fewer than two points".into());
    }
    if is_closed && curve > B_SPLINE {
        return Err("a Bézier curve can't be closed; `\"curve\": \"b_spline\"` can".into());
    }
    if is_closed && points.len() < 3 {
        return Err("a closed `sweep` has three points at least".into());
    }
    if curve == B_SPLINE && points.len() <= DEGREE {
        return Err(format!("a cubic B-spline has {} points at least", DEGREE + 1));
    }
    if curve != SPLINE {
        return Ok(());
    }
    match points.windows(2).position(|pair| pair[0] == pair[1]) {
        Some(index) => Err(format!("point {} of `sweep` and the next one are the same", index + 1)),
        None => Ok(()),
    }
}

/// The arcs that stand for the curve.
fn arcs(args: &[f64]) -> Vec<Arc3> {
    let points: Vec<DVec3> = args[BEFORE..].chunks_exact(3).map(DVec3::from_slice).collect();
    let corner = |pick: fn(DVec3, DVec3) -> DVec3| points.iter().copied().reduce(pick).unwrap_or_default();
    let tolerance = corner(DVec3::max).distance(corner(DVec3::min)) * TOLERANCE;
    let is_closed = args[1] != 0.0;
    let pieces: Vec<Bezier<DVec3>> = match args[0] {
        SPLINE => spline::pieces(&points, is_closed),
        B_SPLINE => Knots::Even.spline(DEGREE as f64, is_closed, points).expect("there are enough points").beziers(),
        _ => vec![Bezier::new(points)],
    };
    pieces.iter().flat_map(|piece| of_curve(piece, tolerance)).collect()
}

/// The constants of all pieces and ends.
fn rows(args: &[f64]) -> Vec<f64> {
    remembered("sweep", args, || {
        if check(args).is_err() {
            return Vec::new();
        }
        let arcs = arcs(args);
        let mut joints = joints(&arcs, OVERLAP);
        if let (true, [first, .., last]) = (args[1] == 0.0, &mut joints[..]) {
            // Even if it comes back to where it began, as the figure may be turned there.
            (first[0], last[1]) = (-1.0, -1.0);
        }
        let frames = frames(&arcs, DVec3::from_slice(&args[2..BEFORE]));
        let depths = depths(&arcs, &joints);
        let pieces = arcs.iter().zip(frames).zip(joints.into_iter().zip(depths));
        pieces.flat_map(|((arc, frame), (joints, depths))| row(arc, frame[0], joints, depths)).collect()
    })
}

/// The constants of a piece along an arc at whose beginning the figure's x axis points to `x`.
fn row(arc: &Arc3, x: DVec3, joints: [f64; 2], depths: [f64; 4]) -> impl Iterator<Item = f64> {
    let constants = arc.constants();
    let (along, across) = (DVec3::from_slice(&constants[3..]), DVec3::from_slice(&constants[6..]));
    let [sin, cos] = [constants[arcs3::HALF + 1], constants[arcs3::HALF + 2]];
    let outward = across * cos - along * sin;
    let turn = DVec2::new(x.dot(outward), x.dot(along.cross(across))).normalize_or(DVec2::X);
    constants.into_iter().chain([turn.x, turn.y]).chain(joints).chain(depths)
}

/// How far the beginning and the end of each piece are at least from the curve's beginning, or the corner, that lies before them;
/// and from its end, or the corner, that comes after them.
fn depths(arcs: &[Arc3], joints: &[[f64; 2]]) -> Vec<[f64; 4]> {
    // Through each piece: between the planes of its ends, where the figure reaches inwards most.
    let through = |arc: &Arc3| match arc.constants()[arcs3::ROW - 1] {
        radius if radius > 0.0 => radius * (1.0 - MOST_INWARD) * libm::sin(2.0 * arc.half_turn()),
        _ => arc.length(),
    };
    let through: Vec<f64> = arcs.iter().map(through).collect();
    // What has no end is deeper than any figure that fits along it. Around closed curves the second time tells what corners change.
    let endless: f64 = arcs.iter().map(Arc3::length).sum();
    let walk = |order: &mut dyn Iterator<Item = usize>, side: usize| {
        let mut depth = endless;
        let mut depths = vec![[0.0; 2]; arcs.len()];
        for index in order {
            let begin = if joints[index][side] < 0.0 { 0.0 } else { depth };
            depth = begin + through[index];
            depths[index] = [begin, depth];
        }
        depths
    };
    let count = arcs.len();
    let before = walk(&mut (0..2 * count).map(|index| index % count), 0);
    let after = walk(&mut (0..2 * count).rev().map(|index| index % count), 1);
    before.into_iter().zip(after).map(|([a, b], [d, c])| [a, b, c, d]).collect()
}

/// The directions of the figure's x axis at the beginning and at the end of each arc.
fn frames(arcs: &[Arc3], up: DVec3) -> Vec<[DVec3; 2]> {
    let Some(first) = arcs.first() else { return Vec::new() };
    let mut x = up.cross(first.direction).normalize_or(first.direction.any_orthonormal_vector());
    let frame = |arc: &Arc3| {
        let begin = (x - arc.direction * x.dot(arc.direction)).normalize_or(arc.direction.any_orthonormal_vector());
        // About the axis of the arc, by the angle that it turns by.
        let axis = arc.direction.cross(arc.end_direction()).normalize_or_zero();
        x = if axis == DVec3::ZERO { begin } else { DQuat::from_axis_angle(axis, 2.0 * arc.half_turn()) * begin };
        [begin, x]
    };
    arcs.iter().map(frame).collect()
}

/// The angle by which the figure comes back turned around a closed curve; 0 for an open one.
fn twist(args: &[f64]) -> f64 {
    let arcs = arcs(args);
    let (Some(first), true) = (arcs.first(), args[1] != 0.0) else { return 0.0 };
    let frames = frames(&arcs, DVec3::from_slice(&args[2..BEFORE]));
    let (from, to) = (frames[0][0], frames[frames.len() - 1][1]);
    libm::atan2(to.dot(first.direction.cross(from)), to.dot(from))
}

/// The support of one piece, see [`Map::support`].
fn support(row: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
    let (middle, along, across) = (DVec3::from_slice(row), DVec3::from_slice(&row[3..]), DVec3::from_slice(&row[6..]));
    let &[half, sin, cos, radius, cos_turn, sin_turn] = &row[arcs3::HALF..arcs3::ROW + 2] else {
        unreachable!("six numbers")
    };
    let (forward, sideways, out) = (direction.dot(along), direction.dot(across), direction.dot(along.cross(across)));
    // Of the figure that stands where `outward` of the direction leads away from the axis, and `beyond` of it along the curve.
    let within = |outward: f64, beyond: f64| {
        reach(DVec3::new(outward * cos_turn + out * sin_turn, out * cos_turn - outward * sin_turn, beyond))
    };
    let base = direction.dot(middle);
    let end = |side: f64| {
        let forward = forward * side;
        base + half * forward + within(sideways * cos + forward * sin, (forward * cos - sideways * sin).max(0.0))
    };
    let ends = end(1.0).max(end(-1.0));
    let flat = libm::hypot(forward, sideways);
    // The farthest direction of the circle, if it lies on the arc.
    if radius > 0.0 && sideways > cos * flat {
        ends.max(base + radius * (flat - cos * sideways) + within(flat, 0.0))
    } else {
        ends
    }
}
