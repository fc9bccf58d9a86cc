//! What programs are made of: operations, and how their constants follow from the numbers of a tree.

use crate::analysis::axis_map;
use crate::field::{Field, MaterialId};
use crate::formula::{Binary, Unary};
use crate::shape::{CombineTable, CopiesTable, MapTable, ModifyTable, PlaceTable, PrimitiveTable};
use glam::{DMat3, DVec3};
use std::collections::BTreeSet;
use std::ops::Range;

/// A part of the surface that shades as one: an object, or what is painted within it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Region {
    /// The index of the object among those compiled.
    pub object: usize,
    /// The innermost material painted, if any.
    pub material: Option<MaterialId>,
}

/// Where the constants of a structure's steps come from, and what it tells apart.
#[derive(Debug)]
pub(crate) struct Code {
    pub(crate) derive: Vec<Derive>,
    pub(crate) constants: usize,
    pub(crate) regions: Vec<Region>,
    /// The slots whose numbers shaped the code.
    pub(crate) fixed: BTreeSet<usize>,
}

/// A run of entries in a table: of constants, or of the slots of a tree's numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Run {
    start: u32,
    len: u32,
}

impl Run {
    pub(crate) fn range(self) -> Range<usize> {
        self.start as usize..(self.start + self.len) as usize
    }

    pub(crate) fn len(self) -> usize {
        self.len as usize
    }

    pub(crate) fn start(self) -> usize {
        self.start as usize
    }
}

impl From<Range<usize>> for Run {
    fn from(range: Range<usize>) -> Self {
        let number = |n: usize| u32::try_from(n).expect("tables have less than 2^32 entries");
        Self { start: number(range.start), len: number(range.len()) }
    }
}

/// The place of a step in its list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct StepId(pub(crate) u32);

impl StepId {
    /// The step that yields the point itself.
    pub(crate) const POINT: Self = Self(0);

    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// One step of a computation. Each yields one point or one value and reads only steps before it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Step {
    /// The point itself: always the first step, and only that.
    Point,
    /// The point `M p + t`.
    Affine { from: StepId, constants: Run },
    /// The point `map(p - at)`.
    Map { table: &'static MapTable, from: StepId, at: Run, constants: Run },
    /// The value `primitive(p - at)`.
    Primitive { table: &'static PrimitiveTable, point: StepId, at: Run, constants: Run, slope: u32, region: u32 },
    /// The value `combine(a, b)`.
    Combine { table: &'static CombineTable, a: StepId, b: StepId, constants: Run },
    /// The mixture of two values, by the share that follows from a height.
    Mix { a: StepId, b: StepId, height: StepId, constants: Run },
    /// The value `modify(from)`.
    Modify { table: &'static ModifyTable, from: StepId, constants: Run },
    /// The value `factor * from`.
    Scale { from: StepId, factor: u32 },
    /// A coordinate of the point `p - at`.
    Coordinate { point: StepId, axis: u8, at: Run },
    /// A constant.
    Literal { constant: u32 },
    /// A function of one value.
    Unary { op: Unary, from: StepId },
    /// A function of two values.
    Binary { op: Binary, a: StepId, b: StepId },
    /// An integer power.
    Power { from: StepId, exponent: i32 },
    /// The value of a formula as a whole, which belongs to a region.
    Surface { from: StepId, region: u32 },
    /// The value `op(from, by)`, which belongs to whatever `from` belongs to.
    Altered { op: Binary, from: StepId, by: StepId },
    /// The point with three values as its coordinates.
    Warp { x: StepId, y: StepId, z: StepId },
}

/// The region of what belongs to none, since it only bounds something that does.
pub(crate) const NO_REGION: u32 = u32::MAX;

impl Step {
    /// Calls `visit` once with each step that this one reads.
    pub(crate) fn operands(&self, mut visit: impl FnMut(StepId)) {
        match *self {
            Self::Point | Self::Literal { .. } => {}
            Self::Affine { from, .. }
            | Self::Map { from, .. }
            | Self::Modify { from, .. }
            | Self::Scale { from, .. }
            | Self::Unary { from, .. }
            | Self::Power { from, .. }
            | Self::Surface { from, .. } => visit(from),
            Self::Primitive { point, .. } | Self::Coordinate { point, .. } => visit(point),
            Self::Combine { a, b, .. } | Self::Binary { a, b, .. } | Self::Altered { from: a, by: b, .. } => {
                visit(a);
                if a != b {
                    visit(b);
                }
            }
            Self::Warp { x, y, z } | Self::Mix { a: x, b: y, height: z, .. } => {
                visit(x);
                if y != x {
                    visit(y);
                }
                if z != x && z != y {
                    visit(z);
                }
            }
        }
    }

    /// The step with each operand replaced.
    pub(crate) fn with_operands(mut self, map: impl Fn(StepId) -> StepId) -> Self {
        match &mut self {
            Self::Point | Self::Literal { .. } => {}
            Self::Affine { from, .. }
            | Self::Map { from, .. }
            | Self::Modify { from, .. }
            | Self::Scale { from, .. }
            | Self::Unary { from, .. }
            | Self::Power { from, .. }
            | Self::Surface { from, .. } => *from = map(*from),
            Self::Primitive { point, .. } | Self::Coordinate { point, .. } => *point = map(*point),
            Self::Combine { a, b, .. } | Self::Binary { a, b, .. } | Self::Altered { from: a, by: b, .. } => {
                *a = map(*a);
                *b = map(*b);
            }
            Self::Warp { x, y, z } | Self::Mix { a: x, b: y, height: z, .. } => {
                [x, y, z].into_iter().for_each(|id| *id = map(*id));
            }
        }
        self
    }

    /// Whether it yields a point.
    pub(crate) fn is_point(&self) -> bool {
        matches!(self, Self::Point | Self::Affine { .. } | Self::Map { .. } | Self::Warp { .. })
    }
}

/// A computation of one value from a point.
#[derive(Clone, Debug)]
pub(crate) struct Steps {
    pub(crate) list: Vec<Step>,
    /// The step that yields the result; `None` if there is nothing, which is infinitely far.
    pub(crate) result: Option<StepId>,
}

/// How a run of constants follows from the numbers of the tree.
#[derive(Clone, Debug)]
pub(crate) enum Derive {
    /// A node's own `prepare`.
    Prepare { prepare: fn(&[f64]) -> Vec<f64>, args: Range<usize>, out: Range<usize> },
    /// None, but a primitive falls into these parts.
    Parts { table: &'static PrimitiveTable, args: Range<usize>, parts: Vec<usize> },
    /// The inverse of a chain of affine maps, to be applied to points of a register.
    Affine { chain: Vec<Link>, from_root: bool, out: Range<usize> },
    /// The same for a chain of translations: what to subtract.
    Offset { chain: Vec<Link>, from_root: bool, out: Range<usize> },
    /// The mixture of a loft that goes from figure `index` to the next of `count`.
    Mixture { args: Range<usize>, index: usize, count: usize, out: Range<usize> },
    /// All of an endless repetition with these numbers in its tree, of as many copies as there were when it was compiled.
    Endless { field: Field, numbers: Range<usize>, out: Range<usize> },
    /// Numbers that are no arguments: those of a formula's text.
    Literals { numbers: Vec<f64>, out: Range<usize> },
    /// The largest slope of a primitive; infinite if it is not known.
    Slope { table: &'static PrimitiveTable, args: Range<usize>, out: usize },
    /// A placing node's factor.
    Factor { table: &'static PlaceTable, args: Range<usize>, out: usize },
}

/// One affine map of a chain, outermost first.
#[derive(Clone, Debug)]
pub(crate) enum Link {
    /// A placing node.
    Place { table: &'static PlaceTable, args: Range<usize> },
    /// One of several copies.
    Copy { table: &'static CopiesTable, args: Range<usize>, index: usize },
    /// An axial shape's own axis, which is the last of its arguments.
    Axis { arg: usize },
}

impl Link {
    pub(crate) fn is_translation(&self) -> bool {
        match self {
            Self::Place { table, .. } => table.is_translation,
            Self::Copy { table, .. } => table.are_moved,
            Self::Axis { .. } => false,
        }
    }

    /// The map of this link.
    pub(crate) fn map(&self, values: &[f64]) -> glam::DAffine3 {
        match self {
            Self::Place { table, args, .. } => (table.map)(&values[args.clone()]),
            Self::Copy { table, args, index } => table.map(&values[args.clone()], *index),
            Self::Axis { arg } => glam::DAffine3::from_mat3(axis_map(values[*arg] as usize)),
        }
    }
}

/// The translation and linear part of the inverse of a chain of maps.
pub(crate) fn inverse_of(chain: &[Link], values: &[f64]) -> (DMat3, DVec3) {
    let map = chain.iter().fold(glam::DAffine3::IDENTITY, |map, link| map * link.map(values));
    let inverse = map.inverse();
    (inverse.matrix3, inverse.translation)
}
