//! `f64`: the reference every other number type is tested against.

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
}
