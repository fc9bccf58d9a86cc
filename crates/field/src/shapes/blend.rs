//! What the families of blends share.
//!
//! A family is a smooth minimum, min(a, b) - g(|a - b|), with a falling g whose slope is between -1 and 0; the share of the
//! larger operand is -g'. Shares are between 0 and 1 and make 1, so no blend here is steeper than its operands. Intersection and
//! difference follow by signs, which are constants: all three run the same kernels.

use super::difference::{KEEP_MATERIAL, common, cut, subtrahend};
use super::intersection::greater;
use crate::expr::Expr;
use crate::kernel::CombineKernels;
use crate::shape::{CombineTable, Kind};
use crate::shape_prelude::*;
use std::marker::PhantomData;

/// How far the blend reaches.
pub(crate) const K: Param = Param::required(
    "k",
    ParamKind::Length,
    "Visible size: how far from a right-angled edge the blend leaves the face; 0 for none.",
);

/// How far materials mix.
pub(crate) const MIX: Param = Param::optional(
    "mix",
    ParamKind::Positive,
    &[1.0],
    "Size of the zone in which materials mix, as a multiple of the blend's own.",
);

/// Whether cut faces keep the first material.
pub(crate) const KEEP: Param = KEEP_MATERIAL;

/// A family of blends. Its arguments are those of the shape: `k`, then at most one of its own, then [`MIX`], and [`KEEP`] for
/// shapes that cut.
pub(crate) trait Family: 'static {
    /// The description of its union.
    const UNION: About;

    /// How many arguments of its own it has.
    const OWN: usize;

    /// How many constants it has.
    const WIDTH: usize;

    /// A fault of its own argument, as a sentence.
    ///
    /// # Errors
    /// The fault.
    fn check(_own: f64) -> Result<(), String> {
        Ok(())
    }

    /// The constants for a blend of size `k`.
    fn constants(k: f64, own: f64) -> Vec<f64>;

    /// The difference of the operands from which on only the smaller one matters, to the last bit.
    fn reach(k: f64, _own: f64) -> f64 {
        k
    }

    /// The most that folding `count` operands takes off their minimum.
    ///
    /// Each step takes off at most g(0), and all together never more than the reach: where the running value is d below the
    /// smallest operand, the next step takes off at most g(d), which is at most k - d because of g's slope.
    fn total_depth(k: f64, own: f64, count: usize) -> f64 {
        let table = Self::constants(k, own);
        let depth = Self::depth(0.0_f64, &Constants::new(0.0, &table, table.len()), 0);
        (depth * count.saturating_sub(1) as f64).min(k)
    }

    /// g(`gap`); the constants begin at index `at`. Write `#[inline(always)]` before it.
    fn depth<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S;

    /// The smooth minimum. Write `#[inline(always)]` before it.
    #[inline(always)]
    fn minimum<S: Scalar>(a: S, b: S, c: &Constants<'_, S>, at: usize) -> S {
        a.min(b) - Self::depth((a - b).abs(), c, at)
    }

    /// -g'(`gap`). Write `#[inline(always)]` before it.
    fn farther<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S;
}

/// A blend of a family; its formula serves union, intersection and difference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blend<F>(PhantomData<F>);

/// Constants: the signs of both operands, the material's factor, the reach; then the family's for values and for shares.
const SIGN_A: usize = 0;
const SIGN_B: usize = 1;
const MIXED: usize = 2;
const REACH: usize = 3;
const VALUES: usize = 4;

const fn mix_at<F: Family>() -> usize {
    1 + F::OWN
}

fn own<F: Family>(args: &[f64]) -> f64 {
    if F::OWN > 0 { args[1] } else { 0.0 }
}

fn constants<F: Family>(args: &[f64], signs: [f64; 2]) -> Vec<f64> {
    let (k, own, mix) = (args[0], own::<F>(args), args[mix_at::<F>()]);
    let keep = args.get(mix_at::<F>() + 1).copied().unwrap_or(0.0);
    let reach = F::reach(k, own).max(F::reach(k * mix, own));
    let mut all = vec![signs[0], signs[1], 1.0 - keep, reach];
    all.extend(F::constants(k, own));
    all.extend(F::constants(k * mix, own));
    all
}

/// What an operator needs that reads distances on both sides of both surfaces.
///
/// # Errors
/// If one of them has no inside.
pub(crate) fn solids(a: Contract, b: Contract) -> Result<(), String> {
    if a.signed && b.signed {
        Ok(())
    } else {
        Err("a sheet has no inside to combine; give it a thickness first, for instance with `offset`".into())
    }
}

/// What all operands but a cutter must have.
fn check<F: Family>(args: &[f64], is_solid: bool) -> Result<(), String> {
    if !is_solid {
        return Err("a sheet has no inside to blend with; give it a thickness first, for instance with `offset`".into());
    }
    F::check(own::<F>(args))
}

impl<F: Family> Combine for Blend<F> {
    const ABOUT: About = F::UNION;
    const HULL: Hull = Hull::Both;

    fn prepare(args: &[f64]) -> Vec<f64> {
        constants::<F>(args, [1.0, 1.0])
    }

    fn contract(args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        check::<F>(args, a.signed && b.signed)?;
        Ok(a.worse_of(b).at_most_bound())
    }

    fn level(args: &[f64], level: f64, count: usize) -> f64 {
        level + F::total_depth(args[0], own::<F>(args), count)
    }

    fn settle(a: Interval, b: Interval, constants: &[f64]) -> Settled {
        Settled::lesser(a, b, constants[REACH])
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        let (sign_a, sign_b) = (c.at(SIGN_A), c.at(SIGN_B));
        let (a, b) = (a * sign_a, b * sign_b);
        // Shares make 1, so that a blend moves no more than its operands: in enclosures, each of which is in the formula several
        // times, that is narrower where both are near.
        let whole = F::minimum(a, b, c, VALUES);
        let around = F::minimum(a.core(), b.core(), c, VALUES).around_core(a, b);
        whole.agreed(around) * sign_a
    }

    #[inline(always)]
    fn share<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        let (a, b) = (a * c.at(SIGN_A), b * c.at(SIGN_B));
        let farther = F::farther((a - b).abs(), c, VALUES + F::WIDTH);
        S::select(b.lt(a), -farther + 1.0, farther) * c.at(MIXED)
    }
}

/// The descriptor of a family's union.
pub(crate) const fn union<F: Family>() -> Shape {
    Shape::combine::<Blend<F>>()
}

/// The descriptor of a family's intersection.
pub(crate) const fn intersection<F: Family>(about: About) -> Shape {
    fn prepare<F: Family>(args: &[f64]) -> Vec<f64> {
        constants::<F>(args, [-1.0, -1.0])
    }
    fn contract<F: Family>(args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        check::<F>(args, a.signed && b.signed)?;
        Ok(common(a, b).at_most_bound())
    }
    fn settle(a: Interval, b: Interval, constants: &[f64]) -> Settled {
        greater(a, b, constants[REACH], 1.0 - constants[MIXED])
    }
    derived::<F>(about, prepare::<F>, contract::<F>, settle, Hull::Common)
}

/// The descriptor of a family's difference.
pub(crate) const fn difference<F: Family>(about: About) -> Shape {
    fn prepare<F: Family>(args: &[f64]) -> Vec<f64> {
        constants::<F>(args, [-1.0, 1.0])
    }
    fn contract<F: Family>(args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        check::<F>(args, a.signed)?;
        Ok(common(a, subtrahend(b)?).at_most_bound())
    }
    fn settle(a: Interval, b: Interval, constants: &[f64]) -> Settled {
        cut(a, b, constants[REACH], 1.0 - constants[MIXED])
    }
    derived::<F>(about, prepare::<F>, contract::<F>, settle, Hull::First)
}

/// A descriptor with the kernels of the union. The blend only takes away from what operands have in common, hence the level.
const fn derived<F: Family>(
    about: About,
    prepare: fn(&[f64]) -> Vec<f64>,
    contract: fn(&[f64], Contract, Contract) -> Result<Contract, String>,
    settle: fn(Interval, Interval, &[f64]) -> Settled,
    hull: Hull,
) -> Shape {
    fn level(_args: &[f64], level: f64, _count: usize) -> f64 {
        level
    }
    fn share<'g, F: Family>(a: Expr<'g>, b: Expr<'g>, c: &Constants<'_, Expr<'g>>) -> Expr<'g> {
        Blend::<F>::share(a, b, c)
    }
    Shape {
        about,
        kind: Kind::Combine(CombineTable {
            is_minimum: false,
            prepare,
            contract,
            settle,
            hull,
            level,
            kernels: CombineKernels::of::<Blend<F>>(),
            share: share::<F>,
        }),
        file: None,
    }
}

/// How much of the blend's size is left: 1 where the operands are equal, 0 where their gap is `k` or more. `inverse` is 1 / k.
#[inline(always)]
pub(crate) fn nearness<S: Scalar>(gap: S, k: S, inverse: S) -> S {
    // The maximum comes last, so that no enclosure reaches below 0, where powers would be unknown.
    ((k - gap) * inverse).max(gap.lift(0.0))
}

/// 1 / k, or 0 for no blend at all.
pub(crate) fn inverse(k: f64) -> f64 {
    if k > 0.0 { 1.0 / k } else { 0.0 }
}
