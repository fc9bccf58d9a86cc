//! The hull of two discs. Exact.

use super::outline::{Outline, closed};
use crate::shape_prelude::*;
use std::f64::consts::PI;

/// See [`uneven_capsule`].
#[derive(Clone, Copy, Debug)]
pub struct UnevenCapsule;

/// The descriptor of [`uneven_capsule`].
pub static UNEVEN_CAPSULE: Shape = Shape::special::<UnevenCapsule>();

/// The hull of two discs, one above the other. The middle of the line between their middles is the origin.
#[track_caller]
pub fn uneven_capsule(
    bottom: impl Into<Value>,
    top: impl Into<Value>,
    height: impl Into<Value>,
) -> Form<UnevenCapsule> {
    Form::new(&UNEVEN_CAPSULE, [bottom.into(), top.into(), height.into()])
}

impl Special for UnevenCapsule {
    type General = Outline;

    const ABOUT: About = About {
        name: "uneven_capsule",
        summary: "A plane figure: the hull of two discs, one above the other.",
        params: &[
            Param::required("bottom", ParamKind::Positive, "Radius of the lower disc."),
            Param::required("top", ParamKind::Positive, "Radius of the upper disc."),
            Param::required("height", ParamKind::Positive, "Distance of the middles of the two discs."),
        ],
        elsewhere: &["sdUnevenCapsule", "capsule2", "pill", "stadium", "slot"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "uneven_capsule": { "bottom": 0.55, "top": 0.3, "height": 0.9 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[bottom, top, height] = args else { unreachable!("three numbers") };
        if (bottom - top).abs() >= height {
            return Err(
                "one disc of `uneven_capsule` holds the other: `height` must be above the difference of the radii"
                    .into(),
            );
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[bottom, top, height] = args else { unreachable!("three numbers") };
        let lean = libm::asin((bottom - top) / height);
        let (sin, cos) = libm::sincos(lean);
        let (low, high) = (bottom * sin - height / 2.0, top * sin + height / 2.0);
        closed(&[
            [-bottom * cos, low, PI + 2.0 * lean],
            [bottom * cos, low, 0.0],
            [top * cos, high, PI - 2.0 * lean],
            [-top * cos, high, 0.0],
        ])
    }
}
