//! Sphere tracing (Hart 1996) of many rays at once.
//!
//! Rays lie in rows of lanes and advance together, one field evaluation of all rows per step. A ray that is done stays
//! where it is, costing evaluations but changing nothing, until all rays of its row are done. What a ray ends with depends on
//! nothing but the ray itself.
//!
//! There are two kinds of march. [`hard`] looks for the first surface. [`soft`] looks besides for the least ratio of
//! clearance to distance travelled, the factor of soft shadows.

use crate::bundle::{Bundle, LANES, Rows, row, row_mut};
use freikugel_field::simd;
use freikugel_field::{Evaluator, Part};

/// A soft shadow darker than this is black: less than half a step of 8 bits, even encoded.
const NEGLIGIBLE: f32 = 1.0 / 8192.0;

/// The shortest step of a soft march, in clearances. Passing an edge, the clearance half a step from its least
/// value is at most sqrt(1 + (1/4)^2) times that value: the factor is at most 3 % too bright.
const SHORTEST_STEP: f32 = 0.5;

/// A ratio that has fallen by less than this on the last step is at its least or will not fall much any more.
const STEADY: f32 = 0.98;

/// What holds for all rays of a march.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    /// What a field value is multiplied with to get a safe step.
    pub(crate) scale: f32,
    /// The share of a safe step that is taken.
    pub(crate) step_factor: f32,
    /// How many steps a ray may take.
    pub(crate) max_steps: u32,
}

/// One ray. Lengths are in world units, coordinates relative to the program's origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    /// What the caller knows the ray by.
    pub(crate) id: u32,
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    /// Where on the ray to begin, and where to stop looking.
    pub(crate) span: [f32; 2],
    /// The field value that counts as a hit: at the origin, and what it gains per unit of distance.
    pub(crate) tolerance: [f32; 2],
    /// Steps taken before.
    pub(crate) steps: u32,
    /// The factor of a soft shadow is the clearance over the distance travelled, times this.
    pub(crate) sharpness: f32,
}

/// How a ray ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fate {
    /// The field fell below the tolerance.
    Hit,
    /// The ray reached its end, or (soft marches only) nothing of the light is left.
    Passed,
    /// The steps ran out, or the field has no value there.
    Exhausted,
}

/// A ray that is done.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    pub(crate) id: u32,
    pub(crate) fate: Fate,
    /// Where on the ray.
    pub(crate) t: f32,
    /// The field's value there.
    pub(crate) value: f32,
    /// All steps taken.
    pub(crate) steps: u32,
    /// For soft marches, the share of the light that arrives.
    pub(crate) factor: f32,
    /// The cell in which the ray met something, by its place among those of the packet.
    pub(crate) place: u32,
}

impl End {
    /// The place of a ray that met nothing.
    pub(crate) const NOWHERE: u32 = u32::MAX;
}

/// Takes the rays of some rows along their stretches to the first surface, and notes those that met one in `place`. Returns
/// how many field values the rays needed.
pub(crate) fn hard(
    bundle: &mut Bundle,
    rows: Rows,
    field: &mut Evaluator<'_>,
    part: &Part,
    pace: Pace,
    place: u32,
) -> u64 {
    let evaluations =
        march(bundle, rows, field, part, |bundle, start, values| advance_hard(bundle, start, values, pace));
    collect(bundle, rows, place, false);
    evaluations
}

/// Takes the rays of some rows to the first surface, or to their end while looking for the least factor.
pub(crate) fn soft(
    bundle: &mut Bundle,
    rows: Rows,
    field: &mut Evaluator<'_>,
    part: &Part,
    pace: Pace,
    place: u32,
) -> u64 {
    let evaluations =
        march(bundle, rows, field, part, |bundle, start, values| advance_soft(bundle, start, values, pace));
    collect(bundle, rows, place, true);
    evaluations
}

/// Advances rows until none of their rays goes on. `advance` takes one step with a row and returns how many rays went on.
fn march(
    bundle: &mut Bundle,
    mut rows: Rows,
    field: &mut Evaluator<'_>,
    part: &Part,
    advance: impl Fn(&mut Bundle, usize, &[f32; LANES]) -> u32,
) -> u64 {
    let level = field.level();
    let mut evaluations = bundle.count_meeting(&rows);
    while !rows.is_empty() {
        let values = field.batch_in(part, rows.lanes(), |points| bundle.points_at(level, &rows, &bundle.enter, points));
        let mut going = [0; crate::bundle::RAYS / LANES];
        simd::with(
            level,
            #[inline(always)]
            || {
                for ((start, values), going) in rows.starts().zip(values.chunks_exact(LANES)).zip(&mut going) {
                    *going = advance(bundle, start, values.try_into().expect("a row"));
                }
            },
        );
        evaluations += going.iter().map(|&count| u64::from(count)).sum::<u64>();
        rows.retain(|place| going[place] > 0);
    }
    evaluations
}

/// Takes one step with all rays of a row that are not done, and returns how many those are.
#[inline(always)]
fn advance_hard(bundle: &mut Bundle, start: usize, values: &[f32; LANES], pace: Pace) -> u32 {
    let factor = pace.scale * pace.step_factor;
    let Bundle { enter, leave, base, growth, steps, value, .. } = bundle;
    let (t, end) = (row_mut(enter, start), row(leave, start));
    let (base, growth) = (row(base, start), row(growth, start));
    let steps: &mut [u32; LANES] = (&mut steps[start..start + LANES]).try_into().expect("a row");
    *row_mut(value, start) = *values;
    let mut going = 0;
    for ray in 0..LANES {
        let goes =
            (values[ray] >= base[ray] + growth[ray] * t[ray]) & (t[ray] < end[ray]) & (steps[ray] < pace.max_steps);
        t[ray] += if goes { values[ray] * factor } else { 0.0 };
        steps[ray] += u32::from(goes);
        going += u32::from(goes);
    }
    going
}

/// As [`advance_hard`], with the factor of the shadow.
///
/// The field being 1-Lipschitz after scaling, a step up to where clearance over distance could first fall below the least
/// ratio so far misses no smaller one. Where that would be tiny, the step is a fixed part of the clearance instead; the
/// whole of it if the ratio is steady, as it is on the way from a flat surface.
#[inline(always)]
fn advance_soft(bundle: &mut Bundle, start: usize, values: &[f32; LANES], pace: Pace) -> u32 {
    let Bundle { enter, leave, base, growth, sharpness, factor, before, steps, value, .. } = bundle;
    let (t, end) = (row_mut(enter, start), row(leave, start));
    let (base, growth) = (row(base, start), row(growth, start));
    let (sharpness, factor) = (row(sharpness, start), row_mut(factor, start));
    let before = row_mut(before, start);
    let steps: &mut [u32; LANES] = (&mut steps[start..start + LANES]).try_into().expect("a row");
    *row_mut(value, start) = *values;
    let mut going = 0;
    for ray in 0..LANES {
        let goes = (values[ray] >= base[ray] + growth[ray] * t[ray])
            & (t[ray] < end[ray])
            & (steps[ray] < pace.max_steps)
            & (factor[ray] >= NEGLIGIBLE);
        let clearance = values[ray] * pace.scale;
        let here = sharpness[ray] * clearance / t[ray];
        let least = if here < factor[ray] { here } else { factor[ray] };
        let ratio = least / sharpness[ray];
        let safe = (clearance - t[ray] * ratio) / (1.0 + ratio);
        let is_steady = here >= before[ray] * STEADY;
        let short = if is_steady { clearance } else { clearance * SHORTEST_STEP };
        let step = if safe > short { safe } else { short };
        factor[ray] = if goes { least } else { factor[ray] };
        before[ray] = if goes { here } else { before[ray] };
        t[ray] += if goes { step * pace.step_factor } else { 0.0 };
        steps[ray] += u32::from(goes);
        going += u32::from(goes);
    }
    going
}

/// Notes the rays of some rows that did not come to the end of their stretch.
fn collect(bundle: &mut Bundle, rows: Rows, place: u32, is_soft: bool) {
    for start in rows.starts() {
        let (t, end, factor) = (row(&bundle.enter, start), row(&bundle.leave, start), row(&bundle.factor, start));
        let mut stopped = 0;
        for lane in 0..LANES {
            let is_dark = is_soft & (factor[lane] < NEGLIGIBLE);
            let stops = (end[lane] > f32::NEG_INFINITY) & (is_dark | (t[lane] < end[lane]));
            stopped |= u32::from(stops) << lane;
        }
        while stopped != 0 {
            let ray = start + stopped.trailing_zeros() as usize;
            stopped &= stopped - 1;
            let (t, value) = (bundle.enter.0[ray], bundle.value.0[ray]);
            let fate = if t >= bundle.leave.0[ray] || (is_soft && bundle.factor.0[ray] < NEGLIGIBLE) {
                bundle.factor.0[ray] = 0.0;
                Fate::Passed
            } else if value < bundle.base.0[ray] + bundle.growth.0[ray] * t {
                Fate::Hit
            } else {
                Fate::Exhausted
            };
            bundle.find(ray, fate, t, value, place);
        }
    }
}
