//! Blends by hyperbolas. Bounds.
//!
//! Quilez' root form is (a + b - sqrt((a - b)^2 + w^2)) / 2, which deviates from the minimum everywhere ("smooth minimum", root).
//! Here w = k/4, its tangent at a gap of k is taken off, and what remains is scaled so that the shares are 1/2 in the seam; so
//! the blend ends at k, as all others do.

use super::blend::{self, Family, inverse, nearness};
use crate::shape_prelude::*;

/// The family of these blends.
#[derive(Clone, Copy, Debug)]
struct Root;

/// The descriptor of [`root_union`].
pub static ROOT_UNION: Shape = blend::union::<Root>();

/// The descriptor of [`root_intersection`].
pub static ROOT_INTERSECTION: Shape = blend::intersection::<Root>(About {
    name: "root_intersection",
    summary: "An intersection with a fillet like a hyperbola along its edges; materials mix across them.",
    params: &[blend::K, blend::MIX, blend::KEEP],
    elsewhere: &["smax_root"],
    example: r#"{ "root_intersection": { "k": 0.3, "shapes":
        [ { "sphere": { "radius": 0.9 } }, { "box": { "size": 1.4 } } ] } }"#,
});

/// The descriptor of [`root_difference`].
pub static ROOT_DIFFERENCE: Shape = blend::difference::<Root>(About {
    name: "root_difference",
    summary: "A difference with a fillet like a hyperbola along the cut's edges; materials mix across them.",
    params: &[blend::K, blend::MIX, blend::KEEP],
    elsewhere: &[],
    example: r#"{ "root_difference": { "k": 0.2, "shapes":
        [ { "box": { "size": 1.4 } }, { "sphere": { "radius": 0.9 } } ] } }"#,
});

/// Everything that lies in any of the shapes, with a fillet like a hyperbola in the seams; `k` is the visible size.
/// Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn root_union<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&ROOT_UNION, [k.into()], shapes.into_iter().map(Into::into))
}

/// What all the shapes have in common, with a fillet like a hyperbola along its edges; `k` is the visible size.
/// Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn root_intersection<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&ROOT_INTERSECTION, [k.into()], shapes.into_iter().map(Into::into))
}

/// The first shape without all the others, with a fillet like a hyperbola along the cut's edges; `k` is the visible size.
#[track_caller]
pub fn root_difference<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&ROOT_DIFFERENCE, [k.into()], shapes.into_iter().map(Into::into))
}

/// w / k: how round the hyperbola's vertex is. At the blend's end the root form's own share is then 1.5 %.
const WIDTH: f64 = 0.25;

/// The root form's deviation from the minimum at a gap of t k, in k.
#[inline(always)]
fn hyperbola(t: f64) -> f64 {
    0.5 * ((t * t + WIDTH * WIDTH).sqrt() - t)
}

/// How fast it falls there.
#[inline(always)]
fn slope(t: f64) -> f64 {
    0.5 * (1.0 - t / (t * t + WIDTH * WIDTH).sqrt())
}

impl Family for Root {
    const UNION: About = About {
        name: "root_union",
        summary: "A union with a fillet like a hyperbola in its seams; materials mix across them.",
        params: &[blend::K, blend::MIX],
        elsewhere: &["smin_root", "sminRoot", "smin_sqrt"],
        example: r#"{ "root_union": { "k": 0.4, "shapes":
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
        let (h, scale) = (nearness(gap, k, inverse), 0.5 / (0.5 - slope(1.0)));
        let t = -h + 1.0;
        let fall = ((t.square() + WIDTH * WIDTH).sqrt() - t) * 0.5 - gap.lift(hyperbola(1.0)) - h * slope(1.0);
        // Roundings leave something at the very end.
        S::select(h.lift(0.0).lt(h), (k * fall * scale).max(h.lift(0.0)), h.lift(0.0))
    }

    #[inline(always)]
    fn farther<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        let [k, inverse] = [c.at(at), c.at(at + 1)];
        let (h, scale) = (nearness(gap, k, inverse), 0.5 / (0.5 - slope(1.0)));
        let t = -h + 1.0;
        let share = (-(t / (t.square() + WIDTH * WIDTH).sqrt()) * 0.5 + (0.5 - slope(1.0))) * scale;
        S::select(h.lift(0.0).lt(h), share.max(h.lift(0.0)), h.lift(0.0))
    }
}
