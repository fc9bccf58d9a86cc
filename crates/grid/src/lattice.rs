//! Where bricks and samples are.

use glam::{UVec3, Vec3};
use std::fmt;

/// Cells of a brick along each axis.
pub const CELLS: u32 = 8;

/// Samples of a brick along each axis: those on its faces belong to its neighbours, too, so that one brick is enough to interpolate
/// in.
pub const SAMPLES: u32 = CELLS + 1;

/// The fewest cells along the longest side: two bricks.
pub const FEWEST_CELLS: u32 = 2 * CELLS;

/// The most cells along the longest side: with more, the sample numbers of a full lattice would not fit into 32 bits.
pub const MOST_CELLS: u32 = 1024;

/// Cells left free on each side of what is sampled, so that its surface lies inside.
const BORDER: u32 = 1;

/// A box divided into bricks of cubic cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    min: Vec3,
    voxel: f32,
    bricks: UVec3,
}

/// Why a field can't be sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GridError {
    /// The number of cells along the longest side is not between [`FEWEST_CELLS`] and [`MOST_CELLS`].
    Cells(u32),
    /// The box has no size, or an endless one.
    Box {
        /// Its least corner.
        min: Vec3,
        /// Its greatest corner.
        max: Vec3,
    },
    /// The field has a value that is no finite number.
    Value {
        /// Where.
        at: Vec3,
    },
}

impl Lattice {
    /// A lattice around a box, with a number of cells along its longest side, one of which is left free at each end.
    ///
    /// # Errors
    /// If the number is out of range, or the box has no finite size.
    pub fn around(min: Vec3, max: Vec3, cells: u32) -> Result<Self, GridError> {
        if !(FEWEST_CELLS..=MOST_CELLS).contains(&cells) {
            return Err(GridError::Cells(cells));
        }
        let size = max - min;
        let voxel = size.max_element() / (cells - 2 * BORDER) as f32;
        if !size.is_finite() || !min.is_finite() || size.min_element() < 0.0 || voxel < f32::MIN_POSITIVE {
            return Err(GridError::Box { min, max });
        }
        // Rounding must not make another brick of a side that is a whole number of cells.
        let needed = (size / voxel - 1e-3).ceil() + 2.0 * BORDER as f32;
        let bricks = (needed / CELLS as f32).ceil().as_uvec3().max(UVec3::ONE);
        let whole = (bricks * CELLS).as_vec3() * voxel;
        Ok(Self { min: 0.5 * (min + max) - 0.5 * whole, voxel, bricks })
    }

    /// The least corner of the box.
    pub fn min(&self) -> Vec3 {
        self.min
    }

    /// The greatest corner of the box.
    pub fn max(&self) -> Vec3 {
        self.min + (self.bricks * CELLS).as_vec3() * self.voxel
    }

    /// The edge of a cell.
    pub fn voxel(&self) -> f32 {
        self.voxel
    }

    /// The edge of a brick.
    pub fn brick(&self) -> f32 {
        self.voxel * CELLS as f32
    }

    /// How many bricks there are along each axis.
    pub fn bricks(&self) -> UVec3 {
        self.bricks
    }

    /// How many bricks there are.
    pub fn count(&self) -> usize {
        self.bricks.to_array().iter().map(|&count| count as usize).product()
    }

    /// The number of a brick: x counts fastest, then y.
    pub fn number(&self, brick: UVec3) -> usize {
        let [x, y, z] = brick.to_array().map(|place| place as usize);
        x + self.bricks.x as usize * (y + self.bricks.y as usize * z)
    }

    /// The middle of a brick.
    pub fn middle(&self, brick: UVec3) -> Vec3 {
        self.min + (brick.as_vec3() + 0.5) * self.brick()
    }

    /// The place of a sample of a brick.
    pub fn place(&self, brick: UVec3, sample: UVec3) -> Vec3 {
        self.min + (brick * CELLS + sample).as_vec3() * self.voxel
    }

    /// The brick that holds a point, or the nearest one; and the point in cells from the least corner of the box.
    pub fn find(&self, p: Vec3) -> (UVec3, Vec3) {
        let cells = (p - self.min) / self.voxel;
        let brick = (cells / CELLS as f32).floor().max(Vec3::ZERO).as_uvec3().min(self.bricks - UVec3::ONE);
        (brick, cells)
    }
}

impl fmt::Display for GridError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cells(cells) => write!(
                f,
                "{cells} voxels along the longest side can't be sampled: choose {FEWEST_CELLS} to {MOST_CELLS}"
            ),
            Self::Box { min, max } => {
                write!(f, "the box from {min} to {max} can't be sampled: it must have a finite size")
            }
            Self::Value { at } => write!(f, "the field has no finite value at {at}, so it can't be sampled"),
        }
    }
}

impl std::error::Error for GridError {}
