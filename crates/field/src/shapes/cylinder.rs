//! Capped cylinder, optionally with rounded edges. Exact.
//!
//! Rotation about the axis reduces it to a rectangle in the half-plane of radius and height.

use crate::shape_prelude::*;

/// See [`cylinder`].
#[derive(Clone, Copy, Debug)]
pub struct Cylinder;

/// The descriptor of [`cylinder`].
pub static CYLINDER: Shape = Shape::primitive::<Cylinder>();

/// A cylinder of some radius and full height, its middle at the origin.
#[track_caller]
pub fn cylinder(radius: impl Into<Value>, height: impl Into<Value>) -> Form<Cylinder> {
    Form::new(&CYLINDER, [radius.into(), height.into()])
}

impl Form<Cylinder> {
    /// Rounds the two edges with this radius; the size stays.
    #[must_use]
    pub fn round(self, radius: impl Into<Value>) -> Self {
        self.with("round", &[radius.into()])
    }
}

impl Primitive for Cylinder {
    const ABOUT: About = About {
        name: "cylinder",
        summary: "A cylinder with flat ends, its middle at the origin.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Distance from the axis to the side."),
            Param::required("height", ParamKind::Positive, "Full height, from end to end."),
            Param::optional("round", ParamKind::Length, &[0.0], "Radius of the rounded edges; the size stays."),
            AXIS,
        ],
        elsewhere: &["capped cylinder", "sdCappedCylinder", "rounded_cylinder"],
        example: r#"{ "cylinder": { "radius": 0.7, "height": 1.6, "round": 0.1 } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[radius, height, round, _axis] = args else { unreachable!("four numbers") };
        if round > radius || round > height / 2.0 {
            return Err("`round` of `cylinder` must not exceed the radius or half the height".into());
        }
        Ok(())
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        let &[radius, height, round, _axis] = args else { unreachable!("four numbers") };
        vec![radius - round, height / 2.0 - round, round]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let &[radius, height, round, _axis] = args else { unreachable!("four numbers") };
        let across = libm::hypot(direction.x, direction.y);
        (radius - round) * across + (height / 2.0 - round) * direction.z.abs() + (round + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [radius, half_height, round] = c.get();
        let side = S::length2(p.x, p.y) - radius;
        let end = p.z.abs() - half_height;
        let zero = p.x.lift(0.0);
        S::length2(side.max(zero), end.max(zero)) + zero.min(side.max(end)) - round
    }
}
