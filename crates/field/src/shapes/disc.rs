//! Disc without thickness. Exact, unsigned.

use crate::shape_prelude::*;

/// See [`disc`].
#[derive(Clone, Copy, Debug)]
pub struct Disc;

/// The descriptor of [`disc`].
pub static DISC: Shape = Shape::primitive::<Disc>();

/// A disc around the origin, across the z axis, as a sheet without thickness.
#[track_caller]
pub fn disc(radius: impl Into<Value>) -> Form<Disc> {
    Form::new(&DISC, [radius.into()])
}

impl Primitive for Disc {
    const ABOUT: About = About {
        name: "disc",
        summary: "A disc without thickness, around the origin and across its axis. It has no inside; `offset` gives it one, with a round rim.",
        params: &[Param::required("radius", ParamKind::Positive, "Distance of the rim from the origin."), AXIS],
        elsewhere: &["circle3", "udDisc", "fDisc"],
        example: r#"{ "offset": { "by": 0.06, "shape": { "disc": { "radius": 0.9 } } } }"#,
    };

    fn contract(_args: &[f64]) -> Contract {
        Contract::SHEET
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        args[0] * libm::hypot(direction.x, direction.y) + level * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [radius, _axis] = c.get();
        S::length2((S::length2(p.x, p.y) - radius).max(p.x.lift(0.0)), p.z)
    }
}
