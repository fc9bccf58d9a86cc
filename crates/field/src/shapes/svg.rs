//! Figure of an SVG picture: what it fills and strokes. Curves become arcs within a tolerance; the distance from these is exact.

use super::outline::Outline;
use super::svg_path::text_of;
use crate::drawing::lines;
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`svg`].
#[derive(Clone, Copy, Debug)]
pub struct Svg;

/// The descriptor of [`svg`].
pub static SVG: Shape = Shape::special::<Svg>();

/// All that a picture draws, as one figure: the text of its file, such as `"<svg xmlns=...>...</svg>"`. Its middle comes to lie at
/// the origin unless `with("center", ...)` says otherwise, and it has the size of the picture in pixels unless `with("height",
/// ...)` is given.
#[track_caller]
pub fn svg(picture: &str) -> Form<Svg> {
    let characters = picture.chars().map(|c| Value::from(u32::from(c)));
    Form::new(&SVG, [0.into(), 1.into()].into_iter().chain(characters))
}

/// How many arguments stand before the picture.
const BEFORE: usize = 2;

impl Special for Svg {
    type General = Outline;

    const ABOUT: About = About {
        name: "svg",
        summary: "A plane figure: all that an SVG picture draws, fills and strokes, whatever its colours.",
        params: &[
            Param::optional(
                "height",
                ParamKind::Length,
                &[0.0],
                "Full height of what is drawn; 0 takes the picture's own units for lengths.",
            ),
            Param::optional(
                "center",
                ParamKind::Flag,
                &[1.0],
                "Whether the middle of what is drawn comes to lie at the origin; otherwise the picture's corner at the top left does.",
            ),
            Param::required("picture", ParamKind::Text, "The text of the picture."),
        ],
        elsewhere: &["import", "svg import", "logo"],
        example: r#"{ "extrude": { "height": 0.3, "shape": { "svg": { "height": 1.6, "picture":
            "<svg xmlns='http://www.w3.org/2000/svg'> <circle cx='5' cy='5' r='4' fill='none' stroke='red'/> <path d='M5 2 L7 8 L2 4 H8 L3 8 Z'/> </svg>" } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        if !Self::general(args).is_empty() {
            return Ok(());
        }
        let fault = lines(&text_of(&args[BEFORE..])).err().unwrap_or_else(|| "draws nothing".into());
        Err(format!("`picture` of `svg` {fault}"))
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("svg", args, || {
            let mut lines = lines(&text_of(&args[BEFORE..])).unwrap_or_default();
            let extent = |axis: DVec3| Outline::support(&lines, axis, 0.0);
            let low = DVec3::new(-extent(DVec3::NEG_X), -extent(DVec3::NEG_Y), 0.0);
            let high = DVec3::new(extent(DVec3::X), extent(DVec3::Y), 0.0);
            let scale = if args[0] > 0.0 { args[0] / (high.y - low.y) } else { 1.0 };
            let origin = if args[1] == 0.0 { DVec3::ZERO } else { (low + high) / 2.0 };
            for corner in lines.chunks_exact_mut(4) {
                (corner[0], corner[1]) = ((corner[0] - origin.x) * scale, (corner[1] - origin.y) * scale);
            }
            lines
        })
    }
}
