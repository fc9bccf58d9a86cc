//! Copies at given points: a union, so that it is right for shapes of any size and place.

use super::translate::TRANSLATE;
use crate::shape_prelude::*;
use std::ops::Range;

/// See [`Scatter::scatter`].
#[derive(Clone, Copy, Debug)]
pub struct Scattered;

/// The descriptor of [`Scatter::scatter`].
pub static SCATTER: Shape = Shape::copies::<Scattered>();

/// Copies of a shape at given points.
pub trait Scatter: Into<Field> {
    /// A copy of the shape at each of the points, where its origin comes to lie.
    #[track_caller]
    fn scatter<V: Into<Value>>(self, points: impl IntoIterator<Item = [V; 3]>) -> Field {
        Field::new(&SCATTER, points.into_iter().flat_map(|point| point.map(Into::into)), [self.into()])
    }
}

impl<F: Into<Field>> Scatter for F {}

impl Copies for Scattered {
    const ABOUT: About = About {
        name: "scatter",
        summary: "Copies of a shape at given points. Many equal balls are a `point_set`.",
        params: &[Param::required("points", ParamKind::Points3, "Where the copies have their origins.")],
        elsewhere: &["instances", "copy to points"],
        example: r#"{ "scatter": { "points": [[-0.8, -0.6, -0.2], [-0.5, 0.5, 0.3], [0, -0.1, 0], [0.5, 0.6, -0.3], [0.8, -0.4, 0.4]],
            "shape": { "sphere": { "radius": 0.3 } } } }"#,
    };

    const ARE_MOVED: bool = true;

    const COUNTED: Range<usize> = 0..0;

    fn count(args: &[f64]) -> usize {
        args.len() / 3
    }

    fn places(args: &[f64], index: usize) -> Vec<PlaceCall> {
        vec![(&TRANSLATE, args[3 * index..3 * index + 3].to_vec())]
    }
}
