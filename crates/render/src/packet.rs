//! Rays that travel together through the hierarchy of cells.
//!
//! A packet is sorted by the signs of the rays' directions into bundles, each of which visits the cells that its rays meet
//! from front to back. A box that lies beside the shaft around all rays of a bundle is skipped with all it holds; in the
//! smallest boxes the rays that meet them march with the part of the program that matters there. What a ray ends with
//! depends on nothing but the ray and the cells: not on its companions.

use crate::march::{End, Fate, March, Pace, Start};
use crate::search::Search;
use crate::vector::Triple;
use freikugel_field::simd::{self, Level};
use freikugel_field::{Cell, Cells, Encloser, Evaluator, Occupancy, Splitter};

/// A part with this many steps is not worth splitting further: the point and two primitives with their union.
const SMALL_PART: usize = 8;

/// The same for a part with a warp or a displacement, whose formulas count, too.
const SMALL_WARPED: usize = 32;

/// Where the field is steeper than this, a search by intervals needs fewer looks than a march would need steps.
const STEEP: f32 = 16.0;

/// A box this many pixels wide, as seen from the camera, is not split further: fewer rays meet it than fill the lanes.
const CELL_PIXELS: f32 = 24.0;

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
    pub(crate) manner: Manner,
}

/// How rays travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Manner {
    /// From cell to cell, in each as its part allows: marching by distances, searching for the zeros of formulas.
    Fitting,
    /// From cell to cell, searching in all of them. A penumbra is made of clearances, which no search finds: for the least
    /// ratio rays march all the same.
    Searching,
    /// Marching through one cell that holds the whole field.
    Plain,
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
    search: Search,
    ends: Vec<End>,
}

/// Rays whose directions have the same signs, and what became of them so far.
#[derive(Default)]
struct Bundle {
    starts: Vec<Start>,
    states: Vec<State>,
    /// The rays that meet the boxes on the way from the root to the one being visited; first all rays.
    groups: Vec<Group>,
    found: Vec<Found>,
    met: Vec<Met>,
}

/// Some rays of a bundle.
#[derive(Default)]
struct Group {
    /// Their places in the bundle.
    ray: Vec<u32>,
    origin: [Vec<f32>; 3],
    inverse: [Vec<f32>; 3],
    near: Vec<f32>,
    /// Beyond this nothing can change a ray's fate any more.
    far: Vec<f32>,
    shaft: Shaft,
    /// Where each ray enters and leaves the box tested last.
    enter: Vec<f32>,
    leave: Vec<f32>,
    /// Which rays meet it.
    meets: Vec<u32>,
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

/// Bounds of the rays of a group.
#[derive(Clone, Copy, Default)]
struct Shaft {
    origin: [[f32; 2]; 3],
    inverse: [[f32; 2]; 3],
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
    pub(crate) fn travel<'e>(
        &mut self,
        space: &Space<'f>,
        quest: Quest,
        field: &mut Evaluator<'e>,
        encloser: &mut Encloser<'e>,
        splitter: &mut Splitter,
        ends: &mut Vec<End>,
    ) -> u64 {
        self.places.clear();
        let Self { bundles, places, march, search, ends: own } = self;
        let mut trip = Trip { space, quest, field, encloser, splitter, places, march, search, ends: own };
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
        self.states.push(State {
            fate: Fate::Passed,
            t: start.span[1],
            value: f32::INFINITY,
            steps: start.steps,
            factor: 1.0,
            before: 0.0,
            find: u32::MAX,
        });
        self.starts.push(*start);
    }

    /// Makes the group of all rays.
    fn gather(&mut self) {
        if self.groups.is_empty() {
            self.groups.push(Group::default());
        }
        let group = &mut self.groups[0];
        group.clear();
        for (ray, start) in self.starts.iter().enumerate() {
            group.ray.push(ray as u32);
            for axis in 0..3 {
                let d = start.direction[axis];
                group.origin[axis].push(start.origin[axis]);
                group.inverse[axis].push(1.0 / if d.abs() < LEAST_COMPONENT { LEAST_COMPONENT.copysign(d) } else { d });
            }
            let [near, far] = start.span;
            group.near.push(near);
            group.far.push(far);
        }
        group.shaft = Shaft::around(group);
    }

    /// Appends how all rays ended and forgets them.
    fn finish(&mut self, ends: &mut Vec<End>) {
        let end = |ray: usize, place: u32| {
            let (start, state) = (&self.starts[ray], &self.states[ray]);
            let State { fate, t, value, steps, factor, before, .. } = *state;
            let factor = if fate == Fate::Hit { 0.0 } else { factor };
            End { id: start.id, fate, t, value, steps, factor, before, place }
        };
        ends.extend(self.found.iter().map(|found| end(found.ray as usize, found.place)));
        let nothing = (0..self.starts.len()).filter(|&ray| self.states[ray].find == u32::MAX);
        ends.extend(nothing.map(|ray| end(ray, End::NOWHERE)));
        self.starts.clear();
        self.states.clear();
        self.found.clear();
    }
}

impl Group {
    fn clear(&mut self) {
        self.ray.clear();
        for numbers in self.origin.iter_mut().chain(&mut self.inverse).chain([&mut self.near, &mut self.far]) {
            numbers.clear();
        }
    }

    /// Finds the rays that meet a box before their end, and where they enter and leave it.
    fn meet(&mut self, level: Level, middle: Triple, half: Triple) {
        let count = self.ray.len();
        self.enter.resize(count, 0.0);
        self.leave.resize(count, 0.0);
        let Self { origin, inverse, near, far, enter, leave, .. } = self;
        simd::with(
            level,
            #[inline(always)]
            || {
                enter.copy_from_slice(near);
                leave.copy_from_slice(far);
                for axis in 0..3 {
                    let (origin, inverse) = (&origin[axis][..count], &inverse[axis][..count]);
                    let (enter, leave) = (&mut enter[..count], &mut leave[..count]);
                    let (middle, half) = (middle[axis], half[axis]);
                    for ray in 0..count {
                        let towards = (middle - origin[ray]) * inverse[ray];
                        let reach = half * inverse[ray].abs();
                        let (first, last) = (towards - reach, towards + reach);
                        enter[ray] = if first > enter[ray] { first } else { enter[ray] };
                        leave[ray] = if last < leave[ray] { last } else { leave[ray] };
                    }
                }
                for ray in 0..count {
                    let seam = SEAM * (enter[ray].abs() + leave[ray].abs());
                    enter[ray] -= seam;
                    leave[ray] += seam;
                }
            },
        );
        self.meets.clear();
        self.meets.extend((0..count as u32).filter(|&ray| self.enter[ray as usize] <= self.leave[ray as usize]));
    }

    /// Lets rays that met something go no farther.
    fn stop(&mut self, states: &[State]) {
        for (far, &ray) in self.far.iter_mut().zip(&self.ray) {
            if states[ray as usize].find != u32::MAX {
                *far = f32::NEG_INFINITY;
            }
        }
    }

    /// The rays of `from` that meet the box that those were tested with last.
    fn take(&mut self, from: &Self) {
        self.clear();
        self.ray.extend(from.meets.iter().map(|&ray| from.ray[ray as usize]));
        for axis in 0..3 {
            pick(&mut self.origin[axis], &from.origin[axis], &from.meets);
            pick(&mut self.inverse[axis], &from.inverse[axis], &from.meets);
        }
        pick(&mut self.near, &from.near, &from.meets);
        pick(&mut self.far, &from.far, &from.meets);
        self.shaft = Shaft::around(self);
    }
}

fn pick(to: &mut Vec<f32>, from: &[f32], places: &[u32]) {
    to.extend(places.iter().map(|&place| from[place as usize]));
}

/// A packet on its way.
struct Trip<'a, 'f, 'e> {
    space: &'a Space<'f>,
    quest: Quest,
    field: &'a mut Evaluator<'e>,
    encloser: &'a mut Encloser<'e>,
    splitter: &'a mut Splitter,
    places: &'a mut Vec<&'f Cell>,
    march: &'a mut March,
    search: &'a mut Search,
    ends: &'a mut Vec<End>,
}

impl<'f> Trip<'_, 'f, '_> {
    fn take(&mut self, bundle: &mut Bundle) -> u64 {
        bundle.gather();
        let root = self.space.cells.root();
        // What lies outside all cells can still dim a soft shadow.
        let mut evaluations = self.march_outside(bundle, root, |[near, _], [enter, _]| [near, enter]);
        evaluations += self.visit(bundle, root, 0);
        evaluations + self.march_outside(bundle, root, |[_, far], [_, leave]| [leave, far])
    }

    /// Visits a box with the group at `depth`, of which some rays may meet it.
    fn visit(&mut self, bundle: &mut Bundle, cell: &'f Cell, depth: usize) -> u64 {
        let group = &mut bundle.groups[depth];
        group.meet(self.field.level(), cell.middle(), cell.half());
        if group.meets.is_empty() {
            return 0;
        }
        if self.is_small(cell) {
            return self.march_through(bundle, cell, depth);
        }
        if bundle.groups.len() == depth + 1 {
            bundle.groups.push(Group::default());
        }
        let [.., from, group] = &mut bundle.groups[..depth + 2] else { unreachable!("two groups") };
        group.take(from);
        let children = self.space.cells.children(cell, self.splitter);
        let side = (1..).find(|n| n * n * n >= children.len()).expect("a cube of boxes");
        let ahead = [0, 1, 2].map(|axis| group.shaft.rises(axis));
        let mut evaluations = 0;
        for place in 0..children.len() {
            let index = [place % side, place / side % side, place / (side * side)];
            let child = (0..3)
                .rev()
                .fold(0, |child, axis| child * side + if ahead[axis] { index[axis] } else { side - 1 - index[axis] });
            let child = &children[child];
            let shaft = &bundle.groups[depth + 1].shaft;
            if !self.is_of_no_interest(child) && shaft.meets(child.middle(), child.half()) {
                evaluations += self.visit(bundle, child, depth + 1);
            }
        }
        evaluations
    }

    /// Whether rays march by values where that is safe.
    fn may_march(&self) -> bool {
        self.space.manner != Manner::Searching || self.quest == Quest::Least
    }

    fn is_of_no_interest(&self, cell: &Cell) -> bool {
        self.quest != Quest::Least && matches!(cell.occupancy(), Occupancy::Outside(_))
    }

    fn is_small(&self, cell: &Cell) -> bool {
        let part = cell.part();
        if self.space.manner == Manner::Plain
            || cell.occupancy() != Occupancy::Surface
            || (part.size() <= SMALL_PART && part.is_measured() && self.may_march())
        {
            return true;
        }
        if part.is_warped() && self.may_march() && part.size() <= SMALL_WARPED && self.space.cells.slope(cell).is_tight
        {
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
        let group = &mut bundle.groups[0];
        group.meet(self.field.level(), root.middle(), root.half());
        bundle.met.clear();
        for ray in 0..group.ray.len() {
            let (near, far) = (group.near[ray], group.far[ray]);
            let (enter, leave) = (group.enter[ray].max(near), group.leave[ray].min(far));
            let inside = if enter <= leave { [enter, leave] } else { [far, far] };
            let span = stretch([near, far], inside);
            if span[0] < span[1] {
                bundle.met.push(Met { ray: group.ray[ray], span });
            }
        }
        self.march_met(bundle, root, self.pace_of(root).filter(|_| root.part().is_measured()))
    }

    /// Lets the rays of a group that meet a cell march through it.
    fn march_through(&mut self, bundle: &mut Bundle, cell: &'f Cell, depth: usize) -> u64 {
        let group = &bundle.groups[depth];
        bundle.met.clear();
        bundle.met.extend(group.meets.iter().map(|&place| {
            let place = place as usize;
            let span = [group.enter[place].max(group.near[place]), group.leave[place].min(group.far[place])];
            Met { ray: group.ray[place], span }
        }));
        let finds = bundle.found.len();
        let evaluations = self.march_met(bundle, cell, self.pace_of(cell));
        if bundle.found.len() > finds {
            for group in &mut bundle.groups[..=depth] {
                group.stop(&bundle.states);
            }
        }
        evaluations
    }

    /// How rays march in a cell by the values of its part, if they can. Where space is warped, that depends on the cell.
    fn pace_of(&self, cell: &Cell) -> Option<Pace> {
        let pace = self.space.pace;
        if !self.may_march() {
            return None;
        }
        // The pace of plain marches suits formulas, too, but makes no clearances of their values.
        if cell.part().is_measured() || (self.space.manner == Manner::Plain && self.quest != Quest::Least) {
            return Some(pace);
        }
        let slope = cell.part().is_warped().then(|| self.space.cells.slope(cell).bound)?;
        (slope > 0.0 && slope <= STEEP).then(|| Pace { scale: 1.0 / slope, ..pace })
    }

    /// Lets the rays in `bundle.met` march where the part of `cell` holds; without a pace, they search.
    fn march_met(&mut self, bundle: &mut Bundle, cell: &'f Cell, pace: Option<Pace>) -> u64 {
        // Without a scale there is no clearance: a surface dims all or nothing.
        let is_soft = self.quest == Quest::Least && pace.is_some();
        let scale = pace.map_or(1.0, |pace| pace.scale);
        for &Met { ray, span } in &bundle.met {
            let (start, state) = (&bundle.starts[ray as usize], &bundle.states[ray as usize]);
            if let (true, Occupancy::Outside(clearance)) = (is_soft, cell.occupancy())
                && clearance * scale * start.sharpness >= state.factor * span[1]
            {
                continue;
            }
            let start = Start { id: ray, span, steps: state.steps, ..*start };
            match pace {
                Some(_) => self.march.push(&start, [state.factor, state.before]),
                None => self.search.push(&start),
            }
        }
        self.ends.clear();
        let evaluations = match pace {
            None => self.search.run(self.encloser, cell.part(), self.space.pace, self.ends),
            Some(pace) if is_soft => self.march.soft(self.field, cell.part(), pace, self.ends),
            Some(pace) => self.march.hard(self.field, cell.part(), pace, self.ends),
        };
        let place = self.places.len() as u32;
        let finds = bundle.found.len();
        for end in &*self.ends {
            let state = &mut bundle.states[end.id as usize];
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
        }
        if bundle.found.len() > finds {
            self.places.push(cell);
        }
        evaluations
    }
}

impl Shaft {
    fn around(group: &Group) -> Self {
        Self {
            origin: group.origin.each_ref().map(|numbers| bounds(numbers)),
            inverse: group.inverse.each_ref().map(|numbers| bounds(numbers)),
            near: bounds(&group.near)[0],
            far: bounds(&group.far)[1],
        }
    }

    /// Whether the rays go upwards along an axis.
    fn rises(&self, axis: usize) -> bool {
        self.inverse[axis][0] > 0.0
    }

    /// Whether a box may be met: where the times at which some ray enters and leaves the slabs of the box leave no gap.
    fn meets(&self, middle: Triple, half: Triple) -> bool {
        let (mut near, mut far) = (self.near, self.far);
        for axis in 0..3 {
            let ([first, last], [slow, fast]) = (self.origin[axis], self.inverse[axis]);
            // All rays go the same way; towards rising coordinates after mirroring.
            let (lo, hi, least, most) = if slow > 0.0 {
                (middle[axis] - half[axis] - last, middle[axis] + half[axis] - first, slow, fast)
            } else {
                (first - middle[axis] - half[axis], last - middle[axis] + half[axis], -fast, -slow)
            };
            near = near.max(lo * if lo > 0.0 { least } else { most });
            far = far.min(hi * if hi > 0.0 { most } else { least });
        }
        near <= far + SEAM * (near.abs() + far.abs())
    }
}

/// The least and the largest of some numbers.
fn bounds(numbers: &[f32]) -> [f32; 2] {
    const LANES: usize = 8;
    let (mut lo, mut hi) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
    let mut chunks = numbers.chunks_exact(LANES);
    let mut widen = |lane: usize, x: f32| {
        lo[lane] = if x < lo[lane] { x } else { lo[lane] };
        hi[lane] = if x > hi[lane] { x } else { hi[lane] };
    };
    for chunk in &mut chunks {
        for (lane, &x) in chunk.iter().enumerate() {
            widen(lane, x);
        }
    }
    for &x in chunks.remainder() {
        widen(0, x);
    }
    [lo.into_iter().fold(f32::INFINITY, f32::min), hi.into_iter().fold(f32::NEG_INFINITY, f32::max)]
}
