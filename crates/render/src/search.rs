//! Guaranteed search for the first zero of a field along rays (Mitchell, "Robust ray intersection with interval arithmetic",
//! 1990; with steps by the derivative's bound as in Galin et al., "Segment Tracing Using Local Lipschitz Bounds", 2020).
//!
//! A ray looks ahead over a stretch, for which interval arithmetic bounds the field and its derivative along the ray. It
//! goes on only where these prove that there is no zero: over all of the stretch, or as far as the value and the steepest
//! descent allow. Otherwise it looks less far ahead, down to the tolerance; a zero that can't be excluded even there is a
//! hit. So no surface is missed, and the field's scale does not matter.

use crate::march::{End, Fate, Pace, Start};
use freikugel_field::{Encloser, Part, Stretches};

/// The part of a proven step that is taken: less than all of it by more than the rounding errors.
const SAFE: f32 = 1.0 - 8.0 * f32::EPSILON;

/// A step shorter than this part of the stretch ahead means that the stretch is too long for useful bounds.
const WORTHWHILE: f32 = 0.25;

/// The rays on their way, and what is known about the stretches ahead of them.
#[derive(Default)]
pub(crate) struct Search {
    rays: Vec<Seeker>,
    origin: [Vec<f32>; 3],
    direction: [Vec<f32>; 3],
    near: Vec<f32>,
    far: Vec<f32>,
    /// Lower and upper bounds: of the value where the ray is, of the values ahead, and of the derivative ahead.
    here: [Vec<f32>; 2],
    ahead: [Vec<f32>; 2],
    slope: [Vec<f32>; 2],
}

/// A ray.
#[derive(Clone, Copy)]
struct Seeker {
    start: Start,
    t: f32,
    width: f32,
    steps: u32,
}

/// What becomes of a ray after one look ahead.
enum Verdict {
    /// It goes on from a point, looking this far.
    Go { t: f32, width: f32 },
    /// There is a zero, or none can be excluded, and the field has this value.
    Hit { t: f32, value: f32 },
    /// The bounds are useless however short the stretch.
    GiveUp,
}

impl Search {
    /// Adds a ray.
    pub(crate) fn push(&mut self, start: &Start) {
        let [near, far] = start.span;
        self.rays.push(Seeker { start: *start, t: near, width: far - near, steps: start.steps });
    }

    /// Takes all rays to their first surface. Appends how they ended, and returns how many enclosures that took.
    pub(crate) fn run(&mut self, encloser: &mut Encloser<'_>, part: &Part, pace: Pace, ends: &mut Vec<End>) -> u64 {
        let mut enclosures = 0;
        while !self.rays.is_empty() {
            self.look(encloser, part);
            enclosures += 2 * self.rays.len() as u64;
            let mut kept = 0;
            for ray in 0..self.rays.len() {
                let mut seeker = self.rays[ray];
                seeker.steps += 1;
                let mut end = |fate, t, value| {
                    let Seeker { start, steps, .. } = seeker;
                    let factor = if fate == Fate::Hit { 0.0 } else { 1.0 };
                    let place = End::NOWHERE;
                    ends.push(End { id: start.id, fate, t, value, steps, factor, before: 0.0, place });
                };
                match self.judge(ray, pace) {
                    Verdict::Hit { t, value } => end(Fate::Hit, t, value),
                    Verdict::Go { t, .. } if t >= seeker.start.span[1] => end(Fate::Passed, t, f32::INFINITY),
                    Verdict::Go { t, width } if seeker.steps < pace.max_steps => {
                        self.rays[kept] = Seeker { t, width, ..seeker };
                        kept += 1;
                    }
                    Verdict::Go { t, .. } => end(Fate::Exhausted, t, 0.0),
                    Verdict::GiveUp => end(Fate::Exhausted, seeker.t, 0.0),
                }
            }
            self.rays.truncate(kept);
        }
        enclosures
    }

    /// Encloses the field where the rays are and ahead of them.
    fn look(&mut self, encloser: &mut Encloser<'_>, part: &Part) {
        let Self { rays, origin, direction, near, far, here, ahead, slope } = self;
        for axis in 0..3 {
            origin[axis].clear();
            origin[axis].extend(rays.iter().map(|ray| ray.start.origin[axis]));
            direction[axis].clear();
            direction[axis].extend(rays.iter().map(|ray| ray.start.direction[axis]));
        }
        near.clear();
        near.extend(rays.iter().map(|ray| ray.t));
        far.clear();
        far.extend(rays.iter().map(Seeker::far));
        for bounds in here.iter_mut().chain(&mut *ahead).chain(&mut *slope) {
            bounds.resize(rays.len(), 0.0);
        }
        let (origin, direction) = (origin.each_ref().map(Vec::as_slice), direction.each_ref().map(Vec::as_slice));
        let points = Stretches { origin, direction, near, far: near };
        let [lo, hi] = here;
        encloser.values(part, &points, [lo, hi]);
        let stretches = Stretches { origin, direction, near, far };
        let ([lo, hi], [least, most]) = (ahead, slope);
        encloser.jets(part, &stretches, [lo, hi], [least, most]);
    }

    fn judge(&self, ray: usize, pace: Pace) -> Verdict {
        let seeker = &self.rays[ray];
        let (t, far) = (seeker.t, seeker.far());
        let width = far - t;
        let [lo, hi] = self.here.each_ref().map(|bounds| bounds[ray]);
        let [descent, ascent] = self.slope.each_ref().map(|bounds| bounds[ray]);
        let [base, growth] = seeker.start.tolerance;
        let tolerance = (base + growth * t) * pace.scale;
        if hi < 0.0 {
            return Verdict::Hit { t, value: hi };
        }
        // How far the value where the ray is and the steepest descent exclude a zero.
        let proven = match lo > 0.0 {
            true if descent >= 0.0 => f32::INFINITY,
            true if descent > f32::NEG_INFINITY => SAFE * lo / -descent,
            _ => 0.0,
        };
        if self.ahead[0][ray] > 0.0 || proven >= width {
            return Verdict::Go { t: far, width: 2.0 * width };
        }
        // Where the field falls all the way, the zero is no farther than this.
        let latest = if ascent < 0.0 { hi / -ascent } else { f32::INFINITY };
        if latest <= width && latest - proven <= tolerance {
            return Verdict::Hit { t: t + 0.5 * (proven + latest), value: 0.0 };
        }
        if width <= tolerance {
            let is_bounded = descent > f32::NEG_INFINITY && ascent < f32::INFINITY;
            return if is_bounded { Verdict::Hit { t, value: 0.0 } } else { Verdict::GiveUp };
        }
        if proven >= WORTHWHILE * width || latest <= width {
            let width = (latest.min(width) - proven).max(tolerance);
            return Verdict::Go { t: t + proven, width };
        }
        Verdict::Go { t: t + proven, width: 0.5 * width }
    }
}

impl Seeker {
    /// How far it looks.
    fn far(&self) -> f32 {
        (self.t + self.width).min(self.start.span[1])
    }
}
