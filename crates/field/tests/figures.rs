//! Plane figures and what is made of them, and maps of space: beside shapes that are the same by another way.

mod common;

use common::Random;
use freikugel_field::curve::{BSpline, Bezier};
use freikugel_field::shapes::*;
use freikugel_field::{
    Dimension, Extent, Field, Interval, Metric, Program, Severity, Structure, analyse, analyse_body, extent,
};
use glam::DVec3;

/// Rounding errors of a few operations on numbers of this size.
const ROUNDING: f64 = 1e-12;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

/// Pairs of the same distance by two ways.
fn pairs() -> Vec<(&'static str, Field, Field)> {
    let moved = |x: f64, y: f64| sphere(0.4).at([x, y, 0.3]);
    let figure = || rectangle(0.5, 0.7).at([0.1, 0.4, 0.0]);
    vec![
        ("an extruded circle", circle(0.7).extrude(1.2), cylinder(0.7, 1.2).into()),
        ("an extruded rectangle", rectangle(1.4, 0.6).extrude(1.1), cuboid([1.4, 0.6, 1.1]).into()),
        (
            "an extruded circle with round edges",
            circle(0.7).extrude(1.2).with("round", &[0.2.into()]),
            cylinder(0.7, 1.2).round(0.2).into(),
        ),
        (
            "an extruded rectangle with round edges and corners",
            rectangle(1.4, 0.8).round(0.2).extrude(1.1).with("round", &[0.2.into()]),
            cuboid([1.4, 0.8, 1.1]).round(0.2).into(),
        ),
        (
            "an extruded square that was turned and moved",
            rectangle(1.0, 1.0).rotate([0.0, 0.0, 1.0], 30.0).at([0.3, -0.2, 0.0]).extrude(0.5),
            cuboid([1.0, 1.0, 0.5]).rotate([0.0, 0.0, 1.0], 30.0).at([0.3, -0.2, 0.0]),
        ),
        (
            "an extruded circle that was scaled, in another place",
            circle(0.5).scale(1.5).extrude(0.8).rotate([1.0, 1.0, 0.0], 50.0).at([0.1, 0.2, 0.3]),
            cylinder(0.75, 0.8).rotate([1.0, 1.0, 0.0], 50.0).at([0.1, 0.2, 0.3]),
        ),
        ("a revolved circle", circle(0.3).revolve().with("offset", &[0.9.into()]), torus(0.9, 0.3).into()),
        ("a revolved rectangle on the axis", rectangle(1.4, 0.8).revolve(), cylinder(0.7, 0.8).into()),
        (
            "an extruded and a revolved union",
            (figure() + figure().at([0.4, 0.3, 0.0])).extrude(0.6),
            figure().extrude(0.6) + figure().extrude(0.6).at([0.4, 0.3, 0.0]),
        ),
        (
            "four spheres",
            moved(0.6, 0.5).symmetric("xy"),
            moved(0.6, 0.5) + moved(-0.6, 0.5) + moved(0.6, -0.5) + moved(-0.6, -0.5),
        ),
        (
            "a longer sphere",
            sphere(0.4).elongate([1.2, 0.0, 0.0]),
            capsule([-0.6, 0.0, 0.0], [0.6, 0.0, 0.0], 0.4).into(),
        ),
        ("a sphere made a box", sphere(0.2).elongate([1.0, 0.6, 0.8]), cuboid([1.4, 1.0, 1.2]).round(0.2).into()),
    ]
}

#[test]
fn figures_become_the_bodies_they_should() {
    let mut random = Random::new(3);
    for (name, made, known) in pairs() {
        let (one, other) = (program(&made), program(&known));
        for p in (0..400).map(|_| random.point(1.6)) {
            let (found, expected) = (one.value(p), other.value(p));
            // Elongated shapes fall short of the distance inside.
            let is_bound = analyse(&made).0.expect("sound").contract.inside != Metric::Exact && expected < 0.0;
            if is_bound {
                assert!(found <= ROUNDING && found >= expected - ROUNDING, "{name} at {p}: {found}, {expected}");
            } else {
                assert!((found - expected).abs() < ROUNDING, "{name} at {p}: {found}, not {expected}");
            }
        }
        let (Extent::Finite(one), Extent::Finite(other)) = (extent(&made), extent(&known)) else {
            panic!("{name} has an end");
        };
        let gap = (one.min - other.min).abs().max((one.max - other.max).abs()).max_element();
        assert!(gap < 1e-9, "{name}: {one:?}, not {other:?}");
    }
}

#[test]
fn contracts_say_how_much_is_exact() {
    let contract = |field: Field| analyse(&field).0.expect("a sound field").contract;
    let exact = |field: Field| {
        let contract = contract(field);
        (contract.outside, contract.inside) == (Metric::Exact, Metric::Exact)
    };
    assert!(exact(circle(1.0).into()) && exact(circle(1.0).extrude(1.0)));
    assert!(exact(circle(0.3).revolve().with("offset", &[0.5.into()])));
    assert!(!exact(circle(0.3).revolve().with("offset", &[0.2.into()])), "it crosses the axis");
    assert!(exact(sphere(0.3).at([0.5, 0.0, 0.0]).symmetric("x")));
    assert!(!exact(sphere(0.3).at([0.5, 0.0, 0.0]).symmetric("y")), "it crosses the fold");
    assert!(!exact(sphere(0.3).elongate([1.0, 0.0, 0.0])));
    assert!(exact(sphere(0.3).elongate([0.0, 0.0, 0.0])));
    for figure in
        [circle(1.0).into(), rectangle(1.0, 2.0) + circle(0.5), circle(0.4).at([0.5, 0.0, 0.0]).symmetric("x")]
    {
        assert_eq!(contract(figure.clone()).dimension, Dimension::Plane);
        assert_eq!(contract(figure.extrude(1.0)).dimension, Dimension::Space);
    }
}

#[test]
fn figures_and_bodies_do_not_mix() {
    let tilted = || circle(1.0).rotate([1.0, 0.0, 0.0], 20.0);
    for (field, message) in [
        (circle(1.0) + sphere(1.0), "either plane figures or bodies"),
        (sphere(1.0).extrude(1.0), "`extrude` takes a plane figure"),
        (sphere(1.0).revolve(), "`revolve` takes a plane figure"),
        (circle(1.0).extrude(1.0).extrude(1.0), "`extrude` takes a plane figure"),
        (tilted().extrude(1.0), "`rotate` takes a plane figure out of its plane"),
        (circle(1.0).at([0.0, 0.0, 0.5]).extrude(1.0), "`translate` takes a plane figure out of its plane"),
        (circle(1.0).twist(20.0), "`twist` takes a body"),
        (circle(1.0).warp(["x", "y", "z"]), "`warp` takes a body"),
        (rectangle(1.0, 1.0).extrude(1.0).with("round", &[0.6.into()]), "half the height"),
        (sphere(1.0).elongate([1.0, -1.0, 0.0]), "must not be negative"),
    ] {
        let (analysis, diagnostics) = analyse(&field);
        assert!(analysis.is_none(), "{message}");
        let errors: Vec<_> = diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error).collect();
        assert!(errors.iter().any(|error| error.message.contains(message)), "{message}: {errors:?}");
    }
    let (analysis, diagnostics) = analyse_body(&circle(1.0).into());
    assert!(analysis.is_none() && diagnostics[0].message.contains("has no height"), "{diagnostics:?}");
    assert!(analyse_body(&circle(1.0).extrude(1.0)).0.is_some());
    // Turns within the plane are allowed, and so are half turns out of it and back.
    for axis in [[0.0, 0.0, 1.0], [0.0, 0.0, -2.0]] {
        assert!(analyse(&circle(1.0).rotate(axis, 33.0).extrude(1.0)).0.is_some());
    }
    assert!(analyse(&circle(1.0).rotate([1.0, 0.0, 0.0], 180.0).extrude(1.0)).0.is_some());
}

#[test]
fn copies_are_unions_of_what_they_copy() {
    let child = || cuboid([0.3, 0.5, 0.7]).at([0.4, 0.1, 0.2]).rotate([1.0, 2.0, 0.5], 30.0);
    let grid = || {
        (0..2).flat_map(|z| (0..4).flat_map(move |y| (0..3).map(move |x| [x, y, z]))).map(|at: [u32; 3]| {
            let place = |axis: usize, spacing: f64, count: f64| spacing * (f64::from(at[axis]) - (count - 1.0) / 2.0);
            // Cells are smaller than the shape, and one axis runs backwards.
            child().at([place(0, 0.3, 3.0), place(1, -0.8, 4.0), place(2, 0.5, 2.0)])
        })
    };
    let turned = |index: u32, step: f64, rise: f64| {
        child().rotate([0.0, 1.0, 0.0], step * f64::from(index)).at([0.0, rise * f64::from(index), 0.0])
    };
    let helix = child().repeat_polar(9).with("step", &[25f64.to_radians().into()]).with("rise", &[0.15.into()]);
    let even = child().repeat_polar(7).with("axis", &[1.into()]);
    let cases: [(Field, Field); 3] = [
        (child().repeat([0.3, -0.8, 0.5], [3, 4, 2]), union(grid())),
        (helix.with("axis", &[1.into()]), union((0..9).map(|index| turned(index, 25.0, 0.15)))),
        (even, union((0..7).map(|index| turned(index, 360.0 / 7.0, 0.0)))),
    ];
    let mut random = Random::new(8);
    for (made, known) in cases {
        let (one, other) = (program(&made), program(&known));
        for p in (0..300).map(|_| random.point(2.5)) {
            assert!((one.value(p) - other.value(p)).abs() < ROUNDING, "{p}");
        }
        assert_eq!(extent(&made), extent(&known));
        // New numbers move the copies; another count needs other steps.
        let structure = Structure::compile(std::slice::from_ref(&made)).expect("sound");
        let mut values = structure.values().to_vec();
        *values.last_mut().expect("numbers") *= 1.1;
        assert!(structure.bind(&values, DVec3::ZERO).is_ok());
    }
    let many = sphere(0.1).repeat([1.0; 3], [100, 100, 100]);
    let (analysis, diagnostics) = analyse(&many);
    assert!(analysis.is_none() && diagnostics[0].message.contains("1000000 copies"), "{diagnostics:?}");
}

#[test]
fn mirrored_cells_are_folded_one_by_one() {
    let child = || sphere(0.3).at([0.15, -0.1, 0.05]) + cuboid([0.2, 0.9, 0.1]);
    let made = program(&child().repeat_mirrored([1.0, 0.0, 1.5]));
    let known = program(&child());
    let mut random = Random::new(21);
    for p in (0..500).map(|_| random.point(6.0)) {
        // Walls are crossed one after another.
        let mut q = p;
        for (axis, edge) in [(0, 1.0), (2, 1.5)] {
            while q[axis].abs() > edge / 2.0 {
                q[axis] = f64::copysign(edge, q[axis]) - q[axis];
            }
        }
        assert!((made.value(p) - known.value(q)).abs() < 1e-12, "{p}");
    }
}

#[test]
fn sides_of_polygons_are_known_at_the_height_of_their_corners() {
    // A half-line through a corner crosses two edges at once, or none, which enclosures can't tell.
    let field: Field = polygon([[-1.0, -1.0], [2.0, -1.0], [2.0, 1.0], [0.5, 0.0], [-1.0, 1.0]]).into();
    let program = program(&field);
    let half = 1e-6;
    let around = |x: f64| Interval::new(x - half, x + half);
    for at in [[-2.0, 1.0], [0.7, 0.5], [-1.5, 0.0], [1.7, 0.0], [0.5, -0.7], [0.5, 2.0], [3.0, -0.7], [-3.0, -1.0]] {
        let enclosure = program.interval([around(at[0]), around(at[1]), around(0.0)]);
        let value = program.value(DVec3::new(at[0], at[1], 0.0));
        assert!(enclosure.contains(value) && enclosure.width() < 10.0 * half, "{at:?}: {enclosure:?}, {value}");
    }
}

#[test]
fn corners_of_solids_lie_on_them_and_are_their_outermost_points() {
    let signs = || [1.0, -1.0].into_iter();
    let all_signs = move |x: f64, y: f64, z: f64| {
        signs().flat_map(move |a| signs().flat_map(move |b| signs().map(move |c| DVec3::new(a * x, b * y, c * z))))
    };
    let turned = |p: DVec3| [p, DVec3::new(p.y, p.z, p.x), DVec3::new(p.z, p.x, p.y)];
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let cube: Vec<DVec3> = all_signs(1.0, 1.0, 1.0).collect();
    let solids: [(Field, Vec<DVec3>); 4] = [
        (tetrahedron(1.3).into(), cube.iter().copied().filter(|p| p.x * p.y * p.z > 0.0).collect()),
        (
            dodecahedron(1.3).into(),
            cube.iter().copied().chain(all_signs(0.0, 1.0 / golden, golden).flat_map(turned)).collect(),
        ),
        (icosahedron(1.3).into(), all_signs(0.0, 1.0, golden).flat_map(turned).collect()),
        (
            truncated_octahedron(1.3 * 2.0 / 5f64.sqrt()).into(),
            all_signs(0.0, 1.0, 2.0).flat_map(|p| [p, DVec3::new(p.x, p.z, p.y)]).flat_map(turned).collect(),
        ),
    ];
    let mut random = Random::new(5);
    for (field, corners) in solids {
        let program = program(&field);
        let name = field.node().shape.about.name;
        let corners: Vec<DVec3> = corners.into_iter().map(|corner| corner.normalize() * 1.3).collect();
        for &corner in &corners {
            assert!(program.value(corner).abs() < ROUNDING, "{name}: {corner}");
            // Straight out from a corner nothing else is nearer.
            assert!((program.value(corner * 1.5) - 0.65).abs() < ROUNDING, "{name}: {corner}");
        }
        // The hull of the corners holds all points of the solid and no others.
        for p in (0..500).map(|_| random.point(1.4)) {
            let direction = p.normalize();
            let is_beyond = corners.iter().all(|corner| corner.dot(direction) < p.dot(direction));
            assert!(!is_beyond || program.value(p) > 0.0, "{name}: {p}");
        }
        for _ in 0..500 {
            let shares: Vec<f64> = corners.iter().map(|_| random.unit().powi(6)).collect();
            let inside = corners.iter().zip(&shares).map(|(c, s)| *c * *s).sum::<DVec3>() / shares.iter().sum::<f64>();
            assert!(program.value(inside) < ROUNDING, "{name}: {inside}");
        }
    }
}

#[test]
fn outlines_are_as_far_as_the_nearest_of_their_points() {
    /// So many points along each edge, none of which is longer than this.
    const STEPS: u32 = 4000;
    const LONGEST: f64 = 16.0;
    let mut random = Random::new(77);
    for round in 0..60 {
        let count = 2 + random.below(5);
        let mut line: Vec<[f64; 3]> =
            (0..count).map(|_| [random.range(-1.0, 1.0), random.range(-1.0, 1.0), random.range(-5.0, 5.0)]).collect();
        // Half of all edges are straight, and some all but straight.
        line.iter_mut().for_each(|corner| corner[2] *= [0.0, 0.0, 1e-6, 1.0, 1.0, 1.0][random.below(6)]);
        line[0][2] = random.range(0.5, 3.0);
        let field: Field = outline([line.clone(), vec![[-0.2, 0.1, 3.0], [0.3, 0.0, -2.0]]]).into();
        let program = program(&field);
        let points: Vec<DVec3> = [line, vec![[-0.2, 0.1, 3.0], [0.3, 0.0, -2.0]]]
            .iter()
            .flat_map(|line| {
                (0..line.len()).flat_map(|index| {
                    let ([ax, ay, turn], [bx, by, _]) = (line[index], line[(index + 1) % line.len()]);
                    (0..=STEPS).map(move |step| {
                        // Along an arc the direction turns evenly from the chord's, less half of the turn.
                        let (share, chord) = (f64::from(step) / f64::from(STEPS), DVec3::new(bx - ax, by - ay, 0.0));
                        let part = if turn == 0.0 { share } else { (turn * share / 2.0).sin() / (turn / 2.0).sin() };
                        DVec3::new(ax, ay, 0.0)
                            + glam::DQuat::from_rotation_z(turn * (share - 1.0) / 2.0) * chord * part
                    })
                })
            })
            .collect();
        for _ in 0..20 {
            let p = random.point(1.5) * DVec3::new(1.0, 1.0, 0.0);
            let nearest = points.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
            let value = program.value(p);
            // The foot lies within a step of the nearest of these points, along the line at a right angle to the way there.
            let excess = nearest.powi(2) - value.powi(2);
            let step = LONGEST / f64::from(STEPS);
            assert!((-ROUNDING..step * step).contains(&excess), "round {round}: {value}, not {nearest}");
        }
    }
}

#[test]
fn sides_of_outlines_are_right_at_the_height_of_corners_and_on_chords() {
    let circle = |turn: f64| outline([vec![[-1.0, 0.0, turn], [1.0, 0.0, turn]]]);
    for turn in [std::f64::consts::PI, -std::f64::consts::PI] {
        let program = program(&circle(turn).into());
        // All on the chord or at the height of corners, where a half-line meets two edges at once.
        for x in [-1.5, -0.9, -0.1, 0.0, 0.5, 0.99, 1.2] {
            let value = program.value(DVec3::new(x, 0.0, 0.0));
            assert!((value - (x.abs() - 1.0)).abs() < ROUNDING, "{x}: {value}");
            let value = program.value(DVec3::new(0.0, x, 0.0));
            assert!((value - (x.abs() - 1.0)).abs() < ROUNDING, "{x}: {value}");
        }
    }
    // Four arcs on a square, on whose edges and diagonals points lie; two of them dents.
    let quarter = std::f64::consts::FRAC_PI_2;
    let corners = vec![[-1.0, -1.0, quarter], [1.0, -1.0, -quarter], [1.0, 1.0, quarter], [-1.0, 1.0, -quarter]];
    let program = program(&outline([corners]).into());
    let depth = 2f64.sqrt() - 1.0;
    for (at, value) in [
        ([0.0, -1.0], -depth),
        ([0.0, 1.0], -depth),
        ([1.0, 0.0], depth),
        ([-1.0, 0.0], depth),
        ([0.0, -1.0 - depth], 0.0),
        ([1.0 - depth, 0.0], 0.0),
    ] {
        let found = program.value(DVec3::new(at[0], at[1], 0.0));
        assert!((found - value).abs() < ROUNDING, "{at:?}: {found}, not {value}");
    }
}

#[test]
fn outlines_that_make_no_figure_are_refused() {
    for (corners, message) in [
        (vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], "fewer than three corners has no arc"),
        (
            vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
            "corner 2 of `outline` and the next one are the same",
        ),
        (vec![[0.0, 0.0, 6.3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], "less than 360 degrees"),
    ] {
        let (analysis, diagnostics) = analyse(&outline([corners]).into());
        assert!(analysis.is_none() && diagnostics[0].message.contains(message), "{diagnostics:?}");
    }
}

#[test]
fn tubes_are_as_far_as_the_nearest_points_of_their_curves() {
    const RADIUS: f64 = 0.2;
    /// So much the arcs may be away from their curve, as a share of the radius; and the steps along the curve.
    const TOLERANCE: f64 = 2.5e-3 * RADIUS;
    const STEPS: u32 = 4000;
    let mut random = Random::new(19);
    for round in 0..12 {
        let points: Vec<DVec3> = (0..4 + round % 3).map(|_| random.point(1.0)).collect();
        let rows = || points.iter().map(DVec3::to_array);
        let spline = |degree: usize, closed: bool| {
            if closed { BSpline::closed(degree, &points) } else { BSpline::clamped(degree, points.clone()) }
                .expect("enough points")
        };
        let bezier = Bezier::new(points.clone());
        let along = |spline: BSpline<DVec3>| {
            let (low, high) = spline.domain();
            (0..=STEPS).map(|step| spline.at(low + (high - low) * f64::from(step) / f64::from(STEPS))).collect()
        };
        let cases: [(&str, Field, Vec<DVec3>); 4] = [
            (
                "bezier",
                bezier_of(RADIUS, rows()),
                (0..=STEPS).map(|step| bezier.at(f64::from(step) / f64::from(STEPS))).collect(),
            ),
            ("quadratic", b_spline(RADIUS, 2, rows()).into(), along(spline(2, false))),
            ("cubic", b_spline(RADIUS, 3, rows()).into(), along(spline(3, false))),
            ("closed", b_spline(RADIUS, 3, rows()).with("closed", &[1.into()]).into(), along(spline(3, true))),
        ];
        for (name, field, curve) in cases {
            let (program, contract) = (program(&field), analyse(&field).0.expect("sound").contract);
            assert_eq!((contract.outside, contract.inside), (Metric::Exact, Metric::Bound));
            let Extent::Finite(aabb) = extent(&field) else { panic!("a tube is finite") };
            for p in &curve {
                assert!(p.cmpge(aabb.min + RADIUS - TOLERANCE).all() && p.cmple(aabb.max - RADIUS + TOLERANCE).all());
            }
            for p in (0..60).map(|_| random.point(1.5)) {
                let nearest = curve.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min) - RADIUS;
                let value = program.value(p);
                assert!((value - nearest).abs() < 2.0 * TOLERANCE, "{name} {round}: {value}, not {nearest}");
            }
        }
        // Through its points, smoothly: all of them lie in the middle of the tube.
        let through = program(&spline_of(RADIUS, rows()));
        for p in &points {
            assert!((through.value(*p) + RADIUS).abs() < TOLERANCE, "{round}");
        }
    }
}

fn bezier_of(radius: f64, points: impl Iterator<Item = [f64; 3]>) -> Field {
    bezier(radius, points).into()
}

fn spline_of(radius: f64, points: impl Iterator<Item = [f64; 3]>) -> Field {
    spline(radius, points).into()
}

#[test]
fn curves_that_are_none_are_refused() {
    for (field, message) in [
        (bezier_of(0.1, [[0.0; 3]].into_iter()), "between two points"),
        (bezier_of(0.1, [[0.5; 3]; 4].into_iter()), "between two points"),
        (bezier_of(0.1, (0..40).map(|i| [f64::from(i), 0.0, 0.0])), "at most 33 points"),
        (b_spline(0.1, 3, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]).into(), "at least 4 points"),
        (tube(0.1, [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]).into(), "point 1 of `tube` and the next one are the same"),
        (spline_of(0.1, [[0.0; 3]].into_iter()), "`spline` has fewer than two points"),
    ] {
        let (analysis, diagnostics) = analyse(&field);
        assert!(analysis.is_none() && diagnostics[0].message.contains(message), "{message}: {diagnostics:?}");
    }
}

/// A point of the plane as one of space.
fn flat(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, y, 0.0)
}

/// The distance from the nearest of some points that lie close together along a line.
fn nearest(points: &[DVec3], p: DVec3) -> f64 {
    points.iter().map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min).sqrt()
}

#[test]
fn conics_are_as_far_as_the_nearest_of_their_points() {
    /// So many points lie along the branch and on the chord.
    const STEPS: u32 = 20_000;
    let mut random = Random::new(23);
    let limit = |width: f64, height: f64| width * width / (8.0 * height);
    for (width, height) in [(1.0, 1.0), (2.0, 0.1), (0.2, 1.8)] {
        for share in [1.0, 1.0 - 1e-9, 1.0 - 1e-4, 0.9, 0.5, 0.1, 1e-3] {
            let radius = share * limit(width, height);
            let program = program(&hyperbola(width, height, radius).into());
            let (half, bend) = (width / 2.0, (width * width / (4.0 * radius) - 2.0 * height) / (height * height));
            // x^2 = radius (2 v + bend v^2), v being the height above the vertex.
            let branch = (0..=STEPS).map(|step| {
                let v = height * (f64::from(step) / f64::from(STEPS)).powi(2);
                flat((radius * (2.0 * v + bend * v * v)).sqrt(), v - height / 2.0)
            });
            let chord = (0..=STEPS).map(|step| flat(half * f64::from(step) / f64::from(STEPS), height / 2.0));
            let edge: Vec<DVec3> = branch.chain(chord).collect();
            for _ in 0..40 {
                let p = random.point(1.5) * DVec3::new(1.0, 1.0, 0.0);
                let (found, known) = (program.value(p), nearest(&edge, p.abs().with_y(p.y)));
                let error = found.abs() - known;
                // The nearest of these points is within half a step of the foot point.
                let step = 2.0 * (width + height) / f64::from(STEPS);
                assert!(error < ROUNDING && error > -step, "{width} {height} {share} at {p}: {found}, not {known}");
                assert!(
                    known < 1e-2 || error > -step * step / known,
                    "{width} {height} {share} at {p}: {found}, {known}"
                );
                let v = p.y + height / 2.0;
                let is_inside = v > 0.0 && v < height && p.x * p.x < radius * (2.0 * v + bend * v * v);
                assert!((found < 0.0) == is_inside, "{width} {height} {share} at {p}: {found}");
            }
        }
    }
}

#[test]
fn superellipses_are_as_far_as_the_nearest_of_their_points() {
    const STEPS: u32 = 20_000;
    let mut random = Random::new(24);
    for (x, y) in [(1.0, 1.0), (1.2, 0.4), (0.3, 1.0)] {
        let tolerance = 1.5e-4 * f64::min(x, y);
        for exponent in [0.3, 0.7, 1.0, 1.4, 2.0, 2.5, 4.0, 9.0, 60.0] {
            let program = program(&superellipse(x, y, exponent).into());
            let power = |base: f64| base.powf(2.0 / exponent);
            let curve: Vec<DVec3> = (0..=STEPS)
                .map(|step| (std::f64::consts::FRAC_PI_2 * f64::from(step) / f64::from(STEPS)).sin_cos())
                .map(|(sin, cos)| flat(x * power(cos), y * power(sin)))
                .chain([flat(0.0, y)])
                .collect();
            // Where the curve's points lie far apart, all between two of them is near the straight edge that joins them.
            let gap = |p: DVec3| {
                let to_edge = |pair: &[DVec3]| {
                    let (a, along) = (pair[0], pair[1] - pair[0]);
                    let share = (p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
                    p.distance(a + along * share.clamp(0.0, 1.0))
                };
                curve.windows(2).map(to_edge).fold(f64::INFINITY, f64::min)
            };
            for _ in 0..25 {
                let p = random.point(1.5) * DVec3::new(1.0, 1.0, 0.0);
                let (found, known) = (program.value(p), gap(p.abs()));
                assert!((found.abs() - known).abs() < tolerance, "{x} {y} {exponent} at {p}: {found}, not {known}");
                let size = (p.x / x).abs().powf(exponent) + (p.y / y).abs().powf(exponent);
                assert!(known < tolerance || (found < 0.0) == (size < 1.0), "{x} {y} {exponent} at {p}: {found}");
            }
        }
    }
}

#[test]
fn gears_mesh() {
    // With so many teeth no tip reaches a foot that has not been cut back.
    const TEETH: [u32; 2] = [20, 31];
    const MODULE: f64 = 0.1;
    const STEPS: u32 = 120;
    let tolerance = 2.5e-3 * MODULE;
    let [radius, other] = TEETH.map(|teeth| f64::from(teeth) * MODULE / 2.0);
    for pressure in [20.0f64, 22.5, 25.0] {
        let gear = |teeth: u32| gear(teeth, MODULE).with("pressure_angle", &[pressure.to_radians().into()]);
        for turn in [0.0, 1.0, 2.5, 4.0, 7.3, 11.0] {
            // The first one's tooth on the y axis turns into the other one's gap, to the right of it.
            let driver = program(&gear(TEETH[0]).rotate([0.0, 0.0, 1.0], turn - 90.0));
            let back = 90.0 + 180.0 / f64::from(TEETH[1]) - turn * radius / other;
            let driven = program(&gear(TEETH[1]).rotate([0.0, 0.0, 1.0], back).at([radius + other, 0.0, 0.0]));
            let mut deepest = f64::INFINITY;
            for (i, j) in (0..=STEPS).flat_map(|i| (0..=STEPS).map(move |j| (i, j))) {
                let place = |step: u32, reach: f64| reach * (2.0 * f64::from(step) / f64::from(STEPS) - 1.0);
                let p = flat(radius + place(i, 1.2 * MODULE), place(j, 4.0 * MODULE));
                deepest = deepest.min(driver.value(p).max(driven.value(p)));
            }
            // They touch, and nowhere overlap.
            assert!(deepest > -tolerance, "{pressure} {turn}: {deepest} deep");
            assert!(deepest < 8.0 * MODULE / f64::from(STEPS), "{pressure} {turn}: {deepest} apart");
        }
    }
    // Teeth and gaps are equally wide on the pitch circle; tips and feet lie where they should.
    let program = program(&gear(24, MODULE).into());
    let at = |radius: f64, angle: f64| program.value(flat(radius * angle.sin(), radius * angle.cos()));
    let (pitch, step) = (1.2, std::f64::consts::PI / 24.0);
    for tooth in 0..24 {
        let middle = 2.0 * step * f64::from(tooth);
        assert!(at(pitch, middle + step / 2.0).abs() < tolerance && at(pitch, middle - step / 2.0).abs() < tolerance);
        assert!(
            at(pitch + MODULE, middle).abs() < ROUNDING && at(pitch - 1.25 * MODULE, middle + step).abs() < ROUNDING
        );
    }
}

#[test]
fn spirals_are_as_far_as_the_nearest_of_their_points() {
    const STEPS: u32 = 40_000;
    let mut random = Random::new(25);
    for (width, spacing, turns, inner) in
        [(0.1, 0.3, 4.0, 0.0), (0.05, 0.5, 2.3, 0.2), (0.2, 0.1, 0.4, 0.7), (0.1, 0.2, 6.0, 0.05)]
    {
        let field: Field = spiral(width, spacing, turns).with("inner", &[inner.into()]).into();
        let program = program(&field);
        let curve: Vec<DVec3> = (0..=STEPS)
            .map(|step| turns * f64::from(step) / f64::from(STEPS))
            .map(|turn| (inner + spacing * turn, (std::f64::consts::TAU * turn).sin_cos()))
            .map(|(radius, (sin, cos))| flat(radius * cos, radius * sin))
            .collect();
        let Extent::Finite(aabb) = extent(&field.clone().extrude(1.0)) else { panic!("a spiral is finite") };
        let tolerance = 2e-3 * width;
        for p in &curve {
            let reach = DVec3::new(width, width, 0.0) / 2.0 - tolerance;
            assert!((*p - reach).cmpge(aabb.min).all() && (*p + reach).cmple(aabb.max).all());
        }
        for _ in 0..200 {
            let p = random.point(1.5) * DVec3::new(1.0, 1.0, 0.0);
            let (found, known) = (program.value(p), nearest(&curve, p) - width / 2.0);
            assert!((found - known).abs() < tolerance, "{width} {spacing} {turns} at {p}: {found}, not {known}");
        }
    }
}

/// Compares a line of some width with the points of its curve.
fn compare_line(name: &str, field: &Field, curve: &[DVec3], width: f64, random: &mut Random) {
    let program = program(field);
    let Extent::Finite(aabb) = extent(&field.clone().extrude(1.0)) else { panic!("a line is finite") };
    let tolerance = 2e-3 * width;
    for p in curve {
        let reach = DVec3::new(width, width, 0.0) / 2.0 - tolerance;
        assert!((*p - reach).cmpge(aabb.min).all() && (*p + reach).cmple(aabb.max).all(), "{name}: {p} in {aabb:?}");
    }
    for _ in 0..200 {
        let p = random.point(1.5) * DVec3::new(1.0, 1.0, 0.0);
        let (found, known) = (program.value(p), nearest(curve, p) - width / 2.0);
        assert!((found - known).abs() < tolerance, "{name} at {p}: {found}, not {known}");
    }
}

#[test]
fn logarithmic_spirals_are_as_far_as_the_nearest_of_their_points() {
    const STEPS: u32 = 40_000;
    let mut random = Random::new(28);
    // A nautilus, the golden spiral, one inwards, a circle, and one that is nearly straight.
    for (width, inner, growth, turns) in [
        (0.1, 0.05, 3.0, 2.8),
        (0.05, 0.01, 6.854, 2.5),
        (0.08, 1.2, 0.2, 3.0),
        (0.2, 0.8, 1.0, 0.7),
        (0.1, 1e-3, 1e4, 0.74),
    ] {
        let curve: Vec<DVec3> = (0..=STEPS)
            .map(|step| turns * f64::from(step) / f64::from(STEPS))
            .map(|turn| (inner * f64::powf(growth, turn), (std::f64::consts::TAU * turn).sin_cos()))
            .map(|(radius, (sin, cos))| flat(radius * cos, radius * sin))
            .collect();
        let field = logarithmic_spiral(width, inner, growth, turns).into();
        compare_line(&format!("{inner} times {growth}"), &field, &curve, width, &mut random);
    }
}

#[test]
fn clothoids_are_as_far_as_the_nearest_of_their_points() {
    const STEPS: u32 = 40_000;
    let mut random = Random::new(30);
    for (width, length, turn, is_symmetric) in [
        (0.1, 1.5, 90.0, false),
        (0.06, 2.5, 700.0, true),
        (0.05, 2.0, -1500.0, false),
        (0.2, 1.0, 0.0, true),
        (0.1, 0.8, -30.0, true),
    ] {
        // From middle to middle of short straight steps.
        let step = length / f64::from(STEPS);
        let mut half = vec![DVec3::ZERO];
        for index in 0..STEPS {
            let share = (f64::from(index) + 0.5) / f64::from(STEPS);
            let (sin, cos) = (f64::to_radians(turn) * share * share).sin_cos();
            half.push(half[half.len() - 1] + flat(cos, sin) * step);
        }
        let other: Vec<DVec3> = half.iter().map(|point| -*point).filter(|_| is_symmetric).collect();
        let field = clothoid(width, length, turn).with("symmetric", &[i32::from(is_symmetric).into()]).into();
        compare_line(&format!("{length} turned by {turn}"), &field, &[half, other].concat(), width, &mut random);
    }
    // The limit of Fresnel's integrals, which the last round surrounds.
    let end = program(&clothoid(0.01, 100.0, 17_999.0).into());
    let rate = f64::to_radians(17_999.0) / 1e4;
    let eye = (std::f64::consts::PI / 8.0 / rate).sqrt();
    assert!((end.value(flat(eye, eye)) - (1.0 / (2.0 * rate * 100.0) - 0.005)).abs() < 1e-3);
}

#[test]
fn sheets_are_the_thinnest_of_bodies() {
    // As thin as bodies get without being nothing.
    const THIN: f64 = 1e-12;
    let corners = [[0.2, -0.4, 0.1], [0.9, 0.3, -0.5], [-0.6, 0.5, 0.3]];
    let [a, b, c] = corners.map(DVec3::from_array);
    let (u, w) = ((b - a).normalize(), (b - a).cross(c - a).normalize());
    let v = w.cross(u);
    let within = |p: DVec3| [(p - a).dot(u), (p - a).dot(v)];
    let rows = glam::DMat3::from_cols(u, v, w).transpose().to_cols_array_2d();
    let placed = polygon([a, b, c].map(within)).extrude(THIN).matrix(rows).at(a.to_array());
    let mut random = Random::new(26);
    for (name, sheet, body) in [
        ("a disc", Field::from(disc(0.7)), Field::from(cylinder(0.7, THIN))),
        (
            "a disc along x",
            disc(0.7).along(freikugel_field::Axis::X).into(),
            cylinder(0.7, THIN).along(freikugel_field::Axis::X).into(),
        ),
        ("a square", quad([-0.5, -0.3, 0.0], [1.0, 0.0, 0.0], [0.0, 0.6, 0.0]).into(), cuboid([1.0, 0.6, THIN]).into()),
        ("a triangle", triangle(corners[0], corners[1], corners[2]).into(), placed),
        (
            "a leaning parallelogram",
            quad([-0.5, -0.6, -0.3], [1.0, 0.0, 0.0], [0.2, 0.0, 0.6]).into(),
            parallelogram(1.0, 0.6, 0.2).extrude(THIN).rotate([1.0, 0.0, 0.0], 90.0).at([0.1, -0.6, 0.0]),
        ),
    ] {
        let contract = analyse(&sheet).0.expect("sound").contract;
        assert!(!contract.signed && contract.outside == Metric::Exact, "{name}");
        let (one, other) = (program(&sheet), program(&body));
        for p in (0..400).map(|_| random.point(1.5)) {
            let (found, expected) = (one.value(p), other.value(p));
            assert!((found - expected).abs() < 10.0 * THIN, "{name} at {p}: {found}, not {expected}");
        }
        let (Extent::Finite(one), Extent::Finite(other)) = (extent(&sheet), extent(&body)) else {
            panic!("{name} has an end");
        };
        let gap = (one.min - other.min).abs().max((one.max - other.max).abs()).max_element();
        assert!(gap < 1e-9, "{name}: {one:?}, not {other:?}");
    }
}

#[test]
fn matrices_do_what_other_maps_do() {
    let child = || cuboid([0.9, 0.5, 0.7]).at([0.2, 0.1, 0.0]);
    let turn = glam::DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.6);
    let rows = |matrix: glam::DMat3| matrix.transpose().to_cols_array_2d();
    let mut random = Random::new(27);
    for (name, made, known) in [
        (
            "a similarity",
            child().matrix(rows(turn * 1.5)).with("by", &[0.1, -0.2, 0.3].map(Into::into)),
            child().rotate([1.0, 2.0, 0.5], 0.6f64.to_degrees()).scale(1.5).at([0.1, -0.2, 0.3]),
        ),
        (
            "a mirror",
            child().matrix([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
            child().reflect([1.0, 0.0, 0.0]),
        ),
        (
            "stretches",
            child().matrix([[1.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 2.0]]),
            child().stretch([1.5, 0.5, 2.0]),
        ),
        ("a shear", child().matrix([[1.0, 0.0, 0.7], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), child().shear("xz", 0.7)),
    ] {
        let contract = |field: &Field| analyse(field).0.expect("sound").contract;
        assert_eq!(contract(&made), contract(&known), "{name}");
        let (one, other) = (program(&made), program(&known));
        for p in (0..300).map(|_| random.point(1.6)) {
            let (found, expected) = (one.value(p), other.value(p));
            assert!((found - expected).abs() < ROUNDING, "{name} at {p}: {found}, not {expected}");
        }
    }
    // A figure stays one in its plane.
    let (half, root) = (0.5, 0.75f64.sqrt());
    assert!(
        analyse(&circle(1.0).matrix([[half, -root, 0.0], [root, half, 0.0], [0.0, 0.0, 1.0]]).extrude(1.0)).0.is_some()
    );
    for (rows, message) in [
        ([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]], "`rows` of `matrix` must not be singular"),
        ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1e-14]], "`rows` of `matrix` must not be singular"),
    ] {
        let (analysis, diagnostics) = analyse(&child().matrix(rows));
        assert!(analysis.is_none() && diagnostics[0].message.contains(message), "{diagnostics:?}");
    }
}

#[test]
fn copies_vary_as_much_as_they_may() {
    let child = || cuboid([0.3, 0.5, 0.7]).at([0.1, 0.0, 0.2]);
    let varied = |turn: f64, seed: u32| {
        let field = child().repeat_varied([1.0, -0.8, 0.5], [3, 4, 2], [0.2, 0.0, 0.1]);
        field.with("turn", &[turn.to_radians().into()]).with("seed", &[seed.into()])
    };
    // As another program computes them.
    const FIRST: [f64; 4] = [-0.05717914066303953, 0.2955157214705162, -0.9610422413654072, 0.19212035563665286];
    const LATER: [f64; 4] = [0.08646024760071325, 0.05637860206761336, 0.6901980769836007, 0.7102794933914025];
    let copies = |field: &Field| freikugel_field::copies(field).expect("copies");
    for (index, [x, _, z, turn], seed, place) in [(0, FIRST, 0, [-1.0, 1.2, -0.25]), (5, LATER, 7, [1.0, 0.4, -0.25])] {
        let found = &copies(&varied(30.0, seed))[index];
        let [px, py, pz] = place;
        let expected = child().rotate([0.0, 0.0, 1.0], 30.0 * turn).at([px + 0.2 * x, py, pz + 0.1 * z]);
        let (one, other) = (program(found), program(&expected));
        let mut random = Random::new(28);
        for p in (0..100).map(|_| random.point(2.0)) {
            assert!((one.value(p) - other.value(p)).abs() < ROUNDING, "copy {index} at {p}");
        }
    }
    // Without displacements and turns all is regular.
    let regular = program(&child().repeat([1.0, -0.8, 0.5], [3, 4, 2]));
    let still = program(&child().repeat_varied([1.0, -0.8, 0.5], [3, 4, 2], [0.0; 3]));
    let (one, other) = (program(&varied(30.0, 1)), program(&varied(30.0, 2)));
    let mut random = Random::new(29);
    let mut differs = 0;
    for p in (0..200).map(|_| random.point(2.5)) {
        assert!((regular.value(p) - still.value(p)).abs() < ROUNDING);
        differs += usize::from((one.value(p) - other.value(p)).abs() > 1e-3);
    }
    assert!(differs > 150, "other seeds, other copies: {differs} of 200");
    // Over many copies chance is even: as often to either side, and up to the ends.
    let many = copies(&sphere(0.1).repeat_varied([0.0; 3], [10, 10, 10], [1.0; 3]));
    let places: Vec<DVec3> = many
        .iter()
        .map(|copy| match extent(copy) {
            Extent::Finite(aabb) => aabb.center(),
            other => panic!("{other:?}"),
        })
        .collect();
    let (mean, square) =
        (places.iter().sum::<DVec3>() / 1000.0, places.iter().map(|p| *p * *p).sum::<DVec3>() / 1000.0);
    let most = places.iter().fold(DVec3::ZERO, |most, p| most.max(p.abs()));
    // Standard deviations of these means are 0.018 and 0.0094.
    assert!(mean.abs().max_element() < 0.06 && (square - 1.0 / 3.0).abs().max_element() < 0.03, "{mean} {square}");
    assert!(most.max_element() <= 1.0 + ROUNDING && most.min_element() > 0.98, "{most}");
}

#[test]
fn what_can_be_no_figure_is_refused() {
    let gear = |teeth: u32, pressure: f64| gear(teeth, 0.1).with("pressure_angle", &[pressure.to_radians().into()]);
    for (field, message) in [
        (Field::from(hyperbola(1.0, 1.0, 0.126)), "`radius` of `hyperbola` must not exceed 0.125"),
        (superellipse(1.0, 1.0, 0.1).into(), "`exponent` of `superellipse` must lie between 0.2 and 100, but is 0.1"),
        (ellipse(1.0, 1e4).into(), "must not differ by more than a factor of 1000"),
        (gear(20, 50.0).into(), "must lie between 0 and 35 degrees"),
        (gear(6, 33.0).into(), "end in points below their full height"),
        (gear(300, 34.0).into(), "fill the gaps"),
        (spiral(0.1, 0.2, 101.0).into(), "`turns` of `spiral` must not exceed 100"),
        (logarithmic_spiral(0.1, 0.2, 1.1, 101.0).into(), "`turns` of `logarithmic_spiral` must not exceed 100"),
        (logarithmic_spiral(1.0, 1e-3, 10.0, 6.1).into(), "comes to more than a factor of 1000000"),
        (logarithmic_spiral(1.0, 1e-3, 0.1, 6.1).into(), "comes to more than a factor of 1000000"),
        (logarithmic_spiral(1e-3, 1.0, 10.0, 2.1).into(), "farther from the origin than 100000 times its `width`"),
        (clothoid(0.1, 0.2, -18_001.0).into(), "`turn` of `clothoid` must not exceed 18000 degrees"),
        (triangle([0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]).into(), "the corners of `triangle` lie on a line"),
        (quad([0.0; 3], [1.0, 0.0, 1.0], [0.0; 3]).into(), "the edges `u` and `v` of `quad` lie on a line"),
        (sphere(1.0) - Field::from(disc(0.5)), "a sheet has no inside"),
    ] {
        let (analysis, diagnostics) = analyse(&field);
        assert!(analysis.is_none() && diagnostics[0].message.contains(message), "{message}: {diagnostics:?}");
    }
}
