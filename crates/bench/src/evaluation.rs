//! Values and gradients at many points, on one thread.

use crate::fields;
use crate::measure::{Clock, Contender, Row, Unit};
use crate::peer::{BACKENDS, Peer, with_derivatives};
use freikugel::field::{Evaluator, Field, Points, Program, Structure, simd};
use glam::DVec3;
use std::hint::black_box;

/// As many points as a renderer has on their way at once: they stay in the second-level cache.
pub const POINTS: usize = 2048;

/// How often the fractals iterate.
const ITERATIONS: usize = 10;

/// How many primitives the larger field has.
const MANY: usize = 256;

/// Points all over the cube from -1 to 1.
pub fn points(count: usize) -> [Vec<f32>; 3] {
    let along = |step: f32| (0..count).map(|i| (i as f32 * step).sin()).collect();
    [along(0.37), along(0.91), along(1.73)]
}

/// The program of a field.
pub fn program(field: Field) -> Program {
    Structure::compile(&[field]).expect("a sound field").program(DVec3::ZERO)
}

/// All rows whose names `is_wanted`.
pub fn rows(is_wanted: &dyn Fn(&str) -> bool) -> Vec<Row<'static>> {
    let formula = format!("{ITERATIONS} iterations (formula, written out)");
    type Subject = (String, fn() -> Field, bool);
    let fields: [Subject; 5] = [
        ("csg20: 10 primitives, 9 operators".into(), fields::csg20, true),
        (format!("many256: {MANY} primitives"), || fields::many(MANY), true),
        ("gyroid in a sphere (formula)".into(), fields::gyroid, false),
        (format!("quaternion Julia set, {formula}"), || fields::julia(ITERATIONS), false),
        (format!("Mandelbulb, {formula}"), || fields::mandelbulb(ITERATIONS), false),
    ];
    let mut rows = Vec::new();
    for (name, field, has_gradients) in fields {
        let names = [format!("{name}: values"), format!("{name}: gradients")];
        for (name, is_gradient) in names.into_iter().zip([false, true]) {
            if is_wanted(&name) && (has_gradients || !is_gradient) {
                let contenders = contenders(&program(field()), is_gradient);
                rows.push(Row { name, unit: Unit::Points(POINTS), contenders });
            }
        }
    }
    rows
}

fn contenders(program: &Program, is_gradient: bool) -> Vec<Contender<'static>> {
    // They live as long as the process, as the points do that evaluators borrow.
    let program: &'static Program = Box::leak(Box::new(program.clone()));
    let [x, y, z]: &'static [Vec<f32>; 3] = Box::leak(Box::new(points(POINTS)));
    let mut contenders: Vec<Contender<'_>> = simd::available()
        .into_iter()
        .rev()
        .map(|level| {
            let mut evaluator = Evaluator::with_level(program, level);
            let mut values = vec![0.0; POINTS];
            let mut gradient = [vec![0.0; POINTS], vec![0.0; POINTS], vec![0.0; POINTS]];
            let name = format!("Freikugel {}", simd::name(level));
            Contender::new(name, Clock::Thread, move || {
                let points = Points { x, y, z };
                if is_gradient {
                    let [gx, gy, gz] = &mut gradient;
                    evaluator.gradients(points, &mut values, [gx, gy, gz]);
                } else {
                    evaluator.values(points, &mut values);
                }
                black_box(&values);
            })
        })
        .collect();
    let peer = match Peer::translate(program) {
        Ok(peer) => peer,
        Err(reason) => {
            contenders.extend(BACKENDS.map(|(_, name)| Contender::missing(name, reason.clone())));
            return contenders;
        }
    };
    for (backend, name) in BACKENDS {
        let points = [&x[..], &y[..], &z[..]];
        let mut work = if is_gradient {
            peer.gradients(backend, Box::leak(Box::new(with_derivatives(points))))
        } else {
            peer.values(backend, points)
        };
        contenders.push(Contender::new(name, Clock::Thread, move || {
            black_box(work());
        }));
    }
    contenders
}
