//! From a scene to what tracing needs.
//!
//! A [`Renderer`] holds what stays the same however large the picture is and wherever the camera stands: compiled
//! fields, and which objects are marched and which are intersected exactly. A [`Frame`] adds what belongs to one
//! picture: the programs relative to its origin, the view, the lights as seen from there, and the tolerances.

use crate::exact::{Exact, Form};
use crate::keep::{Keep, Site};
use crate::light::Lamp;
use crate::march::Pace;
use crate::options::Options;
use crate::vector::Triple;
use crate::view::{CameraError, View, framed};
use crate::wave::Way;
use freikugel_field::simd::{self, Level};
use freikugel_field::{
    Aabb, Cells, Contract, Diagnostic, Extent, Field, Interval, Limits, MaterialId, Program, Severity, Structure,
    analyse_body, find_extent,
};
use freikugel_scene::{Camera, Material, Method, Scene, Tracer};
use glam::DVec3;
use std::fmt;
use std::sync::Arc;

pub mod plan;

/// The part of half a ray's share of its pixel that a surface may be missed by. The default precision is coarser than
/// that at all but the smallest sizes.
const FOOTPRINT_SHARE: f64 = 1.0 / 16.0;

/// The part of the scene's size that a fixed step goes if the scene does not say: no more than 443 steps lead through.
const FIXED_STEP: f64 = 1.0 / 256.0;

/// So many steps before a sheet, fixed steps begin to look for it.
const VALLEY_STEPS: f64 = 2.0;

/// Rounding errors of a field value in single precision, relative to the coordinates: a handful of operations.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// What boxes are widened by, relative to their size, so that a surface on their border lies inside.
const BOX_MARGIN: f64 = 1e-3;

/// The part of the scene's size that ambient occlusion reaches if the scene does not say.
const OCCLUSION_REACH: f64 = 0.1;

/// Samples of ambient occlusion along the normal.
pub(crate) const OCCLUSION_SAMPLES: usize = 5;

/// Why a scene can't be rendered.
#[derive(Clone, Debug)]
pub enum PrepareError {
    /// The fields have faults.
    Fields(Vec<Diagnostic>),
    /// The camera shows nothing.
    Camera(CameraError),
    /// A light can't be used.
    Light {
        /// Its place among the lights.
        index: usize,
        /// What is wrong, as a sentence.
        fault: &'static str,
    },
    /// A parameter of the tracing is out of its range.
    Tracing(&'static str),
    /// The method can't be used on an object, since it is not known how far a step may go.
    NoScale {
        /// The object's place in the scene.
        index: usize,
        /// The object's name.
        object: String,
        /// The method.
        method: Method,
    },
}

/// A scene made ready for pictures of any size. See the [crate documentation](crate).
pub struct Renderer<'s> {
    pub(crate) scene: &'s Scene,
    /// The union of the objects that are marched.
    marched: Option<Structure>,
    /// What each region of that union looks like.
    pub(crate) paints: Vec<Paint<'s>>,
    /// Whether all regions look alike, so that nobody needs to ask for their shares.
    pub(crate) is_uniform: bool,
    /// Whether all regions belong to one object.
    pub(crate) is_one_object: bool,
    /// What field values are multiplied with to get safe steps.
    scale: f64,
    /// Where the marched objects are.
    bounds: Extent,
    /// Objects that rays are intersected with exactly.
    pub(crate) exact: Vec<Exact<'s>>,
    /// The box around all objects of finite size.
    extent: Option<Aabb>,
    /// The cells of the marched union.
    keep: Keep,
}

/// What a part of a surface looks like.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Paint<'s> {
    pub(crate) object: u32,
    pub(crate) material: &'s Material,
    /// Whether it has no inside, and therefore two front sides.
    pub(crate) is_sheet: bool,
}

impl<'s> Renderer<'s> {
    /// Compiles the fields of a scene.
    ///
    /// # Errors
    /// All faults of the fields, or the first other reason why the scene can't be rendered.
    pub fn new(scene: &'s Scene) -> Result<Self, PrepareError> {
        let fields: Vec<Field> = scene.objects.iter().map(|object| object.shape.clone()).collect();
        let mut analyses = Vec::with_capacity(fields.len());
        let mut diagnostics = Vec::new();
        for field in &fields {
            let (analysis, found) = analyse_body(field);
            diagnostics.extend(found);
            analyses.extend(analysis);
        }
        if diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error) {
            return Err(PrepareError::Fields(diagnostics));
        }
        check_tracing(scene)?;

        let mut marched = Vec::new();
        let mut exact = Vec::new();
        let mut bounds = Extent::Empty;
        let mut extent = Extent::Empty;
        let mut scale = f64::INFINITY;
        let mut contracts = Vec::new();
        let mut unscaled = Vec::new();
        let method = scene.tracer.method;
        for (index, (object, analysis)) in scene.objects.iter().zip(&mut analyses).enumerate() {
            contracts.push(analysis.contract);
            let form = Form::of(&object.shape);
            if analysis.extent == Extent::Unbounded && form.is_none() {
                // What is not there within the reach of the search may still be beyond it.
                analysis.extent = match find_extent(&object.shape, &Limits::default()) {
                    Extent::Finite(aabb) => Extent::Finite(aabb),
                    Extent::Empty | Extent::Unbounded => Extent::Unbounded,
                };
            }
            if matches!(analysis.extent, Extent::Finite(_)) {
                extent = hull(extent, analysis.extent);
            }
            // All other methods are there to be compared: each has to find all surfaces.
            let form = form.filter(|_| method == Method::Auto);
            if let Some(form) = form {
                let structure = Structure::compile(&fields[index..=index]).map_err(PrepareError::Fields)?;
                let own = structure.regions().first().and_then(|region| region.material);
                let paint = Paint {
                    object: index as u32,
                    material: material(scene, own.or(object.material)),
                    is_sheet: !analysis.contract.signed,
                };
                exact.push(Exact { form, paint, structure, extent: analysis.extent });
            } else if analysis.extent != Extent::Empty {
                // What is no safe step is searched by intervals, or needs no scale, or gets one from its slope; distances that it
                // is cut with have slope 1.
                scale = scale.min(if analysis.contract.is_safe_step() { safe_scale(&analysis.contract) } else { 1.0 });
                if !analysis.contract.is_safe_step() && matches!(method, Method::Sphere | Method::Relaxed) {
                    unscaled.push(index);
                }
                bounds = hull(bounds, analysis.extent);
                marched.push(index);
            }
        }

        for index in unscaled {
            let everywhere = contracts[index].lipschitz.filter(|_| contracts[index].within.is_none());
            let slope = match bounds {
                Extent::Finite(bounds) => slope_over(&fields[index..=index], widened(bounds))?.or(everywhere),
                Extent::Empty | Extent::Unbounded => everywhere,
            };
            let no_scale = || PrepareError::NoScale { index, object: scene.objects[index].name.clone(), method };
            scale = scale.min(slope.ok_or_else(no_scale)?.recip());
        }

        let structure = (!marched.is_empty())
            .then(|| {
                let fields: Vec<Field> = marched.iter().map(|&index| fields[index].clone()).collect();
                Structure::compile(&fields).map_err(PrepareError::Fields)
            })
            .transpose()?;
        let paints: Vec<Paint<'s>> = structure
            .iter()
            .flat_map(Structure::regions)
            .map(|region| {
                let object = marched[region.object];
                Paint {
                    object: object as u32,
                    material: material(scene, region.material.or(scene.objects[object].material)),
                    is_sheet: !contracts[object].signed,
                }
            })
            .collect();
        let is_uniform = paints
            .windows(2)
            .all(|pair| std::ptr::eq(pair[0].material, pair[1].material) && pair[0].is_sheet == pair[1].is_sheet);
        let is_one_object = paints.windows(2).all(|pair| pair[0].object == pair[1].object);
        Ok(Self {
            scene,
            marched: structure,
            paints,
            is_uniform,
            is_one_object,
            scale: if scale.is_finite() { scale } else { 1.0 },
            bounds,
            exact,
            extent: match extent {
                Extent::Finite(extent) => Some(extent),
                Extent::Empty | Extent::Unbounded => None,
            },
            keep: Keep::default(),
        })
    }

    /// The box around all objects of finite size, if there are any.
    pub fn extent(&self) -> Option<Aabb> {
        self.extent
    }

    /// The scene's camera, or the one that frames it in a picture of this size.
    pub fn camera(&self, width: u32, height: u32) -> Camera {
        self.scene.camera.clone().unwrap_or_else(|| framed(self.extent, width, height))
    }
}

impl Renderer<'_> {
    /// Where the cells of a picture lie that fill `region`, or all that can be seen: at the same place for all pictures, if that
    /// can be.
    fn site(&self, camera: &Camera, region: Option<Aabb>) -> Site {
        // The origins of pictures lie in the extent, if there is one.
        let (origin, reach) = match self.extent {
            Some(extent) => (extent.center(), extent.size().length() / 2.0),
            None => (camera.target, 0.0),
        };
        let region = region.unwrap_or_else(|| {
            // Where a ray can get to from what the camera sees; rounded up, so that it is the same for many cameras.
            let way = 2.0 * self.scene.tracer.max_distance + camera.eye.distance(camera.target);
            let far = way + camera.eye.distance(origin);
            let reach = std::iter::successors(Some(1.0), |reach| Some(2.0 * reach)).find(|&reach| reach >= far);
            let reach = reach.unwrap_or(far);
            Aabb { min: origin - reach, max: origin + reach }
        });
        Site { origin, reach, region }
    }
}

/// The largest factor that keeps the steps of a field safe whose values are.
fn safe_scale(contract: &Contract) -> f64 {
    contract.lipschitz.filter(|&slope| slope > 0.0).map_or(1.0, |slope| (1.0 / slope).max(1.0))
}

/// A bound of a field's slope within a box, if there is one.
fn slope_over(field: &[Field], region: Aabb) -> Result<Option<f64>, PrepareError> {
    let program = Structure::compile(field).map_err(PrepareError::Fields)?.program(DVec3::ZERO);
    let side = |axis: usize| Interval::new(region.min[axis], region.max[axis]);
    Ok(program.lipschitz_over([side(0), side(1), side(2)]))
}

/// A box that holds what lies on the border of another one.
fn widened(bounds: Aabb) -> Aabb {
    let far = bounds.min.abs().max(bounds.max.abs()).max_element();
    let margin = BOX_MARGIN * bounds.size().max_element() + ROUNDING * far;
    Aabb { min: bounds.min - margin, max: bounds.max + margin }
}

fn material(scene: &Scene, id: Option<MaterialId>) -> &Material {
    static PLAIN: std::sync::LazyLock<Material> = std::sync::LazyLock::new(Material::default);
    id.and_then(|MaterialId(index)| scene.materials.get(index as usize)).map_or(&*PLAIN, |(_, material)| material)
}

fn hull(a: Extent, b: Extent) -> Extent {
    match (a, b) {
        (Extent::Empty, other) | (other, Extent::Empty) => other,
        (Extent::Finite(a), Extent::Finite(b)) => Extent::Finite(a.hull(b)),
        (Extent::Unbounded, _) | (_, Extent::Unbounded) => Extent::Unbounded,
    }
}

fn check_tracing(scene: &Scene) -> Result<(), PrepareError> {
    let tracing = &scene.tracer;
    let fault = if !(tracing.max_distance > 0.0 && tracing.max_distance.is_finite()) {
        "the maximum distance must be above 0"
    } else if !(0.0..=1.0).contains(&tracing.precision) {
        "the precision must be at least 0 and at most 1"
    } else if !(0.0..=2.0).contains(&tracing.precision_exponent) {
        "the exponent of the precision must be at least 0 and at most 2"
    } else if !(1.0..2.0).contains(&tracing.relaxation) {
        "the relaxation must be at least 1 and below 2"
    } else if tracing.step.is_some_and(|step| !(step > 0.0 && step.is_finite())) {
        "the fixed step must be above 0"
    } else if tracing.max_steps == 0 {
        "there must be at least one step"
    } else if !(tracing.step_factor > 0.0 && tracing.step_factor <= 1.0) {
        "the step factor must be above 0 and at most 1"
    } else {
        return Ok(());
    };
    Err(PrepareError::Tracing(fault))
}

/// What belongs to one picture.
pub(crate) struct Frame<'r> {
    pub(crate) renderer: &'r Renderer<'r>,
    pub(crate) view: View,
    pub(crate) level: Level,
    /// What single-precision coordinates are relative to.
    pub(crate) origin: DVec3,
    pub(crate) marched: Option<Program>,
    /// One for each of the renderer's exact objects.
    pub(crate) exact: Vec<Program>,
    pub(crate) lamps: Vec<Lamp>,
    pub(crate) way: Way,
    pub(crate) pace: Pace,
    pub(crate) tolerance: Tolerance,
    /// Where to look for marched objects; everywhere if they have no bounds.
    pub(crate) bounds: Option<Aabb>,
    /// The cells of the marched program.
    pub(crate) cells: Option<Arc<Cells>>,
    /// The camera, relative to the origin.
    pub(crate) eye: Triple,
    pub(crate) occlusion: Option<OcclusionSamples>,
    /// The width of the cone that a ray stands for: at the camera, and what it gains per unit of distance.
    pub(crate) footprint: [f32; 2],
    /// Whether hits tell objects apart that look alike.
    pub(crate) tells_objects: bool,
}

/// How far from a surface a ray may stop, in world units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tolerance {
    /// Everywhere.
    fixed: f64,
    /// Per unit of distance from the camera.
    growth: f64,
    /// The precision, which `growth` has in it already if the exponent is 1.
    precision: f64,
    exponent: f64,
}

/// Ambient occlusion, ready to use.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OcclusionSamples {
    /// Distances of the samples from the surface.
    pub(crate) heights: [f32; OCCLUSION_SAMPLES],
    /// What the samples' shortfalls weigh. If all of them touch other surfaces, the weighted sum is the strength.
    pub(crate) weights: [f32; OCCLUSION_SAMPLES],
}

impl<'r> Frame<'r> {
    pub(crate) fn new(renderer: &'r Renderer<'_>, options: &Options) -> Result<Self, PrepareError> {
        let scene = renderer.scene;
        let camera = options.camera.clone().unwrap_or_else(|| renderer.camera(options.width, options.height));
        let view = View::new(&camera, options.width, options.height).map_err(PrepareError::Camera)?;
        // Where single precision is finest should be what the camera sees from nearest by.
        let origin = match renderer.extent {
            Some(extent) => camera.eye.clamp(extent.min, extent.max),
            None => camera.target,
        };
        let program = |structure: &Structure| structure.program(origin);
        let marched = renderer.marched.as_ref().map(program);
        let exact: Vec<Program> = renderer.exact.iter().map(|exact| program(&exact.structure)).collect();
        let clearance =
            |place: DVec3| marched.iter().chain(&exact).map(|field| field.value(place)).fold(f64::INFINITY, f64::min);
        let lamps = scene
            .lights
            .iter()
            .enumerate()
            .map(|(index, light)| {
                Lamp::new(light, origin, clearance).map_err(|fault| PrepareError::Light { index, fault })
            })
            .collect::<Result<_, _>>()?;

        let size = match renderer.extent {
            Some(extent) => extent.size().max_element(),
            None => camera.eye.distance(camera.target),
        };
        // Rays of a pixel share it among them.
        let (fixed, growth) = view.footprint();
        let spread = f64::from(options.samples).sqrt();
        let (fixed, growth) = (fixed / spread, growth / spread);
        let tracer = &scene.tracer;
        let share = if tracer.method == Method::Relaxed { 1.0 } else { FOOTPRINT_SHARE };
        let tolerance = Tolerance::new([fixed, growth].map(|width| width / 2.0 * share), tracer);
        let step = tracer.step.unwrap_or(size * FIXED_STEP) as f32;
        let way = match tracer.method {
            Method::Auto | Method::Guaranteed | Method::Sphere => Way::Packets,
            Method::Fixed => Way::Fixed { step, has_sheets: renderer.paints.iter().any(|paint| paint.is_sheet) },
            Method::Relaxed => Way::Relaxed { relaxation: tracer.relaxation as f32 },
        };
        // Three steps show a valley; the first two may come before it.
        let ahead = match way {
            Way::Fixed { step, has_sheets: true } => VALLEY_STEPS * f64::from(step),
            _ => 0.0,
        };
        let bounds = match renderer.bounds {
            Extent::Finite(bounds) => {
                let Aabb { min, max } = widened(bounds);
                Some(Aabb { min: min - ahead, max: max + ahead })
            }
            Extent::Empty | Extent::Unbounded => None,
        };
        let occlusion = scene.occlusion.as_ref().map(|occlusion| {
            let reach = occlusion.reach.unwrap_or(size * OCCLUSION_REACH);
            (reach, OcclusionSamples::new(f64::from(occlusion.strength), reach))
        });
        // Samples of ambient occlusion should lie in small cells, too.
        let around = occlusion.map_or(0.0, |(reach, _)| reach);
        let region = bounds.map(|Aabb { min, max }| Aabb { min: min - around, max: max + around });
        let site = renderer.site(&camera, region);
        Ok(Self {
            renderer,
            view,
            level: options.level.unwrap_or_else(simd::best),
            origin,
            exact,
            lamps,
            way,
            pace: Pace {
                scale: renderer.scale.min(f64::from(f32::MAX)) as f32,
                step_factor: scene.tracer.step_factor as f32,
                max_steps: scene.tracer.max_steps,
            },
            tolerance,
            bounds,
            cells: renderer.marched.as_ref().map(|structure| renderer.keep.cells(structure, site)),
            eye: (camera.eye - origin).as_vec3().to_array(),
            occlusion: occlusion.map(|(_, samples)| samples),
            footprint: [fixed as f32, growth as f32],
            tells_objects: false,
            marched,
        })
    }
}

impl Tolerance {
    /// For a part of a ray's footprint, at the camera and per unit of distance.
    fn new([fixed, growth]: [f64; 2], tracer: &Tracer) -> Self {
        let Tracer { precision, precision_exponent: exponent, .. } = *tracer;
        // The power of 1 is a growth, of which the larger one holds.
        let growth = if exponent == 1.0 { growth.max(precision) } else { growth };
        Self { fixed, growth, precision, exponent }
    }

    /// How far from the surface a camera ray may have stopped that has come from the camera to a point `t` units away
    /// and `offset` from the origin.
    #[inline(always)]
    pub(crate) fn at(&self, t: f64, offset: f64) -> f64 {
        self.fixed + self.growth * t + ROUNDING * offset + self.power(t)
    }

    /// The tolerance on a ray's way from `t` to `end`, at `t` and per unit of distance further on. Where the tolerance
    /// bends, this is a straight line below it: a chord, or the tangent at `t`.
    #[inline(always)]
    pub(crate) fn along(&self, t: f64, end: f64, offset: f64) -> [f64; 2] {
        let slope = match self.exponent {
            1.0 => 0.0,
            exponent if exponent > 1.0 => self.precision * exponent * libm::pow(t, exponent - 1.0),
            _ if end > t => (self.power(end) - self.power(t)) / (end - t),
            _ => 0.0,
        };
        [self.at(t, offset), self.growth + ROUNDING + slope]
    }

    /// The precision at a distance, unless it is a growth.
    #[inline(always)]
    fn power(&self, t: f64) -> f64 {
        if self.exponent == 1.0 { 0.0 } else { self.precision * libm::pow(t, self.exponent) }
    }
}

/// The rounding error of the field at a point this far from the origin.
pub(crate) fn rounding(offset: f32) -> f32 {
    ROUNDING as f32 * offset
}

impl OcclusionSamples {
    /// Equally spaced heights up to `reach`, each weighing half as much as the one below (K 6.2).
    fn new(strength: f64, reach: f64) -> Self {
        let height = |sample: usize| reach * (sample + 1) as f64 / OCCLUSION_SAMPLES as f64;
        let weight = |sample: usize| 0.5f64.powi(sample as i32 + 1);
        let all: f64 = (0..OCCLUSION_SAMPLES).map(|sample| height(sample) * weight(sample)).sum();
        let strength = if all > 0.0 { strength / all } else { 0.0 };
        Self {
            heights: std::array::from_fn(|sample| height(sample) as f32),
            weights: std::array::from_fn(|sample| (weight(sample) * strength) as f32),
        }
    }
}

impl fmt::Display for PrepareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fields(diagnostics) => {
                for (index, diagnostic) in diagnostics.iter().enumerate() {
                    if index > 0 {
                        f.write_str("\n")?;
                    }
                    diagnostic.fmt(f)?;
                }
                Ok(())
            }
            Self::Camera(fault) => fault.fmt(f),
            Self::Light { index, fault } => write!(f, "light {index}: {fault}"),
            Self::Tracing(fault) => f.write_str(fault),
            Self::NoScale { object, method, .. } => write!(
                f,
                "the tracer `{}` can't find {object:?}: how far a step may go is not known where its slope has no bound \
                 (`auto`, `guaranteed` and `fixed` need not know; where all objects are finite, a bound may be found)",
                method.name()
            ),
        }
    }
}

impl std::error::Error for PrepareError {}
