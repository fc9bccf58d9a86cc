//! Shear: one coordinate moves with another one.

use crate::shape_prelude::*;

/// See [`Shear::shear`].
#[derive(Clone, Copy, Debug)]
pub struct Shearing;

/// The descriptor of [`Shear::shear`].
pub static SHEAR: Shape = Shape::place::<Shearing>();

/// The coordinate that is moved, and the one that it moves with.
const PLANES: &[&str] = &["xy", "xz", "yx", "yz", "zx", "zy"];

/// Shearing a shape.
pub trait Shear: Into<Field> {
    /// The shape sheared: `plane` names the coordinate that is moved and the one that it moves with, such as "xz"; `by` is how
    /// far it moves for each unit of that.
    #[track_caller]
    fn shear(self, plane: &str, by: impl Into<Value>) -> Field {
        let plane = PLANES.iter().position(|&name| name == plane).expect("two different letters of x, y and z");
        Field::new(&SHEAR, [(plane as u32).into(), by.into()], [self.into()])
    }
}

impl<F: Into<Field>> Shear for F {}

impl Place for Shearing {
    const ABOUT: About = About {
        name: "shear",
        summary: "Moves one coordinate of a shape with another one: cuts slide along each other.",
        params: &[
            Param::required(
                "plane",
                ParamKind::Choice(PLANES),
                "The coordinate that is moved, and the one that it moves with: \"xz\" leans a shape that stands along z towards x.",
            ),
            Param::required("by", ParamKind::Number, "How far it moves for each unit of the other coordinate."),
        ],
        elsewhere: &["skew", "opShear", "shear_x_y"],
        example: r#"{ "shear": { "plane": "xz", "by": 0.4, "shape": { "box": { "size": [1.2, 1, 1.2], "round": 0.1 } } } }"#,
    };

    const IS_RIGID: bool = false;

    fn map(args: &[f64]) -> DAffine3 {
        let name = PLANES[args[0] as usize].as_bytes();
        let [moved, with] = [0, 1].map(|place| usize::from(name[place] - b'x'));
        let mut matrix = DMat3::IDENTITY;
        matrix.col_mut(with)[moved] = args[1];
        DAffine3::from_mat3(matrix)
    }

    /// The smaller singular value of a shear.
    fn factor(args: &[f64]) -> f64 {
        let by = args[1].abs();
        2.0 / (by + (by * by + 4.0).sqrt())
    }

    fn is_similarity(args: &[f64]) -> bool {
        args[1] == 0.0
    }
}
