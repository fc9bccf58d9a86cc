//! Four arcs that go over into one another. Exact.

use super::outline::{Outline, closed};
use crate::shape_prelude::*;
use std::f64::consts::{FRAC_PI_3, PI};

/// See [`egg`].
#[derive(Clone, Copy, Debug)]
pub struct Egg;

/// The descriptor of [`egg`].
pub static EGG: Shape = Shape::special::<Egg>();

/// An egg: a half disc below, a smaller disc on top, and arcs between that go over into both. The middle of the lower disc is the
/// origin.
#[track_caller]
pub fn egg(bottom: impl Into<Value>, top: impl Into<Value>) -> Form<Egg> {
    Form::new(&EGG, [bottom.into(), top.into()])
}

impl Special for Egg {
    type General = Outline;

    const ABOUT: About = About {
        name: "egg",
        summary: "A plane figure: an egg of four arcs that go over into one another.",
        params: &[
            Param::required("bottom", ParamKind::Positive, "Radius of the lower disc."),
            Param::required("top", ParamKind::Positive, "Radius of the round top, below that of the lower disc."),
        ],
        elsewhere: &["sdEgg"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "egg": { "bottom": 0.75, "top": 0.3 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[bottom, top] = args else { unreachable!("two numbers") };
        if top >= bottom {
            return Err("`top` of `egg` must be below `bottom`".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[bottom, top] = args else { unreachable!("two numbers") };
        // The arcs at the sides are those of an equilateral triangle, moved outward.
        let (sin, cos) = libm::sincos(FRAC_PI_3);
        let side = 2.0 * bottom - top;
        let (x, y) = (side * cos - (bottom - top), side * sin);
        closed(&[[-bottom, 0.0, PI], [bottom, 0.0, FRAC_PI_3], [x, y, FRAC_PI_3], [-x, y, FRAC_PI_3]])
    }
}
