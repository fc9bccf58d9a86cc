//! Pictures of the values of a field in a plane: where it is negative, lines at equal distances, and how good its values are as
//! distances.

use crate::image::Image;
use crate::isolines::{Isoline, isolines};
use crate::options::Options;
use crate::run::{Progress, RenderError, Rendered};
use crate::section::{Section, squares_along};
use crate::stats::Stats;
use freikugel_field::{Evaluator, Points, Program};
use glam::DVec3;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// What the colours of a slice stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    /// The values: blue inside and orange outside, the stronger the farther from the surface.
    Distance,
    /// The length of the gradient, which is 1 where values are distances: white; blue where they grow too slowly, and red where too
    /// fast; the colours are full at half and at twice the length.
    Slope,
    /// How many steps of the field's value lead down its gradient to the surface: 1 where values are distances. From dark to
    /// light, up to [`MOST_STEPS`].
    Steps,
}

/// More steps are not counted.
pub const MOST_STEPS: u32 = 24;

/// A picture of a field in a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice {
    /// Where.
    pub section: Section,
    /// What the colours stand for.
    pub show: Show,
    /// Values at whole multiples of this have a line; none but the surface if it is 0.
    pub spacing: f64,
}

/// Widths of lines in pixels, of a picture of the usual size.
const SURFACE_WIDTH: f32 = 2.2;
const LINE_WIDTH: f32 = 1.0;

/// How much of a line's colour its middle has.
const LINE_STRENGTH: f32 = 0.45;

/// Colours in linear light.
const INK: [f32; 3] = [0.01, 0.01, 0.015];
const PAPER: [f32; 3] = [0.93, 0.92, 0.90];
const INSIDE: [f32; 3] = [0.07, 0.27, 0.60];
const OUTSIDE: [f32; 3] = [0.80, 0.36, 0.08];
const TOO_FAST: [f32; 3] = [0.65, 0.02, 0.03];
const NOTHING: [f32; 3] = [0.30, 0.30, 0.30];

/// The share of the section's size at which the colours of distances are two thirds of their full strength.
const FADE: f64 = 0.2;

/// A point within this many pixels of the surface has come to it.
const AT_SURFACE: f64 = 0.02;

/// Rows that a thread takes at once.
const ROWS: u32 = 4;

impl Slice {
    /// The picture, or the part of it that the options ask for. Each pixel is divided into squares, as many as the options have
    /// samples, rounded up to a square number.
    ///
    /// # Errors
    /// If the options can't be followed, or it was given up.
    pub fn picture(
        &self,
        program: &Program,
        options: &Options,
        progress: &dyn Progress,
    ) -> Result<Rendered, RenderError> {
        let start = Instant::now();
        let region = options.region()?;
        let fine = squares_along(options.samples);
        let grid =
            Options { width: options.width * fine, height: options.height * fine, crop: None, ..options.clone() };
        let values = self.section.values(program, &grid, progress)?;
        let (colors, evaluations) = match self.show {
            Show::Distance => (None, 0),
            Show::Slope | Show::Steps => {
                let (colors, evaluations) = self.measured(program, &grid, progress)?;
                (Some(colors), evaluations)
            }
        };
        let size = [grid.width, grid.height];
        let painter = Painter { slice: self, values: &values, size, fine, step: self.step(&grid) };
        let share = 1.0 / (fine * fine) as f32;
        let mut pixels = vec![[0.0_f32; 3]; options.width as usize * options.height as usize];
        for y in 0..size[1] {
            for x in 0..size[0] {
                let own = colors.as_ref().map(|colors| colors[(y * size[0] + x) as usize]);
                let color = painter.color(x, y, own);
                let pixel = &mut pixels[(y / fine * options.width + x / fine) as usize];
                *pixel = std::array::from_fn(|channel| pixel[channel] + share * color[channel]);
            }
        }
        let mut stats = Stats { evaluations: evaluations + values.len() as u64, ..Stats::default() };
        stats.times.wall = start.elapsed();
        // Lines depend on what lies beside a pixel, so that a part is cut out of the whole.
        let row = |y: u32| {
            let first = (y * options.width + region.x) as usize;
            &pixels[first..first + region.width as usize]
        };
        let pixels = (region.y..region.y + region.height).flat_map(row).copied().collect();
        Ok(Rendered { image: Image::new(region.width, region.height, pixels), stats })
    }

    /// The lines of the surface and of the multiples of the spacing, with their values, on a grid of the options' size; points
    /// are in pixels of such a picture.
    ///
    /// # Errors
    /// If the options can't be followed, or it was given up.
    pub fn lines(
        &self,
        program: &Program,
        options: &Options,
        progress: &dyn Progress,
    ) -> Result<Vec<(f64, Vec<Isoline>)>, RenderError> {
        let values = self.section.values(program, &Options { crop: None, ..options.clone() }, progress)?;
        let size = [options.width, options.height];
        let lines_of = |level: f64| {
            let mut lines = isolines(&values, size, level as f32);
            // Values are those of the middles of pixels.
            lines.iter_mut().flat_map(|line| &mut line.points).for_each(|point| *point = point.map(|c| c + 0.5));
            (level, lines)
        };
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let (low, high) = (finite().fold(f32::INFINITY, f32::min), finite().fold(f32::NEG_INFINITY, f32::max));
        let mut levels = vec![0.0];
        if self.spacing > 0.0 && low < high {
            let (first, last) = (f64::from(low) / self.spacing, f64::from(high) / self.spacing);
            if last - first > f64::from(MOST_LINES) {
                return Err(RenderError::Lines(MOST_LINES));
            }
            let wanted = first.ceil() as i64..=last.floor() as i64;
            levels.extend(wanted.filter(|&index| index != 0).map(|index| index as f64 * self.spacing));
        }
        Ok(levels.into_iter().map(lines_of).filter(|(_, lines)| !lines.is_empty()).collect())
    }

    /// The distance from one point of a grid to the next.
    fn step(&self, grid: &Options) -> f64 {
        self.section.u.length() / f64::from(grid.width)
    }

    /// The colours of slopes or steps at all points of a grid, and how many evaluations it took.
    fn measured(
        &self,
        program: &Program,
        grid: &Options,
        progress: &dyn Progress,
    ) -> Result<(Vec<[f32; 3]>, u64), RenderError> {
        let row = grid.width as usize;
        let mut colors = vec![[0.0_f32; 3]; row * grid.height as usize];
        let bands: Vec<Mutex<&mut [[f32; 3]]>> = colors.chunks_mut(row * ROWS as usize).map(Mutex::new).collect();
        let (next, evaluations) = (AtomicUsize::new(0), AtomicU64::new(0));
        let work = || {
            let mut walker = Walker::new(program, self.step(grid));
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(band) = bands.get(index).filter(|_| !progress.is_cancelled()) else { break };
                let mut band = band.lock().unwrap_or_else(PoisonError::into_inner);
                for (place, row) in band.chunks_mut(row).enumerate() {
                    let y = index as u32 * ROWS + place as u32;
                    let points = (0..grid.width).map(|x| self.section.point([grid.width, grid.height], [x, y]));
                    walker.color(points, self.show, row);
                }
                progress.advanced(index as u64 + 1, bands.len() as u64);
            }
            evaluations.fetch_add(walker.evaluations, Ordering::Relaxed);
        };
        std::thread::scope(|scope| {
            for _ in 1..grid.threads_for(bands.len()) {
                scope.spawn(work);
            }
            work();
        });
        if progress.is_cancelled() {
            return Err(RenderError::Cancelled);
        }
        drop(bands);
        Ok((colors, evaluations.into_inner()))
    }
}

/// More lines than these can't be told apart in any picture.
const MOST_LINES: u32 = 10_000;

/// Goes down the gradient from many points at once.
struct Walker<'p> {
    evaluator: Evaluator<'p>,
    /// Where a point counts as at the surface.
    near: f32,
    points: [Vec<f32>; 3],
    values: Vec<f32>,
    gradient: [Vec<f32>; 3],
    evaluations: u64,
}

impl<'p> Walker<'p> {
    fn new(program: &'p Program, step: f64) -> Self {
        Self {
            evaluator: Evaluator::new(program),
            near: (step * AT_SURFACE) as f32,
            points: Default::default(),
            values: Vec::new(),
            gradient: Default::default(),
            evaluations: 0,
        }
    }

    fn color(&mut self, points: impl Iterator<Item = DVec3>, show: Show, out: &mut [[f32; 3]]) {
        let origin = self.evaluator.program().origin();
        self.points.iter_mut().for_each(Vec::clear);
        for point in points {
            for (axis, coordinate) in self.points.iter_mut().zip((point - origin).to_array()) {
                axis.push(coordinate as f32);
            }
        }
        self.evaluate();
        if show == Show::Slope {
            (0..out.len()).for_each(|place| out[place] = slope_color(self.slope(place)));
            return;
        }
        let mut steps = vec![0_u32; out.len()];
        for _ in 0..MOST_STEPS {
            let mut is_done = true;
            for (place, steps) in steps.iter_mut().enumerate() {
                let (value, slope) = (self.values[place], self.slope(place));
                if value.abs() > self.near && slope > 0.0 {
                    for (points, gradient) in self.points.iter_mut().zip(&self.gradient) {
                        points[place] -= gradient[place] / slope * value;
                    }
                    *steps += 1;
                    is_done = false;
                }
            }
            if is_done {
                break;
            }
            self.evaluate();
        }
        for (place, (out, steps)) in out.iter_mut().zip(steps).enumerate() {
            let is_known = self.values[place].is_finite() && self.slope(place).is_finite();
            *out = if is_known { steps_color(steps) } else { NOTHING };
        }
    }

    fn evaluate(&mut self) {
        let [x, y, z] = &self.points;
        let count = x.len();
        self.values.resize(count, 0.0);
        self.gradient.iter_mut().for_each(|axis| axis.resize(count, 0.0));
        let [gx, gy, gz] = &mut self.gradient;
        self.evaluator.gradients(Points { x, y, z }, &mut self.values, [gx, gy, gz]);
        self.evaluations += count as u64;
    }

    fn slope(&self, place: usize) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.gradient[axis][place]);
        (x * x + y * y + z * z).sqrt()
    }
}

fn mix(a: [f32; 3], b: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|channel| a[channel] + (b[channel] - a[channel]) * share)
}

fn slope_color(slope: f32) -> [f32; 3] {
    match slope.log2() {
        off if off.is_nan() => NOTHING,
        off if off < 0.0 => mix(PAPER, INSIDE, (-off).min(1.0)),
        off => mix(PAPER, TOO_FAST, off.min(1.0)),
    }
}

/// From dark blue over red to yellow, evenly in the logarithm.
fn steps_color(steps: u32) -> [f32; 3] {
    const STOPS: [[f32; 3]; 4] = [[0.01, 0.02, 0.10], [0.25, 0.02, 0.25], [0.75, 0.12, 0.05], [0.95, 0.85, 0.30]];
    let along = (f64::from(steps.max(1)).ln() / f64::from(MOST_STEPS).ln()) as f32 * (STOPS.len() - 1) as f32;
    let below = (along as usize).min(STOPS.len() - 2);
    mix(STOPS[below], STOPS[below + 1], along - below as f32)
}

/// Paints points of a grid.
struct Painter<'a> {
    slice: &'a Slice,
    values: &'a [f32],
    size: [u32; 2],
    /// Points along the side of a pixel.
    fine: u32,
    /// The distance from one point to the next.
    step: f64,
}

impl Painter<'_> {
    fn at(&self, x: u32, y: u32) -> f32 {
        self.values[(y * self.size[0] + x) as usize]
    }

    /// How much the value changes from pixel to pixel, at most.
    fn change(&self, x: u32, y: u32) -> f32 {
        let along = |[ax, ay]: [u32; 2], [bx, by]: [u32; 2]| {
            let points = (bx - ax + by - ay).max(1) as f32;
            (self.at(bx, by) - self.at(ax, ay)) / points
        };
        let across = along([x.saturating_sub(1), y], [(x + 1).min(self.size[0] - 1), y]);
        let down = along([x, y.saturating_sub(1)], [x, (y + 1).min(self.size[1] - 1)]);
        across.hypot(down) * self.fine as f32
    }

    fn color(&self, x: u32, y: u32, own: Option<[f32; 3]>) -> [f32; 3] {
        let value = self.at(x, y);
        if !value.is_finite() {
            return own.unwrap_or(NOTHING);
        }
        let base = own.unwrap_or_else(|| {
            let size = f64::from(self.size[0].min(self.size[1])) * self.step;
            let strength = 1.0 - (-f64::from(value.abs()) / (size * FADE)).exp() as f32;
            mix(PAPER, if value < 0.0 { INSIDE } else { OUTSIDE }, 0.25 + 0.75 * strength)
        });
        // Distances from lines in pixels; a field that changes nowhere has none.
        let change = self.change(x, y).max(f32::MIN_POSITIVE);
        let covered = |gap: f32, width: f32| (width / 2.0 + 0.5 - gap / change).clamp(0.0, 1.0);
        let spacing = self.slice.spacing as f32;
        let lines = if spacing > 0.0 {
            let gap = (value - (value / spacing).round() * spacing).abs();
            // Where lines run into one another, they fade.
            covered(gap, LINE_WIDTH) * (spacing / change / 4.0).min(1.0)
        } else {
            0.0
        };
        mix(mix(base, INK, LINE_STRENGTH * lines), INK, covered(value.abs(), SURFACE_WIDTH))
    }
}
