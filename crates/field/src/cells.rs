//! A hierarchy of boxes over a region of space, each with the part of a program that matters in it.
//!
//! Boxes are split on demand, into [`SPLIT`] parts along each axis. What a box holds depends on nothing but its place: not
//! on the order of the requests, nor on how many threads make them.

use crate::contract::Aabb;
use crate::kernel::BATCH;
use crate::program::{Part, Program};
pub use crate::prune::Wanted;
use crate::prune::{Boxes, Survey};
use crate::scalar::Interval;
use crate::simd::Level;
use crate::slope::Sloper;
use std::sync::{Arc, OnceLock};

/// Into how many parts a box is split along each axis. The parts fill a few vectors of lanes, so that they cost little more
/// together than one alone.
pub const SPLIT: usize = 4;

/// As [`SPLIT`], for parts of programs above [`LARGE`], whose ranges would need much memory.
const SPLIT_OF_LARGE: usize = 2;

/// How many steps make a part large.
const LARGE: usize = 1 << 14;

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

/// A box, and what matters in it. Coordinates are relative to the program's origin.
pub struct Cell {
    middle: [f32; 3],
    half: [f32; 3],
    occupancy: Occupancy,
    part: Arc<Part>,
    slope: OnceLock<Slope>,
    children: OnceLock<Box<[Cell]>>,
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
pub struct Cells {
    program: Program,
    root: Cell,
}

/// The scratch memory of one thread for splitting boxes.
pub struct Splitter {
    level: Level,
    survey: Survey,
}

impl Splitter {
    /// Works on a given instruction set.
    pub fn new(level: Level) -> Self {
        Self { level, survey: Survey::default() }
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
        let middle = (region.center() - program.origin()).as_vec3().to_array();
        let half = (region.size() * 0.5).as_vec3().to_array();
        let (occupancy, part) = (Occupancy::Surface, Arc::clone(&program.whole));
        let program = program.clone();
        Self {
            program,
            root: Cell { middle, half, occupancy, part, slope: OnceLock::new(), children: OnceLock::new() },
        }
    }

    /// The box of the whole region.
    pub fn root(&self) -> &Cell {
        &self.root
    }

    /// The parts of a box, x fastest, then y, then z.
    pub fn children<'c>(&'c self, cell: &'c Cell, splitter: &mut Splitter) -> &'c [Cell] {
        cell.children.get_or_init(|| split(&self.program, cell, splitter))
    }
}

impl Cells {
    /// How steep the field is in a box and a little around it. Found when it is first asked for.
    ///
    /// A step of a value divided by the bound meets no surface as long as it stays in the box, whatever the field is elsewhere:
    /// this is what keeps a strongly warped spot from slowing the rest (Galin et al., "Segment Tracing Using Local
    /// Lipschitz Bounds", 2020).
    pub fn slope(&self, cell: &Cell) -> Slope {
        *cell.slope.get_or_init(|| {
            let mut sloper = Sloper::new(&self.program, &cell.part.steps);
            let origin = self.program.origin();
            let half = cell.half();
            let side = |axis: usize, share: f64| {
                let middle = origin[axis] + f64::from(cell.middle[axis]);
                let half = share * (f64::from(half[axis]) * AROUND + f64::from(OVERLAP * cell.middle[axis].abs()));
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
    /// The middle.
    pub fn middle(&self) -> [f32; 3] {
        self.middle
    }

    /// Half the edge lengths. Boxes overlap by more than rounding errors, so that nothing falls between them.
    pub fn half(&self) -> [f32; 3] {
        overlapping(self.middle, self.half)
    }

    /// What is known about the field's sign.
    pub fn occupancy(&self) -> Occupancy {
        self.occupancy
    }

    /// What matters here.
    pub fn part(&self) -> &Arc<Part> {
        &self.part
    }
}

/// What boxes overlap by, relative to their places and sizes.
const OVERLAP: f32 = 16.0 * f32::EPSILON;

fn overlapping(middle: [f32; 3], half: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|axis| half[axis] + OVERLAP * (middle[axis].abs() + half[axis]))
}

fn split(program: &Program, cell: &Cell, splitter: &mut Splitter) -> Box<[Cell]> {
    let n = if cell.part.size() > LARGE { SPLIT_OF_LARGE } else { SPLIT };
    let half = cell.half.map(|half| half / n as f32);
    let place = |axis: usize, index: usize| cell.middle[axis] + half[axis] * (2 * index + 1) as f32 - cell.half[axis];
    let places = (0..n * n * n).map(|i| [i % n, i / n % n, i / (n * n)]);
    let mut middles: [Vec<f32>; 3] = Default::default();
    for index in places {
        for (axis, middles) in middles.iter_mut().enumerate() {
            middles.push(place(axis, index[axis]));
        }
    }
    let [x, y, z] = &middles;
    assert!(x.len() <= BATCH, "all parts go into one batch");
    let survey = &mut splitter.survey;
    // The largest overlap of all parts is that of those farthest out.
    let farthest = std::array::from_fn(|axis| cell.middle[axis].abs() + cell.half[axis]);
    let boxes = Boxes { middle: [x, y, z], half: overlapping(farthest, half) };
    survey.run(program, &cell.part, splitter.level, &boxes);
    (0..x.len())
        .map(|place| {
            let [lo, hi] = survey.range(&cell.part, place);
            let occupancy = match cell.occupancy {
                _ if lo > 0.0 => Occupancy::Outside(lo),
                _ if hi < 0.0 => Occupancy::Inside,
                _ => Occupancy::Surface,
            };
            let part = match occupancy {
                Occupancy::Surface => survey.reduce(program, &cell.part, place, Wanted::Surface),
                _ => Arc::clone(&cell.part),
            };
            let middle = [x[place], y[place], z[place]];
            Cell { middle, half, occupancy, part, slope: OnceLock::new(), children: OnceLock::new() }
        })
        .collect()
}
