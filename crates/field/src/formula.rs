//! Formulas in x, y and z, as users write them: `x^2 + y^2 + z^2 - 1`.
//!
//! A [`Formula`] is the text and what it means: a list of [`Term`]s in the order of evaluation, equal ones only once,
//! simplified while it is read. It can be evaluated in any number type ([`Formula::eval`]), differentiated, expanded if it
//! is a polynomial, printed, and exchanged as an expression graph (`.vm`).
//!
//! # The language
//!
//! - numbers (`2`, `.5`, `1e-3`), the coordinates `x`, `y`, `z`, the constants `pi`, `tau`, `turn` (= `tau`), `deg`
//!   (= `pi / 180`) and `e`;
//! - `+ - * / ^` with the usual precedence; `^` groups from the right and binds tighter than a minus before it:
//!   `-x^2` is `-(x^2)`. `**`, `·`, `×`, `÷`, `−` and superscripts (`x²`) are understood, too;
//! - a number may stand before a name or parenthesis without `*`: `2x`, `3(x + 1)`, `45 deg`. Nothing else may, and
//!   neither `1/2x` nor `x^2y`, which people read in two ways;
//! - functions, see [`functions`];
//! - definitions before the formula, each with a `;` after it: `r = hypot(x, y); hypot(r - 2, z) - 1`;
//! - vectors of two or three numbers: `p` is (x, y, z), `vec(a, b)` and `vec(a, b, c)` make others, `v.x` and `v.xy` are parts of
//!   them. Operators and functions of numbers work on each part by itself (a number beside a vector counts for all of them),
//!   `length`, `dot`, `cross`, `normalize` and `distance` on whole vectors: `q = abs(p) - vec(1, 2, 3); length(max(q, 0)) - 0.1`.
//!   The formula itself is a number;
//! - names that are given values from outside, see [`Formula::parse_with`].
//!
//! A formula has no value where a part of it has none, for instance the root of a negative number.

use crate::scalar::Scalar;
use crate::vector::Vec3;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

mod builder;
mod derivative;
mod error;
mod names;
mod parse;
mod polynomial;
mod print;
mod rules;
mod token;
mod value;
mod vm;

pub use error::FormulaError;
pub use names::{Function, functions, name_fault};
pub use parse::{MOST_NESTED, MOST_TERMS};
pub use polynomial::{HIGHEST_DEGREE, Monomial, Polynomial};
pub use vm::VmError;

use builder::Builder;

/// An expression in x, y and z. See the [module documentation](self).
#[derive(Clone, PartialEq)]
pub struct Formula(Arc<Inner>);

#[derive(PartialEq)]
struct Inner {
    terms: Vec<Term>,
    text: String,
    /// The names in it that were given values.
    names: Vec<String>,
}

/// The place of a term in its formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TermId(u32);

impl TermId {
    /// The index into [`Formula::terms`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One operation of a formula; its operands come before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Term {
    /// A coordinate of the point: 0, 1 or 2.
    Input(usize),
    /// A finite number.
    Literal(f64),
    /// A function of one number.
    Unary(Unary, TermId),
    /// A function of two numbers. A literal is the right one in sums, products, minima and maxima.
    Binary(Binary, TermId, TermId),
    /// An integer power other than 0, 1, 2 and -1.
    Power(TermId, i32),
}

/// A function of one number, as the method of the same name of [`Scalar`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "the functions speak for themselves")]
pub enum Unary {
    Neg,
    Abs,
    Square,
    Sqrt,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Exp,
    Ln,
    Floor,
}

/// A function of two numbers, as the method of the same name of [`Scalar`] if nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "the functions speak for themselves")]
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
    Pow,
    /// The angle of the point (right, left).
    Atan2,
    /// 1 where left < right, otherwise 0.
    Less,
}

impl Unary {
    /// The value of the function.
    #[inline(always)]
    pub fn apply<S: Scalar>(self, a: S) -> S {
        match self {
            Self::Neg => -a,
            Self::Abs => a.abs(),
            Self::Square => a.square(),
            Self::Sqrt => a.sqrt(),
            Self::Sin => a.sin(),
            Self::Cos => a.cos(),
            Self::Tan => a.tan(),
            Self::Asin => a.asin(),
            Self::Acos => a.acos(),
            Self::Atan => a.atan(),
            Self::Exp => a.exp(),
            Self::Ln => a.ln(),
            Self::Floor => a.floor(),
        }
    }

    /// Its name, by which graphs call it, and formulas where they have no sign for it.
    fn name(self) -> &'static str {
        match self {
            Self::Neg => "neg",
            Self::Abs => "abs",
            Self::Square => "square",
            Self::Sqrt => "sqrt",
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan => "atan",
            Self::Exp => "exp",
            Self::Ln => "ln",
            Self::Floor => "floor",
        }
    }
}

impl Binary {
    /// The value of the function.
    #[inline(always)]
    pub fn apply<S: Scalar>(self, a: S, b: S) -> S {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Min => a.min(b),
            Self::Max => a.max(b),
            Self::Pow => a.pow(b),
            // Zeros have no sign here: what made one must not choose the side of the jump.
            Self::Atan2 => (a + 0.0).atan2(b + 0.0),
            Self::Less => a.less(b),
        }
    }

    /// Whether the operands may change places.
    pub fn is_commutative(self) -> bool {
        matches!(self, Self::Add | Self::Mul | Self::Min | Self::Max)
    }
}

impl Term {
    /// The terms it is computed from.
    pub fn operands(self) -> impl Iterator<Item = TermId> {
        let (a, b) = match self {
            Self::Input(_) | Self::Literal(_) => (None, None),
            Self::Unary(_, a) | Self::Power(a, _) => (Some(a), None),
            Self::Binary(_, a, b) => (Some(a), Some(b)),
        };
        a.into_iter().chain(b)
    }

    /// The same function of other operands.
    fn map(self, mut to: impl FnMut(TermId) -> TermId) -> Self {
        match self {
            Self::Input(_) | Self::Literal(_) => self,
            Self::Unary(op, a) => Self::Unary(op, to(a)),
            Self::Power(a, n) => Self::Power(to(a), n),
            Self::Binary(op, a, b) => Self::Binary(op, to(a), to(b)),
        }
    }
}

impl Formula {
    /// What `text` means.
    ///
    /// # Errors
    /// The first mistake in it.
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        Self::parse_with(text, &BTreeMap::new())
    }

    /// What `text` means where some names have these finite values; [`name_fault`] says which names can have one.
    ///
    /// ```
    /// use freikugel_field::Formula;
    ///
    /// let given = [("radius".to_owned(), 2.0)].into();
    /// let ball = Formula::parse_with("length(p) - radius", &given)?;
    /// assert_eq!(ball.value([3.0, 0.0, 4.0]), 3.0);
    /// assert_eq!(ball.names(), ["radius"]);
    /// # Ok::<(), freikugel_field::formula::FormulaError>(())
    /// ```
    ///
    /// # Errors
    /// The first mistake in it.
    pub fn parse_with(text: &str, given: &BTreeMap<String, f64>) -> Result<Self, FormulaError> {
        let mut builder = Builder::default();
        let (result, names) = parse::parse(text, given, &mut builder)?;
        Ok(Self(Arc::new(Inner { terms: builder.finish(result), text: text.to_string(), names })))
    }

    /// The number that a formula without coordinates is.
    pub fn constant(&self) -> Option<f64> {
        match *self.terms() {
            [Term::Literal(number)] => Some(number),
            _ => None,
        }
    }

    /// The names in its text that were given values, in order.
    pub fn names(&self) -> &[String] {
        &self.0.names
    }

    /// The formula for a term of `builder`, with its print as the text.
    fn build(builder: &Builder, result: TermId) -> Self {
        let terms = builder.finish(result);
        let text = print::print(&terms);
        Self(Arc::new(Inner { terms, text, names: Vec::new() }))
    }

    /// The coordinate 0, 1 or 2 itself.
    ///
    /// # Panics
    /// If there is no such coordinate.
    pub fn coordinate(axis: usize) -> Self {
        assert!(axis < 3, "there are three coordinates");
        let mut builder = Builder::default();
        let input = builder.input(axis);
        Self::build(&builder, input)
    }

    /// The difference from coordinate `axis`: what the formula adds to it. A coordinate that is a term of a sum cancels.
    #[must_use]
    pub fn minus_coordinate(&self, axis: usize) -> Self {
        let mut builder = Builder::of(self.terms());
        let input = builder.input(axis);
        let difference = builder.binary(Binary::Sub, self.result(), input);
        Self::build(&builder, difference)
    }

    /// All terms, operands before what is computed from them; every one is needed for the last.
    pub fn terms(&self) -> &[Term] {
        &self.0.terms
    }

    /// The term that is the formula's value: the last one.
    pub fn result(&self) -> TermId {
        TermId(self.0.terms.len() as u32 - 1)
    }

    /// The text it was read from, or its print where there is none.
    pub fn text(&self) -> &str {
        &self.0.text
    }

    /// Whether it depends on a coordinate: 0, 1 or 2.
    pub fn uses(&self, axis: usize) -> bool {
        self.0.terms.contains(&Term::Input(axis))
    }

    /// The value at a point; NaN where there is none.
    pub fn value(&self, p: [f64; 3]) -> f64 {
        self.eval(p.into())
    }

    /// The value at a point in any number type, one term after another.
    pub fn eval<S: Scalar>(&self, p: Vec3<S>) -> S {
        let mut values: Vec<S> = Vec::with_capacity(self.0.terms.len());
        for &term in &self.0.terms {
            values.push(match term {
                Term::Input(axis) => [p.x, p.y, p.z][axis],
                Term::Literal(number) => p.x.lift(number),
                Term::Unary(op, a) => op.apply(values[a.index()]),
                Term::Binary(op, a, b) => op.apply(values[a.index()], values[b.index()]),
                Term::Power(a, n) => values[a.index()].powi(n),
            });
        }
        values[self.result().index()]
    }
}

/// The formula in the language it is read from, with no parentheses that it can do without. Reading that again gives the
/// same terms.
impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&print::print(&self.0.terms))
    }
}

impl fmt::Debug for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Formula").field(&self.0.text).finish()
    }
}
