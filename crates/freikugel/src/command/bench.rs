//! `freikugel bench`: how many frames a second a scene makes while the camera moves.

mod figures;

pub(super) use self::figures::Row;
use self::figures::{HEADING, processor_time};
use super::frame::{Frame, Watch, cannot_render, open};
use super::interrupt::Interrupt;
use super::{Failure, graphics, input, print};
use freikugel::field::simd;
use freikugel::render::{Options, Renderer};
use freikugel::scene::{Camera, Inputs, Scene};
use glam::{DQuat, DVec3};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const EXAMPLES: &str = "\
Examples:
  freikugel bench --gpu                           the graphics processor and the CPU on the scenes that come with it
  freikugel bench --gpu cup.json --frames 100
  freikugel bench --filter 100 --threads 1        the CPU alone, on scenes with 100 in their name
  freikugel bench --gpu --json figures.json

The camera swings about its target, so that no two frames are the same. What has to be done once for each scene, and
the first frame, are columns of their own; then come frames for practice, which are not counted.";

/// Measure how many frames a second scenes make, with the CPU and the graphics processor.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The scene files; by default those that come with the program.
    scenes: Vec<PathBuf>,
    /// Measure the graphics processor as well.
    #[arg(long)]
    gpu: bool,
    /// A part of the name of the graphics processor; `info --gpu` lists them.
    #[arg(long, value_name = "NAME", requires = "gpu")]
    adapter: Option<String>,
    /// Leave the CPU out.
    #[arg(long, requires = "gpu")]
    no_cpu: bool,
    /// Sample everything but planes of the scenes, with this many voxels along the longest side, and draw the samples. The CPU is
    /// left out then.
    #[arg(long, value_name = "COUNT", requires = "gpu")]
    voxels: Option<u32>,
    /// Only scenes whose name contains this.
    #[arg(long, value_name = "NAME", default_value = "")]
    filter: String,
    /// How many frames are counted.
    #[arg(long, value_name = "COUNT", default_value_t = 40, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// After how many seconds no further frame is begun.
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0, value_parser = parse_seconds)]
    seconds: f64,
    #[command(flatten)]
    frame: Frame,
    /// Also write all figures to this file.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// The size of a frame, unless another one is asked for.
const SIZE: [u32; 2] = [640, 360];

/// Frames that are drawn before any is counted, after the first one.
const PRACTICE: u32 = 3;

/// How far the camera swings to each side, and how many frames it takes there and back: half a degree a frame, about what a hand
/// at the mouse does.
const SWING: f64 = 4.0 * std::f64::consts::PI / 180.0;
const PERIOD: f64 = 48.0;

/// A scene of the measurements.
struct Measurement {
    name: String,
    scene: Scene,
    /// How many voxels there are along the longest side, if it is sampled.
    voxels: Option<u32>,
}

/// The scenes that come with the program, with a number of voxels for those that are sampled. The last ones were written by
/// `freikugel-bench scene COUNT --kind mixed --lit`.
const SCENES: [(&str, &str, Option<u32>); 9] = [
    ("box", include_str!("../../../../scenes/gpu/box.json"), None),
    ("columns with bowls", include_str!("../../../../scenes/sources/column-with-bowl.json"), None),
    ("Mandelbulb", include_str!("../../../../scenes/gpu/mandelbulb.json"), None),
    ("room, without indirect light", include_str!("../../../../scenes/gpu/room.json"), None),
    ("50^3 voxels", include_str!("../../../../scenes/gpu/voxels.json"), Some(50)),
    ("10 primitives", include_str!("../../../../scenes/gpu/primitives-10.json"), None),
    ("20 primitives", include_str!("../../../../scenes/gpu/primitives-20.json"), None),
    ("100 primitives", include_str!("../../../../scenes/gpu/primitives-100.json"), None),
    ("300 primitives", include_str!("../../../../scenes/gpu/primitives-300.json"), None),
];

fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("give a time above 0".into()),
    }
}

/// Measures, and prints the table line by line.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scenes = scenes(&arguments.scenes, arguments.voxels)?;
    let wanted: Vec<&Measurement> = scenes.iter().filter(|scene| scene.name.contains(&arguments.filter)).collect();
    if wanted.is_empty() {
        let names: Vec<&str> = scenes.iter().map(|scene| scene.name.as_str()).collect();
        return Err(Failure::Usage(format!("no scene has {:?} in its name: {}", arguments.filter, names.join(", "))));
    }
    let [width, height] = SIZE;
    let options = arguments.frame.over(Options { width, height, samples: 1, ..Options::default() });
    options.region().map_err(|error| Failure::Usage(error.to_string()))?;
    let processor = arguments.gpu.then(|| graphics::Processor::open(arguments.adapter.as_deref())).transpose()?;

    let interrupt = Interrupt::listen();
    let json = arguments.json.as_deref().map(|path| open(path, &interrupt).map(|file| (path, file))).transpose()?;
    let watch = Watch::new(true, &interrupt);
    let threads = options.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, Into::into));
    let cpu = format!("CPU, {threads} thread{}", if threads == 1 { "" } else { "s" });
    print(&format!(
        "{} x {} pixels, one ray a pixel; the CPU with {}\n\n{HEADING}",
        options.width,
        options.height,
        simd::name(simd::best())
    ))?;
    let mut rows = Vec::new();
    for Measurement { name, scene, voxels } in wanted {
        let length = Length { frames: arguments.frames, seconds: arguments.seconds };
        let mut add = |row: Row| {
            print(&row.markdown())?;
            rows.push(row);
            Ok(())
        };
        if let Some(processor) = &processor {
            add(processor.measure(name, scene, &options, *voxels, length, &watch)?)?;
        }
        // The CPU draws scenes themselves.
        if !arguments.no_cpu && voxels.is_none() {
            add(on_cpu(name, &cpu, scene, &options, length, &watch)?)?;
        }
    }
    if let Some((path, file)) = json {
        let figures: Vec<serde_json::Value> = rows.iter().map(Row::json).collect();
        let all = serde_json::json!({ "width": options.width, "height": options.height, "rows": figures });
        file.write(format!("{all:#}\n").as_bytes()).map_err(|error| super::frame::cannot_write(path, &error))?;
    }
    Ok(())
}

/// The scenes of some files with their names, or those that come with the program.
fn scenes(files: &[PathBuf], voxels: Option<u32>) -> Result<Vec<Measurement>, Failure> {
    let inputs = Inputs::default();
    let own = |&(name, text, own): &(&str, &str, Option<u32>)| {
        let scene = input::parsed(text, Path::new(name), &inputs)?;
        Ok(Measurement { name: name.to_owned(), scene, voxels: voxels.or(own) })
    };
    let read =
        |path: &PathBuf| Ok(Measurement { name: input::name(path), scene: input::scene(path, &inputs)?, voxels });
    if files.is_empty() { SCENES.iter().map(own).collect() } else { files.iter().map(read).collect() }
}

/// When to stop measuring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Length {
    frames: u32,
    seconds: f64,
}

/// The camera of each frame: it swings about its target, around the direction that is up.
pub(super) fn swinging(camera: &Camera, frame: u32) -> Camera {
    let angle = SWING * (std::f64::consts::TAU * f64::from(frame) / PERIOD).sin();
    let turn = DQuat::from_axis_angle(camera.up.try_normalize().unwrap_or(DVec3::Z), angle);
    Camera { eye: camera.target + turn * (camera.eye - camera.target), ..camera.clone() }
}

/// The times of frames in seconds, after the first one and some for practice; and the processor time of one.
pub(super) struct Measured {
    first: Duration,
    seconds: Vec<f64>,
    processor: Option<f64>,
}

/// Draws frames with `practise`, then with `draw`, which is timed. Both get a frame's number.
pub(super) fn measured(
    length: Length,
    watch: &Watch,
    mut frame: impl FnMut(u32, bool) -> Result<Duration, Failure>,
) -> Result<Measured, Failure> {
    use freikugel::render::Progress;
    let mut number = 0;
    let mut next = |is_practice: bool| {
        if watch.is_cancelled() {
            return Err(Failure::Interrupted);
        }
        number += 1;
        frame(number - 1, is_practice)
    };
    let first = next(true)?;
    for _ in 0..PRACTICE {
        next(true)?;
    }
    let mut seconds = Vec::with_capacity(length.frames as usize);
    let (start, worked) = (Instant::now(), processor_time());
    while seconds.is_empty()
        || (seconds.len() < length.frames as usize && start.elapsed().as_secs_f64() < length.seconds)
    {
        seconds.push(next(false)?.as_secs_f64());
    }
    let processor = worked.zip(processor_time()).map(|(from, to)| (to - from) / seconds.len() as f64);
    Ok(Measured { first, seconds, processor })
}

fn on_cpu(
    name: &str,
    by: &str,
    scene: &Scene,
    options: &Options,
    length: Length,
    watch: &Watch,
) -> Result<Row, Failure> {
    let start = Instant::now();
    let renderer = Renderer::new(scene).map_err(|error| Failure::Input(format!("{name}: {error}")))?;
    let prepared = start.elapsed();
    let camera = renderer.camera(options.width, options.height);
    let measured = measured(length, watch, |number, _| {
        let start = Instant::now();
        let options = Options { camera: Some(swinging(&camera, number)), ..options.clone() };
        renderer.render(&options, watch).map_err(cannot_render)?;
        Ok(start.elapsed())
    })?;
    Ok(Row::new(name, by, prepared, None, &measured))
}
