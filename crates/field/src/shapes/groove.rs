//! Rectangular groove where two surfaces meet. A bound.

use super::carve::{Carve, Carved};
use crate::shape_prelude::*;

/// The operator [`groove`].
#[derive(Clone, Copy, Debug)]
struct Groove;

/// The descriptor of [`groove`].
pub static GROOVE: Shape = Shape::combine::<Carved<Groove>>();

/// The first shape with a groove of this depth and width along the curve in which the surface of the others meets its own.
#[track_caller]
pub fn groove<F: Into<Field>>(
    depth: impl Into<Value>,
    width: impl Into<Value>,
    shapes: impl IntoIterator<Item = F>,
) -> Field {
    Field::new(&GROOVE, [depth.into(), width.into()], shapes.into_iter().map(Into::into))
}

impl Carve for Groove {
    const ABOUT: About = About {
        name: "groove",
        summary: "A shape with a rectangular groove where the surface of another shape meets its own.",
        params: &[
            Param::required("depth", ParamKind::Positive, "Depth of the groove."),
            Param::required("width", ParamKind::Positive, "Full width of the groove."),
        ],
        elsewhere: &["fOpGroove"],
        example: r#"{ "groove": { "depth": 0.12, "width": 0.2, "shapes": [
            { "box": { "size": [1.6, 1.6, 0.9] } }, { "cylinder": { "radius": 0.5, "height": 1.6 } } ] } }"#,
    };

    fn prepare(args: &[f64]) -> Vec<f64> {
        vec![args[0], args[1] / 2.0]
    }

    #[inline(always)]
    fn value<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        let [depth, half] = c.get();
        a.max((a + depth).min(half - b.abs()))
    }
}
