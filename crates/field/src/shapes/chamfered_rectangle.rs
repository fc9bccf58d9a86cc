//! Rectangle with cut corners. Exact.

use super::polygon::Polygon;
use crate::shape_prelude::*;

/// See [`chamfered_rectangle`].
#[derive(Clone, Copy, Debug)]
pub struct ChamferedRectangle;

/// The descriptor of [`chamfered_rectangle`].
pub static CHAMFERED_RECTANGLE: Shape = Shape::special::<ChamferedRectangle>();

/// A rectangle whose corners are cut off at 45 degrees, centred at the origin.
#[track_caller]
pub fn chamfered_rectangle(
    width: impl Into<Value>,
    height: impl Into<Value>,
    chamfer: impl Into<Value>,
) -> Form<ChamferedRectangle> {
    Form::new(&CHAMFERED_RECTANGLE, [width.into(), height.into(), chamfer.into()])
}

impl Special for ChamferedRectangle {
    type General = Polygon;

    const ABOUT: About = About {
        name: "chamfered_rectangle",
        summary: "A plane figure: a rectangle with corners cut off at 45 degrees.",
        params: &[
            Param::required("size", ParamKind::Size2, "Full edge lengths along x and y."),
            Param::required("chamfer", ParamKind::Length, "How much the cuts take off each edge; at most half of it."),
        ],
        elsewhere: &["chamfer_box2", "sdChamferBox", "bevelled rectangle"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "chamfered_rectangle": { "size": [1.6, 1.2], "chamfer": 0.3 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[width, height, chamfer] = args else { unreachable!("three numbers") };
        if chamfer > width.min(height) / 2.0 {
            return Err("`chamfer` of `chamfered_rectangle` must not exceed half the smaller edge".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width, height, chamfer] = args else { unreachable!("three numbers") };
        let (x, y) = (width / 2.0, height / 2.0);
        let (inner_x, inner_y) = (x - chamfer, y - chamfer);
        vec![inner_x, -y, x, -inner_y, x, inner_y, inner_x, y, -inner_x, y, -x, inner_y, -x, -inner_y, -inner_x, -y]
    }
}
