//! The bound that fractals of escaping orbits share: proven, and with a slope of at most 1.
//!
//! An orbit z_0, z_1, ... starts at a point and follows z_(n+1) = z_n^k + c. The shape is the set of points with
//! |z_N| <= B, for N iterations and the bailout B. Two things are needed of it. Thresholds T_n: whoever has |z_n| > T_n has
//! |z_N| > B; with |c| <= C they are T_N = B and T_n = (T_(n+1) + C)^(1/k). They fall quickly to the least bailout; here the last few before N
//! are replaced by T_(N-1), and all before those by one T as well. And a majorant D_n of the stretch |dz_n/dp| that does not change too fast itself:
//!
//! - D_0 = 1, D_(n+1) = D_n L_n, where L_n is at least the stretch of z^k at z_n, and |grad ln L_n| <= 2 λ |dz_n/dp|;
//! - E_0 = 0, E_(n+1) = E_n + λ D_n.
//!
//! By induction |grad D_n| <= 2 E_n D_n, and |grad E_n| <= sum 2 E_i λ D_i <= E_n^2. A sum D_n L_n + 1, where c is the point
//! itself, keeps both. Now let g be a threshold and φ = 2 g (|z_n|^2 - g^2) / (|z_n|^2 + 3 g^2). This has the sign of
//! |z_n| - g and, by |z_n|, a slope between 0 and 1, which it reaches at g. The field of step n is v_n = φ / (D_n + E_n |φ|), and
//!
//! |grad 1/v_n| = |grad (D_n / |φ| + E_n)| <= 2 E_n D_n / |φ| + D_n^2 / φ^2 + E_n^2 = (D_n / |φ| + E_n)^2 = 1 / v_n^2,
//!
//! so that |grad v_n| <= 1. Since v_n is not above 0 anywhere in the shape, it is nowhere above the distance to it. The field
//! is the largest of the positive v_n before the last step, of v_N, which alone has the sign of |z_N| - B, and of |p| - T_0:
//! again with a slope of at most 1, hence a bound on both sides.
//!
//! Once |z_n| is above a radius S, no later step gives a larger value, and the loop ends: 1/v_n falls short of
//! 1/v_(n+1) >= D_n k |z_n|^(k-1) / (2 B) + E_n + λ D_n from where (a^2 + 3 T^2) / (2 T (a^2 - T^2)) <= k a^(k-1) / (2 B) + λ for either T.
//!
//! The classical estimate |z_n| ln |z_n| / |dz_n/dp| (Hart, Sandin, Kauffman, "Ray Tracing Deterministic 3-D Fractals", 1989)
//! is about three times as large and promises nothing.

use crate::shape_prelude::*;

/// The largest number of iterations: far beyond what single precision tells apart.
pub(crate) const MAX_ITERATIONS: u32 = 64;

/// The largest power.
pub(crate) const MAX_POWER: u32 = 16;

/// How often the orbit is continued.
pub(crate) const fn iterations(default: &'static [f64]) -> Param {
    Param::optional(
        "iterations",
        ParamKind::Count(1, MAX_ITERATIONS),
        default,
        "How many steps an orbit must stay within the bailout radius to belong to the set.",
    )
}

/// The radius that orbits must not leave.
pub(crate) const BAILOUT: Param = Param::optional(
    "bailout",
    ParamKind::Length,
    &[0.0],
    "The bailout radius. The least one, from which every orbit escapes, stands for all below it.",
);

/// The power of the iterated map.
pub(crate) const fn power(default: &'static [f64]) -> Param {
    Param::optional("power", ParamKind::Count(2, MAX_POWER), default, "The power that each step raises to.")
}

/// Stands for 1/v of steps that give no value.
const NEVER: f64 = 1e30;

/// A stretch beyond this would only overflow; distances are below anything's resolution there.
const STEEPEST: f64 = 1e15;

/// What `L` is made of for powers above 2: its floor is that of z^k at this radius. Lower floors would make λ larger, higher
/// ones D; in the tests' scenes the bound is largest about here.
pub(crate) const FLOOR: f64 = 0.65;

/// How many steps before the last one have a threshold of their own. A step brings a threshold nearer to the least one by the
/// power or more.
const LATE: u32 = 3;

/// Halvings that exhaust double precision.
const HALVINGS: u32 = 100;

/// The radii of an orbit's bound, in double precision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Radii {
    /// T_0: the shape lies in the ball of this radius.
    pub(crate) extent: f64,
    /// T of the last steps, and of all before those.
    inner: [f64; 2],
    /// How many steps come before the last ones; below 0 if none do.
    early: f64,
    /// B.
    outer: f64,
    /// S.
    stop: f64,
    /// λ.
    pub(crate) lambda: f64,
}

impl Radii {
    /// For orbits of z^k + c with |c| at most `reach`. `extent` is the radius of a ball that holds the shape, if one is known.
    pub(crate) fn new(
        power: f64,
        reach: f64,
        [iterations, bailout]: [f64; 2],
        extent: Option<f64>,
        lambda: f64,
    ) -> Self {
        let outer = bailout.max(escape_radius(power, reach));
        let before = |radius: f64| (radius + reach).powf(1.0 / power);
        let late = before(outer);
        let inner = [late, (0..LATE).fold(late, |radius, _| before(radius))];
        let first = (0..iterations as u32).fold(outer, |radius, _| before(radius));
        // With larger radii the first side falls and the second one rises.
        let suffices = |inner: f64, a: f64| {
            let (square, least) = (a * a, inner * inner);
            (square + 3.0 * least) / (2.0 * inner * (square - least))
                <= power * a.powf(power - 1.0) / (2.0 * outer) + lambda
        };
        let [late, early] = inner.map(|inner| least_with(inner, |a| suffices(inner, a)));
        let (stop, steps) = (late.max(early), iterations - f64::from(LATE));
        Self { extent: extent.unwrap_or(first), inner, early: steps, outer, stop, lambda }
    }

    /// What [`Escape::read`] reads.
    pub(crate) fn constants(&self) -> [f64; Escape::<f64>::COUNT] {
        let Self { extent, inner: [late, early], early: steps, outer, stop, lambda } = *self;
        [
            extent,
            late * late,
            2.0 * late / lambda,
            1.0 / (2.0 * late * lambda),
            early * early,
            2.0 * early / lambda,
            1.0 / (2.0 * early * lambda),
            steps,
            stop * stop,
            outer * outer,
            2.0 * outer,
            3.0 * outer * outer,
            lambda,
            1.0 / lambda,
            STEEPEST * lambda,
        ]
    }
}

/// The least radius beyond which r^k - |c| > r.
fn escape_radius(power: f64, c: f64) -> f64 {
    least_with(0.5, |r| r.powf(power - 1.0) > 1.0 && r.powf(power) - c > r)
}

/// The least number above `low` with a property that all larger ones have; rounded up.
pub(crate) fn least_with(low: f64, has: impl Fn(f64) -> bool) -> f64 {
    let mut high = low + 1.0;
    while !has(high) {
        high = low + 2.0 * (high - low);
    }
    let mut low = low;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if has(middle) { high = middle } else { low = middle }
    }
    high
}

/// A threshold g: its square, and 2 g / λ and 1 / (2 g λ).
#[derive(Clone, Copy)]
struct Threshold<S> {
    square: S,
    gap: S,
    rest: S,
}

impl<S: Scalar> Threshold<S> {
    #[inline(always)]
    fn read(c: &Constants<'_, S>, first: usize) -> Self {
        Self { square: c.at(first), gap: c.at(first + 1), rest: c.at(first + 2) }
    }
}

/// The same as constants of a formula, and what is done with them. Everywhere λ D stands for D.
#[derive(Clone, Copy)]
pub(crate) struct Escape<S> {
    extent: S,
    late: Threshold<S>,
    early: Threshold<S>,
    early_steps: S,
    stop_square: S,
    outer_square: S,
    outer_gap: S,
    outer_rest: S,
    /// λ D_0, and what a step adds where c is the point itself.
    pub(crate) lambda: S,
    inverse_lambda: S,
    steepest: S,
}

impl<S: Scalar> Escape<S> {
    /// How many constants it takes.
    pub(crate) const COUNT: usize = 15;

    /// From the constants that begin at `first`.
    #[inline(always)]
    pub(crate) fn read(c: &Constants<'_, S>, first: usize) -> Self {
        Self {
            extent: c.at(first),
            late: Threshold::read(c, first + 1),
            early: Threshold::read(c, first + 4),
            early_steps: c.at(first + 7),
            stop_square: c.at(first + 8),
            outer_square: c.at(first + 9),
            outer_gap: c.at(first + 10),
            outer_rest: c.at(first + 11),
            lambda: c.at(first + 12),
            inverse_lambda: c.at(first + 13),
            steepest: c.at(first + 14),
        }
    }

    /// 1/v before any step.
    #[inline(always)]
    pub(crate) fn never(&self) -> S {
        self.lambda.lift(NEVER)
    }

    /// The lesser of `inverse` and 1/v_n, for the squared length of z_n.
    #[inline(always)]
    pub(crate) fn sooner(&self, inverse: S, n: S, square: S, stretch: S, sum: S) -> S {
        let is_early = n.lt(self.early_steps);
        let excess = square - S::select(is_early, self.early.square, self.late.square);
        let is_outside = excess.lift(0.0).lt(excess);
        if !S::any(is_outside) {
            return inverse;
        }
        let gap = S::select(is_early, self.early.gap, self.late.gap);
        let rest = S::select(is_early, self.early.rest, self.late.rest);
        let own = stretch * (rest + gap / excess) + sum;
        S::select(is_outside, own, self.never()).min(inverse)
    }

    /// λ D_(n+1).
    #[inline(always)]
    pub(crate) fn stretched(&self, stretch: S, by: S) -> S {
        (stretch * by).min(self.steepest)
    }

    /// Whether later steps may give a larger value than one with this squared length of z_n.
    #[inline(always)]
    pub(crate) fn goes_on(&self, square: S) -> S::Mask {
        square.lt(self.stop_square)
    }

    /// The field, from the least 1/v, the state after the last step, and the length of z_0.
    #[inline(always)]
    pub(crate) fn field(&self, inverse: S, square: S, stretch: S, sum: S, start: S) -> S {
        let last = (square - self.outer_square) * self.outer_gap / (square + self.outer_rest);
        let last = last / (stretch * self.inverse_lambda + sum * last.abs());
        // Far outside the last step may have overflowed; what is not comparable counts for nothing.
        let escaped = last.max(square.lift(1.0) / inverse);
        let field = S::select(inverse.lt(self.never()), escaped, last);
        field.max(start - self.extent)
    }
}

/// The numbers A and B with (x + iy)^k = A + iyB, from x and y^2.
#[inline(always)]
pub(crate) fn complex_power<S: Scalar>(k: u32, x: S, y_square: S) -> [S; 2] {
    let (mut a, mut b) = (x, x.lift(1.0));
    let mut bit = 1 << (u32::BITS - 1 - k.leading_zeros());
    while bit > 1 {
        bit >>= 1;
        let product = a * b;
        (a, b) = (a.square() - b.square() * y_square, product + product);
        if k & bit != 0 {
            (a, b) = (a * x - b * y_square, a + b * x);
        }
    }
    [a, b]
}

/// At least a^(k-1), from the square of a: for even k with (a^2 + 1) / 2 in place of one a.
#[inline(always)]
pub(crate) fn power_below<S: Scalar>(k: u32, square: S) -> S {
    let even = square.powi((k as i32 - 1) / 2);
    if k % 2 == 0 { even * (square * 0.5 + 0.5) } else { even }
}

/// An upper bound of the derivative of ln L by a, L being the larger of [`power_below`] and of its floor.
pub(crate) fn steepest_power(power: f64) -> f64 {
    if power == 2.0 {
        return 1.0;
    }
    // (k-1)/a at the floor, since (a^2 + 1)/2 grows less than a below 1 and has a slope of its own of at most 1.
    let least = FLOOR.powf(power - 1.0);
    let k = power as u32;
    let floor = least_with(0.0, |a| power_below(k, a * a) >= least);
    let own = if k % 2 == 0 { (power - 2.0) / floor + 1.0 } else { (power - 1.0) / floor };
    own.max(power - 1.0)
}
