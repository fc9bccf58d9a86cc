//! From the graph of a formula to that of its value and derivatives.
//!
//! The terms are run again, over dual numbers of expressions, so that the rules of differentiation are those of [`Dual`]. The
//! state of a loop is extended by the derivatives of its numbers. What is multiplied with a derivative of 0, or added to one,
//! leaves no term.

use super::{Binary, Condition, Expr, Graph, Loop, Slots, Term, Unary};
use crate::scalar::{Dual, Scalar};

impl Graph {
    /// Records `results`, numbers of this graph, with their derivatives by the first `N` inputs in another graph.
    pub fn differentiate<'g, const N: usize>(&self, results: &[Expr<'_>], into: &'g Self) -> Vec<Dual<Expr<'g>, N>> {
        let (terms, loops, owners) = (self.terms(), self.loops(), self.owners());
        let count = terms.len();
        let mut again = Again { terms, loops, owners, into, done: vec![None; count], ended: Vec::new() };
        into.tidies.set(true);
        again.block(None);
        let duals = results.iter().map(|result| again.number(result.id)).collect();
        into.tidies.set(false);
        duals
    }
}

/// What a term of the first graph has become in the second one.
#[derive(Clone, Copy)]
enum Done<'g, const N: usize> {
    Number(Dual<Expr<'g>, N>),
    Condition(Condition<'g>),
}

struct Again<'g, const N: usize> {
    terms: Vec<Term>,
    loops: Vec<Loop>,
    owners: Vec<Option<u32>>,
    into: &'g Graph,
    done: Vec<Option<Done<'g, N>>>,
    /// Loops that have been run again, with their places in the second graph.
    ended: Vec<(u32, u32)>,
}

impl<'g, const N: usize> Again<'g, N> {
    fn number(&self, id: u32) -> Dual<Expr<'g>, N> {
        match self.done[id as usize] {
            Some(Done::Number(number)) => number,
            _ => unreachable!("operands are recorded before what reads them, and have its type"),
        }
    }

    fn condition(&self, id: u32) -> Condition<'g> {
        match self.done[id as usize] {
            Some(Done::Condition(condition)) => condition,
            _ => unreachable!("operands are recorded before what reads them, and have its type"),
        }
    }

    fn block(&mut self, owner: Option<u32>) {
        for id in 0..self.terms.len() {
            if self.owners[id] == owner {
                let done = self.term(self.terms[id]);
                // States are set by their loop.
                self.done[id] = done.or(self.done[id]);
            }
        }
    }

    fn term(&mut self, term: Term) -> Option<Done<'g, N>> {
        let one = |op: Unary, a: Dual<Expr<'g>, N>| match op {
            Unary::Neg => -a,
            Unary::Abs => a.abs(),
            Unary::Sqrt => a.sqrt(),
            Unary::Floor => a.floor(),
            Unary::Sin => a.sin(),
            Unary::Cos => a.cos(),
            Unary::Tan => a.tan(),
            Unary::Asin => a.asin(),
            Unary::Acos => a.acos(),
            Unary::Atan => a.atan(),
            Unary::Exp => a.exp(),
            Unary::Ln => a.ln(),
            Unary::Not => unreachable!("a function of conditions"),
        };
        let two = |op: Binary, a: Dual<Expr<'g>, N>, b: Dual<Expr<'g>, N>| match op {
            Binary::Add => a + b,
            Binary::Sub => a - b,
            Binary::Mul => a * b,
            Binary::Div => a / b,
            Binary::Min => a.min(b),
            Binary::Max => a.max(b),
            Binary::Atan2 => a.atan2(b),
            Binary::Pow => a.pow(b),
            Binary::Less | Binary::And | Binary::Or => unreachable!("functions that yield conditions"),
        };
        Some(match term {
            Term::Input(input) => {
                let mut number = Dual::independent(self.into.input(input));
                if let Some(own) = number.gradient.get_mut(input as usize) {
                    *own = number.value.lift(1.0);
                }
                Done::Number(number)
            }
            Term::Slot(slot) => {
                let like = self.into.input(0);
                Done::Number(Dual::independent(like.constant(&Slots::at(slot), 0)))
            }
            Term::Entry(slot, index) => {
                let index = self.number(index).value.id;
                Done::Number(Dual::independent(self.into.term(Term::Entry(slot, index))))
            }
            Term::Literal(bits) => Done::Number(Dual::independent(self.into.input(0).lift(f64::from_bits(bits)))),
            Term::Unary(Unary::Not, a) => Done::Condition(!self.condition(a)),
            Term::Unary(op, a) => Done::Number(one(op, self.number(a))),
            Term::Binary(Binary::Less, a, b) => Done::Condition(self.number(a).lt(self.number(b))),
            Term::Binary(Binary::And, a, b) => Done::Condition(self.condition(a) & self.condition(b)),
            Term::Binary(Binary::Or, a, b) => Done::Condition(self.condition(a) | self.condition(b)),
            // A square keeps its simpler rule.
            Term::Binary(Binary::Mul, a, b) if a == b => Done::Number(self.number(a).square()),
            Term::Binary(op, a, b) => Done::Number(two(op, self.number(a), self.number(b))),
            Term::Length(a, b, None) => Done::Number(Dual::length2(self.number(a), self.number(b))),
            Term::Length(a, b, Some(c)) => Done::Number(Dual::length3(self.number(a), self.number(b), self.number(c))),
            Term::Select(c, a, b) => Done::Number(Dual::select(self.condition(c), self.number(a), self.number(b))),
            Term::State(..) | Term::RowSlot(..) => return None,
            Term::Result(l, place) => {
                let this = match self.ended.iter().find(|(of, _)| *of == l) {
                    Some(&(_, this)) => this,
                    None => {
                        let this = self.run_loop(l);
                        self.ended.push((l, this));
                        this
                    }
                };
                Done::Number(self.spread(place, |place| Term::Result(this, place)))
            }
        })
    }

    /// The number at `place` of a state and its derivatives, which follow one another in the extended state.
    fn spread(&self, place: u32, term: impl Fn(u32) -> Term) -> Dual<Expr<'g>, N> {
        let first = place * (1 + N as u32);
        let mut input = first;
        let gradient = [(); N].map(|()| {
            input += 1;
            self.into.term(term(input))
        });
        Dual { value: self.into.term(term(first)), gradient }
    }

    fn run_loop(&mut self, l: u32) -> u32 {
        let Loop { limit, start, next, go_on, row } = self.loops[l as usize].clone();
        let flat = |again: &Self, ids: &[u32]| -> Vec<u32> {
            let number = |&id: &u32| again.number(id);
            ids.iter().map(number).flat_map(|n| std::iter::once(n.value.id).chain(n.gradient.map(|d| d.id))).collect()
        };
        let this = self.into.begin_loop(limit, row, flat(self, &start));
        for id in 0..self.terms.len() {
            match self.terms[id] {
                Term::State(of, place) if of == l => {
                    self.done[id] = Some(Done::Number(self.spread(place, |place| Term::State(this, place))));
                }
                Term::RowSlot(of, slot) if of == l => {
                    let number = self.into.term(Term::RowSlot(this, slot));
                    self.done[id] = Some(Done::Number(Dual::independent(number)));
                }
                _ => {}
            }
        }
        self.block(Some(l));
        let next = flat(self, &next);
        self.into.end_loop(this, next, go_on.map(|id| self.condition(id).0.id));
        this
    }
}
