//! Closed intervals of `f64`, rounded outward.
//!
//! Every operation returns an interval that holds each exact result of the operation on numbers from its operands. The
//! processor's rounding mode stays untouched: a correctly rounded result is at most half a unit in the last place off,
//! so moving each end to the next number outward is enough.

use super::Scalar;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// All numbers from `lo` to `hi`, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lo: f64,
    hi: f64,
}

/// A comparison of intervals: whether it holds for some pair of numbers, and whether it fails for some.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trilean {
    /// It may hold.
    pub can_hold: bool,
    /// It may fail.
    pub can_fail: bool,
}

impl Interval {
    /// The whole line: nothing is known.
    pub const ENTIRE: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// The interval from `lo` to `hi`.
    ///
    /// # Panics
    /// If `lo > hi` or either is NaN.
    pub fn new(lo: f64, hi: f64) -> Self {
        assert!(lo <= hi, "interval ends out of order: {lo} > {hi}");
        Self { lo, hi }
    }

    /// The interval that holds `x` alone.
    pub fn point(x: f64) -> Self {
        Self::new(x, x)
    }

    /// The lower end.
    pub fn lo(self) -> f64 {
        self.lo
    }

    /// The upper end.
    pub fn hi(self) -> f64 {
        self.hi
    }

    /// `hi - lo`.
    pub fn width(self) -> f64 {
        self.hi - self.lo
    }

    /// A number between the ends.
    pub fn middle(self) -> f64 {
        self.lo + 0.5 * (self.hi - self.lo)
    }

    /// Whether `x` lies inside.
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// The smallest interval that holds both.
    pub fn hull(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// What both have in common. Both must be enclosures of one value, so that there is something.
    pub fn meet(self, other: Self) -> Self {
        let (lo, hi) = (self.lo.max(other.lo), self.hi.min(other.hi));
        debug_assert!(lo <= hi, "two enclosures of one value don't meet: {self:?}, {other:?}");
        if lo <= hi { Self { lo, hi } } else { self }
    }

    /// Moves both ends outward by one representable number. NaN (from inf - inf or 0 * inf) means no knowledge.
    fn outward(lo: f64, hi: f64) -> Self {
        if lo.is_nan() || hi.is_nan() {
            return Self::ENTIRE;
        }
        Self { lo: lo.next_down(), hi: hi.next_up() }
    }

    /// The hull of four candidate results, rounded outward.
    fn outward_hull(ends: [f64; 4]) -> Self {
        if ends.iter().any(|e| e.is_nan()) {
            return Self::ENTIRE;
        }
        let [a, b, c, d] = ends;
        Self::outward(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self::outward(self.lo + rhs.lo, self.hi + rhs.hi)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self::outward(self.lo - rhs.hi, self.hi - rhs.lo)
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, rhs: Self) -> Self {
        Self::outward_hull([self.lo * rhs.lo, self.lo * rhs.hi, self.hi * rhs.lo, self.hi * rhs.hi])
    }
}

impl Div for Interval {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        if rhs.contains(0.0) {
            return Self::ENTIRE;
        }
        Self::outward_hull([self.lo / rhs.lo, self.lo / rhs.hi, self.hi / rhs.lo, self.hi / rhs.hi])
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo }
    }
}

impl Add<f64> for Interval {
    type Output = Self;
    fn add(self, rhs: f64) -> Self {
        self + Self::point(rhs)
    }
}

impl Sub<f64> for Interval {
    type Output = Self;
    fn sub(self, rhs: f64) -> Self {
        self - Self::point(rhs)
    }
}

impl Mul<f64> for Interval {
    type Output = Self;
    fn mul(self, rhs: f64) -> Self {
        self * Self::point(rhs)
    }
}

impl BitAnd for Trilean {
    type Output = Self;
    fn bitand(self, rhs: Self) -> Self {
        Self { can_hold: self.can_hold && rhs.can_hold, can_fail: self.can_fail || rhs.can_fail }
    }
}

impl BitOr for Trilean {
    type Output = Self;
    fn bitor(self, rhs: Self) -> Self {
        Self { can_hold: self.can_hold || rhs.can_hold, can_fail: self.can_fail && rhs.can_fail }
    }
}

impl Not for Trilean {
    type Output = Self;
    fn not(self) -> Self {
        Self { can_hold: self.can_fail, can_fail: self.can_hold }
    }
}

impl Scalar for Interval {
    type Mask = Trilean;
    type Table = [f64];

    fn lift(self, c: f64) -> Self {
        Self::point(c)
    }

    fn constant(self, table: &[f64], index: usize) -> Self {
        Self::point(table[index])
    }

    fn lt(self, rhs: Self) -> Trilean {
        Trilean { can_hold: self.lo < rhs.hi, can_fail: self.hi >= rhs.lo }
    }

    fn select(mask: Trilean, yes: Self, no: Self) -> Self {
        match (mask.can_hold, mask.can_fail) {
            (true, false) => yes,
            (false, true) => no,
            _ => yes.hull(no),
        }
    }

    fn any(mask: Trilean) -> bool {
        mask.can_hold
    }

    fn sqrt(self) -> Self {
        // Outward rounding may have pushed a square below 0; the exact argument is not negative.
        let root = Self::outward(self.lo.max(0.0).sqrt(), self.hi.max(0.0).sqrt());
        Self { lo: root.lo.max(0.0), hi: root.hi }
    }

    fn abs(self) -> Self {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            -self
        } else {
            Self { lo: 0.0, hi: self.hi.max(-self.lo) }
        }
    }

    fn min(self, rhs: Self) -> Self {
        Self { lo: self.lo.min(rhs.lo), hi: self.hi.min(rhs.hi) }
    }

    fn max(self, rhs: Self) -> Self {
        Self { lo: self.lo.max(rhs.lo), hi: self.hi.max(rhs.hi) }
    }

    fn square(self) -> Self {
        let a = self.abs();
        let square = Self::outward(a.lo * a.lo, a.hi * a.hi);
        Self { lo: square.lo.max(0.0), hi: square.hi }
    }
}
