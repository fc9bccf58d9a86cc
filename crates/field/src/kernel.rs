//! Kernels: the generic formulas, instantiated for each number type and wrapped in loops over batches.
//!
//! A batch is at most [`BATCH`] points in structure-of-arrays form. A number of a type with `C` components (1 for plain values, 4
//! for values with gradients) takes `C` consecutive [`Block`]s. Kernels are called through pointers, once for each batch, and
//! never work in place: a select between a new number and the one that is there would become a masked store, which is slow on
//! some processors. Inside, the formula and everything below it is inlined and compiled for one instruction set.

use crate::expr::Expr;
use crate::scalar::{Constants, Dual, Interval, Intervals, Lanes, Scalar, Taylor};
use crate::shape::{Combine, Map, Modify, Primitive};
use crate::simd::{Level, dispatch, dispatch_up_to_avx2};
use crate::vector::{Vec3, vec3};
use fearless_simd::Simd;

mod packed;

pub(crate) use packed::Packed;
use packed::load_point;

/// The largest number of points evaluated at once: few enough that a program's registers stay in the first-level cache.
pub const BATCH: usize = 256;

/// Batches are filled up to a multiple of this, the widest vector.
pub const WIDEST: usize = 16;

/// One component of the numbers of a batch.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Block(pub [f32; BATCH]);

impl Default for Block {
    fn default() -> Self {
        Self([0.0; BATCH])
    }
}

/// A primitive's work on one batch.
pub struct PrimitiveJob<'a> {
    /// Three numbers a point.
    pub points: &'a [Block],
    /// Subtracted from each point before the formula.
    pub at: &'a [f32],
    /// The formula's constants.
    pub constants: &'a [f32],
    /// What the result is the minimum with, if anything.
    pub before: Option<&'a [Block]>,
    /// The result.
    pub out: &'a mut [Block],
    /// How many points, a multiple of [`WIDEST`].
    pub count: usize,
}

#[inline(always)]
fn primitive_loop<P: Primitive, I: Simd, K: Packed<I>>(token: I, job: &mut PrimitiveJob<'_>) {
    let PrimitiveJob { points, at, constants, before, ref mut out, count } = *job;
    assert!(count <= BATCH && count.is_multiple_of(WIDEST));
    let (points, out) = (&points[..3 * K::COMPONENTS], &mut out[..K::COMPONENTS]);
    let like = K::load(token, points, 0);
    let at = Constants::new(like, at, 3).get::<3>();
    let constants = Constants::new(like, constants, constants.len());
    let mut lane = 0;
    match before {
        None => {
            while lane < count {
                let p = load_point::<I, K>(token, points, lane) - at.into();
                P::distance(p, &constants).store(out, lane);
                lane += Lanes::<I>::COUNT;
            }
        }
        Some(before) => {
            let before = &before[..K::COMPONENTS];
            while lane < count {
                let p = load_point::<I, K>(token, points, lane) - at.into();
                K::load(token, before, lane).min(P::distance(p, &constants)).store(out, lane);
                lane += Lanes::<I>::COUNT;
            }
        }
    }
}

/// The loops of a primitive. As methods that the primitive has by itself, they are compiled where it is: side by side with those of
/// others, and only when something about it changes.
trait PrimitiveLoops: Primitive + Sized {
    fn values(level: Level, job: &mut PrimitiveJob<'_>) {
        dispatch!(level, token => primitive_loop::<Self, _, Lanes<_>>(token, job));
    }

    fn gradients(level: Level, job: &mut PrimitiveJob<'_>) {
        dispatch!(level, token => primitive_loop::<Self, _, Dual<Lanes<_>>>(token, job));
    }

    fn seconds(level: Level, job: &mut PrimitiveJob<'_>) {
        dispatch_up_to_avx2!(level, token => primitive_loop::<Self, _, Dual<Dual<Lanes<_>, 1>, 1>>(token, job));
    }

    fn models(level: Level, job: &mut PrimitiveJob<'_>) {
        dispatch!(level, token => primitive_loop::<Self, _, Taylor<_>>(token, job));
    }
}

impl<F: Primitive> PrimitiveLoops for F {}

/// A primitive over one batch of points of some number type.
pub type PrimitiveKernel = fn(Level, &mut PrimitiveJob<'_>);

/// The formula of `P` over Taylor models.
pub fn primitive_models<P: Primitive>(level: Level, job: &mut PrimitiveJob<'_>) {
    P::models(level, job);
}

/// A binary operator's work on one batch.
pub struct CombineJob<'a> {
    /// The first operand.
    pub a: &'a [Block],
    /// The second operand.
    pub b: &'a [Block],
    /// The formula's constants.
    pub constants: &'a [f32],
    /// The result.
    pub out: &'a mut [Block],
    /// How many points, a multiple of [`WIDEST`].
    pub count: usize,
}

#[inline(always)]
fn combine_loop<C: Combine, I: Simd, K: Packed<I>>(token: I, job: &mut CombineJob<'_>, share: bool) {
    let CombineJob { a, b, constants, ref mut out, count } = *job;
    assert!(count <= BATCH && count.is_multiple_of(WIDEST));
    let (a, b, out) = (&a[..K::COMPONENTS], &b[..K::COMPONENTS], &mut out[..K::COMPONENTS]);
    let constants = Constants::new(K::load(token, a, 0), constants, constants.len());
    let mut lane = 0;
    while lane < count {
        let (x, y) = (K::load(token, a, lane), K::load(token, b, lane));
        let result = if share { C::share(x, y, &constants) } else { C::combine(x, y, &constants) };
        result.store(out, lane);
        lane += Lanes::<I>::COUNT;
    }
}

/// The loops of a binary operator; see [`PrimitiveLoops`].
trait CombineLoops: Combine + Sized {
    fn values(level: Level, job: &mut CombineJob<'_>) {
        dispatch!(level, token => combine_loop::<Self, _, Lanes<_>>(token, job, false));
    }

    fn gradients(level: Level, job: &mut CombineJob<'_>) {
        dispatch!(level, token => combine_loop::<Self, _, Dual<Lanes<_>>>(token, job, false));
    }

    fn seconds(level: Level, job: &mut CombineJob<'_>) {
        dispatch_up_to_avx2!(level, token => combine_loop::<Self, _, Dual<Dual<Lanes<_>, 1>, 1>>(token, job, false));
    }

    fn ranges(level: Level, job: &mut CombineJob<'_>) {
        dispatch!(level, token => combine_loop::<Self, _, Intervals<_>>(token, job, false));
    }

    fn models(level: Level, job: &mut CombineJob<'_>) {
        dispatch!(level, token => combine_loop::<Self, _, Taylor<_>>(token, job, false));
    }

    fn shares(level: Level, job: &mut CombineJob<'_>) {
        dispatch!(level, token => combine_loop::<Self, _, Lanes<_>>(token, job, true));
    }
}

impl<F: Combine> CombineLoops for F {}

/// The work of an operator with one operand on one batch.
pub struct ModifyJob<'a> {
    /// The operand.
    pub from: &'a [Block],
    /// The formula's constants.
    pub constants: &'a [f32],
    /// The result.
    pub out: &'a mut [Block],
    /// How many points, a multiple of [`WIDEST`].
    pub count: usize,
}

#[inline(always)]
fn modify_loop<M: Modify, I: Simd, K: Packed<I>>(token: I, job: &mut ModifyJob<'_>) {
    let ModifyJob { from, constants, ref mut out, count } = *job;
    assert!(count <= BATCH && count.is_multiple_of(WIDEST));
    let (from, out) = (&from[..K::COMPONENTS], &mut out[..K::COMPONENTS]);
    let constants = Constants::new(K::load(token, from, 0), constants, constants.len());
    let mut lane = 0;
    while lane < count {
        M::modify(K::load(token, from, lane), &constants).store(out, lane);
        lane += Lanes::<I>::COUNT;
    }
}

/// The loops of a unary operator; see [`PrimitiveLoops`].
trait ModifyLoops: Modify + Sized {
    fn values(level: Level, job: &mut ModifyJob<'_>) {
        dispatch!(level, token => modify_loop::<Self, _, Lanes<_>>(token, job));
    }

    fn gradients(level: Level, job: &mut ModifyJob<'_>) {
        dispatch!(level, token => modify_loop::<Self, _, Dual<Lanes<_>>>(token, job));
    }

    fn seconds(level: Level, job: &mut ModifyJob<'_>) {
        dispatch_up_to_avx2!(level, token => modify_loop::<Self, _, Dual<Dual<Lanes<_>, 1>, 1>>(token, job));
    }

    fn ranges(level: Level, job: &mut ModifyJob<'_>) {
        dispatch!(level, token => modify_loop::<Self, _, Intervals<_>>(token, job));
    }

    fn models(level: Level, job: &mut ModifyJob<'_>) {
        dispatch!(level, token => modify_loop::<Self, _, Taylor<_>>(token, job));
    }
}

impl<F: Modify> ModifyLoops for F {}

/// The affine map `p' = M p + t` as a formula; its first twelve constants are the columns of `M`, then `t`.
#[inline(always)]
pub(crate) fn affine<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
    let [ax, ay, az, bx, by, bz, cx, cy, cz, tx, ty, tz] = c.get();
    vec3(ax * p.x + bx * p.y + cx * p.z + tx, ay * p.x + by * p.y + cy * p.z + ty, az * p.x + bz * p.y + cz * p.z + tz)
}

/// How many constants an affine map has: those of its formula, and the spectral norm of `M`.
pub(crate) const AFFINE_CONSTANTS: usize = 13;

/// The work of an affine map on one batch of points.
pub struct AffineJob<'a> {
    /// The points.
    pub from: &'a [Block],
    /// The map's constants.
    pub constants: &'a [f32],
    /// The mapped points.
    pub to: &'a mut [Block],
    /// How many points, a multiple of [`WIDEST`].
    pub count: usize,
}

#[inline(always)]
fn affine_loop<I: Simd, K: Packed<I>>(token: I, job: &mut AffineJob<'_>) {
    let AffineJob { from, constants, ref mut to, count } = *job;
    assert!(count <= BATCH && count.is_multiple_of(WIDEST));
    let c = K::COMPONENTS;
    let (from, to) = (&from[..3 * c], &mut to[..3 * c]);
    let constants = Constants::new(K::load(token, from, 0), constants, AFFINE_CONSTANTS);
    let mut lane = 0;
    while lane < count {
        let q = affine(load_point::<I, K>(token, from, lane), &constants);
        q.x.store(&mut to[..c], lane);
        q.y.store(&mut to[c..2 * c], lane);
        q.z.store(&mut to[2 * c..], lane);
        lane += Lanes::<I>::COUNT;
    }
}

/// Maps a batch of points.
pub(crate) fn affine_values(level: Level, job: &mut AffineJob<'_>) {
    dispatch!(level, token => affine_loop::<_, Lanes<_>>(token, job));
}

/// Maps a batch of points with derivatives.
pub(crate) fn affine_gradients(level: Level, job: &mut AffineJob<'_>) {
    dispatch!(level, token => affine_loop::<_, Dual<Lanes<_>>>(token, job));
}

/// Maps a batch of points with second derivatives.
pub(crate) fn affine_seconds(level: Level, job: &mut AffineJob<'_>) {
    dispatch_up_to_avx2!(level, token => affine_loop::<_, Dual<Dual<Lanes<_>, 1>, 1>>(token, job));
}

/// Maps a batch of boxes.
pub(crate) fn affine_ranges(level: Level, job: &mut AffineJob<'_>) {
    dispatch!(level, token => affine_loop::<_, Intervals<_>>(token, job));
}

/// Maps a batch of Taylor models of points.
pub(crate) fn affine_models(level: Level, job: &mut AffineJob<'_>) {
    dispatch!(level, token => affine_loop::<_, Taylor<_>>(token, job));
}

/// The work of a map on one batch of points.
pub struct MapJob<'a> {
    /// The points.
    pub from: &'a [Block],
    /// Subtracted from each point before the formula.
    pub at: &'a [f32],
    /// The formula's constants.
    pub constants: &'a [f32],
    /// The mapped points.
    pub to: &'a mut [Block],
    /// How many points, a multiple of [`WIDEST`].
    pub count: usize,
}

#[inline(always)]
fn map_loop<M: Map, I: Simd, K: Packed<I>>(token: I, job: &mut MapJob<'_>) {
    let MapJob { from, at, constants, ref mut to, count } = *job;
    assert!(count <= BATCH && count.is_multiple_of(WIDEST));
    let c = K::COMPONENTS;
    let (from, to) = (&from[..3 * c], &mut to[..3 * c]);
    let like = K::load(token, from, 0);
    let at = Constants::new(like, at, 3).get::<3>();
    let constants = Constants::new(like, constants, constants.len());
    let mut lane = 0;
    while lane < count {
        let q = M::map(load_point::<I, K>(token, from, lane) - at.into(), &constants);
        q.x.store(&mut to[..c], lane);
        q.y.store(&mut to[c..2 * c], lane);
        q.z.store(&mut to[2 * c..], lane);
        lane += Lanes::<I>::COUNT;
    }
}

/// The loops of a map; see [`PrimitiveLoops`].
trait MapLoops: Map + Sized {
    fn values(level: Level, job: &mut MapJob<'_>) {
        dispatch!(level, token => map_loop::<Self, _, Lanes<_>>(token, job));
    }

    fn gradients(level: Level, job: &mut MapJob<'_>) {
        dispatch!(level, token => map_loop::<Self, _, Dual<Lanes<_>>>(token, job));
    }

    fn seconds(level: Level, job: &mut MapJob<'_>) {
        dispatch_up_to_avx2!(level, token => map_loop::<Self, _, Dual<Dual<Lanes<_>, 1>, 1>>(token, job));
    }

    fn ranges(level: Level, job: &mut MapJob<'_>) {
        dispatch!(level, token => map_loop::<Self, _, Intervals<_>>(token, job));
    }

    fn models(level: Level, job: &mut MapJob<'_>) {
        dispatch!(level, token => map_loop::<Self, _, Taylor<_>>(token, job));
    }
}

impl<F: Map> MapLoops for F {}

/// A map's formula over one number type.
pub type MapFn<S> = fn(Vec3<S>, &Constants<'_, S>) -> Vec3<S>;

/// A map's formula, for every number type.
#[derive(Debug)]
#[allow(missing_docs, reason = "one field for each number type")]
pub struct MapKernels {
    pub values: fn(Level, &mut MapJob<'_>),
    pub gradients: fn(Level, &mut MapJob<'_>),
    pub seconds: fn(Level, &mut MapJob<'_>),
    pub ranges: fn(Level, &mut MapJob<'_>),
    pub models: fn(Level, &mut MapJob<'_>),
    pub real: MapFn<f64>,
    pub interval: MapFn<Interval>,
    pub slope: MapFn<Dual<Interval>>,
    pub dual: MapFn<Dual<f64>>,
    pub dual2: MapFn<Dual2>,
    pub expr: for<'g> fn(Vec3<Expr<'g>>, &Constants<'_, Expr<'g>>) -> Vec3<Expr<'g>>,
}

impl MapKernels {
    /// All instantiations of one formula.
    pub const fn of<M: Map>() -> Self {
        fn expr<'g, M: Map>(p: Vec3<Expr<'g>>, c: &Constants<'_, Expr<'g>>) -> Vec3<Expr<'g>> {
            M::map(p, c)
        }
        Self {
            values: <M as MapLoops>::values,
            gradients: <M as MapLoops>::gradients,
            seconds: <M as MapLoops>::seconds,
            ranges: <M as MapLoops>::ranges,
            models: <M as MapLoops>::models,
            real: M::map::<f64>,
            interval: M::map::<Interval>,
            slope: M::map::<Dual<Interval>>,
            dual: M::map::<Dual<f64>>,
            dual2: M::map::<Dual2>,
            expr: expr::<M>,
        }
    }
}

/// A primitive's formula over one number type.
pub type PrimitiveFn<S> = fn(Vec3<S>, &Constants<'_, S>) -> S;
/// A binary operator's formula over one number type.
pub type CombineFn<S> = fn(S, S, &Constants<'_, S>) -> S;
/// A unary operator's formula over one number type.
pub type ModifyFn<S> = fn(S, &Constants<'_, S>) -> S;

/// Value, gradient and (twice) Hessian in one number.
pub type Dual2 = Dual<Dual<f64>>;

macro_rules! kernels {
    ($(#[$doc:meta])* $Kernels:ident, $Trait:ident :: $formula:ident, $Fn:ident, $Job:ident,
     $Loops:ident, [$($arg:ident: $Arg:ty),*], expr [$($ExprArg:ty),*]
     $(, $extra:ident)* $(; $single:ident: $Single:ty)*) => {
        $(#[$doc])*
        #[derive(Debug)]
        #[allow(missing_docs, reason = "one field for each number type")]
        pub struct $Kernels {
            pub values: fn(Level, &mut $Job<'_>),
            pub gradients: fn(Level, &mut $Job<'_>),
            $(pub $extra: fn(Level, &mut $Job<'_>),)*
            pub real: $Fn<f64>,
            pub interval: $Fn<Interval>,
            pub dual: $Fn<Dual<f64>>,
            pub dual2: $Fn<Dual2>,
            pub expr: for<'g> fn($($ExprArg,)* &Constants<'_, Expr<'g>>) -> Expr<'g>,
            $(pub $single: $Fn<$Single>,)*
        }

        impl $Kernels {
            /// All instantiations of one formula.
            pub const fn of<F: $Trait>() -> Self {
                fn expr<'g, F: $Trait>($($arg: $ExprArg,)* c: &Constants<'_, Expr<'g>>) -> Expr<'g> {
                    F::$formula($($arg,)* c)
                }
                Self {
                    values: <F as $Loops>::values,
                    gradients: <F as $Loops>::gradients,
                    $($extra: <F as $Loops>::$extra,)*
                    real: F::$formula::<f64>,
                    interval: F::$formula::<Interval>,
                    dual: F::$formula::<Dual<f64>>,
                    dual2: F::$formula::<Dual2>,
                    expr: expr::<F>,
                    $($single: F::$formula::<$Single>,)*
                }
            }
        }
    };
}

kernels!(
    /// A primitive's formula, for every number type.
    PrimitiveKernels, Primitive::distance, PrimitiveFn, PrimitiveJob, PrimitiveLoops,
    [p: Vec3<S>], expr [Vec3<Expr<'g>>], seconds
);
kernels!(
    /// A binary operator's formula, for every number type.
    CombineKernels, Combine::combine, CombineFn, CombineJob, CombineLoops,
    [a: S, b: S], expr [Expr<'g>, Expr<'g>], seconds, ranges, models, shares
);
kernels!(
    /// A unary operator's formula, for every number type.
    ModifyKernels, Modify::modify, ModifyFn, ModifyJob, ModifyLoops,
    [value: S], expr [Expr<'g>], seconds, ranges, models; slope: Dual<Interval, 1>
);
