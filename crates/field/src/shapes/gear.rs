//! Gear with involute teeth. Flanks become arcs within a tolerance; the distance from these is exact.
//!
//! A flank is the path of the end of a thread that is unwound from the base circle: at the roll angle t it lies at the radius
//! base * sqrt(1 + t^2), turned by t - atan(t) against its beginning, and leads in the direction in which t turns. Heights of teeth
//! are those of ISO 53 (1998): one module above the pitch circle, and 1.25 below. Within the base circle flanks are radial; there
//! is no undercut.

use super::outline::{Outline, closed};
use crate::arcs::Lines;
use crate::remember::remembered;
use crate::shape_prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// See [`gear`].
#[derive(Clone, Copy, Debug)]
pub struct Gear;

/// The descriptor of [`gear`].
pub static GEAR: Shape = Shape::special::<Gear>();

/// A gear with so many involute teeth, of which one lies on the y axis. Two gears mesh if they have the same module, that is the
/// pitch circle's diameter over the number of teeth, and the same pressure angle, and lie half the sum of their pitch circles'
/// diameters apart. `with("pressure_angle", ...)` chooses another one than 20 degrees, in radians.
#[track_caller]
pub fn gear(teeth: u32, module: impl Into<Value>) -> Form<Gear> {
    Form::new(&GEAR, [teeth.into(), module.into()])
}

/// How far teeth reach beyond the pitch circle, and below it, in modules.
const ADDENDUM: f64 = 1.0;
const DEDENDUM: f64 = 1.25;

/// Arcs are within this share of the module of the involutes: less than teeth are cut with, and few arcs.
const TOLERANCE: f64 = 1e-3;

/// The largest pressure angle: with more, teeth would fill the gaps between them.
const STEEPEST: f64 = 35.0 * PI / 180.0;

impl Special for Gear {
    type General = Outline;

    const ABOUT: About = About {
        name: "gear",
        summary: "A plane figure: a gear with involute teeth around the origin, of which one lies on the y axis.",
        params: &[
            Param::required("teeth", ParamKind::Count(3, 300), "How many teeth it has."),
            Param::required(
                "module",
                ParamKind::Positive,
                "Diameter of the pitch circle over the number of teeth; gears of equal modules mesh. Teeth reach one module beyond that circle.",
            ),
            Param::optional(
                "pressure_angle",
                ParamKind::Angle,
                &[PI / 9.0],
                "Degrees by which the flanks lean at the pitch circle, at most 35.",
            ),
        ],
        elsewhere: &["involute_gear", "spur gear", "cog"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "gear": { "teeth": 14, "module": 0.125 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        if !(0.0..=STEEPEST).contains(&args[2]) {
            return Err("`pressure_angle` of `gear` must lie between 0 and 35 degrees".into());
        }
        let tooth = Tooth::of(args);
        if tooth.half_angle(tooth.tip) <= 0.0 {
            return Err(
                "the teeth of `gear` end in points below their full height; take more, or a smaller `pressure_angle`"
                    .into(),
            );
        }
        if tooth.half_angle(tooth.start) >= PI / args[0] {
            return Err("the teeth of `gear` fill the gaps between them; take a smaller `pressure_angle`".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("gear", args, || {
            let corners = Tooth::of(args).corners(args[1] * TOLERANCE);
            let turned = |index: u32| {
                let turn = DVec2::from_angle(TAU * f64::from(index) / args[0]);
                corners.iter().map(move |&[x, y, bend]| {
                    let corner = turn.rotate(DVec2::new(x, y));
                    [corner.x, corner.y, bend]
                })
            };
            closed(&(0..args[0] as u32).flat_map(turned).collect::<Vec<_>>())
        })
    }
}

/// One tooth and the gap after it.
struct Tooth {
    /// The angle from one tooth to the next.
    pitch: f64,
    /// Half the angle that the tooth takes on the base circle.
    half: f64,
    /// Radii of the base circle, the bottoms of the gaps, the beginnings of the flanks, and the tips.
    base: f64,
    root: f64,
    start: f64,
    tip: f64,
}

impl Tooth {
    fn of(args: &[f64]) -> Self {
        let &[teeth, module, pressure] = args else { unreachable!("three numbers") };
        let radius = teeth * module / 2.0;
        let (base, root) = (radius * libm::cos(pressure), radius - DEDENDUM * module);
        // On the pitch circle teeth and gaps are equally wide.
        let half = PI / (2.0 * teeth) + libm::tan(pressure) - pressure;
        Self { pitch: TAU / teeth, half, base, root, start: base.max(root), tip: radius + ADDENDUM * module }
    }

    /// The roll angle at which the flank has come to a radius.
    fn roll(&self, radius: f64) -> f64 {
        ((radius / self.base).powi(2) - 1.0).max(0.0).sqrt()
    }

    /// Half the angle that the tooth takes at a radius.
    fn half_angle(&self, radius: f64) -> f64 {
        let roll = self.roll(radius);
        self.half - (roll - libm::atan(roll))
    }

    /// The corners of the tooth around the y axis, counter-clockwise, and of the gap after it.
    fn corners(&self, tolerance: f64) -> Vec<[f64; 3]> {
        let polar = |radius: f64, angle: f64| DVec2::from_angle(FRAC_PI_2 + angle) * radius;
        // Unwound counter-clockwise, which makes the flank on the right.
        let flank = |roll: f64| {
            let along = DVec2::from_angle(FRAC_PI_2 - self.half + roll);
            ((along - along.perp() * roll) * self.base, along)
        };
        let mirrored = |roll: f64| {
            let (at, along) = flank(roll);
            (DVec2::new(-at.x, at.y), DVec2::new(along.x, -along.y))
        };
        let (low, high) = (self.roll(self.start), self.roll(self.tip));
        let (at_start, at_tip) = (self.half_angle(self.start), self.half_angle(self.tip));
        let mut lines = Lines::new(tolerance);
        lines.move_to(polar(self.root, -at_start));
        if self.root < self.start {
            lines.line_to(flank(low).0);
        }
        lines.follow(&flank, [low, high]);
        lines.arc_to(polar(self.tip, at_tip), 2.0 * at_tip);
        lines.follow(&mirrored, [high, low]);
        if self.root < self.start {
            lines.line_to(polar(self.root, at_start));
        }
        lines.arc_to(polar(self.root, self.pitch - at_start), self.pitch - 2.0 * at_start);
        lines.open().0
    }
}
