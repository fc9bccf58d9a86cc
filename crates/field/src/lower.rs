//! From steps to operations on registers.
//!
//! Two banks of registers, one for points and one for values; a register is used again as soon as nothing reads it any
//! more. A primitive that only enters a minimum is folded into it in one kernel.

use crate::formula::{Binary, Unary};
use crate::operation::{Run, Step, StepId, Steps};
use crate::shape::{CombineTable, MapTable, ModifyTable, PrimitiveTable};

/// Operations in order, and the registers they work on.
#[derive(Clone, Debug)]
pub(crate) struct Listing {
    pub(crate) ops: Vec<Op>,
    /// How many registers of each kind there are.
    pub(crate) points: usize,
    pub(crate) values: usize,
    /// The register of the result; `None` if there is none.
    pub(crate) result: Option<usize>,
    /// The register of each step, as long as it holds that step's result.
    pub(crate) place: Vec<u32>,
}

/// One operation. Registers are numbered from 0; point register 0 holds the point itself. No operation writes to a register
/// it reads.
#[derive(Clone, Debug)]
pub(crate) enum Op {
    /// `points[to] = M points[from] + t`.
    Affine { from: usize, to: usize, constants: Run },
    /// `points[to] = map(points[from] - at)`.
    Map { table: &'static MapTable, from: usize, at: Run, constants: Run, to: usize },
    /// `values[out] = primitive(points[point] - at)`, or the minimum of `values[before]` and that.
    Primitive {
        table: &'static PrimitiveTable,
        point: usize,
        at: Run,
        constants: Run,
        slope: u32,
        before: Option<usize>,
        out: usize,
    },
    /// `values[out] = combine(values[a], values[b])`.
    Combine { table: &'static CombineTable, a: usize, b: usize, out: usize, constants: Run },
    /// `values[out]` mixes `values[a]` and `values[b]` by a share that follows from `values[height]`.
    Mix { a: usize, b: usize, height: usize, out: usize, constants: Run },
    /// `values[out] = modify(values[from])`.
    Modify { table: &'static ModifyTable, from: usize, out: usize, constants: Run },
    /// `values[out] = factor * values[from]`.
    Scale { from: usize, out: usize, factor: usize },
    /// `values[out] = points[point][axis] - at`.
    Coordinate { point: usize, axis: usize, at: usize, out: usize },
    /// `values[out] = op(values[from])`.
    Unary { op: Unary, from: usize, out: usize },
    /// `values[out] = op(a, b)`.
    Binary { op: Binary, a: Operand, b: Operand, out: usize },
    /// `values[out] = values[from]^exponent`.
    Power { from: usize, exponent: i32, out: usize },
    /// `values[out]` is a constant everywhere.
    Fill { constant: usize, out: usize },
    /// `points[to]` has the coordinates `values[from]`.
    Warp { from: [usize; 3], to: usize },
    /// `values[out] = values[from]`.
    Copy { from: usize, out: usize },
}

/// What an operation on numbers reads.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Operand {
    /// A register of values.
    Register(usize),
    /// An entry of the table of constants.
    Constant(usize),
}

impl Listing {
    /// The operations for the result of some steps.
    pub(crate) fn of(steps: &Steps) -> Self {
        let steps = &without_surfaces(steps);
        Self::with_fates(steps, &Fate::of_all(steps, true))
    }

    /// The operations for two results. Returns the register of the second one besides.
    pub(crate) fn of_two(steps: &Steps, second: StepId) -> (Self, usize) {
        let mut fates = Fate::of_all(steps, true);
        fates[second.index()] = Fate { last_use: u32::MAX, is_folded: false };
        let listing = Self::with_fates(steps, &fates);
        let register = listing.place[second.index()] as usize;
        (listing, register)
    }

    /// The operations for the result of some steps, one for each step but the first.
    pub(crate) fn one_by_one(steps: &Steps) -> Self {
        Self::with_fates(steps, &Fate::of_all(steps, false))
    }

    /// The operations for some steps, with a register of its own for each step.
    pub(crate) fn keeping_all(steps: &Steps) -> Self {
        Self::with_fates(steps, &vec![Fate { last_use: u32::MAX, is_folded: false }; steps.list.len()])
    }

    fn with_fates(steps: &Steps, fate: &[Fate]) -> Self {
        let mut registers = Registers::new(steps.list.len());
        let mut ops = Vec::new();
        for (index, step) in steps.list.iter().enumerate() {
            if fate[index].is_folded {
                continue;
            }
            registers.take(index, step.is_point());
            let place = |id: StepId| registers.place[id.index()] as usize;
            let out = registers.place[index] as usize;
            ops.extend(match *step {
                Step::Point => None,
                Step::Affine { from, constants } => Some(Op::Affine { from: place(from), to: out, constants }),
                Step::Map { table, from, at, constants } => {
                    Some(Op::Map { table, from: place(from), at, constants, to: out })
                }
                Step::Primitive { table, point, at, constants, slope, .. } => {
                    Some(Op::Primitive { table, point: place(point), at, constants, slope, before: None, out })
                }
                Step::Combine { a, b, .. } if fate[b.index()].is_folded => {
                    let Step::Primitive { table, point, at, constants, slope, .. } = steps.list[b.index()] else {
                        unreachable!("only primitives are folded")
                    };
                    let before = Some(place(a));
                    Some(Op::Primitive { table, point: place(point), at, constants, slope, before, out })
                }
                Step::Combine { table, a, b, constants, .. } => {
                    Some(Op::Combine { table, a: place(a), b: place(b), out, constants })
                }
                Step::Mix { a, b, height, constants } => {
                    Some(Op::Mix { a: place(a), b: place(b), height: place(height), out, constants })
                }
                Step::Modify { table, from, constants, .. } => {
                    Some(Op::Modify { table, from: place(from), out, constants })
                }
                Step::Scale { from, factor } => Some(Op::Scale { from: place(from), out, factor: factor as usize }),
                Step::Coordinate { point, axis, at } => {
                    let axis = usize::from(axis);
                    Some(Op::Coordinate { point: place(point), axis, at: at.start() + axis, out })
                }
                Step::Literal { constant } => Some(Op::Fill { constant: constant as usize, out }),
                Step::Unary { op, from } => Some(Op::Unary { op, from: place(from), out }),
                Step::Binary { op, a, b } => {
                    let operand = |id: StepId| match (fate[id.index()].is_folded, steps.list[id.index()]) {
                        (true, Step::Literal { constant }) => Operand::Constant(constant as usize),
                        _ => Operand::Register(place(id)),
                    };
                    Some(Op::Binary { op, a: operand(a), b: operand(b), out })
                }
                Step::Power { from, exponent } => Some(Op::Power { from: place(from), exponent, out }),
                Step::Surface { from, .. } => Some(Op::Copy { from: place(from), out }),
                Step::Altered { op, from, by } => {
                    let [a, b] = [from, by].map(|id| Operand::Register(place(id)));
                    Some(Op::Binary { op, a, b, out })
                }
                Step::Warp { x, y, z } => Some(Op::Warp { from: [x, y, z].map(place), to: out }),
            });
            let mut release = |id: StepId| {
                if fate[id.index()].last_use == index as u32 {
                    registers.release(id, steps.list[id.index()].is_point());
                }
            };
            step.operands(|id| match steps.list[id.index()] {
                Step::Primitive { point, .. } if fate[id.index()].is_folded => release(point),
                Step::Literal { .. } if fate[id.index()].is_folded => {}
                _ => release(id),
            });
        }
        let result = steps.result.map(|id| registers.place[id.index()] as usize);
        Self { ops, points: registers.points.count, values: registers.values.count, result, place: registers.place }
    }
}

/// The steps without those that only say whose a value is.
fn without_surfaces(steps: &Steps) -> Steps {
    let mut renamed = Vec::with_capacity(steps.list.len());
    let mut list = Vec::with_capacity(steps.list.len());
    for &step in &steps.list {
        renamed.push(match step {
            Step::Surface { from, .. } => renamed[from.index()],
            step => {
                list.push(step.with_operands(|id| renamed[id.index()]));
                StepId(list.len() as u32 - 1)
            }
        });
    }
    Steps { list, result: steps.result.map(|id| renamed[id.index()]) }
}

/// What becomes of a step.
#[derive(Clone, Copy, Default)]
struct Fate {
    /// The last step that reads it; its own place if none does.
    last_use: u32,
    /// Whether it is computed where it is read: a primitive in a minimum, or a constant operand.
    is_folded: bool,
}

impl Fate {
    /// Primitives are folded into minima if `fold` says so.
    fn of_all(steps: &Steps, fold: bool) -> Vec<Self> {
        let mut fates = vec![Self::default(); steps.list.len()];
        for (index, step) in steps.list.iter().enumerate() {
            let index = index as u32;
            fates[index as usize].last_use = index;
            step.operands(|id| fates[id.index()].last_use = index);
            if let Step::Combine { table, a, b, .. } = *step
                && fold
                && table.is_minimum
                && a != b
                && let Step::Primitive { point, .. } = steps.list[b.index()]
            {
                // A primitive is read by one step alone: trees share no nodes.
                fates[b.index()].is_folded = true;
                fates[point.index()].last_use = index;
            }
            if let (true, Step::Literal { .. }) = (fold, step) {
                // Until something other than a function of two numbers reads it.
                fates[index as usize].is_folded = true;
            }
            if !matches!(step, Step::Binary { .. }) {
                step.operands(|id| {
                    if let Step::Literal { .. } = steps.list[id.index()] {
                        fates[id.index()].is_folded = false;
                    }
                });
            }
        }
        if let Some(result) = steps.result {
            fates[result.index()].last_use = u32::MAX;
            fates[result.index()].is_folded = false;
        }
        fates
    }
}

/// Which registers are taken, by which steps.
struct Registers {
    place: Vec<u32>,
    points: Pool,
    values: Pool,
}

#[derive(Default)]
struct Pool {
    count: usize,
    free: Vec<u32>,
}

impl Registers {
    fn new(steps: usize) -> Self {
        Self { place: vec![0; steps], points: Pool::default(), values: Pool::default() }
    }

    fn pool(&mut self, is_point: bool) -> &mut Pool {
        if is_point { &mut self.points } else { &mut self.values }
    }

    fn take(&mut self, step: usize, is_point: bool) {
        let pool = self.pool(is_point);
        let register = pool.free.pop().unwrap_or_else(|| {
            pool.count += 1;
            pool.count as u32 - 1
        });
        self.place[step] = register;
    }

    /// Gives back the register of a step. The point itself stays: evaluation may run again from it.
    fn release(&mut self, step: StepId, is_point: bool) {
        if step != StepId::POINT {
            let register = self.place[step.index()];
            self.pool(is_point).free.push(register);
        }
    }
}
