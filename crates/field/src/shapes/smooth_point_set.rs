//! Balls around many points that melt into each other. A bound.

use super::point_set::{check, farthest, length, nearest, points, square_to_box, square_to_point};
use crate::point_tree::{TREE, constants};
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`smooth_point_set`].
#[derive(Clone, Copy, Debug)]
pub struct SmoothPointSet;

/// The descriptor of [`smooth_point_set`].
pub static SMOOTH_POINT_SET: Shape = Shape::primitive::<SmoothPointSet>();

/// Balls around some points with smoothly filled seams, whose visible size is `k`. The order of the points does not matter.
#[track_caller]
pub fn smooth_point_set<V: Into<Value>>(
    radius: impl Into<Value>,
    k: impl Into<Value>,
    points: impl IntoIterator<Item = [V; 3]>,
) -> Form<SmoothPointSet> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&SMOOTH_POINT_SET, [radius.into(), k.into()].into_iter().chain(points))
}

/// How many arguments stand before the points, and the constants that they are.
const BEFORE: usize = 2;
const RADIUS: usize = 1;
const K: usize = 2;

/// At most so many steps towards the level; from the second one on each doubles the digits that are right.
const MOST_STEPS: u32 = 12;

/// How often the range is halved in which its highest point is sought: to a thousandth of `k`.
const HALVINGS: u32 = 10;

/// Steps that are shorter than this share of `k` are the last ones.
const PRECISION: f64 = 1e-6;

/// The smooth minimum `u - k` of the distances `d` from all points, where the sum of all `max(u - d, 0)^2` is `k^2`. It is a mean
/// of their slopes that its slope is, so that it is no steeper than they are; a single point has its own distance, and what is
/// farther by `k` than the result plays no part.
#[inline(always)]
fn smooth_nearest<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
    let (k, zero, nearest) = (c.at(K), p.x.lift(0.0), nearest(p, c));
    // The root of the sum is convex, and Newton's steps come down to the level.
    let [level] = S::iterate(
        MOST_STEPS,
        [nearest + k],
        #[inline(always)]
        |[level]| {
            let [_, sum, squares] = S::fold_tree(
                c,
                TREE,
                [level.square(), zero, zero],
                #[inline(always)]
                |node| square_to_box(p, node),
                #[inline(always)]
                |[reach, sum, squares], row| {
                    let depth = (level - length(square_to_point(p, row))).max(zero);
                    [reach, sum + depth, squares + depth.square()]
                },
            );
            // The level is above the least distance, unless `k` is lost beside that.
            let step = S::select(zero.lt(sum), (squares - k * squares.sqrt()) / sum, zero);
            // Enclosures that can't tell whether the sum is 0 still know that much.
            ([(level - step).max(nearest).min(level)], (k * PRECISION).lt(step))
        },
    );
    level - k
}

/// No lower than the largest height, in a direction of length 1, at which the smooth minimum is 0: where it would be if all points
/// were straight below.
fn highest(list: &[f64], direction: DVec3, k: f64) -> f64 {
    let top = farthest(list, direction);
    let heights: Vec<f64> =
        points(list).map(|point| point.dot(direction) - top).filter(|&height| height > -k).collect();
    let squares = |above: f64| -> f64 { heights.iter().map(|height| (k + height - above).max(0.0).powi(2)).sum() };
    let [mut low, mut high] = [0.0, k];
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        *(if squares(middle) > k * k { &mut low } else { &mut high }) = middle;
    }
    top + high
}

impl Primitive for SmoothPointSet {
    const ABOUT: About = About {
        name: "smooth_point_set",
        summary: "Balls around many points, up to two million, that melt into each other.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the ball around a point that is alone."),
            Param::required(
                "k",
                ParamKind::Length,
                "Visible size of the blend: by how much distances from points differ at most that still melt.",
            ),
            Param::required("points", ParamKind::Points3, "The points [x, y, z]."),
        ],
        elsewhere: &["metaballs", "blobs", "smooth point cloud"],
        example: r#"{ "smooth_point_set": { "radius": 0.2, "k": 0.4, "points": [[0.26, 0.86, 0], [-0.32, 0.79, 0.29],
            [0.05, 0.71, -0.55], [0.39, 0.64, 0.5], [-0.69, 0.56, -0.12], [-0.21, 0.41, 0.77], [-0.38, 0.34, -0.74], [0.81, 0.26, 0.3],
            [0.38, 0.11, -0.81], [0.27, 0.04, 0.86], [-0.78, -0.04, -0.45], [0.87, -0.11, -0.19], [-0.51, -0.19, 0.72],
            [-0.8, -0.41, 0.03], [0.54, -0.49, -0.53], [-0.03, -0.56, 0.7], [-0.41, -0.64, -0.49], [0.06, -0.86, -0.25]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        check("smooth_point_set", &args[BEFORE..])
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        remembered("smooth_point_set", args, || constants(points(&args[BEFORE..]).collect(), &args[..BEFORE]))
    }

    fn contract(_args: &[f64]) -> Contract {
        Contract::BOUND
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let length = direction.length();
        highest(&args[BEFORE..], direction / length, args[1]) * length + (args[0] + level) * length
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let distance = if S::IS_ENCLOSURE {
            // That of the middle, and as much to either side as the point may be away from it.
            let middle = vec3(p.x.core(), p.y.core(), p.z.core());
            let way = p - middle;
            let (level, reach) = (smooth_nearest(middle, c), S::length3(way.x, way.y, way.z));
            S::select(reach.lt(reach.core()), level - reach, level + reach)
        } else {
            smooth_nearest(p, c)
        };
        distance - c.at(RADIUS)
    }
}
