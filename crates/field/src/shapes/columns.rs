//! Blends by rows of columns. Bounds.
//!
//! Columns stand in a row on the bevel between two right-angled faces, and touch it from below: circles of radius r = k /
//! (columns - 1), of which the outermost touch it at its ends, and neighbours meet at right angles. With s = (k - |a -
//! b|) / r and z the distance of s from the nearest even number the minimum is min(a, b) - r (s - (sqrt 2 - sqrt(2 -
//! z^2))) / 2. The idea is hg_sdf's (Mercury, 2015), whose columns show half of their circles, which makes them steeper
//! than their operands by up to sqrt 2; ours show a quarter, and are not.

use super::blend::{self, Family, inverse};
use crate::shape_prelude::*;
use std::f64::consts::SQRT_2;

/// The family of these blends.
#[derive(Clone, Copy, Debug)]
struct Columns;

/// The descriptor of [`columns_union`].
pub static COLUMNS_UNION: Shape = blend::union::<Columns>();

/// The descriptor of [`columns_intersection`].
pub static COLUMNS_INTERSECTION: Shape = blend::intersection::<Columns>(About {
    name: "columns_intersection",
    summary: "An intersection with a row of columns along its edges; materials mix across them.",
    params: &[blend::K, COLUMNS, blend::MIX, blend::KEEP],
    elsewhere: &["fOpIntersectionColumns"],
    example: r#"{ "columns_intersection": { "k": 0.4, "columns": 4, "shapes":
        [ { "box": { "size": [3, 3, 1] } }, { "cylinder": { "radius": 0.9, "height": 2 } } ] } }"#,
});

/// The descriptor of [`columns_difference`].
pub static COLUMNS_DIFFERENCE: Shape = blend::difference::<Columns>(About {
    name: "columns_difference",
    summary: "A difference with a row of columns along the cut's edges; materials mix across them.",
    params: &[blend::K, COLUMNS, blend::MIX, blend::KEEP],
    elsewhere: &["fOpDifferenceColumns"],
    example: r#"{ "columns_difference": { "k": 0.4, "columns": 4, "shapes":
        [ { "box": { "size": [1.8, 1.8, 0.9] } }, { "cylinder": { "radius": 0.4, "height": 2 } } ] } }"#,
});

/// Everything that lies in any of the shapes, with a row of columns in the seams; `k` is the visible size.
/// Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn columns_union<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&COLUMNS_UNION, [k.into()], shapes.into_iter().map(Into::into))
}

/// What all the shapes have in common, with a row of columns along its edges; `k` is the visible size.
/// Shapes are blended one after another, so that their order matters a little where several seams meet.
#[track_caller]
pub fn columns_intersection<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&COLUMNS_INTERSECTION, [k.into()], shapes.into_iter().map(Into::into))
}

/// The first shape without all the others, with a row of columns along the cut's edges; `k` is the visible size.
#[track_caller]
pub fn columns_difference<F: Into<Field>>(k: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&COLUMNS_DIFFERENCE, [k.into()], shapes.into_iter().map(Into::into))
}

/// The number of columns.
const COLUMNS: Param = Param::optional(
    "columns",
    ParamKind::Count(2, 100),
    &[4.0],
    "How many columns stand side by side; the outer two are sunk into the faces by half.",
);

impl Family for Columns {
    const UNION: About = About {
        name: "columns_union",
        summary: "A union with a row of columns in its seams; materials mix across them.",
        params: &[blend::K, COLUMNS, blend::MIX],
        elsewhere: &["fOpUnionColumns"],
        example: r#"{ "columns_union": { "k": 0.4, "columns": 4, "shapes":
            [ { "box": { "size": [1.8, 1.8, 0.4] } }, { "cylinder": { "radius": 0.35, "height": 1.6 } } ] } }"#,
    };

    const OWN: usize = 1;
    const WIDTH: usize = 3;

    /// The size, the radius of the columns, and its inverse.
    fn constants(k: f64, own: f64) -> Vec<f64> {
        let radius = k / (own - 1.0);
        vec![k, radius, inverse(radius)]
    }

    #[inline(always)]
    fn depth<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        let [k, radius, inverse] = [c.at(at), c.at(at + 1), c.at(at + 2)];
        let zero = gap.lift(0.0);
        let s = ((k - gap) * inverse).max(zero);
        // How far the columns recede from the chamfer, without a difference of numbers that are equal at its ends.
        let square = s.zigzag().square();
        let recess = square / ((-square + 2.0).sqrt() + SQRT_2);
        (s - recess).max(zero) * radius * 0.5
    }

    #[inline(always)]
    fn farther<S: Scalar>(gap: S, c: &Constants<'_, S>, at: usize) -> S {
        let [k, inverse] = [c.at(at), c.at(at + 2)];
        let s = ((k - gap) * inverse).max(gap.lift(0.0));
        // From the middle of the nearest column.
        let off = s - ((s + 1.0) * 0.5).floor() * 2.0;
        let share = (-(off / (-off.square() + 2.0).sqrt()) + 1.0) * 0.5;
        S::select(gap.lt(k), share, gap.lift(0.0))
    }
}
