//! Evaluation of programs over many points.
//!
//! Points are taken in batches of [`BATCH`]; for each batch the operations of the program run one after another, each as
//! one kernel call over the whole batch. An evaluator is the scratch memory of one thread.

use crate::bank::{Bank, Gradients, Values};
use crate::focus::Focus;
use crate::kernel::{BATCH, Block, CombineJob, WIDEST};
use crate::mix::{MixJob, mix_values};
use crate::operation::{NO_REGION, Step, StepId};
use crate::program::{Part, Program};
use crate::second::Seconds;
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

    pub(crate) fn slice(&self, range: Range<usize>) -> Points<'a> {
        Points { x: &self.x[range.clone()], y: &self.y[range.clone()], z: &self.z[range] }
    }
}

/// The shares of all regions at some points.
#[derive(Clone, Debug, Default)]
pub struct Shares {
    regions: Vec<usize>,
    shares: Vec<f32>,
    count: usize,
}

impl Shares {
    /// The regions that can have a share at these points, each with its share at each point, between 0 and 1; all together
    /// make 1.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[f32])> {
        self.regions.iter().copied().zip(self.shares.chunks(self.count.max(1)))
    }

    /// The share of a region at a point.
    pub fn of(&self, region: usize, point: usize) -> f32 {
        self.iter().find(|(of, _)| *of == region).map_or(0.0, |(_, shares)| shares[point])
    }
}

/// Runs a program over points.
pub struct Evaluator<'p> {
    program: &'p Program,
    level: Level,
    values: Bank<Values>,
    gradients: Bank<Gradients>,
    pub(crate) seconds: Bank<Seconds>,
    kept: Bank<Values>,
    weights: Vec<Block>,
    focus: Focus,
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
            seconds: Bank::default(),
            kept: Bank::default(),
            weights: Vec::new(),
            focus: Focus::default(),
        }
    }

    /// The instruction set it runs on.
    pub fn level(&self) -> Level {
        self.level
    }

    /// What it runs.
    pub fn program(&self) -> &'p Program {
        self.program
    }

    /// The field at each point.
    ///
    /// # Panics
    /// If `out` has not as many places as there are points.
    pub fn values(&mut self, points: Points<'_>, out: &mut [f32]) {
        self.values_in(&self.program.whole, points, out);
    }

    /// The field at each point, all of which lie where `part` holds.
    ///
    /// # Panics
    /// If `out` has not as many places as there are points.
    pub fn values_in(&mut self, part: &Part, points: Points<'_>, out: &mut [f32]) {
        assert_eq!(points.count(), out.len(), "one place for each point");
        let listing = part.listing();
        let Some(result) = listing.result else {
            return out.fill(f32::INFINITY);
        };
        self.values.prepare(listing);
        for batch in batches(out.len()) {
            let count = self.values.load(points.slice(batch.clone()));
            self.values.run(self.program, &listing.ops, self.level, count);
            let out = &mut out[batch];
            out.copy_from_slice(&self.values.value(result)[0].0[..out.len()]);
        }
    }

    /// The field at `count` points that `fill` writes, coordinate by coordinate, all of which lie where `part` holds.
    ///
    /// For inner loops: nothing is copied, in contrast to [`Evaluator::values_in`].
    ///
    /// # Panics
    /// If `count` is above [`BATCH`] or no multiple of [`WIDEST`].
    pub fn batch_in(&mut self, part: &Part, count: usize, fill: impl FnOnce([&mut [f32]; 3])) -> &[f32] {
        assert!(count <= BATCH && count.is_multiple_of(WIDEST), "whole vectors, at most a batch");
        let listing = part.listing();
        let Some(result) = listing.result else {
            return &NOWHERE[..count];
        };
        self.values.prepare(listing);
        let [x, y, z, ..] = &mut self.values.points[..] else { unreachable!("a point has three coordinates") };
        fill([&mut x.0[..count], &mut y.0[..count], &mut z.0[..count]]);
        self.values.run(self.program, &listing.ops, self.level, count);
        &self.values.value(result)[0].0[..count]
    }

    /// The field and its gradient at each point.
    ///
    /// # Panics
    /// If a result has not as many places as there are points.
    pub fn gradients(&mut self, points: Points<'_>, values: &mut [f32], gradient: [&mut [f32]; 3]) {
        self.gradients_in(&self.program.whole, points, values, gradient);
    }

    /// The field and its gradient at each point, all of which lie where `part` holds.
    ///
    /// # Panics
    /// If a result has not as many places as there are points.
    pub fn gradients_in(&mut self, part: &Part, points: Points<'_>, values: &mut [f32], gradient: [&mut [f32]; 3]) {
        assert_eq!(points.count(), values.len(), "one place for each point");
        if part.steps.result.is_none() {
            values.fill(f32::INFINITY);
            return gradient.into_iter().for_each(|out| out.fill(0.0));
        }
        let [gx, gy, gz] = gradient;
        for batch in batches(values.len()) {
            let focused = self.focus.on(self.program, part, self.level, points.slice(batch.clone()));
            let listing = focused.as_ref().unwrap_or(part).listing();
            let result = listing.result.expect("there is a result");
            self.gradients.prepare(listing);
            let count = self.gradients.load(points.slice(batch.clone()));
            self.gradients.run(self.program, &listing.ops, self.level, count);
            let from = self.gradients.value(result);
            for (out, from) in [&mut *values, &mut *gx, &mut *gy, &mut *gz].into_iter().zip(from) {
                let out = &mut out[batch.clone()];
                out.copy_from_slice(&from.0[..out.len()]);
            }
        }
    }

    /// The share of each region of [`crate::Structure::regions`] in the surface nearest to each point.
    pub fn shares(&mut self, points: Points<'_>, out: &mut Shares) {
        self.shares_in(&self.program.whole, points, out);
    }

    /// The share of each region in the surface nearest to each point, all of which lie where `part` holds.
    ///
    /// A share is the product of the partial derivatives of all combinations on the way from the region to the result,
    /// computed from the result downwards over the intermediate values of one evaluation.
    pub fn shares_in(&mut self, part: &Part, points: Points<'_>, out: &mut Shares) {
        // What is left of a long union lists no regions that have no share anywhere.
        let focused = self.focus.on(self.program, part, self.level, points);
        let part = focused.as_ref().unwrap_or(part);
        let (listing, regions) = (part.kept(), part.regions());
        out.count = points.count();
        out.regions.clear();
        out.regions.extend(regions.iter().map(|&region| region as usize));
        out.shares.clear();
        out.shares.resize(out.count * regions.len(), 0.0);
        let Some(result) = listing.result else {
            return;
        };
        self.kept.prepare(listing);
        self.weights.resize(listing.values.max(self.weights.len()), Block::default());
        let place = |id: StepId| listing.place[id.index()] as usize;
        let mut share = Block::default();
        for batch in batches(out.count) {
            let count = self.kept.load(points.slice(batch.clone()));
            self.kept.run(self.program, &listing.ops, self.level, count);
            self.weights[result].0.fill(1.0);
            for (index, step) in part.steps.list.iter().enumerate().rev() {
                let own = listing.place[index] as usize;
                match *step {
                    Step::Combine { table, a, b, constants, .. } => {
                        let (a, b) = (place(a), place(b));
                        (table.kernels.shares)(
                            self.level,
                            &mut CombineJob {
                                a: self.kept.value(a),
                                b: self.kept.value(b),
                                constants: &self.program.single[constants.range()],
                                out: std::slice::from_mut(&mut share),
                                count,
                            },
                        );
                        for lane in 0..count {
                            let weight = self.weights[own].0[lane];
                            self.weights[a].0[lane] = weight * (1.0 - share.0[lane]);
                            self.weights[b].0[lane] = weight * share.0[lane];
                        }
                    }
                    Step::Mix { a, b, height, constants } => {
                        let (a, b, height) = (place(a), place(b), self.kept.value(place(height)));
                        let constants = &self.program.single[constants.range()];
                        let out = std::slice::from_mut(&mut share);
                        // What 0 and 1 mix to is the share of the second value.
                        let (zero, one) = (std::slice::from_ref(&NONE), std::slice::from_ref(&ALL));
                        mix_values(self.level, &mut MixJob { a: zero, b: one, height, constants, out, count });
                        for lane in 0..count {
                            let weight = self.weights[own].0[lane];
                            self.weights[a].0[lane] = weight * (1.0 - share.0[lane]);
                            self.weights[b].0[lane] = weight * share.0[lane];
                        }
                    }
                    Step::Primitive { region, .. } | Step::Surface { region, .. } if region != NO_REGION => {
                        let column = regions.binary_search(&region).expect("a part lists all its regions");
                        let start = column * out.count;
                        let to = &mut out.shares[start + batch.start..start + batch.end];
                        for (to, weight) in to.iter_mut().zip(&self.weights[own].0) {
                            *to += weight;
                        }
                    }
                    Step::Modify { from, .. } | Step::Scale { from, .. } | Step::Altered { from, .. } => {
                        let weight = self.weights[own].clone();
                        self.weights[place(from)] = weight;
                    }
                    // What a formula is made of belongs to the formula as a whole.
                    _ => {}
                }
            }
        }
    }
}

/// Shares of nothing, and of all.
static NONE: Block = Block([0.0; BATCH]);
static ALL: Block = Block([1.0; BATCH]);

/// The distances to nothing.
static NOWHERE: [f32; BATCH] = [f32::INFINITY; BATCH];

/// Consecutive ranges of at most a batch.
pub(crate) fn batches(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count).step_by(BATCH).map(move |start| start..(start + BATCH).min(count))
}
