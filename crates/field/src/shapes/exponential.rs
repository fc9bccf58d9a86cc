//! Blends by exponentials, in which the order of the operands does not matter. Bounds.
//!
//! The smooth minimum is -ln(e^(-ca) + e^(-cb)) / c, computed as min(a, b) - ln(1 + e^(-c |a - b|)) / c, which can't overflow. It
//! is associative: operands may come in any order. It has no end of its own; c is chosen so that nothing is seen of it beyond k.

use super::blend::{self, Family};
use crate::shape_prelude::*;

/// The family of these blends.
#[derive(Clone, Copy, Debug)]
struct Exponential;

/// The descriptor of [`exponential_union`].
pub static EXPONENTIAL_UNION: Shape = blend::union::<Exponential>();

/// The descriptor of [`exponential_intersection`].
pub static EXPONENTIAL_INTERSECTION: Shape = blend::intersection::<Exponential>(About {
    name: "exponential_intersection",
    summary: "An intersection with a soft fillet along its edges; materials mix across them.",
    params: &[blend::K, blend::MIX, blend::KEEP],
    elsewhere: &["smax_exp"],
    example: r#"{ "exponential_intersection": { "k": 0.3, "shapes":
        [ { "sphere": { "radius": 0.9 } }, { "box": { "size": 1.4 } } ] } }"#,
});

/// The descriptor of [`exponential_difference`].
pub static EXPONENTIAL_DIFFERENCE: Shape = blend::difference::<Exponential>(About {
    name: "exponential_difference",
    summary: "A difference with a soft fillet along the cut's edges; materials mix across them.",
    params: &[blend::K, blend::MIX, blend::KEEP],
    elsewhere: &[],
    example: r#"{ "exponential_difference": { "k": 0.2, "shapes":
        [ { "box": { "size": 1.4 } }, { "sphere": { "radius": 0.9 } } ] } }"#,
});

/// Everything that lies in any of the shapes, with a soft fillet in the seams; `k` is the visible size.
/// The order of the shapes does not matter.
#[track_caller]
pub fn exponential_union<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&EXPONENTIAL_UNION, [k.into()], shapes.into_iter().map(Into::into))
}

/// What all the shapes have in common, with a soft fillet along its edges; `k` is the visible size.
/// The order of the shapes does not matter.
#[track_caller]
pub fn exponential_intersection<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&EXPONENTIAL_INTERSECTION, [k.into()], shapes.into_iter().map(Into::into))
}

/// The first shape without all the others, with a soft fillet along the cut's edges; `k` is the visible size.
#[track_caller]
pub fn exponential_difference<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&EXPONENTIAL_DIFFERENCE, [k.into()], shapes.into_iter().map(Into::into))
}

/// c times k. At a gap of k the share of the farther operand is e^-8, less than a tenth of a step of 8-bit colour.
const VISIBLE: f64 = 8.0;

/// Blends smaller than this are as small as this: no picture shows a difference, and c^2 fits into single precision.
const SMALLEST: f64 = 1e-12;

/// The exponent beyond which nothing is added: 1 + e^-37.5 is 1 even in double precision.
const END: f64 = 37.5;

/// c times the gap from which on the farther operand surely does not matter: a little beyond [`END`], for roundings.
const SETTLED: f64 = 38.0;

/// The weight of the farther operand beside 1 for the nearer one.
#[inline(always)]
fn weight<S: Scalar>(gap: S, c: S) -> S {
    // Not below 0, as roundings of enclosures may be: without a blend c is so large that they would come to infinite weights.
    let exponent = (gap * c).min(gap.lift(SETTLED)).max(gap.lift(0.0));
    S::select(exponent.lt(gap.lift(END)), (-exponent).exp(), gap.lift(0.0))
}

impl Family for Exponential {
    const UNION: About = About {
        name: "exponential_union",
        summary: "A union with a soft fillet in its seams; materials mix across them.",
        params: &[blend::K, blend::MIX],
        elsewhere: &["smin_exp", "blend_expt_unit", "log_sum_exp"],
        example: r#"{ "exponential_union": { "k": 0.4, "shapes":
            [ { "sphere": { "radius": 0.7 } }, { "box": { "size": [2, 0.6, 0.6] } } ] } }"#,
    };

    const OWN: usize = 0;
    const WIDTH: usize = 2;

    fn constants(k: f64, _own: f64) -> Vec<f64> {
        let c = VISIBLE / k.max(SMALLEST);
        vec![c, 1.0 / c]
    }

    fn reach(k: f64, _own: f64) -> f64 {
        k.max(SMALLEST) * (SETTLED / VISIBLE)
    }

    fn total_depth(k: f64, _own: f64, count: usize) -> f64 {
        // All operands equal: ln(count e^(-ca)).
        (count.max(1) as f64).ln() * k.max(SMALLEST) / VISIBLE
    }

    #[inline(always)]
    fn depth<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        (weight(gap, c.at(at)) + 1.0).ln() * c.at(at + 1)
    }

    #[inline(always)]
    fn farther<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        let weight = weight(gap, c.at(at));
        weight / (weight + 1.0)
    }
}
