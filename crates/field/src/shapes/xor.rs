//! Symmetric difference: max(min(a, b), -max(a, b)). A bound.

use super::difference::subtrahend;
use crate::shape_prelude::*;

/// See [`xor`].
#[derive(Clone, Copy, Debug)]
pub struct Xor;

/// The descriptor of [`xor`].
pub static XOR: Shape = Shape::combine::<Xor>();

/// What lies in an odd number of the shapes.
#[track_caller]
pub fn xor<F: Into<Field>>(shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&XOR, [], shapes.into_iter().map(Into::into))
}

impl Combine for Xor {
    const ABOUT: About = About {
        name: "xor",
        summary: "What lies in one of two shapes but not in both; of several, in an odd number.",
        params: &[],
        elsewhere: &["symmetric_difference"],
        example: r#"{ "xor": [ { "sphere": { "radius": 0.8 } }, { "box": { "size": [2, 0.7, 0.7] } } ] }"#,
    };

    const HULL: Hull = Hull::Both;

    fn contract(_args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        subtrahend(a)?;
        subtrahend(b)?;
        Ok(a.worse_of(b).at_most_bound())
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, _c: &Constants<'_, S>) -> S {
        a.min(b).max(-a.max(b))
    }

    #[inline(always)]
    fn share<S: Scalar>(a: S, b: S, _c: &Constants<'_, S>) -> S {
        let (zero, one) = (a.lift(0.0), a.lift(1.0));
        let from_common = a.min(b).lt(-a.max(b));
        S::select(from_common, S::select(a.lt(b), one, zero), S::select(b.lt(a), one, zero))
    }
}
