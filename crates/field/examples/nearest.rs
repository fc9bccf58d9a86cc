//! Prints how many shapes a point query of a union looks at, and what it takes, for 10 to 100,000 shapes at equal density:
//! through the hierarchy, for points in random order and along a path, and by evaluating all shapes.
//!
//! `cargo run --release -p freikugel-field --example nearest`

use freikugel_field::{Field, Nearest, Structure, shapes::*};
use glam::DVec3;
use std::time::Instant;

/// Points that are asked for; all shapes are evaluated at fewer of them, as long as this many evaluations last.
const POINTS: usize = 2000;
const EVALUATIONS: usize = 4_000_000;

/// Numbers between 0 and 1.
struct Random(u32);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0 >> 8) / f64::from(1 << 24)
    }

    fn point(&mut self, reach: f64) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit()) * (2.0 * reach) - reach
    }
}

fn main() {
    println!(
        "{:>8} {:>10} {:>14} {:>12} {:>14} {:>14}",
        "shapes", "build", "looked at", "query", "along a path", "all of them"
    );
    for count in [10, 100, 1000, 10_000, 100_000] {
        let mut random = Random(1);
        let reach = (count as f64).cbrt();
        let fields: Vec<Field> = (0..count)
            .map(|i| {
                let at = random.point(reach).to_array();
                match i % 3 {
                    0 => sphere(0.3).at(at),
                    1 => cuboid([0.5, 0.4, 0.3]).rotate([1.0, 1.0, 0.0], 40.0).at(at),
                    _ => torus(0.3, 0.1).at(at),
                }
            })
            .collect();
        let points: Vec<DVec3> = (0..POINTS).map(|_| random.point(reach)).collect();
        let start = Instant::now();
        let nearest = Nearest::new(&fields).expect("sound fields");
        let build = start.elapsed().as_secs_f64();

        let mut values = vec![0.0; POINTS];
        let start = Instant::now();
        nearest.values(&points, &mut values);
        let query = start.elapsed().as_secs_f64() / POINTS as f64;
        let looked_at: usize = points.iter().map(|&p| nearest.find(p).expect("there are shapes").evaluations).sum();

        let step = (points[1] - points[0]) / POINTS as f64;
        let path: Vec<DVec3> = (0..POINTS).map(|i| points[0] + step * i as f64).collect();
        let mut along = vec![0.0; POINTS];
        let start = Instant::now();
        nearest.values(&path, &mut along);
        let path = start.elapsed().as_secs_f64() / POINTS as f64;

        let program = Structure::compile(&fields).expect("sound fields").program(DVec3::ZERO);
        let some = (EVALUATIONS / count).clamp(1, POINTS);
        let start = Instant::now();
        let whole: Vec<f64> = points[..some].iter().map(|&p| program.value(p)).collect();
        let all = start.elapsed().as_secs_f64() / some as f64;
        assert_eq!(whole, values[..some], "the same numbers");
        println!(
            "{count:>8} {:>7.1} ms {:>14.1} {:>9.2} us {:>11.2} us {:>11.2} us",
            build * 1e3,
            looked_at as f64 / POINTS as f64,
            query * 1e6,
            path * 1e6,
            all * 1e6
        );
    }
}
