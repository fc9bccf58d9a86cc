//! V-shaped groove where two surfaces meet. A bound.

use super::carve::{Carve, Carved};
use crate::shape_prelude::*;

/// The operator [`engrave`].
#[derive(Clone, Copy, Debug)]
struct Engrave;

/// The descriptor of [`engrave`].
pub static ENGRAVE: Shape = Shape::combine::<Carved<Engrave>>();

/// The first shape with a V-shaped groove of this depth along the curve in which the surface of the others meets its own.
#[track_caller]
pub fn engrave<F: Into<Field>>(depth: impl Into<Value>, shapes: impl IntoIterator<Item = F>) -> Field {
    Field::new(&ENGRAVE, [depth.into()], shapes.into_iter().map(Into::into))
}

impl Carve for Engrave {
    const ABOUT: About = About {
        name: "engrave",
        summary: "A shape with a V-shaped groove where the surface of another shape meets its own.",
        params: &[Param::required("depth", ParamKind::Positive, "Depth of the groove, and half its width.")],
        elsewhere: &["fOpEngrave"],
        example: r#"{ "engrave": { "depth": 0.15, "shapes": [
            { "box": { "size": [1.6, 1.6, 0.9] } }, { "cylinder": { "radius": 0.5, "height": 1.6 } } ] } }"#,
    };

    /// Where the gradients of both look the same way, the groove's would be twice as long, hence the factor.
    #[inline(always)]
    fn value<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        let [depth] = c.get();
        a.max((a + depth - b.abs()) * 0.5)
    }
}
