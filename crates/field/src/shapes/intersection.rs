//! Intersection: the maximum. Exact inside if the operands are; outside only a bound.

use super::difference::{KEEP_MATERIAL, common};
use crate::shape_prelude::*;

/// See [`intersection`].
#[derive(Clone, Copy, Debug)]
pub struct Intersection;

/// The descriptor of [`intersection`], also reached by `a & b`.
pub static INTERSECTION: Shape = Shape::combine::<Intersection>();

/// What all the shapes have in common.
#[track_caller]
pub fn intersection<F: Into<Field>>(shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&INTERSECTION, [], shapes.into_iter().map(Into::into))
}

/// Which of two operands is always greater than the other by more than `reach`. With `keep` the material of the first one
/// stays even there where the second is greater, so that the first is still needed.
pub(crate) fn greater(a: Interval, b: Interval, reach: f64, keep: f64) -> Settled {
    match Settled::lesser(-a, -b, reach) {
        Settled::Second if keep > 0.0 => Settled::Open,
        settled => settled,
    }
}

impl Combine for Intersection {
    const ABOUT: About = About {
        name: "intersection",
        summary: "What all the shapes have in common.",
        params: &[KEEP_MATERIAL],
        elsewhere: &["and", "intersect", "max"],
        example: r#"{ "intersection": [ { "box": { "size": 1.4 } }, { "sphere": { "radius": 0.9 } } ] }"#,
    };

    const HULL: Hull = Hull::Common;

    fn contract(_args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        Ok(common(a, b))
    }

    fn settle(a: Interval, b: Interval, constants: &[f64]) -> Settled {
        greater(a, b, 0.0, constants[0])
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, _c: &Constants<'_, S>) -> S {
        a.max(b)
    }

    #[inline(always)]
    fn share<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        let [keep] = c.get();
        S::select(a.lt(b), -keep + 1.0, a.lift(0.0))
    }
}
