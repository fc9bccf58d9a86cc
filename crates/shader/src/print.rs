//! What the printers have in common: indentation, order of operations, comments.

use crate::tree::{Expr, Function, Item, Operator, Statement, Type};
use std::fmt::Write;

/// What differs between languages.
pub(crate) trait Language {
    /// The name of a type.
    fn of_type(&self, ty: &Type) -> String;
    /// A literal number.
    fn float(&self, number: f32) -> String;
    /// A function of the language by its name in WGSL.
    fn builtin<'n>(&self, name: &'n str) -> &'n str;
    /// An entry of the table of parameters. The place is a literal, or printed already.
    fn parameter(&self, place: Result<usize, String>) -> String;
    /// A selection, printed as an operand of the highest order.
    fn select(&self, condition: &str, yes: &str, no: &str) -> String;
    /// The name of something as the language may have it.
    fn name(&self, name: &str) -> String;
    /// A binding without `;`.
    fn binding(&self, name: &str, ty: &Type, is_variable: bool) -> String;
    /// The head of a function without `{`.
    fn head(&self, function: &Function) -> String;
    /// The head of a loop over whole numbers without `{`.
    fn count(&self, name: &str, from: &str, to: &str) -> String;
    /// The head of an endless loop without `{`.
    fn endless(&self) -> &'static str;
    /// The head of a condition without `{`.
    fn condition(&self, condition: &str) -> String;
    /// A whole structure, without its comment.
    fn structure(&self, name: &str, members: &[(String, Type)]) -> String;
    /// A constant without its value.
    fn constant(&self, name: &str, ty: &Type) -> String;
}

/// How strongly names, calls and literals bind.
const ATOM: u8 = 9;

/// How strongly signs bind.
const SIGN: u8 = 8;

/// The text of some items.
pub(crate) fn items(language: &dyn Language, items: &[Item]) -> String {
    let mut text = String::new();
    let mut was_constant = false;
    for item in items {
        let is_constant = matches!(item, Item::Constant(..));
        if !(text.is_empty() || is_constant && was_constant) {
            text.push('\n');
        }
        was_constant = is_constant;
        let mut comment = |lines: &[String]| {
            for line in lines {
                let _ = writeln!(text, "//{}{line}", if line.is_empty() { "" } else { " " });
            }
        };
        match item {
            Item::Function(function) => {
                comment(&function.comment);
                let _ = writeln!(text, "{} {{", language.head(function));
                block(language, &function.body, 1, &mut text);
                text.push_str("}\n");
            }
            Item::Struct(name, members, lines) => {
                comment(lines);
                text.push_str(&language.structure(name, members));
            }
            Item::Constant(name, ty, value, lines) => {
                comment(lines);
                let _ = writeln!(text, "{} = {};", language.constant(name, ty), expression(language, value));
            }
        }
    }
    text
}

fn block(language: &dyn Language, statements: &[Statement], depth: usize, text: &mut String) {
    for statement in statements {
        one(language, statement, depth, text);
    }
}

fn one(language: &dyn Language, statement: &Statement, depth: usize, text: &mut String) {
    let indent = "    ".repeat(depth);
    let e = |expr: &Expr| expression(language, expr);
    let _ = match statement {
        Statement::Comment(line) => writeln!(text, "{indent}// {line}"),
        Statement::Let(name, ty, value) => {
            writeln!(text, "{indent}{} = {};", language.binding(name, ty, false), e(value))
        }
        Statement::Var(name, ty, value) => {
            writeln!(text, "{indent}{} = {};", language.binding(name, ty, true), e(value))
        }
        Statement::Assign(place, value) => writeln!(text, "{indent}{} = {};", e(place), e(value)),
        Statement::Break => writeln!(text, "{indent}break;"),
        Statement::Continue => writeln!(text, "{indent}continue;"),
        Statement::Return(value) => writeln!(text, "{indent}return {};", e(value)),
        Statement::If(condition, yes, no) => {
            let _ = writeln!(text, "{indent}{} {{", language.condition(&e(condition)));
            block(language, yes, depth + 1, text);
            match no.as_slice() {
                [] => {}
                [other @ Statement::If(..)] => {
                    let _ = write!(text, "{indent}}} else ");
                    let mut rest = String::new();
                    one(language, other, depth, &mut rest);
                    text.push_str(rest.trim_start());
                    return;
                }
                _ => {
                    let _ = writeln!(text, "{indent}}} else {{");
                    block(language, no, depth + 1, text);
                }
            }
            writeln!(text, "{indent}}}")
        }
        Statement::Count(name, from, to, body) => {
            let _ = writeln!(text, "{indent}{} {{", language.count(&language.name(name), &e(from), &e(to)));
            block(language, body, depth + 1, text);
            writeln!(text, "{indent}}}")
        }
        Statement::Loop(body) => {
            let _ = writeln!(text, "{indent}{} {{", language.endless());
            block(language, body, depth + 1, text);
            writeln!(text, "{indent}}}")
        }
    };
}

/// The text of an expression.
pub(crate) fn expression(language: &dyn Language, expr: &Expr) -> String {
    written(language, expr).0
}

/// The text of an expression as an operand: in parentheses if it binds less strongly than `least`.
fn operand(language: &dyn Language, expr: &Expr, least: u8) -> String {
    let (text, strength) = written(language, expr);
    if strength < least { format!("({text})") } else { text }
}

fn written(language: &dyn Language, expr: &Expr) -> (String, u8) {
    let list = |parts: &[Expr]| parts.iter().map(|part| expression(language, part)).collect::<Vec<_>>().join(", ");
    match expr {
        Expr::Bool(value) => (value.to_string(), ATOM),
        Expr::Int(value) if *value < 0 => (value.to_string(), SIGN),
        Expr::Int(value) => (value.to_string(), ATOM),
        Expr::Float(value) => (language.float(*value), if *value < 0.0 { SIGN } else { ATOM }),
        Expr::Name(name) => (language.name(name), ATOM),
        Expr::Parameter(place) => {
            let place = match place.as_ref() {
                Expr::Int(place) => Ok(usize::try_from(*place).unwrap_or(0)),
                place => Err(expression(language, place)),
            };
            (language.parameter(place), ATOM)
        }
        Expr::Member(of, name) => (format!("{}.{name}", operand(language, of, ATOM)), ATOM),
        Expr::Index(of, place) => (format!("{}[{}]", operand(language, of, ATOM), expression(language, place)), ATOM),
        Expr::Negate(a) => (format!("-{}", operand(language, a, ATOM)), SIGN),
        Expr::Not(a) => (format!("!{}", operand(language, a, ATOM)), SIGN),
        Expr::Binary(op, a, b) => {
            let own = op.precedence();
            // WGSL wants parentheses between different logical operators, and comparisons don't chain.
            let is_chain = matches!(op, Operator::Add | Operator::Sub | Operator::Mul | Operator::Div | Operator::Rem);
            let is_logic = matches!(op, Operator::And | Operator::Or);
            let left = match a.as_ref() {
                Expr::Binary(other, ..) if other == op && (is_chain || is_logic) => own,
                _ if is_logic => Operator::Equal.precedence(),
                _ if is_chain => own,
                _ => own + 1,
            };
            let right = if is_logic { Operator::Equal.precedence() } else { own + 1 };
            let (a, b) = (operand(language, a, left), operand(language, b, right));
            (format!("{a} {} {b}", op.sign()), own)
        }
        Expr::Call(name, parts) => {
            let name = language.name(language.builtin(name));
            (format!("{name}({})", list(parts)), ATOM)
        }
        Expr::Make(ty, parts) => (format!("{}({})", language.of_type(ty), list(parts)), ATOM),
        Expr::Select(condition, yes, no) => {
            let [condition, yes, no] = [condition, yes, no].map(|part| expression(language, part));
            (language.select(&condition, &yes, &no), ATOM)
        }
    }
}

/// A number as all languages read it: with a point or an exponent, and finite.
pub(crate) fn decimal(number: f32) -> String {
    let number = if number.is_nan() { 0.0 } else { number.clamp(f32::MIN, f32::MAX) };
    let text = format!("{number:?}");
    // A long row of digits is the same number with an exponent.
    match text.strip_suffix(".0") {
        Some(digits) if digits.trim_start_matches('-').len() > 9 => format!("{number:e}"),
        _ => text,
    }
}
