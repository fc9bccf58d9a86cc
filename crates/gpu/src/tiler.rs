//! How a picture is cut so that no piece of work runs long.
//!
//! Systems reset a graphics processor that does not answer for about 2 s, and a window can't react while one dispatch
//! runs. How fast a scene is to draw is not known beforehand and differs over the picture, so the first tile is small,
//! and each following one gets as many pixels as would fit a time budget at the pace of those before. Tiles lie in
//! bands: within one, heights are the same; where the budget holds more than a row of tiles, a tile is a whole band.

use freikugel_render::Rect;
use std::time::Duration;

/// The time that one dispatch should take: a twentieth of what systems tolerate, and far above the overhead of one.
pub const BUDGET: Duration = Duration::from_millis(100);

/// Sides of tiles are multiples of this, the side of a workgroup.
const GRAIN: u32 = 8;

/// Pixels of the first tile, 64 x 64: a second at the pace of 4000 pixels per second, slower than any scene known.
const FIRST: u64 = 64 * 64;

/// Pixels of the smallest tiles that are aimed at, 32 x 32. Below, the time is that of sending and waiting, not of drawing.
const LEAST: u64 = 32 * 32;

/// How many times larger or smaller than the one before a tile may be aimed at. An easy tile, all sky, tells little about the
/// next, and a machine that is busy with something else for a moment tells nothing.
const GROWTH: u64 = 4;

/// Cuts a region into tiles.
#[derive(Clone, Debug)]
pub struct Tiler {
    region: Rect,
    /// Where the next tile starts, relative to the region.
    x: u32,
    y: u32,
    /// The height of the band that is being cut; 0 between bands.
    band: u32,
    /// Pixels that the next tile should have.
    goal: u64,
    /// Pixels that no tile may exceed.
    most: u64,
    budget: Duration,
}

impl Tiler {
    /// Starts at the upper left corner. No tile has more than `most` pixels, of which there must be at least 64.
    pub fn new(region: Rect, most: u64, budget: Duration) -> Self {
        assert!(most >= u64::from(GRAIN * GRAIN), "{most} pixels hold no workgroup");
        Self { region, x: 0, y: 0, band: 0, goal: FIRST.min(most), most, budget }
    }

    /// Starts again at the upper left corner, with what is known of the pace.
    pub fn restart(&mut self) {
        (self.x, self.y, self.band) = (0, 0, 0);
    }

    /// What the tiles so far cover: all rows above the first number, and in as many rows below it as the second says, as
    /// many columns as the third.
    pub fn covered(&self) -> [u32; 3] {
        [self.y, self.band, self.x]
    }

    /// Learns that a tile's dispatch took some time.
    pub fn took(&mut self, tile: Rect, time: Duration) {
        let fits = tile.pixels() as f64 * self.budget.as_secs_f64() / time.as_secs_f64().max(1e-9);
        // The last tiles of rows and bands are smaller than their goal, which must not hold those after them back.
        let from = self.goal.max(tile.pixels());
        self.goal = (fits as u64).clamp(self.goal / GROWTH, from * GROWTH).clamp(LEAST.min(self.most), self.most);
    }
}

/// The tiles, in frame coordinates, from the top.
impl Iterator for Tiler {
    type Item = Rect;

    fn next(&mut self) -> Option<Rect> {
        let Rect { width, height, .. } = self.region;
        if self.y >= height {
            return None;
        }
        if self.band == 0 {
            let rows = self.goal / u64::from(width);
            let side = if rows >= u64::from(GRAIN) { rows } else { self.goal.isqrt() };
            self.band = grains(side).min(height - self.y);
        }
        let columns = grains(self.goal / u64::from(self.band));
        let tile = Rect {
            x: self.region.x + self.x,
            y: self.region.y + self.y,
            width: columns.min(width - self.x),
            height: self.band,
        };
        self.x += tile.width;
        if self.x == width {
            (self.x, self.y, self.band) = (0, self.y + self.band, 0);
        }
        Some(tile)
    }
}

/// Rounds down to a multiple of the grain, one at least.
fn grains(side: u64) -> u32 {
    let grains = (side / u64::from(GRAIN)).clamp(1, u64::from(u32::MAX / GRAIN));
    grains as u32 * GRAIN
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// All tiles of a region where each pixel takes as long as `pace` says.
    fn tiles(region: Rect, most: u64, pace: impl Fn(Rect) -> Duration) -> Vec<Rect> {
        let mut tiler = Tiler::new(region, most, BUDGET);
        let mut tiles = Vec::new();
        while let Some(tile) = tiler.next() {
            tiler.took(tile, pace(tile) * tile.pixels() as u32);
            tiles.push(tile);
        }
        tiles
    }

    proptest! {
        #[test]
        fn each_pixel_is_in_one_tile(
            x in 0u32..100, y in 0u32..100, width in 1u32..300, height in 1u32..300, most in 64u64..100_000,
            paces in prop::collection::vec(1u64..1_000_000, 7),
        ) {
            let region = Rect { x, y, width, height };
            let pace = |tile: Rect| Duration::from_nanos(paces[(tile.x + 3 * tile.y) as usize % paces.len()]);
            let mut covered = vec![0; region.pixels() as usize];
            for tile in tiles(region, most, pace) {
                prop_assert!(tile.pixels() <= most, "{tile:?}");
                for row in tile.y..tile.y + tile.height {
                    for column in tile.x..tile.x + tile.width {
                        prop_assert!(column >= x && column < x + width && row >= y && row < y + height, "{tile:?}");
                        covered[((row - y) * width + column - x) as usize] += 1;
                    }
                }
            }
            prop_assert!(covered.iter().all(|&times| times == 1));
        }
    }

    #[test]
    fn tiles_take_the_budget_once_the_pace_is_known() {
        let region = Rect { x: 0, y: 0, width: 1920, height: 1080 };
        for nanoseconds in [100, 1_000, 10_000, 100_000] {
            let pace = Duration::from_nanos(nanoseconds);
            let tiles = tiles(region, 1 << 22, |_| pace);
            let longest = tiles.iter().map(|tile| pace * tile.pixels() as u32).max().expect("tiles");
            let first = pace * FIRST as u32;
            assert!(longest <= BUDGET.max(first), "{nanoseconds}: {longest:?}");
            // No more tiles than four times what an oracle would need, and those that the pace is learned with.
            let fewest = (pace.as_secs_f64() * region.pixels() as f64 / BUDGET.as_secs_f64()).ceil();
            assert!((tiles.len() as f64) < 4.0 * fewest + 12.0, "{nanoseconds}: {} of {fewest}", tiles.len());
        }
    }

    #[test]
    fn a_busy_moment_does_not_shrink_tiles_for_long() {
        let region = Rect { x: 0, y: 0, width: 1024, height: 1024 };
        let mut tiler = Tiler::new(region, 1 << 20, BUDGET);
        let mut goals = Vec::new();
        for index in 0..14 {
            let tile = tiler.next().expect("a tile");
            let pause = if index == 8 { Duration::from_secs(5) } else { Duration::ZERO };
            tiler.took(tile, Duration::from_micros(2) * tile.pixels() as u32 + pause);
            goals.push(tiler.goal);
        }
        assert_eq!(goals[8], goals[7] / GROWTH);
        assert!(goals[10] >= goals[7] * 9 / 10, "{goals:?}");
    }

    #[test]
    fn what_is_covered_is_known() {
        let region = Rect { x: 3, y: 4, width: 100, height: 70 };
        let mut tiler = Tiler::new(region, 1000, BUDGET);
        let mut counted = 0;
        while let Some(tile) = tiler.next() {
            counted += tile.pixels();
            let [rows, band, columns] = tiler.covered().map(u64::from);
            assert_eq!(rows * 100 + band * columns, counted);
        }
        assert_eq!(tiler.covered(), [70, 0, 0]);
        tiler.restart();
        assert_eq!(tiler.covered(), [0, 0, 0]);
        assert_eq!(tiler.map(Rect::pixels).sum::<u64>(), region.pixels());
    }

    #[test]
    fn an_easy_sky_does_not_lead_to_a_long_dispatch() {
        let region = Rect { x: 0, y: 0, width: 640, height: 640 };
        let pace = |tile: Rect| Duration::from_nanos(if tile.y < 320 { 10 } else { 20_000 });
        let mut tiler = Tiler::new(region, 1 << 14, BUDGET);
        let mut slow = Vec::new();
        while let Some(tile) = tiler.next() {
            let time = pace(tile) * tile.pixels() as u32;
            tiler.took(tile, time);
            slow.extend((tile.y >= 320).then_some(time));
        }
        let after_the_first = slow[1..].iter().max().expect("tiles");
        // The first one is bounded by the size of tiles alone, those after it by what it took, up to the rest of its band.
        assert!(slow[0] < Duration::from_millis(400) && *after_the_first <= slow[0], "{slow:?}");
    }
}
