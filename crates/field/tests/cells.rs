//! Cells: what is left of a program in a box computes the same there, bit for bit, and the signs are right. Of what has no
//! scale, only the sign is kept where it is negative.

mod common;

use common::Random;
use freikugel_field::shapes::*;
use freikugel_field::simd;
use freikugel_field::{
    Aabb, Cell, Cells, Evaluator, Field, MaterialId, Occupancy, Points, Program, Shares, Splitter, Structure,
};
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
    let mut splitter = Splitter::new(simd::best());
    cells.enter(cell, &mut splitter);
    let [x, y, z] = points_in(cell, random, POINTS);
    let points = Points { x: &x, y: &y, z: &z };
    let mut evaluator = Evaluator::new(program);
    let (mut all, mut own) = ([0.0; POINTS], [0.0; POINTS]);
    evaluator.values(points, &mut all);
    // Of a crowded box only the sign is known.
    let part = if cell.is_crowded() { program.whole() } else { cell.part() };
    evaluator.values_in(part, points, &mut own);
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
    evaluator.gradients_in(part, points, &mut own, [gx, gy, gz]);
    for point in (0..POINTS).filter(|&point| matters[point]) {
        assert_eq!(all[point], own[point]);
        assert_eq!(gradient.map(|g| g[point]), own_gradient.map(|g| g[point]));
    }
    let (mut shares, mut own_shares) = (Shares::default(), Shares::default());
    evaluator.shares(points, &mut shares);
    evaluator.shares_in(part, points, &mut own_shares);
    for (region, shares) in shares.iter() {
        for (point, &share) in shares.iter().enumerate().filter(|&(point, _)| matters[point]) {
            assert_eq!(share, own_shares.of(region, point), "region {region}");
        }
    }
    if levels > 0 {
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
        .filter(|cell| {
            cells.enter(cell, &mut splitter);
            cell.occupancy() == Occupancy::Surface
        })
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

/// Many small objects, some of them moved to see how far from each other they may be.
fn scattered(count: usize, random: &mut Random) -> Vec<Field> {
    (0..count)
        .map(|index| {
            let place = random.point(2.0).to_array();
            let size = random.range(0.02, 0.3);
            match index % 4 {
                0 => sphere(size).at(place),
                1 => cuboid([size, 1.5 * size, 0.7 * size]).rotate([1.0, 2.0, 3.0], 77.0).at(place),
                2 => union::<Field>([sphere(size).into(), sphere(size).at([size, 0.0, 0.0])]).at(place),
                _ => (sphere(size) - sphere(0.8 * size).at([0.5 * size, 0.0, 0.0])).at(place),
            }
        })
        .collect()
}

#[test]
fn parts_hold_for_programs_with_other_origins() {
    const POINTS: usize = 24;
    let mut random = Random::new(17);
    let fields = [
        scattered(60, &mut random),
        scattered(400, &mut random),
        vec![common::tree(5, &mut random)],
        vec![formula("x^4 + y^4 + z^4 - (x^2 + y^2 + z^2) / 2 + x*y / 5 - 0.1").within_sphere(1.8).into()],
        vec![cuboid([1.2, 0.8, 1.6]).twist(80.0).rotate([1.0, 2.0, 3.0], 40.0), sphere(0.4).at([1.4, 0.4, 0.0])],
    ];
    // Far from the zero of the coordinates, so that origins matter.
    let far = DVec3::new(40.0, -70.0, 20.0);
    for fields in fields {
        let fields: Vec<Field> = fields.into_iter().map(|field| field.at(far.to_array())).collect();
        let structure = Structure::compile(&fields).expect("sound");
        let region = Aabb { min: far + REGION.min, max: far + REGION.max };
        let reach = region.size().length() / 2.0;
        let cells = Cells::for_origins(&structure.program(region.center()), region, reach);
        let mut splitter = Splitter::new(simd::best());
        for _ in 0..40 {
            let mut cell = cells.root();
            for _ in 0..random.below(5) {
                let children = cells.children(cell, &mut splitter);
                cell = &children[random.below(children.len())];
            }
            cells.enter(cell, &mut splitter);
            if cell.is_crowded() {
                continue;
            }
            let origin = region.center() + random.point(2.5);
            let program = structure.program(origin);
            let mut points = points_in(cell, &mut random, POINTS);
            let shift = (cells.origin() - origin).as_vec3();
            for (points, shift) in points.iter_mut().zip(shift.to_array()) {
                points.iter_mut().for_each(|number| *number += shift);
            }
            let [x, y, z] = &points;
            let mut evaluator = Evaluator::new(&program);
            let (mut all, mut own) = ([0.0; POINTS], [0.0; POINTS]);
            evaluator.values(Points { x, y, z }, &mut all);
            evaluator.values_in(cell.part(), Points { x, y, z }, &mut own);
            let is_measured = program.whole().is_measured();
            for (value, own) in all.into_iter().zip(own) {
                assert!(value == own || (!is_measured && value < 0.0 && own < 0.0), "{value} became {own}");
                match cell.occupancy() {
                    Occupancy::Outside(least) => assert!(value >= least, "{value} below {least}"),
                    Occupancy::Inside => assert!(value < 0.0),
                    Occupancy::Surface => {}
                }
            }
        }
    }
}

#[test]
fn boxes_that_were_taken_back_are_the_same_again() {
    let mut random = Random::new(41);
    let program = Structure::compile(&scattered(300, &mut random)).expect("sound").program(DVec3::ZERO);
    let mut cells = Cells::new(&program, REGION);
    let mut splitter = Splitter::new(simd::best());
    // What there is two levels down.
    let mut look = |cells: &Cells| -> Vec<(Occupancy, usize)> {
        let children = cells.children(cells.root(), &mut splitter).iter();
        let all: Vec<&Cell> = children.flat_map(|cell| cells.children(cell, &mut splitter)).collect();
        let look = |cell: &Cell| {
            cells.enter(cell, &mut Splitter::new(simd::best()));
            (cell.occupancy(), if cell.is_crowded() { 0 } else { cell.part().size() })
        };
        all.into_iter().map(look).collect()
    };
    let first = look(&cells);
    let weight = cells.weight();
    assert!(weight > 0);
    cells.trim(usize::MAX);
    assert_eq!(cells.weight(), weight, "all of it was asked for in this round");
    cells.turn();
    let root = cells.root();
    let asked = cells.children(root, &mut Splitter::new(simd::best()))[21].middle();
    assert_eq!(asked, cells.children(root, &mut Splitter::new(simd::best()))[21].middle());
    cells.trim(usize::MAX);
    let less = cells.weight();
    assert!(less > 0 && less < weight, "only the first level was asked for: {less} of {weight}");
    assert_eq!(look(&cells), first);
    assert_eq!(cells.weight(), weight);
    cells.trim(weight - 1);
    assert_eq!(cells.weight(), 0);
    assert_eq!(look(&cells), first);
}

#[test]
fn gradients_and_shares_of_long_unions_are_those_of_the_nearest_operand() {
    const POINTS: usize = 700;
    let mut random = Random::new(53);
    let mut fields = scattered(70, &mut random);
    // Two at the same place: the first has it all.
    fields.push(fields[12].clone());
    let structure = Structure::compile(&fields).expect("sound");
    let program = structure.program(DVec3::ZERO);
    let alone: Vec<Program> = fields
        .iter()
        .map(|field| Structure::compile(std::slice::from_ref(field)).expect("sound").program(DVec3::ZERO))
        .collect();
    let points: [Vec<f32>; 3] = std::array::from_fn(|_| (0..POINTS).map(|_| random.range(-2.5, 2.5) as f32).collect());
    let [x, y, z] = &points;
    let points = Points { x, y, z };
    let evaluate = |program: &Program, points: Points<'_>| {
        let count = points.count();
        let mut out: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; count]);
        let [values, gx, gy, gz] = &mut out;
        Evaluator::new(program).gradients(points, values, [gx, gy, gz]);
        out
    };
    let all = evaluate(&program, points);
    let single: Vec<_> = alone.iter().map(|program| evaluate(program, points)).collect();
    let mut shares = Shares::default();
    Evaluator::new(&program).shares(points, &mut shares);
    for point in 0..POINTS {
        let nearest = (0..single.len()).min_by(|&a, &b| single[a][0][point].total_cmp(&single[b][0][point]));
        let nearest = nearest.expect("there are some");
        assert_eq!([0, 1, 2, 3].map(|k| all[k][point]), [0, 1, 2, 3].map(|k| single[nearest][k][point]));
        for (region, shares) in shares.iter() {
            let expected = if structure.regions()[region].object == nearest { 1.0 } else { 0.0 };
            assert_eq!(shares[point], expected);
        }
        // One point alone comes to the same as many together.
        if point % 50 == 0 {
            let one = |numbers: &[f32]| [numbers[point]];
            let [x, y, z] = [one(x), one(y), one(z)];
            let own = evaluate(&program, Points { x: &x, y: &y, z: &z });
            assert_eq!([0, 1, 2, 3].map(|k| own[k][0]), [0, 1, 2, 3].map(|k| all[k][point]));
        }
    }
}

#[test]
fn crowds_compute_the_same() {
    let mut random = Random::new(67);
    let many = scattered(200, &mut random);
    let with = |more: Vec<Field>| many.iter().cloned().chain(more).collect::<Vec<Field>>();
    let bounds = |random: &mut Random| {
        (0..150)
            .map(|_| {
                let place = random.point(2.0).to_array();
                smooth_union::<Field>(0.1, [sphere(0.2).into(), sphere(0.15).at([0.3, 0.0, 0.0])]).scale(0.5).at(place)
            })
            .collect::<Vec<Field>>()
    };
    let crowds = [
        // One far away, one that holds everything, and tiny ones in a spot.
        with(vec![sphere(1.0).at([900.0, -700.0, 400.0])]),
        with(vec![sphere(2.4).at([0.3, 0.0, 0.0]), sphere(1e-4).at([0.5, 0.5, 0.5])]),
        (0..200).map(|_| sphere(1e-3).at((random.point(0.01) + 0.7).to_array())).collect(),
        // All at one place, the same ones and others.
        (0..200).map(|_| sphere(0.5).at([0.1, 0.2, 0.3])).collect(),
        (0..200).map(|k| cuboid([0.5, 0.5, 1.0]).rotate([0.0, 0.0, 1.0], f64::from(k)).at([0.1, 0.2, 0.3])).collect(),
        // Some without a box, some without a slope.
        with(vec![plane([0.0, 0.0, 1.0]).into(), plane([1.0, 0.0, 0.2]).at([2.0, 0.0, 0.0])]),
        with(vec![formula("x^2 + 2y^2 + z^2 - 0.6").within_sphere(1.8).into()]),
        bounds(&mut random),
        // Nested, painted, moved, and one that is empty.
        vec![union(many[..100].to_vec()).at([0.1, 0.0, 0.0]), union(many[100..].to_vec()).painted(MaterialId(3))],
        with(vec![intersection::<Field>([sphere(0.2).into(), sphere(0.2).at([1.0, 0.0, 0.0])])]),
    ];
    for crowd in crowds {
        check_field(&crowd, &mut random);
    }
}

#[test]
fn a_crowd_keeps_no_more_than_a_survey_of_all_of_it() {
    // The same union as a crowd, and behind a step that hides it from the search, so that all of it is surveyed.
    let mut random = Random::new(71);
    let many = scattered(600, &mut random);
    let hidden = [union(many.clone()).scale(1.0)];
    let (crowd, hidden) = (steps_left(&many, 3), steps_left(&hidden, 3));
    assert!(crowd <= 1.05 * hidden, "{crowd} and {hidden}");
}
