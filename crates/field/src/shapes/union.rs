//! Union: the minimum. Exact outside; inside only a bound, since the nearest surface may lie inside another operand.

use crate::shape_prelude::*;

/// See [`union`].
#[derive(Clone, Copy, Debug)]
pub struct Union;

/// The descriptor of [`union`], also reached by `a | b` and `a + b`.
pub static UNION: Shape = Shape::combine::<Union>();

/// Everything that lies in any of the shapes.
#[track_caller]
pub fn union<F: Into<Field>>(shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&UNION, [], shapes.into_iter().map(Into::into))
}

impl Combine for Union {
    const ABOUT: About = About {
        name: "union",
        summary: "Everything that lies in any of the shapes. Each part keeps its material.",
        params: &[],
        elsewhere: &["or", "add", "min", "group"],
        example: r#"{ "union": [ { "sphere": { "radius": 0.7 } }, { "box": { "size": [2, 0.6, 0.6] } } ] }"#,
    };

    const IS_MINIMUM: bool = true;
    const HULL: Hull = Hull::Both;

    fn contract(_args: &[f64], a: Contract, b: Contract) -> Result<Contract, String> {
        let both = a.worse_of(b);
        Ok(Contract { inside: both.inside.max(Metric::Bound), ..both })
    }

    fn settle(a: Interval, b: Interval, _constants: &[f64]) -> Settled {
        Settled::lesser(a, b, 0.0)
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, _c: &Constants<'_, S>) -> S {
        a.min(b)
    }

    #[inline(always)]
    fn share<S: Scalar>(a: S, b: S, _c: &Constants<'_, S>) -> S {
        S::select(b.lt(a), a.lift(1.0), a.lift(0.0))
    }
}
