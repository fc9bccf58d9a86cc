//! Difference with a polynomial blend. A bound.

use super::blend::{K, MIX};
use super::difference::{KEEP_MATERIAL, common, cut, subtrahend};
use super::polynomial;
use super::smooth_intersection::{KEEP, with_keep};
use crate::shape_prelude::*;

/// See [`smooth_difference`].
#[derive(Clone, Copy, Debug)]
pub struct SmoothDifference;

/// The descriptor of [`smooth_difference`].
pub static SMOOTH_DIFFERENCE: Shape = Shape::combine::<SmoothDifference>();

/// The first shape without all the others, with the cut's edges worn smoothly. `k` is the visible size of the blend.
#[track_caller]
pub fn smooth_difference<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&SMOOTH_DIFFERENCE, [k.into()], shapes.into_iter().map(Into::into))
}

impl Combine for SmoothDifference {
    const ABOUT: About = About {
        name: "smooth_difference",
        summary: "A difference with smoothly worn edges; materials mix across them.",
        params: &[K, polynomial::ORDER, MIX, KEEP_MATERIAL],
        elsewhere: &["opSmoothSubtraction"],
        example: r#"{ "smooth_difference": { "k": 0.2, "shapes":
            [ { "box": { "size": 1.4 } }, { "sphere": { "radius": 0.9 } } ] } }"#,
    };

    const HULL: Hull = Hull::First;

    fn prepare(args: &[f64]) -> Vec<f64> {
        with_keep(args)
    }

    fn contract(_args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        if !a.signed {
            return Err(
                "a sheet has no inside to blend with; give it a thickness first, for instance with `offset`".into()
            );
        }
        Ok(common(a, subtrahend(b)?).at_most_bound())
    }

    fn settle(a: Interval, b: Interval, constants: &[f64]) -> Settled {
        cut(a, b, constants[polynomial::REACH], constants[KEEP])
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        -polynomial::smooth_min(-a, b, c)
    }

    #[inline(always)]
    fn share<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        polynomial::share(-a, b, c) * (-c.at(KEEP) + 1.0)
    }
}
