//! Mixtures of two values, by shares that follow from a third one, a height: what lies between two cross-sections of a body.

use crate::kernel::{BATCH, Block, Packed, WIDEST};
use crate::scalar::Interval;
use crate::scalar::{Constants, Dual, Intervals, Lanes, Scalar, Taylor};
use crate::shape::Settled;
use crate::simd::{Level, dispatch, dispatch_up_to_avx2};
use fearless_simd::Simd;

/// How many constants a mixture has: how fast the share grows with the height, what it is at height 0, and how much of it is eased
/// in and out, from 0 for none to 1 for all.
pub const MIX_CONSTANTS: usize = 3;

/// The share of the second value at a height: 0 up to some height, 1 from another one on.
#[inline(always)]
pub fn share<S: Scalar>(height: S, c: &Constants<'_, S>) -> S {
    let [rate, start, ease] = c.get();
    // Around the middle the cubic t^2 (3 - 2t) has few terms, which keeps enclosures narrow.
    let t = (height * rate + start).clamp(0.0, 1.0) - 0.5;
    let share = t * (t.lift(1.0) + (t.lift(0.5) - t.square() * 2.0) * ease) + 0.5;
    if S::IS_ENCLOSURE { share.clamp(0.0, 1.0) } else { share }
}

/// The mixture.
#[inline(always)]
pub fn mixed<S: Scalar>(a: S, b: S, height: S, c: &Constants<'_, S>) -> S {
    S::mix(a, b, share(height, c))
}

/// In single precision shares of 0 and 1 may end so much earlier, relative to what the share is computed from.
const ROUNDING: f64 = 16.0 * f32::EPSILON as f64;

/// What a mixture comes to at these heights.
pub(crate) fn settle(height: Interval, constants: &[f64]) -> Settled {
    let &[rate, start, _ease] = constants else { unreachable!("three constants") };
    let share = height * Interval::point(rate) + Interval::point(start);
    let slack = ROUNDING * (1.0 + (height * Interval::point(rate)).abs().hi() + start.abs());
    if share.hi() < -slack {
        Settled::First
    } else if share.lo() > 1.0 + slack {
        Settled::Second
    } else {
        Settled::Open
    }
}

/// The work of a mixture on one batch.
pub(crate) struct MixJob<'a> {
    /// The first value.
    pub(crate) a: &'a [Block],
    /// The second value.
    pub(crate) b: &'a [Block],
    /// What the share follows from.
    pub(crate) height: &'a [Block],
    /// [`MIX_CONSTANTS`] of them.
    pub(crate) constants: &'a [f32],
    /// The result.
    pub(crate) out: &'a mut [Block],
    /// How many points, a multiple of [`WIDEST`].
    pub(crate) count: usize,
}

#[inline(always)]
fn mix_loop<I: Simd, K: Packed<I>>(token: I, job: &mut MixJob<'_>) {
    let MixJob { a, b, height, constants, ref mut out, count } = *job;
    assert!(count <= BATCH && count.is_multiple_of(WIDEST));
    let (a, b) = (&a[..K::COMPONENTS], &b[..K::COMPONENTS]);
    let (height, out) = (&height[..K::COMPONENTS], &mut out[..K::COMPONENTS]);
    let constants = Constants::new(K::load(token, a, 0), constants, MIX_CONSTANTS);
    let mut lane = 0;
    while lane < count {
        let [a, b, height] = [a, b, height].map(
            #[inline(always)]
            |from| K::load(token, from, lane),
        );
        mixed(a, b, height, &constants).store(out, lane);
        lane += Lanes::<I>::COUNT;
    }
}

/// Mixes values.
pub(crate) fn mix_values(level: Level, job: &mut MixJob<'_>) {
    dispatch!(level, token => mix_loop::<_, Lanes<_>>(token, job));
}

/// Mixes values with derivatives.
pub(crate) fn mix_gradients(level: Level, job: &mut MixJob<'_>) {
    dispatch!(level, token => mix_loop::<_, Dual<Lanes<_>>>(token, job));
}

/// Mixes values with second derivatives.
pub(crate) fn mix_seconds(level: Level, job: &mut MixJob<'_>) {
    dispatch_up_to_avx2!(level, token => mix_loop::<_, Dual<Dual<Lanes<_>, 1>, 1>>(token, job));
}

/// Mixes ranges.
pub(crate) fn mix_ranges(level: Level, job: &mut MixJob<'_>) {
    dispatch!(level, token => mix_loop::<_, Intervals<_>>(token, job));
}

/// Mixes Taylor models.
pub(crate) fn mix_models(level: Level, job: &mut MixJob<'_>) {
    dispatch!(level, token => mix_loop::<_, Taylor<_>>(token, job));
}
