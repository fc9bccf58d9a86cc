//! Exponentials, logarithms, powers and floor on lanes.
//!
//! Arguments are taken apart by their bits (Cody and Waite, "Software Manual for the Elementary Functions", 1980); what
//! remains is a minimax polynomial, found by the algorithm of Remez. Denormal numbers are arguments and results like
//! others.

use super::trigonometric::SHIFT;
use super::{Lanes, polynomial};
use fearless_simd::{Bytes, ExtractToken, Select, Simd, SimdBase, SimdFloat, SimdInt, SimdNarrow, SimdWiden};
use std::f32::consts::LOG2_E;

/// ln 2 in 9 bits, whose products with exponents are exact, and what it lacks.
const LN_2_HIGH: f32 = 0.693_359_4;
const LN_2_LOW: f32 = -0.000_212_194_44;

/// The bits of the square root of 1/2: where mantissas start, so that they surround 1.
const MANTISSA_START: i32 = 0x3f35_04f3;

/// The exponential.
#[inline(always)]
pub(super) fn exp<I: Simd>(x: Lanes<I>) -> Lanes<I> {
    // Beyond these all results are 0 and infinite. NaN stays.
    let x = x.0.simd_lt(-104.0).select(I::f32s::splat(x.0.token(), -104.0), x.0);
    let x = x.simd_gt(89.0).select(I::f32s::splat(x.token(), 89.0), x);
    let shifted = x * LOG2_E + SHIFT;
    let n = shifted - SHIFT;
    let r = (x - n * LN_2_HIGH) - n * LN_2_LOW;
    // The polynomial is off by at most 2^-28.1.
    let p = polynomial::<I, _, _>(r, [0.001_381_315, 0.008_369_419, 0.041_668_456, 0.166_665_15, 0.499_999_94]);
    let y = (p * (r * r) + r) + 1.0;
    // In two steps, since the power of two may lie outside the range of numbers where the result does not.
    let n = shifted.bitcast::<I::i32s>() - SHIFT.to_bits() as i32;
    let half = n >> 1;
    Lanes(y * power_of_two::<I>(half) * power_of_two::<I>(n - half))
}

/// `2^n` for an `n` from -126 to 127.
#[inline(always)]
fn power_of_two<I: Simd>(n: I::i32s) -> I::f32s {
    ((n + 127) << 23).bitcast()
}

/// `|x|` as a number around 1 times a power of two, for numbers that are not 0, infinite or NaN.
#[inline(always)]
fn split<I: Simd>(absolute: I::f32s) -> (I::f32s, I::f32s) {
    const DENORMAL_SCALE: f32 = 8_388_608.0;
    let token = absolute.token();
    let denormal = absolute.simd_lt(f32::MIN_POSITIVE);
    let scaled = denormal.select(absolute * DENORMAL_SCALE, absolute);
    let bits = scaled.bitcast::<I::i32s>() - MANTISSA_START;
    let exponent = (bits >> 23).to_float::<I::f32s>();
    let correction = denormal.select(I::f32s::splat(token, 23.0), I::f32s::splat(token, 0.0));
    let mantissa = (bits & 0x007f_ffff) + MANTISSA_START;
    (mantissa.bitcast(), exponent - correction)
}

/// The natural logarithm.
#[inline(always)]
pub(super) fn ln<I: Simd>(x: Lanes<I>) -> Lanes<I> {
    /// Off by at most `2^-27.4`.
    const TERMS: [f32; 8] = [
        -0.076_345_49,
        0.127_616_15,
        -0.131_601_81,
        0.142_017_53,
        -0.166_233_57,
        0.200_012_27,
        -0.250_008_2,
        0.333_333_3,
    ];
    let x = x.0;
    let token = x.token();
    let (mantissa, exponent) = split::<I>(x);
    let f = mantissa - 1.0;
    let square = f * f;
    let p = polynomial::<I, _, _>(f, TERMS);
    let low = (f * square * p + exponent * LN_2_LOW) - square * 0.5;
    let result = (low + f) + exponent * LN_2_HIGH;
    // Infinity and NaN stay themselves.
    let result = x.simd_lt(f32::INFINITY).select(result, x);
    let special = x.simd_eq(0.0).select(I::f32s::splat(token, f32::NEG_INFINITY), I::f32s::splat(token, f32::NAN));
    Lanes((x.simd_gt(0.0)).select(result, special))
}

/// A power, through logarithm and exponential by 2 in double precision, good to 2^-40 where they must be.
#[inline(always)]
pub(super) fn pow<I: Simd>(x: Lanes<I>, exponent: Lanes<I>) -> Lanes<I> {
    let (x, y) = (x.0, exponent.0);
    let token = x.token();
    let absolute = x.abs();
    let (mantissa, scale) = split::<I>(absolute);
    // The logarithm of 0 and infinity, through the part that is added.
    let scale = absolute.simd_lt(f32::INFINITY).select(scale, absolute);
    let scale = absolute.simd_eq(0.0).select(I::f32s::splat(token, f32::NEG_INFINITY), scale);
    let ((m, m_last), (s, s_last), (e, e_last)) = (mantissa.widen(), scale.widen(), y.widen());
    let magnitude: I::f32s = power::<I>(m, s, e).narrow(power::<I>(m_last, s_last, e_last));

    let half = y * 0.5;
    let integer = floor::<I>(Lanes(y)).0.simd_eq(y);
    let odd = integer & !floor::<I>(Lanes(half)).0.simd_eq(half);
    let sign = (x.bitcast::<I::u32s>() ^ absolute.bitcast::<I::u32s>()).bitcast::<I::f32s>();
    let zero = I::f32s::splat(token, 0.0);
    let signed = magnitude.copysign(odd.select(sign, zero));
    let defined = integer | !x.simd_lt(0.0) | x.simd_eq(f32::NEG_INFINITY);
    let nan = I::f32s::splat(token, f32::NAN);
    let one = I::f32s::splat(token, 1.0);
    let result = defined.select(signed, nan);
    // 1 to the power of anything, anything to the power of 0, and -1 to the power of an infinity.
    let unit = y.simd_eq(0.0) | x.simd_eq(1.0) | (x.simd_eq(-1.0) & y.abs().simd_eq(f32::INFINITY));
    Lanes(unit.select(one, result))
}

/// `(mantissa * 2^scale)^exponent`.
#[inline(always)]
fn power<I: Simd>(mantissa: I::f64s, scale: I::f64s, exponent: I::f64s) -> I::f64s {
    /// `1.5 * 2^52`, which rounds fractions away.
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    /// Beyond this power of two single precision has 0 and infinity only.
    const LIMIT: f64 = 160.0;
    let token = mantissa.token();
    let f = (mantissa - 1.0) / (mantissa + 1.0);
    let square = f * f;
    // log2 of the mantissa, off by 2^-45 of itself.
    let p = polynomial::<I, _, _>(
        square,
        [
            0.282_921_616_524_436_37,
            0.319_904_264_302_562_64,
            0.412_209_285_588_007_57,
            0.577_077_942_052_604_4,
            0.961_796_694_114_376_4,
            2.885_390_081_777_849_5,
        ],
    );
    let logarithm = f * p + scale;

    let t = exponent * logarithm;
    let t = t.simd_gt(LIMIT).select(I::f64s::splat(token, LIMIT), t);
    let t = t.simd_lt(-LIMIT).select(I::f64s::splat(token, -LIMIT), t);
    let shifted = t + SHIFT;
    let r = t - (shifted - SHIFT);
    // 2^r, off by 2^-34.5.
    let p = polynomial::<I, _, _>(
        r,
        [
            1.520_192_316_817_142e-5,
            0.000_154_693_181_019_650_93,
            0.001_333_392_274_565_425_8,
            0.009_618_027_169_788_842,
            0.055_504_103_530_023_78,
            0.240_226_511_987_805_06,
            0.693_147_180_728_635_5,
            0.999_999_999_961_622_3,
        ],
    );
    let exponent = shifted.bitcast::<I::u64s>() << 52;
    (p.bitcast::<I::u64s>() + exponent).bitcast()
}

/// The largest integer that is not larger.
#[inline(always)]
pub(super) fn floor<I: Simd>(x: Lanes<I>) -> Lanes<I> {
    #[cfg(target_arch = "x86_64")]
    if matches!(x.0.token().level(), fearless_simd::Level::Sse2(_)) {
        // SSE2 has no such instruction and would call the C library lane by lane. From here on all are integers.
        const INTEGERS: f32 = 8_388_608.0;
        let truncated = x.0.to_int::<I::i32s>().to_float::<I::f32s>();
        let zero = I::f32s::splat(x.0.token(), 0.0);
        let one = I::f32s::splat(x.0.token(), 1.0);
        let floor = truncated - truncated.simd_gt(x.0).select(one, zero);
        return Lanes(x.0.abs().simd_lt(INTEGERS).select(floor.copysign(x.0), x.0));
    }
    Lanes(x.0.floor())
}
