//! Dual numbers: a value and its derivatives with respect to some inputs (forward automatic differentiation).
//!
//! `Dual<T>` is a scalar over any scalar, so `Dual<Lanes<_>>` is a batch of gradients and `Dual<Dual<f64>>` yields
//! Hessians. At the ties of min, max and select a side is picked; at the origin of a length the derivative is 0.

#![allow(clippy::suspicious_arithmetic_impl, reason = "the product and quotient rules use other operators")]

use super::{Constants, Scalar};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its partial derivatives by `N` inputs: x, y and z, unless otherwise said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T, const N: usize = 3> {
    /// The value.
    pub value: T,
    /// The partial derivatives.
    pub gradient: [T; N],
}

impl<T: Scalar> Dual<T> {
    /// The input number `axis`, at `value`.
    #[inline(always)]
    pub fn input(value: T, axis: usize) -> Self {
        let mut dual = Self::independent(value);
        dual.gradient[axis] = value.lift(1.0);
        dual
    }
}

impl<T: Scalar, const N: usize> Dual<T, N> {
    /// A value that does not depend on the inputs.
    #[inline(always)]
    pub fn independent(value: T) -> Self {
        let zero = value.lift(0.0);
        Self { value, gradient: [zero; N] }
    }

    #[inline(always)]
    fn map(self, value: T, f: impl Fn(T) -> T) -> Self {
        let mut gradient = self.gradient;
        // No iterators here: their methods are not always inlined.
        let mut input = 0;
        while input < N {
            gradient[input] = f(gradient[input]);
            input += 1;
        }
        Self { value, gradient }
    }

    #[inline(always)]
    fn zip(self, rhs: Self, value: T, f: impl Fn(T, T) -> T) -> Self {
        let mut gradient = self.gradient;
        let mut input = 0;
        while input < N {
            gradient[input] = f(gradient[input], rhs.gradient[input]);
            input += 1;
        }
        Self { value, gradient }
    }

    /// `1 / length`, or 0 at length 0.
    #[inline(always)]
    fn safe_inverse(length: T) -> T {
        let (zero, one) = (length.lift(0.0), length.lift(1.0));
        let positive = zero.lt(length);
        T::select(positive, one / T::select(positive, length, one), zero)
    }

    /// A function of `self` with its value and its slope here.
    #[inline(always)]
    fn chain(self, value: T, slope: T) -> Self {
        self.map(
            value,
            #[inline(always)]
            |d| d * slope,
        )
    }

    /// A function of `self` and `rhs` with its value and its slopes by both.
    #[inline(always)]
    fn chain2(self, rhs: Self, value: T, [by_self, by_rhs]: [T; 2]) -> Self {
        self.zip(
            rhs,
            value,
            #[inline(always)]
            |a, b| a * by_self + b * by_rhs,
        )
    }

    /// The slope of the arc sine, 0 at its ends.
    #[inline(always)]
    fn arc_slope(self) -> T {
        let one = self.value.lift(1.0);
        // The product keeps its digits near the ends, 1 - x^2 would lose them.
        Self::safe_inverse(((one - self.value) * (one + self.value)).sqrt())
    }
}

impl<T: Scalar, const N: usize> Add for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: Self) -> Self {
        self.zip(
            rhs,
            self.value + rhs.value,
            #[inline(always)]
            |a, b| a + b,
        )
    }
}

impl<T: Scalar, const N: usize> Sub for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: Self) -> Self {
        self.zip(
            rhs,
            self.value - rhs.value,
            #[inline(always)]
            |a, b| a - b,
        )
    }
}

impl<T: Scalar, const N: usize> Mul for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: Self) -> Self {
        let (u, v) = (self.value, rhs.value);
        self.zip(
            rhs,
            u * v,
            #[inline(always)]
            |du, dv| du * v + u * dv,
        )
    }
}

impl<T: Scalar, const N: usize> Div for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, rhs: Self) -> Self {
        let (quotient, v) = (self.value / rhs.value, rhs.value);
        self.zip(
            rhs,
            quotient,
            #[inline(always)]
            |du, dv| (du - quotient * dv) / v,
        )
    }
}

impl<T: Scalar, const N: usize> Neg for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(
            -self.value,
            #[inline(always)]
            |d| -d,
        )
    }
}

impl<T: Scalar, const N: usize> Add<f64> for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: f64) -> Self {
        Self { value: self.value + rhs, ..self }
    }
}

impl<T: Scalar, const N: usize> Sub<f64> for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: f64) -> Self {
        Self { value: self.value - rhs, ..self }
    }
}

impl<T: Scalar, const N: usize> Mul<f64> for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: f64) -> Self {
        self.map(
            self.value * rhs,
            #[inline(always)]
            |d| d * rhs,
        )
    }
}

impl<T: Scalar, const N: usize> Scalar for Dual<T, N> {
    type Mask = T::Mask;
    type Table = T::Table;

    const IS_ENCLOSURE: bool = T::IS_ENCLOSURE;

    #[inline(always)]
    fn lift(self, c: f64) -> Self {
        Self::independent(self.value.lift(c))
    }

    #[inline(always)]
    fn constant(self, table: &T::Table, index: usize) -> Self {
        Self::independent(self.value.constant(table, index))
    }

    #[inline(always)]
    fn nearest_row(p: [Self; 3], constants: &Constants<'_, Self>) -> Option<[Self; 3]> {
        let (table, first) = constants.origin();
        let constants = Constants::new(p[0].value, table, 0).part(first, constants.count());
        let [x, y, z] = T::nearest_row([p[0].value, p[1].value, p[2].value], &constants)?;
        Some([Self::independent(x), Self::independent(y), Self::independent(z)])
    }

    #[inline(always)]
    fn lt(self, rhs: Self) -> T::Mask {
        self.value.lt(rhs.value)
    }

    #[inline(always)]
    fn select(mask: T::Mask, yes: Self, no: Self) -> Self {
        yes.zip(
            no,
            T::select(mask, yes.value, no.value),
            #[inline(always)]
            |a, b| T::select(mask, a, b),
        )
    }

    /// As the default, but with the value's own minimum, which is tighter for intervals.
    #[inline(always)]
    fn min(self, rhs: Self) -> Self {
        let value = self.value.min(rhs.value);
        Self { value, ..Self::select(self.lt(rhs), self, rhs) }
    }

    #[inline(always)]
    fn max(self, rhs: Self) -> Self {
        let value = self.value.max(rhs.value);
        Self { value, ..Self::select(rhs.lt(self), self, rhs) }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let value = self.value.abs();
        Self { value, ..Self::select(self.lt(self.lift(0.0)), -self, self) }
    }

    #[inline(always)]
    fn any(mask: T::Mask) -> bool {
        T::any(mask)
    }

    #[inline(always)]
    fn mix(a: Self, b: Self, share: Self) -> Self {
        let of_values = a.zip(
            b,
            T::mix(a.value, b.value, share.value),
            #[inline(always)]
            |a, b| T::mix(a, b, share.value),
        );
        let gap = b.value - a.value;
        of_values.zip(
            share,
            of_values.value,
            #[inline(always)]
            |slope, growth| slope + gap * growth,
        )
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        let slope = Self::safe_inverse(root) * 0.5;
        self.map(
            root,
            #[inline(always)]
            |d| d * slope,
        )
    }

    #[inline(always)]
    fn square(self) -> Self {
        let twice = self.value * 2.0;
        self.map(
            self.value.square(),
            #[inline(always)]
            |d| d * twice,
        )
    }

    #[inline(always)]
    fn length2(a: Self, b: Self) -> Self {
        let length = T::length2(a.value, b.value);
        let inverse = Self::safe_inverse(length);
        let (u, v) = (a.value * inverse, b.value * inverse);
        a.zip(
            b,
            length,
            #[inline(always)]
            |da, db| u * da + v * db,
        )
    }

    #[inline(always)]
    fn length3(a: Self, b: Self, c: Self) -> Self {
        let length = T::length3(a.value, b.value, c.value);
        let inverse = Self::safe_inverse(length);
        let (u, v, w) = (a.value * inverse, b.value * inverse, c.value * inverse);
        let ab = a.zip(
            b,
            length,
            #[inline(always)]
            |da, db| u * da + v * db,
        );
        ab.zip(
            c,
            length,
            #[inline(always)]
            |dab, dc| dab + w * dc,
        )
    }

    #[inline(always)]
    fn less(self, rhs: Self) -> Self {
        let value = self.value.less(rhs.value);
        let slope = value.step_slope();
        Self { value, gradient: [slope; N] }
    }

    #[inline(always)]
    fn floor(self) -> Self {
        let value = self.value.floor();
        let slope = value.step_slope();
        Self { value, gradient: [slope; N] }
    }

    #[inline(always)]
    fn zigzag(self) -> Self {
        // It rises after even numbers and falls after odd ones; in between an enclosure holds all slopes from -1 to 1.
        let x = self.value;
        let whole = x.floor();
        let odd = whole - (whole * x.lift(0.5)).floor() * x.lift(2.0);
        let slope = (x.lift(1.0) - odd * x.lift(2.0)).clamp(-1.0, 1.0);
        self.chain(x.zigzag(), slope)
    }

    #[inline(always)]
    #[expect(clippy::redundant_closure_for_method_calls, reason = "what a path names would not be inlined")]
    fn agreed(self, other: Self) -> Self {
        self.zip(
            other,
            self.value.agreed(other.value),
            #[inline(always)]
            |own, other| own.agreed(other),
        )
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
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    #[inline(always)]
    fn tan(self) -> Self {
        let tan = self.value.tan();
        self.chain(tan, tan.square() + 1.0)
    }

    #[inline(always)]
    fn asin(self) -> Self {
        self.chain(self.value.asin(), self.arc_slope())
    }

    #[inline(always)]
    fn acos(self) -> Self {
        self.chain(self.value.acos(), -self.arc_slope())
    }

    #[inline(always)]
    fn atan(self) -> Self {
        let one = self.value.lift(1.0);
        self.chain(self.value.atan(), one / (self.value.square() + 1.0))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let inverse = Self::safe_inverse(T::length2(self.value, x.value));
        // Divided twice, because the square of the length leaves the range of single precision early.
        let (sin, cos) = (self.value * inverse, x.value * inverse);
        let mut angle = self.chain2(x, self.value.atan2(x.value), [cos * inverse, -sin * inverse]);
        if T::IS_ENCLOSURE {
            // Where x is negative, the angle jumps with the sign of y; any slope there is one of an enclosure only.
            let zero = x.value.lift(0.0);
            let jump = T::select(x.value.lt(zero), self.value.less(zero), zero).step_slope();
            angle = angle.map(
                angle.value,
                #[inline(always)]
                |slope| slope + jump,
            );
        }
        angle
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let exp = self.value.exp();
        self.chain(exp, exp)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        let one = self.value.lift(1.0);
        self.chain(self.value.ln(), one / self.value)
    }

    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        let (a, b) = (self.value, exponent.value);
        let (zero, one) = (a.lift(0.0), a.lift(1.0));
        let value = a.pow(b);
        let finite = zero.lt(a.abs()) | !b.lt(one);
        let by_base = T::select(finite, b * a.pow(b - 1.0), zero);
        // Its logarithm is 0 where the base is not positive, so that a constant exponent never makes 0 * NaN.
        let positive = zero.lt(a);
        let by_exponent = value * T::select(positive, a, one).ln();
        self.chain2(exponent, value, [by_base, T::select(positive, by_exponent, zero)])
    }

    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        match n {
            0 => self.lift(1.0),
            _ => self.chain(self.value.powi(n), self.value.powi(n.saturating_sub(1)) * f64::from(n)),
        }
    }
}
