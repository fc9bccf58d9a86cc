//! Isosceles trapezoid, or triangle. Exact.

use super::polygon::Polygon;
use crate::shape_prelude::*;

/// See [`trapezoid`].
#[derive(Clone, Copy, Debug)]
pub struct Trapezoid;

/// The descriptor of [`trapezoid`].
pub static TRAPEZOID: Shape = Shape::special::<Trapezoid>();

/// A trapezoid with equal sides, or a triangle if one of the parallel sides has no length. Its box is centred at the origin.
#[track_caller]
pub fn trapezoid(bottom: impl Into<Value>, top: impl Into<Value>, height: impl Into<Value>) -> Form<Trapezoid> {
    Form::new(&TRAPEZOID, [bottom.into(), top.into(), height.into()])
}

impl Special for Trapezoid {
    type General = Polygon;

    const ABOUT: About = About {
        name: "trapezoid",
        summary: "A plane figure: a trapezoid with equal sides, or a triangle if one of the parallel sides has no length.",
        params: &[
            Param::required("bottom", ParamKind::Length, "Full width of the lower side."),
            Param::required("top", ParamKind::Length, "Full width of the upper side."),
            Param::required("height", ParamKind::Positive, "Full height."),
        ],
        elsewhere: &["sdTrapezoid", "isosceles_triangle", "sdTriangleIsosceles", "triangle"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "trapezoid": { "bottom": 1.8, "top": 0.8, "height": 1.2 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[bottom, top, _height] = args else { unreachable!("three numbers") };
        if bottom == 0.0 && top == 0.0 {
            return Err("`trapezoid` is only a line: `bottom` or `top` must be above 0".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[bottom, top, height] = args else { unreachable!("three numbers") };
        let (low, high, y) = (bottom / 2.0, top / 2.0, height / 2.0);
        vec![-low, -y, low, -y, high, y, -high, y]
    }
}
