//! Regular octahedron. Exact: folded into one face, whose corners and edges count where the foot of the perpendicular lies beside
//! it.

use crate::shape_prelude::*;

/// See [`octahedron`].
#[derive(Clone, Copy, Debug)]
pub struct Octahedron;

/// The descriptor of [`octahedron`].
pub static OCTAHEDRON: Shape = Shape::primitive::<Octahedron>();

/// An octahedron with corners on the axes at this distance from the origin.
#[track_caller]
pub fn octahedron(radius: impl Into<Value>) -> Form<Octahedron> {
    Form::new(&OCTAHEDRON, [radius.into()])
}

impl Primitive for Octahedron {
    const ABOUT: About = About {
        name: "octahedron",
        summary: "A regular octahedron with its corners on the axes.",
        params: &[Param::required("radius", ParamKind::Positive, "Distance of the corners from the origin.")],
        elsewhere: &["sdOctahedron"],
        example: r#"{ "octahedron": { "radius": 1 } }"#,
    };

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        args[0] * direction.abs().max_element() + level * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [radius] = c.get();
        let (zero, third) = (p.x.lift(0.0), p.x.lift(1.0 / 3.0));
        let p = p.abs();
        // Of the nearest point of the face's plane, the coordinates that count from its corners; below 0 it lies beside.
        let lift = (p.x + p.y + p.z - radius) * third;
        let q = p - vec3(lift, lift, lift);
        // Where one of these is negative, an edge is nearer.
        let (is_x, is_y, is_z) = (q.x.lt(zero), q.y.lt(zero), q.z.lt(zero));
        let of_face = lift * p.x.lift(3f64.sqrt());
        let of_z = S::select(is_z, edge(p.x, p.y, p.z, radius), of_face);
        let of_y = S::select(is_y, edge(p.x, p.z, p.y, radius), of_z);
        S::select(is_x, edge(p.y, p.z, p.x, radius), of_y)
    }
}

/// The distance from the edge that joins corners on two axes, by the coordinates along these and across both.
#[inline(always)]
fn edge<S: Scalar>(a: S, b: S, across: S, radius: S) -> S {
    let along = ((a - b + radius) * 0.5).max(a.lift(0.0)).min(radius);
    S::length3(a - along, b - (radius - along), across)
}
