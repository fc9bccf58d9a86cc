//! Scaling by different factors along the axes: min |a_i| f(S^-1 p). A bound.

use crate::shape_prelude::*;

/// See [`Stretch::stretch`].
#[derive(Clone, Copy, Debug)]
pub struct Stretching;

/// The descriptor of [`Stretch::stretch`].
pub static STRETCH: Shape = Shape::place::<Stretching>();

/// Scaling a shape differently along the axes.
pub trait Stretch: Into<Field> {
    /// The shape scaled about the origin by a factor for each axis.
    #[track_caller]
    fn stretch(self, factors: impl Into<Triple>) -> Field {
        Field::new(&STRETCH, factors.into().0, [self.into()])
    }
}

impl<F: Into<Field>> Stretch for F {}

impl Place for Stretching {
    const ABOUT: About = About {
        name: "stretch",
        summary: "Scales a shape by a factor for each axis. Its field is then only a bound.",
        params: &[Param::required("factors", ParamKind::Factors, "The factors along x, y and z.")],
        elsewhere: &["non-uniform scale"],
        example: r#"{ "stretch": { "factors": [1.4, 1, 0.6], "shape": { "torus": { "major": 0.7, "minor": 0.3 } } } }"#,
    };

    const IS_RIGID: bool = false;

    fn map(args: &[f64]) -> DAffine3 {
        DAffine3::from_scale(DVec3::from_slice(args))
    }

    fn factor(args: &[f64]) -> f64 {
        DVec3::from_slice(args).abs().min_element()
    }

    fn is_similarity(args: &[f64]) -> bool {
        let factors = DVec3::from_slice(args).abs();
        factors.min_element() == factors.max_element()
    }
}
