//! Sphere tracing (Hart 1996) of many rays at once.
//!
//! Rays lie in structure-of-arrays buffers and advance together, one field evaluation of the whole buffer per
//! step. A ray that is done stays where it is, costing evaluations but changing nothing, until enough of them
//! are done to be worth removing. What a ray ends with depends on nothing but the ray itself.
//!
//! There are two kinds of march. [`March::hard`] looks for the first surface. [`March::soft`] looks besides for
//! the least ratio of clearance to distance travelled, the factor of soft shadows.

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
    }

    #[cold]
    fn grow(&mut self) {
        let length = (self.id.len() * 2).max(256);
        let Self { id, steps, moved, kept, .. } = self;
        for numbers in [id, steps, kept] {
            numbers.resize(length, 0);
        }
        moved.resize(length, false);
        let Self { origin, direction, t, end, base, slope, sharpness, factor, before, .. } = self;
        for numbers in origin.iter_mut().chain(direction).chain([t, end, base, slope]) {
            numbers.resize(length, 0.0);
        }
        let Self { point, value, .. } = self;
        for numbers in point.iter_mut().chain([sharpness, factor, before, value]) {
            numbers.resize(length, 0.0);
        }
    }

    /// Takes all rays to their first surface. Appends how they ended, in no particular order, and returns how
    /// many field values that took.
    pub(crate) fn hard(&mut self, field: &mut Evaluator<'_>, part: &Part, pace: Pace, ends: &mut Vec<End>) -> u64 {
        self.run(field, part, pace, ends, Self::advance_hard, false)
    }

    /// Takes all rays to the first surface, or to their end while looking for the least factor.
    pub(crate) fn soft(&mut self, field: &mut Evaluator<'_>, part: &Part, pace: Pace, ends: &mut Vec<End>) -> u64 {
        self.run(field, part, pace, ends, Self::advance_soft, true)
    }

    fn run(
        &mut self,
        field: &mut Evaluator<'_>,
        part: &Part,
        pace: Pace,
        ends: &mut Vec<End>,
        advance: fn(&mut Self, Pace) -> usize,
        is_soft: bool,
    ) -> u64 {
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
            if advance(self, pace) * IDLE_SHARE >= count {
                self.sweep(ends, is_soft);
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
    fn sweep(&mut self, ends: &mut Vec<End>, is_soft: bool) {
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
        if is_soft {
            for numbers in [&mut self.sharpness, &mut self.factor, &mut self.before] {
                pack(numbers, places);
            }
        }
        self.count = kept;
    }
}

/// Moves the numbers at `places`, which rise, to the front.
fn pack<T: Copy>(numbers: &mut [T], places: &[u32]) {
    for (to, &from) in places.iter().enumerate() {
        numbers[to] = numbers[from as usize];
    }
}
