//! Reduction of a program to what can matter in a region.
//!
//! An operand of a combination is dropped where the other one alone decides it all over the region: for a union, where the
//! operand's least value is above the other's largest. The values' ranges come from intervals and from Lipschitz constants
//! (Duff, "Interval arithmetic and recursive subdivision for implicit functions and constructive solid geometry", 1992;
//! Keeter, "Massively parallel rendering of complex closed-form implicit surfaces", 2020; Barbier et al., "Lipschitz
//! pruning", 2025). What remains has the same values in the region, bit for bit.

use crate::bank::{Bank, Ranges};
use crate::formula::{Binary, Unary};
use crate::kernel::{BATCH, WIDEST};
use crate::mix;
use crate::operation::{Run, Step, StepId, Steps};
use crate::program::{Part, Program};
use crate::scalar::Interval;
use crate::shape::{Kind, ModifyTable, Settled};
use crate::shapes;
use crate::simd::Level;
use crate::spine::Excerpt;
use std::sync::Arc;

/// Boxes of one size, relative to the program's origin.
pub(crate) struct Boxes<'a> {
    /// Their middles, coordinate by coordinate.
    pub(crate) middle: [&'a [f32]; 3],
    /// Half their edge lengths.
    pub(crate) half: [f32; 3],
}

/// What a reduced program is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// All values.
    Values,
    /// The surface, and the sign beside it; and the values, where they have a scale.
    Surface,
}

/// The ranges of all values of a part over several boxes.
#[derive(Default)]
pub(crate) struct Survey {
    bank: Bank<Ranges>,
    /// Step by step, a lower and an upper end for each box.
    ends: Vec<[f32; 2]>,
    boxes: usize,
    /// Operand by operand of the part's chain of minima, if it has one: a bit for each box where it can't be the least.
    excluded: Vec<Bits>,
    scratch: Scratch,
}

/// One bit for each box.
type Bits = [u64; BATCH / 64];

/// What the reduction for one box works with.
#[derive(Default)]
struct Scratch {
    settled: Vec<Settled>,
    windows: Vec<Window>,
    renamed: Vec<StepId>,
    excerpt: Excerpt,
}

impl Survey {
    /// Computes the ranges of all values over `boxes`, at most a batch of them.
    pub(crate) fn run(&mut self, program: &Program, part: &Part, level: Level, boxes: &Boxes<'_>) {
        let listing = part.one_by_one();
        let given = boxes.middle[0].len();
        let count = given.next_multiple_of(WIDEST);
        self.boxes = given;
        self.ends.clear();
        self.ends.resize(part.steps.list.len() * given, [f32::NEG_INFINITY, f32::INFINITY]);
        self.bank.prepare(listing);
        let [x, y, z] = boxes.half;
        for axis in 0..3 {
            let half = boxes.half[axis];
            for lane in 0..count {
                let middle = boxes.middle[axis].get(lane).copied().unwrap_or_default();
                self.bank.points[2 * axis].0[lane] = (middle - half).next_down();
                self.bank.points[2 * axis + 1].0[lane] = (middle + half).next_up();
            }
        }
        self.bank.reach[0].0.0[..count].fill((x * x + y * y + z * z).sqrt() * (1.0 + 4.0 * f32::EPSILON));
        for (index, op) in listing.ops.iter().enumerate() {
            self.bank.step(program, op, level, count);
            let step = index + 1;
            if !part.steps.list[step].is_point() {
                let [lo, hi] = self.bank.value(listing.place[step] as usize) else { unreachable!("two ends") };
                let ends = &mut self.ends[step * given..(step + 1) * given];
                for (lane, ends) in ends.iter_mut().enumerate() {
                    *ends = [lo.0[lane], hi.0[lane]];
                }
            }
        }
        self.exclude(part);
    }

    /// Finds which operands of a chain of minima can't be the least, box by box: those above the largest value of the chain.
    fn exclude(&mut self, part: &Part) {
        self.excluded.clear();
        let (Some(spine), Some(result)) = (part.spine(), part.steps.result) else {
            return;
        };
        let boxes = self.boxes;
        let row = |id: StepId| &self.ends[id.index() * boxes..(id.index() + 1) * boxes];
        let ceilings: Vec<f32> = row(result).iter().map(|[_, hi]| *hi).collect();
        self.excluded.extend(spine.entries().iter().map(|entry| {
            let mut bits = Bits::default();
            for (lane, ([lo, _], ceiling)) in row(entry.operand()).iter().zip(&ceilings).enumerate() {
                bits[lane / 64] |= u64::from(lo > ceiling) << (lane % 64);
            }
            bits
        }));
    }

    /// The range of the result over a box.
    pub(crate) fn range(&self, part: &Part, place: usize) -> [f32; 2] {
        match part.steps.result {
            Some(result) => self.ends[result.index() * self.boxes + place],
            None => [f32::INFINITY; 2],
        }
    }

    /// The steps that matter in a box. The part itself if all of them do.
    pub(crate) fn reduce(&mut self, program: &Program, part: &Arc<Part>, place: usize, wanted: Wanted) -> Arc<Part> {
        let Some(result) = part.steps.result else {
            return Arc::clone(part);
        };
        let list = &part.steps.list;
        let (ends, boxes) = (&self.ends, self.boxes);
        let range = |id: StepId| ends[id.index() * boxes + place];
        let Scratch { settled, windows, renamed, excerpt } = &mut self.scratch;
        // Without a scale only the sign tells anything of what is inside, so that it does not matter how far below 0 it is.
        let window = match wanted {
            Wanted::Values => Window::ALL,
            Wanted::Surface if part.is_measured() => Window::ALL,
            Wanted::Surface => Window { floor: 0.0, ..Window::ALL },
        };
        if let Some(spine) = part.spine() {
            let (word, bit) = (place / 64, place % 64);
            let kept = (0..self.excluded.len()).filter(|&entry| self.excluded[entry][word] >> bit & 1 == 0);
            if let Some(result) = excerpt.take(&part.steps, spine, kept) {
                let Excerpt { list, origin } = excerpt;
                let range = |id: StepId| range(origin[id.index()]);
                let dropped = mark(program, list, result, window, range, settled, windows);
                if dropped == 0 && list.len() == part.steps.list.len() {
                    return Arc::clone(part);
                }
                return Arc::new(Part::new(rebuild(list, result, settled, windows, renamed)));
            }
        }
        let dropped = mark(program, list, result, window, range, settled, windows);
        if dropped == 0 {
            return Arc::clone(part);
        }
        Arc::new(Part::new(rebuild(list, result, settled, windows, renamed)))
    }
}

/// What a step comes to by the ranges of its operands.
fn settle(program: &Program, step: &Step, range: impl Fn(StepId) -> [f32; 2]) -> Settled {
    let interval = |id: StepId| {
        let [lo, hi] = range(id);
        (lo <= hi).then(|| Interval::new(lo.into(), hi.into()))
    };
    let pair = |a: StepId, b: StepId| Some((interval(a)?, interval(b)?));
    match *step {
        Step::Combine { table, a, b, constants } => {
            pair(a, b).map_or(Settled::Open, |(a, b)| (table.settle)(a, b, &program.double[constants.range()]))
        }
        Step::Binary { op: Binary::Min, a, b } => pair(a, b).map_or(Settled::Open, |(a, b)| Settled::lesser(a, b, 0.0)),
        Step::Binary { op: Binary::Max, a, b } => {
            pair(a, b).map_or(Settled::Open, |(a, b)| Settled::lesser(-a, -b, 0.0))
        }
        // What alters a value has no region of its own.
        Step::Altered { op: Binary::Min, from, by } => pair(from, by).map_or(Settled::Open, |(a, b)| kept(a, b)),
        Step::Altered { op: Binary::Max, from, by } => pair(from, by).map_or(Settled::Open, |(a, b)| kept(-a, -b)),
        Step::Mix { height, constants, .. } => {
            interval(height).map_or(Settled::Open, |height| mix::settle(height, &program.double[constants.range()]))
        }
        Step::Unary { op: Unary::Abs, from } => match range(from) {
            [lo, _] if lo > 0.0 => Settled::First,
            [_, hi] if hi < 0.0 => Settled::NotSecond,
            _ => Settled::Open,
        },
        _ => Settled::Open,
    }
}

/// Whether the first of two values is less than the second, which has no region of its own.
fn kept(a: Interval, b: Interval) -> Settled {
    if Settled::lesser(a, b, 0.0) == Settled::First { Settled::First } else { Settled::Open }
}

/// The operands of a step that picks one of two values, and whether it picks the lesser or the greater.
fn choice(step: &Step) -> Option<(StepId, StepId, Choice)> {
    match *step {
        Step::Combine { table, a, b, .. } if table.is_minimum => Some((a, b, Choice::Lesser)),
        Step::Binary { op: Binary::Min, a, b } => Some((a, b, Choice::Lesser)),
        Step::Binary { op: Binary::Max, a, b } => Some((a, b, Choice::Greater)),
        _ => None,
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Choice {
    Lesser,
    Greater,
}

/// The values of a step that still make a difference to those that read it.
#[derive(Clone, Copy)]
struct Window {
    is_read: bool,
    floor: f32,
    ceiling: f32,
}

impl Window {
    const UNREAD: Self = Self { is_read: false, floor: f32::INFINITY, ceiling: f32::NEG_INFINITY };
    const ALL: Self = Self { is_read: true, floor: f32::NEG_INFINITY, ceiling: f32::INFINITY };

    /// The window for all who read the step.
    fn widen(&mut self, other: Self) {
        self.is_read |= other.is_read;
        self.floor = self.floor.min(other.floor);
        self.ceiling = self.ceiling.max(other.ceiling);
    }
}

/// Finds what the result still depends on, and settles choices: by their own operands, and those of which an operand is too
/// large or too small to matter in the end. Returns how many steps don't matter. Values of the result outside `window` are as
/// good as any others on that side of it.
///
/// A chain of minima is settled from its end: an operand above the largest value that the whole chain can have is not
/// needed, even if it is not above the operands before it. Chains of maxima likewise.
fn mark(
    program: &Program,
    list: &[Step],
    result: StepId,
    window: Window,
    range: impl Fn(StepId) -> [f32; 2],
    settled: &mut Vec<Settled>,
    windows: &mut Vec<Window>,
) -> usize {
    settled.clear();
    settled.resize(list.len(), Settled::Open);
    windows.clear();
    windows.resize(list.len(), Window::UNREAD);
    windows[StepId::POINT.index()] = Window::ALL;
    windows[result.index()] = window;
    let mut needed = 0;
    for index in (0..list.len()).rev() {
        let own = windows[index];
        if !own.is_read {
            continue;
        }
        needed += 1;
        let step = &list[index];
        settled[index] = settle(program, step, &range);
        let mut window = if let Step::Surface { .. } = step { own } else { Window::ALL };
        if let Some((a, b, choice)) = choice(step) {
            let [lo, hi] = range(StepId(index as u32));
            window = match choice {
                Choice::Lesser => Window { ceiling: own.ceiling.min(hi), ..own },
                Choice::Greater => Window { floor: own.floor.max(lo), ..own },
            };
            if settled[index] == Settled::Open {
                let is_outside = |id: StepId| match (choice, range(id)) {
                    (Choice::Lesser, [lo, _]) => lo > window.ceiling,
                    (Choice::Greater, [_, hi]) => hi < window.floor,
                };
                settled[index] = match (is_outside(a), is_outside(b)) {
                    (false, true) => Settled::First,
                    (true, false) => Settled::Second,
                    _ => Settled::Open,
                };
            }
        }
        needed -= usize::from(matches!(settled[index], Settled::First | Settled::Second));
        match (settled[index], *step) {
            (Settled::Open, step) => step.operands(|id| windows[id.index()].widen(window)),
            (Settled::First, step) => {
                windows[first(&step).index()].widen(window);
            }
            (Settled::Second | Settled::NotSecond, step) => {
                windows[second(&step).index()].widen(window);
            }
        }
    }
    list.len() - needed
}

fn first(step: &Step) -> StepId {
    match *step {
        Step::Combine { a, .. } | Step::Binary { a, .. } | Step::Mix { a, .. } => a,
        Step::Unary { from, .. } | Step::Altered { from, .. } => from,
        _ => unreachable!("only choices are settled"),
    }
}

fn second(step: &Step) -> StepId {
    match *step {
        Step::Combine { b, .. } | Step::Binary { b, .. } | Step::Mix { b, .. } => b,
        Step::Unary { from, .. } => from,
        _ => unreachable!("only choices are settled"),
    }
}

/// The list of the steps that are needed.
fn rebuild(list: &[Step], result: StepId, settled: &[Settled], windows: &[Window], renamed: &mut Vec<StepId>) -> Steps {
    let Kind::Modify(complement) = &shapes::COMPLEMENT.kind else { unreachable!("complement modifies") };
    let complement: &'static ModifyTable = complement;
    renamed.clear();
    renamed.resize(list.len(), StepId::POINT);
    let mut kept = Vec::new();
    for (index, step) in list.iter().enumerate() {
        if !windows[index].is_read {
            continue;
        }
        let new = |id: StepId| renamed[id.index()];
        let own = match (*step, settled[index]) {
            (step, Settled::Open) => Ok(step.with_operands(new)),
            (step, Settled::First) => Err(new(first(&step))),
            (step, Settled::Second) => Err(new(second(&step))),
            (step, Settled::NotSecond) => {
                Ok(Step::Modify { table: complement, from: new(second(&step)), constants: Run::default() })
            }
        };
        renamed[index] = match own {
            Err(same) => same,
            Ok(step) => {
                kept.push(step);
                StepId(kept.len() as u32 - 1)
            }
        };
    }
    Steps { list: kept, result: Some(renamed[result.index()]) }
}
