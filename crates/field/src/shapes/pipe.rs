//! Pipe along the seam of two surfaces: the length of (a, b), less the radius. A bound.

use super::carve::{Carve, Carved};
use crate::shape_prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

/// The operator [`pipe`].
#[derive(Clone, Copy, Debug)]
struct Pipe;

/// The descriptor of [`pipe`].
pub static PIPE: Shape = Shape::combine::<Carved<Pipe>>();

/// A pipe of this radius along the curve in which the surfaces of two shapes meet.
#[track_caller]
pub fn pipe<F: Into<Field>>(radius: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&PIPE, [radius.into()], shapes.into_iter().map(Into::into))
}

impl Carve for Pipe {
    const ABOUT: About = About {
        name: "pipe",
        summary: "A pipe along the curve in which the surfaces of two shapes meet.",
        params: &[Param::required(
            "radius",
            ParamKind::Positive,
            "Radius of the pipe where the surfaces meet at right angles.",
        )],
        elsewhere: &["fOpPipe"],
        example: r#"{ "pipe": { "radius": 0.12, "shapes": [
            { "box": { "size": [1.6, 1.6, 0.9] } }, { "cylinder": { "radius": 0.5, "height": 1.6 } } ] } }"#,
    };

    const HULL: Hull = Hull::Common;

    /// The first two shapes are combined first, and come into all the others.
    fn level(args: &[f64], level: f64, count: usize) -> f64 {
        (1..count).fold(level, |level, _| args[0] + level * SQRT_2)
    }

    /// The gradients of both may look the same way, hence the factor: values are no more than distances.
    #[inline(always)]
    fn value<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        let [radius] = c.get();
        (S::length2(a, b) - radius) * FRAC_1_SQRT_2
    }

    /// As far as the surface of either is from the curve, the pipe belongs to the other.
    #[inline(always)]
    fn share<S: Scalar>(a: S, b: S, _c: &Constants<'_, S>) -> S {
        a.abs().less(b.abs())
    }
}
