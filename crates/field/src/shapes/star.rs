//! Star in the plane. Exact: a polygon with corners on two circles in turn.

use super::polygon::Polygon;
use crate::shape_prelude::*;
use std::f64::consts::PI;

/// See [`star`].
#[derive(Clone, Copy, Debug)]
pub struct Star;

/// The descriptor of [`star`].
pub static STAR: Shape = Shape::special::<Star>();

/// A star with so many tips at one distance from the origin, and notches between them at another one.
#[track_caller]
pub fn star(tips: u32, outer: impl Into<Value>, inner: impl Into<Value>) -> Form<Star> {
    Form::new(&STAR, [tips.into(), outer.into(), inner.into()])
}

impl Special for Star {
    type General = Polygon;

    const ABOUT: About = About {
        name: "star",
        summary: "A plane figure: a star around the origin, with one tip on the y axis.",
        params: &[
            Param::required("tips", ParamKind::Count(2, 100), "How many tips it has."),
            Param::required("outer", ParamKind::Positive, "Distance of the tips from the origin."),
            Param::required("inner", ParamKind::Positive, "Distance of the notches between them from the origin."),
        ],
        elsewhere: &["sdStar", "sdStar5", "hexagram", "pentagram"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "star": { "tips": 5, "outer": 1, "inner": 0.45 } } } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        let &[tips, outer, inner] = args else { unreachable!("three numbers") };
        let corner = |index: u32| {
            let (sin, cos) = libm::sincos(PI * f64::from(index) / tips);
            let radius = if index.is_multiple_of(2) { outer } else { inner };
            [radius * sin, radius * cos]
        };
        (0..2 * tips as u32).flat_map(corner).collect()
    }
}
