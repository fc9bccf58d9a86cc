//! The number type a formula is generic over.
//!
//! A formula is written once, as a function over [`Scalar`], and instantiated with plain `f64`, SIMD lanes
//! ([`Lanes`]), outward-rounded intervals ([`Interval`]), dual numbers ([`Dual`], nested for second derivatives) and an
//! expression builder ([`crate::expr::Expr`]) that yields shader text.
//!
//! Two rules keep one definition valid for all of them. Constants enter through values (`x * 0.5`, `x.lift(0.5)`),
//! because lanes carry the proof that their instruction set exists and expressions carry their arena. Branches are
//! [`Scalar::select`], loops are [`Scalar::iterate`]; a formula never asks a scalar for a plain `bool`.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

mod dual;
mod interval;
mod intervals;
mod lanes;
mod real;
mod taylor;

pub use dual::Dual;
pub use interval::{Interval, Trilean};
pub use intervals::{Intervals, LaneTrilean};
pub(crate) use lanes::WIDEST;
pub use lanes::{LaneMask, Lanes};
pub use taylor::{DEGREE, Taylor};

/// The outcome of a comparison, one truth value for each lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {}

impl<M: Copy + BitAnd<Output = M> + BitOr<Output = M> + Not<Output = M>> Mask for M {}

/// A number a distance formula can be computed with.
pub trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// What a comparison of two scalars yields.
    type Mask: Mask;
    /// Where [`Constants`] are read from: a slice of numbers, or the place of shader parameters.
    type Table: ?Sized;

    /// Whether it stands for all numbers of a range. Formulas may then take more care, which others needn't.
    const IS_ENCLOSURE: bool = false;

    /// The constant `c`, as a scalar of the kind of `self`.
    fn lift(self, c: f64) -> Self;

    /// The entry `index` of a table of constants.
    fn constant(self, table: &Self::Table, index: usize) -> Self;

    /// `if self < rhs`.
    fn lt(self, rhs: Self) -> Self::Mask;

    /// `if mask { yes } else { no }`, lane by lane.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Whether any lane of the mask may be true: to leave the loop of [`Scalar::iterate`] early, or to pass over a long
    /// computation of which [`Scalar::select`] would take nothing.
    fn any(mask: Self::Mask) -> bool;

    /// The square root; the argument must not be negative.
    fn sqrt(self) -> Self;

    /// The absolute value; its derivative at 0 counts as +1.
    #[inline(always)]
    fn abs(self) -> Self {
        Self::select(self.lt(self.lift(0.0)), -self, self)
    }

    /// The smaller one; `rhs` where they are equal or not comparable.
    #[inline(always)]
    fn min(self, rhs: Self) -> Self {
        Self::select(self.lt(rhs), self, rhs)
    }

    /// The larger one; `rhs` where they are equal or not comparable.
    #[inline(always)]
    fn max(self, rhs: Self) -> Self {
        Self::select(rhs.lt(self), self, rhs)
    }

    /// `self * self`; never negative in any number type.
    #[inline(always)]
    fn square(self) -> Self {
        self * self
    }

    /// `sqrt(a^2 + b^2)`, with derivative 0 instead of 0/0 at the origin.
    #[inline(always)]
    fn length2(a: Self, b: Self) -> Self {
        (a.square() + b.square()).sqrt()
    }

    /// `sqrt(a^2 + b^2 + c^2)`, with derivative 0 instead of 0/0 at the origin.
    #[inline(always)]
    fn length3(a: Self, b: Self, c: Self) -> Self {
        (a.square() + b.square() + c.square()).sqrt()
    }

    /// The slope of a step function that has this value: 0, except that an enclosure over a step has any slope.
    #[inline(always)]
    fn step_slope(self) -> Self {
        self.lift(0.0)
    }

    /// 1 where `self < rhs`, otherwise 0: a step function.
    #[inline(always)]
    fn less(self, rhs: Self) -> Self {
        Self::select(self.lt(rhs), self.lift(1.0), self.lift(0.0))
    }

    /// The largest integer that is not larger; its derivative is 0 everywhere, except over the steps of an interval.
    fn floor(self) -> Self;

    /// The distance from the nearest even number: up from 0 to 1 and down again. Enclosures are as narrow as those of a
    /// continuous function can be, which no formula of [`Scalar::floor`] achieves.
    #[inline(always)]
    fn zigzag(self) -> Self {
        (self - ((self + self.lift(1.0)) * self.lift(0.5)).floor() * self.lift(2.0)).abs()
    }

    /// The same number computed in another way: enclosures keep what both have in common, all others the first.
    #[inline(always)]
    fn agreed(self, _other: Self) -> Self {
        self
    }

    /// What is left of an enclosure without its width: its middle, or its polynomial. All other numbers are that themselves.
    #[inline(always)]
    fn core(self) -> Self {
        self
    }

    /// An enclosure of `f(a, b)` from `self`, that of `f` for the [`core`](Scalar::core) of both, for an `f` that changes by no
    /// more than the larger change of its two arguments.
    #[inline(always)]
    fn around_core(self, _a: Self, _b: Self) -> Self {
        self
    }

    /// `(1 - share) a + share b`, for a share from 0 to 1. Enclosures know that both shares make 1.
    #[inline(always)]
    fn mix(a: Self, b: Self, share: Self) -> Self {
        a * (share.lift(1.0) - share) + b * share
    }

    /// The sine of an angle in radians; NaN at the infinities.
    fn sin(self) -> Self;

    /// The cosine of an angle in radians; NaN at the infinities.
    fn cos(self) -> Self;

    /// Sine and cosine of one angle, cheaper than both by themselves.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }

    /// The tangent of an angle in radians; NaN at the infinities.
    fn tan(self) -> Self;

    /// The angle in `[-π/2, π/2]` with this sine; NaN outside `[-1, 1]`.
    fn asin(self) -> Self;

    /// The angle in `[0, π]` with this cosine; NaN outside `[-1, 1]`.
    fn acos(self) -> Self;

    /// The angle in `[-π/2, π/2]` with this tangent.
    fn atan(self) -> Self;

    /// The angle in `[-π, π]` of the vector `(x, self)` against the x axis: `y.atan2(x)`. Defined at the origin too, by the
    /// signs of the zeros as in IEEE 754, with derivative 0.
    fn atan2(self, x: Self) -> Self;

    /// `e^self`.
    fn exp(self) -> Self;

    /// The natural logarithm; -∞ at 0, NaN below.
    fn ln(self) -> Self;

    /// `self^exponent`, as `pow` of IEEE 754: 1 for the exponent 0 (also of 0 and NaN) and for the base 1; a negative base
    /// has powers with integer exponents only, NaN otherwise.
    ///
    /// The derivative by the exponent counts as 0 where the base is not positive, the one by the base where it is infinite
    /// (at base 0 below exponent 1).
    fn pow(self, exponent: Self) -> Self;

    /// `self^n` by repeated squaring, a reciprocal for negative `n`; 1 for `n = 0`.
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        match repeated_squaring(self, n.unsigned_abs()) {
            None => self.lift(1.0),
            Some(power) if n < 0 => self.lift(1.0) / power,
            Some(power) => power,
        }
    }

    /// `self` limited to `[low, high]`.
    #[inline(always)]
    fn clamp(self, low: f64, high: f64) -> Self {
        self.max(self.lift(low)).min(self.lift(high))
    }

    /// Applies `step` to `state` at most `limit` times. `step` returns the next state and whether to go on; a lane that
    /// says no keeps that state while others continue.
    ///
    /// Write the step as `#[inline(always)] |state| ...`: a step that is not inlined loses the instruction set.
    #[inline(always)]
    fn iterate<const N: usize>(
        limit: u32,
        mut state: [Self; N],
        step: impl Fn([Self; N]) -> ([Self; N], Self::Mask),
    ) -> [Self; N] {
        let mut running: Option<Self::Mask> = None;
        for _ in 0..limit {
            let (next, go_on) = step(state);
            running = Some(match running {
                None => {
                    state = next;
                    go_on
                }
                Some(active) => {
                    for (s, n) in state.iter_mut().zip(next) {
                        *s = Self::select(active, n, *s);
                    }
                    active & go_on
                }
            });
            if running.is_some_and(|active| !Self::any(active)) {
                break;
            }
        }
        state
    }

    /// Applies `step` to `state` once for each row of `width` constants, in order: for formulas of lists. In shaders it becomes a
    /// loop, so that the text does not grow with the list.
    ///
    /// Write the step as `#[inline(always)] |state, row| ...`: a step that is not inlined loses the instruction set.
    #[inline(always)]
    fn fold_rows<const N: usize>(
        constants: &Constants<'_, Self>,
        width: usize,
        mut state: [Self; N],
        step: impl Fn([Self; N], &Constants<'_, Self>) -> [Self; N],
    ) -> [Self; N] {
        let mut first = 0;
        while first + width <= constants.count() {
            state = step(state, &constants.part(first, width));
            first += width;
        }
        state
    }

    /// Applies `step` to `state` for the rows in the leaves of a tree, in order, but may pass over those below a node whose `bound`
    /// is not below `state[0]`: there the step may not change anything.
    ///
    /// Write both functions as `#[inline(always)] |...| ...`: what is not inlined loses the instruction set.
    #[inline(always)]
    fn fold_tree<const N: usize>(
        constants: &Constants<'_, Self>,
        tree: Tree,
        mut state: [Self; N],
        bound: impl Fn(&Constants<'_, Self>) -> Self,
        step: impl Fn([Self; N], &Constants<'_, Self>) -> [Self; N],
    ) -> [Self; N] {
        let leaves = tree.leaves(constants.count());
        let mut node = 1;
        loop {
            if Self::any(bound(&tree.node_of(constants, node)).lt(state[0])) {
                if node < leaves {
                    node *= 2;
                    continue;
                }
                state = tree.fold_rows(
                    constants,
                    node,
                    state,
                    #[inline(always)]
                    |state, row| step(state, row),
                );
            }
            // What follows all below this node: its sibling, or that of the nearest node above that is a left one.
            node += 1;
            node >>= node.trailing_zeros();
            if node == 1 {
                return state;
            }
        }
    }

    /// Applies `step` to `state` for the rows of one leaf of a tree: where bounds are low, as far as one can see from above.
    ///
    /// Write both functions as `#[inline(always)] |...| ...`: what is not inlined loses the instruction set.
    #[inline(always)]
    fn fold_leaf<const N: usize>(
        constants: &Constants<'_, Self>,
        tree: Tree,
        state: [Self; N],
        bound: impl Fn(&Constants<'_, Self>) -> Self,
        step: impl Fn([Self; N], &Constants<'_, Self>) -> [Self; N],
    ) -> [Self; N] {
        let leaves = tree.leaves(constants.count());
        let mut node = 1;
        while node < leaves {
            // One by one: a function of the standard library between would lose the instruction set.
            let left = bound(&tree.node_of(constants, 2 * node));
            let right = bound(&tree.node_of(constants, 2 * node + 1));
            node = 2 * node + usize::from(Self::any(right.lt(left)));
        }
        tree.fold_rows(constants, node, state, step)
    }

    /// The least `value` of all rows in the leaves of a tree, which is below `most`; none is less than the `bound` of a node above
    /// it. Of several that are the least, it is the first one, wherever that makes a difference: `raised` is a number above its
    /// argument, by so much that a row of that value is found once more.
    ///
    /// Write all functions as `#[inline(always)] |...| ...`: what is not inlined loses the instruction set.
    #[inline(always)]
    fn least_in_tree(
        constants: &Constants<'_, Self>,
        tree: Tree,
        most: Self,
        bound: impl Fn(&Constants<'_, Self>) -> Self,
        value: impl Fn(&Constants<'_, Self>) -> Self,
        raised: impl Fn(Self) -> Self,
    ) -> Self {
        let [near] = Self::fold_leaf(
            constants,
            tree,
            [most],
            #[inline(always)]
            |node| bound(node),
            #[inline(always)]
            |[least], row| [value(row).min(least)],
        );
        let [least] = Self::fold_tree(
            constants,
            tree,
            [raised(near)],
            #[inline(always)]
            |node| bound(node),
            #[inline(always)]
            |[least], row| [value(row).min(least)],
        );
        least
    }

    /// The coordinates of that point in a tree of points, as `point_set` has it, which is nearest to `p`; of several
    /// any one. `None` of scalars that can't be searched for by themselves, such as enclosures.
    #[inline(always)]
    fn nearest_row(p: [Self; 3], constants: &Constants<'_, Self>) -> Option<[Self; 3]> {
        let _ = (p, constants);
        None
    }
}

/// How a complete binary tree lies among constants. Its `n` leaves are the nodes `n` to `2 n - 1`; below node `i` before them are
/// `2 i` and `2 i + 1`. The constants of the nodes come first, in order, in the place of node 0 (which is none) what else the
/// formula needs, and then the rows of each leaf.
#[derive(Clone, Copy, Debug)]
pub struct Tree {
    /// How many constants a node has.
    pub node: usize,
    /// How many constants a row in a leaf has.
    pub row: usize,
    /// How many rows a leaf has.
    pub leaf: usize,
}

impl Tree {
    /// Which constant is the number of leaves, for those who can't count constants.
    pub const LEAVES: usize = 0;

    /// How many leaves a tree has that takes so many constants.
    #[inline(always)]
    pub fn leaves(self, constants: usize) -> usize {
        constants / (2 * self.node + self.leaf * self.row)
    }

    #[inline(always)]
    fn node_of<'t, S: Scalar>(self, constants: &Constants<'t, S>, node: usize) -> Constants<'t, S> {
        constants.part(self.node * node, self.node)
    }

    /// Applies `step` to `state` for each row of the leaf that is this node.
    #[inline(always)]
    fn fold_rows<S: Scalar, const N: usize>(
        self,
        constants: &Constants<'_, S>,
        node: usize,
        mut state: [S; N],
        step: impl Fn([S; N], &Constants<'_, S>) -> [S; N],
    ) -> [S; N] {
        let leaves = self.leaves(constants.count());
        let mut first = 2 * leaves * self.node + (node - leaves) * self.leaf * self.row;
        let end = first + self.leaf * self.row;
        while first < end {
            state = step(state, &constants.part(first, self.row));
            first += self.row;
        }
        state
    }
}

/// `x^n`, or nothing for `n = 0`.
#[inline(always)]
fn repeated_squaring<S: Scalar>(x: S, n: u32) -> Option<S> {
    let (mut square, mut power, mut bits) = (x, None, n);
    while bits != 0 {
        if bits & 1 == 1 {
            power = Some(match power {
                None => square,
                Some(power) => square * power,
            });
        }
        bits >>= 1;
        if bits != 0 {
            square = square.square();
        }
    }
    power
}

/// The constants of one node: what its parameters were turned into by its `prepare` function.
pub struct Constants<'t, S: Scalar> {
    like: S,
    table: &'t S::Table,
    first: usize,
    len: usize,
}

impl<'t, S: Scalar<Table = [f32]>> Constants<'t, S> {
    /// As plain numbers.
    #[inline(always)]
    pub(crate) fn slice(&self) -> &'t [f32] {
        &self.table[self.first..][..self.len]
    }
}

impl<'t, S: Scalar> Constants<'t, S> {
    /// The first `len` entries of `table`, read as scalars of the kind of `like`.
    #[inline(always)]
    pub fn new(like: S, table: &'t S::Table, len: usize) -> Self {
        Self { like, table, first: 0, len }
    }

    /// Some of them: `len` from `first` on.
    #[inline(always)]
    pub fn part(&self, first: usize, len: usize) -> Self {
        Self { first: self.first + first, len, ..*self }
    }

    /// Where they are read from, and which of its entries is the first one.
    pub(crate) fn origin(&self) -> (&'t S::Table, usize) {
        (self.table, self.first)
    }

    /// How many there are. Fixed for most shapes; lists have as many as the user wrote.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.len
    }

    /// The constant at `index`.
    #[inline(always)]
    pub fn at(&self, index: usize) -> S {
        self.like.constant(self.table, self.first + index)
    }

    /// The first `N` constants.
    #[inline(always)]
    pub fn get<const N: usize>(&self) -> [S; N] {
        let mut out = [self.like; N];
        let mut index = 0;
        while index < N {
            out[index] = self.at(index);
            index += 1;
        }
        out
    }
}
