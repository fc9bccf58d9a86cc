//! Round tubes along chains of straight edges and arcs. Exact outside.
//!
//! Where one goes over into the next smoothly, the joint is never nearer than the points beside it, so that it is no end of either:
//! single precision could not tell it from them, and would take the curvature of an end for that of the tube.

use crate::arcs3::{self, Arc3, is_arc, reach};
use crate::shape_prelude::*;

/// All that a ball fills while it moves along straight edges and arcs: what tubes of all kinds are cases of. Its arguments are its
/// constants: the radius, then those of each arc, and for its beginning and its end -1 if that is an end of the tube, or a corner;
/// otherwise how far both arcs overlap there at least.
#[derive(Clone, Copy, Debug)]
pub struct Wire;

/// How many constants an arc has.
const ROW: usize = arcs3::ROW + 2;

/// Where arcs go on they count as longer by this share of the distance from them and of all coordinates, so that rounding in single
/// precision leaves no gap between two of them. Beyond a joint the circles of both differ by the square of it.
const OVERLAP: f64 = 1e-6;

impl Primitive for Wire {
    const ABOUT: About =
        About { name: "wire", summary: "A round tube along arcs.", params: &[], elsewhere: &[], example: "" };

    fn contract(_args: &[f64]) -> Contract {
        Contract { inside: Metric::Bound, ..Contract::EXACT }
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let farthest = args[1..].chunks_exact(ROW).map(|row| reach(row, direction)).fold(f64::NEG_INFINITY, f64::max);
        farthest + (args[0] + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let arcs = c.part(1, c.count() - 1);
        let (zero, far) = (p.x.lift(0.0), p.x.lift(f64::from(f32::MAX)));
        let [nearest] = S::fold_rows(
            &arcs,
            ROW,
            [far],
            #[inline(always)]
            |[nearest], arc| {
                let [mx, my, mz, ux, uy, uz, nx, ny, nz, half, sin, cos, radius, begins, ends] = arc.get();
                let (q, u, n) = (p - vec3(mx, my, mz), vec3(ux, uy, uz), vec3(nx, ny, nz));
                // In the arc's plane as in an outline, and out of it.
                let (along, across) = (q.dot(u), q.dot(n));
                let out = q.dot(vec3(uy * nz - uz * ny, uz * nx - ux * nz, ux * ny - uy * nx));
                let goes_on = S::select(along.lt(zero), begins, ends);
                let is_end = goes_on.lt(zero);
                let along = along.abs();
                let overlap = S::select(is_end, zero, (along + across.abs() + half) * OVERLAP + goes_on);
                let is_between = zero.lt(sin * across + cos * (half - along) + overlap);
                let to_centre = radius * cos;
                let excess = (along - half) * (along + half) + across * (across + to_centre * 2.0);
                let is_arc = is_arc(radius);
                let gap = S::select(is_arc, excess / (S::length2(along, across + to_centre) + radius), across);
                let beside = S::select(is_between, zero, along - half);
                let across = S::select(is_between, gap, across);
                let distance = S::length3(beside, across, out);
                // Enclosures over a joint are narrower if each arc ends there; the least of both is the same.
                [nearest.min(if S::IS_ENCLOSURE { distance } else { S::select(is_between | is_end, distance, far) })]
            },
        );
        nearest - c.at(0)
    }
}

/// Arcs are within this share of the tube's radius from the curve that they stand for.
pub(crate) const TOLERANCE: f64 = 2e-3;

/// Directions that differ by less are the same: a corner opens a gap that [`OVERLAP`] closes.
const SMOOTH: f64 = 1e-7;

/// The arguments of the tube along some arcs.
pub(crate) fn along(radius: f64, arcs: impl IntoIterator<Item = Arc3>) -> Vec<f64> {
    let arcs: Vec<Arc3> = arcs.into_iter().collect();
    let rows = arcs.iter().zip(joints(&arcs, OVERLAP));
    let row = |(arc, joints): (&Arc3, [f64; 2])| arc.constants().into_iter().chain(joints);
    [radius].into_iter().chain(rows.flat_map(row)).collect()
}

/// For the beginning and the end of each arc of a chain -1 if that is an end of it, or a corner; otherwise how far both arcs overlap
/// there at least: this share of the largest coordinate.
pub(crate) fn joints(arcs: &[Arc3], share: f64) -> Vec<[f64; 2]> {
    // Whether there are ends between an arc and the next one, after the last of which comes the first.
    let next = arcs.iter().cycle().skip(1);
    let largest = arcs.iter().map(|arc| arc.from.abs().max(arc.to.abs()).max_element()).fold(0.0, f64::max);
    let overlap = |(arc, next): (&Arc3, &Arc3)| {
        let is_line = [arc, next].iter().all(|arc| arc.from != arc.to);
        let is_smooth = is_line && arc.to == next.from && arc.end_direction().distance(next.direction) < SMOOTH;
        if is_smooth { largest * share } else { -1.0 }
    };
    let ends: Vec<f64> = arcs.iter().zip(next).map(overlap).collect();
    let begins = ends.iter().cycle().skip(arcs.len().saturating_sub(1));
    begins.zip(&ends).map(|(begins, ends)| [*begins, *ends]).collect()
}

/// See [`tube`].
#[derive(Clone, Copy, Debug)]
pub struct Tube;

/// The descriptor of [`tube`].
pub static TUBE: Shape = Shape::special::<Tube>();

/// All that a ball of this radius fills while its middle moves from point to point. `with("closed", ...)` leads from the last one
/// back to the first.
#[track_caller]
pub fn tube<V: Into<Value>>(radius: impl Into<Value>, points: impl IntoIterator<Item = [V; 3]>) -> Form<Tube> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&TUBE, [radius.into(), 0.into()].into_iter().chain(points))
}

/// How many arguments stand before the points.
const BEFORE: usize = 2;

impl Special for Tube {
    type General = Wire;

    const ABOUT: About = About {
        name: "tube",
        summary: "A round tube along straight pieces from point to point.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the tube."),
            Param::optional("closed", ParamKind::Flag, &[0.0], "Whether the last point is joined to the first."),
            Param::required("points", ParamKind::Points3, "The points [x, y, z], one after another: two at least."),
        ],
        elsewhere: &["polyline", "pipe along points", "line_strip", "wire"],
        example: r#"{ "tube": { "radius": 0.15, "points":
            [[-0.9, -0.5, -0.6], [-0.9, 0.5, 0.6], [0, -0.5, 0.6], [0.2, 0.5, -0.6], [0.9, 0, 0.6]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let points: Vec<&[f64]> = args[BEFORE..].chunks_exact(3).collect();
        if points.len() < 2 {
            return Err("`tube` has fewer than two points".into());
        }
        match points.windows(2).position(|pair| pair[0] == pair[1]) {
            Some(index) => Err(format!("point {} of `tube` and the next one are the same", index + 1)),
            None => Ok(()),
        }
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let points: Vec<DVec3> = args[BEFORE..].chunks_exact(3).map(DVec3::from_slice).collect();
        // From the last point to itself, if the tube is open.
        let end = if args[1] == 0.0 { points[points.len() - 1] } else { points[0] };
        let pairs = points.iter().zip(points[1..].iter().chain([&end]));
        along(args[0], pairs.map(|(from, to)| Arc3::straight(*from, *to)))
    }
}
