//! The notation of formulas: a text. Mistakes are placed inside it.

use crate::notation::Notation;
use crate::reader::{Reader, span};
use crate::schema::Definitions;
use crate::syntax::Written;
use freikugel_field::Formula;
use serde_json::{Value as Json, json};

/// The notation of a formula in x, y and z, in which names of the scene's parameters and the time may stand.
pub(crate) struct FormulaNotation;

impl Notation<Formula> for FormulaNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Formula> {
        let Written::StringLit(text) = value else {
            let hint = "for instance \"x^2 + y^2 + z^2 - 1\"";
            reader.mistyped(value, "a formula, as a text", Some(hint.into()));
            return None;
        };
        match Formula::parse_with(&text.value, reader.names.known()) {
            Ok(formula) => {
                reader.names.note(formula.names());
                Some(formula)
            }
            Err(fault) => {
                let whole = span(value);
                // With escapes in the text, places in it are not those in the file.
                let is_verbatim = text.value.len() + 2 == whole.len();
                let place = match is_verbatim {
                    true => whole.start + 1 + fault.span.start..whole.start + 1 + fault.span.end,
                    false => whole,
                };
                reader.error(place, fault.message, fault.hint);
                None
            }
        }
    }

    fn write(&self, value: &Formula) -> Option<Json> {
        Some(json!(value.text()))
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        json!({ "type": "string", "minLength": 1 })
    }
}

/// The number that a formula without coordinates is.
pub(crate) fn computed(reader: &mut Reader, value: &Written<'_>) -> Option<f64> {
    let formula = FormulaNotation.read(reader, value)?;
    let number = formula.constant();
    if number.is_none() {
        let message = format!("{} is one number, which can't depend on x, y or z", reader.label());
        reader.error(span(value), message, Some("parameters of the scene and the time `t` may stand here".into()));
    }
    number
}
