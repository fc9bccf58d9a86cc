//! Contact sheets: pictures beside each other, with labels.
//!
//! Letters are those of Noto Sans Mono (SIL Open Font License 1.1), which come drawn in advance.

use super::Failure;
use freikugel::render::{Image, Tone};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use std::path::Path;

/// Red, green and blue in sRGB.
pub(super) type Color = [u8; 3];

const PAPER: Color = [250, 249, 246];
const INK: Color = [32, 33, 36];

/// What surrounds the sheet, and what separates its parts.
const MARGIN: u32 = 14;
const GAP: u32 = 10;

const HEADING: Font = Font { height: RasterHeight::Size20, line: 26 };
const TEXT: Font = Font { height: RasterHeight::Size16, line: 19 };

/// A picture in sRGB.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bitmap {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Row by row from the top.
    pub(super) pixels: Vec<Color>,
}

/// A picture on a sheet, and the lines below it.
#[derive(Clone, Debug)]
pub(super) struct Tile {
    pub(super) picture: Bitmap,
    pub(super) caption: Vec<String>,
}

/// A contact sheet. Empty labels take no room.
#[derive(Clone, Debug, Default)]
pub(super) struct Sheet {
    pub(super) title: String,
    /// Colours and what they mean; each list is a line.
    pub(super) legend: Vec<Vec<(Color, String)>>,
    /// What stands above each column.
    pub(super) columns: Vec<String>,
    /// The tiles, and what stands to the left of each row.
    pub(super) rows: Vec<(String, Vec<Tile>)>,
}

struct Font {
    height: RasterHeight,
    /// From line to line.
    line: u32,
}

impl Bitmap {
    /// A picture of one colour.
    pub(super) fn filled(width: u32, height: u32, color: Color) -> Self {
        Self { width, height, pixels: vec![color; width as usize * height as usize] }
    }

    /// A rendered picture as its file would show it.
    pub(super) fn of(image: &Image, tone: &Tone) -> Self {
        let pixels = image.to_srgb8(tone).chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Self { width: image.width(), height: image.height(), pixels }
    }

    /// The picture in a PNG file with three channels of 8 bits.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let fault = |error: &dyn std::fmt::Display| Failure::Input(format!("can't read {}: {error}", path.display()));
        let file = std::fs::File::open(path).map_err(|error| fault(&error))?;
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().map_err(|error| fault(&error))?;
        let (width, height) = (reader.info().width, reader.info().height);
        let mut pixels = vec![[0; 3]; width as usize * height as usize];
        if reader.output_buffer_size() != Some(pixels.as_flattened().len()) {
            return Err(fault(&"it is no picture of three channels of 8 bits"));
        }
        reader.next_frame(pixels.as_flattened_mut()).map_err(|error| fault(&error))?;
        Ok(Self { width, height, pixels })
    }

    /// The picture as a PNG file, as small as can be: sheets are kept and shown more often than they are made.
    pub(super) fn encode(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()?;
        Ok(file)
    }

    /// Puts another picture on it.
    fn put(&mut self, other: &Self, x: u32, y: u32) {
        for (row, line) in other.pixels.chunks_exact(other.width as usize).enumerate() {
            let start = (y as usize + row) * self.width as usize + x as usize;
            self.pixels[start..start + line.len()].copy_from_slice(line);
        }
    }

    /// Writes a line of text with its upper left corner at a place. What does not fit in is left out.
    fn write(&mut self, text: &str, font: &Font, x: u32, y: u32) {
        let advance = font.advance();
        for (index, c) in text.chars().enumerate() {
            let raster = get_raster(c, FontWeight::Regular, font.height);
            let Some(raster) = raster.or_else(|| get_raster('?', FontWeight::Regular, font.height)) else { continue };
            let left = x + index as u32 * advance;
            for (row, line) in raster.rows().enumerate() {
                for (column, &ink) in line.iter().enumerate() {
                    let (x, y) = (left + column as u32, y + row as u32);
                    if x < self.width && y < self.height {
                        let pixel = &mut self.pixels[(y * self.width + x) as usize];
                        *pixel = std::array::from_fn(|channel| blend(pixel[channel], INK[channel], ink));
                    }
                }
            }
        }
    }
}

fn blend(under: u8, over: u8, share: u8) -> u8 {
    let (under, over, share) = (u32::from(under), u32::from(over), u32::from(share));
    ((under * (255 - share) + over * share + 127) / 255) as u8
}

impl Font {
    /// From letter to letter.
    fn advance(&self) -> u32 {
        get_raster_width(FontWeight::Regular, self.height) as u32
    }

    fn width(&self, text: &str) -> u32 {
        text.chars().count() as u32 * self.advance()
    }

    /// The text, cut to a width.
    fn fitted(&self, text: &str, width: u32) -> String {
        if self.width(text) <= width {
            return text.into();
        }
        let letters = (width / self.advance()) as usize;
        text.chars().take(letters.saturating_sub(2)).chain("..".chars()).collect()
    }
}

/// Text in lines that fit under a tile of some width, broken between words.
pub(super) fn wrapped(text: &str, width: u32) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("there is a line");
        if line.is_empty() {
            line.push_str(word);
        } else if TEXT.width(line) + TEXT.advance() + TEXT.width(word) <= width {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.into());
        }
    }
    lines
}

impl Sheet {
    /// Draws the sheet.
    pub(super) fn draw(&self) -> Bitmap {
        let tiles = || self.rows.iter().flat_map(|(_, tiles)| tiles);
        let tile_width = tiles().map(|tile| tile.picture.width).max().unwrap_or(0);
        let count = self.rows.iter().map(|(_, tiles)| tiles.len()).max().unwrap_or(0) as u32;
        let gutter = self.rows.iter().map(|(label, _)| TEXT.width(label)).max().unwrap_or(0);
        let left = MARGIN + if gutter > 0 { gutter + GAP } else { 0 };
        let tiles_end = left + count * (tile_width + GAP) - GAP.min(count * GAP);
        let legend_width = |line: &Vec<(Color, String)>| line.iter().map(|(_, text)| swatch_width(text)).sum::<u32>();
        let legend_end = MARGIN + self.legend.iter().map(legend_width).max().unwrap_or(0);
        let width = tiles_end.max(legend_end).max(MARGIN + HEADING.width(&self.title)) + MARGIN;

        let row_height = |tiles: &[Tile]| {
            let height = |tile: &Tile| {
                let lines = tile.caption.len() as u32;
                tile.picture.height + if lines > 0 { GAP / 2 + lines * TEXT.line } else { 0 }
            };
            tiles.iter().map(height).max().unwrap_or(0) + GAP
        };
        let title = if self.title.is_empty() { 0 } else { HEADING.line };
        let legend = self.legend.len() as u32 * TEXT.line + if self.legend.is_empty() { 0 } else { GAP };
        let columns = if self.columns.is_empty() { 0 } else { TEXT.line + GAP / 2 };
        let rows: u32 = self.rows.iter().map(|(_, tiles)| row_height(tiles)).sum();
        let height = MARGIN + title + GAP / 2 + legend + columns + rows + MARGIN - GAP;
        let mut sheet = Bitmap::filled(width, height, PAPER);

        let mut y = MARGIN;
        sheet.write(&self.title, &HEADING, MARGIN, y);
        y += title + GAP / 2;
        for line in &self.legend {
            let mut x = MARGIN;
            for (color, text) in line {
                let side = TEXT.line - 6;
                sheet.put(&Bitmap::filled(side, side, INK), x, y + 2);
                sheet.put(&Bitmap::filled(side - 2, side - 2, *color), x + 1, y + 3);
                sheet.write(text, &TEXT, x + side + GAP / 2, y);
                x += swatch_width(text);
            }
            y += TEXT.line;
        }
        y += if self.legend.is_empty() { 0 } else { GAP };
        let place = |column: usize| left + column as u32 * (tile_width + GAP);
        for (column, label) in self.columns.iter().enumerate() {
            let label = TEXT.fitted(label, tile_width);
            sheet.write(&label, &TEXT, place(column) + (tile_width - TEXT.width(&label)) / 2, y);
        }
        y += columns;
        for (label, tiles) in &self.rows {
            let tallest = tiles.iter().map(|tile| tile.picture.height).max().unwrap_or(0);
            sheet.write(label, &TEXT, MARGIN, y + tallest.saturating_sub(TEXT.line) / 2);
            for (column, Tile { picture, caption }) in tiles.iter().enumerate() {
                sheet.put(picture, place(column), y);
                for (line, text) in caption.iter().enumerate() {
                    let text = TEXT.fitted(text, tile_width);
                    sheet.write(&text, &TEXT, place(column), y + tallest + GAP / 2 + line as u32 * TEXT.line);
                }
            }
            y += row_height(tiles);
        }
        sheet
    }
}

/// The room that an entry of a legend takes.
fn swatch_width(text: &str) -> u32 {
    TEXT.line - 6 + GAP / 2 + TEXT.width(text) + 2 * GAP
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(width: u32, height: u32, caption: &[&str]) -> Tile {
        let caption = caption.iter().map(ToString::to_string).collect();
        Tile { picture: Bitmap::filled(width, height, [10, 200, 30]), caption }
    }

    #[test]
    fn tiles_stand_beside_and_below_each_other() {
        let row = |label: &str| (label.to_string(), vec![tile(40, 30, &[]), tile(40, 30, &[]), tile(40, 30, &[])]);
        let sheet = Sheet { rows: vec![row(""), row("")], ..Sheet::default() }.draw();
        assert_eq!(sheet.width, 2 * MARGIN + 3 * 40 + 2 * GAP);
        assert_eq!(sheet.height, 2 * MARGIN + GAP / 2 + 2 * 30 + GAP);
        let green = sheet.pixels.iter().filter(|&&pixel| pixel == [10, 200, 30]).count();
        assert_eq!(green, 6 * 40 * 30, "no tile covers another one");
    }

    #[test]
    fn labels_are_written_and_make_room() {
        let bare = Sheet { rows: vec![(String::new(), vec![tile(80, 30, &[])])], ..Sheet::default() };
        let labelled = Sheet {
            title: "title".into(),
            legend: vec![vec![([255, 0, 0], "bad".into())]],
            columns: vec!["column".into()],
            rows: vec![("row".into(), vec![tile(80, 30, &["one", "two lines"])])],
        };
        let (bare, labelled) = (bare.draw(), labelled.draw());
        assert_eq!(labelled.width, bare.width + 3 * TEXT.advance() + GAP);
        assert!(labelled.height > bare.height + 4 * TEXT.line);
        // Edges are soft: few pixels are all ink.
        let is_ink = |pixel: &&Color| pixel.iter().all(|&channel| channel < 128);
        assert_eq!(bare.pixels.iter().filter(is_ink).count(), 0);
        assert!(labelled.pixels.iter().filter(is_ink).count() > 100);
        assert_eq!(
            labelled.pixels.iter().filter(|&&pixel| pixel == [10, 200, 30]).count(),
            80 * 30,
            "text covers no tile"
        );
    }

    #[test]
    fn text_fits() {
        assert_eq!(TEXT.fitted("max_steps = 5", 1000), "max_steps = 5");
        let cut = TEXT.fitted("max_steps = 5", 60);
        assert!(TEXT.width(&cut) <= 60 && cut.ends_with(".."), "{cut}");
        for line in wrapped("nothing says how far a step may go here", 100) {
            assert!(TEXT.width(&line) <= 100, "{line}");
        }
    }

    #[test]
    fn a_picture_survives_its_file() {
        let mut bitmap = Bitmap::filled(16, 16, [0; 3]);
        for (index, pixel) in bitmap.pixels.iter_mut().enumerate() {
            *pixel = [index as u8, 255 - index as u8, 7];
        }
        let file = bitmap.encode().expect("a file");
        let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().expect("a PNG");
        let mut bytes = vec![0; 16 * 16 * 3];
        reader.next_frame(&mut bytes).expect("pixels");
        assert_eq!(bytes, bitmap.pixels.concat());
    }
}
