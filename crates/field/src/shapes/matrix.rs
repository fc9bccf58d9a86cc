//! Any affine map, by its matrix: s f(M^-1 (p - t)), where s is the smallest singular value of M. Keeps exactness if M stretches
//! all directions alike, otherwise a bound.

use crate::shape::{of_rows, smallest_stretch};
use crate::shape_prelude::*;
use crate::vector::spectral_norm;

/// See [`Matrix::matrix`].
#[derive(Clone, Copy, Debug)]
pub struct MatrixMap;

/// The descriptor of [`Matrix::matrix`].
pub static MATRIX: Shape = Shape::place::<MatrixMap>();

/// Mapping a shape by a matrix.
pub trait Matrix: Into<Field> {
    /// The shape with each of its points multiplied by the matrix with these rows. `with("by", ...)` moves it afterwards.
    #[track_caller]
    fn matrix(self, rows: [[f64; 3]; 3]) -> Field {
        Field::new(&MATRIX, rows.into_iter().flatten().map(Value::from), [self.into()])
    }
}

impl<F: Into<Field>> Matrix for F {}

/// Stretches that differ by no more than this share count as the same: rounding errors of a matrix that someone has computed.
const SAME: f64 = 1e-9;

impl Place for MatrixMap {
    const ABOUT: About = About {
        name: "matrix",
        summary: "Maps a shape by a matrix: turns, scales, stretches, shears and mirrors it. Its field is a bound unless all directions are stretched alike.",
        params: &[
            Param::required(
                "rows",
                ParamKind::Matrix,
                "The rows of the matrix that each point of the shape is multiplied by: [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]].",
            ),
            Param::optional("by", ParamKind::Vector, &[0.0; 3], "How far it is moved afterwards."),
        ],
        elsewhere: &["transform", "multmatrix", "affine", "mat4"],
        example: r#"{ "matrix": { "rows": [[0.9, -0.3, 0.2], [0.3, 0.9, 0], [0, 0.2, 0.8]], "shape":
            { "box": { "size": [1.2, 1, 1], "round": 0.1 } } } }"#,
    };

    const IS_RIGID: bool = false;

    fn map(args: &[f64]) -> DAffine3 {
        DAffine3::from_mat3_translation(of_rows(args), DVec3::from_slice(&args[9..]))
    }

    fn factor(args: &[f64]) -> f64 {
        smallest_stretch(of_rows(args))
    }

    fn is_similarity(args: &[f64]) -> bool {
        let matrix = of_rows(args);
        spectral_norm(matrix) <= smallest_stretch(matrix) * (1.0 + SAME)
    }
}
