//! Line along a clothoid, with a width and round ends. It becomes arcs within a tolerance; the distance from these is exact
//! outside.
//!
//! Its points are Fresnel's integrals (Levien, "The Euler spiral: a mathematical history", 2008), summed up over quarters of a
//! turn by Gauss's rule.

use super::polyline::Stroke;
use super::spiral::{line, quarters};
use crate::remember::remembered;
use crate::shape_prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// See [`clothoid`].
#[derive(Clone, Copy, Debug)]
pub struct Clothoid;

/// The descriptor of [`clothoid`].
pub static CLOTHOID: Shape = Shape::special::<Clothoid>();

/// A line of some width and length from the origin along x, whose curvature grows evenly from nothing, until its direction has
/// turned to the left by an angle in degrees. `with("symmetric", ...)` has it lead from the origin to the other side, too.
#[track_caller]
pub fn clothoid(width: impl Into<Value>, length: impl Into<Value>, degrees: f64) -> Form<Clothoid> {
    Form::new(&CLOTHOID, [width.into(), length.into(), degrees.to_radians().into()])
}

/// Each turn takes some eight arcs, all of which are asked for their distance.
const MOST_TURNS: f64 = 50.0;

impl Special for Clothoid {
    type General = Stroke;

    const ABOUT: About = About {
        name: "clothoid",
        summary: "A plane figure: a line of some width that begins straight and bends the more the longer it is, evenly.",
        params: &[
            Param::required("width", ParamKind::Positive, "Full width of the line."),
            Param::required(
                "length",
                ParamKind::Positive,
                "Length of the line from the origin, where it leads along x, to its end.",
            ),
            Param::required(
                "turn",
                ParamKind::Angle,
                "The angle by which its direction turns until then, to the left; to the right if it is negative. At most 18000.",
            ),
            Param::optional(
                "symmetric",
                ParamKind::Flag,
                &[0.0],
                "Whether it leads from the origin to the other side, too, where it bends the other way.",
            ),
        ],
        elsewhere: &["Euler spiral", "Cornu spiral", "spiro", "transition curve"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "clothoid": { "width": 0.04, "length": 3.2, "turn": 500, "symmetric": true } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        if args[2].abs() > MOST_TURNS * TAU * (1.0 + ROUNDING) {
            return Err("`turn` of `clothoid` must not exceed 18000 degrees".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width, length, turn, symmetric] = args else { unreachable!("four numbers") };
        remembered("clothoid", args, || {
            let quarters: Vec<f64> = match quarters(turn.abs()) {
                // Straight on.
                none if turn == 0.0 => none.into_iter().chain([1.0]).collect(),
                some => some.into_iter().map(|angle| (angle / turn.abs()).sqrt()).collect(),
            };
            let mut known = vec![DVec2::ZERO];
            for piece in quarters.windows(2) {
                known.push(known[known.len() - 1] + integral(turn, piece[0], piece[1]));
            }
            // By the share of the length: the direction is turned by its square.
            let at = |share: f64| {
                let (side, share) = (1.0_f64.copysign(share), share.abs());
                let before = quarters.partition_point(|quarter| *quarter <= share).saturating_sub(1);
                let place = known[before] + integral(turn, quarters[before], share);
                (place * length * side, DVec2::from_angle(turn * share * share))
            };
            let back = quarters[1..].iter().rev().map(|share| -share).filter(|_| symmetric != 0.0);
            line(width, &at, &back.chain(quarters.iter().copied()).collect::<Vec<f64>>())
        })
    }
}

/// What rounding adds to an angle in degrees that becomes one in radians.
const ROUNDING: f64 = 1e-12;

/// Within a quarter of a turn Gauss's rule is as good as exact for so many pieces.
const PIECES: u32 = 4;

/// The integral of the direction that is turned by `turn` times the square of the parameter, which leads from one value to another
/// between which it turns by a quarter at most.
fn integral(turn: f64, from: f64, to: f64) -> DVec2 {
    debug_assert!((turn * (to * to - from * from)).abs() <= FRAC_PI_2 * (1.0 + ROUNDING));
    // The rule of five points: where they are, and their weights.
    let root = 2.0 * (10.0_f64 / 7.0).sqrt();
    let [near, far] = [5.0 - root, 5.0 + root].map(|square| square.sqrt() / 3.0);
    let [heavy, light] = [13.0, -13.0].map(|part| (322.0 + part * 70.0_f64.sqrt()) / 900.0);
    let rule = [(0.0, 128.0 / 225.0), (near, heavy), (-near, heavy), (far, light), (-far, light)];
    let half = (to - from) / f64::from(2 * PIECES);
    let piece = |index: u32| {
        let middle = from + half * f64::from(2 * index + 1);
        let term = |(place, weight): (f64, f64)| {
            let share = middle + half * place;
            DVec2::from_angle(turn * share * share) * weight
        };
        rule.map(term).iter().sum::<DVec2>() * half
    };
    (0..PIECES).map(piece).sum()
}
