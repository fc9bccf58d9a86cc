//! Registers for batches of points, and the operations that run over them.

use crate::contract::Dimension;
use crate::evaluator::Points;
use crate::formula::Binary;
use crate::formula_kernel::{self, BinaryJob, FormulaKernels, Source, UnaryJob};
use crate::kernel::{
    AffineJob, BATCH, Block, CombineJob, CombineKernels, MapJob, MapKernels, ModifyJob, ModifyKernels, PrimitiveJob,
    WIDEST,
};
use crate::lower::{Listing, Op, Operand};
use crate::mix::{self, MixJob};
use crate::program::Program;
use crate::shape::{Kind, PrimitiveTable};
use crate::simd::{self, Level};
use std::marker::PhantomData;

/// A number type that batches are computed in.
pub(crate) trait Number: Sized {
    /// How many blocks hold one number.
    const COMPONENTS: usize;

    /// What belongs to each point register besides the coordinates.
    type Reach: Default + Clone;

    fn primitive(level: Level, call: PrimitiveCall<'_, Self>);
    fn combine(kernels: &CombineKernels) -> fn(Level, &mut CombineJob<'_>);
    fn mix(level: Level, job: &mut MixJob<'_>);
    fn modify(kernels: &ModifyKernels) -> fn(Level, &mut ModifyJob<'_>);
    fn affine(level: Level, job: &mut AffineJob<'_>);
    fn map(kernels: &MapKernels) -> fn(Level, &mut MapJob<'_>);

    /// The operations of formulas.
    const FORMULA: FormulaKernels;

    /// The reach after an affine map of this norm.
    fn stretched(_from: &Self::Reach, _norm: f32) -> Self::Reach {
        Self::Reach::default()
    }

    /// The reach of points whose coordinates are these numbers.
    fn reach_of(_point: &[Block], _count: usize) -> Self::Reach {
        Self::Reach::default()
    }
}

/// A primitive's work on one batch, for any number type.
pub(crate) struct PrimitiveCall<'a, N: Number> {
    /// The kernel for values alone.
    pub(crate) table: &'static PrimitiveTable,
    pub(crate) job: PrimitiveJob<'a>,
    /// The largest slope; infinite if it is not known.
    pub(crate) slope: f32,
    pub(crate) reach: &'a N::Reach,
    /// [`SCRATCH`] blocks with whatever is in them.
    pub(crate) scratch: &'a mut [Block],
}

/// Blocks that a primitive may need besides.
const SCRATCH: usize = 6;

/// The registers of operations over numbers of one type.
#[derive(Default)]
pub(crate) struct Bank<N: Number> {
    pub(crate) points: Vec<Block>,
    pub(crate) reach: Vec<N::Reach>,
    values: Vec<Block>,
    scratch: Vec<Block>,
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
        grow(&mut self.scratch, SCRATCH);
        self.reach.resize(listing.points.max(self.reach.len()), N::Reach::default());
    }

    /// The number in a register of values.
    pub(crate) fn value(&self, register: usize) -> &[Block] {
        &self.values[register * N::COMPONENTS..(register + 1) * N::COMPONENTS]
    }

    /// Runs the operations over the first `count` points in point register 0.
    pub(crate) fn run(&mut self, program: &Program, ops: &[Op], level: Level, count: usize) {
        for op in ops {
            self.step(program, op, level, count);
        }
    }

    /// Runs one operation over the first `count` points.
    ///
    /// Called from two places it would not be inlined any more, at which formulas of many cheap operations lose a twelfth of
    /// their speed.
    #[inline(always)]
    pub(crate) fn step(&mut self, program: &Program, op: &Op, level: Level, count: usize) {
        let constants = &program.single[..];
        match *op {
            Op::Affine { from, to, constants: run } => {
                let size = 3 * N::COMPONENTS;
                let constants = &constants[run.range()];
                self.reach[to] = N::stretched(&self.reach[from], constants[constants.len() - 1]);
                let [from, to] = self
                    .points
                    .get_disjoint_mut([from * size..(from + 1) * size, to * size..(to + 1) * size])
                    .expect(NOT_IN_PLACE);
                N::affine(level, &mut AffineJob { from, constants, to, count });
            }
            Op::Map { table, from, at, constants: run, to } => {
                let size = 3 * N::COMPONENTS;
                let (at, constants) = (&constants[at.range()], &constants[run.range()]);
                let [from, point] = self
                    .points
                    .get_disjoint_mut([from * size..(from + 1) * size, to * size..(to + 1) * size])
                    .expect(NOT_IN_PLACE);
                N::map(&table.kernels)(level, &mut MapJob { from, at, constants, to: point, count });
                self.reach[to] = N::reach_of(point, count);
            }
            Op::Primitive { table, point, at, constants: run, slope, before, out } => {
                let size = 3 * N::COMPONENTS;
                let points = &self.points[point * size..(point + 1) * size];
                let (values, out) = apart::<N>(&mut self.values, out);
                let before = before.map(|before| values.at(before));
                let (at, slope) = (&constants[at.range()], constants[slope as usize]);
                let job = PrimitiveJob { points, at, constants: &constants[run.range()], before, out, count };
                let (reach, scratch) = (&self.reach[point], &mut self.scratch[..]);
                N::primitive(level, PrimitiveCall { table, job, slope, reach, scratch });
            }
            Op::Combine { table, a, b, out, constants: run } => {
                let (values, out) = apart::<N>(&mut self.values, out);
                let (a, b) = (values.at(a), values.at(b));
                let constants = &constants[run.range()];
                N::combine(&table.kernels)(level, &mut CombineJob { a, b, constants, out, count });
            }
            Op::Mix { a, b, height, out, constants: run } => {
                let (values, out) = apart::<N>(&mut self.values, out);
                let [a, b, height] = [a, b, height].map(|register| values.at(register));
                N::mix(level, &mut MixJob { a, b, height, constants: &constants[run.range()], out, count });
            }
            Op::Modify { table, from, out, constants: run } => {
                let (values, out) = apart::<N>(&mut self.values, out);
                let (from, constants) = (values.at(from), &constants[run.range()]);
                N::modify(&table.kernels)(level, &mut ModifyJob { from, constants, out, count });
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
            Op::Coordinate { point, axis, at, out } => {
                let start = (3 * point + axis) * N::COMPONENTS;
                let from = &self.points[start..start + N::COMPONENTS];
                let (_, out) = apart::<N>(&mut self.values, out);
                (N::FORMULA.moved)(level, constants[at], &mut UnaryJob { from, out, count });
            }
            Op::Unary { op, from, out } => {
                let (values, out) = apart::<N>(&mut self.values, out);
                (N::FORMULA.unary)(level, op, &mut UnaryJob { from: values.at(from), out, count });
            }
            Op::Binary { op, a, b, out } => {
                let (values, out) = apart::<N>(&mut self.values, out);
                let source = |operand| match operand {
                    Operand::Register(register) => Source::Register(values.at(register)),
                    Operand::Constant(constant) => Source::Constant(program.double[constant]),
                };
                (N::FORMULA.binary)(level, op, &mut BinaryJob { a: source(a), b: source(b), out, count });
            }
            Op::Power { from, exponent, out } => {
                let (values, out) = apart::<N>(&mut self.values, out);
                (N::FORMULA.power)(level, exponent, &mut UnaryJob { from: values.at(from), out, count });
            }
            Op::Fill { constant, out } => {
                let (_, out) = apart::<N>(&mut self.values, out);
                let (number, zero) = (Source::Constant(program.double[constant]), Source::Constant(0.0));
                (N::FORMULA.binary)(level, Binary::Add, &mut BinaryJob { a: number, b: zero, out, count });
            }
            Op::Warp { from, to } => {
                let size = 3 * N::COMPONENTS;
                let point = &mut self.points[to * size..(to + 1) * size];
                for (from, to) in from.into_iter().zip(point.chunks_mut(N::COMPONENTS)) {
                    let from = &self.values[from * N::COMPONENTS..(from + 1) * N::COMPONENTS];
                    for (from, to) in from.iter().zip(to) {
                        to.0[..count].copy_from_slice(&from.0[..count]);
                    }
                }
                self.reach[to] = N::reach_of(point, count);
            }
            Op::Copy { from, out } => {
                let (values, out) = apart::<N>(&mut self.values, out);
                for (from, out) in values.at(from).iter().zip(out) {
                    out.0[..count].copy_from_slice(&from.0[..count]);
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

/// Values alone.
#[derive(Default)]
pub(crate) struct Values;

/// Values with their gradients.
#[derive(Default)]
pub(crate) struct Gradients;

macro_rules! at_points {
    ($Number:ident, $components:literal, $kernel:ident, $affine:ident, $mix:ident, $FORMULA:ident) => {
        impl Number for $Number {
            const COMPONENTS: usize = $components;
            const FORMULA: FormulaKernels = formula_kernel::$FORMULA;
            type Reach = ();

            fn primitive(level: Level, mut call: PrimitiveCall<'_, Self>) {
                (call.table.kernels.$kernel)(level, &mut call.job);
            }
            fn combine(kernels: &CombineKernels) -> fn(Level, &mut CombineJob<'_>) {
                kernels.$kernel
            }
            fn mix(level: Level, job: &mut MixJob<'_>) {
                mix::$mix(level, job);
            }
            fn modify(kernels: &ModifyKernels) -> fn(Level, &mut ModifyJob<'_>) {
                kernels.$kernel
            }
            fn affine(level: Level, job: &mut AffineJob<'_>) {
                crate::kernel::$affine(level, job);
            }
            fn map(kernels: &MapKernels) -> fn(Level, &mut MapJob<'_>) {
                kernels.$kernel
            }
        }

        impl Bank<$Number> {
            /// Fills point register 0 and returns how many points the kernels run over.
            pub(crate) fn load(&mut self, points: Points<'_>) -> usize {
                let given = points.x.len();
                let count = given.next_multiple_of(WIDEST);
                for (axis, from) in [points.x, points.y, points.z].into_iter().enumerate() {
                    let number = &mut self.points[axis * $components..(axis + 1) * $components];
                    number[0].0[..given].copy_from_slice(from);
                    number[0].0[given..count].fill(0.0);
                    for (by, derivative) in number[1..].iter_mut().enumerate() {
                        derivative.0[..count].fill(if by == axis { 1.0 } else { 0.0 });
                    }
                }
                count
            }
        }
    };
}

at_points!(Values, 1, values, affine_values, mix_values, VALUES);
at_points!(Gradients, 4, gradients, affine_gradients, mix_gradients, GRADIENTS);

/// Enclosures of values over boxes: lower and upper ends.
#[derive(Default)]
pub(crate) struct Ranges;

/// How far the points of a register lie around the middle of their box.
#[derive(Clone)]
pub(crate) struct Reach(pub(crate) Block);

impl Default for Reach {
    fn default() -> Self {
        Self(Block([f32::INFINITY; BATCH]))
    }
}

impl Reach {
    fn stretched(&self, norm: f32) -> Self {
        let mut to = self.clone();
        to.0.0.iter_mut().for_each(|radius| *radius *= norm * WIDER);
        to
    }

    /// The reach of points in boxes.
    fn of_boxes(point: &[Block], count: usize) -> Self {
        let mut reach = Self::default();
        for (lane, radius) in reach.0.0[..count].iter_mut().enumerate() {
            let half = |axis: usize| 0.5 * (point[2 * axis + 1].0[lane] - point[2 * axis].0[lane]);
            let [x, y, z] = [half(0), half(1), half(2)];
            *radius = (x * x + y * y + z * z).sqrt() * WIDER;
        }
        reach
    }
}

/// Makes up for a few rounding errors upward.
const WIDER: f32 = 1.0 + 8.0 * f32::EPSILON;

/// The rounding errors of a distance formula in single precision, relative to the coordinates and the value.
const ROUNDING: f32 = 16.0 * f32::EPSILON;

impl Number for Ranges {
    const COMPONENTS: usize = 2;
    const FORMULA: FormulaKernels = formula_kernel::RANGES;
    type Reach = Reach;

    fn primitive(level: Level, call: PrimitiveCall<'_, Self>) {
        primitive_over_boxes(level, call);
    }
    fn combine(kernels: &CombineKernels) -> fn(Level, &mut CombineJob<'_>) {
        kernels.ranges
    }
    fn mix(level: Level, job: &mut MixJob<'_>) {
        mix::mix_ranges(level, job);
    }
    fn modify(kernels: &ModifyKernels) -> fn(Level, &mut ModifyJob<'_>) {
        kernels.ranges
    }
    fn affine(level: Level, job: &mut AffineJob<'_>) {
        crate::kernel::affine_ranges(level, job);
    }
    fn map(kernels: &MapKernels) -> fn(Level, &mut MapJob<'_>) {
        kernels.ranges
    }
    fn stretched(from: &Reach, norm: f32) -> Reach {
        from.stretched(norm)
    }
    fn reach_of(point: &[Block], count: usize) -> Reach {
        Reach::of_boxes(point, count)
    }
}

/// Taylor models along one parameter.
#[derive(Default)]
pub(crate) struct Models;

impl Number for Models {
    const COMPONENTS: usize = 6;
    const FORMULA: FormulaKernels = formula_kernel::MODELS;
    type Reach = Reach;

    fn primitive(level: Level, call: PrimitiveCall<'_, Self>) {
        primitive_model(level, call);
    }
    fn combine(kernels: &CombineKernels) -> fn(Level, &mut CombineJob<'_>) {
        kernels.models
    }
    fn mix(level: Level, job: &mut MixJob<'_>) {
        mix::mix_models(level, job);
    }
    fn modify(kernels: &ModifyKernels) -> fn(Level, &mut ModifyJob<'_>) {
        kernels.models
    }
    fn affine(level: Level, job: &mut AffineJob<'_>) {
        crate::kernel::affine_models(level, job);
    }
    fn map(kernels: &MapKernels) -> fn(Level, &mut MapJob<'_>) {
        kernels.models
    }
    fn stretched(from: &Reach, norm: f32) -> Reach {
        from.stretched(norm)
    }
}

/// How many coordinates a primitive looks at: a figure does not look at the last one, which may be much less certain.
fn axes(table: &PrimitiveTable) -> usize {
    match table.dimension {
        Dimension::Plane => 2,
        Dimension::Space => 3,
    }
}

/// A primitive along a line: its value in the middle, and as much to either side as its largest slope allows.
fn primitive_model(level: Level, call: PrimitiveCall<'_, Models>) {
    let PrimitiveCall { table, mut job, slope, reach, .. } = call;
    if let Some(kernel) = table.models {
        return kernel(level, &mut job);
    }
    let PrimitiveJob { points, at, constants, before, out, count } = job;
    let middle = [0, 1, 2].map(|axis| points[axis * Models::COMPONENTS].clone());
    let mut own: [Block; Models::COMPONENTS] = Default::default();
    let mut job =
        PrimitiveJob { points: &middle, at, constants, before: None, out: std::slice::from_mut(&mut own[0]), count };
    (table.kernels.values)(level, &mut job);
    let axes = axes(table);
    let size = |lane: usize| -> f32 { (0..axes).map(|axis| middle[axis].0[lane].abs() + at[axis].abs()).sum() };
    for lane in 0..count {
        let value = own[0].0[lane];
        let mut radius = 0.0;
        for point in points.chunks_exact(Models::COMPONENTS).take(axes) {
            let reach: f32 = point[1..].iter().map(|term| term.0[lane].abs()).sum();
            radius += reach * reach;
        }
        let radius = (radius.sqrt() * WIDER).min(reach.0.0[lane]);
        let rounding = ROUNDING * (size(lane) + value.abs());
        let slack = slope * radius * WIDER + rounding;
        let is_known = slack < f32::INFINITY;
        own[0].0[lane] = if is_known { value } else { 0.0 };
        own[Models::COMPONENTS - 1].0[lane] = if is_known { slack } else { f32::INFINITY };
    }
    match before {
        None => out.clone_from_slice(&own),
        Some(a) => {
            let Kind::Combine(union) = &crate::shapes::UNION.kind else { unreachable!("union combines") };
            (union.kernels.models)(level, &mut CombineJob { a, b: &own, constants: &[], out, count });
        }
    }
}

/// A primitive over boxes: its value in the middle, and as much to either side as its largest slope allows.
///
/// For distances this is as narrow as an enclosure can be, in contrast to what the formula yields on intervals, and it needs
/// no kernel of its own.
fn primitive_over_boxes(level: Level, call: PrimitiveCall<'_, Ranges>) {
    let PrimitiveCall { table, job, slope, reach, scratch } = call;
    let PrimitiveJob { points, at, constants, before, out, count } = job;
    let (middle, rest) = scratch.split_at_mut(3);
    let [radius, size, value] = rest else { unreachable!("six blocks") };
    simd::with(
        level,
        #[inline(always)]
        || {
            let (radius, size) = (&mut radius.0[..count], &mut size.0[..count]);
            radius.fill(0.0);
            size.fill(0.0);
            for (axis, middle) in middle.iter_mut().enumerate() {
                let (lo, hi) = (&points[2 * axis].0[..count], &points[2 * axis + 1].0[..count]);
                let middle = &mut middle.0[..count];
                if axis >= axes(table) {
                    middle.fill(0.0);
                    continue;
                }
                let offset = at[axis].abs();
                for lane in 0..count {
                    let (lo, hi) = (lo[lane], hi[lane]);
                    let half = 0.5 * (hi - lo) * WIDER;
                    middle[lane] = 0.5 * lo + 0.5 * hi;
                    radius[lane] += half * half;
                    size[lane] += lo.abs().max(hi.abs()) + offset;
                }
            }
        },
    );
    let own = std::slice::from_mut(value);
    (table.kernels.values)(level, &mut PrimitiveJob { points: middle, at, constants, before: None, out: own, count });
    simd::with(
        level,
        #[inline(always)]
        || {
            let [lo, hi] = out else { unreachable!("two ends") };
            let (lo, hi) = (&mut lo.0[..count], &mut hi.0[..count]);
            let (radius, size, value) = (&radius.0[..count], &size.0[..count], &value.0[..count]);
            let around = &reach.0.0[..count];
            for lane in 0..count {
                let radius = (radius[lane].sqrt() * WIDER).min(around[lane]);
                let v = value[lane];
                let slack = slope * radius * WIDER + ROUNDING * (size[lane] + v.abs());
                let is_known = slack < f32::INFINITY;
                lo[lane] = if is_known { v - slack } else { f32::NEG_INFINITY };
                hi[lane] = if is_known { v + slack } else { f32::INFINITY };
            }
            if let Some(before) = before {
                let (lo_before, hi_before) = (&before[0].0[..count], &before[1].0[..count]);
                for lane in 0..count {
                    lo[lane] = lo[lane].min(lo_before[lane]);
                    hi[lane] = hi[lane].min(hi_before[lane]);
                }
            }
        },
    );
}
