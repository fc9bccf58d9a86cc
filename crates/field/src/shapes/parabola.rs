//! Figure within a parabola, up to a height. Exact: a hyperbola whose centre is infinitely far.

use super::hyperbola::{Hyperbola, radius_of_parabola};
use crate::shape_prelude::*;

/// See [`parabola`].
#[derive(Clone, Copy, Debug)]
pub struct Parabola;

/// The descriptor of [`parabola`].
pub static PARABOLA: Shape = Shape::special::<Parabola>();

/// A figure that opens upwards within a parabola, with this full width and height. Its box is centred at the origin.
#[track_caller]
pub fn parabola(width: impl Into<Value>, height: impl Into<Value>) -> Form<Parabola> {
    Form::new(&PARABOLA, [width.into(), height.into()])
}

impl Special for Parabola {
    type General = Hyperbola;

    const ABOUT: About = About {
        name: "parabola",
        summary: "A plane figure within a parabola, which opens upwards, up to some height.",
        params: &[
            Param::required("width", ParamKind::Positive, "Full width at the upper end."),
            Param::required("height", ParamKind::Positive, "Full height; the vertex is the lowest point."),
        ],
        elsewhere: &["sdParabola", "sdParabolaSegment", "parabola_segment"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "parabola": { "width": 1.6, "height": 1.6 } } } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        vec![args[0], args[1], radius_of_parabola(args[0], args[1])]
    }
}
