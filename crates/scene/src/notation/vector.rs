//! Points and directions.

use super::number::{number_schema, tidy};
use super::{Notation, keyframes};
use crate::reader::Reader;
use crate::schema::Definitions;
use crate::suggest::quote;
use crate::syntax::Written;
use freikugel_field::ParamKind;
use glam::DVec3;
use serde_json::{Value as Json, json};

/// A point: `[x, y, z]`.
pub(crate) const POINT: Vector = Vector { kind: ParamKind::Vector };

/// A direction of any length above 0: `[x, y, z]`, or an axis by name.
pub(crate) const DIRECTION: Vector = Vector { kind: ParamKind::Direction };

/// Three numbers.
#[derive(Debug)]
pub(crate) struct Vector {
    kind: ParamKind,
}

/// The axes and their opposites, which a direction may be given by.
const AXES: [(&str, DVec3); 6] = [
    ("x", DVec3::X),
    ("y", DVec3::Y),
    ("z", DVec3::Z),
    ("-x", DVec3::NEG_X),
    ("-y", DVec3::NEG_Y),
    ("-z", DVec3::NEG_Z),
];

/// The direction that a text names, reporting one that names none.
pub(crate) fn named_direction(reader: &mut Reader, value: &Written<'_>, name: &str) -> Option<DVec3> {
    let direction = AXES.iter().find(|(axis, _)| *axis == name).map(|&(_, direction)| direction);
    if direction.is_none() {
        let message = format!("{} can't be {}", reader.label(), quote(name));
        let hint = "a direction is [x, y, z], or one of \"x\", \"y\", \"z\", \"-x\", \"-y\", \"-z\"";
        reader.error(crate::reader::span(value), message, Some(hint.into()));
    }
    direction
}

impl Notation<DVec3> for Vector {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<DVec3> {
        if let (ParamKind::Direction, Written::StringLit(name)) = (self.kind, value) {
            return named_direction(reader, value, &name.value);
        }
        let vector = DVec3::from_array(reader.numbers(value, ["x", "y", "z"])?);
        reader.sound(value, vector, self.fault(&vector))
    }

    fn fault(&self, value: &DVec3) -> Option<String> {
        self.kind.fault(&value.to_array())
    }

    fn write(&self, value: &DVec3) -> Option<Json> {
        Some(value.to_array().map(tidy).to_vec().into())
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        match self.kind {
            ParamKind::Direction => direction_schema(),
            _ => numbers_schema(3),
        }
    }
}

/// A list of exactly `count` numbers, from 2 to 4, for which keyframes may stand.
pub(crate) fn numbers_schema(count: usize) -> Json {
    let list = json!({ "type": "array", "items": number_schema(), "minItems": count, "maxItems": count });
    json!({ "anyOf": [list, keyframes::reference(count)] })
}

/// A direction, by numbers or by name.
pub(crate) fn direction_schema() -> Json {
    json!({ "anyOf": [{ "enum": AXES.map(|(name, _)| name) }, numbers_schema(3)] })
}
