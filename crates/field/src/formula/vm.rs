//! Expression graphs as text (`.vm`), the format in which implicit modelling tools exchange models.
//!
//! Each line is one operation: a name for its result, the name of the operation, and its operands, which are names from
//! lines before; the last line is the result. `#` starts a comment. The format and some of its operations are those of
//! Keeter's "Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces" (2020) and its successors.

use super::builder::Builder;
use super::names::{self, closest};
use super::{Binary, Formula, MOST_TERMS, Term, TermId, Unary};
use std::collections::HashMap;
use std::fmt::{self, Write};
use std::ops::Range;

/// A mistake in an expression graph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VmError {
    /// The line it is in, from 1.
    pub line: usize,
    /// The character of the line that it starts with, from 1.
    pub column: usize,
    /// What it is, as a sentence without the full stop.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
    /// The place, as a range of bytes in the text.
    pub span: Range<usize>,
}

impl fmt::Display for VmError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: {}", self.line, self.column, self.message)?;
        match &self.hint {
            Some(hint) => write!(f, " ({hint})"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for VmError {}

/// The names of the coordinates.
const INPUTS: [&str; 3] = ["var-x", "var-y", "var-z"];

type MakeUnary = fn(&mut Builder, TermId) -> TermId;
type MakeBinary = fn(&mut Builder, TermId, TermId) -> TermId;

const UNARY: &[(&str, MakeUnary)] = &[
    ("neg", |b, p| b.unary(Unary::Neg, p)),
    ("abs", |b, p| b.unary(Unary::Abs, p)),
    ("square", |b, p| b.unary(Unary::Square, p)),
    ("sqrt", |b, p| b.unary(Unary::Sqrt, p)),
    ("sin", |b, p| b.unary(Unary::Sin, p)),
    ("cos", |b, p| b.unary(Unary::Cos, p)),
    ("tan", |b, p| b.unary(Unary::Tan, p)),
    ("asin", |b, p| b.unary(Unary::Asin, p)),
    ("acos", |b, p| b.unary(Unary::Acos, p)),
    ("atan", |b, p| b.unary(Unary::Atan, p)),
    ("exp", |b, p| b.unary(Unary::Exp, p)),
    ("ln", |b, p| b.unary(Unary::Ln, p)),
    ("floor", |b, p| b.unary(Unary::Floor, p)),
    ("ceil", |b, p| names::ceil(b, &[p])),
    ("round", |b, p| names::round(b, &[p])),
    ("not", not),
];

const BINARY: &[(&str, MakeBinary)] = &[
    ("add", |b, p, q| b.binary(Binary::Add, p, q)),
    ("sub", |b, p, q| b.binary(Binary::Sub, p, q)),
    ("mul", |b, p, q| b.binary(Binary::Mul, p, q)),
    ("div", |b, p, q| b.binary(Binary::Div, p, q)),
    ("min", |b, p, q| b.binary(Binary::Min, p, q)),
    ("max", |b, p, q| b.binary(Binary::Max, p, q)),
    ("atan2", |b, p, q| b.binary(Binary::Atan2, p, q)),
    // The Euclidean remainder, which is never negative.
    ("mod", |b, p, q| {
        let size = b.unary(Unary::Abs, q);
        names::modulo(b, &[p, size])
    }),
    // -1, 0 or 1.
    ("compare", |b, p, q| {
        let (above, below) = (b.binary(Binary::Less, q, p), b.binary(Binary::Less, p, q));
        b.binary(Binary::Sub, above, below)
    }),
    // The second if the first is not 0, otherwise the first.
    ("and", |b, p, q| {
        let truth = truth(b, p);
        b.binary(Binary::Mul, q, truth)
    }),
    // The first if it is not 0, otherwise the second.
    ("or", |b, p, q| {
        let truth = not(b, p);
        let other = b.binary(Binary::Mul, q, truth);
        b.binary(Binary::Add, p, other)
    }),
];

/// 1 if `p` is not 0, otherwise 0.
fn truth(b: &mut Builder, p: TermId) -> TermId {
    let zero = b.literal(0.0);
    let (above, below) = (b.binary(Binary::Less, zero, p), b.binary(Binary::Less, p, zero));
    b.binary(Binary::Max, above, below)
}

/// 1 if `p` is 0, otherwise 0.
fn not(b: &mut Builder, p: TermId) -> TermId {
    let (one, truth) = (b.literal(1.0), truth(b, p));
    b.binary(Binary::Sub, one, truth)
}

impl Formula {
    /// The formula of an expression graph. Equal operations become one, those that don't matter are left out.
    ///
    /// Known are `var-x`, `var-y`, `var-z`, `const`, `neg`, `abs`, `square`, `sqrt`, `sin`, `cos`, `tan`, `asin`, `acos`,
    /// `atan`, `exp`, `ln`, `floor`, `ceil`, `round`, `not`, `add`, `sub`, `mul`, `div`, `min`, `max`, `atan2`, `mod`,
    /// `compare`, `and` and `or`.
    ///
    /// # Errors
    /// The first mistake in the text.
    pub fn from_vm(text: &str) -> Result<Self, VmError> {
        let mut builder = Builder::default();
        let mut known: HashMap<&str, TermId> = HashMap::new();
        let mut last = None;
        for (line, number) in text.lines().zip(1..) {
            let code = line.split('#').next().unwrap_or_default();
            let mut words = code.split_whitespace();
            let Some(name) = words.next() else {
                continue;
            };
            let error = |fault: Fault<'_>| VmError::new(text, number, fault);
            let op = words.next().ok_or_else(|| {
                error(Fault { word: name, message: format!("`{name}` is followed by no operation"), hint: None })
            })?;
            let operands: Vec<&str> = words.collect();
            let id = operation(&mut builder, &known, op, &operands).map_err(error)?;
            if known.insert(name, id).is_some() {
                return Err(error(Fault { word: name, message: format!("`{name}` is given twice"), hint: None }));
            }
            if builder.len() > MOST_TERMS {
                let message = format!("the graph has more than {MOST_TERMS} operations");
                return Err(error(Fault { word: name, message, hint: None }));
            }
            last = Some(id);
        }
        last.map(|result| Self::build(&builder, result)).ok_or_else(|| {
            let lines = text.lines().count().max(1);
            let hint = Some("for instance `_0 var-x`".into());
            VmError::new(
                text,
                lines,
                Fault { word: &text[text.len()..], message: "there is no operation".into(), hint },
            )
        })
    }

    /// The formula as an expression graph.
    ///
    /// The format has no powers: integer ones become products, others the exponential of a multiple of the logarithm.
    pub fn to_vm(&self) -> String {
        let mut writer = Writer::default();
        let mut names: Vec<usize> = Vec::with_capacity(self.terms().len());
        for &term in self.terms() {
            let name = |id: TermId| names[id.index()];
            let line = match term {
                Term::Input(axis) => writer.line(INPUTS[axis], &[]),
                Term::Literal(number) => writer.constant(number),
                Term::Unary(op, a) => writer.line(op.name(), &[name(a)]),
                Term::Power(a, n) => writer.power(name(a), n),
                Term::Binary(op, a, b) => writer.binary(op, name(a), name(b)),
            };
            names.push(line);
        }
        writer.text
    }
}

/// What is wrong in a line, and the word that it is about, which is part of the text.
struct Fault<'t> {
    word: &'t str,
    message: String,
    hint: Option<String>,
}

impl VmError {
    fn new(text: &str, line: usize, Fault { word, message, hint }: Fault<'_>) -> Self {
        let start = word.as_ptr().addr() - text.as_ptr().addr();
        let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let column = text[line_start..start].chars().count() + 1;
        Self { line, column, message, hint, span: start..start + word.len() }
    }
}

/// One line of a graph.
fn operation<'t>(
    b: &mut Builder,
    known: &HashMap<&str, TermId>,
    op: &'t str,
    operands: &[&'t str],
) -> Result<TermId, Fault<'t>> {
    let fault = |word: &'t str, message: String| Fault { word, message, hint: None };
    let count = |wanted: usize| match operands.len() {
        found if found == wanted => Ok(()),
        found => {
            let word = operands.get(wanted).copied().unwrap_or(op);
            let words = if wanted == 1 { "word" } else { "words" };
            Err(fault(word, format!("`{op}` is followed by {wanted} {words}, but here by {found}")))
        }
    };
    let operand = |place: usize| {
        let name = operands[place];
        known.get(name).copied().ok_or_else(|| fault(name, format!("there is no `{name}` before this line")))
    };
    if let Some(axis) = INPUTS.iter().position(|&input| input == op) {
        count(0)?;
        Ok(b.input(axis))
    } else if op == "const" {
        count(1)?;
        match operands[0].parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(b.literal(number)),
            _ => Err(fault(operands[0], format!("`{}` is no finite number", operands[0]))),
        }
    } else if let Some((_, make)) = UNARY.iter().find(|unary| unary.0 == op) {
        count(1)?;
        Ok(make(b, operand(0)?))
    } else if let Some((_, make)) = BINARY.iter().find(|binary| binary.0 == op) {
        count(2)?;
        Ok(make(b, operand(0)?, operand(1)?))
    } else {
        let others = UNARY.iter().map(|unary| unary.0).chain(BINARY.iter().map(|binary| binary.0));
        let guess = closest(op, INPUTS.into_iter().chain(["const"]).chain(others));
        let hint = guess.map(|guess| format!("did you mean `{guess}`?"));
        Err(Fault { word: op, message: format!("there is no operation `{op}`"), hint })
    }
}

/// A graph under construction.
#[derive(Default)]
struct Writer {
    text: String,
    lines: usize,
}

impl Writer {
    fn line(&mut self, op: &str, operands: &[usize]) -> usize {
        let _ = write!(self.text, "_{:x} {op}", self.lines);
        for operand in operands {
            let _ = write!(self.text, " _{operand:x}");
        }
        self.text.push('\n');
        self.lines += 1;
        self.lines - 1
    }

    fn constant(&mut self, number: f64) -> usize {
        self.line(&format!("const {number}"), &[])
    }

    fn binary(&mut self, op: Binary, a: usize, b: usize) -> usize {
        let name = match op {
            Binary::Add => "add",
            Binary::Sub => "sub",
            Binary::Mul => "mul",
            Binary::Div => "div",
            Binary::Min => "min",
            Binary::Max => "max",
            Binary::Atan2 => "atan2",
            Binary::Less => {
                // 1, 0 or -1 for a before, at or after b.
                let (order, zero) = (self.line("compare", &[b, a]), self.constant(0.0));
                return self.line("max", &[order, zero]);
            }
            Binary::Pow => {
                let ln = self.line("ln", &[a]);
                let exponent = self.line("mul", &[b, ln]);
                return self.line("exp", &[exponent]);
            }
        };
        self.line(name, &[a, b])
    }

    /// By repeated squaring, from the highest bit of the exponent down.
    fn power(&mut self, base: usize, n: i32) -> usize {
        let times = n.unsigned_abs();
        let mut power = base;
        for bit in (0..times.ilog2()).rev() {
            power = self.line("square", &[power]);
            if times >> bit & 1 == 1 {
                power = self.line("mul", &[power, base]);
            }
        }
        if n > 0 {
            return power;
        }
        let one = self.constant(1.0);
        self.line("div", &[one, power])
    }
}
