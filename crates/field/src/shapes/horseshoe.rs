//! Arc with straight legs. Exact.

use super::outline::{Outline, closed};
use super::sector::part_of_turn;
use crate::shape_prelude::*;
use std::f64::consts::PI;

/// See [`horseshoe`].
#[derive(Clone, Copy, Debug)]
pub struct Horseshoe;

/// The descriptor of [`horseshoe`].
pub static HORSESHOE: Shape = Shape::special::<Horseshoe>();

/// A wide line along an arc around the origin and on from its ends, straight. The arc takes up an angle in degrees, half of it to
/// each side of the lower half of the y axis.
#[track_caller]
pub fn horseshoe(
    radius: impl Into<Value>,
    width: impl Into<Value>,
    degrees: f64,
    length: impl Into<Value>,
) -> Form<Horseshoe> {
    Form::new(&HORSESHOE, [radius.into(), width.into(), degrees.to_radians().into(), length.into()])
}

impl Special for Horseshoe {
    type General = Outline;

    const ABOUT: About = About {
        name: "horseshoe",
        summary: "A plane figure: an arc with straight legs, open at the top.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the arc, in the middle of the line."),
            Param::required("width", ParamKind::Positive, "Width of the line, at most twice the radius."),
            Param::required("angle", ParamKind::Angle, "The angle of the arc: degrees, above 0 and below 360."),
            Param::required("length", ParamKind::Length, "Length of the straight legs."),
        ],
        elsewhere: &["sdHorseshoe", "u_shape"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "horseshoe": { "radius": 0.6, "width": 0.3, "angle": 200, "length": 0.5 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[radius, width, angle, length] = args else { unreachable!("four numbers") };
        if width > 2.0 * radius {
            return Err("`width` of `horseshoe` must not exceed twice the radius".into());
        }
        let (sin, cos) = libm::sincos(angle / 2.0);
        if angle > PI && (radius - width / 2.0) * sin + length * cos < 0.0 {
            return Err("the legs of `horseshoe` cross; make them shorter, or the angle smaller".into());
        }
        part_of_turn("horseshoe", angle)
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[radius, width, angle, length] = args else { unreachable!("four numbers") };
        let (sin, cos) = libm::sincos(angle / 2.0);
        let (outer, inner) = (radius + width / 2.0, radius - width / 2.0);
        // From the end of the arc on, a leg leads along the tangent.
        let right = |radius: f64, length: f64| [radius * sin + length * cos, -radius * cos + length * sin];
        let ([ax, ay], [bx, by], [cx, cy], [dx, dy]) =
            (right(outer, 0.0), right(outer, length), right(inner, length), right(inner, 0.0));
        closed(&[
            [-ax, ay, angle],
            [ax, ay, 0.0],
            [bx, by, 0.0],
            [cx, cy, 0.0],
            [dx, dy, -angle],
            [-dx, dy, 0.0],
            [-cx, cy, 0.0],
            [-bx, by, 0.0],
        ])
    }
}
