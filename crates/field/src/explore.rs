//! What can be found out about a field by looking at its values: bounding boxes and slopes of fields that don't say them.
//!
//! The extent of a bare field is the solution of an optimisation: how far a point where the field is not positive can lie in
//! some direction, or from some centre. Interval branch and bound solves it with a proof (Hansen and Walster, "Global
//! Optimization Using Interval Analysis", 2004): boxes where the field is positive throughout are out; of the others the
//! one that reaches farthest is halved, until what it promises is near to a point that was found.

use crate::analysis::{Analysis, analyse, extent};
use crate::contract::{Aabb, Extent};
use crate::field::Field;
use crate::program::Program;
use crate::scalar::{Interval, Scalar};
use crate::shape::Kind;
use crate::shapes::formula::{Parts, Region};
use crate::slope::{Sloper, halves};
use crate::structure::Structure;
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// How far and how long to look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Half the edge of the cube around the origin that is searched.
    pub reach: f64,
    /// By how much a bound may be too large, relative to the longest edge of the box that is found.
    pub tolerance: f64,
    /// How many boxes may be looked at for each bound. What needs more counts as unbounded.
    pub boxes: usize,
}

impl Default for Limits {
    /// As far as the supported ratio of sizes goes for things of size 1, to a tenth of a percent, within some tenths of a
    /// second.
    fn default() -> Self {
        Self { reach: 1e5, tolerance: 5e-4, boxes: 40_000 }
    }
}

/// A point where the field is not positive and that lies farther out than this part of the reach shows that the shape is
/// not bounded.
const FAR: f64 = 0.5;

/// The first look is for a box this much too large, relative to how far from the origin it reaches: coarse, so that it takes
/// few steps to come in from the border.
const COARSE: f64 = 0.25;

/// The first look need not be finer than this, relative to the reach.
const LEAST: f64 = 1e-7;

/// Looks at one extent. The first one shows the size of the shape, by which the tolerances of the others are measured.
const LOOKS: usize = 3;

/// What is known about a field by [`analyse`] and, where that leaves it open, by search: an extent, and a largest slope
/// that holds in the box of the extent. `None` if the field has faults.
pub fn explore(field: &Field, limits: &Limits) -> Option<Analysis> {
    let mut analysis = analyse(field).0?;
    if analysis.extent == Extent::Unbounded {
        analysis.extent = find_extent(field, limits);
    }
    if let (None, Extent::Finite(aabb)) = (analysis.contract.lipschitz, analysis.extent) {
        let program = program(field)?;
        let node = field.node();
        let region = match node.shape.kind {
            Kind::Formula => Parts::of(&node.numbers()).region,
            _ => Region::Everywhere,
        };
        let slope = match region {
            Region::Sphere { radius } => program.lipschitz_where(sides(aabb), |part| {
                let [x, y, z] = *part;
                Interval::length3(x, y, z).lo() <= radius
            }),
            _ => program.lipschitz_over(sides(aabb)),
        };
        analysis.contract.lipschitz = slope;
        analysis.contract.within = slope.map(|_| aabb);
    }
    Some(analysis)
}

/// The box around all points where a field is not positive, found without help. For a field with a known extent that is the
/// known one.
///
/// A finite box is proven: within the reach of the search nothing lies outside of it, and the shape keeps clear of the
/// border of what was searched. [`Extent::Empty`] means that nothing was there within the reach. Everything else is
/// [`Extent::Unbounded`].
pub fn find_extent(field: &Field, limits: &Limits) -> Extent {
    let known = extent(field);
    if known != Extent::Unbounded {
        return known;
    }
    let Some(program) = program(field) else {
        return Extent::Unbounded;
    };
    let mut region = [Interval::new(-limits.reach, limits.reach); 3];
    let mut tolerance = None;
    for _ in 0..LOOKS {
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let mut direction = DVec3::ZERO;
                direction[axis] = sign;
                let goal = Goal { tolerance, ..Goal::along(limits) };
                let bound = match farthest(&program, region, &goal, |part| along(part, direction)) {
                    Found::Nothing => return Extent::Empty,
                    Found::Bound(bound) => bound,
                    Found::TooFar => return Extent::Unbounded,
                };
                let side = region[axis];
                let (lo, hi) = if sign > 0.0 { (side.lo(), bound) } else { (-bound, side.hi()) };
                region[axis] = Interval::new(lo.min(hi), hi);
            }
        }
        tolerance = Some(limits.tolerance * region.map(Interval::width).into_iter().fold(0.0, f64::max));
    }
    Extent::Finite(Aabb {
        min: DVec3::from_array(region.map(Interval::lo)),
        max: DVec3::from_array(region.map(Interval::hi)),
    })
}

/// The largest `direction . p` over all points where a field is not positive, and at most the tolerance more: the smallest
/// slab around the shape. `None` if the shape is not bounded, or not found to be. Negative infinity if there is nothing.
pub fn find_support(field: &Field, direction: DVec3, limits: &Limits) -> Option<f64> {
    find(field, limits, |part| along(part, direction))
}

/// The radius of the smallest sphere around `center` that holds all points where a field is not positive, and at most the
/// tolerance more. `None` if the shape is not bounded, or not found to be. Negative infinity if there is nothing.
pub fn find_radius(field: &Field, center: DVec3, limits: &Limits) -> Option<f64> {
    find(field, limits, |part| {
        let [x, y, z]: [Interval; 3] = std::array::from_fn(|axis| part[axis] - center[axis]);
        Interval::length3(x, y, z)
    })
}

/// The largest score of a point where the field is not positive.
fn find(field: &Field, limits: &Limits, score: impl Fn(&[Interval; 3]) -> Interval) -> Option<f64> {
    let Extent::Finite(aabb) = find_extent(field, limits) else {
        return (extent(field) == Extent::Empty).then_some(f64::NEG_INFINITY);
    };
    let tolerance = Some(limits.tolerance * aabb.size().max_element());
    let goal = Goal { tolerance, far: f64::INFINITY, ..Goal::along(limits) };
    match farthest(&program(field)?, sides(aabb), &goal, score) {
        Found::Nothing => Some(f64::NEG_INFINITY),
        Found::Bound(bound) => Some(bound),
        Found::TooFar => None,
    }
}

fn program(field: &Field) -> Option<Program> {
    Some(Structure::compile(std::slice::from_ref(field)).ok()?.program(DVec3::ZERO))
}

fn sides(aabb: Aabb) -> [Interval; 3] {
    std::array::from_fn(|axis| Interval::new(aabb.min[axis], aabb.max[axis]))
}

fn along(part: &[Interval; 3], direction: DVec3) -> Interval {
    let side = |axis: usize| match direction[axis] {
        0.0 => Interval::ZERO,
        factor => part[axis] * factor,
    };
    match [0, 1, 2].map(side) {
        // A coordinate alone is exact.
        [x, Interval::ZERO, Interval::ZERO] => x,
        [Interval::ZERO, y, Interval::ZERO] => y,
        [Interval::ZERO, Interval::ZERO, z] => z,
        [x, y, z] => x + y + z,
    }
}

/// When a search is over.
#[derive(Clone, Copy)]
struct Goal {
    /// By how much the bound may be too large; if `None`, relative to itself.
    tolerance: Option<f64>,
    /// What that is at least then.
    least: f64,
    /// A point or bound beyond this means that the shape is not bounded.
    far: f64,
    boxes: usize,
}

impl Goal {
    fn along(limits: &Limits) -> Self {
        Self { tolerance: None, least: LEAST * limits.reach, far: FAR * limits.reach, boxes: limits.boxes }
    }
}

/// How a search ended.
enum Found {
    /// The field is positive throughout.
    Nothing,
    /// No score is larger.
    Bound(f64),
    /// There is something beyond where it may be, or the search took too long.
    TooFar,
}

/// A box that may hold something, ordered by the largest score in it.
struct Candidate {
    score: f64,
    region: [Interval; 3],
    /// By how much each axis makes the field vary in it.
    spread: [f64; 3],
    /// How often the region was halved for it.
    depth: u32,
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.score.total_cmp(&other.score)
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

/// An upper bound of the score over all points of a region where the field is not positive.
fn farthest(
    program: &Program,
    region: [Interval; 3],
    goal: &Goal,
    score: impl Fn(&[Interval; 3]) -> Interval,
) -> Found {
    let mut sloper = Sloper::new(program, &program.whole().steps);
    let mut candidates = BinaryHeap::new();
    // The largest score of a point that was found.
    let mut found = f64::NEG_INFINITY;
    let mut count = 0;
    let mut pending = vec![(region, 0)];
    loop {
        for (region, depth) in pending.drain(..) {
            count += 1;
            let best = score(&region).hi();
            if best <= found {
                continue;
            }
            let (values, spread) = sloper.survey(region);
            if values.lo() > 0.0 {
                continue;
            }
            let middle = region.map(Interval::middle);
            if values.hi() <= 0.0 {
                found = found.max(best);
            } else if program.value(middle.into()) <= 0.0 {
                found = found.max(score(&middle.map(Interval::point)).hi());
            }
            candidates.push(Candidate { score: best, region, spread, depth });
        }
        if found > goal.far {
            return Found::TooFar;
        }
        let Some(Candidate { score: bound, region, spread, depth }) = candidates.pop() else {
            return if found > f64::NEG_INFINITY { Found::Bound(found) } else { Found::Nothing };
        };
        let tolerance = goal.tolerance.unwrap_or(COARSE * bound.abs() + goal.least);
        let longest = region.map(Interval::width).into_iter().fold(0.0, f64::max);
        if bound - found <= tolerance || longest <= 0.5 * tolerance {
            return if bound > goal.far { Found::TooFar } else { Found::Bound(bound) };
        }
        if count >= goal.boxes {
            return Found::TooFar;
        }
        // Halving helps to show that the field is positive, or that the score is small. Every other time it is for the latter,
        // unless that is small already.
        let widths = region.map(Interval::width);
        let by_score = [0, 1, 2].map(|axis| {
            let mut thin = region;
            thin[axis] = Interval::point(region[axis].hi());
            let other = score(&thin).width();
            (score(&region).width() - other).max(0.0)
        });
        let is_score_wide = score(&region).width() > tolerance;
        let is_known = spread.into_iter().sum::<f64>() > 0.0 && spread.into_iter().all(f64::is_finite);
        let weight = match (depth % 2 == 0 && is_score_wide, is_known) {
            (true, _) => by_score,
            // Where nothing is known about the slopes, the longest edge decides.
            (false, true) => spread,
            (false, false) => widths,
        };
        match halves(region, weight) {
            Some(halves) => pending.extend(halves.map(|half| (half, depth + 1))),
            None => return Found::TooFar,
        }
    }
}
