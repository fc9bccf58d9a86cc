//! Notations: how values are written in files.
//!
//! A [`Notation`] reads a value, judges it, writes it back, and describes itself as JSON Schema. Each lies beside the
//! type it is for, and is named once, in the declaration of the record that uses it (see [`crate::record`]).

mod choice;
mod formula;
mod keyframes;
mod number;
mod vector;

pub(crate) use choice::{Choice, ChoiceNotation, choice, index_of};
pub(crate) use formula::{FormulaNotation, computed};
pub(crate) use keyframes::{
    are_keyframes, definitions as keyframes_definitions, keyed, reference as keyframes_reference,
};
pub(crate) use number::{
    Flag, Number, count_schema, formula_or_number_schema, number_schema, number_schema_with, tidy, tidy_degrees,
    tidy_f32,
};
pub(crate) use vector::{DIRECTION, POINT, direction_schema, named_direction, numbers_schema};

use crate::reader::Reader;
use crate::schema::Definitions;
use crate::syntax::Written;
use serde_json::{Value as Json, json};

/// How values of type `T` are written in files.
pub(crate) trait Notation<T>: Sync {
    /// The value, or `None` after reporting why there is none.
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<T>;

    /// Why `value` is not allowed, as the rest of a sentence that starts with its name.
    fn fault(&self, _value: &T) -> Option<String> {
        None
    }

    /// `value` in this notation, or `None` if it has no form of its own and stands for a missing key.
    fn write(&self, value: &T) -> Option<Json>;

    /// What texts this notation accepts.
    fn schema(&self, definitions: &mut Definitions) -> Json;
}

/// A value that may be missing.
#[derive(Debug)]
pub(crate) struct Maybe<N>(pub(crate) N);

impl<T, N: Notation<T>> Notation<Option<T>> for Maybe<N> {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Option<T>> {
        self.0.read(reader, value).map(Some)
    }

    fn fault(&self, value: &Option<T>) -> Option<String> {
        self.0.fault(value.as_ref()?)
    }

    fn write(&self, value: &Option<T>) -> Option<Json> {
        self.0.write(value.as_ref()?)
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        self.0.schema(definitions)
    }
}

/// A value that may be missing, which can also be said by `null`.
#[derive(Debug)]
pub(crate) struct OrNull<N>(pub(crate) N);

impl<T, N: Notation<T>> Notation<Option<T>> for OrNull<N> {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Option<T>> {
        match value {
            Written::NullKeyword(_) => Some(None),
            value => self.0.read(reader, value).map(Some),
        }
    }

    fn fault(&self, value: &Option<T>) -> Option<String> {
        self.0.fault(value.as_ref()?)
    }

    fn write(&self, value: &Option<T>) -> Option<Json> {
        self.0.write(value.as_ref()?)
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        json!({ "anyOf": [self.0.schema(definitions), { "const": null }] })
    }
}

/// A list of values.
#[derive(Debug)]
pub(crate) struct List<N>(pub(crate) N);

impl<T, N: Notation<T>> Notation<Vec<T>> for List<N> {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Vec<T>> {
        let Written::Array(array) = value else {
            reader.mistyped(value, "a list", None);
            return None;
        };
        let mut list = Vec::with_capacity(array.elements.len());
        for (index, element) in array.elements.iter().enumerate() {
            let label = format!("entry {} of {}", index + 1, reader.label());
            list.extend(reader.labelled(label, |reader| self.0.read(reader, element)));
        }
        Some(list)
    }

    fn write(&self, value: &Vec<T>) -> Option<Json> {
        Some(value.iter().map(|entry| self.0.write(entry)).collect())
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        json!({ "type": "array", "items": self.0.schema(definitions) })
    }
}

/// A text for people, kept as it is.
#[derive(Debug)]
pub(crate) struct Words;

impl Notation<String> for Words {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<String> {
        let Written::StringLit(text) = value else {
            reader.mistyped(value, "a text", None);
            return None;
        };
        Some(text.value.to_string())
    }

    fn write(&self, value: &String) -> Option<Json> {
        (!value.is_empty()).then(|| json!(value))
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        json!({ "type": "string" })
    }
}

/// A text that says something to people and nothing to the program.
#[derive(Debug)]
pub(crate) struct Remark;

impl Notation<()> for Remark {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<()> {
        if !matches!(value, Written::StringLit(_)) {
            reader.mistyped(value, "a text", None);
        }
        Some(())
    }

    fn write(&self, (): &()) -> Option<Json> {
        None
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        json!({ "type": "string" })
    }
}
