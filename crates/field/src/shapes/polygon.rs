//! Polygon in the plane, given by its corners. Exact.
//!
//! The nearest of all edges gives the distance; whether the half-line to the right crosses an odd number of them gives the side.
//! So does the half-line upwards: at the height of a corner one alone leaves enclosures of the side in the dark.

use crate::scalar::Mask;
use crate::shape_prelude::*;

/// See [`polygon`].
#[derive(Clone, Copy, Debug)]
pub struct Polygon;

/// The descriptor of [`polygon`].
pub static POLYGON: Shape = Shape::primitive::<Polygon>();

/// The polygon with these corners, in either direction. Where edges cross, what lies inside an even number of times is outside.
#[track_caller]
pub fn polygon<V: Into<Value>>(corners: impl IntoIterator<Item = [V; 2]>) -> Form<Polygon> {
    Form::new(&POLYGON, corners.into_iter().flat_map(|corner| corner.map(Into::into)))
}

impl Primitive for Polygon {
    const ABOUT: About = About {
        name: "polygon",
        summary: "A plane figure: a polygon with any corners, convex or not.",
        params: &[Param::required(
            "points",
            ParamKind::Points2,
            "The corners [x, y], one after another; the last one is joined to the first.",
        )],
        elsewhere: &["sdPolygon", "polyline", "triangle2", "quad2", "trapezoid", "rhombus", "parallelogram"],
        example: r#"{ "extrude": { "height": 0.5, "shape": { "polygon": { "points":
            [[-0.9, -0.6], [0.9, -0.6], [0.3, 0], [0.6, 0.8], [-0.6, 0.4]] } } } }"#,
    };

    const DIMENSION: Dimension = Dimension::Plane;

    fn check(args: &[f64]) -> Result<(), String> {
        let corners: Vec<&[f64]> = args.chunks_exact(2).collect();
        if corners.len() < 3 {
            return Err("`polygon` has fewer than three corners".into());
        }
        match (0..corners.len()).find(|&index| corners[index] == corners[(index + 1) % corners.len()]) {
            Some(index) => Err(format!("corner {} of `polygon` and the next one are the same", index + 1)),
            None => Ok(()),
        }
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        edges(args)
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        support_of_corners(args, direction, level)
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        polygon_distance(p, c)
    }
}

/// The support of a polygon with these corners.
pub(crate) fn support_of_corners(corners: &[f64], direction: DVec3, level: f64) -> f64 {
    let along = |corner: &[f64]| corner[0] * direction.x + corner[1] * direction.y;
    let farthest = corners.chunks_exact(2).map(along).fold(f64::NEG_INFINITY, f64::max);
    in_plane(direction, |across| farthest + level * across)
}

/// How many constants an edge has.
const EDGE: usize = 6;

/// The constants of the edges between corners: for each both ends, and the way from the second to the first over its squared
/// length.
pub(crate) fn edges(corners: &[f64]) -> Vec<f64> {
    let count = corners.len() / 2;
    let corner = |index: usize| DVec2::from_slice(&corners[2 * (index % count)..]);
    (0..count)
        .flat_map(|index| {
            let (a, b) = (corner(index), corner(index + 1));
            // An edge without length is a point, wherever a point is said to lie along it.
            let along = (a - b) / (a - b).length_squared().max(f64::MIN_POSITIVE);
            [a.x, a.y, b.x, b.y, along.x, along.y]
        })
        .collect()
}

/// The signed distance from a polygon whose [`edges`] are the constants.
#[inline(always)]
pub(crate) fn polygon_distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
    let (zero, one) = (p.x.lift(0.0), p.x.lift(1.0));
    let [ax, ay] = c.get();
    // The way from the nearest point of all edges so far, its squared length, and the side by two half-lines.
    let (nx, ny) = (p.x - ax, p.y - ay);
    let start = [nx, ny, nx.square() + ny.square(), one, one];
    let [nx, ny, least, side, other_side] = S::fold_rows(
        c,
        EDGE,
        start,
        #[inline(always)]
        |[nx, ny, least, side, other_side], edge| {
            let [ax, ay, bx, by, ux, uy] = edge.get();
            let (ex, ey) = (ax - bx, ay - by);
            let (wx, wy) = (p.x - bx, p.y - by);
            let along = (wx * ux + wy * uy).max(zero).min(one);
            let (dx, dy) = (wx - ex * along, wy - ey * along);
            let square = dx.square() + dy.square();
            let is_nearer = square.lt(least);
            let is_right = (ey * wx).lt(ex * wy);
            [
                S::select(is_nearer, dx, nx),
                S::select(is_nearer, dy, ny),
                square.min(least),
                S::select(crosses(p.y.lt(by), p.y.lt(ay), is_right), -side, side),
                S::select(crosses(p.x.lt(bx), p.x.lt(ax), !is_right), -other_side, other_side),
            ]
        },
    );
    // Where two edges are as near, an enclosure of the way from them holds all between.
    side.agreed(other_side) * S::length2(nx, ny).agreed(least.sqrt())
}

/// Whether a half-line from a point crosses an edge, by which ends of the edge lie beyond the line that the half-line is part of,
/// and by the side of the edge on which the point lies.
#[inline(always)]
pub(crate) fn crosses<M: Mask>(starts: M, ends: M, is_right: M) -> M {
    (!starts & ends & is_right) | (starts & !ends & !is_right)
}
