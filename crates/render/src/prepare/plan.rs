//! What a picture is computed from, in plain numbers: for other implementations of the same model, on other processors.
//!
//! A plan holds everything that follows from a scene and the size of its picture before the first ray is cast: which objects
//! are intersected exactly, where the others are, the camera's frame, the lights, and all tolerances. Lengths are in world
//! units; positions of lights are relative to the plan's origin, near which single precision is finest.

use super::{Frame, OCCLUSION_SAMPLES, PrepareError, ROUNDING, Renderer, widened};
use crate::light::{Dimming, Emitter, Lamp};
use crate::options::Options;
use freikugel_field::ray::ExactRay;
use freikugel_field::shape::ExactForm;
use freikugel_field::{Aabb, Extent, Limits, analyse, find_extent};
use freikugel_scene::{Falloff, Method, Rgb, Scene};
use glam::DVec3;

/// Everything that is settled before the first ray.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What single-precision coordinates are relative to.
    pub origin: DVec3,
    /// One entry for each object of the scene.
    pub objects: Vec<PlannedObject>,
    /// The box around all marched objects, widened so that their surfaces lie inside; `None` if they have no bounds.
    pub bounds: Option<Aabb>,
    /// The largest extent of the scene along an axis, or its distance from the camera if nothing has a size.
    pub size: f64,
    /// What values of marched distances are multiplied with to get safe steps.
    pub scale: f64,
    /// The camera.
    pub camera: PlannedCamera,
    /// How far from a surface a ray may stop.
    pub tolerance: PlannedTolerance,
    /// The lights, in the order of the scene.
    pub lights: Vec<PlannedLight>,
    /// Ambient occlusion, if there is any: distances of the samples from the surface, and what their shortfalls weigh.
    pub occlusion: Option<[[f32; OCCLUSION_SAMPLES]; 2]>,
}

/// What is known about one object.
#[derive(Clone, Copy, Debug)]
pub struct PlannedObject {
    /// The plane that rays are intersected with exactly, if the object is nothing else.
    pub exact: Option<ExactForm>,
    /// Whether it has no inside, and therefore two front sides.
    pub is_sheet: bool,
    /// The box that holds it, found by search where the field does not say.
    pub extent: Extent,
    /// Whether its value is a safe step once it is multiplied with the plan's scale. Otherwise it says nothing about the
    /// distance until its slope is known.
    pub is_measured: bool,
}

/// A camera's frame: right-handed, of unit vectors.
#[derive(Clone, Copy, Debug)]
pub struct PlannedCamera {
    /// Where rays start, in a perspective; the middle of the plane they start from otherwise.
    pub eye: DVec3,
    /// To the right in the picture.
    pub right: DVec3,
    /// Upwards in the picture.
    pub up: DVec3,
    /// Into the picture.
    pub forward: DVec3,
    /// Half the picture's width and height: at distance 1 for a perspective, in the world otherwise.
    pub half: [f64; 2],
    /// Whether rays go through one point.
    pub is_perspective: bool,
    /// The width of the cone that a ray stands for: at the camera, and what it gains per unit of distance.
    pub footprint: [f64; 2],
}

/// How far from a surface a ray may stop: `fixed + growth t + precision t^exponent`, and [`PlannedTolerance::ROUNDING`] times
/// the distance from the origin.
#[derive(Clone, Copy, Debug)]
pub struct PlannedTolerance {
    /// Everywhere.
    pub fixed: f64,
    /// Per unit of distance from the camera.
    pub growth: f64,
    /// What the power of the distance is multiplied with; 0 if `growth` says it all.
    pub precision: f64,
    /// The exponent of the distance.
    pub exponent: f64,
}

impl PlannedTolerance {
    /// Rounding errors of a field value in single precision, relative to the coordinates.
    pub const ROUNDING: f64 = ROUNDING;
}

/// A light made ready.
#[derive(Clone, Copy, Debug)]
pub struct PlannedLight {
    /// Where it is.
    pub place: Place,
    /// Its colour times its intensity.
    pub power: Rgb,
    /// How light weakens with the distance r from a lamp, `1 / (c0 + c1 r + c2 r^2)`; 1, 0, 0 for a sun.
    pub falloff: [f64; 3],
    /// The cone of a spot light: its axis, and the cosines of the angles where the light ends and where it begins to fade.
    pub cone: Option<([f32; 3], f32, f32)>,
    /// The shadow it casts.
    pub shadow: PlannedShadow,
}

/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// From afar: the unit vector towards it.
    Sun([f32; 3]),
    /// From a point, relative to the origin.
    Lamp([f32; 3]),
}

/// What dims a light where something stands in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlannedShadow {
    /// Nothing does.
    None,
    /// All or nothing.
    Hard,
    /// The least ratio of clearance to distance from the surface, times this, up to 1.
    Sharpness(f32),
    /// As before; the factor is the distance to the light over this.
    Clearance(f32),
}

impl Plan {
    /// Plans a picture of a scene with the method `auto`, whatever the scene says.
    ///
    /// # Errors
    /// If the scene can't be rendered.
    pub fn new(scene: &Scene, width: u32, height: u32, samples: u32) -> Result<Self, PrepareError> {
        let mut scene = scene.clone();
        scene.tracer.method = Method::Auto;
        let renderer = Renderer::new(&scene)?;
        let frame = Frame::new(&renderer, &Options { width, height, samples, ..Options::of(&scene) })?;
        let objects = scene.objects.iter().map(|object| {
            let analysis = analyse(&object.shape).0.expect("the renderer has found no fault");
            let exact = ExactRay::of(&object.shape).map(|ray| ray.form());
            let extent = match (analysis.extent, exact) {
                (Extent::Unbounded, None) => find_extent(&object.shape, &Limits::default()),
                (extent, _) => extent,
            };
            let contract = analysis.contract;
            PlannedObject { exact, is_sheet: !contract.signed, extent, is_measured: contract.is_safe_step() }
        });
        let view = &frame.view;
        let super::Tolerance { fixed, growth, precision, exponent } = frame.tolerance;
        let is_growth = exponent == 1.0;
        Ok(Self {
            origin: frame.origin,
            objects: objects.collect(),
            bounds: match renderer.bounds {
                Extent::Finite(bounds) => Some(widened(bounds)),
                Extent::Empty | Extent::Unbounded => None,
            },
            size: match renderer.extent {
                Some(extent) => extent.size().max_element(),
                None => 2.0 * view.eye.distance(frame.origin),
            },
            scale: renderer.scale,
            camera: PlannedCamera {
                eye: view.eye,
                right: view.right,
                up: view.up,
                forward: view.forward,
                half: view.half.to_array(),
                is_perspective: view.is_perspective,
                footprint: frame.footprint.map(f64::from),
            },
            tolerance: PlannedTolerance { fixed, growth, precision: if is_growth { 0.0 } else { precision }, exponent },
            lights: frame.lamps.iter().map(PlannedLight::of).collect(),
            occlusion: frame.occlusion.map(|occlusion| [occlusion.heights, occlusion.weights]),
        })
    }
}

impl PlannedLight {
    fn of(lamp: &Lamp) -> Self {
        let (place, falloff, cone) = match lamp.emitter {
            Emitter::Sun { direction } => (Place::Sun(direction), Falloff::None, None),
            Emitter::Point { position, falloff, cone } => (Place::Lamp(position), falloff, cone),
        };
        Self {
            place,
            power: lamp.power,
            falloff: match falloff {
                Falloff::None => [1.0, 0.0, 0.0],
                Falloff::InverseSquare => [0.0, 0.0, 1.0],
                Falloff::Polynomial(coefficients) => coefficients.map(f64::from),
            },
            cone: cone.map(|cone| (cone.axis, cone.outer, cone.inner)),
            shadow: match lamp.dimming {
                Dimming::None => PlannedShadow::None,
                Dimming::Hard => PlannedShadow::Hard,
                Dimming::Sharpness(sharpness) => PlannedShadow::Sharpness(sharpness),
                Dimming::Clearance(clearance) => PlannedShadow::Clearance(clearance),
            },
        }
    }
}
