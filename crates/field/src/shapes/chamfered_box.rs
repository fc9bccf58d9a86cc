//! Box with cut edges. Exact.

use super::convex_polyhedron::ConvexPolyhedron;
use crate::shape_prelude::*;
use std::f64::consts::SQRT_2;

/// See [`chamfered_box`].
#[derive(Clone, Copy, Debug)]
pub struct ChamferedBox;

/// The descriptor of [`chamfered_box`].
pub static CHAMFERED_BOX: Shape = Shape::special::<ChamferedBox>();

/// A box whose edges are cut off at 45 degrees, centred at the origin.
#[track_caller]
pub fn chamfered_box(size: impl Into<Triple>, chamfer: impl Into<Value>) -> Form<ChamferedBox> {
    let [x, y, z] = size.into().0;
    Form::new(&CHAMFERED_BOX, [x, y, z, chamfer.into()])
}

impl Special for ChamferedBox {
    type General = ConvexPolyhedron;

    const ABOUT: About = About {
        name: "chamfered_box",
        summary: "A box with all edges cut off at 45 degrees.",
        params: &[
            Param::required("size", ParamKind::Size, "Full edge lengths."),
            Param::required(
                "chamfer",
                ParamKind::Positive,
                "How much the cuts take off each face beside an edge; less than half the smallest edge.",
            ),
        ],
        elsewhere: &["bevelled box", "chamfer box"],
        example: r#"{ "chamfered_box": { "size": [1.6, 1.2, 1], "chamfer": 0.2 } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[x, y, z, chamfer] = args else { unreachable!("four numbers") };
        if chamfer >= x.min(y).min(z) / 2.0 {
            return Err("`chamfer` of `chamfered_box` must be below half the smallest edge".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let half = DVec3::from_slice(args) / 2.0;
        let chamfer = args[3];
        let mut planes = Vec::new();
        for axis in 0..3 {
            let (one, other) = ((axis + 1) % 3, (axis + 2) % 3);
            for sign in [1.0, -1.0] {
                let face = DVec3::AXES[axis] * sign;
                planes.extend([face.x, face.y, face.z, half[axis]]);
                for side in [1.0, -1.0] {
                    let cut = DVec3::AXES[one] * sign + DVec3::AXES[other] * side;
                    planes.extend([cut.x, cut.y, cut.z, (half[one] + half[other] - chamfer) / SQRT_2]);
                }
            }
        }
        planes
    }
}
