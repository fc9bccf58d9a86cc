//! What tests on a graphics processor share. They fail where there is none, rather than pass without having seen anything.

#![allow(dead_code, reason = "not every test uses everything")]

#[path = "../../../shader/tests/common/scenes.rs"]
mod scenes;

pub(crate) use scenes::scene;

use freikugel_gpu::{Choice, Gpu};
use freikugel_scene::Scene;
use std::path::Path;
use std::sync::Arc;

/// The graphics processor that tests run on; software is as good as any.
pub(crate) fn gpu() -> Arc<Gpu> {
    let gpu = Gpu::open(&Choice::Automatic).unwrap_or_else(|error| panic!("this test needs one: {error}"));
    Arc::new(gpu)
}

/// All scenes of the repository, by their paths below its folder of scenes, in order.
pub(crate) fn scenes() -> Vec<(String, Scene)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let name = |file: &Path| file.strip_prefix(&folder).expect("below it").with_extension("").display().to_string();
    scenes::scene_files().iter().map(|file| (name(file), scenes::read(file))).collect()
}
