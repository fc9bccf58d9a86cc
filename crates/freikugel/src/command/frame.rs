//! What commands that render have in common: the size of pictures, rays a pixel, threads, progress, files.

use super::Failure;
use super::interrupt::Interrupt;
use clap::ValueEnum;
use freikugel::files::Output;
use freikugel::render::{Options, Progress, RenderError};
use freikugel::scene::Method;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

/// The size of a picture, and with how many threads it is computed.
#[derive(Debug, clap::Args)]
pub(super) struct Frame {
    /// Width of the picture in pixels, instead of the scene's.
    #[arg(long, value_name = "PIXELS")]
    pub(super) width: Option<u32>,
    /// Height of the picture in pixels, instead of the scene's.
    #[arg(long, value_name = "PIXELS")]
    pub(super) height: Option<u32>,
    /// Threads to render with; by default one for each core. The picture is the same with any number.
    #[arg(long, value_name = "COUNT")]
    pub(super) threads: Option<usize>,
}

impl Frame {
    /// The side of the picture, if only one was given.
    pub(super) fn only_side(&self) -> Option<u32> {
        self.width.xor(self.height)
    }

    /// The options with what was asked for.
    pub(super) fn over(&self, mut options: Options) -> Options {
        options.width = self.width.unwrap_or(options.width);
        options.height = self.height.unwrap_or(options.height);
        options.threads = self.threads.or(options.threads);
        options
    }
}

/// Rays a pixel.
#[derive(Debug, clap::Args)]
pub(super) struct Samples {
    /// Rays a pixel, instead of the scene's. One goes through the pixel's centre.
    #[arg(long, value_name = "COUNT", conflicts_with = "quality")]
    samples: Option<u32>,
    /// Rays a pixel by name.
    #[arg(long, value_name = "NAME")]
    quality: Option<Quality>,
}

/// How many rays a pixel gets.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Quality {
    /// 1 ray a pixel.
    Draft,
    /// 16 rays a pixel.
    Normal,
    /// 64 rays a pixel.
    Fine,
}

/// Samples of a scene instead of the scene itself.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(super) struct Voxels {
    /// Sample everything but planes, with this many voxels along the longest side, and draw the samples.
    #[arg(id = "voxels", long = "voxels", value_name = "COUNT")]
    pub(super) count: Option<u32>,
}

impl Samples {
    /// The options with what was asked for.
    pub(super) fn over(&self, mut options: Options) -> Options {
        let by_name = self.quality.map(|quality| match quality {
            Quality::Draft => 1,
            Quality::Normal => 16,
            Quality::Fine => 64,
        });
        options.samples = self.samples.or(by_name).unwrap_or(options.samples);
        options
    }
}

/// The tracer of a name.
pub(super) fn parse_method(text: &str) -> Result<Method, String> {
    Method::from_name(text).ok_or_else(|| format!("there are {}", Method::ALL.map(Method::name).join(", ")))
}

/// Shows how far a rendering has come, and stops it on Ctrl-C.
pub(super) struct Watch {
    pub(super) bar: ProgressBar,
    pub(super) interrupt: Interrupt,
    /// Which part of the work is watched, and how many there are.
    part: [u64; 2],
}

impl Watch {
    /// A progress bar that is seen where someone looks.
    pub(super) fn new(quiet: bool, interrupt: &Interrupt) -> Self {
        let target = if quiet || !std::io::stderr().is_terminal() {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let style =
            ProgressStyle::with_template("{wide_bar} {percent:>3} %, {eta} left").expect("the template is well-formed");
        let bar = ProgressBar::with_draw_target(Some(1), target).with_style(style);
        Self { bar, interrupt: interrupt.clone(), part: [0, 1] }
    }

    /// The same bar for one part of the work, of several that take equally long.
    pub(super) fn for_part(&self, part: u64, parts: u64) -> Self {
        Self { bar: self.bar.clone(), interrupt: self.interrupt.clone(), part: [part, parts] }
    }
}

impl Progress for Watch {
    fn advanced(&self, done: u64, total: u64) {
        let [part, parts] = self.part;
        self.bar.set_length(total * parts);
        self.bar.set_position(total * part + done);
    }

    fn is_cancelled(&self) -> bool {
        self.interrupt.is_requested()
    }
}

/// Prepares a file that must not stay if the program ends early.
pub(super) fn open(path: &Path, interrupt: &Interrupt) -> Result<Output, Failure> {
    let output = Output::open(path).map_err(|error| cannot_write(path, &error))?;
    interrupt.guard(output.unfinished());
    Ok(output)
}

/// What is said of a file that can't be written.
pub(super) fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Input(format!("can't write {}: {error}", path.display()))
}

/// What is said of a rendering that failed.
pub(super) fn cannot_render(error: RenderError) -> Failure {
    match error {
        RenderError::Cancelled => Failure::Interrupted,
        RenderError::Options(error) => Failure::Usage(error.to_string()),
        error => Failure::Input(error.to_string()),
    }
}

/// Where a picture goes: the scene's name with another ending, in the current folder, unless something else was said.
pub(super) fn output_path(output: Option<&Path>, scene: &Path, ending: &str) -> Result<PathBuf, Failure> {
    match (output, scene.file_stem()) {
        (Some(path), _) => Ok(path.into()),
        (None, Some(stem)) if scene != Path::new("-") => {
            let mut name = stem.to_owned();
            name.push(ending);
            Ok(name.into())
        }
        _ => Err(Failure::Usage("say where the picture goes: -o FILE".into())),
    }
}
