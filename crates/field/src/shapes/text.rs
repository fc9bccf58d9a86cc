//! Text: the letters of a font as a plane figure. Their curves become arcs within a tolerance; the distance from these is exact.

use super::outline::Outline;
use super::svg_path::text_of;
use crate::glyphs::{Align, lines, missing};
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`text`].
#[derive(Clone, Copy, Debug)]
pub struct Text;

/// The descriptor of [`text`].
pub static TEXT: Shape = Shape::special::<Text>();

/// A text in letters of this size, that is, of lines of this height. Its first baseline begins at the origin and leads along x;
/// `\n` begins another line below. `with("align", ...)` centres lines on the y axis, or ends them there.
#[track_caller]
pub fn text(size: impl Into<Value>, text: &str) -> Form<Text> {
    let characters = text.chars().map(|c| Value::from(u32::from(c)));
    Form::new(&TEXT, [size.into(), 0.into(), 1.into()].into_iter().chain(characters))
}

/// How many arguments stand before the letters.
const BEFORE: usize = 3;

const ALIGN: &[&str] = &["left", "center", "right"];

impl Special for Text {
    type General = Outline;

    const ABOUT: About = About {
        name: "text",
        summary: "A plane figure: a text in the letters of Noto Sans, with its first baseline on the x axis.",
        params: &[
            Param::required("size", ParamKind::Positive, "Size of the font: capital letters are 0.71 times as high."),
            Param::optional("align", ParamKind::Choice(ALIGN), &[0.0], "Which point of each line lies on the y axis."),
            Param::optional(
                "spacing",
                ParamKind::Positive,
                &[1.0],
                "From line to line, as a multiple of what is usual.",
            ),
            Param::required("text", ParamKind::Text, "The text; `\\n` begins another line."),
        ],
        elsewhere: &["text", "letters", "string"],
        example: r#"{ "extrude": { "height": 0.3, "shape": {
            "text": { "text": "sdf", "size": 1.4, "align": "center" } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let text = text_of(&args[BEFORE..]);
        if let Some(letter) = missing(&text) {
            return Err(format!("the font of `text` has no letter {letter:?}"));
        }
        if Self::general(args).is_empty() { Err("`text` of `text` shows nothing".into()) } else { Ok(()) }
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let align = [Align::Left, Align::Center, Align::Right][args[1] as usize];
        remembered("text", args, || lines(&text_of(&args[BEFORE..]), args[0], args[2], align))
    }
}
