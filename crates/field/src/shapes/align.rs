//! Rotation that takes one direction to another. Keeps exactness.

use crate::shape_prelude::*;

/// See [`Align::align`].
#[derive(Clone, Copy, Debug)]
pub struct Alignment;

/// The descriptor of [`Align::align`].
pub static ALIGN: Shape = Shape::place::<Alignment>();

/// Turning a shape from one direction to another.
pub trait Align: Into<Field> {
    /// The shape turned the shortest way so that what points along `from` then points along `to`.
    #[track_caller]
    fn align(self, from: impl Into<Triple>, to: impl Into<Triple>) -> Field {
        let ([a, b, c], [d, e, f]) = (from.into().0, to.into().0);
        Field::new(&ALIGN, [a, b, c, d, e, f], [self.into()])
    }
}

impl<F: Into<Field>> Align for F {}

impl Place for Alignment {
    const ABOUT: About = About {
        name: "align",
        summary: "Turns a shape the shortest way so that one direction becomes another.",
        params: &[
            Param::required("from", ParamKind::Direction, "A direction of the shape."),
            Param::required("to", ParamKind::Direction, "Where it then points."),
        ],
        elsewhere: &["rotate_to", "orient", "look_at"],
        example: r#"{ "align": { "from": "z", "to": [1, 0.4, 0.6], "shape": { "cone": { "bottom": 0.6, "top": 0, "height": 1.6 } } } }"#,
    };

    fn map(args: &[f64]) -> DAffine3 {
        let [from, to] = [0, 3].map(|at| DVec3::from_slice(&args[at..]).normalize());
        DAffine3::from_quat(DQuat::from_rotation_arc(from, to))
    }
}
