//! From graphs of formulas to statements.
//!
//! What is used once is written where it is used, so that the text reads like the formula; what is used several times gets a
//! name. Only what the results depend on is written at all, of the states of loops too.

use crate::tree::{Expr, Operator, Statement, Type};
use freikugel_field::expr::{self, Binary, Graph, Loop, Term, Unary};

/// An expression with more parts than this is given a name, so that lines stay readable.
const MOST_PARTS: usize = 16;

/// Statements that compute some results of a graph, and the results.
pub(crate) fn statements(
    graph: &Graph,
    results: &[expr::Expr<'_>],
    inputs: &[Expr],
    table: &dyn Table,
) -> (Vec<Statement>, Vec<Expr>) {
    let (terms, loops, owners) = (graph.terms(), graph.loops(), graph.owners());
    let results: Vec<u32> = results.iter().map(|result| result.id()).collect();
    let uses = Uses::of(&terms, &loops, &owners, &results);
    let count = terms.len();
    let mut writer =
        Writer { terms, loops, owners, uses, inputs, table, written: vec![None; count], run: Vec::new(), names: 0 };
    let body = writer.block(None);
    let results = results.iter().map(|&id| writer.operand(id)).collect();
    (body, results)
}

/// Where constants are read from.
pub(crate) trait Table {
    /// A constant by its place.
    fn slot(&self, slot: usize) -> Expr;

    /// How many rows a list has that had so many when the formula was recorded.
    fn rows(&self, recorded: u32) -> Expr {
        Expr::Int(recorded.into())
    }
}

impl<F: Fn(usize) -> Expr> Table for F {
    fn slot(&self, slot: usize) -> Expr {
        self(slot)
    }
}

/// How often each term is read, and whether a reader is in another block.
struct Uses {
    count: Vec<u32>,
    is_read_elsewhere: Vec<bool>,
}

impl Uses {
    fn of(terms: &[Term], loops: &[Loop], owners: &[Option<u32>], results: &[u32]) -> Self {
        let mut uses = Self { count: vec![0; terms.len()], is_read_elsewhere: vec![false; terms.len()] };
        let mut is_live = vec![false; terms.len()];
        let mut live_states: Vec<Vec<bool>> = loops.iter().map(|l| vec![false; l.start.len()]).collect();
        let mut pending: Vec<(u32, Option<Option<u32>>)> = results.iter().map(|&id| (id, Some(None))).collect();
        while let Some((id, reader)) = pending.pop() {
            let own = id as usize;
            uses.count[own] += 1;
            uses.is_read_elsewhere[own] |= reader.is_some_and(|reader| reader != owners[own]);
            if std::mem::replace(&mut is_live[own], true) {
                continue;
            }
            let mut read = |id: u32| pending.push((id, Some(owners[own])));
            match terms[own] {
                Term::Input(_) | Term::Slot(_) | Term::Literal(_) => {}
                Term::Unary(_, a) | Term::Entry(_, a) => read(a),
                Term::Binary(_, a, b) | Term::Length(a, b, None) => [a, b].into_iter().for_each(read),
                Term::Length(a, b, Some(c)) | Term::Select(a, b, c) => [a, b, c].into_iter().for_each(read),
                // The loop itself stands there as soon as one of its results is read.
                Term::RowSlot(..) => {}
                Term::State(l, place) | Term::Result(l, place) => {
                    let (this, states) = (&loops[l as usize], &mut live_states[l as usize]);
                    if !states.contains(&true) {
                        pending.extend(this.go_on.map(|id| (id, Some(Some(l)))));
                    }
                    if !std::mem::replace(&mut states[place as usize], true) {
                        // The start is computed before the loop, wherever that is.
                        pending.push((this.start[place as usize], None));
                        pending.push((this.next[place as usize], Some(Some(l))));
                    }
                }
            }
        }
        uses
    }
}

struct Writer<'a> {
    terms: Vec<Term>,
    loops: Vec<Loop>,
    owners: Vec<Option<u32>>,
    uses: Uses,
    inputs: &'a [Expr],
    table: &'a dyn Table,
    /// What stands for a term where it is read.
    written: Vec<Option<Expr>>,
    /// Loops that stand there already.
    run: Vec<u32>,
    names: usize,
}

impl Writer<'_> {
    fn block(&mut self, owner: Option<u32>) -> Vec<Statement> {
        let mut body = Vec::new();
        for id in 0..self.terms.len() {
            if self.owners[id] != owner || self.uses.count[id] == 0 {
                continue;
            }
            if let Term::Result(l, _) = self.terms[id]
                && !self.run.contains(&l)
            {
                self.run.push(l);
                self.run_loop(l, &mut body);
            }
            let Some(value) = self.value(id as u32) else { continue };
            let is_shared = self.uses.count[id] > 1 || self.uses.is_read_elsewhere[id];
            let is_kept = match value {
                Expr::Name(_) | Expr::Float(_) | Expr::Member(..) => false,
                _ => is_shared || size(&value) > MOST_PARTS,
            };
            self.written[id] = Some(if is_kept {
                self.names += 1;
                let name = format!("t{}", self.names);
                body.push(Statement::Let(name.clone(), self.ty(id), value));
                Expr::Name(name)
            } else {
                value
            });
        }
        body
    }

    fn ty(&self, id: usize) -> Type {
        match self.terms[id] {
            Term::Unary(Unary::Not, _) | Term::Binary(Binary::Less | Binary::And | Binary::Or, ..) => Type::Bool,
            _ => Type::Float,
        }
    }

    fn run_loop(&mut self, l: u32, body: &mut Vec<Statement>) {
        let Loop { limit, start, next, go_on, row } = self.loops[l as usize].clone();
        let is_live = |writer: &Self, place: usize| {
            writer.terms.iter().enumerate().any(|(id, term)| match *term {
                Term::State(of, at) | Term::Result(of, at) => {
                    of == l && at as usize == place && writer.uses.count[id] > 0
                }
                _ => false,
            })
        };
        let live: Vec<usize> = (0..start.len()).filter(|&place| is_live(self, place)).collect();
        for &place in &live {
            body.push(Statement::Var(state(l, place), Type::Float, self.operand(start[place])));
        }
        let mut inner = self.block(Some(l));
        // A state may be another one's next value, so that all are read before the first one changes.
        let mut changes = Vec::new();
        for &place in &live {
            let value = match self.operand(next[place]) {
                Expr::Name(name) if name == state(l, place) => continue,
                value @ Expr::Float(_) => value,
                Expr::Name(name) if !name.starts_with('s') => Expr::Name(name),
                value if live.len() == 1 => value,
                value => {
                    let name = format!("n{l}_{place}");
                    inner.push(Statement::Let(name.clone(), Type::Float, value));
                    Expr::Name(name)
                }
            };
            changes.push(Statement::Assign(Expr::Name(state(l, place)), value));
        }
        let goes_on = go_on.map(|id| match self.operand(id) {
            name @ Expr::Name(_) => name,
            value => {
                let name = format!("goes_on{l}");
                inner.push(Statement::Let(name.clone(), Type::Bool, value));
                Expr::Name(name)
            }
        });
        inner.append(&mut changes);
        if let Some(goes_on) = goes_on {
            inner.push(Statement::If(Expr::Not(Box::new(goes_on)), vec![Statement::Break], Vec::new()));
        }
        let limit = if row.is_some() { self.table.rows(limit) } else { Expr::Int(limit.into()) };
        body.push(Statement::Count(counter(l), Expr::Int(0), limit, inner));
    }

    /// An entry of the table so many places after a slot.
    fn moved_slot(&self, slot: u32, places: Expr) -> Expr {
        match self.table.slot(slot as usize) {
            Expr::Parameter(place) => Expr::Parameter(Box::new(*place + places)),
            _ => unreachable!("lists are read from the table"),
        }
    }

    fn operand(&self, id: u32) -> Expr {
        match &self.written[id as usize] {
            Some(expr) => expr.clone(),
            None => self.value(id).expect("operands are written before what reads them"),
        }
    }

    /// A term in terms of what stands for its operands.
    fn value(&self, id: u32) -> Option<Expr> {
        let literal = |id: u32| match self.terms[id as usize] {
            Term::Literal(bits) => Some(f64::from_bits(bits)),
            _ => None,
        };
        Some(match self.terms[id as usize] {
            Term::Input(input) => self.inputs[input as usize].clone(),
            Term::Slot(slot) => self.table.slot(slot as usize),
            Term::RowSlot(l, slot) => {
                let width = self.loops[l as usize].row.unwrap_or(0);
                self.moved_slot(slot, Expr::Name(counter(l)) * Expr::Int(width.into()))
            }
            Term::Entry(slot, index) => self.moved_slot(slot, Expr::Make(Type::Int, vec![self.operand(index)])),
            Term::Literal(bits) => Expr::Float(f64::from_bits(bits) as f32),
            Term::State(l, place) | Term::Result(l, place) => Expr::Name(state(l, place as usize)),
            Term::Unary(op, a) => {
                let a = self.operand(a);
                let name = match op {
                    Unary::Neg => {
                        return Some(match a {
                            Expr::Float(number) => Expr::Float(-number),
                            a => Expr::Negate(Box::new(a)),
                        });
                    }
                    Unary::Not => return Some(Expr::Not(Box::new(a))),
                    Unary::Abs => "abs",
                    Unary::Sqrt => "sqrt",
                    Unary::Floor => "floor",
                    Unary::Sin => "sin",
                    Unary::Cos => "cos",
                    Unary::Tan => "tan",
                    Unary::Asin => "asin",
                    Unary::Acos => "acos",
                    Unary::Atan => "atan",
                    Unary::Exp => "exp",
                    Unary::Ln => "log",
                };
                Expr::call(name, [a])
            }
            Term::Binary(Binary::Pow, base, exponent) => {
                power(self.operand(base), self.operand(exponent), literal(exponent))
            }
            Term::Binary(op, a, b) => {
                let (a, b) = (self.operand(a), self.operand(b));
                match op {
                    Binary::Add => a + b,
                    Binary::Sub => a - b,
                    Binary::Mul => a * b,
                    Binary::Div => a / b,
                    Binary::Min => Expr::call("min", [a, b]),
                    Binary::Max => Expr::call("max", [a, b]),
                    Binary::Atan2 => Expr::call("atan2", [a, b]),
                    Binary::Pow => unreachable!("written by itself"),
                    Binary::Less => Expr::binary(Operator::Less, a, b),
                    Binary::And => Expr::binary(Operator::And, a, b),
                    Binary::Or => Expr::binary(Operator::Or, a, b),
                }
            }
            Term::Length(a, b, c) => {
                let parts = [Some(a), Some(b), c].into_iter().flatten().map(|id| self.operand(id));
                Expr::call("length", [swizzled(Expr::vector(parts))])
            }
            Term::Select(c, yes, no) => Expr::select(self.operand(c), self.operand(yes), self.operand(no)),
        })
    }
}

/// The variable that counts the steps of a loop.
fn counter(l: u32) -> String {
    format!("i{l}")
}

/// The variable of a number in a loop's state.
fn state(l: u32, place: usize) -> String {
    format!("s{l}_{place}")
}

/// How many operations an expression holds.
fn size(expr: &Expr) -> usize {
    let own = usize::from(!matches!(expr, Expr::Float(_) | Expr::Name(_) | Expr::Member(..) | Expr::Parameter(_)));
    own + expr.parts().into_iter().map(size).sum::<usize>()
}

/// Shading languages leave powers of negative bases undefined, so that they are made of the absolute value's.
fn power(base: Expr, exponent: Expr, known: Option<f64>) -> Expr {
    let positive = |base: Expr, exponent| Expr::call("pow", [Expr::call("abs", [base]), exponent]);
    match known {
        Some(0.0) => Expr::Float(1.0),
        Some(n) if n % 2.0 == 0.0 => positive(base, exponent),
        Some(n) if n % 1.0 == 0.0 => Expr::call("sign", [base.clone()]) * positive(base, exponent),
        Some(_) => Expr::call("pow", [base, exponent]),
        None => Expr::call("power", [base, exponent]),
    }
}

/// A vector of components of one vector, written as such.
fn swizzled(vector: Expr) -> Expr {
    if let Expr::Make(Type::Vector(_), parts) = &vector {
        let mut of = None;
        let mut letters = String::new();
        for part in parts {
            match part {
                Expr::Member(base, letter) if of.is_none_or(|of: &Expr| of == base.as_ref()) => {
                    of = Some(base.as_ref());
                    letters.push_str(letter);
                }
                _ => return vector,
            }
        }
        if let Some(of) = of {
            return if letters == "xyz" && parts.len() == 3 { of.clone() } else { of.clone().member(&letters) };
        }
    }
    vector
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::{Function, Item};
    use freikugel_field::Scalar;
    use freikugel_field::expr::Slots;

    #[test]
    fn all_functions_become_valid_text() {
        let graph = Graph::new();
        let [x, y, _] = graph.point();
        let slot = x.constants(&Slots::at(0), 1).at(0);
        let cases = [
            (x.sin(), "sin(p.x)"),
            (x.cos(), "cos(p.x)"),
            (x.tan(), "tan(p.x)"),
            (x.asin(), "asin(p.x)"),
            (x.acos(), "acos(p.x)"),
            (x.atan(), "atan(p.x)"),
            (x.exp(), "exp(p.x)"),
            (x.ln(), "log(p.x)"),
            (x.sqrt(), "sqrt(p.x)"),
            (x.abs(), "abs(p.x)"),
            (x.floor(), "floor(p.x)"),
            (x.atan2(y), "atan2(p.x, p.y)"),
            (x.pow(y), "power(p.x, p.y)"),
            (x.pow(slot), "power(p.x, parameters[1].w)"),
            (x.pow(x.lift(-2.0)), "pow(abs(p.x), -2.0)"),
            (x.pow(x.lift(0.0)), "1.0"),
            (x.pow(x.lift(2.0)), "pow(abs(p.x), 2.0)"),
            (x.pow(x.lift(5.0)), "sign(p.x) * pow(abs(p.x), 5.0)"),
            (x.pow(x.lift(0.5)), "pow(p.x, 0.5)"),
        ];
        let inputs = ["x", "y", "z"].map(|axis| Expr::name("p").member(axis));
        let parameter = |slot: usize| Expr::Parameter(Box::new(Expr::Int(7 + slot as i64)));
        for (case, expected) in cases {
            let (mut body, mut results) = statements(&graph, &[case], &inputs, &parameter);
            body.push(Statement::Return(results.remove(0)));
            let function = Function {
                name: "example".into(),
                comment: Vec::new(),
                arguments: vec![("p".into(), Type::Vector(3))],
                result: Type::Float,
                body,
            };
            let mut items = crate::parse::parse(include_str!("library/basics.wgsl")).expect("the library is sound");
            items.push(Item::Function(function));
            let text = crate::wgsl::items(&crate::module::needed(&items, &["example"]));
            assert!(text.contains(&format!("return {expected};")), "{expected} in\n{text}");
            let table = "@group(0) @binding(0) var<uniform> parameters: array<vec4<f32>, 2>;\n";
            crate::target::validated(&(table.to_owned() + &text)).unwrap_or_else(|error| panic!("{error}\n{text}"));
        }
    }
}
