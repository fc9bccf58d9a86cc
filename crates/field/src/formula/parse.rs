//! Reading: recursive descent over the words, straight into a [`Builder`].
//!
//! Each level of parentheses, exponents and calls is one level of recursion; there is a limit to it, so that no text
//! exhausts the stack.

use super::builder::Builder;
use super::error::FormulaError;
use super::names::{self, CONSTANTS, COORDINATES, POINT};
use super::token::{EQUATION_HINT, Kind, Lexer, Token};
use super::value::{Value, for_each_part};
use super::{Binary, TermId, Unary};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;

/// How deep parentheses, calls and exponents may be nested.
pub const MOST_NESTED: usize = 200;

/// The largest number of terms that reading may make; a formula has at most as many.
pub const MOST_TERMS: usize = 1_000_000;

/// The term that `text` means, if the language's names and these have their values, and which of these it uses.
pub(super) fn parse(
    text: &str,
    given: &BTreeMap<String, f64>,
    builder: &mut Builder,
) -> Result<(TermId, Vec<String>), FormulaError> {
    let mut lexer = Lexer::new(text);
    let token = lexer.next()?;
    let before = Token { kind: Kind::End, span: 0..0 };
    let (defined, used) = (HashMap::new(), BTreeSet::new());
    let mut parser = Parser { text, lexer, token, before, builder, given, used, defined, depth: 0 };
    let result = parser.formula()?;
    Ok((result, parser.used.into_iter().map(str::to_owned).collect()))
}

struct Parser<'t, 'b> {
    text: &'t str,
    lexer: Lexer<'t>,
    token: Token,
    /// The word before `token`; an end at the beginning.
    before: Token,
    builder: &'b mut Builder,
    /// Values that names have from outside, and which of them occurred.
    given: &'b BTreeMap<String, f64>,
    used: BTreeSet<&'b str>,
    defined: HashMap<&'t str, Value>,
    depth: usize,
}

/// An operand, and whether it is written as a number and nothing else, which may stand before a name without `*`.
#[derive(Clone, Copy)]
struct Operand {
    value: Value,
    is_number: bool,
}

type Read<T> = Result<T, FormulaError>;

impl<'t> Parser<'t, '_> {
    fn error(&self, span: Range<usize>, message: impl Into<String>) -> FormulaError {
        FormulaError::new(self.text, span, message)
    }

    fn word(&self, token: &Token) -> &'t str {
        &self.text[token.span.clone()]
    }

    fn advance(&mut self) -> Read<Token> {
        let next = self.lexer.next()?;
        self.before = std::mem::replace(&mut self.token, next);
        if self.builder.len() > MOST_TERMS {
            let message = format!("the formula has more than {MOST_TERMS} operations");
            return Err(self.error(self.before.span.clone(), message));
        }
        Ok(self.before.clone())
    }

    fn formula(&mut self) -> Read<TermId> {
        while self.token.kind == Kind::Name && self.is_followed_by_equals() {
            self.definition()?;
        }
        if self.token.kind == Kind::End {
            let message = if self.before.kind == Kind::End {
                "the formula is empty"
            } else {
                "nothing follows the definitions: the formula itself comes last"
            };
            return Err(self.error(self.token.span.clone(), message));
        }
        let start = self.token.span.start;
        let result = self.sum()?;
        match self.token.kind {
            Kind::End => result.as_number().ok_or_else(|| {
                let message = format!("a formula is a number, but this is {}", result.kind());
                self.error(start..self.before.span.end, message)
                    .hint("write length(v) for the length of a vector, v.x for a part of it")
            }),
            Kind::Semicolon => {
                let error = self.error(self.token.span.clone(), "`;` can only stand after a definition");
                Err(error.hint("a definition is: name = value;"))
            }
            _ => Err(self.unexpected()),
        }
    }

    fn is_followed_by_equals(&self) -> bool {
        let mut ahead = self.lexer;
        ahead.next().is_ok_and(|next| next.kind == Kind::Equals)
    }

    /// `name = sum;`
    fn definition(&mut self) -> Read<()> {
        let name = self.advance()?;
        let word = self.word(&name);
        let equals = self.advance()?.span;
        if COORDINATES.contains(&word) {
            // Most likely an equation is meant.
            let message = format!("`{word}` is a coordinate, it can't be defined");
            return Err(self.error(equals, message).hint(EQUATION_HINT));
        }
        if names::is_taken(word) || self.given.contains_key(word) || self.defined.contains_key(word) {
            let error = self.error(name.span, format!("`{word}` has a meaning already"));
            return Err(error.hint("choose another name"));
        }
        let value = self.sum()?;
        match self.token.kind {
            Kind::Semicolon => {}
            Kind::End => {
                let error = self.error(name.span, format!("there is no `;` after the definition of `{word}`"));
                return Err(error.hint("a formula is: name = value; ...; the formula itself"));
            }
            _ => return Err(self.unexpected()),
        }
        self.advance()?;
        self.defined.insert(word, value);
        Ok(())
    }

    /// The error for a word that can't follow what was read.
    fn unexpected(&self) -> FormulaError {
        let (span, word) = (self.token.span.clone(), self.word(&self.token));
        let before = self.word(&self.before);
        match self.token.kind {
            Kind::Close => self.error(span, "this parenthesis was never opened"),
            Kind::Comma => {
                let error = self.error(span, "a comma can only stand between the arguments of a function");
                match self.before.kind {
                    Kind::Number(_) => error.hint("a decimal point is written ."),
                    _ => error,
                }
            }
            Kind::Semicolon => self.error(span, "`;` can't stand within parentheses"),
            Kind::Equals => {
                let error = self.error(span, "a formula is a number, no equation");
                error.hint(format!("{EQUATION_HINT}; a definition is: name = value;"))
            }
            Kind::Number(_) if matches!(self.before.kind, Kind::Number(_)) => self.error(span, "two numbers in a row"),
            _ => {
                let error = self.error(span, format!("an operator is missing between `{before}` and `{word}`"));
                error.hint(format!("write {before} * {word}"))
            }
        }
    }

    /// The error for a word that stands where an operand should.
    fn no_operand(&self) -> FormulaError {
        let (before, word) = (self.before.span.clone(), self.word(&self.token));
        match (self.before.kind, self.token.kind) {
            (Kind::Open, Kind::Close) => {
                self.error(before.start..self.token.span.end, "there is nothing in these parentheses")
            }
            (Kind::Open, Kind::End) => self.error(before, UNCLOSED),
            (Kind::Open | Kind::Comma, Kind::Comma) | (Kind::Comma, Kind::Close | Kind::End) => {
                self.error(self.token.span.clone(), "an argument is missing here")
            }
            (kind, _) if kind.is_operator() => {
                self.error(before.clone(), format!("an operand is missing after `{}`", &self.text[before]))
            }
            (_, Kind::Times | Kind::Divide | Kind::Power | Kind::Raised(_)) => {
                self.error(self.token.span.clone(), format!("an operand is missing before `{word}`"))
            }
            (_, Kind::Close) => self.error(self.token.span.clone(), "this parenthesis was never opened"),
            (Kind::Equals, _) => self.error(before, "this definition has no value"),
            (_, Kind::End) => self.error(self.token.span.clone(), "an operand is missing here"),
            _ => self.error(self.token.span.clone(), format!("`{word}` can't stand here")),
        }
    }

    /// Reads something one level further in.
    fn nested<T>(&mut self, read: impl FnOnce(&mut Self) -> Read<T>) -> Read<T> {
        self.depth += 1;
        if self.depth > MOST_NESTED {
            let error = self.error(self.before.span.clone(), format!("this is nested more than {MOST_NESTED} deep"));
            return Err(error.hint("define parts of it before: name = value; ..."));
        }
        let result = read(self)?;
        self.depth -= 1;
        Ok(result)
    }

    /// The result of an operation, refused if that divides by 0 or makes a constant that is no number.
    fn sound(&self, value: Value, span: Range<usize>) -> Read<Value> {
        if self.builder.is_faulty() {
            let error = self.error(span, "this has no finite value");
            return Err(error.hint("for instance, 1/0 and sqrt(-1) have none"));
        }
        Ok(value)
    }

    /// The operation of two operands, of which `span` is the place.
    fn binary(&mut self, op: Binary, left: Value, right: Value, span: Range<usize>) -> Read<Value> {
        let result = for_each_part(&[left, right], |parts| self.builder.binary(op, parts[0], parts[1]));
        match result {
            Ok(result) => self.sound(result, span),
            Err([left, right]) => {
                Err(self.error(span, format!("{} and {} have no common parts", left.kind(), right.kind())))
            }
        }
    }

    /// A function of each part of an operand.
    fn each_part(&mut self, value: Value, mut f: impl FnMut(&mut Builder, TermId) -> TermId) -> Value {
        for_each_part(&[value], |parts| f(self.builder, parts[0])).unwrap_or(value)
    }

    /// Terms added and subtracted.
    fn sum(&mut self) -> Read<Value> {
        let mut left = self.product()?;
        loop {
            let op = match self.token.kind {
                Kind::Plus => Binary::Add,
                Kind::Minus => Binary::Sub,
                _ => return Ok(left),
            };
            let span = self.advance()?.span;
            let right = self.product()?;
            left = self.binary(op, left, right, span)?;
        }
    }

    /// Factors multiplied and divided, also those with a number before them.
    fn product(&mut self) -> Read<Value> {
        let mut left = self.signed()?;
        let mut divides: Option<Range<usize>> = None;
        loop {
            let (op, span, right) = match self.token.kind {
                Kind::Times | Kind::Divide => {
                    let operator = self.advance()?;
                    let is_division = operator.kind == Kind::Divide;
                    divides = is_division.then(|| operator.span.clone());
                    let op = if is_division { Binary::Div } else { Binary::Mul };
                    (op, operator.span, self.signed()?)
                }
                kind if kind.is_operand() && !matches!(kind, Kind::Number(_)) && left.is_number => {
                    let (number, word) = (self.word(&self.before), self.word(&self.token));
                    if let Some(slash) = divides {
                        let error = self.error(slash, format!("does this divide by {number} or by {number}{word}?"));
                        return Err(error.hint(format!("write / ({number} * {word}...) or / {number} * {word}...")));
                    }
                    (Binary::Mul, self.token.span.clone(), self.power()?)
                }
                kind if kind.is_operand() => return Err(self.unexpected()),
                _ => return Ok(left.value),
            };
            // `2 * 3x` multiplies, whatever is taken first; so does `6 / 2 * 3x`.
            left = Operand { value: self.binary(op, left.value, right.value, span)?, is_number: right.is_number };
        }
    }

    /// A power, with signs before it.
    fn signed(&mut self) -> Read<Operand> {
        let mut is_negative = false;
        while matches!(self.token.kind, Kind::Plus | Kind::Minus) {
            is_negative ^= self.advance()?.kind == Kind::Minus;
        }
        let power = self.power()?;
        Ok(match is_negative {
            true => Operand { value: self.each_part(power.value, |b, part| b.unary(Unary::Neg, part)), ..power },
            false => power,
        })
    }

    /// An operand with its exponents; `a^b^c` is `a^(b^c)`.
    fn power(&mut self) -> Read<Operand> {
        let base = self.raised()?;
        if self.token.kind != Kind::Power {
            return Ok(base);
        }
        let operator = self.advance()?.span;
        let exponent = self.nested(Self::signed)?;
        if exponent.is_number && matches!(self.token.kind, Kind::Name | Kind::Open) {
            let (number, word) = (self.word(&self.before), self.word(&self.token));
            let error = self.error(operator, format!("is {number} or {number}{word} the exponent here?"));
            return Err(error.hint(format!("write ^{number} * {word}... or ^({number} * {word}...)")));
        }
        let value = self.binary(Binary::Pow, base.value, exponent.value, operator)?;
        Ok(Operand { value, is_number: false })
    }

    /// An operand with exponents in superscript digits.
    fn raised(&mut self) -> Read<Operand> {
        let mut operand = self.operand()?;
        while let Kind::Raised(exponent) = self.token.kind {
            let span = self.advance()?.span;
            let value = self.each_part(operand.value, |b, part| b.power(part, exponent));
            operand = Operand { value: self.sound(value, span)?, is_number: false };
        }
        Ok(operand)
    }

    fn operand(&mut self) -> Read<Operand> {
        let mut value = match self.token.kind {
            Kind::Number(number) => {
                self.advance()?;
                return Ok(Operand { value: Value::number(self.builder.literal(number)), is_number: true });
            }
            Kind::Open => {
                let open = self.advance()?.span;
                let value = self.nested(Self::sum)?;
                self.close(open)?;
                value
            }
            Kind::Name => {
                let name = self.advance()?;
                match self.token.kind {
                    Kind::Open => self.call(&name)?,
                    _ => self.name(&name)?,
                }
            }
            _ => return Err(self.no_operand()),
        };
        while self.token.kind == Kind::Dot {
            value = self.part(value)?;
        }
        Ok(Operand { value, is_number: false })
    }

    /// A part of a vector, or several: `.x`, `.xy`; the point is next.
    fn part(&mut self, value: Value) -> Read<Value> {
        let owner = self.word(&self.before);
        let dot = self.advance()?.span;
        let letters = self.advance()?;
        let (word, span) = (self.word(&letters), dot.start..letters.span.end);
        if value.as_number().is_some() {
            let error = self.error(span, format!("a number has no part `.{word}`"));
            return Err(error.hint(format!("write {owner} * {word} for a product")));
        }
        let place = |letter: char| {
            let place = COORDINATES.iter().position(|name| name.starts_with(letter))?;
            value.parts().get(place).copied()
        };
        let parts: Option<Vec<TermId>> = word.chars().map(place).collect();
        parts.and_then(|parts| Value::of(&parts)).ok_or_else(|| {
            let all = COORDINATES[..value.parts().len()].concat();
            let error = self.error(span, format!("{} has no part `.{word}`", value.kind()));
            error.hint(format!("its parts are the letters of .{all}, up to three of them"))
        })
    }

    /// The closing parenthesis for the one at `open`.
    fn close(&mut self, open: Range<usize>) -> Read<()> {
        match self.token.kind {
            Kind::Close => self.advance().map(|_| ()),
            Kind::End => Err(self.error(open, UNCLOSED)),
            _ => Err(self.unexpected()),
        }
    }

    /// A name by itself.
    fn name(&mut self, name: &Token) -> Read<Value> {
        let word = self.word(name);
        if let Some(axis) = COORDINATES.iter().position(|&coordinate| coordinate == word) {
            Ok(Value::number(self.builder.input(axis)))
        } else if word == POINT {
            let coordinates = [0, 1, 2].map(|axis| self.builder.input(axis));
            Ok(Value::of(&coordinates).expect("three parts are a vector"))
        } else if let Some(number) = names::constant(word) {
            Ok(Value::number(self.builder.literal(number)))
        } else if let Some(&value) = self.defined.get(word) {
            Ok(value)
        } else if let Some((name, &number)) = self.given.get_key_value(word) {
            self.used.insert(name);
            Ok(Value::number(self.builder.literal(number)))
        } else if let Some(function) = names::function(word) {
            let error = self.error(name.span.clone(), format!("`{word}` needs its arguments in parentheses"));
            Err(match self.token.kind {
                Kind::Power | Kind::Raised(_) => error.hint(format!("write {word}(...)^2 for the square")),
                Kind::Name | Kind::Number(_) => error.hint(format!("write {word}({})", self.word(&self.token))),
                _ => error.hint(format!("write {}", function.signature)),
            })
        } else {
            let known = COORDINATES.into_iter().chain([POINT]).chain(CONSTANTS.map(|constant| constant.0));
            let given = self.given.keys().map(String::as_str);
            Err(self.unknown(name, known.chain(given).chain(self.defined.keys().copied())))
        }
    }

    /// The error for a name that has no meaning.
    fn unknown<'n>(&self, name: &Token, known: impl Iterator<Item = &'n str>) -> FormulaError {
        let word = self.word(name);
        let error = self.error(name.span.clone(), format!("`{word}` has no meaning here"));
        let all = known.chain(names::functions().map(|function| -> &'n str { function.name() }));
        match (names::elsewhere(word), names::closest(word, all)) {
            (Some(hint), _) => error.hint(hint),
            (None, Some(guess)) => error.hint(format!("did you mean `{guess}`?")),
            (None, None) if is_product(word) => {
                let factors: Vec<String> = word.chars().map(String::from).collect();
                error.hint(format!("write {} for a product", factors.join(" * ")))
            }
            (None, None) => {
                error.hint("a formula is made of x, y, z, numbers and functions; others are defined before")
            }
        }
    }

    /// A call of a function; its name is read, the parenthesis is next.
    fn call(&mut self, name: &Token) -> Read<Value> {
        let word = self.word(name);
        let Some(function) = names::function(word) else {
            let is_value = names::is_taken(word) || self.given.contains_key(word) || self.defined.contains_key(word);
            return Err(if is_value {
                let error = self.error(name.span.clone(), format!("`{word}` is no function"));
                error.hint(format!("write {word} * (...) for a product"))
            } else {
                self.unknown(name, std::iter::empty())
            });
        };
        let open = self.advance()?.span;
        let mut arguments = Vec::new();
        if self.token.kind != Kind::Close {
            loop {
                arguments.push(self.nested(Self::sum)?);
                if self.token.kind != Kind::Comma {
                    break;
                }
                self.advance()?;
            }
        }
        self.close(open)?;
        let span = name.span.start..self.before.span.end;
        if !function.takes(arguments.len()) {
            let message = format!("`{word}` takes {}, but has {}", function.arity(), arguments.len());
            return Err(self.error(span, message).hint(format!("write {}", function.signature)));
        }
        match function.call(self.builder, &arguments) {
            Ok(value) => self.sound(value, span),
            Err(fault) => {
                Err(self.error(span, format!("`{word}` {fault}")).hint(format!("write {}", function.signature)))
            }
        }
    }
}

const UNCLOSED: &str = "this parenthesis is never closed";

/// Whether a word is coordinates without `*` between them.
fn is_product(word: &str) -> bool {
    word.len() > 1 && word.chars().all(|c| matches!(c, 'x' | 'y' | 'z'))
}
