//! Rotation by a quaternion. Keeps exactness.

use crate::shape_prelude::*;

/// See [`RotateQuaternion::rotate_quaternion`].
#[derive(Clone, Copy, Debug)]
pub struct QuaternionRotation;

/// The descriptor of [`RotateQuaternion::rotate_quaternion`].
pub static ROTATE_QUATERNION: Shape = Shape::place::<QuaternionRotation>();

/// Turning a shape by a quaternion.
pub trait RotateQuaternion: Into<Field> {
    /// The shape turned by the quaternion x i + y j + z k + w, whose length does not matter.
    #[track_caller]
    fn rotate_quaternion(self, xyzw: [f64; 4]) -> Field {
        Field::new(&ROTATE_QUATERNION, xyzw.map(Value::from), [self.into()])
    }
}

impl<F: Into<Field>> RotateQuaternion for F {}

impl Place for QuaternionRotation {
    const ABOUT: About = About {
        name: "rotate_quaternion",
        summary: "Turns a shape by a quaternion.",
        params: &[Param::required(
            "quaternion",
            ParamKind::Quaternion,
            "x, y, z and w (the real part); the length does not matter.",
        )],
        elsewhere: &[],
        example: r#"{ "rotate_quaternion": { "quaternion": [0, 0.26, 0, 0.97], "shape": { "box": { "size": [1.6, 1, 0.6] } } } }"#,
    };

    fn map(args: &[f64]) -> DAffine3 {
        DAffine3::from_quat(DQuat::from_slice(args).normalize())
    }
}
