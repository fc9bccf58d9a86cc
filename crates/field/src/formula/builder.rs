//! Terms under construction: equal ones only once, with what is known of their values.

use super::{Binary, Term, TermId, Unary};
use std::collections::HashMap;

/// Terms under construction.
#[derive(Debug, Default)]
pub(super) struct Builder {
    terms: Vec<Term>,
    facts: Vec<Facts>,
    known: HashMap<Key, TermId>,
    is_faulty: bool,
}

/// What is known of a term's values.
#[derive(Clone, Copy, Debug)]
struct Facts {
    /// The coordinates it depends on, one bit each.
    axes: u8,
    /// They are never negative.
    is_nonnegative: bool,
    /// There is one for every finite point, apart from overflow.
    is_total: bool,
}

/// A term with its literal as bits and commuting operands in order.
#[derive(PartialEq, Eq, Hash, Debug)]
enum Key {
    Input(usize),
    Literal(u64),
    Unary(Unary, TermId),
    Binary(Binary, TermId, TermId),
    Power(TermId, i32),
}

impl Builder {
    /// A builder that holds these terms at their places.
    pub(super) fn of(terms: &[Term]) -> Self {
        let mut builder = Self::default();
        for &term in terms {
            builder.push(term);
        }
        builder
    }

    /// How many terms were made.
    pub(super) fn len(&self) -> usize {
        self.terms.len()
    }

    pub(super) fn term(&self, id: TermId) -> Term {
        self.terms[id.index()]
    }

    /// Whether one of the terms divides by the number 0 or is a constant that is no finite number.
    pub(super) fn is_faulty(&self) -> bool {
        self.is_faulty
    }

    /// Whether the term depends on coordinate `axis`.
    pub(super) fn depends(&self, id: TermId, axis: usize) -> bool {
        self.facts[id.index()].axes & (1 << axis) != 0
    }

    /// The terms that `result` needs, in the order of a walk through its operands from the left; it comes last.
    pub(super) fn finish(&self, result: TermId) -> Vec<Term> {
        let mut places: Vec<Option<TermId>> = vec![None; self.terms.len()];
        let mut terms: Vec<Term> = Vec::new();
        let mut pending = vec![result];
        while let Some(&id) = pending.last() {
            let first_missing = self.term(id).operands().find(|operand| places[operand.index()].is_none());
            if places[id.index()].is_some() {
                pending.pop();
            } else if let Some(operand) = first_missing {
                pending.push(operand);
            } else {
                places[id.index()] = Some(TermId(terms.len() as u32));
                terms.push(self.term(id).map(|operand| places[operand.index()].unwrap_or(operand)));
                pending.pop();
            }
        }
        terms
    }

    /// The term itself, no rule applied.
    pub(super) fn push(&mut self, term: Term) -> TermId {
        let key = match term {
            Term::Input(axis) => Key::Input(axis),
            Term::Literal(number) => Key::Literal(number.to_bits()),
            Term::Unary(op, a) => Key::Unary(op, a),
            Term::Binary(op, a, b) if op.is_commutative() && b < a => Key::Binary(op, b, a),
            Term::Binary(op, a, b) => Key::Binary(op, a, b),
            Term::Power(a, n) => Key::Power(a, n),
        };
        if let Some(&id) = self.known.get(&key) {
            return id;
        }
        let id = TermId(self.terms.len() as u32);
        let facts = self.facts_of(term);
        self.is_faulty |= match term {
            Term::Literal(_) => false,
            Term::Binary(Binary::Div, _, b) if self.number(b) == Some(0.0) => true,
            _ => facts.axes == 0,
        };
        self.facts.push(facts);
        self.terms.push(term);
        self.known.insert(key, id);
        id
    }

    fn facts_of(&self, term: Term) -> Facts {
        let facts = |id: TermId| self.facts[id.index()];
        let axes = term.operands().fold(0, |axes, operand| axes | facts(operand).axes);
        let all_total = term.operands().all(|operand| facts(operand).is_total);
        let (is_nonnegative, is_total) = match term {
            Term::Input(axis) => return Facts { axes: 1 << axis, is_nonnegative: false, is_total: true },
            Term::Literal(number) => (number >= 0.0, true),
            Term::Unary(op, a) => {
                let a_nonnegative = facts(a).is_nonnegative;
                match op {
                    Unary::Abs | Unary::Square | Unary::Exp => (true, all_total),
                    Unary::Sqrt => (true, all_total && a_nonnegative),
                    Unary::Acos => (true, false),
                    Unary::Asin => (a_nonnegative, false),
                    Unary::Atan | Unary::Floor => (a_nonnegative, all_total),
                    Unary::Ln => (false, false),
                    Unary::Neg | Unary::Sin | Unary::Cos | Unary::Tan => (false, all_total),
                }
            }
            Term::Binary(op, a, b) => {
                let (a_nonnegative, b_nonnegative) = (facts(a).is_nonnegative, facts(b).is_nonnegative);
                let both = a_nonnegative && b_nonnegative;
                match op {
                    Binary::Add | Binary::Mul | Binary::Min => (both, all_total),
                    Binary::Max => (a_nonnegative || b_nonnegative, all_total),
                    Binary::Sub | Binary::Atan2 => (false, all_total),
                    Binary::Div => (both, all_total && self.number(b).is_some_and(|b| b != 0.0)),
                    Binary::Less => (true, all_total),
                    Binary::Pow => (a_nonnegative, all_total && a_nonnegative && b_nonnegative),
                }
            }
            Term::Power(a, n) => (n % 2 == 0 || facts(a).is_nonnegative, all_total && n > 0),
        };
        Facts { axes, is_nonnegative, is_total }
    }

    /// Whether the term is never negative.
    pub(super) fn is_nonnegative(&self, id: TermId) -> bool {
        self.facts[id.index()].is_nonnegative
    }

    /// Whether the term has a value at every finite point, apart from overflow.
    pub(super) fn is_total(&self, id: TermId) -> bool {
        self.facts[id.index()].is_total
    }

    /// The number a term is, if it is one.
    pub(super) fn number(&self, id: TermId) -> Option<f64> {
        match self.term(id) {
            Term::Literal(number) => Some(number),
            _ => None,
        }
    }

    /// A coordinate.
    pub(super) fn input(&mut self, axis: usize) -> TermId {
        self.push(Term::Input(axis))
    }

    /// A finite number.
    pub(super) fn literal(&mut self, number: f64) -> TermId {
        debug_assert!(number.is_finite(), "literals are finite");
        // 0 has no sign.
        self.push(Term::Literal(number + 0.0))
    }

    /// The number, if it is finite: what is not stays an operation.
    pub(super) fn folded(&mut self, number: f64) -> Option<TermId> {
        number.is_finite().then(|| self.literal(number))
    }
}
