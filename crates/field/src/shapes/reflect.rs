//! Reflection at a plane. Keeps exactness.

use crate::shape_prelude::*;

/// See [`Reflect::reflect`].
#[derive(Clone, Copy, Debug)]
pub struct Reflection;

/// The descriptor of [`Reflect::reflect`].
pub static REFLECT: Shape = Shape::place::<Reflection>();

/// Mirroring a shape.
pub trait Reflect: Into<Field> {
    /// The mirror image of the shape at the plane through the origin with this normal.
    #[track_caller]
    fn reflect(self, normal: impl Into<Triple>) -> Field {
        Field::new(&REFLECT, normal.into().0, [self.into()])
    }
}

impl<F: Into<Field>> Reflect for F {}

impl Place for Reflection {
    const ABOUT: About = About {
        name: "reflect",
        summary: "The mirror image of a shape at a plane.",
        params: &[
            Param::required("normal", ParamKind::Direction, "Normal of the mirror."),
            Param::optional(
                "offset",
                ParamKind::Number,
                &[0.0],
                "Distance of the mirror from the origin, along its normal.",
            ),
        ],
        elsewhere: &["mirror"],
        example: r#"{ "reflect": { "normal": "x", "offset": 0.1, "shape":
            { "cone": { "bottom": 0.7, "height": 1.5, "axis": "x" } } } }"#,
    };

    fn map(args: &[f64]) -> DAffine3 {
        let n = DVec3::from_slice(args).normalize();
        let outer = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        DAffine3::from_mat3_translation(DMat3::IDENTITY - outer * 2.0, n * (2.0 * args[3]))
    }
}
