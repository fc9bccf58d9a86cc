//! Shadows: which of the ways to find them a light uses.

use crate::notation::{Flag, Notation, Number, tidy_f32};
use crate::reader::{Reader, span};
use crate::schema::Definitions;
use crate::suggest::quote;
use crate::syntax::Written;
use serde_json::{Value as Json, json};

/// The shadow that a light casts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shadow {
    /// None: the light goes through everything.
    None,
    /// One with a hard edge.
    #[default]
    Hard,
    /// One whose edge is softened by how close a ray passes to an obstacle: the light is weakened by the smallest
    /// k d/t on the way, with the distance d to the obstacle, t from the surface, and this hardness k.
    Hardness(f32),
    /// One whose edge is that of a light with a size. A lamp fills the free space around it, and has no angle; a sun is
    /// so wide as its angle says, in radians.
    Clearance {
        /// The apparent diameter of a sun.
        angle: Option<f64>,
    },
}

/// The notation of shadows, which differs for suns and lamps.
#[derive(Debug)]
pub(crate) struct ShadowNotation {
    of_sun: bool,
}

const FORMS: [&str; 2] = ["hardness", "clearance"];

const HARDNESS: Number = Number::ANY.above(0.0);

/// A sun's diameter: a wider one would reach below the horizon of what it shines on vertically.
const ANGLE: Number = Number::ANY.above(0.0).below(180.0).degrees();

impl ShadowNotation {
    pub(crate) const OF_SUN: Self = Self { of_sun: true };
    pub(crate) const OF_LAMP: Self = Self { of_sun: false };

    fn clearance(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Shadow> {
        if self.of_sun {
            return Some(Shadow::Clearance { angle: Some(ANGLE.read(reader, value)?) });
        }
        if !Flag.read(reader, value)? {
            reader.error(span(value), "`clearance` can only be `true`", Some("write \"shadow\": false".into()));
            return None;
        }
        Some(Shadow::Clearance { angle: None })
    }
}

impl Notation<Shadow> for ShadowNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Shadow> {
        match value {
            Written::BooleanLit(literal) => Some(if literal.value { Shadow::Hard } else { Shadow::None }),
            Written::Object(_) => {
                let (index, value) = reader.variant(value, "a shadow", &FORMS)?;
                reader.labelled(quote(FORMS[index]), |reader| match index {
                    0 => HARDNESS.read(reader, value).map(Shadow::Hardness),
                    _ => self.clearance(reader, value),
                })
            }
            _ => {
                let hint = "write `false`, `true`, or { \"hardness\": 16 }".into();
                reader.mistyped(value, "`true`, `false` or an object", Some(hint));
                None
            }
        }
    }

    fn fault(&self, value: &Shadow) -> Option<String> {
        match (value, self.of_sun) {
            (Shadow::None | Shadow::Hard | Shadow::Clearance { angle: None }, false)
            | (Shadow::None | Shadow::Hard, true) => None,
            (Shadow::Hardness(hardness), _) => HARDNESS.fault(hardness),
            (Shadow::Clearance { angle: Some(angle) }, true) => ANGLE.fault(angle),
            (Shadow::Clearance { angle: None }, true) => Some("must have an angle: that of the sun".into()),
            (Shadow::Clearance { angle: Some(_) }, false) => {
                Some("must have no angle: a lamp's size is the free space around it".into())
            }
        }
    }

    fn write(&self, value: &Shadow) -> Option<Json> {
        Some(match value {
            Shadow::None => json!(false),
            Shadow::Hard => json!(true),
            Shadow::Hardness(hardness) => json!({ "hardness": tidy_f32(*hardness) }),
            Shadow::Clearance { angle: None } => json!({ "clearance": true }),
            Shadow::Clearance { angle: Some(angle) } => json!({ "clearance": ANGLE.write(angle) }),
        })
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        let clearance = match self.of_sun {
            true => Notation::<f64>::schema(&ANGLE, definitions),
            false => json!({ "const": true }),
        };
        let hardness = Notation::<f32>::schema(&HARDNESS, definitions);
        json!({
            "anyOf": [{ "type": "boolean" }, {
                "type": "object",
                "properties": { "hardness": hardness, "clearance": clearance },
                "additionalProperties": false,
                "minProperties": 1,
                "maxProperties": 1,
            }],
        })
    }
}
