//! Frame after frame of a scene, for measurements: as a window draws it while something moves, but shown nowhere.

use crate::device::Gpu;
use crate::kernel::{Entry, Kernel, MOST_TILE_PIXELS, Sums};
use crate::renderer::DrawError;
use crate::source::{Shown, Source, TileView, resized};
use crate::tiler::{BUDGET, Tiler};
use freikugel_render::{Image, Options, Rect};
use freikugel_scene::{Camera, Scene};
use freikugel_shader::{Parameters, Show, View};
use glam::DVec2;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A scene on a graphics processor, drawn frame by frame with one ray a pixel. The text and the pipelines are made once; each
/// frame sends its numbers, draws, and waits until that is done. Pixels stay where they are, unless someone reads them.
pub struct Frames {
    scene: Scene,
    parameters: Parameters,
    kernel: Kernel,
    sums: Sums,
    frame: Rect,
    tiler: Tiler,
    creation: Creation,
}

/// What had to be done before the first frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Creation {
    /// Making the text of the shader and its numbers from the scene, and sampling it if it is.
    pub text: Duration,
    /// Making pipelines of the text: reading and checking it, and what the driver does at this point. Some drivers put off the
    /// rest until the first frame.
    pub pipelines: Duration,
    /// The length of the text in bytes.
    pub text_bytes: usize,
}

impl Frames {
    /// Makes a scene ready for frames of the size that the options say. Nothing else of them counts. With a number of voxels, it is
    /// sampled: see [`GpuRenderer::of_voxels`](crate::GpuRenderer::of_voxels).
    ///
    /// # Errors
    /// If the scene or the size is faulty, or the graphics processor refuses the shader or has no memory for a frame.
    pub fn new(gpu: &Arc<Gpu>, scene: &Scene, options: &Options, voxels: Option<u32>) -> Result<Self, DrawError> {
        let frame = Options { crop: None, ..options.clone() }.region()?;
        let mut scene = scene.clone();
        resized(&mut scene, &Options { samples: 1, ..options.clone() });
        let start = Instant::now();
        let (source, parameters) = Source::new(&scene, voxels)?;
        let text = start.elapsed();
        let start = Instant::now();
        let kernel = Kernel::new(gpu, source.text(), (&parameters).into(), View::SIZE)?;
        let creation = Creation { text, pipelines: start.elapsed(), text_bytes: source.text().len() };
        let sums = kernel.sums(frame.pixels())?;
        let tiler = Tiler::new(frame, MOST_TILE_PIXELS, BUDGET);
        Ok(Self { scene, parameters, kernel, sums, frame, tiler, creation })
    }

    /// What had to be done before the first frame.
    pub fn creation(&self) -> Creation {
        self.creation
    }

    /// Draws a frame from a camera, and learns into how many pieces one has to be cut so that no dispatch runs long. Returns how
    /// long it took, with all waiting between the pieces.
    ///
    /// # Errors
    /// If the camera shows nothing, or the graphics processor fails.
    pub fn practise(&mut self, camera: &Camera) -> Result<Duration, DrawError> {
        let start = Instant::now();
        self.look(camera)?;
        self.tiler.restart();
        while let Some(tile) = self.tiler.next() {
            let start = Instant::now();
            let submission = self.send(tile)?;
            self.kernel.gpu().wait(submission)?;
            self.tiler.took(tile, start.elapsed());
        }
        Ok(start.elapsed())
    }

    /// Draws a frame from a camera, cut as the frames for practice taught. Returns the time from when the camera is known until
    /// all pixels are there.
    ///
    /// # Errors
    /// If the camera shows nothing, or the graphics processor fails.
    pub fn draw(&mut self, camera: &Camera) -> Result<Duration, DrawError> {
        let start = Instant::now();
        self.look(camera)?;
        self.tiler.restart();
        let mut last = None;
        while let Some(tile) = self.tiler.next() {
            last = Some(self.send(tile)?);
        }
        if let Some(submission) = last {
            self.kernel.gpu().wait(submission)?;
        }
        Ok(start.elapsed())
    }

    /// The frame that was drawn last.
    ///
    /// # Errors
    /// If the graphics processor fails.
    pub fn read(&self) -> Result<Image, DrawError> {
        let pixels = self.kernel.read(&self.sums, self.frame.pixels())?;
        let colors = pixels.into_iter().map(|[red, green, blue, _]| [red, green, blue]);
        Ok(Image::new(self.frame.width, self.frame.height, colors.collect()))
    }

    fn look(&mut self, camera: &Camera) -> Result<(), DrawError> {
        self.scene.camera = Some(camera.clone());
        self.parameters.look(&self.scene)?;
        self.kernel.set_parameters(self.parameters.numbers());
        Ok(())
    }

    fn send(&self, tile: Rect) -> Result<wgpu::SubmissionIndex, DrawError> {
        let Rect { width, height, .. } = self.frame;
        let view =
            TileView { frame: [width, height], tile, offset: DVec2::ZERO, time: 0.0, shown: Shown::Of(Show::Lit) };
        Ok(self.kernel.add_sample(Entry::Render, &view.bytes(), tile, width, true, &self.sums)?)
    }
}

impl std::fmt::Debug for Frames {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Frames").field("frame", &self.frame).field("creation", &self.creation).finish_non_exhaustive()
    }
}
