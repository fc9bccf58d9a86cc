//! Pictures as files: PNG with 8 bits a channel, EXR with the linear colours in single precision.
//!
//! These return bytes. Where they go, and that nothing half-written is left behind, is the caller's concern.

use crate::image::{Image, Tone};
use exr::meta::attribute::Chromaticities;
use exr::prelude::{Encoding, ImageAttributes, Layer, LayerAttributes, SpecificChannels, Text, Vec2, WritableImage};
use std::fmt;
use std::io::Cursor;

/// Why a picture could not be encoded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EncodeError(String);

/// How hard to try to make a file small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// Quickly: in a few milliseconds for a picture of 640 x 360 pixels.
    #[default]
    Quick,
    /// Up to a third smaller, in about ten times the time.
    Thorough,
}

/// A PNG file of the picture in sRGB.
///
/// # Errors
/// If the picture is empty or too large for the format.
pub fn encode_png(image: &Image, tone: &Tone, compression: Compression) -> Result<Vec<u8>, EncodeError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(match compression {
        Compression::Quick => png::Compression::Fast,
        Compression::Thorough => png::Compression::High,
    });
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let fault = |error: png::EncodingError| EncodeError(error.to_string());
    let mut writer = encoder.write_header().map_err(fault)?;
    writer.write_image_data(&image.to_srgb8(tone)).map_err(fault)?;
    writer.finish().map_err(fault)?;
    Ok(file)
}

/// An OpenEXR file of the linear colours, without loss.
///
/// # Errors
/// If the picture is empty or too large for the format.
pub fn encode_exr(image: &Image) -> Result<Vec<u8>, EncodeError> {
    if image.pixels().is_empty() {
        return Err(EncodeError("the picture has no pixels".into()));
    }
    let size = (image.width() as usize, image.height() as usize);
    let colors = |Vec2(x, y): Vec2<usize>| {
        let [r, g, b] = image.pixels()[y * size.0 + x];
        (r, g, b)
    };
    let attributes = LayerAttributes { software_name: Some(Text::from("Freikugel")), ..LayerAttributes::default() };
    let layer = Layer::new(size, attributes, Encoding::FAST_LOSSLESS, SpecificChannels::rgb(colors));
    let mut picture = exr::image::Image::from_layer(layer);
    picture.attributes = ImageAttributes {
        chromaticities: Some(Chromaticities {
            red: Vec2(0.64, 0.33),
            green: Vec2(0.3, 0.6),
            blue: Vec2(0.15, 0.06),
            white: Vec2(0.3127, 0.329),
        }),
        ..picture.attributes
    };
    let mut file = Cursor::new(Vec::new());
    picture.write().non_parallel().to_buffered(&mut file).map_err(|error| EncodeError(error.to_string()))?;
    Ok(file.into_inner())
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the picture can't be encoded: {}", self.0)
    }
}

impl std::error::Error for EncodeError {}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Image {
        let color = |i: u32| [i as f32 * 0.013, 1.5 - i as f32 * 0.01, 1e-3 * i as f32];
        Image::new(7, 5, (0..35).map(color).collect())
    }

    #[test]
    fn a_png_holds_the_srgb_bytes() {
        let tone = Tone { exposure: 0.5, ..Tone::default() };
        let file = encode_png(&picture(), &tone, Compression::Quick).expect("a file");
        let mut reader = png::Decoder::new(Cursor::new(file)).read_info().expect("a PNG");
        assert_eq!((reader.info().width, reader.info().height), (7, 5));
        assert!(reader.info().srgb.is_some());
        let mut bytes = vec![0; 7 * 5 * 3];
        reader.next_frame(&mut bytes).expect("pixels");
        assert_eq!(bytes, picture().to_srgb8(&tone));
    }

    #[test]
    fn an_exr_holds_the_very_numbers() {
        use exr::prelude::*;
        let file = encode_exr(&picture()).expect("a file");
        let read = read()
            .no_deep_data()
            .largest_resolution_level()
            .rgb_channels(
                |size, _| vec![[0.0; 3]; size.area()],
                |pixels: &mut Vec<[f32; 3]>, Vec2(x, y), (r, g, b): (f32, f32, f32)| {
                    pixels[y * 7 + x] = [r, g, b];
                },
            )
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(file))
            .expect("an EXR");
        assert_eq!(read.layer_data.size, Vec2(7, 5));
        assert_eq!(read.layer_data.channel_data.pixels, picture().pixels());
    }

    #[test]
    fn an_empty_picture_is_refused() {
        let empty = Image::new(0, 0, Vec::new());
        assert!(encode_png(&empty, &Tone::default(), Compression::Quick).is_err());
        assert!(encode_exr(&empty).is_err());
    }
}
