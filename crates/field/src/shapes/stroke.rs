//! Line along the path data of an SVG picture, with a width, and round joints and ends. Curves become arcs within a tolerance; the
//! distance from these is exact outside.

use super::polyline::Stroke;
use super::svg_path::{in_pictures, segments};
use super::tube::along;
use crate::arcs3::{Arc3, of_curve};
use crate::curve::Bezier;
use crate::remember::remembered;
use crate::shape_prelude::*;
use svgtypes::SimplePathSegment;

/// See [`stroke`].
#[derive(Clone, Copy, Debug)]
pub struct PathStroke;

/// The descriptor of [`stroke`].
pub static STROKE: Shape = Shape::special::<PathStroke>();

/// All that a disc of this width fills while its middle moves along path data, such as `"M0 0 Q1 1 2 0"`: what the attribute `d`
/// of a path in an SVG picture holds. In pictures y leads downwards; here it leads upwards.
#[track_caller]
pub fn stroke(width: impl Into<Value>, data: &str) -> Form<PathStroke> {
    let characters = data.chars().map(|c| Value::from(u32::from(c)));
    Form::new(&STROKE, [width.into()].into_iter().chain(characters))
}

/// Arcs are within this share of the line's width from its curves.
const TOLERANCE: f64 = 1e-3;

impl Special for PathStroke {
    type General = Stroke;

    const ABOUT: About = About {
        name: "stroke",
        summary: "A plane figure: a line of some width along the path of an SVG picture, with round joints and ends.",
        params: &[
            Param::required("width", ParamKind::Positive, "Full width of the line."),
            Param::required("d", ParamKind::Text, "The path data: what the attribute `d` of the path holds."),
        ],
        elsewhere: &["path with a width", "bezier2", "cubic_bezier", "quadratic_circle", "sdBezier"],
        example: r#"{ "extrude": { "height": 0.3, "shape": { "stroke": { "width": 0.16, "d":
            "M-1 0.5 C-0.8 -1.2 -0.2 -0.6 -0.4 0 S-0.2 0.8 0.2 -0.2 M0.4 0.5 Q0.5 -0.9 0.75 -0.1 T1.1 -0.4" } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let data = segments(&args[1..]).map_err(|fault| format!("`d` of `stroke` {fault}"))?;
        if arcs(&data, args[0] * TOLERANCE).is_empty() { Err("`d` of `stroke` draws nothing".into()) } else { Ok(()) }
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("stroke", args, || {
            let data = segments(&args[1..]).unwrap_or_default();
            along(args[0] / 2.0, arcs(&data, args[0] * TOLERANCE))
        })
    }
}

/// The arcs of all lines of a path, those that are points included: dots.
fn arcs(data: &[SimplePathSegment], tolerance: f64) -> Vec<Arc3> {
    let mut arcs = Vec::new();
    let (mut start, mut at) = (DVec3::ZERO, DVec3::ZERO);
    for segment in data {
        let point = |x, y| in_pictures(x, y).extend(0.0);
        let controls = match *segment {
            SimplePathSegment::MoveTo { x, y } => {
                start = point(x, y);
                at = start;
                continue;
            }
            SimplePathSegment::LineTo { x, y } => vec![at, point(x, y)],
            SimplePathSegment::Quadratic { x1, y1, x, y } => vec![at, point(x1, y1), point(x, y)],
            SimplePathSegment::CurveTo { x1, y1, x2, y2, x, y } => vec![at, point(x1, y1), point(x2, y2), point(x, y)],
            SimplePathSegment::ClosePath => vec![at, start],
        };
        at = controls[controls.len() - 1];
        if controls.iter().all(|control| *control == at) {
            arcs.push(Arc3::straight(at, at));
        } else {
            arcs.extend(of_curve(&Bezier::new(controls), tolerance));
        }
    }
    arcs
}
