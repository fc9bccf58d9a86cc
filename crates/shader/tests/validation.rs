//! Every text passes independent judges: for the example of each shape, and for all scenes of the repository.

use freikugel_field::shapes;
use freikugel_scene::Scene;
use freikugel_shader::{Shader, Target};
use std::path::{Path, PathBuf};

/// A scene from its text.
fn scene(text: &str, name: &str) -> Scene {
    let reading = freikugel_scene::read(text);
    reading.scene.unwrap_or_else(|| panic!("{name}: {:?}", reading.diagnostics))
}

/// All scene files below a folder.
fn scene_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            scene_files(&path, found);
        } else if path.extension().is_some_and(|suffix| suffix == "json") {
            found.push(path);
        }
    }
}

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
        let text = format!(r#"{{ "version": 1, "objects": [{{ "shape": {} }}] }}"#, shape.about.example);
        check(&scene(&text, shape.about.name), shape.about.name);
    }
}

#[test]
fn all_scenes_become_valid_shaders() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut files = Vec::new();
    scene_files(&folder, &mut files);
    assert!(files.len() > 40, "{files:?}");
    for file in files {
        let text = std::fs::read_to_string(&file).expect("a scene file");
        check(&scene(&text, &file.display().to_string()), &file.display().to_string());
    }
}
