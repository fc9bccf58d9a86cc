//! Sweeps of figures along curves: beside points of their surfaces, found by another way of framing curves.

mod common;

use common::Random;
use freikugel_field::curve::{BSpline, Bezier};
use freikugel_field::kernel::BATCH;
use freikugel_field::shapes::*;
use freikugel_field::simd::Level;
use freikugel_field::{Encloser, Evaluator, Extent, Field, Metric, Points, Program, Structure, analyse, extent};
use glam::{DVec2, DVec3};

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

fn rows(points: &[DVec3]) -> impl Iterator<Item = [f64; 3]> {
    points.iter().map(DVec3::to_array)
}

/// Points of a curve and its directions there, close together.
fn along(at: impl Fn(f64) -> DVec3) -> Vec<[DVec3; 2]> {
    const STEPS: u32 = 1500;
    const APART: f64 = 1e-5;
    let direction = |t: f64| (at((t + APART).min(1.0)) - at((t - APART).max(0.0))).normalize();
    (0..=STEPS).map(|step| f64::from(step) / f64::from(STEPS)).map(|t| [at(t), direction(t)]).collect()
}

/// The directions of the figure's axes at each point of a curve: by two reflections from point to point (Wang, Jüttler, Zheng and
/// Liu, "Computation of rotation minimizing frames", 2008).
fn frames(curve: &[[DVec3; 2]], up: DVec3) -> Vec<[DVec3; 2]> {
    let mut x = up.cross(curve[0][1]).normalize();
    let mut frames = vec![[x, curve[0][1].cross(x)]];
    for pair in curve.windows(2) {
        let [[from, direction], [to, next]] = [pair[0], pair[1]];
        let reflected = |v: DVec3, by: DVec3| v - by * (2.0 * v.dot(by) / by.length_squared());
        let (x_there, direction_there) = (reflected(x, to - from), reflected(direction, to - from));
        x = reflected(x_there, next - direction_there);
        frames.push([x, next.cross(x)]);
    }
    frames
}

/// The corners of a figure with no symmetry, small enough for the curves.
const FIGURE: [[f64; 2]; 4] = [[-0.12, -0.08], [0.16, -0.1], [0.1, 0.02], [-0.05, 0.14]];

fn figure() -> Field {
    polygon(FIGURE).into()
}

/// The distance from the figure's border.
fn beside(q: DVec2) -> f64 {
    let corners = FIGURE.map(DVec2::from);
    let edge = |index: usize| {
        let (from, side) = (corners[index], corners[(index + 1) % corners.len()] - corners[index]);
        let share = ((q - from).dot(side) / side.length_squared()).clamp(0.0, 1.0);
        q.distance(from + side * share)
    };
    (0..corners.len()).map(edge).fold(f64::INFINITY, f64::min)
}

/// Whether a point lies in the figure, which is convex.
fn is_within(q: DVec2) -> bool {
    let corners = FIGURE.map(DVec2::from);
    (0..corners.len()).all(|index| {
        let next = corners[(index + 1) % corners.len()];
        (next - corners[index]).perp_dot(q - corners[index]) > 0.0
    })
}

fn curves(random: &mut Random) -> Vec<(&'static str, Field, Vec<[DVec3; 2]>)> {
    // Far enough apart that no curve turns more sharply than the figure is wide.
    let points: Vec<DVec3> =
        (0..5).map(|index| DVec3::new(1.4 * f64::from(index) - 2.8, 0.0, 0.0) + random.point(0.7)).collect();
    let named = |field: Field, name: usize| field.with("curve", &[(name as f64).into()]);
    let bezier = Bezier::new(points.clone());
    let spline = BSpline::clamped(3, points.clone()).expect("enough points");
    let (low, high) = spline.domain();
    let lines = [points[0], points[4]];
    vec![
        ("bezier", named(figure().sweep(rows(&points)), 2), along(|t| bezier.at(t))),
        ("b_spline", named(figure().sweep(rows(&points)), 1), along(|t| spline.at(low + (high - low) * t))),
        ("line", figure().sweep(rows(&lines)), along(|t| lines[0].lerp(lines[1], t))),
    ]
}

#[test]
fn sweeps_are_as_far_as_the_nearest_point_of_their_surfaces() {
    /// Half of the way between points of the curve, and what arcs may be away from it, with the turn that this leads to.
    const TOLERANCE: f64 = 4e-3;
    let mut random = Random::new(31);
    for _ in 0..4 {
        for (name, field, curve) in curves(&mut random) {
            let contract = analyse(&field).0.expect("sound").contract;
            assert_eq!((contract.outside, contract.inside), (Metric::Exact, Metric::Bound), "{name}");
            let frames = frames(&curve, DVec3::Z);
            let place = |index: usize, q: DVec2| curve[index][0] + frames[index][0] * q.x + frames[index][1] * q.y;
            let distance = |p: DVec3| {
                let at = |index: usize| {
                    let (r, [x, y]) = (p - curve[index][0], frames[index]);
                    let (q, height) = (DVec2::new(r.dot(x), r.dot(y)), r.dot(curve[index][1]));
                    let is_end = index == 0 || index == curve.len() - 1;
                    if is_end && is_within(q) { height.abs() } else { beside(q).hypot(height) }
                };
                (0..curve.len()).map(at).fold(f64::INFINITY, f64::min)
            };
            let Extent::Finite(aabb) = extent(&field) else { panic!("a sweep is finite") };
            let all = (0..curve.len()).flat_map(|index| FIGURE.map(|corner| place(index, corner.into())));
            let all: Vec<DVec3> = all.collect();
            let farthest = |pick: fn(DVec3, DVec3) -> DVec3| all.iter().copied().reduce(pick).expect("points");
            assert!((farthest(DVec3::min) - aabb.min).abs().max_element() < TOLERANCE, "{name}");
            assert!((farthest(DVec3::max) - aabb.max).abs().max_element() < TOLERANCE, "{name}");
            let program = program(&field);
            for _ in 0..150 {
                let p = aabb.min + (random.point(0.5) + 0.5) * aabb.size();
                let (value, truth) = (program.value(p), distance(p));
                if value > 0.0 {
                    assert!((value - truth).abs() < TOLERANCE, "{name} at {p}: {value}, not {truth}");
                }
                assert!(value.abs() < truth + TOLERANCE, "{name} at {p}: {value}, above {truth}");
            }
            for _ in 0..150 {
                let index = random.below(curve.len());
                let q = DVec2::new(random.range(-0.15, 0.2), random.range(-0.15, 0.2));
                let p = place(index, q);
                let (value, truth) = (program.value(p), distance(p));
                assert!(value.abs() < truth + TOLERANCE, "{name} at {p}: {value}, above {truth}");
                assert!(truth < TOLERANCE || (value < 0.0) == is_within(q), "{name} at {p}: {value}");
            }
        }
    }
}

#[test]
fn closed_sweeps_of_circles_are_tubes() {
    /// What arcs may be away from their curve for either.
    const TOLERANCE: f64 = 1e-3;
    let points = [[1.0, 0.0, 0.2], [0.0, 1.2, 0.2], [-1.0, 0.2, 0.2], [-0.2, -0.9, 0.2]];
    let made = program(&circle(0.15).sweep(points).with("closed", &[1.into()]));
    let tube = program(&Field::from(spline(0.15, points)).with("closed", &[1.into()]));
    let mut random = Random::new(5);
    for _ in 0..20_000 {
        let p = random.point(1.6);
        let (made, tube) = (made.value(p), tube.value(p));
        assert!((made - tube).abs() < TOLERANCE, "{p}: {made}, not {tube}");
    }
}

#[test]
fn joints_of_sweeps_leave_no_gap_in_single_precision() {
    let mut random = Random::new(77);
    for (name, field, curve) in curves(&mut random) {
        let points: Vec<DVec3> = curve.iter().map(|[at, _]| *at).collect();
        // So far from the ends that their depth is that of the figure: of how far away ends are, a tenth is known at least.
        let points = &points[200..points.len() - 200];
        let program = program(&field);
        let [x, y, z] = [0, 1, 2].map(|axis| points.iter().map(|point| point[axis] as f32).collect::<Vec<f32>>());
        let mut values = vec![0.0; points.len()];
        Evaluator::new(&program).values(Points { x: &x, y: &y, z: &z }, &mut values);
        // The point of the figure at the curve is well within.
        let most = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        assert!(most < -0.02, "{name}: {most}");
    }
}

#[test]
fn sweeps_along_perimeters_are_what_else_makes_the_same_body() {
    const ROUNDING: f64 = 1e-9;
    let polygon = figure().scale(2.0);
    let corners = [[0.9, 0.6, 0.0], [-0.9, 0.6, 0.0], [-0.9, -0.6, 0.0], [0.9, -0.6, 0.0]];
    let tube = Field::from(tube(0.2, corners)).with("closed", &[1.into()]);
    let turned = polygon.clone().revolve().with("offset", &[0.7.into()]);
    let cases = [
        ("around a circle", polygon.perimeter_sweep(circle(0.7)), turned),
        ("around a rectangle", circle(0.2).perimeter_sweep(rectangle(1.8, 1.2)), tube),
        ("a range of distances", rectangle(0.4, 0.6).perimeter_sweep(circle(0.7)), tube_of(0.5, 0.9, 0.6)),
    ];
    let mut random = Random::new(12);
    for (name, made, other) in cases {
        let contract = analyse(&made).0.expect("sound").contract;
        assert_eq!((contract.outside, contract.inside, contract.lipschitz), (Metric::Bound, Metric::Bound, Some(1.0)));
        let (Extent::Finite(a), Extent::Finite(b)) = (extent(&made), extent(&other)) else {
            panic!("{name} is finite")
        };
        assert!(
            (a.min - b.min).abs().max_element() < ROUNDING && (a.max - b.max).abs().max_element() < ROUNDING,
            "{name}"
        );
        let (made, other) = (program(&made), program(&other));
        for _ in 0..5000 {
            let p = random.point(1.5);
            let (made, other) = (made.value(p), other.value(p));
            // Around the corners of the rectangle the tube is a ball within as well.
            assert!((made - other).abs() < ROUNDING || other < 0.0 && made < 0.0, "{name} at {p}: {made}, not {other}");
        }
    }
}

/// What a rectangle turns into around the z axis.
fn tube_of(inner: f64, outer: f64, height: f64) -> Field {
    let middle = (inner + outer) / 2.0;
    rectangle(outer - inner, height).revolve().with("offset", &[middle.into()])
}

#[test]
fn enclosures_along_straight_edges_are_narrow() {
    /// Of a stretch, half of it.
    const SHORT: f32 = 1e-4;
    let square = outline([vec![[-0.1, -0.1, 0.0], [0.1, -0.1, 0.0], [0.1, 0.1, 0.0], [-0.1, 0.1, 0.0]]]);
    let line = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    for field in [tube(0.1, line).into(), circle(0.1).sweep(line), square.extrude(4.0)] {
        let program = program(&field);
        let mut encloser = Encloser::new(&program, Level::baseline());
        // Out of it all, beside it, at its end, and beyond that.
        for [x, y, z] in [[0.3, 0.5, 0.1], [1.0, 0.5, 0.1], [1.1, 0.5, -0.2], [0.5, 0.0, 2.0], [0.3, 0.3, 2.3]] {
            let distance = program.value([x, y, z].map(f64::from).into()) as f32;
            let zeros = encloser.models(program.whole(), BATCH, |stretches| {
                stretches.origin.into_iter().zip([x, y, z]).for_each(|(lane, value)| lane.fill(value));
                stretches.direction.into_iter().zip([0.6, 0.0, 0.8]).for_each(|(lane, value)| lane.fill(value));
                stretches.middle.fill(0.0);
                stretches.half.fill(SHORT);
            });
            let (value, bound) = (zeros.first.p[0][0], zeros.first.r[0]);
            assert!((value - distance).abs() < 2.0 * SHORT && bound < 3.0 * SHORT, "{value}, not {distance}; {bound}");
        }
    }
}

#[test]
fn sweeps_that_cannot_be_are_refused() {
    let refused = |field: &Field, part: &str| {
        let messages: Vec<String> = analyse(field).1.into_iter().map(|d| d.message).collect();
        assert!(messages.iter().any(|message| message.contains(part)), "{part}: {messages:?}");
    };
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.5], [1.0, 1.0, -0.2], [0.0, 1.0, 0.9], [-0.5, 0.3, 0.6]];
    refused(&figure().sweep([[0.0, 0.0, 0.0]]), "fewer than two points");
    refused(&figure().sweep([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]), "point 1 of `sweep` and the next one are the same");
    refused(&figure().sweep(points).with("closed", &[1.into()]), "comes back turned by");
    refused(&figure().sweep(points).with("closed", &[1.into()]).with("curve", &[2.into()]), "can't be closed");
    refused(&sphere(1.0).sweep(points), "takes a plane figure");
    refused(&sphere(1.0).perimeter_sweep(circle(1.0)), "takes plane figures, not bodies");
    let three = Field::new(&PERIMETER_SWEEP, [], [circle(1.0), circle(0.1), circle(0.2)].map(Field::from));
    refused(&three, "takes two figures, not 3");
    refused(&figure().scale(10.0).sweep(points), "turns too sharply for its figure");
}
