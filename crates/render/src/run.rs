//! Tiles, threads, progress: how a whole picture gets computed.
//!
//! Threads take the next tile from a shared counter until none is left. Each pixel is the mean of its own rays, added up
//! in the order of its sample pattern, so that neither tiles nor threads nor the size of waves change a bit of it.

use crate::filter;
use crate::image::Image;
use crate::layers::Layers;
use crate::options::{Options, OptionsError, Rect};
use crate::prepare::{Frame, PrepareError, Renderer};
use crate::shade::Shading;
use crate::stats::Stats;
use crate::trace::Tracer;
use crate::vector::{Triple, add_scaled, scaled};
use freikugel_scene::Scene;
use glam::DVec2;
use std::fmt;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

/// Rays traced together. Few enough for their buffers to stay in the second-level cache, many enough that the
/// stragglers among them still fill the lanes.
const WAVE: usize = 2048;

/// Hears how far a rendering has come, and may stop it. All methods are called from several threads.
pub trait Progress: Sync {
    /// `done` of `total` pixels are computed.
    fn advanced(&self, done: u64, total: u64) {
        let _ = (done, total);
    }

    /// Whether to give up. Asked several times a second at least, except where a single wave of rays takes longer.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Nobody listens.
impl Progress for () {}

/// Stops when set.
impl Progress for AtomicBool {
    fn is_cancelled(&self) -> bool {
        self.load(Ordering::Relaxed)
    }
}

/// A picture and what it took.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// Linear Rec. 709 colours of the frame or of the crop.
    pub image: Image,
    /// Counts and times.
    pub stats: Stats,
}

/// Why there is no picture.
#[derive(Clone, Debug)]
pub enum RenderError {
    /// The scene can't be rendered.
    Prepare(PrepareError),
    /// The options can't be followed.
    Options(OptionsError),
    /// There is not enough memory for the picture.
    Memory,
    /// A slice would have more than this many lines at equal distances.
    Lines(u32),
    /// It was given up as [`Progress::is_cancelled`] asked for.
    Cancelled,
}

/// Renders a scene.
///
/// # Errors
/// If the scene or the options are faulty, or the rendering was cancelled.
pub fn render(scene: &Scene, options: &Options, progress: &dyn Progress) -> Result<Rendered, RenderError> {
    Renderer::new(scene)?.render(options, progress)
}

impl Renderer<'_> {
    /// Renders a picture.
    ///
    /// # Errors
    /// If camera, lights or options are faulty, or the rendering was cancelled.
    pub fn render(&self, options: &Options, progress: &dyn Progress) -> Result<Rendered, RenderError> {
        let start = Instant::now();
        let region = options.region()?;
        let frame = Frame::new(self, options)?;
        let offsets = filter::offsets(options.samples);
        let warning = self.scene.tracer.warning;
        let mut pixels = filled(region, [0.0; 3])?;
        let mut stats = in_tiles(&frame, options, region, progress, &mut pixels, || {
            let mut shading = Shading::default();
            let mut colors = Vec::new();
            let mut order = Order::default();
            let offsets = &offsets;
            move |tracer, tile, out: &mut [Triple]| {
                order.fit(tile);
                let mut unresolved = vec![false; out.len()];
                let weight = 1.0 / offsets.len() as f32;
                let mut rays = 0..out.len() * offsets.len();
                while !rays.is_empty() {
                    if progress.is_cancelled() {
                        return;
                    }
                    let wave = rays.start..(rays.start + WAVE).min(rays.end);
                    rays.start = wave.end;
                    tracer.clear();
                    for ray in wave.clone() {
                        tracer.push(order.center(ray / offsets.len()) + offsets[ray % offsets.len()]);
                    }
                    tracer.trace();
                    tracer.shade(&mut shading, &mut colors);
                    for (ray, &color) in wave.clone().zip(&colors) {
                        let pixel = &mut out[order.pixel(ray / offsets.len())];
                        *pixel = add_scaled(*pixel, 1.0, color);
                    }
                    for &ray in &tracer.unresolved {
                        unresolved[order.pixel((wave.start + ray as usize) / offsets.len())] = true;
                    }
                }
                for (pixel, &is_unresolved) in out.iter_mut().zip(&unresolved) {
                    *pixel = warning.filter(|_| is_unresolved).unwrap_or_else(|| scaled(*pixel, weight));
                }
                let count = unresolved.iter().filter(|&&pixel| pixel).count();
                tracer.stats.unresolved.pixels += count as u64;
            }
        })?;
        stats.times.wall = start.elapsed();
        Ok(Rendered { image: Image::new(region.width, region.height, pixels), stats })
    }

    /// Computes what lies at the centre of each pixel, other than its colour. The samples of the options count for
    /// nothing here.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn layers(&self, options: &Options, progress: &dyn Progress) -> Result<(Layers, Stats), RenderError> {
        let start = Instant::now();
        let region = options.region()?;
        let frame = Frame::new(self, &Options { samples: 1, ..options.clone() })?;
        let frame = Frame { tells_objects: true, ..frame };
        let mut pixels = filled(region, Layers::NOTHING)?;
        let mut stats = in_tiles(&frame, options, region, progress, &mut pixels, || {
            let mut order = Order::default();
            move |tracer, tile, out: &mut [_]| {
                order.fit(tile);
                for first in (0..out.len()).step_by(WAVE) {
                    if progress.is_cancelled() {
                        return;
                    }
                    let wave = first..(first + WAVE).min(out.len());
                    tracer.clear();
                    for ray in wave.clone() {
                        tracer.push(order.center(ray));
                    }
                    tracer.trace();
                    Layers::collect(tracer, out, |ray| order.pixel(first + ray));
                    tracer.stats.unresolved.pixels += tracer.unresolved.len() as u64;
                }
            }
        })?;
        stats.times.wall = start.elapsed();
        Ok((Layers::new(region.width, region.height, pixels), stats))
    }
}

/// The sides of the blocks, smallest first, whose pixels are traced one after the other: those of a row of lanes and of a
/// bundle lie side by side, so that their rays meet the same boxes.
const BLOCKS: [u32; 2] = [4, 16];

/// The order in which the pixels of a tile are traced.
#[derive(Default)]
struct Order {
    tile: Rect,
    /// Column and row in the tile.
    pixels: Vec<[u32; 2]>,
}

impl Order {
    /// Makes the order for a tile.
    fn fit(&mut self, tile: Rect) {
        if (self.tile.width, self.tile.height) != (tile.width, tile.height) {
            self.pixels.clear();
            self.pixels.extend((0..tile.height).flat_map(|row| (0..tile.width).map(move |column| [column, row])));
            self.pixels.sort_by_key(|&[column, row]| {
                let [small, large] = BLOCKS.map(|side| [row / side, column / side]);
                [large, small, [row, column]]
            });
        }
        self.tile = tile;
    }

    /// The place of a pixel in its tile, row by row.
    fn pixel(&self, place: usize) -> usize {
        let [column, row] = self.pixels[place];
        (row * self.tile.width + column) as usize
    }

    /// The raster coordinates of the centre of a pixel.
    fn center(&self, place: usize) -> DVec2 {
        let [column, row] = self.pixels[place];
        DVec2::new(f64::from(self.tile.x + column), f64::from(self.tile.y + row)) + 0.5
    }
}

fn filled<T: Clone>(region: Rect, value: T) -> Result<Vec<T>, RenderError> {
    let count = usize::try_from(region.pixels()).map_err(|_| RenderError::Memory)?;
    let mut pixels = Vec::new();
    pixels.try_reserve_exact(count).map_err(|_| RenderError::Memory)?;
    pixels.resize(count, value);
    Ok(pixels)
}

/// Has all threads compute tiles of `region` until `pixels` is full. `worker` makes what one thread computes a tile with;
/// that gets the tile's pixels, row by row, as they are in `pixels`.
fn in_tiles<'f, T, W>(
    frame: &'f Frame<'f>,
    options: &Options,
    region: Rect,
    progress: &dyn Progress,
    pixels: &mut [T],
    worker: impl Fn() -> W + Sync,
) -> Result<Stats, RenderError>
where
    T: Copy + Send + Sync,
    W: FnMut(&mut Tracer<'f>, Rect, &mut [T]),
{
    struct Shared<'p, T> {
        pixels: &'p mut [T],
        done: u64,
        stats: Stats,
    }
    let tiles = region.tiles(options.tile);
    let threads = options.threads_for(tiles.len());
    let next = AtomicUsize::new(0);
    let blank = pixels[0];
    let shared = Mutex::new(Shared { pixels, done: 0, stats: Stats::default() });
    let work = || {
        let start = Instant::now();
        let mut tracer = Tracer::new(frame);
        let mut compute = worker();
        let mut own = Vec::new();
        while let Some(&tile) = tiles.get(next.fetch_add(1, Ordering::Relaxed)) {
            own.clear();
            own.resize(tile.pixels() as usize, blank);
            compute(&mut tracer, tile, &mut own);
            if progress.is_cancelled() {
                break;
            }
            // A thread that panicked takes the whole rendering down with it, so nobody sees its tile.
            let mut shared = shared.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            for (row, from) in own.chunks_exact(tile.width as usize).enumerate() {
                let row = (tile.y - region.y) as usize + row;
                let start = row * region.width as usize + (tile.x - region.x) as usize;
                shared.pixels[start..start + from.len()].copy_from_slice(from);
            }
            shared.done += tile.pixels();
            // Told under the lock, so that what is heard never runs backwards.
            progress.advanced(shared.done, region.pixels());
        }
        tracer.stats.times.work = start.elapsed();
        let mut shared = shared.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        shared.stats += tracer.stats;
    };
    std::thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(work);
        }
        work();
    });
    let Shared { done, mut stats, .. } = shared.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    if done < region.pixels() {
        return Err(RenderError::Cancelled);
    }
    stats.times.threads = threads as u64;
    Ok(stats)
}

impl From<PrepareError> for RenderError {
    fn from(error: PrepareError) -> Self {
        Self::Prepare(error)
    }
}

impl From<OptionsError> for RenderError {
    fn from(error: OptionsError) -> Self {
        Self::Options(error)
    }
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Prepare(error) => error.fmt(f),
            Self::Options(error) => error.fmt(f),
            Self::Memory => f.write_str("there is not enough memory for a picture of this size"),
            Self::Lines(most) => {
                write!(f, "there would be more than {most} lines; take a larger distance between them")
            }
            Self::Cancelled => f.write_str("the rendering was cancelled"),
        }
    }
}

impl std::error::Error for RenderError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Prepare(error) => Some(error),
            Self::Options(error) => Some(error),
            Self::Memory | Self::Lines(_) | Self::Cancelled => None,
        }
    }
}
