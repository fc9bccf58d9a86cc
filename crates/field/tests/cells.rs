//! Cells: what is left of a program in a box computes the same there, bit for bit, and the signs are right. Of what has no
//! scale, only the sign is kept where it is negative.

mod common;

use common::Random;
use freikugel_field::shapes::*;
use freikugel_field::simd;
use freikugel_field::{Aabb, Cell, Cells, Evaluator, Field, Occupancy, Points, Program, Shares, Splitter, Structure};
use glam::DVec3;

const REGION: Aabb = Aabb { min: DVec3::splat(-2.5), max: DVec3::splat(2.5) };

/// Points in a box.
fn points_in(cell: &Cell, random: &mut Random, count: usize) -> [Vec<f32>; 3] {
    let mut axis = |axis: usize| {
        let (middle, half) = (cell.middle()[axis], cell.half()[axis]);
        (0..count).map(|_| middle + half * random.range(-1.0, 1.0) as f32).collect()
    };
    [axis(0), axis(1), axis(2)]
}

/// Checks a box and some boxes within.
fn check(program: &Program, cells: &Cells, cell: &Cell, random: &mut Random, levels: usize) {
    const POINTS: usize = 24;
    let [x, y, z] = points_in(cell, random, POINTS);
    let points = Points { x: &x, y: &y, z: &z };
    let mut evaluator = Evaluator::new(program);
    let (mut all, mut own) = ([0.0; POINTS], [0.0; POINTS]);
    evaluator.values(points, &mut all);
    evaluator.values_in(cell.part(), points, &mut own);
    let is_measured = program.whole().is_measured();
    let matters = all.map(|value| is_measured || value >= 0.0);
    for (point, (value, own)) in all.into_iter().zip(own).enumerate() {
        assert!(value == own || (!matters[point] && own < 0.0), "{value} became {own}");
    }
    for value in all {
        match cell.occupancy() {
            Occupancy::Outside(least) => assert!(value >= least && least > 0.0, "{value} below {least}"),
            Occupancy::Inside => assert!(value < 0.0, "{value} is not inside"),
            Occupancy::Surface => {}
        }
    }
    let (mut gradient, mut own_gradient) = ([[0.0; POINTS]; 3], [[0.0; POINTS]; 3]);
    let [gx, gy, gz] = &mut gradient;
    evaluator.gradients(points, &mut all, [gx, gy, gz]);
    let [gx, gy, gz] = &mut own_gradient;
    evaluator.gradients_in(cell.part(), points, &mut own, [gx, gy, gz]);
    for point in (0..POINTS).filter(|&point| matters[point]) {
        assert_eq!(all[point], own[point]);
        assert_eq!(gradient.map(|g| g[point]), own_gradient.map(|g| g[point]));
    }
    let (mut shares, mut own_shares) = (Shares::default(), Shares::default());
    evaluator.shares(points, &mut shares);
    evaluator.shares_in(cell.part(), points, &mut own_shares);
    for (region, shares) in shares.iter() {
        for (point, &share) in shares.iter().enumerate().filter(|&(point, _)| matters[point]) {
            assert_eq!(share, own_shares.of(region, point), "region {region}");
        }
    }
    if levels > 0 {
        let mut splitter = Splitter::new(simd::best());
        let children = cells.children(cell, &mut splitter);
        for _ in 0..4 {
            check(program, cells, &children[random.below(children.len())], random, levels - 1);
        }
    }
}

fn check_field(fields: &[Field], random: &mut Random) {
    let program = Structure::compile(fields).expect("a sound field").program(DVec3::new(0.3, -0.2, 0.1));
    let cells = Cells::new(&program, REGION);
    check(&program, &cells, cells.root(), random, 4);
}

#[test]
fn what_is_left_computes_the_same() {
    let mut random = Random::new(11);
    for _ in 0..60 {
        let field = common::tree(5, &mut random);
        check_field(&[field], &mut random);
    }
}

#[test]
fn long_unions_compute_the_same() {
    let mut random = Random::new(29);
    for _ in 0..6 {
        // Operands of one step and of many, so that a chain of minima has gaps of all lengths.
        let mut objects: Vec<Field> = Vec::new();
        for index in 0..50 {
            let depth = 1 + index % 3;
            objects.push(common::tree(depth, &mut random).at(random.point(2.0).to_array()));
        }
        check_field(&objects, &mut random);
        let nested: Vec<Field> = objects.chunks(5).map(|five| union(five.to_vec())).collect();
        check_field(&nested, &mut random);
        check_field(&[union(objects.clone()).rotate([1.0, 2.0, 3.0], 30.0)], &mut random);
        check_field(&[union(objects) - sphere(1.0)], &mut random);
    }
}

#[test]
fn every_shape_survives_pruning() {
    let mut random = Random::new(5);
    for (_, _, field) in common::every_shape(3) {
        let beside = sphere(0.5).at([1.2, 0.4, 0.0]);
        check_field(&[field.clone(), beside.clone()], &mut random);
        let blend = smooth_union(0.3, [field, beside]);
        // A sheet can't be blended with.
        if Structure::compile(std::slice::from_ref(&blend)).is_ok() {
            check_field(&[blend], &mut random);
        }
    }
}

#[test]
fn formulas_survive_pruning() {
    let mut random = Random::new(21);
    for text in [
        "x^2 + 2y^2 + z^2 - 0.6",
        "x^4 + y^4 + z^4 - (x^2 + y^2 + z^2) / 2 + x*y / 5 - 0.1",
        "sin(3x) * cos(3y) + sin(3y) * cos(3z) + sin(3z) * cos(3x)",
        "max(abs(x) - 0.5, min(y, exp(z) - 1.2), abs(abs(z - 0.3) - 1) - 0.7)",
        "floor(2x) / 2 + ln(4 + y) - sqrt(abs(z)) + atan2(y, x + 4) - (x < y) / 9",
        "1 / (4 + x) - tan(z / 4) * acos(y / 9) + asin(x / 9) - pow(4 + y, 1.3) / 5 + 0.2",
    ] {
        let text = text.replace("(x < y) / 9", "step(x, y) / 9");
        let within = formula(&text).within_sphere(1.8);
        check_field(&[within.clone().into()], &mut random);
        check_field(&[within.clone().sheet().into(), sphere(0.7).at([0.5, 0.2, 0.1])], &mut random);
        let turned =
            formula(&text).within_box([2.0, 3.0, 2.5]).open().rotate([1.0, 2.0, 3.0], 40.0).at([0.2, 0.1, 0.0]);
        check_field(&[turned, within.into()], &mut random);
    }
}

#[test]
fn warps_survive_pruning_and_cells_know_their_slopes() {
    let mut random = Random::new(31);
    let strong = ["x + exp(-20*((x - 0.5)^2 + y^2 + z^2)) / 2", "y + 0.1*sin(3x)", "z"];
    let fields = [
        (cuboid([1.2, 0.8, 1.6]) - sphere(0.5)).twist(80.0).rotate([1.0, 2.0, 3.0], 40.0),
        sphere(1.0).warp_within_sphere(strong, 0.9),
        smooth_union(0.3, [sphere(0.6).displace("sin(9x)*sin(9y) / 20"), torus(0.8, 0.2).into()]),
        formula("x^2 + 2y^2 + z^2 - 0.6").within_sphere(1.5).twist(50.0),
    ];
    for field in fields {
        let beside = sphere(0.4).at([1.4, 0.4, 0.0]);
        check_field(&[field.clone(), beside.clone()], &mut random);
        let program = Structure::compile(&[field, beside]).expect("sound").program(DVec3::new(0.3, -0.2, 0.1));
        let cells = Cells::new(&program, REGION);
        let mut splitter = Splitter::new(simd::best());
        for _ in 0..40 {
            let mut cell = cells.root();
            for _ in 0..random.below(4) {
                let children = cells.children(cell, &mut splitter);
                cell = &children[random.below(children.len())];
            }
            let slope = cells.slope(cell);
            let mut at = || {
                let offset: [f64; 3] = [0, 1, 2].map(|axis| {
                    f64::from(cell.middle()[axis]) + f64::from(cell.half()[axis]) * random.range(-1.0, 1.0)
                });
                program.origin() + DVec3::from_array(offset)
            };
            let mut steepest = 0.0_f64;
            for _ in 0..200 {
                let (p, q) = (at(), at());
                steepest = steepest.max((program.value(p) - program.value(q)).abs() / p.distance(q));
            }
            assert!(steepest <= f64::from(slope.bound) * (1.0 + 1e-9), "{steepest} above {slope:?}");
        }
    }
    // A strong spot steepens the cells around it, and no others.
    let program = Structure::compile(&[sphere(1.0).warp(strong)]).expect("sound").program(DVec3::ZERO);
    let cells = Cells::new(&program, REGION);
    let mut splitter = Splitter::new(simd::best());
    let children = cells.children(cells.root(), &mut splitter);
    let slopes: Vec<f32> = children
        .iter()
        .flat_map(|cell| cells.children(cell, &mut splitter))
        .map(|cell| cells.slope(cell).bound)
        .collect();
    let tame = slopes.iter().filter(|&&slope| slope < 1.5).count();
    assert!(tame * 10 > slopes.len() * 9 && slopes.iter().any(|&slope| slope > 2.0), "{tame} of {}", slopes.len());
}

/// How many steps matter on average in the boxes at this depth that hold a surface.
fn steps_left(fields: &[Field], levels: usize) -> f64 {
    let program = Structure::compile(fields).expect("a sound field").program(DVec3::ZERO);
    let cells = Cells::new(&program, REGION);
    let mut splitter = Splitter::new(simd::best());
    let mut level: Vec<&Cell> = vec![cells.root()];
    for _ in 0..levels {
        level = level
            .into_iter()
            .filter(|cell| cell.occupancy() == Occupancy::Surface)
            .flat_map(|cell| cells.children(cell, &mut splitter))
            .collect();
    }
    let left: Vec<usize> = level
        .into_iter()
        .filter(|cell| cell.occupancy() == Occupancy::Surface)
        .map(|cell| cell.part().size())
        .collect();
    left.iter().sum::<usize>() as f64 / left.len() as f64
}

#[test]
fn distant_operands_are_dropped() {
    let mut random = Random::new(3);
    let scattered: Vec<Field> =
        (0..300).map(|_| sphere(random.range(0.02, 0.1)).at(random.point(2.0).to_array())).collect();
    // The point and one primitive are the least; with another one and their minimum they are four.
    let left = steps_left(&scattered, 3);
    assert!(left < 3.0, "{left}");
    let left = steps_left(&[smooth_union(0.02, scattered.clone())], 3);
    assert!(left < 4.0, "{left}");
    let holes = scattered.into_iter().map(|hole| hole.rotate([1.0, 0.0, 0.0], 30.0));
    let block = std::iter::once(cuboid([4.0, 4.0, 4.0]).into()).chain(holes);
    let left = steps_left(&[difference(block)], 3);
    assert!(left < 5.0, "{left}");
}
