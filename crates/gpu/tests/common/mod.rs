//! What tests on a graphics processor share. They fail where there is none, rather than pass without having seen anything.

#![allow(dead_code, reason = "not every test uses everything")]

use freikugel_gpu::{Choice, Gpu};
use freikugel_scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The graphics processor that tests run on; software is as good as any.
pub(crate) fn gpu() -> Arc<Gpu> {
    let gpu = Gpu::open(&Choice::Automatic).unwrap_or_else(|error| panic!("this test needs one: {error}"));
    Arc::new(gpu)
}

/// A scene from its text.
pub(crate) fn scene(text: &str, name: &str) -> Scene {
    let reading = freikugel_scene::read(text);
    reading.scene.unwrap_or_else(|| panic!("{name}: {:?}", reading.diagnostics))
}

/// All scenes of the repository, by their paths below its folder of scenes, in order.
pub(crate) fn scenes() -> Vec<(String, Scene)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut files = Vec::new();
    collect(&folder, &mut files);
    files.sort();
    let read = |file: &PathBuf| {
        let name = file.strip_prefix(&folder).expect("below it").with_extension("").display().to_string();
        let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{name}: {error}"));
        (name.clone(), scene(&text, &name))
    };
    files.iter().map(read).collect()
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|suffix| suffix == "json") {
            found.push(path);
        }
    }
}
