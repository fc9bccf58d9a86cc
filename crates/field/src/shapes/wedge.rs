//! Prism over a right triangle. Exact.

use super::convex_polyhedron::ConvexPolyhedron;
use crate::shape_prelude::*;

/// See [`wedge`].
#[derive(Clone, Copy, Debug)]
pub struct Wedge;

/// The descriptor of [`wedge`].
pub static WEDGE: Shape = Shape::special::<Wedge>();

/// A wedge: half of a box, below a slope that falls towards positive x. The box is centred at the origin.
#[track_caller]
pub fn wedge(size: impl Into<Triple>) -> Form<Wedge> {
    Form::new(&WEDGE, size.into().0)
}

impl Special for Wedge {
    type General = ConvexPolyhedron;

    const ABOUT: About = About {
        name: "wedge",
        summary: "Half of a box, below a slope that falls towards positive x.",
        params: &[Param::required("size", ParamKind::Size, "Full edge lengths of the box.")],
        elsewhere: &["ramp", "right_triangular_prism"],
        example: r#"{ "wedge": { "size": [1.8, 1.2, 1] } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        let &[x, y, z] = args else { unreachable!("three numbers") };
        // The slope goes through the y axis.
        vec![
            -1.0,
            0.0,
            0.0,
            x / 2.0,
            0.0,
            1.0,
            0.0,
            y / 2.0,
            0.0,
            -1.0,
            0.0,
            y / 2.0,
            0.0,
            0.0,
            -1.0,
            z / 2.0,
            z,
            0.0,
            x,
            0.0,
        ]
    }
}
