//! Repetition around an axis, also along a helix: a union of copies, so that it is right for shapes of any size and place.

use super::rotate::ROTATE;
use super::translate::TRANSLATE;
use crate::shape_prelude::*;
use std::ops::Range;

/// See [`RepeatPolar::repeat_polar`].
#[derive(Clone, Copy, Debug)]
pub struct Polar;

/// The descriptor of [`RepeatPolar::repeat_polar`].
pub static REPEAT_POLAR: Shape = Shape::copies::<Polar>();

/// Copies of a shape around an axis.
pub trait RepeatPolar: Into<Field> {
    /// So many copies of the shape, turned about the z axis at even angles. `with("step", ...)` chooses the angle from one to
    /// the next, in radians, `with("rise", ...)` how far each lies above the one before, and `with("axis", ...)` another axis.
    #[track_caller]
    fn repeat_polar(self, count: u32) -> Field {
        Field::new(&REPEAT_POLAR, [count.into()], [self.into()])
    }
}

impl<F: Into<Field>> RepeatPolar for F {}

impl Copies for Polar {
    const ABOUT: About = About {
        name: "repeat_polar",
        summary: "Copies of a shape turned about an axis, and moved along it if they are to follow a helix.",
        params: &[
            Param::required(
                "count",
                ParamKind::Count(1, 10_000),
                "How many copies there are; the first one stays where it is.",
            ),
            Param::optional(
                "step",
                ParamKind::Angle,
                &[0.0],
                "Degrees from one copy to the next; 0 for an even spread all around.",
            ),
            Param::optional(
                "rise",
                ParamKind::Number,
                &[0.0],
                "How far each copy lies beyond the one before along the axis.",
            ),
            AXIS,
        ],
        elsewhere: &["circular_array", "radial", "pModPolar", "repeat_radial", "helix"],
        example: r#"{ "repeat_polar": { "count": 7, "shape": {
            "translate": { "by": [0.8, 0, 0], "shape": { "box": { "size": [0.3, 0.3, 0.6], "round": 0.05 } } } } } }"#,
    };

    const COUNTED: Range<usize> = 0..1;

    fn count(args: &[f64]) -> usize {
        args[0] as usize
    }

    fn places(args: &[f64], index: usize) -> Vec<PlaceCall> {
        let &[count, step, rise, axis] = args else { unreachable!("four numbers") };
        let step = if step == 0.0 { std::f64::consts::TAU / count } else { step };
        let axis = DVec3::AXES[axis as usize];
        let turn = [&axis.to_array()[..], &[step * index as f64]].concat();
        let mut places: Vec<PlaceCall> = Vec::new();
        if rise != 0.0 {
            places.push((&TRANSLATE, (axis * rise * index as f64).to_array().to_vec()));
        }
        places.push((&ROTATE, turn));
        places
    }
}
