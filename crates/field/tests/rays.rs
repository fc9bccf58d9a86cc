//! Exact ray intersections against the field along the ray.

use freikugel_field::ray::ExactRay;
use freikugel_field::shapes::*;
use freikugel_field::{Field, MaterialId, Structure};
use glam::DVec3;

fn planes() -> Vec<Field> {
    let plane = || plane([1.0, 2.0, -0.5]).offset_by(0.3);
    let sheet = || sheet([0.0, 1.0, 3.0]).offset_by(-0.2);
    vec![
        plane().into(),
        sheet().into(),
        plane().at([0.3, -0.7, 1.1]).rotate([1.0, 1.0, 0.2], 70.0),
        sheet().scale(-2.5).at([1.0, 0.0, 0.0]),
        plane().stretch([1.0, 3.0, -0.5]).reflect([1.0, 1.0, 0.0]).painted(MaterialId(0)),
        union([plane().rotate_euler([10.0, 20.0, 30.0])]),
    ]
}

#[test]
fn hits_lie_where_the_field_first_vanishes() {
    let mut hits = 0;
    for field in planes() {
        let exact = ExactRay::of(&field).expect("nothing but a plane");
        let program = Structure::compile(&[field]).expect("sound").program(DVec3::ZERO);
        for i in 0..200 {
            let angle = f64::from(i) * 2.4;
            let origin = DVec3::new(angle.sin(), (angle * 1.7).cos(), (angle * 0.3).sin()) * 3.0;
            let direction = DVec3::new((angle * 0.9).cos(), (angle * 2.1).sin(), (angle * 1.3).cos()).normalize();
            match exact.hit(origin, direction) {
                Some(0.0) => assert!(program.value(origin) <= 1e-12),
                Some(t) => {
                    hits += 1;
                    assert!(program.value(origin + direction * t).abs() < 1e-9);
                    assert!((0..100).all(|k| program.value(origin + direction * (t * f64::from(k) / 100.0)) > 0.0));
                }
                None => assert!((0..100).all(|k| program.value(origin + direction * f64::from(k)) > 0.0)),
            }
        }
    }
    assert!(hits > 300, "only {hits}");
}

#[test]
fn other_fields_have_none() {
    let fields: [Field; 3] =
        [sphere(1.0).into(), plane([0.0, 0.0, 1.0]) | sphere(1.0), plane([0.0, 0.0, 1.0]).offset(0.1)];
    assert!(fields.iter().all(|field| ExactRay::of(field).is_none()));
}
