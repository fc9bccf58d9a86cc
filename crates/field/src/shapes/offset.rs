//! Offset: all points within a distance of a shape, f - r. Needs a distance; a bound changes its shape.

use crate::shape_prelude::*;

/// See [`Offset::offset`].
#[derive(Clone, Copy, Debug)]
pub struct Offsetting;

/// The descriptor of [`Offset::offset`].
pub static OFFSET: Shape = Shape::modify::<Offsetting>();

/// Growing or shrinking a shape.
pub trait Offset: Into<Field> {
    /// The shape grown by a distance on all sides, with rounded edges, or shrunk by a negative one.
    #[track_caller]
    fn offset(self, by: impl Into<Value>) -> Field {
        Field::new(&OFFSET, [by.into()], [self.into()])
    }
}

impl<F: Into<Field>> Offset for F {}

impl Modify for Offsetting {
    const ABOUT: About = About {
        name: "offset",
        summary: "Grows a shape by a distance on all sides, with rounded edges, or shrinks it.",
        params: &[Param::required("by", ParamKind::Number, "How far; negative to shrink.")],
        elsewhere: &["round", "dilate", "erode", "expand"],
        example: r#"{ "offset": { "by": 0.2, "shape": { "box": { "size": 1 } } } }"#,
    };

    fn contract(args: &[f64], child: Contract) -> Result<Contract, String> {
        let by = args[0];
        if !child.signed && by < 0.0 {
            return Err("a sheet has no inside to shrink".into());
        }
        // Growing keeps outer distances, shrinking inner ones; on the other side a nearer surface may appear.
        Ok(Contract {
            outside: if by > 0.0 { child.outside } else { child.outside.max(Metric::Bound) },
            inside: if by < 0.0 { child.inside } else { child.inside.max(Metric::Bound) },
            signed: child.signed || by > 0.0,
            ..child
        })
    }

    fn warning(args: &[f64], child: Contract) -> Option<String> {
        let side = if args[0] > 0.0 { child.outside } else { child.inside };
        (args[0] != 0.0 && side != Metric::Exact)
            .then(|| "the field under this offset is only a bound, so that its edges move by another distance".into())
    }

    fn level(args: &[f64], level: f64) -> Option<f64> {
        Some(level + args[0])
    }

    #[inline(always)]
    fn modify<S: Scalar>(value: S, c: &Constants<'_, S>) -> S {
        let [by] = c.get();
        value - by
    }
}
