//! A graph as text of the WebGPU Shading Language.
//!
//! One `let` for each term, so that the text follows the formula. Constants are read from `parameters`, a storage array
//! that the shader around it declares: changing a number never changes the text.

use super::{Binary, Expr, Graph, Loop, Term, Unary};
use std::fmt::Write;

/// A function `fn NAME(p: vec3<f32>) -> f32` that computes `result`.
pub fn function(name: &str, graph: &Graph, result: Expr<'_>) -> String {
    let (terms, loops, owners) = (graph.terms(), graph.loops(), graph.owners());
    let mut printer = Printer { terms, loops, owners, started: Vec::new(), text: String::new() };
    let _ = writeln!(printer.text, "fn {name}(p: vec3<f32>) -> f32 {{");
    printer.block(None, 1);
    let _ = writeln!(printer.text, "    return {};\n}}", printer.operand(result.id()));
    printer.text
}

/// The declaration of `parameters` that the functions read from.
pub const PARAMETERS: &str = "@group(0) @binding(0) var<storage, read> parameters: array<f32>;\n";

struct Printer {
    terms: Vec<Term>,
    loops: Vec<Loop>,
    owners: Vec<Option<u32>>,
    started: Vec<u32>,
    text: String,
}

impl Printer {
    fn block(&mut self, owner: Option<u32>, depth: usize) {
        let indent = "    ".repeat(depth);
        for id in 0..self.terms.len() {
            if self.owners[id] != owner {
                continue;
            }
            let value = match self.terms[id] {
                // Printed where they are used.
                Term::Input(_) | Term::Slot(_) | Term::Literal(_) | Term::State(..) => continue,
                Term::Result(l, _) => {
                    if !self.started.contains(&l) {
                        self.started.push(l);
                        self.print_loop(l, depth);
                    }
                    continue;
                }
                Term::Unary(op, a) => {
                    let a = self.operand(a);
                    match op {
                        Unary::Neg => format!("-{a}"),
                        Unary::Abs => format!("abs({a})"),
                        Unary::Sqrt => format!("sqrt({a})"),
                        Unary::Sin => format!("sin({a})"),
                        Unary::Cos => format!("cos({a})"),
                        Unary::Tan => format!("tan({a})"),
                        Unary::Asin => format!("asin({a})"),
                        Unary::Acos => format!("acos({a})"),
                        Unary::Atan => format!("atan({a})"),
                        Unary::Exp => format!("exp({a})"),
                        Unary::Ln => format!("log({a})"),
                        Unary::Floor => format!("floor({a})"),
                        Unary::Not => format!("!{a}"),
                    }
                }
                Term::Binary(Binary::Pow, a, b) => self.power(a, b),
                Term::Binary(op, a, b) => {
                    let (a, b) = (self.operand(a), self.operand(b));
                    match op {
                        Binary::Add => format!("{a} + {b}"),
                        Binary::Sub => format!("{a} - {b}"),
                        Binary::Mul => format!("{a} * {b}"),
                        Binary::Div => format!("{a} / {b}"),
                        Binary::Min => format!("min({a}, {b})"),
                        Binary::Max => format!("max({a}, {b})"),
                        Binary::Atan2 => format!("atan2({a}, {b})"),
                        Binary::Pow => unreachable!("printed by itself"),
                        Binary::Less => format!("{a} < {b}"),
                        Binary::And => format!("{a} && {b}"),
                        Binary::Or => format!("{a} || {b}"),
                    }
                }
                Term::Length(a, b, None) => {
                    format!("length(vec2<f32>({}, {}))", self.operand(a), self.operand(b))
                }
                Term::Length(a, b, Some(c)) => {
                    format!("length(vec3<f32>({}, {}, {}))", self.operand(a), self.operand(b), self.operand(c))
                }
                Term::Select(c, yes, no) => {
                    format!("select({}, {}, {})", self.operand(no), self.operand(yes), self.operand(c))
                }
            };
            let _ = writeln!(self.text, "{indent}let e{id} = {value};");
        }
    }

    fn print_loop(&mut self, l: u32, depth: usize) {
        let indent = "    ".repeat(depth);
        let this = self.loops[l as usize].clone();
        for (place, &start) in this.start.iter().enumerate() {
            let start = self.operand(start);
            let _ = writeln!(self.text, "{indent}var s{l}_{place} = {start};");
        }
        let _ = writeln!(self.text, "{indent}for (var i{l} = 0u; i{l} < {}u; i{l}++) {{", this.limit);
        self.block(Some(l), depth + 1);
        // All new values are computed before the first one is stored: a state may be another one's next value.
        for (place, &next) in this.next.iter().enumerate() {
            let next = self.operand(next);
            let _ = writeln!(self.text, "{indent}    let n{l}_{place} = {next};");
        }
        for place in 0..this.next.len() {
            let _ = writeln!(self.text, "{indent}    s{l}_{place} = n{l}_{place};");
        }
        let go_on = self.operand(this.go_on);
        let _ = writeln!(self.text, "{indent}    if !({go_on}) {{ break; }}\n{indent}}}");
    }

    /// The shading language leaves powers of negative bases undefined, so that they are made of the absolute value's.
    fn power(&self, base: u32, exponent: u32) -> String {
        let (a, b) = (self.operand(base), self.operand(exponent));
        match self.terms[exponent as usize] {
            Term::Literal(bits) => match f64::from_bits(bits) {
                0.0 => "1f".into(),
                n if n % 2.0 == 0.0 => format!("pow(abs({a}), {b})"),
                n if n % 1.0 == 0.0 => format!("sign({a}) * pow(abs({a}), {b})"),
                _ => format!("pow({a}, {b})"),
            },
            _ => {
                let sign = format!("select(1f, -1f, {a} < 0f && fract(0.5f * {b}) != 0f)");
                format!("select({sign} * pow(abs({a}), {b}), 1f, {b} == 0f)")
            }
        }
    }

    fn operand(&self, id: u32) -> String {
        match self.terms[id as usize] {
            Term::Input(axis) => ["p.x", "p.y", "p.z"][axis as usize].into(),
            Term::Slot(slot) => format!("parameters[{slot}]"),
            Term::Literal(bits) => {
                let number = f64::from_bits(bits) as f32;
                if number < 0.0 { format!("({number:?}f)") } else { format!("{number:?}f") }
            }
            Term::State(l, place) | Term::Result(l, place) => format!("s{l}_{place}"),
            _ => format!("e{id}"),
        }
    }
}
