//! Rotation by Euler angles in the order z-y'-x''. Keeps exactness.

use crate::shape_prelude::*;

/// See [`RotateEuler::rotate_euler`].
#[derive(Clone, Copy, Debug)]
pub struct EulerRotation;

/// The descriptor of [`RotateEuler::rotate_euler`].
pub static ROTATE_EULER: Shape = Shape::place::<EulerRotation>();

/// Turning a shape by three angles.
pub trait RotateEuler: Into<Field> {
    /// The shape turned by three angles in degrees: first about x, then about y, then about z.
    #[track_caller]
    fn rotate_euler(self, degrees: [f64; 3]) -> Field {
        Field::new(&ROTATE_EULER, degrees.map(|angle| angle.to_radians().into()), [self.into()])
    }
}

impl<F: Into<Field>> RotateEuler for F {}

impl Place for EulerRotation {
    const ABOUT: About = About {
        name: "rotate_euler",
        summary: "Turns a shape by three angles: first about x, then about y, then about z (z-y'-x'').",
        params: &[Param::required("angles", ParamKind::Angles, "The angles about x, y and z, in degrees.")],
        elsewhere: &["yaw, pitch, roll"],
        example: r#"{ "rotate_euler": { "angles": [20, 30, 40], "shape": { "box": { "size": [1.6, 1, 0.6] } } } }"#,
    };

    fn map(args: &[f64]) -> DAffine3 {
        let &[x, y, z] = args else { unreachable!("three numbers") };
        DAffine3::from_mat3(DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x))
    }
}
