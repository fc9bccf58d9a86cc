//! Text: the letters of a font as a plane figure. Their curves become arcs within a tolerance; the distance from these is exact.

use super::outline::{OUTLINE, Outline};
use super::svg_path::text_of;
use crate::glyphs::{Align, Font};
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`text`].
#[derive(Clone, Copy, Debug)]
pub struct Text;

/// The descriptor of [`text`].
pub static TEXT: Shape = Shape::special::<Text>().with_file(FileParam {
    name: "font",
    about: "A font, TrueType or OpenType, instead of Noto Sans.",
    build: in_font,
});

/// A text in letters of this size, that is, of lines of this height. Its first baseline begins at the origin and leads along x;
/// `\n` begins another line below. `with("align", ...)` centres lines on the y axis, or ends them there.
#[track_caller]
pub fn text(size: impl Into<Value>, text: &str) -> Form<Text> {
    let characters = text.chars().map(|c| Value::from(u32::from(c)));
    Form::new(&TEXT, [size.into(), 0.into(), 1.into()].into_iter().chain(characters))
}

impl Form<Text> {
    /// The text in another font, given as the contents of its file (TrueType or OpenType; of a collection the first).
    ///
    /// # Errors
    /// What is wrong with the font, the text, or both together.
    #[track_caller]
    pub fn in_font(self, contents: &[u8]) -> Result<Form<Outline>, String> {
        let lines = lines_in(&Field::from(self).node().numbers(), contents)?;
        Ok(Form::new(&OUTLINE, lines.into_iter().map(Value::from)))
    }
}

/// See [`FileParam::build`].
fn in_font(args: &[f64], contents: &[u8]) -> Result<Field, String> {
    Ok(Form::<Outline>::new(&OUTLINE, lines_in(args, contents)?.into_iter().map(Value::from)).into())
}

/// The closed lines of a text in the font that a file holds.
fn lines_in(args: &[f64], contents: &[u8]) -> Result<Vec<f64>, String> {
    let font = Font::of(contents).ok_or("`font` of `text` is no TrueType or OpenType font")?;
    lettered(&font, args)
}

/// The closed lines of a text.
fn lettered(font: &Font<'_>, args: &[f64]) -> Result<Vec<f64>, String> {
    let text = text_of(&args[BEFORE..]);
    if let Some(letter) = font.missing(&text) {
        return Err(format!("the font of `text` has no letter {letter:?}"));
    }
    let align = [Align::Left, Align::Center, Align::Right][args[1] as usize];
    let lines = font.lines(&text, args[0], args[2], align);
    if lines.is_empty() { Err("`text` of `text` shows nothing".into()) } else { Ok(lines) }
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
        if !Self::general(args).is_empty() {
            return Ok(());
        }
        lettered(&Font::noto_sans(), args).map(|_| ())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("text", args, || lettered(&Font::noto_sans(), args).unwrap_or_default())
    }
}
