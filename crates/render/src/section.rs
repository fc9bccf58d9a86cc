//! Plane sections of a field: where it is negative, and its values.
//!
//! The plane is cut into tiles, and these into smaller ones. Ranges of the field over all parts of a tile are computed at
//! once, in lanes; a part of which the sign is known is filled, and the others go on with what is left of the program there
//! (Keeter, "Massively parallel rendering of complex closed-form implicit surfaces", 2020). The smallest tiles are evaluated
//! at their points in one batch. Wherever the field has a value, the result is the same as that of the whole program at
//! each point, bit by bit; a point where a formula has no value may count as either side.

use crate::image::Image;
use crate::options::{Options, Rect};
use crate::run::{Progress, RenderError, Rendered};
use crate::stats::Stats;
use freikugel_field::simd::{self, Level};
use freikugel_field::{Evaluator, Occupancy, Part, Points, Program, Splitter, Wanted};
use glam::DVec3;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// The side of the tiles that threads take in turn, in points. The whole program is surveyed over all of them at once.
const TILE: u32 = 256;

/// Into how many parts a tile is split along each side: two vectors of the widest lanes.
const SPLIT: u32 = 4;

/// The side of the tiles that are evaluated at their points, which are one batch.
const LEAF: u32 = 16;

/// A rectangle (or parallelogram) in space, looked at through a grid of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// The corner that belongs to the upper left of a picture, in the coordinates of the world.
    pub origin: DVec3,
    /// The edge from there to the upper right.
    pub u: DVec3,
    /// The edge from there to the lower left.
    pub v: DVec3,
}

impl Section {
    /// A rectangle of this width (along x) and height (along y) around `middle`, seen from above, that is, against z.
    pub fn from_above(middle: DVec3, width: f64, height: f64) -> Self {
        let (u, v) = (DVec3::X * width, DVec3::NEG_Y * height);
        Self { origin: middle - (u + v) / 2.0, u, v }
    }

    /// The point in the middle of a cell when the section is divided into `columns` times `rows` cells.
    pub fn point(&self, [columns, rows]: [u32; 2], [column, row]: [u32; 2]) -> DVec3 {
        let along = |index: u32, count: u32| (f64::from(index) + 0.5) / f64::from(count);
        self.origin + self.u * along(column, columns) + self.v * along(row, rows)
    }

    /// Whether the field is negative, in the middle of each pixel, row by row. Samples and tiles of the options count for
    /// nothing here.
    ///
    /// # Errors
    /// If the options can't be followed, or it was given up.
    pub fn mask(
        &self,
        program: &Program,
        options: &Options,
        progress: &dyn Progress,
    ) -> Result<Vec<bool>, RenderError> {
        let region = options.region()?;
        let grid = Grid::new(self, program, [options.width, options.height]);
        let mut mask = filled(region, false)?;
        let threads = Threads { options, progress };
        grid.in_tiles(region, threads, 1, Wanted::Surface, &mut mask, |piece, out| match piece {
            Piece::Filled(rect, is_inside) => out.rows(rect).for_each(|row| row.fill(is_inside)),
            Piece::Values(rect, values) => {
                for (row, values) in out.rows(rect).zip(values.chunks(rect.width as usize)) {
                    row.iter_mut().zip(values).for_each(|(out, value)| *out = *value < 0.0);
                }
            }
        })?;
        Ok(mask)
    }

    /// The field in the middle of each pixel, row by row. Samples and tiles of the options count for nothing here.
    ///
    /// # Errors
    /// If the options can't be followed, or it was given up.
    pub fn values(
        &self,
        program: &Program,
        options: &Options,
        progress: &dyn Progress,
    ) -> Result<Vec<f32>, RenderError> {
        let region = options.region()?;
        let grid = Grid::new(self, program, [options.width, options.height]);
        let mut all = filled(region, 0.0)?;
        let threads = Threads { options, progress };
        grid.in_tiles(region, threads, 1, Wanted::Values, &mut all, |piece, out| {
            let Piece::Values(rect, values) = piece else { unreachable!("values are wanted everywhere") };
            for (row, values) in out.rows(rect).zip(values.chunks(rect.width as usize)) {
                row.copy_from_slice(values);
            }
        })?;
        Ok(all)
    }

    /// A picture of the section: two colours, and their mixtures along the border. Each pixel is divided into squares, as
    /// many as the options have samples, rounded up to a square number.
    ///
    /// # Errors
    /// If the options can't be followed, or it was given up.
    pub fn picture(
        &self,
        program: &Program,
        options: &Options,
        colors: [[f32; 3]; 2],
        progress: &dyn Progress,
    ) -> Result<Rendered, RenderError> {
        let start = Instant::now();
        let region = options.region()?;
        let fine = squares_along(options.samples);
        let grid = Grid::new(self, program, [options.width * fine, options.height * fine]);
        let mut inside = filled(region, 0_u32)?;
        let threads = Threads { options, progress };
        let mut stats =
            grid.in_tiles(region, threads, fine, Wanted::Surface, &mut inside, |piece, out| match piece {
                Piece::Filled(_, false) => {}
                Piece::Filled(rect, true) if fine == 1 => out.rows(rect).for_each(|row| row.fill(1)),
                Piece::Filled(rect, true) => each(rect, |x, y, _| *out.at(x / fine, y / fine) += 1),
                Piece::Values(rect, values) => {
                    each(rect, |x, y, index| *out.at(x / fine, y / fine) += u32::from(values[index] < 0.0));
                }
            })?;
        let share = 1.0 / (fine * fine) as f32;
        let [dark, light] = colors;
        let mixed = |count: u32| -> [f32; 3] {
            let share = count as f32 * share;
            std::array::from_fn(|channel| share * dark[channel] + (1.0 - share) * light[channel])
        };
        let image = Image::new(region.width, region.height, inside.into_iter().map(mixed).collect());
        stats.times.wall = start.elapsed();
        Ok(Rendered { image, stats })
    }
}

/// Into how many squares a pixel is divided along each side, so that there are as many as samples, rounded up to a square number.
pub(crate) fn squares_along(samples: u32) -> u32 {
    let side = samples.isqrt();
    side + u32::from(side * side < samples)
}

/// Calls `visit` with the column, row and index of each place in a rectangle.
fn each(rect: Rect, mut visit: impl FnMut(u32, u32, usize)) {
    let mut index = 0;
    for y in rect.y..rect.y + rect.height {
        for x in rect.x..rect.x + rect.width {
            visit(x, y, index);
            index += 1;
        }
    }
}

fn filled<T: Clone>(region: Rect, value: T) -> Result<Vec<T>, RenderError> {
    let count = usize::try_from(region.pixels()).map_err(|_| RenderError::Memory)?;
    let mut pixels = Vec::new();
    pixels.try_reserve_exact(count).map_err(|_| RenderError::Memory)?;
    pixels.resize(count, value);
    Ok(pixels)
}

/// What is known about some points of the grid.
enum Piece<'a> {
    /// All of them are inside, or all of them are not.
    Filled(Rect, bool),
    /// The field at each of them, row by row.
    Values(Rect, &'a [f32]),
}

/// The pixels of one tile.
struct Pixels<T> {
    rect: Rect,
    pixels: Vec<T>,
}

impl<T> Pixels<T> {
    fn at(&mut self, x: u32, y: u32) -> &mut T {
        &mut self.pixels[((y - self.rect.y) * self.rect.width + x - self.rect.x) as usize]
    }

    /// The rows of a rectangle in it.
    fn rows(&mut self, rect: Rect) -> impl Iterator<Item = &mut [T]> {
        let first = (rect.x - self.rect.x) as usize;
        self.pixels
            .chunks_exact_mut(self.rect.width as usize)
            .skip((rect.y - self.rect.y) as usize)
            .take(rect.height as usize)
            .map(move |row| &mut row[first..first + rect.width as usize])
    }
}

/// Who works, and who listens.
#[derive(Clone, Copy)]
struct Threads<'a> {
    options: &'a Options,
    progress: &'a dyn Progress,
}

/// The points of a section, relative to a program's origin.
struct Grid<'p> {
    program: &'p Program,
    size: [u32; 2],
    origin: DVec3,
    /// From one point to the next, along and across.
    steps: [DVec3; 2],
    section: Section,
}

impl<'p> Grid<'p> {
    fn new(section: &Section, program: &'p Program, size: [u32; 2]) -> Self {
        let steps = [section.u / f64::from(size[0]), section.v / f64::from(size[1])];
        Self { program, size, origin: program.origin(), steps, section: *section }
    }

    /// The box around the points of a tile with its upper left corner at (0, 0), from its middle outward.
    fn half(&self, side: u32) -> [f32; 3] {
        let reach = (self.steps[0].abs() + self.steps[1].abs()) * (f64::from(side - 1) / 2.0);
        reach.to_array().map(|half| (half as f32).next_up())
    }

    /// The middles of some tiles, coordinate by coordinate.
    fn middles(&self, corners: &[[u32; 2]], side: u32) -> [Vec<f32>; 3] {
        let mut middles: [Vec<f32>; 3] = Default::default();
        for corner in corners {
            // Whole numbers of steps and half steps: the middle between the first and the last point.
            let [x, y] = corner.map(|first| f64::from(first) + f64::from(side) / 2.0);
            let middle = self.section.origin - self.origin + self.steps[0] * x + self.steps[1] * y;
            for (middles, coordinate) in middles.iter_mut().zip(middle.to_array()) {
                middles.push(coordinate as f32);
            }
        }
        middles
    }

    /// Has all threads look at the tiles of a region until `pixels` is full. The grid has `fine` points along each side of
    /// a pixel; `sink` hears what is known about them.
    fn in_tiles<T: Copy + Default + Send>(
        &self,
        region: Rect,
        Threads { options, progress }: Threads<'_>,
        fine: u32,
        wanted: Wanted,
        pixels: &mut [T],
        sink: impl Fn(Piece<'_>, &mut Pixels<T>) + Sync,
    ) -> Result<Stats, RenderError> {
        struct Shared<'p, T> {
            pixels: &'p mut [T],
            done: u64,
            stats: Stats,
        }
        let start = Instant::now();
        let level = options.level.unwrap_or_else(simd::best);
        // Tiles hold whole pixels, so that no two threads count for the same one.
        let in_pixels = (TILE / fine).max(1);
        let side = in_pixels * fine;
        let tiles = region.tiles(in_pixels);
        let parts = self.survey(&tiles, side, fine, level, wanted);
        let threads = options.threads_for(tiles.len());
        let next = AtomicUsize::new(0);
        let shared = Mutex::new(Shared { pixels, done: 0, stats: Stats::default() });
        let work = || {
            let start = Instant::now();
            let mut worker = Worker::new(self, level, wanted);
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(&rect) = tiles.get(index) else { break };
                if progress.is_cancelled() {
                    break;
                }
                let mut out = Pixels { rect, pixels: vec![T::default(); rect.pixels() as usize] };
                let points = scaled(rect, fine);
                let corner = [rect.x / in_pixels * side, rect.y / in_pixels * side];
                worker.tile(points, corner, side, &parts[index], &mut |piece| sink(piece, &mut out));
                let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
                for (row, from) in out.pixels.chunks_exact(rect.width as usize).enumerate() {
                    let row = (rect.y - region.y) as usize + row;
                    let start = row * region.width as usize + (rect.x - region.x) as usize;
                    shared.pixels[start..start + from.len()].copy_from_slice(from);
                }
                shared.done += rect.pixels();
                progress.advanced(shared.done, region.pixels());
            }
            let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
            shared.stats.evaluations += worker.evaluations;
            shared.stats.times.work += start.elapsed();
        };
        std::thread::scope(|scope| {
            for _ in 1..threads {
                scope.spawn(work);
            }
            work();
        });
        let Shared { done, mut stats, .. } = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
        if done < region.pixels() {
            return Err(RenderError::Cancelled);
        }
        stats.times.threads = threads as u64;
        stats.times.wall = start.elapsed();
        Ok(stats)
    }

    /// What is known about each of the largest tiles.
    fn survey(&self, tiles: &[Rect], side: u32, fine: u32, level: Level, wanted: Wanted) -> Vec<Known> {
        let corners: Vec<[u32; 2]> =
            tiles.iter().map(|tile| [tile.x * fine / side * side, tile.y * fine / side * side]).collect();
        let mut splitter = Splitter::new(level);
        let mut known = Vec::with_capacity(tiles.len());
        for corners in corners.chunks(freikugel_field::kernel::BATCH) {
            self.judge(&mut splitter, self.program.whole(), corners, side, wanted, &mut known);
        }
        known
    }

    /// What is known about some tiles in which `part` holds.
    fn judge(
        &self,
        splitter: &mut Splitter,
        part: &Arc<Part>,
        corners: &[[u32; 2]],
        side: u32,
        wanted: Wanted,
        known: &mut Vec<Known>,
    ) {
        let [x, y, z] = &self.middles(corners, side);
        let mut surveyed = splitter.survey(self.program, part, [x, y, z], self.half(side));
        known.extend((0..corners.len()).map(|place| match (wanted, surveyed.occupancy(place)) {
            (Wanted::Surface, Occupancy::Inside) => Known::Filled(true),
            (Wanted::Surface, Occupancy::Outside(_)) => Known::Filled(false),
            _ => Known::Part(surveyed.part(place, wanted)),
        }));
    }
}

/// What is known about a tile.
enum Known {
    /// The sign of the field.
    Filled(bool),
    /// What is left of the program.
    Part(Arc<Part>),
}

fn scaled(rect: Rect, by: u32) -> Rect {
    Rect { x: rect.x * by, y: rect.y * by, width: rect.width * by, height: rect.height * by }
}

/// What lies in both, if anything does.
fn common(a: Rect, b: Rect) -> Option<Rect> {
    let span = |a: u32, a_size: u32, b: u32, b_size: u32| {
        let (first, end) = (a.max(b), (a + a_size).min(b + b_size));
        (first < end).then(|| (first, end - first))
    };
    let (x, width) = span(a.x, a.width, b.x, b.width)?;
    let (y, height) = span(a.y, a.height, b.y, b.height)?;
    Some(Rect { x, y, width, height })
}

/// What one thread works with.
struct Worker<'g> {
    grid: &'g Grid<'g>,
    wanted: Wanted,
    splitter: Splitter,
    evaluator: Evaluator<'g>,
    points: [Vec<f32>; 3],
    values: Vec<f32>,
    evaluations: u64,
}

impl<'g> Worker<'g> {
    fn new(grid: &'g Grid<'g>, level: Level, wanted: Wanted) -> Self {
        Self {
            grid,
            wanted,
            splitter: Splitter::new(level),
            evaluator: Evaluator::with_level(grid.program, level),
            points: Default::default(),
            values: Vec::new(),
            evaluations: 0,
        }
    }

    /// Finds out about the points of `rect`, which lies in the tile with this corner and side.
    fn tile(&mut self, rect: Rect, corner: [u32; 2], side: u32, known: &Known, sink: &mut dyn FnMut(Piece<'_>)) {
        let part = match known {
            &Known::Filled(is_inside) => return sink(Piece::Filled(rect, is_inside)),
            Known::Part(part) => part,
        };
        if side <= LEAF {
            return self.points(rect, part, sink);
        }
        let finer = side.div_ceil(SPLIT);
        let inside = |corner: [u32; 2]| common(rect, Rect { x: corner[0], y: corner[1], width: finer, height: finer });
        let corners: Vec<[u32; 2]> = (0..SPLIT * SPLIT)
            .map(|index| [corner[0] + index % SPLIT * finer, corner[1] + index / SPLIT * finer])
            .filter(|&corner| inside(corner).is_some())
            .collect();
        let mut known = Vec::with_capacity(corners.len());
        self.grid.judge(&mut self.splitter, part, &corners, finer, self.wanted, &mut known);
        for (&corner, known) in corners.iter().zip(&known) {
            if let Some(rect) = inside(corner) {
                self.tile(rect, corner, finer, known, sink);
            }
        }
    }

    /// Evaluates the points of `rect`.
    fn points(&mut self, rect: Rect, part: &Part, sink: &mut dyn FnMut(Piece<'_>)) {
        let Grid { section, size, origin, .. } = self.grid;
        let [x, y, z] = &mut self.points;
        for coordinates in [&mut *x, &mut *y, &mut *z] {
            coordinates.clear();
        }
        each(rect, |column, row, _| {
            let point = section.point(*size, [column, row]) - *origin;
            x.push(point.x as f32);
            y.push(point.y as f32);
            z.push(point.z as f32);
        });
        self.values.resize(x.len(), 0.0);
        self.evaluator.values_in(part, Points { x, y, z }, &mut self.values);
        self.evaluations += x.len() as u64;
        sink(Piece::Values(rect, &self.values));
    }
}
