//! Numbers in a range, and truth values.

use super::{Notation, keyframes};
use crate::reader::Reader;
use crate::schema::Definitions;
use crate::syntax::Written;
use serde_json::{Value as Json, json};

/// A number in a range, in the unit of files.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Number {
    least: Option<f64>,
    above: Option<f64>,
    most: Option<f64>,
    below: Option<f64>,
    unit: Unit,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Unit {
    Plain,
    /// Degrees in files, radians inside.
    Degrees,
}

impl Number {
    /// Any finite number.
    pub(crate) const ANY: Self = Self { least: None, above: None, most: None, below: None, unit: Unit::Plain };

    pub(crate) const fn at_least(self, least: f64) -> Self {
        Self { least: Some(least), ..self }
    }

    pub(crate) const fn above(self, above: f64) -> Self {
        Self { above: Some(above), ..self }
    }

    pub(crate) const fn at_most(self, most: f64) -> Self {
        Self { most: Some(most), ..self }
    }

    pub(crate) const fn below(self, below: f64) -> Self {
        Self { below: Some(below), ..self }
    }

    /// The same range, in degrees.
    pub(crate) const fn degrees(self) -> Self {
        Self { unit: Unit::Degrees, ..self }
    }

    /// Why a number, in the unit of files, is out of range.
    fn misplaced(&self, number: f64) -> Option<String> {
        let unit = if self.unit == Unit::Degrees { " degrees" } else { "" };
        let wanted = if !number.is_finite() {
            return Some("must be a finite number".into());
        } else if let Some(least) = self.least.filter(|&least| number < least) {
            if least == 0.0 { "not be negative".into() } else { format!("be at least {}{unit}", shown(least)) }
        } else if let Some(above) = self.above.filter(|&above| number <= above) {
            format!("be above {}{unit}", shown(above))
        } else if let Some(most) = self.most.filter(|&most| number > most) {
            format!("be at most {}{unit}", shown(most))
        } else {
            format!("be below {}{unit}", shown(self.below.filter(|&below| number >= below)?))
        };
        Some(format!("must {wanted}, but is {}", shown(number)))
    }

    fn describe(&self, kind: &str) -> Json {
        let mut schema = json!({ "type": [kind, "string"] });
        // What formulas and keyframes come to is known when they are computed.
        let bounds = [
            ("minimum", self.least),
            ("exclusiveMinimum", self.above),
            ("maximum", self.most),
            ("exclusiveMaximum", self.below),
        ];
        for (key, bound) in bounds {
            if let Some(bound) = bound {
                schema[key] = tidy(bound);
            }
        }
        json!({ "anyOf": [schema, keyframes::reference(1)] })
    }
}

impl Notation<f64> for Number {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<f64> {
        let number = reader.number(value)?;
        let number = reader.sound(value, number, self.misplaced(number))?;
        Some(if self.unit == Unit::Degrees { number.to_radians() } else { number })
    }

    fn fault(&self, value: &f64) -> Option<String> {
        self.misplaced(if self.unit == Unit::Degrees { rounded_degrees(*value) } else { *value })
    }

    fn write(&self, value: &f64) -> Option<Json> {
        Some(tidy(if self.unit == Unit::Degrees { rounded_degrees(*value) } else { *value }))
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        self.describe("number")
    }
}

impl Notation<f32> for Number {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<f32> {
        let number: f64 = self.read(reader, value)?;
        let narrow = number as f32;
        let fault = narrow.is_infinite().then(|| format!("is too large: it can be up to {:e}", f32::MAX));
        reader.sound(value, narrow, fault)
    }

    fn fault(&self, value: &f32) -> Option<String> {
        self.misplaced(f64::from(*value))
    }

    fn write(&self, value: &f32) -> Option<Json> {
        Some(tidy_f32(*value))
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        self.describe("number")
    }
}

impl Notation<u32> for Number {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<u32> {
        let number: f64 = self.read(reader, value)?;
        let fault = (number.fract() != 0.0 || !(0.0..=f64::from(u32::MAX)).contains(&number))
            .then(|| format!("must be a whole number, but is {}", shown(number)));
        reader.sound(value, number as u32, fault)
    }

    fn fault(&self, value: &u32) -> Option<String> {
        self.misplaced(f64::from(*value))
    }

    fn write(&self, value: &u32) -> Option<Json> {
        Some(json!(value))
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        self.describe("integer")
    }
}

/// The schema of a number, or a formula for one.
pub(crate) fn formula_or_number_schema() -> Json {
    json!({ "type": ["number", "string"] })
}

/// The schema of a number, for which a formula or keyframes may stand.
pub(crate) fn number_schema() -> Json {
    number_schema_with(json!({}))
}

/// The same with more keys, which hold for numbers.
pub(crate) fn number_schema_with(keys: Json) -> Json {
    let mut schema = formula_or_number_schema();
    if let (Some(schema), Json::Object(keys)) = (schema.as_object_mut(), keys) {
        schema.extend(keys);
    }
    json!({ "anyOf": [schema, keyframes::reference(1)] })
}

/// The schema of a whole number in a range, for which a formula or keyframes may stand.
pub(crate) fn count_schema(least: impl Into<Json>, most: impl Into<Json>) -> Json {
    let number = json!({ "type": ["integer", "string"], "minimum": least.into(), "maximum": most.into() });
    json!({ "anyOf": [number, keyframes::reference(1)] })
}

/// Degrees without the noise of the conversion: nobody writes more than nine decimals of a degree.
fn rounded_degrees(radians: f64) -> f64 {
    let degrees = radians.to_degrees();
    let rounded = (degrees * 1e9).round() / 1e9;
    if rounded.is_finite() { rounded } else { degrees }
}

/// A number in JSON, whole ones without a point.
pub(crate) fn tidy(number: f64) -> Json {
    // Up to here every whole number is told apart from its neighbours.
    let is_whole = number.fract() == 0.0 && number.abs() < 9e15;
    if is_whole { json!(number as i64) } else { json!(number) }
}

/// An angle in degrees in JSON.
pub(crate) fn tidy_degrees(radians: f64) -> Json {
    tidy(rounded_degrees(radians))
}

/// The shortest decimal that stands for the same `f32`.
pub(crate) fn tidy_f32(number: f32) -> Json {
    tidy(number.to_string().parse().unwrap_or(f64::from(number)))
}

/// A number in a message: short, whatever its size.
pub(crate) fn shown(number: f64) -> String {
    if number != 0.0 && !(1e-4..1e10).contains(&number.abs()) { format!("{number:e}") } else { number.to_string() }
}

/// `true` or `false`.
#[derive(Debug)]
pub(crate) struct Flag;

impl Notation<bool> for Flag {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<bool> {
        let Written::BooleanLit(literal) = value else {
            reader.mistyped(value, "`true` or `false`", None);
            return None;
        };
        Some(literal.value)
    }

    fn write(&self, value: &bool) -> Option<Json> {
        Some(json!(value))
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        json!({ "type": "boolean" })
    }
}
