//! Balls around given points, found by a tree of boxes: clouds of up to millions of points.

use crate::point_tree::{SHORTER, TREE, constants};
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`point_set`].
#[derive(Clone, Copy, Debug)]
pub struct PointSet;

/// The descriptor of [`point_set`].
pub static POINT_SET: Shape = Shape::primitive::<PointSet>();

/// All that is at most `radius` away from the nearest of some points.
#[track_caller]
pub fn point_set<V: Into<Value>>(radius: impl Into<Value>, points: impl IntoIterator<Item = [V; 3]>) -> Form<PointSet> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&POINT_SET, [radius.into()].into_iter().chain(points))
}

/// So many points at most: their tree has numbers that single precision counts exactly.
pub(crate) const MOST_POINTS: usize = 2_000_000;

/// The constant that is the radius.
const RADIUS: usize = 1;

/// Squares of distances that are taken for 0, where a point has no direction to the nearest one.
const LEAST: f64 = 1e-36;

/// The points of a list of coordinates.
pub(crate) fn points(list: &[f64]) -> impl Iterator<Item = DVec3> {
    list.chunks_exact(3).map(DVec3::from_slice)
}

/// What is wrong with a list of points for the shape of this name.
///
/// # Errors
/// The fault.
pub(crate) fn check(name: &str, list: &[f64]) -> Result<(), String> {
    match list.len() / 3 {
        0 => Err(format!("`{name}` needs a point at least")),
        count if count > MOST_POINTS => Err(format!("`{name}` has {count} points; at most {MOST_POINTS} are possible")),
        _ => Ok(()),
    }
}

/// The largest value of `direction . p` over all points.
pub(crate) fn farthest(list: &[f64], direction: DVec3) -> f64 {
    points(list).map(|point| point.dot(direction)).fold(f64::NEG_INFINITY, f64::max)
}

/// A square that the square of the distance from all points in the box of a node is not below.
#[inline(always)]
pub(crate) fn square_to_box<S: Scalar>(p: Vec3<S>, node: &Constants<'_, S>) -> S {
    let [mx, my, mz, hx, hy, hz] = node.get();
    let zero = p.x.lift(0.0);
    let outside = (p - vec3(mx, my, mz)).abs() - vec3(hx, hy, hz);
    let square = outside.x.max(zero).square() + outside.y.max(zero).square() + outside.z.max(zero).square();
    square * (1.0 - SHORTER)
}

/// The square of the distance from the point in a row.
#[inline(always)]
pub(crate) fn square_to_point<S: Scalar>(p: Vec3<S>, row: &Constants<'_, S>) -> S {
    let [x, y, z] = row.get();
    square(p - vec3(x, y, z))
}

#[inline(always)]
fn square<S: Scalar>(q: Vec3<S>) -> S {
    q.x.square() + q.y.square() + q.z.square()
}

/// The distance whose square this is; not 0, since there it has no slope.
#[inline(always)]
pub(crate) fn length<S: Scalar>(square: S) -> S {
    square.max(square.lift(LEAST)).sqrt()
}

/// The distance from the nearest point of a tree.
#[inline(always)]
pub(crate) fn nearest<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
    let far = p.x.lift(f64::from(f32::MAX));
    if let Some([x, y, z]) = S::nearest_row([p.x, p.y, p.z], c) {
        return length(square(p - vec3(x, y, z)).min(far));
    }
    let square = S::least_in_tree(
        c,
        TREE,
        far,
        #[inline(always)]
        |node| square_to_box(p, node),
        #[inline(always)]
        |row| square_to_point(p, row),
        #[inline(always)]
        |square| square * (1.0 + SHORTER) + far.lift(LEAST),
    );
    length(square)
}

impl Primitive for PointSet {
    const ABOUT: About = About {
        name: "point_set",
        summary: "All that is near to one of many points: balls around them, up to two million.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the ball around each point."),
            Param::required("points", ParamKind::Points3, "The points [x, y, z]."),
        ],
        elsewhere: &["point cloud", "voronoi2", "worley", "Multi3D"],
        example: r#"{ "point_set": { "radius": 0.2, "points": [[0.26, 0.86, 0], [-0.32, 0.79, 0.29], [0.05, 0.71, -0.55],
            [0.39, 0.64, 0.5], [-0.69, 0.56, -0.12], [0.64, 0.49, -0.41], [-0.21, 0.41, 0.77], [-0.38, 0.34, -0.74], [0.81, 0.26, 0.3],
            [-0.81, 0.19, 0.34], [0.38, 0.11, -0.81], [0.27, 0.04, 0.86], [-0.78, -0.04, -0.45], [0.87, -0.11, -0.19],
            [-0.51, -0.19, 0.72], [-0.11, -0.26, -0.85], [0.64, -0.34, 0.54], [-0.8, -0.41, 0.03], [0.54, -0.49, -0.53],
            [-0.03, -0.56, 0.7], [-0.41, -0.64, -0.49], [0.54, -0.71, 0.07], [-0.36, -0.79, 0.25], [0.06, -0.86, -0.25]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        check("point_set", &args[1..])
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        remembered("point_set", args, || constants(points(&args[1..]).collect(), &args[..RADIUS]))
    }

    fn contract(args: &[f64]) -> Contract {
        let inside = if args.len() > 4 { Metric::Bound } else { Metric::Exact };
        Contract { inside, ..Contract::EXACT }
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        farthest(&args[1..], direction) + (args[0] + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        nearest(p, c) - c.at(RADIUS)
    }
}
