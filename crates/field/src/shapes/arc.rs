//! Arc with a width and round ends. Exact.

use super::outline::{Outline, closed};
use super::sector::part_of_turn;
use crate::shape_prelude::*;
use std::f64::consts::PI;

/// See [`arc`].
#[derive(Clone, Copy, Debug)]
pub struct Arc;

/// The descriptor of [`arc`].
pub static ARC: Shape = Shape::special::<Arc>();

/// All that a disc of this width fills while its middle moves along an arc around the origin. The arc takes up an angle in
/// degrees, half of it to each side of the y axis.
#[track_caller]
pub fn arc(radius: impl Into<Value>, width: impl Into<Value>, degrees: f64) -> Form<Arc> {
    Form::new(&ARC, [radius.into(), width.into(), degrees.to_radians().into()])
}

impl Special for Arc {
    type General = Outline;

    const ABOUT: About = About {
        name: "arc",
        summary: "A plane figure: a wide line along an arc, with round ends, half of it to each side of the y axis.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the arc, in the middle of the line."),
            Param::required("width", ParamKind::Positive, "Width of the line, at most twice the radius."),
            Param::required(
                "angle",
                ParamKind::Angle,
                "How much of the circle there is: degrees, above 0 and below 360.",
            ),
        ],
        elsewhere: &["sdArc"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "arc": { "radius": 0.8, "width": 0.3, "angle": 220 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[radius, width, angle] = args else { unreachable!("three numbers") };
        if width > 2.0 * radius {
            return Err("`width` of `arc` must not exceed twice the radius".into());
        }
        // Ends that run into one another would count as outside where they overlap.
        let gap = 2.0 * radius * libm::sin(angle / 2.0);
        if angle > PI && gap < width {
            return Err("the ends of `arc` overlap; use a smaller `angle`, or a `ring`".into());
        }
        part_of_turn("arc", angle)
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[radius, width, angle] = args else { unreachable!("three numbers") };
        let (sin, cos) = libm::sincos(angle / 2.0);
        let (outer, inner) = (radius + width / 2.0, radius - width / 2.0);
        closed(&[
            [outer * sin, outer * cos, angle],
            [-outer * sin, outer * cos, PI],
            [-inner * sin, inner * cos, -angle],
            [inner * sin, inner * cos, PI],
        ])
    }
}
