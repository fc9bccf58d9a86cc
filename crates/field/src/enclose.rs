//! Taylor models of a field along stretches of rays, in batches.
//!
//! For each stretch: a polynomial in the place along it, and a bound of how far the field may be from that anywhere on the
//! stretch, rounding errors included; so a field that is no distance can be searched for its zeros without missing one
//! (Makino and Berz, "Taylor models and other validated functional inclusion methods", 2003).

use crate::bank::{Bank, Models, Number};
use crate::kernel::{BATCH, Block, WIDEST};
use crate::program::{Part, Program};
use crate::simd::{self, Level};

/// Encloses a program. The scratch memory of one thread.
pub struct Encloser<'p> {
    program: &'p Program,
    level: Level,
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
        Self { program, level, models: Bank::default(), lanes: Default::default() }
    }

    /// The instruction set it runs on.
    pub fn level(&self) -> Level {
        self.level
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
        for (lane, radius) in reach.0.0[..count].iter_mut().enumerate() {
            let size = ox[lane].abs() + oy[lane].abs() + oz[lane].abs() + middle[lane].abs() + half[lane];
            *radius = half[lane] * LONGEST + 2.0 * ROUNDING * size;
        }
        models.run(self.program, &listing.ops, self.level, count);
        let model = |register| {
            let [p0, p1, p2, p3, p4, r] = models.value(register) else { unreachable!("six components") };
            ModelLanes { p: [p0, p1, p2, p3, p4].map(|term| &term.0[..count]), r: &r.0[..count] }
        };
        ZeroLanes { first: model(result), is_sheet: zeros.is_sheet, cut: zeros.cut.map(model) }
    }
}

/// The field of nothing.
static FAR: Block = Block([f32::INFINITY; BATCH]);
static ZERO: Block = Block([0.0; BATCH]);
