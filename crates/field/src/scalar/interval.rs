//! Closed intervals of `f64`, rounded outward.
//!
//! Every operation returns an interval that holds each exact result of the operation on numbers from its operands. The
//! processor's rounding mode stays untouched: a correctly rounded result is at most half a unit in the last place off,
//! so moving each end to the next number outward is enough. Where a function is not defined on all of its argument, the
//! result holds its values on the part where it is; where it is defined nowhere, [`Interval::ENTIRE`]. As a number, zero
//! has no sign: 0 counts as +0.

use super::{Scalar, repeated_squaring};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
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

    /// The interval that holds 0 alone.
    pub const ZERO: Self = Self { lo: 0.0, hi: 0.0 };

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

/// How many numbers the ends of elementary functions are moved outward. The errors of `libm` are below one unit in the last
/// place (see the module of `f64`), and next to a power of two a unit is two numbers. Twice that, so that the results
/// computed between the ends lie inside, too.
const STEPS: u32 = 4;

/// The same for the angle of a vector, whose error is below one unit and a half.
const ANGLE_STEPS: u32 = 6;

/// A little less than π and 2π, by more than the rounding error of a width.
const LESS_THAN_PI: f64 = PI - 4e-15;
const LESS_THAN_TWO_PI: f64 = TAU - 8e-15;

impl Interval {
    /// What an increasing function makes of the ends, widened by the error of `libm`.
    fn increasing(self, f: impl Fn(f64) -> f64) -> Self {
        Self::hull_of_libm([f(self.lo), f(self.hi)], STEPS)
    }

    /// The hull of results of `libm`, widened by their errors.
    fn hull_of_libm<const N: usize>(values: [f64; N], steps: u32) -> Self {
        if values.iter().any(|v| v.is_nan()) {
            return Self::ENTIRE;
        }
        let hull = Self {
            lo: values.into_iter().fold(f64::INFINITY, f64::min),
            hi: values.into_iter().fold(f64::NEG_INFINITY, f64::max),
        };
        (0..steps).fold(hull, |wide, _| Self::outward(wide.lo, wide.hi))
    }

    /// `self`, an enclosure of numbers from `[lo, hi]`, without what lies outside.
    fn within(self, lo: f64, hi: f64) -> Self {
        Self { lo: self.lo.clamp(lo, hi), hi: self.hi.clamp(lo, hi) }
    }

    /// The part inside `[lo, hi]`, if there is one.
    fn part(self, lo: f64, hi: f64) -> Option<Self> {
        (self.lo <= hi && self.hi >= lo).then(|| self.within(lo, hi))
    }

    /// A sine or cosine by its values and slopes at both ends. The signs of the slopes are those of computed numbers; these
    /// are right, because the errors are relative.
    fn wave(self, values: [f64; 2], slopes: [f64; 2]) -> Self {
        let width = self.width();
        // Not true for infinite and NaN widths.
        let short = width < LESS_THAN_TWO_PI;
        let [rises_first, rises_last] = slopes.map(|slope| slope > 0.0);
        let ends = Self::hull_of_libm(values, STEPS);
        let range = match (rises_first, rises_last) {
            _ if !short => Self::ENTIRE,
            (true, false) => Self { hi: 1.0, ..ends },
            (false, true) => Self { lo: -1.0, ..ends },
            // Both turning points lie between, or none.
            _ if width < LESS_THAN_PI => ends,
            _ => Self::ENTIRE,
        };
        range.within(-1.0, 1.0)
    }

    /// `x^n` for an odd `n`, or for an `x` that is not negative: increasing there.
    fn power(x: f64, n: u32) -> Self {
        match repeated_squaring(Self::point(x.abs()), n) {
            None => Self::point(1.0),
            Some(_) if x == 0.0 => Self::point(0.0),
            Some(power) if x < 0.0 => -power.within(0.0, f64::INFINITY),
            Some(power) => power.within(0.0, f64::INFINITY),
        }
    }

    /// `1 / self` on the part where it is defined.
    fn reciprocal(self) -> Self {
        let inverse = |x: f64| Self::outward(1.0 / x, 1.0 / x);
        let (negative, positive) = (self.lo < 0.0, self.hi > 0.0);
        if negative == positive {
            return Self::ENTIRE;
        }
        // An end at 0 has the infinity of the other side.
        let end = |x: f64| if x == 0.0 { Self::ENTIRE } else { inverse(x) };
        Self { lo: end(self.hi).lo, hi: end(self.lo).hi }
    }

    /// The powers of a base that is not negative. They are monotone in the base and in the exponent.
    fn pow_of_absolute(self, exponent: Self) -> Self {
        // Without the sign of a zero, whose odd negative powers would have it.
        let ([a, b], [m, n]) = ([self.lo + 0.0, self.hi + 0.0], [exponent.lo, exponent.hi]);
        Self::hull_of_libm([libm::pow(a, m), libm::pow(a, n), libm::pow(b, m), libm::pow(b, n)], STEPS)
            .within(0.0, f64::INFINITY)
    }

    /// The powers of a base that is not positive, with those exponents that are integers: positive ones with even, negative
    /// ones with odd exponents.
    fn pow_of_negative(self, exponent: Self) -> Option<Self> {
        let (first, last) = (exponent.lo.ceil(), exponent.hi.floor());
        let of_parity = |odd: bool| {
            let is_other = |n: f64| (n % 2.0 != 0.0) != odd;
            let lo = if is_other(first) { first + 1.0 } else { first };
            let hi = if is_other(last) { last - 1.0 } else { last };
            (lo <= hi).then(|| (-self).pow_of_absolute(Self { lo, hi }))
        };
        match (of_parity(false), of_parity(true).map(|power| -power)) {
            (Some(even), Some(odd)) => Some(even.hull(odd)),
            (even, odd) => even.or(odd),
        }
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

    const IS_ENCLOSURE: bool = true;

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
        self.part(0.0, f64::INFINITY)
            .map_or(Self::ENTIRE, |part| Self::outward(part.lo.sqrt(), part.hi.sqrt()).within(0.0, f64::INFINITY))
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

    fn step_slope(self) -> Self {
        if self.lo == self.hi { Self::point(0.0) } else { Self::ENTIRE }
    }

    fn floor(self) -> Self {
        Self { lo: self.lo.floor(), hi: self.hi.floor() }
    }

    fn zigzag(self) -> Self {
        if self.width() >= 2.0 {
            return Self { lo: 0.0, hi: 1.0 };
        }
        let (a, b) = (self.lo.zigzag(), self.hi.zigzag());
        // Whether there is an even or an odd number in between.
        let meets = |first: f64| ((self.hi - first) / 2.0).floor() * 2.0 + first >= self.lo;
        let lo = if meets(0.0) { 0.0 } else { a.min(b) };
        let hi = if meets(1.0) { 1.0 } else { a.max(b) };
        // Rounding errors are those of the argument.
        let error = 2.0 * f64::EPSILON * self.lo.abs().max(self.hi.abs());
        Self { lo: (lo - error).max(0.0), hi: (hi + error).min(1.0) }
    }

    fn agreed(self, other: Self) -> Self {
        self.meet(other)
    }

    /// Between its ends a mixture goes straight from one to the other.
    fn mix(a: Self, b: Self, share: Self) -> Self {
        let at = |share: f64| a * (Self::point(1.0) - Self::point(share)) + b * Self::point(share);
        at(share.lo).hull(at(share.hi))
    }

    fn core(self) -> Self {
        let middle = self.middle();
        if middle.is_finite() { Self { lo: middle, hi: middle } } else { self }
    }

    fn around_core(self, a: Self, b: Self) -> Self {
        let radius = |of: Self| (of.hi - of.core().lo).max(of.core().hi - of.lo).next_up();
        let radius = radius(a).max(radius(b));
        Self::outward(self.lo - radius, self.hi + radius)
    }

    fn sin(self) -> Self {
        self.sin_cos().0
    }

    fn cos(self) -> Self {
        self.sin_cos().1
    }

    fn sin_cos(self) -> (Self, Self) {
        let ((sin, cos), (sin_last, cos_last)) = (libm::sincos(self.lo), libm::sincos(self.hi));
        (self.wave([sin, sin_last], [cos, cos_last]), self.wave([cos, cos_last], [-sin, -sin_last]))
    }

    fn tan(self) -> Self {
        let between_poles = self.width() < LESS_THAN_PI && (libm::cos(self.lo) > 0.0) == (libm::cos(self.hi) > 0.0);
        if between_poles { self.increasing(libm::tan) } else { Self::ENTIRE }
    }

    fn asin(self) -> Self {
        let limit = FRAC_PI_2.next_up();
        self.part(-1.0, 1.0).map_or(Self::ENTIRE, |part| part.increasing(libm::asin).within(-limit, limit))
    }

    fn acos(self) -> Self {
        let decreasing = |part: Self| Self::hull_of_libm([libm::acos(part.lo), libm::acos(part.hi)], STEPS);
        self.part(-1.0, 1.0).map_or(Self::ENTIRE, |part| decreasing(part).within(0.0, PI.next_up()))
    }

    fn atan(self) -> Self {
        let limit = FRAC_PI_2.next_up();
        self.increasing(libm::atan).within(-limit, limit)
    }

    fn atan2(self, x: Self) -> Self {
        let limit = PI.next_up();
        // The angle jumps where the ray of the negative x axis is crossed from below.
        if self.lo < 0.0 && self.hi >= 0.0 && x.lo < 0.0 {
            return Self { lo: -limit, hi: limit };
        }
        // Elsewhere it is extreme in corners. Zeros without their signs, which would mean the other side of the jump.
        let ([y, y_last], [x, x_last]) = ([self.lo + 0.0, self.hi + 0.0], [x.lo + 0.0, x.hi + 0.0]);
        let corners = [libm::atan2(y, x), libm::atan2(y, x_last), libm::atan2(y_last, x), libm::atan2(y_last, x_last)];
        Self::hull_of_libm(corners, ANGLE_STEPS).within(-limit, limit)
    }

    fn exp(self) -> Self {
        self.increasing(libm::exp).within(0.0, f64::INFINITY)
    }

    fn ln(self) -> Self {
        self.part(0.0, f64::INFINITY).map_or(Self::ENTIRE, |part| part.increasing(libm::log))
    }

    fn pow(self, exponent: Self) -> Self {
        // Negative powers of 0 are not numbers.
        let nothing_but_a_pole = self.hi == 0.0 && exponent.hi < 0.0;
        let positive = if nothing_but_a_pole { None } else { self.part(0.0, f64::INFINITY) };
        let of_positive = positive.map(|base| base.pow_of_absolute(exponent));
        let negative = if self.lo < 0.0 { self.part(f64::NEG_INFINITY, 0.0) } else { None };
        let of_negative = negative.and_then(|base| base.pow_of_negative(exponent));
        match (of_positive, of_negative) {
            (Some(a), Some(b)) => a.hull(b),
            (a, b) => a.or(b).unwrap_or(Self::ENTIRE),
        }
    }

    fn powi(self, n: i32) -> Self {
        let base = if n % 2 == 0 { self.abs() } else { self };
        let times = n.unsigned_abs();
        let power = Self { lo: Self::power(base.lo, times).lo, hi: Self::power(base.hi, times).hi };
        if n < 0 { power.reciprocal() } else { power }
    }
}
