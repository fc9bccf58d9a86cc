//! A square with half discs on two of its sides. Exact.

use super::outline::{Outline, closed};
use crate::shape_prelude::*;
use std::f64::consts::{PI, SQRT_2};

/// See [`heart`].
#[derive(Clone, Copy, Debug)]
pub struct Heart;

/// The descriptor of [`heart`].
pub static HEART: Shape = Shape::special::<Heart>();

/// A heart: a square on its corner with a half disc on each of the upper sides. Its tip points down, and its box is centred at
/// the origin.
#[track_caller]
pub fn heart(width: impl Into<Value>) -> Form<Heart> {
    Form::new(&HEART, [width.into()])
}

impl Special for Heart {
    type General = Outline;

    const ABOUT: About = About {
        name: "heart",
        summary: "A plane figure: a heart, made of a square and two half discs.",
        params: &[Param::required("width", ParamKind::Positive, "Full width along x.")],
        elsewhere: &["sdHeart"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "heart": { "width": 1.8 } } } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width] = args else { unreachable!("one number") };
        let half_diagonal = width / (1.0 + SQRT_2);
        // The half discs reach as far above the middles of their sides as those sides are long, halved.
        let top = half_diagonal / 2.0 + half_diagonal / SQRT_2;
        let shift = (half_diagonal - top) / 2.0;
        closed(&[
            [0.0, shift - half_diagonal, 0.0],
            [half_diagonal, shift, PI],
            [0.0, shift + half_diagonal, PI],
            [-half_diagonal, shift, 0.0],
        ])
    }
}
