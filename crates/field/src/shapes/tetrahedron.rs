//! Regular tetrahedron. Exact.

use super::convex_polyhedron::ConvexPolyhedron;
use crate::shape_prelude::*;

/// See [`tetrahedron`].
#[derive(Clone, Copy, Debug)]
pub struct Tetrahedron;

/// The descriptor of [`tetrahedron`].
pub static TETRAHEDRON: Shape = Shape::special::<Tetrahedron>();

/// A regular tetrahedron around the origin, with corners at this distance from it, on four diagonals of a cube.
#[track_caller]
pub fn tetrahedron(radius: impl Into<Value>) -> Form<Tetrahedron> {
    Form::new(&TETRAHEDRON, [radius.into()])
}

impl Special for Tetrahedron {
    type General = ConvexPolyhedron;

    const ABOUT: About = About {
        name: "tetrahedron",
        summary: "A regular tetrahedron with its corners on four diagonals of a cube.",
        params: &[Param::required("radius", ParamKind::Positive, "Distance of the corners from the origin.")],
        elsewhere: &["sdTetrahedron", "fTetrahedron"],
        example: r#"{ "tetrahedron": { "radius": 1.2 } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        let &[radius] = args else { unreachable!("one number") };
        // A face lies opposite to each corner, a third as far away.
        [[-1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0]]
            .into_iter()
            .flat_map(|[x, y, z]| [x, y, z, radius / 3.0])
            .collect()
    }
}
