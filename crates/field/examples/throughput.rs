//! Prints how many points a second the batch evaluator handles, for a CSG scene of 10 primitives and 9 operators
//! ("csg20"), for 256 primitives ("many256") and for two fractals with 10 iterations, on each instruction set of this machine.
//!
//! `cargo run --release -p freikugel-field --example throughput`

use freikugel_field::{Evaluator, Field, Points, Program, Structure, shapes::*, simd};
use std::time::Instant;

fn csg20() -> Field {
    let body = cuboid([1.0, 1.0, 0.6]).round(0.05) - cylinder(0.25, 1.2);
    let body = smooth_union(0.1, [body, torus(0.35, 0.08).at([0.0, 0.0, 0.3])]);
    let body = smooth_union(0.08, [body, sphere(0.2).at([0.55, 0.0, 0.2])]);
    let body = smooth_union(0.08, [body, sphere(0.2).at([-0.55, 0.0, 0.2])]);
    let body = body - cuboid([0.16, 0.4, 1.0]).at([0.0, 0.5, 0.1]).rotate([0.0, 0.0, 1.0], 40.0);
    let body = body | cylinder(0.1, 1.0);
    let body = smooth_union(0.05, [body, sphere(0.14).at([0.0, 0.0, 0.55])]);
    body | cuboid([1.4, 1.4, 0.14]).round(0.02).at([0.0, 0.0, -0.45])
        | torus(0.6, 0.05).at([0.0, 0.0, -0.35]).rotate([0.0, 0.0, 1.0], 40.0)
}

fn many(count: usize) -> Field {
    let mut seed = 0x1234_5678_u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 8) / f64::from(1 << 24)
    };
    let mut all: Option<Field> = None;
    for i in 0..count {
        let at = [(); 3].map(|()| random() * 1.6 - 0.8);
        let q = 0.04 + 0.06 * random();
        let next = match i % 4 {
            0 => sphere(q).at(at),
            1 => cuboid([2.0 * q, 2.0 * q, 1.2 * q]).round(0.01).at(at),
            2 => torus(q, 0.3 * q).at(at),
            _ => cylinder(0.6 * q, 2.0 * q).at(at),
        };
        all = Some(match all {
            None => next,
            Some(all) if i % 8 == 0 => smooth_union(0.03, [all, next]),
            Some(all) => all | next,
        });
    }
    all.expect("at least one")
}

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
    }
}
