//! Text over the picture: a panel of lines, drawn on the CPU only when it changes.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// The letters' height.
const LETTERS: RasterHeight = RasterHeight::Size16;

/// From the top of one line to the top of the next.
const LINE: u32 = 18;

/// From the edge of the panel to the text.
const MARGIN: u32 = 8;

/// The panel behind the letters, of 255: dark, and half transparent.
const PANEL: [u8; 4] = [12, 14, 18, 176];

/// A drawn text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Panel {
    /// Pixels in a row.
    pub(crate) width: u32,
    /// Rows.
    pub(crate) height: u32,
    /// Red, green, blue and opacity of each pixel, in sRGB, not multiplied.
    pub(crate) pixels: Vec<[u8; 4]>,
}

/// The colour of a line of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ink {
    /// What one wants to read.
    Plain,
    /// What went wrong.
    Alarm,
}

impl Ink {
    fn color(self) -> [u8; 3] {
        match self {
            Self::Plain => [235, 238, 240],
            Self::Alarm => [255, 140, 110],
        }
    }
}

/// Draws lines of text, cut where they would be wider than `most` pixels. No lines give an empty panel.
pub(crate) fn panel(lines: &[(Ink, String)], most: u32) -> Panel {
    let advance = get_raster_width(FontWeight::Regular, LETTERS) as u32;
    let room = (most.saturating_sub(2 * MARGIN) / advance) as usize;
    let longest = lines.iter().map(|(_, text)| text.chars().count().min(room)).max().unwrap_or(0);
    if longest == 0 {
        return Panel { width: 0, height: 0, pixels: Vec::new() };
    }
    let width = longest as u32 * advance + 2 * MARGIN;
    let height = lines.len() as u32 * LINE + 2 * MARGIN;
    let mut panel = Panel { width, height, pixels: vec![PANEL; (width * height) as usize] };
    for (line, (ink, text)) in (0..).zip(lines) {
        for (column, letter) in (0..room as u32).zip(text.chars()) {
            panel.write(letter, MARGIN + column * advance, MARGIN + line * LINE, *ink);
        }
    }
    panel
}

impl Panel {
    /// Letters that the font does not have are shown as question marks.
    fn write(&mut self, letter: char, x: u32, y: u32, ink: Ink) {
        let raster = |letter| get_raster(letter, FontWeight::Regular, LETTERS);
        let Some(letter) = raster(letter).or_else(|| raster('?')) else {
            return;
        };
        for (row, line) in (y..).zip(letter.rows()) {
            for (column, &cover) in (x..).zip(line) {
                if column < self.width && row < self.height {
                    let pixel = &mut self.pixels[(row * self.width + column) as usize];
                    let blend = |under: u8, over: u8| {
                        let [under, over, cover] = [under, over, cover].map(u32::from);
                        ((under * (255 - cover) + over * cover + 127) / 255) as u8
                    };
                    let [red, green, blue] = ink.color();
                    for (channel, over) in pixel.iter_mut().zip([red, green, blue, 255]) {
                        *channel = blend(*channel, over);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(texts: &[&str]) -> Vec<(Ink, String)> {
        texts.iter().map(|text| (Ink::Plain, (*text).to_owned())).collect()
    }

    #[test]
    fn a_panel_holds_its_lines() {
        let advance = get_raster_width(FontWeight::Regular, LETTERS) as u32;
        let panel = panel(&lines(&["frame 12 ms", "long line of text"]), 1000);
        assert_eq!((panel.width, panel.height), (17 * advance + 2 * MARGIN, 2 * LINE + 2 * MARGIN));
        assert_eq!(panel.pixels.len(), (panel.width * panel.height) as usize);
        let rows: Vec<usize> = panel
            .pixels
            .chunks(panel.width as usize)
            .map(|row| row.iter().filter(|&&pixel| pixel != PANEL).count())
            .collect();
        assert!(rows[..MARGIN as usize].iter().all(|&count| count == 0), "the margin is empty");
        assert!(rows[MARGIN as usize..(MARGIN + LINE) as usize].iter().sum::<usize>() > 50);
        assert!(rows[(MARGIN + LINE) as usize..].iter().sum::<usize>() > 50);
    }

    #[test]
    fn long_lines_are_cut_and_nothing_is_drawn_for_nothing() {
        let panel = panel(&lines(&["a line that is far too long for this window"]), 100);
        assert!(panel.width <= 100 && panel.width > 80, "{}", panel.width);
        for empty in [super::panel(&[], 100), super::panel(&lines(&[""]), 100), super::panel(&lines(&["text"]), 3)] {
            assert_eq!((empty.width, empty.height), (0, 0));
        }
    }

    #[test]
    fn foreign_letters_become_question_marks_and_alarms_have_a_colour_of_their_own() {
        assert_eq!(panel(&lines(&["\u{1f600}"]), 100), panel(&lines(&["?"]), 100));
        let alarm = panel(&[(Ink::Alarm, "x".into())], 100);
        assert_ne!(alarm, panel(&lines(&["x"]), 100));
    }
}
