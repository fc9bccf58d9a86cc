//! Mixture of two fields. A bound.

use super::blend::solids;
use crate::shape_prelude::*;

/// See [`morph`].
#[derive(Clone, Copy, Debug)]
pub struct Morph;

/// The descriptor of [`morph`].
pub static MORPH: Shape = Shape::combine::<Morph>();

/// What lies between two shapes: the first one for a share of 0, the second one for 1.
#[track_caller]
pub fn morph<F: Into<Field>>(share: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&MORPH, [share.into()], shapes.into_iter().map(Into::into))
}

impl Combine for Morph {
    const ABOUT: About = About {
        name: "morph",
        summary: "A mixture of two shapes: their distances, mixed.",
        params: &[Param::required("share", ParamKind::Number, "How much there is of the second shape, from 0 to 1.")],
        elsewhere: &["mix", "blend", "lerp", "transition"],
        example: r#"{ "morph": { "share": 0.5, "shapes": [ { "box": { "size": 1.4 } }, { "sphere": { "radius": 1 } } ] } }"#,
    };

    const HULL: Hull = Hull::Both;

    fn prepare(args: &[f64]) -> Vec<f64> {
        vec![1.0 - args[0], args[0]]
    }

    fn contract(args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        solids(a, b)?;
        if !(0.0..=1.0).contains(&args[0]) {
            return Err(format!("`share` of `morph` must be from 0 to 1, but is {}", args[0]));
        }
        Ok(match args[0] {
            0.0 => a,
            1.0 => b,
            _ => a.worse_of(b).at_most_bound(),
        })
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        value(a, b, c).agreed(value(a.core(), b.core(), c).around_core(a, b))
    }

    #[inline(always)]
    fn share<S: Scalar>(_a: S, _b: S, c: &Constants<'_, S>) -> S {
        c.at(1)
    }
}

#[inline(always)]
fn value<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
    let [of_first, of_second] = c.get();
    a * of_first + b * of_second
}
