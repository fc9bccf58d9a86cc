//! Repetition in a grid: a union of copies, so that it is right for shapes of any size and place.

use super::translate::TRANSLATE;
use crate::shape_prelude::*;
use std::ops::Range;

/// See [`Repeat::repeat`].
#[derive(Clone, Copy, Debug)]
pub struct Grid;

/// The descriptor of [`Repeat::repeat`].
pub static REPEAT: Shape = Shape::copies::<Grid>();

/// Copies of a shape in rows, columns and layers.
pub trait Repeat: Into<Field> {
    /// So many copies of the shape along each axis, at this distance from each other; all of them together have their middle
    /// where the shape has its origin.
    #[track_caller]
    fn repeat(self, spacing: impl Into<Triple>, count: [u32; 3]) -> Field {
        let numbers = spacing.into().0.into_iter().chain(count.map(Value::from));
        Field::new(&REPEAT, numbers, [self.into()])
    }
}

impl<F: Into<Field>> Repeat for F {}

/// The most copies along one axis.
const MOST: u32 = 10_000;

/// The parameters of all grids, which come first.
pub(crate) const SPACING: Param =
    Param::required("spacing", ParamKind::Vector, "Distance from one copy to the next, along x, y and z.");
pub(crate) const COUNT: Param =
    Param::required("count", ParamKind::Counts(1, MOST), "How many copies there are, along x, y and z.");

/// How many copies a grid has.
pub(crate) fn copies(args: &[f64]) -> usize {
    args[3..6].iter().map(|&count| count as usize).product()
}

/// The column, row and layer of a copy.
pub(crate) fn cell(args: &[f64], index: usize) -> [usize; 3] {
    let [columns, rows] = [3, 4].map(|count| args[count] as usize);
    [index % columns, index / columns % rows, index / columns / rows]
}

/// Where along one axis a cell lies.
pub(crate) fn place(args: &[f64], cell: [usize; 3], axis: usize) -> f64 {
    args[axis] * (cell[axis] as f64 - (args[3 + axis] - 1.0) / 2.0)
}

impl Copies for Grid {
    const ABOUT: About = About {
        name: "repeat",
        summary: "Copies of a shape in rows, columns and layers around the origin. They may overlap, and lie anywhere in their cells.",
        params: &[SPACING, COUNT],
        elsewhere: &["opRepLim", "array", "rep", "tile", "linear_array", "pattern"],
        example: r#"{ "repeat": { "spacing": [0.6, 0.6, 0], "count": [3, 3, 1], "shape": { "sphere": { "radius": 0.25 } } } }"#,
    };

    const ARE_MOVED: bool = true;

    const COUNTED: Range<usize> = 3..6;

    fn count(args: &[f64]) -> usize {
        copies(args)
    }

    fn places(args: &[f64], index: usize) -> Vec<PlaceCall> {
        let cell = cell(args, index);
        vec![(&TRANSLATE, [0, 1, 2].map(|axis| place(args, cell, axis)).to_vec())]
    }
}
