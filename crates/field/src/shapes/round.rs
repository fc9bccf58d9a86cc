//! Blends by circular arcs. Bounds.
//!
//! With h = max(k - |a - b|, 0) / k the smooth minimum is min(a, b) - k/2 (1 + h - sqrt(1 + 2h - h^2)) (Quilez, "smooth minimum",
//! circular). It vanishes where (k - a)^2 + (k - b)^2 = k^2: the arc of radius k that hg_sdf's round blend has (Mercury, 2015),
//! which is steeper than its operands by up to sqrt 2. This form never is.

use super::blend::{self, Family, inverse, nearness};
use crate::shape_prelude::*;

/// The family of these blends.
#[derive(Clone, Copy, Debug)]
struct Round;

/// The descriptor of [`round_union`].
pub static ROUND_UNION: Shape = blend::union::<Round>();

/// The descriptor of [`round_intersection`].
pub static ROUND_INTERSECTION: Shape = blend::intersection::<Round>(About {
    name: "round_intersection",
    summary: "An intersection with a fillet of radius `k` along its edges; materials mix across them.",
    params: &[blend::K, blend::MIX, blend::KEEP],
    elsewhere: &["fOpIntersectionRound"],
    example: r#"{ "round_intersection": { "k": 0.3, "shapes":
        [ { "sphere": { "radius": 0.9 } }, { "box": { "size": 1.4 } } ] } }"#,
});

/// The descriptor of [`round_difference`].
pub static ROUND_DIFFERENCE: Shape = blend::difference::<Round>(About {
    name: "round_difference",
    summary: "A difference with a fillet of radius `k` along the cut's edges; materials mix across them.",
    params: &[blend::K, blend::MIX, blend::KEEP],
    elsewhere: &["fOpDifferenceRound"],
    example: r#"{ "round_difference": { "k": 0.2, "shapes":
        [ { "box": { "size": 1.4 } }, { "sphere": { "radius": 0.9 } } ] } }"#,
});

/// Everything that lies in any of the shapes, with a fillet of radius `k` in the seams; `k` is the visible size.
/// Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn round_union<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&ROUND_UNION, [k.into()], shapes.into_iter().map(Into::into))
}

/// What all the shapes have in common, with a fillet of radius `k` along its edges; `k` is the visible size.
/// Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn round_intersection<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&ROUND_INTERSECTION, [k.into()], shapes.into_iter().map(Into::into))
}

/// The first shape without all the others, with a fillet of radius `k` along the cut's edges; `k` is the visible size.
#[track_caller]
pub fn round_difference<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&ROUND_DIFFERENCE, [k.into()], shapes.into_iter().map(Into::into))
}

/// sqrt(1 + 2h - h^2); h is in [0, 1].
#[inline(always)]
fn arc<S: Scalar>(h: S) -> S {
    (h * (-h + 2.0) + 1.0).sqrt()
}

impl Family for Round {
    const UNION: About = About {
        name: "round_union",
        summary: "A union with a fillet of radius `k` in its seams; materials mix across them.",
        params: &[blend::K, blend::MIX],
        elsewhere: &["fOpUnionRound", "smin_circular", "sminCircular"],
        example: r#"{ "round_union": { "k": 0.4, "shapes":
            [ { "sphere": { "radius": 0.7 } }, { "box": { "size": [2, 0.6, 0.6] } } ] } }"#,
    };

    const OWN: usize = 0;
    const WIDTH: usize = 2;

    fn constants(k: f64, _own: f64) -> Vec<f64> {
        vec![k, inverse(k)]
    }

    #[inline(always)]
    fn depth<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        let [k, inverse] = [c.at(at), c.at(at + 1)];
        let h = nearness(gap, k, inverse);
        k * (h + 1.0 - arc(h)) * 0.5
    }

    #[inline(always)]
    fn farther<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        let [k, inverse] = [c.at(at), c.at(at + 1)];
        let h = nearness(gap, k, inverse);
        -((-h + 1.0) / arc(h)) * 0.5 + 0.5
    }
}
