//! What a kernel gets from a scene: the shader's text with the addition of slices, the numbers, and the bytes of views.

use freikugel_render::{Options, Rect, Renderer};
use freikugel_scene::{Camera, Scene};
use freikugel_shader::{Parameters, Shader, ShaderError, Show, Target, View};
use glam::{DVec2, DVec3};
use std::fmt;

/// The field on a plane, drawn with the functions of the scene's shader.
const SLICE: &str = include_str!("slice.wgsl");

/// A scene's shader.
pub(crate) struct Source {
    shader: Shader,
    text: String,
}

/// What a tile is to show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shown {
    /// One of the views that each shader has.
    Of(Show),
    /// The field on the plane at some distance in front of the eye.
    Slice {
        /// The distance.
        depth: f64,
    },
}

/// A sample of a tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileView {
    /// The size of the whole picture.
    pub(crate) frame: [u32; 2],
    /// The tile in it.
    pub(crate) tile: Rect,
    /// Where in its pixel the sample lies, from the centre.
    pub(crate) offset: DVec2,
    /// Seconds since the start.
    pub(crate) time: f64,
    pub(crate) shown: Shown,
}

impl Source {
    /// The shader of a scene, and the scene's numbers for a picture of the size that the scene asks for. With a number of voxels,
    /// all but planes is sampled, and that is how many there are along the longest side.
    ///
    /// # Errors
    /// If the scene has mistakes, or can't be sampled.
    pub(crate) fn new(scene: &Scene, voxels: Option<u32>) -> Result<(Self, Parameters), ShaderError> {
        let shader = match voxels {
            None => Shader::new(scene)?,
            Some(count) => Shader::of_voxels(scene, count)?,
        };
        let parameters = shader.parameters(scene)?;
        let text = shader.text(Target::Wgsl, &parameters)? + SLICE;
        Ok((Self { shader, text }, parameters))
    }

    /// The text, which no number changes.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// The numbers of another scene that has the same text.
    ///
    /// # Errors
    /// If it has mistakes, or another text.
    pub(crate) fn parameters(&self, scene: &Scene) -> Result<Parameters, ShaderError> {
        self.shader.parameters(scene)
    }
}

impl TileView {
    /// As the shader reads it.
    pub(crate) fn bytes(&self) -> [u8; View::SIZE] {
        let Self { frame, tile, offset, time, shown } = *self;
        let (show, weight) = match shown {
            Shown::Of(show) => (show, 1.0),
            Shown::Slice { depth } => (Show::Lit, depth as f32),
        };
        let place = offset + 0.5;
        View {
            size: frame.map(|side| side as f32),
            tile: [tile.x as f32, tile.y as f32],
            place: [place.x as f32, place.y as f32],
            time: time as f32,
            show,
            tile_size: [tile.width, tile.height],
            keep: 0.0,
            weight,
        }
        .bytes()
    }
}

/// A scene with another size of its picture, and other samples.
pub(crate) fn resized(scene: &mut Scene, options: &Options) {
    (scene.picture.width, scene.picture.height) = (options.width, options.height);
    scene.picture.samples = options.samples;
}

/// The scene's camera, or the one that frames it in a picture of some size.
///
/// # Errors
/// If the scene can't be rendered.
pub(crate) fn framed(scene: &Scene, width: u32, height: u32) -> Result<Camera, ShaderError> {
    match &scene.camera {
        Some(camera) => Ok(camera.clone()),
        None => Ok(Renderer::new(scene).map_err(ShaderError::Prepare)?.camera(width, height)),
    }
}

/// How far in front of a camera's eye its target is.
pub(crate) fn depth_of_target(camera: &Camera) -> f64 {
    let to_target: DVec3 = camera.target - camera.eye;
    to_target.length()
}

impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Source").field("text", &self.text).finish_non_exhaustive()
    }
}
