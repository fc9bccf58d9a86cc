//! Reading the library: the part of WGSL that the [form](crate::tree) can hold.
//!
//! Functions, structures and constants; `let` and `var` with their types, assignments, `if`, `for` over whole numbers, `loop`,
//! `break`, `continue`, `return`; comments on lines of their own. Anything else is refused with its line.

use crate::tree::{Expr, Function, Item, Operator, Statement, Type};

/// What is wrong with a text, and in which line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseError {
    /// The line, counted from 1.
    pub line: usize,
    /// What is wrong, as a sentence.
    pub message: String,
}

/// The items of a text.
///
/// # Errors
/// The first thing that is not in the part of the language that is read.
pub fn parse(text: &str) -> Result<Vec<Item>, ParseError> {
    let mut parser = Parser { tokens: tokens(text)?, next: 0 };
    let mut items = Vec::new();
    loop {
        let comment = parser.comment();
        if parser.is_at_end() {
            return Ok(items);
        }
        items.push(parser.item(comment)?);
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Word(String),
    Float(f32),
    Int(i64),
    Sign(&'static str),
    Comment(String),
}

/// Longer signs before their beginnings.
const SIGNS: &[&str] = &[
    "->", "<=", ">=", "==", "!=", "&&", "||", "++", "+=", "-=", "*=", "/=", "+", "-", "*", "/", "%", "<", ">", "=",
    "!", "(", ")", "{", "}", "[", "]", ",", ";", ":", ".",
];

fn tokens(text: &str) -> Result<Vec<(usize, Token)>, ParseError> {
    let mut tokens = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let mut rest = line.trim_start();
        while !rest.is_empty() {
            let taken = |rest: &str, is_part: fn(char) -> bool| rest.find(|c| !is_part(c)).unwrap_or(rest.len());
            let first = rest.chars().next().unwrap_or(' ');
            let (token, length) = if let Some(comment) = rest.strip_prefix("//") {
                (Token::Comment(comment.trim().into()), rest.len())
            } else if first.is_ascii_alphabetic() || first == '_' {
                let length = taken(rest, |c| c.is_ascii_alphanumeric() || c == '_');
                (Token::Word(rest[..length].into()), length)
            } else if first.is_ascii_digit() {
                let mut length = taken(rest, |c| c.is_ascii_alphanumeric() || c == '.');
                if rest[..length].ends_with('e') && rest[length..].starts_with('-') {
                    length += 1 + taken(&rest[length + 1..], |c| c.is_ascii_digit());
                }
                let digits = &rest[..length];
                let fault = || ParseError { line: number, message: format!("`{digits}` is no number") };
                let token = match digits.contains(['.', 'e']) {
                    true => Token::Float(digits.parse().map_err(|_| fault())?),
                    false => Token::Int(digits.parse().map_err(|_| fault())?),
                };
                (token, length)
            } else if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
                (Token::Sign(sign), sign.len())
            } else {
                return Err(ParseError { line: number, message: format!("`{first}` is no sign of the language") });
            };
            tokens.push((number, token));
            rest = rest[length..].trim_start();
        }
    }
    Ok(tokens)
}

struct Parser {
    tokens: Vec<(usize, Token)>,
    next: usize,
}

type Parsed<T> = Result<T, ParseError>;

impl Parser {
    fn is_at_end(&self) -> bool {
        self.next >= self.tokens.len()
    }

    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next).map(|(_, token)| token)
    }

    fn fault<T>(&self, message: impl Into<String>) -> Parsed<T> {
        let line = self.tokens.get(self.next).or(self.tokens.last()).map_or(1, |(line, _)| *line);
        Err(ParseError { line, message: message.into() })
    }

    /// All lines of comment that come next.
    fn comment(&mut self) -> Vec<String> {
        let mut lines = Vec::new();
        while let Some(Token::Comment(line)) = self.peek() {
            lines.push(line.clone());
            self.next += 1;
        }
        lines
    }

    fn takes(&mut self, sign: &str) -> bool {
        let is_there = matches!(self.peek(), Some(Token::Sign(own)) if *own == sign);
        self.next += usize::from(is_there);
        is_there
    }

    fn takes_word(&mut self, word: &str) -> bool {
        let is_there = matches!(self.peek(), Some(Token::Word(own)) if own == word);
        self.next += usize::from(is_there);
        is_there
    }

    fn expect(&mut self, sign: &str) -> Parsed<()> {
        if self.takes(sign) { Ok(()) } else { self.fault(format!("expected `{sign}`, found {:?}", self.peek())) }
    }

    fn word(&mut self) -> Parsed<String> {
        match self.peek() {
            Some(Token::Word(word)) => {
                let word = word.clone();
                self.next += 1;
                Ok(word)
            }
            other => self.fault(format!("expected a name, found {other:?}")),
        }
    }

    fn ty(&mut self) -> Parsed<Type> {
        let name = self.word()?;
        let ty = match name.as_str() {
            "bool" => Type::Bool,
            "i32" => Type::Int,
            "f32" => Type::Float,
            "vec2" => Type::Vector(2),
            "vec3" => Type::Vector(3),
            "vec4" => Type::Vector(4),
            "mat3x3" => Type::Matrix,
            _ => return Ok(Type::Struct(name)),
        };
        if matches!(ty, Type::Vector(_) | Type::Matrix) {
            self.expect("<")?;
            if !self.takes_word("f32") {
                return self.fault("only vectors of `f32` are read");
            }
            self.expect(">")?;
        }
        Ok(ty)
    }

    fn typed(&mut self) -> Parsed<(String, Type)> {
        let name = self.word()?;
        self.expect(":")?;
        Ok((name, self.ty()?))
    }

    fn item(&mut self, comment: Vec<String>) -> Parsed<Item> {
        if self.takes_word("const") {
            let (name, ty) = self.typed()?;
            self.expect("=")?;
            let value = self.expression(0)?;
            self.expect(";")?;
            return Ok(Item::Constant(name, ty, value, comment));
        }
        if self.takes_word("struct") {
            let name = self.word()?;
            self.expect("{")?;
            let mut members = Vec::new();
            while !self.takes("}") {
                self.comment();
                members.push(self.typed()?);
                self.takes(",");
                self.comment();
            }
            return Ok(Item::Struct(name, members, comment));
        }
        if !self.takes_word("fn") {
            return self.fault("expected `fn`, `struct` or `const`");
        }
        let name = self.word()?;
        self.expect("(")?;
        let mut arguments = Vec::new();
        while !self.takes(")") {
            arguments.push(self.typed()?);
            self.takes(",");
        }
        self.expect("->")?;
        let result = self.ty()?;
        let body = self.block()?;
        Ok(Item::Function(Function { name, comment, arguments, result, body }))
    }

    fn block(&mut self) -> Parsed<Vec<Statement>> {
        self.expect("{")?;
        let mut statements = Vec::new();
        while !self.takes("}") {
            statements.push(self.statement()?);
        }
        Ok(statements)
    }

    fn statement(&mut self) -> Parsed<Statement> {
        if let Some(Token::Comment(line)) = self.peek() {
            let line = line.clone();
            self.next += 1;
            return Ok(Statement::Comment(line));
        }
        for is_variable in [false, true] {
            if self.takes_word(if is_variable { "var" } else { "let" }) {
                let (name, ty) = self.typed()?;
                self.expect("=")?;
                let value = self.expression(0)?;
                self.expect(";")?;
                return Ok(if is_variable { Statement::Var(name, ty, value) } else { Statement::Let(name, ty, value) });
            }
        }
        for (word, statement) in [("break", Statement::Break), ("continue", Statement::Continue)] {
            if self.takes_word(word) {
                self.expect(";")?;
                return Ok(statement);
            }
        }
        if self.takes_word("return") {
            let value = self.expression(0)?;
            self.expect(";")?;
            return Ok(Statement::Return(value));
        }
        if self.takes_word("loop") {
            return Ok(Statement::Loop(self.block()?));
        }
        if self.takes_word("if") {
            return self.condition();
        }
        if self.takes_word("for") {
            return self.count();
        }
        let place = self.expression(0)?;
        let operators = [("+=", Operator::Add), ("-=", Operator::Sub), ("*=", Operator::Mul), ("/=", Operator::Div)];
        for (sign, op) in operators {
            if self.takes(sign) {
                let value = Expr::binary(op, place.clone(), self.expression(0)?);
                self.expect(";")?;
                return Ok(Statement::Assign(place, value));
            }
        }
        self.expect("=")?;
        let value = self.expression(0)?;
        self.expect(";")?;
        Ok(Statement::Assign(place, value))
    }

    fn condition(&mut self) -> Parsed<Statement> {
        let condition = self.expression(0)?;
        let yes = self.block()?;
        let no = match self.takes_word("else") {
            true if self.takes_word("if") => vec![self.condition()?],
            true => self.block()?,
            false => Vec::new(),
        };
        Ok(Statement::If(condition, yes, no))
    }

    /// `for (var i: i32 = a; i < b; i++) { ... }`
    fn count(&mut self) -> Parsed<Statement> {
        self.expect("(")?;
        if !self.takes_word("var") {
            return self.fault("expected `var`");
        }
        let (name, ty) = self.typed()?;
        if ty != Type::Int {
            return self.fault("loops count by whole numbers");
        }
        self.expect("=")?;
        let from = self.expression(0)?;
        self.expect(";")?;
        let condition = self.expression(0)?;
        let to = match condition {
            Expr::Binary(Operator::Less, i, to) if *i == Expr::name(&*name) => *to,
            _ => return self.fault(format!("expected `{name} <` a limit")),
        };
        self.expect(";")?;
        if self.word()? != name {
            return self.fault(format!("expected `{name}++`"));
        }
        self.expect("++")?;
        self.expect(")")?;
        Ok(Statement::Count(name, from, to, self.block()?))
    }

    /// An expression of operators that bind at least as strongly as `least`.
    fn expression(&mut self, least: u8) -> Parsed<Expr> {
        let mut left = self.signed()?;
        while let Some(Token::Sign(sign)) = self.peek() {
            let Some(&(op, _)) = Operator::ALL.iter().find(|(_, own)| own == sign) else { break };
            if op.precedence() < least {
                break;
            }
            self.next += 1;
            let right = self.expression(op.precedence() + 1)?;
            left = Expr::binary(op, left, right);
        }
        Ok(left)
    }

    fn signed(&mut self) -> Parsed<Expr> {
        if self.takes("-") {
            return Ok(match self.signed()? {
                Expr::Float(number) => Expr::Float(-number),
                Expr::Int(number) => Expr::Int(-number),
                other => Expr::Negate(Box::new(other)),
            });
        }
        if self.takes("!") {
            return Ok(Expr::Not(Box::new(self.signed()?)));
        }
        let mut value = self.atom()?;
        loop {
            if self.takes(".") {
                value = value.member(&self.word()?);
            } else if self.takes("[") {
                let place = Box::new(self.expression(0)?);
                self.expect("]")?;
                value = match value {
                    Expr::Name(name) if name == "parameters" => Expr::Parameter(place),
                    of => Expr::Index(Box::new(of), place),
                };
            } else {
                return Ok(value);
            }
        }
    }

    fn atom(&mut self) -> Parsed<Expr> {
        match self.peek().cloned() {
            Some(Token::Float(number)) => {
                self.next += 1;
                Ok(Expr::Float(number))
            }
            Some(Token::Int(number)) => {
                self.next += 1;
                Ok(Expr::Int(number))
            }
            Some(Token::Sign("(")) => {
                self.next += 1;
                let inner = self.expression(0)?;
                self.expect(")")?;
                Ok(inner)
            }
            Some(Token::Word(word)) => match word.as_str() {
                "true" | "false" => {
                    self.next += 1;
                    Ok(Expr::Bool(word == "true"))
                }
                "vec2" | "vec3" | "vec4" | "mat3x3" | "f32" | "i32" => {
                    let ty = self.ty()?;
                    Ok(Expr::Make(ty, self.arguments()?))
                }
                "select" => {
                    self.next += 1;
                    let arguments = self.arguments()?;
                    let [no, yes, condition] =
                        <[Expr; 3]>::try_from(arguments).or_else(|_| self.fault("`select` takes three values"))?;
                    Ok(Expr::select(condition, yes, no))
                }
                _ => {
                    self.next += 1;
                    if !matches!(self.peek(), Some(Token::Sign("("))) {
                        return Ok(Expr::Name(word));
                    }
                    let arguments = self.arguments()?;
                    // Structures begin with a capital letter, functions don't.
                    Ok(if word.starts_with(|c: char| c.is_ascii_uppercase()) {
                        Expr::Make(Type::Struct(word), arguments)
                    } else {
                        Expr::Call(word, arguments)
                    })
                }
            },
            other => self.fault(format!("expected a value, found {other:?}")),
        }
    }

    fn arguments(&mut self) -> Parsed<Vec<Expr>> {
        self.expect("(")?;
        let mut arguments = Vec::new();
        while !self.takes(")") {
            arguments.push(self.expression(0)?);
            if !self.takes(",") && !matches!(self.peek(), Some(Token::Sign(")"))) {
                return self.fault("expected `,` or `)`");
            }
        }
        Ok(arguments)
    }
}
