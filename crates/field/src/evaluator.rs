//! Evaluation of programs over many points.
//!
//! Points are taken in batches of [`BATCH`]; for each batch the operations of the program run one after another, each as
//! one kernel call over the whole batch. An evaluator is the scratch memory of one thread.

use crate::kernel::{
    AffineJob, BATCH, Block, CombineJob, ModifyJob, PrimitiveJob, WIDEST, affine_gradients, affine_values,
};
use crate::operation::{Op, Registers};
use crate::program::Program;
use crate::simd::{self, Level};
use std::ops::Range;

/// Many points, coordinate by coordinate, relative to the program's origin.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the coordinates speak for themselves")]
pub struct Points<'a> {
    pub x: &'a [f32],
    pub y: &'a [f32],
    pub z: &'a [f32],
}

impl<'a> Points<'a> {
    /// How many there are.
    ///
    /// # Panics
    /// If the coordinates differ in number.
    pub fn count(&self) -> usize {
        assert!(self.x.len() == self.y.len() && self.x.len() == self.z.len(), "coordinates differ in number");
        self.x.len()
    }

    fn slice(&self, range: Range<usize>) -> Points<'a> {
        Points { x: &self.x[range.clone()], y: &self.y[range.clone()], z: &self.z[range] }
    }
}

/// The shares of all regions at some points.
#[derive(Clone, Debug, Default)]
pub struct Shares {
    shares: Vec<f32>,
    count: usize,
}

impl Shares {
    /// The share of a region at each point, between 0 and 1; all regions together make 1.
    pub fn of(&self, region: usize) -> &[f32] {
        &self.shares[region * self.count..(region + 1) * self.count]
    }
}

/// Runs a program over points.
pub struct Evaluator<'p> {
    program: &'p Program,
    level: Level,
    values: Bank<1>,
    gradients: Bank<4>,
    kept: Bank<1>,
    weights: Vec<Block>,
}

/// The registers of a program over numbers of `C` components.
#[derive(Default)]
struct Bank<const C: usize> {
    points: Vec<Block>,
    values: Vec<Block>,
}

impl<'p> Evaluator<'p> {
    /// An evaluator on the best instruction set of this machine.
    pub fn new(program: &'p Program) -> Self {
        Self::with_level(program, simd::best())
    }

    /// An evaluator on a given instruction set. The results are the same bits on all of them.
    pub fn with_level(program: &'p Program, level: Level) -> Self {
        Self {
            program,
            level,
            values: Bank::default(),
            gradients: Bank::default(),
            kept: Bank::default(),
            weights: Vec::new(),
        }
    }

    /// The field at each point.
    ///
    /// # Panics
    /// If `out` has not as many places as there are points.
    pub fn values(&mut self, points: Points<'_>, out: &mut [f32]) {
        assert_eq!(points.count(), out.len(), "one place for each point");
        let code = &self.program.code;
        self.values.resize(code.registers);
        for batch in batches(out.len()) {
            let count = self.values.load(points.slice(batch.clone()));
            run(self.program, &code.ops, self.level, &mut self.values, count);
            let out = &mut out[batch];
            out.copy_from_slice(&self.values.values[code.registers.result].0[..out.len()]);
        }
    }

    /// The field and its gradient at each point.
    ///
    /// # Panics
    /// If a result has not as many places as there are points.
    pub fn gradients(&mut self, points: Points<'_>, values: &mut [f32], gradient: [&mut [f32]; 3]) {
        assert_eq!(points.count(), values.len(), "one place for each point");
        let code = &self.program.code;
        let result = 4 * code.registers.result;
        self.gradients.resize(code.registers);
        let [gx, gy, gz] = gradient;
        for batch in batches(values.len()) {
            let count = self.gradients.load(points.slice(batch.clone()));
            run(self.program, &code.ops, self.level, &mut self.gradients, count);
            let from = &self.gradients.values[result..result + 4];
            for (out, from) in [&mut *values, &mut *gx, &mut *gy, &mut *gz].into_iter().zip(from) {
                let out = &mut out[batch.clone()];
                out.copy_from_slice(&from.0[..out.len()]);
            }
        }
    }

    /// The share of each region of [`crate::Structure::regions`] in the surface nearest to each point.
    ///
    /// A share is the product of the partial derivatives of all combinations on the way from the region to the result,
    /// computed from the result downwards over the intermediate values of one evaluation.
    pub fn shares(&mut self, points: Points<'_>, out: &mut Shares) {
        let code = &self.program.code;
        out.count = points.count();
        out.shares.clear();
        out.shares.resize(out.count * code.regions.len(), 0.0);
        self.kept.resize(code.share_registers);
        self.weights.resize(code.share_registers.values, Block::default());
        let mut share = Block::default();
        for batch in batches(out.count) {
            let count = self.kept.load(points.slice(batch.clone()));
            run(self.program, &code.share_ops, self.level, &mut self.kept, count);
            self.weights[code.share_registers.result].0.fill(1.0);
            for op in code.share_ops.iter().rev() {
                match op {
                    Op::Combine { table, a, b, out, constants } => {
                        (table.kernels.shares)(
                            self.level,
                            &mut CombineJob {
                                a: &self.kept.values[*a..=*a],
                                b: &self.kept.values[*b..=*b],
                                constants: &self.program.single[constants.clone()],
                                out: std::slice::from_mut(&mut share),
                                count,
                            },
                        );
                        for lane in 0..count {
                            let weight = self.weights[*out].0[lane];
                            self.weights[*a].0[lane] = weight * (1.0 - share.0[lane]);
                            self.weights[*b].0[lane] = weight * share.0[lane];
                        }
                    }
                    Op::Primitive { out: value, region, .. } => {
                        let start = region * out.count;
                        let to = &mut out.shares[start + batch.start..start + batch.end];
                        for (to, weight) in to.iter_mut().zip(&self.weights[*value].0) {
                            *to += weight;
                        }
                    }
                    Op::Modify { from, out, .. } | Op::Scale { from, out, .. } => {
                        let weight = self.weights[*out].clone();
                        self.weights[*from] = weight;
                    }
                    Op::Affine { .. } => {}
                }
            }
        }
    }
}

impl<const C: usize> Bank<C> {
    fn resize(&mut self, registers: Registers) {
        self.points.resize(registers.points * 3 * C, Block::default());
        // A program without operations leaves this: nothing is near.
        self.values.resize(registers.values * C, Block([f32::INFINITY; BATCH]));
    }

    /// Fills point register 0 and returns how many points the kernels run over.
    fn load(&mut self, points: Points<'_>) -> usize {
        let given = points.x.len();
        let count = given.next_multiple_of(WIDEST);
        for (axis, from) in [points.x, points.y, points.z].into_iter().enumerate() {
            let number = &mut self.points[axis * C..(axis + 1) * C];
            number[0].0[..given].copy_from_slice(from);
            number[0].0[given..count].fill(0.0);
            for (by, derivative) in number[1..].iter_mut().enumerate() {
                derivative.0[..count].fill(if by == axis { 1.0 } else { 0.0 });
            }
        }
        count
    }
}

/// Consecutive ranges of at most a batch.
fn batches(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count).step_by(BATCH).map(move |start| start..(start + BATCH).min(count))
}

/// Runs the operations over the `count` points in point register 0.
fn run<const C: usize>(program: &Program, ops: &[Op], level: Level, bank: &mut Bank<C>, count: usize) {
    let constants_of = |range: &Range<usize>| &program.single[range.clone()];
    for op in ops {
        match op {
            Op::Affine { from, to, constants } => {
                let size = 3 * C;
                let [from, to] = bank
                    .points
                    .get_disjoint_mut([from * size..(from + 1) * size, to * size..(to + 1) * size])
                    .expect(NOT_IN_PLACE);
                let mut job = AffineJob { from, constants: constants_of(constants), to, count };
                if C == 1 {
                    affine_values(level, &mut job);
                } else {
                    affine_gradients(level, &mut job);
                }
            }
            Op::Primitive { table, point, at, constants, before, out, .. } => {
                let kernel = if C == 1 { table.kernels.values } else { table.kernels.gradients };
                let points = &bank.points[point * 3 * C..(point + 1) * 3 * C];
                let (before, out) = match before {
                    None => (None, number::<C>(&mut bank.values, *out)),
                    Some(before) => {
                        let [before, out] = numbers::<C, 2>(&mut bank.values, [*before, *out]);
                        (Some(&*before), out)
                    }
                };
                let (at, constants) = (constants_of(at), constants_of(constants));
                kernel(level, &mut PrimitiveJob { points, at, constants, before, out, count });
            }
            Op::Combine { table, a, b, out, constants } => {
                let kernel = if C == 1 { table.kernels.values } else { table.kernels.gradients };
                let [a, b, out] = numbers::<C, 3>(&mut bank.values, [*a, *b, *out]);
                kernel(level, &mut CombineJob { a, b, constants: constants_of(constants), out, count });
            }
            Op::Modify { table, from, out, constants } => {
                let kernel = if C == 1 { table.kernels.values } else { table.kernels.gradients };
                let [from, out] = numbers::<C, 2>(&mut bank.values, [*from, *out]);
                kernel(level, &mut ModifyJob { from, constants: constants_of(constants), out, count });
            }
            Op::Scale { from, out, factor } => {
                let factor = program.single[*factor];
                let [from, out] = numbers::<C, 2>(&mut bank.values, [*from, *out]);
                for (from, out) in from.iter().zip(out) {
                    for (from, out) in from.0[..count].iter().zip(&mut out.0) {
                        *out = from * factor;
                    }
                }
            }
        }
    }
}

/// Register `index` of numbers with `C` components.
fn number<const C: usize>(values: &mut [Block], index: usize) -> &mut [Block] {
    &mut values[index * C..(index + 1) * C]
}

/// Several registers of numbers with `C` components.
fn numbers<const C: usize, const N: usize>(values: &mut [Block], indices: [usize; N]) -> [&mut [Block]; N] {
    values.get_disjoint_mut(indices.map(|index| index * C..(index + 1) * C)).expect(NOT_IN_PLACE)
}

/// Why registers can be borrowed apart.
const NOT_IN_PLACE: &str = "no operation writes to a register it reads";
