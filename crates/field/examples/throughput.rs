//! Prints how many points a second the batch evaluator handles, for a CSG scene of 10 primitives and 9 operators
//! ("csg20"), for 256 primitives ("many256") and for two fractals with 10 iterations, on each instruction set of this machine.
//!
//! `cargo run --release -p freikugel-field --example throughput`

mod fields;

use fields::{csg20, many};
use freikugel_field::shapes::{mandelbulb, quaternion_julia};
use freikugel_field::{Evaluator, Points, Program, Structure, simd};
use std::time::Instant;

fn measure(name: &str, program: &Program, work: &mut dyn FnMut(&mut Evaluator<'_>), points: usize) {
    for level in simd::available() {
        let mut evaluator = Evaluator::with_level(program, level);
        let mut best = f64::INFINITY;
        for _ in 0..RUNS {
            let start = Instant::now();
            (0..REPEATS).for_each(|_| work(&mut evaluator));
            best = best.min(start.elapsed().as_secs_f64() / REPEATS as f64);
        }
        println!("{name:20} {:7} {:8.1} M points/s", simd::name(level), points as f64 / best / 1e6);
    }
}

/// As many points as a renderer has on their way at once: they stay in the second-level cache.
const POINTS: usize = 2048;

/// Evaluations in one run, and runs of which the best one counts.
const REPEATS: usize = 64;
const RUNS: usize = 25;

fn main() {
    let coordinate = |k: f32| (0..POINTS).map(|i| (i as f32 * k).sin()).collect::<Vec<f32>>();
    let (x, y, z) = (coordinate(0.37), coordinate(0.91), coordinate(1.73));
    let points = Points { x: &x, y: &y, z: &z };
    let mut values = vec![0.0; POINTS];
    let mut gradient = [vec![0.0; POINTS], vec![0.0; POINTS], vec![0.0; POINTS]];
    let mut hessian = [(); 6].map(|()| vec![0.0; POINTS]);
    let julia = quaternion_julia([-0.2, 0.6, 0.2, 0.2]).with("iterations", &[10.into()]).into();
    let bulb = mandelbulb(8).with("iterations", &[10.into()]).into();
    for (name, field) in [("csg20", csg20()), ("many256", many(256)), ("julia", julia), ("mandelbulb", bulb)] {
        let structure = Structure::compile(&[field]).expect("sound fields");
        let program = structure.program(glam::DVec3::ZERO);
        println!("{name}: {} operations", structure.operations());
        measure(name, &program, &mut |evaluator| evaluator.values(points, &mut values), POINTS);
        let [gx, gy, gz] = &mut gradient;
        let mut gradients = |evaluator: &mut Evaluator<'_>| {
            evaluator.gradients(points, &mut values, [gx, gy, gz]);
        };
        measure(&format!("{name} gradients"), &program, &mut gradients, POINTS);
        let [xx, yy, zz, xy, xz, yz] = &mut hessian;
        let [gx, gy, gz] = &mut gradient;
        let mut hessians = |evaluator: &mut Evaluator<'_>| {
            evaluator.hessians(points, &mut values, [gx, gy, gz], [xx, yy, zz, xy, xz, yz]);
        };
        measure(&format!("{name} Hessians"), &program, &mut hessians, POINTS);
    }
}
