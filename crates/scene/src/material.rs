//! Materials: how surfaces answer to light.

use crate::Argument;
use crate::color::{BLACK, ColorNotation, Rgb, WHITE};
use crate::diagnostic::Severity;
use crate::notation::{ChoiceNotation, Notation, Number, choice};
use crate::reader::Reader;
use crate::record::{Fault, Record, record};
use crate::schema::Definitions;
use crate::suggest::quote;
use crate::syntax::Written;
use serde_json::{Value as Json, json};

record! {
    /// How a surface answers to light.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Material = "material" {
        /// The colour of the surface: one, or a pattern such as
        /// `{ "checker": { "colors": ["#fff", "#000"], "size": 1 } }`.
        pub color: Pattern = Pattern::Solid([0.6; 3]), optional PatternNotation;
        /// The share of the ambient light that is sent back.
        pub ambient: f32 = 1.0, optional COEFFICIENT, setter ambient;
        /// The share of a light that is sent back evenly to all sides.
        pub diffuse: f32 = 0.8, optional COEFFICIENT, setter diffuse;
        /// The share of a light that is sent back in a highlight.
        pub specular: f32 = 0.2, optional COEFFICIENT, setter specular;
        /// The narrowness of the highlight.
        pub exponent: f32 = 32.0, optional Number::ANY.above(0.0), setter exponent;
        /// Light that the surface sends out by itself.
        pub emissive: Rgb = BLACK, optional ColorNotation, setter emissive;
        /// How the highlight is computed.
        pub model: Model = Model::BlinnPhong, optional ChoiceNotation, setter model;
    }
    checked by energy_faults
}

impl Material {
    /// A material of one colour.
    pub fn color(color: impl Argument<Rgb>) -> Self {
        Self { color: Pattern::Solid(color.value()), ..Self::default() }
    }

    /// A material of cubes in two colours with edges of length `size`.
    pub fn checker(one: impl Argument<Rgb>, other: impl Argument<Rgb>, size: impl Argument<f64>) -> Self {
        let color = Pattern::Checker { colors: [one.value(), other.value()], size: size.value() };
        Self { color, ..Self::default() }
    }
}

const COEFFICIENT: Number = Number::ANY.at_least(0.0);

/// What the sum of coefficients may exceed 1 by before it is worth a warning: `f32` arithmetic on decimals.
const ENERGY_TOLERANCE: f32 = 1e-6;

fn energy_faults(material: &Material) -> Vec<Fault> {
    let sum = material.diffuse + material.specular;
    let fault = (sum > 1.0 + ENERGY_TOLERANCE).then(|| Fault {
        severity: Severity::Warning,
        key: if material.diffuse > material.specular { "diffuse" } else { "specular" },
        message: format!("`diffuse` and `specular` make {sum} together: more light than arrives"),
        hint: Some("keep their sum at 1 or below".into()),
    });
    fault.into_iter().collect()
}

choice! {
    /// How highlights are computed.
    pub enum Model {
        /// From the angle between the mirrored light and the viewer.
        Phong = "phong",
        /// From the angle between the normal and the direction halfway between light and viewer.
        BlinnPhong = "blinn_phong",
    }
    default BlinnPhong
}

/// The colours of a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// The same everywhere.
    Solid(Rgb),
    /// Cubes in two colours by turns, along the axes of the world.
    Checker {
        /// The colour of the cube at the origin with positive coordinates, and of its neighbours.
        colors: [Rgb; 2],
        /// The length of their edges.
        size: f64,
    },
}

impl Default for Pattern {
    fn default() -> Self {
        Material::default().color
    }
}

record! {
    /// Cubes in two colours by turns, along the axes of the world.
    #[derive(Clone, Debug)]
    struct Checker = "checker" {
        /// The two colours.
        pub colors: [Rgb; 2] = [WHITE, BLACK], required Pair;
        /// The length of the edges of the cubes.
        pub size: f64 = 1.0, optional Number::ANY.above(0.0);
    }
}

/// Two colours.
struct Pair;

impl Notation<[Rgb; 2]> for Pair {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<[Rgb; 2]> {
        let Written::Array(array) = value else {
            reader.mistyped(value, "a list of two colours", None);
            return None;
        };
        let [one, other] = array.elements.as_slice() else {
            let message = format!("{} must be two colours, but has {}", reader.label(), array.elements.len());
            reader.error(crate::reader::span(value), message, None);
            return None;
        };
        // Both are read before either ends this, so that both may be reported.
        let (one, other) = (ColorNotation.read(reader, one), ColorNotation.read(reader, other));
        Some([one?, other?])
    }

    fn fault(&self, value: &[Rgb; 2]) -> Option<String> {
        value.iter().find_map(|color| ColorNotation.fault(color))
    }

    fn write(&self, value: &[Rgb; 2]) -> Option<Json> {
        Some(value.iter().map(|color| ColorNotation.write(color)).collect())
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        json!({ "type": "array", "items": ColorNotation.schema(definitions), "minItems": 2, "maxItems": 2 })
    }
}

struct PatternNotation;

impl Notation<Pattern> for PatternNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Pattern> {
        if !matches!(value, Written::Object(_)) {
            return ColorNotation.read(reader, value).map(Pattern::Solid);
        }
        let (_, value) = reader.variant(value, "a pattern", &[Checker::NAME])?;
        let label = quote(Checker::NAME);
        let Checker { colors, size } = reader.labelled(label, |reader| Checker::read(reader, value))?;
        Some(Pattern::Checker { colors, size })
    }

    fn fault(&self, value: &Pattern) -> Option<String> {
        match value {
            Pattern::Solid(color) => ColorNotation.fault(color),
            &Pattern::Checker { colors, size } => {
                let fault = Checker { colors, size }.faults().into_iter().next()?;
                Some(format!("has a checker whose {}", fault.message))
            }
        }
    }

    fn write(&self, value: &Pattern) -> Option<Json> {
        match value {
            Pattern::Solid(color) => ColorNotation.write(color),
            &Pattern::Checker { colors, size } => Some(json!({ Checker::NAME: Checker { colors, size }.write() })),
        }
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        let checker = definitions.record::<Checker>();
        json!({
            "anyOf": [ColorNotation.schema(definitions), {
                "type": "object",
                "properties": { Checker::NAME: checker },
                "required": [Checker::NAME],
                "additionalProperties": false,
            }],
        })
    }
}
