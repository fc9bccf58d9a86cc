//! Pictures without a window: the counterpart of the CPU's renderer, with the same options, samples, images and layers.

use crate::device::{Gpu, GpuError};
use crate::kernel::Kernel;
use crate::picture::{Stopped, mean};
use crate::source::{Shown, Source, TileView, framed, resized};
use crate::tiler::BUDGET;
use freikugel_render::{
    Image, Layer, Layers, Options, OptionsError, Progress, Rays, Rect, Rendered, Stats, Times, Unresolved,
    sample_offsets,
};
use freikugel_scene::Scene;
use freikugel_shader::{Parameters, ShaderError, Show, View};
use glam::{DVec2, DVec3};
use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A scene on a graphics processor, ready for pictures of any size. It compiles the scene once; other numbers, another
/// camera or another size of the picture compile nothing.
pub struct GpuRenderer {
    scene: Scene,
    source: Source,
    parameters: Parameters,
    kernel: Kernel,
    voxels: Option<u32>,
    budget: Duration,
}

/// Why there is no picture.
#[derive(Debug)]
pub enum DrawError {
    /// The scene has mistakes, or no shader.
    Shader(ShaderError),
    /// The options can't be followed.
    Options(OptionsError),
    /// The graphics processor failed.
    Gpu(GpuError),
    /// [`Progress::is_cancelled`] asked to give up.
    Cancelled,
}

impl GpuRenderer {
    /// Compiles a scene.
    ///
    /// # Errors
    /// If it has mistakes, or the graphics processor refuses its shader.
    pub fn new(gpu: &Arc<Gpu>, scene: &Scene) -> Result<Self, DrawError> {
        Self::of(gpu, scene, None)
    }

    /// Samples a scene and compiles a shader that draws samples. All but planes is sampled, with `count` voxels along the longest
    /// side of its box: edges are rounded by about one of them, and what is thinner than one may have holes; how long a picture
    /// takes does not depend on what the scene is made of.
    ///
    /// # Errors
    /// As [`GpuRenderer::new`]; or if the scene can't be sampled, or memory does not suffice.
    pub fn of_voxels(gpu: &Arc<Gpu>, scene: &Scene, count: u32) -> Result<Self, DrawError> {
        Self::of(gpu, scene, Some(count))
    }

    fn of(gpu: &Arc<Gpu>, scene: &Scene, voxels: Option<u32>) -> Result<Self, DrawError> {
        let (source, parameters) = Source::new(scene, voxels)?;
        let kernel = Kernel::new(gpu, source.text(), (&parameters).into(), View::SIZE)?;
        Ok(Self { scene: scene.clone(), source, parameters, kernel, voxels, budget: BUDGET })
    }

    /// Takes another scene. Only if it differs in more than numbers, something is compiled; returns whether that was so. If
    /// it fails, the old scene stays.
    ///
    /// # Errors
    /// As [`GpuRenderer::new`].
    pub fn set_scene(&mut self, scene: &Scene) -> Result<bool, DrawError> {
        if let Ok(parameters) = self.source.parameters(scene) {
            self.kernel.set_table((&parameters).into())?;
            self.parameters = parameters;
            self.scene = scene.clone();
            return Ok(false);
        }
        let (source, parameters) = Source::new(scene, self.voxels)?;
        if source.text() != self.source.text() {
            *self = Self { budget: self.budget, ..Self::of(self.kernel.gpu(), scene, self.voxels)? };
            return Ok(true);
        }
        self.kernel.set_table((&parameters).into())?;
        (self.source, self.parameters, self.scene) = (source, parameters, scene.clone());
        Ok(false)
    }

    /// The bytes that samples of the scene take.
    pub fn voxel_bytes(&self) -> usize {
        size_of_val(self.parameters.voxels())
    }

    /// Gives each dispatch another time than [`BUDGET`].
    #[must_use]
    pub fn with_budget(self, budget: Duration) -> Self {
        Self { budget, ..self }
    }

    /// What it computes with.
    pub fn gpu(&self) -> &Arc<Gpu> {
        self.kernel.gpu()
    }

    /// The point of the world that the shader's coordinates are relative to.
    pub fn origin(&self) -> DVec3 {
        self.parameters.origin()
    }

    /// Renders a picture. Of the options, those of threads and instruction sets count for nothing. Of the statistics, only
    /// camera rays, unresolved ones and the wall time are known.
    ///
    /// # Errors
    /// If the options or the camera are faulty, the graphics processor fails, or the rendering was cancelled.
    pub fn render(&mut self, options: &Options, progress: &dyn Progress) -> Result<Rendered, DrawError> {
        let start = Instant::now();
        let region = options.region()?;
        self.prepare(options, options.samples)?;
        let offsets = sample_offsets(options.samples);
        let sums = self.picture(options, region, Show::Lit, &offsets, progress)?;
        let mut unresolved = Unresolved::default();
        let warning = self.scene.tracer.warning;
        let colors = sums.into_iter().map(|[red, green, blue, given_up]| {
            if given_up > 0.0 {
                unresolved.pixels += 1;
                unresolved.camera += (given_up * options.samples as f32).round() as u64;
                return warning.unwrap_or([red, green, blue]);
            }
            [red, green, blue]
        });
        let image = Image::new(region.width, region.height, colors.collect());
        let camera = region.pixels() * u64::from(options.samples);
        let stats = Stats {
            rays: Rays { camera, ..Rays::default() },
            unresolved,
            times: Times { wall: start.elapsed(), ..Times::default() },
            ..Stats::default()
        };
        Ok(Rendered { image, stats })
    }

    /// Computes what lies at the centre of each pixel, other than its colour. The samples of the options count for nothing.
    ///
    /// # Errors
    /// As [`GpuRenderer::render`].
    pub fn layers(&mut self, options: &Options, progress: &dyn Progress) -> Result<Layers, DrawError> {
        let region = options.region()?;
        self.prepare(options, 1)?;
        let centre = [DVec2::ZERO];
        let normals = self.picture(options, region, Show::LayerNormal, &centre, progress)?;
        let numbers = self.picture(options, region, Show::LayerNumbers, &centre, progress)?;
        let pixels = normals.into_iter().zip(numbers).map(|([x, y, z, distance], [depth, object, steps, given_up])| {
            let has_met = distance >= 0.0;
            Layer {
                steps: steps as u32,
                is_unresolved: given_up > 0.0,
                distance: if has_met { distance } else { f32::INFINITY },
                depth: if has_met { depth } else { f32::INFINITY },
                normal: if has_met { [x, y, z] } else { [0.0; 3] },
                object: (has_met && object >= 0.0).then_some(object as u32),
            }
        });
        Ok(Layers::new(region.width, region.height, pixels.collect()))
    }

    /// Gradients and values of the field that rays are marched through, at points of the world.
    ///
    /// # Errors
    /// If the graphics processor fails.
    pub fn probe(&mut self, points: &[DVec3]) -> Result<Vec<(DVec3, f64)>, DrawError> {
        self.kernel.set_parameters(self.parameters.numbers());
        let origin = self.parameters.origin();
        let points: Vec<[f32; 3]> = points.iter().map(|point| (*point - origin).as_vec3().to_array()).collect();
        let view = View::of(1, 1).bytes();
        let found = self.kernel.probe(&view, &points)?;
        Ok(found.into_iter().map(|[x, y, z, value]| (DVec3::new(x.into(), y.into(), z.into()), value.into())).collect())
    }

    /// Fits camera and tolerances to a picture.
    fn prepare(&mut self, options: &Options, samples: u32) -> Result<(), DrawError> {
        resized(&mut self.scene, &Options { samples, ..options.clone() });
        let camera = framed(&self.scene, options.width, options.height)?;
        let given = self.scene.camera.replace(camera);
        let looked = self.parameters.look(&self.scene);
        self.scene.camera = given;
        looked?;
        self.kernel.set_parameters(self.parameters.numbers());
        Ok(())
    }

    fn picture(
        &self,
        options: &Options,
        region: Rect,
        show: Show,
        offsets: &[DVec2],
        progress: &dyn Progress,
    ) -> Result<Vec<[f32; 4]>, DrawError> {
        let frame = [options.width, options.height];
        let view = |tile: Rect, sample: u32| {
            TileView { frame, tile, offset: offsets[sample as usize], time: 0.0, shown: Shown::Of(show) }.bytes()
        };
        let found = mean(&self.kernel, region, offsets.len() as u32, self.budget, view, progress);
        found.map_err(|stopped| match stopped {
            Stopped::Failed(error) => DrawError::Gpu(error),
            Stopped::Cancelled => DrawError::Cancelled,
        })
    }
}

impl From<ShaderError> for DrawError {
    fn from(error: ShaderError) -> Self {
        Self::Shader(error)
    }
}

impl From<OptionsError> for DrawError {
    fn from(error: OptionsError) -> Self {
        Self::Options(error)
    }
}

impl From<GpuError> for DrawError {
    fn from(error: GpuError) -> Self {
        Self::Gpu(error)
    }
}

impl fmt::Display for DrawError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shader(error) => error.fmt(f),
            Self::Options(error) => error.fmt(f),
            Self::Gpu(error) => error.fmt(f),
            Self::Cancelled => f.write_str("the rendering was cancelled"),
        }
    }
}

impl std::error::Error for DrawError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Shader(error) => Some(error),
            Self::Options(error) => Some(error),
            Self::Gpu(error) => Some(error),
            Self::Cancelled => None,
        }
    }
}
