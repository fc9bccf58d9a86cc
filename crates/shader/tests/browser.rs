//! Pictures that a browser draws from the text for WebGL 2, and from the text for Shadertoy in a page with Shadertoy's inputs: they
//! have to look like those of the processor.
//!
//! `cargo xtask test-browser` installs what this needs (Node.js with `playwright-core`, Chromium) and runs it. Screenshots stay in
//! `target/tmp/browser`.

mod common;
#[path = "common/judge.rs"]
mod judge;

use common::{read, scene, scene_of};
use freikugel_render::{Options, Tone, render};
use freikugel_scene::{Light, Scene, Sun};
use freikugel_shader::glsl::BLOCK_VECTORS;
use freikugel_shader::{Parameters, Shader, TEXTURE_WIDTH, Target, VOXELS_WIDTH};
use glam::{DMat3, DVec3};
use judge::Difference;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The size of all pictures. There is one ray a pixel: the browser gives bytes, which can't be averaged. So each ray that
/// grazes an edge is a whole outlier.
const SIZE: [u32; 2] = [160, 90];

/// Scenes of the repository that are drawn.
const SCENES: [&str; 10] = [
    "first-light",
    "sources/blends",
    "sources/column-with-bowl",
    "bench/s1-csg",
    "bench/s2-quartic",
    "tracers/thin",
    "shapes/formula",
    "shapes/warp",
    "shapes/sheet",
    "shapes/quaternion_julia",
];

/// Objects of the large scene: so many that they are found by walks through a table.
const MANY: usize = 100;

/// Operands of the large blend, whose numbers are too many for single uniforms.
const BLENDED: usize = 100;

/// Lights of the scene that is too large even for blocks of uniforms.
const MANY_LIGHTS: usize = 3000;

/// Voxels along the longest side of the scene that is sampled, and how much its picture may differ on the mean.
const VOXELS: u32 = 100;
const MEAN_OF_VOXELS: f64 = 1.0;

/// A picture for the browser, and what it has to look like.
struct Job {
    name: String,
    target: Target,
    text: String,
    table: Vec<f32>,
    /// Samples of the scene, if it is drawn by these.
    voxels: Vec<[f32; 2]>,
    /// Shadertoy's `iMouse`.
    mouse: [f32; 4],
    /// The scene as the browser should show it, and the processor's picture of it.
    scene: Scene,
    expected: Vec<u8>,
}

fn sized(mut scene: Scene) -> Scene {
    [scene.picture.width, scene.picture.height] = SIZE;
    scene.picture.samples = 1;
    scene
}

fn on_cpu(scene: &Scene) -> Vec<u8> {
    let rendered = render(scene, &Options::of(scene), &()).expect("a picture");
    rendered.image.to_srgb8(&Tone::of(&scene.picture))
}

/// The jobs of a scene, one for each target.
fn jobs(name: &str, scene: Scene) -> Vec<Job> {
    let scene = sized(scene);
    let expected = on_cpu(&scene);
    let shader = Shader::new(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let parameters = shader.parameters(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let job = |(target, kind): (Target, &str)| Job {
        name: format!("{}-{kind}", name.replace('/', "-")),
        target,
        text: text(&shader, target, &parameters),
        table: parameters.numbers().to_vec(),
        voxels: Vec::new(),
        mouse: [0.0; 4],
        scene: scene.clone(),
        expected: expected.clone(),
    };
    [(Target::Glsl, "webgl"), (Target::Shadertoy, "shadertoy")].map(job).into()
}

/// A scene by its samples.
fn sampled(name: &str, scene: Scene) -> Job {
    let scene = sized(scene);
    let shader = Shader::of_voxels(&scene, VOXELS).unwrap_or_else(|error| panic!("{name}: {error}"));
    let parameters = shader.parameters(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    Job {
        name: name.to_owned(),
        target: Target::Glsl,
        text: text(&shader, Target::Glsl, &parameters),
        table: parameters.numbers().to_vec(),
        voxels: parameters.voxels().to_vec(),
        mouse: [0.0; 4],
        expected: on_cpu(&scene),
        scene,
    }
}

fn text(shader: &Shader, target: Target, parameters: &Parameters) -> String {
    shader.text(target, parameters).unwrap_or_else(|error| panic!("{error}"))
}

/// A scene of many primitives on a plane.
fn many() -> Scene {
    let mut objects = String::from(r#"{ "material": "m0", "shape": { "plane": {} } }"#);
    for index in 0..MANY {
        let (column, row) = (index % 10, index / 10);
        let shape = match index % 4 {
            0 => r#"{ "sphere": { "radius": 0.4 } }"#,
            1 => r#"{ "box": { "size": 0.6, "round": 0.05 } }"#,
            2 => r#"{ "torus": { "major": 0.3, "minor": 0.1 } }"#,
            _ => r#"{ "cylinder": { "radius": 0.3, "height": 0.7 } }"#,
        };
        let (x, y) = (column as f64 - 4.5, row as f64 - 4.5);
        let _ = write!(
            objects,
            r#", {{ "material": "m{}", "shape": {{ "translate": {{ "by": [{x}, {y}, 0.4], "shape": {shape} }} }} }}"#,
            index % 3
        );
    }
    let materials = r##""m0": { "color": "#b0b0a8" }, "m1": { "color": "#c8825a" }, "m2": { "color": "#5a82c8" }"##;
    let camera = r#"{ "eye": [6, -12, 8], "target": [0, -0.5, 0], "fov": 38 }"#;
    let text =
        format!(r#"{{ "version": 1, "camera": {camera}, "materials": {{ {materials} }}, "objects": [{objects}] }}"#);
    scene(&text, "many objects")
}

/// A single object with many numbers.
fn blend() -> Scene {
    let mut shapes = Vec::new();
    for index in 0..BLENDED {
        let (x, y) = ((index % 10) as f64 * 0.2 - 0.9, (index / 10) as f64 * 0.2 - 0.9);
        let shape = format!(r#"{{ "box": {{ "size": [0.3, 0.3, {}], "round": 0.1 }} }}"#, 0.3 + 0.01 * index as f64);
        shapes.push(format!(r#"{{ "translate": {{ "by": [{x}, {y}, 0], "shape": {shape} }} }}"#));
    }
    scene_of(&format!(r#"{{ "smooth_union": {{ "k": 0.1, "shapes": [{}] }} }}"#, shapes.join(", ")))
}

/// A scene whose lights have so many numbers that no blocks of uniforms hold them. All but one are dark.
fn many_lights() -> Scene {
    let mut scene = scene_of(r#"{ "box": { "size": [1.2, 1, 0.8] } }"#);
    let lit = Light::Sun(Sun { direction: DVec3::new(-1.0, -2.0, 2.0), ..Sun::default() });
    let dark = Light::Sun(Sun { intensity: 0.0, ..Sun::default() });
    scene.lights = vec![dark; MANY_LIGHTS];
    scene.lights.push(lit);
    scene
}

/// Shadertoy's picture while the mouse is dragged to a place, and the processor's from where the camera then is.
fn dragged(name: &str, scene: Scene, mouse: f32) -> Job {
    let scene = sized(scene);
    let shader = Shader::new(&scene).expect("a shader");
    let parameters = shader.parameters(&scene).expect("parameters");
    let angle = TAU * (0.5 - f64::from(mouse));
    let mut turned = scene.clone();
    let camera = turned.camera.as_mut().expect("a camera of its own");
    camera.eye = camera.target + DMat3::from_axis_angle(DVec3::Z, angle) * (camera.eye - camera.target);
    let place = [mouse * SIZE[0] as f32, 0.5 * SIZE[1] as f32];
    Job {
        name: name.to_owned(),
        target: Target::Shadertoy,
        text: text(&shader, Target::Shadertoy, &parameters),
        table: Vec::new(),
        voxels: Vec::new(),
        mouse: [place[0], place[1], place[0], place[1]],
        expected: on_cpu(&turned),
        scene: turned,
    }
}

/// Has the browser draw all jobs, and gives what it says to each: where the parameters were, and its times.
fn draw(jobs: &[Job]) -> (PathBuf, HashMap<String, String>) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("browser");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder for pictures");
    let mut list = Vec::new();
    for Job { name, target, text, table, voxels, mouse, .. } in jobs {
        let write = |ending: &str, bytes: &[u8]| {
            std::fs::write(folder.join(format!("{name}.{ending}")), bytes).expect("a file for the browser");
        };
        write("glsl", text.as_bytes());
        for (ending, numbers) in [("f32", &**table), ("voxels", voxels.as_flattened())] {
            write(ending, &numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>());
        }
        let kind = if *target == Target::Shadertoy { "shadertoy" } else { "webgl" };
        let [width, height] = SIZE;
        list.push(format!(
            r#"{{ "name": "{name}", "kind": "{kind}", "width": {width}, "height": {height}, "blockVectors": {BLOCK_VECTORS}, "textureWidth": {TEXTURE_WIDTH}, "voxelsWidth": {VOXELS_WIDTH}, "mouse": {mouse:?} }}"#
        ));
    }
    std::fs::write(folder.join("jobs.json"), format!("[{}]", list.join(",\n"))).expect("a list for the browser");
    let driver = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser/run.mjs");
    let output = Command::new("node")
        .arg(driver)
        .arg(&folder)
        .output()
        .unwrap_or_else(|error| panic!("this test needs Node.js: {error}; `cargo xtask test-browser` sets it up"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}\n`cargo xtask test-browser` installs what is missing");
    let lines = String::from_utf8(output.stdout).expect("text");
    let said = lines.lines().filter_map(|line| line.split_once('\t')).map(|(name, rest)| (name.into(), rest.into()));
    (folder, said.collect())
}

#[test]
#[ignore = "needs a browser: cargo xtask test-browser"]
fn browsers_draw_what_the_processor_draws() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let file = |name: &str| read(&folder.join(name).with_extension("json"));
    let mut all: Vec<Job> = SCENES.iter().flat_map(|name| jobs(name, file(name))).collect();
    all.extend(jobs("many", many()));
    all.extend(jobs("blend", blend()));
    // As a constant in a text, that many numbers are of no use.
    all.extend(jobs("lights", many_lights()).into_iter().filter(|job| job.target == Target::Glsl));
    // To the middle, which is where the camera is; and a quarter turn.
    all.push(dragged("drag-middle", file("first-light"), 0.5));
    all.push(dragged("drag-quarter", file("first-light"), 0.25));
    all.push(sampled("voxels", file("gpu/voxels")));

    let (folder, said) = draw(&all);
    let mut faults = Vec::new();
    for Job { name, scene, expected, voxels, .. } in &all {
        let found = std::fs::read(folder.join(format!("{name}.rgb"))).unwrap_or_else(|error| panic!("{name}: {error}"));
        let difference = Difference::of(&found, expected);
        let summary = format!("{name}: {difference}");
        println!("{summary}; {}", said[name].replace('\t', ", "));
        let is_too_large = match voxels.is_empty() {
            true => difference.is_too_large(scene, expected, on_cpu),
            false => difference.mean > MEAN_OF_VOXELS,
        };
        if is_too_large {
            faults.push(summary);
        }
    }
    assert!(faults.is_empty(), "{} pictures differ:\n{}", faults.len(), faults.join("\n"));
    let way = |name: &str| said[name].split('\t').next().expect("a word").to_owned();
    assert_eq!(
        ["shapes-sheet-webgl", "blend-webgl", "many-webgl", "lights-webgl"].map(way),
        ["uniforms", "blocks", "texture", "texture"]
    );
}
