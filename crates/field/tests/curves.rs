//! Tubes whose radius changes, tubes along rational curves, and lines along paths: beside the points of their curves.

mod common;

use common::{Random, ranges_hold};
use freikugel_field::curve::{BSpline, Bezier};
use freikugel_field::shapes::*;
use freikugel_field::{Evaluator, Extent, Field, Metric, Points, Program, Structure, analyse, extent};
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
            // No distance changes by more than the way there.
            let widest = |half: f64| (6.0 * half * 3.0_f64.sqrt()).max(1e-9) * 10.0;
            ranges_hold(&program, 100, widest, &mut random);
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

/// The control points that count at `u`, by de Boor's recursion over pairs of them, in its textbook form.
fn de_boor(degree: usize, knots: &[f64], points: &[DVec4], u: f64) -> DVec4 {
    fn point(degree: usize, knots: &[f64], points: &[DVec4], u: f64, round: usize, index: usize) -> DVec4 {
        if round == 0 {
            return points[index];
        }
        let (low, high) = (knots[index], knots[index + degree + 1 - round]);
        let share = (u - low) / (high - low);
        point(degree, knots, points, u, round - 1, index - 1) * (1.0 - share)
            + point(degree, knots, points, u, round - 1, index) * share
    }
    let last = points.len() - 1;
    let piece = (degree..=last).rev().find(|&piece| knots[piece] <= u && knots[piece] < knots[piece + 1]);
    point(degree, knots, points, u, degree, piece.expect("within the domain"))
}

#[test]
fn uneven_knots_are_those_of_de_boor() {
    const RADIUS: f64 = 0.2;
    /// Arcs are within 2e-3 of the radius from their curve at the places where they are compared, and hardly more between these.
    const TOLERANCE: f64 = 1.5 * 2e-3 * RADIUS;
    let mut random = Random::new(53);
    // Clamped, with a knot of several; not clamped; and with one as often as the degree, at a corner.
    let cases: [(usize, &[f64], bool); 5] = [
        (3, &[0.0, 0.0, 0.0, 0.0, 0.1, 0.7, 1.0, 1.0, 1.0, 1.0], false),
        (2, &[-1.0, 0.0, 0.5, 0.6, 2.0, 2.5, 3.0, 5.0, 5.5], false),
        (3, &[0.0, 0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0], false),
        (2, &[0.0, 0.3, 1.0, 1.1, 3.0, 3.0, 4.0], true),
        (3, &[2.0, 2.3, 3.0, 3.1, 5.0, 6.0, 7.5], true),
    ];
    for (degree, knots, is_closed) in cases {
        let count = if is_closed { knots.len() - 1 } else { knots.len() - degree - 1 };
        let balls: Vec<DVec4> = (0..count).map(|_| random.point(1.0).extend(random.range(0.3, 2.0))).collect();
        let weighted: Vec<DVec4> = balls.iter().map(|ball| (ball.truncate() * ball.w).extend(ball.w)).collect();
        // Those of three rounds, of which the middle one is the domain.
        let round = knots[knots.len() - 1] - knots[0];
        let rounds = [-round, 0.0, round].map(|from| knots[..knots.len() - 1].iter().map(move |knot| knot + from));
        let (all, domain): (Vec<f64>, [f64; 2]) = match is_closed {
            true => (rounds.into_iter().flatten().skip(count - degree).collect(), [knots[0], knots[count]]),
            false => (knots.to_vec(), [knots[degree], knots[count]]),
        };
        let around = |points: &[DVec4]| -> Vec<DVec4> {
            points.iter().chain(points.iter().take(if is_closed { degree } else { 0 })).copied().collect()
        };
        let curve = |points: &[DVec4]| -> Vec<DVec4> {
            let points = around(points);
            let all = &all[..points.len() + degree + 1];
            // Short of the end, which the piece before it holds.
            steps()
                .map(|share| domain[0] + (domain[1] - domain[0]) * share * (1.0 - 1e-12))
                .map(|u| de_boor(degree, all, &points, u))
                .collect()
        };
        let closed = |field: Field| field.with("closed", &[i32::from(is_closed).into()]);
        let degree = degree as u32;
        let plain =
            b_spline(RADIUS, degree, balls.iter().map(|b| b.truncate().to_array())).knots(knots.iter().copied());
        let rational = nurbs(RADIUS, degree, balls.iter().map(DVec4::to_array)).knots(knots.iter().copied());
        let tapered =
            tapered_b_spline(degree, balls.iter().map(|b| (*b / 4.0).to_array())).knots(knots.iter().copied());
        let quarter: Vec<DVec4> = balls.iter().map(|ball| *ball / 4.0).collect();
        let project = |points: Vec<DVec4>| points.into_iter().map(|p| p.truncate() / p.w).collect::<Vec<_>>();
        let drop_weights = |points: Vec<DVec4>| points.into_iter().map(DVec4::truncate).collect::<Vec<_>>();
        for (name, field, axis) in [
            ("b_spline", closed(plain.into()), drop_weights(curve(&balls))),
            ("nurbs", closed(rational.into()), project(curve(&weighted))),
        ] {
            let program = program(&field);
            for point in axis.iter().step_by(7) {
                let off = program.value(*point) + RADIUS;
                assert!(off.abs() < TOLERANCE, "{name} {knots:?}: {off} at {point}");
            }
            for p in (0..100).map(|_| random.point(1.5)) {
                let nearest = axis.iter().map(|point| point.distance(p)).fold(f64::INFINITY, f64::min) - RADIUS;
                let found = program.value(p);
                assert!((found - nearest).abs() < TOLERANCE, "{name} {knots:?} at {p}: {found}, not {nearest}");
            }
        }
        let (axis, program) = (curve(&quarter), program(&closed(tapered.into())));
        let widest = axis.iter().map(|ball| ball.w).fold(0.0, f64::max);
        for p in (0..100).map(|_| random.point(0.5)) {
            let nearest = axis.iter().map(|ball| ball.truncate().distance(p) - ball.w).fold(f64::INFINITY, f64::min);
            let found = program.value(p);
            assert!((found - nearest).abs() < 2e-3 * widest, "tapered {knots:?} at {p}: {found}, not {nearest}");
        }
    }
}

#[test]
fn knots_that_are_written_out_are_those_that_have_names() {
    let mut random = Random::new(59);
    let points: Vec<[f64; 3]> = (0..7).map(|_| random.point(1.0).to_array()).collect();
    let made = || b_spline(0.2, 3, points.iter().copied());
    let pairs: [(Field, Field); 3] = [
        (made().into(), made().knots([1, 1, 1, 1, 3, 5, 7, 9, 9, 9, 9]).into()),
        (made().with("knots", &[1.into()]).into(), made().knots([0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2]).into()),
        (
            Field::from(made()).with("closed", &[1.into()]),
            Field::from(made().knots([0, 2, 4, 6, 8, 10, 12, 14])).with("closed", &[1.into()]),
        ),
    ];
    for (index, (named, listed)) in pairs.into_iter().enumerate() {
        let (named, listed) = (program(&named), program(&listed));
        for p in (0..200).map(|_| random.point(1.5)) {
            assert!((named.value(p) - listed.value(p)).abs() < ROUNDING, "{index} at {p}");
        }
    }
    // Knots may be changed again.
    let changed = made().knots([0, 0, 0, 0, 1, 2, 8, 9, 9, 9, 9]).knots([1, 1, 1, 1, 3, 5, 7, 9, 9, 9, 9]).into();
    assert!((program(&changed).value(DVec3::ONE) - program(&made().into()).value(DVec3::ONE)).abs() < ROUNDING);
}

#[test]
fn what_is_no_curve_is_refused() {
    let balls = |radius: f64| [[0.0, 0.0, 0.0, radius], [1.0, 0.0, 0.0, radius]];
    let pieces = |field: Field| field.with("knots", &[1.into()]);
    let line = || b_spline(0.1, 2, [[0, 0, 0], [1, 0, 0], [2, 1, 0], [3, 1, 1]]);
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
        (line().knots([0, 1, 2]).into(), "`b_spline`: a spline of degree 2 with 4 points has 7 knots, not 3"),
        (line().knots([0, 0, 0, 2, 1, 3, 3]).into(), "`knots` of `b_spline` must not fall, but entry 5 is 1 after 2"),
        (line().knots([0, 0, 0, 0, 1, 1, 1]).into(), "`b_spline`: a spline of degree 2 has no knot more than 3 times"),
        (line().knots([0, 1, 2, 2, 2, 3, 4]).into(), "nothing lies between"),
        (line().with("knots", &[0.5.into()]).into(), "`knots` of `b_spline` must be a name or a list of numbers"),
        (line().with("knots", &[9e99.into()]).into(), "`b_spline` needs `knots`"),
        (line().with("closed", &[1.into()]).knots([0, 1, 2]).into(), "with 4 points has 5 knots, not 3"),
        (line().with("closed", &[1.into()]).knots([0, 1, 1, 1, 4]).into(), "has no knot more than 2 times"),
        (nurbs(0.1, 1, balls(1.0)).knots([0.0, 1.0]).into(), "`nurbs`: a spline of degree 1 with 2 points has 4 knots"),
        (tapered_b_spline(1, balls(1.0)).knots([3, 2, 1, 0]).into(), "`knots` of `tapered_b_spline` must not fall"),
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
