//! `freikugel render --frames`: a picture for each moment, in files of their own or in one that moves.
//!
//! Every frame is written as soon as it is there, and a list beside the frames says which ones are done: when the same command
//! runs again after an interruption, it goes on from there.

use super::super::Failure;
use super::super::frame::{Watch, cannot_render, cannot_write, open, output_path};
use super::super::graphics::Backend;
use super::super::input::{self, Input};
use super::super::interrupt::Interrupt;
use super::super::sheet::Bitmap;
use super::{Arguments, make};
use freikugel::animation::{Animation, AnimationError, Container, has_ffmpeg};
use freikugel::files::Format;
use freikugel::render::{Compression, Options, Rendered, Renderer};
use freikugel::scene::{Files, Folder, Inputs, Picture, Severity, read_at};
use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::{Duration, Instant};

/// The numbers of the frames of FROM..TO.
pub(super) fn parse_range(text: &str) -> Result<Range<u32>, String> {
    let fault = || format!("{text:?} is no range FROM..TO such as 0..120");
    let (from, to) = text.split_once("..").ok_or_else(fault)?;
    let number = |text: &str| text.trim().parse::<u32>().map_err(|_| fault());
    let (from, to) = (number(from)?, number(to)?);
    match to.checked_sub(from) {
        None | Some(0) => Err(format!("{text:?} has no frames: the last number is left out, 0..120 are 120 frames")),
        Some(count) if count > MOST_FRAMES => Err(format!("these are more than {MOST_FRAMES} frames")),
        Some(_) => Ok(from..to),
    }
}

/// Eleven hours at 25 a second.
const MOST_FRAMES: u32 = 1_000_000;

/// How long frames are read in advance, to find mistakes before the first one is rendered.
const LOOKING_AHEAD: Duration = Duration::from_secs(2);

/// Renders all frames and, if they go into one file, puts them there.
pub(super) fn run(arguments: &Arguments, range: &Range<u32>) -> Result<(), Failure> {
    let start = Instant::now();
    let path = output_path(arguments.output.as_deref(), &arguments.scene, ".png")?;
    let target = Target::of(&path)?;
    let interrupt = Interrupt::listen();
    let movie = match target {
        // That it can be written is found out before there is anything to write.
        Target::Movie(container) if !container.is_video() => Some(open(&path, &interrupt)?),
        _ => None,
    };
    let clip = Clip::new(arguments, range.clone())?;
    let options = clip.options(&clip.read(range.start)?)?;
    if let Target::Movie(container) = target {
        let region = options.region().map_err(|error| Failure::Usage(error.to_string()))?;
        if let Some(fault) = container.fault([region.width, region.height], arguments.fps) {
            return Err(Failure::Usage(fault));
        }
        if container.is_video() && !has_ffmpeg() {
            return Err(Failure::Input(AnimationError::NoFfmpeg.to_string()));
        }
    }
    clip.look_ahead()?;

    let mut done = Done::open(&path, target, clip.fingerprint(&options), range)?;
    let there = done.frames.len();
    if there > 0 && !arguments.quiet {
        eprintln!("going on: {there} of {} frames are there", range.len());
    }
    let rendered = clip.render(&mut done, &interrupt);
    if matches!(rendered, Err(Failure::Interrupted)) {
        let message =
            format!("stopped after {} of {} frames; the same command goes on", done.frames.len(), range.len());
        return Err(Failure::Paused(message));
    }
    rendered?;
    if let Target::Movie(container) = target {
        assemble(container, &done, range, arguments.fps, &path, movie)?;
    }
    done.forget();
    if !arguments.quiet {
        let count = range.len();
        let plural = if count == 1 { "" } else { "s" };
        eprintln!("{}: {count} frame{plural}, {:.2} s", done.shown(&path, range), start.elapsed().as_secs_f64());
    }
    Ok(())
}

/// Where frames go.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    /// Into files of their own.
    Files(Format),
    /// Into one file.
    Movie(Container),
}

impl Target {
    fn of(path: &Path) -> Result<Self, Failure> {
        let movie = Container::of(path).map(Self::Movie);
        movie.or_else(|| Format::of(path).map(Self::Files)).ok_or_else(|| {
            let movies = Container::ALL.map(|(_, suffix)| format!(".{suffix}")).join(", ");
            Failure::Usage(format!(
                "{}: the suffix must be .png or .exr, for a file for each frame, or one of {movies}",
                path.display()
            ))
        })
    }

    /// The format of single frames.
    fn format(self) -> Format {
        match self {
            Self::Files(format) => format,
            Self::Movie(_) => Format::Png,
        }
    }
}

/// The files beside a scene, each read once.
#[derive(Clone, Debug)]
struct Kept {
    folder: Folder,
    contents: Rc<RefCell<HashMap<String, Vec<u8>>>>,
}

impl Files for Kept {
    fn contents(&self, name: &str) -> Result<Vec<u8>, String> {
        if let Some(known) = self.contents.borrow().get(name) {
            return Ok(known.clone());
        }
        let contents = self.folder.contents(name)?;
        self.contents.borrow_mut().insert(name.to_owned(), contents.clone());
        Ok(contents)
    }
}

/// A scene and the moments at which it is seen.
struct Clip<'a> {
    arguments: &'a Arguments,
    range: Range<u32>,
    text: String,
    files: Kept,
    /// What the scene is read with at the time 0.
    inputs: Inputs,
}

impl<'a> Clip<'a> {
    fn new(arguments: &'a Arguments, range: Range<u32>) -> Result<Self, Failure> {
        if input::is_model(&arguments.scene) {
            return Err(Failure::Usage("a model does not move: frames are made of scenes".into()));
        }
        let text = input::text(&arguments.scene)?;
        let files = Kept { folder: Folder::of(&arguments.scene), contents: Rc::default() };
        let clip = Self { arguments, range, text, files, inputs: arguments.given.inputs() };
        let reading = read_at(&clip.text, clip.files.clone(), &clip.inputs_at(clip.range.start));
        input::show(&clip.text, &input::name(&arguments.scene), &reading.diagnostics);
        if reading.scene.is_some() && !reading.uses_time && !arguments.quiet {
            eprintln!("nothing in the scene depends on the time `t`: all frames are alike");
        }
        Ok(clip)
    }

    fn inputs_at(&self, frame: u32) -> Inputs {
        Inputs { time: self.inputs.time + f64::from(frame) / f64::from(self.arguments.fps), ..self.inputs.clone() }
    }

    /// The scene at the time of a frame.
    fn read(&self, frame: u32) -> Result<Input, Failure> {
        let inputs = self.inputs_at(frame);
        let reading = read_at(&self.text, self.files.clone(), &inputs);
        let Some(mut scene) = reading.scene else {
            let name = input::name(&self.arguments.scene);
            // Those of the first frame have been shown.
            if frame != self.range.start {
                let errors: Vec<_> =
                    reading.diagnostics.into_iter().filter(|d| d.severity == Severity::Error).collect();
                input::show(&self.text, &format!("{name} at t = {}", inputs.time), &errors);
            }
            return Err(Failure::Input(format!("{name} is no sound scene in frame {frame}")));
        };
        scene.tracer.method = self.arguments.tracer.unwrap_or(scene.tracer.method);
        scene.tracer.warning = self.arguments.warning_color.or(scene.tracer.warning);
        let scene = Box::new(scene);
        Ok(if scene.is_plane() { Input::Figures(scene) } else { Input::Scene(scene) })
    }

    /// Reads frames without rendering them, from the last one on: mistakes should not come out after hours.
    fn look_ahead(&self) -> Result<(), Failure> {
        let start = Instant::now();
        let frames = std::iter::once(self.range.end - 1).chain(self.range.clone());
        for frame in frames {
            self.read(frame)?;
            if start.elapsed() > LOOKING_AHEAD {
                break;
            }
        }
        Ok(())
    }

    fn options(&self, input: &Input) -> Result<Options, Failure> {
        let options = super::options(self.arguments, input)?;
        options.region().map_err(|error| Failure::Usage(error.to_string()))?;
        Ok(options)
    }

    /// A number that differs if anything does that frames depend on.
    fn fingerprint(&self, options: &Options) -> u64 {
        let mut hasher = DefaultHasher::new();
        let Arguments { fps, tracer, warning_color, voxels, small, backend, .. } = self.arguments;
        let options = Options { threads: None, level: None, ..options.clone() };
        let said = format!("{:?}", (&self.inputs, options, fps, tracer, warning_color, voxels.count, small, backend));
        (env!("CARGO_PKG_VERSION"), &self.text, said).hash(&mut hasher);
        let contents = self.files.contents.borrow();
        let mut names: Vec<&String> = contents.keys().collect();
        names.sort_unstable();
        names.into_iter().for_each(|name| (name, &contents[name]).hash(&mut hasher));
        hasher.finish()
    }

    /// Renders the frames that are not there yet.
    fn render(&self, done: &mut Done, interrupt: &Interrupt) -> Result<(), Failure> {
        let watch = Watch::new(self.arguments.quiet, interrupt);
        let backend = super::backend(self.arguments)?;
        let missing: Vec<u32> = self.range.clone().filter(|frame| !done.frames.contains(frame)).collect();
        let parts = self.range.len() as u64;
        let mut next = missing.first().map(|&frame| self.read(frame)).transpose()?;
        let mut places = missing.iter().copied().enumerate().peekable();
        while let (Some((place, frame)), Some(input)) = (places.next(), next.take()) {
            let part = |place: usize| watch.for_part(parts - missing.len() as u64 + place as u64, parts);
            let scene = match &input {
                Input::Scene(scene) if backend == Backend::Cpu => scene,
                _ => {
                    let (rendered, _) = make(self.arguments, backend, &input, &self.options(&input)?, &part(place))?;
                    done.write(frame, &rendered, &picture(&input), interrupt)?;
                    next = places.peek().map(|&(_, frame)| self.read(frame)).transpose()?;
                    continue;
                }
            };
            // What is compiled serves for all frames that follow until something else than the camera moves.
            let renderer = Renderer::new(scene).map_err(|error| cannot_render(error.into()))?;
            let mut options = self.options(&input)?;
            let (mut place, mut frame) = (place, frame);
            loop {
                let rendered = renderer.render(&options, &part(place)).map_err(cannot_render)?;
                done.write(frame, &rendered, &scene.picture, interrupt)?;
                let Some(&(following, number)) = places.peek() else { break };
                let input = self.read(number)?;
                match &input {
                    Input::Scene(other) if scene.differs_only_in_camera(other) => {
                        options.camera.clone_from(&other.camera);
                        places.next();
                        (place, frame) = (following, number);
                    }
                    _ => {
                        next = Some(input);
                        break;
                    }
                }
            }
        }
        watch.bar.finish_and_clear();
        Ok(())
    }
}

fn picture(input: &Input) -> Picture {
    match input {
        Input::Scene(scene) => scene.picture.clone(),
        Input::Figures(_) | Input::Region(_) => Picture::default(),
    }
}

/// The frames that are done, and the list of them, which is there as long as some are missing.
struct Done {
    frames: BTreeSet<u32>,
    /// What comes before the number in the names of frames, with their folder, and the format.
    stem: PathBuf,
    format: Format,
    digits: usize,
    list: PathBuf,
    /// The folder that is there for the frames alone.
    folder: Option<PathBuf>,
}

impl Done {
    /// Looks up which frames are there from before, if they were made alike.
    fn open(path: &Path, target: Target, fingerprint: u64, range: &Range<u32>) -> Result<Self, Failure> {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let (folder, stem, list) = match target {
            Target::Files(_) => (None, path.with_file_name(&*name), path.with_file_name(format!(".{name}-frames"))),
            Target::Movie(_) => {
                let whole = path.file_name().unwrap_or_default().to_string_lossy();
                let folder = path.with_file_name(format!(".{whole}-frames"));
                std::fs::create_dir_all(&folder).map_err(|error| cannot_write(&folder, &error))?;
                (Some(folder.clone()), folder.join("frame"), folder.join("list"))
            }
        };
        let digits = (range.end - 1).to_string().len().max(FEWEST_DIGITS);
        let mut done = Self { frames: BTreeSet::new(), stem, format: target.format(), digits, list, folder };
        let heading = format!("{fingerprint:016x}");
        let known = std::fs::read_to_string(&done.list).unwrap_or_default();
        if let Some(numbers) = known.strip_prefix(&heading) {
            let numbers = numbers.lines().filter_map(|line| line.parse().ok());
            done.frames = numbers.filter(|&frame| range.contains(&frame) && done.path(frame).is_file()).collect();
        }
        let lines = done.frames.iter().map(|frame| format!("{frame}\n")).collect::<String>();
        std::fs::write(&done.list, format!("{heading}\n{lines}")).map_err(|error| cannot_write(&done.list, &error))?;
        Ok(done)
    }

    /// The file of a frame.
    fn path(&self, frame: u32) -> PathBuf {
        let mut name = self.stem.clone().into_os_string();
        let suffix = if self.format == Format::Png { "png" } else { "exr" };
        name.push(format!("-{frame:0digits$}.{suffix}", digits = self.digits));
        name.into()
    }

    /// Writes a frame, and then that it is done.
    fn write(
        &mut self,
        frame: u32,
        rendered: &Rendered,
        picture: &Picture,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let path = self.path(frame);
        let bytes = self.format.encode(rendered, picture, Compression::Quick);
        let bytes = bytes.map_err(|error| Failure::Input(error.to_string()))?;
        open(&path, interrupt)?.write(&bytes).map_err(|error| cannot_write(&path, &error))?;
        let append = || writeln!(std::fs::OpenOptions::new().append(true).open(&self.list)?, "{frame}");
        append().map_err(|error| cannot_write(&self.list, &error))?;
        self.frames.insert(frame);
        Ok(())
    }

    /// Removes what is there only until all frames are.
    fn forget(&self) {
        // What stays does no harm.
        let _ = std::fs::remove_file(&self.list);
        if let Some(folder) = &self.folder {
            let _ = std::fs::remove_dir_all(folder);
        }
    }

    /// What was written, in a message.
    fn shown(&self, path: &Path, range: &Range<u32>) -> String {
        match self.folder {
            Some(_) => path.display().to_string(),
            None if range.len() == 1 => self.path(range.start).display().to_string(),
            None => format!("{} to {}", self.path(range.start).display(), self.path(range.end - 1).display()),
        }
    }
}

/// Numbers of frames have so many digits at least.
const FEWEST_DIGITS: usize = 4;

/// Puts the frames into one file.
fn assemble(
    container: Container,
    done: &Done,
    range: &Range<u32>,
    rate: u16,
    path: &Path,
    file: Option<freikugel::files::Output>,
) -> Result<(), Failure> {
    let failure = |error: AnimationError| match error {
        AnimationError::Write(error) => cannot_write(path, &error),
        error => Failure::Input(error.to_string()),
    };
    // What ffmpeg writes takes its name when it is complete.
    let beside = done.list.with_file_name("video");
    let mut animation: Option<Animation> = None;
    for frame in range.clone() {
        let Bitmap { width, height, pixels } = Bitmap::read(&done.path(frame))?;
        let animation = match &mut animation {
            Some(animation) => animation,
            none => {
                let made = Animation::new(container, &beside, [width, height], range.len() as u32, rate);
                none.insert(made.map_err(failure)?)
            }
        };
        animation.push(pixels.as_flattened()).map_err(failure)?;
    }
    let contents = animation.map_or(Ok(None), Animation::finish).map_err(failure)?;
    match (contents, file) {
        (Some(contents), Some(file)) => file.write(&contents).map_err(|error| cannot_write(path, &error)),
        _ => std::fs::rename(&beside, path).map_err(|error| cannot_write(path, &error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_leave_their_end_out() {
        assert_eq!(parse_range("0..120"), Ok(0..120));
        assert_eq!(parse_range(" 5 .. 6 "), Ok(5..6));
        for (text, says) in [
            ("120", "no range"),
            ("5..5", "no frames"),
            ("6..5", "no frames"),
            ("0..x", "no range"),
            ("0..9999999", "more than"),
        ] {
            let fault = parse_range(text).expect_err(text);
            assert!(fault.contains(says), "{text}: {fault}");
        }
    }
}
