//! Objects, and the tables of objects and materials in a file.

use crate::material::Material;
use crate::notation::{List, Maybe, Notation};
use crate::reader::{Reader, name_span, span};
use crate::record::{RecordNotation, record};
use crate::schema::Definitions;
use crate::shapes::ShapeNotation;
use crate::suggest::{closest, listed, quote};
use crate::syntax::Written;
use freikugel_field::{Field, MaterialId, shapes};
use serde_json::{Value as Json, json};
use std::collections::{HashMap, HashSet};

record! {
    /// A shape with a name and a material.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Object = "object" {
        /// What it is called; no two objects share a name. Objects without one are numbered.
        pub name: String = String::new(), optional NameNotation;
        /// The material of the parts that are not painted; an index into the scene's materials in code, a name in files.
        pub material: Option<MaterialId> = None, optional Maybe(MaterialNotation);
        /// The shape: in files, an object with the name of the shape as its key.
        pub shape: Field = shapes::sphere(1.0).into(), required ShapeNotation;
    }
}

/// The notation of names: any text but the empty one.
pub(crate) struct NameNotation;

impl Notation<String> for NameNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<String> {
        let Written::StringLit(name) = value else {
            reader.mistyped(value, "a text", None);
            return None;
        };
        let name = name.value.to_string();
        let fault = self.fault(&name);
        reader.sound(value, name, fault)
    }

    fn fault(&self, value: &String) -> Option<String> {
        value.is_empty().then(|| "must not be empty".into())
    }

    fn write(&self, value: &String) -> Option<Json> {
        (!value.is_empty()).then(|| json!(value))
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        json!({ "type": "string", "minLength": 1 })
    }
}

/// The notation of a reference to a material: its name.
pub(crate) struct MaterialNotation;

impl Notation<MaterialId> for MaterialNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<MaterialId> {
        let Written::StringLit(name) = value else {
            reader.mistyped(value, "the name of a material", None);
            return None;
        };
        // Without a table of materials, any name may be right.
        let materials = reader.materials.as_ref()?;
        if let Some(&index) = materials.get(name.value.as_ref()) {
            return Some(MaterialId(index));
        }
        // In order, so that the same file always gets the same suggestion.
        let mut names: Vec<&str> = materials.keys().map(String::as_str).collect();
        names.sort_unstable();
        let hint = match closest(&name.value, names.iter().copied()) {
            Some(guess) => format!("did you mean `{guess}`?"),
            None if names.is_empty() => "define it under `materials`".into(),
            None => format!("the scene has {}", listed(names.into_iter().take(MOST_LISTED))),
        };
        let message = format!("there is no material {}", quote(&name.value));
        reader.error(span(value), message, Some(hint));
        None
    }

    fn write(&self, _value: &MaterialId) -> Option<Json> {
        None
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        json!({ "type": "string" })
    }
}

/// As many names as a hint can hold and still be read.
const MOST_LISTED: usize = 12;

/// The notation of the table of materials: an object with their names as keys.
pub(crate) struct MaterialsNotation;

impl Notation<Vec<(String, Material)>> for MaterialsNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Vec<(String, Material)>> {
        let Written::Object(object) = value else {
            reader.materials = None;
            reader.mistyped(value, "an object with a material for each name", None);
            return None;
        };
        let mut names = HashMap::new();
        let mut materials = Vec::new();
        for prop in &object.properties {
            let name = prop.name.as_str();
            if name.is_empty() {
                reader.error(name_span(prop), "the name of a material must not be empty", None);
            }
            let material = reader.labelled(quote(name), |reader| RecordNotation.read(reader, &prop.value));
            let index = u32::try_from(materials.len()).unwrap_or(u32::MAX);
            if names.insert(name.to_string(), index).is_some() {
                reader.duplicate(prop);
            }
            // A faulty material still has a name that may be used.
            materials.push((name.to_string(), material.unwrap_or_default()));
        }
        reader.materials = Some(names);
        Some(materials)
    }

    fn write(&self, value: &Vec<(String, Material)>) -> Option<Json> {
        let entry = |(name, material): &(String, Material)| Some((name.clone(), RecordNotation.write(material)?));
        Some(Json::Object(value.iter().filter_map(entry).collect()))
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        json!({
            "type": "object",
            "additionalProperties": definitions.record::<Material>(),
            "propertyNames": { "minLength": 1 },
        })
    }
}

/// The notation of the list of objects.
pub(crate) struct ObjectsNotation;

impl Notation<Vec<Object>> for ObjectsNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Vec<Object>> {
        let mut objects: Vec<Object> = List(RecordNotation).read(reader, value)?;
        let Written::Array(array) = value else {
            return None;
        };
        if array.elements.is_empty() {
            let hint = format!("for instance {{ \"shape\": {} }}", shapes::SPHERE.about.example);
            reader.error(span(value), "the scene has no objects", Some(hint));
        }
        let mut names = HashSet::new();
        for written in array.elements.iter().filter_map(|element| element.as_object()) {
            let Some(name) = written.get_string("name") else {
                continue;
            };
            if !name.value.is_empty() && !names.insert(name.value.as_ref()) {
                let message = format!("another object is called {} already", quote(&name.value));
                reader.error(name.range.start..name.range.end, message, Some("names must differ".into()));
            }
        }
        for (index, object) in objects.iter_mut().enumerate().filter(|(_, object)| object.name.is_empty()) {
            let numbered = format!("object {}", index + 1);
            object.name = if names.contains(numbered.as_str()) { format!("{numbered} (unnamed)") } else { numbered };
        }
        Some(objects)
    }

    fn write(&self, _value: &Vec<Object>) -> Option<Json> {
        None
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        json!({ "type": "array", "items": definitions.record::<Object>(), "minItems": 1 })
    }
}
