//! Lights, their shadows, and how light weakens with distance.

use crate::color::{ColorNotation, Rgb, WHITE};
use crate::diagnostic::Severity;
use crate::notation::{DIRECTION, Notation, Number, POINT};
use crate::reader::Reader;
use crate::record::{Fault, Record, RecordNotation, record};
use crate::schema::Definitions;
use crate::shadow::{Shadow, ShadowNotation};
use crate::suggest::quote;
use crate::syntax::Written;
use crate::{Argument, notation};
use glam::DVec3;
use serde_json::{Value as Json, json};

record! {
    /// A light so far away that its rays are parallel.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Sun = "sun" {
        /// The direction from the scene towards the sun.
        pub direction: DVec3 = DVec3::new(1.0, -1.0, 2.0), required DIRECTION;
        /// The colour of the light.
        pub color: Rgb = WHITE, optional ColorNotation, setter color;
        /// The factor that the colour is multiplied with.
        pub intensity: f32 = 1.0, optional INTENSITY, setter intensity;
        /// The shadow it casts: `false`, `true` for one with a hard edge, `{ "hardness": 16 }`, or
        /// `{ "clearance": 0.5 }` for a sun of that many degrees across.
        pub shadow: Shadow = Shadow::Hard, optional ShadowNotation::OF_SUN, setter shadow;
    }
}

impl Sun {
    /// A sun in a direction as seen from the scene.
    pub fn towards(direction: impl Argument<DVec3>) -> Self {
        Self { direction: direction.value(), ..Self::default() }
    }
}

record! {
    /// A light that shines from a point in all directions.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Point = "point" {
        /// Where it is.
        pub position: DVec3 = DVec3::new(0.0, 0.0, 5.0), required POINT;
        /// The colour of the light.
        pub color: Rgb = WHITE, optional ColorNotation, setter color;
        /// The factor that the colour is multiplied with.
        pub intensity: f32 = 1.0, optional INTENSITY, setter intensity;
        /// How the light weakens with distance: `"none"`, `"inverse_square"`, or coefficients `[c0, c1, c2]` for
        /// 1/(c0 + c1 r + c2 r²).
        pub falloff: Falloff = Falloff::InverseSquare, optional FalloffNotation, setter falloff;
        /// The shadow it casts: `false`, `true` for one with a hard edge, `{ "hardness": 16 }`, or
        /// `{ "clearance": true }` for the penumbra of a light that fills the free space around it.
        pub shadow: Shadow = Shadow::Hard, optional ShadowNotation::OF_LAMP, setter shadow;
    }
}

impl Point {
    /// A light at a point.
    pub fn at(position: impl Argument<DVec3>) -> Self {
        Self { position: position.value(), ..Self::default() }
    }
}

record! {
    /// A light that shines from a point into a cone.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Spot = "spot" {
        /// Where it is.
        pub position: DVec3 = DVec3::new(0.0, 0.0, 5.0), required POINT;
        /// A point on the axis of the cone.
        pub target: DVec3 = DVec3::ZERO, required POINT;
        /// The full opening angle of the cone, in degrees.
        pub angle: f64 = 40_f64.to_radians(), optional Number::ANY.above(0.0).below(180.0).degrees();
        /// The share of the cone, from its edge inwards, over which the light fades.
        pub softness: f64 = 0.15, optional Number::ANY.at_least(0.0).at_most(1.0), setter softness;
        /// The colour of the light.
        pub color: Rgb = WHITE, optional ColorNotation, setter color;
        /// The factor that the colour is multiplied with.
        pub intensity: f32 = 1.0, optional INTENSITY, setter intensity;
        /// How the light weakens with distance: `"none"`, `"inverse_square"`, or coefficients `[c0, c1, c2]` for
        /// 1/(c0 + c1 r + c2 r²).
        pub falloff: Falloff = Falloff::InverseSquare, optional FalloffNotation, setter falloff;
        /// The shadow it casts: `false`, `true` for one with a hard edge, `{ "hardness": 16 }`, or
        /// `{ "clearance": true }` for the penumbra of a light that fills the free space around it.
        pub shadow: Shadow = Shadow::Hard, optional ShadowNotation::OF_LAMP, setter shadow;
    }
    checked by spot_faults
}

impl Spot {
    /// A light at a point, directed to another.
    pub fn at(position: impl Argument<DVec3>, target: impl Argument<DVec3>) -> Self {
        Self { position: position.value(), target: target.value(), ..Self::default() }
    }

    /// The same with another full opening angle, in degrees.
    #[must_use]
    pub fn angle(self, degrees: impl Argument<f64>) -> Self {
        Self { angle: degrees.value().to_radians(), ..self }
    }
}

fn spot_faults(spot: &Spot) -> Vec<Fault> {
    let fault = (spot.position == spot.target).then(|| Fault {
        severity: Severity::Error,
        key: "target",
        message: "`target` must not be where the light is".into(),
        hint: None,
    });
    fault.into_iter().collect()
}

const INTENSITY: Number = Number::ANY.at_least(0.0);

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub enum Light {
    /// One with parallel rays.
    Sun(Sun),
    /// One that shines in all directions.
    Point(Point),
    /// One that shines into a cone.
    Spot(Spot),
}

impl From<Sun> for Light {
    fn from(sun: Sun) -> Self {
        Self::Sun(sun)
    }
}

impl From<Point> for Light {
    fn from(point: Point) -> Self {
        Self::Point(point)
    }
}

impl From<Spot> for Light {
    fn from(spot: Spot) -> Self {
        Self::Spot(spot)
    }
}

impl Light {
    /// The light of a scene that names none: a warm key light with a soft shadow from the upper left of a viewer at +x and
    /// -y, a cooler fill light from the right, and a rim light from behind.
    pub fn rig() -> Vec<Self> {
        let fill = Sun::towards([1.0, -0.3, 0.5]).color([0.75, 0.85, 1.0]).intensity(0.3).shadow(Shadow::None);
        let rim = Sun::towards([-0.5, 1.0, 0.7]).intensity(0.4).shadow(Shadow::None);
        let key = Sun::towards([-0.3, -1.0, 1.4]).color([1.0, 0.95, 0.86]).shadow(Shadow::Hardness(12.0));
        vec![key.into(), fill.into(), rim.into()]
    }

    pub(crate) fn faults(&self) -> Vec<Fault> {
        match self {
            Self::Sun(sun) => sun.faults(),
            Self::Point(point) => point.faults(),
            Self::Spot(spot) => spot.faults(),
        }
    }
}

/// The notation of a light: an object with one key.
pub(crate) struct LightNotation;

const LIGHTS: [&str; 3] = [Sun::NAME, Point::NAME, Spot::NAME];

impl Notation<Light> for LightNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Light> {
        let (index, value) = reader.variant(value, "a light", &LIGHTS)?;
        reader.labelled(quote(LIGHTS[index]), |reader| match index {
            0 => RecordNotation.read(reader, value).map(Light::Sun),
            1 => RecordNotation.read(reader, value).map(Light::Point),
            _ => RecordNotation.read(reader, value).map(Light::Spot),
        })
    }

    fn write(&self, value: &Light) -> Option<Json> {
        Some(match value {
            Light::Sun(sun) => json!({ Sun::NAME: sun.write() }),
            Light::Point(point) => json!({ Point::NAME: point.write() }),
            Light::Spot(spot) => json!({ Spot::NAME: spot.write() }),
        })
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        definitions.define("light", |definitions| {
            json!({
                "description": "A light: an object with one key that says of what kind.",
                "type": "object",
                "properties": {
                    Sun::NAME: definitions.record::<Sun>(),
                    Point::NAME: definitions.record::<Point>(),
                    Spot::NAME: definitions.record::<Spot>(),
                },
                "additionalProperties": false,
                "minProperties": 1,
                "maxProperties": 1,
            })
        })
    }
}

/// How light weakens with the distance r from its source.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Falloff {
    /// Not at all.
    None,
    /// By 1/r², as in nature.
    #[default]
    InverseSquare,
    /// By 1/(c0 + c1 r + c2 r²).
    Polynomial([f32; 3]),
}

struct FalloffNotation;

const FALLOFFS: [(&str, Falloff); 2] = [("none", Falloff::None), ("inverse_square", Falloff::InverseSquare)];

impl Notation<Falloff> for FalloffNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Falloff> {
        if let Written::StringLit(name) = value {
            let names = FALLOFFS.iter().map(|(name, _)| *name);
            let index = notation::index_of(reader, value, &name.value, names)?;
            return Some(FALLOFFS[index].1);
        }
        let coefficients = reader.numbers(value, ["c0", "c1", "c2"])?.map(|number| number as f32);
        let falloff = Falloff::Polynomial(coefficients);
        reader.sound(value, falloff, self.fault(&falloff))
    }

    fn fault(&self, value: &Falloff) -> Option<String> {
        let Falloff::Polynomial(coefficients) = value else {
            return None;
        };
        if !coefficients.iter().all(|c| c.is_finite() && *c >= 0.0) {
            return Some("must have finite coefficients, none of them negative".into());
        }
        (*coefficients == [0.0; 3]).then(|| "must have a coefficient above 0".into())
    }

    fn write(&self, value: &Falloff) -> Option<Json> {
        Some(match value {
            Falloff::Polynomial(coefficients) => coefficients.map(notation::tidy_f32).to_vec().into(),
            named => FALLOFFS.iter().find(|(_, falloff)| falloff == named)?.0.into(),
        })
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        let coefficient = notation::number_schema_with(json!({ "minimum": 0 }));
        json!({
            "anyOf": [
                { "enum": FALLOFFS.map(|(name, _)| name) },
                { "type": "array", "items": coefficient, "minItems": 3, "maxItems": 3 },
            ],
        })
    }
}
