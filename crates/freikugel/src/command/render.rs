//! `freikugel render`: a picture of a scene or model.

mod frames;

use super::Failure;
use super::frame::{Frame, Samples, Voxels, Watch, cannot_render, cannot_write, open, output_path, parse_method};
use super::given::Given;
use super::graphics::{self, Backend};
use super::input::{self, Input};
use super::interrupt::Interrupt;
use super::slice::picture_of_figures;
use freikugel::files::Format;
use freikugel::model::Region;
use freikugel::render::{Compression, Options, Rect, Rendered, Stats, render};
use freikugel::scene::color::from_hex;
use freikugel::scene::{Method, Picture, Rgb};
use std::ops::Range;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  freikugel render cup.json                       writes cup.png
  freikugel render cup.json -o cup.exr            linear colours, unclamped
  freikugel render cup.json --quality draft       one ray a pixel
  freikugel render cup.json --tracer sphere       plain sphere tracing, for comparison
  freikugel render cup.json --crop 100,50,64,64   a part of the frame, the same bytes as in the whole
  freikugel render cup.json --stats cup-stats.json
  freikugel render cup.json --backend gpu         by the graphics processor
  freikugel render cup.json --backend gpu --voxels 50
  freikugel render cup.vm                         an expression graph: a solid, or without z a region of the plane
  freikugel render cup.json --set radius=2        with another value for a parameter
  freikugel render cup.json --frames 0..120 --fps 30 -o cup.gif
  freikugel render cup.json --frames 0..120 --fps 30 -o frames/cup.png

With --frames, the scene is seen at the times FRAME / FPS, which its formulas call `t`. The suffix says what becomes of the
frames: .png and .exr make a file of each (cup-0000.png, ...), .apng, .gif and .webp one that moves, .mp4 and .webm a video,
by ffmpeg. What was interrupted goes on when the same command runs again.";

/// Render a picture of a scene.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The scene file, or - for standard input; or a model, whose file is called `.vm`.
    scene: PathBuf,
    /// The picture, .png or .exr, or .apng, .gif, .webp, .mp4 or .webm for --frames; by default the scene's name with .png, in the
    /// current folder.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    given: Given,
    #[command(flatten)]
    frame: Frame,
    #[command(flatten)]
    samples: Samples,
    /// Render several frames, not the last number.
    #[arg(long, value_name = "FROM..TO", value_parser = frames::parse_range, conflicts_with = "stats")]
    frames: Option<Range<u32>>,
    /// Frames a second.
    #[arg(long, value_name = "COUNT", default_value_t = 30, requires = "frames",
          value_parser = clap::value_parser!(u16).range(1..=MOST_FPS))]
    fps: u16,
    /// The part of the frame to render.
    #[arg(long, value_name = "X,Y,WIDTH,HEIGHT", value_parser = parse_crop)]
    crop: Option<Rect>,
    /// What computes the picture. Only the CPU's pictures are the same, byte by byte, on all machines.
    #[arg(long, value_name = "NAME", default_value = "cpu")]
    backend: Backend,
    /// A part of the name of the graphics processor; `info --gpu` lists them.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    #[command(flatten)]
    voxels: Voxels,
    /// The instruction set to evaluate fields with; by default the best one. The picture is the same with all.
    #[arg(long, value_name = "NAME")]
    simd: Option<String>,
    /// How rays find surfaces, instead of the scene's way.
    #[arg(long, value_name = "NAME", value_parser = parse_method)]
    tracer: Option<Method>,
    /// Draw pixels with a ray that ran out of steps in this colour: #rrggbb or #rgb.
    #[arg(long, value_name = "COLOR", value_parser = parse_color)]
    warning_color: Option<Rgb>,
    /// Take longer to write a PNG file that is up to a third smaller.
    #[arg(long)]
    small: bool,
    /// Write counts and times to this file, as JSON.
    #[arg(long, value_name = "FILE")]
    stats: Option<PathBuf>,
    /// Show no progress and no summary.
    #[arg(short, long)]
    quiet: bool,
}

/// More frames a second than any screen shows.
const MOST_FPS: i64 = 1000;

fn parse_crop(text: &str) -> Result<Rect, String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|word| word.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, width, height]) => Ok(Rect { x, y, width, height }),
        _ => Err("give four whole numbers: x,y,width,height".into()),
    }
}

fn parse_color(text: &str) -> Result<Rgb, String> {
    from_hex(text).ok_or_else(|| "give #rrggbb or #rgb".into())
}

/// Renders the picture and writes its files.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(range) = &arguments.frames {
        return frames::run(arguments, range);
    }
    let path = output_path(arguments.output.as_deref(), &arguments.scene, ".png")?;
    let format = Format::of(&path)
        .ok_or_else(|| Failure::Usage(format!("{}: the suffix must be .png or .exr", path.display())))?;
    let mut input = input::read(&arguments.scene, &arguments.given.inputs())?;
    if let Input::Scene(scene) = &mut input {
        scene.tracer.method = arguments.tracer.unwrap_or(scene.tracer.method);
        scene.tracer.warning = arguments.warning_color.or(scene.tracer.warning);
    }
    let options = options(arguments, &input)?;
    options.region().map_err(|error| Failure::Usage(error.to_string()))?;
    let backend = backend(arguments)?;

    let interrupt = Interrupt::listen();
    let picture_file = open(&path, &interrupt)?;
    let stats_file = arguments.stats.as_deref().map(|path| open(path, &interrupt)).transpose()?;

    let watch = Watch::new(arguments.quiet, &interrupt);
    let made = make(arguments, backend, &input, &options, &watch);
    watch.bar.finish_and_clear();
    let (rendered, by) = made?;

    let picture = match &input {
        Input::Scene(scene) => scene.picture.clone(),
        Input::Figures(_) | Input::Region(_) => Picture::default(),
    };
    let compression = if arguments.small { Compression::Thorough } else { Compression::Quick };
    let bytes = format.encode(&rendered, &picture, compression).map_err(|error| Failure::Input(error.to_string()))?;
    if interrupt.is_requested() {
        return Err(Failure::Interrupted);
    }
    if let (Some(file), Some(path)) = (stats_file, &arguments.stats) {
        let method = match &input {
            Input::Scene(scene) => scene.tracer.method,
            Input::Figures(_) | Input::Region(_) => Method::Auto,
        };
        let text = statistics(&rendered, method, by.as_deref());
        file.write(text.as_bytes()).map_err(|error| cannot_write(path, &error))?;
    }
    picture_file.write(&bytes).map_err(|error| cannot_write(&path, &error))?;
    if !arguments.quiet {
        summarise(&path, &rendered, by.as_deref());
    }
    Ok(())
}

/// What the command line asks for, over what the scene says.
fn options(arguments: &Arguments, input: &Input) -> Result<Options, Failure> {
    let options = match input {
        Input::Scene(scene) | Input::Figures(scene) => Options::of(scene),
        Input::Region(_) => Region::options(),
    };
    let level = arguments.simd.as_deref().map(instruction_set).transpose()?;
    let mut options = Options { crop: arguments.crop, level, ..arguments.samples.over(arguments.frame.over(options)) };
    if let (Input::Region(_), Some(side)) = (input, arguments.frame.only_side()) {
        // Regions are seen in a square unless both sides are given.
        (options.width, options.height) = (side, side);
    }
    Ok(options)
}

/// The picture of what was read, and what computed it, if that is of interest.
fn make(
    arguments: &Arguments,
    backend: Backend,
    input: &Input,
    options: &Options,
    watch: &Watch,
) -> Result<graphics::Made, Failure> {
    let on_cpu = || match input {
        Input::Scene(scene) => render(scene, options, watch).map_err(cannot_render),
        Input::Figures(scene) => picture_of_figures(scene, options, watch),
        Input::Region(region) => region.render(options, watch).map_err(cannot_render),
    };
    let how = graphics::How { adapter: arguments.adapter.as_deref(), voxels: arguments.voxels.count };
    match (backend, input) {
        (Backend::Cpu, _) => on_cpu().map(|rendered| (rendered, None)),
        (Backend::Gpu, Input::Scene(scene)) => graphics::render(scene, options, how, watch),
        (Backend::Gpu, Input::Region(_) | Input::Figures(_)) => {
            Err(Failure::Usage("what lies in a plane is rendered on the CPU: leave --backend out".into()))
        }
        (Backend::Auto, Input::Scene(scene)) => graphics::render_if_able(scene, options, how, watch)
            .unwrap_or_else(|reason| on_cpu().map(|rendered| (rendered, Some(format!("CPU: {reason}"))))),
        (Backend::Auto, Input::Region(_) | Input::Figures(_)) => on_cpu().map(|rendered| (rendered, None)),
    }
}

/// What computes the picture, as far as the words of the command line say: some of them mean something on the CPU only.
fn backend(arguments: &Arguments) -> Result<Backend, Failure> {
    let Arguments { backend, adapter, simd, tracer, frame, voxels, .. } = arguments;
    let only_cpu = [("--simd", simd.is_some()), ("--tracer", tracer.is_some()), ("--threads", frame.threads.is_some())];
    let for_cpu = only_cpu.iter().find(|(_, is_given)| *is_given);
    match (backend, for_cpu) {
        (Backend::Gpu, Some((name, _))) => Err(Failure::Usage(format!("{name} is for the CPU, not for --backend gpu"))),
        (Backend::Cpu, _) if adapter.is_some() => {
            Err(Failure::Usage("--adapter names a graphics processor: add --backend gpu".into()))
        }
        (Backend::Cpu, _) if voxels.count.is_some() => {
            Err(Failure::Usage("voxels are drawn by graphics processors: add --backend gpu".into()))
        }
        (Backend::Auto, Some((name, _))) if voxels.count.is_some() => {
            Err(Failure::Usage(format!("{name} is for the CPU, and voxels are drawn by graphics processors")))
        }
        (Backend::Auto, None) if voxels.count.is_some() => Ok(Backend::Gpu),
        (Backend::Auto, Some(_)) => Ok(Backend::Cpu),
        (backend, _) => Ok(*backend),
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

/// One line on what came out and what computed it, if that is of interest; and one on what did not come out.
fn summarise(path: &Path, rendered: &Rendered, by: Option<&str>) {
    let Stats { rays, times, unresolved, .. } = &rendered.stats;
    let (width, height) = (rendered.image.width(), rendered.image.height());
    let all = rays.camera + rays.shadow + rays.occlusion;
    let by = by.map_or_else(String::new, |by| format!(", on {by}"));
    // Only the CPU counts rays that do not come from the camera.
    let what = if rays.shadow + rays.occlusion > 0 { "rays" } else { "camera rays" };
    eprintln!("{}: {width} x {height}, {:.2} s, {all} {what}{by}", path.display(), times.wall.as_secs_f64());
    if unresolved.camera + unresolved.shadow > 0 {
        let share = 100.0 * unresolved.pixels as f64 / rendered.image.pixels().len() as f64;
        eprintln!(
            "unresolved: {} pixels ({share:.2} %) with {} camera rays, and {} shadow rays, ran out of steps",
            unresolved.pixels, unresolved.camera, unresolved.shadow
        );
    }
}

/// Counts and times as JSON. A graphics processor counts few things, and what it did not count is not there.
fn statistics(rendered: &Rendered, method: Method, by: Option<&str>) -> String {
    let Stats { rays, hits, inside, evaluations, steps, unresolved, times } = &rendered.stats;
    if times.threads == 0 {
        let value = serde_json::json!({
            "graphics_processor": by,
            "width": rendered.image.width(),
            "height": rendered.image.height(),
            "rays": { "camera": rays.camera },
            "unresolved": { "pixels": unresolved.pixels, "camera_rays": unresolved.camera },
            "seconds": { "wall": times.wall.as_secs_f64() },
        });
        return format!("{value:#}\n");
    }
    let value = serde_json::json!({
        "tracer": method.name(),
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
