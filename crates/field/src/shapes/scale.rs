//! Uniform scaling: |a| f(p / a). Keeps exactness.

use crate::shape_prelude::*;

/// See [`Scale::scale`].
#[derive(Clone, Copy, Debug)]
pub struct Scaling;

/// The descriptor of [`Scale::scale`].
pub static SCALE: Shape = Shape::place::<Scaling>();

/// Making a shape larger or smaller.
pub trait Scale: Into<Field> {
    /// The shape scaled about the origin, in all directions alike.
    #[track_caller]
    fn scale(self, factor: impl Into<Value>) -> Field {
        Field::new(&SCALE, [factor.into()], [self.into()])
    }
}

impl<F: Into<Field>> Scale for F {}

impl Place for Scaling {
    const ABOUT: About = About {
        name: "scale",
        summary: "Makes a shape larger or smaller, in all directions alike.",
        params: &[Param::required(
            "factor",
            ParamKind::Factor,
            "The factor; a negative one also reflects at the origin.",
        )],
        elsewhere: &[],
        example: r#"{ "scale": { "factor": 1.5, "shape": { "torus": { "major": 0.5, "minor": 0.2 } } } }"#,
    };

    const IS_RIGID: bool = false;

    fn map(args: &[f64]) -> DAffine3 {
        DAffine3::from_scale(DVec3::splat(args[0]))
    }

    fn factor(args: &[f64]) -> f64 {
        args[0].abs()
    }
}
