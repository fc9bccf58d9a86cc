//! What the elementary functions of [`Lanes`] promise, and a way to run them by themselves.
//!
//! [`FUNCTIONS`] states the largest error of each, in units in the last place ([`ulps`]). The tests check it on a sample of
//! all arguments; `cargo run --release -p freikugel-field --example elementary` checks it on all of them.

use crate::scalar::{Lanes, Scalar, WIDEST};
use crate::simd::{Level, dispatch};
use fearless_simd::Simd;

/// An elementary function in single precision.
pub struct Function {
    /// Its name as a method of [`Scalar`].
    pub name: &'static str,
    /// The largest error over all arguments, in units in the last place.
    pub max_error: f64,
    /// The same function in double precision.
    pub reference: Reference,
    kernel: fn(Level, &[f32], &[f32], &mut [f32]),
}

/// A function in double precision, with one or two arguments.
#[derive(Clone, Copy)]
pub enum Reference {
    /// Of one number.
    Unary(fn(f64) -> f64),
    /// Of two numbers, in the order of the method: `y.atan2(x)`, `base.pow(exponent)`.
    Binary(fn(f64, f64) -> f64),
}

impl Function {
    /// Computes `out[i] = f(a[i])` or `f(a[i], b[i])` on the lanes of an instruction set. `b` is not read by functions of one
    /// number.
    ///
    /// # Panics
    /// If `a` or a `b` that is read is shorter than `out`.
    pub fn apply(&self, level: Level, a: &[f32], b: &[f32], out: &mut [f32]) {
        let b = if matches!(self.reference, Reference::Unary(_)) { a } else { b };
        (self.kernel)(level, a, b, out);
    }
}

/// The distance of `value` from `exact` in units of the last place that a single-precision number of the size of `exact`
/// has; 0 for equal infinities and for NaN both, infinite where only one is infinite or NaN. An `exact` that rounds to
/// infinity counts as infinite.
pub fn ulps(value: f32, exact: f64) -> f64 {
    if value.is_nan() && exact.is_nan() || f64::from(value) == exact || value == exact as f32 && value.is_infinite() {
        return 0.0;
    }
    if !value.is_finite() || !exact.is_finite() {
        return f64::INFINITY;
    }
    let exponent = ((exact.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    let unit = f64::from_bits(((exponent.clamp(-126, 127) - 23 + 1023) as u64) << 52);
    (f64::from(value) - exact).abs() / unit
}

#[inline(always)]
fn run<I: Simd>(token: I, a: &[f32], b: &[f32], out: &mut [f32], f: impl Fn(Lanes<I>, Lanes<I>) -> Lanes<I>) {
    let width = Lanes::<I>::COUNT;
    let (a, b) = (&a[..out.len()], &b[..out.len()]);
    let mut chunks = out.chunks_exact_mut(width);
    for ((a, b), out) in a.chunks_exact(width).zip(b.chunks_exact(width)).zip(&mut chunks) {
        f(Lanes::load(token, a), Lanes::load(token, b)).store(out);
    }
    let rest = chunks.into_remainder();
    if rest.is_empty() {
        return;
    }
    let (mut a_rest, mut b_rest, mut out_rest) = ([0.0; WIDEST], [0.0; WIDEST], [0.0; WIDEST]);
    let start = a.len() - rest.len();
    a_rest[..rest.len()].copy_from_slice(&a[start..]);
    b_rest[..rest.len()].copy_from_slice(&b[start..]);
    let (a, b) = (Lanes::load(token, &a_rest[..width]), Lanes::load(token, &b_rest[..width]));
    f(a, b).store(&mut out_rest[..width]);
    rest.copy_from_slice(&out_rest[..rest.len()]);
}

macro_rules! functions {
    ($($kind:ident $name:ident ($($arg:ident),*) $max_error:literal;)*) => {
        /// All elementary functions that have an error. Those of one number were checked on every number of single
        /// precision.
        pub const FUNCTIONS: &[Function] = &[$(Function {
            name: stringify!($name),
            max_error: $max_error,
            reference: Reference::$kind($name::exact),
            kernel: $name::kernel,
        }),*];

        $(mod $name {
            use super::*;

            pub(super) fn exact($($arg: f64),*) -> f64 {
                Scalar::$name($($arg),*)
            }

            pub(super) fn kernel(level: Level, a: &[f32], b: &[f32], out: &mut [f32]) {
                dispatch!(level, token => run(token, a, b, out, #[inline(always)] |a, b| {
                    let _ = b;
                    functions!(@call $name a b $($arg)*)
                }));
            }
        })*
    };
    (@call $name:ident $a:ident $b:ident $x:ident) => { $a.$name() };
    (@call $name:ident $a:ident $b:ident $x:ident $y:ident) => { $a.$name($b) };
}

functions! {
    Unary sin(x) 1.5;
    Unary cos(x) 1.5;
    Unary tan(x) 0.6;
    Unary asin(x) 2.0;
    Unary acos(x) 2.0;
    Unary atan(x) 2.0;
    Unary exp(x) 1.0;
    Unary ln(x) 1.0;
    Unary floor(x) 0.0;
    Binary atan2(y, x) 2.0;
    Binary pow(x, y) 0.6;
}
