//! The traits that functions are written in.

use super::{About, MapTable, Shape};
use crate::contract::{Contract, Dimension};
use crate::kernel::PrimitiveKernel;
use crate::scalar::{Constants, Interval, Scalar};
use crate::vector::Vec3;
use glam::{DAffine3, DVec3};
use std::ops::Range;

/// A field made from nothing but parameters.
pub trait Primitive: 'static {
    /// Description and parameters.
    const ABOUT: About;

    /// Whether its values are much smaller than the distance almost everywhere, so that rays do well to step farther and
    /// to make sure afterwards that they missed nothing.
    const IS_LOOSE: bool = false;

    /// Whether it is a body, or a figure in the plane of x and y, whose formula does not look at z and whose support along z
    /// is infinite.
    const DIMENSION: Dimension = Dimension::Space;

    /// A fault that no single parameter shows, as a sentence.
    ///
    /// # Errors
    /// The fault.
    fn check(_args: &[f64]) -> Result<(), String> {
        Ok(())
    }

    /// The constants of the formula, from parameters that passed all checks.
    fn prepare(args: &[f64]) -> Vec<f64> {
        args.to_vec()
    }

    /// How many constants each of several parts has, if the field is the minimum of these in value and contract: each is then
    /// computed by itself, and where it can't matter not at all. Those of a part follow one another in [`Primitive::prepare`].
    fn parts(_args: &[f64]) -> Vec<usize> {
        Vec::new()
    }

    /// What is known about the field, apart from its extent.
    fn contract(_args: &[f64]) -> Contract {
        Contract::EXACT
    }

    /// The largest value of `direction . p` over all `p` where the field is at most `level`, or an upper bound of it;
    /// infinite for an unbounded shape. `level` is 0 for the shape itself and above 0 for the shape grown by operators.
    fn support(args: &[f64], direction: DVec3, level: f64) -> f64;

    /// The shape in a form that rays are intersected with exactly, if it has one and rays profit.
    fn exact_form(_args: &[f64]) -> Option<ExactForm> {
        None
    }

    /// The kernel for Taylor models, [`crate::kernel::primitive_models`] of this primitive. It is worth its build time for
    /// what formulas are combined with and cut to; without it a model is the value in the middle, give or take the slope.
    const MODELS: Option<PrimitiveKernel> = None;

    /// The formula. Write `#[inline(always)]` before it: a formula that is not inlined loses the instruction set.
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S;
}

/// A primitive that is another one with certain arguments, which it is computed by: it needs no kernels of its own.
pub trait Special: 'static {
    /// The primitive that it is a case of.
    type General: Primitive;

    /// Description and parameters.
    const ABOUT: About;

    /// A fault that no single parameter shows, as a sentence.
    ///
    /// # Errors
    /// The fault.
    fn check(_args: &[f64]) -> Result<(), String> {
        Ok(())
    }

    /// The arguments of the general primitive, from parameters that passed all checks: sound ones.
    fn general(args: &[f64]) -> Vec<f64>;
}

/// The support of a plane figure: `flat` of the direction's length in the plane, or infinite if it leads out of the plane.
pub(crate) fn in_plane(direction: DVec3, flat: impl FnOnce(f64) -> f64) -> f64 {
    if direction.z == 0.0 { flat(libm::hypot(direction.x, direction.y)) } else { f64::INFINITY }
}

/// A surface that rays are intersected with in closed form. Normals have length 1; offsets are along them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "described above")]
pub enum ExactForm {
    /// Everything behind a plane.
    HalfSpace { normal: DVec3, offset: f64 },
    /// A plane without thickness.
    Sheet { normal: DVec3, offset: f64 },
}

/// Several fields made into one, folded from left to right.
pub trait Combine: 'static {
    /// Description and parameters.
    const ABOUT: About;

    /// Whether folding is the plain minimum, which the evaluator fuses with primitives.
    const IS_MINIMUM: bool = false;

    /// The constants of the formula.
    fn prepare(args: &[f64]) -> Vec<f64> {
        args.to_vec()
    }

    /// The contract of one fold step.
    ///
    /// # Errors
    /// Why these two can't be combined, as a sentence.
    fn contract(args: &[f64], a: Contract, b: Contract) -> Result<Contract, String>;

    /// What the combination comes to where its operands have values in these ranges. `constants` are those of the formula.
    fn settle(_a: Interval, _b: Interval, _constants: &[f64]) -> Settled {
        Settled::Open
    }

    /// How the support of the result follows from those of the operands; see [`Primitive::support`].
    const HULL: Hull;

    /// The level that `count` operands reach wherever their combination is at most `level`: at least one of them, or all of
    /// them, or the first, as [`Combine::HULL`] says.
    fn level(_args: &[f64], level: f64, _count: usize) -> f64 {
        level
    }

    /// The formula. Write `#[inline(always)]` before it: a formula that is not inlined loses the instruction set.
    fn combine<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S;

    /// The share of `b` in the result's material, in `[0, 1]`: the size of the partial derivative of
    /// [`Combine::combine`] by `b`. The rest is `a`'s.
    fn share<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S;
}

/// What a combination comes to where only one of its operands matters: exactly that operand, in value and in material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settled {
    /// Both may matter.
    Open,
    /// It is the first operand.
    First,
    /// It is the second operand.
    Second,
    /// It is the second operand with its sign turned.
    NotSecond,
}

impl Settled {
    /// Which of two operands is always less than the other by more than `reach`.
    pub fn lesser(a: Interval, b: Interval, reach: f64) -> Self {
        if a.hi() + reach < b.lo() {
            Self::First
        } else if b.hi() + reach < a.lo() {
            Self::Second
        } else {
            Self::Open
        }
    }
}

/// An affine map of space.
pub trait Place: 'static {
    /// Description and parameters.
    const ABOUT: About;

    /// The map from the child's space to the parent's.
    fn map(args: &[f64]) -> DAffine3;

    /// Whether the map never changes a distance, whatever its parameters.
    const IS_RIGID: bool = true;

    /// Whether the map is a translation, whatever its parameters.
    const IS_TRANSLATION: bool = false;

    /// What the child's distance is multiplied with: the smallest factor by which the map stretches a length.
    fn factor(_args: &[f64]) -> f64 {
        1.0
    }

    /// Whether the map stretches all directions alike, so that exact distances stay exact.
    fn is_similarity(_args: &[f64]) -> bool {
        true
    }
}

/// What a [`Map`]'s child reaches: its support in a direction, see [`Primitive::support`].
pub type Supports<'a> = &'a dyn Fn(DVec3) -> f64;

/// A map of the points at which the child is looked up.
pub trait Map: 'static {
    /// Description and parameters.
    const ABOUT: About;

    /// Whether the child is a figure or a body.
    const TAKES: Dimension = Dimension::Space;

    /// Whether the result is a figure or a body. What keeps figures in their plane takes both, and gives what it took.
    const GIVES: Dimension = Dimension::Space;

    /// Whether the map never lengthens a distance, whatever its parameters, so that the child's distances stay bounds.
    /// What does lengthen them is marched by the slope of each cell of space.
    const IS_SHORT: bool = true;

    /// Whether it keeps figures in their plane: x and y of the mapped point do not depend on z.
    const IS_PLANAR: bool = false;

    /// The constants of the formula.
    fn prepare(args: &[f64]) -> Vec<f64> {
        args.to_vec()
    }

    /// What is known about the result.
    ///
    /// # Errors
    /// Why the child can't be mapped so, as a sentence.
    fn contract(args: &[f64], child: Contract, reach: Supports<'_>) -> Result<Contract, String>;

    /// The support of the result from that of the child at the same level; see [`Primitive::support`].
    fn support(args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64;

    /// The formula. Write `#[inline(always)]` before it: a formula that is not inlined loses the instruction set.
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S>;
}

/// A body that is, in some frame of space, the product of a figure and a range: it holds what lies within both, the figure in the
/// plane of x and y and the range along z. Distances from both are the legs of a right triangle.
pub trait Product: Combine {
    /// Where points are in the frame; `None` for space as it is. The figure's plane and the range may each by itself not lengthen
    /// a distance, whatever the parameters.
    const FRAME: Option<MapTable> = None;

    /// How many such products it is the union of: one unless there is a frame, whose constants are then those of each part in turn.
    fn parts(_args: &[f64]) -> usize {
        1
    }

    /// The range: a call of a primitive that looks at z alone, the same one for all parameters.
    fn range(args: &[f64]) -> RangeCall;
}

/// A call of a [`Primitive`] with its arguments.
pub type RangeCall = (&'static Shape, Vec<f64>);

/// A union of copies of the child in several places.
pub trait Copies: 'static {
    /// Description and parameters.
    const ABOUT: About;

    /// Whether copies are moved and never turned.
    const ARE_MOVED: bool = false;

    /// The arguments that decide how many copies there are; the others just move them.
    const COUNTED: Range<usize>;

    /// How many copies there are: one at least.
    fn count(args: &[f64]) -> usize;

    /// What places copy number `index`, the outermost call first. None of them changes a distance.
    fn places(args: &[f64], index: usize) -> Vec<PlaceCall>;
}

/// A call of a [`Place`] with its arguments.
pub type PlaceCall = (&'static Shape, Vec<f64>);

/// A change of the distance alone.
pub trait Modify: 'static {
    /// Description and parameters.
    const ABOUT: About;

    /// The constants of the formula.
    fn prepare(args: &[f64]) -> Vec<f64> {
        args.to_vec()
    }

    /// The contract of the result.
    ///
    /// # Errors
    /// Why the child can't be modified so, as a sentence.
    fn contract(args: &[f64], child: Contract) -> Result<Contract, String>;

    /// Something the user should know about this use, as a sentence.
    fn warning(_args: &[f64], _child: Contract) -> Option<String> {
        None
    }

    /// The level of the child whose inside covers that of the result at `level`; `None` if none does.
    fn level(args: &[f64], level: f64) -> Option<f64>;

    /// The formula. Write `#[inline(always)]` before it: a formula that is not inlined loses the instruction set.
    fn modify<S: Scalar>(value: S, c: &Constants<'_, S>) -> S;
}

/// What part of its operands' space a combination fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hull {
    /// At most that of both together.
    Both,
    /// At most what both have in common.
    Common,
    /// At most that of the first.
    First,
}
