//! Shapes with names, which a scene uses wherever it wants one: `{ "use": "bolt" }`.

use crate::notation::Notation;
use crate::reader::{Reader, name_span, span};
use crate::schema::Definitions;
use crate::shapes::{ShapeNotation, read_shape};
use crate::suggest::{closest, listed, quote};
use crate::syntax::Written;
use freikugel_field::Field;
use jsonc_parser::ast::ObjectProp;
use serde_json::{Value as Json, json};

/// The key of a shape that stands for one with a name.
pub(crate) const USE: &str = "use";

/// The most functions that a shape may be made of, each counted as often as it is used: shapes that use others twice grow fast.
const MOST_NODES: usize = 4_000_000;

/// The notation of the table of shapes with names: an object with these as its keys.
pub(crate) struct NamedShapesNotation;

impl Notation<Vec<(String, Field)>> for NamedShapesNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Vec<(String, Field)>> {
        let Written::Object(object) = value else {
            reader.mistyped(value, "an object with a shape for each name", None);
            return None;
        };
        let mut found: Vec<(String, Field)> = Vec::new();
        let mut pending: Vec<&ObjectProp<'_>> = Vec::new();
        for prop in &object.properties {
            if prop.name.as_str().is_empty() {
                reader.error(name_span(prop), "the name of a shape must not be empty", None);
            } else if pending.iter().any(|other| other.name.as_str() == prop.name.as_str()) {
                reader.duplicate(prop);
            } else {
                pending.push(prop);
            }
        }
        // In whatever order they are written: each after those that it uses.
        while let Some(index) = pending.iter().position(|prop| !uses_any(&prop.value, &pending)) {
            let prop = pending.remove(index);
            let name = prop.name.as_str();
            let field = reader.labelled(quote(name), |reader| read_shape(reader, &prop.value));
            let field = field.filter(|field| !is_too_large(reader, prop, field));
            reader.named.extend(field.clone());
            found.extend(field.iter().map(|field| (name.to_owned(), field.clone())));
            reader.shapes.insert(name.to_owned(), field);
        }
        for prop in &pending {
            let name = quote(prop.name.as_str());
            let (message, hint) = match &*pending {
                [_] => (format!("{name} uses itself"), None),
                all => {
                    let all = listed(all.iter().map(|prop| prop.name.as_str()));
                    (format!("{name} uses itself, or another that does"), Some(format!("among {all}")))
                }
            };
            reader.error(name_span(prop), message, hint);
            reader.shapes.insert(prop.name.as_str().to_owned(), None);
        }
        let place = |name: &str| object.properties.iter().position(|prop| prop.name.as_str() == name);
        found.sort_by_key(|(name, _)| place(name));
        Some(found)
    }

    fn write(&self, _value: &Vec<(String, Field)>) -> Option<Json> {
        None
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        json!({
            "type": "object",
            "additionalProperties": ShapeNotation.schema(definitions),
            "propertyNames": { "minLength": 1 },
        })
    }
}

/// The shape that a use names, or `None` after reporting that there is none; nothing is said of one that has a fault itself.
pub(crate) fn used(reader: &mut Reader, value: &Written<'_>) -> Option<Field> {
    let Written::StringLit(name) = value else {
        reader.labelled(quote(USE), |reader| reader.mistyped(value, "the name of a shape", None));
        return None;
    };
    if let Some(shape) = reader.shapes.get(name.value.as_ref()) {
        return shape.clone();
    }
    let names: Vec<&str> = reader.shapes.keys().map(String::as_str).collect();
    let hint = match closest(&name.value, names.iter().copied()) {
        Some(guess) => format!("did you mean `{guess}`?"),
        None if names.is_empty() => "name it under `shapes`".into(),
        None => format!("the scene has {}", listed(names.into_iter().take(MOST_LISTED))),
    };
    reader.error(span(value), format!("there is no shape called {}", quote(&name.value)), Some(hint));
    None
}

/// As many names as a hint can hold and still be read.
const MOST_LISTED: usize = 12;

/// Whether a value has a use of one of the shapes in `others`.
fn uses_any(value: &Written<'_>, others: &[&ObjectProp<'_>]) -> bool {
    match value {
        Written::Object(object) => object.properties.iter().any(|prop| match &prop.value {
            Written::StringLit(name) if prop.name.as_str() == USE => {
                others.iter().any(|other| other.name.as_str() == name.value)
            }
            inner => uses_any(inner, others),
        }),
        Written::Array(array) => array.elements.iter().any(|element| uses_any(element, others)),
        _ => false,
    }
}

/// Whether a shape has too many parts, which is reported.
fn is_too_large(reader: &mut Reader, prop: &ObjectProp<'_>, field: &Field) -> bool {
    let is_too_large = nodes(field, MOST_NODES) > MOST_NODES;
    if is_too_large {
        let message = format!("{} is made of more than {MOST_NODES} functions", quote(prop.name.as_str()));
        reader.error(name_span(prop), message, Some(GROWTH.into()));
    }
    is_too_large
}

/// Whether shapes together have too many parts, which is reported at the first that is one too many.
pub(crate) fn are_too_large(reader: &mut Reader, fields: &[Field]) -> bool {
    let mut left = MOST_NODES;
    for field in fields {
        let count = nodes(field, left);
        if count > left {
            let place = reader.place(field.node().origin).unwrap_or_default();
            reader.error(place, format!("the scene is made of more than {MOST_NODES} functions"), Some(GROWTH.into()));
            return true;
        }
        left -= count;
    }
    false
}

const GROWTH: &str = "shapes that use others twice grow fast";

/// How many functions a field is made of, each as often as it is used; counting ends above `limit`.
fn nodes(field: &Field, limit: usize) -> usize {
    let (mut count, mut pending) = (0, vec![field]);
    while let Some(field) = pending.pop() {
        count += 1;
        if count > limit {
            break;
        }
        pending.extend(&field.node().children);
    }
    count
}
