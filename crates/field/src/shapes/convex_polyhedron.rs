//! Convex polyhedron. Exact outside and inside.
//!
//! Inside, the nearest plane decides. Outside, the nearest point lies on the face whose plane the point is farthest outside of, if
//! its foot on that plane is behind all other planes, or else on an edge. Faces and edges are found in `f64` when the numbers are
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

/// Normals whose difference has a smaller square are those of one plane, or of parallel ones; single precision tells as much.
const SAME_NORMAL: f64 = 1e-12;

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

/// How many constants a plane has, and an edge.
const PLANE: usize = 4;
const EDGE: usize = 7;

/// How many edges are stored for so many planes.
const fn edge_count(planes: usize) -> usize {
    3 * planes - 6
}

/// How many planes lead to `count` constants.
const fn plane_count(count: usize) -> usize {
    (count + 6 * EDGE) / (PLANE + 3 * EDGE)
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
        let edges = edges(&planes);
        let stored = edge_count(planes.len());
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
        let (planes, edges) = (c.part(0, PLANE * planes), c.part(PLANE * planes, EDGE * edge_count(planes)));
        let [inside, over] = if S::IS_ENCLOSURE { each_foot(p, &planes) } else { foot_of_farthest(p, &planes) };
        let [nearest_edge] = S::fold_rows(
            &edges,
            EDGE,
            [p.x.lift(f64::from(f32::MAX))],
            #[inline(always)]
            |[nearest], own| [nearest.min(edge(p, own))],
        );
        let zero = p.x.lift(0.0);
        let is_beside = zero.lt(inside) & zero.lt(over);
        S::select(is_beside, nearest_edge, inside)
    }
}

/// How far outside of the plane the point is that it is farthest outside of, and its foot on that plane outside of all others: if
/// the nearest point lies on a face at all, it lies on that plane's, for no half-space that holds the polyhedron is farther than
/// the polyhedron.
#[inline(always)]
fn foot_of_farthest<S: Scalar>(p: Vec3<S>, planes: &Constants<'_, S>) -> [S; 2] {
    let first = planes.part(0, PLANE);
    let [x, y, z] = first.get();
    let [inside, x, y, z] = S::fold_rows(
        planes,
        PLANE,
        [height(p, &first, 0), x, y, z],
        #[inline(always)]
        |[most, x, y, z], plane| {
            let own = height(p, plane, 0);
            let is_farther = most.lt(own);
            let [nx, ny, nz] = plane.get();
            [most.max(own), S::select(is_farther, nx, x), S::select(is_farther, ny, y), S::select(is_farther, nz, z)]
        },
    );
    [inside, over_others(p, planes, inside, vec3(x, y, z))]
}

/// The same by the feet on all planes: which plane is the farthest, enclosures may not know, but they know of each whether its foot
/// lies on the face.
#[inline(always)]
fn each_foot<S: Scalar>(p: Vec3<S>, planes: &Constants<'_, S>) -> [S; 2] {
    let lowest = p.x.lift(f64::from(f32::MIN));
    S::fold_rows(
        planes,
        PLANE,
        [lowest, lowest],
        #[inline(always)]
        |[most, over], plane| {
            let own = height(p, plane, 0);
            let [nx, ny, nz] = plane.get();
            let own_over = over_others(p, planes, own, vec3(nx, ny, nz));
            [most.max(own), S::select(most.lt(own), own_over, over)]
        },
    )
}

/// The largest height of a point's foot on a plane over all other planes. That over its own one would be nothing but rounding.
#[inline(always)]
fn over_others<S: Scalar>(p: Vec3<S>, planes: &Constants<'_, S>, height_over_own: S, own: Vec3<S>) -> S {
    let foot = p - own * height_over_own;
    let [over] = S::fold_rows(
        planes,
        PLANE,
        [p.x.lift(f64::from(f32::MIN))],
        #[inline(always)]
        |[over], plane| {
            let [nx, ny, nz] = plane.get();
            let turn = (nx - own.x).square() + (ny - own.y).square() + (nz - own.z).square();
            [S::select(turn.lt(turn.lift(SAME_NORMAL)), over, over.max(height(foot, plane, 0)))]
        },
    );
    over
}

/// The height of a point above the plane whose index among half-spaces is `i`.
#[inline(always)]
pub(crate) fn height<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>, i: usize) -> S {
    p.dot(vec3(c.at(4 * i), c.at(4 * i + 1), c.at(4 * i + 2))) - c.at(4 * i + 3)
}

/// The distance from the edge with these constants.
#[inline(always)]
fn edge<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
    let [fx, fy, fz, ax, ay, az, inverse] = c.get();
    segment(p, vec3(fx, fy, fz), vec3(ax, ay, az), inverse)
}
