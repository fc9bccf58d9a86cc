//! `freikugel render`: a picture of a scene or model.

use super::Failure;
use super::input::{self, Input};
use super::interrupt::Interrupt;
use clap::ValueEnum;
use freikugel::files::{Format, Output};
use freikugel::model::Region;
use freikugel::render::{Options, Progress, Rect, RenderError, Rendered, Stats, render};
use freikugel::scene::Picture;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  freikugel render cup.json                       writes cup.png
  freikugel render cup.json -o cup.exr            linear colours, unclamped
  freikugel render cup.json --quality draft       one ray a pixel
  freikugel render cup.json --crop 100,50,64,64   a part of the frame, the same bytes as in the whole
  freikugel render cup.json --stats cup-stats.json
  freikugel render cup.vm                         an expression graph: a solid, or without z a region of the plane";

/// Render a picture of a scene.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The scene file, or - for standard input; or a model, whose file is called `.vm`.
    scene: PathBuf,
    /// The picture, .png or .exr; by default the scene's name with .png, in the current folder.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Width of the picture in pixels, instead of the scene's.
    #[arg(long, value_name = "PIXELS")]
    width: Option<u32>,
    /// Height of the picture in pixels, instead of the scene's.
    #[arg(long, value_name = "PIXELS")]
    height: Option<u32>,
    /// Rays a pixel, instead of the scene's. One goes through the pixel's centre.
    #[arg(long, value_name = "COUNT", conflicts_with = "quality")]
    samples: Option<u32>,
    /// Rays a pixel by name.
    #[arg(long, value_name = "NAME")]
    quality: Option<Quality>,
    /// The part of the frame to render.
    #[arg(long, value_name = "X,Y,WIDTH,HEIGHT", value_parser = parse_crop)]
    crop: Option<Rect>,
    /// Threads to render with; by default one for each core. The picture is the same with any number.
    #[arg(long, value_name = "COUNT")]
    threads: Option<usize>,
    /// The instruction set to evaluate fields with; by default the best one. The picture is the same with all.
    #[arg(long, value_name = "NAME")]
    simd: Option<String>,
    /// Write counts and times to this file, as JSON.
    #[arg(long, value_name = "FILE")]
    stats: Option<PathBuf>,
    /// Show no progress and no summary.
    #[arg(short, long)]
    quiet: bool,
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

impl Quality {
    fn samples(self) -> u32 {
        match self {
            Self::Draft => 1,
            Self::Normal => 16,
            Self::Fine => 64,
        }
    }
}

fn parse_crop(text: &str) -> Result<Rect, String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|word| word.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, width, height]) => Ok(Rect { x, y, width, height }),
        _ => Err("give four whole numbers: x,y,width,height".into()),
    }
}

/// Renders the picture and writes its files.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let path = output_path(arguments)?;
    let format = Format::of(&path)
        .ok_or_else(|| Failure::Usage(format!("{}: the suffix must be .png or .exr", path.display())))?;
    let level = arguments.simd.as_deref().map(instruction_set).transpose()?;

    let input = input::read(&arguments.scene)?;
    let given = match &input {
        Input::Scene(scene) => Options::of(scene),
        Input::Region(_) => Region::options(),
    };
    let mut options = Options { crop: arguments.crop, threads: arguments.threads, level, ..given };
    options.width = arguments.width.unwrap_or(options.width);
    options.height = arguments.height.unwrap_or(options.height);
    if let (Input::Region(_), Some(side), None) | (Input::Region(_), None, Some(side)) =
        (&input, arguments.width, arguments.height)
    {
        // Regions are seen in a square unless both sides are given.
        (options.width, options.height) = (side, side);
    }
    options.samples = arguments.samples.or(arguments.quality.map(Quality::samples)).unwrap_or(options.samples);
    options.region().map_err(|error| Failure::Usage(error.to_string()))?;

    let interrupt = Interrupt::listen();
    let open = |path: &Path| -> Result<Output, Failure> {
        let output = Output::open(path).map_err(|error| cannot_write(path, &error))?;
        interrupt.guard(output.unfinished());
        Ok(output)
    };
    let picture_file = open(&path)?;
    let stats_file = arguments.stats.as_deref().map(open).transpose()?;

    let watch = Watch { bar: progress_bar(arguments.quiet), interrupt: interrupt.clone() };
    let rendered = match &input {
        Input::Scene(scene) => render(scene, &options, &watch),
        Input::Region(region) => region.render(&options, &watch),
    };
    watch.bar.finish_and_clear();
    let rendered = rendered.map_err(|error| match error {
        RenderError::Cancelled => Failure::Interrupted,
        RenderError::Options(error) => Failure::Usage(error.to_string()),
        error => Failure::Input(error.to_string()),
    })?;

    let picture = match &input {
        Input::Scene(scene) => scene.picture.clone(),
        Input::Region(_) => Picture::default(),
    };
    let bytes = format.encode(&rendered, &picture).map_err(|error| Failure::Input(error.to_string()))?;
    if interrupt.is_requested() {
        return Err(Failure::Interrupted);
    }
    if let (Some(file), Some(path)) = (stats_file, &arguments.stats) {
        file.write(statistics(&rendered).as_bytes()).map_err(|error| cannot_write(path, &error))?;
    }
    picture_file.write(&bytes).map_err(|error| cannot_write(&path, &error))?;
    if !arguments.quiet {
        summarise(&path, &rendered);
    }
    Ok(())
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Input(format!("can't write {}: {error}", path.display()))
}

fn output_path(arguments: &Arguments) -> Result<PathBuf, Failure> {
    if let Some(path) = &arguments.output {
        return Ok(path.clone());
    }
    match arguments.scene.file_stem() {
        Some(stem) if arguments.scene != Path::new("-") => Ok(Path::new(stem).with_extension("png")),
        _ => Err(Failure::Usage("say where the picture goes: -o FILE".into())),
    }
}

/// The instruction set of a name.
fn instruction_set(name: &str) -> Result<freikugel::field::simd::Level, Failure> {
    use freikugel::field::simd;
    let levels = simd::available();
    levels.iter().copied().find(|&level| simd::name(level) == name).ok_or_else(|| {
        let names: Vec<&str> = levels.into_iter().map(simd::name).collect();
        Failure::Usage(format!("this machine has no instruction set {name:?}; it has {}", names.join(", ")))
    })
}

/// Shows how far a rendering has come, and stops it on Ctrl-C.
struct Watch {
    bar: ProgressBar,
    interrupt: Interrupt,
}

impl Progress for Watch {
    fn advanced(&self, done: u64, total: u64) {
        self.bar.set_length(total);
        self.bar.set_position(done);
    }

    fn is_cancelled(&self) -> bool {
        self.interrupt.is_requested()
    }
}

fn progress_bar(quiet: bool) -> ProgressBar {
    let target = if quiet || !std::io::stderr().is_terminal() {
        ProgressDrawTarget::hidden()
    } else {
        ProgressDrawTarget::stderr()
    };
    let style =
        ProgressStyle::with_template("{wide_bar} {percent:>3} %, {eta} left").expect("the template is well-formed");
    ProgressBar::with_draw_target(Some(1), target).with_style(style)
}

/// One line on what came out, and one on what did not.
fn summarise(path: &Path, rendered: &Rendered) {
    let Stats { rays, times, unresolved, .. } = &rendered.stats;
    let (width, height) = (rendered.image.width(), rendered.image.height());
    let all = rays.camera + rays.shadow + rays.occlusion;
    eprintln!("{}: {width} x {height}, {:.2} s, {all} rays", path.display(), times.wall.as_secs_f64());
    if unresolved.camera + unresolved.shadow > 0 {
        let share = 100.0 * unresolved.pixels as f64 / rendered.image.pixels().len() as f64;
        eprintln!(
            "unresolved: {} pixels ({share:.2} %) with {} camera rays, and {} shadow rays, ran out of steps",
            unresolved.pixels, unresolved.camera, unresolved.shadow
        );
    }
}

/// Counts and times as JSON.
fn statistics(rendered: &Rendered) -> String {
    let Stats { rays, hits, inside, evaluations, steps, unresolved, times } = &rendered.stats;
    let value = serde_json::json!({
        "width": rendered.image.width(),
        "height": rendered.image.height(),
        "rays": { "camera": rays.camera, "shadow": rays.shadow, "occlusion": rays.occlusion },
        "hits": hits,
        "inside": inside,
        "field_evaluations": evaluations,
        "steps": steps,
        "unresolved": {
            "pixels": unresolved.pixels,
            "camera_rays": unresolved.camera,
            "shadow_rays": unresolved.shadow,
        },
        "seconds": { "wall": times.wall.as_secs_f64(), "work": times.work.as_secs_f64() },
        "threads": times.threads,
    });
    format!("{value:#}\n")
}
