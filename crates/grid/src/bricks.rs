//! Taking samples: coarse ones everywhere, fine ones near the surface.

use crate::lattice::{CELLS, GridError, Lattice, SAMPLES};
use glam::{UVec3, Vec3};

/// Bricks are kept if something within this many voxels of a surface may lie in them: central differences at a surface reach one
/// voxel far, and the samples around that another one.
pub const MARGIN: u32 = 2;

/// Half the diagonal of a cube over its edge, rounded up.
pub(crate) const HALF_DIAGONAL: f32 = 0.866_025_6;

/// So many bricks along each axis have their middles evaluated at once.
const BLOCK: u32 = 4;

/// What a brick without fine samples holds in place of their number.
pub(crate) const EMPTY: u32 = u32::MAX;

/// What is sampled. Values must not differ by more than the distance of their points: a field of another slope is to be
/// divided by it.
pub trait Source {
    /// The values at points, all of which lie in a block.
    fn values(&mut self, block: &Block, points: &Points, values: &mut [f32]);

    /// The numbers of what is nearest to points, all of which lie in a block.
    fn labels(&mut self, block: &Block, points: &Points, labels: &mut [u32]);
}

/// A box that holds all points that are asked for at once, so that a source may leave out what does not matter there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Its least corner.
    pub min: Vec3,
    /// Its greatest corner.
    pub max: Vec3,
}

/// Points, coordinate by coordinate.
#[derive(Clone, Debug, Default)]
#[allow(missing_docs, reason = "the coordinates speak for themselves")]
pub struct Points {
    pub x: Vec<f32>,
    pub y: Vec<f32>,
    pub z: Vec<f32>,
}

impl Points {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.x.len()
    }

    /// One after another.
    pub fn iter(&self) -> impl Iterator<Item = Vec3> {
        self.x.iter().zip(&self.y).zip(&self.z).map(|((&x, &y), &z)| Vec3::new(x, y, z))
    }

    fn set(&mut self, points: impl Iterator<Item = Vec3>) {
        [&mut self.x, &mut self.y, &mut self.z].into_iter().for_each(Vec::clear);
        for p in points {
            self.x.push(p.x);
            self.y.push(p.y);
            self.z.push(p.z);
        }
    }
}

/// A sampled field.
#[derive(Clone, Debug)]
pub struct Bricks {
    pub(crate) lattice: Lattice,
    /// The values in the middles of all bricks.
    pub(crate) middles: Vec<f32>,
    /// The number of each brick among those with fine samples, or [`EMPTY`].
    pub(crate) slots: Vec<u32>,
    /// The fine samples, brick by brick; x counts fastest, then y.
    pub(crate) values: Vec<f32>,
    pub(crate) labels: Vec<u32>,
}

impl Bricks {
    /// Samples a field. The same source gives the same bits.
    ///
    /// # Errors
    /// If a value is not finite.
    pub fn sample(lattice: Lattice, source: &mut impl Source) -> Result<Self, GridError> {
        let mut points = Points::default();
        let middles = middles(&lattice, source, &mut points)?;
        let mut bricks =
            Self { lattice, slots: vec![EMPTY; middles.len()], middles, values: Vec::new(), labels: Vec::new() };
        let reach = HALF_DIAGONAL * lattice.brick() + MARGIN as f32 * lattice.voxel();
        let mut kept = 0;
        for brick in all(UVec3::ZERO, lattice.bricks()) {
            let number = lattice.number(brick);
            if bricks.middles[number].abs() > reach {
                continue;
            }
            bricks.slots[number] = kept;
            kept += 1;
            points.set(all(UVec3::ZERO, UVec3::splat(SAMPLES)).map(|sample| lattice.place(brick, sample)));
            let block =
                Block { min: lattice.place(brick, UVec3::ZERO), max: lattice.place(brick, UVec3::splat(CELLS)) };
            let start = bricks.values.len();
            bricks.values.resize(start + points.count(), 0.0);
            bricks.labels.resize(start + points.count(), 0);
            source.values(&block, &points, &mut bricks.values[start..]);
            check(&points, &bricks.values[start..])?;
            source.labels(&block, &points, &mut bricks.labels[start..]);
        }
        Ok(bricks)
    }

    /// Where the samples are.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// How many bricks have fine samples.
    pub fn kept(&self) -> usize {
        self.values.len() / SAMPLES.pow(3) as usize
    }

    /// For each brick, by [`Lattice::number`], the value in its middle, and its number among those with fine samples.
    pub fn coarse(&self) -> impl Iterator<Item = (f32, Option<u32>)> {
        self.middles.iter().zip(&self.slots).map(|(&middle, &slot)| (middle, (slot != EMPTY).then_some(slot)))
    }

    /// The values and labels of all fine samples, [`SAMPLES`] cubed for each brick that has some; x counts fastest, then y.
    pub fn fine(&self) -> impl Iterator<Item = (f32, u32)> {
        self.values.iter().copied().zip(self.labels.iter().copied())
    }

    /// The bytes that all samples take.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.middles)
            + size_of_val(&*self.slots)
            + size_of_val(&*self.values)
            + size_of_val(&*self.labels)
    }
}

/// The values in the middles of all bricks.
fn middles(lattice: &Lattice, source: &mut impl Source, points: &mut Points) -> Result<Vec<f32>, GridError> {
    let mut middles = vec![0.0; lattice.count()];
    let mut values = Vec::new();
    for block in all(UVec3::ZERO, (lattice.bricks() + (BLOCK - 1)) / BLOCK) {
        let (first, end) = (block * BLOCK, ((block + UVec3::ONE) * BLOCK).min(lattice.bricks()));
        points.set(all(first, end).map(|brick| lattice.middle(brick)));
        values.clear();
        values.resize(points.count(), 0.0);
        let around = Block { min: lattice.place(first, UVec3::ZERO), max: lattice.place(end, UVec3::ZERO) };
        source.values(&around, points, &mut values);
        check(points, &values)?;
        all(first, end).zip(&values).for_each(|(brick, &value)| middles[lattice.number(brick)] = value);
    }
    Ok(middles)
}

fn check(points: &Points, values: &[f32]) -> Result<(), GridError> {
    match points.iter().zip(values).find(|(_, value)| !value.is_finite()) {
        Some((at, _)) => Err(GridError::Value { at }),
        None => Ok(()),
    }
}

/// All places from a first one up to but without an end, x fastest, then y.
fn all(first: UVec3, end: UVec3) -> impl Iterator<Item = UVec3> {
    (first.z..end.z)
        .flat_map(move |z| (first.y..end.y).flat_map(move |y| (first.x..end.x).map(move |x| UVec3::new(x, y, z))))
}
