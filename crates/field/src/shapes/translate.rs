//! Translation. Keeps exactness.

use crate::shape_prelude::*;

/// See [`Translate::at`].
#[derive(Clone, Copy, Debug)]
pub struct Translation;

/// The descriptor of [`Translate::at`].
pub static TRANSLATE: Shape = Shape::place::<Translation>();

/// Moving a shape.
pub trait Translate: Into<Field> {
    /// The shape moved by a displacement; the origin goes to that point.
    #[track_caller]
    fn at(self, by: impl Into<Triple>) -> Field {
        Field::new(&TRANSLATE, by.into().0, [self.into()])
    }
}

impl<F: Into<Field>> Translate for F {}

impl Place for Translation {
    const ABOUT: About = About {
        name: "translate",
        summary: "Moves a shape.",
        params: &[Param::required("by", ParamKind::Vector, "The displacement.")],
        elsewhere: &["move", "at"],
        example: r#"{ "translate": { "by": [0, 0, 1], "shape": { "sphere": { "radius": 0.6 } } } }"#,
    };

    const IS_TRANSLATION: bool = true;

    fn map(args: &[f64]) -> DAffine3 {
        DAffine3::from_translation(DVec3::from_slice(args))
    }
}
