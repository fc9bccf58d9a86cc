//! The form that all shader text goes through: modules of typed functions, without anything that only one language has.
//!
//! Two printers make text of it, [`crate::wgsl`] and [`crate::glsl`]. It comes from two sources: the formulas of shapes
//! (`formula.rs`), and the library of tracing and lighting, which is written in a part of WGSL and read by
//! [`crate::parse`]. Every binding states its type, so that no printer has to infer one.

/// The type of a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Type {
    /// A truth value.
    Bool,
    /// A signed whole number.
    Int,
    /// A number in single precision.
    Float,
    /// Two to four numbers.
    Vector(u8),
    /// A matrix of 3 x 3 numbers, by columns.
    Matrix,
    /// A structure of this name.
    Struct(String),
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub enum Expr {
    /// A truth value.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// A number.
    Float(f32),
    /// A binding, an argument or a constant.
    Name(String),
    /// An entry of the table of parameters.
    Parameter(Box<Expr>),
    /// A member of a structure, or components of a vector.
    Member(Box<Expr>, String),
    /// A column of a matrix or a component of a vector.
    Index(Box<Expr>, Box<Expr>),
    /// The number with its sign turned.
    Negate(Box<Expr>),
    /// The other truth value.
    Not(Box<Expr>),
    /// An operation on two values.
    Binary(Operator, Box<Expr>, Box<Expr>),
    /// A call of a function, of the language or of the module.
    Call(String, Vec<Expr>),
    /// A vector, a structure or a converted number, made of its parts.
    Make(Type, Vec<Expr>),
    /// The second value if the first one is true, otherwise the third one; both are computed.
    Select(Box<Expr>, Box<Expr>, Box<Expr>),
}

/// An operation on two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the operations speak for themselves")]
pub enum Operator {
    Add,
    Sub,
    Mul,
    Div,
    Rem,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
}

impl Operator {
    /// All of them with their signs, which all languages share.
    pub const ALL: [(Self, &'static str); 13] = [
        (Self::Add, "+"),
        (Self::Sub, "-"),
        (Self::Mul, "*"),
        (Self::Div, "/"),
        (Self::Rem, "%"),
        (Self::Less, "<"),
        (Self::LessEqual, "<="),
        (Self::Greater, ">"),
        (Self::GreaterEqual, ">="),
        (Self::Equal, "=="),
        (Self::NotEqual, "!="),
        (Self::And, "&&"),
        (Self::Or, "||"),
    ];

    /// Its sign.
    pub fn sign(self) -> &'static str {
        Self::ALL.iter().find(|(own, _)| *own == self).map_or("", |(_, sign)| sign)
    }

    /// How strongly it binds; all languages agree.
    pub fn precedence(self) -> u8 {
        match self {
            Self::Or => 1,
            Self::And => 2,
            Self::Equal | Self::NotEqual => 3,
            Self::Less | Self::LessEqual | Self::Greater | Self::GreaterEqual => 4,
            Self::Add | Self::Sub => 5,
            Self::Mul | Self::Div | Self::Rem => 6,
        }
    }
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub enum Statement {
    /// A line of comment.
    Comment(String),
    /// A value under a name.
    Let(String, Type, Expr),
    /// A variable with its first value.
    Var(String, Type, Expr),
    /// A new value for a variable or a part of one.
    Assign(Expr, Expr),
    /// One of two blocks.
    If(Expr, Vec<Statement>, Vec<Statement>),
    /// A block once for each whole number from the first up to but without the second one.
    Count(String, Expr, Expr, Vec<Statement>),
    /// A block until something leaves it.
    Loop(Vec<Statement>),
    /// Leaves the loop.
    Break,
    /// Goes on with the next round of the loop.
    Continue,
    /// Leaves the function.
    Return(Expr),
}

/// A function.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// What it is, line by line.
    pub comment: Vec<String>,
    /// Its arguments.
    pub arguments: Vec<(String, Type)>,
    /// What it returns.
    pub result: Type,
    /// What it does.
    pub body: Vec<Statement>,
}

/// A part of a module.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A function.
    Function(Function),
    /// A structure: name, members, and what it is.
    Struct(String, Vec<(String, Type)>, Vec<String>),
    /// A constant: name, type, value, and what it is.
    Constant(String, Type, Expr, Vec<String>),
}

impl Item {
    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Function(function) => &function.name,
            Self::Struct(name, ..) | Self::Constant(name, ..) => name,
        }
    }
}

/// Short ways to write expressions.
impl Expr {
    /// A binding.
    pub fn name(name: impl Into<String>) -> Self {
        Self::Name(name.into())
    }

    /// An entry of the table of parameters at a place that is known.
    pub fn parameter(place: usize) -> Self {
        Self::Parameter(Box::new(Self::Int(place as i64)))
    }

    /// A call.
    pub fn call(name: impl Into<String>, arguments: impl IntoIterator<Item = Self>) -> Self {
        Self::Call(name.into(), arguments.into_iter().collect())
    }

    /// A vector.
    pub fn vector(parts: impl IntoIterator<Item = Self>) -> Self {
        let parts: Vec<Self> = parts.into_iter().collect();
        Self::Make(Type::Vector(parts.len() as u8), parts)
    }

    /// A member.
    pub fn member(self, name: &str) -> Self {
        Self::Member(Box::new(self), name.into())
    }

    /// An operation.
    pub fn binary(op: Operator, a: Self, b: Self) -> Self {
        Self::Binary(op, Box::new(a), Box::new(b))
    }

    /// A selection.
    pub fn select(condition: Self, yes: Self, no: Self) -> Self {
        Self::Select(Box::new(condition), Box::new(yes), Box::new(no))
    }

    /// All expressions it is made of, directly.
    pub fn parts(&self) -> Vec<&Self> {
        match self {
            Self::Bool(_) | Self::Int(_) | Self::Float(_) | Self::Name(_) => Vec::new(),
            Self::Parameter(a) | Self::Member(a, _) | Self::Negate(a) | Self::Not(a) => vec![a],
            Self::Index(a, b) | Self::Binary(_, a, b) => vec![a, b],
            Self::Select(a, b, c) => vec![a, b, c],
            Self::Call(_, parts) | Self::Make(_, parts) => parts.iter().collect(),
        }
    }
}

macro_rules! operators {
    ($($Trait:ident $method:ident),*) => {$(
        impl std::ops::$Trait for Expr {
            type Output = Self;
            fn $method(self, rhs: Self) -> Self {
                Self::binary(Operator::$Trait, self, rhs)
            }
        }
    )*};
}

operators!(Add add, Sub sub, Mul mul, Div div);
