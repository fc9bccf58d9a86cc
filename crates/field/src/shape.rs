//! Descriptors: everything the system knows about a function that makes or changes a field.
//!
//! A [`Shape`] is static data plus the kernels instantiated from one generic formula. The scene reader, the schema, the
//! documentation, the evaluator and the shader text all read descriptors; none of them keeps a list of its own. A new
//! function is one file under `shapes/` that implements one of the six traits here:
//!
//! - [`Primitive`]: a point and parameters to a distance;
//! - [`Combine`]: distances of several children to one, folded from left to right;
//! - [`Place`]: an affine map of space;
//! - [`Map`]: any other map of space, or from space to the plane of a figure;
//! - [`Copies`]: a union of copies in several places;
//! - [`Modify`]: one distance to another.

use crate::contract::{Contract, Dimension};
use crate::expr::Expr;
use crate::kernel::{CombineKernels, MapKernels, ModifyKernels, PrimitiveKernel, PrimitiveKernels};
use crate::scalar::{Constants, Interval, Scalar};
use crate::vector::Vec3;
use glam::{DAffine3, DVec3};

/// What a user reads about a function, and what a reader of scenes needs to decode it.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// The name in scene files and in the library.
    pub name: &'static str,
    /// One sentence: what it is.
    pub summary: &'static str,
    /// The parameters, in the order of the library's constructor. Only the last one may be a list.
    pub params: &'static [Param],
    /// Names of the same thing in other systems.
    pub elsewhere: &'static [&'static str],
    /// A complete shape in scene notation.
    pub example: &'static str,
}

/// One parameter of a function.
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// Its key in scene files.
    pub name: &'static str,
    /// What values it takes.
    pub kind: ParamKind,
    /// Its numbers if the user writes none; `None` for a required parameter.
    pub default: Option<&'static [f64]>,
    /// What it means, with its unit if it has one.
    pub about: &'static str,
}

/// What values a parameter takes. Each kind is stored as a fixed number of `f64`, except the list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamKind {
    /// Any finite number.
    Number,
    /// A length, not negative.
    Length,
    /// A length above 0.
    Positive,
    /// A factor other than 0.
    Factor,
    /// A whole number, at least the first and at most the second one.
    Count(u32, u32),
    /// Three whole numbers, each at least the first and at most the second one; a single number stands for three equal ones.
    Counts(u32, u32),
    /// An angle: degrees in files, radians inside.
    Angle,
    /// One of several names, stored as its index. Files that were written with numbers may use those instead, where
    /// every name is one.
    Choice(&'static [&'static str]),
    /// Yes or no, stored as 1 or 0.
    Flag,
    /// A point or displacement.
    Vector,
    /// A vector other than 0; its length does not matter.
    Direction,
    /// Three full lengths above 0; a single number stands for three equal ones.
    Size,
    /// Three lengths, not negative.
    Lengths,
    /// Two full lengths above 0; a single number stands for two equal ones.
    Size2,
    /// Three factors other than 0.
    Factors,
    /// Three angles about x, y and z.
    Angles,
    /// A quaternion x, y, z, w other than 0; its length does not matter.
    Quaternion,
    /// A quaternion by its real part and those along i, j and k.
    Quadruple,
    /// A region of space: stored as 0 for all of it, or 1 and a sphere's radius, or 2 and a box's three full edge lengths;
    /// always four numbers.
    Region,
    /// A list of points of the plane: x, y.
    Points2,
    /// A list of half-spaces, each with an outward normal and the distance of its plane from the origin: x, y, z, d.
    HalfSpaces,
}

impl ParamKind {
    /// How many numbers hold one value (one entry, for a list).
    pub const fn width(self) -> usize {
        match self {
            Self::Number
            | Self::Length
            | Self::Positive
            | Self::Factor
            | Self::Count(..)
            | Self::Angle
            | Self::Choice(_)
            | Self::Flag => 1,
            Self::Size2 | Self::Points2 => 2,
            Self::Vector
            | Self::Direction
            | Self::Size
            | Self::Lengths
            | Self::Factors
            | Self::Angles
            | Self::Counts(..) => 3,
            Self::Quaternion | Self::Quadruple | Self::Region | Self::HalfSpaces => 4,
        }
    }

    /// Whether the value is a list of entries.
    pub const fn is_list(self) -> bool {
        matches!(self, Self::HalfSpaces | Self::Points2)
    }

    /// Why `value` is not one of this kind, or `None` if it is. The numbers are as stored: angles in radians.
    pub fn fault(self, value: &[f64]) -> Option<String> {
        if value.iter().any(|v| !v.is_finite()) {
            return Some("must be finite".into());
        }
        let length = value.iter().map(|v| v * v).sum::<f64>().sqrt();
        match self {
            Self::Length if value[0] < 0.0 => Some(format!("must not be negative, but is {}", brief(value[0]))),
            Self::Positive if value[0] <= 0.0 => Some(format!("must be above 0, but is {}", brief(value[0]))),
            Self::Factor if value[0] == 0.0 => Some("must not be 0: it would flatten the shape".into()),
            Self::Count(..) if value[0].fract() != 0.0 => {
                Some(format!("must be a whole number, but is {}", brief(value[0])))
            }
            Self::Count(least, most) if !(f64::from(least)..=f64::from(most)).contains(&value[0]) => {
                Some(format!("must be from {least} to {most}, but is {}", brief(value[0])))
            }
            Self::Counts(least, most) if value.iter().any(|&v| Self::Count(least, most).fault(&[v]).is_some()) => {
                Some(format!("must be whole numbers from {least} to {most}"))
            }
            Self::Lengths if value.iter().any(|&v| v < 0.0) => Some("must not be negative in any direction".into()),
            Self::Size | Self::Size2 if value.iter().any(|&v| v <= 0.0) => {
                Some("must be above 0 in every direction".into())
            }
            Self::Factors if value.contains(&0.0) => Some("must not be 0 in any direction".into()),
            Self::Direction if length < SHORTEST_DIRECTION => Some("must not be the zero vector".into()),
            Self::Quaternion if length < SHORTEST_DIRECTION => Some("must not be the zero quaternion".into()),
            Self::Region => match *value {
                [kind, radius, ..] if kind == 1.0 && radius <= 0.0 => Some("needs a radius above 0".into()),
                [kind, ref size @ ..] if kind == 2.0 && size.iter().any(|&edge| edge <= 0.0) => {
                    Some("needs a size above 0 in every direction".into())
                }
                [kind, ..] if ![0.0, 1.0, 2.0].contains(&kind) => Some("must be a sphere or a box".into()),
                _ => None,
            },
            Self::HalfSpaces => value.chunks(4).enumerate().find_map(|(i, plane)| {
                (DVec3::new(plane[0], plane[1], plane[2]).length() < SHORTEST_DIRECTION)
                    .then(|| format!("entry {i} has a zero normal"))
            }),
            _ => None,
        }
    }
}

/// A number for a message: no hundreds of digits.
fn brief(number: f64) -> String {
    if number == 0.0 || (1e-6..1e12).contains(&number.abs()) { number.to_string() } else { format!("{number:e}") }
}

/// Below this length a direction's components lose precision when it is normalised.
pub const SHORTEST_DIRECTION: f64 = 1e-100;

impl Param {
    /// A parameter without default.
    pub const fn required(name: &'static str, kind: ParamKind, about: &'static str) -> Self {
        Self { name, kind, default: None, about }
    }

    /// A parameter with a default.
    pub const fn optional(name: &'static str, kind: ParamKind, default: &'static [f64], about: &'static str) -> Self {
        Self { name, kind, default: Some(default), about }
    }
}

/// The axis an axial shape stands along; always its last parameter. Formulas are written for z.
pub const AXIS: Param =
    Param::optional("axis", ParamKind::Choice(&["x", "y", "z"]), &[2.0], "The axis it stands along.");

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

    /// Whether the child is a figure or a body; the result is a body. [`Dimension::Space`] takes both, and gives what it took.
    const TAKES: Dimension = Dimension::Space;

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

/// A union of copies of the child in several places.
pub trait Copies: 'static {
    /// Description and parameters.
    const ABOUT: About;

    /// Whether copies are moved and never turned.
    const ARE_MOVED: bool = false;

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

/// A function that makes or changes a field.
#[derive(Debug)]
pub struct Shape {
    /// Description and parameters.
    pub about: About,
    /// What it does.
    pub kind: Kind,
}

/// The kinds of functions.
#[derive(Debug)]
pub enum Kind {
    /// See [`Primitive`].
    Primitive(PrimitiveTable),
    /// See [`Combine`].
    Combine(CombineTable),
    /// See [`Place`].
    Place(PlaceTable),
    /// See [`Map`].
    Map(MapTable),
    /// See [`Modify`].
    Modify(ModifyTable),
    /// See [`Copies`].
    Copies(CopiesTable),
    /// Makes a body of a figure: combines the figure's distance with that from all points within some height of its plane.
    Extrude(CombineTable),
    /// Gives its child a material.
    Paint,
    /// Computes a formula.
    Formula,
    /// Looks its child up at other points, by three formulas.
    Warp,
    /// Adds a formula to its child's value.
    Displace,
    /// Turns its child about an axis, the more the farther along it.
    Twist,
}

/// A formula in x, y and z among what a function takes.
#[derive(Clone, Copy, Debug)]
pub struct FormulaParam {
    /// Its key in scene files.
    pub name: &'static str,
    /// Its text if the user writes none; `None` if it is required.
    pub default: Option<&'static str>,
    /// What it means.
    pub about: &'static str,
}

/// The functions of a [`Primitive`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct PrimitiveTable {
    pub is_loose: bool,
    pub dimension: Dimension,
    pub check: fn(&[f64]) -> Result<(), String>,
    pub prepare: fn(&[f64]) -> Vec<f64>,
    pub contract: fn(&[f64]) -> Contract,
    pub support: fn(&[f64], DVec3, f64) -> f64,
    pub exact_form: fn(&[f64]) -> Option<ExactForm>,
    pub models: Option<PrimitiveKernel>,
    pub kernels: PrimitiveKernels,
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

/// The functions of a [`Combine`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct CombineTable {
    pub is_minimum: bool,
    pub prepare: fn(&[f64]) -> Vec<f64>,
    pub contract: fn(&[f64], Contract, Contract) -> Result<Contract, String>,
    pub settle: fn(Interval, Interval, &[f64]) -> Settled,
    pub hull: Hull,
    pub level: fn(&[f64], f64, usize) -> f64,
    pub kernels: CombineKernels,
    pub share: for<'g> fn(Expr<'g>, Expr<'g>, &Constants<'_, Expr<'g>>) -> Expr<'g>,
}

/// The functions of a [`Place`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct PlaceTable {
    pub is_rigid: bool,
    pub is_translation: bool,
    pub map: fn(&[f64]) -> DAffine3,
    pub factor: fn(&[f64]) -> f64,
    pub is_similarity: fn(&[f64]) -> bool,
}

/// The functions of a [`Map`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct MapTable {
    pub takes: Dimension,
    pub is_short: bool,
    pub is_planar: bool,
    pub prepare: fn(&[f64]) -> Vec<f64>,
    pub contract: fn(&[f64], Contract, Supports<'_>) -> Result<Contract, String>,
    pub support: fn(&[f64], DVec3, Supports<'_>) -> f64,
    pub kernels: MapKernels,
}

/// The functions of a [`Copies`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct CopiesTable {
    pub are_moved: bool,
    pub count: fn(&[f64]) -> usize,
    pub places: fn(&[f64], usize) -> Vec<PlaceCall>,
}

impl CopiesTable {
    /// The map that places a copy.
    pub fn map(&self, args: &[f64], index: usize) -> DAffine3 {
        let places = (self.places)(args, index);
        places.iter().fold(DAffine3::IDENTITY, |map, (shape, args)| match &shape.kind {
            Kind::Place(table) => map * (table.map)(args),
            _ => unreachable!("copies are placed by affine maps"),
        })
    }
}

/// The functions of a [`Modify`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct ModifyTable {
    pub prepare: fn(&[f64]) -> Vec<f64>,
    pub contract: fn(&[f64], Contract) -> Result<Contract, String>,
    pub warning: fn(&[f64], Contract) -> Option<String>,
    pub level: fn(&[f64], f64) -> Option<f64>,
    pub kernels: ModifyKernels,
}

impl CombineTable {
    /// The functions of one combination.
    pub const fn of<C: Combine>() -> Self {
        fn share<'g, C: Combine>(a: Expr<'g>, b: Expr<'g>, c: &Constants<'_, Expr<'g>>) -> Expr<'g> {
            C::share(a, b, c)
        }
        Self {
            is_minimum: C::IS_MINIMUM,
            prepare: C::prepare,
            contract: C::contract,
            settle: C::settle,
            hull: C::HULL,
            level: C::level,
            kernels: CombineKernels::of::<C>(),
            share: share::<C>,
        }
    }
}

impl Shape {
    /// The descriptor of a primitive.
    pub const fn primitive<P: Primitive>() -> Self {
        Self {
            about: P::ABOUT,
            kind: Kind::Primitive(PrimitiveTable {
                is_loose: P::IS_LOOSE,
                dimension: P::DIMENSION,
                check: P::check,
                prepare: P::prepare,
                contract: P::contract,
                support: P::support,
                exact_form: P::exact_form,
                models: P::MODELS,
                kernels: PrimitiveKernels::of::<P>(),
            }),
        }
    }

    /// The descriptor of a way to combine fields.
    pub const fn combine<C: Combine>() -> Self {
        Self { about: C::ABOUT, kind: Kind::Combine(CombineTable::of::<C>()) }
    }

    /// The descriptor of a way to make bodies of figures: `C` combines the figure's distance with that along the height.
    pub const fn extrude<C: Combine>() -> Self {
        Self { about: C::ABOUT, kind: Kind::Extrude(CombineTable::of::<C>()) }
    }

    /// The descriptor of an affine map.
    pub const fn place<P: Place>() -> Self {
        Self {
            about: P::ABOUT,
            kind: Kind::Place(PlaceTable {
                is_rigid: P::IS_RIGID,
                is_translation: P::IS_TRANSLATION,
                map: P::map,
                factor: P::factor,
                is_similarity: P::is_similarity,
            }),
        }
    }

    /// The descriptor of a map.
    pub const fn map<M: Map>() -> Self {
        Self {
            about: M::ABOUT,
            kind: Kind::Map(MapTable {
                takes: M::TAKES,
                is_short: M::IS_SHORT,
                is_planar: M::IS_PLANAR,
                prepare: M::prepare,
                contract: M::contract,
                support: M::support,
                kernels: MapKernels::of::<M>(),
            }),
        }
    }

    /// The descriptor of a union of copies.
    pub const fn copies<C: Copies>() -> Self {
        let table = CopiesTable { are_moved: C::ARE_MOVED, count: C::count, places: C::places };
        Self { about: C::ABOUT, kind: Kind::Copies(table) }
    }

    /// The functions of a combination, be it of shapes, or of a figure and its height.
    pub fn combination(&self) -> Option<&CombineTable> {
        match &self.kind {
            Kind::Combine(table) | Kind::Extrude(table) => Some(table),
            _ => None,
        }
    }

    /// The descriptor of a change of the distance.
    pub const fn modify<M: Modify>() -> Self {
        Self {
            about: M::ABOUT,
            kind: Kind::Modify(ModifyTable {
                prepare: M::prepare,
                contract: M::contract,
                warning: M::warning,
                level: M::level,
                kernels: ModifyKernels::of::<M>(),
            }),
        }
    }

    /// How many children it takes: none, exactly one, or any number above 0.
    pub fn arity(&self) -> Arity {
        match self.kind {
            Kind::Primitive(_) | Kind::Formula => Arity::None,
            Kind::Combine(_) => Arity::Many,
            Kind::Place(_)
            | Kind::Map(_)
            | Kind::Modify(_)
            | Kind::Extrude(_)
            | Kind::Copies(_)
            | Kind::Paint
            | Kind::Warp
            | Kind::Displace
            | Kind::Twist => Arity::One,
        }
    }

    /// The formulas that it takes, in order.
    pub fn formulas(&self) -> &'static [FormulaParam] {
        const fn coordinate(name: &'static str, about: &'static str) -> FormulaParam {
            FormulaParam { name, default: Some(name), about }
        }
        match self.kind {
            Kind::Formula => &[FormulaParam {
                name: "f",
                default: None,
                about: "The formula in x, y and z that is 0 on the surface.",
            }],
            Kind::Warp => {
                const {
                    &[
                        coordinate("x", "A formula: the x at which the shape is looked up."),
                        coordinate("y", "A formula: the y at which the shape is looked up."),
                        coordinate("z", "A formula: the z at which the shape is looked up."),
                    ]
                }
            }
            Kind::Displace => &[FormulaParam {
                name: "by",
                default: None,
                about: "The formula in x, y and z that is added; where it is negative, the surface moves outward.",
            }],
            _ => &[],
        }
    }

    /// Whether it stands along an axis the user chooses (its last parameter is then [`AXIS`]).
    pub fn is_axial(&self) -> bool {
        self.about.params.last().is_some_and(|p| p.name == AXIS.name)
    }

    /// Where the numbers of parameter `index` lie among the arguments of a node with `count` numbers in all.
    ///
    /// # Panics
    /// If there is no such parameter.
    pub fn range(&self, index: usize, count: usize) -> std::ops::Range<usize> {
        let start = self.about.params[..index].iter().map(|p| p.kind.width()).sum();
        let kind = self.about.params[index].kind;
        start..if kind.is_list() { count } else { start + kind.width() }
    }
}

/// How many children a function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arity {
    /// None.
    None,
    /// Exactly one.
    One,
    /// One or more.
    Many,
}
