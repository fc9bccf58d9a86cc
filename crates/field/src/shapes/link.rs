//! Link of a chain: a ring pulled apart. Exact.

use crate::shape_prelude::*;

/// See [`link`].
#[derive(Clone, Copy, Debug)]
pub struct Link;

/// The descriptor of [`link`].
pub static LINK: Shape = Shape::primitive::<Link>();

/// A torus cut in two halves that lie `length` apart along z, joined by straight pieces; it lies in the plane of x and z.
#[track_caller]
pub fn link(length: impl Into<Value>, major: impl Into<Value>, minor: impl Into<Value>) -> Form<Link> {
    Form::new(&LINK, [length.into(), major.into(), minor.into()])
}

impl Primitive for Link {
    const ABOUT: About = About {
        name: "link",
        summary: "A link of a chain: two halves of a ring, joined by straight pieces.",
        params: &[
            Param::required("length", ParamKind::Length, "Length of the straight pieces."),
            Param::required("major", ParamKind::Positive, "Radius of the circle in the middle of the tube."),
            Param::required("minor", ParamKind::Positive, "Radius of the tube."),
            AXIS,
        ],
        elsewhere: &["sdLink", "chain link"],
        example: r#"{ "link": { "length": 0.8, "major": 0.5, "minor": 0.18 } }"#,
    };

    fn prepare(args: &[f64]) -> Vec<f64> {
        vec![args[0] / 2.0, args[1], args[2]]
    }

    fn contract(args: &[f64]) -> Contract {
        let overlaps = args[2] > args[1];
        Contract { inside: if overlaps { Metric::Bound } else { Metric::Exact }, ..Contract::EXACT }
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let ring = args[1] * libm::hypot(direction.x, direction.z);
        args[0] / 2.0 * direction.z.abs() + ring + (args[2] + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [half, major, minor] = c.get();
        let end = (p.z.abs() - half).max(p.z.lift(0.0));
        S::length2(S::length2(p.x, end) - major, p.y) - minor
    }
}
