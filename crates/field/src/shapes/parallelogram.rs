//! Parallelogram. Exact.

use super::polygon::Polygon;
use crate::shape_prelude::*;

/// See [`parallelogram`].
#[derive(Clone, Copy, Debug)]
pub struct Parallelogram;

/// The descriptor of [`parallelogram`].
pub static PARALLELOGRAM: Shape = Shape::special::<Parallelogram>();

/// A parallelogram with two level sides, centred at the origin.
#[track_caller]
pub fn parallelogram(width: impl Into<Value>, height: impl Into<Value>, skew: impl Into<Value>) -> Form<Parallelogram> {
    Form::new(&PARALLELOGRAM, [width.into(), height.into(), skew.into()])
}

impl Special for Parallelogram {
    type General = Polygon;

    const ABOUT: About = About {
        name: "parallelogram",
        summary: "A plane figure: a parallelogram with two level sides.",
        params: &[
            Param::required("size", ParamKind::Size2, "Full length of the level sides, and full height."),
            Param::required(
                "skew",
                ParamKind::Number,
                "How much farther to the right the upper side lies than the lower one.",
            ),
        ],
        elsewhere: &["sdParallelogram", "sheared rectangle"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "parallelogram": { "size": [1.2, 1], "skew": 0.5 } } } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width, height, skew] = args else { unreachable!("three numbers") };
        let (x, y, lean) = (width / 2.0, height / 2.0, skew / 2.0);
        vec![-x - lean, -y, x - lean, -y, x + lean, y, -x + lean, y]
    }
}
