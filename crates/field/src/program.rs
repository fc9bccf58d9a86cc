//! A structure with its numbers: what evaluators run.
//!
//! Constants are derived in `f64` and kept twice: rounded to `f32` and relative to the program's origin for batches, and
//! as they are for evaluation at single points in `f64`, intervals, dual numbers and expressions, which all go through
//! one generic interpreter.

use crate::diagnostic::Diagnostic;
use crate::expr::{Expr, Graph, Slots};
use crate::formula::{Binary, Unary};
use crate::kernel::{
    CombineFn, CombineKernels, Dual2, MapFn, MapKernels, ModifyFn, ModifyKernels, PrimitiveFn, PrimitiveKernels, affine,
};
use crate::lower::Listing;
use crate::mix::{MIX_CONSTANTS, mixed};
use crate::operands::Operands;
use crate::operation::{Code, Derive, NO_REGION, Run, Step, StepId, Steps, inverse_of};
use crate::scalar::{Constants, Dual, Interval, Scalar};
use crate::shapes::{loft, repeat_endless};
use crate::spine::Spine;
use crate::vector::{Vec3, spectral_norm};
use glam::DVec3;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Why numbers could not be bound.
#[derive(Clone, Debug)]
pub enum BindError {
    /// There are not as many numbers as slots.
    Count {
        /// How many numbers there are.
        given: usize,
        /// How many slots there are.
        wanted: usize,
    },
    /// The numbers are no sound arguments.
    Faults(Vec<Diagnostic>),
    /// With these numbers a shape needs another number of constants: the field must be compiled anew.
    Structure,
}

impl std::fmt::Display for BindError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Count { given, wanted } => write!(f, "{given} numbers for {wanted} slots"),
            Self::Faults(faults) => faults.iter().try_for_each(|fault| writeln!(f, "{fault}")),
            Self::Structure => f.write_str("these numbers need another structure"),
        }
    }
}

impl std::error::Error for BindError {}

/// A compiled field with its numbers. Cheap to clone; share it between threads.
#[derive(Clone, Debug)]
pub struct Program {
    /// All steps.
    pub(crate) whole: Arc<Part>,
    /// For batches: relative to the origin.
    pub(crate) single: Arc<[f32]>,
    /// For single points: absolute.
    pub(crate) double: Arc<[f64]>,
    operands: Arc<Operands>,
    origin: DVec3,
    lipschitz: Option<f64>,
}

impl Program {
    pub(crate) fn bind(
        code: &Code,
        whole: &Arc<Part>,
        operands: Arc<Operands>,
        values: &[f64],
        origin: DVec3,
        lipschitz: Option<f64>,
    ) -> Result<Self, BindError> {
        let double = derive(code, values, DVec3::ZERO)?;
        let single = derive(code, values, origin)?.iter().map(|&c| c as f32).collect();
        Ok(Self { whole: Arc::clone(whole), single, double: double.into(), operands, origin, lipschitz })
    }

    /// What the points of batches are relative to.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The largest slope of the field, if it is known.
    pub fn lipschitz(&self) -> Option<f64> {
        self.lipschitz
    }

    /// All of its steps.
    pub fn whole(&self) -> &Arc<Part> {
        &self.whole
    }

    /// The field at a point, in `f64`.
    pub fn value(&self, p: DVec3) -> f64 {
        self.run(p.to_array().into())
    }

    /// The field and its gradient at a point, in `f64`.
    pub fn gradient(&self, p: DVec3) -> (f64, DVec3) {
        let [x, y, z] = p.to_array();
        let result = self.run([Dual::input(x, 0), Dual::input(y, 1), Dual::input(z, 2)].into());
        (result.value, result.gradient.into())
    }

    /// The field, its gradient and its Hessian (by columns) at a point, in `f64`.
    pub fn hessian(&self, p: DVec3) -> (f64, DVec3, glam::DMat3) {
        let input = |axis: usize| Dual2 {
            value: Dual::input(p[axis], axis),
            gradient: std::array::from_fn(|i| Dual::independent(if i == axis { 1.0 } else { 0.0 })),
        };
        let result: Dual2 = self.run([input(0), input(1), input(2)].into());
        let [x, y, z] = result.gradient.map(|d| d.gradient.into());
        (result.value.value, result.value.gradient.into(), glam::DMat3::from_cols(x, y, z))
    }

    /// An enclosure of the field's values over a box.
    ///
    /// Where the field's slope is known, the value in the middle and the slope give a second enclosure, which the result
    /// is cut with: it stays narrow where the formula repeats its variables.
    pub fn interval(&self, region: [Interval; 3]) -> Interval {
        let natural = self.run(region.into());
        let Some(lipschitz) = self.lipschitz else {
            return natural;
        };
        let middle = region.map(|side| Interval::point(side.middle()));
        let reach = region.map(|side| {
            let middle = Interval::point(side.middle());
            (side - middle).abs().hi()
        });
        let [x, y, z] = reach.map(Interval::point);
        let drift = Interval::length3(x, y, z) * lipschitz;
        if !drift.hi().is_finite() {
            return natural;
        }
        let center: Interval = self.run(middle.into());
        natural.meet(center + Interval::new(-drift.hi(), drift.hi()))
    }

    /// [`Program::interval`] for several boxes.
    ///
    /// # Panics
    /// If `out` has not as many places as there are boxes.
    pub fn intervals(&self, regions: &[[Interval; 3]], out: &mut [Interval]) {
        assert_eq!(regions.len(), out.len(), "one place for each box");
        for (region, out) in regions.iter().zip(out) {
            *out = self.interval(*region);
        }
    }

    /// Records the field's formula. The constants of its operations are the slots of the graph, in the order of
    /// [`Program::constants`].
    pub fn expression<'g>(&self, graph: &'g Graph) -> Expr<'g> {
        self.run(graph.point().into())
    }

    /// The constants of all operations, for absolute points.
    pub fn constants(&self) -> &[f64] {
        &self.double
    }

    /// The fields that it was made of.
    pub(crate) fn operands(&self) -> &Operands {
        &self.operands
    }

    /// The value at a point of a step that is computed from nothing but the steps `own`, in `f64`.
    pub(crate) fn value_of(&self, own: Range<usize>, result: StepId, p: DVec3) -> f64 {
        self.run_steps(own, result, p.to_array().into())
    }

    fn run<S: Host>(&self, p: Vec3<S>) -> S {
        let steps = &self.whole.steps;
        match steps.result {
            Some(result) => self.run_steps(1..steps.list.len(), result, p),
            None => p.x.lift(f64::INFINITY),
        }
    }

    /// Runs some steps, which read no others but the point.
    fn run_steps<S: Host>(&self, own: Range<usize>, result: StepId, p: Vec3<S>) -> S {
        let like = p.x;
        let place = |id: StepId| if id == StepId::POINT { 0 } else { id.index() - own.start + 1 };
        let mut points: Vec<Vec3<S>> = Vec::with_capacity(own.len() + 1);
        let mut values: Vec<S> = Vec::with_capacity(own.len() + 1);
        points.push(p);
        values.push(like);
        for step in &self.whole.steps.list[own.clone()] {
            let (mut point, mut value) = (p, like);
            match *step {
                Step::Point => {}
                Step::Affine { from, constants } => {
                    let from = points[place(from)];
                    point =
                        S::with_table(&self.double, constants, |table| affine(from, &Constants::new(like, table, 12)));
                }
                Step::Map { table, from, at, constants } => {
                    let at = S::with_table(&self.double, at, |table| Constants::new(like, table, 3).get::<3>());
                    let p = points[place(from)] - at.into();
                    point = S::with_table(&self.double, constants, |slots| {
                        S::map(&table.kernels)(p, &Constants::new(like, slots, constants.len()))
                    });
                }
                Step::Primitive { table, point: at_point, at, constants, .. } => {
                    let at = S::with_table(&self.double, at, |table| Constants::new(like, table, 3).get::<3>());
                    let p = points[place(at_point)] - at.into();
                    value = S::with_table(&self.double, constants, |slots| {
                        S::primitive(&table.kernels)(p, &Constants::new(like, slots, constants.len()))
                    });
                }
                Step::Combine { table, a, b, constants, .. } => {
                    let (a, b) = (values[place(a)], values[place(b)]);
                    value = S::with_table(&self.double, constants, |slots| {
                        S::combine(&table.kernels)(a, b, &Constants::new(like, slots, constants.len()))
                    });
                }
                Step::Mix { a, b, height, constants } => {
                    let [a, b, height] = [a, b, height].map(|id| values[place(id)]);
                    value = S::with_table(&self.double, constants, |slots| {
                        mixed(a, b, height, &Constants::new(like, slots, MIX_CONSTANTS))
                    });
                }
                Step::Modify { table, from, constants, .. } => {
                    let from = values[place(from)];
                    value = S::with_table(&self.double, constants, |slots| {
                        S::modify(&table.kernels)(from, &Constants::new(like, slots, constants.len()))
                    });
                }
                Step::Scale { from, factor } => {
                    let factor = Run::from(factor as usize..factor as usize + 1);
                    let factor = S::with_table(&self.double, factor, |table| like.constant(table, 0));
                    value = values[place(from)] * factor;
                }
                Step::Coordinate { point, axis, at } => {
                    let p = points[place(point)];
                    let at = S::with_table(&self.double, at, |table| like.constant(table, usize::from(axis)));
                    value = [p.x, p.y, p.z][usize::from(axis)] - at;
                }
                Step::Literal { constant } => {
                    let run = Run::from(constant as usize..constant as usize + 1);
                    value = S::with_table(&self.double, run, |table| like.constant(table, 0));
                }
                Step::Unary { op, from } => value = op.apply(values[place(from)]),
                Step::Binary { op, a, b } => value = op.apply(values[place(a)], values[place(b)]),
                Step::Power { from, exponent } => value = values[place(from)].powi(exponent),
                Step::Surface { from, .. } => value = values[place(from)],
                Step::Altered { op, from, by } => value = op.apply(values[place(from)], values[place(by)]),
                Step::Warp { x, y, z } => point = [x, y, z].map(|id| values[place(id)]).into(),
            }
            points.push(point);
            values.push(value);
        }
        values[place(result)]
    }
}

/// Some of a program's steps: all that can matter somewhere.
#[derive(Debug)]
pub struct Part {
    pub(crate) steps: Steps,
    is_measured: bool,
    is_warped: bool,
    is_loose: bool,
    listing: OnceLock<Listing>,
    one_by_one: OnceLock<Listing>,
    kept: OnceLock<Listing>,
    zeros: OnceLock<Zeros>,
    regions: OnceLock<Vec<u32>>,
    spine: OnceLock<Option<Spine>>,
}

impl Part {
    pub(crate) fn new(steps: Steps) -> Self {
        let one_by_one = OnceLock::new();
        // What is computed from coordinates other than by primitives has no scale. A formula of which nothing but the cut is
        // left does not read them any more.
        // Neither has what a map stretches, or what is mixed by heights.
        let is_measured = !steps.list.iter().any(|step| match step {
            Step::Coordinate { .. } | Step::Literal { .. } | Step::Mix { .. } => true,
            Step::Map { table, .. } => !table.is_short,
            _ => false,
        });
        let is_warped = !is_measured && !steps.list.iter().any(|step| matches!(step, Step::Surface { .. }));
        let is_loose = steps.list.iter().any(|step| matches!(step, Step::Primitive { table, .. } if table.is_loose));
        Self {
            steps,
            is_measured,
            is_warped,
            is_loose,
            listing: OnceLock::new(),
            one_by_one,
            kept: OnceLock::new(),
            zeros: OnceLock::new(),
            regions: OnceLock::new(),
            spine: OnceLock::new(),
        }
    }

    /// Whether all values in it are distances or bounds of them up to a factor, so that rays can march by them.
    pub fn is_measured(&self) -> bool {
        self.is_measured
    }

    /// Whether its values are distances but for what warps and displacements do to them, so that rays can march by them where
    /// [`Cells::slope`](crate::Cells::slope) says how steep they are.
    pub fn is_warped(&self) -> bool {
        self.is_warped
    }

    /// Whether some of its values are much smaller than distances, so that rays gain by relaxed steps.
    pub fn is_loose(&self) -> bool {
        self.is_loose
    }

    /// How many steps there are.
    pub fn size(&self) -> usize {
        self.steps.list.len()
    }

    /// How many regions have a share somewhere.
    pub fn region_count(&self) -> usize {
        self.regions().len()
    }

    /// The first of these regions.
    pub fn first_region(&self) -> Option<usize> {
        self.regions().first().map(|&region| region as usize)
    }

    pub(crate) fn listing(&self) -> &Listing {
        self.listing.get_or_init(|| Listing::of(&self.steps))
    }

    /// The operations, one for each step but the first.
    pub(crate) fn one_by_one(&self) -> &Listing {
        self.one_by_one.get_or_init(|| Listing::one_by_one(&self.steps))
    }

    /// The operations that keep every intermediate value.
    pub(crate) fn kept(&self) -> &Listing {
        self.kept.get_or_init(|| Listing::keeping_all(&self.steps))
    }

    /// The chain of minima that it ends with, if that is a long one.
    pub(crate) fn spine(&self) -> Option<&Spine> {
        self.spine.get_or_init(|| Spine::of(&self.steps)).as_ref()
    }

    /// What the surface is made of, if that is known to be the zeros of simpler fields.
    pub(crate) fn zeros(&self) -> &Zeros {
        self.zeros.get_or_init(|| Zeros::of(&self.steps))
    }

    /// The regions of all its surfaces, in order.
    pub(crate) fn regions(&self) -> &[u32] {
        self.regions.get_or_init(|| {
            let region = |step: &Step| match *step {
                Step::Primitive { region, .. } | Step::Surface { region, .. } if region != NO_REGION => Some(region),
                _ => None,
            };
            let mut regions: Vec<u32> = self.steps.list.iter().filter_map(region).collect();
            regions.sort_unstable();
            regions.dedup();
            regions
        })
    }
}

/// Fields that have the zeros of a part between them.
#[derive(Debug)]
pub(crate) struct Zeros {
    /// The operations for the first one.
    pub(crate) listing: Listing,
    /// Whether the part has its absolute values.
    pub(crate) is_sheet: bool,
    /// The register of another field; the part has the larger one of both.
    pub(crate) cut: Option<usize>,
}

impl Zeros {
    fn of(steps: &Steps) -> Self {
        let Some(result) = steps.result else {
            return Self { listing: Listing::of(steps), is_sheet: false, cut: None };
        };
        let step = |id: StepId| steps.list[id.index()];
        let bare = |mut id: StepId| {
            while let Step::Surface { from, .. } = step(id) {
                id = from;
            }
            id
        };
        let (first, cut) = match step(bare(result)) {
            Step::Binary { op: Binary::Max, a, b } => (bare(a), Some(bare(b))),
            _ => (bare(result), None),
        };
        let (first, is_sheet) = match step(first) {
            Step::Unary { op: Unary::Abs, from } => (from, true),
            _ => (first, false),
        };
        let count = cut.map_or(first, |cut| cut.max(first)).index() + 1;
        let steps = Steps { list: steps.list[..count].to_vec(), result: Some(first) };
        match cut {
            None => Self { listing: Listing::of(&steps), is_sheet, cut: None },
            Some(cut) => {
                let (listing, register) = Listing::of_two(&steps, cut);
                Self { listing, is_sheet, cut: Some(register) }
            }
        }
    }
}

/// All constants, with points taken relative to `origin`.
fn derive(code: &Code, values: &[f64], origin: DVec3) -> Result<Vec<f64>, BindError> {
    let mut constants = vec![0.0; code.constants];
    for derive in &code.derive {
        match derive {
            Derive::Prepare { prepare, args, out } => {
                let own = prepare(&values[args.clone()]);
                if own.len() != out.len() {
                    return Err(BindError::Structure);
                }
                constants[out.clone()].copy_from_slice(&own);
            }
            Derive::Parts { table, args, parts } => {
                if (table.parts)(&values[args.clone()]) != *parts {
                    return Err(BindError::Structure);
                }
            }
            Derive::Affine { chain, from_root, out } => {
                let (matrix, mut translation) = inverse_of(chain, values);
                if *from_root {
                    translation += matrix * origin;
                }
                constants[out.start..out.start + 9].copy_from_slice(&matrix.to_cols_array());
                constants[out.start + 9..out.start + 12].copy_from_slice(&translation.to_array());
                constants[out.start + 12] = spectral_norm(matrix);
            }
            Derive::Offset { chain, from_root, out } => {
                let (_, mut translation) = inverse_of(chain, values);
                if *from_root {
                    translation += origin;
                }
                constants[out.clone()].copy_from_slice(&(-translation).to_array());
            }
            Derive::Mixture { args, index, count, out } => {
                constants[out.clone()].copy_from_slice(&loft::mixture(&values[args.clone()], *index, *count));
            }
            Derive::Endless { field, numbers, out } => {
                let own = repeat_endless::constants(&field.with_numbers(&mut &values[numbers.clone()]));
                if own.len() != out.len() {
                    return Err(BindError::Structure);
                }
                constants[out.clone()].copy_from_slice(&own);
            }
            Derive::Literals { numbers, out } => constants[out.clone()].copy_from_slice(numbers),
            Derive::Slope { table, args, out } => {
                constants[*out] = (table.contract)(&values[args.clone()]).lipschitz.unwrap_or(f64::INFINITY);
            }
            Derive::Factor { table, args, out } => {
                constants[*out] = (table.factor)(&values[args.clone()]);
            }
        }
    }
    Ok(constants)
}

/// A number type that single points are evaluated in.
trait Host: Scalar {
    fn primitive(kernels: &PrimitiveKernels) -> PrimitiveFn<Self>;
    fn combine(kernels: &CombineKernels) -> CombineFn<Self>;
    fn modify(kernels: &ModifyKernels) -> ModifyFn<Self>;
    fn map(kernels: &MapKernels) -> MapFn<Self>;
    fn with_table<R>(constants: &[f64], range: Run, read: impl FnOnce(&Self::Table) -> R) -> R;
}

macro_rules! host {
    ($($Number:ty: $field:ident),*) => {$(
        impl Host for $Number {
            fn primitive(kernels: &PrimitiveKernels) -> PrimitiveFn<Self> {
                kernels.$field
            }
            fn combine(kernels: &CombineKernels) -> CombineFn<Self> {
                kernels.$field
            }
            fn modify(kernels: &ModifyKernels) -> ModifyFn<Self> {
                kernels.$field
            }
            fn map(kernels: &MapKernels) -> MapFn<Self> {
                kernels.$field
            }
            fn with_table<R>(constants: &[f64], range: Run, read: impl FnOnce(&[f64]) -> R) -> R {
                read(&constants[range.range()])
            }
        }
    )*};
}

host!(f64: real, Interval: interval, Dual<f64>: dual, Dual2: dual2);

impl Host for Expr<'_> {
    fn primitive(kernels: &PrimitiveKernels) -> PrimitiveFn<Self> {
        kernels.expr
    }

    fn combine(kernels: &CombineKernels) -> CombineFn<Self> {
        kernels.expr
    }

    fn modify(kernels: &ModifyKernels) -> ModifyFn<Self> {
        kernels.expr
    }

    fn map(kernels: &MapKernels) -> MapFn<Self> {
        kernels.expr
    }

    fn with_table<R>(_constants: &[f64], range: Run, read: impl FnOnce(&Slots) -> R) -> R {
        read(&Slots::at(range.start() as u32))
    }
}
