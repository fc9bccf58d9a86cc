//! Extents that had to be looked for.

mod common;

use common::Random;
use freikugel_field::shapes::*;
use freikugel_field::{
    Aabb, Extent, Field, Limits, Program, Structure, explore, extent, find_extent, find_radius, find_support,
};
use glam::DVec3;

/// The quartic of the benchmark scene.
const QUARTIC: &str = "(x-2)^2*(x+2)^2 + (y-2)^2*(y+2)^2 + (z-2)^2*(z+2)^2 + 3*(x^2*y^2 + x^2*z^2 + y^2*z^2) \
    - 6*x*y*z - 10*(x^2 + y^2 + z^2) + 22";

#[track_caller]
fn found(field: impl Into<Field>) -> Extent {
    find_extent(&field.into(), &Limits::default())
}

#[track_caller]
fn finite(field: impl Into<Field>) -> Aabb {
    match found(field) {
        Extent::Finite(aabb) => aabb,
        other => panic!("{other:?}"),
    }
}

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

#[track_caller]
fn assert_near(aabb: Aabb, min: [f64; 3], max: [f64; 3]) {
    let (min, max) = (DVec3::from_array(min), DVec3::from_array(max));
    let tolerance = 1e-3 * (max - min).max_element();
    let holds = aabb.min.cmple(min + 1e-9).all() && aabb.max.cmpge(max - 1e-9).all();
    assert!(holds, "{aabb:?} does not hold {min} to {max}");
    let is_tight = (aabb.min - min).abs().max_element() < tolerance && (aabb.max - max).abs().max_element() < tolerance;
    assert!(is_tight, "{aabb:?} is not {min} to {max}");
}

#[test]
fn bare_fields_get_their_boxes() {
    assert_near(finite(formula("x^2 + y^2 + z^2 - 1")), [-1.0; 3], [1.0; 3]);
    assert_near(finite(formula("x^2/4 + (y - 3)^2 + 4z^2 - 1")), [-2.0, 2.0, -0.5], [2.0, 4.0, 0.5]);
    assert_near(
        finite(formula("max(abs(x) - 1, abs(y) - 2, abs(z - 100) - 3)")),
        [-1.0, -2.0, 97.0],
        [1.0, 2.0, 103.0],
    );
    assert_near(finite(formula("hypot(x + 1, y, z) - 1")), [-2.0, -1.0, -1.0], [0.0, 1.0, 1.0]);
    // A surface alone, which no point that is tried lies inside of.
    assert_near(finite(formula("x^2 + y^2 + z^2 - 1").sheet()), [-1.0; 3], [1.0; 3]);
    // An intersection of unbounded things.
    let slabs =
        sheet([1.0, 0.0, 0.0]).offset(0.5) & sheet([0.0, 1.0, 0.0]).offset(0.25) & sheet([1.0, 0.0, 2.0]).offset(0.5);
    // Where |x + 2z| / sqrt(5) <= 1/2 and |x| <= 1/2.
    let corner = (0.5 * 5f64.sqrt() + 0.5) / 2.0;
    assert_near(finite(slabs), [-0.5, -0.25, -corner], [0.5, 0.25, corner]);
    // A small one far away.
    let far = formula("x^2 + y^2 + z^2 - 0.0001").at([300.0, -200.0, 0.0]);
    assert_near(finite(far), [299.99, -200.01, -0.01], [300.01, -199.99, 0.01]);
}

#[test]
fn the_quartic_is_framed_as_sampling_says() {
    let field: Field = formula(QUARTIC).into();
    let aabb = finite(field.clone());
    let (program, mut random) = (program(&field), Random::new(1));
    let mut reached = [0.0_f64; 3];
    for _ in 0..200_000 {
        let p = random.point(4.0);
        if program.value(p) < 0.0 {
            assert!(p.cmpge(aabb.min).all() && p.cmple(aabb.max).all(), "{p} outside of {aabb:?}");
            (0..3).for_each(|axis| reached[axis] = reached[axis].max(p[axis]));
        }
    }
    for axis in 0..3 {
        assert!(aabb.max[axis] < 4.0 && aabb.max[axis] - reached[axis] < 0.1, "{reached:?} for {aabb:?}");
    }
    // It is symmetric in its coordinates.
    assert!((aabb.max.x - aabb.max.y).abs() + (aabb.max.y - aabb.max.z).abs() < 0.02, "{aabb:?}");
}

#[test]
fn what_is_not_bounded_stays_so() {
    for text in ["x*y - 1", "x", "sin(x) + sin(y) + sin(z)", "x^2 + y^2 - 1", "x*y*z - 1e-3"] {
        assert_eq!(found(formula(text)), Extent::Unbounded, "{text}");
        assert_eq!(found(formula(text).sheet()), Extent::Unbounded, "{text} as a sheet");
    }
    assert_eq!(found(formula("1 - x^2 - y^2 - z^2")), Extent::Unbounded);
    assert_eq!(found(plane([0.0, 0.0, 1.0])), Extent::Unbounded);
    assert_eq!(found(!Field::from(sphere(1.0))), Extent::Unbounded);
    // Larger than what is looked through.
    assert_eq!(found(formula("x^2 + y^2 + z^2 - 1e10")), Extent::Unbounded);
    assert_eq!(found(formula("x^2 + y^2 + z^2 + 1")), Extent::Empty);
    // What is known is not looked for.
    assert_eq!(found(torus(0.5, 0.2)), extent(&torus(0.5, 0.2).into()));
}

#[test]
fn twists_are_found() {
    let twist = ["x*cos(z) + y*sin(z)", "y*cos(z) - x*sin(z)", "z"];
    let field = cuboid([1.0, 0.5, 6.0]).warp(twist);
    // Each end of the bar's section comes around to every side.
    let radius = 0.5 * 1.25f64.sqrt();
    assert_near(finite(field.clone()), [-radius, -radius, -3.0], [radius, radius, 3.0]);
    let exact = (radius * radius + 9.0_f64).sqrt();
    let sphere = find_radius(&field, DVec3::ZERO, &Limits::default()).expect("bounded");
    assert!((0.0..0.005).contains(&(sphere - exact)), "{sphere} for {exact}");
}

#[test]
fn slabs_and_spheres_are_found() {
    let limits = Limits::default();
    let ellipsoid: Field = formula("x^2/4 + y^2 + z^2/9 - 1").into();
    let n = DVec3::new(1.0, 2.0, -1.0).normalize();
    let exact = (n * DVec3::new(2.0, 1.0, 3.0)).length();
    let support = find_support(&ellipsoid, n, &limits).expect("bounded");
    assert!((-1e-9..0.01).contains(&(support - exact)), "{support} for {exact}");
    let radius = find_radius(&ellipsoid, DVec3::new(0.0, 0.0, 1.0), &limits).expect("bounded");
    assert!((-1e-9..0.01).contains(&(radius - 4.0)), "{radius}");
    assert_eq!(find_support(&formula("x*y - 1").into(), n, &limits), None);
}

#[test]
fn slopes_come_with_their_boxes() {
    let limits = Limits::default();
    let known = |field: Field| explore(&field, &limits).expect("sound").contract;
    let cut = known(formula("x^2 + y^2 + z^2 - 1").within_sphere(2.0).into());
    let (slope, within) = (cut.lipschitz.expect("found"), cut.within.expect("only there"));
    assert!((4.0..5.01).contains(&slope), "{slope}");
    assert_eq!((within.min, within.max), (DVec3::splat(-2.0), DVec3::splat(2.0)));
    let bare = known(formula("x^2 + y^2 + z^2 - 1").into());
    assert!((3.4..4.4).contains(&bare.lipschitz.expect("found")), "{bare:?}");
    // Waves have a slope everywhere, distances always did, and what has neither says so.
    assert_eq!(known(formula("sin(3x)").into()).within, None);
    assert!((known(formula("sin(3x)").into()).lipschitz.expect("known") - 3.0).abs() < 1e-9);
    assert_eq!(known(sphere(1.0).into()).lipschitz, Some(1.0));
    assert_eq!(known(formula("x*y - 1").into()).lipschitz, None);
}
