//! The inlining guard: a helper that is not inlined into a kernel is compiled for the baseline instruction set and takes
//! the whole kernel down with it. Such a kernel is no faster, mostly far slower, on AVX2 than on SSE2.
//!
//! Operations on wide lanes can't be inlined into such a helper: it calls them. The code of this very program is searched for
//! such calls, which finds them in all kernels, on every processor. Loops over plain numbers, which the compiler turns into
//! wide ones by itself, have no such calls; of these the speed is measured.
#![cfg(all(target_arch = "x86_64", target_os = "linux", feature = "instruction-sets"))]

mod common;

use common::{Random, call};
use fearless_simd::{Avx2, SimdBase, f32x8};
use freikugel_field::elementary::FUNCTIONS;
use freikugel_field::kernel::BATCH;
use freikugel_field::simd::{self, Level};
use freikugel_field::{Evaluator, Points, Structure, shapes};
use glam::DVec3;
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};
use rustc_demangle::demangle;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// How functions are called on x86-64: one byte, and the distance from the end of the instruction in four.
const CALLS: [u8; 2] = [0xe8, 0xe9];

/// The functions of a program by where they stand, with their sizes and names.
type Functions = BTreeMap<u64, (u64, String)>;

/// An operation of a wide instruction set.
fn is_operation(name: &str) -> bool {
    (name.contains("::avx2::") || name.contains("::avx512::")) && name.contains("fearless_simd_kernel")
}

/// What is compiled for a wide instruction set.
fn is_wide(name: &str) -> bool {
    is_operation(name) || name.contains("vectorize_avx2") || name.contains("vectorize_avx512")
}

/// What a function whose code is `code` and which stands at `address` calls or goes on as.
fn called(address: u64, code: &[u8]) -> impl Iterator<Item = u64> {
    code.windows(5).enumerate().filter(|(_, bytes)| CALLS.contains(&bytes[0])).map(move |(offset, bytes)| {
        let distance = i32::from_le_bytes(bytes[1..].try_into().expect("four bytes"));
        (address + offset as u64 + 5).wrapping_add_signed(distance.into())
    })
}

/// Functions that are not compiled for a wide instruction set and call operations of one, with these operations.
fn astray() -> BTreeSet<(String, String)> {
    let program = std::fs::read(std::env::current_exe().expect("this program")).expect("its file");
    let program = object::File::parse(&*program).expect("an executable file");
    let functions: Functions = program
        .symbols()
        .filter(|symbol| symbol.kind() == SymbolKind::Text)
        .map(|symbol| (symbol.address(), (symbol.size(), format!("{:#}", demangle(symbol.name().expect("a name"))))))
        .collect();
    let operations: HashSet<u64> =
        functions.iter().filter(|(_, (_, name))| is_operation(name)).map(|(&address, _)| address).collect();
    let code = program.section_by_name(".text").expect("a program has code");
    functions
        .iter()
        .filter(|(_, (_, name))| !is_wide(name))
        .filter_map(|(&address, (size, name))| Some((address, name, code.data_range(address, *size).ok()??)))
        .flat_map(|(address, name, code)| called(address, code).map(move |callee| (name, callee)))
        .filter(|(_, callee)| operations.contains(callee))
        .map(|(name, callee)| (name.clone(), functions[&callee].1.clone()))
        .collect()
}

/// A function as it should not be.
#[inline(never)]
fn outside(level: Avx2, number: f32) -> f32x8<Avx2> {
    f32x8::splat(level, number) * number
}

#[test]
fn kernels_are_inlined_whole() {
    if let Some(level) = simd::best().as_avx2() {
        black_box(outside(level, black_box(2.0)));
    }
    // All kernels are part of this program, as they can be reached from here.
    black_box((shapes::ALL, FUNCTIONS));
    let (known, others): (Vec<_>, Vec<_>) =
        astray().into_iter().partition(|(name, _)| name.ends_with("inlining::outside"));
    assert!(!known.is_empty(), "the function that stands outside on purpose is not found");
    assert!(others.is_empty(), "functions that are not compiled for the instruction set they use: {others:#?}");
}

/// Twice the width gives up to twice the speed; this much is demanded. Loops that are not compiled for it are no faster.
const GAIN: f64 = 1.15;

/// Calls in one measurement: enough that the clock's resolution does not matter.
const RUNS: usize = 40;

/// The best of so many measurements is free of interruptions on a busy machine.
const MEASUREMENTS: usize = 25;

/// What does not reach the gain is measured again so many times before it counts as a failure.
const TRIES: usize = 60;

/// How long one run takes over so many points on an instruction set.
fn time(work: &mut impl FnMut(Level, usize), level: Level, count: usize) -> Duration {
    let start = Instant::now();
    (0..RUNS).for_each(|_| work(level, count));
    start.elapsed()
}

/// How many times as fast the wider instruction set is. What a call costs without any points is the same on both.
fn gain(mut work: impl FnMut(Level, usize), narrow: Level, wide: Level) -> f64 {
    let mut best = [[Duration::MAX; 2]; 2];
    for _ in 0..MEASUREMENTS {
        for (level, best) in [narrow, wide].into_iter().zip(&mut best) {
            for (count, best) in [0, BATCH].into_iter().zip(best) {
                *best = (*best).min(time(&mut work, level, count));
            }
        }
    }
    let [narrow, wide] = best.map(|[call, all]| all.saturating_sub(call).as_secs_f64());
    narrow / wide.max(f64::MIN_POSITIVE)
}

#[test]
fn affine_maps_gain_from_wider_vectors() {
    let [narrow, wide, ..] = simd::available()[..] else {
        eprintln!("skipped: this machine has one instruction set only");
        return;
    };
    let many = (0..8).map(|i| call(&shapes::ROTATE, 0, &mut Random::new(i)));
    let structure = Structure::compile(&many.collect::<Vec<_>>()).expect("sound fields");
    let program = structure.program(DVec3::ZERO);
    let mut work = |level, count| {
        let (x, mut values) = ([0.5; BATCH], [0.0; BATCH]);
        let x = &x[..count];
        Evaluator::with_level(&program, level).values(Points { x, y: x, z: x }, &mut values[..count]);
    };
    let enough = (0..TRIES).map(|_| gain(&mut work, narrow, wide)).find(|&gain| gain >= GAIN);
    assert!(enough.is_some(), "affine maps gain less than {GAIN}");
}
