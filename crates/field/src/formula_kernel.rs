//! Kernels for the operations of formulas, one operation over one batch at a time.
//!
//! Operands are registers or constants. A constant keeps its double precision until it becomes a number of the kernel's
//! type, so that intervals know whether single precision holds it exactly.

use crate::formula::{Binary, Unary};
use crate::kernel::{BATCH, Block, Packed, WIDEST};
use crate::scalar::{Dual, Intervals, Lanes, Taylor};
use crate::simd::{Level, dispatch};
use fearless_simd::Simd;

/// Where an operand comes from.
#[derive(Clone, Copy)]
pub(crate) enum Source<'a> {
    /// The number in a register.
    Register(&'a [Block]),
    /// The same number everywhere.
    Constant(f64),
}

/// A function of one number over a batch.
pub(crate) struct UnaryJob<'a> {
    pub(crate) from: &'a [Block],
    pub(crate) out: &'a mut [Block],
    /// How many points, a multiple of [`WIDEST`].
    pub(crate) count: usize,
}

/// A function of two numbers over a batch.
pub(crate) struct BinaryJob<'a> {
    pub(crate) a: Source<'a>,
    pub(crate) b: Source<'a>,
    pub(crate) out: &'a mut [Block],
    /// How many points, a multiple of [`WIDEST`].
    pub(crate) count: usize,
}

#[inline(always)]
fn map<I: Simd, K: Packed<I>>(token: I, job: &mut UnaryJob<'_>, f: impl Fn(K) -> K) {
    let UnaryJob { from, ref mut out, count } = *job;
    assert!(count <= BATCH && count.is_multiple_of(WIDEST));
    let (from, out) = (&from[..K::COMPONENTS], &mut out[..K::COMPONENTS]);
    let mut lane = 0;
    while lane < count {
        f(K::load(token, from, lane)).store(out, lane);
        lane += Lanes::<I>::COUNT;
    }
}

#[inline(always)]
fn zip<I: Simd, K: Packed<I>>(token: I, job: &mut BinaryJob<'_>, f: impl Fn(K, K) -> K) {
    let BinaryJob { a, b, ref mut out, count } = *job;
    assert!(count <= BATCH && count.is_multiple_of(WIDEST));
    let out = &mut out[..K::COMPONENTS];
    let mut lane = 0;
    match (a, b) {
        (Source::Register(a), Source::Register(b)) => {
            let (a, b) = (&a[..K::COMPONENTS], &b[..K::COMPONENTS]);
            while lane < count {
                f(K::load(token, a, lane), K::load(token, b, lane)).store(out, lane);
                lane += Lanes::<I>::COUNT;
            }
        }
        (Source::Register(a), Source::Constant(b)) => {
            let a = &a[..K::COMPONENTS];
            let b = K::splat(token, b);
            while lane < count {
                f(K::load(token, a, lane), b).store(out, lane);
                lane += Lanes::<I>::COUNT;
            }
        }
        (Source::Constant(a), Source::Register(b)) => {
            let b = &b[..K::COMPONENTS];
            let a = K::splat(token, a);
            while lane < count {
                f(a, K::load(token, b, lane)).store(out, lane);
                lane += Lanes::<I>::COUNT;
            }
        }
        (Source::Constant(a), Source::Constant(b)) => {
            let value = f(K::splat(token, a), K::splat(token, b));
            while lane < count {
                value.store(out, lane);
                lane += Lanes::<I>::COUNT;
            }
        }
    }
}

#[inline(always)]
fn unary<I: Simd, K: Packed<I>>(token: I, op: Unary, job: &mut UnaryJob<'_>) {
    /// Runs a loop of its own for each function, so that the function is known inside.
    macro_rules! each {
        ($($name:ident),*) => {
            match op {
                $(Unary::$name => map::<I, K>(
                    token,
                    job,
                    #[inline(always)]
                    |a| Unary::$name.apply(a),
                ),)*
            }
        };
    }
    each!(Neg, Abs, Square, Sqrt, Sin, Cos, Tan, Asin, Acos, Atan, Exp, Ln, Floor);
}

#[inline(always)]
fn binary<I: Simd, K: Packed<I>>(token: I, op: Binary, job: &mut BinaryJob<'_>) {
    macro_rules! each {
        ($($name:ident),*) => {
            match op {
                $(Binary::$name => zip::<I, K>(
                    token,
                    job,
                    #[inline(always)]
                    |a, b| Binary::$name.apply(a, b),
                ),)*
            }
        };
    }
    each!(Add, Sub, Mul, Div, Min, Max, Pow, Atan2, Less);
}

/// `from - at`, a coordinate of a moved point.
#[inline(always)]
fn moved<I: Simd, K: Packed<I>>(token: I, job: &mut UnaryJob<'_>, at: f32) {
    let like = K::load(token, job.from, 0);
    let at = like.constant(&[at], 0);
    map::<I, K>(
        token,
        job,
        #[inline(always)]
        |x| x - at,
    );
}

#[inline(always)]
fn power<I: Simd, K: Packed<I>>(token: I, exponent: i32, job: &mut UnaryJob<'_>) {
    /// The common powers have loops of their own, without a branch inside.
    macro_rules! each_power {
        ($($n:literal),*) => {
            match exponent {
                $($n => map::<I, K>(
                    token,
                    job,
                    #[inline(always)]
                    |a| a.powi($n),
                ),)*
                n => map::<I, K>(
                    token,
                    job,
                    #[inline(always)]
                    |a| a.powi(n),
                ),
            }
        };
    }
    each_power!(3, 4, 6, 8);
}

/// The kernels of one number type.
#[derive(Clone, Copy)]
pub(crate) struct FormulaKernels {
    pub(crate) unary: fn(Level, Unary, &mut UnaryJob<'_>),
    pub(crate) binary: fn(Level, Binary, &mut BinaryJob<'_>),
    pub(crate) power: fn(Level, i32, &mut UnaryJob<'_>),
    pub(crate) moved: fn(Level, f32, &mut UnaryJob<'_>),
}

macro_rules! kernels {
    ($NAME:ident, $Number:ty) => {
        pub(crate) const $NAME: FormulaKernels = FormulaKernels {
    unary: |level, op, job| dispatch!(level, token => unary::<_, $Number>(token, op, job)),
    binary: |level, op, job| dispatch!(level, token => binary::<_, $Number>(token, op, job)),
    power: |level, n, job| dispatch!(level, token => power::<_, $Number>(token, n, job)),
    moved: |level, at, job| dispatch!(level, token => moved::<_, $Number>(token, job, at)),
        };
    };
}

kernels!(VALUES, Lanes<_>);
kernels!(GRADIENTS, Dual<Lanes<_>>);
kernels!(SECONDS, Dual<Dual<Lanes<_>, 1>, 1>);
kernels!(RANGES, Intervals<_>);

/// A product with a constant needs no product of polynomials.
pub(crate) const MODELS: FormulaKernels = FormulaKernels {
    binary: |level, op, job| {
        let BinaryJob { a, b, ref mut out, count } = *job;
        match (op, a, b) {
            (Binary::Mul, Source::Register(from), Source::Constant(factor))
            | (Binary::Mul, Source::Constant(factor), Source::Register(from)) => {
                dispatch!(level, token => map::<_, Taylor<_>>(token, &mut UnaryJob { from, out, count },
                    #[inline(always)] |a| a * factor));
            }
            _ => (ALL_MODELS.binary)(level, op, job),
        }
    },
    ..ALL_MODELS
};

kernels!(ALL_MODELS, Taylor<_>);
