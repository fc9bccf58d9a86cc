//! Rectangular ridge where two surfaces meet. A bound.

use super::carve::{Carve, Carved};
use crate::shape_prelude::*;

/// The operator [`tongue`].
#[derive(Clone, Copy, Debug)]
struct Tongue;

/// The descriptor of [`tongue`].
pub static TONGUE: Shape = Shape::combine::<Carved<Tongue>>();

/// The first shape with a ridge of this height and width along the curve in which the surface of the others meets its own.
#[track_caller]
pub fn tongue<F: Into<Field>>(
    height: impl Into<Value>,
    width: impl Into<Value>,
    shapes: impl IntoIterator<Item = F>,
) -> Field {
    Field::new(&TONGUE, [height.into(), width.into()], shapes.into_iter().map(Into::into))
}

impl Carve for Tongue {
    const ABOUT: About = About {
        name: "tongue",
        summary: "A shape with a rectangular ridge where the surface of another shape meets its own.",
        params: &[
            Param::required("height", ParamKind::Positive, "How far the ridge stands out."),
            Param::required("width", ParamKind::Positive, "Full width of the ridge."),
        ],
        elsewhere: &["fOpTongue"],
        example: r#"{ "tongue": { "height": 0.1, "width": 0.2, "shapes": [
            { "box": { "size": [1.6, 1.6, 0.9] } }, { "cylinder": { "radius": 0.5, "height": 1.6 } } ] } }"#,
    };

    fn prepare(args: &[f64]) -> Vec<f64> {
        vec![args[0], args[1] / 2.0]
    }

    fn level(args: &[f64], level: f64, count: usize) -> f64 {
        level + args[0] * count.saturating_sub(1) as f64
    }

    #[inline(always)]
    fn value<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        let [height, half] = c.get();
        a.min((a - height).max(b.abs() - half))
    }
}
