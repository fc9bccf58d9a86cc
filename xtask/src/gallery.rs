//! The pictures of the gallery, all made from scenes.

use crate::reference;
use crate::run::{Result, output, root, run};
use std::path::{Path, PathBuf};

/// Contact sheets: the file below `gallery/`, the command and its scene below `scenes/`, and further arguments.
const SHEETS: [(&str, &str, &str, &[&str]); 9] = [
    ("tracers/max-distance.png", "sweep", "tracers/limits.json", &["--vary", "tracer.max_distance=100,9,6.3"]),
    ("tracers/precision.png", "sweep", "tracers/limits.json", &["--vary", "tracer.precision=1e-5,0.1,1"]),
    ("tracers/steps.png", "sweep", "tracers/limits.json", &["--vary", "tracer.max_steps=100,10,5"]),
    (
        "tracers/shadow-hardness.png",
        "sweep",
        "sources/sphere-on-plane.json",
        &["--vary", "lights[0].sun.shadow.hardness=8,16,32,64,128,256", "--width", "300", "--height", "200"],
    ),
    (
        "slices/distance.png",
        "slice",
        "first-light.json",
        &["--axis", "y", "--width", "400", "--height", "260", "--quiet"],
    ),
    (
        "slices/slope.png",
        "slice",
        "first-light.json",
        &["--axis", "y", "--show", "slope", "--width", "400", "--height", "260", "--quiet"],
    ),
    (
        "slices/steps.png",
        "slice",
        "shapes/ellipsoid_bound.json",
        &["--show", "steps", "--width", "400", "--height", "260", "--quiet"],
    ),
    ("tracers/compare-distances.png", "compare", "tracers/thin.json", &["--width", "210", "--height", "140"]),
    ("tracers/compare-formula.png", "compare", "bench/s3-periodic.json", &["--width", "210", "--height", "140"]),
];

/// Scenes that move: the file below `gallery/`, the scene below `scenes/`, and further arguments.
const MOVING: [(&str, &str, &[&str]); 1] = [(
    "animation/gears.gif",
    "animation/gears.json",
    &["--frames", "0..12", "--fps", "12", "--samples", "4", "--width", "240", "--height", "180"],
)];

/// The largest picture that is kept with the sources, in bytes.
const LARGEST: u64 = 200_000;

/// Renders every scene into a picture, the contact sheets, and what moves.
pub(crate) fn gallery() -> Result {
    let root = root();
    for scene in scenes(&root.join("scenes"))? {
        let below = scene.strip_prefix(root.join("scenes")).expect("found below it").with_extension("png");
        make(&root, &below, &["render", "--small", &scene.display().to_string()])?;
    }
    for (file, command, scene, arguments) in SHEETS {
        let scene = root.join("scenes").join(scene).display().to_string();
        make(&root, Path::new(file), &[&[command, scene.as_str()], arguments].concat())?;
    }
    for (file, scene, arguments) in MOVING {
        let scene = root.join("scenes").join(scene).display().to_string();
        make(&root, Path::new(file), &[&["render", scene.as_str()], arguments].concat())?;
    }
    thumbnails(&root)
}

/// A picture of each shape's example.
fn thumbnails(root: &Path) -> Result {
    let folder = root.join("target/reference");
    std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let ask = |args: &[&str]| {
        output(root, "cargo", &[&["run", "--quiet", "--release", "-p", "freikugel", "--"], args].concat())
    };
    for name in reference::names(&ask)? {
        let scene = folder.join(&name).with_extension("json");
        let text = ask(&["help", "shapes", &name, "--scene"])?;
        std::fs::write(&scene, text).map_err(|e| e.to_string())?;
        let below = Path::new("reference").join(&name).with_extension("png");
        make(root, &below, &["render", "--small", &scene.display().to_string(), "--width", "240", "--height", "180"])?;
    }
    Ok(())
}

/// Has the program make a picture of the gallery.
fn make(root: &Path, below: &Path, arguments: &[&str]) -> Result {
    let picture = root.join("gallery").join(below);
    std::fs::create_dir_all(picture.parent().expect("a file in a folder")).map_err(|e| e.to_string())?;
    let output = picture.display().to_string();
    let program = ["run", "--quiet", "--release", "-p", "freikugel", "--"];
    run(root, "cargo", &[&program[..], arguments, &["-o", &output]].concat())?;
    match std::fs::metadata(&picture).map_err(|e| e.to_string())?.len() {
        size if size > LARGEST => Err(format!("{output} has {size} bytes, more than {LARGEST}")),
        _ => Ok(()),
    }
}

/// All scene files below a folder, in order.
pub(crate) fn scenes(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let entries = std::fs::read_dir(folder).map_err(|e| format!("can't read {}: {e}", folder.display()))?;
    for entry in entries {
        let path = entry.map_err(|e| e.to_string())?.path();
        if path.is_dir() {
            found.extend(scenes(&path)?);
        } else if path.extension().is_some_and(|e| e == "json") {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}
