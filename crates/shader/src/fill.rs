//! The numbers of a scene, written into its table: parts, planes, the materials of regions, lights.

use crate::curvature::curvature;
use crate::hierarchy::{Leaf, write_nodes};
use crate::layout::{LIGHT_SIZE, Layout, PART_SIZE, PLANE_SIZE, REGION_SIZE, SURFACE_SIZE, write};
use crate::many;
use crate::numbers::{slope, write_box, write_light, write_singles};
use crate::part::Part;
use crate::sampled::write_lattice;
use crate::shader::Plane;
use freikugel_field::shape::ExactForm;
use freikugel_field::{Aabb, Action, Extent, Interval, Limits, MaterialId, find_extent};
use freikugel_grid::Bricks;
use freikugel_render::Plan;
use freikugel_scene::{Material, Model, Pattern, Scene};
use glam::{DVec3, Vec3};

/// What boxes of formulas, and those that rays enter, are widened by, relative to their size, so that surfaces on their border
/// lie inside.
const BOX_MARGIN: f64 = 1e-3;

/// Rounding errors of positions on rays, relative to the distance from the origin: eight of single precision.
const POSITION_ERRORS: f64 = 8.0 * f32::EPSILON as f64;

/// A table that is being filled.
pub(crate) struct Filling<'a> {
    pub(crate) numbers: &'a mut [f32],
    pub(crate) layout: &'a Layout,
    pub(crate) scene: &'a Scene,
    pub(crate) plan: &'a Plan,
    pub(crate) notices: Vec<String>,
}

impl Filling<'_> {
    /// Writes all parts. `own` are those of the shader, which know the places of their numbers, of the forms `kinds`; `parts`
    /// are the same ones of this scene.
    pub(crate) fn parts(&mut self, own: &[Part], kinds: &[usize], parts: &[Part]) {
        let plan = self.plan;
        let mut boxes = Vec::with_capacity(parts.len());
        for (index, (own, part)) in own.iter().zip(parts).enumerate() {
            let program = part.structure.program(plan.origin);
            write_singles(&mut self.numbers[own.base..], program.single_constants());
            boxes.push(self.part(index, kinds[index], own.base, part));
            for (region, &place) in part.structure.regions().iter().zip(&own.regions) {
                self.region(place, part.source.object, region.material);
            }
        }
        if self.layout.is_many() {
            self.hierarchy(own, &boxes);
        }
    }

    /// What is known of a part other than its constants; returns its box.
    fn part(&mut self, index: usize, kind: usize, base: usize, part: &Part) -> Option<Aabb> {
        let plan = self.plan;
        let bounds = match find_extent(&part.source.field, &Limits::default()) {
            Extent::Finite(bounds) => Some(bounds),
            Extent::Empty | Extent::Unbounded => None,
        };
        let (bounds, factor, margin) = match part.is_measured {
            true => (bounds, 1.0, 0.0),
            false => {
                let margin = bounds.map_or(0.0, |bounds| BOX_MARGIN * bounds.size().max_element());
                let widened = bounds.map(|bounds| Aabb { min: bounds.min - margin, max: bounds.max + margin });
                let slope = slope(part, widened, self.scene, plan, &mut self.notices);
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
        let is_bare = part.outline.steps.iter().any(|action| matches!(action, Action::Surface { .. }));
        let metric = match (part.is_measured, is_bare) {
            (true, _) => 0.0,
            (false, false) => 1.0,
            (false, true) => 2.0,
        };
        let place = self.layout.parts + PART_SIZE * index;
        write_box(&mut self.numbers[place..], bounds, plan.origin);
        let rest = [factor, margin, kind as f64, base as f64, metric, fall.unwrap_or(-1.0)];
        write(&mut self.numbers[place + 6..], &rest);
        bounds
    }

    /// The hierarchy of boxes of many parts, and the forms of their surfaces.
    fn hierarchy(&mut self, own: &[Part], boxes: &[Option<Aabb>]) {
        let origin = self.plan.origin;
        let leaf = |(part, &bounds): (usize, &Option<Aabb>)| {
            let bounds = bounds.map(|bounds| widened(bounds, origin));
            Leaf { part, bounds, constants: own[part].base }
        };
        let mut leaves: Vec<Leaf> = boxes.iter().enumerate().map(leaf).collect();
        write_nodes(self.numbers, self.layout.nodes, &mut leaves, origin);
        for (index, (part, form)) in own.iter().zip(many::surface_kinds(own)).enumerate() {
            let form = form.map_or(-1.0, |form| form as f64);
            let second = part.regions.get(1).map_or(0, |region| self.layout.regions + REGION_SIZE * region);
            let place = self.layout.surfaces + SURFACE_SIZE * index;
            write(&mut self.numbers[place..], &[form, second as f64]);
        }
    }

    /// Writes where samples are, and what is asked of them as if they were a part, whose values are distances.
    pub(crate) fn samples(&mut self, bricks: &Bricks) {
        let lattice = bricks.lattice();
        write_lattice(&mut self.numbers[self.layout.voxels..], lattice);
        let [min, max] = [lattice.min(), lattice.max()].map(Vec3::as_dvec3);
        Layout::set(self.numbers, "BOUNDS", &[min.x, min.y, min.z, max.x, max.y, max.z]);
        let place = self.layout.parts;
        write_box(&mut self.numbers[place..], Some(Aabb { min, max }), DVec3::ZERO);
        write(&mut self.numbers[place + 6..], &[1.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
    }

    /// Writes all planes.
    pub(crate) fn planes(&mut self, planes: &[Plane]) {
        let plan = self.plan;
        for (index, plane) in planes.iter().enumerate() {
            let form = plan.objects[plane.object].exact.expect("a plane");
            let (normal, offset, is_sheet) = match form {
                ExactForm::HalfSpace { normal, offset } => (normal, offset, 0.0),
                ExactForm::Sheet { normal, offset } => (normal, offset, 1.0),
            };
            let offset = offset - normal.dot(plan.origin);
            let slope = plane.structure.program(plan.origin).gradient(plan.origin + normal).1.length();
            let place = self.layout.planes + PLANE_SIZE * index;
            write(&mut self.numbers[place..], &[normal.x, normal.y, normal.z, offset, is_sheet, slope]);
            let own = plane.structure.regions().first().and_then(|region| region.material);
            self.region(self.layout.part_count + index, plane.object, own);
        }
    }

    /// Writes all lights; returns where they end.
    pub(crate) fn lights(&mut self) -> usize {
        for (index, light) in self.plan.lights.iter().enumerate() {
            let place = self.layout.lights + LIGHT_SIZE * index;
            write_light(&mut self.numbers[place..place + LIGHT_SIZE], light);
        }
        self.layout.lights + LIGHT_SIZE * self.plan.lights.len()
    }

    /// Writes the material of a region of an object, its own one or else the object's.
    pub(crate) fn region(&mut self, region: usize, object: usize, own: Option<MaterialId>) {
        let (scene, plan) = (self.scene, self.plan);
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
        write(&mut self.numbers[place..place + REGION_SIZE], &all);
    }
}

/// A box that a surface on its border lies well inside of, for rays that begin where they enter it.
fn widened(bounds: Aabb, origin: DVec3) -> Aabb {
    let reach = (bounds.min - origin).abs().max((bounds.max - origin).abs()).max_element();
    let margin = BOX_MARGIN * bounds.size().max_element() + POSITION_ERRORS * reach;
    Aabb { min: bounds.min - margin, max: bounds.max + margin }
}
