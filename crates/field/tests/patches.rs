//! Sheets along curved surfaces: beside the points of their surfaces.

mod common;

use common::{Random, ranges_hold};
use freikugel_field::shapes::*;
use freikugel_field::surface::{BSplinePatch, BezierPatch};
use freikugel_field::{
    Aabb, Cell, Cells, Evaluator, Extent, Field, Metric, Points, Program, Splitter, Structure, analyse, extent, simd,
};
use glam::{DVec3, DVec4};

/// Rounding errors of a few operations on numbers of this size.
const ROUNDING: f64 = 1e-12;

/// What triangles may be off, as a share of the largest edge of the box around the control points.
const TOLERANCE: f64 = 1e-3;

/// Half of the thickness of all sheets here.
const RADIUS: f64 = 0.1;

/// Into so many steps each parameter is cut, first.
const STEPS: u32 = 40;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

/// A net with bumps.
fn net(random: &mut Random, rows: usize, columns: usize) -> Vec<Vec<DVec3>> {
    let step = |count: usize, index: usize| 2.0 * index as f64 / (count - 1) as f64 - 1.0;
    let mut point = |row, column| DVec3::new(step(rows, row), step(columns, column), 0.0) + random.point(0.4);
    (0..rows).map(|row| (0..columns).map(|column| point(row, column)).collect()).collect()
}

fn rows(net: &[Vec<DVec3>]) -> Vec<Vec<[f64; 3]>> {
    net.iter().map(|row| row.iter().map(DVec3::to_array).collect()).collect()
}

/// The distance from the nearest point of a surface over the square of 0 to 1: of many points, and closer around the best of them.
fn nearest(surface: impl Fn(f64, f64) -> DVec3, p: DVec3) -> f64 {
    let mut best = (f64::INFINITY, 0.5, 0.5);
    let mut reach = 0.5;
    for _ in 0..6 {
        let (_, middle_u, middle_v) = best;
        let place = |middle: f64, step: u32| {
            (middle + reach * (2.0 * f64::from(step) / f64::from(STEPS) - 1.0)).clamp(0.0, 1.0)
        };
        for (u, v) in (0..=STEPS).flat_map(|u| (0..=STEPS).map(move |v| (u, v))) {
            let (u, v) = (place(middle_u, u), place(middle_v, v));
            let distance = surface(u, v).distance(p);
            if distance < best.0 {
                best = (distance, u, v);
            }
        }
        reach *= 3.0 / f64::from(STEPS);
    }
    best.0
}

/// Compares a sheet with its surface over the square of 0 to 1.
fn compare(name: &str, field: &Field, surface: impl Fn(f64, f64) -> DVec3, tolerance: f64, random: &mut Random) {
    let contract = analyse(field).0.expect("sound").contract;
    assert_eq!((contract.outside, contract.inside, contract.signed), (Metric::Exact, Metric::Bound, true), "{name}");
    let program = program(field);
    let Extent::Finite(aabb) = extent(field) else { panic!("a sheet is finite") };
    for _ in 0..300 {
        let point = surface(random.unit(), random.unit());
        assert!((program.value(point) + RADIUS).abs() < tolerance, "{name} at {point}, which is in the middle");
        let reach = RADIUS - tolerance;
        assert!(point.cmpge(aabb.min + reach).all() && point.cmple(aabb.max - reach).all(), "{name}: {point} {aabb:?}");
    }
    for p in (0..40).map(|_| random.point(1.6)) {
        let (found, known) = (program.value(p), nearest(&surface, p) - RADIUS);
        assert!((found - known).abs() < tolerance, "{name} at {p}: {found}, not {known}");
    }
}

fn size(net: &[Vec<DVec3>]) -> f64 {
    let points = || net.iter().flatten().copied();
    let (low, high) = (points().fold(DVec3::INFINITY, DVec3::min), points().fold(DVec3::NEG_INFINITY, DVec3::max));
    (high - low).max_element()
}

#[test]
fn bezier_patches_are_near_their_surfaces() {
    let mut random = Random::new(61);
    for (count_u, count_v) in [(2, 2), (3, 2), (4, 4), (3, 5)] {
        let net = net(&mut random, count_u, count_v);
        let (field, patch) = (bezier_patch(RADIUS, rows(&net)).into(), BezierPatch::new(net.clone()));
        let name = format!("{count_u} by {count_v}");
        compare(&name, &field, |u, v| patch.at(u, v), TOLERANCE * size(&net), &mut random);
        // With fewer triangles as far as the user says.
        let coarse: Field = bezier_patch(RADIUS, rows(&net)).with("tolerance", &[0.05.into()]).into();
        compare(&name, &coarse, |u, v| patch.at(u, v), 0.05, &mut random);
        assert!(program(&coarse).whole().size() < program(&field).whole().size(), "{name}");
    }
}

#[test]
fn spline_patches_are_near_their_surfaces() {
    let mut random = Random::new(67);
    let within = |(low, high): (f64, f64), share: f64| low + (high - low) * share;
    let net = net(&mut random, 5, 6);
    let weights: Vec<f64> = (0..30).map(|_| random.range(0.4, 2.5)).collect();
    let with_weights: Vec<Vec<DVec4>> = net
        .iter()
        .zip(weights.chunks(6))
        .map(|(row, weights)| row.iter().zip(weights).map(|(point, weight)| point.extend(*weight)).collect())
        .collect();
    let each = |of: fn(&DVec4) -> DVec4| with_weights.iter().map(|row| row.iter().map(of).collect()).collect();
    let weighted: Vec<Vec<DVec4>> = each(|point| (point.truncate() * point.w).extend(point.w));
    let (knots_u, knots_v) =
        ([0.0, 0.0, 0.0, 0.4, 0.4, 1.0, 1.5, 2.0], [0.0, 0.0, 0.0, 0.0, 0.2, 0.9, 1.0, 1.0, 1.0, 1.0]);
    let knots = [knots_u.to_vec(), knots_v.to_vec()];
    let tolerance = TOLERANCE * size(&net);

    let plain = BSplinePatch::clamped([2, 3], net.clone()).expect("sound");
    let [u, v] = plain.domain();
    let field = b_spline_patch(RADIUS, [2, 3], rows(&net)).into();
    compare("even knots", &field, |s, t| plain.at(within(u, s), within(v, t)), tolerance, &mut random);

    let uneven = BSplinePatch::new([2, 3], knots.clone(), net.clone()).expect("sound");
    let [u, v] = uneven.domain();
    let field = b_spline_patch(RADIUS, [2, 3], rows(&net)).knots_u(knots_u).knots_v(knots_v).into();
    compare("uneven knots", &field, |s, t| uneven.at(within(u, s), within(v, t)), tolerance, &mut random);

    let numbers = with_weights.iter().map(|row| row.iter().map(DVec4::to_array).collect::<Vec<_>>());
    let rational = BSplinePatch::new([2, 3], knots, weighted).expect("sound");
    let field = nurbs_patch(RADIUS, [2, 3], numbers).knots_u(knots_u).knots_v(knots_v).into();
    let at = |s: f64, t: f64| {
        let point = rational.at(within(u, s), within(v, t));
        point.truncate() / point.w
    };
    compare("rational", &field, at, tolerance, &mut random);
}

#[test]
fn closed_patches_are_tubes() {
    const TUBE: f64 = 0.3;
    // A square along v makes rings, four of which along u make a ring of them.
    let corners = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let w = 0.5_f64.sqrt();
    let ring = |corners: &[[f64; 2]]| -> Vec<[f64; 3]> {
        let middle = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1], w];
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).flat_map(|(a, b)| [[a[0], a[1], 1.0], middle(*a, *b)]).collect()
    };
    let circle = ring(&corners);
    let rows = circle.iter().map(|&[x, y, own]| {
        circle.iter().map(move |&[r, z, other]| {
            let radius = 0.8 + TUBE * r;
            [x * radius, y * radius, TUBE * z, own * other]
        })
    });
    let rows: Vec<Vec<[f64; 4]>> = rows.map(Iterator::collect).collect();
    let named = |name: &str, field: Field, by: i32| field.with(name, &[by.into()]);
    let field = nurbs_patch(RADIUS, [2, 2], rows).into();
    let field = named("closed_u", named("closed_v", named("knots_u", named("knots_v", field, 1), 1), 1), 1);
    let (made, known) = (program(&field), program(&torus(0.8, TUBE).into()));
    let mut random = Random::new(71);
    for p in (0..200).map(|_| random.point(1.5)) {
        // Within the tube, as outside of it, the surface is the nearest there is.
        let (found, known) = (made.value(p), known.value(p).abs() - RADIUS);
        assert!((found - known).abs() < TOLERANCE * 2.2, "{p}: {found}, not {known}");
    }
    // Closed without corners, too: no end is left.
    let net = net(&mut random, 5, 4);
    let around = named("closed_u", b_spline_patch(RADIUS, [3, 1], self::rows(&net)).into(), 1);
    let mut longer = net.clone();
    longer.extend_from_slice(&net[..3]);
    let open = b_spline_patch(RADIUS, [3, 1], self::rows(&longer)).knots_u(0..12).into();
    let (around, open) = (program(&around), program(&open));
    assert!((0..200).map(|_| random.point(1.5)).all(|p| (around.value(p) - open.value(p)).abs() < ROUNDING));
}

#[test]
fn an_octant_of_a_sphere_is_one() {
    const SPHERE: f64 = 0.9;
    let half = 0.5_f64.sqrt();
    let quarter = [(1.0, 0.0, 1.0), (1.0, 1.0, half), (0.0, 1.0, 1.0)];
    let point = |(x, y, w): (f64, f64, f64), (r, z, own): (f64, f64, f64)| {
        [x * r * SPHERE, y * r * SPHERE, z * SPHERE, w * own]
    };
    let rows = quarter.map(|row| quarter.map(|own| point(row, own)));
    let program = program(&nurbs_patch(RADIUS, [2, 2], rows).into());
    let mut random = Random::new(73);
    let tolerance = TOLERANCE * SPHERE;
    for p in (0..2000).map(|_| random.point(1.5)) {
        // The nearest point of the octant: of the sphere in its own octant, elsewhere of the quarters of circles at its edges.
        let arc = |axis: usize| {
            let flat = (p * (DVec3::ONE - DVec3::AXES[axis])).max(DVec3::ZERO);
            let ends = [0, 1, 2].into_iter().filter(|own| *own != axis).map(|own| DVec3::AXES[own] * SPHERE);
            let on_arc = (flat.length() > 0.0).then(|| flat.normalize() * SPHERE);
            ends.chain(on_arc).map(|q| q.distance(p)).fold(f64::INFINITY, f64::min)
        };
        let known = match p.min_element() >= 0.0 {
            true => (p.length() - SPHERE).abs(),
            false => (0..3).map(arc).fold(f64::INFINITY, f64::min),
        };
        let found = program.value(p) + RADIUS;
        assert!((found - known).abs() < tolerance, "{p}: {found}, not {known}");
    }
}

#[test]
fn flat_patches_are_panels() {
    let (corner, u, v) = (DVec3::new(-0.8, -0.6, -0.3), DVec3::new(1.5, -0.1, -0.2), DVec3::new(0.3, 1.3, 0.7));
    let at = |s: f64, t: f64| corner + u * s + v * t;
    let known = Field::from(quad(corner, u, v)).offset(RADIUS);
    let net = |count_u: u32, count_v: u32| -> Vec<Vec<DVec3>> {
        let share = |index: u32, count: u32| f64::from(index) / f64::from(count - 1);
        let row = |i: u32| (0..count_v).map(|j| at(share(i, count_u), share(j, count_v))).collect();
        (0..count_u).map(row).collect()
    };
    // Bent within its plane, it is the same.
    let mut bent = net(4, 4);
    bent[1][1] = at(0.5, 0.2);
    bent[2][1] = at(0.8, 0.4);
    let mut random = Random::new(79);
    for (name, made) in [
        ("bilinear", Field::from(bezier_patch(RADIUS, rows(&net(2, 2))))),
        ("of degrees 3 and 2", bezier_patch(RADIUS, rows(&net(4, 3))).into()),
        ("bent", bezier_patch(RADIUS, rows(&bent)).into()),
        ("a spline", b_spline_patch(RADIUS, [1, 1], rows(&net(3, 4))).into()),
    ] {
        let (made, known) = (program(&made), program(&known));
        for p in (0..400).map(|_| random.point(1.5)) {
            let (found, expected) = (made.value(p), known.value(p));
            assert!((found - expected).abs() < ROUNDING, "{name} at {p}: {found}, not {expected}");
        }
    }
}

#[test]
fn patches_that_collapse_are_lines() {
    // All rows are the same: a curve, with a tube around it. And one row that is a point: a triangle.
    let points = [[-1.0, -0.2, 0.0], [0.0, 0.9, 0.4], [1.0, 0.0, -0.3]];
    let mut random = Random::new(83);
    let line = bezier_patch(RADIUS, [points, points]).into();
    let (line, known) = (program(&line), program(&bezier(RADIUS, points).into()));
    for p in (0..200).map(|_| random.point(1.5)) {
        assert!((line.value(p) - known.value(p)).abs() < 3e-3, "{p}");
    }
    let [a, b, c] = points;
    let corner = program(&bezier_patch(RADIUS, [[a, a], [b, c]]).into());
    let known = program(&Field::from(triangle(a, b, c)).offset(RADIUS));
    for p in (0..200).map(|_| random.point(1.5)) {
        assert!((corner.value(p) - known.value(p)).abs() < ROUNDING, "{p}");
    }
}

#[test]
fn boxes_keep_the_near_triangles() {
    /// So often boxes are split.
    const LEVELS: u32 = 6;
    let mut random = Random::new(89);
    let net = net(&mut random, 4, 4);
    let program = program(&bezier_patch(RADIUS, rows(&net)).into());
    let whole = program.whole().size();
    assert!(whole > 100, "{whole} steps");
    let aabb = Aabb { min: DVec3::splat(-2.0), max: DVec3::splat(2.0) };
    let (cells, mut splitter) = (Cells::new(&program, aabb), Splitter::new(simd::best()));
    // Around points where the sheet ends, a few steps are left.
    let mut sizes = Vec::new();
    for _ in 0..40 {
        let near = random.point(1.2);
        let (value, gradient) = program.gradient(near);
        let point = (near - gradient * value).as_vec3().to_array();
        let mut cell = cells.root();
        for _ in 0..LEVELS {
            cells.enter(cell, &mut splitter);
            let holds =
                |cell: &&Cell| (0..3).all(|axis| (point[axis] - cell.middle()[axis]).abs() <= cell.half()[axis]);
            cell = cells.children(cell, &mut splitter).iter().find(holds).expect("a box that holds the point");
        }
        sizes.push(cell.part().size());
    }
    let mean = sizes.iter().sum::<usize>() / sizes.len();
    assert!(mean < whole / 20, "{mean} of {whole} steps: {sizes:?}");
}

#[test]
fn single_precision_leaves_no_gap() {
    let mut random = Random::new(97);
    let far = DVec3::new(30.0, -20.0, 10.0);
    let net: Vec<Vec<DVec3>> =
        net(&mut random, 4, 4).into_iter().map(|row| row.into_iter().map(|point| far + point).collect()).collect();
    let patch = BezierPatch::new(net.clone());
    let program = program(&bezier_patch(0.05, rows(&net)).with("tolerance", &[0.02.into()]).into());
    let places: Vec<DVec3> = (0..20_000)
        .map(|_| patch.at(random.unit(), random.unit()) + random.point(0.1))
        .map(|p| p.as_vec3().as_dvec3())
        .collect();
    let [x, y, z] = [0, 1, 2].map(|axis| places.iter().map(|p| p[axis] as f32).collect::<Vec<_>>());
    let mut found = vec![0.0; places.len()];
    Evaluator::new(&program).values(Points { x: &x, y: &y, z: &z }, &mut found);
    for (p, found) in places.into_iter().zip(found) {
        let expected = program.value(p);
        assert!((f64::from(found) - expected).abs() < 3e-5, "{p}: {found}, not {expected}");
    }
}

#[test]
fn ranges_hold_all_values() {
    let mut random = Random::new(101);
    for _ in 0..6 {
        let net = net(&mut random, 3, 4);
        let program = program(&bezier_patch(RADIUS, rows(&net)).with("tolerance", &[0.1.into()]).into());
        ranges_hold(&program, 60, |half| 40.0 * half, &mut random);
    }
}

#[test]
fn what_is_no_surface_is_refused() {
    let flat = |rows: usize, columns: usize| -> Vec<Vec<[f64; 3]>> {
        let point = |row: usize, column: usize| [row as f64, column as f64, 0.0];
        (0..rows).map(|row| (0..columns).map(|column| point(row, column)).collect()).collect()
    };
    let mut uneven = flat(4, 4);
    uneven[2].pop();
    let light = [[[0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]], [[1.0, 0.0, 0.0, 1.0], [1.0, 1.0, 0.0, 0.0]]];
    let wild = |height: f64| {
        let mut net = flat(4, 4);
        net[1][1][2] = height;
        bezier_patch(0.1, net)
    };
    let spline = || b_spline_patch(0.1, [2, 3], flat(4, 5));
    for (field, message) in [
        (
            Field::from(bezier_patch(0.1, uneven)),
            "`points` of `bezier_patch` must have as many points in each row, but row 3 has 3",
        ),
        (bezier_patch(0.1, flat(1, 3)).into(), "must have two rows or more, with two points or more in each"),
        (bezier_patch(0.1, flat(3, 1)).into(), "must have two rows or more, with two points or more in each"),
        (bezier_patch(0.1, flat(2, 34)).into(), "`bezier_patch` may have at most 33 points in each direction"),
        (bezier_patch(0.1, [[[1.0, 2.0, 3.0]; 2]; 2]).into(), "all points of `bezier_patch` are in the same place"),
        (
            wild(3.0).with("tolerance", &[1e-7.into()]).into(),
            "and at most 20000 are possible: a larger `tolerance` takes fewer",
        ),
        (wild(3.0).with("tolerance", &[(-1.0).into()]).into(), "`tolerance` of `bezier_patch` must not be negative"),
        (
            b_spline_patch(0.1, [4, 1], flat(4, 5)).into(),
            "`b_spline_patch`: along u, a spline of degree 4 has at least 5 points",
        ),
        (
            b_spline_patch(0.1, [1, 5], flat(4, 5)).into(),
            "`b_spline_patch`: along v, a spline of degree 5 has at least 6 points",
        ),
        (spline().knots_u([0, 1, 2]).into(), "along u, a spline of degree 2 with 4 points has 7 knots, not 3"),
        (
            spline().knots_v([0, 0, 0, 0, 0, 1, 1, 1, 1]).into(),
            "along v, a spline of degree 3 has no knot more than 4 times",
        ),
        (
            spline().knots_v([0, 0, 0, 0, 2, 1, 1, 1, 1]).into(),
            "`knots_v` of `b_spline_patch` must not fall, but entry 6 is 1",
        ),
        (
            spline().with("knots_u", &[1.into()]).into(),
            "along u, a chain of pieces of degree 2 has a multiple of 2 points",
        ),
        (
            spline().with("closed_u", &[1.into()]).knots_u([0, 1, 2]).into(),
            "a closed spline of degree 2 with 4 points has 5",
        ),
        (
            nurbs_patch(0.1, [1, 1], light).into(),
            "`points` of `nurbs_patch` must have weights above 0, but point 4 has 0",
        ),
    ] {
        let (analysis, diagnostics) = analyse(&field);
        assert!(analysis.is_none() && diagnostics[0].message.contains(message), "{message}: {diagnostics:?}");
    }
}
