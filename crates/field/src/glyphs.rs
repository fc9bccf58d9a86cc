//! Texts as closed lines: the letters of a font, one after another.
//!
//! Which letters there are and where is settled by a shaping engine, so that kerning, ligatures, accents and joined scripts come
//! out as a reader expects; a line runs in one direction, that of its first letters.

use crate::arcs::Lines;
use crate::fill::{Rule, filled};
use glam::DVec2;
use rustybuzz::ttf_parser::GlyphId;
use rustybuzz::ttf_parser::OutlineBuilder;
use rustybuzz::{Face, UnicodeBuffer};

/// The font that comes along: a part of Noto Sans (SIL Open Font License 1.1, see `assets/OFL.txt`): Latin, Greek and Cyrillic
/// letters.
pub(crate) static NOTO_SANS: &[u8] = include_bytes!("../assets/NotoSans-Regular.ttf");

/// Arcs are within this share of the font size from the curves of letters.
const TOLERANCE: f64 = 2e-4;

/// Where lines of text stand beside the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Center,
    Right,
}

/// A font.
pub(crate) struct Font<'a>(Face<'a>);

impl<'a> Font<'a> {
    /// The font that a file holds, the first one of a collection; `None` if it is none of TrueType or OpenType.
    pub(crate) fn of(contents: &'a [u8]) -> Option<Self> {
        Face::from_slice(contents, 0).map(Self)
    }

    /// The font that comes along.
    pub(crate) fn noto_sans() -> Font<'static> {
        Font::of(NOTO_SANS).expect("the font that comes along is sound")
    }

    /// The first letter of a text that the font does not have.
    pub(crate) fn missing(&self, text: &str) -> Option<char> {
        text.split('\n').find_map(|line| {
            let shaped = self.shaped(line);
            let missing = shaped.glyph_infos().iter().find(|info| info.glyph_id == 0)?;
            line[missing.cluster as usize..].chars().next()
        })
    }

    /// The closed lines of a text, with arguments as those of an outline. `size` is the height of the font; the first baseline is
    /// the x axis, and the next one lies lower by `spacing` times the usual distance.
    pub(crate) fn lines(&self, text: &str, size: f64, spacing: f64, align: Align) -> Vec<f64> {
        let scale = size / f64::from(self.0.units_per_em());
        let leading = spacing * scale * (f64::from(self.0.height()) + f64::from(self.0.line_gap()));
        let mut letters = Vec::new();
        for (number, line) in text.split('\n').enumerate() {
            let shaped = self.shaped(line);
            let width: f64 = shaped.glyph_positions().iter().map(|place| f64::from(place.x_advance)).sum();
            let mut at = match align {
                Align::Left => 0.0,
                Align::Center => -width / 2.0,
                Align::Right => -width,
            };
            for (info, place) in shaped.glyph_infos().iter().zip(shaped.glyph_positions()) {
                let own = DVec2::new(at + f64::from(place.x_offset), place.y_offset.into()) * scale;
                let origin = own - DVec2::Y * (leading * number as f64);
                let mut pen = Pen { lines: Lines::new(size * TOLERANCE), origin, scale };
                self.0.outline_glyph(GlyphId(info.glyph_id as u16), &mut pen);
                letters.extend(pen.lines.finish());
                at += f64::from(place.x_advance);
            }
        }
        // Parts of a letter may overlap, and so may letters that are joined.
        filled(&letters, Rule::NonZero, size * TOLERANCE)
    }

    /// The letters of a line and their places.
    fn shaped(&self, line: &str) -> rustybuzz::GlyphBuffer {
        let mut buffer = UnicodeBuffer::new();
        buffer.push_str(line);
        buffer.guess_segment_properties();
        rustybuzz::shape(&self.0, &[], buffer)
    }
}

/// Draws a letter.
struct Pen {
    lines: Lines,
    origin: DVec2,
    scale: f64,
}

impl Pen {
    fn point(&self, x: f32, y: f32) -> DVec2 {
        self.origin + DVec2::new(x.into(), y.into()) * self.scale
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.lines.move_to(self.point(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.lines.line_to(self.point(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.lines.quadratic_to(self.point(x1, y1), self.point(x, y));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.lines.cubic_to(self.point(x1, y1), self.point(x2, y2), self.point(x, y));
    }

    fn close(&mut self) {
        self.lines.close();
    }
}
