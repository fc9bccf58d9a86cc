//! Sector of a disc. Exact.

use super::outline::{Outline, closed};
use crate::shape_prelude::*;
use std::f64::consts::TAU;

/// See [`sector`].
#[derive(Clone, Copy, Debug)]
pub struct Sector;

/// The descriptor of [`sector`].
pub static SECTOR: Shape = Shape::special::<Sector>();

/// The part of a disc that a corner in its middle cuts out. It takes up an angle in degrees, half of it to each side of the y axis.
#[track_caller]
pub fn sector(radius: impl Into<Value>, degrees: f64) -> Form<Sector> {
    Form::new(&SECTOR, [radius.into(), degrees.to_radians().into()])
}

impl Special for Sector {
    type General = Outline;

    const ABOUT: About = About {
        name: "sector",
        summary: "A plane figure: the sector of a disc, half of it to each side of the y axis.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the disc."),
            Param::required("angle", ParamKind::Angle, "The angle in the middle: degrees, above 0 and below 360."),
        ],
        elsewhere: &["pie", "sdPie", "slice of cake"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "sector": { "radius": 1, "angle": 100 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[_radius, angle] = args else { unreachable!("two numbers") };
        part_of_turn("sector", angle)
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[radius, angle] = args else { unreachable!("two numbers") };
        let (sin, cos) = libm::sincos(angle / 2.0);
        closed(&[[0.0, 0.0, 0.0], [radius * sin, radius * cos, angle], [-radius * sin, radius * cos, 0.0]])
    }
}

/// Whether an angle leaves something of a whole turn.
pub(crate) fn part_of_turn(name: &str, angle: f64) -> Result<(), String> {
    if angle > 0.0 && angle < TAU {
        Ok(())
    } else {
        Err(format!("`angle` of `{name}` must be above 0 and below 360 degrees"))
    }
}
