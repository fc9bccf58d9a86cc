//! Figure of the path data of an SVG picture. Curves become arcs within a tolerance; the distance from these is exact.

use super::outline::Outline;
use crate::arcs::Lines;
use crate::fill::{Rule, filled};
use crate::remember::remembered;
use crate::shape_prelude::*;
use svgtypes::{SimplePathSegment, SimplifyingPathParser};

/// See [`svg_path`].
#[derive(Clone, Copy, Debug)]
pub struct SvgPath;

/// The descriptor of [`svg_path`].
pub static SVG_PATH: Shape = Shape::special::<SvgPath>();

/// The figure of path data, such as `"M0 0 L4 0 Q4 3 0 3 Z"`: what the attribute `d` of a path in an SVG picture holds. In
/// pictures y leads downwards; here it leads upwards. `with("rule", ...)` chooses how lines within others are filled.
#[track_caller]
pub fn svg_path(data: &str) -> Form<SvgPath> {
    let characters = data.chars().map(|c| Value::from(u32::from(c)));
    Form::new(&SVG_PATH, [0.into()].into_iter().chain(characters))
}

/// Arcs are within this share of the size of the path from its curves.
const TOLERANCE: f64 = 1e-4;

/// The text of a list of characters.
pub(crate) fn text_of(codes: &[f64]) -> String {
    codes.iter().map(|&code| char::from_u32(code as u32).unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

impl Special for SvgPath {
    type General = Outline;

    const ABOUT: About = About {
        name: "svg_path",
        summary: "A plane figure: the path of an SVG picture, with lines, arcs and Bézier curves.",
        params: &[
            Param::optional(
                "rule",
                ParamKind::Choice(&["nonzero", "evenodd"]),
                &[0.0],
                "What is inside where lines lie within others: `nonzero` counts in which direction they run, `evenodd` how many they are.",
            ),
            Param::required("d", ParamKind::Text, "The path data: what the attribute `d` of the path holds."),
        ],
        elsewhere: &["path", "svg", "outline import", "bezier2", "parabola_segment", "quad_circle"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "svg_path": { "d":
            "M-0.9 0.5 C-0.9 -0.7 -0.2 -0.7 0 0 C0.2 -0.7 0.9 -0.7 0.9 0.5 Q0 0.9 -0.9 0.5 Z M-0.3 0.3 L0.3 0.3 L0 0.05 Z" } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        lines(args).map_err(|fault| format!("`d` of `svg_path` {fault}"))?;
        if Self::general(args).is_empty() { Err("`d` of `svg_path` surrounds nothing".into()) } else { Ok(()) }
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("svg_path", args, || {
            let Ok((lines, tolerance)) = lines(args) else { return Vec::new() };
            filled(&lines, if args[0] == 0.0 { Rule::NonZero } else { Rule::EvenOdd }, tolerance)
        })
    }
}

/// The path data of a list of characters.
pub(crate) fn segments(codes: &[f64]) -> Result<Vec<SimplePathSegment>, String> {
    let parsed: Result<_, _> = SimplifyingPathParser::from(text_of(codes).as_str()).collect();
    parsed.map_err(|error| format!("is no path data: {error}"))
}

/// A point of a picture, in which y leads downwards.
pub(crate) fn in_pictures(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, -y)
}

/// The closed lines of a path, with arguments as those of an outline, and the tolerance they were made with.
fn lines(args: &[f64]) -> Result<(Vec<f64>, f64), String> {
    let segments = segments(&args[1..])?;
    let point = in_pictures;
    let ends = segments.iter().filter_map(|segment| match *segment {
        SimplePathSegment::MoveTo { x, y }
        | SimplePathSegment::LineTo { x, y }
        | SimplePathSegment::CurveTo { x, y, .. }
        | SimplePathSegment::Quadratic { x, y, .. } => Some(point(x, y)),
        SimplePathSegment::ClosePath => None,
    });
    let (low, high) = ends.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let size = (high - low).max_element().max(f64::MIN_POSITIVE);
    let tolerance = size * TOLERANCE;
    let mut lines = Lines::new(tolerance);
    for segment in segments {
        match segment {
            SimplePathSegment::MoveTo { x, y } => lines.move_to(point(x, y)),
            SimplePathSegment::LineTo { x, y } => lines.line_to(point(x, y)),
            SimplePathSegment::Quadratic { x1, y1, x, y } => lines.quadratic_to(point(x1, y1), point(x, y)),
            SimplePathSegment::CurveTo { x1, y1, x2, y2, x, y } => {
                lines.cubic_to(point(x1, y1), point(x2, y2), point(x, y));
            }
            SimplePathSegment::ClosePath => lines.close(),
        }
    }
    Ok((lines.finish(), tolerance))
}
