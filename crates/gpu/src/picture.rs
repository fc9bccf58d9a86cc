//! A whole picture from a kernel: tiles within a time budget, samples added up, progress, cancellation.

use crate::device::GpuError;
use crate::kernel::{Entry, Kernel, MOST_TILE_PIXELS};
use crate::tiler::Tiler;
use freikugel_render::{Progress, Rect};
use std::time::{Duration, Instant};

/// Why no picture was made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Stopped {
    /// The graphics processor failed.
    Failed(GpuError),
    /// [`Progress::is_cancelled`] asked for it.
    Cancelled,
}

/// The mean over the samples of each pixel of a region, row by row. `view` gives the bytes of the shader's view of a tile,
/// in coordinates of the frame, for a sample.
pub(crate) fn mean<V: AsRef<[u8]>>(
    kernel: &Kernel,
    region: Rect,
    samples: u32,
    budget: Duration,
    view: impl Fn(Rect, u32) -> V,
    progress: &dyn Progress,
) -> Result<Vec<[f32; 4]>, Stopped> {
    let mut pixels = vec![[0.0; 4]; region.pixels() as usize];
    let mut done = 0;
    let mut tiler = Tiler::new(region, MOST_TILE_PIXELS, budget);
    let sums = kernel.sums(MOST_TILE_PIXELS.min(region.pixels())).map_err(Stopped::Failed)?;
    let weight = 1.0 / samples as f32;
    while let Some(tile) = tiler.next() {
        let place = Rect { x: 0, y: 0, ..tile };
        // Samples are sent together as long as they stay within the budget, so that there is time to react between them.
        let (mut start, mut waited, mut pace) = (Instant::now(), 0, Duration::ZERO);
        for sample in 0..samples {
            let submission =
                kernel.add_sample(Entry::Render, view(tile, sample).as_ref(), place, tile.width, sample == 0, &sums);
            let submission = submission.map_err(Stopped::Failed)?;
            let pending = sample + 1 - waited;
            let is_last = sample + 1 == samples;
            if sample > 0 && !is_last && pace * (pending + 1) < budget {
                continue;
            }
            kernel.gpu().wait(submission).map_err(Stopped::Failed)?;
            pace = start.elapsed() / pending;
            if sample == 0 {
                tiler.took(tile, pace);
            }
            (start, waited) = (Instant::now(), sample + 1);
            if progress.is_cancelled() {
                return Err(Stopped::Cancelled);
            }
        }
        let found = kernel.read(&sums, tile.pixels()).map_err(Stopped::Failed)?;
        for (row, from) in found.chunks_exact(tile.width as usize).enumerate() {
            let row = (tile.y - region.y) as usize + row;
            let start = row * region.width as usize + (tile.x - region.x) as usize;
            for (pixel, sum) in pixels[start..].iter_mut().zip(from) {
                *pixel = sum.map(|channel| channel * weight);
            }
        }
        done += tile.pixels();
        progress.advanced(done, region.pixels());
    }
    Ok(pixels)
}
