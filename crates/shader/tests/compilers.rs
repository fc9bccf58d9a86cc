//! Texts that no library here judges are compiled by the reference compiler of Khronos, `glslangValidator`: HLSL, and GLSL ES for
//! WebGL 2. `cargo xtask test-compilers` installs it.

mod common;

use common::{read, scene_files, scene_of};
use freikugel_field::shapes;
use freikugel_scene::Scene;
use freikugel_shader::{Shader, Target};
use std::path::Path;
use std::process::Command;

/// Languages, with the endings of files that the compiler knows them by, and what it is told.
const LANGUAGES: [(Target, &str, &[&str]); 2] =
    [(Target::Hlsl, "hlsl", &["-D", "-e", "render", "-S", "comp", "-V"]), (Target::Glsl, "frag", &["-S", "frag"])];

/// Has a text compiled; the messages if it can't be.
fn compile(text: &str, ending: &str, options: &[&str], folder: &Path) -> Result<(), String> {
    let file = folder.join(format!("scene.{ending}"));
    std::fs::write(&file, text).expect("a file");
    let output = Command::new("glslangValidator")
        .args(options)
        .args(if options.contains(&"-V") { &["-o", "scene.spv"][..] } else { &[] })
        .arg(&file)
        .current_dir(folder)
        .output()
        .expect("glslangValidator, of the package glslang-tools, is installed");
    if output.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&output.stdout).into_owned()) }
}

fn check(scene: &Scene, name: &str, folder: &Path) {
    let shader = Shader::new(scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    check_text(&shader, scene, name, folder);
}

fn check_text(shader: &Shader, scene: &Scene, name: &str, folder: &Path) {
    let parameters = shader.parameters(scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    for (target, ending, options) in LANGUAGES {
        let text = shader.text(target, &parameters).unwrap_or_else(|error| panic!("{name}: {error}"));
        compile(&text, ending, options, folder).unwrap_or_else(|error| panic!("{name}, {target:?}: {error}"));
    }
}

#[test]
#[ignore = "needs glslangValidator: cargo xtask test-compilers"]
fn the_reference_compiler_takes_all_texts() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("compilers");
    std::fs::create_dir_all(&folder).expect("a folder");
    // It does refuse what is wrong.
    for (_, ending, options) in LANGUAGES {
        assert!(compile("nonsense", ending, options, &folder).is_err(), "{ending}");
    }
    for shape in shapes::ALL {
        check(&scene_of(shape.about.example), shape.about.name, &folder);
    }
    let scene = scene_of(shapes::SPHERE.about.example);
    check_text(&Shader::of_voxels(&scene, 50).expect("a shader"), &scene, "voxels", &folder);
    for file in scene_files() {
        check(&read(&file), &file.display().to_string(), &folder);
    }
}
