//! Enclosures of a field along stretches of rays, in batches.
//!
//! For each stretch: bounds of the field's values on it, and bounds of the derivative along the ray. They hold for every
//! point of the stretch, rounding errors included; so a field that is no distance can be searched for its zeros without
//! missing one (Mitchell, "Robust ray intersection with interval arithmetic", 1990).

use crate::bank::{Bank, Jets, Models, Number, Ranges, Reach};
use crate::kernel::{BATCH, Block, WIDEST};
use crate::program::{Part, Program};
use crate::simd::{self, Level};
use std::ops::Range;

/// Stretches of rays, from `near` to `far`, coordinate by coordinate, relative to the program's origin. Directions have
/// length 1.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "described above")]
pub struct Stretches<'a> {
    pub origin: [&'a [f32]; 3],
    pub direction: [&'a [f32]; 3],
    pub near: &'a [f32],
    pub far: &'a [f32],
}

impl Stretches<'_> {
    /// How many there are.
    ///
    /// # Panics
    /// If the lists differ in length.
    pub fn count(&self) -> usize {
        let count = self.near.len();
        let lists = self.origin.iter().chain(&self.direction).chain([&self.far]);
        lists.for_each(|list| assert_eq!(list.len(), count, "the lists differ in length"));
        count
    }
}

/// Places for lower and for upper bounds.
pub type Bounds<'a> = [&'a mut [f32]; 2];

/// Encloses a program. The scratch memory of one thread.
pub struct Encloser<'p> {
    program: &'p Program,
    level: Level,
    ranges: Bank<Ranges>,
    jets: Bank<Jets>,
    models: Bank<Models>,
    /// Origins, directions, middles and halves of stretches.
    lanes: [Block; 8],
}

/// The middles of stretches of rays and half their lengths, as lanes to be filled. The stretch holds the points
/// `origin + (middle + s half) direction` for `-1 <= s <= 1`.
#[allow(missing_docs, reason = "described above")]
pub struct StretchLanes<'a> {
    pub origin: [&'a mut [f32]; 3],
    pub direction: [&'a mut [f32]; 3],
    pub middle: &'a mut [f32],
    pub half: &'a mut [f32],
}

/// Taylor models of a field along stretches of rays: `|f(s) - p(s)| <= r` for `-1 <= s <= 1`.
#[derive(Clone, Copy)]
pub struct ModelLanes<'a> {
    /// The coefficients of `p`, that of the lowest power first; NaN where the field has no value.
    pub p: [&'a [f32]; 5],
    /// The bound; infinite where nothing is known.
    pub r: &'a [f32],
}

/// Taylor models of what a field's zeros are those of.
#[derive(Clone, Copy)]
pub struct ZeroLanes<'a> {
    /// The first field.
    pub first: ModelLanes<'a>,
    /// Whether its absolute values count: there is a surface wherever its sign changes.
    pub is_sheet: bool,
    /// Another field; the larger one of both counts.
    pub cut: Option<ModelLanes<'a>>,
}

/// How much longer than 1 a direction in single precision may be.
const LONGEST: f32 = 1.0 + 4.0 * f32::EPSILON;

/// What a coordinate on a ray is uncertain by, relative to the numbers it is computed from.
const ROUNDING: f32 = 2.0 * f32::EPSILON;

impl<'p> Encloser<'p> {
    /// Works on a given instruction set. The results are the same bits on all of them.
    pub fn new(program: &'p Program, level: Level) -> Self {
        Self {
            program,
            level,
            ranges: Bank::default(),
            jets: Bank::default(),
            models: Bank::default(),
            lanes: Default::default(),
        }
    }

    /// The instruction set it runs on.
    pub fn level(&self) -> Level {
        self.level
    }

    /// Bounds of the values on each stretch, all of which lie where `part` holds.
    ///
    /// # Panics
    /// If a result has not as many places as there are stretches.
    pub fn values(&mut self, part: &Part, stretches: &Stretches<'_>, [lo, hi]: Bounds<'_>) {
        let count = stretches.count();
        let listing = part.listing();
        let Some(result) = listing.result else {
            lo.fill(f32::INFINITY);
            return hi.fill(f32::INFINITY);
        };
        self.ranges.prepare(listing);
        for batch in (0..count).step_by(BATCH).map(|start| start..(start + BATCH).min(count)) {
            let lanes = load(&mut self.ranges, stretches, batch.clone());
            self.ranges.run(self.program, &listing.ops, self.level, lanes);
            for (out, from) in [&mut *lo, &mut *hi].into_iter().zip(self.ranges.value(result)) {
                out[batch.clone()].copy_from_slice(&from.0[..batch.len()]);
            }
        }
    }

    /// Taylor models along `count` stretches that `fill` writes, all of which lie where `part` holds.
    ///
    /// # Panics
    /// If `count` is above [`BATCH`] or no multiple of [`WIDEST`].
    pub fn models(&mut self, part: &Part, count: usize, fill: impl FnOnce(StretchLanes<'_>)) -> ZeroLanes<'_> {
        assert!(count <= BATCH && count.is_multiple_of(WIDEST), "whole vectors, at most a batch");
        let zeros = part.zeros();
        let listing = &zeros.listing;
        let Some(result) = listing.result else {
            let zero = &ZERO.0[..count];
            let first = ModelLanes { p: [&FAR.0[..count], zero, zero, zero, zero], r: zero };
            return ZeroLanes { first, is_sheet: false, cut: None };
        };
        let [ox, oy, oz, dx, dy, dz, middle, half] = self.lanes.each_mut().map(|block| &mut block.0[..count]);
        fill(StretchLanes { origin: [ox, oy, oz], direction: [dx, dy, dz], middle, half });
        self.models.prepare(listing);
        let Self { models, lanes, .. } = self;
        let [.., middle, half] = lanes.each_ref().map(|block| &block.0[..count]);
        simd::with(
            self.level,
            #[inline(always)]
            || {
                for axis in 0..3 {
                    let (origin, direction) = (&lanes[axis].0[..count], &lanes[axis + 3].0[..count]);
                    let number = &mut models.points[axis * Models::COMPONENTS..(axis + 1) * Models::COMPONENTS];
                    let [constant, slope, a, b, c, rest] = number else { unreachable!("six components") };
                    for blank in [a, b, c] {
                        blank.0[..count].fill(0.0);
                    }
                    let (constant, slope, rest) =
                        (&mut constant.0[..count], &mut slope.0[..count], &mut rest.0[..count]);
                    for lane in 0..count {
                        let (o, d) = (origin[lane], direction[lane]);
                        constant[lane] = o + middle[lane] * d;
                        slope[lane] = half[lane] * d;
                        rest[lane] = ROUNDING * (o.abs() + middle[lane].abs() + half[lane].abs()) + f32::MIN_POSITIVE;
                    }
                }
            },
        );
        let [ox, oy, oz, _, _, _, middle, half] = lanes.each_ref().map(|block| &block.0[..count]);
        let reach = &mut models.reach[0];
        for (lane, radius) in reach.radius.0[..count].iter_mut().enumerate() {
            let size = ox[lane].abs() + oy[lane].abs() + oz[lane].abs() + middle[lane].abs() + half[lane];
            *radius = half[lane] * LONGEST + 2.0 * ROUNDING * size;
        }
        reach.speed.0[..count].fill(LONGEST);
        models.run(self.program, &listing.ops, self.level, count);
        let model = |register| {
            let [p0, p1, p2, p3, p4, r] = models.value(register) else { unreachable!("six components") };
            ModelLanes { p: [p0, p1, p2, p3, p4].map(|term| &term.0[..count]), r: &r.0[..count] }
        };
        ZeroLanes { first: model(result), is_sheet: zeros.is_sheet, cut: zeros.cut.map(model) }
    }

    /// Bounds of the values on each stretch, and of the derivative along it.
    ///
    /// # Panics
    /// If a result has not as many places as there are stretches.
    pub fn jets(&mut self, part: &Part, stretches: &Stretches<'_>, [lo, hi]: Bounds<'_>, [least, most]: Bounds<'_>) {
        let count = stretches.count();
        let listing = part.listing();
        let Some(result) = listing.result else {
            lo.fill(f32::INFINITY);
            hi.fill(f32::INFINITY);
            least.fill(0.0);
            return most.fill(0.0);
        };
        self.jets.prepare(listing);
        for batch in (0..count).step_by(BATCH).map(|start| start..(start + BATCH).min(count)) {
            let lanes = load(&mut self.jets, stretches, batch.clone());
            for axis in 0..3 {
                let number = &mut self.jets.points[4 * axis..4 * axis + 4];
                number[2].0[..batch.len()].copy_from_slice(&stretches.direction[axis][batch.clone()]);
                number[2].0[batch.len()..lanes].fill(0.0);
                let [.., from, to] = number else { unreachable!("four components") };
                to.0[..lanes].copy_from_slice(&from.0[..lanes]);
            }
            self.jets.run(self.program, &listing.ops, self.level, lanes);
            let outs = [&mut *lo, &mut *hi, &mut *least, &mut *most];
            for (out, from) in outs.into_iter().zip(self.jets.value(result)) {
                out[batch.clone()].copy_from_slice(&from.0[..batch.len()]);
            }
        }
    }
}

/// The field of nothing.
static FAR: Block = Block([f32::INFINITY; BATCH]);
static ZERO: Block = Block([0.0; BATCH]);

/// Fills the values of point register 0, and what belongs to it, and returns how many lanes to run.
fn load<N: Number<Reach = Reach>>(bank: &mut Bank<N>, stretches: &Stretches<'_>, batch: Range<usize>) -> usize {
    let lanes = batch.len().next_multiple_of(WIDEST);
    let (near, far) = (&stretches.near[batch.clone()], &stretches.far[batch.clone()]);
    for axis in 0..3 {
        let (origin, direction) = (&stretches.origin[axis][batch.clone()], &stretches.direction[axis][batch.clone()]);
        let number = &mut bank.points[axis * N::COMPONENTS..(axis + 1) * N::COMPONENTS];
        let [lo, hi, ..] = number else { unreachable!("two ends at least") };
        for lane in 0..near.len() {
            let (o, d) = (origin[lane], direction[lane]);
            let (first, last) = (o + near[lane] * d, o + far[lane] * d);
            let slack = ROUNDING * (o.abs() + far[lane].abs());
            lo.0[lane] = first.min(last) - slack;
            hi.0[lane] = first.max(last) + slack;
        }
        lo.0[near.len()..lanes].fill(0.0);
        hi.0[near.len()..lanes].fill(0.0);
    }
    let reach = &mut bank.reach[0];
    for lane in 0..near.len() {
        let size = stretches.origin.iter().fold(far[lane].abs(), |size, o| size + o[batch.start + lane].abs());
        reach.radius.0[lane] = 0.5 * (far[lane] - near[lane]) * LONGEST + 2.0 * ROUNDING * size;
    }
    reach.radius.0[near.len()..lanes].fill(0.0);
    reach.speed.0[..lanes].fill(LONGEST);
    lanes
}
