//! What to compute: the size of the picture, the part of it, the samples, and how much of the machine to use.
//!
//! How much of the machine never changes a byte of the result: tiles are anchored to the full frame, pixels are
//! independent of each other, and all instruction sets compute the same bits.

use freikugel_field::simd::Level;
use freikugel_scene::{Camera, Scene};
use std::fmt;

/// The longest side of a picture in pixels; beyond 2^24, single precision could not tell pixels apart.
pub const MAX_SIDE: u32 = 1 << 20;

/// The most pixels computed in one go: 1.5 GiB of linear colours.
pub const MAX_PIXELS: u64 = 1 << 27;

/// The most rays per pixel. Their noise is far below a step of 8 bits by then.
pub const MAX_SAMPLES: u32 = 1 << 16;

/// The largest side of a tile in pixels.
pub const MAX_TILE: u32 = 1 << 10;

/// The most threads started.
const MAX_THREADS: usize = 1024;

/// What to compute, and with what.
#[derive(Clone, Debug)]
pub struct Options {
    /// Width of the full frame in pixels.
    pub width: u32,
    /// Height of the full frame in pixels.
    pub height: u32,
    /// Rays per pixel. One goes through the pixel's centre; more are spread by the reconstruction
    /// filter.
    pub samples: u32,
    /// The part of the frame to compute; all of it if not given.
    pub crop: Option<Rect>,
    /// Threads to compute with; as many as the machine has cores if not given.
    pub threads: Option<usize>,
    /// The instruction set to evaluate fields with; the best one if not given.
    pub level: Option<Level>,
    /// The side of the square tiles that threads take in turn, in pixels.
    pub tile: u32,
    /// From where; as the scene says if not given.
    pub camera: Option<Camera>,
}

/// A part of a frame, in pixels. Row 0 is on top.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Rect {
    /// The first column.
    pub x: u32,
    /// The first row.
    pub y: u32,
    /// How many columns.
    pub width: u32,
    /// How many rows.
    pub height: u32,
}

/// Why nothing can be computed with some [`Options`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OptionsError {
    /// A side of the frame is 0 or above [`MAX_SIDE`].
    Size {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
    /// More than [`MAX_PIXELS`] would be computed.
    Pixels(u64),
    /// The samples are 0 or above [`MAX_SAMPLES`].
    Samples(u32),
    /// The crop is empty or reaches over the frame's edge.
    Crop(Rect),
    /// There are to be 0 threads, or more than a thousand.
    Threads(usize),
    /// The tile's side is 0 or above [`MAX_TILE`].
    Tile(u32),
}

impl Default for Options {
    fn default() -> Self {
        Self { width: 640, height: 360, samples: 16, crop: None, threads: None, level: None, tile: 32, camera: None }
    }
}

impl Options {
    /// The options a scene asks for.
    pub fn of(scene: &Scene) -> Self {
        let picture = &scene.picture;
        Self { width: picture.width, height: picture.height, samples: picture.samples, ..Self::default() }
    }

    /// The part of the frame that will be computed.
    ///
    /// # Errors
    /// The first option that can't be followed.
    pub fn region(&self) -> Result<Rect, OptionsError> {
        let (width, height) = (self.width, self.height);
        if width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE {
            return Err(OptionsError::Size { width, height });
        }
        if self.samples == 0 || self.samples > MAX_SAMPLES {
            return Err(OptionsError::Samples(self.samples));
        }
        if self.tile == 0 || self.tile > MAX_TILE {
            return Err(OptionsError::Tile(self.tile));
        }
        if let Some(threads) = self.threads.filter(|&threads| threads == 0 || threads > MAX_THREADS) {
            return Err(OptionsError::Threads(threads));
        }
        let region = self.crop.unwrap_or(Rect { x: 0, y: 0, width, height });
        let fits =
            |start: u32, size: u32, full: u32| size > 0 && start.checked_add(size).is_some_and(|end| end <= full);
        if !fits(region.x, region.width, width) || !fits(region.y, region.height, height) {
            return Err(OptionsError::Crop(region));
        }
        match region.pixels() {
            pixels if pixels > MAX_PIXELS => Err(OptionsError::Pixels(pixels)),
            _ => Ok(region),
        }
    }

    /// How many threads will be started for `tiles` tiles.
    pub(crate) fn threads_for(&self, tiles: usize) -> usize {
        let wanted = self.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, Into::into));
        wanted.min(tiles).clamp(1, MAX_THREADS)
    }
}

impl Rect {
    /// How many pixels it holds.
    pub fn pixels(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Its parts in the cells of a grid of squares anchored to the frame's corner, row by row.
    pub(crate) fn tiles(self, side: u32) -> Vec<Rect> {
        // Rounding down to a multiple of the side finds the cell that holds a coordinate.
        let cells = |start: u32, size: u32| {
            let end = start + size;
            (start / side * side..end).step_by(side as usize).map(move |cell| {
                let first = cell.max(start);
                (first, cell.saturating_add(side).min(end) - first)
            })
        };
        cells(self.y, self.height)
            .flat_map(|(y, height)| cells(self.x, self.width).map(move |(x, width)| Rect { x, y, width, height }))
            .collect()
    }
}

impl fmt::Display for OptionsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Size { width, height } => {
                write!(f, "a picture of {width} x {height} pixels: each side must be 1 to {MAX_SIDE}")
            }
            Self::Pixels(pixels) => {
                write!(f, "{pixels} pixels are more than the {MAX_PIXELS} that are computed at once")
            }
            Self::Samples(samples) => {
                write!(f, "{samples} samples per pixel: there must be 1 to {MAX_SAMPLES}")
            }
            Self::Crop(Rect { x, y, width, height }) => {
                write!(f, "the crop of {width} x {height} pixels at ({x}, {y}) is empty or leaves the frame")
            }
            Self::Threads(threads) => write!(f, "{threads} threads: there must be 1 to {MAX_THREADS}"),
            Self::Tile(tile) => write!(f, "tiles of {tile} pixels: their side must be 1 to {MAX_TILE}"),
        }
    }
}

impl std::error::Error for OptionsError {}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn tiles_cover_each_pixel_once_and_keep_to_the_grid(
            x in 0u32..100, y in 0u32..100, width in 1u32..90, height in 1u32..90, side in 1u32..40,
        ) {
            let rect = Rect { x, y, width, height };
            let tiles = rect.tiles(side);
            prop_assert_eq!(tiles.iter().map(|tile| tile.pixels()).sum::<u64>(), rect.pixels());
            for (index, tile) in tiles.iter().enumerate() {
                prop_assert_eq!(tile.x / side, (tile.x + tile.width - 1) / side);
                prop_assert_eq!(tile.y / side, (tile.y + tile.height - 1) / side);
                prop_assert!(tile.x >= x && tile.x + tile.width <= x + width);
                prop_assert!(tile.y >= y && tile.y + tile.height <= y + height);
                for other in &tiles[..index] {
                    let apart = other.x + other.width <= tile.x || tile.x + tile.width <= other.x
                        || other.y + other.height <= tile.y || tile.y + tile.height <= other.y;
                    prop_assert!(apart);
                }
            }
        }
    }

    #[test]
    fn impossible_options_are_refused() {
        let good = Options { width: 20, height: 10, ..Options::default() };
        assert_eq!(good.region(), Ok(Rect { x: 0, y: 0, width: 20, height: 10 }));
        let rect = Rect { x: 15, y: 0, width: 6, height: 10 };
        let wraps = Rect { x: u32::MAX, y: 0, width: 6, height: 10 };
        for (bad, error) in [
            (Options { width: 0, ..good.clone() }, OptionsError::Size { width: 0, height: 10 }),
            (Options { samples: 0, ..good.clone() }, OptionsError::Samples(0)),
            (Options { tile: 0, ..good.clone() }, OptionsError::Tile(0)),
            (Options { threads: Some(0), ..good.clone() }, OptionsError::Threads(0)),
            (Options { crop: Some(rect), ..good.clone() }, OptionsError::Crop(rect)),
            (Options { crop: Some(wraps), ..good.clone() }, OptionsError::Crop(wraps)),
            (Options { width: 1 << 17, height: 1 << 17, ..good.clone() }, OptionsError::Pixels(1 << 34)),
        ] {
            assert_eq!(bad.region(), Err(error), "{error}");
        }
    }
}
