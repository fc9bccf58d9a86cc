//! Union with a polynomial blend. A bound.

use super::blend::{K, MIX};
use super::polynomial;
use crate::shape_prelude::*;

/// See [`smooth_union`].
#[derive(Clone, Copy, Debug)]
pub struct SmoothUnion;

/// The descriptor of [`smooth_union`].
pub static SMOOTH_UNION: Shape = Shape::combine::<SmoothUnion>();

/// Everything that lies in any of the shapes, with the seams filled smoothly. `k` is the visible size of the blend.
#[track_caller]
pub fn smooth_union<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&SMOOTH_UNION, [k.into()], shapes.into_iter().map(Into::into))
}

impl Combine for SmoothUnion {
    const ABOUT: About = About {
        name: "smooth_union",
        summary: "A union with smoothly filled seams; materials mix across them.",
        params: &[K, polynomial::ORDER, MIX],
        elsewhere: &["smin", "opSmoothUnion", "blend"],
        example: r#"{ "smooth_union": { "k": 0.4, "shapes":
            [ { "sphere": { "radius": 0.7 } }, { "box": { "size": [2, 0.6, 0.6] } } ] } }"#,
    };

    const HULL: Hull = Hull::Both;

    fn prepare(args: &[f64]) -> Vec<f64> {
        polynomial::prepare(args)
    }

    fn contract(_args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        if !(a.signed && b.signed) {
            return Err(
                "a sheet has no inside to blend with; give it a thickness first, for instance with `offset`".into()
            );
        }
        Ok(a.worse_of(b).at_most_bound())
    }

    fn level(args: &[f64], level: f64, count: usize) -> f64 {
        level + polynomial::total_depth(args, count)
    }

    fn settle(a: Interval, b: Interval, constants: &[f64]) -> Settled {
        Settled::lesser(a, b, constants[polynomial::REACH])
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        polynomial::smooth_min(a, b, c)
    }

    #[inline(always)]
    fn share<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        polynomial::share(a, b, c)
    }
}
