//! Segment of a disc: what lies beyond a straight cut. Exact.

use super::outline::{Outline, closed};
use crate::shape_prelude::*;

/// See [`circle_segment`].
#[derive(Clone, Copy, Debug)]
pub struct CircleSegment;

/// The descriptor of [`circle_segment`].
pub static CIRCLE_SEGMENT: Shape = Shape::special::<CircleSegment>();

/// What of a disc around the origin lies above this height.
#[track_caller]
pub fn circle_segment(radius: impl Into<Value>, height: impl Into<Value>) -> Form<CircleSegment> {
    Form::new(&CIRCLE_SEGMENT, [radius.into(), height.into()])
}

impl Special for CircleSegment {
    type General = Outline;

    const ABOUT: About = About {
        name: "circle_segment",
        summary: "A plane figure: what of a disc around the origin lies above a straight cut.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the disc."),
            Param::required("height", ParamKind::Number, "The y of the cut, between minus the radius and the radius."),
        ],
        elsewhere: &["cut_disk", "sdCutDisk"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "circle_segment": { "radius": 1, "height": -0.3 } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[radius, height] = args else { unreachable!("two numbers") };
        if height.abs() >= radius {
            return Err(
                "the cut of `circle_segment` misses the disc: `height` must lie between minus and plus `radius`".into(),
            );
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[radius, height] = args else { unreachable!("two numbers") };
        let half = (radius * radius - height * height).sqrt();
        closed(&[[half, height, 2.0 * libm::acos(height / radius)], [-half, height, 0.0]])
    }
}
