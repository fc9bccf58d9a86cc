//! Rays that travel together through the hierarchy of cells.
//!
//! A packet is sorted by the signs of the rays' directions into bundles, each of which visits the cells that its rays meet
//! from front to back. A box that lies beside the shaft around all rays of a bundle is skipped with all it holds; in the
//! smallest boxes the rays that meet them march with the part of the program that matters there. What a ray ends with
//! depends on nothing but the ray and the cells: not on its companions.

use crate::bundle::{Bundle, Rows, SHAFT_SEAM, Shaft};
use crate::loose::Loose;
use crate::march::{self, End, Pace, Start};
use crate::rays::Rays;
use crate::search::Search;
use crate::vector::{Triple, length};
use freikugel_field::{Cell, Cells, Encloser, Evaluator, Occupancy, Slope, Splitter};

/// A part with this many steps is not worth splitting further: some ten primitives and what joins them cost rays less than
/// the way through more boxes.
const SMALL_PART: usize = 24;

/// The same for a part with a warp or a displacement, whose formulas count, too.
const SMALL_WARPED: usize = 32;

/// Where the field is steeper than this, a search by intervals needs fewer looks than a march would need steps.
const STEEP: f32 = 16.0;

/// As [`STEEP`], for formulas, relative to the slope in the middle of a cell: a march takes some more steps than a search
/// needs models, each of which costs as much as six values.
const EVEN: f32 = 2.0;

/// A box this many pixels wide, as seen from the camera, is not split further: fewer rays meet it than fill the lanes.
const CELL_PIXELS: f32 = 24.0;

/// As [`SMALL_PART`], for parts with formulas, and as [`CELL_PIXELS`]: a model along a ray covers long stretches at once, so
/// that large boxes are better unless they hold less of a long formula.
const SMALL_FORMULA: usize = 96;
const FORMULA_PIXELS: f32 = 48.0;

/// What rays travel through.
pub(crate) struct Space<'f> {
    pub(crate) cells: &'f Cells,
    /// Where the origin of the cells lies, relative to that of the rays.
    pub(crate) shift: Triple,
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

impl<'f> Space<'f> {
    /// The middle of a cell, relative to the origin of the rays.
    pub(crate) fn middle(&self, cell: &Cell) -> Triple {
        let middle = cell.middle();
        std::array::from_fn(|axis| middle[axis] + self.shift[axis])
    }

    /// The smallest cell around a point. What lies outside of all gets that of all.
    pub(crate) fn cell_at(&self, point: Triple, splitter: &mut Splitter) -> &'f Cell {
        let root = self.cells.root();
        let [middle, half] = [self.middle(root), root.half()];
        self.cells.enter(root, splitter);
        if (0..3).any(|axis| (point[axis] - middle[axis]).abs() > half[axis]) {
            return root;
        }
        let mut cell = root;
        while !self.is_small(cell, true) {
            let children = self.cells.children(cell, splitter);
            let side = side_of(children);
            let place = |axis: usize, stride: usize| {
                let nearest = |place: &usize| (self.middle(&children[place * stride])[axis] - point[axis]).abs();
                (0..side).min_by(|a, b| nearest(a).total_cmp(&nearest(b))).expect("a child") * stride
            };
            cell = &children[place(0, 1) + place(1, side) + place(2, side * side)];
            self.cells.enter(cell, splitter);
        }
        cell
    }

    /// Whether a box that was entered is not worth splitting further, for what is done with values there if that is safe, or
    /// else with models.
    fn is_small(&self, cell: &Cell, by_values: bool) -> bool {
        if cell.is_crowded() {
            return self.manner == Manner::Plain;
        }
        let part = cell.part();
        let (small, pixels) = match (part.is_measured() && by_values, part.is_warped()) {
            (true, _) => (SMALL_PART, CELL_PIXELS),
            (false, true) => (0, CELL_PIXELS),
            (false, false) => (SMALL_FORMULA, FORMULA_PIXELS),
        };
        if self.manner == Manner::Plain || cell.occupancy() != Occupancy::Surface || part.size() <= small {
            return true;
        }
        if part.is_warped() && by_values && part.size() <= SMALL_WARPED && self.cells.slope(cell).is_tight() {
            return true;
        }
        let (middle, half, eye) = (self.middle(cell), cell.half(), self.eye);
        let gap = |axis: usize| ((middle[axis] - eye[axis]).abs() - half[axis]).max(0.0);
        let distance = length([gap(0), gap(1), gap(2)]);
        let [fixed, growth] = self.pixel;
        2.0 * half[0].max(half[1]).max(half[2]) <= pixels * (fixed + growth * distance)
    }
}

/// Rays to be traced together.
#[derive(Default)]
pub(crate) struct Packet<'f> {
    /// By the signs of the directions. Those beyond the first `in_use` have no rays.
    bundles: [Vec<Bundle>; 8],
    in_use: [usize; 8],
    /// Scratch memory: the places of rays that wait to be taken into bundles.
    waiting: [Vec<u32>; 8],
    /// The cells in which something was met.
    pub(crate) places: Vec<&'f Cell>,
    search: Search,
    loose: Loose,
}

impl<'f> Packet<'f> {
    /// Adds a ray.
    pub(crate) fn push(&mut self, start: &Start) {
        self.open(octant(start.direction)).push(start);
    }

    /// Adds those of some camera rays that march.
    pub(crate) fn push_all(&mut self, rays: &Rays) {
        let [x, y, z] = &rays.starts.direction;
        let mut waiting = std::mem::take(&mut self.waiting);
        for ray in rays.marching() {
            waiting[octant([x[ray], y[ray], z[ray]])].push(ray as u32);
        }
        for (octant, waiting) in waiting.iter_mut().enumerate() {
            let mut rest = &waiting[..];
            while !rest.is_empty() {
                let taken = self.open(octant).take(&rays.starts, rest);
                rest = &rest[taken..];
            }
            waiting.clear();
        }
        self.waiting = waiting;
    }

    /// A bundle of an octant that is not full.
    fn open(&mut self, octant: usize) -> &mut Bundle {
        let (bundles, in_use) = (&mut self.bundles[octant], &mut self.in_use[octant]);
        if *in_use == 0 || bundles[*in_use - 1].is_full() {
            *in_use += 1;
            if bundles.len() < *in_use {
                bundles.push(Bundle::default());
            }
        }
        &mut bundles[*in_use - 1]
    }

    /// Whether there are no rays.
    pub(crate) fn is_empty(&self) -> bool {
        self.in_use.iter().all(|&count| count == 0)
    }

    /// Takes all rays as far as they go. Appends how they ended; of those that met something, all of a bundle that met it in
    /// one cell stand together. Returns how many field values that took. The packet is empty afterwards.
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
        let Self { bundles, in_use, places, search, loose, .. } = self;
        let mut trip = Trip { space, quest, field, encloser, splitter, places, search, loose };
        let mut evaluations = 0;
        for (bundles, in_use) in bundles.iter_mut().zip(in_use) {
            for bundle in &mut bundles[..*in_use] {
                evaluations += trip.take(bundle);
                bundle.finish(ends);
            }
            *in_use = 0;
        }
        evaluations
    }
}

/// How many parts of a box lie side by side.
fn side_of(children: &[Cell]) -> usize {
    (1..).find(|n| n * n * n >= children.len()).expect("a cube of boxes")
}

/// The signs of a direction.
#[inline(always)]
fn octant(direction: Triple) -> usize {
    let sign = |axis: usize| usize::from(direction[axis] < 0.0) << axis;
    sign(0) | sign(1) | sign(2)
}

/// A packet on its way.
struct Trip<'a, 'f, 'e> {
    space: &'a Space<'f>,
    quest: Quest,
    field: &'a mut Evaluator<'e>,
    encloser: &'a mut Encloser<'e>,
    splitter: &'a mut Splitter,
    places: &'a mut Vec<&'f Cell>,
    search: &'a mut Search,
    loose: &'a mut Loose,
}

impl<'f> Trip<'_, 'f, '_> {
    fn take(&mut self, bundle: &mut Bundle) -> u64 {
        let shaft = bundle.set_out(self.field.level());
        let root = self.space.cells.root();
        // What lies outside all cells can still dim a soft shadow.
        let mut evaluations = self.march_outside(bundle, root, false);
        evaluations += self.visit(bundle, &shaft, bundle.rows(), root);
        evaluations + self.march_outside(bundle, root, true)
    }

    /// Visits a box that some rays of some rows may meet.
    fn visit(&mut self, bundle: &mut Bundle, shaft: &Shaft, rows: Rows, cell: &'f Cell) -> u64 {
        if bundle.is_done() {
            return 0;
        }
        self.space.cells.enter(cell, self.splitter);
        // More may be known now.
        if self.is_of_no_interest(cell) {
            return 0;
        }
        if self.space.is_small(cell, self.may_march()) {
            let rows = bundle.meet(self.field.level(), rows, self.space.middle(cell), cell.half());
            let pace = self.pace_of(cell);
            return self.cross(bundle, rows, cell, pace);
        }
        let rows = bundle.approaching(self.field.level(), rows, self.space.middle(cell), cell.half());
        if rows.is_empty() {
            return 0;
        }
        let children = self.space.cells.children(cell, self.splitter);
        let side = side_of(children);
        let strides = [1, side, side * side];
        // Along each axis the slabs that the boxes lie in, from front to back.
        let mut slabs = [[(0, [0.0; 2]); MOST_SLABS]; 3];
        for (axis, slabs) in slabs.iter_mut().enumerate() {
            for (place, slab) in slabs[..side].iter_mut().enumerate() {
                let index = if shaft.rises(axis) { place } else { side - 1 - place };
                let child = &children[index * strides[axis]];
                *slab = (index * strides[axis], shaft.slab(axis, self.space.middle(child)[axis], child.half()[axis]));
            }
        }
        let meet = |[near, far]: [f32; 2], [first, last]: [f32; 2]| [near.max(first), far.min(last)];
        let is_open = |[near, far]: [f32; 2]| near <= far + SHAFT_SEAM * (near.abs() + far.abs());
        let mut evaluations = 0;
        for &(z, slab) in &slabs[2][..side] {
            let span = meet([shaft.near, shaft.far], slab);
            if !is_open(span) {
                continue;
            }
            for &(y, slab) in &slabs[1][..side] {
                let span = meet(span, slab);
                if !is_open(span) {
                    continue;
                }
                for &(x, slab) in &slabs[0][..side] {
                    let child = &children[x + y + z];
                    if is_open(meet(span, slab)) && !self.is_of_no_interest(child) {
                        evaluations += self.visit(bundle, shaft, rows, child);
                    }
                }
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

    /// Lets rays march on the stretches of them that lie outside the region of all cells, before or behind it.
    fn march_outside(&mut self, bundle: &mut Bundle, root: &'f Cell, is_behind: bool) -> u64 {
        if self.quest != Quest::Least {
            return 0;
        }
        let rows = bundle.rows();
        bundle.meet(self.field.level(), rows, self.space.middle(root), root.half());
        let rows = bundle.outside(is_behind);
        let pace = root.part().is_measured().then_some(self.space.pace);
        self.cross(bundle, rows, root, pace)
    }

    /// How rays march in a cell by the values of its part, if they can. Where space is warped, that depends on the cell; and
    /// formulas, too, are marched where their slope hardly changes: they are distances there but for a factor.
    fn pace_of(&self, cell: &Cell) -> Option<Pace> {
        let pace = self.space.pace;
        if !self.may_march() {
            return None;
        }
        // The pace of plain marches suits formulas, too, but makes no clearances of their values.
        if cell.part().is_measured() || (self.space.manner == Manner::Plain && self.quest != Quest::Least) {
            return Some(pace);
        }
        // Clearances by slopes that differ from cell to cell would show the cells in penumbras.
        if !cell.part().is_warped() && self.quest == Quest::Least {
            return None;
        }
        let Slope { bound, middle } = self.space.cells.slope(cell);
        let steepest = if cell.part().is_warped() { STEEP } else { EVEN * middle };
        (bound > 0.0 && bound <= steepest && bound.is_finite()).then(|| Pace { scale: 1.0 / bound, ..pace })
    }

    /// Takes the rays of some rows along their stretches, on which the part of `cell` holds; without a pace, they search.
    fn cross(&mut self, bundle: &mut Bundle, rows: Rows, cell: &'f Cell, pace: Option<Pace>) -> u64 {
        if rows.is_empty() {
            return 0;
        }
        let part = cell.part();
        let place = self.places.len() as u32;
        let finds = bundle.finds();
        let evaluations = if let Some(pace) = pace {
            self.march(bundle, rows, cell, pace, place)
        } else {
            // Without a scale there is no clearance: a surface dims all or nothing.
            self.search.cross(bundle, rows, self.encloser, part, self.space.pace, place)
        };
        if bundle.finds() > finds {
            self.places.push(cell);
        }
        evaluations
    }

    /// Lets the rays of some rows march through a cell.
    fn march(&mut self, bundle: &mut Bundle, mut rows: Rows, cell: &Cell, pace: Pace, place: u32) -> u64 {
        if self.quest != Quest::Least && cell.part().is_loose() {
            return self.loose.hard(bundle, rows, self.field, cell.part(), pace, place);
        }
        if self.quest != Quest::Least {
            return march::hard(bundle, rows, self.field, cell.part(), pace, place);
        }
        if let Occupancy::Outside(clearance) = cell.occupancy() {
            rows = bundle.undimmed(clearance * pace.scale);
        }
        march::soft(bundle, rows, self.field, cell.part(), pace, place)
    }
}

/// The most boxes side by side that one is split into.
const MOST_SLABS: usize = freikugel_field::cells::SPLIT;
