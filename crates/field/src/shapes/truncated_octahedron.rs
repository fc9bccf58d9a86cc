//! Octahedron without its tips, of squares and regular hexagons. Exact.

use super::convex_polyhedron::ConvexPolyhedron;
use crate::shape_prelude::*;

/// See [`truncated_octahedron`].
#[derive(Clone, Copy, Debug)]
pub struct TruncatedOctahedron;

/// The descriptor of [`truncated_octahedron`].
pub static TRUNCATED_OCTAHEDRON: Shape = Shape::special::<TruncatedOctahedron>();

/// An octahedron whose tips are cut off so that all edges have the same length: copies of it fill space.
#[track_caller]
pub fn truncated_octahedron(radius: impl Into<Value>) -> Form<TruncatedOctahedron> {
    Form::new(&TRUNCATED_OCTAHEDRON, [radius.into()])
}

impl Special for TruncatedOctahedron {
    type General = ConvexPolyhedron;

    const ABOUT: About = About {
        name: "truncated_octahedron",
        summary: "An octahedron without its tips, made of squares and regular hexagons; copies of it fill space.",
        params: &[Param::required("radius", ParamKind::Positive, "Distance of the square faces from the origin.")],
        elsewhere: &["fTruncatedOctahedron", "Kelvin cell"],
        example: r#"{ "truncated_octahedron": { "radius": 0.9 } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        let &[radius] = args else { unreachable!("one number") };
        const SIGNS: [f64; 2] = [1.0, -1.0];
        let hexagons = SIGNS
            .into_iter()
            .flat_map(|x| SIGNS.into_iter().flat_map(move |y| SIGNS.into_iter().map(move |z| [x, y, z])));
        let squares = DVec3::AXES.into_iter().flat_map(|axis| [axis.to_array(), (-axis).to_array()]);
        // Both faces meet in the corners (1, 1/2, 0) and their like.
        let to_hexagon = radius * 3f64.sqrt() / 2.0;
        hexagons
            .flat_map(|[x, y, z]| [x, y, z, to_hexagon])
            .chain(squares.flat_map(|[x, y, z]| [x, y, z, radius]))
            .collect()
    }
}
