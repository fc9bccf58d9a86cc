//! Intersection of half-spaces as the maximum of their distances. Exact inside, a bound outside, and cheap.

use super::convex_polyhedron::{HALF_SPACES, edges, half_space_values, half_spaces, height};
use super::plane::support_of_plane;
use crate::shape_prelude::*;

/// See [`convex_polyhedron_bound`].
#[derive(Clone, Copy, Debug)]
pub struct ConvexPolyhedronBound;

/// The descriptor of [`convex_polyhedron_bound`].
pub static CONVEX_POLYHEDRON_BOUND: Shape = Shape::primitive::<ConvexPolyhedronBound>();

/// Everything behind all these planes, each given by its outward normal and its distance from the origin.
#[track_caller]
pub fn convex_polyhedron_bound<V: Into<Value>>(
    half_spaces: impl IntoIterator<Item = ([V; 3], V)>,
) -> Form<ConvexPolyhedronBound> {
    Form::new(&CONVEX_POLYHEDRON_BOUND, half_space_values(half_spaces))
}

impl Primitive for ConvexPolyhedronBound {
    const ABOUT: About = About {
        name: "convex_polyhedron_bound",
        summary: "What several half-spaces have in common, bounded or not; outside its field is only a bound.",
        params: &[HALF_SPACES],
        elsewhere: &["convex_polygon", "plane intersection"],
        example: r#"{ "convex_polyhedron_bound": { "half_spaces":
            [[1, 1, 1, 0.5], [-1, -1, 1, 0.5], [-1, 1, -1, 0.5], [1, -1, -1, 0.5]] } }"#,
    };

    fn contract(_args: &[f64]) -> Contract {
        Contract { outside: Metric::Bound, ..Contract::EXACT }
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        half_spaces(args).iter().flat_map(|(n, d)| [n.x, n.y, n.z, *d]).collect()
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let moved: Vec<(DVec3, f64)> = half_spaces(args).into_iter().map(|(n, d)| (n, d + level)).collect();
        let along_a_plane =
            args.chunks_exact(4).map(|h| support_of_plane(h, direction, level)).fold(f64::INFINITY, f64::min);
        let edges = edges(&moved);
        if edges.is_empty() || edges.iter().any(|(a, b)| !a.is_finite() || !b.is_finite()) {
            return along_a_plane;
        }
        let corners = edges.into_iter().flat_map(|(a, b)| [a, b]);
        corners.map(|corner| direction.dot(corner)).fold(f64::NEG_INFINITY, f64::max).min(along_a_plane)
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let mut highest = height(p, c, 0);
        for i in 1..c.count() / 4 {
            highest = highest.max(height(p, c, i));
        }
        highest
    }
}
