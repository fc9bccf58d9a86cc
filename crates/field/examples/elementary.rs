//! Prints the largest error of each elementary function on lanes, where it is, and how fast the function is.
//!
//! Functions of one number are computed for all 2^32 numbers of single precision, those of two for as many pairs, on every
//! instruction set of the machine. Fails if a stated error is exceeded or if two instruction sets differ.
//!
//! `cargo run --release -p freikugel-field --example elementary -- [--stride N] [FUNCTION...]`

use freikugel_field::elementary::{FUNCTIONS, Function, Reference, ulps};
use freikugel_field::simd;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// All numbers of single precision, or as many pairs of them.
const ALL: u64 = 1 << 32;

/// How many arguments a thread takes at once.
const BATCH: u64 = 1 << 14;

/// The worst of many results.
#[derive(Clone, Copy, Default)]
struct Worst {
    error: f64,
    at: [f32; 2],
    value: f32,
    /// Arguments for which two instruction sets gave different bits.
    differing: u64,
}

/// The arguments number `index`: for one number its bits; for two a mixture of all bits and of moderate numbers, since most
/// pairs of arbitrary bits have powers of 0 or infinity.
fn arguments(reference: Reference, index: u64) -> [f32; 2] {
    if let Reference::Unary(_) = reference {
        // All of them, but neighbours far apart: a lane must not be disturbed by others.
        return [f32::from_bits((index as u32).wrapping_mul(0x9e37_79b1)); 2];
    }
    // SplitMix64 (Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", 2014).
    let mut bits = index.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    let (a, b) = (bits as u32, (bits >> 32) as u32);
    // The exponents of moderate numbers lie from -8 to 7.
    let moderate = |bits: u32| f32::from_bits((bits & 0x87ff_ffff) | 0x3800_0000).copysign(f32::from_bits(bits));
    match index % 4 {
        0 => [f32::from_bits(a), f32::from_bits(b)],
        1 => [f32::from_bits(a), moderate(b)],
        // Near 1, where powers with large exponents are.
        2 => [1.0 + f32::from_bits(a & 0x8fff_ffff | 0x3000_0000) * 1e-3, moderate(b) * 100.0],
        _ => [moderate(a), moderate(b)],
    }
}

fn sweep(function: &Function, stride: u64) -> Worst {
    let next = AtomicU64::new(0);
    let work = || {
        let levels = simd::available();
        let mut worst = Worst::default();
        let (mut a, mut b) = (Vec::new(), Vec::new());
        let mut outs = vec![vec![0.0; BATCH as usize]; levels.len()];
        loop {
            let start = next.fetch_add(BATCH * stride, Ordering::Relaxed);
            if start >= ALL {
                return worst;
            }
            a.clear();
            b.clear();
            for index in (start..ALL.min(start + BATCH * stride)).step_by(stride as usize) {
                let [x, y] = arguments(function.reference, index);
                a.push(x);
                b.push(y);
            }
            for (&level, out) in levels.iter().zip(&mut outs) {
                function.apply(level, &a, &b, &mut out[..a.len()]);
            }
            for (i, &value) in outs[0][..a.len()].iter().enumerate() {
                let same =
                    outs.iter().all(|out| out[i].to_bits() == value.to_bits() || out[i].is_nan() && value.is_nan());
                worst.differing += u64::from(!same);
                let exact = match function.reference {
                    Reference::Unary(f) => f(a[i].into()),
                    Reference::Binary(f) => f(a[i].into(), b[i].into()),
                };
                let error = ulps(value, exact);
                if error > worst.error {
                    worst = Worst { error, at: [a[i], b[i]], value, ..worst };
                }
            }
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        threads.into_iter().map(|thread| thread.join().expect("a thread that does not panic")).fold(
            Worst::default(),
            |a, b| Worst { differing: a.differing + b.differing, ..if a.error < b.error { b } else { a } },
        )
    })
}

/// Millions of evaluations a second on each instruction set, for moderate arguments.
fn speeds(function: &Function) -> String {
    const POINTS: u32 = 2048;
    const REPEATS: u32 = 64;
    const RUNS: u32 = 25;
    let coordinate = |step: f32| (0..POINTS).map(|i| (i as f32 * step) % 1.0).collect::<Vec<f32>>();
    let (a, b, mut out) = (coordinate(0.37), coordinate(0.91), vec![0.0; POINTS as usize]);
    let mut text = String::new();
    for level in simd::available() {
        let mut best = f64::INFINITY;
        for _ in 0..RUNS {
            let start = Instant::now();
            (0..REPEATS).for_each(|_| function.apply(level, &a, &b, std::hint::black_box(&mut out)));
            best = best.min(start.elapsed().as_secs_f64());
        }
        text += &format!(" {} {:5.0}", simd::name(level), f64::from(POINTS * REPEATS) / best / 1e6);
    }
    text
}

fn main() -> ExitCode {
    let mut stride = 1;
    let mut wanted = Vec::new();
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match (arg.as_str(), FUNCTIONS.iter().find(|f| f.name == arg)) {
            ("--stride", _) => match args.next().and_then(|n| n.parse().ok()).filter(|&n| n > 0) {
                Some(n) => stride = n,
                None => {
                    eprintln!("--stride needs a positive number");
                    return ExitCode::FAILURE;
                }
            },
            (_, Some(function)) => wanted.push(function),
            _ => {
                eprintln!("usage: elementary [--stride N] [FUNCTION...]");
                return ExitCode::FAILURE;
            }
        }
    }
    if wanted.is_empty() {
        wanted.extend(FUNCTIONS);
    }
    let mut sound = true;
    for function in wanted {
        let worst = sweep(function, stride);
        let of_this = worst.error <= function.max_error && worst.differing == 0;
        sound &= of_this;
        let [x, y] = worst.at;
        let at =
            if matches!(function.reference, Reference::Unary(_)) { format!("{x:e}") } else { format!("{x:e}, {y:e}") };
        println!(
            "{:6} {:.4} ulps (stated {}) at {at} = {:e}; {} differing{}; M/s:{}",
            function.name,
            worst.error,
            function.max_error,
            worst.value,
            worst.differing,
            if of_this { "" } else { " FAILED" },
            speeds(function)
        );
    }
    if sound { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
