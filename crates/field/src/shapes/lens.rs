//! What two equal discs have in common. Exact.

use super::outline::{Outline, closed};
use crate::shape_prelude::*;

/// See [`lens`].
#[derive(Clone, Copy, Debug)]
pub struct Lens;

/// The descriptor of [`lens`].
pub static LENS: Shape = Shape::special::<Lens>();

/// The figure between two equal arcs, with its tips on the y axis.
#[track_caller]
pub fn lens(width: impl Into<Value>, height: impl Into<Value>) -> Form<Lens> {
    Form::new(&LENS, [width.into(), height.into()])
}

impl Special for Lens {
    type General = Outline;

    const ABOUT: About = About {
        name: "lens",
        summary: "A plane figure: a lens between two equal arcs, with its tips on the y axis.",
        params: &[
            Param::required("width", ParamKind::Positive, "Width across, along x; at most the height."),
            Param::required("height", ParamKind::Positive, "Distance of the tips, along y."),
        ],
        elsewhere: &["vesica", "sdVesica", "vesica piscis", "mandorla"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "lens": { "width": 0.9, "height": 1.8 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[width, height] = args else { unreachable!("two numbers") };
        if width > height {
            return Err(
                "`width` of `lens` must not exceed its height; turn it for a lens that is wider than high".into()
            );
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width, height] = args else { unreachable!("two numbers") };
        let turn = 4.0 * libm::atan(width / height);
        closed(&[[0.0, -height / 2.0, turn], [0.0, height / 2.0, turn]])
    }
}
