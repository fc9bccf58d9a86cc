//! Guaranteed search for the first zero of a field along rays, by Taylor models (Makino and Berz, "Taylor models and other
//! validated functional inclusion methods", 2003; as Mitchell, "Robust ray intersection with interval arithmetic", 1990, did
//! it with intervals).
//!
//! Along a stretch of a ray the field is a polynomial up to a bound of the rest. Where the polynomial stays above the bound,
//! there is no zero; where it falls from above the bound to below, there is one, and it lies about where the polynomial's
//! is. Bernstein coefficients show both. Where neither is proven, the ray looks at a shorter stretch, for which the bound is
//! much smaller, down to the tolerance; a zero that can't be excluded even there is a hit. So no surface is missed, and the
//! field's scale does not matter.

use crate::bundle::{Bundle, LANES, Row, Rows, row, row_mut};
use crate::march::{Fate, Pace};
use crate::squad::Squad;
use freikugel_field::kernel::Block;
use freikugel_field::{Encloser, ModelLanes, Part, StretchLanes, simd};

/// Rounding errors of Bernstein coefficients, relative to the sum of the polynomial's coefficients.
const ROUNDING: f32 = 16.0 * f32::EPSILON;

/// How often the range of a polynomial is halved or moved along it, before a new one is made of a shorter stretch.
const LOOKS: usize = 12;

/// A part of a polynomial's range shorter than this is better looked at with a new polynomial.
const SHORTEST_LOOK: f32 = 1.0 / 64.0;

/// Newton's steps on a polynomial that falls steadily; what they leave is added to the uncertainty.
const NEWTON_STEPS: usize = 5;

/// The bound that stretches are chosen for, relative to the size of the polynomial: small enough to tell zeros from other
/// places, large enough for long stretches.
const GOOD_BOUND: f32 = 1.0 / 16.0;

/// The next stretch relative to the last one, if the last bound was larger than good by more than the first number: since the
/// bound grows with the fifth power of the stretch, the factor is the fifth root.
const CHANGES: [[f32; 2]; 6] = [[1024.0, 0.25], [243.0, 0.33], [32.0, 0.5], [7.6, 0.67], [1.0, 0.85], [0.13, 1.0]];

/// As above, if the bound was smaller than that.
const LONGER: f32 = 1.6;

/// A clear stretch is followed by one that is longer by this at least: rounding errors, which don't shrink with the stretch,
/// may be all there is to the bound.
const AT_LEAST_LONGER: f32 = 1.3;

/// The next stretch after one where the bound was good, but the field comes too near to zero.
const SHORTER: f32 = 0.4;

/// Makes a stretch cover its ends in spite of rounding.
const COVER: f32 = 1.0 + 4.0 * f32::EPSILON;

/// The rays that search a cell. Their further numbers: how far they look, and how far from a zero they may stop.
#[derive(Default)]
pub(crate) struct Search {
    rays: Squad<2>,
    /// What became of each ray, as a [`Verdict`].
    verdict: Block,
}

/// What becomes of a ray, or of a look at a polynomial. Kept in lanes of numbers.
struct Verdict;

impl Verdict {
    /// The search goes on.
    const OPEN: f32 = 0.0;
    /// There is no zero.
    const CLEAR: f32 = 1.0;
    /// There is a zero, or none can be excluded.
    const HIT: f32 = 2.0;
    /// The field falls through zero.
    const ROOT: f32 = 3.0;
    /// Nothing is proven beyond some place.
    const STUCK: f32 = 4.0;
    /// Nothing is known of the field.
    const UNKNOWN: f32 = 5.0;
}

impl Search {
    /// Takes the rays of some rows along their stretches, on which `part` holds, to their first surface, and notes those that
    /// met one in `place`. Returns how many models that took.
    pub(crate) fn cross(
        &mut self,
        bundle: &mut Bundle,
        rows: Rows,
        encloser: &mut Encloser<'_>,
        part: &Part,
        pace: Pace,
        place: u32,
    ) -> u64 {
        self.rays.gather(bundle, rows, |ray| {
            let (enter, leave) = (bundle.enter.0[ray], bundle.leave.0[ray]);
            [leave - enter, (bundle.base.0[ray] + bundle.growth.0[ray] * enter) * pace.scale]
        });
        let level = encloser.level();
        let mut models = 0;
        while self.rays.count() > 0 {
            models += self.rays.count() as u64;
            let lanes = self.rays.lanes();
            let zeros = encloser.models(part, lanes, |stretches| self.stretch(lanes, stretches));
            simd::with(
                level,
                #[inline(always)]
                || {
                    for start in (0..lanes).step_by(LANES) {
                        let first = Model::load(&zeros.first, start, zeros.is_sheet);
                        let look = match &zeros.cut {
                            None => Look::at(&first, None),
                            Some(cut) => Look::at(&first, Some(&Model::load(cut, start, false))),
                        };
                        self.step(start, &look);
                    }
                },
            );
            self.sort_out(bundle, pace, place);
        }
        models
    }

    /// Writes the stretches that lie ahead.
    fn stretch(&self, lanes: usize, to: StretchLanes<'_>) {
        let Squad { origin, direction, t, end, further: [width, _], .. } = &self.rays;
        for (to, from) in to.origin.into_iter().zip(origin).chain(to.direction.into_iter().zip(direction)) {
            to.copy_from_slice(&from.0[..lanes]);
        }
        for lane in 0..lanes {
            let near = t.0[lane];
            let far = (near + width.0[lane]).min(end.0[lane]);
            to.middle[lane] = 0.5 * near + 0.5 * far;
            to.half[lane] = 0.5 * (far - near) * COVER;
        }
    }

    /// Draws the conclusions from models along the stretches ahead of a row.
    #[inline(always)]
    fn step(&mut self, start: usize, look: &Look) {
        let Squad { t, end, further: [width, tolerance], .. } = &mut self.rays;
        let (t, width) = (row_mut(t, start), row_mut(width, start));
        let (end, tolerance) = (row(end, start), row(tolerance, start));
        let verdict = row_mut(&mut self.verdict, start);
        for lane in 0..LANES {
            let (near, ahead) = (t[lane], width[lane]);
            let far = near + ahead;
            let far = if far < end[lane] { far } else { end[lane] };
            let (middle, half) = (0.5 * near + 0.5 * far, 0.5 * (far - near));
            let found = look.verdict[lane];
            let at = middle + half * look.at[lane];
            let doubt = half * look.doubt[lane];
            let is_clear = found == Verdict::CLEAR;
            let is_root = found == Verdict::ROOT;
            let is_near = is_root & (doubt <= tolerance[lane]);
            let is_last = (lesser(ahead, far - near) <= tolerance[lane]) & !is_clear;
            let is_hit = is_near | (found == Verdict::HIT) | (is_last & (found != Verdict::UNKNOWN));
            let is_past = is_clear & (far >= end[lane]);
            // Around a zero that is not known well enough, as far as the doubt goes.
            let next = if is_clear {
                far
            } else if is_root {
                at - doubt
            } else {
                at
            };
            let next = if next > near { next } else { near };
            let change = look.change[lane];
            let change = if is_clear { greater(change, AT_LEAST_LONGER) } else { lesser(change, SHORTER) };
            let next_width = if is_root { lesser(2.0 * doubt, 0.5 * (far - near)) } else { change * (far - near) };
            let stop = if is_root | (found == Verdict::HIT) { at } else { near };
            verdict[lane] = if is_hit {
                Verdict::HIT
            } else if is_past {
                Verdict::CLEAR
            } else if is_last {
                Verdict::UNKNOWN
            } else {
                Verdict::OPEN
            };
            t[lane] = if is_hit { stop } else { next };
            width[lane] = greater(next_width, tolerance[lane]);
        }
    }

    /// Notes the rays that are done, and moves the others together.
    fn sort_out(&mut self, bundle: &mut Bundle, pace: Pace, place: u32) {
        let Self { rays, verdict } = self;
        rays.steps.iter_mut().for_each(|steps| *steps += 1);
        rays.retain(|rays, lane, ray| {
            let (t, steps) = (rays.t.0[lane], rays.steps[lane]);
            bundle.steps[ray] = steps;
            let fate = match verdict.0[lane] {
                Verdict::HIT => Fate::Hit,
                Verdict::UNKNOWN => Fate::Exhausted,
                Verdict::OPEN if steps >= pace.max_steps => Fate::Exhausted,
                verdict => return verdict == Verdict::OPEN,
            };
            bundle.find(ray, fate, t, 0.0, place);
            false
        });
    }
}

/// Polynomials of degree 4 in a parameter between -1 and 1, and the bounds of what they leave out.
struct Model {
    p: [Row; 5],
    r: Row,
    /// Bounds of the rounding errors of a value.
    slack: Row,
}

/// What a look at a model found.
struct Look {
    verdict: Row,
    /// Where in the range of the parameter: a zero, or what is proven to be clear before.
    at: Row,
    /// How far the zero may be from there.
    doubt: Row,
    /// How long the next stretch should be, relative to this one.
    change: Row,
}

impl Model {
    /// Reads the models of a row. Those of a sheet are turned so that they begin above zero.
    #[inline(always)]
    fn load(lanes: &ModelLanes<'_>, place: usize, is_sheet: bool) -> Self {
        let read = |from: &[f32]| -> Row { from[place..place + LANES].try_into().expect("a row") };
        let mut model = Self { p: lanes.p.map(read), r: read(lanes.r), slack: [0.0; LANES] };
        for lane in 0..LANES {
            let [p0, p1, p2, p3, p4] = model.p.map(|term| term[lane]);
            let is_below = is_sheet & (p0 - p1 + p2 - p3 + p4 < 0.0);
            let sign = if is_below { -1.0 } else { 1.0 };
            for term in &mut model.p {
                term[lane] *= sign;
            }
            model.slack[lane] = (p0.abs() + p1.abs() + p2.abs() + p3.abs() + p4.abs()) * ROUNDING;
        }
        model
    }

    /// Bernstein coefficients of one ray's polynomial on the part from `a` to `a + w` of its range.
    #[inline(always)]
    fn part(&self, lane: usize, a: f32, w: f32) -> Bernstein {
        let [p0, p1, p2, p3, p4] = self.p.each_ref().map(|term| term[lane]);
        // The Taylor coefficients at `a`, by repeated division.
        let c3 = p3 + p4 * a;
        let c2 = p2 + c3 * a;
        let c1 = p1 + c2 * a;
        let q0 = p0 + c1 * a;
        let d3 = c3 + p4 * a;
        let d2 = c2 + d3 * a;
        let q1 = (c1 + d2 * a) * w;
        let e3 = d3 + p4 * a;
        let q2 = (d2 + e3 * a) * (w * w);
        let q3 = (e3 + p4 * a) * (w * w * w);
        let q4 = p4 * (w * w) * (w * w);
        let b1 = q0 + 0.25 * q1;
        let b2 = q0 + 0.5 * q1 + q2 * (1.0 / 6.0);
        let b3 = q0 + 0.75 * q1 + 0.5 * q2 + 0.25 * q3;
        let b4 = q0 + q1 + q2 + q3 + q4;
        Bernstein {
            begin: q0,
            end: b4,
            least: lesser(lesser(q0, b1), lesser(lesser(b2, b3), b4)),
            most: greater(greater(q0, b1), greater(greater(b2, b3), b4)),
            ascent: greater(greater(b1 - q0, b2 - b1), greater(b3 - b2, b4 - b3)) + self.slack[lane],
            bound: self.r[lane] + self.slack[lane],
        }
    }
}

/// What is known of a field on a part of a model's range.
struct Bernstein {
    /// The polynomial at both ends, and bounds of it in between.
    begin: f32,
    end: f32,
    least: f32,
    most: f32,
    /// The largest difference of two coefficients; a quarter of the steepest ascent over the part.
    ascent: f32,
    /// How far the field may be from the polynomial.
    bound: f32,
}

impl Bernstein {
    /// Whether the field falls from above zero to below.
    #[inline(always)]
    fn falls_through(&self) -> bool {
        (self.ascent < 0.0) & (self.begin > self.bound) & (self.end < -self.bound)
    }
}

impl Look {
    /// Looks for the first zero of the field of a row of models, or of the larger one of two fields.
    #[inline(always)]
    fn at(first: &Model, cut: Option<&Model>) -> Self {
        let (mut at, mut width) = ([-1.0_f32; LANES], [2.0_f32; LANES]);
        let (mut descent, mut is_of_cut) = ([1.0_f32; LANES], [false; LANES]);
        let mut verdict: Row = std::array::from_fn(
            #[inline(always)]
            |lane| {
                let is_known = (first.r[lane] < f32::INFINITY) & cut.is_none_or(|cut| cut.r[lane] < f32::INFINITY);
                let known = if is_known { Verdict::OPEN } else { Verdict::UNKNOWN };
                // Where the field has no value it has no zero.
                if first.p[0][lane].is_nan() { Verdict::CLEAR } else { known }
            },
        );
        for _ in 0..LOOKS {
            let mut open = 0;
            for lane in 0..LANES {
                let (a, w) = (at[lane], width[lane]);
                let own = first.part(lane, a, w);
                let (mut is_clear, mut is_inside) = (own.least > own.bound, own.begin < -own.bound);
                let (mut is_root, mut ascent) = (own.falls_through(), own.ascent);
                let mut is_ahead = own.begin > own.bound;
                let mut cuts = false;
                if let Some(cut) = cut {
                    let other = cut.part(lane, a, w);
                    is_root &= other.most < -other.bound;
                    cuts = other.falls_through() & (own.most < -own.bound);
                    is_root |= cuts;
                    ascent = if cuts { other.ascent } else { ascent };
                    is_clear |= other.least > other.bound;
                    is_inside &= other.begin < -other.bound;
                    is_ahead |= other.begin > other.bound;
                }
                let is_stuck = !(is_clear | is_inside | is_root) & (!is_ahead | (w <= SHORTEST_LOOK));
                let is_done = is_clear & (a + w >= 1.0);
                let was_open = verdict[lane] == Verdict::OPEN;
                let outcome = if is_clear {
                    if is_done { Verdict::CLEAR } else { Verdict::OPEN }
                } else if is_root {
                    Verdict::ROOT
                } else if is_inside {
                    Verdict::HIT
                } else if is_stuck {
                    Verdict::STUCK
                } else {
                    Verdict::OPEN
                };
                verdict[lane] = if was_open { outcome } else { verdict[lane] };
                descent[lane] = if was_open { ascent * -4.0 / w } else { descent[lane] };
                is_of_cut[lane] = if was_open { cuts } else { is_of_cut[lane] };
                let goes_on = was_open & (outcome == Verdict::OPEN);
                let next = if is_clear { a + w } else { a };
                let next_width = if is_clear { lesser(2.0 * w, 1.0 - next) } else { 0.5 * w };
                at[lane] = if goes_on { next } else { a };
                width[lane] = if goes_on { next_width } else { w };
                open += u32::from(goes_on);
            }
            if open == 0 {
                break;
            }
        }
        let mut look = Self { verdict, at, doubt: [0.0; LANES], change: [0.0; LANES] };
        look.refine(first, cut, &width, &descent, &is_of_cut);
        look
    }

    /// Finds where the polynomials fall through zero, and how far the fields' zeros may be from there. `descent` is the least
    /// one on the part of the range that this is known to be in.
    #[inline(always)]
    fn refine(&mut self, first: &Model, cut: Option<&Model>, width: &Row, descent: &Row, is_of_cut: &[bool; LANES]) {
        for lane in 0..LANES {
            let pick = |first: f32, other: Option<f32>| match other {
                Some(other) if is_of_cut[lane] => other,
                _ => first,
            };
            let p: [f32; 5] =
                std::array::from_fn(|power| pick(first.p[power][lane], cut.map(|cut| cut.p[power][lane])));
            let (begin, end) = (self.at[lane], self.at[lane] + width[lane]);
            let (above, below) = (value(p, begin), value(p, end));
            let mut s = begin + width[lane] * (above / (above - below));
            for _ in 0..NEWTON_STEPS {
                let slope = ((4.0 * p[4] * s + 3.0 * p[3]) * s + 2.0 * p[2]) * s + p[1];
                let next = s - value(p, s) / slope;
                s = lesser(greater(next, begin), end);
            }
            let bound = pick(first.r[lane] + first.slack[lane], cut.map(|cut| cut.r[lane] + cut.slack[lane]));
            let is_root = self.verdict[lane] == Verdict::ROOT;
            self.doubt[lane] = (value(p, s).abs() + bound) / descent[lane];
            self.at[lane] = if is_root { s } else { self.at[lane] };
            let is_open = self.verdict[lane] == Verdict::OPEN;
            self.verdict[lane] = if is_open { Verdict::STUCK } else { self.verdict[lane] };
        }
        for lane in 0..LANES {
            let excess = |model: &Model| model.r[lane] / (model.slack[lane] * (GOOD_BOUND / ROUNDING));
            let excess = cut.map_or(excess(first), |cut| greater(excess(first), excess(cut)));
            let mut factor = LONGER;
            for [least, change] in CHANGES.into_iter().rev() {
                factor = if excess > least { change } else { factor };
            }
            self.change[lane] = if self.verdict[lane] == Verdict::UNKNOWN { CHANGES[0][1] } else { factor };
        }
    }
}

/// A polynomial's value.
#[inline(always)]
fn value(p: [f32; 5], s: f32) -> f32 {
    (((p[4] * s + p[3]) * s + p[2]) * s + p[1]) * s + p[0]
}

#[inline(always)]
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
