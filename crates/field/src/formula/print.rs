//! Printing: from terms to the language they are read from, with no parentheses that it can do without.
//!
//! A term that is used more than once is printed each time, as people would write it, unless that makes the text much
//! longer than the list of terms; then such terms get definitions, and so do terms nested too deep to be read back.

use super::names::COORDINATES;
use super::parse::MOST_NESTED;
use super::{Binary, Term, TermId, Unary};
use std::f64::consts;
use std::fmt::Write;

/// Up to so many operations, and so many for each term, a formula is printed without definitions.
const SHORT: u64 = 100;
const REPETITIONS: u64 = 3;

/// Deeper nesting is cut up by definitions.
const DEEPEST: usize = MOST_NESTED / 2;

/// How tightly an operation holds its operands together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Power,
    Atom,
}

/// What is to be printed next.
enum Piece {
    Text(&'static str),
    Number(f64),
    Integer(i32),
    /// A term, in parentheses if it is below the level.
    Term(TermId, Level),
    /// The operands of nested minima or maxima.
    Operands(Binary, TermId),
    /// A term as the exponent of a power.
    Exponent(TermId),
}

/// The text for the last one of `terms`.
pub(super) fn print(terms: &[Term]) -> String {
    let mut printer = Printer { terms, names: vec![0; terms.len()], text: String::new() };
    let last = terms.len() - 1;
    for (place, id) in printer.definitions().into_iter().enumerate() {
        let _ = write!(printer.text, "t{} = ", place + 1);
        printer.value(id);
        printer.text.push_str("; ");
        printer.names[id.index()] = place + 1;
    }
    printer.value(TermId(last as u32));
    printer.text
}

struct Printer<'t> {
    terms: &'t [Term],
    /// The number of the definition of each term that has one, from 1.
    names: Vec<usize>,
    text: String,
}

impl Printer<'_> {
    /// The terms that get definitions.
    fn definitions(&mut self) -> Vec<TermId> {
        let ids = || (0..self.terms.len() as u32).map(TermId);
        let mut sizes = vec![1_u64; self.terms.len()];
        for id in ids() {
            let operands = self.terms[id.index()].operands();
            sizes[id.index()] = operands.fold(1, |size, operand| size.saturating_add(sizes[operand.index()]));
        }
        let is_short = sizes[self.terms.len() - 1] <= SHORT + REPETITIONS * self.terms.len() as u64;
        let mut uses = vec![0_u32; self.terms.len()];
        for operand in self.terms.iter().flat_map(|term| term.operands()) {
            uses[operand.index()] += 1;
        }
        let mut definitions = Vec::new();
        let mut depths = vec![0_usize; self.terms.len()];
        for id in ids() {
            let term = self.terms[id.index()];
            if term.operands().next().is_none() {
                continue;
            }
            let depth = self.depth(term, &depths);
            let is_last = id.index() + 1 == self.terms.len();
            if !is_last && ((!is_short && uses[id.index()] > 1) || depth >= DEEPEST) {
                definitions.push(id);
            } else {
                depths[id.index()] = depth;
            }
        }
        definitions
    }

    /// At most how many levels further in than `term` parts of it are read.
    fn depth(&self, term: Term, depths: &[usize]) -> usize {
        let inside = |id: TermId, level| depths[id.index()] + usize::from(self.level(id) < level);
        let within = |id: TermId| depths[id.index()] + 1;
        match term {
            Term::Input(_) | Term::Literal(_) => 0,
            Term::Binary(Binary::Add | Binary::Sub, a, b) => inside(a, Level::Sum).max(inside(b, Level::Product)),
            Term::Binary(Binary::Mul | Binary::Div, a, b) => inside(a, Level::Product).max(inside(b, Level::Power)),
            Term::Binary(op @ (Binary::Min | Binary::Max), a, b) => {
                let is_joined = matches!(self.terms[a.index()], Term::Binary(own, ..) if own == op);
                within(b).max(if is_joined { depths[a.index()] } else { within(a) })
            }
            Term::Unary(_, a) | Term::Power(a, _) => within(a),
            Term::Binary(_, a, b) => within(a).max(within(b)),
        }
    }

    fn value(&mut self, id: TermId) {
        let mut pieces = vec![Piece::Term(id, Level::Sum)];
        while let Some(piece) = pieces.pop() {
            match piece {
                Piece::Text(text) => self.text.push_str(text),
                Piece::Number(number) => self.number(number),
                Piece::Integer(number) => {
                    let _ = write!(self.text, "{number}");
                }
                Piece::Term(id, level) if self.level(id) < level => {
                    self.text.push('(');
                    pieces.extend([Piece::Text(")"), Piece::Term(id, Level::Sum)]);
                }
                Piece::Term(id, _) => match self.names[id.index()] {
                    0 => pieces.extend(self.pieces(id).into_iter().rev()),
                    name => {
                        let _ = write!(self.text, "t{name}");
                    }
                },
                Piece::Operands(op, id) => match self.inline(id) {
                    Some(Term::Binary(own, a, b)) if own == op => {
                        let rest = [Piece::Term(b, Level::Sum), Piece::Text(", "), Piece::Operands(op, a)];
                        pieces.extend(rest);
                    }
                    _ => pieces.push(Piece::Term(id, Level::Sum)),
                },
                Piece::Exponent(id) => match self.inline(id) {
                    Some(Term::Literal(number)) => self.number(number),
                    Some(Term::Unary(Unary::Neg, a)) if self.level(a) >= Level::Power => {
                        pieces.extend([Piece::Term(a, Level::Power), Piece::Text("-")]);
                    }
                    _ => pieces.push(Piece::Term(id, Level::Power)),
                },
            }
        }
    }

    /// The term, unless it has a definition.
    fn inline(&self, id: TermId) -> Option<Term> {
        (self.names[id.index()] == 0).then(|| self.terms[id.index()])
    }

    fn number_of(&self, id: TermId) -> Option<f64> {
        match self.terms[id.index()] {
            Term::Literal(number) => Some(number),
            _ => None,
        }
    }

    fn level(&self, id: TermId) -> Level {
        match self.inline(id) {
            None | Some(Term::Input(_)) => Level::Atom,
            Some(Term::Literal(number)) if number < 0.0 => Level::Product,
            Some(Term::Literal(_)) => Level::Atom,
            Some(Term::Unary(Unary::Neg, _)) => Level::Product,
            Some(Term::Unary(Unary::Square, _) | Term::Power(..) | Term::Binary(Binary::Pow, ..)) => Level::Power,
            Some(Term::Binary(Binary::Add | Binary::Sub, ..)) => Level::Sum,
            Some(Term::Binary(Binary::Mul | Binary::Div, ..)) => Level::Product,
            Some(Term::Unary(..) | Term::Binary(..)) => Level::Atom,
        }
    }

    /// What a term is printed as.
    fn pieces(&self, id: TermId) -> Vec<Piece> {
        use Piece::{Exponent, Integer, Number, Operands, Text};
        let term = Piece::Term;
        match self.terms[id.index()] {
            Term::Input(axis) => vec![Text(COORDINATES[axis])],
            Term::Literal(number) => vec![Number(number)],
            Term::Unary(Unary::Neg, a) if self.begins_with_sign(a) => vec![Text("-"), term(a, Level::Atom)],
            Term::Unary(Unary::Neg, a) => vec![Text("-"), term(a, Level::Product)],
            Term::Unary(Unary::Square, a) => vec![term(a, Level::Atom), Text("^2")],
            Term::Power(a, n) => vec![term(a, Level::Atom), Text("^"), Integer(n)],
            Term::Unary(op, a) => vec![Text(op.name()), Text("("), term(a, Level::Sum), Text(")")],
            Term::Binary(Binary::Add, a, b) => match self.number_of(b) {
                Some(c @ ..0.0) => vec![term(a, Level::Sum), Text(" - "), Number(-c)],
                _ => vec![term(a, Level::Sum), Text(" + "), term(b, Level::Product)],
            },
            Term::Binary(Binary::Sub, a, b) => vec![term(a, Level::Sum), Text(" - "), term(b, Level::Product)],
            Term::Binary(Binary::Mul, a, b) => match self.number_of(b) {
                Some(c) if self.level(a) != Level::Product => vec![Number(c), Text(" * "), term(a, Level::Power)],
                Some(c) => vec![term(a, Level::Product), Text(" * "), Number(c)],
                None => vec![term(a, Level::Product), Text(" * "), term(b, Level::Power)],
            },
            Term::Binary(Binary::Div, a, b) => vec![term(a, Level::Product), Text(" / "), term(b, Level::Power)],
            Term::Binary(Binary::Pow, a, b) => vec![term(a, Level::Atom), Text("^"), Exponent(b)],
            Term::Binary(Binary::Min, ..) => vec![Text("min("), Operands(Binary::Min, id), Text(")")],
            Term::Binary(Binary::Max, ..) => vec![Text("max("), Operands(Binary::Max, id), Text(")")],
            Term::Binary(op @ (Binary::Atan2 | Binary::Less), a, b) => {
                let name = if op == Binary::Less { "less(" } else { "atan2(" };
                vec![Text(name), term(a, Level::Sum), Text(", "), term(b, Level::Sum), Text(")")]
            }
        }
    }

    /// Whether a minus before the print of a product or quotient would be taken for the sign of a part of it: of a number
    /// or a difference.
    fn begins_with_sign(&self, mut id: TermId) -> bool {
        loop {
            id = match self.inline(id) {
                Some(Term::Literal(_) | Term::Binary(Binary::Sub, ..)) => return true,
                Some(Term::Binary(Binary::Add, _, b)) => return self.number_of(b).is_some(),
                Some(Term::Binary(Binary::Mul, _, b)) if self.number_of(b).is_some() => return true,
                Some(Term::Binary(Binary::Mul | Binary::Div, a, _)) => a,
                _ => return false,
            }
        }
    }

    fn number(&mut self, number: f64) {
        let size = number.abs();
        let sign = if number < 0.0 { "-" } else { "" };
        let _ = match size {
            consts::PI => write!(self.text, "{sign}pi"),
            consts::TAU => write!(self.text, "{sign}tau"),
            0.0 | 1e-4..1e15 => write!(self.text, "{number}"),
            _ => write!(self.text, "{number:e}"),
        };
    }
}
