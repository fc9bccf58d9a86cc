//! Where the numbers of a scene are in the table of parameters.
//!
//! First come numbers that every scene has, at places that are the same for all; then the boxes of parts, the hierarchy of many,
//! planes, the materials of regions, and the constants of the parts' functions; last the lights, since their number may change.

use crate::hierarchy::{self, NODE_SIZE};
use crate::tree::{Expr, Item, Type};

/// What every scene has, with how many numbers.
const HEADER: &[(&str, usize)] = &[
    ("EYE", 3),
    ("RIGHT", 3),
    ("UP", 3),
    ("FORWARD", 3),
    ("TARGET", 3),
    ("HALF", 1),
    ("IS_HORIZONTAL", 1),
    ("IS_PERSPECTIVE", 1),
    ("FOOTPRINT", 2),
    ("TOLERANCE", 4),
    ("SCALE", 1),
    ("STEP_FACTOR", 1),
    ("MAX_STEPS", 1),
    ("MAX_DISTANCE", 1),
    ("BOUNDS", 6),
    ("AMBIENT", 6),
    ("BACKGROUND", 6),
    ("OCCLUSION", 10),
    ("GAIN", 1),
    ("SCALES_DOWN", 1),
    ("WARNING", 4),
    ("SCENE_SIZE", 1),
    ("LIGHT_COUNT", 1),
];

/// Numbers of a part: the middle of its box and half its edges, what its values are multiplied with for steps, and how much
/// its box is larger than needed; the number of its form, the place of its constants, whether
/// its values are distances (0), warped distances (1) or have no scale (2); and how fast its slope can fall along a line, or -1.
pub(crate) const PART_SIZE: usize = 12;
/// Numbers of a part that is one of many: the form of its surface, or -1 if it is of one region, and the place of the second
/// of its regions.
pub(crate) const SURFACE_SIZE: usize = 2;
/// Numbers of a sampled scene: the least corner of its box, the edge of a voxel, how many bricks there are along each axis, and in
/// all, which is where fine samples begin in their table.
pub(crate) const VOXELS_SIZE: usize = 8;
/// Numbers of a plane: normal, offset, whether it is a sheet, and the slope of its field.
pub(crate) const PLANE_SIZE: usize = 6;
/// Numbers of a region: two colours, the size of the pattern (0 for none) and its phase, emitted light, shares of ambient,
/// diffuse and specular light, exponent, whether the model is Blinn's, the object, a spare one, whether it is a sheet.
pub(crate) const REGION_SIZE: usize = 21;
/// Numbers of a light: kind, place, power, falloff, whether it has a cone, its axis and two cosines, the kind of shadow and
/// its measure.
pub(crate) const LIGHT_SIZE: usize = 18;

/// With fewer parts each of them is a line of its own in the text, under its name. Many are found through a hierarchy of boxes, and
/// share a function with all others of the same form. In software 10 parts take as long either way, 20 half as long by the
/// hierarchy.
const FEWEST_OF_MANY: usize = 12;

/// Places of everything whose number depends on the scene.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) parts: usize,
    pub(crate) part_count: usize,
    /// Parts that need a slope to be marched.
    pub(crate) formula_count: usize,
    /// Nodes of the hierarchy, of which there are none if parts are few.
    pub(crate) nodes: usize,
    pub(crate) node_count: usize,
    /// What is known of the surfaces of parts, if they are many.
    pub(crate) surfaces: usize,
    /// Where samples are, if there are some.
    pub(crate) voxels: usize,
    pub(crate) planes: usize,
    pub(crate) plane_count: usize,
    pub(crate) regions: usize,
    pub(crate) constants: usize,
    pub(crate) lights: usize,
}

/// How much of everything a scene has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counts {
    pub(crate) parts: usize,
    pub(crate) formulas: usize,
    pub(crate) planes: usize,
    pub(crate) regions: usize,
    pub(crate) constants: usize,
    /// Whether its only part are samples.
    pub(crate) is_sampled: bool,
}

impl Layout {
    pub(crate) fn new(counts: &Counts) -> Self {
        let Counts { parts: part_count, formulas: formula_count, planes: plane_count, .. } = *counts;
        let parts: usize = HEADER.iter().map(|(_, count)| count).sum();
        // Nodes are aligned, so that vectors of four hold what belongs together.
        let (nodes, node_count, surface_count) = match parts + PART_SIZE * part_count {
            end if part_count < FEWEST_OF_MANY => (end, 0, 0),
            end => (end.next_multiple_of(4), hierarchy::node_count(part_count), part_count),
        };
        let surfaces = nodes + NODE_SIZE * node_count;
        let voxels = surfaces + SURFACE_SIZE * surface_count;
        let planes = voxels + if counts.is_sampled { VOXELS_SIZE } else { 0 };
        let regions = planes + PLANE_SIZE * plane_count;
        // Aligned, so that vectors of four hold what belongs together more often.
        let constants = (regions + REGION_SIZE * counts.regions).next_multiple_of(4);
        let lights = (constants + counts.constants).next_multiple_of(4);
        Self {
            parts,
            part_count,
            formula_count,
            nodes,
            node_count,
            surfaces,
            voxels,
            planes,
            plane_count,
            regions,
            constants,
            lights,
        }
    }

    /// Whether parts are found through the hierarchy.
    pub(crate) fn is_many(&self) -> bool {
        self.node_count > 0
    }

    /// The places and sizes as constants of the module.
    pub(crate) fn items(&self) -> Vec<Item> {
        let mut place = 0;
        let mut places: Vec<(&str, usize)> = Vec::new();
        for &(name, count) in HEADER {
            places.push((name, place));
            place += count;
        }
        places.extend([
            ("PARTS", self.parts),
            ("PART_SIZE", PART_SIZE),
            ("PART_COUNT", self.part_count),
            ("FORMULA_COUNT", self.formula_count),
            ("NODES", self.nodes),
            ("NODE_SIZE", NODE_SIZE),
            ("NODES_END", self.nodes + NODE_SIZE * self.node_count),
            ("SURFACES", self.surfaces),
            ("SURFACE_SIZE", SURFACE_SIZE),
            ("VOXELS", self.voxels),
            ("CELLS", freikugel_grid::CELLS as usize),
            ("SAMPLES", freikugel_grid::SAMPLES as usize),
            ("MARGIN", freikugel_grid::MARGIN as usize),
            ("PLANES", self.planes),
            ("PLANE_SIZE", PLANE_SIZE),
            ("PLANE_COUNT", self.plane_count),
            ("REGIONS", self.regions),
            ("REGION_SIZE", REGION_SIZE),
            ("LIGHTS", self.lights),
            ("LIGHT_SIZE", LIGHT_SIZE),
        ]);
        let constant = |(index, (name, place)): (usize, (&str, usize))| {
            let comment =
                if index == 0 { vec!["Places in the table of parameters, and counts.".to_owned()] } else { Vec::new() };
            Item::Constant(name.into(), Type::Int, Expr::Int(place as i64), comment)
        };
        places.into_iter().enumerate().map(constant).collect()
    }

    /// Writes numbers of the header.
    pub(crate) fn set(table: &mut [f32], name: &str, numbers: &[f64]) {
        let mut place = 0;
        for &(own, count) in HEADER {
            if own == name {
                assert_eq!(count, numbers.len(), "{name} has {count} numbers");
                write(&mut table[place..place + count], numbers);
                return;
            }
            place += count;
        }
        panic!("no number is called {name}");
    }
}

/// Writes numbers in single precision.
pub(crate) fn write(to: &mut [f32], numbers: &[f64]) {
    for (to, number) in to.iter_mut().zip(numbers) {
        *to = *number as f32;
    }
}
