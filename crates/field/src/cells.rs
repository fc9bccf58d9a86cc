//! A hierarchy of boxes over a region of space, each with the part of a program that matters in it.
//!
//! Boxes are split on demand, into [`SPLIT`] parts along each axis. What a box holds depends on nothing but its place: not
//! on the order of the requests, nor on how many threads make them. So a hierarchy can serve many pictures; its memory is
//! kept within bounds by taking back boxes that nobody asks for any more.

use crate::contract::Aabb;
use crate::kernel::BATCH;
use crate::operands::{CROWD, Crowd, Search};
use crate::operation::Steps;
use crate::program::{Part, Program};
pub use crate::prune::Wanted;
use crate::prune::{Boxes, Survey};
use crate::scalar::Interval;
use crate::simd::Level;
use crate::slope::Sloper;
use crate::spine::Excerpt;
use glam::{DVec3, Vec3};
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

/// Into how many parts a box is split along each axis. The parts fill a few vectors of lanes, so that they cost little more
/// together than one alone.
pub const SPLIT: usize = 4;

/// As [`SPLIT`], for parts of programs above [`LARGE`], whose ranges would need much memory.
const SPLIT_OF_LARGE: usize = 2;

/// How many steps make a part large.
const LARGE: usize = 1 << 14;

/// A box with more than this share of the operands of the box it is part of is no better than that.
const NO_PROGRESS: f64 = 0.75;

/// After so many boxes in a row without progress a box is no longer taken as crowded: its operands are in one spot, and
/// smaller boxes there would hold no fewer of them.
const MOST_STAGNANT: u8 = 2;

/// What is known about the field's sign in a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Occupancy {
    /// The field is positive throughout, at least this.
    Outside(f32),
    /// The field is negative throughout.
    Inside,
    /// There may be a surface.
    Surface,
}

/// A box, and what matters in it. Coordinates are relative to the origin of the hierarchy's program.
pub struct Cell {
    middle: [f32; 3],
    half: [f32; 3],
    /// What boxes overlap by besides [`OVERLAP`].
    seam: f32,
    /// The crowded box that it is part of.
    crowding: Crowding,
    /// What is known before the box is entered.
    occupancy: Occupancy,
    content: OnceLock<Content>,
    slope: OnceLock<Slope>,
    children: OnceLock<Box<[Cell]>>,
    /// The last round in which its children were asked for: see [`Cells::turn`].
    round: AtomicU32,
}

/// How crowded a box is.
#[derive(Clone, Copy, Default)]
struct Crowding {
    /// The operands that matter.
    operands: usize,
    /// How many boxes in a row, up to this one, made no progress.
    stagnant: u8,
}

/// What is found out about a box when it is entered.
#[derive(Clone)]
struct Content {
    occupancy: Occupancy,
    /// Set where so many operands of a union matter in the box that its parts are made from the union as a whole.
    crowding: Option<Crowding>,
    /// What matters in the box; nothing is made for crowded boxes.
    part: Option<Arc<Part>>,
}

/// How steep the field is in a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// An upper bound: no value in the box differs from another by more than this for each unit of distance. Infinite if
    /// none is known.
    pub bound: f32,
    /// An upper bound of the slope in the middle.
    pub middle: f32,
}

/// The hierarchy.
///
/// It serves programs with the numbers of its own, but other origins: see [`Cells::for_origins`].
pub struct Cells {
    program: Program,
    root: Cell,
    /// What the boxes below the root weigh.
    weight: AtomicUsize,
    round: AtomicU32,
}

/// The bytes that a step of a part takes, with the operations on registers that follow from it; roughly, since not every
/// part is evaluated.
const BYTES_OF_STEP: usize = 160;

/// The scratch memory of one thread for splitting boxes.
pub struct Splitter {
    level: Level,
    survey: Survey,
    search: Search,
    excerpt: Excerpt,
}

impl Splitter {
    /// Works on a given instruction set.
    pub fn new(level: Level) -> Self {
        Self { level, survey: Survey::default(), search: Search::default(), excerpt: Excerpt::default() }
    }

    /// Finds out about some boxes, all of which lie where `part` holds.
    ///
    /// The boxes have the edge lengths `2 * half`, which may be 0 along some axes, and these middles, coordinate by
    /// coordinate and relative to the program's origin. They are taken somewhat larger, so that nothing falls between
    /// neighbours.
    ///
    /// # Panics
    /// If there are more than [`BATCH`] boxes, or the coordinates differ in number.
    pub fn survey<'s>(
        &'s mut self,
        program: &'s Program,
        part: &'s Arc<Part>,
        middles: [&[f32]; 3],
        half: [f32; 3],
    ) -> Surveyed<'s> {
        let [x, y, z] = middles;
        assert!(x.len() <= BATCH, "at most a batch of boxes");
        assert!(x.len() == y.len() && x.len() == z.len(), "coordinates differ in number");
        // The largest overlap of all boxes is that of those farthest out.
        let farthest = middles.map(|middles| middles.iter().fold(0.0, |most: f32, middle| most.max(middle.abs())));
        self.survey.run(program, part, self.level, &Boxes { middle: middles, half: overlapping(farthest, half) });
        Surveyed { program, part, survey: &mut self.survey }
    }
}

/// What [`Splitter::survey`] found.
pub struct Surveyed<'s> {
    program: &'s Program,
    part: &'s Arc<Part>,
    survey: &'s mut Survey,
}

impl Surveyed<'_> {
    /// What is known about the field's sign in a box, where it has a value.
    pub fn occupancy(&self, place: usize) -> Occupancy {
        match self.survey.range(self.part, place) {
            [lo, _] if lo > 0.0 => Occupancy::Outside(lo),
            [_, hi] if hi < 0.0 => Occupancy::Inside,
            _ => Occupancy::Surface,
        }
    }

    /// What matters in a box for what is wanted.
    pub fn part(&mut self, place: usize, wanted: Wanted) -> Arc<Part> {
        self.survey.reduce(self.program, self.part, place, wanted)
    }
}

impl Cells {
    /// A hierarchy over `region`, in the coordinates of the world.
    pub fn new(program: &Program, region: Aabb) -> Self {
        Self::for_origins(program, region, 0.0)
    }

    /// A hierarchy whose parts also hold for programs with the same numbers and another origin, up to `reach` away from
    /// that of `program`. For these, a box lies at [`Cell::middle`] plus the difference of the origins.
    pub fn for_origins(program: &Program, region: Aabb, reach: f64) -> Self {
        let middle = (region.center() - program.origin()).as_vec3().to_array();
        let half = (region.size() * 0.5).as_vec3().to_array();
        let seam = OVERLAP * reach as f32;
        let crowding =
            Crowd::of(program).map(|crowd| Crowding { operands: crowd.spine().entries().len(), stagnant: 0 });
        let content = Content { occupancy: Occupancy::Surface, crowding, part: Some(Arc::clone(&program.whole)) };
        let root =
            Cell { content: content.into(), ..Cell::new(middle, half, seam, Crowding::default(), Occupancy::Surface) };
        Self { program: program.clone(), root, weight: AtomicUsize::new(0), round: AtomicU32::new(0) }
    }

    /// The box of the whole region.
    pub fn root(&self) -> &Cell {
        &self.root
    }

    /// What the coordinates of boxes are relative to.
    pub fn origin(&self) -> DVec3 {
        self.program.origin()
    }

    /// Finds out what matters in a box: what is asked for in it must have been entered before, unless it is the root.
    ///
    /// What is known about the field's sign may be more afterwards.
    pub fn enter(&self, cell: &Cell, splitter: &mut Splitter) {
        cell.content.get_or_init(|| {
            let content = find_content(&self.program, cell, splitter);
            let steps = content.part.as_ref().map_or(0, |part| part.size());
            self.weight.fetch_add(BYTES_OF_STEP * steps, Ordering::Relaxed);
            content
        });
    }

    /// The parts of a box, x fastest, then y, then z.
    pub fn children<'c>(&'c self, cell: &'c Cell, splitter: &mut Splitter) -> &'c [Cell] {
        let round = self.round.load(Ordering::Relaxed);
        if cell.round.load(Ordering::Relaxed) != round {
            cell.round.store(round, Ordering::Relaxed);
        }
        self.enter(cell, splitter);
        cell.children.get_or_init(|| {
            let children = split(&self.program, cell, splitter);
            self.weight.fetch_add(weight_of(cell, &children), Ordering::Relaxed);
            children
        })
    }

    /// The memory that all boxes take, roughly, in bytes.
    pub fn weight(&self) -> usize {
        self.weight.load(Ordering::Relaxed)
    }

    /// Begins a round, a picture for instance.
    pub fn turn(&self) {
        self.round.fetch_add(1, Ordering::Relaxed);
    }

    /// Takes boxes back into the one they are parts of: all that were not asked for in this round, and if the rest still
    /// weighs more than `most`, all but the root. They are made anew when they are asked for, and are the same again.
    pub fn trim(&mut self, most: usize) {
        let round = *self.round.get_mut();
        let mut freed = 0;
        forget(&mut self.root, &mut freed, Some(round));
        let weight = self.weight.get_mut();
        *weight -= freed;
        if *weight > most {
            self.root.children.take();
            *weight = 0;
        }
    }
}

/// What the children of a box weigh, without their own.
fn weight_of(cell: &Cell, children: &[Cell]) -> usize {
    let part = |cell: &Cell| cell.content.get().and_then(|content| content.part.clone());
    let own = part(cell);
    let steps = |child: &Cell| match (part(child), &own) {
        // A part that is that of the parent takes nothing.
        (Some(part), Some(own)) if Arc::ptr_eq(&part, own) => 0,
        (Some(part), _) => part.size(),
        (None, _) => 0,
    };
    children.iter().map(|child| size_of::<Cell>() + BYTES_OF_STEP * steps(child)).sum()
}

/// Drops the children of all boxes below and including `cell` for which nobody asked in a round, or of all of them, and adds
/// up what they weighed.
fn forget(cell: &mut Cell, freed: &mut usize, round: Option<u32>) {
    let round = round.filter(|round| cell.round.get_mut() == round);
    // The deepest first, so that all are weighed.
    for child in cell.children.get_mut().into_iter().flatten() {
        forget(child, freed, round);
    }
    if round.is_none()
        && let Some(children) = cell.children.take()
    {
        *freed += weight_of(cell, &children);
    }
}

impl Cells {
    /// How steep the field is in a box and a little around it. Found when it is first asked for, of a box that is not
    /// crowded.
    ///
    /// A step of a value divided by the bound meets no surface as long as it stays in the box, whatever the field is elsewhere:
    /// this is what keeps a strongly warped spot from slowing the rest (Galin et al., "Segment Tracing Using Local
    /// Lipschitz Bounds", 2020).
    pub fn slope(&self, cell: &Cell) -> Slope {
        *cell.slope.get_or_init(|| {
            let mut sloper = Sloper::new(&self.program, &cell.part().steps);
            let origin = self.program.origin();
            let half = cell.half();
            let side = |axis: usize, share: f64| {
                let middle = origin[axis] + f64::from(cell.middle[axis]);
                let half =
                    share * (f64::from(half[axis]) * AROUND + f64::from(OVERLAP * cell.middle[axis].abs() + cell.seam));
                Interval::new(middle - half, middle + half)
            };
            let bound = sloper.bound([0, 1, 2].map(|axis| side(axis, 1.0)));
            let middle = sloper.bound([0, 1, 2].map(|axis| side(axis, 0.0)));
            Slope { bound: (bound as f32).next_up(), middle: (middle as f32).next_up() }
        })
    }
}

/// Slopes hold in boxes this much larger: rays enter and leave boxes where rounding errors put it.
const AROUND: f64 = 1.0 + 1e-4;

/// A bound of the slope over a box that is larger than that in its middle by no more than this is tight.
const TIGHT: f32 = 1.25;

impl Slope {
    /// Whether smaller boxes could not have a much lower bound.
    pub fn is_tight(&self) -> bool {
        self.bound.is_finite() && self.bound <= TIGHT * self.middle
    }
}

impl Cell {
    fn new(middle: [f32; 3], half: [f32; 3], seam: f32, crowding: Crowding, occupancy: Occupancy) -> Self {
        let (content, slope, children) = (OnceLock::new(), OnceLock::new(), OnceLock::new());
        Self { middle, half, seam, crowding, occupancy, content, slope, children, round: AtomicU32::new(0) }
    }

    /// The middle.
    pub fn middle(&self) -> [f32; 3] {
        self.middle
    }

    /// Half the edge lengths. Boxes overlap by more than rounding errors, so that nothing falls between them.
    pub fn half(&self) -> [f32; 3] {
        overlapping(self.middle, self.half).map(|half| half + self.seam)
    }

    /// What is known about the field's sign.
    pub fn occupancy(&self) -> Occupancy {
        self.content.get().map_or(self.occupancy, |content| content.occupancy)
    }

    /// Whether so many operands of a union matter here that a part is not worth making: the box is there to be split. Never
    /// so before it is entered.
    pub fn is_crowded(&self) -> bool {
        self.content.get().is_some_and(|content| content.crowding.is_some())
    }

    /// What matters here.
    ///
    /// # Panics
    /// If the box was not entered ([`Cells::enter`]), or is crowded and not the root.
    pub fn part(&self) -> &Arc<Part> {
        let content = self.content.get().expect("a box is entered before its part is asked for");
        content.part.as_ref().expect("crowded boxes are split")
    }
}

/// What boxes overlap by, relative to their places and sizes.
const OVERLAP: f32 = 16.0 * f32::EPSILON;

/// Parts hold this many seams beyond their boxes: one that boxes overlap by, and as much again for the rounding errors of
/// points relative to another origin, which are a small part of a seam.
const SEAMS: f32 = 2.0;

fn overlapping(middle: [f32; 3], half: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|axis| half[axis] + OVERLAP * (middle[axis].abs() + half[axis]))
}

/// The parts of a box, side by side: their middles, coordinate by coordinate, and half their edge lengths.
fn places(cell: &Cell, n: usize) -> ([Vec<f32>; 3], [f32; 3]) {
    let half = cell.half.map(|half| half / n as f32);
    let place = |axis: usize, index: usize| cell.middle[axis] + half[axis] * (2 * index + 1) as f32 - cell.half[axis];
    let mut middles: [Vec<f32>; 3] = Default::default();
    for index in (0..n * n * n).map(|i| [i % n, i / n % n, i / (n * n)]) {
        for (axis, middles) in middles.iter_mut().enumerate() {
            middles.push(place(axis, index[axis]));
        }
    }
    (middles, half)
}

fn split(program: &Program, cell: &Cell, splitter: &mut Splitter) -> Box<[Cell]> {
    if cell.is_crowded() {
        return split_crowd(program, cell, splitter);
    }
    let part = cell.part();
    let n = if part.size() > LARGE { SPLIT_OF_LARGE } else { SPLIT };
    let (middles, half) = places(cell, n);
    let [x, y, z] = &middles;
    assert!(x.len() <= BATCH, "all parts go into one batch");
    let survey = &mut splitter.survey;
    // The largest overlap of all parts is that of those farthest out.
    let farthest = std::array::from_fn(|axis| cell.middle[axis].abs() + cell.half[axis]);
    let boxes = Boxes { middle: [x, y, z], half: holding(farthest, half, cell.seam) };
    survey.run(program, part, splitter.level, &boxes);
    (0..x.len())
        .map(|place| {
            let occupancy = match survey.range(part, place) {
                [lo, _] if lo > 0.0 => Occupancy::Outside(lo),
                [_, hi] if hi < 0.0 => Occupancy::Inside,
                _ => Occupancy::Surface,
            };
            let part = match occupancy {
                Occupancy::Surface => survey.reduce(program, part, place, Wanted::Surface),
                _ => Arc::clone(part),
            };
            let content = Content { occupancy, crowding: None, part: Some(part) };
            let middle = [x[place], y[place], z[place]];
            Cell { content: content.into(), ..Cell::new(middle, half, cell.seam, Crowding::default(), occupancy) }
        })
        .collect()
}

/// Splits a crowded box. Nothing is found out about its parts but whether they are empty: most will never be entered.
fn split_crowd(program: &Program, cell: &Cell, splitter: &mut Splitter) -> Box<[Cell]> {
    let crowd = Crowd::of(program).expect("a crowded box belongs to a crowd");
    let crowding = cell.content.get().and_then(|content| content.crowding).expect("it is crowded");
    let ([x, y, z], half) = places(cell, SPLIT);
    (0..x.len())
        .map(|place| {
            let middle = [x[place], y[place], z[place]];
            let place = in_world(program, middle, holding(middle.map(f32::abs), half, cell.seam));
            let floor = crowd.floor(place, &mut splitter.search) as f32;
            let occupancy = if floor > 0.0 { Occupancy::Outside(floor.next_down()) } else { Occupancy::Surface };
            Cell::new(middle, half, cell.seam, crowding, occupancy)
        })
        .collect()
}

/// What matters in a part of a crowded box.
fn find_content(program: &Program, cell: &Cell, splitter: &mut Splitter) -> Content {
    let crowd = Crowd::of(program).expect("a box that is not entered is part of a crowded one");
    let Splitter { level, survey, search, excerpt } = splitter;
    let half = holding(cell.middle.map(f32::abs), cell.half, cell.seam);
    crowd.find(in_world(program, cell.middle, half), search);
    let occupancy = cell.occupancy;
    let (operands, above) = (search.found.len(), cell.crowding);
    let is_stagnant = operands as f64 > NO_PROGRESS * above.operands as f64;
    let crowding = Crowding { operands, stagnant: if is_stagnant { above.stagnant + 1 } else { 0 } };
    if occupancy == Occupancy::Surface && operands > CROWD && crowding.stagnant <= MOST_STAGNANT {
        return Content { occupancy, crowding: Some(crowding), part: None };
    }
    let operands = search.found.iter().map(|&operand| operand as usize);
    let result = excerpt.take(&program.whole.steps, crowd.spine(), operands);
    let part = Arc::new(Part::new(Steps { list: excerpt.list.clone(), result }));
    let [x, y, z] = cell.middle.map(|middle| [middle]);
    survey.run(program, &part, *level, &Boxes { middle: [&x, &y, &z], half });
    let occupancy = match (occupancy, survey.range(&part, 0)) {
        (Occupancy::Outside(least), [lo, _]) => Occupancy::Outside(least.max(lo)),
        (_, [lo, _]) if lo > 0.0 => Occupancy::Outside(lo),
        (_, [_, hi]) if hi < 0.0 => Occupancy::Inside,
        _ => Occupancy::Surface,
    };
    let part = match occupancy {
        Occupancy::Inside => part,
        Occupancy::Outside(_) | Occupancy::Surface => survey.reduce(program, &part, 0, Wanted::Surface),
    };
    Content { occupancy, crowding: None, part: Some(part) }
}

/// Half the edge lengths of the boxes that parts must hold in.
fn holding(farthest: [f32; 3], half: [f32; 3], seam: f32) -> [f32; 3] {
    overlapping(farthest, half).map(|half| half + SEAMS * seam)
}

/// A box in the coordinates of the world.
fn in_world(program: &Program, middle: [f32; 3], half: [f32; 3]) -> Aabb {
    let (middle, half) = (program.origin() + Vec3::from(middle).as_dvec3(), Vec3::from(half).as_dvec3());
    Aabb { min: middle - half, max: middle + half }
}
