//! The ball around the origin. Exact.

use crate::shape_prelude::*;

/// See [`sphere`].
#[derive(Clone, Copy, Debug)]
pub struct Sphere;

/// The descriptor of [`sphere`].
pub static SPHERE: Shape = Shape::primitive::<Sphere>();

/// A ball around the origin.
#[track_caller]
pub fn sphere(radius: impl Into<Value>) -> Form<Sphere> {
    Form::new(&SPHERE, [radius.into()])
}

impl Primitive for Sphere {
    const ABOUT: About = About {
        name: "sphere",
        summary: "A ball around the origin.",
        params: &[Param::required("radius", ParamKind::Positive, "Distance from the centre to the surface.")],
        elsewhere: &["ball", "sdSphere"],
        example: r#"{ "sphere": { "radius": 1 } }"#,
    };

    const MODELS: Option<PrimitiveKernel> = Some(primitive_models::<Self>);

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        (args[0] + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [radius] = c.get();
        p.length() - radius
    }
}
