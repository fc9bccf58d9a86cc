//! Circle in the plane. Exact.

use crate::shape_prelude::*;

/// See [`circle`].
#[derive(Clone, Copy, Debug)]
pub struct Circle;

/// The descriptor of [`circle`].
pub static CIRCLE: Shape = Shape::primitive::<Circle>();

/// A filled circle around the origin of the plane.
#[track_caller]
pub fn circle(radius: impl Into<Value>) -> Form<Circle> {
    Form::new(&CIRCLE, [radius.into()])
}

impl Primitive for Circle {
    const ABOUT: About = About {
        name: "circle",
        summary: "A plane figure: a filled circle around the origin.",
        params: &[Param::required("radius", ParamKind::Positive, "Distance of the edge from the origin.")],
        elsewhere: &["disk", "sdCircle", "circle2"],
        example: r#"{ "extrude": { "height": 0.6, "shape": { "circle": { "radius": 0.8 } } } }"#,
    };

    const DIMENSION: Dimension = Dimension::Plane;

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        in_plane(direction, |across| (args[0] + level) * across)
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [radius] = c.get();
        S::length2(p.x, p.y) - radius
    }
}
