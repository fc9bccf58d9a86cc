//! All that is near to some triangles: what sheets along curved surfaces of all kinds are cases of. Exact outside.

use super::triangle::normal;
use crate::remember::remembered;
use crate::shape_prelude::*;
use crate::surface::BezierPatch;
use crate::triangles::{Cut, MOST_TRIANGLES, Patches};
use glam::DVec4;

/// What is at most a radius away from some triangles. Its arguments are the radius, and the three corners of each triangle, of
/// which those that follow one another are near to each other.
#[derive(Clone, Copy, Debug)]
pub struct Facets;

/// How many constants a triangle has: the first corner, a direction along the longest edge, one across it in the plane, and the
/// normal; in these directions the other end of that edge, and the third corner; for each edge 1 over its squared length, or 0 if
/// it has none; and the radius.
const ROW: usize = 19;

/// Where in a row the radius stands.
const RADIUS: usize = ROW - 1;

/// So many triangles are looked at together.
const GROUP: usize = 8;

/// How many arguments a triangle has.
const CORNERS: usize = 9;

/// An edge that is shorter than this share of the triangle's longest one is a point.
const SHORT: f64 = 1e-6;

fn corners(args: &[f64]) -> impl Iterator<Item = DVec3> {
    args[1..].chunks_exact(3).map(DVec3::from_slice)
}

/// The constants of a triangle, at least two of whose corners differ.
fn row(corners: [DVec3; 3], radius: f64) -> [f64; ROW] {
    let length = |index: usize| corners[index].distance_squared(corners[(index + 1) % 3]);
    let longest = (0..3).fold(0, |longest, index| if length(index) > length(longest) { index } else { longest });
    let [a, b, c] = [0, 1, 2].map(|place| corners[(longest + place) % 3]);
    let along = (b - a).normalize_or(DVec3::X);
    // A triangle without area is its longest edge.
    let normal = normal(&[a, b, c]).unwrap_or_else(|| along.any_orthonormal_vector());
    let across = normal.cross(along);
    let least = length(longest) * SHORT * SHORT;
    let inverse = |from: DVec3, to: DVec3| match from.distance_squared(to) {
        square if square > least => 1.0 / square,
        _ => 0.0,
    };
    let [ax, ay, az] = a.to_array();
    let [ux, uy, uz] = along.to_array();
    let [vx, vy, vz] = across.to_array();
    let [nx, ny, nz] = normal.to_array();
    let flat = [(b - a).dot(along), (c - a).dot(along), (c - a).dot(across)];
    let inverses = [inverse(a, b), inverse(b, c), inverse(a, c)];
    let [bx, cx, cy] = flat;
    let [ab, bc, ac] = inverses;
    [ax, ay, az, ux, uy, uz, vx, vy, vz, nx, ny, nz, bx, cx, cy, ab, bc, ac, radius]
}

impl Primitive for Facets {
    const ABOUT: About =
        About { name: "facets", summary: "Triangles with a thickness.", params: &[], elsewhere: &[], example: "" };

    fn contract(_args: &[f64]) -> Contract {
        Contract { inside: Metric::Bound, ..Contract::EXACT }
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        let corners: Vec<DVec3> = corners(args).collect();
        corners.chunks_exact(3).flat_map(|corners| row([corners[0], corners[1], corners[2]], args[0])).collect()
    }

    fn parts(args: &[f64]) -> Vec<usize> {
        let count = args.len() / CORNERS;
        (0..count).step_by(GROUP).map(|first| GROUP.min(count - first) * ROW).collect()
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let farthest = corners(args).map(|corner| corner.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
        farthest + (args[0] + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let (zero, one, far) = (p.x.lift(0.0), p.x.lift(1.0), p.x.lift(f64::from(f32::MAX)));
        let [nearest] = S::fold_rows(
            c,
            ROW,
            [far],
            #[inline(always)]
            |[nearest], row| {
                let [ax, ay, az, ux, uy, uz, vx, vy, vz, nx, ny, nz, bx, cx, cy, ab, bc, ac] = row.get();
                let q = p - vec3(ax, ay, az);
                let (x, y, z) = (q.dot(vec3(ux, uy, uz)), q.dot(vec3(vx, vy, vz)), q.dot(vec3(nx, ny, nz)));
                // In the plane, the way from the nearest point of each edge.
                let along = (x * bx * ab).max(zero).min(one);
                let (dx, dy) = (x - bx * along, y);
                let square = dx.square() + dy.square();

                let (wx, ex) = (x - bx, cx - bx);
                let along = ((wx * ex + y * cy) * bc).max(zero).min(one);
                let (tx, ty) = (wx - ex * along, y - cy * along);
                let other = tx.square() + ty.square();
                let is_nearer = other.lt(square);
                let (dx, dy) = (S::select(is_nearer, tx, dx), S::select(is_nearer, ty, dy));
                let square = square.min(other);

                let along = ((x * cx + y * cy) * ac).max(zero).min(one);
                let (tx, ty) = (x - cx * along, y - cy * along);
                let other = tx.square() + ty.square();
                let is_nearer = other.lt(square);
                let (dx, dy) = (S::select(is_nearer, tx, dx), S::select(is_nearer, ty, dy));
                let square = square.min(other);

                let is_within = zero.lt(y) & (cy * wx).lt(ex * y) & (cx * y).lt(cy * x);
                let (dx, dy) = (S::select(is_within, zero, dx), S::select(is_within, zero, dy));
                let square = S::select(is_within, zero, square) + z.square();
                // Where two edges are as near, an enclosure of the way from them holds all between.
                [nearest.min(S::length3(dx, dy, z).agreed(square.sqrt()))]
            },
        );
        nearest - c.at(RADIUS)
    }
}

/// How far triangles may be from the surface, as a share of the largest edge of the box around its control points, if the user says
/// nothing else.
const DEFAULT_TOLERANCE: f64 = 1e-3;

/// How far triangles may be from the surface.
pub(crate) const TOLERANCE: Param = Param::optional(
    "tolerance",
    ParamKind::Length,
    &[0.0],
    "How far the triangles that stand for the surface may be from it; 0 is a thousandth of the largest edge of the box around the \
     control points. At most 20000 triangles are possible.",
);

/// Corners nearer to each other than this share of the size are the same.
const POINT: f64 = 1e-9;

/// The arguments for rows of points.
pub(crate) fn of_rows<V: Into<Value>, R: IntoIterator<Item = [V; N]>, const N: usize>(
    rows: impl IntoIterator<Item = R>,
) -> Vec<Value> {
    let row = |row: R| {
        let mut points = row.into_iter().peekable();
        let mut out = Vec::new();
        while let Some(point) = points.next() {
            out.extend(point.map(Into::into));
            out.push(u8::from(points.peek().is_none()).into());
        }
        out
    };
    rows.into_iter().flat_map(row).collect()
}

/// The rows of a net, with points `(w x, w y, w z, w)`; weights are 1 if it has none.
pub(crate) fn rows_of(net: &[f64], kind: ParamKind) -> Vec<Vec<DVec4>> {
    let (width, has_weights) = (kind.width(), kind == ParamKind::WeightedNet);
    let points: Vec<&[f64]> = net.chunks_exact(width).collect();
    let point = |point: &&[f64]| {
        let weight = if has_weights { point[3] } else { 1.0 };
        (DVec3::from_slice(point) * weight).extend(weight)
    };
    points.split_inclusive(|point| point[width - 1] != 0.0).map(|row| row.iter().map(point).collect()).collect()
}

/// The largest edge of the box around all control points.
fn size_of(patches: &Patches) -> f64 {
    let places = || patches.iter().flatten().flat_map(BezierPatch::points).map(|point| point.truncate() / point.w);
    let low = places().fold(DVec3::INFINITY, DVec3::min);
    let high = places().fold(DVec3::NEG_INFINITY, DVec3::max);
    (high - low).max_element()
}

/// The surface, cut for a tolerance that the user gave.
fn cut(patches: Patches, tolerance: f64) -> Result<Cut, f64> {
    let tolerance = if tolerance > 0.0 { tolerance } else { size_of(&patches) * DEFAULT_TOLERANCE };
    Cut::new(patches, tolerance)
}

/// What is wrong with a surface for the sheet of this name.
///
/// # Errors
/// The fault.
pub(crate) fn check(name: &str, patches: Result<Patches, String>, tolerance: f64) -> Result<(), String> {
    let patches = patches.map_err(|fault| format!("`{name}`: {fault}"))?;
    if size_of(&patches) <= 0.0 {
        return Err(format!("all points of `{name}` are in the same place"));
    }
    cut(patches, tolerance).map(|_| ()).map_err(|count| {
        format!(
            "`{name}` would take {count:.0} triangles, and at most {MOST_TRIANGLES} are possible: a larger `tolerance` takes fewer"
        )
    })
}

/// The arguments of [`Facets`] for the sheet of this name with these arguments, whose surface passed all checks.
pub(crate) fn along(
    name: &'static str,
    args: &[f64],
    [radius, tolerance]: [f64; 2],
    patches: impl FnOnce() -> Result<Patches, String>,
) -> Vec<f64> {
    remembered(name, args, || {
        let patches = patches().unwrap_or_default();
        let least = size_of(&patches) * POINT;
        let triangles = cut(patches, tolerance).map(|cut| cut.triangles()).unwrap_or_default();
        let is_point = |corners: &[DVec3; 3]| corners[1..].iter().all(|corner| corner.distance(corners[0]) <= least);
        let corners = triangles.into_iter().filter(|corners| !is_point(corners)).flatten();
        [radius].into_iter().chain(corners.flat_map(|corner| corner.to_array())).collect()
    })
}
