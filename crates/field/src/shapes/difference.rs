//! Difference: max(a, -b), from left to right. Outside only a bound.

use super::intersection::greater;
use crate::shape_prelude::*;

/// See [`difference`].
#[derive(Clone, Copy, Debug)]
pub struct Difference;

/// The descriptor of [`difference`], also reached by `a - b`.
pub static DIFFERENCE: Shape = Shape::combine::<Difference>();

/// The first shape without all the others.
#[track_caller]
pub fn difference<F: Into<Field>>(shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&DIFFERENCE, [], shapes.into_iter().map(Into::into))
}

/// What a cut face looks like: a parameter of all cutting operators.
pub(crate) const KEEP_MATERIAL: Param = Param::optional(
    "keep_material",
    ParamKind::Flag,
    &[0.0],
    "Whether cut faces keep the first shape's material instead of taking the cutter's.",
);

/// The contract of a field that is subtracted.
///
/// # Errors
/// If it has no inside.
pub(crate) fn subtrahend(b: Contract) -> Result<Contract, String> {
    if b.signed {
        Ok(b.complement())
    } else {
        Err("a sheet has no inside to subtract; give it a thickness first, for instance with `offset`".into())
    }
}

/// The contract of an intersection.
pub(crate) fn common(a: Contract, b: Contract) -> Contract {
    let both = a.worse_of(b);
    Contract { outside: both.outside.max(Metric::Bound), ..both }
}

/// As [`greater`], of the first operand and the second with its sign turned.
pub(crate) fn cut(a: Interval, b: Interval, reach: f64, keep: f64) -> Settled {
    match greater(a, -b, reach, keep) {
        Settled::Second => Settled::NotSecond,
        settled => settled,
    }
}

impl Combine for Difference {
    const ABOUT: About = About {
        name: "difference",
        summary: "The first shape without all the others.",
        params: &[KEEP_MATERIAL],
        elsewhere: &["subtract", "cut"],
        example: r#"{ "difference": [ { "box": { "size": 1.4 } }, { "sphere": { "radius": 0.9 } } ] }"#,
    };

    const HULL: Hull = Hull::First;

    fn contract(_args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        Ok(common(a, subtrahend(b)?))
    }

    fn settle(a: Interval, b: Interval, constants: &[f64]) -> Settled {
        cut(a, b, 0.0, constants[0])
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, _c: &Constants<'_, S>) -> S {
        a.max(-b)
    }

    #[inline(always)]
    fn share<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        let [keep] = c.get();
        S::select(a.lt(-b), -keep + 1.0, a.lift(0.0))
    }
}
