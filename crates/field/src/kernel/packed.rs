//! Numbers of each type as components in blocks.

use super::Block;
use crate::scalar::{Dual, Intervals, Lanes, Scalar, Taylor};
use crate::vector::{Vec3, vec3};
use fearless_simd::Simd;

/// A lane type that is stored as a fixed number of blocks.
pub(crate) trait Packed<I: Simd>: Scalar<Table = [f32]> {
    const COMPONENTS: usize;

    fn load(token: I, from: &[Block], lane: usize) -> Self;
    fn store(self, to: &mut [Block], lane: usize);

    /// The same number in all lanes.
    fn splat(token: I, number: f64) -> Self;
}

impl<I: Simd> Packed<I> for Lanes<I> {
    const COMPONENTS: usize = 1;

    #[inline(always)]
    fn splat(token: I, number: f64) -> Self {
        Lanes::splat(token, number as f32)
    }

    #[inline(always)]
    fn load(token: I, from: &[Block], lane: usize) -> Self {
        Lanes::load(token, &from[0].0[lane..lane + Self::COUNT])
    }

    #[inline(always)]
    fn store(self, to: &mut [Block], lane: usize) {
        Lanes::store(self, &mut to[0].0[lane..lane + Self::COUNT]);
    }
}

impl<I: Simd> Packed<I> for Dual<Lanes<I>> {
    const COMPONENTS: usize = 4;

    #[inline(always)]
    fn splat(token: I, number: f64) -> Self {
        Dual::independent(Lanes::splat(token, number as f32))
    }

    #[inline(always)]
    fn load(token: I, from: &[Block], lane: usize) -> Self {
        let [value, x, y, z] = [&from[0], &from[1], &from[2], &from[3]];
        Dual {
            value: Lanes::load(token, &value.0[lane..lane + Lanes::<I>::COUNT]),
            gradient: [
                Lanes::load(token, &x.0[lane..lane + Lanes::<I>::COUNT]),
                Lanes::load(token, &y.0[lane..lane + Lanes::<I>::COUNT]),
                Lanes::load(token, &z.0[lane..lane + Lanes::<I>::COUNT]),
            ],
        }
    }

    #[inline(always)]
    fn store(self, to: &mut [Block], lane: usize) {
        self.value.store(&mut to[0].0[lane..lane + Lanes::<I>::COUNT]);
        for (component, block) in self.gradient.into_iter().zip(&mut to[1..4]) {
            component.store(&mut block.0[lane..lane + Lanes::<I>::COUNT]);
        }
    }
}

/// A value and one derivative from two blocks.
#[inline(always)]
fn load_dual<I: Simd>(token: I, from: &[Block], lane: usize) -> Dual<Lanes<I>, 1> {
    let [value, slope] = [&from[0], &from[1]];
    Dual {
        value: Lanes::load(token, &value.0[lane..lane + Lanes::<I>::COUNT]),
        gradient: [Lanes::load(token, &slope.0[lane..lane + Lanes::<I>::COUNT])],
    }
}

impl<I: Simd> Packed<I> for Dual<Dual<Lanes<I>, 1>, 1> {
    const COMPONENTS: usize = 4;

    #[inline(always)]
    fn splat(token: I, number: f64) -> Self {
        Dual::independent(Dual::independent(Lanes::splat(token, number as f32)))
    }

    #[inline(always)]
    fn load(token: I, from: &[Block], lane: usize) -> Self {
        let (value, slope) = from.split_at(2);
        Dual { value: load_dual(token, value, lane), gradient: [load_dual(token, slope, lane)] }
    }

    #[inline(always)]
    fn store(self, to: &mut [Block], lane: usize) {
        let [slope] = self.gradient;
        self.value.value.store(&mut to[0].0[lane..lane + Lanes::<I>::COUNT]);
        self.value.gradient[0].store(&mut to[1].0[lane..lane + Lanes::<I>::COUNT]);
        slope.value.store(&mut to[2].0[lane..lane + Lanes::<I>::COUNT]);
        slope.gradient[0].store(&mut to[3].0[lane..lane + Lanes::<I>::COUNT]);
    }
}

impl<I: Simd> Packed<I> for Intervals<I> {
    const COMPONENTS: usize = 2;

    #[inline(always)]
    fn splat(token: I, number: f64) -> Self {
        Intervals::point(Lanes::splat(token, 0.0)).lift(number)
    }

    #[inline(always)]
    fn load(token: I, from: &[Block], lane: usize) -> Self {
        let [lo, hi] = [&from[0], &from[1]];
        Self {
            lo: Lanes::load(token, &lo.0[lane..lane + Lanes::<I>::COUNT]),
            hi: Lanes::load(token, &hi.0[lane..lane + Lanes::<I>::COUNT]),
        }
    }

    #[inline(always)]
    fn store(self, to: &mut [Block], lane: usize) {
        self.lo.store(&mut to[0].0[lane..lane + Lanes::<I>::COUNT]);
        self.hi.store(&mut to[1].0[lane..lane + Lanes::<I>::COUNT]);
    }
}

impl<I: Simd> Packed<I> for Dual<Intervals<I>, 1> {
    const COMPONENTS: usize = 4;

    #[inline(always)]
    fn splat(token: I, number: f64) -> Self {
        Dual::independent(Intervals::splat(token, number))
    }

    #[inline(always)]
    fn load(token: I, from: &[Block], lane: usize) -> Self {
        let (value, slope) = from.split_at(2);
        Self { value: Intervals::load(token, value, lane), gradient: [Intervals::load(token, slope, lane)] }
    }

    #[inline(always)]
    fn store(self, to: &mut [Block], lane: usize) {
        let (value, slope) = to.split_at_mut(2);
        self.value.store(value, lane);
        self.gradient[0].store(slope, lane);
    }
}

impl<I: Simd> Packed<I> for Taylor<I> {
    const COMPONENTS: usize = 6;

    #[inline(always)]
    fn splat(token: I, number: f64) -> Self {
        let zero = Lanes::splat(token, 0.0);
        Self::around(zero, zero).lift(number)
    }

    #[inline(always)]
    fn load(token: I, from: &[Block], lane: usize) -> Self {
        let from = &from[..Self::COMPONENTS];
        let lanes = lane..lane + Lanes::<I>::COUNT;
        let mut number = [Lanes::load(token, &from[0].0[lanes.clone()]); 6];
        for (number, block) in number.iter_mut().zip(from) {
            *number = Lanes::load(token, &block.0[lanes.clone()]);
        }
        let [p0, p1, p2, p3, p4, r] = number;
        Self { p: [p0, p1, p2, p3, p4], r }
    }

    #[inline(always)]
    fn store(self, to: &mut [Block], lane: usize) {
        let (p, r) = to[..Self::COMPONENTS].split_at_mut(5);
        for (term, block) in self.p.into_iter().zip(p) {
            term.store(&mut block.0[lane..lane + Lanes::<I>::COUNT]);
        }
        self.r.store(&mut r[0].0[lane..lane + Lanes::<I>::COUNT]);
    }
}

/// A point from three numbers in a row.
#[inline(always)]
pub(super) fn load_point<I: Simd, K: Packed<I>>(token: I, from: &[Block], lane: usize) -> Vec3<K> {
    let c = K::COMPONENTS;
    vec3(
        K::load(token, &from[..c], lane),
        K::load(token, &from[c..2 * c], lane),
        K::load(token, &from[2 * c..3 * c], lane),
    )
}
