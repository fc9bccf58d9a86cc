//! The scene as the window sees it: its shader, the sums of its samples, and what is drawn into them next. Knows the
//! graphics processor, but no window.

use super::keys::Show;
use super::present::Picture;
use super::refine::{Fine, Refinement, STILL_TILE, Work};
use crate::device::{Gpu, GpuError};
use crate::kernel::{Entry, Kernel, MOST_TILE_PIXELS, Sums};
use crate::source::{Shown, Source, TileView, depth_of_target, framed, resized};
use freikugel_render::{Compression, EncodeError, Image, Options, Rect, Tone, encode_png, sample_offsets};
use freikugel_scene::color::linear;
use freikugel_scene::{Camera, Scene};
use freikugel_shader::{Parameters, ShaderError, Show as Layer, View};
use glam::DVec2;
use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long to draw finer tiles before the window looks for input again.
const STILL_FRAME: Duration = Duration::from_millis(25);

/// The scene as the window sees it.
pub(crate) struct Stage {
    gpu: Arc<Gpu>,
    scene: Scene,
    source: Source,
    parameters: Parameters,
    kernel: Kernel,
    coarse: Sums,
    fine: Sums,
    /// The size of the picture that `coarse` holds.
    coarse_size: [u32; 2],
    size: [u32; 2],
    refinement: Refinement,
    offsets: Vec<DVec2>,
    show: Show,
    time: f64,
    /// What has drawn a whole picture already. Drivers compile when something is drawn first, which says nothing of the pace.
    warm: Vec<Entry>,
    /// How many voxels there are along the longest side, if the scene is sampled.
    voxels: Option<u32>,
}

/// Why a scene can't be shown.
#[derive(Debug)]
pub(crate) enum StageError {
    /// The graphics processor failed.
    Gpu(GpuError),
    /// The scene has no shader.
    Shader(ShaderError),
    /// The picture can't be saved.
    Encode(EncodeError),
}

impl Stage {
    /// Compiles a scene, for a window of some size and with some rays a pixel in the end; samples it before if there is a number
    /// of voxels.
    pub(crate) fn new(
        gpu: &Arc<Gpu>,
        scene: Scene,
        size: [u32; 2],
        samples: u32,
        voxels: Option<u32>,
    ) -> Result<Self, StageError> {
        let (source, parameters, kernel, scene) = compiled(gpu, scene, size, samples, voxels)?;
        let [coarse, fine] = sums(&kernel, size)?;
        Ok(Self {
            gpu: Arc::clone(gpu),
            scene,
            source,
            parameters,
            kernel,
            coarse,
            fine,
            coarse_size: [1; 2],
            size,
            refinement: Refinement::new(size, samples, MOST_TILE_PIXELS),
            offsets: sample_offsets(samples),
            show: Show::Lit,
            time: 0.0,
            warm: Vec::new(),
            voxels,
        })
    }

    /// Takes another scene. If only its numbers differ, nothing is compiled. If it can't be shown, the old one stays.
    pub(crate) fn set_scene(&mut self, mut scene: Scene) -> Result<(), StageError> {
        prepared(&mut scene, self.size, self.samples())?;
        if let Ok(parameters) = self.source.parameters(&scene) {
            self.kernel.set_table((&parameters).into())?;
            (self.parameters, self.scene) = (parameters, scene);
        } else {
            let samples = self.samples();
            let (source, parameters, kernel, scene) = compiled(&self.gpu, scene, self.size, samples, self.voxels)?;
            let [coarse, fine] = sums(&kernel, self.size)?;
            (self.source, self.parameters, self.kernel, self.scene) = (source, parameters, kernel, scene);
            (self.coarse, self.fine) = (coarse, fine);
            self.refinement.forget_pace();
            self.warm.clear();
        }
        self.refinement.restart();
        Ok(())
    }

    /// Fits another size of the window.
    pub(crate) fn resize(&mut self, size: [u32; 2]) -> Result<(), StageError> {
        [self.coarse, self.fine] = sums(&self.kernel, size)?;
        self.size = size;
        self.refinement.resize(size, self.samples());
        self.look()
    }

    /// Looks from somewhere else, at something else, or at another time.
    pub(crate) fn set_view(&mut self, camera: &Camera, show: Show, time: f64) -> Result<(), StageError> {
        if self.scene.camera.as_ref() != Some(camera) {
            self.scene.camera = Some(camera.clone());
            self.look()?;
        }
        (self.show, self.time) = (show, time);
        self.refinement.restart();
        Ok(())
    }

    /// Fits the numbers to the camera and the size of the window.
    fn look(&mut self) -> Result<(), StageError> {
        let [width, height] = self.size;
        let options = Options { width, height, samples: self.samples(), ..Options::default() };
        resized(&mut self.scene, &options);
        self.parameters.look(&self.scene)?;
        self.kernel.set_parameters(self.parameters.numbers());
        Ok(())
    }

    /// Draws what comes next; the time of the picture if it was a whole one, as while things move.
    pub(crate) fn draw(&mut self) -> Result<Option<Duration>, StageError> {
        let start = Instant::now();
        let mut whole = None;
        while let Some(work) = self.refinement.next() {
            let begin = Instant::now();
            match work {
                Work::Coarse { width, height } => {
                    self.coarse_size = [width, height];
                    for tile in bands(width, height) {
                        self.sample(tile, [width, height], 0, DVec2::ZERO, &self.coarse)?;
                    }
                }
                Work::Fine { tile, sample } => {
                    let offset = self.offsets[sample as usize];
                    self.sample(tile, self.size, sample, offset, &self.fine)?;
                }
            }
            let time = begin.elapsed();
            let entry = self.entry();
            if !self.warm.contains(&entry) {
                self.warm.push(entry);
                break;
            }
            self.refinement.took(work, time);
            if matches!(work, Work::Coarse { .. }) {
                whole = Some(time);
                break;
            }
            if start.elapsed() + STILL_TILE > STILL_FRAME {
                break;
            }
        }
        Ok(whole)
    }

    /// What there is to show.
    pub(crate) fn picture(&self) -> Picture<'_> {
        Picture {
            size: self.size,
            coarse: &self.coarse,
            coarse_size: self.coarse_size,
            fine: &self.fine,
            progress: self.refinement.fine(),
            tone: self.tone(),
        }
    }

    /// What is shown as a PNG file, without text. Waits until each pixel has a sample.
    pub(crate) fn png(&mut self) -> Result<Vec<u8>, StageError> {
        while self.refinement.fine().samples == 0 && !self.refinement.is_finished() {
            self.draw()?;
        }
        let [width, height] = self.size;
        let Fine { samples, covered: [rows, band, columns] } = self.refinement.fine();
        let sums = self.kernel.read(&self.fine, u64::from(width) * u64::from(height))?;
        let tone = self.tone();
        let colors = sums.iter().zip(0..).map(|(&[red, green, blue, _], index)| {
            let (x, y) = (index % width, index / width);
            let is_ahead = y < rows || (y < rows + band && x < columns);
            let weight = 1.0 / (samples + u32::from(is_ahead)) as f32;
            let color = [red, green, blue].map(|channel| channel * weight);
            // What is no light is a code already.
            if tone.is_some() { color } else { color.map(|code| linear(code.clamp(0.0, 1.0).into()) as f32) }
        });
        let image = Image::new(width, height, colors.collect());
        encode_png(&image, &tone.unwrap_or_default(), Compression::Quick).map_err(StageError::Encode)
    }

    /// The scene's camera, or the one that frames it.
    pub(crate) fn camera(&self) -> Camera {
        self.scene.camera.clone().unwrap_or_default()
    }

    /// Whether the scene depends on time.
    pub(crate) fn is_animated(&self) -> bool {
        false
    }

    /// Rays a pixel in the end.
    pub(crate) fn samples(&self) -> u32 {
        self.offsets.len() as u32
    }

    /// The size of pictures while things move.
    pub(crate) fn coarse_size(&self) -> [u32; 2] {
        self.refinement.coarse_size()
    }

    /// What the finer picture holds.
    pub(crate) fn fine(&self) -> Fine {
        self.refinement.fine()
    }

    /// Whether there is nothing left to draw.
    pub(crate) fn is_finished(&self) -> bool {
        self.refinement.is_finished()
    }

    fn entry(&self) -> Entry {
        match self.show {
            Show::Slice => Entry::Slice,
            Show::Lit | Show::Normals | Show::Steps | Show::Depth => Entry::Render,
        }
    }

    fn tone(&self) -> Option<Tone> {
        (self.show == Show::Lit).then(|| Tone::of(&self.scene.picture))
    }

    fn sample(&self, tile: Rect, frame: [u32; 2], sample: u32, offset: DVec2, sums: &Sums) -> Result<(), StageError> {
        let shown = match self.show {
            Show::Lit => Shown::Of(Layer::Lit),
            Show::Normals => Shown::Of(Layer::Normals),
            Show::Steps => Shown::Of(Layer::Steps),
            Show::Depth => Shown::Of(Layer::Depth),
            Show::Slice => Shown::Slice { depth: depth_of_target(&self.camera()) },
        };
        let view = TileView { frame, tile, offset, time: self.time, shown };
        let submission = self.kernel.add_sample(self.entry(), &view.bytes(), tile, frame[0], sample == 0, sums)?;
        Ok(self.gpu.wait(submission)?)
    }
}

/// Sets the picture's size, and a camera if there is none.
fn prepared(scene: &mut Scene, [width, height]: [u32; 2], samples: u32) -> Result<(), StageError> {
    resized(scene, &Options { width, height, samples, ..Options::default() });
    scene.camera = Some(framed(scene, width, height)?);
    Ok(())
}

/// A scene's shader and numbers, and the scene with a camera.
fn compiled(
    gpu: &Arc<Gpu>,
    mut scene: Scene,
    size: [u32; 2],
    samples: u32,
    voxels: Option<u32>,
) -> Result<(Source, Parameters, Kernel, Scene), StageError> {
    prepared(&mut scene, size, samples)?;
    let (source, parameters) = Source::new(&scene, voxels)?;
    let kernel = Kernel::new(gpu, source.text(), (&parameters).into(), View::SIZE)?;
    Ok((source, parameters, kernel, scene))
}

/// Room for a coarse picture, which may be as fine as the window, and for a fine one.
fn sums(kernel: &Kernel, [width, height]: [u32; 2]) -> Result<[Sums; 2], GpuError> {
    let pixels = u64::from(width) * u64::from(height);
    Ok([kernel.sums(pixels)?, kernel.sums(pixels)?])
}

/// A picture in as few bands as tiles may be large.
fn bands(width: u32, height: u32) -> impl Iterator<Item = Rect> {
    let rows = (MOST_TILE_PIXELS / u64::from(width)).max(1) as u32;
    (0..height).step_by(rows as usize).map(move |y| Rect { x: 0, y, width, height: rows.min(height - y) })
}

impl From<GpuError> for StageError {
    fn from(error: GpuError) -> Self {
        Self::Gpu(error)
    }
}

impl From<ShaderError> for StageError {
    fn from(error: ShaderError) -> Self {
        Self::Shader(error)
    }
}

impl fmt::Display for StageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gpu(error) => error.fmt(f),
            Self::Shader(error) => error.fmt(f),
            Self::Encode(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for StageError {}
