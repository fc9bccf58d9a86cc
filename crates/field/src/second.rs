//! Second derivatives in batches.
//!
//! A number holds a value, its derivatives along two directions, and its second derivative along both: a dual number of dual
//! numbers with one derivative each. Six runs of a program, one for each pair of axes, give the Hessian. That takes half as
//! much again as the sixteen components of nested gradients would, but such numbers fill the registers of the machine
//! several times over, and their kernels take four times as long to build.

use crate::bank::{Bank, Number, PrimitiveCall};
use crate::evaluator::{Evaluator, Points, batches};
use crate::formula_kernel::{self, FormulaKernels};
use crate::kernel::{AffineJob, CombineJob, CombineKernels, MapJob, MapKernels, ModifyJob, ModifyKernels, WIDEST};
use crate::mix::MixJob;
use crate::program::Part;
use crate::simd::Level;

/// Values with their derivatives along two axes, and along both.
#[derive(Default)]
pub(crate) struct Seconds;

impl Number for Seconds {
    const COMPONENTS: usize = 4;
    const FORMULA: FormulaKernels = formula_kernel::SECONDS;
    type Reach = ();

    fn primitive(level: Level, mut call: PrimitiveCall<'_, Self>) {
        (call.table.kernels.seconds)(level, &mut call.job);
    }

    fn combine(kernels: &CombineKernels) -> fn(Level, &mut CombineJob<'_>) {
        kernels.seconds
    }

    fn mix(level: Level, job: &mut MixJob<'_>) {
        crate::mix::mix_seconds(level, job);
    }

    fn modify(kernels: &ModifyKernels) -> fn(Level, &mut ModifyJob<'_>) {
        kernels.seconds
    }

    fn affine(level: Level, job: &mut AffineJob<'_>) {
        crate::kernel::affine_seconds(level, job);
    }

    fn map(kernels: &MapKernels) -> fn(Level, &mut MapJob<'_>) {
        kernels.seconds
    }
}

impl Bank<Seconds> {
    /// Fills point register 0 for derivatives along two axes, and returns how many points the kernels run over.
    fn load(&mut self, points: Points<'_>, along: [usize; 2]) -> usize {
        let given = points.count();
        let count = given.next_multiple_of(WIDEST);
        for (axis, from) in [points.x, points.y, points.z].into_iter().enumerate() {
            let [value, inner, outer, both] = &mut self.points[4 * axis..4 * axis + 4] else {
                unreachable!("four components")
            };
            value.0[..given].copy_from_slice(from);
            value.0[given..count].fill(0.0);
            for (derivative, by) in [inner, outer].into_iter().zip(along) {
                derivative.0[..count].fill(if by == axis { 1.0 } else { 0.0 });
            }
            both.0[..count].fill(0.0);
        }
        count
    }
}

/// The pairs of axes in the order of the entries of a Hessian.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

impl Evaluator<'_> {
    /// The field, its gradient and its Hessian at each point. The entries of the symmetric Hessian are those of xx, yy, zz,
    /// xy, xz and yz.
    ///
    /// # Panics
    /// If a result has not as many places as there are points.
    pub fn hessians(
        &mut self,
        points: Points<'_>,
        values: &mut [f32],
        gradient: [&mut [f32]; 3],
        hessian: [&mut [f32]; 6],
    ) {
        self.hessians_in(&self.program().whole, points, values, gradient, hessian);
    }

    /// The field, its gradient and its Hessian at each point, all of which lie where `part` holds. See
    /// [`Evaluator::hessians`].
    ///
    /// # Panics
    /// If a result has not as many places as there are points.
    pub fn hessians_in(
        &mut self,
        part: &Part,
        points: Points<'_>,
        values: &mut [f32],
        gradient: [&mut [f32]; 3],
        hessian: [&mut [f32]; 6],
    ) {
        assert_eq!(points.count(), values.len(), "one place for each point");
        let listing = part.listing();
        let Some(result) = listing.result else {
            values.fill(f32::INFINITY);
            return gradient.into_iter().chain(hessian).for_each(|out| out.fill(0.0));
        };
        let (program, level) = (self.program(), self.level());
        let bank = &mut self.seconds;
        bank.prepare(listing);
        for batch in batches(values.len()) {
            for (pair, along) in PAIRS.into_iter().enumerate() {
                let count = bank.load(points.slice(batch.clone()), along);
                bank.run(program, &listing.ops, level, count);
                let [value, inner, _, both] = bank.value(result) else { unreachable!("four components") };
                let size = batch.len();
                hessian[pair][batch.clone()].copy_from_slice(&both.0[..size]);
                if pair < 3 {
                    gradient[pair][batch.clone()].copy_from_slice(&inner.0[..size]);
                    values[batch.clone()].copy_from_slice(&value.0[..size]);
                }
            }
        }
    }
}
