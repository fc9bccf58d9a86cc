//! Words of the formula language.

use super::error::FormulaError;
use std::ops::Range;

/// The kinds of words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Number(f64),
    Name,
    Plus,
    Minus,
    Times,
    Divide,
    Power,
    /// An exponent in superscript digits.
    Raised(i32),
    Open,
    Close,
    Comma,
    /// The point before the letters of a vector's parts.
    Dot,
    Semicolon,
    Equals,
    End,
}

impl Kind {
    /// Whether it stands between two operands.
    pub(super) fn is_operator(self) -> bool {
        matches!(self, Self::Plus | Self::Minus | Self::Times | Self::Divide | Self::Power)
    }

    /// Whether an operand can begin with it, signs aside.
    pub(super) fn is_operand(self) -> bool {
        matches!(self, Self::Number(_) | Self::Name | Self::Open)
    }
}

/// A word with its place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) span: Range<usize>,
}

/// Cuts a text into words.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lexer<'t> {
    text: &'t str,
    at: usize,
}

const SHAPE_HINT: &str = "a solid is where its formula is negative: for left < right, write left - right";
const CONDITION_HINT: &str = "less(a, b) is 1 where a < b and 0 elsewhere";

impl<'t> Lexer<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        Self { text, at: 0 }
    }

    /// The next word; [`Kind::End`] for ever after the last one.
    pub(super) fn next(&mut self) -> Result<Token, FormulaError> {
        let rest = self.text[self.at..].trim_start();
        let start = self.text.len() - rest.len();
        let Some(first) = rest.chars().next() else {
            self.at = self.text.len();
            return Ok(Token { kind: Kind::End, span: start..start });
        };
        let (kind, length) = match first {
            '.' if rest[1..].starts_with(|c: char| c.is_ascii_alphabetic()) => (Kind::Dot, 1),
            '0'..='9' | '.' => self.number(start, rest)?,
            'a'..='z' | 'A'..='Z' | '_' => (Kind::Name, run(rest, |c| c.is_ascii_alphanumeric() || c == '_')),
            'π' | 'τ' => (Kind::Name, first.len_utf8()),
            '*' if rest.starts_with("**") => (Kind::Power, 2),
            _ if superscript(first).is_some() || first == '⁻' => self.raised(start, rest)?,
            _ => {
                let kind = match first {
                    '+' => Kind::Plus,
                    '-' | '−' => Kind::Minus,
                    '*' | '·' | '⋅' | '×' => Kind::Times,
                    '/' | '÷' => Kind::Divide,
                    '^' => Kind::Power,
                    '(' => Kind::Open,
                    ')' => Kind::Close,
                    ',' => Kind::Comma,
                    ';' => Kind::Semicolon,
                    '=' if !rest.starts_with("==") => Kind::Equals,
                    _ => return Err(self.stranger(start, rest, first)),
                };
                (kind, first.len_utf8())
            }
        };
        self.at = start + length;
        Ok(Token { kind, span: start..self.at })
    }

    /// A number and its length. An `e` belongs to it only with an exponent after it: `2e` is 2 times e.
    fn number(&self, start: usize, rest: &str) -> Result<(Kind, usize), FormulaError> {
        let digits = |from: usize| from + run(&rest[from..], |c| c.is_ascii_digit());
        let mut end = digits(0);
        if rest[end..].starts_with('.') {
            end = digits(end + 1);
        }
        if end == 1 && rest.starts_with('.') {
            return Err(FormulaError::new(self.text, start..start + 1, "a point without digits is no number"));
        }
        let tail = &rest[end..];
        if tail.starts_with(['e', 'E']) {
            let exponent = end + 1 + usize::from(tail[1..].starts_with(['+', '-']));
            if digits(exponent) > exponent {
                end = digits(exponent);
            }
        }
        match rest[..end].parse::<f64>() {
            Ok(number) if number.is_finite() => Ok((Kind::Number(number), end)),
            _ => {
                let error = FormulaError::new(self.text, start..start + end, "this number is too large");
                Err(error.hint(format!("numbers go up to {:e}", f64::MAX)))
            }
        }
    }

    /// An exponent in superscript digits, and its length.
    fn raised(&self, start: usize, rest: &str) -> Result<(Kind, usize), FormulaError> {
        let sign = if rest.starts_with('⁻') { '⁻'.len_utf8() } else { 0 };
        let length = sign + run(&rest[sign..], |c| superscript(c).is_some());
        let number = rest[sign..length]
            .chars()
            .filter_map(superscript)
            .try_fold(0_i32, |number, digit| number.checked_mul(10)?.checked_add(digit));
        match number {
            Some(number) if length > sign => Ok((Kind::Raised(if sign > 0 { -number } else { number }), length)),
            Some(_) => Err(FormulaError::new(self.text, start..start + length, "this exponent has no digits")),
            None => Err(FormulaError::new(self.text, start..start + length, "this exponent is too large")),
        }
    }

    /// The error for a character that no word begins with.
    fn stranger(&self, start: usize, rest: &str, c: char) -> FormulaError {
        let two = ["<=", ">=", "==", "!=", "<>", "&&", "||"].iter().any(|two| rest.starts_with(two));
        let length = if two { 2 } else { c.len_utf8() };
        let word = &rest[..length];
        let error = |message: String| FormulaError::new(self.text, start..start + length, message);
        match c {
            '<' | '>' | '≤' | '≥' => {
                error(format!("a formula is a number, no comparison with `{word}`")).hint(SHAPE_HINT)
            }
            '=' => error("a formula is a number, no equation".into()).hint(EQUATION_HINT),
            '!' | '&' | '?' | ':' | '~' | '¬' | '∧' | '∨' | '|' if c != '|' || length == 2 => {
                error(format!("there is no operator `{word}`")).hint(CONDITION_HINT)
            }
            '|' => error("there is no `|`".into()).hint("write abs(x) for |x|"),
            '%' => error("there is no operator `%`".into()).hint("write mod(a, b) for a % b"),
            '√' => error("there is no `√`".into()).hint("write sqrt(x)"),
            '[' | ']' | '{' | '}' => error(format!("`{c}` has no meaning here")).hint("write ( and )"),
            '–' | '—' => error("this is a dash, no minus".into()).hint("write -"),
            c if c.is_control() => error(format!("the character U+{:04X} has no meaning here", u32::from(c))),
            c => error(format!("`{c}` has no meaning here")),
        }
    }
}

pub(super) const EQUATION_HINT: &str = "for left = right, write left - right";

/// How many bytes at the start of `text` are characters for which `is_part` holds.
fn run(text: &str, is_part: impl Fn(char) -> bool) -> usize {
    text.find(|c| !is_part(c)).unwrap_or(text.len())
}

fn superscript(c: char) -> Option<i32> {
    "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().zip(0..).find(|&(raised, _)| raised == c).map(|(_, digit)| digit)
}
