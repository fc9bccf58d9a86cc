//! Sphere tracing (Hart 1996) of many rays at once.
//!
//! Rays lie in structure-of-arrays buffers and advance together, one field evaluation of the whole buffer per
//! step. A ray that is done stays where it is, costing evaluations but changing nothing, until enough of them
//! are done to be worth removing. What a ray ends with depends on nothing but the ray itself.
//!
//! There are two kinds of march. [`March::hard`] looks for the first surface. [`March::soft`] looks besides for
//! the least ratio of clearance to distance travelled, the factor of soft shadows.
//!
//! Where the field is much smaller than the distance, as that of a fractal, hard marches take longer steps than the free
//! ball around their point allows (Keinert, Schäfer, Korndörfer, Ganse and Stamminger, "Enhanced Sphere Tracing", 2014). If
//! the free balls before and after such a step don't touch, something may lie between them: the ray goes back to where the
//! first one ends. How much longer the steps are follows from how the field changed on the last one.

use freikugel_field::simd::{self, Level};
use freikugel_field::{Evaluator, Part, Points};

/// Rays are removed from the buffers when at least one in this many is done.
const IDLE_SHARE: usize = 6;

/// A soft shadow darker than this is black: less than half a step of 8 bits, even encoded.
const NEGLIGIBLE: f32 = 1.0 / 8192.0;

/// The shortest step of a soft march, in clearances. Passing an edge, the clearance half a step from its least
/// value is at most sqrt(1 + (1/4)^2) times that value: the factor is at most 3 % too bright.
const SHORTEST_STEP: f32 = 0.5;

/// A ratio that has fallen by less than this on the last step is at its least or will not fall much any more.
const STEADY: f32 = 0.98;

/// The surplus of a relaxed step, in free balls, where the field stays as large as it was on the last step; in proportion
/// where it fell. With more of it too many steps are taken back: on the fractals of the bench scenes, twice this costs as much
/// as nothing.
const SURPLUS: f32 = 0.65;

/// So many rays take a relaxed step at once. Buffers hold a multiple of it.
const CHUNK: usize = 16;

/// What a relaxed step reads of as many rays.
type Strides = [[f32; CHUNK]; 7];

/// The largest surplus, where the field grows. The balls could not touch from 1 on unless it grows further.
const LARGEST_SURPLUS: f32 = 0.9;

/// What holds for all rays of a march.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    /// What a field value is multiplied with to get a safe step.
    pub(crate) scale: f32,
    /// The share of a safe step that is taken.
    pub(crate) step_factor: f32,
    /// How many steps a ray may take.
    pub(crate) max_steps: u32,
}

/// How rays march, which tells the buffers that matter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Manner {
    Hard,
    Relaxed,
    Soft,
}

/// One ray. Lengths are in world units, coordinates relative to the program's origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    /// What the caller knows the ray by.
    pub(crate) id: u32,
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    /// Where on the ray to begin, and where to stop looking.
    pub(crate) span: [f32; 2],
    /// The field value that counts as a hit: at the origin, and what it gains per unit of distance.
    pub(crate) tolerance: [f32; 2],
    /// Steps taken before.
    pub(crate) steps: u32,
    /// The factor of a soft shadow is the clearance over the distance travelled, times this.
    pub(crate) sharpness: f32,
}

/// How a ray ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fate {
    /// The field fell below the tolerance.
    Hit,
    /// The ray reached its end, or (soft marches only) nothing of the light is left.
    Passed,
    /// The steps ran out, or the field has no value there.
    Exhausted,
}

/// A ray that is done.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    pub(crate) id: u32,
    pub(crate) fate: Fate,
    /// Where on the ray.
    pub(crate) t: f32,
    /// The field's value there.
    pub(crate) value: f32,
    /// All steps taken.
    pub(crate) steps: u32,
    /// For soft marches, the share of the light that arrives.
    pub(crate) factor: f32,
    /// For soft marches, the ratio at the last step, times the sharpness.
    pub(crate) before: f32,
    /// The cell in which the ray met something, by its place among those of the packet.
    pub(crate) place: u32,
}

impl End {
    /// The place of a ray that met nothing.
    pub(crate) const NOWHERE: u32 = u32::MAX;
}

/// The rays on their way. All buffers are as long as the fullest wave so far.
#[derive(Default)]
pub(crate) struct March {
    count: usize,
    id: Vec<u32>,
    steps: Vec<u32>,
    origin: [Vec<f32>; 3],
    direction: [Vec<f32>; 3],
    t: Vec<f32>,
    end: Vec<f32>,
    base: Vec<f32>,
    slope: Vec<f32>,
    sharpness: Vec<f32>,
    /// The factor so far.
    factor: Vec<f32>,
    /// The ratio one step ago, times the sharpness.
    before: Vec<f32>,
    /// Of relaxed marches: the radius of the free ball before the last step, and the length of that step.
    free: Vec<f32>,
    stride: Vec<f32>,
    point: [Vec<f32>; 3],
    value: Vec<f32>,
    /// Whether the last step moved the ray, so that its value is that of a point it has left.
    moved: Vec<bool>,
    /// Where the rays are that stay in a sweep.
    kept: Vec<u32>,
}

impl March {
    /// Adds a ray, for soft marches with the factor so far and the ratio at the last step.
    pub(crate) fn push(&mut self, ray: &Start, [factor, before]: [f32; 2]) {
        let place = self.count;
        self.count += 1;
        if place == self.id.len() {
            self.grow();
        }
        self.id[place] = ray.id;
        self.steps[place] = ray.steps;
        for axis in 0..3 {
            self.origin[axis][place] = ray.origin[axis];
            self.direction[axis][place] = ray.direction[axis];
        }
        self.t[place] = ray.span[0];
        self.end[place] = ray.span[1];
        self.base[place] = ray.tolerance[0];
        self.slope[place] = ray.tolerance[1];
        self.sharpness[place] = ray.sharpness;
        self.factor[place] = factor;
        self.before[place] = before;
        self.free[place] = 0.0;
        self.stride[place] = 0.0;
    }

    #[cold]
    fn grow(&mut self) {
        let length = (self.id.len() * 2).max(16 * CHUNK);
        let Self { id, steps, moved, kept, .. } = self;
        for numbers in [id, steps, kept] {
            numbers.resize(length, 0);
        }
        moved.resize(length, false);
        let Self { origin, direction, t, end, base, slope, sharpness, factor, before, .. } = self;
        for numbers in origin.iter_mut().chain(direction).chain([t, end, base, slope]) {
            numbers.resize(length, 0.0);
        }
        let Self { point, value, free, stride, .. } = self;
        for numbers in point.iter_mut().chain([sharpness, factor, before, value, free, stride]) {
            numbers.resize(length, 0.0);
        }
    }

    /// Takes all rays to their first surface. Appends how they ended, in no particular order, and returns how
    /// many field values that took.
    pub(crate) fn hard(&mut self, field: &mut Evaluator<'_>, part: &Part, pace: Pace, ends: &mut Vec<End>) -> u64 {
        match part.is_loose() {
            false => self.run(field, part, pace, ends, Manner::Hard),
            true => self.run(field, part, pace, ends, Manner::Relaxed),
        }
    }

    /// Takes all rays to the first surface, or to their end while looking for the least factor.
    pub(crate) fn soft(&mut self, field: &mut Evaluator<'_>, part: &Part, pace: Pace, ends: &mut Vec<End>) -> u64 {
        self.run(field, part, pace, ends, Manner::Soft)
    }

    fn run(&mut self, field: &mut Evaluator<'_>, part: &Part, pace: Pace, ends: &mut Vec<End>, manner: Manner) -> u64 {
        let mut evaluations = 0;
        while self.count > 0 {
            let count = self.count;
            for axis in 0..3 {
                let (point, t) = (&mut self.point[axis][..count], &self.t[..count]);
                let origin = &self.origin[axis][..count];
                let direction = &self.direction[axis][..count];
                for ray in 0..count {
                    point[ray] = origin[ray] + t[ray] * direction[ray];
                }
            }
            let [x, y, z] = &self.point;
            let points = Points { x: &x[..count], y: &y[..count], z: &z[..count] };
            field.values_in(part, points, &mut self.value[..count]);
            evaluations += count as u64;
            let done = match manner {
                Manner::Hard => self.advance_hard(pace),
                Manner::Relaxed => self.advance_relaxed(pace, field.level()),
                Manner::Soft => self.advance_soft(pace),
            };
            if done * IDLE_SHARE >= count {
                self.sweep(ends, manner);
            }
        }
        evaluations
    }

    /// Takes one step with all rays that are not done, and returns how many are.
    fn advance_hard(&mut self, pace: Pace) -> usize {
        let count = self.count;
        let factor = pace.scale * pace.step_factor;
        let (value, t, end) = (&self.value[..count], &mut self.t[..count], &self.end[..count]);
        let (base, slope) = (&self.base[..count], &self.slope[..count]);
        let (steps, moved) = (&mut self.steps[..count], &mut self.moved[..count]);
        let mut going = 0;
        for ray in 0..count {
            let goes =
                (value[ray] >= base[ray] + slope[ray] * t[ray]) & (t[ray] < end[ray]) & (steps[ray] < pace.max_steps);
            moved[ray] = goes;
            t[ray] += if goes { value[ray] * factor } else { 0.0 };
            steps[ray] += u32::from(goes);
            going += u32::from(goes);
        }
        count - going as usize
    }

    /// As [`March::advance_hard`], with steps that are longer than known to be safe.
    ///
    /// No relaxed step reaches the end: what lies between the balls of the last two points would never be seen.
    fn advance_relaxed(&mut self, pace: Pace, level: Level) -> usize {
        let Self { count, value, t, end, base, slope, steps, moved, free, stride, .. } = self;
        let factor = pace.scale * pace.step_factor;
        let mut going = 0;
        simd::with(
            level,
            #[inline(always)]
            || {
                // Buffers are longer than there are rays, by whole chunks; what is in their unused places does not matter.
                for first in (0..*count).step_by(CHUNK) {
                    let places = first..first + CHUNK;
                    let old: Strides = [&*value, t, end, base, slope, free, stride].map(|from| chunk(from, first));
                    let mut taken: [u32; CHUNK] = chunk(steps, first);
                    let mut new: [[f32; CHUNK]; 3] = [[0.0; CHUNK]; 3];
                    let mut goes = [0; CHUNK];
                    for ray in 0..CHUNK {
                        let [value, t, end, base, slope, before, stride] = [0, 1, 2, 3, 4, 5, 6].map(|i| old[i][ray]);
                        let own = value * factor;
                        // A step within the ball is safe, whatever rounding says.
                        let misses = (stride > before) & (own + before < stride);
                        let is_on_its_way = (value >= base + slope * t) & (t < end) & (taken[ray] < pace.max_steps);
                        let change = SURPLUS * own / before;
                        let surplus = if change < LARGEST_SURPLUS { change } else { LARGEST_SURPLUS };
                        let surplus = if before > 0.0 { surplus } else { 0.0 };
                        let relaxed = own + own * surplus;
                        let ahead = if t + relaxed < end { relaxed } else { own };
                        // Having gone back, a ray forgets the step, so that the next one is safe.
                        let moved = if misses {
                            [t + (before - stride), 0.0, 0.0]
                        } else if is_on_its_way {
                            [t + ahead, own, ahead]
                        } else {
                            [t, before, stride]
                        };
                        [new[0][ray], new[1][ray], new[2][ray]] = moved;
                        goes[ray] = u32::from(misses | is_on_its_way);
                        taken[ray] += goes[ray];
                    }
                    steps[places.clone()].copy_from_slice(&taken);
                    for (to, new) in [&mut *t, free, stride].into_iter().zip(&new) {
                        to[places.clone()].copy_from_slice(new);
                    }
                    moved[places].copy_from_slice(&goes.map(|goes| goes != 0));
                    going += goes.iter().sum::<u32>();
                    let unused = &goes[CHUNK.min(*count - first)..];
                    going -= unused.iter().sum::<u32>();
                }
            },
        );
        *count - going as usize
    }

    /// As [`March::advance_hard`], with the factor of the shadow.
    ///
    /// The field being 1-Lipschitz after scaling, a step up to where clearance over distance could first fall below
    /// the least ratio so far misses no smaller one. Where that would be tiny, the step is a fixed part of the
    /// clearance instead; the whole of it if the ratio is steady, as it is on the way from a flat surface.
    fn advance_soft(&mut self, pace: Pace) -> usize {
        let count = self.count;
        let (value, t, end) = (&self.value[..count], &mut self.t[..count], &self.end[..count]);
        let (base, slope) = (&self.base[..count], &self.slope[..count]);
        let (sharpness, factor) = (&self.sharpness[..count], &mut self.factor[..count]);
        let (steps, before) = (&mut self.steps[..count], &mut self.before[..count]);
        let moved = &mut self.moved[..count];
        let mut going = 0;
        for ray in 0..count {
            let goes = (value[ray] >= base[ray] + slope[ray] * t[ray])
                & (t[ray] < end[ray])
                & (steps[ray] < pace.max_steps)
                & (factor[ray] >= NEGLIGIBLE);
            moved[ray] = goes;
            let clearance = value[ray] * pace.scale;
            let here = sharpness[ray] * clearance / t[ray];
            let least = if here < factor[ray] { here } else { factor[ray] };
            let ratio = least / sharpness[ray];
            let safe = (clearance - t[ray] * ratio) / (1.0 + ratio);
            let is_steady = here >= before[ray] * STEADY;
            let short = if is_steady { clearance } else { clearance * SHORTEST_STEP };
            let step = if safe > short { safe } else { short };
            factor[ray] = if goes { least } else { factor[ray] };
            before[ray] = if goes { here } else { before[ray] };
            t[ray] += if goes { step * pace.step_factor } else { 0.0 };
            steps[ray] += u32::from(goes);
            going += u32::from(goes);
        }
        count - going as usize
    }

    /// Takes the rays that are done out of the buffers.
    fn sweep(&mut self, ends: &mut Vec<End>, manner: Manner) {
        let mut kept = 0;
        for ray in 0..self.count {
            let (t, value, factor) = (self.t[ray], self.value[ray], self.factor[ray]);
            let is_past = t >= self.end[ray] || factor < NEGLIGIBLE;
            if self.moved[ray] && !is_past {
                self.kept[kept] = ray as u32;
                kept += 1;
                continue;
            }
            let fate = if is_past {
                Fate::Passed
            } else if value < self.base[ray] + self.slope[ray] * t {
                Fate::Hit
            } else {
                Fate::Exhausted
            };
            let factor = if fate == Fate::Hit || factor < NEGLIGIBLE { 0.0 } else { factor };
            let (id, steps, before) = (self.id[ray], self.steps[ray], self.before[ray]);
            ends.push(End { id, fate, t, value, steps, factor, before, place: End::NOWHERE });
        }
        // Buffer by buffer, since each fits the first-level cache and all of them together do not.
        let Self { id, steps, origin, direction, t, end, base, slope, .. } = self;
        let places = &self.kept[..kept];
        pack(id, places);
        pack(steps, places);
        for numbers in origin.iter_mut().chain(direction).chain([t, end, base, slope]) {
            pack(numbers, places);
        }
        match manner {
            Manner::Hard => {}
            Manner::Relaxed => {
                pack(&mut self.free, places);
                pack(&mut self.stride, places);
            }
            Manner::Soft => {
                for numbers in [&mut self.sharpness, &mut self.factor, &mut self.before] {
                    pack(numbers, places);
                }
            }
        }
        self.count = kept;
    }
}

/// The numbers of one chunk.
#[inline(always)]
fn chunk<T: Copy>(numbers: &[T], first: usize) -> [T; CHUNK] {
    numbers[first..first + CHUNK].try_into().expect("buffers hold whole chunks")
}

/// Moves the numbers at `places`, which rise, to the front.
fn pack<T: Copy>(numbers: &mut [T], places: &[u32]) {
    for (to, &from) in places.iter().enumerate() {
        numbers[to] = numbers[from as usize];
    }
}
