//! Pictures of linear colours, and how they become bytes: exposure, what is brighter than white, sRGB.

use freikugel_scene::color::linear;
use freikugel_scene::{Overbright, Picture};
use std::sync::LazyLock;

/// Linear Rec. 709 colours, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 3]>,
}

/// From scene light to the range of a display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Stops: each doubles the light.
    pub exposure: f32,
    /// What happens to what is brighter than white.
    pub overbright: Overbright,
}

impl Image {
    /// A picture.
    ///
    /// # Panics
    /// If there are not `width` times `height` pixels.
    pub fn new(width: u32, height: u32, pixels: Vec<[f32; 3]>) -> Self {
        assert_eq!(u64::from(width) * u64::from(height), pixels.len() as u64, "one colour for each pixel");
        Self { width, height, pixels }
    }

    /// Pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The colours, row by row from the top.
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }

    /// The colour in column `x` of row `y`.
    ///
    /// # Panics
    /// If that lies outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> [f32; 3] {
        assert!(x < self.width && y < self.height, "({x}, {y}) is outside");
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The picture in sRGB, three bytes for each pixel.
    pub fn to_srgb8(&self, tone: &Tone) -> Vec<u8> {
        let gain = libm::exp2f(tone.exposure);
        let encoder = &*ENCODER;
        self.pixels
            .iter()
            .flat_map(|pixel| {
                let mut pixel = pixel.map(|channel| channel * gain);
                let brightest = pixel[0].max(pixel[1]).max(pixel[2]);
                if tone.overbright == Overbright::ScaleDown && brightest > 1.0 {
                    // Infinite light has no hue left to keep.
                    pixel = pixel.map(|channel| if brightest < f32::INFINITY { channel / brightest } else { 1.0 });
                }
                pixel.map(|channel| encoder.encode(channel))
            })
            .collect()
    }
}

impl Tone {
    /// What the scene's picture asks for.
    pub fn of(picture: &Picture) -> Self {
        Self { exposure: picture.exposure, overbright: picture.overbright }
    }
}

impl Default for Tone {
    fn default() -> Self {
        Self { exposure: 0.0, overbright: Overbright::Clamp }
    }
}

/// The sRGB byte nearest to a linear value; values outside 0 to 1 are clamped, and what is no number is 0.
pub fn srgb_encode8(linear: f32) -> u8 {
    ENCODER.encode(linear)
}

/// Entries of the encoder's table. sRGB rises by at most 12.92 * 255 codes per unit, so a cell of this size holds at
/// most one border between two codes.
const CELLS: usize = 4096;

/// Encodes without computing a power: a table gives the code at the start of a cell, one comparison the rest.
struct Encoder {
    /// The code of the smallest value in each cell.
    codes: [u8; CELLS + 1],
    /// The smallest value that is rounded to the code after each; infinite for the last.
    borders: [f32; 256],
}

static ENCODER: LazyLock<Encoder> = LazyLock::new(|| {
    let mut borders = [f32::INFINITY; 256];
    for (code, border) in borders[..255].iter_mut().enumerate() {
        let exact = linear((code as f64 + 0.5) / 255.0);
        let nearest = exact as f32;
        *border = if f64::from(nearest) < exact { nearest.next_up() } else { nearest };
    }
    let mut codes = [0; CELLS + 1];
    for (cell, code) in codes.iter_mut().enumerate() {
        let start = cell as f32 / CELLS as f32;
        *code = borders.partition_point(|&border| border <= start) as u8;
    }
    Encoder { codes, borders }
});

impl Encoder {
    #[inline]
    fn encode(&self, linear: f32) -> u8 {
        // Written so that what is no number becomes 0.
        let linear = if linear > 0.0 { linear.min(1.0) } else { 0.0 };
        let code = self.codes[(linear * CELLS as f32) as usize];
        code + u8::from(linear >= self.borders[usize::from(code)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The formula, rounded to the nearest code.
    fn reference(linear: f32) -> u8 {
        let linear = f64::from(linear).clamp(0.0, 1.0);
        let encoded = if linear <= 0.0031308 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
        (encoded * 255.0).round() as u8
    }

    #[test]
    fn every_code_survives_decoding_and_encoding() {
        for code in 0..=255u8 {
            assert_eq!(srgb_encode8(linear(f64::from(code) / 255.0) as f32), code);
        }
    }

    #[test]
    fn encoding_is_the_rounded_formula() {
        for step in 0..1_000_000 {
            let linear = step as f32 / 999_999.0;
            assert_eq!(srgb_encode8(linear), reference(linear), "{linear}");
        }
        // On either side of each border, as near as single precision comes.
        for &border in &ENCODER.borders[..255] {
            assert_eq!(srgb_encode8(border) - srgb_encode8(border.next_down()), 1, "{border}");
        }
        let odd = [-1.0, -0.0, f32::NAN, 2.0, f32::INFINITY, f32::NEG_INFINITY, 1e-40];
        assert_eq!(odd.map(srgb_encode8), [0, 0, 0, 255, 255, 0, 0]);
    }

    #[test]
    fn exposure_doubles_and_overbright_pixels_keep_their_hue() {
        let image = Image::new(3, 1, vec![[0.1, 0.2, 0.4], [1.0, 2.0, 4.0], [f32::INFINITY, 0.0, 0.0]]);
        let bytes = |exposure, overbright| image.to_srgb8(&Tone { exposure, overbright });
        let codes = |values: [f32; 3]| values.map(srgb_encode8);
        let clamped = bytes(1.0, Overbright::Clamp);
        assert_eq!(clamped[..3], codes([0.2, 0.4, 0.8]));
        assert_eq!(clamped[3..6], [255; 3]);
        let scaled = bytes(1.0, Overbright::ScaleDown);
        assert_eq!(scaled[..3], codes([0.2, 0.4, 0.8]));
        assert_eq!(scaled[3..6], codes([0.25, 0.5, 1.0]));
        assert_eq!(scaled[6..], [255; 3]);
    }
}
