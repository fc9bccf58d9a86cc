//! Line along a logarithmic spiral, with a width and round ends. It becomes arcs within a tolerance; the distance from these is
//! exact outside.

use super::polyline::Stroke;
use super::spiral::{MOST_TURNS, line, quarters};
use crate::remember::remembered;
use crate::shape_prelude::*;
use std::f64::consts::TAU;

/// See [`logarithmic_spiral`].
#[derive(Clone, Copy, Debug)]
pub struct LogarithmicSpiral;

/// The descriptor of [`logarithmic_spiral`].
pub static LOGARITHMIC_SPIRAL: Shape = Shape::special::<LogarithmicSpiral>();

/// A line of some width around the origin, counter-clockwise in so many turns. It begins on the x axis at the distance `inner`,
/// which each turn multiplies by `growth`.
#[track_caller]
pub fn logarithmic_spiral(
    width: impl Into<Value>,
    inner: impl Into<Value>,
    growth: impl Into<Value>,
    turns: impl Into<Value>,
) -> Form<LogarithmicSpiral> {
    Form::new(&LOGARITHMIC_SPIRAL, [width.into(), inner.into(), growth.into(), turns.into()])
}

/// By so much at most may the distance from the origin be multiplied or divided in all.
const MOST_GROWTH: f64 = 1e6;

/// So many times its width is as far from the origin as it may lead: farther, single precision can't tell its sides apart.
const FARTHEST: f64 = 1e5;

impl Special for LogarithmicSpiral {
    type General = Stroke;

    const ABOUT: About = About {
        name: "logarithmic_spiral",
        summary: "A plane figure: a line of some width that leads around the origin, always at the same angle to the way outwards.",
        params: &[
            Param::required("width", ParamKind::Positive, "Full width of the line."),
            Param::required(
                "inner",
                ParamKind::Positive,
                "Distance from the origin at which it begins, on the x axis.",
            ),
            Param::required(
                "growth",
                ParamKind::Positive,
                "By how much each turn multiplies the distance from the origin: 3 for a nautilus, 6.854 for the golden spiral; below 1 it \
                 leads inwards.",
            ),
            Param::required(
                "turns",
                ParamKind::Positive,
                "How often it leads around, at most 100 times; also a part of a turn.",
            ),
        ],
        elsewhere: &["equiangular spiral", "golden spiral", "Bernoulli's spiral", "nautilus"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "logarithmic_spiral": { "width": 0.1, "inner": 0.06, "growth": 2.5, "turns": 3 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[width, inner, growth, turns] = args else { unreachable!("four numbers") };
        if turns > MOST_TURNS {
            return Err("`turns` of `logarithmic_spiral` must not exceed 100".into());
        }
        if turns * libm::log(growth).abs() > libm::log(MOST_GROWTH) {
            return Err(
                "`growth` of `logarithmic_spiral` comes to more than a factor of 1000000 over all `turns`".into()
            );
        }
        if inner * libm::pow(growth, turns).max(1.0) > FARTHEST * width {
            return Err("`logarithmic_spiral` leads farther from the origin than 100000 times its `width`".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width, inner, growth, turns] = args else { unreachable!("four numbers") };
        remembered("logarithmic_spiral", args, || {
            let rate = libm::log(growth) / TAU;
            let at = |angle: f64| {
                let (out, radius) = (DVec2::from_angle(angle), inner * libm::exp(rate * angle));
                (out * radius, out * rate + out.perp())
            };
            line(width, &at, &quarters(TAU * turns))
        })
    }
}
