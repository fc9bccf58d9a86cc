//! Every formula in every number type, against the same formula in `f64`.

mod common;

use common::{Random, every_shape, tree};
use freikugel_field::expr::Graph;
use freikugel_field::shapes::*;
use freikugel_field::{Evaluator, Field, Interval, Points, Program, Shares, Structure, simd};
use glam::DVec3;

/// Random calls of each shape.
const CALLS: u64 = 6;

/// Single precision has a relative error of 6e-8; formulas lose some more by cancellation at points of size 2. The
/// iterated foot point of a flat ellipsoid is the worst.
const SINGLE: f64 = 4e-6;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

/// Points of single precision, so that both precisions mean the same ones.
fn points(random: &mut Random, count: usize) -> Vec<DVec3> {
    let single = |v: f64| f64::from(v as f32);
    (0..count).map(|_| random.point(2.0).map(single)).collect()
}

fn columns(points: &[DVec3]) -> [Vec<f32>; 3] {
    [0, 1, 2].map(|axis| points.iter().map(|p| p[axis] as f32).collect())
}

#[test]
fn lanes_agree_with_f64_and_bit_for_bit_with_each_other() {
    for (name, seed, field) in every_shape(CALLS) {
        let program = program(&field);
        // Not a multiple of any batch or vector.
        let points = points(&mut Random::new(seed), 777);
        let [x, y, z] = columns(&points);
        let mut first: Option<Vec<u32>> = None;
        for level in simd::available() {
            let mut values = vec![0.0; points.len()];
            Evaluator::with_level(&program, level).values(Points { x: &x, y: &y, z: &z }, &mut values);
            for (p, &value) in points.iter().zip(&values) {
                let exact = program.value(*p);
                let error = (f64::from(value) - exact).abs();
                assert!(error < SINGLE * (1.0 + exact.abs()), "{name} {seed} {level:?} at {p}: {value}, not {exact}");
            }
            let bits: Vec<u32> = values.iter().map(|v| v.to_bits()).collect();
            assert_eq!(first.get_or_insert_with(|| bits.clone()), &bits, "{name} {seed} {level:?}");
        }
    }
}

#[test]
fn batches_of_any_size_give_the_same_bits() {
    let field = tree(3, &mut Random::new(5));
    let program = program(&field);
    let points = points(&mut Random::new(6), 700);
    let [x, y, z] = columns(&points);
    let mut whole = vec![0.0; points.len()];
    Evaluator::new(&program).values(Points { x: &x, y: &y, z: &z }, &mut whole);
    for size in [1, 3, 16, 17, 255, 256, 257] {
        let mut evaluator = Evaluator::new(&program);
        for start in (0..points.len()).step_by(size) {
            let range = start..(start + size).min(points.len());
            let mut part = vec![0.0; range.len()];
            let these = Points { x: &x[range.clone()], y: &y[range.clone()], z: &z[range.clone()] };
            evaluator.values(these, &mut part);
            assert_eq!(part, whole[range], "batches of {size}");
        }
    }
}

#[test]
fn gradients_agree_with_differences() {
    const STEP: f64 = 1e-5;
    for (name, seed, field) in every_shape(CALLS) {
        let program = program(&field);
        let points = points(&mut Random::new(seed + 100), 300);
        let [x, y, z] = columns(&points);
        let mut values = vec![0.0; points.len()];
        let mut gradient = [(); 3].map(|()| vec![0.0; points.len()]);
        let [gx, gy, gz] = &mut gradient;
        Evaluator::new(&program).gradients(Points { x: &x, y: &y, z: &z }, &mut values, [gx, gy, gz]);
        let mut smooth = 0;
        for (i, &p) in points.iter().enumerate() {
            let (value, exact) = program.gradient(p);
            assert_eq!(value, program.value(p), "{name} {seed} at {p}");
            assert!(exact.is_finite(), "{name} {seed} at {p}: {exact}");
            let at = |axis: usize, step: f64| program.value(p + DVec3::AXES[axis] * step);
            let differences = DVec3::from_array([0, 1, 2].map(|a| (at(a, STEP) - at(a, -STEP)) / (2.0 * STEP)));
            let bends = (0..3).any(|a| (at(a, STEP) + at(a, -STEP) - 2.0 * value).abs() > 0.5e-4 * STEP);
            if bends {
                continue;
            }
            smooth += 1;
            assert!(exact.distance(differences) < 1e-4, "{name} {seed} at {p}: {exact}, not {differences}");
            let single = DVec3::new(gradient[0][i].into(), gradient[1][i].into(), gradient[2][i].into());
            assert!(single.distance(exact) < 3e-3, "{name} {seed} at {p}: {single}, not {exact}");
        }
        assert!(smooth > 200, "{name} {seed}: only {smooth} points away from edges");
    }
}

/// Where a value is 0, which of the two sides of a surface counts must not be neither.
#[test]
fn bodies_with_faces_have_slopes_on_them() {
    let square = || rectangle(2.0, 2.0);
    let bodies: [Field; 6] = [
        cuboid([2.0, 2.0, 2.0]).into(),
        cuboid([2.0, 2.0, 2.0]).round(0.25).into(),
        box_frame([2.0, 2.0, 2.0], 0.5).into(),
        cylinder(1.0, 2.0).into(),
        square().extrude(2.0),
        square().sweep([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]),
    ];
    for body in bodies {
        let program = program(&body);
        let (x, y, z) = ([1.0, -1.0, 0.0, 0.0, 0.75], [0.0, 0.0, 1.0, 0.0, 0.0], [0.875, 0.75, -0.875, 1.0, -1.0]);
        let mut value = [1.0; 5];
        let mut gradient = [[0.0; 5]; 3];
        let [dx, dy, dz] = &mut gradient;
        Evaluator::new(&program).gradients(Points { x: &x, y: &y, z: &z }, &mut value, [dx, dy, dz]);
        for place in 0..5 {
            let slope = gradient.iter().map(|along| along[place] * along[place]).sum::<f32>();
            // Not all of these places lie on all of the bodies.
            assert!(value[place] != 0.0 || (slope - 1.0).abs() < 1e-6, "{body:?} at place {place}: {slope}");
        }
        assert!(value.iter().filter(|&&value| value == 0.0).count() > 2, "{body:?}: {value:?}");
    }
}

#[test]
fn hessians_agree_with_differences_of_gradients() {
    const STEP: f64 = 1e-5;
    for (name, seed, field) in every_shape(2) {
        let program = program(&field);
        for p in points(&mut Random::new(seed + 200), 100) {
            let (value, gradient, hessian) = program.hessian(p);
            assert_eq!((value, gradient), program.gradient(p), "{name} {seed} at {p}");
            for axis in 0..3 {
                let at = |step: f64| program.gradient(p + DVec3::AXES[axis] * step).1;
                let (before, after) = (at(-STEP), at(STEP));
                if (before + after - 2.0 * gradient).length() > 1e4 * STEP * STEP {
                    continue;
                }
                let differences = (after - before) / (2.0 * STEP);
                let column = hessian.col(axis);
                assert!(
                    column.distance(differences) < 1e-3 * (1.0 + column.length()),
                    "{name} {seed} at {p}, axis {axis}: {column}, not {differences}"
                );
            }
        }
    }
}

#[test]
fn hessians_in_batches_agree_with_f64_and_bit_for_bit_with_each_other() {
    /// A second derivative loses as many digits again as a first one, and more where a curvature is large.
    const TOLERANCE: f64 = 2e-3;
    /// Beside a crease, single precision may stand on its other side.
    const MOST_OFF: usize = 3;
    let formulas = ["x^3*y - exp(z/2)*x", "sin(2x)*cos(y) + atan2(y, x + 4)", "hypot(x - 3, y, z) - 1"];
    let formulas = formulas.iter().map(|text| (*text, 0, formula(text).into()));
    for (name, seed, field) in every_shape(2).chain(formulas) {
        let program = program(&field);
        let points = points(&mut Random::new(seed + 250), 300);
        let [x, y, z] = columns(&points);
        let given = Points { x: &x, y: &y, z: &z };
        let mut first: Option<Vec<u32>> = None;
        for level in simd::available() {
            let mut evaluator = Evaluator::with_level(&program, level);
            let mut all = vec![vec![0.0; points.len()]; 10];
            let [value, gx, gy, gz, xx, yy, zz, xy, xz, yz] = &mut all[..] else { unreachable!("ten") };
            evaluator.hessians(given, value, [gx, gy, gz], [xx, yy, zz, xy, xz, yz]);
            let bits: Vec<u32> = all.iter().flatten().map(|number| number.to_bits()).collect();
            assert_eq!(first.get_or_insert_with(|| bits.clone()), &bits, "{name} {seed} {level:?}");
            let mut plain = vec![0.0; points.len()];
            evaluator.values(given, &mut plain);
            assert_eq!(plain, all[0], "{name} {seed}: the values are those without derivatives");
            let mut off = 0;
            for (i, &p) in points.iter().enumerate() {
                let [.., xx, yy, zz, xy, xz, yz] = &all[..] else { unreachable!("ten") };
                let own = [xx[i], xy[i], xz[i], xy[i], yy[i], yz[i], xz[i], yz[i], zz[i]].map(f64::from);
                let (_, gradient, hessian) = program.hessian(p);
                let hessian = hessian.to_cols_array();
                let largest = hessian.into_iter().fold(1.0, |m: f64, h| m.max(h.abs()));
                let near = hessian.into_iter().zip(own).all(|(a, b)| (a - b).abs() < TOLERANCE * largest);
                let slopes = (0..3).all(|axis| (f64::from(all[1 + axis][i]) - gradient[axis]).abs() < 3e-3);
                off += usize::from(!(near && slopes));
            }
            let shown = common::notation(&field);
            assert!(off <= MOST_OFF, "{name} {seed} {level:?}: {off} of {} points of {shown}", points.len());
        }
    }
}

#[test]
fn intervals_contain_and_are_narrow() {
    // Outward rounding adds two units in the last place with each operation; the largest programs here have a few
    // hundred operations on numbers of size 10, and the iterated foot point multiplies what it starts with.
    const POINT_WIDTH: f64 = 1e-9;
    // Each step of an orbit multiplies widths, inside the set and close to it far more than the values. How much of the space
    // here that is depends on the set and on what was done to it; it is a few per cent of all points, and none of them is
    // as far from the surface as this.
    const NEAR_ORBITS: f64 = 1.0;
    const WIDE_SHARE: f64 = 0.15;
    const CELL: f64 = 0.1;
    const LEVEL_SHARE: f64 = 0.04;
    // Ridges of other shapes, too, are level to both sides.
    const RIDGE_SHARE: f64 = 1e-4;
    let (mut orbits, mut wide, mut blends, mut level, mut cells, mut ridges) = (0, 0, 0, 0, 0, 0);
    for (name, seed, field) in every_shape(CALLS) {
        let program = program(&field);
        let is_orbit = common::notation(&field).contains("julia") || common::notation(&field).contains("bulb");
        let mut random = Random::new(seed + 300);
        for _ in 0..60 {
            let corner = random.point(2.0);
            let (at, value) = (program.interval(corner.to_array().map(Interval::point)), program.value(corner));
            assert!(at.contains(value), "{name} {seed} at {corner}");
            orbits += usize::from(is_orbit);
            if is_orbit && at.width() >= POINT_WIDTH && value.abs() < NEAR_ORBITS {
                wide += 1;
            } else {
                assert!(at.width() < POINT_WIDTH, "{name} {seed} at {corner}: width {}", at.width());
            }

            let cell = program.interval(corner.to_array().map(|c| Interval::new(c, c + CELL)));
            let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
            for i in 0..216 {
                let place = DVec3::new(f64::from(i % 6), f64::from(i / 6 % 6), f64::from(i / 36)) / 5.0;
                let value = program.value(corner + place * CELL);
                assert!(cell.contains(value), "{name} {seed} at {corner}: {value} not in {cell:?}");
                (lowest, highest) = (lowest.min(value), highest.max(value));
            }
            // Around a ridge or in a seam the values hardly vary, while the slope's form still spans the cell's diagonal.
            let slack = 0.5 * CELL;
            let is_narrow = cell.width() <= 4.0 * (highest - lowest) + slack;
            // A blend of faces that look the same way, or of those that face each other, is nearly level all over, which ranges of
            // its operands can't know. Such places are rare, and enclosures there span no more than the slope does.
            let is_blend = common::is_blend(name) || common::is_carved(name);
            let may_be_level = cell.width() <= CELL * 3f64.sqrt() * (1.0 + 1e-9);
            if is_blend {
                blends += 1;
                level += usize::from(may_be_level && !is_narrow);
            } else if !is_orbit {
                cells += 1;
                ridges += usize::from(may_be_level && !is_narrow);
            }
            assert!(
                is_orbit || may_be_level || is_narrow,
                "{name} {seed} at {corner}: {} for {} of {}",
                cell.width(),
                highest - lowest,
                common::notation(&field)
            );
        }
    }
    println!("{ridges} of {cells} cells are level");
    assert!(ridges as f64 <= RIDGE_SHARE * cells as f64, "{ridges} of {cells} cells are level");
    println!("{level} of {blends} cells of blends are level");
    assert!(level as f64 <= LEVEL_SHARE * blends as f64, "{level} of {blends} cells of blends are level");
    println!("{wide} of {orbits} points of fractals have wide intervals");
    assert!(wide as f64 <= WIDE_SHARE * orbits as f64, "{wide} of {orbits} points of fractals have wide intervals");
}

#[test]
fn expressions_compute_the_same() {
    for (name, seed, field) in every_shape(2) {
        let program = program(&field);
        let graph = Graph::new();
        let result = program.expression(&graph);
        for p in points(&mut Random::new(seed + 400), 50) {
            let value = graph.evaluate(result, p.to_array(), program.constants());
            let exact = program.value(p);
            assert!((value - exact).abs() < 1e-12 * (1.0 + exact.abs()), "{name} {seed} at {p}: {value}, not {exact}");
        }
    }
}

#[test]
fn programs_agree_with_set_logic_on_random_trees() {
    for seed in 0..300 {
        let field = tree(4, &mut Random::new(seed));
        let program = program(&field);
        for p in points(&mut Random::new(seed + 500), 40) {
            let value = program.value(p);
            if let Some(inside) = common::inside::contains(&field, p)
                && value.abs() > 1e-5
            {
                assert_eq!(inside, value < 0.0, "seed {seed} at {p}: {value} in {}", common::notation(&field));
            }
        }
    }
}

#[test]
fn an_origin_far_away_changes_nothing_but_precision() {
    let at = DVec3::new(5e4, -3e4, 2e4);
    for seed in 0..50 {
        let field = tree(3, &mut Random::new(seed));
        let moved = Field::new(&TRANSLATE, at.to_array().map(Into::into), [field.clone()]);
        let (here, there) = (program(&field), Structure::compile(&[moved]).expect("sound").program(at));
        let points = points(&mut Random::new(seed + 600), 64);
        let [x, y, z] = columns(&points);
        let mut values = [vec![0.0; 64], vec![0.0; 64]];
        for (program, values) in [here, there].iter().zip(&mut values) {
            Evaluator::new(program).values(Points { x: &x, y: &y, z: &z }, values);
        }
        for (a, b) in values[0].iter().zip(&values[1]) {
            assert!((a - b).abs() < 2e-5 * (1.0 + a.abs()), "seed {seed}: {a} and {b}");
        }
    }
}

#[test]
fn shares_are_the_partial_derivatives() {
    for seed in 0..80 {
        let objects: Vec<Field> = (0..2).map(|i| tree(3, &mut Random::new(seed * 7 + i))).collect();
        let structure = Structure::compile(&objects).expect("sound fields");
        let program = structure.program(DVec3::ZERO);
        let points = points(&mut Random::new(seed + 700), 300);
        let [x, y, z] = columns(&points);
        let mut shares = Shares::default();
        Evaluator::new(&program).shares(Points { x: &x, y: &y, z: &z }, &mut shares);
        let alone: Vec<Program> = objects.iter().map(program_of).collect();
        for (i, &p) in points.iter().enumerate() {
            let total: f32 = (0..structure.regions().len()).map(|region| shares.of(region, i)).sum();
            assert!((total - 1.0).abs() < 1e-5, "seed {seed} at {p}: {total}");
            let of_first: f32 = structure
                .regions()
                .iter()
                .enumerate()
                .filter(|(_, region)| region.object == 0)
                .map(|(index, _)| shares.of(index, i))
                .sum();
            let (a, b) = (alone[0].value(p), alone[1].value(p));
            if (a - b).abs() > 1e-4 {
                let expected = if a < b { 1.0 } else { 0.0 };
                assert!((of_first - expected).abs() < 1e-5, "seed {seed} at {p}: {of_first}, {a} against {b}");
            }
        }
    }
}

fn program_of(field: &Field) -> Program {
    program(field)
}

#[test]
fn blends_share_by_their_derivatives() {
    use freikugel_field::shapes::*;
    const STEP: f64 = 1e-6;
    type Blend = fn(f64, [Field; 2]) -> Field;
    let blends: [(&str, Blend); 3] = [
        ("union", |k, shapes| smooth_union(k, shapes)),
        ("intersection", |k, shapes| smooth_intersection(k, shapes)),
        ("difference", |k, shapes| smooth_difference(k, shapes)),
    ];
    for order in [0.0, 1.0] {
        for (name, blend) in blends {
            let field = |grow: f64| {
                let b = sphere(0.8 + grow).at([0.7, 0.2, 0.0]);
                blend(0.5, [cuboid([1.5, 1.0, 1.2]).into(), b]).with("order", &[order.into()])
            };
            let (less, more) = (program(&field(-STEP)), program(&field(STEP)));
            let structure = Structure::compile(&[Field::new(
                &UNION,
                [],
                [blend(
                    0.5,
                    [
                        cuboid([1.5, 1.0, 1.2]).into(),
                        sphere(0.8).at([0.7, 0.2, 0.0]).painted(freikugel_field::MaterialId(1)),
                    ],
                )
                .with("order", &[order.into()])],
            )])
            .expect("sound");
            let program = structure.program(DVec3::ZERO);
            let points = points(&mut Random::new(9), 400);
            let [x, y, z] = columns(&points);
            let mut shares = Shares::default();
            Evaluator::new(&program).shares(Points { x: &x, y: &y, z: &z }, &mut shares);
            let painted = structure.regions().iter().position(|r| r.material.is_some()).expect("a painted region");
            for (i, &p) in points.iter().enumerate() {
                // Growing the ball lowers its distance at the same rate everywhere.
                let slope = (more.value(p) - less.value(p)) / (2.0 * STEP);
                let share = f64::from(shares.of(painted, i));
                assert!((slope.abs() - share).abs() < 1e-3, "{name} {order} at {p}: {share}, not {}", slope.abs());
            }
        }
    }
}
