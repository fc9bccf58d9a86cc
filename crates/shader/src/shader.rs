//! A scene as a shader: its text, which no number changes, and its numbers.

use crate::fill::Filling;
use crate::helpers::Helpers;
use crate::layout::{Counts, LIGHT_SIZE, Layout};
use crate::many;
use crate::module::needed;
use crate::names::Names;
use crate::numbers::{head, look};
use crate::parse::parse;
use crate::part::{Part, Source, outline_key, sources};
use crate::sampled::{self, SampleError, Sampled};
use crate::scene;
use crate::target::MOST_UNIFORM_BYTES;
use crate::tree::Item;
use freikugel_field::{Action, Diagnostic, Field, Structure};
use freikugel_render::{Plan, PrepareError};
use freikugel_scene::{Light, Scene};
use glam::DVec3;
use std::fmt;

/// The texts of the library: see there.
const LIBRARY: [&str; 6] = [
    include_str!("library/basics.wgsl"),
    include_str!("library/camera.wgsl"),
    include_str!("library/material.wgsl"),
    include_str!("library/trace.wgsl"),
    include_str!("library/shade.wgsl"),
    include_str!("library/picture.wgsl"),
];

/// How parts are found where they are few, and where they are many; and how samples are read.
const FEW: [&str; 3] =
    [include_str!("library/seen.wgsl"), include_str!("library/few.wgsl"), include_str!("library/at_once.wgsl")];
const MANY: [&str; 2] = [include_str!("library/seen.wgsl"), include_str!("library/many.wgsl")];
const VOXELS: [&str; 2] = [include_str!("library/voxels.wgsl"), include_str!("library/at_once.wgsl")];

/// What scenes bring along or shells define.
const GIVEN: [&str; 10] = [
    "nearest",
    "free_ahead",
    "unscaled",
    "whole",
    "part_gradient",
    "field_gradient",
    "surface_at",
    "part_value",
    "quad",
    "voxel",
];

/// What shells call; everything else is there for these.
const ENTRIES: [&str; 7] =
    ["sample_along", "shown_along", "camera_ray", "field_gradient", "triple", "TARGET", "SHOW_LIT"];

/// Numbers that a table can hold: places in it are numbers of the table themselves, whole ones up to here in single precision.
const MOST_NUMBERS: usize = 1 << f32::MANTISSA_DIGITS;

/// Room for lights comes in this many.
const LIGHTS_AT_ONCE: usize = 4;

/// A scene made into a shader.
pub struct Shader {
    body: Body,
    planes: Vec<Plane>,
    layout: Layout,
    /// Lights that there is room for.
    light_room: usize,
    items: Vec<Item>,
}

/// What rays are marched through.
enum Body {
    /// Formulas.
    Parts {
        parts: Vec<Part>,
        /// Which form each part has.
        kinds: Vec<usize>,
    },
    /// Samples.
    Voxels {
        /// How many there are along the longest side.
        count: u32,
        /// Where the regions of what is sampled are among those of the scene.
        regions: Vec<usize>,
    },
}

/// An object that is nothing but a plane.
pub(crate) struct Plane {
    pub(crate) object: usize,
    pub(crate) structure: Structure,
}

/// The numbers that a shader reads.
#[derive(Clone, Debug)]
pub struct Parameters {
    numbers: Vec<f32>,
    /// How many of them mean something; the others are room for lights.
    used: usize,
    voxels: Vec<[f32; 2]>,
    origin: DVec3,
    notices: Vec<String>,
}

/// Why there is no shader for a scene.
#[derive(Debug)]
pub enum ShaderError {
    /// The scene can't be rendered at all.
    Prepare(PrepareError),
    /// The fields have faults.
    Fields(Vec<Diagnostic>),
    /// The scene can't be sampled.
    Sample(SampleError),
    /// The scene is not of the form that the shader was made for.
    OtherScene(String),
    /// The scene has so many numbers that single precision can't count the places of its table.
    TooLarge(usize),
    /// The text did not pass validation: a mistake of this program.
    Invalid(String),
}

impl Shader {
    /// Makes a shader for a scene and all others that differ from it in numbers only.
    ///
    /// # Errors
    /// If the scene can't be rendered.
    pub fn new(scene: &Scene) -> Result<Self, ShaderError> {
        let plan = plan(scene)?;
        let (mut parts, planes) = dissect(scene, &plan)?;
        let mut numbering = Numbering::new(parts.len(), planes.len());
        let mut constants = 0;
        for (index, part) in parts.iter_mut().enumerate() {
            part.regions = numbering.of_part(index, part.structure.regions().len());
            part.base = constants;
            constants += part.structure.program(DVec3::ZERO).constants().len();
        }
        let layout = laid_out(&Counts {
            parts: parts.len(),
            formulas: parts.iter().filter(|part| !part.is_measured).count(),
            planes: planes.len(),
            regions: numbering.count,
            constants,
            is_sampled: false,
        })?;
        parts.iter_mut().for_each(|part| part.base += layout.constants);
        let kinds = scene::kinds(&parts);
        let (library, names) = library(if layout.is_many() { &MANY } else { &FEW });
        let helpers = Helpers::new(names);
        let own = match layout.is_many() {
            true => many::items(&parts, &kinds, planes.len(), helpers),
            false => scene::items(&parts, &kinds, &layout, helpers),
        };
        Ok(Self::joined(Body::Parts { parts, kinds }, planes, layout, &plan, library, own))
    }

    /// Makes a shader for a scene of which all but planes is sampled, with a number of voxels along the longest side of its box;
    /// and for all others with as many planes and materials. Their text is the same for all shapes.
    ///
    /// # Errors
    /// If the scene can't be rendered, or not be sampled: if it has no bounds, its values are no distances, or it has no inside.
    pub fn of_voxels(scene: &Scene, count: u32) -> Result<Self, ShaderError> {
        let plan = plan(scene)?;
        let sampled = Sampled::new(scene, &plan)?;
        let planes = planes(scene, &plan)?;
        let mut numbering = Numbering::new(1, planes.len());
        let regions = numbering.of_part(0, sampled.regions().len());
        let layout = laid_out(&Counts {
            parts: 1,
            formulas: 0,
            planes: planes.len(),
            regions: numbering.count,
            constants: 0,
            is_sampled: true,
        })?;
        let (library, _) = library(&VOXELS);
        let own = sampled::items(planes.len());
        Ok(Self::joined(Body::Voxels { count, regions }, planes, layout, &plan, library, own))
    }

    fn joined(body: Body, planes: Vec<Plane>, layout: Layout, plan: &Plan, library: Vec<Item>, own: Vec<Item>) -> Self {
        let mut all = layout.items();
        all.extend(library);
        all.extend(own);
        Self { body, planes, layout, light_room: light_room(plan.lights.len()), items: needed(&all, &ENTRIES) }
    }

    /// What all targets share: everything but the declarations of parameters and view, and the entry points.
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// Whether parts are found through a hierarchy in the table, so that most places in it are computed.
    pub(crate) fn is_many(&self) -> bool {
        self.layout.is_many()
    }

    /// Whether rays are marched through samples, which are a table of their own.
    pub(crate) fn is_sampled(&self) -> bool {
        matches!(self.body, Body::Voxels { .. })
    }

    /// How many parts are marched.
    pub fn part_count(&self) -> usize {
        self.layout.part_count
    }

    /// How many parameters there are: a multiple of four.
    fn parameter_count(&self) -> usize {
        (self.layout.lights + LIGHT_SIZE * self.light_room).next_multiple_of(4)
    }

    /// The numbers of a scene of the form that the shader was made for. The size and the samples of its picture count too: they
    /// say how wide a ray is, and how a scene without a camera is framed.
    ///
    /// # Errors
    /// If the scene can't be rendered, or has another form.
    pub fn parameters(&self, scene: &Scene) -> Result<Parameters, ShaderError> {
        let plan = plan(scene)?;
        if light_room(plan.lights.len()) != self.light_room {
            return Err(ShaderError::OtherScene("lights".into()));
        }
        let mut numbers = vec![0.0; self.parameter_count()];
        head(&mut numbers, scene, &plan);
        let mut filling =
            Filling { numbers: &mut numbers, layout: &self.layout, scene, plan: &plan, notices: Vec::new() };
        let (planes, voxels) = match &self.body {
            Body::Parts { parts: own, kinds } => {
                let (parts, planes) = dissect(scene, &plan)?;
                compare_parts(own, &parts, scene)?;
                self.compare_planes(&planes, scene)?;
                filling.parts(own, kinds, &parts);
                (planes, Vec::new())
            }
            Body::Voxels { count, regions } => {
                let sampled = Sampled::new(scene, &plan)?;
                let planes = planes(scene, &plan)?;
                self.compare_planes(&planes, scene)?;
                if sampled.regions().len() != regions.len() {
                    other_scene(scene, 0)?;
                }
                let bricks = sampled.bricks(&plan, *count)?;
                filling.samples(&bricks);
                for (&place, (object, material)) in regions.iter().zip(sampled.regions()) {
                    filling.region(place, object, material);
                }
                (planes, sampled::table(&bricks, regions))
            }
        };
        filling.planes(&planes);
        let used = filling.lights();
        let notices = filling.notices;
        Ok(Parameters { numbers, used, voxels, origin: plan.origin, notices })
    }

    fn compare_planes(&self, planes: &[Plane], scene: &Scene) -> Result<(), ShaderError> {
        match self.planes.iter().zip(planes).find(|(own, plane)| own.object != plane.object) {
            Some((_, plane)) => other_scene(scene, plane.object),
            None if self.planes.len() != planes.len() => other_scene(scene, scene.objects.len()),
            None => Ok(()),
        }
    }
}

impl Parameters {
    /// The table, in the order in which the shader reads it.
    pub fn numbers(&self) -> &[f32] {
        &self.numbers
    }

    /// The table of samples that a shader made by [`Shader::of_voxels`] reads, otherwise nothing: for each brick of 8 x 8 x 8
    /// cells the value in its middle and a number, and for those with a number of at least 0 the values at the corners of their
    /// cells, each with that of a material.
    pub fn voxels(&self) -> &[[f32; 2]] {
        &self.voxels
    }

    /// Those numbers that mean something: all but the room for further lights at the end.
    pub(crate) fn used(&self) -> &[f32] {
        &self.numbers[..self.used]
    }

    /// Whether the texts in WGSL and MSL keep them as uniforms, otherwise in a storage buffer.
    pub fn is_uniform(&self) -> bool {
        size_of_val(self.numbers.as_slice()) <= MOST_UNIFORM_BYTES
    }

    /// The point of the world that the shader's coordinates are relative to.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// What the user should know about these numbers.
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// Changes what belongs to the camera and the size of the picture to those of `scene`, of which nothing else counts. The
    /// origin stays where it is.
    ///
    /// # Errors
    /// If the camera shows nothing.
    pub fn look(&mut self, scene: &Scene) -> Result<(), ShaderError> {
        let bare = Scene {
            camera: scene.camera.clone(),
            tracer: scene.tracer.clone(),
            picture: scene.picture.clone(),
            lights: Vec::<Light>::new(),
            objects: Vec::new(),
            ..Scene::default()
        };
        let plan = plan(&bare)?;
        look(&mut self.numbers, &bare, &plan, self.origin);
        Ok(())
    }
}

/// How many lights the table has room for in a scene that has some: so many that one more hardly ever needs another text.
fn light_room(lights: usize) -> usize {
    (lights + 1).next_multiple_of(LIGHTS_AT_ONCE)
}

/// Which regions of a scene belong to what: first comes the first one of each part, then those of planes, then all others.
struct Numbering {
    count: usize,
}

impl Numbering {
    fn new(parts: usize, planes: usize) -> Self {
        Self { count: parts + planes }
    }

    /// The numbers of the regions of a part.
    fn of_part(&mut self, index: usize, regions: usize) -> Vec<usize> {
        let first = self.count;
        self.count += regions.saturating_sub(1);
        std::iter::once(index).chain(first..).take(regions).collect()
    }
}

fn laid_out(counts: &Counts) -> Result<Layout, ShaderError> {
    let layout = Layout::new(counts);
    if layout.lights > MOST_NUMBERS { Err(ShaderError::TooLarge(layout.lights)) } else { Ok(layout) }
}

/// The library with one way to find what is near, and the names that are taken then.
fn library(walks: &[&str]) -> (Vec<Item>, Names) {
    let texts = LIBRARY.iter().chain(walks);
    let library: Vec<Item> = texts.flat_map(|text| parse(text).expect("the library is sound")).collect();
    let mut names = Names::new();
    library.iter().for_each(|item| names.take(item.name()));
    GIVEN.iter().for_each(|name| names.take(name));
    (library, names)
}

/// Whether the parts of a scene are those of a shader but for their numbers.
fn compare_parts(own: &[Part], parts: &[Part], scene: &Scene) -> Result<(), ShaderError> {
    let form = |part: &Part| (part.source.object, part.is_measured, outline_key(&part.outline, true));
    let differs = |(own, part): &(&Part, &Part)| {
        form(own) != form(part) || own.structure.regions().len() != part.structure.regions().len()
    };
    match own.iter().zip(parts).find(differs) {
        Some((_, part)) => other_scene(scene, part.source.object),
        None if own.len() != parts.len() => other_scene(scene, parts.len()),
        None => Ok(()),
    }
}

/// A scene is of another form, first at an object.
fn other_scene(scene: &Scene, object: usize) -> Result<(), ShaderError> {
    let name = scene.objects.get(object).map_or("", |object| object.name.as_str());
    Err(ShaderError::OtherScene(name.to_owned()))
}

pub(crate) fn plan(scene: &Scene) -> Result<Plan, ShaderError> {
    let picture = &scene.picture;
    Plan::new(scene, picture.width, picture.height, picture.samples).map_err(ShaderError::Prepare)
}

fn compiled(field: &Field) -> Result<Structure, ShaderError> {
    Structure::compile_undivided(std::slice::from_ref(field)).map_err(ShaderError::Fields)
}

/// The planes of a scene.
fn planes(scene: &Scene, plan: &Plan) -> Result<Vec<Plane>, ShaderError> {
    let planes = scene.objects.iter().enumerate().filter(|(index, _)| plan.objects[*index].exact.is_some());
    planes.map(|(object, of)| Ok(Plane { object, structure: compiled(&of.shape)? })).collect()
}

/// The parts and planes of a scene.
fn dissect(scene: &Scene, plan: &Plan) -> Result<(Vec<Part>, Vec<Plane>), ShaderError> {
    let mut parts = Vec::new();
    for (index, object) in scene.objects.iter().enumerate().filter(|(index, _)| plan.objects[*index].exact.is_none()) {
        for source in sources(index, &object.name, &object.shape) {
            parts.push(part(source)?);
        }
    }
    Ok((parts, planes(scene, plan)?))
}

fn part(source: Source) -> Result<Part, ShaderError> {
    let structure = compiled(&source.field)?;
    let outline = structure.program(DVec3::ZERO).outline();
    // What is computed from coordinates other than by primitives has no scale of its own.
    let is_measured = !outline.steps.iter().any(|action| match action {
        Action::Coordinate { .. } | Action::Literal { .. } | Action::Mix { .. } => true,
        Action::Map { shape, .. } => shape.mapping().is_some_and(|table| !table.is_short),
        _ => false,
    });
    Ok(Part { source, structure, outline, base: 0, regions: Vec::new(), is_measured })
}

impl From<SampleError> for ShaderError {
    fn from(error: SampleError) -> Self {
        Self::Sample(error)
    }
}

impl fmt::Display for ShaderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Prepare(error) => error.fmt(f),
            Self::Fields(diagnostics) => diagnostics.iter().try_for_each(|diagnostic| writeln!(f, "{diagnostic}")),
            Self::Sample(error) => error.fmt(f),
            Self::OtherScene(object) => {
                write!(f, "the scene differs from the shader's in more than numbers, first at object {object:?}")
            }
            Self::TooLarge(count) => write!(
                f,
                "the scene has {count} numbers, and shaders can count {MOST_NUMBERS}; render on the CPU, or use fewer objects"
            ),
            Self::Invalid(message) => {
                write!(f, "the shader did not pass validation, which is a mistake of Freikugel: {message}")
            }
        }
    }
}

impl std::error::Error for ShaderError {}
