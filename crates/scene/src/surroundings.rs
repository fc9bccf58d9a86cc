//! What surrounds the objects: light from all sides, how corners keep it out, and what is seen behind everything.

use crate::color::{ColorNotation, Rgb};
use crate::notation::{Maybe, Notation, Number};
use crate::reader::Reader;
use crate::record::{Record, record};
use crate::schema::Definitions;
use crate::suggest::quote;
use crate::syntax::Written;
use serde_json::{Value as Json, json};

record! {
    /// Light from all sides, between that of the sky for surfaces that face up and that of the ground for those that face
    /// down.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Ambient = "hemispheres" {
        /// The light from above.
        pub sky: Rgb = [0.24, 0.28, 0.34], required ColorNotation, setter sky;
        /// The light from below.
        pub ground: Rgb = [0.12, 0.10, 0.08], required ColorNotation, setter ground;
    }
}

impl Ambient {
    /// The same light from all sides.
    pub fn even(color: Rgb) -> Self {
        Self { sky: color, ground: color }
    }
}

/// The notation of ambient light: a colour, or an object with one for the sky and one for the ground.
pub(crate) struct AmbientNotation;

impl Notation<Ambient> for AmbientNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Ambient> {
        match value {
            Written::Object(_) => Ambient::read(reader, value),
            _ => ColorNotation.read(reader, value).map(Ambient::even),
        }
    }

    fn write(&self, value: &Ambient) -> Option<Json> {
        Some(value.write())
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        json!({ "anyOf": [ColorNotation.schema(definitions), definitions.record::<Ambient>()] })
    }
}

record! {
    /// How corners and clefts keep the ambient light out.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Occlusion = "occlusion" {
        /// How much of the ambient light is kept out: 0 for none, 1 for as much as the surroundings block.
        pub strength: f32 = 1.0, optional Number::ANY.at_least(0.0), setter strength;
        /// How far surroundings are looked for; a share of the scene's size if missing.
        pub reach: Option<f64> = None, optional Maybe(Number::ANY.above(0.0));
    }
}

/// The notation of occlusion: an object, or `true` for the default one and `false` for none.
pub(crate) struct OcclusionNotation;

impl Notation<Option<Occlusion>> for OcclusionNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Option<Occlusion>> {
        match value {
            Written::BooleanLit(literal) => Some(literal.value.then(Occlusion::default)),
            Written::Object(_) => Occlusion::read(reader, value).map(Some),
            _ => {
                reader.mistyped(value, "`true`, `false` or an object", None);
                None
            }
        }
    }

    fn write(&self, value: &Option<Occlusion>) -> Option<Json> {
        Some(value.as_ref().map_or(json!(false), Record::write))
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        json!({ "anyOf": [{ "type": "boolean" }, definitions.record::<Occlusion>()] })
    }
}

/// What is seen where no object is.
#[derive(Clone, Debug, PartialEq)]
pub enum Background {
    /// The same colour everywhere.
    Solid(Rgb),
    /// Colours by the elevation of the view.
    Gradient {
        /// The colour straight up.
        top: Rgb,
        /// The colour straight down.
        bottom: Rgb,
    },
}

impl Default for Background {
    fn default() -> Self {
        let Gradient { top, bottom } = Gradient::default();
        Self::Gradient { top, bottom }
    }
}

record! {
    /// Colours by the elevation of the view.
    #[derive(Clone, Debug)]
    struct Gradient = "gradient" {
        /// The colour straight up.
        pub top: Rgb = [0.30, 0.42, 0.56], required ColorNotation;
        /// The colour straight down.
        pub bottom: Rgb = [0.80, 0.78, 0.74], required ColorNotation;
    }
}

/// The notation of a background: a colour, or `{ "gradient": { "top": ..., "bottom": ... } }`.
pub(crate) struct BackgroundNotation;

impl Notation<Background> for BackgroundNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Background> {
        if !matches!(value, Written::Object(_)) {
            return ColorNotation.read(reader, value).map(Background::Solid);
        }
        let (_, value) = reader.variant(value, "a background", &[Gradient::NAME])?;
        let label = quote(Gradient::NAME);
        let Gradient { top, bottom } = reader.labelled(label, |reader| Gradient::read(reader, value))?;
        Some(Background::Gradient { top, bottom })
    }

    fn fault(&self, value: &Background) -> Option<String> {
        match value {
            Background::Solid(color) => ColorNotation.fault(color),
            &Background::Gradient { top, bottom } => {
                let fault = Gradient { top, bottom }.faults().into_iter().next()?;
                Some(format!("has a gradient whose {}", fault.message))
            }
        }
    }

    fn write(&self, value: &Background) -> Option<Json> {
        match value {
            Background::Solid(color) => ColorNotation.write(color),
            &Background::Gradient { top, bottom } => Some(json!({ Gradient::NAME: Gradient { top, bottom }.write() })),
        }
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        let gradient = definitions.record::<Gradient>();
        json!({
            "anyOf": [ColorNotation.schema(definitions), {
                "type": "object",
                "properties": { Gradient::NAME: gradient },
                "required": [Gradient::NAME],
                "additionalProperties": false,
            }],
        })
    }
}
