//! What programs are made of: operations, and how their constants follow from the numbers of a tree.

use crate::analysis::axis_map;
use crate::field::MaterialId;
use crate::shape::{CombineTable, ModifyTable, PlaceTable, PrimitiveTable};
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

/// The operations of a structure.
#[derive(Debug)]
pub(crate) struct Code {
    pub(crate) ops: Vec<Op>,
    /// The operations that keep every intermediate value, for shares.
    pub(crate) share_ops: Vec<Op>,
    pub(crate) derive: Vec<Derive>,
    pub(crate) constants: usize,
    pub(crate) registers: Registers,
    pub(crate) share_registers: Registers,
    pub(crate) regions: Vec<Region>,
    /// The slots whose numbers shaped the code.
    pub(crate) fixed: BTreeSet<usize>,
}

/// How many registers of each kind a program needs, and where the result ends up.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Registers {
    pub(crate) points: usize,
    pub(crate) values: usize,
    pub(crate) result: usize,
}

/// One operation. Registers are numbered from 0; point register 0 holds the point itself. No operation writes to a register
/// it reads.
#[derive(Clone, Debug)]
pub(crate) enum Op {
    /// `points[to] = M points[from] + t`.
    Affine { from: usize, to: usize, constants: Range<usize> },
    /// `values[out] = primitive(points[point] - at)`, or the minimum of `values[before]` and that.
    Primitive {
        table: &'static PrimitiveTable,
        point: usize,
        at: Range<usize>,
        constants: Range<usize>,
        before: Option<usize>,
        out: usize,
        region: usize,
    },
    /// `values[out] = combine(values[a], values[b])`.
    Combine { table: &'static CombineTable, a: usize, b: usize, out: usize, constants: Range<usize> },
    /// `values[out] = modify(values[from])`.
    Modify { table: &'static ModifyTable, from: usize, out: usize, constants: Range<usize> },
    /// `values[out] = factor * values[from]`.
    Scale { from: usize, out: usize, factor: usize },
}

/// How a run of constants follows from the numbers of the tree.
#[derive(Clone, Debug)]
pub(crate) enum Derive {
    /// A node's own `prepare`.
    Prepare { prepare: fn(&[f64]) -> Vec<f64>, args: Range<usize>, out: Range<usize> },
    /// The inverse of a chain of affine maps, to be applied to points of a register.
    Affine { chain: Vec<Link>, from_root: bool, out: Range<usize> },
    /// The same for a chain of translations: what to subtract.
    Offset { chain: Vec<Link>, from_root: bool, out: Range<usize> },
    /// A placing node's factor.
    Factor { table: &'static PlaceTable, args: Range<usize>, out: usize },
}

/// One affine map of a chain, outermost first.
#[derive(Clone, Debug)]
pub(crate) enum Link {
    /// A placing node.
    Place { table: &'static PlaceTable, args: Range<usize> },
    /// An axial shape's own axis, which is the last of its arguments.
    Axis { arg: usize },
}

impl Link {
    pub(crate) fn is_translation(&self) -> bool {
        matches!(self, Self::Place { table, .. } if table.is_translation)
    }

    /// The slot of its first number, which tells links apart.
    pub(crate) fn slot(&self) -> usize {
        match self {
            Self::Place { args, .. } => args.start,
            Self::Axis { arg } => *arg,
        }
    }

    /// The map of this link.
    pub(crate) fn map(&self, values: &[f64]) -> glam::DAffine3 {
        match self {
            Self::Place { table, args, .. } => (table.map)(&values[args.clone()]),
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
