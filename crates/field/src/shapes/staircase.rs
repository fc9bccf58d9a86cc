//! Steps with one base. Exact.

use super::polygon::Polygon;
use crate::shape_prelude::*;

/// See [`staircase`].
#[derive(Clone, Copy, Debug)]
pub struct Staircase;

/// The descriptor of [`staircase`].
pub static STAIRCASE: Shape = Shape::special::<Staircase>();

/// A staircase that rises from left to right. Its box is centred at the origin.
#[track_caller]
pub fn staircase(width: impl Into<Value>, height: impl Into<Value>, steps: u32) -> Form<Staircase> {
    Form::new(&STAIRCASE, [width.into(), height.into(), steps.into()])
}

impl Special for Staircase {
    type General = Polygon;

    const ABOUT: About = About {
        name: "staircase",
        summary: "A plane figure: a staircase that rises from left to right.",
        params: &[
            Param::required("size", ParamKind::Size2, "Full width and full height."),
            Param::required("steps", ParamKind::Count(1, 200), "How many steps it has."),
        ],
        elsewhere: &["sdStairs", "stairs2"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "staircase": { "size": [1.6, 1.2], "steps": 4 } } } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width, height, steps] = args else { unreachable!("three numbers") };
        let (x, y) = (width / 2.0, height / 2.0);
        let mut corners = vec![-x, -y, x, -y];
        // Down the steps from the right.
        for step in (1..=steps as u32).rev() {
            let top = -y + height * f64::from(step) / steps;
            corners.extend([-x + width * f64::from(step) / steps, top, -x + width * f64::from(step - 1) / steps, top]);
        }
        corners
    }
}
