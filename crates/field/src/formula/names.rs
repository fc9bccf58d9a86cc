//! The names of the formula language, and what its functions are made of.

use super::TermId;
use super::builder::Builder;
use super::value::{Value, for_each_part};
use super::{Binary, Unary};
use std::f64::consts;
use std::ops::RangeInclusive;

/// A function that formulas may call.
#[derive(Debug)]
pub struct Function {
    /// Its name with its parameters, as in `atan2(y, x)`.
    pub signature: &'static str,
    /// What it is, if the name does not say it.
    pub about: &'static str,
    count: RangeInclusive<usize>,
    build: Build,
}

/// What a function makes of its arguments.
#[derive(Debug)]
enum Build {
    /// A number of numbers; of vectors, their parts by themselves.
    Parts(fn(&mut Builder, &[TermId]) -> TermId),
    /// Something else of vectors, or a fault, as the rest of a sentence that starts with the function's name.
    Vectors(fn(&mut Builder, &[Value]) -> Result<Value, String>),
}

impl Function {
    /// Its name.
    pub fn name(&self) -> &'static str {
        self.signature.split('(').next().unwrap_or_default()
    }

    /// Whether it can be called with this many arguments.
    pub(super) fn takes(&self, count: usize) -> bool {
        self.count.contains(&count)
    }

    /// How many arguments it takes, in words.
    pub(super) fn arity(&self) -> String {
        match (*self.count.start(), *self.count.end()) {
            (1, 1) => "1 argument".into(),
            (few, many) if few == many => format!("{few} arguments"),
            (few, usize::MAX) => format!("{few} arguments or more"),
            (few, many) => format!("{few} or {many} arguments"),
        }
    }

    /// A call with as many arguments as it takes.
    ///
    /// # Errors
    /// If these can't be its arguments: why, as the rest of a sentence that starts with its name.
    pub(super) fn call(&self, builder: &mut Builder, arguments: &[Value]) -> Result<Value, String> {
        match self.build {
            Build::Parts(build) => for_each_part(arguments, |parts| build(builder, parts))
                .map_err(|[one, other]| format!("can't take {} and {}", one.kind(), other.kind())),
            Build::Vectors(build) => build(builder, arguments),
        }
    }
}

/// All functions that formulas may call.
pub fn functions() -> impl Iterator<Item = &'static Function> {
    FUNCTIONS.iter()
}

const ANY: RangeInclusive<usize> = 2..=usize::MAX;

macro_rules! function {
    ($signature:literal, $about:literal, $count:expr, $build:expr) => {
        Function { signature: $signature, about: $about, count: $count, build: Build::Parts($build) }
    };
}

macro_rules! of_vectors {
    ($signature:literal, $about:literal, $count:expr, $build:expr) => {
        Function { signature: $signature, about: $about, count: $count, build: Build::Vectors($build) }
    };
}

static FUNCTIONS: &[Function] = &[
    function!("sin(a)", "", 1..=1, |b, args| b.unary(Unary::Sin, args[0])),
    function!("cos(a)", "", 1..=1, |b, args| b.unary(Unary::Cos, args[0])),
    function!("tan(a)", "", 1..=1, |b, args| b.unary(Unary::Tan, args[0])),
    function!("asin(a)", "", 1..=1, |b, args| b.unary(Unary::Asin, args[0])),
    function!("acos(a)", "", 1..=1, |b, args| b.unary(Unary::Acos, args[0])),
    function!("atan(a)", "", 1..=1, |b, args| b.unary(Unary::Atan, args[0])),
    function!("atan2(y, x)", "the angle of the point (x, y)", 2..=2, |b, args| {
        b.binary(Binary::Atan2, args[0], args[1])
    }),
    function!("sinh(a)", "", 1..=1, sinh),
    function!("cosh(a)", "", 1..=1, cosh),
    function!("tanh(a)", "", 1..=1, tanh),
    function!("exp(a)", "", 1..=1, |b, args| b.unary(Unary::Exp, args[0])),
    function!("ln(a)", "the natural logarithm", 1..=1, |b, args| b.unary(Unary::Ln, args[0])),
    function!("log2(a)", "", 1..=1, |b, args| logarithm(b, args[0], consts::LN_2)),
    function!("log10(a)", "", 1..=1, |b, args| logarithm(b, args[0], consts::LN_10)),
    function!("pow(a, b)", "the same as a^b", 2..=2, |b, args| b.binary(Binary::Pow, args[0], args[1])),
    function!("sqrt(a)", "", 1..=1, |b, args| b.unary(Unary::Sqrt, args[0])),
    function!("cbrt(a)", "the cube root, negative for a negative a", 1..=1, cbrt),
    function!("hypot(a, b)", "sqrt(a^2 + b^2), or of three squares", 2..=3, hypot),
    function!("abs(a)", "", 1..=1, |b, args| b.unary(Unary::Abs, args[0])),
    function!("sign(a)", "-1, 0 or 1", 1..=1, |b, args| sign(b, args[0])),
    function!("floor(a)", "", 1..=1, |b, args| b.unary(Unary::Floor, args[0])),
    function!("ceil(a)", "", 1..=1, ceil),
    function!("round(a)", "the nearest integer, upwards from the middle", 1..=1, round),
    function!("fract(a)", "a - floor(a)", 1..=1, fract),
    function!("mod(a, b)", "a - b * floor(a / b)", 2..=2, modulo),
    function!("min(a, b, ...)", "", ANY, |b, args| fold(b, Binary::Min, args)),
    function!("max(a, b, ...)", "", ANY, |b, args| fold(b, Binary::Max, args)),
    function!("clamp(a, low, high)", "min(max(a, low), high)", 3..=3, |b, args| {
        clamp(b, args[0], args[1], args[2])
    }),
    function!("mix(a, b, t)", "a + (b - a) * t", 3..=3, mix),
    function!("less(a, b)", "1 where a < b, otherwise 0", 2..=2, |b, args| b.binary(Binary::Less, args[0], args[1])),
    function!("step(edge, a)", "0 where a < edge, otherwise 1", 2..=2, step),
    function!("smoothstep(low, high, a)", "0 up to low, 1 from high, smooth between", 3..=3, smoothstep),
    of_vectors!("vec(a, b, c)", "the vector of two or three numbers, or of a vector's and another", 1..=3, vector),
    of_vectors!("length(v)", "the length of a vector, or of that of two or three numbers", 1..=3, length),
    of_vectors!("dot(v, w)", "the sum of the products of the parts of two vectors", 2..=2, dot),
    of_vectors!("cross(v, w)", "the vector at a right angle to two vectors of 3", 2..=2, cross),
    of_vectors!("normalize(v)", "the vector of length 1 in the same direction", 1..=1, normalize),
    of_vectors!("distance(v, w)", "the length of the difference of two vectors", 2..=2, distance),
];

/// The function of a name.
pub(super) fn function(name: &str) -> Option<&'static Function> {
    functions().find(|function| function.name() == name)
}

/// The names of the coordinates, in their order.
pub(super) const COORDINATES: [&str; 3] = ["x", "y", "z"];

/// The name of the vector of all coordinates.
pub(super) const POINT: &str = "p";

/// Why a name can't be given a value, as the rest of a sentence that starts with it; `None` if it can.
pub fn name_fault(name: &str) -> Option<&'static str> {
    let mut letters = name.chars();
    let begins = letters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    if !begins || !letters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Some("is no name: names are letters, digits and _, and don't begin with a digit");
    }
    is_taken(name).then_some("has a meaning in formulas already")
}

/// Whether the language itself gives a name a meaning.
pub(super) fn is_taken(name: &str) -> bool {
    COORDINATES.contains(&name) || name == POINT || constant(name).is_some() || function(name).is_some()
}

/// The constants by name.
pub(super) const CONSTANTS: [(&str, f64); 7] = [
    ("pi", consts::PI),
    ("π", consts::PI),
    ("tau", consts::TAU),
    ("τ", consts::TAU),
    ("turn", consts::TAU),
    ("deg", consts::PI / 180.0),
    ("e", consts::E),
];

/// The constant of a name.
pub(super) fn constant(name: &str) -> Option<f64> {
    CONSTANTS.iter().find(|constant| constant.0 == name).map(|constant| constant.1)
}

/// What to write for a name that other systems have.
pub(super) fn elsewhere(name: &str) -> Option<&'static str> {
    Some(match name {
        "log" => "write ln(a) for the natural logarithm, log10(a) or log2(a) for others",
        "arcsin" => "write asin",
        "arccos" => "write acos",
        "arctan" | "atn" => "write atan",
        "arctan2" => "write atan2(y, x)",
        "sgn" | "signum" => "write sign",
        "fabs" => "write abs",
        "frac" => "write fract",
        "lerp" => "write mix(a, b, t)",
        "fmod" => "write mod(a, b)",
        "sqr" | "square" => "write a^2",
        "if" | "select" => "less(a, b) is 1 where a < b and 0 elsewhere; mix(no, yes, less(a, b)) chooses",
        "r" | "rho" => "there are x, y and z; define it: r = hypot(x, y); ...",
        "theta" | "phi" | "angle" => "there are x, y and z; define it: phi = atan2(y, x); ...",
        "t" | "time" => "the time is `t`, in scenes",
        "pos" | "position" => "the point is `p`, its coordinates are x, y and z",
        "vec2" | "vec3" | "float2" | "float3" => "write vec(a, b) or vec(a, b, c)",
        "norm" | "mag" | "magnitude" => "write length(v)",
        _ => return None,
    })
}

/// Longer words are nobody's misspelling of a name.
const LONGEST_WORD: usize = 24;

/// The name that `word` is probably meant to be.
pub(super) fn closest<'n>(word: &str, names: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    if word.len() > LONGEST_WORD {
        return None;
    }
    let word = word.to_lowercase();
    let close = names.into_iter().filter_map(|name| {
        let mistakes = strsim::damerau_levenshtein(&word, name);
        // At most one mistake in three letters, or a name with more or fewer letters at its end.
        let is_close = 3 * mistakes <= word.len().max(name.len());
        let is_part = word.len() >= 3 && (name.starts_with(&word) || (name.len() >= 3 && word.starts_with(name)));
        (is_close || is_part).then_some((mistakes, name))
    });
    close.min_by_key(|&(mistakes, _)| mistakes).map(|(_, name)| name)
}

fn fold(b: &mut Builder, op: Binary, args: &[TermId]) -> TermId {
    args[1..].iter().fold(args[0], |before, &next| b.binary(op, before, next))
}

/// The exponential grows and its reciprocal falls, so that their difference encloses tightly in intervals.
fn sinh(b: &mut Builder, args: &[TermId]) -> TermId {
    let exp = b.unary(Unary::Exp, args[0]);
    let (one, half) = (b.literal(1.0), b.literal(0.5));
    let inverse = b.binary(Binary::Div, one, exp);
    let difference = b.binary(Binary::Sub, exp, inverse);
    b.binary(Binary::Mul, difference, half)
}

/// Of the absolute value, which makes intervals around 0 narrower.
fn cosh(b: &mut Builder, args: &[TermId]) -> TermId {
    let a = b.unary(Unary::Abs, args[0]);
    let exp = b.unary(Unary::Exp, a);
    let (one, half) = (b.literal(1.0), b.literal(0.5));
    let inverse = b.binary(Binary::Div, one, exp);
    let sum = b.binary(Binary::Add, exp, inverse);
    b.binary(Binary::Mul, sum, half)
}

/// `1 - 2 / (exp(2a) + 1)`: the argument occurs once, and an exponential that overflows does no harm.
fn tanh(b: &mut Builder, args: &[TermId]) -> TermId {
    if let Some(number) = b.number(args[0]) {
        return b.literal(libm::tanh(number));
    }
    let (one, two) = (b.literal(1.0), b.literal(2.0));
    let twice = b.binary(Binary::Mul, args[0], two);
    let exp = b.unary(Unary::Exp, twice);
    let sum = b.binary(Binary::Add, exp, one);
    let quotient = b.binary(Binary::Div, two, sum);
    b.binary(Binary::Sub, one, quotient)
}

fn logarithm(b: &mut Builder, a: TermId, ln_of_base: f64) -> TermId {
    let (ln, scale) = (b.unary(Unary::Ln, a), b.literal(ln_of_base));
    b.binary(Binary::Div, ln, scale)
}

fn cbrt(b: &mut Builder, args: &[TermId]) -> TermId {
    let (sign, absolute, third) = (sign(b, args[0]), b.unary(Unary::Abs, args[0]), b.literal(1.0 / 3.0));
    let root = b.binary(Binary::Pow, absolute, third);
    b.binary(Binary::Mul, sign, root)
}

/// `sqrt` of the sum of squares.
fn hypot(b: &mut Builder, args: &[TermId]) -> TermId {
    let squares: Vec<TermId> = args.iter().map(|&a| b.unary(Unary::Square, a)).collect();
    let sum = fold(b, Binary::Add, &squares);
    b.unary(Unary::Sqrt, sum)
}

fn sign(b: &mut Builder, a: TermId) -> TermId {
    let zero = b.literal(0.0);
    let (positive, negative) = (b.binary(Binary::Less, zero, a), b.binary(Binary::Less, a, zero));
    b.binary(Binary::Sub, positive, negative)
}

pub(super) fn ceil(b: &mut Builder, args: &[TermId]) -> TermId {
    let opposite = b.unary(Unary::Neg, args[0]);
    let floor = b.unary(Unary::Floor, opposite);
    b.unary(Unary::Neg, floor)
}

pub(super) fn round(b: &mut Builder, args: &[TermId]) -> TermId {
    let half = b.literal(0.5);
    let sum = b.binary(Binary::Add, args[0], half);
    b.unary(Unary::Floor, sum)
}

fn fract(b: &mut Builder, args: &[TermId]) -> TermId {
    let floor = b.unary(Unary::Floor, args[0]);
    b.binary(Binary::Sub, args[0], floor)
}

pub(super) fn modulo(b: &mut Builder, args: &[TermId]) -> TermId {
    let quotient = b.binary(Binary::Div, args[0], args[1]);
    let floor = b.unary(Unary::Floor, quotient);
    let whole = b.binary(Binary::Mul, floor, args[1]);
    b.binary(Binary::Sub, args[0], whole)
}

fn clamp(b: &mut Builder, a: TermId, low: TermId, high: TermId) -> TermId {
    let above = b.binary(Binary::Max, a, low);
    b.binary(Binary::Min, above, high)
}

fn mix(b: &mut Builder, args: &[TermId]) -> TermId {
    let difference = b.binary(Binary::Sub, args[1], args[0]);
    let part = b.binary(Binary::Mul, difference, args[2]);
    b.binary(Binary::Add, args[0], part)
}

fn step(b: &mut Builder, args: &[TermId]) -> TermId {
    let (one, below) = (b.literal(1.0), b.binary(Binary::Less, args[1], args[0]));
    b.binary(Binary::Sub, one, below)
}

fn smoothstep(b: &mut Builder, args: &[TermId]) -> TermId {
    let (zero, one, two, three) = (b.literal(0.0), b.literal(1.0), b.literal(2.0), b.literal(3.0));
    let (above, width) = (b.binary(Binary::Sub, args[2], args[0]), b.binary(Binary::Sub, args[1], args[0]));
    let share = b.binary(Binary::Div, above, width);
    let t = clamp(b, share, zero, one);
    let (square, twice) = (b.unary(Unary::Square, t), b.binary(Binary::Mul, t, two));
    let rest = b.binary(Binary::Sub, three, twice);
    b.binary(Binary::Mul, square, rest)
}

fn vector(_: &mut Builder, args: &[Value]) -> Result<Value, String> {
    let parts: Vec<TermId> = args.iter().flat_map(Value::parts).copied().collect();
    match parts.len() {
        1 => Err("needs two numbers at least".into()),
        _ => Value::of(&parts).ok_or_else(|| format!("can't have {} parts: vectors have 2 or 3", parts.len())),
    }
}

fn length(b: &mut Builder, args: &[Value]) -> Result<Value, String> {
    match args {
        [vector] if vector.as_number().is_some() => Err("is that of a vector; write abs(a) for a number".into()),
        [vector] => Ok(Value::number(hypot(b, vector.parts()))),
        numbers => {
            let numbers: Option<Vec<TermId>> = numbers.iter().map(Value::as_number).collect();
            let numbers = numbers.ok_or("takes one vector, or two or three numbers")?;
            Ok(Value::number(hypot(b, &numbers)))
        }
    }
}

/// The parts of two vectors that have as many.
fn pair(args: &[Value]) -> Result<[&[TermId]; 2], String> {
    match args {
        [v, w] if v.parts().len() == w.parts().len() && v.as_number().is_none() => Ok([v.parts(), w.parts()]),
        [v, w] => Err(format!("takes two vectors of the same length, not {} and {}", v.kind(), w.kind())),
        _ => Err("takes two vectors".into()),
    }
}

fn dot(b: &mut Builder, args: &[Value]) -> Result<Value, String> {
    let [v, w] = pair(args)?;
    let products: Vec<TermId> = v.iter().zip(w).map(|(&v, &w)| b.binary(Binary::Mul, v, w)).collect();
    Ok(Value::number(fold(b, Binary::Add, &products)))
}

fn cross(b: &mut Builder, args: &[Value]) -> Result<Value, String> {
    let [&[vx, vy, vz], &[wx, wy, wz]] = pair(args)? else {
        return Err("takes two vectors of 3".into());
    };
    let mut minor = |[a, b_, c, d]: [TermId; 4]| {
        let (left, right) = (b.binary(Binary::Mul, a, d), b.binary(Binary::Mul, b_, c));
        b.binary(Binary::Sub, left, right)
    };
    let parts = [minor([vy, vz, wy, wz]), minor([vz, vx, wz, wx]), minor([vx, vy, wx, wy])];
    Value::of(&parts).ok_or_else(String::new)
}

fn normalize(b: &mut Builder, args: &[Value]) -> Result<Value, String> {
    if args[0].as_number().is_some() {
        return Err("is that of a vector; write sign(a) for a number".into());
    }
    let length = hypot(b, args[0].parts());
    divided(b, &args[0], length)
}

/// A vector by a number.
fn divided(b: &mut Builder, vector: &Value, by: TermId) -> Result<Value, String> {
    let parts: Vec<TermId> = vector.parts().iter().map(|&part| b.binary(Binary::Div, part, by)).collect();
    Value::of(&parts).ok_or_else(String::new)
}

fn distance(b: &mut Builder, args: &[Value]) -> Result<Value, String> {
    let [v, w] = pair(args)?;
    let differences: Vec<TermId> = v.iter().zip(w).map(|(&v, &w)| b.binary(Binary::Sub, v, w)).collect();
    Ok(Value::number(hypot(b, &differences)))
}
