//! The camera: where the picture is taken from, and how points fall on it.

use crate::Argument;
use crate::notation::{DIRECTION, Notation, Number, POINT, are_keyframes};
use crate::reader::Reader;
use crate::record::record;
use crate::schema::Definitions;
use crate::syntax::Written;
use glam::DVec3;
use serde_json::{Value as Json, json};

record! {
    /// Where the picture is taken from. Without a camera, the renderer frames the whole scene.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Camera = "camera" {
        /// Where the eye is.
        pub eye: DVec3 = DVec3::new(4.0, -6.0, 3.0), required POINT;
        /// The point in the middle of the picture.
        pub target: DVec3 = DVec3::ZERO, optional POINT;
        /// The direction that points up in the picture. Where the eye looks along it, the renderer takes another.
        pub up: DVec3 = DVec3::Z, optional DIRECTION, setter up;
        /// How points fall on the picture.
        pub projection as "fov": Projection = Projection::default(), optional FieldOfView, or "height" Height;
    }
}

impl Camera {
    /// A camera at `eye` that looks at `target`.
    pub fn look(eye: impl Argument<DVec3>, target: impl Argument<DVec3>) -> Self {
        Self { eye: eye.value(), target: target.value(), ..Self::default() }
    }

    /// The same with a perspective that opens by an angle in degrees from the lower to the upper edge.
    #[must_use]
    pub fn fov(self, degrees: impl Argument<f64>) -> Self {
        let fov = degrees.value().to_radians();
        Self { projection: Projection::Perspective { fov, axis: FovAxis::Vertical }, ..self }
    }

    /// The same with a perspective that opens by an angle in degrees from side to side.
    #[must_use]
    pub fn horizontal_fov(self, degrees: impl Argument<f64>) -> Self {
        let fov = degrees.value().to_radians();
        Self { projection: Projection::Perspective { fov, axis: FovAxis::Horizontal }, ..self }
    }

    /// The same with parallel rays, and `height` from the lower to the upper edge.
    #[must_use]
    pub fn orthographic(self, height: impl Argument<f64>) -> Self {
        Self { projection: Projection::Orthographic { height: height.value() }, ..self }
    }
}

/// How points of the scene fall on the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Rays through one point.
    Perspective {
        /// The opening angle, in radians.
        fov: f64,
        /// Where it is measured.
        axis: FovAxis,
    },
    /// Parallel rays.
    Orthographic {
        /// The distance in the scene from the lower to the upper edge of the picture.
        height: f64,
    },
}

/// The opening angle of a camera, in degrees, if none is given.
const DEFAULT_FOV: f64 = 40.0;

impl Default for Projection {
    fn default() -> Self {
        Self::Perspective { fov: DEFAULT_FOV.to_radians(), axis: FovAxis::Vertical }
    }
}

/// Where an opening angle is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FovAxis {
    /// From the lower to the upper edge of the picture.
    #[default]
    Vertical,
    /// From the left to the right edge of the picture.
    Horizontal,
}

/// An opening angle: at 180 degrees a plane picture would be infinitely large.
const FOV: Number = Number::ANY.above(0.0).below(180.0).degrees();

/// The height of an orthographic view.
const HEIGHT: Number = Number::ANY.above(0.0);

/// The notation of a perspective: an angle, or an object that names its axis.
struct FieldOfView;

const AXES: [&str; 2] = ["vertical", "horizontal"];

impl Notation<Projection> for FieldOfView {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Projection> {
        let (axis, angle) = match value {
            Written::Object(_) if !are_keyframes(value) => {
                let (index, angle) = reader.variant(value, "an opening angle", &AXES)?;
                (if index == 0 { FovAxis::Vertical } else { FovAxis::Horizontal }, angle)
            }
            _ => (FovAxis::Vertical, value),
        };
        Some(Projection::Perspective { fov: FOV.read(reader, angle)?, axis })
    }

    fn fault(&self, value: &Projection) -> Option<String> {
        match value {
            Projection::Perspective { fov, .. } => FOV.fault(fov),
            Projection::Orthographic { .. } => None,
        }
    }

    fn write(&self, value: &Projection) -> Option<Json> {
        let Projection::Perspective { fov, axis } = value else {
            return None;
        };
        let angle = FOV.write(fov);
        Some(match axis {
            FovAxis::Vertical => angle?,
            FovAxis::Horizontal => json!({ "horizontal": angle? }),
        })
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        let angle = Notation::<f64>::schema(&FOV, definitions);
        let named: serde_json::Map<_, _> = AXES.map(|axis| (axis.to_string(), angle.clone())).into_iter().collect();
        json!({
            "description": "The opening angle in degrees from the lower to the upper edge of the picture, or \
                as { \"horizontal\": 60 } from side to side.",
            "anyOf": [angle, {
                "type": "object",
                "properties": named,
                "additionalProperties": false,
                "minProperties": 1,
                "maxProperties": 1,
            }],
        })
    }
}

/// The notation of an orthographic projection.
struct Height;

impl Notation<Projection> for Height {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Projection> {
        HEIGHT.read(reader, value).map(|height| Projection::Orthographic { height })
    }

    fn fault(&self, value: &Projection) -> Option<String> {
        match value {
            Projection::Perspective { .. } => None,
            Projection::Orthographic { height } => HEIGHT.fault(height),
        }
    }

    fn write(&self, value: &Projection) -> Option<Json> {
        match value {
            Projection::Perspective { .. } => None,
            Projection::Orthographic { height } => HEIGHT.write(height),
        }
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        let mut schema = Notation::<f64>::schema(&HEIGHT, definitions);
        schema["description"] =
            "The height of the part of the scene that is seen, for an orthographic picture instead of a perspective one."
                .into();
        schema
    }
}
