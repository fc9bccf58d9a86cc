//! Dual numbers: a value and its gradient with respect to three inputs (forward automatic differentiation).
//!
//! `Dual<T>` is a scalar over any scalar, so `Dual<Lanes<_>>` is a batch of gradients and `Dual<Dual<f64>>` yields
//! Hessians. At the ties of min, max and select a side is picked; at the origin of a length the derivative is 0.

#![allow(clippy::suspicious_arithmetic_impl, reason = "the product and quotient rules use other operators")]

use super::Scalar;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its partial derivatives by x, y and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T> {
    /// The value.
    pub value: T,
    /// The three partial derivatives.
    pub gradient: [T; 3],
}

impl<T: Scalar> Dual<T> {
    /// A value that does not depend on the inputs.
    #[inline(always)]
    pub fn independent(value: T) -> Self {
        let zero = value.lift(0.0);
        Self { value, gradient: [zero; 3] }
    }

    /// The input number `axis` (0, 1 or 2), at `value`.
    #[inline(always)]
    pub fn input(value: T, axis: usize) -> Self {
        let mut dual = Self::independent(value);
        dual.gradient[axis] = value.lift(1.0);
        dual
    }

    #[inline(always)]
    fn map(self, value: T, f: impl Fn(T) -> T) -> Self {
        let [x, y, z] = self.gradient;
        Self { value, gradient: [f(x), f(y), f(z)] }
    }

    #[inline(always)]
    fn zip(self, rhs: Self, value: T, f: impl Fn(T, T) -> T) -> Self {
        let ([x, y, z], [a, b, c]) = (self.gradient, rhs.gradient);
        Self { value, gradient: [f(x, a), f(y, b), f(z, c)] }
    }

    /// `1 / length`, or 0 at length 0.
    #[inline(always)]
    fn safe_inverse(length: T) -> T {
        let (zero, one) = (length.lift(0.0), length.lift(1.0));
        let positive = zero.lt(length);
        T::select(positive, one / T::select(positive, length, one), zero)
    }
}

impl<T: Scalar> Add for Dual<T> {
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

impl<T: Scalar> Sub for Dual<T> {
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

impl<T: Scalar> Mul for Dual<T> {
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

impl<T: Scalar> Div for Dual<T> {
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

impl<T: Scalar> Neg for Dual<T> {
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

impl<T: Scalar> Add<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: f64) -> Self {
        Self { value: self.value + rhs, ..self }
    }
}

impl<T: Scalar> Sub<f64> for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: f64) -> Self {
        Self { value: self.value - rhs, ..self }
    }
}

impl<T: Scalar> Mul<f64> for Dual<T> {
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

impl<T: Scalar> Scalar for Dual<T> {
    type Mask = T::Mask;
    type Table = T::Table;

    #[inline(always)]
    fn lift(self, c: f64) -> Self {
        Self::independent(self.value.lift(c))
    }

    #[inline(always)]
    fn constant(self, table: &T::Table, index: usize) -> Self {
        Self::independent(self.value.constant(table, index))
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

    #[inline(always)]
    fn any(mask: T::Mask) -> bool {
        T::any(mask)
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
}
