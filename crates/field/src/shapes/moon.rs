//! A disc less another one. Exact.

use super::outline::{Outline, closed};
use crate::shape_prelude::*;
use std::f64::consts::PI;

/// See [`moon`].
#[derive(Clone, Copy, Debug)]
pub struct Moon;

/// The descriptor of [`moon`].
pub static MOON: Shape = Shape::special::<Moon>();

/// A disc around the origin without what another disc, whose middle lies on the x axis, has of it.
#[track_caller]
pub fn moon(outer: impl Into<Value>, inner: impl Into<Value>, distance: impl Into<Value>) -> Form<Moon> {
    Form::new(&MOON, [outer.into(), inner.into(), distance.into()])
}

impl Special for Moon {
    type General = Outline;

    const ABOUT: About = About {
        name: "moon",
        summary: "A plane figure: a disc without what another disc, to the right, covers of it.",
        params: &[
            Param::required("outer", ParamKind::Positive, "Radius of the disc."),
            Param::required("inner", ParamKind::Positive, "Radius of the disc that is taken away."),
            Param::required("distance", ParamKind::Positive, "The x of the middle of the disc that is taken away."),
        ],
        elsewhere: &["sdMoon", "crescent", "lune"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "moon": { "outer": 0.9, "inner": 0.75, "distance": 0.4 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[outer, inner, distance] = args else { unreachable!("three numbers") };
        if distance >= outer + inner || distance <= (outer - inner).abs() {
            return Err("the circles of `moon` don't cross; for other cases use `difference` or `ring`".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[outer, inner, distance] = args else { unreachable!("three numbers") };
        let x = (outer * outer - inner * inner + distance * distance) / (2.0 * distance);
        let y = (outer * outer - x * x).sqrt();
        let (own, other) = (libm::atan2(y, x), libm::atan2(y, distance - x));
        closed(&[[x, y, 2.0 * (PI - own)], [x, -y, -2.0 * other]])
    }
}
