//! What to draw next: coarse pictures while things move, ever finer ones while they are still.
//!
//! A change is answered at once by a picture of fewer pixels, as many as the pace of the last ones lets into a frame. If
//! nothing has changed since, tiles of the full size follow, sample after sample, each frame as many as fit. What is
//! coarse stays visible until finer tiles cover it. Nothing here knows devices or clocks.

use crate::tiler::Tiler;
use freikugel_render::Rect;
use std::time::Duration;

/// How long a frame should take while things move.
pub(crate) const MOVING_FRAME: Duration = Duration::from_millis(33);

/// How long one tile should take while things are still, so that input is answered soon.
pub(crate) const STILL_TILE: Duration = Duration::from_millis(12);

/// How many pixels of the window may become one in each direction, at most.
const COARSEST: u32 = 8;

/// Pictures become finer only if they would take no more than this part of a frame, lest the size flickers.
const ROOM: f64 = 0.7;

/// Something to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    /// The whole picture with one sample, in a smaller size.
    Coarse {
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
    },
    /// One sample of a tile in full size.
    Fine {
        /// The tile.
        tile: Rect,
        /// The sample, from 0.
        sample: u32,
    },
}

/// What the finer picture holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fine {
    /// Samples that all pixels have.
    pub(crate) samples: u32,
    /// The pixels that have one more: all above a row, and some columns of the rows below it. See [`Tiler::covered`].
    pub(crate) covered: [u32; 3],
}

/// What to draw next.
#[derive(Clone, Debug)]
pub(crate) struct Refinement {
    size: [u32; 2],
    samples: u32,
    /// Pixels of the window that are one in the coarse picture, in each direction.
    divisor: u32,
    is_coarse_due: bool,
    tiler: Tiler,
    sample: u32,
    most_tile: u64,
}

impl Refinement {
    /// For a window, with samples per pixel in the end, and tiles of no more than some pixels.
    pub(crate) fn new(size: [u32; 2], samples: u32, most_tile: u64) -> Self {
        let size = size.map(|side| side.max(1));
        Self {
            size,
            samples,
            divisor: COARSEST,
            is_coarse_due: true,
            tiler: tiler(size, most_tile),
            sample: 0,
            most_tile,
        }
    }

    /// Something that is seen has changed: all that was drawn is out of date.
    pub(crate) fn restart(&mut self) {
        self.is_coarse_due = true;
        self.tiler.restart();
        self.sample = 0;
    }

    /// The window has another size, or pixels get other numbers of samples.
    pub(crate) fn resize(&mut self, size: [u32; 2], samples: u32) {
        let divisor = self.divisor;
        *self = Self { divisor, ..Self::new(size, samples, self.most_tile) };
    }

    /// The scene is another one, whose pace is not known.
    pub(crate) fn forget_pace(&mut self) {
        *self = Self::new(self.size, self.samples, self.most_tile);
    }

    /// What comes next; nothing if the picture is finished.
    pub(crate) fn next(&mut self) -> Option<Work> {
        if self.is_coarse_due {
            self.is_coarse_due = false;
            let [width, height] = self.coarse_size();
            return Some(Work::Coarse { width, height });
        }
        if self.sample == self.samples {
            return None;
        }
        if let Some(tile) = self.tiler.next() {
            return Some(Work::Fine { tile, sample: self.sample });
        }
        self.sample += 1;
        self.tiler.restart();
        if self.sample == self.samples {
            return None;
        }
        self.tiler.next().map(|tile| Work::Fine { tile, sample: self.sample })
    }

    /// Learns that some work took some time.
    pub(crate) fn took(&mut self, work: Work, time: Duration) {
        match work {
            Work::Fine { tile, .. } => self.tiler.took(tile, time),
            Work::Coarse { width, height } => {
                let pace = time.as_secs_f64() / (f64::from(width) * f64::from(height));
                let frame = |divisor: u32| {
                    let [width, height] = self.size.map(|side| f64::from(side.div_ceil(divisor)));
                    pace * width * height
                };
                let budget = MOVING_FRAME.as_secs_f64();
                if frame(self.divisor) > budget {
                    while self.divisor < COARSEST && frame(self.divisor) > budget {
                        self.divisor += 1;
                    }
                } else {
                    while self.divisor > 1 && frame(self.divisor - 1) <= ROOM * budget {
                        self.divisor -= 1;
                    }
                }
            }
        }
    }

    /// Whether there is nothing left to draw.
    pub(crate) fn is_finished(&self) -> bool {
        !self.is_coarse_due && self.sample == self.samples
    }

    /// The size of coarse pictures.
    pub(crate) fn coarse_size(&self) -> [u32; 2] {
        self.size.map(|side| side.div_ceil(self.divisor))
    }

    /// What the finer picture holds.
    pub(crate) fn fine(&self) -> Fine {
        Fine { samples: self.sample, covered: self.tiler.covered() }
    }
}

fn tiler([width, height]: [u32; 2], most: u64) -> Tiler {
    Tiler::new(Rect { x: 0, y: 0, width, height }, most, STILL_TILE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [640, 360];

    /// Draws as long as there is something, at a pace in nanoseconds per pixel; how much was drawn of what.
    fn finish(refinement: &mut Refinement, nanoseconds: u64) -> (u32, u64) {
        let (mut coarse, mut pixels) = (0, 0);
        while let Some(work) = refinement.next() {
            let drawn = match work {
                Work::Coarse { width, height } => {
                    coarse += 1;
                    u64::from(width) * u64::from(height)
                }
                Work::Fine { tile, .. } => {
                    pixels += tile.pixels();
                    tile.pixels()
                }
            };
            refinement.took(work, Duration::from_nanos(nanoseconds * drawn));
        }
        (coarse, pixels)
    }

    #[test]
    fn a_still_picture_gets_all_samples_and_then_rests() {
        let mut refinement = Refinement::new(SIZE, 3, 1 << 20);
        assert_eq!(finish(&mut refinement, 100), (1, 3 * 640 * 360));
        assert!(refinement.is_finished());
        assert_eq!(refinement.next(), None);
        assert_eq!(refinement.fine(), Fine { samples: 3, covered: [0, 0, 0] });
        refinement.restart();
        assert!(!refinement.is_finished());
        assert_eq!(finish(&mut refinement, 100), (1, 3 * 640 * 360));
    }

    #[test]
    fn moving_pictures_are_as_fine_as_the_pace_allows() {
        for nanoseconds in [10, 100, 300, 1000, 3000, 10_000, 100_000] {
            let mut refinement = Refinement::new(SIZE, 16, 1 << 20);
            for _ in 0..10 {
                refinement.restart();
                let Some(work @ Work::Coarse { width, height }) = refinement.next() else {
                    panic!("a coarse picture is first");
                };
                refinement.took(work, Duration::from_nanos(nanoseconds * u64::from(width * height)));
            }
            let frame = |divisor: u32| {
                let pixels = SIZE[0].div_ceil(divisor) * SIZE[1].div_ceil(divisor);
                Duration::from_nanos(nanoseconds * u64::from(pixels))
            };
            let divisor = refinement.divisor;
            assert!(divisor == COARSEST || frame(divisor) <= MOVING_FRAME, "{nanoseconds} ns: {divisor}");
            assert!(divisor == 1 || frame(divisor - 1) > MOVING_FRAME.mul_f64(ROOM), "{nanoseconds} ns: {divisor}");
        }
    }

    #[test]
    fn a_steady_pace_keeps_a_steady_size() {
        for nanoseconds in (50..5000).step_by(50) {
            let mut refinement = Refinement::new(SIZE, 16, 1 << 20);
            let mut sizes = Vec::new();
            for _ in 0..20 {
                refinement.restart();
                let Some(work @ Work::Coarse { width, height }) = refinement.next() else {
                    panic!("a coarse picture is first");
                };
                refinement.took(work, Duration::from_nanos(nanoseconds * u64::from(width * height)));
                sizes.push([width, height]);
            }
            assert!(sizes[5..].windows(2).all(|pair| pair[0] == pair[1]), "{nanoseconds}: {sizes:?}");
        }
    }

    #[test]
    fn a_resized_window_starts_anew() {
        let mut refinement = Refinement::new(SIZE, 2, 1 << 20);
        finish(&mut refinement, 10);
        refinement.resize([100, 50], 4);
        assert_eq!(finish(&mut refinement, 10), (1, 4 * 100 * 50));
        refinement.resize([0, 0], 1);
        assert_eq!(finish(&mut refinement, 10), (1, 1));
    }
}
