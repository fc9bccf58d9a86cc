//! Texts as closed lines: the letters of a font, one after another.
//!
//! The font is a part of Noto Sans (SIL Open Font License 1.1, see `assets/OFL.txt`): Latin, Greek and Cyrillic letters.

use crate::arcs::Lines;
use glam::DVec2;
use ttf_parser::gpos::{PairAdjustment, PositioningSubtable};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

static FONT: &[u8] = include_bytes!("../assets/NotoSans-Regular.ttf");

/// Arcs are within this share of the font size from the curves of letters.
const TOLERANCE: f64 = 2e-4;

/// Where lines of text stand beside the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Center,
    Right,
}

/// The font.
fn face() -> Face<'static> {
    Face::parse(FONT, 0).expect("the font that comes along is sound")
}

/// The first letter of a text that the font does not have.
pub(crate) fn missing(text: &str) -> Option<char> {
    let face = face();
    text.chars().find(|&c| c != '\n' && face.glyph_index(c).is_none())
}

/// The closed lines of a text, with arguments as those of an outline. `size` is the height of the font; the first baseline is the x
/// axis, and the next one lies lower by `spacing` times the usual distance.
pub(crate) fn lines(text: &str, size: f64, spacing: f64, align: Align) -> Vec<f64> {
    let face = face();
    let scale = size / f64::from(face.units_per_em());
    let leading = spacing * scale * f64::from(face.height() + face.line_gap());
    let mut pen = Pen { lines: Lines::new(size * TOLERANCE), origin: DVec2::ZERO, scale };
    for (number, line) in text.split('\n').enumerate() {
        let glyphs: Vec<GlyphId> = line.chars().filter_map(|c| face.glyph_index(c)).collect();
        let mut places = Vec::with_capacity(glyphs.len());
        let mut at = 0.0;
        for (index, &glyph) in glyphs.iter().enumerate() {
            if index > 0 {
                at += f64::from(kerning(&face, glyphs[index - 1], glyph));
            }
            places.push(at);
            at += f64::from(face.glyph_hor_advance(glyph).unwrap_or(0));
        }
        let start = match align {
            Align::Left => 0.0,
            Align::Center => -at / 2.0,
            Align::Right => -at,
        };
        for (glyph, place) in glyphs.into_iter().zip(places) {
            pen.origin = DVec2::new((start + place) * scale, -leading * number as f64);
            face.outline_glyph(glyph, &mut pen);
        }
    }
    pen.lines.finish()
}

/// What is added to the advance between two letters.
fn kerning(face: &Face<'_>, left: GlyphId, right: GlyphId) -> i16 {
    let Some(table) = face.tables().gpos else { return 0 };
    let mut sum = 0;
    for lookup in table.lookups {
        let by = lookup.subtables.into_iter::<PositioningSubtable<'_>>().find_map(|subtable| match subtable {
            PositioningSubtable::Pair(PairAdjustment::Format1 { coverage, sets }) => {
                let (first, _) = sets.get(coverage.get(left)?)?.get(right)?;
                Some(first.x_advance)
            }
            PositioningSubtable::Pair(PairAdjustment::Format2 { coverage, classes, matrix }) => {
                coverage.get(left)?;
                let (first, _) = matrix.get((classes.0.get(left), classes.1.get(right)))?;
                Some(first.x_advance)
            }
            _ => None,
        });
        sum += by.unwrap_or(0);
    }
    sum
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
