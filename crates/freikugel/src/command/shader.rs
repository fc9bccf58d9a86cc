//! `freikugel shader`: a scene as the text of a shader.

use super::frame::{Voxels, cannot_write, open, output_path};
use super::given::Given;
use super::interrupt::Interrupt;
use super::{Failure, input, print};
use freikugel::scene::Scene;
use freikugel::shader::{Parameters, Shader, ShaderError, Target};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  freikugel shader cup.json --target shadertoy -o cup.glsl     paste it into Shadertoy
  freikugel shader cup.json --target wgsl --numbers cup.f32    the text, and the table of numbers that it reads
  freikugel shader cup.json --target hlsl -o Cup.compute       a compute shader for Unity
  freikugel shader cup.json --target glsl --voxels 50 --numbers cup.f32 --voxel-numbers cup-voxels.f32";

/// Write a scene as a shader.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The scene file, or - for standard input; or a model, whose file is called `.vm`.
    scene: PathBuf,
    #[command(flatten)]
    given: Given,
    /// The language and the host: wgsl (WebGPU), glsl (WebGL 2), shadertoy, hlsl (Unity) or msl (Metal).
    #[arg(short, long, value_name = "NAME", value_parser = parse_target)]
    target: Target,
    /// The file, or - for standard output; by default the scene's name with the ending of the language, in the current folder.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write the numbers that the shader reads to this file, as 32-bit floating-point numbers, lowest byte first.
    #[arg(long, value_name = "FILE")]
    numbers: Option<PathBuf>,
    #[command(flatten)]
    voxels: Voxels,
    /// Write the voxels that the shader reads to this file, as pairs of 32-bit floating-point numbers, lowest byte first.
    #[arg(long, value_name = "FILE", requires = "voxels")]
    voxel_numbers: Option<PathBuf>,
}

fn parse_target(text: &str) -> Result<Target, String> {
    let known = Target::ALL.iter().find(|(_, name)| *name == text);
    known.map(|(target, _)| *target).ok_or_else(|| {
        let names: Vec<&str> = Target::ALL.iter().map(|(_, name)| *name).collect();
        format!("the targets are {}", names.join(", "))
    })
}

/// Writes the shader.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = input::scene(&arguments.scene, &arguments.given.inputs())?;
    let to_output = arguments.output.as_deref() == Some(Path::new("-"));
    let interrupt = Interrupt::listen();
    let place = |path: &Path| open(path, &interrupt).map(|file| (file, path.to_owned()));
    let text_file = match to_output {
        true => None,
        false => Some(place(&output_path(arguments.output.as_deref(), &arguments.scene, arguments.target.ending())?)?),
    };
    let numbers_file = arguments.numbers.as_deref().map(place).transpose()?;
    let voxels_file = arguments.voxel_numbers.as_deref().map(place).transpose()?;

    let (text, parameters) =
        make(&scene, arguments.target, arguments.voxels.count).map_err(|error| Failure::Input(error.to_string()))?;
    for notice in parameters.notices() {
        eprintln!("freikugel: note: {notice}");
    }
    if interrupt.is_requested() {
        return Err(Failure::Interrupted);
    }
    for (file, numbers) in [(numbers_file, parameters.numbers()), (voxels_file, parameters.voxels().as_flattened())] {
        if let Some((file, path)) = file {
            let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
            file.write(&bytes).map_err(|error| cannot_write(&path, &error))?;
        }
    }
    match text_file {
        None => print(&text),
        Some((file, path)) => file.write(text.as_bytes()).map_err(|error| cannot_write(&path, &error)),
    }
}

fn make(scene: &Scene, target: Target, voxels: Option<u32>) -> Result<(String, Parameters), ShaderError> {
    let shader = match voxels {
        None => Shader::new(scene)?,
        Some(count) => Shader::of_voxels(scene, count)?,
    };
    let parameters = shader.parameters(scene)?;
    Ok((shader.text(target, &parameters)?, parameters))
}
