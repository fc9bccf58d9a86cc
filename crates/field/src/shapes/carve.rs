//! What the operators share that work along the curve in which the surfaces of two shapes meet. All of them yield bounds.

use super::blend::solids;
use crate::shape_prelude::*;
use std::marker::PhantomData;

/// An operator along the curve in which the surface of a shape meets that of the next one.
pub(crate) trait Carve: 'static {
    /// Description and parameters.
    const ABOUT: About;

    /// See [`Combine::HULL`]: the first shape's, unless otherwise said.
    const HULL: Hull = Hull::First;

    /// The constants of the formula.
    fn prepare(args: &[f64]) -> Vec<f64> {
        args.to_vec()
    }

    /// See [`Combine::level`].
    fn level(_args: &[f64], level: f64, _count: usize) -> f64 {
        level
    }

    /// The formula. It must not change by more than the larger change of both values, as enclosures rely on. Write
    /// `#[inline(always)]` before it.
    fn value<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S;

    /// See [`Combine::share`]: all of it is the first shape's, unless otherwise said. Write `#[inline(always)]` before it.
    #[inline(always)]
    fn share<S: Scalar>(a: S, _b: S, _c: &Constants<'_, S>) -> S {
        a.lift(0.0)
    }
}

/// The combination that such an operator makes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carved<C>(PhantomData<C>);

impl<C: Carve> Combine for Carved<C> {
    const ABOUT: About = C::ABOUT;

    const HULL: Hull = C::HULL;

    fn prepare(args: &[f64]) -> Vec<f64> {
        C::prepare(args)
    }

    fn contract(_args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        solids(a, b)?;
        Ok(a.worse_of(b).at_most_bound())
    }

    fn level(args: &[f64], level: f64, count: usize) -> f64 {
        C::level(args, level, count)
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        C::value(a, b, c).agreed(C::value(a.core(), b.core(), c).around_core(a, b))
    }

    #[inline(always)]
    fn share<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        C::share(a, b, c)
    }
}
