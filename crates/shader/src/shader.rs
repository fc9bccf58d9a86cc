//! A scene as a shader: its text, which no number changes, and its numbers.

use crate::curvature::curvature;
use crate::helpers::Helpers;
use crate::hierarchy::{Leaf, write_nodes};
use crate::layout::{LIGHT_SIZE, Layout, PART_SIZE, PLANE_SIZE, REGION_SIZE, SURFACE_SIZE, write};
use crate::many;
use crate::module::needed;
use crate::names::Names;
use crate::numbers::{head, look, slope, write_box, write_light, write_singles};
use crate::parse::parse;
use crate::part::{Part, Source, outline_key, sources};
use crate::scene;
use crate::target::MOST_UNIFORM_BYTES;
use crate::tree::Item;
use freikugel_field::shape::ExactForm;
use freikugel_field::{
    Aabb, Action, Diagnostic, Extent, Field, Interval, Kind, Limits, MaterialId, Shape, Structure, find_extent,
};
use freikugel_render::plan::PlannedObject;
use freikugel_render::{Plan, PrepareError};
use freikugel_scene::{Light, Material, Model, Pattern, Scene};
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

/// How parts are found where they are few, and where they are many.
const FEW: &str = include_str!("library/few.wgsl");
const MANY: &str = include_str!("library/many.wgsl");

/// What shells call; everything else is there for these.
const ENTRIES: [&str; 7] =
    ["sample_along", "shown_along", "camera_ray", "field_gradient", "triple", "TARGET", "SHOW_LIT"];

/// What boxes of formulas, and those that rays enter, are widened by, relative to their size, so that surfaces on their border lie inside.
const BOX_MARGIN: f64 = 1e-3;

/// Rounding errors of positions on rays, relative to the distance from the origin: eight of single precision.
const POSITION_ERRORS: f64 = 8.0 * f32::EPSILON as f64;

/// Numbers that a table can hold: places in it are numbers of the table themselves, whole ones up to here in single precision.
const MOST_NUMBERS: usize = 1 << f32::MANTISSA_DIGITS;

/// Room for lights comes in this many.
const LIGHTS_AT_ONCE: usize = 4;

/// A scene made into a shader.
pub struct Shader {
    parts: Vec<Part>,
    planes: Vec<Plane>,
    layout: Layout,
    /// Lights that there is room for.
    light_room: usize,
    /// Which form each part has.
    kinds: Vec<usize>,
    items: Vec<Item>,
}

/// An object that is nothing but a plane.
struct Plane {
    object: usize,
    structure: Structure,
}

/// The numbers that a shader reads.
#[derive(Clone, Debug)]
pub struct Parameters {
    numbers: Vec<f32>,
    /// How many of them mean something; the others are room for lights.
    used: usize,
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
        // The first region of each part, then those of planes, then all others.
        let mut region_count = parts.len() + planes.len();
        let mut constant_count = 0;
        for (index, part) in parts.iter_mut().enumerate() {
            let count = part.structure.regions().len();
            part.regions = std::iter::once(index).chain(region_count..).take(count).collect();
            region_count += count.saturating_sub(1);
            part.base = constant_count;
            constant_count += part.structure.program(DVec3::ZERO).constants().len();
        }
        let formula_count = parts.iter().filter(|part| !part.is_measured).count();
        let layout = Layout::new(parts.len(), formula_count, planes.len(), region_count, constant_count);
        if layout.lights > MOST_NUMBERS {
            return Err(ShaderError::TooLarge(layout.lights));
        }
        parts.iter_mut().for_each(|part| part.base += layout.constants);

        let mut names = Names::new();
        let walks = if layout.is_many() { MANY } else { FEW };
        let library: Vec<Item> =
            LIBRARY.iter().chain(&[walks]).flat_map(|text| parse(text).expect("the library is sound")).collect();
        library.iter().for_each(|item| names.take(item.name()));
        [
            "nearest",
            "free_ahead",
            "unscaled",
            "whole",
            "part_gradient",
            "field_gradient",
            "surface_at",
            "part_value",
            "quad",
        ]
        .iter()
        .for_each(|name| names.take(name));
        let mut all = layout.items();
        all.extend(library);
        let kinds = scene::kinds(&parts);
        let helpers = Helpers::new(names);
        all.extend(match layout.is_many() {
            true => many::items(&parts, &kinds, planes.len(), helpers),
            false => scene::items(&parts, &kinds, &layout, helpers),
        });
        let items = needed(&all, &ENTRIES);
        let light_room = light_room(plan.lights.len());
        Ok(Self { parts, planes, layout, light_room, kinds, items })
    }

    /// What all targets share: everything but the declarations of parameters and view, and the entry points.
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// Whether parts are found through a hierarchy in the table, so that most places in it are computed.
    pub(crate) fn is_many(&self) -> bool {
        self.layout.is_many()
    }

    /// How many parts are marched.
    pub fn part_count(&self) -> usize {
        self.parts.len()
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
        let (parts, planes) = dissect(scene, &plan)?;
        self.compare(scene, &parts, &planes)?;
        if light_room(plan.lights.len()) != self.light_room {
            return Err(ShaderError::OtherScene("lights".into()));
        }
        let mut numbers = vec![0.0; self.parameter_count()];
        let mut notices = Vec::new();
        head(&mut numbers, scene, &plan);
        let mut boxes = Vec::with_capacity(parts.len());
        for (index, part) in parts.iter().enumerate() {
            let program = part.structure.program(plan.origin);
            write_singles(&mut numbers[self.parts[index].base..], program.single_constants());
            let bounds = match find_extent(&part.source.field, &Limits::default()) {
                Extent::Finite(bounds) => Some(bounds),
                Extent::Empty | Extent::Unbounded => None,
            };
            let (bounds, factor, margin) = match part.is_measured {
                true => (bounds, 1.0, 0.0),
                false => {
                    let margin = bounds.map_or(0.0, |bounds| BOX_MARGIN * bounds.size().max_element());
                    let widened = bounds.map(|bounds| Aabb { min: bounds.min - margin, max: bounds.max + margin });
                    let slope = slope(part, widened, scene, &plan, &mut notices);
                    (widened, 1.0 / (slope * plan.scale), margin)
                }
            };
            let fall = match bounds {
                Some(Aabb { min, max }) if !part.is_measured => {
                    let side = |axis: usize| Interval::new(min[axis], max[axis]);
                    curvature(&part.structure.program(DVec3::ZERO), [0, 1, 2].map(side))
                }
                _ => None,
            };
            let place = self.layout.parts + PART_SIZE * index;
            write_box(&mut numbers[place..], bounds, plan.origin);
            let kind = self.kinds[index] as f64;
            let is_bare = part.outline.steps.iter().any(|action| matches!(action, Action::Surface { .. }));
            let metric = if part.is_measured {
                0.0
            } else if is_bare {
                2.0
            } else {
                1.0
            };
            write(
                &mut numbers[place + 6..],
                &[factor, margin, kind, self.parts[index].base as f64, metric, fall.unwrap_or(-1.0)],
            );
            boxes.push(bounds);
            for (region, &place) in part.structure.regions().iter().zip(&self.parts[index].regions) {
                self.write_region(&mut numbers, place, part.source.object, region.material, scene, &plan);
            }
        }
        if self.layout.is_many() {
            let leaf = |(part, &bounds): (usize, &Option<Aabb>)| {
                let bounds = bounds.map(|bounds| widened(bounds, plan.origin));
                Leaf { part, bounds, constants: self.parts[part].base }
            };
            let mut leaves: Vec<Leaf> = boxes.iter().enumerate().map(leaf).collect();
            write_nodes(&mut numbers, self.layout.nodes, &mut leaves, plan.origin);
            for (index, (part, form)) in self.parts.iter().zip(many::surface_kinds(&self.parts)).enumerate() {
                let form = form.map_or(-1.0, |form| form as f64);
                let second = part.regions.get(1).map_or(0, |region| self.layout.regions + REGION_SIZE * region);
                let place = self.layout.surfaces + SURFACE_SIZE * index;
                write(&mut numbers[place..], &[form, second as f64]);
            }
        }
        for (index, plane) in planes.iter().enumerate() {
            let form = plan.objects[plane.object].exact.expect("a plane");
            let (normal, offset, is_sheet) = match form {
                ExactForm::HalfSpace { normal, offset } => (normal, offset, 0.0),
                ExactForm::Sheet { normal, offset } => (normal, offset, 1.0),
            };
            let offset = offset - normal.dot(plan.origin);
            let slope = plane.structure.program(plan.origin).gradient(plan.origin + normal).1.length();
            let place = self.layout.planes + PLANE_SIZE * index;
            write(&mut numbers[place..], &[normal.x, normal.y, normal.z, offset, is_sheet, slope]);
            let own = plane.structure.regions().first().and_then(|region| region.material);
            self.write_region(&mut numbers, parts.len() + index, plane.object, own, scene, &plan);
        }
        for (index, light) in plan.lights.iter().enumerate() {
            let place = self.layout.lights + LIGHT_SIZE * index;
            write_light(&mut numbers[place..place + LIGHT_SIZE], light);
        }
        let used = self.layout.lights + LIGHT_SIZE * plan.lights.len();
        Ok(Parameters { numbers, used, origin: plan.origin, notices })
    }

    /// Whether the parts of a scene are those of this shader but for their numbers.
    fn compare(&self, scene: &Scene, parts: &[Part], planes: &[Plane]) -> Result<(), ShaderError> {
        let other = |object: usize| {
            let name = scene.objects.get(object).map_or("", |object| object.name.as_str());
            Err(ShaderError::OtherScene(name.to_owned()))
        };
        let form = |part: &Part| (part.source.object, part.is_measured, outline_key(&part.outline, true));
        if parts.len() != self.parts.len() || planes.len() != self.planes.len() {
            return other(parts.len());
        }
        for (own, part) in self.parts.iter().zip(parts) {
            if form(own) != form(part) || own.structure.regions().len() != part.structure.regions().len() {
                return other(part.source.object);
            }
        }
        for (own, plane) in self.planes.iter().zip(planes) {
            if own.object != plane.object {
                return other(plane.object);
            }
        }
        Ok(())
    }

    fn write_region(
        &self,
        numbers: &mut [f32],
        region: usize,
        object: usize,
        own: Option<MaterialId>,
        scene: &Scene,
        plan: &Plan,
    ) {
        let plain = Material::default();
        let id = own.or(scene.objects[object].material);
        let material = id.and_then(|id| scene.materials.get(id.0 as usize)).map_or(&plain, |(_, material)| material);
        let (colors, size) = match &material.color {
            Pattern::Solid(color) => ([*color; 2], 0.0),
            Pattern::Checker { colors, size } => (*colors, *size),
        };
        // Cells alternate with a period of two, so that only the rest matters of how far away the origin is.
        let phase = if size > 0.0 { (plan.origin / size).map(|x| x.rem_euclid(2.0)) } else { DVec3::ZERO };
        let wide = |color: [f32; 3]| color.map(f64::from);
        let mut all = Vec::with_capacity(REGION_SIZE);
        all.extend(wide(colors[0]));
        all.extend(wide(colors[1]));
        all.push(size);
        all.extend(phase.to_array());
        all.extend(wide(material.emissive));
        all.extend([material.ambient, material.diffuse, material.specular, material.exponent].map(f64::from));
        let is_sheet = f64::from(u8::from(plan.objects[object].is_sheet));
        all.extend([f64::from(u8::from(material.model == Model::BlinnPhong)), object as f64, 0.0, is_sheet]);
        let place = self.layout.regions + REGION_SIZE * region;
        write(&mut numbers[place..place + REGION_SIZE], &all);
    }
}

impl Parameters {
    /// The table, in the order in which the shader reads it.
    pub fn numbers(&self) -> &[f32] {
        &self.numbers
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

/// A box that a surface on its border lies well inside of, for rays that begin where they enter it.
fn widened(bounds: Aabb, origin: DVec3) -> Aabb {
    let reach = (bounds.min - origin).abs().max((bounds.max - origin).abs()).max_element();
    let margin = BOX_MARGIN * bounds.size().max_element() + POSITION_ERRORS * reach;
    Aabb { min: bounds.min - margin, max: bounds.max + margin }
}

/// How many lights the table has room for in a scene that has some: so many that one more hardly ever needs another text.
fn light_room(lights: usize) -> usize {
    (lights + 1).next_multiple_of(LIGHTS_AT_ONCE)
}

fn plan(scene: &Scene) -> Result<Plan, ShaderError> {
    let picture = &scene.picture;
    Plan::new(scene, picture.width, picture.height, picture.samples).map_err(ShaderError::Prepare)
}

/// The parts and planes of a scene.
fn dissect(scene: &Scene, plan: &Plan) -> Result<(Vec<Part>, Vec<Plane>), ShaderError> {
    let mut parts = Vec::new();
    let mut planes = Vec::new();
    for (index, (object, planned)) in scene.objects.iter().zip(&plan.objects).enumerate() {
        let compile = |field: &Field| Structure::compile(std::slice::from_ref(field)).map_err(ShaderError::Fields);
        if let PlannedObject { exact: Some(_), .. } = planned {
            planes.push(Plane { object: index, structure: compile(&object.shape)? });
            continue;
        }
        for source in sources(index, &object.name, &object.shape) {
            parts.push(part(source, compile)?);
        }
    }
    Ok((parts, planes))
}

fn part(source: Source, compile: impl Fn(&Field) -> Result<Structure, ShaderError>) -> Result<Part, ShaderError> {
    let structure = compile(&source.field)?;
    let outline = structure.program(DVec3::ZERO).outline();
    // What is computed from coordinates other than by primitives has no scale of its own.
    let is_measured = !outline.steps.iter().any(|action| match action {
        Action::Coordinate { .. } | Action::Literal { .. } => true,
        Action::Map { shape: Shape { kind: Kind::Map(table), .. }, .. } => !table.is_short,
        _ => false,
    });
    Ok(Part { source, structure, outline, base: 0, regions: Vec::new(), is_measured })
}

impl fmt::Display for ShaderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Prepare(error) => error.fmt(f),
            Self::Fields(diagnostics) => diagnostics.iter().try_for_each(|diagnostic| writeln!(f, "{diagnostic}")),
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
