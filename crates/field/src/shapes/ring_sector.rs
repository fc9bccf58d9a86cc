//! Sector of a ring, with straight ends. Exact.

use super::outline::{Outline, closed};
use super::sector::part_of_turn;
use crate::shape_prelude::*;

/// See [`ring_sector`].
#[derive(Clone, Copy, Debug)]
pub struct RingSector;

/// The descriptor of [`ring_sector`].
pub static RING_SECTOR: Shape = Shape::special::<RingSector>();

/// What a sector of the plane has of a ring. It takes up an angle in degrees, half of it to each side of the y axis.
#[track_caller]
pub fn ring_sector(outer: impl Into<Value>, inner: impl Into<Value>, degrees: f64) -> Form<RingSector> {
    Form::new(&RING_SECTOR, [outer.into(), inner.into(), degrees.to_radians().into()])
}

impl Special for RingSector {
    type General = Outline;

    const ABOUT: About = About {
        name: "ring_sector",
        summary: "A plane figure: the sector of a ring, half of it to each side of the y axis.",
        params: &[
            Param::required("outer", ParamKind::Positive, "Radius of the outer circle."),
            Param::required("inner", ParamKind::Positive, "Radius of the hole."),
            Param::required(
                "angle",
                ParamKind::Angle,
                "How much of the ring there is: degrees, above 0 and below 360.",
            ),
        ],
        elsewhere: &["sdRing", "flat_ended_arc", "annular sector"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "ring_sector": { "outer": 1, "inner": 0.6, "angle": 200 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[outer, inner, angle] = args else { unreachable!("three numbers") };
        if inner >= outer {
            return Err("`inner` of `ring_sector` must be below `outer`".into());
        }
        part_of_turn("ring_sector", angle)
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[outer, inner, angle] = args else { unreachable!("three numbers") };
        let (sin, cos) = libm::sincos(angle / 2.0);
        closed(&[
            [outer * sin, outer * cos, angle],
            [-outer * sin, outer * cos, 0.0],
            [-inner * sin, inner * cos, -angle],
            [inner * sin, inner * cos, 0.0],
        ])
    }
}
