//! Torus. Exact; inside only a bound where the tube overlaps itself.

use crate::shape_prelude::*;

/// See [`torus`].
#[derive(Clone, Copy, Debug)]
pub struct Torus;

/// The descriptor of [`torus`].
pub static TORUS: Shape = Shape::primitive::<Torus>();

/// A ring: a tube of radius `minor` around a circle of radius `major`.
#[track_caller]
pub fn torus(major: impl Into<Value>, minor: impl Into<Value>) -> Form<Torus> {
    Form::new(&TORUS, [major.into(), minor.into()])
}

impl Primitive for Torus {
    const ABOUT: About = About {
        name: "torus",
        summary: "A ring: a tube around a circle.",
        params: &[
            Param::required("major", ParamKind::Positive, "Radius of the circle in the middle of the tube."),
            Param::required("minor", ParamKind::Positive, "Radius of the tube."),
            AXIS,
        ],
        elsewhere: &["ring", "donut", "sdTorus"],
        example: r#"{ "torus": { "major": 0.8, "minor": 0.3 } }"#,
    };

    fn contract(args: &[f64]) -> Contract {
        let overlaps = args[1] > args[0];
        Contract { inside: if overlaps { Metric::Bound } else { Metric::Exact }, ..Contract::EXACT }
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        args[0] * libm::hypot(direction.x, direction.y) + (args[1] + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [major, minor] = c.get();
        S::length2(S::length2(p.x, p.y) - major, p.z) - minor
    }
}
