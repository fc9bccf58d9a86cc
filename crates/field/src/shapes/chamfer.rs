//! Blends by flat bevels. Bounds.
//!
//! The smooth minimum is min(a, b, (a + b - k)/2): the mean form, which is no steeper than its operands, with the bevel of
//! hg_sdf's chamfer, whose factor sqrt(1/2) makes it steeper by up to sqrt 2 where both operands rise in the same direction.

use super::blend::{self, Family};
use crate::shape_prelude::*;

/// The family of these blends.
#[derive(Clone, Copy, Debug)]
struct Chamfer;

/// The descriptor of [`chamfer_union`].
pub static CHAMFER_UNION: Shape = blend::union::<Chamfer>();

/// The descriptor of [`chamfer_intersection`].
pub static CHAMFER_INTERSECTION: Shape = blend::intersection::<Chamfer>(About {
    name: "chamfer_intersection",
    summary: "An intersection with a bevel along its edges; materials mix across them.",
    params: &[blend::K, blend::MIX, blend::KEEP],
    elsewhere: &["fOpIntersectionChamfer"],
    example: r#"{ "chamfer_intersection": { "k": 0.3, "shapes":
        [ { "sphere": { "radius": 0.9 } }, { "box": { "size": 1.4 } } ] } }"#,
});

/// The descriptor of [`chamfer_difference`].
pub static CHAMFER_DIFFERENCE: Shape = blend::difference::<Chamfer>(About {
    name: "chamfer_difference",
    summary: "A difference with a bevel along the cut's edges; materials mix across them.",
    params: &[blend::K, blend::MIX, blend::KEEP],
    elsewhere: &["fOpDifferenceChamfer"],
    example: r#"{ "chamfer_difference": { "k": 0.2, "shapes":
        [ { "box": { "size": 1.4 } }, { "sphere": { "radius": 0.9 } } ] } }"#,
});

/// Everything that lies in any of the shapes, with a bevel in the seams; `k` is the visible size.
/// Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn chamfer_union<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&CHAMFER_UNION, [k.into()], shapes.into_iter().map(Into::into))
}

/// What all the shapes have in common, with a bevel along its edges; `k` is the visible size.
/// Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn chamfer_intersection<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&CHAMFER_INTERSECTION, [k.into()], shapes.into_iter().map(Into::into))
}

/// The first shape without all the others, with a bevel along the cut's edges; `k` is the visible size.
#[track_caller]
pub fn chamfer_difference<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&CHAMFER_DIFFERENCE, [k.into()], shapes.into_iter().map(Into::into))
}

impl Family for Chamfer {
    const UNION: About = About {
        name: "chamfer_union",
        summary: "A union with a bevel in its seams; materials mix across them.",
        params: &[blend::K, blend::MIX],
        elsewhere: &["fOpUnionChamfer", "smooth_chamfer"],
        example: r#"{ "chamfer_union": { "k": 0.4, "shapes":
            [ { "sphere": { "radius": 0.7 } }, { "box": { "size": [2, 0.6, 0.6] } } ] } }"#,
    };

    const OWN: usize = 0;
    const WIDTH: usize = 1;

    fn constants(k: f64, _own: f64) -> Vec<f64> {
        vec![k]
    }

    #[inline(always)]
    fn depth<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        (c.at(at) - gap).max(gap.lift(0.0)) * 0.5
    }

    // The same in a form that is narrow over intervals: in the bevel each operand occurs once.
    #[inline(always)]
    fn minimum<S: Scalar>(a: S, b: S, c: &Constants<'_, S>, at: usize) -> S {
        let k = c.at(at);
        S::select((a - b).abs().lt(k), (a + b - k) * 0.5, a.min(b))
    }

    #[inline(always)]
    fn farther<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        gap.less(c.at(at)) * 0.5
    }
}
