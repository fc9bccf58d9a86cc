//! Regular dodecahedron. Exact.

use super::convex_polyhedron::ConvexPolyhedron;
use crate::shape_prelude::*;

/// See [`dodecahedron`].
#[derive(Clone, Copy, Debug)]
pub struct Dodecahedron;

/// The descriptor of [`dodecahedron`].
pub static DODECAHEDRON: Shape = Shape::special::<Dodecahedron>();

/// Radius of the inscribed sphere of a regular dodecahedron, and of a regular icosahedron, over that of the sphere through its
/// corners: `sqrt((5 + 2 sqrt(5)) / 15)`.
pub(crate) const INNER_OF_OUTER: f64 = 0.794_654_472_291_766_1;

/// A regular dodecahedron around the origin, with corners at this distance from it, eight of them on the diagonals of a cube.
#[track_caller]
pub fn dodecahedron(radius: impl Into<Value>) -> Form<Dodecahedron> {
    Form::new(&DODECAHEDRON, [radius.into()])
}

impl Special for Dodecahedron {
    type General = ConvexPolyhedron;

    const ABOUT: About = About {
        name: "dodecahedron",
        summary: "A regular dodecahedron, eight of whose corners are those of a cube.",
        params: &[Param::required("radius", ParamKind::Positive, "Distance of the corners from the origin.")],
        elsewhere: &["sdDodecahedron", "fDodecahedron"],
        example: r#"{ "dodecahedron": { "radius": 1 } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        let &[radius] = args else { unreachable!("one number") };
        faces(radius * INNER_OF_OUTER).collect()
    }
}

/// The faces of a dodecahedron at this distance: towards the corners of an icosahedron.
pub(crate) fn faces(distance: f64) -> impl Iterator<Item = f64> {
    const SIGNS: [f64; 2] = [1.0, -1.0];
    let corners = (0..3).flat_map(|axis| {
        SIGNS.into_iter().flat_map(move |one| SIGNS.into_iter().map(move |other| (axis, one * GOLDEN, other)))
    });
    corners.flat_map(move |(axis, one, other)| {
        let mut normal = [0.0; 3];
        (normal[(axis + 1) % 3], normal[(axis + 2) % 3]) = (one, other);
        [normal[0], normal[1], normal[2], distance]
    })
}

/// The golden ratio.
pub(crate) const GOLDEN: f64 = 1.618_033_988_749_895;
