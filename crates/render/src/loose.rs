//! Relaxed sphere tracing through fields that are much smaller than distances, as those of fractals (Keinert, Schäfer,
//! Korndörfer, Ganse and Stamminger, "Enhanced Sphere Tracing", 2014).
//!
//! Steps are longer than the free ball around a ray's point allows. If the free balls before and after such a step don't
//! touch, something may lie between them: the ray goes back to where the first one ends. How much longer the steps are follows
//! from how the field changed on the last one. The fields are costly, so rays are moved together as they get fewer.

use crate::bundle::{Bundle, LANES, Row, Rows, row, row_mut};
use crate::march::{Fate, Pace};
use crate::squad::Squad;
use freikugel_field::kernel::Block;
use freikugel_field::{Evaluator, Part, simd};

/// The surplus of a relaxed step, in free balls, where the field stays as large as it was on the last step; in proportion
/// where it fell. With more of it too many steps are taken back: on the fractals of the bench scenes, twice this costs as much
/// as nothing.
const SURPLUS: f32 = 0.65;

/// The largest surplus, where the field grows. The balls could not touch from 1 on unless it grows further.
const LARGEST_SURPLUS: f32 = 0.9;

/// Rays are moved together when at least one in this many is done.
const IDLE_SHARE: usize = 6;

/// The rays on their way. Their further numbers: the value that counts as a hit at the origin, and what that gains per unit
/// of distance; the radius of the free ball before the last step, and the length of that step.
#[derive(Default)]
pub(crate) struct Loose {
    rays: Squad<4>,
    value: Block,
    goes: Block,
}

impl Loose {
    /// Takes the rays of some rows along their stretches to the first surface, and notes those that met one in `place`.
    /// Returns how many field values the rays needed.
    pub(crate) fn hard(
        &mut self,
        bundle: &mut Bundle,
        rows: Rows,
        field: &mut Evaluator<'_>,
        part: &Part,
        pace: Pace,
        place: u32,
    ) -> u64 {
        let level = field.level();
        self.rays.gather(bundle, rows, |ray| [bundle.base.0[ray], bundle.growth.0[ray], 0.0, 0.0]);
        let mut evaluations = self.rays.count() as u64;
        while self.rays.count() > 0 {
            let lanes = self.rays.lanes();
            let Self { rays, value, goes } = self;
            let values = field.batch_in(part, lanes, |points| {
                simd::with(
                    level,
                    #[inline(always)]
                    || {
                        for (axis, to) in points.into_iter().enumerate() {
                            let (origin, direction) = (&rays.origin[axis].0[..lanes], &rays.direction[axis].0[..lanes]);
                            let (to, t) = (&mut to[..lanes], &rays.t.0[..lanes]);
                            for lane in 0..lanes {
                                to[lane] = origin[lane] + t[lane] * direction[lane];
                            }
                        }
                    },
                );
            });
            value.0[..lanes].copy_from_slice(values);
            simd::with(
                level,
                #[inline(always)]
                || {
                    for start in (0..lanes).step_by(LANES) {
                        advance(rays, start, row(value, start), row_mut(goes, start), pace);
                    }
                },
            );
            let going = goes.0[..rays.count()].iter().filter(|&&goes| goes > 0.0).count();
            evaluations += going as u64;
            if (rays.count() - going) * IDLE_SHARE >= rays.count() {
                rays.retain(|rays, lane, ray| {
                    let (t, here) = (rays.t.0[lane], value.0[lane]);
                    bundle.steps[ray] = rays.steps[lane];
                    if goes.0[lane] > 0.0 {
                        return true;
                    }
                    if t < rays.end.0[lane] || t.is_nan() {
                        let [base, growth, ..] = &rays.further;
                        let is_hit = here < base.0[lane] + growth.0[lane] * t;
                        bundle.find(ray, if is_hit { Fate::Hit } else { Fate::Exhausted }, t, here, place);
                    }
                    false
                });
            }
        }
        evaluations
    }
}

/// Takes one step with all rays of a row that are not done, and says which those are.
#[inline(always)]
fn advance(rays: &mut Squad<4>, start: usize, values: &Row, goes: &mut Row, pace: Pace) {
    let factor = pace.scale * pace.step_factor;
    let Squad { t, end, steps, further: [base, growth, free, stride], .. } = rays;
    let (t, end) = (row_mut(t, start), row(end, start));
    let (base, growth) = (row(base, start), row(growth, start));
    let (free, stride) = (row_mut(free, start), row_mut(stride, start));
    let steps: &mut [u32; LANES] = (&mut steps[start..start + LANES]).try_into().expect("a row");
    for ray in 0..LANES {
        let (own, before) = (values[ray] * factor, free[ray]);
        // A step within the ball is safe, whatever rounding says.
        let misses = (stride[ray] > before) & (own + before < stride[ray]);
        let is_on_its_way =
            (values[ray] >= base[ray] + growth[ray] * t[ray]) & (t[ray] < end[ray]) & (steps[ray] < pace.max_steps);
        let change = SURPLUS * own / before;
        let surplus = if change < LARGEST_SURPLUS { change } else { LARGEST_SURPLUS };
        let surplus = if before > 0.0 { surplus } else { 0.0 };
        let relaxed = own + own * surplus;
        let ahead = if t[ray] + relaxed < end[ray] { relaxed } else { own };
        // Having gone back, a ray forgets the step, so that the next one is safe.
        let back = before - stride[ray];
        let step = if is_on_its_way { ahead } else { 0.0 };
        t[ray] += if misses { back } else { step };
        let (next_free, next_stride) = if is_on_its_way { (own, ahead) } else { (before, stride[ray]) };
        free[ray] = if misses { 0.0 } else { next_free };
        stride[ray] = if misses { 0.0 } else { next_stride };
        let moves = misses | is_on_its_way;
        goes[ray] = if moves { 1.0 } else { 0.0 };
        steps[ray] += u32::from(moves);
    }
}
