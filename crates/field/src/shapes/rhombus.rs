//! Rhombus. Exact.

use super::polygon::Polygon;
use crate::shape_prelude::*;

/// See [`rhombus`].
#[derive(Clone, Copy, Debug)]
pub struct Rhombus;

/// The descriptor of [`rhombus`].
pub static RHOMBUS: Shape = Shape::special::<Rhombus>();

/// A rhombus with its corners on the axes.
#[track_caller]
pub fn rhombus(width: impl Into<Value>, height: impl Into<Value>) -> Form<Rhombus> {
    Form::new(&RHOMBUS, [width.into(), height.into()])
}

impl Special for Rhombus {
    type General = Polygon;

    const ABOUT: About = About {
        name: "rhombus",
        summary: "A plane figure: a rhombus with its corners on the axes.",
        params: &[Param::required("size", ParamKind::Size2, "Full lengths of the diagonals along x and y.")],
        elsewhere: &["diamond", "sdRhombus", "lozenge"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "rhombus": { "size": [1.8, 1.1] } } } }"#,
    };

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width, height] = args else { unreachable!("two numbers") };
        let (x, y) = (width / 2.0, height / 2.0);
        vec![x, 0.0, 0.0, y, -x, 0.0, 0.0, -y]
    }
}
