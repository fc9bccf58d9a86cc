//! The measure of the design: a new shape is one file.
//!
//! Copies the workspace to a scratch folder, adds a shape there from a template, regenerates what is generated, and asks
//! for it everywhere: on the command line, in a picture, as shader text, in the schema and in the documentation.

use crate::run::{Result, SCHEMA, freikugel, output, root, run, schema};
use crate::shapes;
use std::path::Path;

/// A shape that the project does not have: an octahedron, as the bound that its faces' planes give.
const TEMPLATE: &str = r##"//! Probe: the octahedron as a bound.

use crate::shape_prelude::*;

/// See [`probe_shape`].
#[derive(Clone, Copy, Debug)]
pub struct ProbeShape;

/// The descriptor of [`probe_shape`].
pub static PROBE_SHAPE: Shape = Shape::primitive::<ProbeShape>();

/// An octahedron.
#[track_caller]
pub fn probe_shape(radius: impl Into<Value>) -> Form<ProbeShape> {
    Form::new(&PROBE_SHAPE, [radius.into()])
}

impl Primitive for ProbeShape {
    const ABOUT: About = About {
        name: "probe_shape",
        summary: "An octahedron for probing.",
        params: &[Param::required("radius", ParamKind::Positive, "Distance from the centre to a corner.")],
        elsewhere: &[],
        example: r#"{ "probe_shape": { "radius": 1 } }"#,
    };

    fn contract(_args: &[f64]) -> Contract {
        Contract { outside: Metric::Bound, ..Contract::EXACT }
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        (args[0] + level * 3.0_f64.sqrt()) * direction.abs().max_element()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [radius] = c.get();
        let q = p.abs();
        (q.x + q.y + q.z - radius) * 0.577_350_269_189_625_8
    }
}
"##;

const NAME: &str = "probe_shape";

/// Runs the probe.
pub(crate) fn shape() -> Result {
    let (from, scratch) = (root(), root().join("target/probe/workspace"));
    if scratch.exists() {
        std::fs::remove_dir_all(&scratch).map_err(|e| e.to_string())?;
    }
    copy_tracked(&from, &scratch)?;
    run(&scratch, "git", &["init", "--quiet"])?;
    run(&scratch, "git", &["add", "--all"])?;

    let file = format!("crates/field/src/shapes/{NAME}.rs");
    std::fs::write(scratch.join(&file), TEMPLATE).map_err(|e| e.to_string())?;
    shapes::write(&scratch)?;
    // Not the workspace's own target folder: the copy's crates have the same names and would pass for the real ones.
    let target = from.join("target/probe/target");
    let target = target.to_str().ok_or("the path of the target folder is no text")?;
    std::fs::write(scratch.join(".cargo/config.toml"), format!("[build]\ntarget-dir = {target:?}\n"))
        .map_err(|e| e.to_string())?;
    schema(&scratch)?;

    let differing = ["ls-files", "--modified", "--others", "--exclude-standard"];
    let mut changed: Vec<String> = output(&scratch, "git", &differing)?
        .lines()
        .map(str::to_owned)
        .filter(|path| path != ".cargo/config.toml")
        .collect();
    changed.sort();
    let expected = ["crates/field/src/shapes.rs", file.as_str(), SCHEMA];
    if changed != expected {
        return Err(format!("a new shape should change {expected:?}, but it changed {changed:?}"));
    }
    let schema = std::fs::read_to_string(scratch.join(SCHEMA)).map_err(|e| e.to_string())?;
    expect("the schema", &schema, &[NAME, "An octahedron for probing.", "Distance from the centre to a corner."])?;

    let with = |args: &[&str]| freikugel(&scratch, args);
    let documentation = with(&["help", "shapes", NAME])?;
    expect("the documentation", &documentation, &["An octahedron for probing.", "radius"])?;
    let scene = scratch.join("target-probe.json");
    std::fs::write(&scene, format!(r#"{{ "objects": [ {{ "shape": {{ "{NAME}": {{ "radius": 1 }} }} }} ] }}"#))
        .map_err(|e| e.to_string())?;
    let scene = scene.to_str().ok_or("the path of the scratch folder is no text")?;
    expect("info", &with(&["info", scene])?, &[NAME])?;
    with(&["render", scene, "--width", "16", "--height", "16", "--samples", "1", "-o", "target-probe.png"])?;
    // What the command writes is valid.
    expect("the shader", &with(&["shader", scene, "--target", "wgsl", "--output", "-"])?, &[NAME])?;
    // Every number type. (The tests that need to know what lies inside are for its author.)
    let tests = ["lanes_agree", "gradients_agree", "hessians_agree", "intervals_contain", "expressions_compute"];
    // With the command's package beside the other: what is already built has its features.
    let packages = ["-p", "freikugel-field", "-p", "freikugel", "--no-default-features"];
    let conformance = [&["test", "--quiet"][..], &packages, &["--test", "conformance", "--"]].concat();
    run(&scratch, "cargo", &[&conformance[..], &tests].concat())?;
    // The command as small as it gets, which is built nowhere else.
    run(
        &scratch,
        "cargo",
        &[&["test", "--quiet"][..], &packages, &["--test", "command", "--test", "graphics"]].concat(),
    )
}

fn expect(what: &str, text: &str, words: &[&str]) -> Result {
    match words.iter().find(|word| !text.contains(**word)) {
        Some(word) => Err(format!("{what} does not have {word:?} of the new shape")),
        None => Ok(()),
    }
}

/// Copies all files that git knows or would take up.
pub(crate) fn copy_tracked(from: &Path, to: &Path) -> Result {
    let files = output(from, "git", &["ls-files", "--cached", "--others", "--exclude-standard"])?;
    for file in files.lines() {
        let (source, copy) = (from.join(file), to.join(file));
        if !source.is_file() {
            continue;
        }
        let folder = copy.parent().ok_or("a file without folder")?;
        std::fs::create_dir_all(folder).map_err(|e| e.to_string())?;
        std::fs::copy(&source, &copy).map_err(|e| format!("can't copy {file}: {e}"))?;
    }
    Ok(())
}
