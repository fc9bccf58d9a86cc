//! Sines, tangents and their inverses on lanes.
//!
//! Angles are reduced in double precision by multiples of π/2 split into two numbers (Cody and Waite, "Software Manual for
//! the Elementary Functions", 1980); what remains is a minimax polynomial, found by the algorithm of Remez. Huge angles
//! are rare and left to `libm`, lane by lane.

use super::{Lanes, WIDEST, polynomial};
use fearless_simd::{
    Bytes, ExtractToken, MaskWiden, Select, Simd, SimdBase, SimdFloat, SimdMask, SimdNarrow, SimdWiden,
};
use std::f32::consts::{FRAC_2_PI, FRAC_PI_2};

/// Up to here the number of quarter turns is found well enough in single precision: what remains is at most π/4 + 0.04.
const LIMIT: f32 = 524_288.0;

/// `1.5 * 2^23`: added to a number below `2^22`, its fraction is rounded away, and the last bits are the integer's.
pub(super) const SHIFT: f32 = 12_582_912.0;

/// π/2, its first 31 bits: their product with a number of quarter turns is exact.
const QUARTER_HIGH: f64 = 1.570_796_326_734_125_6;
/// π/2 less these.
const QUARTER_LOW: f64 = 6.077_100_506_506_192e-11;

/// `near` of angles up to the limit; beyond and for NaN `exact`, lane by lane.
#[inline(always)]
fn with_far<I: Simd, const N: usize>(
    x: Lanes<I>,
    near: impl Fn(Lanes<I>) -> [Lanes<I>; N],
    exact: [fn(f64) -> f64; N],
) -> [Lanes<I>; N] {
    if x.0.abs().simd_le(LIMIT).all_true() {
        return near(x);
    }
    // Through memory of its own, so that the lanes above stay in registers.
    let (mut numbers, mut results) = ([0.0; WIDEST], [[0.0; WIDEST]; N]);
    x.store(&mut numbers[..Lanes::<I>::COUNT]);
    far(x.0.token(), &numbers, near, exact, &mut results);
    let mut lanes = [x; N];
    for (lanes, result) in lanes.iter_mut().zip(&results) {
        *lanes = Lanes::load(x.0.token(), &result[..Lanes::<I>::COUNT]);
    }
    lanes
}

/// Lanes up to the limit are computed as ever: no result may depend on neighbours.
#[cold]
#[inline(never)]
fn far<I: Simd, const N: usize>(
    token: I,
    numbers: &[f32; WIDEST],
    near: impl Fn(Lanes<I>) -> [Lanes<I>; N],
    exact: [fn(f64) -> f64; N],
    results: &mut [[f32; WIDEST]; N],
) {
    let count = Lanes::<I>::COUNT;
    let nears = token.vectorize(
        #[inline(always)]
        || near(Lanes::load(token, &numbers[..count])),
    );
    for ((result, near), exact) in results.iter_mut().zip(nears).zip(exact) {
        near.store(&mut result[..count]);
        for (result, &x) in result.iter_mut().zip(numbers) {
            if x.abs() > LIMIT || x.is_nan() {
                *result = exact(x.into()) as f32;
            }
        }
    }
}

/// `x`, not negative, less the nearest multiple of π/2, and an integer whose last two bits are the multiple's.
#[inline(always)]
fn reduce<I: Simd>(x: I::f32s) -> ([I::f64s; 2], I::u32s) {
    let shifted = x * FRAC_2_PI + SHIFT;
    let ((x, x_last), (n, n_last)) = (x.widen(), (shifted - SHIFT).widen());
    ([rest::<I>(x, n), rest::<I>(x_last, n_last)], shifted.bitcast())
}

#[inline(always)]
fn rest<I: Simd>(x: I::f64s, n: I::f64s) -> I::f64s {
    (x - n * QUARTER_HIGH) - n * QUARTER_LOW
}

/// The sine in `[-0.84, 0.84]`, where the polynomial is off by at most `2^-27.2`.
#[inline(always)]
fn sine<I: Simd>(x: I::f32s, square: I::f32s) -> I::f32s {
    x + x * square * polynomial::<I, _, _>(square, [-0.000_194_684_65, 0.008_331_798, -0.166_666_5])
}

/// The cosine in `[-0.84, 0.84]`, where the polynomial is off by at most `2^-32`.
#[inline(always)]
fn cosine<I: Simd>(square: I::f32s) -> I::f32s {
    let p = polynomial::<I, _, _>(square, [2.437_957e-5, -0.001_388_682_3, 0.041_666_634]);
    square * square * p - square * 0.5 + 1.0
}

/// Sine and cosine.
#[inline(always)]
pub(super) fn sin_cos<I: Simd>(x: Lanes<I>) -> (Lanes<I>, Lanes<I>) {
    let [sin, cos] = with_far(
        x,
        #[inline(always)]
        |x| near_sin_cos(x),
        [libm::sin, libm::cos],
    );
    (sin, cos)
}

#[inline(always)]
fn near_sin_cos<I: Simd>(x: Lanes<I>) -> [Lanes<I>; 2] {
    let absolute = x.0.abs();
    let ([rest, rest_last], quadrant) = reduce::<I>(absolute);
    let rest: I::f32s = rest.narrow(rest_last);
    let square = rest * rest;
    let (sine, cosine) = (sine::<I>(rest, square), cosine::<I>(square));
    let even = (quadrant & 1).simd_eq(0);
    let sign = x.0.bitcast::<I::u32s>() ^ absolute.bitcast::<I::u32s>();
    let sin = even.select(sine, cosine).bitcast::<I::u32s>() ^ ((quadrant & 2) << 30) ^ sign;
    let cos = even.select(cosine, sine).bitcast::<I::u32s>() ^ (((quadrant + 1) & 2) << 30);
    [Lanes(sin.bitcast()), Lanes(cos.bitcast())]
}

/// The tangent.
#[inline(always)]
pub(super) fn tan<I: Simd>(x: Lanes<I>) -> Lanes<I> {
    let [tan] = with_far(
        x,
        #[inline(always)]
        |x| near_tan(x),
        [libm::tan],
    );
    tan
}

/// In double precision throughout: two polynomials and a division would add up to more than two units.
#[inline(always)]
fn near_tan<I: Simd>(x: Lanes<I>) -> [Lanes<I>; 1] {
    let absolute = x.0.abs();
    let ([rest, rest_last], quadrant) = reduce::<I>(absolute);
    let (even, even_last) = (quadrant & 1).simd_eq(0).widen();
    let tan: I::f32s = quotient::<I>(rest, even).narrow(quotient::<I>(rest_last, even_last));
    let sign = x.0.bitcast::<I::u32s>() ^ absolute.bitcast::<I::u32s>();
    [Lanes((tan.bitcast::<I::u32s>() ^ sign).bitcast())]
}

/// The tangent of an angle in `[-0.84, 0.84]` and an even or odd number of quarter turns, off by at most `2^-36`.
#[inline(always)]
fn quotient<I: Simd>(x: I::f64s, even: I::mask64s) -> I::f64s {
    let square = x * x;
    let sine = polynomial::<I, _, _>(
        square,
        [
            2.712_718_514_512_787_3e-6,
            -0.000_198_387_072_998_047_34,
            0.008_333_327_294_481_814,
            -0.166_666_666_222_341_08,
        ],
    );
    let cosine = polynomial::<I, _, _>(
        square,
        [-2.715_467_131_063_887e-7, 2.479_879_420_468_391e-5, -0.001_388_888_077_031_320_4, 0.041_666_666_585_045_49],
    );
    let (sine, cosine) = (x + x * square * sine, square * square * cosine - square * 0.5 + 1.0);
    even.select(sine, -cosine) / even.select(cosine, sine)
}

/// The arc tangent in `[0, 1]`, where the polynomial is off by at most `2^-28.5`.
#[inline(always)]
fn arc_tangent<I: Simd>(x: I::f32s) -> I::f32s {
    const TERMS: [f32; 9] = [
        -0.001_793_622_2,
        0.010_914_608,
        -0.031_177_85,
        0.057_957_6,
        -0.084_034_51,
        0.109_521_86,
        -0.142_642_42,
        0.199_985_49,
        -0.333_333,
    ];
    let square = x * x;
    x + x * square * polynomial::<I, _, _>(square, TERMS)
}

/// What π/2 is more than its nearest number of single precision, over that number.
const QUARTER_REST: f32 = -2.782_753_5e-8;

/// The arc tangent.
#[inline(always)]
pub(super) fn atan<I: Simd>(x: Lanes<I>) -> Lanes<I> {
    let absolute = x.0.abs();
    let one = I::f32s::splat(absolute.token(), 1.0);
    let steep = absolute.simd_gt(1.0);
    let t = arc_tangent::<I>(steep.select(one, absolute) / steep.select(absolute, one));
    let complement = -(t - FRAC_PI_2 * QUARTER_REST) + FRAC_PI_2;
    Lanes(steep.select(complement, t).copysign(x.0))
}

/// The angle of a vector.
#[inline(always)]
pub(super) fn atan2<I: Simd>(y: Lanes<I>, x: Lanes<I>) -> Lanes<I> {
    let (x_absolute, y_absolute) = (x.0.abs(), y.0.abs());
    let token = x_absolute.token();
    let steep = y_absolute.simd_gt(x_absolute);
    let (less, more) = (steep.select(x_absolute, y_absolute), steep.select(y_absolute, x_absolute));
    let (zero, one) = (I::f32s::splat(token, 0.0), I::f32s::splat(token, 1.0));
    // 0/0 counts as 0, and the quotient of equal numbers as 1 also if they are infinite.
    let more = more.simd_eq(0.0).select(one, more);
    let t = arc_tangent::<I>(less.simd_eq(more).select(one, less / more));
    let left = (x.0.bitcast::<I::i32s>() >> 31).simd_eq(-1);
    let quarter = I::f32s::splat(token, FRAC_PI_2);
    let base = steep.select(quarter, left.select(quarter + quarter, zero));
    let turned = (steep ^ left).select(-t, t);
    Lanes((base + (base * QUARTER_REST + turned)).copysign(y.0))
}

/// The arc sine less its argument, over the cube of it, in `[0, 1/2]`; makes the arc sine off by at most `2^-27.6`.
#[inline(always)]
fn arc_sine_term<I: Simd>(square: I::f32s) -> I::f32s {
    polynomial::<I, _, _>(square, [0.042_166_393, 0.024_179_462, 0.045_470_387, 0.074_952_975, 0.166_667_52])
}

/// The two terms of the arc sine of `|x|` up to 1/2, beyond that those of the half angle's sine; and which it is.
#[inline(always)]
fn arc_sine<I: Simd>(absolute: I::f32s) -> ([I::f32s; 2], <I::f32s as SimdBase<I>>::Mask) {
    let high = absolute.simd_gt(0.5);
    let square = high.select(-absolute * 0.5 + 0.5, absolute * absolute);
    let x = high.select(square.sqrt(), absolute);
    ([x, x * square * arc_sine_term::<I>(square)], high)
}

/// The arc sine.
#[inline(always)]
pub(super) fn asin<I: Simd>(x: Lanes<I>) -> Lanes<I> {
    let ([t, small], high) = arc_sine::<I>(x.0.abs());
    let twice = t + t;
    let complement = -twice + FRAC_PI_2;
    // What the difference lost by rounding (Dekker, "A Floating-Point Technique for Extending the Available Precision",
    // 1971).
    let lost = (-complement + FRAC_PI_2) - twice;
    let complement = complement + (lost - (small + small - FRAC_PI_2 * QUARTER_REST));
    Lanes(high.select(complement, t + small).copysign(x.0))
}

/// The arc cosine.
#[inline(always)]
pub(super) fn acos<I: Simd>(x: Lanes<I>) -> Lanes<I> {
    let ([t, small], high) = arc_sine::<I>(x.0.abs());
    let token = t.token();
    let zero = I::f32s::splat(token, 0.0);
    let quarter = I::f32s::splat(token, FRAC_PI_2);
    let left = x.0.simd_lt(0.0);
    // With the arc sine s of |x|: π/2 - s, π/2 + s; and with the one of the half angle: 2 s, π - 2 s.
    let base = high.select(left.select(quarter + quarter, zero), quarter);
    let (t, small) = (high.select(t + t, t), high.select(small + small, small));
    let minus = high ^ !left;
    let (t, small) = (minus.select(-t, t), minus.select(-small, small));
    Lanes((base + t) + (base * QUARTER_REST + small))
}
