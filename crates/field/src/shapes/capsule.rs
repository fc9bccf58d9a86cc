//! Capsule: all points near a segment. Exact.

use crate::shape_prelude::*;

/// See [`capsule`].
#[derive(Clone, Copy, Debug)]
pub struct Capsule;

/// The descriptor of [`capsule`].
pub static CAPSULE: Shape = Shape::primitive::<Capsule>();

/// A rod with round ends: all points within `radius` of the segment between two points.
#[track_caller]
pub fn capsule(from: impl Into<Triple>, to: impl Into<Triple>, radius: impl Into<Value>) -> Form<Capsule> {
    let ([a, b, c], [d, e, f]) = (from.into().0, to.into().0);
    Form::new(&CAPSULE, [a, b, c, d, e, f, radius.into()])
}

impl Primitive for Capsule {
    const ABOUT: About = About {
        name: "capsule",
        summary: "A rod with round ends: all points near a segment.",
        params: &[
            Param::required("from", ParamKind::Vector, "One end of the segment."),
            Param::required("to", ParamKind::Vector, "The other end of the segment."),
            Param::required("radius", ParamKind::Positive, "Distance from the segment to the surface."),
        ],
        elsewhere: &["line3", "segment", "sdCapsule"],
        example: r#"{ "capsule": { "from": [-0.6, 0, -0.4], "to": [0.6, 0, 0.4], "radius": 0.4 } }"#,
    };

    fn prepare(args: &[f64]) -> Vec<f64> {
        let (from, to) = (DVec3::from_slice(args), DVec3::from_slice(&args[3..]));
        let along = to - from;
        // A segment of no length is a point; any finite factor does, since it multiplies 0.
        let inverse = if along.length_squared() > 0.0 { 1.0 / along.length_squared() } else { 0.0 };
        vec![from.x, from.y, from.z, along.x, along.y, along.z, inverse, args[6]]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let (from, to) = (DVec3::from_slice(args), DVec3::from_slice(&args[3..]));
        direction.dot(from).max(direction.dot(to)) + (args[6] + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [ax, ay, az, bx, by, bz, inverse, radius] = c.get();
        segment(p, vec3(ax, ay, az), vec3(bx, by, bz), inverse) - radius
    }
}

/// The distance from the segment that starts at `from` and goes `along`; `inverse` is 1 / |along|^2.
#[inline(always)]
pub(crate) fn segment<S: Scalar>(p: Vec3<S>, from: Vec3<S>, along: Vec3<S>, inverse: S) -> S {
    let q = p - from;
    let share = (q.dot(along) * inverse).clamp(0.0, 1.0);
    (q - along * share).length()
}
