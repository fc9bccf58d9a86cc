//! Complement: everything outside a shape. Exchanges inside and outside.

use crate::shape_prelude::*;

/// See [`Inside::complement`].
#[derive(Clone, Copy, Debug)]
pub struct Complement;

/// The descriptor of [`Inside::complement`], also reached by `-a` and `!a`.
pub static COMPLEMENT: Shape = Shape::modify::<Complement>();

/// Exchanging inside and outside.
pub trait Inside: Into<Field> {
    /// Everything outside the shape.
    #[track_caller]
    fn complement(self) -> Field {
        Field::new(&COMPLEMENT, [], [self.into()])
    }
}

impl<F: Into<Field>> Inside for F {}

impl Modify for Complement {
    const ABOUT: About = About {
        name: "complement",
        summary: "Everything outside a shape.",
        params: &[],
        elsewhere: &["negate", "inverse", "not"],
        example: r#"{ "intersection": [ { "box": { "size": 1.4 } }, { "complement": { "shape": { "sphere": { "radius": 0.9 } } } } ] }"#,
    };

    fn contract(_args: &[f64], child: Contract) -> Result<Contract, String> {
        if child.signed {
            Ok(child.complement())
        } else {
            Err("a sheet has no inside; give it a thickness first, for instance with `offset`".into())
        }
    }

    fn level(_args: &[f64], _level: f64) -> Option<f64> {
        None
    }

    #[inline(always)]
    fn modify<S: Scalar>(value: S, _c: &Constants<'_, S>) -> S {
        -value
    }
}
