//! Every text passes independent judges: for the example of each shape, and for all scenes of the repository.

mod common;
#[path = "../../field/tests/common/mod.rs"]
mod fields;

use common::{read, scene, scene_files, scene_of};
use freikugel_field::shapes::{self, Extrude, Offset};
use freikugel_field::{Dimension, analyse};
use freikugel_scene::Scene;
use freikugel_shader::{Shader, Target};

fn check(scene: &Scene, name: &str) {
    let shader = Shader::new(scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let parameters = shader.parameters(scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    for (target, _) in Target::ALL {
        let text = shader.text(target, &parameters).unwrap_or_else(|error| panic!("{name}, {target:?}: {error}"));
        assert!(!text.is_empty());
    }
}

#[test]
fn all_shapes_become_valid_shaders() {
    for shape in shapes::ALL {
        check(&scene_of(shape.about.example), shape.about.name);
    }
}

#[test]
fn samples_become_valid_shaders() {
    let on_plane =
        r#"{ "version": 1, "objects": [{ "shape": { "plane": {} } }, { "shape": { "sphere": { "radius": 1 } } }] }"#;
    for scene in [scene_of(r#"{ "sphere": { "radius": 1 } }"#), scene(on_plane, "on a plane")] {
        let shader = Shader::of_voxels(&scene, 50).expect("a shader");
        let parameters = shader.parameters(&scene).expect("numbers");
        for (target, _) in Target::ALL.into_iter().filter(|(target, _)| *target != Target::Shadertoy) {
            let text = shader.text(target, &parameters).unwrap_or_else(|error| panic!("{target:?}: {error}"));
            assert!(text.contains("voxel"), "{target:?}");
        }
    }
}

#[test]
fn shapes_with_any_arguments_become_valid_shaders() {
    for (name, seed, field) in fields::every_shape(2) {
        let mut scene = scene_of(r#"{ "sphere": { "radius": 1 } }"#);
        // Figures by themselves are nothing to be lit.
        let contract = analyse(&field).0.expect("sound").contract;
        scene.objects[0].shape = match contract.dimension {
            Dimension::Plane if contract.signed => field.extrude(1.0),
            Dimension::Plane => field.offset(0.1).extrude(1.0),
            Dimension::Space => field,
        };
        check(&scene, &format!("{name} {seed}"));
    }
}

#[test]
fn all_scenes_become_valid_shaders() {
    let files = scene_files();
    assert!(files.len() > 40, "{files:?}");
    for file in files {
        check(&read(&file), &file.display().to_string());
    }
}
