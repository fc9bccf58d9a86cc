//! Polynomial blends, shared by the smooth operators.
//!
//! With h = max(k - |a - b|, 0) / k the smooth minimum of order n is min(a, b) - k/(2n) h^n, and the share of the larger
//! operand is h^(n-1) / 2 (Quilez, "smooth minimum", 2013; order n after Csébfalvi). The slope never exceeds those of
//! the operands, since the shares are between 0 and 1 and make 1.

use crate::shape_prelude::*;

/// The order of the polynomial.
pub(crate) const ORDER: Param = Param::optional(
    "order",
    ParamKind::Choice(&["2", "3"]),
    &[0.0],
    "Order of the polynomial: 2 is the common one, 3 is smooth in curvature too.",
);

/// The most a blend takes off the minimum.
pub(crate) fn depth(args: &[f64]) -> f64 {
    args[0] / (2.0 * order(args))
}

/// The most that folding `count` operands takes off their minimum.
///
/// Each step takes off at most [`depth`]; and never do all together take off more than k: where the running value is g below
/// the smallest operand, the next step adds at most depth (1 - g/k)^n to g, which stays below k.
pub(crate) fn total_depth(args: &[f64], count: usize) -> f64 {
    (depth(args) * count.saturating_sub(1) as f64).min(args[0])
}

fn order(args: &[f64]) -> f64 {
    2.0 + args[1]
}

/// How many constants [`prepare`] yields.
pub(crate) const WIDTH: usize = 9;

/// The constant that is the difference of the operands from which on only one of them matters.
pub(crate) const REACH: usize = 8;

/// The constants of [`smooth_min`] and [`share`].
pub(crate) fn prepare(args: &[f64]) -> Vec<f64> {
    let &[k, cubic, mix, ..] = args else { unreachable!("three numbers at least") };
    let inverse = |k: f64| if k > 0.0 { 1.0 / k } else { 0.0 };
    let mixed = k * mix;
    let depths = [depth(args) * (1.0 - cubic), depth(args) * cubic];
    let shares = [0.5 * (1.0 - cubic), 0.5 * cubic];
    vec![k, inverse(k), depths[0], depths[1], mixed, inverse(mixed), shares[0], shares[1], k.max(mixed)]
}

/// The smooth minimum. Without a blend (k = 0) it is the plain one.
#[inline(always)]
pub(crate) fn smooth_min<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
    // Shares make 1, so that a blend moves no more than its operands: in enclosures, each of which is in the formula several
    // times, that is narrower where both are near.
    plain_smooth_min(a, b, c).agreed(plain_smooth_min(a.core(), b.core(), c).around_core(a, b))
}

#[inline(always)]
fn plain_smooth_min<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
    let [k, inverse, square, cubic] = c.get();
    let h = (k - (a - b).abs()).max(a.lift(0.0)) * inverse;
    a.min(b) - h.square() * (square + cubic * h)
}

/// The share of `b` in the smooth minimum.
#[inline(always)]
pub(crate) fn share<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
    let [_, _, _, _, k, inverse, linear, square] = c.get();
    let h = (k - (a - b).abs()).max(a.lift(0.0)) * inverse;
    let farther = h * (linear + square * h);
    S::select(b.lt(a), -farther + 1.0, farther)
}
