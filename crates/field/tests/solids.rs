//! Bodies of figures by part of a turn and by lofting, cuts through bodies, and endless repetition: beside brute force, and beside
//! unions of copies written out.

mod common;

use common::Random;
use freikugel_field::shapes::*;
use freikugel_field::{
    Cells, Dimension, Evaluator, Extent, Field, Interval, MaterialId, Metric, Points, Program, Severity, Shares,
    Splitter, Structure, analyse, extent, simd,
};
use glam::{DQuat, DVec3};

/// Rounding errors of a few operations on numbers of this size.
const ROUNDING: f64 = 1e-12;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

fn metric(field: &Field) -> (Metric, Metric) {
    let contract = analyse(field).0.expect("a sound field").contract;
    (contract.outside, contract.inside)
}

fn refused(field: &Field, message: &str) {
    let (analysis, diagnostics) = analyse(field);
    assert!(analysis.is_none(), "{message}");
    let errors: Vec<_> = diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error).collect();
    assert!(errors.iter().any(|error| error.message.contains(message)), "{message}: {errors:?}");
}

#[test]
fn parts_of_revolutions_are_those_of_known_bodies() {
    let ring = |angle: f64| circle(0.3).revolve_part(angle).with("offset", &[0.8.into()]);
    let quarter = rectangle(1.0, 0.8).at([0.5, 0.0, 0.0]).revolve_part(90.0).rotate([0.0, 0.0, 1.0], 45.0);
    let cases: [(Field, Field); 3] = [
        // A quarter and a half of a cylinder are what planes leave of it, inside, where that is exact.
        (quarter, cylinder(1.0, 0.8) & plane([-1.0, 0.0, 0.0]) & plane([0.0, -1.0, 0.0])),
        (rectangle(1.0, 0.8).at([0.5, 0.0, 0.0]).revolve_part(180.0), cylinder(1.0, 0.8) & plane([-1.0, 0.0, 0.0])),
        (ring(359.999), torus(0.8, 0.3).into()),
    ];
    let mut random = Random::new(31);
    for (index, (made, known)) in cases.iter().enumerate() {
        let (one, other) = (program(made), program(known));
        for p in (0..600).map(|_| random.point(1.6)) {
            let (found, expected) = (one.value(p), other.value(p));
            match index {
                // A cut of next to nothing is there.
                2 => assert!((found - expected).abs() < 1e-5 || expected < 1e-5, "{p}: {found}, {expected}"),
                _ if expected < 0.0 => assert!((found - expected).abs() < ROUNDING, "{index} {p}: {found}, {expected}"),
                _ => assert!(found > expected - ROUNDING, "{index} {p}: {found}, {expected}"),
            }
        }
    }
}

#[test]
fn a_part_of_a_revolution_is_as_far_as_the_nearest_of_its_half_planes() {
    /// Half-planes in which the figure is looked for: their angles are no farther apart than this, times the distance from the
    /// axis.
    const STEPS: u32 = 4000;
    let mut random = Random::new(32);
    for angle in [1.0, 40.0, 90.0, 179.0, 181.0, 250.0, 330.0, 359.0_f64] {
        let figure = || rectangle(0.5, 0.8).round(0.1).at([0.9, 0.1, 0.0]) - circle(0.15).at([0.8, 0.0, 0.0]);
        let made = figure().revolve_part(angle);
        assert_eq!(metric(&made), metric(&figure()), "{angle}");
        let (made, flat) = (program(&made), program(&figure()));
        for p in (0..60).map(|_| random.point(1.8)) {
            let value = made.value(p);
            let half = angle.to_radians() / 2.0;
            let turned = |step: u32| {
                let turn = half * (2.0 * f64::from(step) / f64::from(STEPS) - 1.0);
                DQuat::from_rotation_z(-turn) * p
            };
            if p.y.atan2(p.x).abs() >= half {
                // From the half-plane at one of the angles: as far beside it as the y, and as far in it as the figure is.
                let far = |q: DVec3| q.y.hypot(flat.value(DVec3::new(q.x, q.z, 0.0)).max(0.0));
                let nearest = (0..=STEPS).map(|step| far(turned(step))).fold(f64::INFINITY, f64::min);
                assert!((value - nearest).abs() < ROUNDING, "{angle} at {p}: {value}, not {nearest}");
            } else {
                // Between the ends: what leaves the whole body, or reaches an end.
                let whole = flat.value(DVec3::new(p.x.hypot(p.y), p.z, 0.0));
                let to_end = |side: f64| {
                    let q = DQuat::from_rotation_z(-half * side) * p;
                    if q.x > 0.0 { q.y.abs() } else { p.x.hypot(p.y) }
                };
                let expected = whole.max(-to_end(1.0).min(to_end(-1.0)));
                assert!((value - expected).abs() < ROUNDING, "{angle} at {p}: {value}, not {expected}");
            }
        }
    }
    refused(&circle(0.3).revolve_part(360.0), "below 360 degrees");
    refused(&sphere(0.3).revolve_part(90.0), "`revolve_part` takes a plane figure");
    let crossing = circle(0.5).at([0.2, 0.0, 0.0]).revolve_part(120.0);
    assert_eq!(metric(&crossing), (Metric::Bound, Metric::Bound), "it crosses the axis");
}

#[test]
fn a_cut_is_where_the_body_is() {
    let body = || torus(0.7, 0.3).rotate([1.0, 0.4, 0.0], 60.0) + sphere(0.4).at([0.3, 0.2, 0.5]);
    let (solid, figure) = (program(&body()), body().cross_section(0.35));
    assert_eq!(analyse(&figure).0.expect("sound").contract.dimension, Dimension::Plane);
    assert_eq!(metric(&figure), (Metric::Bound, Metric::Bound));
    let cut = program(&figure);
    let extruded = program(&figure.clone().extrude(0.6));
    let mut random = Random::new(33);
    for p in (0..500).map(|_| random.point(1.5)) {
        let value = cut.value(p);
        assert_eq!(value, solid.value(p.with_z(0.35)), "{p}");
        assert_eq!(extruded.value(p) < 0.0, value < 0.0 && p.z.abs() < 0.3, "{p}");
    }
    // A cut through a ball is a circle: never nearer, and at the edge the same.
    let (circle_of_ball, known) = (program(&sphere(1.0).cross_section(0.6)), program(&circle(0.8).into()));
    for p in (0..500).map(|_| random.point(1.5)) {
        let (bound, exact) = (circle_of_ball.value(p), known.value(p));
        assert!(bound.abs() <= exact.abs() + ROUNDING && (bound * exact >= 0.0 || exact.abs() < ROUNDING), "{p}");
    }
    refused(&circle(1.0).cross_section(0.0), "`cross_section` takes a body");
    refused(&(sphere(1.0).cross_section(0.0) + sphere(1.0)), "either plane figures or bodies");
    // Formulas may be cut, too.
    assert!(analyse(&formula("x^2 + y^2 + z^2 - 1").cross_section(0.0).extrude(1.0)).0.is_some());
}

/// Shapes with the distances at which they are repeated, and how many copies each way are enough for points nearby.
fn repetitions() -> Vec<(&'static str, Field, [f64; 3], i32)> {
    vec![
        ("balls, far apart", sphere(0.3).into(), [1.0, 1.5, 2.0], 4),
        ("balls off the middle", sphere(0.3).at([0.4, -0.2, 0.1]), [1.0, 1.0, 1.0], 5),
        ("boxes that overhang", cuboid([1.6, 0.3, 0.4]).rotate([0.0, 0.0, 1.0], 30.0), [1.1, 0.5, 0.0], 8),
        ("rings through each other", torus(0.6, 0.1).rotate([1.0, 1.0, 0.0], 70.0), [0.7, 0.0, 0.0], 9),
        (
            "balls that blend",
            smooth_union(0.3, [sphere(0.3).into(), sphere(0.2).at([0.4, 0.1, 0.0])]),
            [0.9, 0.8, 0.7],
            6,
        ),
        ("a wall of balls", sphere(0.4) - cuboid([0.3, 0.3, 2.0]), [0.8, 0.0, 0.8], 6),
        ("a stretched box", cuboid([0.3, 0.4, 0.2]).stretch([3.0, 0.5, 1.0]), [0.8, 0.7, 0.0], 7),
    ]
}

#[test]
fn endless_copies_are_no_farther_than_the_union_of_them() {
    let mut random = Random::new(34);
    for (name, child, spacing, reach) in repetitions() {
        let made = child.clone().repeat_endless(spacing);
        let along = |axis: usize| if spacing[axis] == 0.0 { 0..=0 } else { -reach..=reach };
        let cells = along(0).flat_map(|x| along(1).flat_map(move |y| along(2).map(move |z| [x, y, z])));
        let offset = |cell: [i32; 3]| DVec3::from(spacing) * DVec3::from(cell.map(f64::from));
        let copies: Vec<DVec3> = cells.map(offset).collect();
        let (one, single) = (program(&made), program(&child));
        let clearance = spacing.into_iter().filter(|&s| s > 0.0).fold(f64::INFINITY, f64::min) / 4.0;
        let is_exact = metric(&child).0 == Metric::Exact;
        for p in (0..300).map(|_| random.point(1.2)) {
            let (found, all) =
                (one.value(p), copies.iter().map(|&at| single.value(p - at)).fold(f64::INFINITY, f64::min));
            if is_exact {
                assert!(found <= all + ROUNDING, "{name} at {p}: {found}, and the union {all}");
            }
            assert_eq!(found < 0.0, all < 0.0, "{name} at {p}: {found}, and the union {all}");
            // What is nearer than all that is not looked at is known.
            let is_known = if is_exact { all < clearance } else { all < 0.0 };
            assert!(!is_known || (found - all).abs() < ROUNDING, "{name} at {p}: {found}, not {all}");
        }
        // It repeats.
        for p in (0..100).map(|_| random.point(1.0)) {
            let far = DVec3::from(spacing) * DVec3::new(17.0, -23.0, 31.0);
            assert!((one.value(p) - one.value(p + far)).abs() < 1e-9, "{name} at {p}");
        }
        // Far from what is not repeated, steps are long.
        if let Some(axis) = (0..3).find(|&axis| spacing[axis] == 0.0) {
            assert!(one.value(DVec3::AXES[axis] * 50.0) > 48.0, "{name}");
        }
    }
}

#[test]
fn endless_copies_have_no_jumps() {
    let mut random = Random::new(35);
    for (name, child, spacing, _) in repetitions() {
        let field = child.repeat_endless(spacing);
        let slope = analyse(&field).0.expect("sound").contract.lipschitz.expect("it is known");
        let program = program(&field);
        for _ in 0..4000 {
            // Mostly across the places where another copy is looked at.
            let mut p = random.point(3.0);
            let axis = random.below(3);
            if spacing[axis] > 0.0 {
                p[axis] = (p[axis] / spacing[axis] * 4.0).round() * spacing[axis] / 4.0;
            }
            let q = p + random.direction() * 10f64.powf(random.range(-9.0, -1.0));
            let difference = (program.value(p) - program.value(q)).abs();
            assert!(difference <= slope * p.distance(q) * (1.0 + 1e-9) + 1e-12, "{name} from {p} to {q}");
            let hull = [0, 1, 2].map(|axis| Interval::new(p[axis].min(q[axis]), p[axis].max(q[axis])));
            assert!(program.interval(hull).contains(program.value(p)), "{name} at {p}");
        }
    }
}

#[test]
fn endless_copies_are_bounded_where_nothing_is_repeated() {
    let field = cuboid([1.0, 2.0, 3.0]).at([0.0, 0.5, 0.0]).repeat_endless([0.7, 0.0, 0.0]);
    assert_eq!(extent(&field), Extent::Unbounded);
    let Extent::Finite(aabb) = extent(&(field & cuboid([1.0, 10.0, 10.0]))) else { panic!("it was cut") };
    assert_eq!((aabb.min, aabb.max), (DVec3::new(-0.5, -0.5, -1.5), DVec3::new(0.5, 1.5, 1.5)));
    let apart = sphere(0.4).repeat_endless([1.0, 1.0, 0.0]);
    assert_eq!(metric(&apart), (Metric::Bound, Metric::Exact));
    assert_eq!(metric(&sphere(0.6).repeat_endless([1.0, 1.0, 0.0])), (Metric::Bound, Metric::Bound));
    refused(&plane([0.0, 0.0, 1.0]).repeat_endless([1.0, 0.0, 0.0]), "has no end along x");
    refused(&circle(0.3).repeat_endless([1.0, 0.0, 1.0]), "has no end along z");
    refused(&sphere(1.0).repeat_endless([0.1, 0.1, 0.0]), "441 copies");
    refused(&sphere(1.0).repeat_endless([0.0, 0.0, 0.0]), "along some axis");
    assert!(analyse(&circle(0.3).repeat_endless([1.0, 1.0, 0.0]).extrude(1.0)).0.is_some());
}

#[test]
fn endless_copies_take_new_numbers_as_long_as_no_others_are_looked_at() {
    let structure = Structure::compile(&[sphere(0.3).repeat_endless([1.0, 1.0, 0.0])]).expect("sound");
    assert_eq!(structure.values(), [1.0, 1.0, 0.0, 0.3]);
    let program = structure.bind(&[1.2, 1.1, 0.0, 0.4], DVec3::ZERO).expect("as many copies");
    let known = self::program(&sphere(0.4).repeat_endless([1.2, 1.1, 0.0]));
    let mut random = Random::new(36);
    for p in (0..200).map(|_| random.point(2.0)) {
        assert_eq!(program.value(p), known.value(p));
    }
    assert!(structure.bind(&[1.0, 1.0, 0.0, 0.9], DVec3::ZERO).is_err(), "more copies need other steps");
}

#[test]
fn what_is_left_in_boxes_of_endless_copies_has_the_same_values_gradients_and_shares() {
    let pair = union([sphere(0.25).painted(MaterialId(0)), sphere(0.2).at([0.3, 0.2, 0.1]).painted(MaterialId(1))]);
    let figures = [circle(0.5).painted(MaterialId(0)), rectangle(1.2, 0.6).painted(MaterialId(1)), circle(0.3).into()];
    let lofted = loft(1.2, figures).painted(MaterialId(0));
    for field in [pair.repeat_endless([0.6, 0.5, 0.7]), lofted] {
        let structure = Structure::compile(&[field]).expect("sound");
        let program = structure.program(DVec3::ZERO);
        let region = freikugel_field::Aabb { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
        let cells = Cells::new(&program, region);
        let level = simd::available()[0];
        let mut splitter = Splitter::new(level);
        let mut evaluator = Evaluator::with_level(&program, level);
        let mut random = Random::new(37);
        let (mut smaller, mut count) = (0, 0);
        let outer = cells.children(cells.root(), &mut splitter);
        for inner in outer.iter().flat_map(|cell| cells.children(cell, &mut splitter)) {
            if inner.occupancy() != freikugel_field::Occupancy::Surface {
                continue;
            }
            count += 1;
            smaller += usize::from(inner.part().size() < program.whole().size());
            let [x, y, z] = [0, 1, 2].map(|axis| {
                (0..32)
                    .map(|_| inner.middle()[axis] + inner.half()[axis] * random.range(-0.99, 0.99) as f32)
                    .collect::<Vec<f32>>()
            });
            let points = Points { x: &x, y: &y, z: &z };
            let mut values = [vec![0.0; 32], vec![0.0; 32]];
            let mut gradients = [[(); 3].map(|()| vec![0.0; 32]), [(); 3].map(|()| vec![0.0; 32])];
            let [whole, part] = &mut values;
            let [[a, b, c], [d, e, f]] = &mut gradients;
            evaluator.gradients(points, whole, [a, b, c]);
            evaluator.gradients_in(inner.part(), points, part, [d, e, f]);
            let (mut all, mut own) = (Shares::default(), Shares::default());
            evaluator.shares(points, &mut all);
            evaluator.shares_in(inner.part(), points, &mut own);
            let is_measured = inner.part().is_measured();
            for i in 0..32 {
                // Of what has no scale, only the sign is kept inside.
                if values[0][i] < 0.0 && !is_measured {
                    assert!(values[1][i] < 0.0);
                    continue;
                }
                assert_eq!(values[0][i], values[1][i]);
                assert!((0..3).all(|axis| gradients[0][axis][i] == gradients[1][axis][i]));
                assert!((0..2).all(|region| all.of(region, i) == own.of(region, i)));
                assert!((all.of(0, i) + all.of(1, i) - 1.0).abs() < 1e-6);
            }
        }
        println!("{smaller} of {count} boxes hold less");
        assert!(smaller * 2 > count, "{smaller} of {count} boxes hold less");
    }
}

#[test]
fn lofts_are_mixtures_of_their_figures() {
    let figures: [Field; 3] =
        [rectangle(1.2, 0.8).round(0.1).into(), circle(0.4).at([0.2, 0.1, 0.0]), star(5, 0.9, 0.5).into()];
    let known: Vec<Program> = figures.iter().map(program).collect();
    let mut random = Random::new(38);
    for smooth in [false, true] {
        let field = loft(1.6, figures.clone()).with("ease", &[u8::from(smooth).into()]);
        let made = program(&field);
        assert_eq!(metric(&field), (Metric::Implicit, Metric::Implicit));
        for p in (0..500).map(|_| random.point(1.2)) {
            let share = ((p.z / 1.6 + 0.5) * 2.0).clamp(0.0, 2.0);
            let first = share.floor().min(1.0);
            let t = share - first;
            let t = if smooth { t * t * (3.0 - 2.0 * t) } else { t };
            let value = |index: usize| known[index].value(p);
            let first = first as usize;
            let expected = (value(first) * (1.0 - t) + value(first + 1) * t).max(p.z.abs() - 0.8);
            assert!((made.value(p) - expected).abs() < ROUNDING, "{smooth} at {p}");
        }
        let Extent::Finite(aabb) = extent(&field) else { panic!("it has an end") };
        assert!(aabb.max.z == 0.8 && aabb.min.x <= -0.6 && aabb.max.x <= 0.9, "{aabb:?}");
        for p in (0..2000).map(|_| random.point(1.2)).filter(|&p| made.value(p) < 0.0) {
            assert!(p.cmpge(aabb.min).all() && p.cmple(aabb.max).all(), "{p}");
        }
    }
    refused(&loft(1.0, [circle(1.0)]), "goes from one figure to another");
    refused(&loft(1.0, [sphere(1.0), sphere(2.0)]), "takes plane figures, not bodies");
}

#[test]
fn slopes_of_lofts_are_bounded_in_every_box() {
    let mut random = Random::new(39);
    for ease in [0, 1] {
        let field =
            loft(1.2, [rectangle(1.6, 0.4).into(), circle(0.3).at([0.3, 0.0, 0.0]), rectangle(0.4, 1.6).into()])
                .with("ease", &[ease.into()])
                .rotate([1.0, 2.0, 0.5], 40.0);
        let program = program(&field);
        for _ in 0..60 {
            let (corner, size) = (random.point(1.0), 10f64.powf(random.range(-3.0, 0.0)));
            let region = corner.to_array().map(|c| Interval::new(c, c + size));
            let bound = program.lipschitz_over(region).expect("a bound");
            let place = |random: &mut Random| corner + size * DVec3::new(random.unit(), random.unit(), random.unit());
            let mut steepest: f64 = 0.0;
            for _ in 0..200 {
                let (p, q) = (place(&mut random), place(&mut random));
                let slope = (program.value(p) - program.value(q)).abs() / p.distance(q);
                assert!(slope <= bound * (1.0 + 1e-9), "{slope} above {bound} from {p} to {q}");
                steepest = steepest.max(slope);
                let value = program.value(p);
                assert!(program.interval(region).contains(value), "{p}");
            }
            assert!(bound < 4.0, "{bound} for {steepest}");
        }
    }
}

#[test]
fn materials_of_lofts_go_over() {
    let figure = |material: u32| circle(0.5).painted(MaterialId(material));
    let structure = Structure::compile(&[loft(2.0, [figure(0), figure(1), figure(2)])]).expect("sound");
    let program = structure.program(DVec3::ZERO);
    let z = [-1.0, -0.75, -0.5, 0.0, 0.25, 1.0];
    let (x, y) = ([0.5; 6], [0.0; 6]);
    let mut shares = Shares::default();
    Evaluator::new(&program).shares(Points { x: &x, y: &y, z: &z }, &mut shares);
    let expected =
        [[1.0, 0.0, 0.0], [0.75, 0.25, 0.0], [0.5, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.75, 0.25], [0.0, 0.0, 1.0]];
    for (place, expected) in expected.into_iter().enumerate() {
        for (index, region) in structure.regions().iter().enumerate() {
            let material = region.material.expect("all are painted").0 as usize;
            assert!((shares.of(index, place) - expected[material]).abs() < 1e-6, "{place} {material}");
        }
    }
}

#[test]
fn shells_are_hollow() {
    let shell = program(&sphere(1.0).shell(0.2));
    for radius in [0.0, 0.3, 0.89, 0.95, 1.0, 1.05, 1.5] {
        let expected = f64::abs(radius - 1.0) - 0.1;
        let value = shell.value(DVec3::new(0.0, radius, 0.0));
        assert!((value - expected).abs() < 1e-12, "{value}, not {expected}, at {radius}");
    }
}
