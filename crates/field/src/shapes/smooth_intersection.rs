//! Intersection with a polynomial blend. A bound.

use super::blend::{K, MIX};
use super::difference::{KEEP_MATERIAL, common};
use super::intersection::greater;
use super::polynomial;
use crate::shape_prelude::*;

/// See [`smooth_intersection`].
#[derive(Clone, Copy, Debug)]
pub struct SmoothIntersection;

/// The descriptor of [`smooth_intersection`].
pub static SMOOTH_INTERSECTION: Shape = Shape::combine::<SmoothIntersection>();

/// What all the shapes have in common, with its edges worn smoothly. `k` is the visible size of the blend.
#[track_caller]
pub fn smooth_intersection<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&SMOOTH_INTERSECTION, [k.into()], shapes.into_iter().map(Into::into))
}

impl Combine for SmoothIntersection {
    const ABOUT: About = About {
        name: "smooth_intersection",
        summary: "An intersection with smoothly worn edges; materials mix across them.",
        params: &[K, polynomial::ORDER, MIX, KEEP_MATERIAL],
        elsewhere: &["smax", "opSmoothIntersection"],
        example: r#"{ "smooth_intersection": { "k": 0.3, "shapes":
            [ { "sphere": { "radius": 0.9 } }, { "box": { "size": 1.4 } } ] } }"#,
    };

    const HULL: Hull = Hull::Common;

    fn prepare(args: &[f64]) -> Vec<f64> {
        with_keep(args)
    }

    fn contract(_args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        if !(a.signed && b.signed) {
            return Err(
                "a sheet has no inside to blend with; give it a thickness first, for instance with `offset`".into()
            );
        }
        Ok(common(a, b).at_most_bound())
    }

    fn settle(a: Interval, b: Interval, constants: &[f64]) -> Settled {
        greater(a, b, constants[polynomial::REACH], constants[KEEP])
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        -polynomial::smooth_min(-a, -b, c)
    }

    #[inline(always)]
    fn share<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        polynomial::share(-a, -b, c) * (-c.at(KEEP) + 1.0)
    }
}

/// The index of the constant that says whether the first material is kept.
pub(crate) const KEEP: usize = polynomial::WIDTH;

/// The blend's constants, followed by whether the first material is kept.
pub(crate) fn with_keep(args: &[f64]) -> Vec<f64> {
    let mut constants = polynomial::prepare(args);
    constants.push(args[3]);
    constants
}
