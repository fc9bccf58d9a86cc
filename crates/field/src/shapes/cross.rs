//! Two bars across one another. Exact.

use super::outline::{Outline, closed};
use crate::shape_prelude::*;
use std::f64::consts::FRAC_PI_2;

/// See [`cross`].
#[derive(Clone, Copy, Debug)]
pub struct Cross;

/// The descriptor of [`cross`].
pub static CROSS: Shape = Shape::special::<Cross>();

/// Two equal bars across one another along the axes. `with("round", ...)` rounds their ends.
#[track_caller]
pub fn cross(size: impl Into<Value>, width: impl Into<Value>) -> Form<Cross> {
    Form::new(&CROSS, [size.into(), width.into()])
}

impl Special for Cross {
    type General = Outline;

    const ABOUT: About = About {
        name: "cross",
        summary: "A plane figure: two equal bars across one another along the axes.",
        params: &[
            Param::required("size", ParamKind::Positive, "Full length of the bars."),
            Param::required("width", ParamKind::Positive, "Full width of the bars, less than the length."),
            Param::optional(
                "round",
                ParamKind::Length,
                &[0.0],
                "Radius of the corners at the ends, at most half the width; the size stays.",
            ),
        ],
        elsewhere: &["sdCross", "plus", "rounded_x", "sdRoundedX", "rounded_cross"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "cross": { "size": 1.8, "width": 0.6, "round": 0.15 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[size, width, round] = args else { unreachable!("three numbers") };
        if width >= size {
            return Err("`width` of `cross` must be below `size`".into());
        }
        if round > width / 2.0 || round > (size - width) / 2.0 {
            return Err("`round` of `cross` must not exceed half the width, or the length of an arm".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[size, width, round] = args else { unreachable!("three numbers") };
        let (end, side) = (size / 2.0, width / 2.0);
        // The right arm from the lower notch on; the others are that one, turned.
        let arm = [
            [side, -side, 0.0],
            [end - round, -side, FRAC_PI_2],
            [end, -side + round, 0.0],
            [end, side - round, FRAC_PI_2],
            [end - round, side, 0.0],
        ];
        let arms = (0..4).flat_map(|quarter| {
            arm.map(|[x, y, turn]| match quarter {
                0 => [x, y, turn],
                1 => [-y, x, turn],
                2 => [-x, -y, turn],
                _ => [y, -x, turn],
            })
        });
        closed(&arms.collect::<Vec<_>>())
    }
}
