//! SIMD lanes of `f32`: the hot path.
//!
//! No fused multiply-add and no approximate reciprocals, and min and max are those selects that every x86 level has as
//! one instruction (the second operand wins on ties and NaN): results are the same bits on SSE2, AVX2 and AVX-512.
//!
//! The elementary functions are computed without tables, branches or calls, but for angles beyond 524 288, which go to
//! `libm` lane by lane. [`crate::elementary`] states their errors. Integer powers are multiplied out: their error grows by
//! up to a unit in the last place with each factor.

use super::{Constants, Scalar};
use crate::point_tree::Search;
use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdFloat, SimdMask};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

mod exponential;
mod trigonometric;

/// No instruction set has more lanes.
pub(crate) const WIDEST: usize = 16;

/// The polynomial with these coefficients, the one of the highest power first.
#[inline(always)]
fn polynomial<I: Simd, V: SimdFloat<I>, const N: usize>(x: V, coefficients: [V::Element; N]) -> V {
    let mut sum = x * coefficients[0] + coefficients[1];
    for &coefficient in &coefficients[2..] {
        sum = sum * x + coefficient;
    }
    sum
}

/// One native-width vector of `f32` on the instruction set `I`.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<I: Simd>(I::f32s);

/// One truth value for each lane of [`Lanes`].
#[derive(Clone, Copy)]
pub struct LaneMask<I: Simd>(<I::f32s as SimdBase<I>>::Mask);

impl<I: Simd> Lanes<I> {
    /// How many lanes there are.
    pub const COUNT: usize = <I::f32s as SimdBase<I>>::LEN;

    /// All lanes from the [`Self::COUNT`] numbers of `from`.
    #[inline(always)]
    pub fn load(token: I, from: &[f32]) -> Self {
        Self(I::f32s::from_slice(token, from))
    }

    /// Writes all lanes to `to`, which has [`Self::COUNT`] places.
    #[inline(always)]
    pub fn store(self, to: &mut [f32]) {
        self.0.store_slice(to);
    }

    /// Which lanes are NaN.
    #[inline(always)]
    pub(crate) fn is_nan(self) -> LaneMask<I> {
        LaneMask(self.0.is_nan())
    }

    /// `value` in every lane.
    #[inline(always)]
    pub fn splat(token: I, value: f32) -> Self {
        Self(I::f32s::splat(token, value))
    }
}

macro_rules! arithmetic {
    ($($Trait:ident $method:ident),*) => {$(
        impl<I: Simd> $Trait for Lanes<I> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, rhs: Self) -> Self {
                Self($Trait::$method(self.0, rhs.0))
            }
        }
    )*};
}

arithmetic!(Add add, Sub sub, Mul mul, Div div);

macro_rules! with_constant {
    ($($Trait:ident $method:ident),*) => {$(
        impl<I: Simd> $Trait<f64> for Lanes<I> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, rhs: f64) -> Self {
                $Trait::$method(self, self.lift(rhs))
            }
        }
    )*};
}

with_constant!(Add add, Sub sub, Mul mul);

impl<I: Simd> Neg for Lanes<I> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<I: Simd> BitAnd for LaneMask<I> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, rhs: Self) -> Self {
        Self(self.0 & rhs.0)
    }
}

impl<I: Simd> BitOr for LaneMask<I> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, rhs: Self) -> Self {
        Self(self.0 | rhs.0)
    }
}

impl<I: Simd> Not for LaneMask<I> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl<I: Simd> Scalar for Lanes<I> {
    type Mask = LaneMask<I>;
    type Table = [f32];

    #[inline(always)]
    fn lift(self, c: f64) -> Self {
        Self::splat(self.0.token(), c as f32)
    }

    #[inline(always)]
    fn constant(self, table: &[f32], index: usize) -> Self {
        Self::splat(self.0.token(), table[index])
    }

    #[inline(always)]
    fn lt(self, rhs: Self) -> LaneMask<I> {
        LaneMask(self.0.simd_lt(rhs.0))
    }

    #[inline(always)]
    fn select(mask: LaneMask<I>, yes: Self, no: Self) -> Self {
        Self(mask.0.select(yes.0, no.0))
    }

    #[inline(always)]
    fn nearest_row(p: [Self; 3], constants: &Constants<'_, Self>) -> Option<[Self; 3]> {
        let mut search = Search::new(constants.slice());
        let [mut x, mut y, mut z] = [[0.0; WIDEST]; 3];
        p[0].store(&mut x[..Self::COUNT]);
        p[1].store(&mut y[..Self::COUNT]);
        p[2].store(&mut z[..Self::COUNT]);
        let mut lane = 0;
        while lane < Self::COUNT {
            [x[lane], y[lane], z[lane]] = search.nearest([x[lane], y[lane], z[lane]]);
            lane += 1;
        }
        let (token, count) = (p[0].0.token(), Self::COUNT);
        Some([Self::load(token, &x[..count]), Self::load(token, &y[..count]), Self::load(token, &z[..count])])
    }

    #[inline(always)]
    fn any(mask: LaneMask<I>) -> bool {
        mask.0.any_true()
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn min(self, rhs: Self) -> Self {
        Self(self.0.min(rhs.0))
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn max(self, rhs: Self) -> Self {
        Self(self.0.max(rhs.0))
    }

    #[inline(always)]
    fn floor(self) -> Self {
        exponential::floor(self)
    }

    #[inline(always)]
    fn sin(self) -> Self {
        trigonometric::sin_cos(self).0
    }

    #[inline(always)]
    fn cos(self) -> Self {
        trigonometric::sin_cos(self).1
    }

    #[inline(always)]
    fn tan(self) -> Self {
        trigonometric::tan(self)
    }

    #[inline(always)]
    fn asin(self) -> Self {
        trigonometric::asin(self)
    }

    #[inline(always)]
    fn acos(self) -> Self {
        trigonometric::acos(self)
    }

    #[inline(always)]
    fn atan(self) -> Self {
        trigonometric::atan(self)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        exponential::exp(self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        exponential::ln(self)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        trigonometric::sin_cos(self)
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        trigonometric::atan2(self, x)
    }

    #[inline(always)]
    fn pow(self, exponent: Self) -> Self {
        exponential::pow(self, exponent)
    }
}
