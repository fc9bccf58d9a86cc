//! Attempts to refute what contracts promise, and to show them lazy.

mod common;

use common::inside::contains;
use common::{Random, calls, every_shape, large_tree, notation, tree};
use freikugel_field::shapes::Offset;
use freikugel_field::{Extent, Field, Metric, Program, Structure, analyse, extent};
use glam::DVec3;

const CALLS: u64 = 8;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

/// Every shape over primitives, and random trees, also large ones.
fn fields() -> impl Iterator<Item = (String, Field)> {
    let shapes = every_shape(CALLS).map(|(name, seed, field)| (format!("{name} {seed}"), field));
    let trees = (0..150).map(|seed| (format!("tree {seed}"), tree(4, &mut Random::new(seed + 1000))));
    let large = (0..4).map(|seed| {
        let field = large_tree(200, &mut Random::new(seed + 1));
        (format!("tree of {} calls, {seed}", calls(&field)), field)
    });
    shapes.chain(trees).chain(large)
}

#[test]
fn the_lipschitz_constant_is_never_exceeded() {
    for (name, field) in fields() {
        let lipschitz = analyse(&field).0.expect("sound").contract.lipschitz.expect("all constants are known so far");
        let program = program(&field);
        let mut random = Random::new(7);
        for i in 0..400 {
            let p = random.point(2.0);
            // From a few units in the last place to metres.
            let length = 10.0_f64.powf(-9.0 + f64::from(i % 10));
            let q = p + random.direction() * length;
            let (slope, rounding) = ((program.value(p) - program.value(q)).abs(), 1e-13);
            assert!(slope <= lipschitz * p.distance(q) * (1.0 + 1e-9) + rounding, "{name} from {p} to {q}");
        }
    }
}

#[test]
fn the_lipschitz_constant_is_not_lazy() {
    for (name, field) in fields() {
        let lipschitz = analyse(&field).0.expect("sound").contract.lipschitz.expect("all constants are known so far");
        let program = program(&field);
        let mut random = Random::new(8);
        let largest = (0..400).map(|_| program.gradient(random.point(2.0)).1.length()).fold(0.0, f64::max);
        // An operator knows its child's constant, not in which direction the child is steepest: a plane, or an ellipsoid's
        // bound, may stand so that stretching flattens it. A fractal is steep far outside alone, where stretching may take it
        // out of sight. Trees may hide their steepest part altogether.
        let child = field.node().children.first().map_or("", |c| c.node().shape.about.name);
        let flat = ["plane", "sheet", "ellipsoid_bound", "quaternion_julia", "mandelbulb"].contains(&child);
        // In a cell there may be nothing but a flat part.
        let is_flattened =
            ["stretch", "shear", "repeat_mirrored", "repeat_endless"].iter().any(|flattens| name.starts_with(flattens));
        // A cut may run along all that is steep.
        let is_cut = name.starts_with("cross_section") && (flat || child == "slab");
        let excused = name.starts_with("tree") || (is_flattened && flat) || is_cut;
        assert!(excused || lipschitz <= 1.25 * largest, "{name}: {lipschitz} for {largest}");
    }
}

#[test]
fn the_ball_of_the_bound_is_empty_and_that_of_an_exact_distance_touches() {
    for (name, field) in fields() {
        let contract = analyse(&field).0.expect("sound").contract;
        let program = program(&field);
        let mut random = Random::new(9);
        for _ in 0..40 {
            let p = random.point(2.0);
            let (value, gradient) = program.gradient(p);
            let Some(here) = contains(&field, p) else {
                break;
            };
            // Membership of a segment is sampled, hence the margin.
            let margin = 1e-4;
            if value.abs() < 10.0 * margin {
                continue;
            }
            for _ in 0..60 {
                let q = p + random.direction() * (value.abs() - margin) * random.unit().cbrt();
                assert_eq!(contains(&field, q), Some(here), "{name}: {q} within {value} of {p}");
            }
            let metric = if value > 0.0 { contract.outside } else { contract.inside };
            if metric == Metric::Exact && (gradient.length() - 1.0).abs() < 1e-6 {
                let beyond = p - gradient * (value + margin * value.signum());
                let touches = contains(&field, beyond) == Some(!here)
                    // Past a thin edge the other side may already be over: look around the foot point as well, so often that a
                    // tip of half a degree is found.
                    || (0..200_000).any(|_| {
                        let near = p - gradient * value + random.direction() * margin;
                        contains(&field, near) == Some(!here)
                    });
                assert!(touches, "{name}: nothing at distance {value} of {p} from {}", notation(&field));
            }
        }
    }
}

#[test]
fn an_exact_distance_equals_the_nearest_of_many_surface_points() {
    for (name, field) in every_shape(3).map(|(name, seed, field)| (format!("{name} {seed}"), field)) {
        let contract = analyse(&field).0.expect("sound").contract;
        if contract.outside != Metric::Exact || contains(&field, DVec3::ZERO).is_none() {
            continue;
        }
        let program = program(&field);
        let mut random = Random::new(10);
        for _ in 0..4 {
            let p = random.point(2.0);
            let value = program.value(p);
            if value < 0.1 {
                continue;
            }
            // Along directions that narrow down on the best one, the first change of membership by bisection.
            let reach = |direction: DVec3, around: f64| -> f64 {
                let (mut near, mut far) = (0.0, f64::INFINITY);
                for i in 1..=60 {
                    let t = value * (1.0 + around * (f64::from(i) / 30.0 - 1.0));
                    if contains(&field, p + direction * t) == Some(true) {
                        far = t;
                        break;
                    }
                    near = t;
                }
                while far.is_finite() && far - near > 1e-7 {
                    let middle = 0.5 * (near + far);
                    if contains(&field, p + direction * middle) == Some(true) {
                        far = middle;
                    } else {
                        near = middle;
                    }
                }
                far
            };
            // From all directions, and around the one in which the surface is said to lie, where it may be a tip: thinner than the
            // steps that are taken in other directions.
            let said = -program.gradient(p).1.normalize_or(DVec3::X);
            let mut least = f64::INFINITY;
            for start in [None, Some(said)] {
                let mut best = (f64::INFINITY, start);
                let (mut spread, around) = if start.is_none() { (2.0, 0.1) } else { (0.05, 0.003) };
                for round in 0..12 {
                    let count = if round == 0 && start.is_none() { 1000 } else { 80 };
                    for _ in 0..count {
                        let direction = match best.1 {
                            Some(best) if round > 0 || start.is_some() => {
                                (best + random.direction() * spread).normalize()
                            }
                            _ => random.direction(),
                        };
                        let t = reach(direction, around);
                        if t < best.0 {
                            best = (t, Some(direction));
                        }
                    }
                    spread *= 0.45;
                }
                least = least.min(best.0);
            }
            if least.is_finite() {
                assert!((least - value).abs() < 2e-3 * value, "{name} at {p}: {value}, but {least}");
            }
        }
    }
}

#[test]
fn the_extent_holds_the_shape() {
    for (name, field) in fields() {
        let program = program(&field);
        let mut random = Random::new(11);
        let Extent::Finite(aabb) = extent(&field) else {
            continue;
        };
        for _ in 0..2000 {
            let p = random.point(3.0);
            if program.value(p) < 0.0 {
                let slack = 1e-9;
                assert!(
                    p.cmpge(aabb.min - slack).all() && p.cmple(aabb.max + slack).all(),
                    "{name}: {p} outside of {aabb:?}"
                );
            }
        }
    }
}

#[test]
fn the_extent_of_primitives_under_maps_is_tight() {
    let placed = ["translate", "rotate", "rotate_euler", "rotate_quaternion", "reflect", "scale", "stretch"];
    for (name, seed, field) in every_shape(4) {
        let is_primitive = field.node().children.is_empty();
        if !is_primitive && !placed.contains(&name) && name != "paint" {
            continue;
        }
        // Of orbits only the ball is known that none of them comes back to.
        let mut primitive = field.clone();
        while let Some(child) = primitive.node().children.first().cloned() {
            primitive = child;
        }
        // Of smooth sets of points only how far they grow where all points are in one place.
        if ["quaternion_julia", "mandelbulb", "smooth_point_set"].contains(&primitive.node().shape.about.name) {
            continue;
        }
        let Extent::Finite(aabb) = extent(&field) else {
            continue;
        };
        // What has no inside gets one, and so do ends of tubes that are mere points, by as much as the box grows then.
        let grown = field.clone().offset(0.05);
        let is_sheet = !analyse(&field).0.expect("sound").contract.signed;
        let is_pointed = primitive.node().shape.about.name.starts_with("tapered");
        let (field, aabb) = match extent(&grown) {
            Extent::Finite(aabb) if is_sheet || is_pointed => (grown, aabb),
            _ => (field, aabb),
        };
        let program = program(&field);
        let mut random = Random::new(12);
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                // From the best of many inside points: step along the axis, fall back onto the shape, and keep what is
                // higher. On a ridge or at a corner the falling back goes along the faces in turn.
                let score = |p: DVec3| p[axis] * sign;
                let mut best: Option<DVec3> = None;
                for _ in 0..4000 {
                    let p = aabb.min + aabb.size() * DVec3::new(random.unit(), random.unit(), random.unit());
                    if program.value(p) < 0.0 && best.is_none_or(|b| score(p) > score(b)) {
                        best = Some(p);
                    }
                }
                let mut step = aabb.size().max_element() * 0.2;
                while step > 1e-4 {
                    let Some(b) = best else { break };
                    let mut p = b + DVec3::AXES[axis] * sign * step + random.direction() * step * 0.5;
                    for _ in 0..60 {
                        let (value, gradient) = program.gradient(p);
                        if value < 0.0 {
                            break;
                        }
                        p -= gradient * ((value + 1e-9) / gradient.length_squared().max(1e-6));
                    }
                    if program.value(p) < 0.0 && score(p) > score(b) {
                        best = Some(p);
                    } else {
                        step *= 0.985;
                    }
                }
                let best = best.unwrap_or_else(|| panic!("{name} {seed} is empty"));
                let face = if sign > 0.0 { aabb.max[axis] } else { aabb.min[axis] };
                assert!(
                    (face - best[axis]).abs() < 0.01 * aabb.size()[axis],
                    "{name} {seed}, axis {axis}: {face} for {} of {}",
                    best[axis],
                    notation(&field)
                );
            }
        }
    }
}

#[test]
fn the_extent_of_a_blend_of_many_stays_near() {
    use freikugel_field::shapes::*;
    let extent_of = |field: &Field| match extent(field) {
        Extent::Finite(aabb) => aabb,
        other => panic!("{other:?}"),
    };
    for order in [0.0, 1.0] {
        // Equal operands bulge most: on the axis the surface lies where the folded value vanishes.
        let blend = smooth_union(0.4, (0..200).map(|_| sphere(1.0))).with("order", &[order.into()]);
        let (aabb, program) = (extent_of(&blend), program(&blend));
        assert!(program.value(DVec3::X * aabb.max.x) >= 0.0);
        assert!(program.value(DVec3::X * (aabb.max.x - 0.1)) < 0.0, "a hundred steps come near k");
        assert!((aabb.max.x - 1.4).abs() < 1e-12, "{aabb:?}");
    }
    let two = extent_of(&smooth_union(0.4, [sphere(1.0), sphere(1.0)]));
    assert!((two.max.x - 1.1).abs() < 1e-12, "{two:?}");
}

#[test]
fn metrics_are_as_claimed() {
    use freikugel_field::shapes::*;
    let metric = |field: Field| {
        let contract = analyse(&field).0.expect("sound").contract;
        (contract.outside, contract.inside, contract.signed)
    };
    let (a, b) = (|| sphere(1.0), || cuboid([1.0, 1.0, 1.0]));
    assert_eq!(metric(a().into()), (Metric::Exact, Metric::Exact, true));
    assert_eq!(metric(a() | b()), (Metric::Exact, Metric::Bound, true));
    assert_eq!(metric(a() & b()), (Metric::Bound, Metric::Exact, true));
    assert_eq!(metric(a() - b()), (Metric::Bound, Metric::Exact, true));
    assert_eq!(metric(-(a() | b())), (Metric::Bound, Metric::Exact, true));
    assert_eq!(metric(a() - (b() & a())), (Metric::Bound, Metric::Bound, true));
    assert_eq!(metric(smooth_union(0.1, [a().at([0.0; 3]), b().at([0.0; 3])])), (Metric::Bound, Metric::Bound, true));
    assert_eq!(metric(a().at([1.0, 2.0, 3.0]).scale(2.0)), (Metric::Exact, Metric::Exact, true));
    assert_eq!(metric(a().stretch([1.0, 2.0, 1.0])), (Metric::Bound, Metric::Bound, true));
    assert_eq!(metric(a().stretch([2.0, -2.0, 2.0])), (Metric::Exact, Metric::Exact, true));
    assert_eq!(metric(b().offset(0.1)), (Metric::Exact, Metric::Bound, true));
    assert_eq!(metric(b().offset(-0.1)), (Metric::Bound, Metric::Exact, true));
    assert_eq!(metric(b().shell(0.1)), (Metric::Exact, Metric::Bound, true));
    assert_eq!(metric(sheet([0.0, 0.0, 1.0]).into()), (Metric::Exact, Metric::Exact, false));
    assert_eq!(metric(sheet([0.0, 0.0, 1.0]).offset(0.1)), (Metric::Exact, Metric::Bound, true));
    assert_eq!(metric(torus(0.5, 0.7).into()), (Metric::Exact, Metric::Bound, true));
}
