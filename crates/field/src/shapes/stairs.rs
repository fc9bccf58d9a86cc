//! Blends by stairs. Bounds.
//!
//! With h = max(k - |a - b|, 0) and a triangle wave t of height s = k / (steps + 1) and period 2s the minimum is
//! min(a, b) - (h - t(h)) / 2 (after hg_sdf, Mercury, 2015). Between the operands' faces stand copies of both in turn.

use super::blend::{self, Family, inverse};
use crate::shape_prelude::*;

/// The family of these blends.
#[derive(Clone, Copy, Debug)]
struct Stairs;

/// The descriptor of [`stairs_union`].
pub static STAIRS_UNION: Shape = blend::union::<Stairs>();

/// The descriptor of [`stairs_intersection`].
pub static STAIRS_INTERSECTION: Shape = blend::intersection::<Stairs>(About {
    name: "stairs_intersection",
    summary: "An intersection with a flight of stairs along its edges; materials mix across them.",
    params: &[blend::K, STEPS, blend::MIX, blend::KEEP],
    elsewhere: &["fOpIntersectionStairs"],
    example: r#"{ "stairs_intersection": { "k": 0.3, "steps": 3, "shapes":
        [ { "sphere": { "radius": 0.9 } }, { "box": { "size": 1.4 } } ] } }"#,
});

/// The descriptor of [`stairs_difference`].
pub static STAIRS_DIFFERENCE: Shape = blend::difference::<Stairs>(About {
    name: "stairs_difference",
    summary: "A difference with a flight of stairs along the cut's edges; materials mix across them.",
    params: &[blend::K, STEPS, blend::MIX, blend::KEEP],
    elsewhere: &["fOpDifferenceStairs"],
    example: r#"{ "stairs_difference": { "k": 0.2, "steps": 3, "shapes":
        [ { "box": { "size": 1.4 } }, { "sphere": { "radius": 0.9 } } ] } }"#,
});

/// Everything that lies in any of the shapes, with a flight of stairs in the seams; `k` is the visible size.
/// Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn stairs_union<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&STAIRS_UNION, [k.into()], shapes.into_iter().map(Into::into))
}

/// What all the shapes have in common, with a flight of stairs along its edges; `k` is the visible size.
/// Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn stairs_intersection<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&STAIRS_INTERSECTION, [k.into()], shapes.into_iter().map(Into::into))
}

/// The first shape without all the others, with a flight of stairs along the cut's edges; `k` is the visible size.
#[track_caller]
pub fn stairs_difference<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&STAIRS_DIFFERENCE, [k.into()], shapes.into_iter().map(Into::into))
}

/// The number of steps.
const STEPS: Param =
    Param::optional("steps", ParamKind::Count(1, 100), &[3.0], "How many steps stand between the two faces.");

/// How far into the wave's period, of twice the rise, h is.
#[inline(always)]
fn phase<S: Scalar>(h: S, rise: S, frequency: S) -> S {
    h - (h * frequency * 0.5).floor() * rise * 2.0
}

impl Family for Stairs {
    const UNION: About = About {
        name: "stairs_union",
        summary: "A union with a flight of stairs in its seams; materials mix across them.",
        params: &[blend::K, STEPS, blend::MIX],
        elsewhere: &["fOpUnionStairs"],
        example: r#"{ "stairs_union": { "k": 0.4, "steps": 3, "shapes":
            [ { "sphere": { "radius": 0.7 } }, { "box": { "size": [2, 0.6, 0.6] } } ] } }"#,
    };

    const OWN: usize = 1;
    const WIDTH: usize = 3;

    fn constants(k: f64, own: f64) -> Vec<f64> {
        let rise = k / (own + 1.0);
        vec![k, rise, inverse(rise)]
    }

    #[inline(always)]
    fn depth<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        let [k, rise, frequency] = [c.at(at), c.at(at + 1), c.at(at + 2)];
        let h = (k - gap).max(gap.lift(0.0));
        // As a whole and not by its phase, which jumps: enclosures over a jump are never narrow.
        let wave = (h * frequency).zigzag() * rise;
        (h - wave).max(gap.lift(0.0)) * 0.5
    }

    #[inline(always)]
    fn farther<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        let [k, rise, frequency] = [c.at(at), c.at(at + 1), c.at(at + 2)];
        let h = (k - gap).max(gap.lift(0.0));
        // On falling parts of the wave. At h = 0 it rises, unless there is no blend.
        S::select(gap.lt(k) & rise.lt(phase(h, rise, frequency)), gap.lift(1.0), gap.lift(0.0))
    }
}
