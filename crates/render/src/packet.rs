//! Rays that travel together through the hierarchy of cells.
//!
//! A packet is sorted by the signs of the rays' directions into bundles, each of which visits the cells that its rays meet
//! from front to back. A box that lies beside the shaft around all rays of a bundle is skipped with all it holds; in the
//! smallest boxes the rays that meet them march with the part of the program that matters there. What a ray ends with
//! depends on nothing but the ray and the cells: not on its companions.

use crate::march::{End, Fate, March, Pace, Start};
use crate::vector::Triple;
use freikugel_field::{Cell, Cells, Evaluator, Occupancy, Splitter};

/// A part with this many steps is not worth splitting further: the point and two primitives with their union.
const SMALL_PART: usize = 4;

/// A box this many pixels wide, as seen from the camera, is not split further: fewer rays meet it than fill the lanes.
const CELL_PIXELS: f32 = 12.0;

/// Where a ray enters and leaves a box is known up to this part of the distances involved. Parts hold as much beyond their
/// boxes.
const SEAM: f32 = 4.0 * f32::EPSILON;

/// Stands for the components of a direction that are 0, so that no product of 0 and infinity arises.
const LEAST_COMPONENT: f32 = 1e-30;

/// What rays travel through.
pub(crate) struct Space<'f> {
    pub(crate) cells: &'f Cells,
    /// The camera, and the width of a pixel there and what that gains per unit of distance.
    pub(crate) eye: Triple,
    pub(crate) pixel: [f32; 2],
    pub(crate) pace: Pace,
}

/// What rays look for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quest {
    /// The first surface.
    First,
    /// Any surface.
    Any,
    /// The least ratio of clearance to distance, or any surface.
    Least,
}

/// Rays to be traced together.
#[derive(Default)]
pub(crate) struct Packet<'f> {
    /// By the signs of the directions.
    bundles: [Bundle; 8],
    /// The cells in which something was met.
    pub(crate) places: Vec<&'f Cell>,
    march: March,
    ends: Vec<End>,
}

/// Rays whose directions have the same signs, and what became of them so far.
#[derive(Default)]
struct Bundle {
    starts: Vec<Start>,
    states: Vec<State>,
    origin: [Vec<f32>; 3],
    inverse: [Vec<f32>; 3],
    near: Vec<f32>,
    /// Beyond this nothing can change a ray's fate any more.
    far: Vec<f32>,
    shaft: Shaft,
    found: Vec<Found>,
    met: Vec<Met>,
}

/// What is known about a ray so far.
#[derive(Clone, Copy)]
struct State {
    fate: Fate,
    t: f32,
    value: f32,
    steps: u32,
    factor: f32,
    before: f32,
    /// Which of the bundle's finds it is.
    find: u32,
}

/// A surface that a ray met, or gave up before.
#[derive(Clone, Copy)]
struct Found {
    ray: u32,
    place: u32,
}

/// A ray that meets a box, and where.
#[derive(Clone, Copy)]
struct Met {
    ray: u32,
    span: [f32; 2],
}

/// Bounds of the rays of a bundle.
#[derive(Clone, Copy, Default)]
struct Shaft {
    origin: [[f32; 2]; 3],
    direction: [[f32; 2]; 3],
    near: f32,
    far: f32,
}

impl<'f> Packet<'f> {
    /// Adds a ray.
    pub(crate) fn push(&mut self, start: &Start) {
        let sign = |axis: usize| usize::from(start.direction[axis] < 0.0) << axis;
        self.bundles[sign(0) | sign(1) | sign(2)].push(start);
    }

    /// Whether there are no rays.
    pub(crate) fn is_empty(&self) -> bool {
        self.bundles.iter().all(|bundle| bundle.starts.is_empty())
    }

    /// Takes all rays as far as they go. Appends how they ended; of those that met something, all that met it in one cell
    /// stand together. Returns how many field values that took. The packet is empty afterwards.
    pub(crate) fn travel(
        &mut self,
        space: &Space<'f>,
        quest: Quest,
        field: &mut Evaluator<'_>,
        splitter: &mut Splitter,
        ends: &mut Vec<End>,
    ) -> u64 {
        self.places.clear();
        let Self { bundles, places, march, ends: own, .. } = self;
        let mut trip = Trip { space, quest, field, splitter, places, march, ends: own };
        let mut evaluations = 0;
        for bundle in bundles.iter_mut().filter(|bundle| !bundle.starts.is_empty()) {
            evaluations += trip.take(bundle);
            bundle.finish(ends);
        }
        evaluations
    }
}

impl Bundle {
    fn push(&mut self, start: &Start) {
        let [near, far] = start.span;
        self.states.push(State {
            fate: Fate::Passed,
            t: far,
            value: f32::INFINITY,
            steps: start.steps,
            factor: 1.0,
            before: 0.0,
            find: u32::MAX,
        });
        for axis in 0..3 {
            let d = start.direction[axis];
            self.origin[axis].push(start.origin[axis]);
            self.inverse[axis].push(1.0 / if d.abs() < LEAST_COMPONENT { LEAST_COMPONENT.copysign(d) } else { d });
        }
        self.near.push(near);
        self.far.push(far);
        self.starts.push(*start);
    }

    /// Appends how all rays ended and forgets them.
    fn finish(&mut self, ends: &mut Vec<End>) {
        let end = |ray: usize, place: u32| {
            let (start, state) = (&self.starts[ray], &self.states[ray]);
            let State { fate, t, value, steps, factor, before, .. } = *state;
            let factor = if fate == Fate::Hit { 0.0 } else { factor };
            End { id: start.id, fate, t, value, steps, factor, before, place }
        };
        for (find, found) in self.found.iter().enumerate() {
            if self.states[found.ray as usize].find == find as u32 {
                ends.push(end(found.ray as usize, found.place));
            }
        }
        let nothing = (0..self.starts.len()).filter(|&ray| self.states[ray].find == u32::MAX);
        ends.extend(nothing.map(|ray| end(ray, End::NOWHERE)));
        self.starts.clear();
        self.states.clear();
        self.found.clear();
        for numbers in self.origin.iter_mut().chain(&mut self.inverse).chain([&mut self.near, &mut self.far]) {
            numbers.clear();
        }
    }

    /// Where each ray meets a box, if it does before its end.
    fn meet(&mut self, middle: Triple, half: Triple) {
        self.met.clear();
        for ray in 0..self.starts.len() {
            if let Some(span) = self.span(ray, middle, half) {
                self.met.push(Met { ray: ray as u32, span });
            }
        }
    }

    /// Whether any ray meets a box before its end.
    fn meets(&self, middle: Triple, half: Triple) -> bool {
        (0..self.starts.len()).any(|ray| self.span(ray, middle, half).is_some())
    }

    #[inline(always)]
    fn span(&self, ray: usize, middle: Triple, half: Triple) -> Option<[f32; 2]> {
        let (mut near, mut far) = (self.near[ray], self.far[ray]);
        for axis in 0..3 {
            let (origin, inverse) = (self.origin[axis][ray], self.inverse[axis][ray]);
            let (towards, reach) = ((middle[axis] - origin) * inverse, half[axis] * inverse.abs());
            near = near.max(towards - reach);
            far = far.min(towards + reach);
        }
        let seam = SEAM * (near.abs() + far.abs());
        (near <= far + seam).then(|| [(near - seam).max(self.near[ray]), (far + seam).min(self.far[ray])])
    }
}

/// A packet on its way.
struct Trip<'a, 'f, 'e> {
    space: &'a Space<'f>,
    quest: Quest,
    field: &'a mut Evaluator<'e>,
    splitter: &'a mut Splitter,
    places: &'a mut Vec<&'f Cell>,
    march: &'a mut March,
    ends: &'a mut Vec<End>,
}

impl<'f> Trip<'_, 'f, '_> {
    fn take(&mut self, bundle: &mut Bundle) -> u64 {
        bundle.shaft = Shaft::around(&bundle.starts);
        let root = self.space.cells.root();
        // What lies outside all cells can still dim a soft shadow.
        let mut evaluations = self.march_outside(bundle, root, |[near, _], [enter, _]| [near, enter]);
        evaluations += self.visit(bundle, root);
        evaluations + self.march_outside(bundle, root, |[_, far], [_, leave]| [leave, far])
    }

    fn visit(&mut self, bundle: &mut Bundle, cell: &'f Cell) -> u64 {
        if self.is_small(cell) {
            return self.march_through(bundle, cell);
        }
        let children = self.space.cells.children(cell, self.splitter);
        let side = (1..).find(|n| n * n * n >= children.len()).expect("a cube of boxes");
        let mut evaluations = 0;
        for place in 0..children.len() {
            let index = [place % side, place / side % side, place / (side * side)];
            let mut child = 0;
            for axis in (0..3).rev() {
                let ahead = bundle.shaft.rises(axis);
                child = child * side + if ahead { index[axis] } else { side - 1 - index[axis] };
            }
            let child = &children[child];
            if self.is_of_no_interest(child) || !bundle.shaft.meets(child.middle(), child.half()) {
                continue;
            }
            if bundle.meets(child.middle(), child.half()) {
                evaluations += self.visit(bundle, child);
            }
        }
        evaluations
    }

    fn is_of_no_interest(&self, cell: &Cell) -> bool {
        self.quest != Quest::Least && matches!(cell.occupancy(), Occupancy::Outside(_))
    }

    fn is_small(&self, cell: &Cell) -> bool {
        if cell.occupancy() != Occupancy::Surface || cell.part().size() <= SMALL_PART {
            return true;
        }
        let (middle, half, eye) = (cell.middle(), cell.half(), self.space.eye);
        let gap = |axis: usize| ((middle[axis] - eye[axis]).abs() - half[axis]).max(0.0);
        let distance = crate::vector::length([gap(0), gap(1), gap(2)]);
        let [fixed, growth] = self.space.pixel;
        2.0 * half[0].max(half[1]).max(half[2]) <= CELL_PIXELS * (fixed + growth * distance)
    }

    /// Lets rays march on the stretches of them that lie outside the region of all cells. `stretch` picks one from where a
    /// ray begins and ends and where it meets the region.
    fn march_outside(
        &mut self,
        bundle: &mut Bundle,
        root: &'f Cell,
        stretch: impl Fn([f32; 2], [f32; 2]) -> [f32; 2],
    ) -> u64 {
        if self.quest != Quest::Least {
            return 0;
        }
        bundle.met.clear();
        for ray in 0..bundle.starts.len() {
            let (near, far) = (bundle.near[ray], bundle.far[ray]);
            let inside = bundle.span(ray, root.middle(), root.half()).unwrap_or([far, far]);
            let span = stretch([near, far], inside);
            if span[0] < span[1] {
                bundle.met.push(Met { ray: ray as u32, span });
            }
        }
        self.march_met(bundle, root)
    }

    /// Lets the rays that meet a cell march through it.
    fn march_through(&mut self, bundle: &mut Bundle, cell: &'f Cell) -> u64 {
        bundle.meet(cell.middle(), cell.half());
        self.march_met(bundle, cell)
    }

    /// Lets the rays in `bundle.met` march where the part of `cell` holds.
    fn march_met(&mut self, bundle: &mut Bundle, cell: &'f Cell) -> u64 {
        let is_soft = self.quest == Quest::Least;
        for &Met { ray, span } in &bundle.met {
            let (start, state) = (&bundle.starts[ray as usize], &bundle.states[ray as usize]);
            if let (true, Occupancy::Outside(clearance)) = (is_soft, cell.occupancy())
                && clearance * self.space.pace.scale * start.sharpness >= state.factor * span[1]
            {
                continue;
            }
            self.march.push(&Start { id: ray, span, steps: state.steps, ..*start }, [state.factor, state.before]);
        }
        if self.march.is_empty() {
            return 0;
        }
        self.ends.clear();
        let evaluations = match is_soft {
            false => self.march.hard(self.field, cell.part(), self.space.pace, self.ends),
            true => self.march.soft(self.field, cell.part(), self.space.pace, self.ends),
        };
        let place = self.places.len() as u32;
        let finds = bundle.found.len();
        for end in &*self.ends {
            let ray = end.id as usize;
            let state = &mut bundle.states[ray];
            state.steps = end.steps;
            if is_soft {
                (state.factor, state.before) = (end.factor, end.before);
            }
            if end.fate == Fate::Passed && end.factor > 0.0 {
                continue;
            }
            (state.fate, state.t, state.value) = (end.fate, end.t, end.value);
            state.find = bundle.found.len() as u32;
            bundle.found.push(Found { ray: end.id, place });
            bundle.far[ray] = if self.quest == Quest::First { end.t } else { f32::NEG_INFINITY };
        }
        if bundle.found.len() > finds {
            self.places.push(cell);
        }
        evaluations
    }
}

impl Shaft {
    fn around(starts: &[Start]) -> Self {
        const EMPTY: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];
        let mut shaft = Self { origin: [EMPTY; 3], direction: [EMPTY; 3], near: f32::INFINITY, far: f32::NEG_INFINITY };
        let widen = |[lo, hi]: &mut [f32; 2], x: f32| (*lo, *hi) = (lo.min(x), hi.max(x));
        for start in starts {
            for axis in 0..3 {
                widen(&mut shaft.origin[axis], start.origin[axis]);
                widen(&mut shaft.direction[axis], start.direction[axis]);
            }
            shaft.near = shaft.near.min(start.span[0]);
            shaft.far = shaft.far.max(start.span[1]);
        }
        shaft
    }

    /// Whether most rays go upwards along an axis.
    fn rises(&self, axis: usize) -> bool {
        let [lo, hi] = self.direction[axis];
        lo + hi >= 0.0
    }

    /// Whether a box may be met: where the times at which some ray enters and leaves the slabs of the box leave no gap.
    fn meets(&self, middle: Triple, half: Triple) -> bool {
        let (mut near, mut far) = (self.near, self.far);
        for axis in 0..3 {
            let ([first, last], [slow, fast]) = (self.origin[axis], self.direction[axis]);
            // Towards rising coordinates, where the direction has one sign.
            let (lo, hi, slow, fast) = if slow > LEAST_COMPONENT {
                (middle[axis] - half[axis] - last, middle[axis] + half[axis] - first, slow, fast)
            } else if fast < -LEAST_COMPONENT {
                (first - middle[axis] - half[axis], last - middle[axis] + half[axis], -fast, -slow)
            } else {
                continue;
            };
            near = near.max(lo / if lo > 0.0 { fast } else { slow });
            far = far.min(hi / if hi > 0.0 { slow } else { fast });
        }
        near <= far + SEAM * (near.abs() + far.abs())
    }
}
