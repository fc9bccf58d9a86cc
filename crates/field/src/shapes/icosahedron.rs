//! Regular icosahedron. Exact.

use super::convex_polyhedron::ConvexPolyhedron;
use super::dodecahedron::{GOLDEN, INNER_OF_OUTER};
use crate::shape_prelude::*;

/// See [`icosahedron`].
#[derive(Clone, Copy, Debug)]
pub struct Icosahedron;

/// The descriptor of [`icosahedron`].
pub static ICOSAHEDRON: Shape = Shape::special::<Icosahedron>();

/// A regular icosahedron around the origin, with corners at this distance from it.
#[track_caller]
pub fn icosahedron(radius: impl Into<Value>) -> Form<Icosahedron> {
    Form::new(&ICOSAHEDRON, [radius.into()])
}

impl Special for Icosahedron {
    type General = ConvexPolyhedron;

    const ABOUT: About = About {
        name: "icosahedron",
        summary: "A regular icosahedron, whose corners lie on three golden rectangles.",
        params: &[Param::required("radius", ParamKind::Positive, "Distance of the corners from the origin.")],
        elsewhere: &["sdIcosahedron", "fIcosahedron"],
        example: r#"{ "icosahedron": { "radius": 1 } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        let &[radius] = args else { unreachable!("one number") };
        corners().flat_map(|[x, y, z]| [x, y, z, radius * INNER_OF_OUTER]).collect()
    }
}

/// The directions of the corners of a dodecahedron: those of a cube, and of three rectangles.
fn corners() -> impl Iterator<Item = [f64; 3]> {
    const SIGNS: [f64; 2] = [1.0, -1.0];
    let pairs = || SIGNS.into_iter().flat_map(|a| SIGNS.into_iter().map(move |b| (a, b)));
    let cube = SIGNS.into_iter().flat_map(move |x| pairs().map(move |(y, z)| [x, y, z]));
    let rectangles = (0..3).flat_map(move |axis| {
        pairs().map(move |(a, b)| {
            let mut corner = [0.0; 3];
            (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (a * GOLDEN, b / GOLDEN);
            corner
        })
    });
    cube.chain(rectangles)
}
