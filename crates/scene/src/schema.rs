//! The JSON Schema of scene files, from the same declarations that read them.

use crate::notation::{Notation, keyframes_definitions};
use crate::record::Record;
use crate::scene::Scene;
use serde_json::{Map, Value as Json, json};

/// The JSON Schema (draft 2020-12) of scene files.
///
/// It says what can be said of a value by itself. What a scene needs beyond that (known materials, distinct names, ...)
/// only [`read`](fn@crate::read) tells.
pub fn schema() -> Json {
    let mut definitions = Definitions::default();
    let root = definitions.record::<Scene>();
    definitions.0.extend(keyframes_definitions());
    let mut schema = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Freikugel scene",
        "$defs": definitions.0,
    });
    schema["$ref"] = root["$ref"].clone();
    schema
}

/// The named parts of the schema.
#[derive(Debug, Default)]
pub(crate) struct Definitions(Map<String, Json>);

impl Definitions {
    /// A reference to the definition `name`, which `build` makes if it isn't there yet. It may refer to itself.
    pub(crate) fn define(&mut self, name: &str, build: impl FnOnce(&mut Self) -> Json) -> Json {
        if !self.0.contains_key(name) {
            self.0.insert(name.into(), Json::Null);
            let definition = build(self);
            self.0.insert(name.into(), definition);
        }
        json!({ "$ref": format!("#/$defs/{name}") })
    }

    /// A reference to a record's definition.
    pub(crate) fn record<R: Record>(&mut self) -> Json {
        self.define(R::NAME, |definitions| {
            let mut schema = RecordSchema { object: ObjectSchema::default(), definitions };
            R::schema(&mut schema);
            schema.object.finish()
        })
    }
}

/// The schema of an object with fixed keys, under construction.
#[derive(Debug, Default)]
pub(crate) struct ObjectSchema {
    about: &'static str,
    properties: Map<String, Json>,
    required: Vec<&'static str>,
    exclusions: Vec<Json>,
}

impl ObjectSchema {
    pub(crate) fn about(&mut self, about: &'static str) {
        self.about = about.trim_ascii();
    }

    /// Adds a key. If the schema of its value says what it is, that goes before `about`.
    pub(crate) fn key(&mut self, key: &'static str, about: &str, mut schema: Json, need: Need) {
        if schema.get("description").is_none() {
            schema["description"] = about.trim_ascii().into();
        }
        match need {
            Need::Required => self.required.push(key),
            Need::Optional(Some(default)) => schema["default"] = default,
            Need::Optional(None) => {}
        }
        self.properties.insert(key.into(), schema);
    }

    pub(crate) fn finish(self) -> Json {
        let mut schema = json!({ "type": "object", "properties": self.properties, "additionalProperties": false });
        if !self.about.is_empty() {
            schema["description"] = self.about.into();
        }
        if !self.required.is_empty() {
            schema["required"] = self.required.into();
        }
        if !self.exclusions.is_empty() {
            schema["not"] = json!({ "anyOf": self.exclusions });
        }
        schema
    }
}

/// Whether a key must be there.
#[derive(Debug)]
pub(crate) enum Need {
    Required,
    /// Not; what a missing one stands for, if that can be written.
    Optional(Option<Json>),
}

/// The schema of a record, under construction.
#[derive(Debug)]
pub(crate) struct RecordSchema<'d> {
    object: ObjectSchema,
    definitions: &'d mut Definitions,
}

impl RecordSchema<'_> {
    pub(crate) fn about(&mut self, about: &'static str) {
        self.object.about(about);
    }

    /// Adds a key with its notation and its default, if it need not be there.
    pub(crate) fn key<T>(&mut self, key: &'static str, about: &str, notation: &dyn Notation<T>, default: Option<&T>) {
        let need = default.map_or(Need::Required, |default| Need::Optional(notation.write(default)));
        let schema = notation.schema(self.definitions);
        self.object.key(key, about, schema, need);
    }

    /// At most one of two keys may be there.
    pub(crate) fn exclude(&mut self, one: &'static str, other: &'static str) {
        self.object.exclusions.push(json!({ "required": [one, other] }));
    }
}
