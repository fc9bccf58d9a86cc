//! Taylor models in SIMD lanes of `f32`: a polynomial in one parameter, and a bound of what it leaves out (Makino and Berz,
//! "Taylor models and other validated functional inclusion methods", 2003).
//!
//! A model stands for all functions `f` with `|f(s) - p(s)| <= r` for `-1 <= s <= 1`, where `p` has degree [`DEGREE`]. Every
//! operation returns a model of the results on functions from its operands: what it cuts off from the polynomial and all
//! rounding errors go into `r`. Halving the range of the parameter makes `r` smaller by a factor of 32, where an interval
//! only gets narrower by 2; and a polynomial formula up to that degree leaves rounding errors alone.
//!
//! `r` is infinite where nothing is known. Where a function has no value all over the range, `p` is NaN; where it has one on a
//! part of the range alone, the model holds there.

use super::{Intervals, LaneTrilean, Lanes, Scalar};
use fearless_simd::Simd;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The degree of the polynomials. With 4, a multiplication costs little more than one of intervals with derivatives.
pub const DEGREE: usize = 4;

/// How many coefficients there are.
const TERMS: usize = DEGREE + 1;

/// Twice the largest relative error of one operation in single precision.
const UNIT: f64 = 1.0 / (1 << 23) as f64;

/// As [`UNIT`] for an elementary function: above the largest of their stated errors.
const ELEMENTARY: f64 = 16.0 * UNIT;

/// The relative error of a coefficient of a product: up to five products and four additions, in half units.
const PRODUCT: f64 = 5.0 * UNIT;

/// Makes up for the rounding errors of a bound that is itself computed in single precision: sums of at most a few dozen
/// positive numbers.
const WIDER: f64 = 1.0 + 32.0 * UNIT;

/// Stands for results below the smallest normal number.
const TINY: f64 = f32::MIN_POSITIVE as f64;

/// A polynomial in a parameter between -1 and 1, and how far the function may be from it.
#[derive(Clone, Copy, Debug)]
pub struct Taylor<I: Simd> {
    /// The coefficients, that of the lowest power first.
    pub p: [Lanes<I>; TERMS],
    /// The bound, which is not negative.
    pub r: Lanes<I>,
}

/// The coefficients of all powers. A function that takes a closure, as those of the standard library, would lose the instruction set.
macro_rules! powers {
    ($power:ident => $coefficient:expr) => {
        [
            {
                let $power = 0;
                $coefficient
            },
            {
                let $power = 1;
                $coefficient
            },
            {
                let $power = 2;
                $coefficient
            },
            {
                let $power = 3;
                $coefficient
            },
            {
                let $power = 4;
                $coefficient
            },
        ]
    };
}

/// The sum of absolute values.
#[inline(always)]
fn size<I: Simd>(terms: &[Lanes<I>]) -> Lanes<I> {
    let mut sum = terms[0].abs();
    for &term in &terms[1..] {
        sum = sum + term.abs();
    }
    sum
}

impl<I: Simd> Taylor<I> {
    /// The constant functions between two numbers each.
    #[inline(always)]
    pub fn constant_within(range: Intervals<I>) -> Self {
        let middle = range.lo * 0.5 + range.hi * 0.5;
        let radius = (range.hi - middle).max(middle - range.lo);
        let size = range.lo.abs() + range.hi.abs();
        let is_known = size.lt(size.lift(f64::INFINITY));
        Self::around(middle, (radius + size * UNIT + TINY) * WIDER).known_if(is_known)
    }

    /// Constant functions as far as is known of a function of `self`: it has no value where that has none.
    #[inline(always)]
    fn flat(self, range: Intervals<I>) -> Self {
        Self::constant_within(range).undefined_if(self.p[0].is_nan())
    }

    /// The functions that stay within `r` of a constant.
    #[inline(always)]
    pub fn around(middle: Lanes<I>, r: Lanes<I>) -> Self {
        let zero = middle.lift(0.0);
        Self { p: [middle, zero, zero, zero, zero], r }
    }

    /// What the functions can have as values.
    #[inline(always)]
    pub fn range(self) -> Intervals<I> {
        let [constant, odd, even, odd3, even4] = self.p;
        let zero = constant.lift(0.0);
        let sway = odd.abs() + odd3.abs() + self.r;
        // Even powers do not become negative.
        let (low, high) = (even.min(zero) + even4.min(zero), even.max(zero) + even4.max(zero));
        let slack = size(&self.p) * PRODUCT + TINY;
        Intervals { lo: constant + low - sway - slack, hi: constant + high + sway + slack }.or_entire()
    }

    /// The largest absolute value that the functions can have.
    #[inline(always)]
    fn magnitude(self) -> Lanes<I> {
        (size(&self.p) + self.r) * WIDER
    }

    /// What the functions have beyond the constant term, and how large it can be.
    #[inline(always)]
    fn rest(self) -> (Self, Lanes<I>) {
        let rest = Self { p: powers!(power => if power == 0 { self.r.lift(0.0) } else { self.p[power] }), r: self.r };
        (rest, rest.magnitude())
    }

    /// Adds to the bound.
    #[inline(always)]
    fn with_slack(self, slack: Lanes<I>) -> Self {
        Self { r: (self.r + slack) * WIDER, ..self }
    }

    /// The function `f(a + u)`, where `a` is the constant term and `u` the rest of `self`, by the Taylor coefficients of `f` at
    /// `a` and a bound of the remainder; `error` bounds the relative error of the coefficients.
    #[inline(always)]
    fn compose(rest: Self, f: [Lanes<I>; TERMS], remainder: Lanes<I>, error: f64) -> Self {
        let zero = remainder.lift(0.0);
        let bent = size(&rest.p[2..]);
        if !Lanes::any(zero.lt(bent)) {
            return Self::compose_line(rest, f, remainder, error);
        }
        let mut sum = Self::around(f[DEGREE], f[DEGREE].abs() * error + TINY);
        for power in (0..DEGREE).rev() {
            sum = sum * rest + Self::around(f[power], f[power].abs() * error + TINY);
        }
        sum.with_slack(remainder * WIDER + TINY)
    }

    /// [`Taylor::compose`] where `u` is linear, as coordinates are along a ray: its powers are known.
    #[inline(always)]
    fn compose_line(rest: Self, f: [Lanes<I>; TERMS], remainder: Lanes<I>, error: f64) -> Self {
        let slope = rest.p[1];
        let reach = slope.abs() + rest.r;
        let (mut p, mut power, mut far) = (f, slope, reach);
        // How much the result changes with what is not linear in `u`.
        let mut change = f[1].abs();
        for index in 1..TERMS {
            p[index] = f[index] * power;
            if index < DEGREE {
                change = change + f[index + 1].abs() * far * (index + 1) as f64;
                (power, far) = (power * slope, far * reach);
            }
        }
        let own = size(&p) * (error + PRODUCT);
        Self { p, r: (rest.r * change + own + remainder) * WIDER + TINY }
    }

    /// The function `f(a + u)` by its value at `a` and bounds of its derivative over all arguments (the mean value theorem).
    #[inline(always)]
    fn compose_slope(self, value: Lanes<I>, derivative: Intervals<I>) -> Self {
        let (rest, reach) = self.rest();
        let slope = Self::constant_within(derivative);
        let product = rest.scaled_by(slope.p[0]);
        let sum = Self { p: powers!(power => if power == 0 { value } else { product.p[power] }), r: product.r };
        sum.with_slack(slope.r * reach + value.abs() * ELEMENTARY + TINY)
    }

    /// `factor` times the functions.
    #[inline(always)]
    pub fn scaled_by(self, factor: Lanes<I>) -> Self {
        let p = powers!(power => self.p[power] * factor);
        let r = (self.r * factor.abs() + size(&p) * UNIT) * WIDER + TINY;
        Self { p, r }
    }

    /// The functions where `mask` holds, nothing known elsewhere.
    #[inline(always)]
    fn known_if(self, mask: <Lanes<I> as Scalar>::Mask) -> Self {
        let zero = self.r.lift(0.0);
        Self {
            p: powers!(power => Lanes::select(mask, self.p[power], zero)),
            r: Lanes::select(mask, self.r, self.r.lift(f64::INFINITY)),
        }
    }

    /// The functions, but no values at all where `mask` holds.
    #[inline(always)]
    fn undefined_if(self, mask: <Lanes<I> as Scalar>::Mask) -> Self {
        let nothing = self.r.lift(f64::NAN);
        Self { p: powers!(power => Lanes::select(mask, nothing, self.p[power])), r: self.r }
    }

    /// `yes` where `mask` holds, `no` elsewhere.
    #[inline(always)]
    fn choose(mask: <Lanes<I> as Scalar>::Mask, yes: Self, no: Self) -> Self {
        Self {
            p: powers!(power => Lanes::select(mask, yes.p[power], no.p[power])),
            r: Lanes::select(mask, yes.r, no.r),
        }
    }

    /// A model of the functions of both.
    #[inline(always)]
    fn hull(self, other: Self) -> Self {
        let half = powers!(power => (self.p[power] - other.p[power]) * 0.5);
        let middle = powers!(power => self.p[power] * 0.5 + other.p[power] * 0.5);
        let slack = (size(&self.p) + size(&other.p)) * (2.0 * UNIT) + TINY;
        let both = Self { p: middle, r: (size(&half) + self.r.max(other.r) + slack) * WIDER };
        // What has no value leaves it to the other.
        Self::choose(self.p[0].is_nan(), other, Self::choose(other.p[0].is_nan(), self, both))
    }

    /// `1 / self`.
    #[inline(always)]
    fn reciprocal(self) -> Self {
        let (rest, reach) = self.rest();
        let one = self.r.lift(1.0);
        let inverse = one / self.p[0];
        let ratio = reach * inverse.abs() * WIDER;
        let mut f = [inverse; TERMS];
        for power in 1..TERMS {
            f[power] = -(f[power - 1] * inverse);
        }
        // The series is geometric.
        let fifth = ratio.square().square() * ratio;
        let remainder = fifth * inverse.abs() / (one - ratio);
        Self::compose(rest, f, remainder, 8.0 * UNIT).known_if(ratio.lt(one.lift(0.999)))
    }
}

impl<I: Simd> Intervals<I> {
    /// Everything where an end is NaN.
    #[inline(always)]
    fn or_entire(self) -> Self {
        let unknown = self.lo.is_nan() | self.hi.is_nan();
        Self {
            lo: Lanes::select(unknown, self.lo.lift(f64::NEG_INFINITY), self.lo),
            hi: Lanes::select(unknown, self.hi.lift(f64::INFINITY), self.hi),
        }
    }
}

impl<I: Simd> Add for Taylor<I> {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: Self) -> Self {
        let p = powers!(power => self.p[power] + rhs.p[power]);
        Self { p, r: (self.r + rhs.r + size(&p) * UNIT) * WIDER }
    }
}

impl<I: Simd> Sub for Taylor<I> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: Self) -> Self {
        let p = powers!(power => self.p[power] - rhs.p[power]);
        Self { p, r: (self.r + rhs.r + size(&p) * UNIT) * WIDER }
    }
}

impl<I: Simd> Mul for Taylor<I> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: Self) -> Self {
        let (a, b) = (self.p, rhs.p);
        let p = powers!(power => {
            let mut sum = a[0] * b[power];
            for i in 1..=power {
                sum = sum + a[i] * b[power - i];
            }
            sum
        });
        // Products of higher powers are left out; `above` is what the second factor has from some power on.
        let mut above = b[DEGREE].abs();
        let mut cut = a[1].abs() * above;
        for i in 2..TERMS {
            above = above + b[TERMS - i].abs();
            cut = cut + a[i].abs() * above;
        }
        let (size_a, size_b) = (size(&a), above + b[0].abs());
        let drift = size_a * rhs.r + (size_b + rhs.r) * self.r;
        Self { p, r: (cut + drift + size_a * size_b * PRODUCT) * WIDER + TINY }
    }
}

impl<I: Simd> Div for Taylor<I> {
    type Output = Self;
    #[inline(always)]
    #[allow(clippy::suspicious_arithmetic_impl, reason = "a quotient is a product with the reciprocal")]
    fn div(self, rhs: Self) -> Self {
        self * rhs.reciprocal()
    }
}

impl<I: Simd> Neg for Taylor<I> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { p: powers!(power => -self.p[power]), r: self.r }
    }
}

impl<I: Simd> Add<f64> for Taylor<I> {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: f64) -> Self {
        self + self.lift(rhs)
    }
}

impl<I: Simd> Sub<f64> for Taylor<I> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: f64) -> Self {
        self - self.lift(rhs)
    }
}

impl<I: Simd> Mul<f64> for Taylor<I> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: f64) -> Self {
        let factor = self.r.lift(rhs);
        let near = rhs as f32;
        let inexact = if f64::from(near) == rhs { 0.0 } else { (f64::from(near) - rhs).abs() * 2.0 };
        self.scaled_by(factor).with_slack(self.magnitude() * inexact)
    }
}

impl<I: Simd> Scalar for Taylor<I> {
    type Mask = LaneTrilean<<Lanes<I> as Scalar>::Mask>;
    type Table = [f32];

    const IS_ENCLOSURE: bool = true;

    #[inline(always)]
    fn lift(self, c: f64) -> Self {
        let near = c as f32;
        let inexact = if f64::from(near) == c { 0.0 } else { (f64::from(near) - c).abs() * 2.0 };
        Self::around(self.r.lift(c), self.r.lift(inexact))
    }

    /// Constants are rounded to single precision: the exact one lies between the neighbours.
    #[inline(always)]
    fn constant(self, table: &[f32], index: usize) -> Self {
        let near = self.r.lift(table[index].into());
        Self::around(near, near.abs() * UNIT + TINY)
    }

    #[inline(always)]
    fn lt(self, rhs: Self) -> Self::Mask {
        (self - rhs).range().lt(Intervals::point(self.r.lift(0.0)))
    }

    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        let decided = Self::choose(mask.holds(), yes, no);
        // Along most stretches all comparisons are decided.
        if Lanes::<I>::any(mask.is_open()) { Self::choose(mask.is_open(), yes.hull(no), decided) } else { decided }
    }

    #[inline(always)]
    fn min(self, rhs: Self) -> Self {
        let mask = self.lt(rhs);
        let decided = Self::choose(mask.holds(), self, rhs);
        if !Lanes::<I>::any(mask.is_open()) {
            return decided;
        }
        // Of two that go side by side, a model of both keeps the shape; of one that goes far beyond the other, nothing but its
        // range.
        let (both, flat) = (self.hull(rhs), Self::constant_within(self.range().min(rhs.range())));
        Self::choose(mask.is_open(), Self::choose(flat.r.lt(both.r), flat, both), decided)
    }

    #[inline(always)]
    fn max(self, rhs: Self) -> Self {
        -(-self).min(-rhs)
    }

    #[inline(always)]
    fn any(mask: Self::Mask) -> bool {
        <Intervals<I> as Scalar>::any(mask)
    }

    #[inline(always)]
    fn step_slope(self) -> Self {
        Self::constant_within(self.range().step_slope())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let zero = self.r.lift(0.0);
        let range = self.range();
        let folded = self.flat(range.abs());
        Self::choose(!range.lo.lt(zero), self, Self::choose(!zero.lt(range.hi), -self, folded))
    }

    #[inline(always)]
    fn square(self) -> Self {
        let a = self.p;
        let two = powers!(power => a[power] + a[power]);
        let p = [
            a[0].square(),
            two[0] * a[1],
            two[0] * a[2] + a[1].square(),
            two[0] * a[3] + two[1] * a[2],
            two[0] * a[4] + two[1] * a[3] + a[2].square(),
        ];
        let cut = (a[1] * two[4]).abs() + (a[2] * two[3]).abs() + size(&a[3..]) * size(&a[2..]) * 2.0;
        let size = size(&a);
        Self { p, r: (cut + (size + size + self.r) * self.r + size.square() * PRODUCT) * WIDER + TINY }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let (rest, reach) = self.rest();
        let one = self.r.lift(1.0);
        let root = self.p[0].sqrt();
        let inverse = one / self.p[0];
        let ratio = reach * inverse * WIDER;
        // The binomial series; its coefficients for the powers of the rest.
        let first = root * inverse * 0.5;
        let second = first * inverse * -0.25;
        let third = second * inverse * -0.5;
        let fourth = third * inverse * -0.625;
        // The fifth derivative is steepest at the lower end: below (1 - ratio)^(-9/2), at most (1 - ratio)^(-5).
        let left = one - ratio;
        let fifth = ratio.square().square() * ratio;
        let remainder = root * fifth * (7.0 / 256.0) / (left.square().square() * left);
        let series = Self::compose(rest, [root, first, second, third, fourth], remainder, 12.0 * UNIT);
        let range = self.range();
        let zero = one.lift(0.0);
        let is_known = zero.lt(self.p[0]) & ratio.lt(one.lift(0.9));
        Self::choose(is_known, series, self.flat(range.sqrt())).undefined_if(range.hi.lt(zero))
    }

    #[inline(always)]
    fn floor(self) -> Self {
        let range = self.range();
        let floor = range.floor();
        let is_one = !floor.lo.lt(floor.hi) & !floor.hi.lt(floor.lo);
        Self::choose(is_one, Self::around(floor.lo, self.r.lift(0.0)), self.flat(floor))
    }

    #[inline(always)]
    fn zigzag(self) -> Self {
        let range = self.range();
        let two = self.r.lift(2.0);
        let middle = ((self.p[0] + self.r.lift(1.0)) * self.r.lift(0.5)).floor() * two;
        let mut near = self;
        near.p[0] = near.p[0] - middle;
        let ends = near.range();
        let (one, least) = (self.r.lift(1.0), self.r.lift(-1.0));
        let is_one = !ends.lo.lt(least) & !one.lt(ends.hi);
        Self::choose(is_one, near.abs(), self.flat(range.zigzag()))
    }

    #[inline(always)]
    fn agreed(self, other: Self) -> Self {
        // Common parts of two models are no model; the narrower one is.
        let [own, others] = [self.range(), other.range()];
        Self::choose((others.hi - others.lo).lt(own.hi - own.lo), other, self)
    }

    #[inline(always)]
    fn core(self) -> Self {
        Self { r: self.r.lift(0.0), ..self }
    }

    #[inline(always)]
    fn around_core(self, a: Self, b: Self) -> Self {
        // The larger bound, and NaN for what has no value.
        self.with_slack(Lanes::select(a.r.lt(b.r), b.r, a.r)).undefined_if(a.p[0].is_nan() | b.p[0].is_nan())
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
        let (rest, reach) = self.rest();
        let (sin, cos) = self.p[0].sin_cos();
        let fifth = reach.square().square() * reach * (1.0 / 120.0);
        let is_short = reach.lt(reach.lift(2.0));
        let one = reach.lift(1.0);
        // Errors of the coefficients are absolute here: small values are as inexact as large ones.
        let slack = one * ELEMENTARY;
        let anything = Self::around(one.lift(0.0), one);
        let sine = Self::compose(rest, wave(sin, cos), fifth + slack, ELEMENTARY);
        let cosine = Self::compose(rest, wave(cos, -sin), fifth + slack, ELEMENTARY);
        let anything = anything.undefined_if(self.p[0].is_nan());
        (Self::choose(is_short, sine, anything), Self::choose(is_short, cosine, anything))
    }

    #[inline(always)]
    fn tan(self) -> Self {
        let one = Intervals::point(self.r.lift(1.0));
        let tan = self.range().tan();
        self.compose_slope(self.p[0].tan(), one + tan.square())
    }

    #[inline(always)]
    fn asin(self) -> Self {
        let value = self.p[0].asin();
        self.arc(value, self.range().asin(), 1.0)
    }

    #[inline(always)]
    fn acos(self) -> Self {
        let value = self.p[0].acos();
        self.arc(value, self.range().acos(), -1.0)
    }

    #[inline(always)]
    fn atan(self) -> Self {
        let one = Intervals::point(self.r.lift(1.0));
        self.compose_slope(self.p[0].atan(), one / (one + self.range().square()))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        self.flat(self.range().atan2(x.range())).undefined_if(x.p[0].is_nan())
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let (rest, reach) = self.rest();
        let value = self.p[0].exp();
        let fifth = reach.square().square() * reach * (1.0 / 120.0);
        let most = (self.p[0] + reach).exp() * (1.0 + ELEMENTARY) + TINY;
        let f = [value, value, value * 0.5, value * (1.0 / 6.0), value * (1.0 / 24.0)];
        let series = Self::compose(rest, f, fifth * most, ELEMENTARY);
        let is_long = reach.lift(1.0).lt(reach);
        if !Lanes::<I>::any(is_long) {
            return series;
        }
        // Far from the middle the series goes astray, and the range is what is left.
        let flat = self.flat(self.range().exp());
        Self::choose(is_long, Self::choose(flat.r.lt(series.r), flat, series), series)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        let (rest, reach) = self.rest();
        let one = self.r.lift(1.0);
        let inverse = one / self.p[0];
        let ratio = reach * inverse * WIDER;
        let (second, third) = (inverse.square(), inverse.square() * inverse);
        let f = [self.p[0].ln(), inverse, second * -0.5, third * (1.0 / 3.0), second.square() * -0.25];
        let left = one - ratio;
        let fifth = ratio.square().square() * ratio;
        let remainder = fifth * 0.2 / (left.square().square() * left) + one * ELEMENTARY;
        let series = Self::compose(rest, f, remainder, ELEMENTARY);
        let range = self.range();
        let zero = one.lift(0.0);
        let is_known = zero.lt(self.p[0]) & ratio.lt(one.lift(0.9));
        Self::choose(is_known, series, self.flat(range.ln())).undefined_if(range.hi.lt(zero))
    }

    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        let zero = self.r.lift(0.0);
        let base = self.range();
        let smooth = (exponent * self.ln()).exp();
        Self::choose(
            zero.lt(base.lo),
            smooth,
            self.flat(base.pow(exponent.range())).undefined_if(exponent.p[0].is_nan()),
        )
    }

    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        match super::repeated_squaring(self, n.unsigned_abs()) {
            None => self.lift(1.0),
            Some(power) if n < 0 => power.reciprocal(),
            Some(power) => power,
        }
    }
}

/// The Taylor coefficients of a sine or cosine by its value and slope.
#[inline(always)]
fn wave<I: Simd>(value: Lanes<I>, slope: Lanes<I>) -> [Lanes<I>; TERMS] {
    [value, slope, value * -0.5, slope * (-1.0 / 6.0), value * (1.0 / 24.0)]
}

impl<I: Simd> Taylor<I> {
    /// An inverse sine or cosine, whose slope is `sign / sqrt(1 - x^2)`, by its value at the constant term and all its values.
    #[inline(always)]
    fn arc(self, value: Lanes<I>, values: Intervals<I>, sign: f64) -> Self {
        let one = self.r.lift(1.0);
        let range = self.range();
        let unit = Intervals::point(one);
        let smooth = self.compose_slope(value, unit / (unit - range.square()).sqrt() * sign);
        let is_inside = range.abs().hi.lt(one);
        let is_outside = one.lt(range.lo) | range.hi.lt(-one);
        Self::choose(is_inside, smooth, self.flat(values)).undefined_if(is_outside)
    }
}
