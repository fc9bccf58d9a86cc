//! Parallelogram in space, without thickness. Exact, unsigned.

use super::triangle::{Panel, normal};
use crate::shape_prelude::*;

/// See [`quad`].
#[derive(Clone, Copy, Debug)]
pub struct Quad;

/// The descriptor of [`quad`].
pub static QUAD: Shape = Shape::special::<Quad>();

/// The parallelogram, or rectangle, with this corner and these edges from there, as a sheet without thickness.
#[track_caller]
pub fn quad(corner: impl Into<Triple>, u: impl Into<Triple>, v: impl Into<Triple>) -> Form<Quad> {
    Form::new(&QUAD, [corner.into().0, u.into().0, v.into().0].concat())
}

/// The corners, one after another.
fn corners(args: &[f64]) -> [DVec3; 4] {
    let [corner, u, v] = [0, 3, 6].map(|at| DVec3::from_slice(&args[at..]));
    [corner, corner + u, corner + u + v, corner + v]
}

impl Special for Quad {
    type General = Panel;

    const ABOUT: About = About {
        name: "quad",
        summary: "A rectangle or parallelogram in space, without thickness. It has no inside; `offset` gives it one, with round edges.",
        params: &[
            Param::required("corner", ParamKind::Vector, "A corner."),
            Param::required("u", ParamKind::Vector, "The edge from there to the next corner."),
            Param::required("v", ParamKind::Vector, "The other edge from there."),
        ],
        elsewhere: &["quad3", "udQuad", "parallelogram in space"],
        example: r#"{ "offset": { "by": 0.05, "shape":
            { "quad": { "corner": [-0.9, -0.7, -0.3], "u": [1.5, -0.1, -0.1], "v": [0.3, 1.3, 0.7] } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        match normal(&corners(args)) {
            Some(_) => Ok(()),
            None => Err("the edges `u` and `v` of `quad` lie on a line".into()),
        }
    }

    fn general(args: &[f64]) -> Vec<f64> {
        corners(args).iter().flat_map(DVec3::to_array).collect()
    }
}
