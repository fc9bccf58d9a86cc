//! Warped and displaced fields: their values, enclosures, extents, slopes and materials.

mod common;

use common::Random;
use common::inside::contains;
use freikugel_field::shapes::*;
use freikugel_field::{
    Evaluator, Extent, Field, Formula, Interval, MaterialId, Points, Program, Severity, Shares, Structure, analyse,
    extent,
};
use glam::{DQuat, DVec3};

/// Maps of space: waves, a twist, one that bends strongly in one spot, and the identity.
const MAPS: [[&str; 3]; 5] = [
    ["x + 0.2*sin(3z)", "y + 0.1*cos(2x)", "z"],
    ["x*cos(z) + y*sin(z)", "y*cos(z) - x*sin(z)", "z"],
    ["x + exp(-20*((x - 0.5)^2 + y^2 + z^2)) / 3", "y", "z - 0.1*x^2"],
    ["x", "y", "z"],
    ["abs(x) - 0.5", "y", "max(z, -0.4)"],
];

fn children() -> [Field; 4] {
    [
        sphere(0.8).into(),
        cuboid([0.9, 1.1, 1.3]) - cylinder(0.3, 2.0),
        formula("x^4 + y^4 + z^4 - 0.4").within_sphere(1.2).into(),
        smooth_union(0.3, [torus(0.6, 0.25).into(), sphere(0.4).at([0.0, 0.3, 0.4])]).rotate([1.0, 2.0, 0.5], 30.0),
    ]
}

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

/// All children under all maps.
fn warped() -> impl Iterator<Item = (String, [Formula; 3], Field, Field)> {
    MAPS.into_iter().enumerate().flat_map(|(number, map)| {
        let formulas = map.map(|text| Formula::parse(text).expect("a formula"));
        children().into_iter().enumerate().map(move |(child, field)| {
            (format!("map {number} of child {child}"), formulas.clone(), field.clone(), field.warp(map))
        })
    })
}

#[test]
fn a_warp_looks_its_child_up_elsewhere() {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 40f64.to_radians());
    let shift = DVec3::new(0.2, -0.3, 0.4);
    let mut random = Random::new(1);
    for (name, map, child, field) in warped() {
        let (alone, plain) = (program(&child), program(&field));
        let placed = field.rotate([1.0, 2.0, 3.0], 40.0).at(shift.to_array());
        let placed = Structure::compile(&[placed]).expect("sound").program(DVec3::new(0.5, 0.1, -0.2));
        for p in (0..40).map(|_| random.point(1.5)) {
            let looked_up = DVec3::from_array(map.each_ref().map(|formula| formula.value(p.to_array())));
            let expected = alone.value(looked_up);
            assert_eq!(plain.value(p), expected, "{name} at {p}");
            let there = turn * p + shift;
            assert!((placed.value(there) - expected).abs() < 1e-9, "{name} at {p}");
            let [x, y, z] = (there - placed.origin()).as_vec3().to_array().map(|c| [c]);
            let mut single = [0.0];
            Evaluator::new(&placed).values(Points { x: &x, y: &y, z: &z }, &mut single);
            assert!((f64::from(single[0]) - expected).abs() < 2e-5, "{name} at {p}: {}, not {expected}", single[0]);
            let around = placed.interval(there.to_array().map(|c| Interval::new(c - 0.01, c + 0.01)));
            assert!(around.contains(expected), "{name} at {p}: {expected} not in {around:?}");
            if let (Some(inside), true) = (contains_if_measured(&child, looked_up), expected.abs() > 1e-6) {
                assert_eq!(inside, expected < 0.0, "{name} at {p}");
            }
        }
    }
}

/// Membership by set logic, for children without formulas.
fn contains_if_measured(child: &Field, p: DVec3) -> Option<bool> {
    (!child.node().shape.about.name.starts_with("formula")).then(|| contains(child, p)).flatten()
}

#[test]
fn gradients_and_hessians_pass_through_a_warp() {
    const STEP: f64 = 1e-5;
    let mut random = Random::new(2);
    for (name, _, _, field) in warped() {
        let program = program(&field);
        let mut smooth = 0;
        for p in (0..40).map(|_| random.point(1.2)) {
            let (value, gradient, hessian) = program.hessian(p);
            let at = |axis: usize, step: f64| program.gradient(p + DVec3::AXES[axis] * step);
            let bends = (0..3).any(|a| (at(a, STEP).0 + at(a, -STEP).0 - 2.0 * value).abs() > 1e-4 * STEP);
            if bends {
                continue;
            }
            smooth += 1;
            let [x, y, z] = p.as_vec3().to_array().map(|c| [c]);
            let mut out = [[0.0]; 10];
            let [value, gx, gy, gz, xx, yy, zz, xy, xz, yz] = &mut out;
            Evaluator::new(&program).hessians(
                Points { x: &x, y: &y, z: &z },
                value,
                [gx, gy, gz],
                [xx, yy, zz, xy, xz, yz],
            );
            let entries = [[xx, xy, xz].map(|e| e[0]), [xy, yy, yz].map(|e| e[0]), [xz, yz, zz].map(|e| e[0])];
            for axis in 0..3 {
                let slope = (at(axis, STEP).0 - at(axis, -STEP).0) / (2.0 * STEP);
                assert!((slope - gradient[axis]).abs() < 1e-4, "{name} at {p}: {slope}, not {gradient}");
                let column = (at(axis, STEP).1 - at(axis, -STEP).1) / (2.0 * STEP);
                let size = 1.0 + column.length();
                assert!(column.distance(hessian.col(axis)) < 2e-3 * size, "{name} at {p}: {column}");
                let single = DVec3::from_array(entries[axis].map(f64::from));
                assert!(single.distance(hessian.col(axis)) < 5e-3 * size, "{name} at {p}: {single}, not {column}");
            }
        }
        assert!(smooth > 10, "{name}: only {smooth} points away from edges");
    }
}

#[test]
fn slopes_of_warps_hold_and_are_local() {
    let mut random = Random::new(4);
    for (name, _, _, field) in warped() {
        let (program, everywhere) = (program(&field), analyse(&field).0.expect("sound").contract.lipschitz);
        for _ in 0..5 {
            let region = random.point(0.8).to_array().map(|c| Interval::new(c - 0.2, c + 0.2));
            let bound = program.lipschitz_over(region).expect("bounded here");
            for _ in 0..100 {
                let mut at = || DVec3::from_array(region.map(|side| random.range(side.lo(), side.hi())));
                let (p, q) = (at(), at());
                let rise = (program.value(p) - program.value(q)).abs() / p.distance(q);
                assert!(rise <= bound * (1.0 + 1e-9), "{name}: {rise} above {bound}");
                assert!(everywhere.is_none_or(|all| rise <= all * (1.0 + 1e-9)), "{name}: {rise} above {everywhere:?}");
            }
        }
    }
    // Waves have a slope everywhere; a strong spot has its own, and elsewhere there is none of it.
    let wave = analyse(&sphere(1.0).warp(MAPS[0])).0.expect("sound").contract.lipschitz.expect("known");
    assert!((1.2..1.9).contains(&wave), "{wave}");
    let spot = program(&sphere(1.0).warp(MAPS[2]));
    let over = |x: f64| spot.lipschitz_over([x, 0.0, 0.0].map(|c| Interval::new(c - 0.1, c + 0.1))).expect("bounded");
    assert!(over(0.6) > 1.8 && over(-0.7) < 1.2, "{} and {}", over(0.6), over(-0.7));
}

/// The norm of a twist's Jacobian matrix at radius r is (a + sqrt(a^2 + 4)) / 2 with a the radius times the rate.
#[test]
fn the_slope_of_a_twist_is_that_of_the_closed_form() {
    let twisted = program(&cuboid([1.0, 1.0, 4.0]).warp(MAPS[1]));
    let reach: f64 = 0.8;
    let a = reach * 2f64.sqrt();
    let exact = (a + (a * a + 4.0).sqrt()) / 2.0;
    let bound = twisted.lipschitz_over([reach; 3].map(|c| Interval::new(-c, c))).expect("bounded");
    assert!(exact <= bound * (1.0 + 1e-9) && bound <= 1.3 * exact, "{bound} for {exact}");
}

#[test]
fn a_twist_turns_its_cuts() {
    let mut random = Random::new(6);
    let child = || cuboid([1.0, 0.6, 2.0]).at([0.2, 0.0, 0.1]);
    let alone = program(&child());
    let rate = 50f64.to_radians();
    for (axis, direction) in [(0, DVec3::X), (1, DVec3::Y), (2, DVec3::Z)] {
        let field = child().twist(50.0).with("axis", &[axis.into()]);
        let program = program(&field);
        let Extent::Finite(aabb) = extent(&field) else { panic!("a twisted box is finite") };
        for p in (0..2000).map(|_| random.point(1.6)) {
            let turn = DQuat::from_axis_angle(direction, -rate * p.dot(direction));
            let expected = alone.value(turn * p);
            assert!((program.value(p) - expected).abs() < 1e-12, "axis {axis} at {p}");
            let is_in_box = p.cmpge(aabb.min).all() && p.cmple(aabb.max).all();
            assert!(expected > 0.0 || is_in_box, "axis {axis}: {p} outside of {aabb:?}");
        }
        // The rate is a number like others: binding another one compiles nothing.
        let structure = Structure::compile(&[field]).expect("sound");
        let values: Vec<f64> = structure.values().iter().map(|&v| if v == rate { 0.0 } else { v }).collect();
        let still = structure.bind(&values, DVec3::ZERO).expect("the same structure");
        let p = random.point(1.0);
        assert!((still.value(p) - alone.value(p)).abs() < 1e-12, "axis {axis} at {p}");
    }
    let endless = analyse(&plane([1.0, 0.0, 0.0]).twist(10.0)).1;
    assert!(endless[0].message.contains("no bound across the axis"), "{endless:?}");
    assert!(analyse(&(sphere(1.0) | sheet([0.0, 0.0, 1.0])).twist(10.0)).0.is_none());
}

#[test]
fn the_extent_of_a_warp_holds_it_and_a_cut_bounds_it() {
    let mut random = Random::new(5);
    for (name, _, _, field) in warped() {
        let Extent::Finite(aabb) = extent(&field) else { continue };
        let program = program(&field);
        for p in (0..4000).map(|_| random.point(2.5)) {
            if program.value(p) < 0.0 {
                assert!(p.cmpge(aabb.min).all() && p.cmple(aabb.max).all(), "{name}: {p} outside of {aabb:?}");
            }
        }
    }
    let Extent::Finite(waved) = extent(&sphere(1.0).warp(MAPS[0])) else { panic!("waves don't carry far") };
    assert!(waved.max.distance(DVec3::new(1.2, 1.1, 1.0)) < 1e-9 && waved.min == -waved.max, "{waved:?}");
    assert_eq!(extent(&sphere(1.0).warp(MAPS[1])), Extent::Unbounded, "how far a twist carries is not looked for here");
    let Extent::Finite(cut) = extent(&sphere(1.0).warp_within_sphere(MAPS[1], 0.5)) else { panic!("a cut is finite") };
    assert_eq!(cut.max, DVec3::splat(0.5));
    let Extent::Finite(bumped) = extent(&sphere(1.0).displace("0.1*sin(9x)*sin(9y)")) else { panic!("bounded") };
    assert!((bumped.max.x - 1.1).abs() < 1e-9, "{bumped:?}");
    let cut = program(&sphere(1.0).warp_within_sphere(["x", "y", "z"], 0.5));
    assert!((cut.value(DVec3::X * 0.7) - 0.2).abs() < 1e-12);
}

/// A name, a mapped field, and where its child is looked up.
type Mapped = (&'static str, Field, fn(DVec3) -> DVec3);

/// Maps by formulas of their own, with the same looked up in another way.
fn maps() -> Vec<Mapped> {
    let child = || cuboid([1.6, 0.5, 0.9]).at([0.1, 0.05, -0.1]) | sphere(0.35).at([-0.6, 0.1, 0.3]);
    vec![
        ("bend", child().bend(50.0), |p| {
            // The angle at the middle of the bend, and the distance from it.
            let radius = 1.0 / 50f64.to_radians();
            let from_middle = p - DVec3::Y * radius;
            DVec3::new(p.x.atan2(radius - p.y) * radius, radius - from_middle.truncate().length(), p.z)
        }),
        ("bend down", child().bend(-70.0), |p| {
            let radius = 1.0 / 70f64.to_radians();
            let from_middle = p + DVec3::Y * radius;
            DVec3::new(p.x.atan2(radius + p.y) * radius, from_middle.truncate().length() - radius, p.z)
        }),
        ("taper", child().taper(-0.4, 0.5, 0.3), |p| {
            let scale = if p.z < -0.4 {
                1.0
            } else if p.z > 0.5 {
                0.3
            } else {
                1.0 - 0.7 * (p.z + 0.4) / 0.9
            };
            DVec3::new(p.x / scale, p.y / scale, p.z)
        }),
        ("swirl", child().swirl(130.0, 0.7), |p| {
            let angle = 130f64.to_radians() * (-p.truncate().length() / 0.7).exp();
            DQuat::from_rotation_z(-angle) * p
        }),
        ("symmetry along x", child().symmetric("x"), |p| DVec3::new(p.x.abs(), p.y, p.z)),
        ("symmetry along y", child().symmetric("y"), |p| DVec3::new(p.x, p.y.abs(), p.z)),
        ("smooth symmetry along x and z", child().symmetric("xz").with("k", &[0.4.into()]), |p| {
            let smooth = |x: f64| if x.abs() < 0.4 { x * x / 0.8 + 0.2 } else { x.abs() };
            DVec3::new(smooth(p.x), p.y, smooth(p.z))
        }),
        ("curl", child().curl(40.0), |p| DQuat::from_rotation_z(40f64.to_radians() * p.x) * p),
    ]
}

#[test]
fn maps_look_their_child_up_where_they_should() {
    let child = || cuboid([1.6, 0.5, 0.9]).at([0.1, 0.05, -0.1]) | sphere(0.35).at([-0.6, 0.1, 0.3]);
    let alone = program(&child());
    let mut random = Random::new(31);
    for (name, field, map) in maps() {
        let program = program(&field);
        let Extent::Finite(aabb) = extent(&field) else { panic!("{name} of a finite shape is finite") };
        let size = aabb.size();
        assert!(size.max_element() < 3.5, "{name}: {aabb:?} is far too large");
        for p in (0..4000).map(|_| random.point(1.8)) {
            let expected = alone.value(map(p));
            assert!((program.value(p) - expected).abs() < 1e-11, "{name} at {p}");
            let is_in_box = p.cmpge(aabb.min).all() && p.cmple(aabb.max).all();
            assert!(expected > 0.0 || is_in_box, "{name}: {p} outside of {aabb:?}");
        }
        let everywhere = analyse(&field).0.expect("sound").contract.lipschitz;
        for _ in 0..40 {
            let region = random.point(1.5).to_array().map(|c| Interval::new(c - 0.1, c + 0.1));
            let bound = program.lipschitz_over(region);
            for _ in 0..60 {
                let mut at = || DVec3::from_array(region.map(|side| random.range(side.lo(), side.hi())));
                let (p, q) = (at(), at());
                let (one, other) = (program.value(p), program.value(q));
                let rise = (one - other).abs() / p.distance(q);
                assert!(bound.is_none_or(|bound| rise <= bound * (1.0 + 1e-9)), "{name}: {rise} above {bound:?}");
                assert!(everywhere.is_none_or(|all| rise <= all * (1.0 + 1e-9)), "{name}: {rise} above {everywhere:?}");
                let enclosure = program.interval(region);
                assert!(enclosure.contains(one), "{name}: {one} not in {enclosure:?}");
            }
        }
    }
}

#[test]
fn maps_refuse_what_they_would_tear_apart() {
    let message = |field: Field| analyse(&field).1.first().map_or(String::new(), |fault| fault.message.clone());
    assert!(message(cuboid([7.0, 0.2, 0.2]).bend(60.0)).contains("ends of the bent shape meet"));
    assert!(message(cuboid([1.0, 2.0, 0.2]).bend(60.0)).contains("reaches the middle"));
    assert!(message(cuboid([1.0, 2.0, 0.2]).at([0.0, -1.0, 0.0]).bend(60.0)).is_empty());
    assert!(message(plane([0.0, 0.0, 1.0]).bend(60.0)).contains("no end along x"));
    assert!(message(sphere(1.0).bend(0.0)).contains("must not be 0"));
    assert!(message(sphere(1.0).taper(1.0, 0.0, 0.5)).contains("must be below `to`"));
    assert!(message(plane([0.0, 0.0, 1.0]).taper(0.0, 1.0, 0.5)).contains("no bound across z"));
    assert!(message(plane([1.0, 0.0, 0.0]).curl(10.0)).contains("no bound across z"));
    assert!(message(plane([1.0, 0.0, 0.0]).swirl(10.0, 1.0)).is_empty(), "a swirl has a slope everywhere");
}

#[test]
fn materials_stay_with_the_shape() {
    let (red, blue) = (MaterialId(1), MaterialId(2));
    let half = |x: f64, material| sphere(0.5).at([x, 0.0, 0.0]).painted(material);
    let pair = || half(-0.6, red) | half(0.6, blue);
    for field in [pair().warp_within_sphere(MAPS[0], 0.8), pair().displace("0.05*sin(9y)")] {
        let structure = Structure::compile(&[field]).expect("sound");
        let program = structure.program(DVec3::ZERO);
        let (x, zero) = ([-1.3, -0.8, -0.5, 0.5, 0.8, 1.3], [0.0; 6]);
        let mut shares = Shares::default();
        Evaluator::new(&program).shares(Points { x: &x, y: &zero, z: &zero }, &mut shares);
        for (point, x) in x.into_iter().enumerate() {
            let wanted = if x < 0.0 { red } else { blue };
            let region = structure.regions().iter().position(|region| region.material == Some(wanted)).expect("there");
            assert_eq!(shares.of(region, point), 1.0, "at {x}");
        }
    }
}

#[test]
fn faults_are_reported() {
    let messages = |field: Field| -> Vec<String> {
        let errors = analyse(&field).1.into_iter().filter(|d| d.severity == Severity::Error);
        errors.map(|d| d.message).collect()
    };
    let faulty = messages(sphere(1.0).warp(["x +", "y", "q"]));
    assert!(faulty.len() == 2 && faulty.iter().all(|message| message.contains("column")), "{faulty:?}");
    let bare = messages(Field::new(&WARP, [], [sphere(1.0).into()]));
    assert_eq!(bare.len(), 3, "{bare:?}");
    assert!(messages(sheet([0.0, 0.0, 1.0]).displace("x"))[0].contains("sheet"));
}
