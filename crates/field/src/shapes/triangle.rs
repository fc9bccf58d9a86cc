//! Flat panels in space, without thickness: a triangle, and what all of them share. Exact, unsigned.

use super::polygon::{edges, polygon_distance};
use crate::shape_prelude::*;

/// The part of a plane within a polygon. Its arguments are its corners, all of them in that plane; the first three don't lie on a
/// line.
#[derive(Clone, Copy, Debug)]
pub struct Panel;

/// How many constants stand before those of the edges: the first corner, two directions in the plane, and its normal.
const FRAME: usize = 12;

/// Corners nearer than this to a line, as a share of the distances between them, lie on it.
const FLAT: f64 = 1e-9;

/// The normal of the plane through three points, if they don't lie on a line.
pub(crate) fn normal(corners: &[DVec3]) -> Option<DVec3> {
    let (a, b) = (corners[1] - corners[0], corners[2] - corners[0]);
    let normal = a.cross(b);
    (normal.length() > FLAT * a.length() * b.length()).then(|| normal.normalize())
}

fn corners(args: &[f64]) -> Vec<DVec3> {
    args.chunks_exact(3).map(DVec3::from_slice).collect()
}

impl Primitive for Panel {
    const ABOUT: About =
        About { name: "panel", summary: "A part of a plane.", params: &[], elsewhere: &[], example: "" };

    fn contract(_args: &[f64]) -> Contract {
        Contract::SHEET
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        let corners = corners(args);
        let along = (corners[1] - corners[0]).normalize_or(DVec3::X);
        let normal = normal(&corners).unwrap_or_else(|| along.any_orthonormal_vector());
        let across = normal.cross(along);
        let flat = |corner: &DVec3| {
            let from_first = *corner - corners[0];
            DVec2::new(from_first.dot(along), from_first.dot(across)).to_array()
        };
        let frame = [corners[0], along, across, normal];
        let flat: Vec<f64> = corners.iter().flat_map(flat).collect();
        frame.iter().flat_map(DVec3::to_array).chain(edges(&flat)).collect()
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let farthest = corners(args).into_iter().map(|corner| corner.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
        farthest + level * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [px, py, pz, ux, uy, uz, vx, vy, vz, nx, ny, nz] = c.get();
        let (q, zero) = (p - vec3(px, py, pz), p.x.lift(0.0));
        let flat = vec3(q.dot(vec3(ux, uy, uz)), q.dot(vec3(vx, vy, vz)), zero);
        let beside = polygon_distance(flat, &c.part(FRAME, c.count() - FRAME));
        S::length2(beside.max(zero), q.dot(vec3(nx, ny, nz)))
    }
}

/// See [`triangle`].
#[derive(Clone, Copy, Debug)]
pub struct Triangle;

/// The descriptor of [`triangle`].
pub static TRIANGLE: Shape = Shape::special::<Triangle>();

/// The triangle with these corners, as a sheet without thickness.
#[track_caller]
pub fn triangle(a: impl Into<Triple>, b: impl Into<Triple>, c: impl Into<Triple>) -> Form<Triangle> {
    Form::new(&TRIANGLE, [a.into().0, b.into().0, c.into().0].concat())
}

impl Special for Triangle {
    type General = Panel;

    const ABOUT: About = About {
        name: "triangle",
        summary: "A triangle in space, without thickness. It has no inside; `offset` gives it one, with round edges.",
        params: &[
            Param::required("a", ParamKind::Vector, "A corner."),
            Param::required("b", ParamKind::Vector, "Another corner."),
            Param::required("c", ParamKind::Vector, "The third corner."),
        ],
        elsewhere: &["triangle3", "udTriangle"],
        example: r#"{ "offset": { "by": 0.05, "shape":
            { "triangle": { "a": [-0.9, -0.6, -0.5], "b": [0.9, -0.4, -0.3], "c": [0, 0.6, 0.8] } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        match normal(&corners(args)) {
            Some(_) => Ok(()),
            None => Err("the corners of `triangle` lie on a line".into()),
        }
    }

    fn general(args: &[f64]) -> Vec<f64> {
        args.to_vec()
    }
}
