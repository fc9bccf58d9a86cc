//! Long chains of minima: what a union of many objects is made of.
//!
//! Where a chain's operands are independent of each other, those that can't be the least in a box are found by one
//! comparison each, without a walk through the steps of all the others.

use crate::operation::{Step, StepId, Steps};
use std::ops::Range;

/// Shorter chains are not worth the trouble.
const SHORTEST: usize = 16;

/// A chain of minima that ends with the result: `min(min(min(a, b), c), d)`.
#[derive(Debug)]
pub(crate) struct Spine {
    entries: Vec<Entry>,
}

/// One operand of a chain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    /// The first step that it alone is computed from.
    first: u32,
    /// The step that yields it: the last of its own.
    operand: StepId,
    /// The minimum with those before it, if it has any before it.
    minimum: Option<StepId>,
}

impl Entry {
    /// The step that yields the operand.
    pub(crate) fn operand(self) -> StepId {
        self.operand
    }

    /// The steps that it alone is computed from.
    pub(crate) fn own(self) -> Range<usize> {
        self.first as usize..self.operand.index() + 1
    }
}

impl Spine {
    /// The chain that some steps end with, if it is long and its operands share no steps.
    pub(crate) fn of(steps: &Steps) -> Option<Self> {
        let mut minima = Vec::new();
        let mut last = steps.result?;
        while let Step::Combine { table, a, b, .. } = steps.list[last.index()]
            && table.is_minimum
            && a < b
        {
            minima.push((b, last));
            last = a;
        }
        if minima.len() < SHORTEST {
            return None;
        }
        let innermost = Entry { first: 1, operand: last, minimum: None };
        let mut entries = vec![innermost];
        for &(operand, minimum) in minima.iter().rev() {
            let first = entries.last().map_or(0, |before| before.minimum.unwrap_or(before.operand).0 + 1);
            // The steps in between must be those of the operand, with its minimum right after them.
            if operand.0 < first || minimum.0 != operand.0 + 1 {
                return None;
            }
            entries.push(Entry { first, operand, minimum: Some(minimum) });
        }
        let is_independent = |entry: &Entry| {
            let mut stays_inside = true;
            for step in &steps.list[entry.own()] {
                step.operands(|id| stays_inside &= id == StepId::POINT || id.0 >= entry.first);
            }
            stays_inside
        };
        entries.iter().all(is_independent).then_some(Self { entries })
    }

    /// The operands.
    pub(crate) fn entries(&self) -> &[Entry] {
        &self.entries
    }
}

/// A shorter list of steps, each with its place in the longer one that it comes from.
#[derive(Default)]
pub(crate) struct Excerpt {
    pub(crate) list: Vec<Step>,
    pub(crate) origin: Vec<StepId>,
}

impl Excerpt {
    /// Takes over the operands at these places in the chain, which are in order, and their minimum. Returns the step of the
    /// result, if there is an operand.
    pub(crate) fn take(&mut self, steps: &Steps, spine: &Spine, places: impl Iterator<Item = usize>) -> Option<StepId> {
        self.list.clear();
        self.origin.clear();
        self.push(Step::Point, StepId::POINT);
        let mut result = None;
        for place in places {
            let entry = spine.entries[place];
            let shift = entry.first - self.list.len() as u32;
            let moved = |id: StepId| if id == StepId::POINT { id } else { StepId(id.0 - shift) };
            for index in entry.own() {
                self.push(steps.list[index].with_operands(moved), StepId(index as u32));
            }
            let operand = moved(entry.operand);
            result = Some(match (result, entry.minimum) {
                (Some(before), Some(minimum)) => {
                    let Step::Combine { table, constants, .. } = steps.list[minimum.index()] else {
                        unreachable!("a chain is made of minima")
                    };
                    self.push(Step::Combine { table, a: before, b: operand, constants }, minimum)
                }
                _ => operand,
            });
        }
        result
    }

    fn push(&mut self, step: Step, origin: StepId) -> StepId {
        self.list.push(step);
        self.origin.push(origin);
        StepId(self.list.len() as u32 - 1)
    }
}
