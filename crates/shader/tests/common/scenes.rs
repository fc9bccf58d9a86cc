//! Scenes from text, and those of the repository.

use freikugel_scene::Scene;
use std::path::{Path, PathBuf};

/// A scene from its text.
pub(crate) fn scene(text: &str, name: &str) -> Scene {
    let reading = freikugel_scene::read(text);
    reading.scene.unwrap_or_else(|| panic!("{name}: {:?}", reading.diagnostics))
}

/// A scene of one object, in scene notation.
pub(crate) fn scene_of(shape: &str) -> Scene {
    let materials = r##"{ "clay": { "color": "#c8825a" }, "glaze": { "color": "#5a82c8" } }"##;
    scene(&format!(r#"{{ "version": 1, "materials": {materials}, "objects": [{{ "shape": {shape} }}] }}"#), shape)
}

/// All scene files of the repository.
pub(crate) fn scene_files() -> Vec<PathBuf> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                walk(&path, found);
            } else if path.extension().is_some_and(|suffix| suffix == "json") {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    walk(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes"), &mut found);
    found.sort();
    found
}

/// The scene of a file.
pub(crate) fn read(path: &Path) -> Scene {
    scene(&std::fs::read_to_string(path).expect("a scene file"), &path.display().to_string())
}
