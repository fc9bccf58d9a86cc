//! Blends by polynomials of any order above 1. Bounds.
//!
//! With h = max(k - |a - b|, 0) / k the smooth minimum of order n is min(a, b) - k/(2n) h^n (Quilez, "smooth minimum", 2013;
//! order n after Csébfalvi). Orders 2 and 3 are also had from the smooth operators, without a power and therefore faster.

use super::blend::{self, Family, inverse, nearness};
use crate::shape_prelude::*;

/// The family of these blends.
#[derive(Clone, Copy, Debug)]
struct Polynomial;

/// The descriptor of [`polynomial_union`].
pub static POLYNOMIAL_UNION: Shape = blend::union::<Polynomial>();

/// The descriptor of [`polynomial_intersection`].
pub static POLYNOMIAL_INTERSECTION: Shape = blend::intersection::<Polynomial>(About {
    name: "polynomial_intersection",
    summary: "An intersection with a fillet along its edges, the sharper in its middle the higher its order; materials mix across them.",
    params: &[blend::K, ORDER, blend::MIX, blend::KEEP],
    elsewhere: &["smax"],
    example: r#"{ "polynomial_intersection": { "k": 0.3, "order": 4, "shapes":
        [ { "sphere": { "radius": 0.9 } }, { "box": { "size": 1.4 } } ] } }"#,
});

/// The descriptor of [`polynomial_difference`].
pub static POLYNOMIAL_DIFFERENCE: Shape = blend::difference::<Polynomial>(About {
    name: "polynomial_difference",
    summary: "A difference with a fillet along the cut's edges, the sharper in its middle the higher its order; materials mix across them.",
    params: &[blend::K, ORDER, blend::MIX, blend::KEEP],
    elsewhere: &[],
    example: r#"{ "polynomial_difference": { "k": 0.2, "order": 4, "shapes":
        [ { "box": { "size": 1.4 } }, { "sphere": { "radius": 0.9 } } ] } }"#,
});

/// Everything that lies in any of the shapes, with a fillet that is sharper in its middle the higher the `order` in the seams;
/// `k` is the visible size. Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn polynomial_union<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&POLYNOMIAL_UNION, [k.into()], shapes.into_iter().map(Into::into))
}

/// What all the shapes have in common, with a fillet that is sharper in its middle the higher the `order` along its edges; `k` is
/// the visible size. Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn polynomial_intersection<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&POLYNOMIAL_INTERSECTION, [k.into()], shapes.into_iter().map(Into::into))
}

/// The first shape without all the others, with a fillet that is sharper in its middle the higher the `order` along the cut's
/// edges; `k` is the visible size.
#[track_caller]
pub fn polynomial_difference<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&POLYNOMIAL_DIFFERENCE, [k.into()], shapes.into_iter().map(Into::into))
}

/// The order of the polynomial.
const ORDER: Param = Param::optional(
    "order",
    ParamKind::Positive,
    &[2.5],
    "Order of the polynomial, any number above 1: near 1 it is nearly a chamfer, the higher the more of the seam stays.",
);

impl Family for Polynomial {
    const UNION: About = About {
        name: "polynomial_union",
        summary: "A union with a fillet in its seams, the sharper in its middle the higher its order; materials mix across them.",
        params: &[blend::K, ORDER, blend::MIX],
        elsewhere: &["smin", "sminN"],
        example: r#"{ "polynomial_union": { "k": 0.4, "order": 4, "shapes":
            [ { "sphere": { "radius": 0.7 } }, { "box": { "size": [2, 0.6, 0.6] } } ] } }"#,
    };

    const OWN: usize = 1;
    const WIDTH: usize = 4;

    fn check(own: f64) -> Result<(), String> {
        if own > 1.0 { Ok(()) } else { Err(format!("`order` must be above 1, but is {own}")) }
    }

    fn constants(k: f64, own: f64) -> Vec<f64> {
        vec![k, inverse(k), k / (2.0 * own), own]
    }

    #[inline(always)]
    fn depth<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        let [k, inverse, depth, order] = [c.at(at), c.at(at + 1), c.at(at + 2), c.at(at + 3)];
        nearness(gap, k, inverse).pow(order) * depth
    }

    #[inline(always)]
    fn farther<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        let [k, inverse, order] = [c.at(at), c.at(at + 1), c.at(at + 3)];
        nearness(gap, k, inverse).pow(order - 1.0) * 0.5
    }
}
