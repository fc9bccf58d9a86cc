//! Expressions: the number type that records a formula instead of computing it.
//!
//! Running a formula over [`Expr`] leaves its operations in a [`Graph`], in the order of evaluation, equal ones only once. The
//! graph is turned into shader text (by the crate of shaders) or evaluated ([`Graph::evaluate`]), which the tests compare with
//! the direct computation. A loop ([`Scalar::iterate`]) becomes one [`Loop`] whose body are the terms that depend on its state.

use crate::scalar::{Constants, Scalar, Tree};
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

mod gradient;
mod search;

use search::TreeSearch;

/// An operation with one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "the operations speak for themselves")]
pub enum Unary {
    Neg,
    Abs,
    Sqrt,
    Floor,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Exp,
    Ln,
    Not,
}

/// An operation with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "the operations speak for themselves")]
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
    Atan2,
    Pow,
    Less,
    And,
    Or,
}

/// One entry of a graph; operands are indices of earlier entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Term {
    /// What the formula is about: of a point, coordinate 0, 1 or 2.
    Input(u32),
    /// An entry of the table of constants.
    Slot(u32),
    /// Inside a loop over rows of constants: entry `.1` of the first row, in later rows as much farther on.
    RowSlot(u32, u32),
    /// The entry of the table of constants that is this number of entries (a whole number, not negative) after the first one.
    Entry(u32, u32),
    /// A number, as its bits.
    Literal(u64),
    /// An operation with one operand.
    Unary(Unary, u32),
    /// An operation with two operands.
    Binary(Binary, u32, u32),
    /// The length of a vector of two or three numbers.
    Length(u32, u32, Option<u32>),
    /// Condition, value if true, value if false.
    Select(u32, u32, u32),
    /// Inside a loop: number `.1` of its state before the step.
    State(u32, u32),
    /// After a loop: number `.1` of its state.
    Result(u32, u32),
}

/// A bounded loop.
#[derive(Clone, Debug)]
pub struct Loop {
    /// The largest number of steps.
    pub limit: u32,
    /// The state before the first step.
    pub start: Vec<u32>,
    /// The state after a step.
    pub next: Vec<u32>,
    /// Whether to go on after a step; always if there is nothing.
    pub go_on: Option<u32>,
    /// How many constants a row has, of a loop over all rows of a list.
    pub row: Option<u32>,
}

/// The recorded operations of one or several formulas.
#[derive(Debug, Default)]
pub struct Graph {
    terms: RefCell<Vec<Term>>,
    known: RefCell<HashMap<Term, u32>>,
    loops: RefCell<Vec<Loop>>,
    /// Whether sums with 0 and products with 0 and 1 are recorded as what they come to.
    tidies: Cell<bool>,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// The point the formula is about.
    pub fn point(&self) -> [Expr<'_>; 3] {
        [0, 1, 2].map(|axis| self.input(axis))
    }

    /// A number that the formula is about.
    pub fn input(&self, index: u32) -> Expr<'_> {
        self.term(Term::Input(index))
    }

    /// A number by its place among the terms.
    pub fn at(&self, id: u32) -> Expr<'_> {
        Expr { graph: self, id }
    }

    /// All terms in the order of evaluation.
    pub fn terms(&self) -> Vec<Term> {
        self.terms.borrow().clone()
    }

    /// All loops.
    pub fn loops(&self) -> Vec<Loop> {
        self.loops.borrow().clone()
    }

    fn term(&self, term: Term) -> Expr<'_> {
        let mut known = self.known.borrow_mut();
        let id = *known.entry(term).or_insert_with(|| {
            let mut terms = self.terms.borrow_mut();
            terms.push(term);
            (terms.len() - 1) as u32
        });
        Expr { graph: self, id }
    }

    fn begin_loop(&self, limit: u32, row: Option<u32>, start: Vec<u32>) -> u32 {
        let mut loops = self.loops.borrow_mut();
        loops.push(Loop { limit, start, next: Vec::new(), go_on: None, row });
        (loops.len() - 1) as u32
    }

    /// Records a loop; see [`Scalar::iterate`].
    fn repeat<'g, const N: usize>(
        &'g self,
        limit: u32,
        start: [Expr<'g>; N],
        step: impl FnOnce([Expr<'g>; N]) -> ([Expr<'g>; N], Condition<'g>),
    ) -> [Expr<'g>; N] {
        let this = self.begin_loop(limit, None, start.iter().map(|s| s.id).collect());
        let (next, go_on) = step(self.spread(|place| Term::State(this, place)));
        self.end_loop(this, next.iter().map(|s| s.id).collect(), Some(go_on.0.id));
        self.spread(|place| Term::Result(this, place))
    }

    /// Records a loop whose state has one number more, which comes first.
    fn repeat_with<'g, const N: usize>(
        &'g self,
        limit: u32,
        first: Expr<'g>,
        start: [Expr<'g>; N],
        step: impl FnOnce(Expr<'g>, [Expr<'g>; N]) -> (Expr<'g>, [Expr<'g>; N], Condition<'g>),
    ) -> (Expr<'g>, [Expr<'g>; N]) {
        let ids = |first: Expr<'g>, others: [Expr<'g>; N]| [first].iter().chain(&others).map(|s| s.id).collect();
        let this = self.begin_loop(limit, None, ids(first, start));
        let state = (self.term(Term::State(this, 0)), self.spread(|place| Term::State(this, place + 1)));
        let (first, others, go_on) = step(state.0, state.1);
        self.end_loop(this, ids(first, others), Some(go_on.0.id));
        (self.term(Term::Result(this, 0)), self.spread(|place| Term::Result(this, place + 1)))
    }

    /// The numbers of a state or a result.
    fn spread<const N: usize>(&self, term: impl Fn(u32) -> Term) -> [Expr<'_>; N] {
        let mut place = 0;
        [(); N].map(|()| {
            place += 1;
            self.term(term(place - 1))
        })
    }

    fn end_loop(&self, this: u32, next: Vec<u32>, go_on: Option<u32>) {
        let this = &mut self.loops.borrow_mut()[this as usize];
        (this.next, this.go_on) = (next, go_on);
    }

    /// The number that a term is, if it is one.
    fn literal(&self, id: u32) -> Option<f64> {
        match self.terms.borrow()[id as usize] {
            Term::Literal(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// For each term, the innermost loop it must be computed inside, if any.
    pub fn owners(&self) -> Vec<Option<u32>> {
        let (terms, loops) = (self.terms.borrow(), self.loops.borrow());
        // A loop that starts from another one's state lies inside that one.
        let mut parents: Vec<Option<u32>> = vec![None; loops.len()];
        let mut owners: Vec<Option<u32>> = Vec::with_capacity(terms.len());
        let depth = |mut of: Option<u32>, parents: &[Option<u32>]| {
            let mut depth = 0;
            while let Some(inner) = of {
                depth += 1;
                of = parents[inner as usize];
            }
            depth
        };
        for term in terms.iter() {
            let deepest = |ids: &[u32], owners: &[Option<u32>], parents: &[Option<u32>]| {
                ids.iter().map(|&id| owners[id as usize]).max_by_key(|&owner| depth(owner, parents)).flatten()
            };
            let owner = match *term {
                Term::Input(_) | Term::Slot(_) | Term::Literal(_) => None,
                Term::Unary(_, a) | Term::Entry(_, a) => deepest(&[a], &owners, &parents),
                Term::Binary(_, a, b) | Term::Length(a, b, None) => deepest(&[a, b], &owners, &parents),
                Term::Select(a, b, c) | Term::Length(a, b, Some(c)) => deepest(&[a, b, c], &owners, &parents),
                Term::State(l, _) | Term::RowSlot(l, _) => {
                    parents[l as usize] = deepest(&loops[l as usize].start, &owners, &parents);
                    Some(l)
                }
                Term::Result(l, _) => parents[l as usize],
            };
            owners.push(owner);
        }
        owners
    }

    /// The value of `result` at a point.
    ///
    /// # Panics
    /// If `result` is a condition.
    pub fn evaluate(&self, result: Expr<'_>, point: [f64; 3], slots: &[f64]) -> f64 {
        let (terms, loops, owners) = (self.terms.borrow(), self.loops.borrow(), self.owners());
        let run = Run { terms: &terms, loops: &loops, owners: &owners, point, slots };
        let mut values = vec![f64::NAN; terms.len()];
        let mut finished = vec![Vec::new(); loops.len()];
        run.block(None, &mut values, &mut finished);
        values[result.id as usize]
    }
}

/// One evaluation of a graph. Conditions are 1 and 0.
struct Run<'a> {
    terms: &'a [Term],
    loops: &'a [Loop],
    owners: &'a [Option<u32>],
    point: [f64; 3],
    slots: &'a [f64],
}

impl Run<'_> {
    fn block(&self, owner: Option<u32>, values: &mut Vec<f64>, finished: &mut Vec<Vec<f64>>) {
        for (id, term) in self.terms.iter().enumerate() {
            if self.owners[id] != owner {
                continue;
            }
            let v = |i: u32| values[i as usize];
            let truth = |condition: bool| f64::from(u8::from(condition));
            let value = match *term {
                Term::Input(axis) => self.point[axis as usize],
                Term::Slot(slot) => self.slots[slot as usize],
                Term::Entry(slot, index) => self.slots[slot as usize + v(index) as usize],
                Term::Literal(bits) => f64::from_bits(bits),
                Term::Unary(op, a) => match op {
                    Unary::Neg => -v(a),
                    Unary::Abs => v(a).abs(),
                    Unary::Sqrt => v(a).sqrt(),
                    Unary::Sin => Scalar::sin(v(a)),
                    Unary::Cos => Scalar::cos(v(a)),
                    Unary::Tan => Scalar::tan(v(a)),
                    Unary::Asin => Scalar::asin(v(a)),
                    Unary::Acos => Scalar::acos(v(a)),
                    Unary::Atan => Scalar::atan(v(a)),
                    Unary::Exp => Scalar::exp(v(a)),
                    Unary::Ln => Scalar::ln(v(a)),
                    Unary::Floor => Scalar::floor(v(a)),
                    Unary::Not => 1.0 - v(a),
                },
                Term::Binary(op, a, b) => match op {
                    Binary::Add => v(a) + v(b),
                    Binary::Sub => v(a) - v(b),
                    Binary::Mul => v(a) * v(b),
                    Binary::Div => v(a) / v(b),
                    Binary::Min => Scalar::min(v(a), v(b)),
                    Binary::Max => Scalar::max(v(a), v(b)),
                    Binary::Atan2 => Scalar::atan2(v(a), v(b)),
                    Binary::Pow => Scalar::pow(v(a), v(b)),
                    Binary::Less => truth(v(a) < v(b)),
                    Binary::And => v(a) * v(b),
                    Binary::Or => v(a).max(v(b)),
                },
                Term::Length(a, b, None) => Scalar::length2(v(a), v(b)),
                Term::Length(a, b, Some(c)) => Scalar::length3(v(a), v(b), v(c)),
                Term::Select(c, a, b) => {
                    if v(c) == 1.0 {
                        v(a)
                    } else {
                        v(b)
                    }
                }
                // Set by the loop that runs this block.
                Term::State(..) | Term::RowSlot(..) => continue,
                Term::Result(l, place) => {
                    if finished[l as usize].is_empty() {
                        self.run_loop(l, values, finished);
                    }
                    finished[l as usize][place as usize]
                }
            };
            values[id] = value;
        }
    }

    fn run_loop(&self, l: u32, values: &mut Vec<f64>, finished: &mut Vec<Vec<f64>>) {
        let this = &self.loops[l as usize];
        let read = |ids: &[u32], values: &[f64]| ids.iter().map(|&id| values[id as usize]).collect::<Vec<_>>();
        let mut state = read(&this.start, values);
        for step in 0..this.limit {
            for (id, term) in self.terms.iter().enumerate() {
                match *term {
                    Term::State(of, place) if of == l => values[id] = state[place as usize],
                    Term::RowSlot(of, slot) if of == l => {
                        values[id] = self.slots[(slot + step * this.row.unwrap_or(0)) as usize];
                    }
                    _ => {}
                }
                // Inner loops run anew in each step.
                if let (Term::Result(inner, _), true) = (*term, self.owners[id] == Some(l)) {
                    finished[inner as usize].clear();
                }
            }
            self.block(Some(l), values, finished);
            state = read(&this.next, values);
            if this.go_on.is_some_and(|go_on| values[go_on as usize] != 1.0) {
                break;
            }
        }
        finished[l as usize] = state;
    }
}

/// A number in a [`Graph`].
#[derive(Clone, Copy, Debug)]
pub struct Expr<'g> {
    graph: &'g Graph,
    id: u32,
}

impl Constants<'_, Expr<'_>> {
    /// The slot of the first one.
    fn place(&self) -> u32 {
        let (table, first) = self.origin();
        table.first + first as u32
    }
}

/// The outcome of a comparison in a [`Graph`].
#[derive(Clone, Copy, Debug)]
pub struct Condition<'g>(Expr<'g>);

/// Where the constants of a node start in the table that the shader reads.
#[derive(Clone, Copy, Debug)]
pub struct Slots {
    first: u32,
    /// What places them elsewhere at run time.
    moved: Moved,
}

/// How constants lie elsewhere than their slots say.
#[derive(Clone, Copy, Debug)]
enum Moved {
    /// Not at all.
    No,
    /// In the rows of this loop.
    ByLoop(u32),
    /// Farther on by this number.
    By(u32),
}

impl Slots {
    /// At this place.
    pub fn at(first: u32) -> Self {
        Self { first, moved: Moved::No }
    }
}

impl<'g> Expr<'g> {
    /// Its place among the terms of the graph.
    pub fn id(self) -> u32 {
        self.id
    }

    fn unary(self, op: Unary) -> Self {
        if self.graph.tidies.get() && op == Unary::Neg {
            match self.graph.terms.borrow()[self.id as usize] {
                Term::Unary(Unary::Neg, id) => return Self { id, ..self },
                Term::Literal(0) => return self,
                _ => {}
            }
        }
        self.graph.term(Term::Unary(op, self.id))
    }

    fn binary(self, op: Binary, rhs: Self) -> Self {
        if self.graph.tidies.get()
            && let Some(tidy) = self.tidied(op, rhs)
        {
            return tidy;
        }
        self.graph.term(Term::Binary(op, self.id, rhs.id))
    }

    /// What an operation comes to if one of the numbers is 0 or 1.
    fn tidied(self, op: Binary, rhs: Self) -> Option<Self> {
        let (a, b) = (self.graph.literal(self.id), self.graph.literal(rhs.id));
        Some(match (op, a, b) {
            (Binary::Add, Some(0.0), _) => rhs,
            (Binary::Add | Binary::Sub, _, Some(0.0)) => self,
            (Binary::Sub, Some(0.0), _) => -rhs,
            (Binary::Mul, Some(0.0), _) | (Binary::Mul, _, Some(1.0)) => self,
            (Binary::Mul, Some(1.0), _) | (Binary::Mul, _, Some(0.0)) => rhs,
            (Binary::Div, Some(0.0), _) | (Binary::Div, _, Some(1.0)) => self,
            (Binary::Mul, Some(-1.0), _) => -rhs,
            (Binary::Mul, _, Some(-1.0)) => -self,
            _ => return None,
        })
    }

    /// The constants that start at slot `first`.
    pub fn constants(self, first: &Slots, count: usize) -> Constants<'_, Self> {
        Constants::new(self, first, count)
    }
}

macro_rules! record {
    ($($Trait:ident $method:ident),*) => {$(
        impl $Trait for Expr<'_> {
            type Output = Self;
            fn $method(self, rhs: Self) -> Self {
                self.binary(Binary::$Trait, rhs)
            }
        }
    )*};
}

record!(Add add, Sub sub, Mul mul, Div div);

macro_rules! record_constant {
    ($($Trait:ident $method:ident),*) => {$(
        impl $Trait<f64> for Expr<'_> {
            type Output = Self;
            fn $method(self, rhs: f64) -> Self {
                $Trait::$method(self, self.lift(rhs))
            }
        }
    )*};
}

record_constant!(Add add, Sub sub, Mul mul);

impl Neg for Expr<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(Unary::Neg)
    }
}

impl BitAnd for Condition<'_> {
    type Output = Self;
    fn bitand(self, rhs: Self) -> Self {
        Self(self.0.binary(Binary::And, rhs.0))
    }
}

impl BitOr for Condition<'_> {
    type Output = Self;
    fn bitor(self, rhs: Self) -> Self {
        Self(self.0.binary(Binary::Or, rhs.0))
    }
}

impl Not for Condition<'_> {
    type Output = Self;
    fn not(self) -> Self {
        Self(self.0.unary(Unary::Not))
    }
}

impl<'g> Scalar for Expr<'g> {
    type Mask = Condition<'g>;
    type Table = Slots;

    fn lift(self, c: f64) -> Self {
        self.graph.term(Term::Literal(c.to_bits()))
    }

    fn constant(self, table: &Slots, index: usize) -> Self {
        let slot = table.first + index as u32;
        self.graph.term(match table.moved {
            Moved::ByLoop(this) => Term::RowSlot(this, slot),
            Moved::By(index) => Term::Entry(slot, index),
            Moved::No => Term::Slot(slot),
        })
    }

    fn lt(self, rhs: Self) -> Condition<'g> {
        Condition(self.binary(Binary::Less, rhs))
    }

    fn select(mask: Condition<'g>, yes: Self, no: Self) -> Self {
        if yes.graph.tidies.get() && yes.id == no.id {
            return yes;
        }
        yes.graph.term(Term::Select(mask.0.id, yes.id, no.id))
    }

    fn any(_mask: Condition<'g>) -> bool {
        true
    }

    fn sqrt(self) -> Self {
        self.unary(Unary::Sqrt)
    }

    fn abs(self) -> Self {
        self.unary(Unary::Abs)
    }

    fn min(self, rhs: Self) -> Self {
        self.binary(Binary::Min, rhs)
    }

    fn max(self, rhs: Self) -> Self {
        self.binary(Binary::Max, rhs)
    }

    fn length2(a: Self, b: Self) -> Self {
        a.graph.term(Term::Length(a.id, b.id, None))
    }

    fn length3(a: Self, b: Self, c: Self) -> Self {
        a.graph.term(Term::Length(a.id, b.id, Some(c.id)))
    }

    fn sin(self) -> Self {
        self.unary(Unary::Sin)
    }

    fn cos(self) -> Self {
        self.unary(Unary::Cos)
    }

    fn tan(self) -> Self {
        self.unary(Unary::Tan)
    }

    fn asin(self) -> Self {
        self.unary(Unary::Asin)
    }

    fn acos(self) -> Self {
        self.unary(Unary::Acos)
    }

    fn atan(self) -> Self {
        self.unary(Unary::Atan)
    }

    fn exp(self) -> Self {
        self.unary(Unary::Exp)
    }

    fn ln(self) -> Self {
        self.unary(Unary::Ln)
    }

    fn floor(self) -> Self {
        self.unary(Unary::Floor)
    }

    fn atan2(self, x: Self) -> Self {
        self.binary(Binary::Atan2, x)
    }

    fn pow(self, exponent: Self) -> Self {
        self.binary(Binary::Pow, exponent)
    }

    fn iterate<const N: usize>(
        limit: u32,
        state: [Self; N],
        step: impl Fn([Self; N]) -> ([Self; N], Condition<'g>),
    ) -> [Self; N] {
        let Some(first) = state.first() else {
            return state;
        };
        first.graph.repeat(limit, state, step)
    }

    fn fold_rows<const N: usize>(
        constants: &Constants<'_, Self>,
        width: usize,
        state: [Self; N],
        step: impl Fn([Self; N], &Constants<'_, Self>) -> [Self; N],
    ) -> [Self; N] {
        let (Some(first), rows) = (state.first(), constants.count() / width) else {
            return state;
        };
        let graph = first.graph;
        let this = graph.begin_loop(rows as u32, Some(width as u32), state.iter().map(|s| s.id).collect());
        let slots = Slots { first: constants.place(), moved: Moved::ByLoop(this) };
        let row = Constants::new(*first, &slots, width);
        let next = step(graph.spread(|place| Term::State(this, place)), &row);
        graph.end_loop(this, next.iter().map(|s| s.id).collect(), None);
        graph.spread(|place| Term::Result(this, place))
    }

    fn fold_tree<const N: usize>(
        constants: &Constants<'_, Self>,
        tree: Tree,
        state: [Self; N],
        bound: impl Fn(&Constants<'_, Self>) -> Self,
        step: impl Fn([Self; N], &Constants<'_, Self>) -> [Self; N],
    ) -> [Self; N] {
        TreeSearch::new(constants, tree, bound, step).all(state)
    }

    fn fold_leaf<const N: usize>(
        constants: &Constants<'_, Self>,
        tree: Tree,
        state: [Self; N],
        bound: impl Fn(&Constants<'_, Self>) -> Self,
        step: impl Fn([Self; N], &Constants<'_, Self>) -> [Self; N],
    ) -> [Self; N] {
        TreeSearch::new(constants, tree, bound, step).near(state)
    }
}
