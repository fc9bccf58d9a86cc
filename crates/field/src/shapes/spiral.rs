//! Line along a spiral of Archimedes, with a width and round ends. It becomes arcs within a tolerance; the distance from these is
//! exact outside.

use super::polyline::Stroke;
use crate::arcs::{Curve, Lines};
use crate::arcs3::Arc3;
use crate::remember::remembered;
use crate::shape_prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// See [`spiral`].
#[derive(Clone, Copy, Debug)]
pub struct Spiral;

/// The descriptor of [`spiral`].
pub static SPIRAL: Shape = Shape::special::<Spiral>();

/// A line of some width from the origin outwards, counter-clockwise in so many turns, this far from each other. `with("inner",
/// ...)` has it begin at a distance from the origin, on the x axis.
#[track_caller]
pub fn spiral(width: impl Into<Value>, spacing: impl Into<Value>, turns: impl Into<Value>) -> Form<Spiral> {
    Form::new(&SPIRAL, [width.into(), spacing.into(), turns.into()])
}

/// Arcs are within this share of the line's width of the spiral.
const TOLERANCE: f64 = 1e-3;

/// Each turn takes some eight arcs, all of which are asked for their distance.
pub(crate) const MOST_TURNS: f64 = 100.0;

impl Special for Spiral {
    type General = Stroke;

    const ABOUT: About = About {
        name: "spiral",
        summary: "A plane figure: a line of some width that leads around the origin, always as far from its last turn.",
        params: &[
            Param::required("width", ParamKind::Positive, "Full width of the line."),
            Param::required(
                "spacing",
                ParamKind::Positive,
                "Distance from one turn to the next, from middle to middle.",
            ),
            Param::required(
                "turns",
                ParamKind::Positive,
                "How often it leads around, at most 100 times; also a part of a turn.",
            ),
            Param::optional(
                "inner",
                ParamKind::Length,
                &[0.0],
                "Distance from the origin at which it begins, on the x axis.",
            ),
        ],
        elsewhere: &["Archimedean spiral", "sdSpiral", "arithmetic spiral"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "spiral": { "width": 0.14, "spacing": 0.26, "turns": 3.5 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        if args[2] > MOST_TURNS { Err("`turns` of `spiral` must not exceed 100".into()) } else { Ok(()) }
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width, spacing, turns, inner] = args else { unreachable!("four numbers") };
        remembered("spiral", args, || {
            let growth = spacing / TAU;
            let at = |angle: f64| {
                let (out, radius) = (DVec2::from_angle(angle), inner + growth * angle);
                (out * radius, out * growth + out.perp() * radius)
            };
            line(width, &at, &quarters(TAU * turns))
        })
    }
}

/// Angles from 0 to `end` in quarters of a turn, of which the last one may be shorter.
pub(crate) fn quarters(end: f64) -> Vec<f64> {
    let count = (end / FRAC_PI_2).ceil() as u32;
    (0..=count).map(|quarter| (f64::from(quarter) * FRAC_PI_2).min(end)).collect()
}

/// The arguments of a line of some width along a curve, from each of these parameters to the next one: two at least, between which
/// it turns by a quarter at most.
pub(crate) fn line(width: f64, curve: Curve<'_>, parameters: &[f64]) -> Vec<f64> {
    let mut lines = Lines::new(width * TOLERANCE);
    lines.move_to(curve(parameters[0]).0);
    for piece in parameters.windows(2) {
        lines.follow(curve, [piece[0], piece[1]]);
    }
    let (corners, end) = lines.open();
    let place = |corner: &[f64; 3]| DVec2::new(corner[0], corner[1]);
    let ends = corners[1..].iter().map(place).chain([end]);
    let arcs = corners.iter().zip(ends).map(|(corner, to)| Arc3::flat(place(corner), to, corner[2]));
    super::tube::along(width / 2.0, arcs)
}
