//! Rotation about an axis through the origin. Keeps exactness.

use crate::shape_prelude::*;

/// See [`Rotate::rotate`].
#[derive(Clone, Copy, Debug)]
pub struct Rotation;

/// The descriptor of [`Rotate::rotate`].
pub static ROTATE: Shape = Shape::place::<Rotation>();

/// Turning a shape about an axis.
pub trait Rotate: Into<Field> {
    /// The shape turned about an axis through the origin by an angle in degrees, counter-clockwise seen from the tip of
    /// the axis.
    #[track_caller]
    fn rotate(self, axis: impl Into<Triple>, degrees: f64) -> Field {
        let [x, y, z] = axis.into().0;
        Field::new(&ROTATE, [x, y, z, degrees.to_radians().into()], [self.into()])
    }
}

impl<F: Into<Field>> Rotate for F {}

impl Place for Rotation {
    const ABOUT: About = About {
        name: "rotate",
        summary: "Turns a shape about an axis through the origin.",
        params: &[
            Param::required("axis", ParamKind::Direction, "The axis."),
            Param::required("angle", ParamKind::Angle, "Counter-clockwise seen from the tip of the axis, in degrees."),
        ],
        elsewhere: &["rotate_axis"],
        example: r#"{ "rotate": { "axis": "y", "angle": 30, "shape": { "box": { "size": [1.6, 1, 0.6] } } } }"#,
    };

    fn map(args: &[f64]) -> DAffine3 {
        DAffine3::from_axis_angle(DVec3::from_slice(args).normalize(), args[3])
    }
}
