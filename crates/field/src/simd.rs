//! Which instruction set the batch kernels run on.
//!
//! Kernels are instantiated for SSE2, AVX2 and AVX-512 on x86-64 (SSE4.2 would bring nothing over SSE2 here) and for
//! what the target has elsewhere. All of them compute the same bits. Without the feature `instruction-sets`, and in the tests
//! inside of this crate, there is SSE2 alone: kernels for all take minutes to build.

pub use fearless_simd::Level;

/// The best instruction set of this machine that kernels exist for.
pub fn best() -> Level {
    let best = Level::new();
    #[cfg(all(target_arch = "x86_64", not(all(feature = "instruction-sets", not(test)))))]
    let best = best.as_sse2().map_or(best, Level::Sse2);
    best
}

/// All instruction sets of this machine that kernels exist for, the best one last.
pub fn available() -> Vec<Level> {
    let best = best();
    #[cfg(target_arch = "x86_64")]
    let levels =
        [best.as_sse2().map(Level::Sse2), best.as_avx2().map(Level::Avx2), best.as_avx512().map(Level::Avx512)]
            .into_iter()
            .flatten()
            .collect();
    #[cfg(not(target_arch = "x86_64"))]
    let levels = vec![best];
    levels
}

/// The short name of an instruction set: `sse2`, `avx2`, `avx512`, or `native` on other machines than x86-64.
pub fn name(level: Level) -> &'static str {
    #[cfg(target_arch = "x86_64")]
    let name = match level {
        Level::Avx512(_) => "avx512",
        Level::Avx2(_) => "avx2",
        _ => "sse2",
    };
    #[cfg(not(target_arch = "x86_64"))]
    let name = {
        let _ = level;
        "native"
    };
    name
}

/// Runs `$body` compiled for the instruction set of `$level`, with `$token` as the proof that it is there.
#[cfg(all(target_arch = "x86_64", feature = "instruction-sets", not(test)))]
macro_rules! dispatch {
    ($level:expr, $token:ident => $body:expr) => {{
        use fearless_simd::Simd;
        let level: $crate::simd::Level = $level;
        if let Some($token) = level.as_avx512() {
            $token.vectorize(
                #[inline(always)]
                || $body,
            )
        } else if let Some($token) = level.as_avx2() {
            $token.vectorize(
                #[inline(always)]
                || $body,
            )
        } else {
            let $token = level.as_sse2().expect("x86-64 has SSE2");
            $token.vectorize(
                #[inline(always)]
                || $body,
            )
        }
    }};
}

/// As above, but for the lowest instruction set alone.
#[cfg(all(target_arch = "x86_64", not(all(feature = "instruction-sets", not(test)))))]
macro_rules! dispatch {
    ($level:expr, $token:ident => $body:expr) => {{
        use fearless_simd::Simd;
        let $token = $level.as_sse2().expect("x86-64 has SSE2");
        $token.vectorize(
            #[inline(always)]
            || $body,
        )
    }};
}

/// Runs `$body` compiled for the instruction set of `$level`, with `$token` as the proof that it is there.
#[cfg(not(target_arch = "x86_64"))]
macro_rules! dispatch {
    ($level:expr, $token:ident => $body:expr) => {
        fearless_simd::dispatch!($level, $token => $body)
    };
}

pub(crate) use dispatch;

/// As [`dispatch!`], for kernels that run seldom and take long to build: AVX-512 machines run those for AVX2.
#[cfg(all(target_arch = "x86_64", feature = "instruction-sets", not(test)))]
macro_rules! dispatch_up_to_avx2 {
    ($level:expr, $token:ident => $body:expr) => {{
        use fearless_simd::Simd;
        let level: $crate::simd::Level = $level;
        if let Some($token) = level.as_avx2() {
            $token.vectorize(
                #[inline(always)]
                || $body,
            )
        } else {
            let $token = level.as_sse2().expect("x86-64 has SSE2");
            $token.vectorize(
                #[inline(always)]
                || $body,
            )
        }
    }};
}

/// As [`dispatch!`].
#[cfg(all(target_arch = "x86_64", not(all(feature = "instruction-sets", not(test)))))]
macro_rules! dispatch_up_to_avx2 {
    ($level:expr, $token:ident => $body:expr) => {{
        use fearless_simd::Simd;
        let $token = $level.as_sse2().expect("x86-64 has SSE2");
        $token.vectorize(
            #[inline(always)]
            || $body,
        )
    }};
}

/// As [`dispatch!`].
#[cfg(not(target_arch = "x86_64"))]
macro_rules! dispatch_up_to_avx2 {
    ($level:expr, $token:ident => $body:expr) => {
        fearless_simd::dispatch!($level, $token => $body)
    };
}

pub(crate) use dispatch_up_to_avx2;

/// Runs `work` compiled for an instruction set, so that loops in it are vectorised for that. Write the closure as
/// `#[inline(always)] || ...`, in the call itself.
#[inline(always)]
pub fn with<R>(level: Level, work: impl FnOnce() -> R) -> R {
    dispatch!(level, token => {
        let _ = token;
        work()
    })
}
