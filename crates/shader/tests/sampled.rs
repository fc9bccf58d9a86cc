//! Sampled scenes beside their fields in double precision, and beside what reads the samples on the processor.

mod common;

use common::{Machine, Value, read, scene};
use freikugel_field::Structure;
use freikugel_grid::Bricks;
use freikugel_render::Plan;
use freikugel_scene::Scene;
use freikugel_shader::{SampleError, Shader, ShaderError, Target, View, sample};
use glam::Vec3;
use std::path::Path;

/// Rounding errors of values of scenes about this large.
const ROUNDING: f64 = 1e-4;

const SCENES: [&str; 3] = ["first-light.json", "gpu/primitives-100.json", "sources/column-with-bowl.json"];

fn of_file(file: &str) -> Scene {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(file))
}

fn of_shape(shape: &str) -> Scene {
    scene(&format!(r#"{{ "version": 1, "objects": [{{ "name": "it", "shape": {shape} }}] }}"#), "it")
}

/// Points spread evenly over the box of samples and around it (an additive recurrence: multiples of three irrational steps,
/// modulo 1).
fn points(bricks: &Bricks, count: u32, around: f32) -> impl Iterator<Item = Vec3> {
    let (min, max) = (bricks.lattice().min(), bricks.lattice().max());
    let (middle, half) = (0.5 * (min + max), 0.5 * around * (max - min));
    let steps = [0.819_172_5, 0.671_043_6, 0.549_700_5];
    (1..=count).map(move |i| {
        let share = steps.map(|step: f64| (f64::from(i) * step).fract() as f32);
        middle + half * (2.0 * Vec3::from(share) - 1.0)
    })
}

#[test]
fn samples_are_the_field_of_the_scene() {
    for file in SCENES {
        let scene = of_file(file);
        let plan = Plan::new(&scene, 64, 36, 1).expect("a plan");
        let bricks = sample(&scene, 64).unwrap_or_else(|error| panic!("{file}: {error}"));
        let marched = scene.objects.iter().zip(&plan.objects).filter(|(_, planned)| planned.exact.is_none());
        let fields: Vec<_> = marched.map(|(object, _)| object.shape.clone()).collect();
        let program = Structure::compile(&fields).expect("fields").program(plan.origin);
        let half_diagonal = 0.5 * 3f64.sqrt() * f64::from(bricks.lattice().voxel());
        let mut near = 0;
        for p in points(&bricks, 4000, 1.0) {
            let value = program.value(plan.origin + p.as_dvec3()) * plan.scale;
            if bricks.label(p).is_some() {
                near += 1;
                assert!((f64::from(bricks.value(p)) - value).abs() <= half_diagonal + ROUNDING, "{file}: {p}");
            } else {
                assert!(f64::from(bricks.free(p)).abs() <= value.abs() + ROUNDING, "{file}: {p}");
            }
        }
        assert!((200..3800).contains(&near), "{file}: {near}");
    }
}

#[test]
fn shaders_read_samples_as_the_processor_does() {
    for file in SCENES {
        let scene = of_file(file);
        let plan = Plan::new(&scene, 64, 36, 1).expect("a plan");
        let shader = Shader::of_voxels(&scene, 50).expect("a shader");
        let parameters = shader.parameters(&scene).expect("numbers");
        let machine = Machine::new(&shader, &parameters, &View::of(64, 36));
        let bricks = sample(&scene, 50).expect("samples");
        let argument = |p: Vec3| Value::Vector(p.as_dvec3().to_array().to_vec());
        for p in points(&bricks, 500, 2.0) {
            let near = |found: &Value, expected: f32| {
                let found = found.vector()[0] * plan.scale;
                assert!((found - f64::from(expected)).abs() < ROUNDING, "{file}, {p}: {found}, not {expected}");
            };
            near(&machine.call("unscaled", vec![argument(p), Value::Float(1e30)]), bricks.value(p));
            let reach = machine.call("reach_at", vec![argument(p), Value::Int(0)]);
            near(&reach, bricks.free(p));
            // A surface may be only where fine samples are.
            if reach.vector()[1] < 0.0 {
                assert!(bricks.free(p) > 0.0, "{file}, {p}");
            }
        }
    }
}

#[test]
fn what_can_not_be_sampled_is_told() {
    let refused =
        |scene: &Scene, count: u32| match Shader::of_voxels(scene, count).map(|shader| shader.parameters(scene)) {
            Err(ShaderError::Sample(error)) | Ok(Err(ShaderError::Sample(error))) => error,
            _ => panic!("no error"),
        };
    assert_eq!(refused(&of_shape(r#"{ "plane": {} }"#), 50), SampleError::Unbounded);
    assert_eq!(refused(&of_shape(r#"{ "formula": "x^2 + y^2 + z^2 - 1" }"#), 50), SampleError::Unscaled("it".into()));
    let endless = r#"{ "complement": { "shape": { "sphere": { "radius": 1 } } } }"#;
    assert_eq!(refused(&of_shape(endless), 50), SampleError::Unbounded);
    let ball = of_shape(r#"{ "sphere": { "radius": 1 } }"#);
    assert!(matches!(refused(&ball, 5), SampleError::Grid(_)));
    let shader = Shader::of_voxels(&ball, 50).expect("a shader");
    let text = shader.text(Target::Shadertoy, &shader.parameters(&ball).expect("numbers"));
    assert!(matches!(text, Err(ShaderError::Sample(SampleError::Host("Shadertoy")))));
}

#[test]
fn no_shape_changes_the_text() {
    let [ball, cup] = [
        r#"{ "sphere": { "radius": 1 } }"#,
        r#"{ "difference": [{ "box": { "size": 2 } }, { "torus": { "major": 1, "minor": 0.3 } }] }"#,
    ]
    .map(of_shape);
    let shader = Shader::of_voxels(&ball, 50).expect("a shader");
    let [of_ball, of_cup] = [&ball, &cup].map(|scene| shader.parameters(scene).expect("numbers"));
    assert_eq!(
        shader.text(Target::Wgsl, &of_ball).expect("a text"),
        shader.text(Target::Wgsl, &of_cup).expect("a text")
    );
    assert_ne!(of_ball.voxels(), of_cup.voxels());
}
