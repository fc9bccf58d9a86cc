//! Tubes whose radius changes, tubes along rational curves, and lines along paths: beside the points of their curves.

mod common;

use common::Random;
use freikugel_field::curve::{BSpline, Bezier};
use freikugel_field::shapes::*;
use freikugel_field::{Evaluator, Extent, Field, Interval, Metric, Points, Program, Structure, analyse, extent};
use glam::{DVec3, DVec4};

/// Rounding errors of a few operations on numbers of this size.
const ROUNDING: f64 = 1e-12;

/// So many steps along a curve.
const STEPS: u32 = 4000;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

fn ball(random: &mut Random) -> DVec4 {
    random.point(1.0).extend(random.range(0.05, 0.5))
}

fn steps() -> impl Iterator<Item = f64> {
    (0..=STEPS).map(|step| f64::from(step) / f64::from(STEPS))
}

fn along(spline: &BSpline<DVec4>) -> Vec<DVec4> {
    let (low, high) = spline.domain();
    steps().map(|share| spline.at(low + (high - low) * share)).collect()
}

#[test]
fn tapered_tubes_are_as_far_as_the_nearest_of_their_balls() {
    /// Twice what arcs may be away from their curve, as a share of the largest radius.
    const TOLERANCE: f64 = 2e-3;
    let mut random = Random::new(29);
    for round in 0..12 {
        let balls: Vec<DVec4> = (0..4 + round % 3).map(|_| ball(&mut random)).collect();
        let rows = || balls.iter().map(DVec4::to_array);
        let closed = |field: Field| field.with("closed", &[1.into()]);
        let bezier = Bezier::new(balls.clone());
        let spline = |degree| BSpline::clamped(degree, balls.clone()).expect("enough points");
        let around = BSpline::closed(3, &balls).expect("enough points");
        let cases: [(&str, Field, Vec<DVec4>); 4] = [
            ("bezier", tapered_bezier(rows()).into(), steps().map(|t| bezier.at(t)).collect()),
            ("quadratic", tapered_b_spline(2, rows()).into(), along(&spline(2))),
            ("cubic", tapered_b_spline(3, rows()).into(), along(&spline(3))),
            ("closed", closed(tapered_b_spline(3, rows()).into()), along(&around)),
        ];
        for (name, field, curve) in cases {
            let (program, contract) = (program(&field), analyse(&field).0.expect("sound").contract);
            assert_eq!((contract.outside, contract.inside), (Metric::Exact, Metric::Bound));
            let tolerance = TOLERANCE * curve.iter().map(|ball| ball.w).fold(0.0, f64::max);
            let Extent::Finite(aabb) = extent(&field) else { panic!("a tube is finite") };
            for ball in &curve {
                let (middle, radius) = (ball.truncate(), ball.w - tolerance);
                assert!(middle.cmpge(aabb.min + radius).all() && middle.cmple(aabb.max - radius).all(), "{name}");
            }
            for p in (0..60).map(|_| random.point(1.5)) {
                let nearest =
                    curve.iter().map(|ball| ball.truncate().distance(p) - ball.w).fold(f64::INFINITY, f64::min);
                let value = program.value(p);
                assert!((value - nearest).abs() < tolerance, "{name} {round}: {value}, not {nearest}");
            }
        }
        // Through its points, with the radius there: nothing of the ball is left out.
        let through = program(&tapered_spline(rows()).into());
        for ball in &balls {
            assert!(through.value(ball.truncate()) < -ball.w + TOLERANCE * ball.w, "{round}");
        }
    }
}

#[test]
fn radii_never_fall_below_nothing() {
    // Between two balls of radius 0 the radius of a smooth curve would swing below.
    let tips = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.2, 0.0, 0.0], [2.0, 0.0, 0.3, 0.0], [3.0, 0.0, 0.0, 1.0]];
    let program = program(&tapered_spline(tips).into());
    let least = (0..=100).map(|step| program.value(DVec3::new(1.0 + f64::from(step) / 100.0, 0.1, 0.15)));
    assert!(least.fold(f64::INFINITY, f64::min) > -0.01);
}

#[test]
fn tubes_of_one_radius_are_plain_tubes() {
    const RADIUS: f64 = 0.2;
    /// Arcs are within this share of the radius from their curve in one of both, and half as far in the other one.
    const TOLERANCE: f64 = 3e-3 * RADIUS;
    let mut random = Random::new(31);
    for _ in 0..8 {
        let points: Vec<[f64; 3]> = (0..5).map(|_| random.point(1.0).to_array()).collect();
        let balls = || points.iter().map(|[x, y, z]| [*x, *y, *z, RADIUS]);
        let weighted = || points.iter().map(|[x, y, z]| [*x, *y, *z, 0.7]);
        let plain = || points.iter().copied();
        let closed = |field: Field| field.with("closed", &[1.into()]);
        let pairs: [(Field, Field, f64); 8] = [
            (tapered_tube(balls()).into(), tube(RADIUS, plain()).into(), ROUNDING),
            (closed(tapered_tube(balls()).into()), closed(tube(RADIUS, plain()).into()), ROUNDING),
            (tapered_bezier(balls()).into(), bezier(RADIUS, plain()).into(), TOLERANCE),
            (tapered_b_spline(3, balls()).into(), b_spline(RADIUS, 3, plain()).into(), TOLERANCE),
            (closed(tapered_spline(balls()).into()), closed(spline(RADIUS, plain()).into()), TOLERANCE),
            (nurbs(RADIUS, 3, weighted()).into(), b_spline(RADIUS, 3, plain()).into(), ROUNDING),
            (closed(nurbs(RADIUS, 2, weighted()).into()), closed(b_spline(RADIUS, 2, plain()).into()), ROUNDING),
            (nurbs(RADIUS, 4, weighted()).with("knots", &[1.into()]).into(), bezier(RADIUS, plain()).into(), ROUNDING),
        ];
        for (index, (one, other, tolerance)) in pairs.into_iter().enumerate() {
            let (one, other) = (program(&one), program(&other));
            for p in (0..60).map(|_| random.point(1.5)) {
                let (found, expected) = (one.value(p), other.value(p));
                assert!((found - expected).abs() < tolerance, "{index}: {found}, not {expected} at {p}");
            }
        }
    }
}

#[test]
fn ranges_hold_all_values() {
    let mut random = Random::new(37);
    for _ in 0..12 {
        let balls: Vec<[f64; 4]> = (0..5).map(|_| ball(&mut random).to_array()).collect();
        for field in [tapered_tube(balls.clone()).into(), Field::from(tapered_spline(balls.clone()))] {
            let program = program(&field);
            for step in 0..100 {
                let (middle, half) = (random.point(1.5), 10.0_f64.powi(-(step % 7)));
                let enclosure = program.interval(middle.to_array().map(|x| Interval::new(x - half, x + half)));
                for p in (0..20).map(|_| middle + random.point(half)) {
                    let value = program.value(p);
                    assert!(enclosure.contains(value), "{value} at {p} in {enclosure:?}");
                }
                // No distance changes by more than the way there.
                let most = 6.0 * half * 3.0_f64.sqrt();
                assert!(half > 1e-3 || enclosure.width() < most.max(1e-9) * 10.0, "{enclosure:?} for {half}");
            }
        }
    }
}

#[test]
fn rational_curves_are_true_circles() {
    let w = 0.5_f64.sqrt();
    let corners = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
    let points = corners.iter().map(|&[x, y]| [f64::from(x), f64::from(y), 0.0, if x * y == 0 { 1.0 } else { w }]);
    let closed = |field: Field| field.with("closed", &[1.into()]);
    let made = closed(nurbs(0.2, 2, points).with("knots", &[1.into()]).into());
    let (made, known) = (program(&made), program(&torus(1.0, 0.2).into()));
    let mut random = Random::new(41);
    for p in (0..400).map(|_| random.point(1.6)) {
        assert!((made.value(p) - known.value(p)).abs() < 1e-9, "{p}");
    }
    // A piece of a hyperbola, whose weight in the middle is above 1, stays within its control points, and nearer to the middle one.
    let bow =
        |w: f64| program(&nurbs(0.1, 2, [[-1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, w], [1.0, 0.0, 0.0, 1.0]]).into());
    let at = |w: f64| DVec3::new(0.0, w / (1.0 + w), 0.0);
    for w in [0.2, 1.0, 5.0] {
        assert!((bow(w).value(at(w)) + 0.1).abs() < 2e-3 * 0.1, "{w}");
    }
}

#[test]
fn strokes_are_lines_along_their_paths() {
    let plane = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let mut random = Random::new(43);
    let cases: [(&str, Field, Field, f64); 5] = [
        (
            "edges",
            stroke(0.2, "M-1 0 L0 -0.5 l1 0.7").into(),
            polyline(0.2, [[-1.0, 0.0], [0.0, 0.5], [1.0, -0.2]]).into(),
            ROUNDING,
        ),
        (
            "a closed line",
            stroke(0.2, "M-1 0 L0 -0.5 H1 Z").into(),
            polyline(0.2, [[-1.0, 0.0], [0.0, 0.5], [1.0, 0.5]]).with("closed", &[1.into()]).into(),
            ROUNDING,
        ),
        ("a dot", stroke(0.4, "M0.3 -0.2 l0 0").into(), Field::from(circle(0.2)).at([0.3, 0.2, 0.0]), ROUNDING),
        (
            "two lines",
            stroke(0.2, "M-1 0 h0.5 M0.5 0 v-1").into(),
            polyline(0.2, [[-1.0, 0.0], [-0.5, 0.0]]) + polyline(0.2, [[0.5, 0.0], [0.5, 1.0]]),
            ROUNDING,
        ),
        // The picture's arcs become cubic curves first, whose error is 2.7e-4 of their radius.
        ("half a ring", stroke(0.2, "M-0.8 0 A0.8 0.8 0 0 1 0.8 0").into(), arc(0.8, 0.2, 180.0).into(), 6e-4),
    ];
    for (name, made, known, tolerance) in cases {
        let (one, other) = (program(&made), program(&known));
        for p in (0..400).map(|_| random.point(1.6) * plane(1.0, 1.0)) {
            let (found, expected) = (one.value(p), other.value(p));
            let is_bound = expected < 0.0 && found >= expected - tolerance && found <= tolerance;
            assert!(is_bound || (found - expected).abs() < tolerance, "{name} at {p}: {found}, not {expected}");
        }
    }
    let (bow, curve) = (stroke(0.1, "M0 0 Q 1 -1 2 0").into(), [plane(0.0, 0.0), plane(1.0, 1.0), plane(2.0, 0.0)]);
    let (bow, curve) = (program(&bow), Bezier::new(curve.to_vec()));
    for p in (0..200).map(|_| random.point(2.0) * plane(1.0, 1.0)) {
        let nearest = steps().map(|t| curve.at(t).distance(p)).fold(f64::INFINITY, f64::min) - 0.05;
        assert!((bow.value(p) - nearest).abs() < 2e-4, "{p}");
    }
}

#[test]
fn what_is_no_curve_is_refused() {
    let balls = |radius: f64| [[0.0, 0.0, 0.0, radius], [1.0, 0.0, 0.0, radius]];
    let pieces = |field: Field| field.with("knots", &[1.into()]);
    for (field, message) in [
        (tapered_tube(balls(0.0)).into(), "`points` of `tapered_tube` must have a radius above 0"),
        (tapered_tube(balls(-0.5)).into(), "must have radii of 0 or more, but entry 1 has -0.5"),
        (tapered_tube([[0.0, 0.0, 0.0, 1.0]]).into(), "`tapered_tube` has fewer than two points"),
        (tapered_tube([[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 2.0]]).into(), "point 1 of `tapered_tube`"),
        (tapered_spline([[0.0, 0.0, 0.0, 1.0]]).into(), "`tapered_spline` has fewer than two points"),
        (tapered_bezier([[0.0, 0.0, 0.0, 1.0]; 3]).into(), "`tapered_bezier` is a curve between two points"),
        (tapered_b_spline(3, balls(1.0)).into(), "at least 4 points"),
        (nurbs(0.1, 1, balls(0.0)).into(), "must have weights above 0, but entry 1 has 0"),
        (pieces(nurbs(0.1, 2, balls(1.0)).into()), "a multiple of 2 points and one more"),
        (stroke(0.1, "M0 0 L1 x").into(), "`d` of `stroke` is no path data"),
        (stroke(0.1, "M0 0").into(), "`d` of `stroke` draws nothing"),
    ] {
        let (analysis, diagnostics) = analyse(&field);
        assert!(analysis.is_none() && diagnostics[0].message.contains(message), "{message}: {diagnostics:?}");
    }
}

#[test]
fn joints_leave_no_gap_in_single_precision() {
    // Far from the origin of its own coordinates, where rounding moves arcs against each other.
    let far = |x: f64, y: f64, z: f64| [30.0 + x, y - 20.0, 10.0 + z];
    let points = [far(0.0, 0.0, 0.0), far(0.5, 0.7, 0.2), far(1.0, 0.0, 0.6), far(0.3, -0.6, 0.9), far(0.0, 0.2, 0.4)];
    let program = program(&spline(0.05, points).into());
    let mut random = Random::new(31);
    let middle = DVec3::new(30.5, -20.0, 10.5);
    let places: Vec<DVec3> = (0..200_000).map(|_| (middle + random.point(1.0)).as_vec3().as_dvec3()).collect();
    let [x, y, z] = [0, 1, 2].map(|axis| places.iter().map(|p| p[axis] as f32).collect::<Vec<_>>());
    let mut found = vec![0.0; places.len()];
    Evaluator::new(&program).values(Points { x: &x, y: &y, z: &z }, &mut found);
    for (p, found) in places.into_iter().zip(found) {
        let expected = program.value(p);
        assert!((f64::from(found) - expected).abs() < 3e-5, "{p}: {found}, not {expected}");
    }
}
