//! Bounds on a program's slope over a box, found without help from the user.
//!
//! A value's gradient is enclosed twice: in a box, component by component, by interval arithmetic on its derivatives, and
//! in a ball, by the largest slopes of primitives and the triangle inequality. The box is narrow for formulas, whose terms
//! cancel; the ball is narrow for distances, whose direction is not known. The largest norm over a region follows from a
//! subdivision of it: the part with the largest bound is split until that bound comes near a slope that the field really has
//! (interval branch and bound; Hansen and Walster, "Global Optimization Using Interval Analysis", 2004).

use crate::formula::{Binary, Unary};
use crate::mix;
use crate::operation::{Run, Step, StepId, Steps};
use crate::program::Program;
use crate::scalar::{Constants, Dual, Interval, Scalar};
use crate::shape::{MapTable, Settled};
use crate::vector::{Vec3, spectral_norm};
use glam::DMat3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A bound this near to a slope that was found is good enough: a step is then at most a fifth shorter than it could be.
const GOOD_ENOUGH: f64 = 1.25;

/// Into how many parts a region is divided at most: some ten milliseconds with a formula of fifty terms.
const MOST_PARTS: usize = 2048;

impl Program {
    /// An upper bound of the size of the field's gradient over a box, in the coordinates of the world: no difference quotient
    /// between two points of the box is larger. It is at most 1.25 times the largest, unless the field is so intricate
    /// there that the search stops early. `None` if no finite bound is found, for instance around a step or a cusp.
    pub fn lipschitz_over(&self, region: [Interval; 3]) -> Option<f64> {
        self.lipschitz_where(region, |_| true)
    }

    /// As [`Program::lipschitz_over`], for a convex part of a box. `meets` says whether a smaller box, which may be a
    /// point, may have something in common with that part.
    pub(crate) fn lipschitz_where(&self, region: [Interval; 3], meets: impl Fn(&[Interval; 3]) -> bool) -> Option<f64> {
        let mut parts = BinaryHeap::new();
        let mut sloper = Sloper::new(self, &self.whole().steps);
        let mut steepest = 0.0_f64;
        let mut pending = vec![(region, self.lipschitz().unwrap_or(f64::INFINITY))];
        let mut count = 0;
        loop {
            for (region, above) in pending.drain(..) {
                if !meets(&region) {
                    continue;
                }
                let middle = region.map(Interval::middle);
                if meets(&middle.map(Interval::point)) {
                    let slope = self.gradient(middle.into()).1.length();
                    // A slope that is not finite says nothing about how near the bounds are.
                    steepest = if slope.is_finite() { steepest.max(slope) } else { steepest };
                }
                parts.push(Part { bound: sloper.bound(region).min(above), region });
                count += 1;
            }
            let Some(Part { bound, region }) = parts.pop() else {
                return Some(0.0);
            };
            let halves = halves(region, region.map(Interval::width))
                .filter(|_| count < MOST_PARTS && bound > GOOD_ENOUGH * steepest);
            let Some(halves) = halves else {
                return bound.is_finite().then_some(bound);
            };
            pending.extend(halves.map(|half| (half, bound)));
        }
    }
}

/// A part of a region, ordered by the bound over it.
pub(crate) struct Part {
    pub(crate) bound: f64,
    pub(crate) region: [Interval; 3],
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

/// Both halves of a box across the axis of the largest weight, unless it is too short for that.
pub(crate) fn halves(region: [Interval; 3], weight: [f64; 3]) -> Option<[[Interval; 3]; 2]> {
    let axis = (0..3).fold(0, |best, axis| if weight[axis] > weight[best] { axis } else { best });
    let (lo, middle, hi) = (region[axis].lo(), region[axis].middle(), region[axis].hi());
    if !(lo < middle && middle < hi) {
        return None;
    }
    let half = |lo, hi| {
        let mut half = region;
        half[axis] = Interval::new(lo, hi);
        half
    };
    Some([half(lo, middle), half(middle, hi)])
}

/// A value over a box, and two enclosures of its gradient.
#[derive(Clone, Copy)]
struct Sloped {
    value: Interval,
    gradient: [Interval; 3],
    /// The gradient is no longer than this.
    norm: f64,
}

/// The points that a box is mapped to, and the Jacobian matrix of the map.
#[derive(Clone, Copy)]
struct Mapped {
    point: [Interval; 3],
    /// The gradients of the coordinates.
    rows: [[Interval; 3]; 3],
    /// The spectral norm of the matrix is no larger than this.
    norm: f64,
}

const ZERO: [Interval; 3] = [Interval::ZERO; 3];

impl Sloped {
    const CONSTANT: Self = Self { value: Interval::ZERO, gradient: ZERO, norm: 0.0 };

    fn new(value: Interval, gradient: [Interval; 3], norm: f64) -> Self {
        Self { value, gradient, norm: norm.min(length(gradient)) }
    }

    /// A function of this value, by its value and slope.
    fn chain(self, of: Dual<Interval, 1>) -> Self {
        let [slope] = of.gradient;
        Self::new(of.value, self.gradient.map(|g| times(slope, g)), times_up(slope.abs().hi(), self.norm))
    }

    /// A function of two values, by its value and slopes.
    fn chain2(self, rhs: Self, of: Dual<Interval, 2>) -> Self {
        let [by_self, by_rhs] = of.gradient;
        let gradient = std::array::from_fn(|i| plus(times(by_self, self.gradient[i]), times(by_rhs, rhs.gradient[i])));
        let norm = times_up(by_self.abs().hi(), self.norm) + times_up(by_rhs.abs().hi(), rhs.norm);
        Self::new(of.value, gradient, norm.next_up())
    }

    /// One of two values, of which is not known.
    fn either(self, rhs: Self, value: Interval) -> Self {
        let gradient = std::array::from_fn(|i| self.gradient[i].hull(rhs.gradient[i]));
        Self::new(value, gradient, self.norm.max(rhs.norm))
    }
}

impl Mapped {
    /// The point with these values as its coordinates.
    fn at(values: [Sloped; 3]) -> Self {
        let rows = values.map(|value| value.gradient);
        let norms = length(values.map(|value| Interval::point(value.norm)));
        Self { point: values.map(|value| value.value), rows, norm: matrix_norm(&rows).min(norms) }
    }
}

/// Computes bounds for one box after another.
pub(crate) struct Sloper<'p> {
    program: &'p Program,
    steps: &'p Steps,
    points: Vec<Mapped>,
    values: Vec<Sloped>,
}

impl<'p> Sloper<'p> {
    pub(crate) fn new(program: &'p Program, steps: &'p Steps) -> Self {
        Self { program, steps, points: Vec::new(), values: Vec::new() }
    }

    /// The largest slope over a box.
    pub(crate) fn bound(&mut self, region: [Interval; 3]) -> f64 {
        self.enclose(region).map_or(0.0, |result| result.norm)
    }

    /// The values over a box, and by how much each axis makes them vary. The values come from intervals, and from the value
    /// in the middle and the gradient (the mean value form), which is the better enclosure in small boxes.
    pub(crate) fn survey(&mut self, region: [Interval; 3]) -> (Interval, [f64; 3]) {
        let Some(Sloped { value, gradient, norm }) = self.enclose(region) else {
            return (Interval::new(f64::INFINITY, f64::INFINITY), [0.0; 3]);
        };
        let spread = std::array::from_fn(|axis| gradient[axis].abs().hi() * region[axis].width());
        if !value.contains(0.0) || !norm.is_finite() {
            return (value, spread);
        }
        let middle = region.map(|side| Interval::point(side.middle()));
        let offsets: [Interval; 3] = std::array::from_fn(|axis| region[axis] - middle[axis]);
        let by_box = (0..3).fold(Interval::ZERO, |sum, axis| plus(sum, times(gradient[axis], offsets[axis])));
        let by_ball = times_up(norm, length(offsets));
        let drift = by_box.meet(Interval::new(-by_ball, by_ball));
        let center = self.enclose(middle).map_or(value, |center| center.value);
        (value.meet(center + drift), spread)
    }

    /// The value and slope over a box; nothing if there is nothing.
    fn enclose(&mut self, region: [Interval; 3]) -> Option<Sloped> {
        let steps = self.steps;
        let result = steps.result?;
        let rows = std::array::from_fn(|i| std::array::from_fn(|j| Interval::point(if i == j { 1.0 } else { 0.0 })));
        let root = Mapped { point: region, rows, norm: 1.0 };
        self.points.clear();
        self.values.clear();
        for step in &steps.list {
            let point = self.point(step).unwrap_or(root);
            let value = self.value(step, &steps.list);
            self.points.push(point);
            self.values.push(value);
        }
        Some(self.values[result.index()])
    }

    /// The point that a step yields, if it is another one than the first.
    fn point(&self, step: &Step) -> Option<Mapped> {
        let (from, constants) = match *step {
            Step::Affine { from, constants } => (from, constants),
            Step::Map { table, from, at, constants } => return Some(self.mapped(table, from, at, constants)),
            Step::Warp { x, y, z } => return Some(Mapped::at([x, y, z].map(|id| self.values[id.index()]))),
            _ => return None,
        };
        let from = &self.points[from.index()];
        let table = self.constants(constants);
        let matrix = DMat3::from_cols_slice(table);
        let row = |i: usize, of: [Interval; 3]| {
            (0..3).fold(Interval::ZERO, |sum, j| plus(sum, times(Interval::point(matrix.col(j)[i]), of[j])))
        };
        let point = std::array::from_fn(|i| row(i, from.point) + table[9 + i]);
        let column = |k: usize| [0, 1, 2].map(|j| from.rows[j][k]);
        let rows = std::array::from_fn(|i| std::array::from_fn(|k| row(i, column(k))));
        let norm = matrix_norm(&rows).min(times_up(table[12], from.norm));
        Some(Mapped { point, rows, norm })
    }

    /// The points that a map takes a box to.
    fn mapped(&self, table: &MapTable, from: StepId, at: Run, constants: Run) -> Mapped {
        let from = &self.points[from.index()];
        let (at, constants) = (self.constants(at), self.constants(constants));
        let input = |axis: usize| Dual {
            value: from.point[axis] - Interval::point(at[axis]),
            gradient: std::array::from_fn(|other| Interval::point(if other == axis { 1.0 } else { 0.0 })),
        };
        let p = Vec3 { x: input(0), y: input(1), z: input(2) };
        let q = (table.kernels.slope)(p, &Constants::new(p.x, constants, constants.len()));
        let own = [q.x.gradient, q.y.gradient, q.z.gradient];
        let norm = if table.is_short { matrix_norm(&own).min(1.0) } else { matrix_norm(&own) };
        let norm = times_up(norm, from.norm);
        let row = |i: usize, k: usize| {
            let sum = (0..3).fold(Interval::ZERO, |sum, j| plus(sum, times(own[i][j], from.rows[j][k])));
            // No entry is larger than the norm, whatever became of derivatives at corners.
            sum.meet(symmetric(norm))
        };
        let rows = std::array::from_fn(|i| std::array::from_fn(|k| row(i, k)));
        let norm = matrix_norm(&rows).min(norm);
        Mapped { point: [q.x.value, q.y.value, q.z.value], rows, norm }
    }

    fn value(&self, step: &Step, list: &[Step]) -> Sloped {
        let at = |id: StepId| self.values[id.index()];
        match *step {
            Step::Point | Step::Affine { .. } | Step::Map { .. } | Step::Warp { .. } => Sloped::CONSTANT,
            Step::Primitive { table, point, at, constants, slope, .. } => {
                let Mapped { point, rows, norm } = self.points[point.index()];
                let slope = self.program.double[slope as usize];
                let at = self.constants(at);
                let constants = self.constants(constants);
                let distance = |p: [Interval; 3]| {
                    let p = Vec3::from(p) - [0, 1, 2].map(|axis| Interval::point(at[axis])).into();
                    (table.kernels.interval)(p, &Constants::new(p.x, constants, constants.len()))
                };
                let mut value = distance(point);
                if slope.is_finite() {
                    let middle = point.map(|side| Interval::point(side.middle()));
                    let radius = length(std::array::from_fn(|axis| point[axis] - middle[axis])) * slope;
                    if radius.is_finite() {
                        let radius = radius.next_up();
                        value = value.meet(distance(middle) + Interval::new(-radius, radius));
                    }
                }
                // Whatever its direction, a gradient in the mapped space enters by a column of the Jacobian matrix.
                let gradient = [0, 1, 2].map(|axis| symmetric(times_up(slope, length(rows.map(|row| row[axis])))));
                Sloped { value, gradient, norm: times_up(slope, norm) }
            }
            Step::Combine { table, a, b, constants } => {
                // The slopes by both operands are shares that make 1.
                let (a, b) = (at(a), at(b));
                let constants = self.constants(constants);
                let value =
                    (table.kernels.interval)(a.value, b.value, &Constants::new(a.value, constants, constants.len()));
                match (table.settle)(a.value, b.value, constants) {
                    Settled::Open => {
                        let size = |axis: usize| a.gradient[axis].abs().hi().max(b.gradient[axis].abs().hi());
                        let gradient = [0, 1, 2].map(|axis| symmetric(size(axis)));
                        Sloped { value, gradient, norm: a.norm.max(b.norm) }
                    }
                    Settled::First => Sloped { value, ..a },
                    Settled::Second => Sloped { value, ..b },
                    Settled::NotSecond => Sloped { value, gradient: b.gradient.map(|side| -side), norm: b.norm },
                }
            }
            Step::Mix { a, b, height, constants } => {
                let (a, b, height) = (at(a), at(b), at(height));
                let constants = self.constants(constants);
                let input = Dual { value: height.value, gradient: [Interval::point(1.0)] };
                let share = height.chain(mix::share(input, &Constants::new(input, constants, constants.len())));
                let gap = b.value - a.value;
                let slope = |axis: usize| {
                    let of_values = Interval::mix(a.gradient[axis], b.gradient[axis], share.value);
                    plus(of_values, times(gap, share.gradient[axis]))
                };
                let norm = a.norm.max(b.norm) + times_up(gap.abs().hi(), share.norm);
                Sloped::new(Interval::mix(a.value, b.value, share.value), [0, 1, 2].map(slope), norm.next_up())
            }
            Step::Modify { table, from, constants } => {
                let from = at(from);
                let constants = self.constants(constants);
                let input = Dual { value: from.value, gradient: [Interval::point(1.0)] };
                from.chain((table.kernels.slope)(input, &Constants::new(input, constants, constants.len())))
            }
            Step::Scale { from, factor } => {
                let (from, factor) = (at(from), Interval::point(self.program.double[factor as usize]));
                from.chain(Dual { value: from.value * factor, gradient: [factor] })
            }
            Step::Coordinate { point, axis, at } => {
                let (point, axis) = (&self.points[point.index()], usize::from(axis));
                Sloped::new(point.point[axis] - self.constants(at)[axis], point.rows[axis], point.norm)
            }
            Step::Literal { constant } => {
                Sloped { value: Interval::point(self.program.double[constant as usize]), ..Sloped::CONSTANT }
            }
            Step::Unary { op: Unary::Sqrt, from } => self.root(from, list),
            Step::Unary { op, from } => unary(at(from), |x| op.apply(x)),
            Step::Binary { op, a, b } | Step::Altered { op, from: a, by: b } => binary(op, at(a), at(b)),
            Step::Power { from, exponent } => unary(at(from), |x| x.powi(exponent)),
            Step::Surface { from, .. } => at(from),
        }
    }

    /// The square root of a value. Where that is a sum of squares, it is a length, whose slope stays finite at 0.
    fn root(&self, from: StepId, list: &[Step]) -> Sloped {
        let mut sides = [StepId::POINT; 3];
        let Some(count) = squares(from, list, &mut sides) else {
            return unary(self.values[from.index()], Scalar::sqrt);
        };
        let sides: [Sloped; 3] = std::array::from_fn(|i| match i < count {
            true => self.values[sides[i].index()],
            false => Sloped::CONSTANT,
        });
        let [x, y, z] = sides.map(|side| side.value);
        let value = Interval::length3(x, y, z);
        // The slopes by the sides are the components of a unit vector.
        let shares = sides.map(|side| match value.lo() > 0.0 {
            true => (side.value / value).clamp(-1.0, 1.0),
            false => Interval::new(-1.0, 1.0),
        });
        let gradient = [0, 1, 2]
            .map(|axis| (0..3).fold(Interval::ZERO, |sum, i| plus(sum, times(shares[i], sides[i].gradient[axis]))));
        let norms = length(sides.map(|side| Interval::point(side.norm)));
        Sloped::new(value, gradient, matrix_norm(&sides.map(|side| side.gradient)).min(norms))
    }

    fn constants(&self, run: Run) -> &'p [f64] {
        &self.program.double[run.range()]
    }
}

/// Collects what is squared in a sum of at most three squares, and returns how many there are.
fn squares(sum: StepId, list: &[Step], sides: &mut [StepId; 3]) -> Option<usize> {
    match list[sum.index()] {
        Step::Unary { op: Unary::Square, from } => {
            sides[0] = from;
            Some(1)
        }
        Step::Binary { op: Binary::Add, a, b } => {
            let (mut left, mut right) = (*sides, *sides);
            let (m, n) = (squares(a, list, &mut left)?, squares(b, list, &mut right)?);
            if m + n > sides.len() {
                return None;
            }
            sides[..m].copy_from_slice(&left[..m]);
            sides[m..m + n].copy_from_slice(&right[..n]);
            Some(m + n)
        }
        _ => None,
    }
}

/// A function of one value.
fn unary(from: Sloped, f: impl Fn(Dual<Interval, 1>) -> Dual<Interval, 1>) -> Sloped {
    from.chain(f(Dual { value: from.value, gradient: [Interval::point(1.0)] }))
}

/// A function of two values.
fn binary(op: Binary, a: Sloped, b: Sloped) -> Sloped {
    if let Binary::Min | Binary::Max = op {
        let (lesser, greater) = if op == Binary::Min { (a, b) } else { (b, a) };
        return if lesser.value.hi() < greater.value.lo() {
            a
        } else if greater.value.hi() < lesser.value.lo() {
            b
        } else {
            a.either(b, op.apply(a.value, b.value))
        };
    }
    let input = |value, gradient: [f64; 2]| Dual { value, gradient: gradient.map(Interval::point) };
    a.chain2(b, op.apply(input(a.value, [1.0, 0.0]), input(b.value, [0.0, 1.0])))
}

/// An upper bound of the spectral norm of all matrices with rows in these.
///
/// The smaller one of two: the norm of the matrix in the middle and the Frobenius norm of the largest difference from it,
/// which is good where the entries vary little; and the root of the largest sum of sizes along a row of M M^T, which needs no
/// middle.
pub(crate) fn matrix_norm(rows: &[[Interval; 3]; 3]) -> f64 {
    let dot = |a: [Interval; 3], b: [Interval; 3]| (0..3).fold(Interval::ZERO, |sum, i| plus(sum, times(a[i], b[i])));
    let square = |a: [Interval; 3]| (0..3).fold(Interval::ZERO, |sum, i| plus(sum, a[i].square()));
    let entry = |i: usize, j: usize| if i == j { square(rows[i]) } else { dot(rows[i], rows[j]) };
    let row = |i: usize| (0..3).fold(Interval::ZERO, |sum, j| plus(sum, entry(i, j).abs()));
    let by_product = [0, 1, 2].map(|i| row(i).hi()).into_iter().fold(0.0, f64::max);
    let by_product = Interval::point(by_product).sqrt().hi();
    let middle = rows.map(|row| row.map(Interval::middle));
    let transposed = DMat3::from_cols_array_2d(&middle);
    if !transposed.is_finite() {
        return by_product;
    }
    let off = |i: usize| length(std::array::from_fn(|j| rows[i][j] - middle[i][j]));
    let by_middle = (spectral_norm(transposed) + length([0, 1, 2].map(|i| Interval::point(off(i))))).next_up();
    if by_middle < by_product { by_middle } else { by_product }
}

/// All numbers of at most this size.
fn symmetric(size: f64) -> Interval {
    if size.is_finite() { Interval::new(-size, size) } else { Interval::ENTIRE }
}

/// An upper bound of the length of all vectors in a box.
fn length([x, y, z]: [Interval; 3]) -> f64 {
    Interval::length3(x, y, z).hi()
}

/// The product, without trouble from what is 0 times something unknown.
fn times(a: Interval, b: Interval) -> Interval {
    if a == Interval::ZERO || b == Interval::ZERO { Interval::ZERO } else { a * b }
}

/// The sum. Zeros leave the other number as it is.
fn plus(a: Interval, b: Interval) -> Interval {
    match (a == Interval::ZERO, b == Interval::ZERO) {
        (true, _) => b,
        (_, true) => a,
        _ => a + b,
    }
}

/// The product of two sizes, rounded up.
fn times_up(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        0.0
    } else if a == 1.0 || b == 1.0 {
        a * b
    } else {
        (a * b).next_up()
    }
}
