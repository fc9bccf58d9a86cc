//! What products of a figure and a range share.
//!
//! The distance from a product of sets follows from those of its factors: outside both, they are the legs of a right triangle;
//! otherwise the larger one counts. The gradients of the two are at right angles, so that the slope is that of the steeper.

use crate::shape_prelude::*;

/// The distance from a product by those from its factors.
#[inline(always)]
pub(super) fn distance<S: Scalar>(figure: S, range: S) -> S {
    let zero = figure.lift(0.0);
    S::select(zero.lt(figure) & zero.lt(range), S::length2(figure, range), figure.max(range))
}

/// What is known about a product: no less than about its figure, whose range is exact.
///
/// # Errors
/// If the figure has no inside.
pub(super) fn contract(figure: Contract) -> Result<Contract, String> {
    if !figure.signed {
        return Err(
            "a line has no inside to make a body of; give it a thickness first, for instance with `offset`".into()
        );
    }
    Ok(Contract { lipschitz: figure.lipschitz.map(|slope| slope.max(1.0)), ..figure })
}

/// Which factor a product comes to. Never the range alone: ends look as the figure does, too.
pub(super) fn settle(figure: Interval, range: Interval) -> Settled {
    if range.hi() < 0.0 && range.hi() < figure.lo() { Settled::First } else { Settled::Open }
}
