//! Rays that travel side by side: what they are, what is known about them, and where they meet a box.
//!
//! A [`Bundle`] holds as many rays as a batch of field values, in rows of as many as the widest vector has lanes. Everything
//! happens to whole rows: rays that have nothing to do keep their lane and change nothing, so that no ray ever has to be
//! moved. What a ray ends with depends on nothing but the ray itself.

use crate::march::{End, Fate, Start};
use crate::rays::Starts;
use crate::vector::Triple;
use freikugel_field::kernel::{BATCH, Block, WIDEST};
use freikugel_field::simd::{self, Level};

/// The rays of a bundle.
pub(crate) const RAYS: usize = BATCH;

/// The rays of a row.
pub(crate) const LANES: usize = WIDEST;

/// The rows of a bundle.
const ROWS: usize = RAYS / LANES;

/// Where a ray enters and leaves a box is known up to this part of the distances involved. Parts hold as much beyond their
/// boxes.
const SEAM: f32 = 4.0 * f32::EPSILON;

/// What the planes of a box are moved outward by for a shaft, relative to the coordinates involved: more than the rounding
/// errors of a ray's test.
const SHAFT_ROUNDING: f32 = 16.0 * f32::EPSILON;

/// As [`SEAM`], for shafts: more than that of a ray on both sides.
pub(crate) const SHAFT_SEAM: f32 = 4.0 * SEAM;

/// Stands for the components of a direction that are 0, so that no product of 0 and infinity arises.
const LEAST_COMPONENT: f32 = 1e-30;

/// One number for each ray of a row.
pub(crate) type Row = [f32; LANES];

/// Some rows of a bundle, by their places.
#[derive(Clone, Copy, Default)]
pub(crate) struct Rows {
    places: [u8; ROWS],
    count: usize,
}

/// Rays whose directions have the same signs.
pub(crate) struct Bundle {
    count: usize,
    id: [u32; RAYS],
    pub(crate) origin: [Block; 3],
    pub(crate) direction: [Block; 3],
    inverse: [Block; 3],
    /// Where on each ray to begin, and beyond what nothing can change its fate any more.
    near: Block,
    far: Block,
    /// The field value that counts as a hit: at the origin, and what it gains per unit of distance.
    pub(crate) base: Block,
    pub(crate) growth: Block,
    pub(crate) sharpness: Block,
    /// Steps taken so far.
    pub(crate) steps: [u32; RAYS],
    /// For soft marches: the factor so far, and the ratio at the last step times the sharpness.
    pub(crate) factor: Block,
    pub(crate) before: Block,
    /// The stretch of each ray in the box tested last; none (`leave` is -∞) if it does not meet that.
    pub(crate) enter: Block,
    pub(crate) leave: Block,
    /// The field value where each ray is.
    pub(crate) value: Block,
    fate: [Fate; RAYS],
    /// Where each ray ended, and the value there: others of its row may go on.
    t: [f32; RAYS],
    last: [f32; RAYS],
    /// The rays that met something, and in which place, in the order in which they did.
    found: Vec<(u32, u32)>,
}

impl Rows {
    /// The first rows, enough for `rays` rays.
    fn of(rays: usize) -> Self {
        Self { places: std::array::from_fn(|row| row as u8), count: rays.div_ceil(LANES) }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// How many lanes they have together.
    pub(crate) fn lanes(&self) -> usize {
        self.count * LANES
    }

    /// The places of the first rays of the rows.
    #[inline(always)]
    pub(crate) fn starts(&self) -> impl Iterator<Item = usize> + '_ {
        self.places[..self.count].iter().map(|&row| usize::from(row) * LANES)
    }

    /// Keeps the rows that `keep` wants; it is told the place of a row in the list.
    pub(crate) fn retain(&mut self, mut keep: impl FnMut(usize) -> bool) {
        let mut kept = 0;
        for place in 0..self.count {
            if keep(place) {
                self.places[kept] = self.places[place];
                kept += 1;
            }
        }
        self.count = kept;
    }
}

/// The row of a block that starts at a ray.
#[inline(always)]
pub(crate) fn row(block: &Block, start: usize) -> &Row {
    block.0[start..start + LANES].try_into().expect("a row")
}

/// The row of a block that starts at a ray, to be written.
#[inline(always)]
pub(crate) fn row_mut(block: &mut Block, start: usize) -> &mut Row {
    (&mut block.0[start..start + LANES]).try_into().expect("a row")
}

impl Default for Bundle {
    fn default() -> Self {
        Self {
            count: 0,
            id: [0; RAYS],
            origin: Default::default(),
            direction: Default::default(),
            inverse: Default::default(),
            near: Block::default(),
            far: Block::default(),
            base: Block::default(),
            growth: Block::default(),
            sharpness: Block::default(),
            steps: [0; RAYS],
            factor: Block::default(),
            before: Block::default(),
            enter: Block::default(),
            leave: Block::default(),
            value: Block::default(),
            fate: [Fate::Passed; RAYS],
            t: [0.0; RAYS],
            last: [0.0; RAYS],
            found: Vec::new(),
        }
    }
}

impl Bundle {
    pub(crate) fn is_full(&self) -> bool {
        self.count == RAYS
    }

    /// Adds a ray.
    pub(crate) fn push(&mut self, start: &Start) {
        let place = self.count;
        self.count += 1;
        self.id[place] = start.id;
        for axis in 0..3 {
            self.origin[axis].0[place] = start.origin[axis];
            self.direction[axis].0[place] = start.direction[axis];
        }
        self.near.0[place] = start.span[0];
        self.far.0[place] = start.span[1];
        self.base.0[place] = start.tolerance[0];
        self.growth.0[place] = start.tolerance[1];
        self.sharpness.0[place] = start.sharpness;
        self.steps[place] = start.steps;
    }

    /// Adds camera rays, as many of these as there is room for, and returns how many those are.
    pub(crate) fn take(&mut self, starts: &Starts, rays: &[u32]) -> usize {
        let taken = rays.len().min(RAYS - self.count);
        let rays = &rays[..taken];
        let places = self.count..self.count + taken;
        self.count += taken;
        let (first, last) = (rays[0] as usize, rays[taken - 1] as usize);
        let are_neighbours = last - first + 1 == taken;
        let copy = |to: &mut Block, from: &[f32]| {
            let to = &mut to.0[places.clone()];
            if are_neighbours {
                to.copy_from_slice(&from[first..=last]);
            } else {
                to.iter_mut().zip(rays).for_each(|(to, &ray)| *to = from[ray as usize]);
            }
        };
        let Starts { origin, direction, end, base, growth } = starts;
        for axis in 0..3 {
            copy(&mut self.origin[axis], &origin[axis]);
            copy(&mut self.direction[axis], &direction[axis]);
        }
        copy(&mut self.far, end);
        copy(&mut self.base, base);
        copy(&mut self.growth, growth);
        self.near.0[places.clone()].fill(0.0);
        self.sharpness.0[places.clone()].fill(1.0);
        self.steps[places.clone()].fill(0);
        self.id[places].copy_from_slice(rays);
        taken
    }

    /// Makes ready for a journey and returns what is around all rays.
    pub(crate) fn set_out(&mut self, level: Level) -> Shaft {
        let filled = Rows::of(self.count).lanes();
        // A lane without a ray repeats the last one, so that it bounds no more than that; it is never on its way.
        let last = self.count - 1;
        for block in self.origin.iter_mut().chain(&mut self.direction).chain([&mut self.near, &mut self.far]) {
            let number = block.0[last];
            block.0[self.count..filled].fill(number);
        }
        let Self { direction, inverse, factor, before, origin, near, far, .. } = self;
        let mut shaft = Shaft::default();
        simd::with(
            level,
            #[inline(always)]
            || {
                factor.0[..filled].fill(1.0);
                before.0[..filled].fill(0.0);
                for axis in 0..3 {
                    for start in (0..filled).step_by(LANES) {
                        let (d, inverse) = (row(&direction[axis], start), row_mut(&mut inverse[axis], start));
                        for lane in 0..LANES {
                            let least = LEAST_COMPONENT.copysign(d[lane]);
                            inverse[lane] = 1.0 / if d[lane].abs() < LEAST_COMPONENT { least } else { d[lane] };
                        }
                    }
                    shaft.origin[axis] = bounds(&origin[axis], filled);
                    shaft.inverse[axis] = bounds(&inverse[axis], filled);
                }
                shaft.near = bounds(near, filled)[0];
                shaft.far = bounds(far, filled)[1];
            },
        );
        self.fate[..self.count].fill(Fate::Passed);
        far.0[self.count..filled].fill(f32::NEG_INFINITY);
        self.t[..self.count].copy_from_slice(&far.0[..self.count]);
        self.found.clear();
        shaft
    }

    /// Whether all rays have met something.
    pub(crate) fn is_done(&self) -> bool {
        self.found.len() == self.count
    }

    /// All rows.
    pub(crate) fn rows(&self) -> Rows {
        Rows::of(self.count)
    }

    /// Those of some rows that may meet a box or something in it before their end. Wide enough for whatever
    /// [`Bundle::meet`] makes of a box in there: whether a ray meets a box must not depend on its companions.
    pub(crate) fn approaching(&self, level: Level, mut rows: Rows, middle: Triple, half: Triple) -> Rows {
        let mut some = [false; ROWS];
        let Self { origin, inverse, near, far, .. } = self;
        simd::with(
            level,
            #[inline(always)]
            || {
                for (start, some) in rows.starts().zip(&mut some) {
                    let (mut first, mut last) = (*row(near, start), *row(far, start));
                    for axis in 0..3 {
                        let size = middle[axis].abs() + half[axis];
                        let half = |origin: f32| half[axis] + SHAFT_ROUNDING * (size + origin.abs());
                        let (origin, inverse) = (row(&origin[axis], start), row(&inverse[axis], start));
                        narrow(&mut first, &mut last, origin, inverse, middle[axis], half);
                    }
                    let mut met = 0;
                    for lane in 0..LANES {
                        let seam = SHAFT_SEAM * (first[lane].abs() + last[lane].abs());
                        met += u32::from(first[lane] - seam <= last[lane] + seam);
                    }
                    *some = met > 0;
                }
            },
        );
        rows.retain(|place| some[place]);
        rows
    }

    /// Finds the stretch of each ray of some rows that lies in a box, and returns the rows of those that meet it before their
    /// end.
    pub(crate) fn meet(&mut self, level: Level, mut rows: Rows, middle: Triple, half: Triple) -> Rows {
        let mut some = [false; ROWS];
        let Self { origin, inverse, near, far, enter, leave, .. } = self;
        simd::with(
            level,
            #[inline(always)]
            || {
                for (start, some) in rows.starts().zip(&mut some) {
                    let (near, far) = (row(near, start), row(far, start));
                    let (mut first, mut last) = (*near, *far);
                    for axis in 0..3 {
                        let (origin, inverse) = (row(&origin[axis], start), row(&inverse[axis], start));
                        narrow(&mut first, &mut last, origin, inverse, middle[axis], |_| half[axis]);
                    }
                    let (enter, leave) = (row_mut(enter, start), row_mut(leave, start));
                    let mut met = 0;
                    for lane in 0..LANES {
                        let seam = SEAM * (first[lane].abs() + last[lane].abs());
                        let (begin, end) = (first[lane] - seam, last[lane] + seam);
                        let meets = begin <= end;
                        enter[lane] = if begin > near[lane] { begin } else { near[lane] };
                        let end = if end < far[lane] { end } else { far[lane] };
                        leave[lane] = if meets { end } else { f32::NEG_INFINITY };
                        met += u32::from(meets);
                    }
                    *some = met > 0;
                }
            },
        );
        rows.retain(|place| some[place]);
        rows
    }

    /// Takes the stretches before the box tested last instead of those in it, or those behind it.
    pub(crate) fn outside(&mut self, is_behind: bool) -> Rows {
        for ray in 0..self.count {
            let (near, far) = (self.near.0[ray], self.far.0[ray]);
            let (enter, leave) = (self.enter.0[ray], self.leave.0[ray]);
            let meets = leave > f32::NEG_INFINITY;
            let [first, last] = match (is_behind, meets) {
                (false, true) => [near, enter],
                (false, false) => [near, far],
                (true, true) => [leave, far],
                (true, false) => [far, far],
            };
            self.enter.0[ray] = first;
            self.leave.0[ray] = if first < last { last } else { f32::NEG_INFINITY };
        }
        self.meeting()
    }

    /// The rows of rays that meet the box tested last.
    pub(crate) fn meeting(&self) -> Rows {
        let mut rows = Rows::of(self.count);
        rows.retain(|place| row(&self.leave, place * LANES).iter().any(|&leave| leave > f32::NEG_INFINITY));
        rows
    }

    /// Leaves out the rays that can't be dimmed any more by what is this far away or farther.
    pub(crate) fn undimmed(&mut self, clearance: f32) -> Rows {
        let Self { factor, leave, sharpness, .. } = self;
        for ((leave, factor), sharpness) in leave.0[..self.count].iter_mut().zip(&factor.0).zip(&sharpness.0) {
            if clearance * sharpness >= factor * *leave {
                *leave = f32::NEG_INFINITY;
            }
        }
        self.meeting()
    }

    /// How many rays of these rows meet the box tested last.
    pub(crate) fn count_meeting(&self, rows: &Rows) -> u64 {
        let meet =
            |start| row(&self.leave, start).iter().map(|&leave| u64::from(leave > f32::NEG_INFINITY)).sum::<u64>();
        rows.starts().map(meet).sum()
    }

    /// Writes the points `t` along the rays of some rows, lane by lane.
    pub(crate) fn points_at(&self, level: Level, rows: &Rows, t: &Block, [x, y, z]: [&mut [f32]; 3]) {
        simd::with(
            level,
            #[inline(always)]
            || {
                for (axis, to) in [x, y, z].into_iter().enumerate() {
                    for (to, start) in to.chunks_exact_mut(LANES).zip(rows.starts()) {
                        let to: &mut Row = to.try_into().expect("a row");
                        let (o, d) = (row(&self.origin[axis], start), row(&self.direction[axis], start));
                        let t = row(t, start);
                        for lane in 0..LANES {
                            to[lane] = o[lane] + t[lane] * d[lane];
                        }
                    }
                }
            },
        );
    }

    /// Notes that a ray met something in a place, or gave up there, and goes no farther.
    pub(crate) fn find(&mut self, ray: usize, fate: Fate, t: f32, value: f32, place: u32) {
        self.fate[ray] = fate;
        self.t[ray] = t;
        self.last[ray] = value;
        self.far.0[ray] = f32::NEG_INFINITY;
        self.found.push((ray as u32, place));
    }

    /// How many rays have met something so far.
    pub(crate) fn finds(&self) -> usize {
        self.found.len()
    }

    /// Appends how all rays ended and forgets them.
    pub(crate) fn finish(&mut self, ends: &mut Vec<End>) {
        let end = |ray: usize, place: u32| {
            let fate = self.fate[ray];
            End {
                id: self.id[ray],
                fate,
                t: self.t[ray],
                value: if place == End::NOWHERE { f32::INFINITY } else { self.last[ray] },
                steps: self.steps[ray],
                factor: if fate == Fate::Hit { 0.0 } else { self.factor.0[ray] },
                place,
            }
        };
        ends.extend(self.found.iter().map(|&(ray, place)| end(ray as usize, place)));
        let goes_on = |&ray: &usize| self.far.0[ray] > f32::NEG_INFINITY;
        ends.extend((0..self.count).filter(goes_on).map(|ray| end(ray, End::NOWHERE)));
        self.count = 0;
    }
}

/// Narrows the stretches of a row of rays to a slab between two planes across an axis, half of whose width may depend on the
/// origin of a ray.
#[inline(always)]
fn narrow(first: &mut Row, last: &mut Row, origin: &Row, inverse: &Row, middle: f32, half: impl Fn(f32) -> f32) {
    for lane in 0..LANES {
        let towards = (middle - origin[lane]) * inverse[lane];
        let reach = half(origin[lane]) * inverse[lane].abs();
        let (begin, end) = (towards - reach, towards + reach);
        first[lane] = if begin > first[lane] { begin } else { first[lane] };
        last[lane] = if end < last[lane] { end } else { last[lane] };
    }
}

/// Bounds of all rays of a bundle.
#[derive(Clone, Copy, Default)]
pub(crate) struct Shaft {
    origin: [[f32; 2]; 3],
    inverse: [[f32; 2]; 3],
    pub(crate) near: f32,
    pub(crate) far: f32,
}

impl Shaft {
    /// Whether the rays go upwards along an axis.
    pub(crate) fn rises(&self, axis: usize) -> bool {
        self.inverse[axis][0] > 0.0
    }

    /// Between what distances some ray may lie in a slab between two planes across an axis. Wide enough for whatever
    /// [`Bundle::meet`] makes of a box in there: whether a ray meets a box must not depend on its companions.
    pub(crate) fn slab(&self, axis: usize, middle: f32, half: f32) -> [f32; 2] {
        let ([first, last], [slow, fast]) = (self.origin[axis], self.inverse[axis]);
        let half = half + SHAFT_ROUNDING * (middle.abs() + half + first.abs().max(last.abs()));
        // All rays go the same way; towards rising coordinates after mirroring.
        let (lo, hi, least, most) = if slow > 0.0 {
            (middle - half - last, middle + half - first, slow, fast)
        } else {
            (first - middle - half, last - middle + half, -fast, -slow)
        };
        [lo * if lo > 0.0 { least } else { most }, hi * if hi > 0.0 { most } else { least }]
    }
}

/// The least and the largest of the first `count` numbers, a multiple of the lanes.
#[inline(always)]
fn bounds(block: &Block, count: usize) -> [f32; 2] {
    let (mut lo, mut hi) = (*row(block, 0), *row(block, 0));
    for start in (0..count).step_by(LANES) {
        let numbers = row(block, start);
        for lane in 0..LANES {
            lo[lane] = if numbers[lane] < lo[lane] { numbers[lane] } else { lo[lane] };
            hi[lane] = if numbers[lane] > hi[lane] { numbers[lane] } else { hi[lane] };
        }
    }
    let mut ends = [lo[0], hi[0]];
    for lane in 1..LANES {
        ends =
            [if lo[lane] < ends[0] { lo[lane] } else { ends[0] }, if hi[lane] > ends[1] { hi[lane] } else { ends[1] }];
    }
    ends
}
