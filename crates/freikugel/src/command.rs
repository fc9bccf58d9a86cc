//! What the command line offers, and how it fails.
//!
//! Exit codes: 0 done; 1 the input or the machine won't do; 2 the words of the command line are off; 130 stopped by
//! Ctrl-C.

mod bench;
mod check;
mod compare;
mod formula;
mod frame;
mod given;
mod graphics;
mod help;
mod info;
mod input;
mod interrupt;
mod reference;
mod render;
mod shader;
mod sheet;
mod slice;
mod sweep;
mod view;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  freikugel render scenes/first-light.json -o first-light.png
  freikugel render cup.json -o cup.exr --width 1920 --height 1080 --quality fine
  freikugel view cup.json
  freikugel slice cup.json --axis y
  freikugel sweep cup.json --vary tracer.max_steps=5,10,100 -o steps.png
  freikugel compare cup.json
  freikugel bench --gpu
  freikugel shader cup.json --target shadertoy -o cup.glsl
  freikugel check cup.json
  freikugel formula \"x^2 + y^2 - 1\" --derive x --at 1,2,3
  freikugel help shapes torus";

/// Pictures of signed distance fields.
#[derive(Debug, Parser)]
#[command(name = "freikugel", version, about, after_help = EXAMPLES, disable_help_subcommand = true)]
#[command(arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render a picture of a scene.
    Render(render::Arguments),
    /// Show a scene in a window, drawn by the graphics processor.
    View(view::Arguments),
    /// Show the values of a scene's field in a plane: inside and outside, lines of equal distance, slopes.
    Slice(slice::Arguments),
    /// Render a scene with several values of a number, as a contact sheet.
    Sweep(sweep::Arguments),
    /// Compare all tracers on a scene: steps, evaluations, time, wrong pixels.
    Compare(compare::Arguments),
    /// Measure how many frames a second scenes make, with the CPU and the graphics processor.
    Bench(bench::Arguments),
    /// Write a scene as a shader: WGSL, GLSL, Shadertoy, HLSL, MSL.
    Shader(shader::Arguments),
    /// Report the mistakes of scenes, and nothing else.
    Check(SceneFiles),
    /// Show what a scene is made of: its tree, contracts, boxes, and counts.
    Info(info::Arguments),
    /// Explain a formula: simplified, its derivatives, its values at points, and its range over boxes.
    Formula(formula::Arguments),
    /// Print the JSON Schema of scene files.
    Schema,
    /// Explain a command, or the shapes: `help shapes`, `help shapes torus`.
    Help(help::Arguments),
}

/// The scenes to work on.
#[derive(Debug, clap::Args)]
struct SceneFiles {
    /// The scene files, or - for standard input; or models, whose files are called `.vm`.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    given: given::Given,
}

/// How a command ends when it does not succeed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The input or the machine won't do. The message has been printed already if it is empty.
    Input(String),
    /// The words of the command line are off.
    Usage(String),
    /// The user stopped it.
    Interrupted,
    /// The user stopped it, and part of the work is kept; says so.
    Paused(String),
}

impl Failure {
    /// Says what is wrong, and which code to exit with.
    pub(crate) fn report(self) -> ExitCode {
        let (message, code) = match self {
            Self::Input(message) => (message, 1),
            Self::Usage(message) => (message, 2),
            Self::Interrupted => ("stopped; nothing was written".to_owned(), 130),
            Self::Paused(message) => (message, 130),
        };
        if !message.is_empty() {
            eprintln!("freikugel: {message}");
        }
        ExitCode::from(code)
    }
}

/// Writes to standard output. A reader that has seen enough (`| head`) is no failure.
fn print(text: &str) -> Result<(), Failure> {
    use std::io::Write;
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Input(format!("can't write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Runs a command.
pub(crate) fn run(arguments: Arguments) -> Result<(), Failure> {
    match arguments.command {
        Command::Render(arguments) => render::run(&arguments),
        Command::View(arguments) => view::run(&arguments),
        Command::Slice(arguments) => slice::run(&arguments),
        Command::Sweep(arguments) => sweep::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Shader(arguments) => shader::run(&arguments),
        Command::Check(files) => check::run(&files.scenes, &files.given.inputs()),
        Command::Info(arguments) => info::run(&arguments),
        Command::Formula(arguments) => formula::run(&arguments),
        Command::Schema => {
            let schema = freikugel::scene::schema();
            let text = serde_json::to_string_pretty(&schema).map_err(|error| Failure::Input(error.to_string()))?;
            print(&(text + "\n"))
        }
        Command::Help(arguments) => help::run(&arguments),
    }
}
