//! Registers for batches of points, and the operations that run over them.

use crate::evaluator::Points;
use crate::kernel::{
    AffineJob, BATCH, Block, CombineJob, CombineKernels, ModifyJob, ModifyKernels, PrimitiveJob, PrimitiveKernels,
    WIDEST, affine_gradients, affine_values,
};
use crate::lower::{Listing, Op};
use crate::simd::Level;
use std::marker::PhantomData;

/// A number type that batches are computed in.
pub(crate) trait Number {
    /// How many blocks hold one number.
    const COMPONENTS: usize;

    fn primitive(kernels: &PrimitiveKernels) -> fn(Level, &mut PrimitiveJob<'_>);
    fn combine(kernels: &CombineKernels) -> fn(Level, &mut CombineJob<'_>);
    fn modify(kernels: &ModifyKernels) -> fn(Level, &mut ModifyJob<'_>);
    fn affine(level: Level, job: &mut AffineJob<'_>);
}

/// Values alone.
#[derive(Default)]
pub(crate) struct Values;

/// Values with their gradients.
#[derive(Default)]
pub(crate) struct Gradients;

macro_rules! number {
    ($Number:ident, $components:literal, $kernel:ident, $affine:ident) => {
        impl Number for $Number {
            const COMPONENTS: usize = $components;

            fn primitive(kernels: &PrimitiveKernels) -> fn(Level, &mut PrimitiveJob<'_>) {
                kernels.$kernel
            }
            fn combine(kernels: &CombineKernels) -> fn(Level, &mut CombineJob<'_>) {
                kernels.$kernel
            }
            fn modify(kernels: &ModifyKernels) -> fn(Level, &mut ModifyJob<'_>) {
                kernels.$kernel
            }
            fn affine(level: Level, job: &mut AffineJob<'_>) {
                $affine(level, job);
            }
        }
    };
}

number!(Values, 1, values, affine_values);
number!(Gradients, 4, gradients, affine_gradients);

/// The registers of operations over numbers of one type.
#[derive(Default)]
pub(crate) struct Bank<N> {
    points: Vec<Block>,
    values: Vec<Block>,
    number: PhantomData<N>,
}

impl<N: Number> Bank<N> {
    /// Makes sure that there are enough registers.
    pub(crate) fn prepare(&mut self, listing: &Listing) {
        let grow = |blocks: &mut Vec<Block>, count: usize| {
            if blocks.len() < count {
                blocks.resize(count, Block::default());
            }
        };
        grow(&mut self.points, listing.points * 3 * N::COMPONENTS);
        grow(&mut self.values, listing.values * N::COMPONENTS);
    }

    /// Fills point register 0 and returns how many points the kernels run over.
    pub(crate) fn load(&mut self, points: Points<'_>) -> usize {
        let given = points.x.len();
        let count = given.next_multiple_of(WIDEST);
        for (axis, from) in [points.x, points.y, points.z].into_iter().enumerate() {
            let number = &mut self.points[axis * N::COMPONENTS..(axis + 1) * N::COMPONENTS];
            number[0].0[..given].copy_from_slice(from);
            number[0].0[given..count].fill(0.0);
            for (by, derivative) in number[1..].iter_mut().enumerate() {
                derivative.0[..count].fill(if by == axis { 1.0 } else { 0.0 });
            }
        }
        count
    }

    /// The number in a register of values.
    pub(crate) fn value(&self, register: usize) -> &[Block] {
        &self.values[register * N::COMPONENTS..(register + 1) * N::COMPONENTS]
    }

    /// Runs the operations over the first `count` points in point register 0.
    pub(crate) fn run(&mut self, constants: &[f32], ops: &[Op], level: Level, count: usize) {
        debug_assert!(count <= BATCH, "a batch holds no more");
        for op in ops {
            match *op {
                Op::Affine { from, to, constants: run } => {
                    let size = 3 * N::COMPONENTS;
                    let [from, to] = self
                        .points
                        .get_disjoint_mut([from * size..(from + 1) * size, to * size..(to + 1) * size])
                        .expect(NOT_IN_PLACE);
                    N::affine(level, &mut AffineJob { from, constants: &constants[run.range()], to, count });
                }
                Op::Primitive { table, point, at, constants: run, before, out } => {
                    let size = 3 * N::COMPONENTS;
                    let points = &self.points[point * size..(point + 1) * size];
                    let (values, out) = apart::<N>(&mut self.values, out);
                    let job = &mut PrimitiveJob {
                        points,
                        at: &constants[at.range()],
                        constants: &constants[run.range()],
                        before: before.map(|before| values.at(before)),
                        out,
                        count,
                    };
                    N::primitive(&table.kernels)(level, job);
                }
                Op::Combine { table, a, b, out, constants: run } => {
                    let (values, out) = apart::<N>(&mut self.values, out);
                    let (a, b) = (values.at(a), values.at(b));
                    let job = &mut CombineJob { a, b, constants: &constants[run.range()], out, count };
                    N::combine(&table.kernels)(level, job);
                }
                Op::Modify { table, from, out, constants: run } => {
                    let (values, out) = apart::<N>(&mut self.values, out);
                    let job = &mut ModifyJob { from: values.at(from), constants: &constants[run.range()], out, count };
                    N::modify(&table.kernels)(level, job);
                }
                Op::Scale { from, out, factor } => {
                    let factor = constants[factor];
                    let (values, out) = apart::<N>(&mut self.values, out);
                    for (from, out) in values.at(from).iter().zip(out) {
                        for (from, out) in from.0[..count].iter().zip(&mut out.0) {
                            *out = from * factor;
                        }
                    }
                }
            }
        }
    }
}

/// All registers but the one that is written to.
struct Others<'b, N> {
    below: &'b [Block],
    above: &'b [Block],
    written: usize,
    number: PhantomData<N>,
}

/// Register `out`, and all others.
fn apart<N: Number>(values: &mut [Block], out: usize) -> (Others<'_, N>, &mut [Block]) {
    let (below, rest) = values.split_at_mut(out * N::COMPONENTS);
    let (written, above) = rest.split_at_mut(N::COMPONENTS);
    (Others { below, above, written: out, number: PhantomData }, written)
}

impl<'b, N: Number> Others<'b, N> {
    fn at(&self, register: usize) -> &'b [Block] {
        assert_ne!(register, self.written, "{NOT_IN_PLACE}");
        let (bank, register) =
            if register < self.written { (self.below, register) } else { (self.above, register - self.written - 1) };
        &bank[register * N::COMPONENTS..(register + 1) * N::COMPONENTS]
    }
}

/// Why registers can be borrowed apart.
const NOT_IN_PLACE: &str = "no operation writes to a register it reads";
