//! `f64`: the reference every other number type is tested against.
//!
//! Elementary functions come from the crate `libm`, a port of those of FreeBSD: the same bits with every C library. Its
//! sources promise errors below one unit in the last place for the exponential and the logarithm. Against numbers of 120
//! bits, 600 000 random arguments each, no function was off by more than 0.9 units, but the arc tangent of two arguments
//! by ATAN2.

use super::Scalar;

impl Scalar for f64 {
    type Mask = bool;
    type Table = [f64];

    #[inline(always)]
    fn lift(self, c: f64) -> Self {
        c
    }

    #[inline(always)]
    fn constant(self, table: &[f64], index: usize) -> Self {
        table[index]
    }

    #[inline(always)]
    fn lt(self, rhs: Self) -> bool {
        self < rhs
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        f64::floor(self)
    }

    #[inline(always)]
    fn sin(self) -> Self {
        libm::sin(self)
    }

    #[inline(always)]
    fn cos(self) -> Self {
        libm::cos(self)
    }

    #[inline(always)]
    fn tan(self) -> Self {
        libm::tan(self)
    }

    #[inline(always)]
    fn asin(self) -> Self {
        libm::asin(self)
    }

    #[inline(always)]
    fn acos(self) -> Self {
        libm::acos(self)
    }

    #[inline(always)]
    fn atan(self) -> Self {
        libm::atan(self)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        libm::exp(self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        libm::log(self)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }

    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        libm::pow(self, exponent)
    }
}
