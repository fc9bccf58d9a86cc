//! Reduction of a program to what can matter in a region.
//!
//! An operand of a combination is dropped where the other one alone decides it all over the region: for a union, where the
//! operand's least value is above the other's largest. The values' ranges come from intervals and from Lipschitz constants
//! (Duff, "Interval arithmetic and recursive subdivision for implicit functions and constructive solid geometry", 1992;
//! Keeter, "Massively parallel rendering of complex closed-form implicit surfaces", 2020; Barbier et al., "Lipschitz
//! pruning", 2025). What remains has the same values in the region, bit for bit.

use crate::bank::{Bank, Ranges};
use crate::kernel::WIDEST;
use crate::operation::{Run, Step, StepId, Steps};
use crate::program::{Part, Program};
use crate::scalar::Interval;
use crate::shape::{Kind, ModifyTable, Settled};
use crate::shapes;
use crate::simd::Level;
use std::sync::Arc;

/// Boxes of one size, relative to the program's origin.
pub(crate) struct Boxes<'a> {
    /// Their middles, coordinate by coordinate.
    pub(crate) middle: [&'a [f32]; 3],
    /// Half their edge lengths.
    pub(crate) half: [f32; 3],
}

/// The ranges of all values of a part over several boxes.
#[derive(Default)]
pub(crate) struct Survey {
    bank: Bank<Ranges>,
    /// Step by step, a lower and an upper end for each box.
    ends: Vec<[f32; 2]>,
    boxes: usize,
    scratch: Scratch,
}

/// What the reduction for one box works with.
#[derive(Default)]
struct Scratch {
    settled: Vec<Settled>,
    /// Above this a step's value does not matter any more; NaN where nothing reads the step.
    ceiling: Vec<f32>,
    renamed: Vec<StepId>,
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
        self.bank.reach[0].radius.0[..count].fill((x * x + y * y + z * z).sqrt() * (1.0 + 4.0 * f32::EPSILON));
        for (index, op) in listing.ops.iter().enumerate() {
            self.bank.step(&program.single, op, level, count);
            let step = index + 1;
            if !part.steps.list[step].is_point() {
                let [lo, hi] = self.bank.value(listing.place[step] as usize) else { unreachable!("two ends") };
                let ends = &mut self.ends[step * given..(step + 1) * given];
                for (lane, ends) in ends.iter_mut().enumerate() {
                    *ends = [lo.0[lane], hi.0[lane]];
                }
            }
        }
    }

    /// The range of the result over a box.
    pub(crate) fn range(&self, part: &Part, place: usize) -> [f32; 2] {
        match part.steps.result {
            Some(result) => self.ends[result.index() * self.boxes + place],
            None => [f32::INFINITY; 2],
        }
    }

    /// The steps that matter in a box. The part itself if all of them do.
    pub(crate) fn reduce(&mut self, program: &Program, part: &Arc<Part>, place: usize) -> Arc<Part> {
        let Some(result) = part.steps.result else {
            return Arc::clone(part);
        };
        let list = &part.steps.list;
        let (ends, boxes) = (&self.ends, self.boxes);
        let range = |id: StepId| ends[id.index() * boxes + place];
        let Scratch { settled, ceiling, renamed } = &mut self.scratch;
        settle(program, list, range, settled);
        let dropped = mark(list, result, range, settled, ceiling);
        if dropped == 0 {
            return Arc::clone(part);
        }
        Arc::new(Part::new(rebuild(list, result, settled, ceiling, renamed)))
    }
}

/// What each combination comes to by the ranges of its operands.
fn settle(program: &Program, list: &[Step], range: impl Fn(StepId) -> [f32; 2], settled: &mut Vec<Settled>) {
    settled.clear();
    settled.extend(list.iter().map(|step| match *step {
        Step::Combine { table, a, b, constants } => {
            let ([a, above_a], [b, above_b]) = (range(a), range(b));
            if a <= above_a && b <= above_b {
                let interval = |lo: f32, hi: f32| Interval::new(lo.into(), hi.into());
                (table.settle)(interval(a, above_a), interval(b, above_b), &program.double[constants.range()])
            } else {
                Settled::Open
            }
        }
        _ => Settled::Open,
    }));
}

/// Finds what the result still depends on, and settles minima of which an operand is too large to matter in the end. Returns
/// how many steps don't matter.
///
/// A chain of minima is settled from its end: an operand above the largest value that the whole chain can have is not
/// needed, even if it is not above the operands before it.
fn mark(
    list: &[Step],
    result: StepId,
    range: impl Fn(StepId) -> [f32; 2],
    settled: &mut [Settled],
    ceiling: &mut Vec<f32>,
) -> usize {
    ceiling.clear();
    ceiling.resize(list.len(), f32::NAN);
    ceiling[StepId::POINT.index()] = f32::INFINITY;
    ceiling[result.index()] = f32::INFINITY;
    let mut needed = 0;
    for index in (0..list.len()).rev() {
        let own = ceiling[index];
        if own.is_nan() {
            continue;
        }
        needed += 1;
        match list[index] {
            Step::Combine { table, a, b, .. } => {
                let below = if table.is_minimum { own.min(range(StepId(index as u32))[1]) } else { f32::INFINITY };
                if table.is_minimum && settled[index] == Settled::Open {
                    settled[index] = match (range(a)[0] > below, range(b)[0] > below) {
                        (false, true) => Settled::First,
                        (true, false) => Settled::Second,
                        _ => Settled::Open,
                    };
                }
                // Only an unchanged operand of a minimum inherits its ceiling.
                let (reads_a, reads_b) = match settled[index] {
                    Settled::Open => (true, true),
                    Settled::First => (true, false),
                    Settled::Second | Settled::NotSecond => (false, true),
                };
                needed -= usize::from(matches!(settled[index], Settled::First | Settled::Second));
                for (reads, id) in [(reads_a, a), (reads_b, b)] {
                    if reads {
                        raise(&mut ceiling[id.index()], below);
                    }
                }
            }
            step => step.operands(|id| raise(&mut ceiling[id.index()], f32::INFINITY)),
        }
    }
    list.len() - needed
}

/// The ceiling of a step is the largest one of those that read it.
fn raise(ceiling: &mut f32, to: f32) {
    if ceiling.is_nan() || *ceiling < to {
        *ceiling = to;
    }
}

/// The list of the steps that are needed.
fn rebuild(list: &[Step], result: StepId, settled: &[Settled], ceiling: &[f32], renamed: &mut Vec<StepId>) -> Steps {
    let Kind::Modify(complement) = &shapes::COMPLEMENT.kind else { unreachable!("complement modifies") };
    let complement: &'static ModifyTable = complement;
    renamed.clear();
    renamed.resize(list.len(), StepId::POINT);
    let mut kept = Vec::new();
    for (index, step) in list.iter().enumerate() {
        if ceiling[index].is_nan() {
            continue;
        }
        let new = |id: StepId| renamed[id.index()];
        let own = match (*step, settled[index]) {
            (Step::Combine { a, .. }, Settled::First) => Err(new(a)),
            (Step::Combine { b, .. }, Settled::Second) => Err(new(b)),
            (Step::Combine { b, .. }, Settled::NotSecond) => {
                Ok(Step::Modify { table: complement, from: new(b), constants: Run::default() })
            }
            (step, _) => Ok(step.with_operands(new)),
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
