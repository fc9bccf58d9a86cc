//! Intervals in SIMD lanes of `f32`: enclosures of a field over many boxes or stretches of rays at once.
//!
//! Every operation returns an interval that holds each exact result on numbers from its operands. A result of the lanes is
//! at most half a unit in the last place off (a stated error for elementary functions); the ends are moved outward by more
//! than that. Infinite ends mean that nothing is known on that side. Where a function is not defined on all of its argument,
//! the result holds its values on the part where it is.

use super::{Lanes, Scalar};
use fearless_simd::Simd;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// What an end is moved outward by, relative to itself: at least one unit in the last place.
const UNIT: f64 = 1.0 / (1 << 23) as f64;

/// As [`UNIT`], after an elementary function: above the largest of their stated errors.
const ELEMENTARY: f64 = 16.0 * UNIT;

/// Moves an end outward even at 0, where a result may have been below the smallest normal number.
const TINY: f64 = f32::MIN_POSITIVE as f64;

/// All numbers from `lo` to `hi` in each lane, both included.
#[derive(Clone, Copy, Debug)]
pub struct Intervals<I: Simd> {
    /// The lower ends.
    pub lo: Lanes<I>,
    /// The upper ends.
    pub hi: Lanes<I>,
}

/// A comparison of intervals: whether it holds for some pair of numbers, and whether it fails for some.
#[derive(Clone, Copy)]
pub struct LaneTrilean<M> {
    can_hold: M,
    can_fail: M,
}

impl<M: Copy + BitAnd<Output = M> + Not<Output = M>> LaneTrilean<M> {
    /// Where it can hold as well as fail.
    #[inline(always)]
    pub(crate) fn is_open(self) -> M {
        self.can_hold & self.can_fail
    }

    /// Where it holds whatever the numbers are.
    #[inline(always)]
    pub(crate) fn holds(self) -> M {
        !self.can_fail
    }
}

impl<I: Simd> Intervals<I> {
    /// The intervals that hold one number each.
    #[inline(always)]
    pub fn point(x: Lanes<I>) -> Self {
        Self { lo: x, hi: x }
    }

    /// Nothing is known.
    #[inline(always)]
    fn entire(like: Lanes<I>) -> Self {
        Self { lo: like.lift(f64::NEG_INFINITY), hi: like.lift(f64::INFINITY) }
    }

    /// The smallest interval that holds both.
    #[inline(always)]
    pub fn hull(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    #[inline(always)]
    fn middle(self) -> Lanes<I> {
        self.lo * 0.5 + self.hi * 0.5
    }

    /// How far the ends are from the middle.
    #[inline(always)]
    fn radius(self) -> Lanes<I> {
        let middle = self.middle();
        let radius = (self.hi - middle).max(middle - self.lo);
        radius + radius * (2.0 * UNIT) + TINY
    }

    /// Moves both ends outward by the part `unit` of themselves.
    #[inline(always)]
    fn outward(lo: Lanes<I>, hi: Lanes<I>, unit: f64) -> Self {
        let most = lo.lift(f32::MAX.into());
        Self { lo: lo - ((lo.abs() * unit).min(most) + TINY), hi: hi + ((hi.abs() * unit).min(most) + TINY) }
    }

    /// `self` where `mask` holds, everything elsewhere.
    #[inline(always)]
    fn known_if(self, mask: <Lanes<I> as Scalar>::Mask) -> Self {
        let entire = Self::entire(self.lo);
        Self { lo: Lanes::select(mask, self.lo, entire.lo), hi: Lanes::select(mask, self.hi, entire.hi) }
    }

    /// `self`, an enclosure of numbers from `[lo, hi]`, without what lies outside.
    #[inline(always)]
    fn within(self, lo: f64, hi: f64) -> Self {
        Self { lo: self.lo.clamp(lo, hi), hi: self.hi.clamp(lo, hi) }
    }

    /// The hull of four results, moved outward; everything where one is NaN (from 0 times infinity).
    #[inline(always)]
    fn hull_of_four(a: Lanes<I>, b: Lanes<I>, c: Lanes<I>, d: Lanes<I>, unit: f64) -> Self {
        // Infinities of both signs make NaN as well; then nothing is known anyway.
        let is_nan = ((a + b) + (c + d)).is_nan();
        Self::outward(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)), unit).known_if(!is_nan)
    }

    /// What an increasing function makes of the ends.
    #[inline(always)]
    fn increasing(lo: Lanes<I>, hi: Lanes<I>) -> Self {
        Self::outward(lo, hi, ELEMENTARY)
    }

    /// Whether a point `phase + n` lies inside for some integer `n`, after multiplication with `frequency`; where rounding
    /// leaves it open, it may.
    #[inline(always)]
    fn meets(self, frequency: f64, phase: f64) -> <Lanes<I> as Scalar>::Mask {
        const SLACK: f64 = 4.0 * UNIT;
        let (first, last) = (self.lo * frequency - phase, self.hi * frequency - phase);
        let first = first - (first.abs() * SLACK + SLACK);
        let last = last + (last.abs() * SLACK + SLACK);
        let (first, last) = (first.floor(), last.floor());
        // Also where an end is infinite or NaN.
        !(last - first).lt(first.lift(0.5)) | first.is_nan() | last.is_nan()
    }

    /// A sine or cosine by its values at both ends, and whether it has a maximum or a minimum in between.
    #[inline(always)]
    fn wave(
        first: Lanes<I>,
        last: Lanes<I>,
        top: <Lanes<I> as Scalar>::Mask,
        bottom: <Lanes<I> as Scalar>::Mask,
    ) -> Self {
        let one = first.lift(1.0);
        let ends = Self::outward(first.min(last), first.max(last), ELEMENTARY);
        let range = Self { lo: Lanes::select(bottom, -one, ends.lo), hi: Lanes::select(top, one, ends.hi) };
        range.within(-1.0, 1.0)
    }
}

impl<I: Simd> Add for Intervals<I> {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: Self) -> Self {
        Self::outward(self.lo + rhs.lo, self.hi + rhs.hi, UNIT)
    }
}

impl<I: Simd> Sub for Intervals<I> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: Self) -> Self {
        Self::outward(self.lo - rhs.hi, self.hi - rhs.lo, UNIT)
    }
}

impl<I: Simd> Mul for Intervals<I> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: Self) -> Self {
        Self::hull_of_four(self.lo * rhs.lo, self.lo * rhs.hi, self.hi * rhs.lo, self.hi * rhs.hi, UNIT)
    }
}

impl<I: Simd> Div for Intervals<I> {
    type Output = Self;
    #[inline(always)]
    fn div(self, rhs: Self) -> Self {
        let zero = self.lo.lift(0.0);
        let quotient = Self::hull_of_four(self.lo / rhs.lo, self.lo / rhs.hi, self.hi / rhs.lo, self.hi / rhs.hi, UNIT);
        quotient.known_if(zero.lt(rhs.lo) | rhs.hi.lt(zero))
    }
}

impl<I: Simd> Neg for Intervals<I> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo }
    }
}

impl<I: Simd> Add<f64> for Intervals<I> {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: f64) -> Self {
        self + self.lift(rhs)
    }
}

impl<I: Simd> Sub<f64> for Intervals<I> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: f64) -> Self {
        self - self.lift(rhs)
    }
}

impl<I: Simd> Mul<f64> for Intervals<I> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: f64) -> Self {
        self * self.lift(rhs)
    }
}

impl<M: BitAnd<Output = M> + BitOr<Output = M>> BitAnd for LaneTrilean<M> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, rhs: Self) -> Self {
        Self { can_hold: self.can_hold & rhs.can_hold, can_fail: self.can_fail | rhs.can_fail }
    }
}

impl<M: BitAnd<Output = M> + BitOr<Output = M>> BitOr for LaneTrilean<M> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, rhs: Self) -> Self {
        Self { can_hold: self.can_hold | rhs.can_hold, can_fail: self.can_fail & rhs.can_fail }
    }
}

impl<M> Not for LaneTrilean<M> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self { can_hold: self.can_fail, can_fail: self.can_hold }
    }
}

impl<I: Simd> Scalar for Intervals<I> {
    type Mask = LaneTrilean<<Lanes<I> as Scalar>::Mask>;
    type Table = [f32];

    const IS_ENCLOSURE: bool = true;

    #[inline(always)]
    fn lift(self, c: f64) -> Self {
        let near = c as f32;
        let (lo, hi) = match f64::from(near) {
            exact if exact == c => (near, near),
            _ => (near.next_down(), near.next_up()),
        };
        Self { lo: self.lo.lift(lo.into()), hi: self.lo.lift(hi.into()) }
    }

    /// Constants are rounded to single precision: the exact one lies between the neighbours.
    #[inline(always)]
    fn constant(self, table: &[f32], index: usize) -> Self {
        let near = table[index];
        Self { lo: self.lo.lift(near.next_down().into()), hi: self.lo.lift(near.next_up().into()) }
    }

    #[inline(always)]
    fn lt(self, rhs: Self) -> Self::Mask {
        LaneTrilean { can_hold: self.lo.lt(rhs.hi), can_fail: !self.hi.lt(rhs.lo) }
    }

    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        let hull = yes.hull(no);
        Self {
            lo: Lanes::select(mask.can_fail, Lanes::select(mask.can_hold, hull.lo, no.lo), yes.lo),
            hi: Lanes::select(mask.can_fail, Lanes::select(mask.can_hold, hull.hi, no.hi), yes.hi),
        }
    }

    #[inline(always)]
    fn any(mask: Self::Mask) -> bool {
        Lanes::<I>::any(mask.can_hold)
    }

    #[inline(always)]
    fn step_slope(self) -> Self {
        let zero = self.lo.lift(0.0);
        Self::point(zero).known_if(!self.lo.lt(self.hi))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let zero = self.lo.lift(0.0);
        let root = Self::outward(self.lo.max(zero).sqrt(), self.hi.max(zero).sqrt(), UNIT);
        Self { lo: root.lo.max(zero), hi: root.hi }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let zero = self.lo.lift(0.0);
        Self { lo: self.lo.max(-self.hi).max(zero), hi: self.hi.max(-self.lo) }
    }

    #[inline(always)]
    fn min(self, rhs: Self) -> Self {
        Self { lo: self.lo.min(rhs.lo), hi: self.hi.min(rhs.hi) }
    }

    #[inline(always)]
    fn max(self, rhs: Self) -> Self {
        Self { lo: self.lo.max(rhs.lo), hi: self.hi.max(rhs.hi) }
    }

    #[inline(always)]
    fn square(self) -> Self {
        let a = self.abs();
        let square = Self::outward(a.lo * a.lo, a.hi * a.hi, UNIT);
        Self { lo: square.lo.max(self.lo.lift(0.0)), hi: square.hi }
    }

    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        let Some(power) = self.positive_power(n.unsigned_abs()) else {
            return self.lift(1.0);
        };
        if n < 0 { self.lift(1.0) / power } else { power }
    }

    #[inline(always)]
    fn floor(self) -> Self {
        Self { lo: self.lo.floor(), hi: self.hi.floor() }
    }

    #[inline(always)]
    fn zigzag(self) -> Self {
        let (zero, one) = (self.lo.lift(0.0), self.lo.lift(1.0));
        let (a, b) = (self.lo.zigzag(), self.hi.zigzag());
        // Even and odd numbers in between.
        let lo = Lanes::select(self.meets(0.5, 0.0), zero, a.min(b));
        let hi = Lanes::select(self.meets(0.5, 0.5), one, a.max(b));
        // Rounding errors are those of the argument.
        let error = self.lo.abs().max(self.hi.abs()) * (2.0 * UNIT);
        Self { lo: (lo - error).max(zero), hi: (hi + error).min(one) }
    }

    /// Between its ends a mixture goes straight from one to the other.
    #[inline(always)]
    fn mix(a: Self, b: Self, share: Self) -> Self {
        let (least, most) = (Self::point(share.lo), Self::point(share.hi));
        let one = share.lift(1.0);
        (a * (one - least) + b * least).hull(a * (one - most) + b * most)
    }

    #[inline(always)]
    fn agreed(self, other: Self) -> Self {
        // Of what can't be compared, `max` and `min` take the second one.
        let common = Self { lo: other.lo.max(self.lo), hi: other.hi.min(self.hi) };
        let is_empty = common.hi.lt(common.lo);
        Self { lo: Lanes::select(is_empty, self.lo, common.lo), hi: Lanes::select(is_empty, self.hi, common.hi) }
    }

    #[inline(always)]
    fn core(self) -> Self {
        let middle = self.middle();
        let is_known = middle.abs().lt(middle.lift(f64::INFINITY));
        Self { lo: Lanes::select(is_known, middle, self.lo), hi: Lanes::select(is_known, middle, self.hi) }
    }

    #[inline(always)]
    fn around_core(self, a: Self, b: Self) -> Self {
        let (a, b) = (a.radius(), b.radius());
        let radius = a.max(b);
        // What is not known of one is not known of both.
        let is_known = (a + b).lt(a.lift(f64::INFINITY));
        Self::outward(self.lo - radius, self.hi + radius, UNIT).known_if(is_known)
    }

    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let ((sin, cos), (sin_last, cos_last)) = (self.lo.sin_cos(), self.hi.sin_cos());
        const PER_TURN: f64 = 0.5 * FRAC_1_PI;
        let (east, north) = (self.meets(PER_TURN, 0.0), self.meets(PER_TURN, 0.25));
        let (west, south) = (self.meets(PER_TURN, 0.5), self.meets(PER_TURN, 0.75));
        (Self::wave(sin, sin_last, north, south), Self::wave(cos, cos_last, east, west))
    }

    #[inline(always)]
    fn tan(self) -> Self {
        Self::increasing(self.lo.tan(), self.hi.tan()).known_if(!self.meets(FRAC_1_PI, 0.5))
    }

    #[inline(always)]
    fn asin(self) -> Self {
        let part = self.within(-1.0, 1.0);
        Self::increasing(part.lo.asin(), part.hi.asin())
    }

    #[inline(always)]
    fn acos(self) -> Self {
        let part = self.within(-1.0, 1.0);
        Self::increasing(part.hi.acos(), part.lo.acos())
    }

    #[inline(always)]
    fn atan(self) -> Self {
        Self::increasing(self.lo.atan(), self.hi.atan()).within(-FRAC_PI_2 - ELEMENTARY, FRAC_PI_2 + ELEMENTARY)
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let zero = self.lo.lift(0.0);
        let corners = [self.lo.atan2(x.lo), self.lo.atan2(x.hi), self.hi.atan2(x.lo), self.hi.atan2(x.hi)];
        let [a, b, c, d] = corners;
        let hull = Self::hull_of_four(a, b, c, d, ELEMENTARY);
        // The angle jumps where the negative x axis is crossed.
        let jumps = !zero.lt(self.lo) & !self.hi.lt(zero) & !zero.lt(x.lo);
        hull.known_if(!jumps).within(-PI - ELEMENTARY, PI + ELEMENTARY)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let zero = self.lo.lift(0.0);
        let exp = Self::increasing(self.lo.exp(), self.hi.exp());
        Self { lo: exp.lo.max(zero), hi: exp.hi }
    }

    #[inline(always)]
    fn ln(self) -> Self {
        let zero = self.lo.lift(0.0);
        Self::increasing(self.lo.max(zero).ln(), self.hi.max(zero).ln())
    }

    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        let zero = self.lo.lift(0.0);
        let (lo, hi) = (self.lo.max(zero), self.hi.max(zero));
        let corners = [lo.pow(exponent.lo), lo.pow(exponent.hi), hi.pow(exponent.lo), hi.pow(exponent.hi)];
        let [a, b, c, d] = corners;
        let power = Self::hull_of_four(a, b, c, d, ELEMENTARY);
        let power = Self { lo: power.lo.max(zero), hi: power.hi };
        // What of the base is negative has a power with a whole exponent only, as large as without the sign. Of several exponents
        // some may be whole, and then nothing is said.
        let e = exponent.lo;
        let whole = e.floor();
        let is_whole = !whole.lt(e);
        let is_odd = is_whole & zero.lt(whole - (whole * 0.5).floor() * 2.0);
        let size = Self::outward((-self.lo).max(zero).pow(e), (-self.lo).max(zero).pow(e), ELEMENTARY).hi;
        let lo = Lanes::select(is_odd, -size, zero);
        let hi = Lanes::select(is_whole & !is_odd, power.hi.max(size), power.hi);
        let is_one = !e.lt(exponent.hi) | (!is_whole & !whole.lt(exponent.hi.floor()));
        let is_positive = !self.lo.lt(zero);
        let all = Self { lo: Lanes::select(is_positive, power.lo, lo), hi: Lanes::select(is_positive, power.hi, hi) };
        all.known_if(is_positive | (is_one & zero.lt(e) & !self.hi.lt(zero)))
    }
}

impl<I: Simd> Intervals<I> {
    /// `self^n`, or nothing for `n = 0`.
    #[inline(always)]
    fn positive_power(self, n: u32) -> Option<Self> {
        if n.is_multiple_of(2) {
            let a = self.abs();
            let (lo, hi) = (Self::absolute_power(a.lo, n)?, Self::absolute_power(a.hi, n)?);
            return Some(Self { lo: lo.lo, hi: hi.hi });
        }
        Some(Self { lo: Self::odd_power(self.lo, n)?.lo, hi: Self::odd_power(self.hi, n)?.hi })
    }

    /// `|x|^n`, which is monotone.
    #[inline(always)]
    fn absolute_power(x: Lanes<I>, n: u32) -> Option<Self> {
        let power = super::repeated_squaring(Self::point(x.abs()), n)?;
        Some(Self { lo: power.lo.max(x.lift(0.0)), hi: power.hi })
    }

    /// `x^n` for odd `n`.
    #[inline(always)]
    fn odd_power(x: Lanes<I>, n: u32) -> Option<Self> {
        let power = Self::absolute_power(x, n)?;
        let is_negative = x.lt(x.lift(0.0));
        Some(Self {
            lo: Lanes::select(is_negative, -power.hi, power.lo),
            hi: Lanes::select(is_negative, -power.lo, power.hi),
        })
    }
}
