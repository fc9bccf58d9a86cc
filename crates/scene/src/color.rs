//! Colours: linear Rec. 709 inside, sRGB where people write them.

use crate::Argument;
use crate::notation::{Notation, number_schema_with, tidy_f32};
use crate::reader::{Reader, span};
use crate::schema::Definitions;
use crate::suggest::quote;
use crate::syntax::Written;
use serde_json::{Value as Json, json};

/// A colour as shares of linear light: red, green and blue of Rec. 709 (the primaries of sRGB).
pub type Rgb = [f32; 3];

/// All of the light.
pub const WHITE: Rgb = [1.0; 3];

/// No light.
pub const BLACK: Rgb = [0.0; 3];

/// The colour that `#rrggbb` or `#rgb` names in sRGB.
///
/// ```
/// use freikugel_scene::color::{WHITE, from_hex};
///
/// assert_eq!(from_hex("#ffffff"), Some(WHITE));
/// assert_eq!(from_hex("#fff"), Some(WHITE));
/// assert_eq!(from_hex("white"), None);
/// ```
pub fn from_hex(text: &str) -> Option<Rgb> {
    let digits = text.strip_prefix('#')?;
    // Guards the slices below against signs and characters of several bytes.
    if !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let channel = |index: usize| match digits.len() {
        3 => u8::from_str_radix(&digits[index..index + 1], 16).ok().map(|digit| digit * 0x11),
        6 => u8::from_str_radix(&digits[2 * index..2 * index + 2], 16).ok(),
        _ => None,
    };
    Some([channel(0)?, channel(1)?, channel(2)?].map(|value| linear(f64::from(value) / 255.0) as f32))
}

/// The linear light of an sRGB value in `[0, 1]` (IEC 61966-2-1).
pub fn linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// The notation of colours.
#[derive(Debug)]
pub(crate) struct ColorNotation;

impl Notation<Rgb> for ColorNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Rgb> {
        match value {
            Written::StringLit(text) => {
                let color = from_hex(&text.value);
                if color.is_none() {
                    let message = format!("{} can't be {}", reader.label(), quote(&text.value));
                    reader.error(span(value), message, Some(FORMS.into()));
                }
                color
            }
            Written::Array(_) => {
                let color = reader.numbers(value, ["red", "green", "blue"])?.map(|channel| channel as f32);
                reader.sound(value, color, self.fault(&color))
            }
            _ => {
                reader.mistyped(value, "a colour", Some(FORMS.into()));
                None
            }
        }
    }

    fn fault(&self, value: &Rgb) -> Option<String> {
        if value.iter().all(|channel| channel.is_nan()) {
            return Some(format!("is not a colour: {FORMS}"));
        }
        let is_sound = value.iter().all(|&channel| channel.is_finite() && channel >= 0.0);
        (!is_sound).then(|| "must have finite channels, none of them negative".into())
    }

    fn write(&self, value: &Rgb) -> Option<Json> {
        Some(value.map(tidy_f32).to_vec().into())
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        definitions.define("color", |_| {
            json!({
                "description": "A colour: \"#rrggbb\" or \"#rgb\" in sRGB, or a list of linear red, green and blue.",
                "anyOf": [
                    { "type": "string", "pattern": "^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$" },
                    { "type": "array", "items": number_schema_with(json!({ "minimum": 0 })), "minItems": 3, "maxItems": 3 },
                ],
            })
        })
    }
}

/// The ways to write a colour.
const FORMS: &str = "a colour is \"#rrggbb\" or \"#rgb\", or linear [red, green, blue]";

/// `#rrggbb` or `#rgb`. Any other text makes a colour that [`crate::Scene::check`] reports.
impl Argument<Rgb> for &str {
    fn value(self) -> Rgb {
        from_hex(self).unwrap_or([f32::NAN; 3])
    }
}

#[cfg(test)]
mod tests {
    use super::{from_hex, linear};

    #[test]
    fn hex_colours_are_srgb() {
        // The standard's own figures: mid grey 188 is about half of the light.
        let [half, ..] = from_hex("#bcbcbc").expect("a colour");
        assert!((half - 0.5029).abs() < 1e-4, "{half}");
        assert_eq!(from_hex("#c84"), from_hex("#cc8844"));
        for wrong in ["", "#", "c8825a", "#c8825", "#c8825a00", "#+12345", "#ääa", "#12 456"] {
            assert_eq!(from_hex(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn the_two_pieces_of_the_curve_meet() {
        assert!((linear(0.04045) - linear(0.040_450_01)).abs() < 1e-6);
        assert_eq!(linear(1.0), 1.0);
    }
}
