//! Convex polyhedron. Exact outside and inside.
//!
//! Inside, the nearest plane decides. Outside, the nearest point lies on a face, where the point's projection onto that
//! face's plane is behind all other planes, or else on an edge. Faces and edges are found in `f64` when the numbers are
//! bound; a polyhedron of n planes has at most 3n - 6 edges (Euler), and that many are always stored, the last one
//! repeated, so that moving a plane never changes the structure.

use super::capsule::segment;
use crate::shape_prelude::*;

/// See [`convex_polyhedron`].
#[derive(Clone, Copy, Debug)]
pub struct ConvexPolyhedron;

/// The descriptor of [`convex_polyhedron`].
pub static CONVEX_POLYHEDRON: Shape = Shape::primitive::<ConvexPolyhedron>();

/// The solid behind all these planes, each given by its outward normal and its distance from the origin. Together they
/// must enclose it.
#[track_caller]
pub fn convex_polyhedron<V: Into<Value>>(half_spaces: impl IntoIterator<Item = ([V; 3], V)>) -> Form<ConvexPolyhedron> {
    Form::new(&CONVEX_POLYHEDRON, half_space_values(half_spaces))
}

/// The numbers of a list of half-spaces.
pub(crate) fn half_space_values<V: Into<Value>>(
    half_spaces: impl IntoIterator<Item = ([V; 3], V)>,
) -> impl Iterator<Item = Value> {
    half_spaces.into_iter().flat_map(|([x, y, z], d)| [x.into(), y.into(), z.into(), d.into()])
}

/// The parameter of both polyhedra.
pub(crate) const HALF_SPACES: Param = Param::required(
    "half_spaces",
    ParamKind::HalfSpaces,
    "Each with an outward normal and the distance of its plane from the origin: x, y, z, d.",
);

/// The most planes a polyhedron may have; evaluation grows with their square.
const MAX_PLANES: usize = 64;

/// Lengths below this share of the polyhedron's size count as 0 when edges are found.
const TINY: f64 = 1e-9;

/// A plane: unit normal and offset.
type HalfSpace = (DVec3, f64);

/// The half-spaces of a list of numbers.
pub(crate) fn half_spaces(args: &[f64]) -> Vec<HalfSpace> {
    args.chunks_exact(4).map(|h| (DVec3::from_slice(h).normalize(), h[3])).collect()
}

/// The edges of the solid behind all planes; an edge may be infinitely long.
pub(crate) fn edges(planes: &[HalfSpace]) -> Vec<(DVec3, DVec3)> {
    let size = planes.iter().map(|(_, d)| d.abs()).fold(f64::MIN_POSITIVE, f64::max);
    // Of parallel planes only the innermost one bounds the solid.
    let is_needed = |i: usize| {
        let (normal, offset) = planes[i];
        !planes
            .iter()
            .enumerate()
            .any(|(j, &(other, d))| j != i && other.distance(normal) < TINY && (d < offset || (d == offset && j < i)))
    };
    let needed: Vec<HalfSpace> = (0..planes.len()).filter(|&i| is_needed(i)).map(|i| planes[i]).collect();
    let mut edges = Vec::new();
    for (i, &(a, da)) in needed.iter().enumerate() {
        for &(b, db) in &needed[..i] {
            let cross = a.cross(b);
            if cross.length() < TINY {
                continue;
            }
            let along = cross.normalize();
            let foot = (b.cross(along) * da + along.cross(a) * db) / cross.length();
            let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
            for &(n, d) in &needed {
                let (slope, gap) = (n.dot(along), d - n.dot(foot));
                if slope.abs() < TINY {
                    if gap < -TINY * size {
                        to = f64::NEG_INFINITY;
                    }
                } else if slope > 0.0 {
                    to = to.min(gap / slope);
                } else {
                    from = from.max(gap / slope);
                }
            }
            if to - from > TINY * size {
                edges.push((foot + along * from, foot + along * to));
            }
        }
    }
    edges
}

/// How many planes lead to `count` constants.
const fn plane_count(count: usize) -> usize {
    let mut planes = 4;
    while planes * 4 + planes * planes + (3 * planes - 6) * 7 < count {
        planes += 1;
    }
    planes
}

impl Primitive for ConvexPolyhedron {
    const ABOUT: About = About {
        name: "convex_polyhedron",
        summary: "The solid behind several planes that together enclose it (at most 64).",
        params: &[HALF_SPACES],
        elsewhere: &["intersection of half-spaces"],
        example: r#"{ "convex_polyhedron": { "half_spaces":
            [[1, 1, 1, 0.5], [-1, -1, 1, 0.5], [-1, 1, -1, 0.5], [1, -1, -1, 0.5], [0, 0, 1, 0.5]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let planes = half_spaces(args);
        if planes.len() > MAX_PLANES {
            return Err(format!("a convex polyhedron may have at most {MAX_PLANES} half-spaces"));
        }
        let edges = edges(&planes);
        if planes.len() < 4 || edges.iter().any(|(a, b)| !a.is_finite() || !b.is_finite()) {
            return Err("the half-spaces do not enclose the polyhedron on all sides; add the missing ones, or use \
                        `convex_polyhedron_bound`"
                .into());
        }
        if edges.len() < 6 {
            return Err("the half-spaces have no solid in common".into());
        }
        Ok(())
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        let planes = half_spaces(args);
        let mut constants: Vec<f64> = planes.iter().flat_map(|(n, d)| [n.x, n.y, n.z, *d]).collect();
        for (a, _) in &planes {
            constants.extend(planes.iter().map(|(b, _)| a.dot(*b)));
        }
        let edges = edges(&planes);
        let stored = 3 * planes.len() - 6;
        for (from, to) in
            edges.iter().chain(std::iter::repeat(edges.last().unwrap_or(&(DVec3::ZERO, DVec3::X)))).take(stored)
        {
            let along = *to - *from;
            constants.extend([from.x, from.y, from.z, along.x, along.y, along.z, 1.0 / along.length_squared()]);
        }
        constants
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let corners = edges(&half_spaces(args)).into_iter().flat_map(|(a, b)| [a, b]);
        corners.map(|corner| direction.dot(corner)).fold(f64::NEG_INFINITY, f64::max) + level * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let planes = plane_count(c.count());
        let mut inside = height(p, c, 0);
        for i in 1..planes {
            inside = inside.max(height(p, c, i));
        }
        let first_edge = 4 * planes + planes * planes;
        let mut outside = edge(p, c, first_edge);
        for i in 1..3 * planes - 6 {
            outside = outside.min(edge(p, c, first_edge + 7 * i));
        }
        let zero = p.x.lift(0.0);
        for i in 0..planes {
            let own = height(p, c, i);
            // The height of the point's projection over every other plane.
            let mut over = p.x.lift(-1.0);
            for j in 0..planes {
                if j != i {
                    over = over.max(height(p, c, j) - c.at(4 * planes + planes * i + j) * own);
                }
            }
            let is_beside = over.lt(zero) & zero.lt(own);
            outside = S::select(is_beside, outside.min(own), outside);
        }
        S::select(zero.lt(inside), outside, inside)
    }
}

/// The height of a point above the plane whose index among half-spaces is `i`.
#[inline(always)]
pub(crate) fn height<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>, i: usize) -> S {
    p.dot(vec3(c.at(4 * i), c.at(4 * i + 1), c.at(4 * i + 2))) - c.at(4 * i + 3)
}

/// The distance from the edge whose constants start at `i`.
#[inline(always)]
fn edge<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>, i: usize) -> S {
    let (from, along) = (vec3(c.at(i), c.at(i + 1), c.at(i + 2)), vec3(c.at(i + 3), c.at(i + 4), c.at(i + 5)));
    segment(p, from, along, c.at(i + 6))
}
