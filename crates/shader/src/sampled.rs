//! Scenes as sampled fields: everything but planes, in bricks.

use crate::numbers::write_singles;
use crate::scene;
use crate::shader::{ShaderError, plan};
use crate::tree::Item;
use freikugel_field::{Aabb, Cell, Cells, Evaluator, Field, MaterialId, Shares, Splitter, Structure, simd};
use freikugel_grid::{Block, Bricks, GridError, Lattice, Points, Source};
use freikugel_render::Plan;
use freikugel_scene::Scene;
use glam::Vec3;
use std::fmt;
use std::sync::Arc;

/// A part of so few steps is not worth looking for a smaller one.
const SMALL_PART: usize = 24;

/// Why a scene can't be sampled.
#[derive(Clone, Debug, PartialEq)]
pub enum SampleError {
    /// There is nothing but planes, or something that has no bounds.
    Unbounded,
    /// The values of an object, whose name this is, are no distances.
    Unscaled(String),
    /// An object, whose name this is, has no inside: between samples it would have gaps.
    Sheet(String),
    /// The number of voxels is out of range, or the field has a value that is not finite.
    Grid(GridError),
    /// The host of the shader has no place for samples.
    Host(&'static str),
}

/// What is sampled of a scene: everything but planes.
pub(crate) struct Sampled {
    /// The objects.
    objects: Vec<usize>,
    structure: Structure,
}

impl Sampled {
    /// Looks whether a scene can be sampled.
    pub(crate) fn new(scene: &Scene, plan: &Plan) -> Result<Self, ShaderError> {
        let is_sampled = |&object: &usize| plan.objects[object].exact.is_none();
        let objects: Vec<usize> = (0..scene.objects.len()).filter(is_sampled).collect();
        for &object in &objects {
            let name = || scene.objects[object].name.clone();
            if !plan.objects[object].is_measured {
                return Err(SampleError::Unscaled(name()).into());
            }
            if plan.objects[object].is_sheet {
                return Err(SampleError::Sheet(name()).into());
            }
        }
        if objects.is_empty() || plan.bounds.is_none() {
            return Err(SampleError::Unbounded.into());
        }
        let fields: Vec<Field> = objects.iter().map(|&object| scene.objects[object].shape.clone()).collect();
        let structure = Structure::compile(&fields).map_err(ShaderError::Fields)?;
        Ok(Self { objects, structure })
    }

    /// What is told apart: objects of the scene, and materials in them. Labels of samples are places in this list.
    pub(crate) fn regions(&self) -> impl ExactSizeIterator<Item = (usize, Option<MaterialId>)> {
        self.structure.regions().iter().map(|region| (self.objects[region.object], region.material))
    }

    /// Takes the samples.
    pub(crate) fn bricks(&self, plan: &Plan, voxels: u32) -> Result<Bricks, SampleError> {
        let bounds = plan.bounds.ok_or(SampleError::Unbounded)?;
        let [min, max] = [bounds.min, bounds.max].map(|corner| (corner - plan.origin).as_vec3());
        let lattice = Lattice::around(min, max, voxels).map_err(SampleError::Grid)?;
        let program = self.structure.program(plan.origin);
        // Boxes of a cube of as many bricks as a power of two are whole bricks.
        let side = f64::from(lattice.brick()) * f64::from(lattice.bricks().max_element().next_power_of_two());
        let corner = plan.origin + lattice.min().as_dvec3();
        let level = simd::best();
        let mut source = Pruned {
            cells: Cells::new(&program, Aabb { min: corner, max: corner + side }),
            splitter: Splitter::new(level),
            evaluator: Evaluator::with_level(&program, level),
            shares: Shares::default(),
            scale: plan.scale as f32,
        };
        Bricks::sample(lattice, &mut source).map_err(SampleError::Grid)
    }
}

/// Samples a scene without its planes, with a number of voxels along the longest side of its box. Coordinates are relative to
/// [`Plan::origin`], values are multiplied with [`Plan::scale`], so that they are safe steps; labels tell objects and the
/// materials in them apart.
///
/// # Errors
/// If the scene can't be sampled.
pub fn sample(scene: &Scene, voxels: u32) -> Result<Bricks, ShaderError> {
    let plan = plan(scene)?;
    Ok(Sampled::new(scene, &plan)?.bricks(&plan, voxels)?)
}

/// The functions of a scene that was sampled, other than those of the library.
pub(crate) fn items(plane_count: usize) -> Vec<Item> {
    [scene::whole(plane_count), scene::whole_gradient()].map(Item::Function).into()
}

/// The numbers that tell where samples are.
pub(crate) fn write_lattice(numbers: &mut [f32], lattice: &Lattice) {
    let [x, y, z] = lattice.min().to_array();
    let [columns, rows, layers] = lattice.bricks().to_array().map(|count| count as f32);
    write_singles(numbers, &[x, y, z, lattice.voxel(), columns, rows, layers, lattice.count() as f32]);
}

/// The table of samples: for each brick the value in its middle, and its number among those with fine samples or -1; then for each
/// fine sample its value, and the number of its region.
pub(crate) fn table(bricks: &Bricks, regions: &[usize]) -> Vec<[f32; 2]> {
    let coarse = bricks.coarse().map(|(middle, slot)| [middle, slot.map_or(-1.0, |slot| slot as f32)]);
    coarse.chain(bricks.fine().map(|(value, label)| [value, regions[label as usize] as f32])).collect()
}

/// A scene's field, of which each block needs a part only.
struct Pruned<'p> {
    cells: Cells,
    splitter: Splitter,
    evaluator: Evaluator<'p>,
    shares: Shares,
    scale: f32,
}

impl Pruned<'_> {
    /// The part of the smallest box that holds a block.
    fn part(&mut self, block: &Block) -> Arc<freikugel_field::Part> {
        let Self { cells, splitter, .. } = self;
        let mut cell = cells.root();
        let mut part = Arc::clone(cell.part());
        while part.size() > SMALL_PART || cell.is_crowded() {
            let Some(child) = cells.children(cell, splitter).iter().find(|child| holds(child, block)) else {
                break;
            };
            cells.enter(child, splitter);
            if !child.is_crowded() {
                part = Arc::clone(child.part());
            }
            cell = child;
        }
        part
    }
}

fn holds(cell: &Cell, block: &Block) -> bool {
    let (middle, half) = (Vec3::from(cell.middle()), Vec3::from(cell.half()));
    block.min.cmpge(middle - half).all() && block.max.cmple(middle + half).all()
}

fn slices(points: &Points) -> freikugel_field::Points<'_> {
    freikugel_field::Points { x: &points.x, y: &points.y, z: &points.z }
}

impl Source for Pruned<'_> {
    fn values(&mut self, block: &Block, points: &Points, values: &mut [f32]) {
        let part = self.part(block);
        self.evaluator.values_in(&part, slices(points), values);
        values.iter_mut().for_each(|value| *value *= self.scale);
    }

    fn labels(&mut self, block: &Block, points: &Points, labels: &mut [u32]) {
        let part = self.part(block);
        self.evaluator.shares_in(&part, slices(points), &mut self.shares);
        let mut largest = vec![0.0; labels.len()];
        for (region, shares) in self.shares.iter() {
            for ((label, largest), &share) in labels.iter_mut().zip(&mut largest).zip(shares) {
                if share > *largest {
                    (*label, *largest) = (region as u32, share);
                }
            }
        }
    }
}

impl fmt::Display for SampleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unbounded => f.write_str(
                "only what has bounds can be sampled: cut what is endless by a box, or leave the voxels out",
            ),
            Self::Unscaled(object) => write!(
                f,
                "the values of {object:?} are no distances, so that it can't be sampled: leave the voxels out"
            ),
            Self::Sheet(object) => write!(
                f,
                "{object:?} has no inside and would get holes between samples: give it a thickness, or leave the voxels out"
            ),
            Self::Grid(error) => error.fmt(f),
            Self::Host(name) => write!(f, "{name} has no place for voxels: leave them out, or choose another target"),
        }
    }
}

impl std::error::Error for SampleError {}
