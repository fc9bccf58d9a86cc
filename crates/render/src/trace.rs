//! From camera rays to hits: exact intersections, marching, normals, materials.
//!
//! A [`Tracer`] is the working memory of one thread. It takes rays in waves; all buffers keep their size from wave to
//! wave.

use crate::march::{End, Fate, Start};
use crate::material::{Footprint, Surface};
use crate::packet::{Manner, Quest, Space};
use crate::prepare::{Frame, Renderer, rounding};
use crate::rays::Rays;
use crate::stats::Stats;
use crate::vector::{Triple, add_scaled, dot, length, scaled};
use crate::wave::Wave;
use freikugel_field::{Cell, Encloser, Evaluator, Part, Points, Program, Shares, Splitter};
use freikugel_scene::Method;
use glam::{DVec2, DVec3};
use std::ops::Range;

/// A hit is a false one if by its gradient the surface is still this many tolerances away.
const FALSE_HIT: f32 = 2.0;

/// The least gradient a surface is expected to have; where the field is flatter, hits are taken as they are.
const FLATTEST: f32 = 1e-3;

/// An unresolved ray shows the surface it is creeping along if that is nearer than this many tolerances, else what
/// lies behind.
const CREEPING: f32 = 64.0;

/// What a camera ray met.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// The ray's place in its wave.
    pub(crate) ray: u32,
    /// The object's place in the scene; the one with the largest share. One of those that look like it, unless
    /// [`Frame::tells_objects`].
    pub(crate) object: u32,
    /// Relative to the frame's origin.
    pub(crate) position: Triple,
    pub(crate) normal: Triple,
    /// The unit vector against the ray.
    pub(crate) viewer: Triple,
    /// From the ray's origin.
    pub(crate) distance: f64,
    /// How far the position may be from the surface.
    pub(crate) uncertainty: f32,
    /// What errors of position are tolerated there, in this and in its shadow.
    pub(crate) tolerance: f32,
    /// How fast the marched field grows away from the surface, if it is one of its own.
    pub(crate) gradient: f32,
    pub(crate) surface: Surface,
}

/// Where a march ended on a surface.
#[derive(Clone, Copy)]
struct Landing<'f> {
    ray: u32,
    /// Where the part of the field that matters there is to be found.
    cell: &'f Cell,
    t: f32,
    position: Triple,
    gradient: Triple,
}

/// The working memory of one thread.
pub(crate) struct Tracer<'f> {
    pub(crate) frame: &'f Frame<'f>,
    pub(crate) marched: Option<Evaluator<'f>>,
    pub(crate) encloser: Option<Encloser<'f>>,
    pub(crate) exact: Vec<Evaluator<'f>>,
    pub(crate) wave: Wave<'f>,
    pub(crate) splitter: Splitter,
    pub(crate) ends: Vec<End>,
    pub(crate) cloud: Cloud,
    shares: Shares,
    pub(crate) rays: Rays,
    landings: Vec<Landing<'f>>,
    /// What the rays of the last wave met, in no particular order; at most one for each ray.
    pub(crate) hits: Vec<Hit>,
    /// Rays of the last wave that ran out of steps.
    pub(crate) unresolved: Vec<u32>,
    pub(crate) stats: Stats,
}

/// Points with room for what is computed at them.
#[derive(Default)]
pub(crate) struct Cloud {
    point: [Vec<f32>; 3],
    pub(crate) value: Vec<f32>,
    gradient: [Vec<f32>; 3],
}

impl<'f> Tracer<'f> {
    pub(crate) fn new(frame: &'f Frame<'f>) -> Self {
        let evaluator = |program: &'f Program| Evaluator::with_level(program, frame.level);
        Self {
            frame,
            marched: frame.marched.as_ref().map(evaluator),
            encloser: frame.marched.as_ref().map(|program| Encloser::new(program, frame.level)),
            exact: frame.exact.iter().map(evaluator).collect(),
            wave: Wave::new(frame.way),
            splitter: Splitter::new(frame.level),
            ends: Vec::new(),
            cloud: Cloud::default(),
            shares: Shares::default(),
            rays: Rays::default(),
            landings: Vec::new(),
            hits: Vec::new(),
            unresolved: Vec::new(),
            stats: Stats::default(),
        }
    }

    /// Forgets the last wave.
    pub(crate) fn clear(&mut self) {
        self.rays.clear();
        self.hits.clear();
        self.unresolved.clear();
    }

    /// Adds the camera ray through a point of the picture to the wave.
    pub(crate) fn push(&mut self, raster: DVec2) {
        self.rays.push(raster);
    }

    /// Traces all rays of the wave and collects what they hit.
    pub(crate) fn trace(&mut self) {
        self.rays.cast(self.frame, self.marched.is_some());
        self.wave.push_all(&self.rays);
        self.stats.rays.camera += self.rays.count() as u64;
        self.land();
        self.collect_marched();
        self.collect_exact();
        self.stats.hits += self.hits.len() as u64;
    }

    /// Marches until each ray has landed, passed, or run out of steps.
    ///
    /// Where a field's slope is below its Lipschitz constant, its values fall below the tolerance before the surface is
    /// as near as that. The gradient tells: such rays go on with a tolerance that fits the slope they saw.
    fn land(&mut self) {
        self.landings.clear();
        let (Some(field), Some(encloser)) = (&mut self.marched, &mut self.encloser) else { return };
        let pace = self.frame.pace;
        let space = self.frame.space().expect("what is marched has cells");
        loop {
            self.ends.clear();
            self.stats.evaluations +=
                self.wave.travel(&space, Quest::First, field, encloser, &mut self.splitter, &mut self.ends);
            self.cloud.clear();
            self.ends.retain(|end| {
                let ray = end.id as usize;
                let starts = &self.rays.starts;
                self.rays.steps[ray] = end.steps;
                let lands = match end.fate {
                    Fate::Hit => true,
                    Fate::Passed => false,
                    Fate::Exhausted => {
                        self.unresolved.push(end.id);
                        end.value < CREEPING * (starts.base[ray] + starts.growth[ray] * end.t)
                    }
                };
                if lands {
                    let Start { origin, direction, tolerance: [base, growth], .. } = self.rays.start(ray);
                    // On the very surface many fields have no slope: then that of the way there, as near as is tolerated.
                    let back = if end.value == 0.0 { (base + growth * end.t) * pace.scale } else { 0.0 };
                    self.cloud.push(add_scaled(origin, end.t - back, direction));
                }
                lands
            });
            let mut first = 0;
            for ends in self.ends.chunk_by(|a, b| a.place == b.place) {
                let part = self.wave.cell(&space, ends[0].place).part();
                self.stats.evaluations += self.cloud.gradients(field, part, first..first + ends.len());
                first += ends.len();
            }
            for (index, end) in self.ends.iter().enumerate() {
                let start = self.rays.start(end.id as usize);
                let gradient = self.cloud.gradient_at(index);
                let slope = length(gradient);
                let in_values = slope.max(FLATTEST) * pace.scale;
                let [base, growth] = start.tolerance;
                let limit = base + growth * end.t;
                // Rounding errors of values do not shrink with the slope.
                let finer =
                    [(base * in_values).max(rounding(length(start.origin))), (growth * in_values).max(rounding(1.0))];
                let is_false = end.value > FALSE_HIT * limit * in_values && end.value > finer[0] + finer[1] * end.t;
                if end.fate == Fate::Hit && is_false && self.wave.heeds_tolerance() {
                    self.rays.starts.tolerate(end.id as usize, finer);
                    let span = [end.t, start.span[1]];
                    self.wave.push(&Start { span, steps: end.steps, tolerance: finer, ..start });
                } else {
                    if end.t == 0.0 && end.value < -limit {
                        self.stats.inside += 1;
                    }
                    let position = add_scaled(start.origin, end.t, start.direction);
                    let cell = self.wave.cell(&space, end.place);
                    self.landings.push(Landing { ray: end.id, cell, t: end.t, position, gradient });
                }
            }
            if self.wave.is_empty() {
                break;
            }
        }
        self.stats.steps += self.rays.steps.iter().map(|&steps| u64::from(steps)).sum::<u64>();
        self.stats.unresolved.camera += self.unresolved.len() as u64;
    }

    fn collect_marched(&mut self) {
        let frame = self.frame;
        let paints = &frame.renderer.paints;
        if self.landings.is_empty() {
            return;
        }
        let Renderer { is_uniform, is_one_object, .. } = *frame.renderer;
        let matters = !is_uniform || (frame.tells_objects && !is_one_object);
        for landings in self.landings.chunk_by(|a, b| std::ptr::eq(a.cell, b.cell)) {
            let part = landings[0].cell.part();
            // Most cells hold one region, which has it all.
            let asks_for_shares = part.region_count() > 1 && matters;
            if asks_for_shares {
                self.cloud.clear();
                for landing in landings {
                    self.cloud.push(landing.position);
                }
                let field = self.marched.as_mut().expect("something was marched");
                self.stats.evaluations += self.cloud.shares(field, part, &mut self.shares);
            }
            for (index, landing) in landings.iter().enumerate() {
                let ray = landing.ray as usize;
                let main = match asks_for_shares {
                    true => self
                        .shares
                        .iter()
                        .reduce(|best, other| if other.1[index] > best.1[index] { other } else { best })
                        .map_or(0, |(region, _)| region),
                    false => part.first_region().unwrap_or(0),
                };
                let viewer = self.rays.viewer(ray);
                let slope = length(landing.gradient);
                let mut normal = scaled(landing.gradient, 1.0 / slope);
                if !normal.iter().all(|x| x.is_finite()) {
                    normal = viewer;
                }
                if paints[main].is_sheet && dot(normal, viewer) < 0.0 {
                    normal = normal.map(|x| -x);
                }
                let distance = self.rays.begin(ray) + f64::from(landing.t);
                let offset = length(landing.position);
                let uncertainty = frame.tolerance.at(distance, f64::from(offset)) as f32;
                let footprint = Footprint { width: frame.width_at(distance), normal, viewer, uncertainty };
                let point = frame.origin + DVec3::from(landing.position.map(f64::from));
                let mut surface = Surface::of(paints[main].material, point, &footprint);
                if asks_for_shares {
                    let mut total = self.shares.of(main, index);
                    for (region, shares) in self.shares.iter().filter(|&(region, _)| region != main) {
                        let share = shares[index];
                        if share > 0.0 {
                            total += share;
                            let other = Surface::of(paints[region].material, point, &footprint);
                            surface.mix(&other, share / total);
                        }
                    }
                }
                self.hits.push(Hit {
                    ray: landing.ray,
                    object: paints[main].object,
                    position: landing.position,
                    normal,
                    viewer,
                    distance,
                    uncertainty,
                    tolerance: uncertainty,
                    gradient: slope.clamp(FLATTEST, 1.0),
                    surface,
                });
            }
        }
    }

    /// Adds the exact objects that rays meet which landed on nothing.
    fn collect_exact(&mut self) {
        let frame = self.frame;
        for landing in &self.landings {
            self.rays.forget_exact(landing.ray as usize);
        }
        for (index, evaluator) in self.exact.iter_mut().enumerate() {
            let paint = &frame.renderer.exact[index].paint;
            self.cloud.clear();
            let first = self.hits.len();
            for id in 0..self.rays.count() {
                let Some((_, distance)) = self.rays.exact(id).filter(|(object, _)| *object == index) else {
                    continue;
                };
                let ray = self.rays.ray(id);
                let point = ray.origin + ray.direction * distance;
                let position = (point - frame.origin).as_vec3().to_array();
                self.cloud.push(position);
                let offset = length(position);
                self.hits.push(Hit {
                    ray: id as u32,
                    object: paint.object,
                    position,
                    normal: [0.0; 3],
                    viewer: self.rays.viewer(id),
                    distance,
                    // Of the two, the distance is the one that never vanishes.
                    uncertainty: rounding(offset.max(distance as f32)),
                    tolerance: frame.tolerance.at(distance, offset.into()) as f32,
                    gradient: 1.0 / frame.pace.scale,
                    surface: Surface::default(),
                });
            }
            let all = 0..self.hits.len() - first;
            self.stats.evaluations += self.cloud.gradients(evaluator, evaluator.program().whole(), all);
            for (place, hit) in self.hits[first..].iter_mut().enumerate() {
                self.stats.inside += u64::from(hit.distance == 0.0 && !paint.is_sheet);
                let gradient = self.cloud.gradient_at(place);
                let normal = scaled(gradient, 1.0 / length(gradient));
                let is_seen_from_behind = paint.is_sheet && dot(normal, hit.viewer) < 0.0;
                hit.normal = if !normal.iter().all(|x| x.is_finite()) {
                    hit.viewer
                } else if is_seen_from_behind {
                    normal.map(|x| -x)
                } else {
                    normal
                };
                let footprint = Footprint {
                    width: frame.width_at(hit.distance),
                    normal: hit.normal,
                    viewer: hit.viewer,
                    uncertainty: hit.uncertainty,
                };
                let ray = self.rays.ray(hit.ray as usize);
                let point = ray.origin + ray.direction * hit.distance;
                hit.surface = Surface::of(paint.material, point, &footprint);
            }
        }
    }
}

impl Frame<'_> {
    /// What marching rays travel through.
    pub(crate) fn space(&self) -> Option<Space<'_>> {
        let cells = self.cells.as_deref()?;
        let shift = (cells.origin() - self.origin).as_vec3().to_array();
        let manner = match self.renderer.scene.tracer.method {
            Method::Auto => Manner::Fitting,
            Method::Guaranteed => Manner::Searching,
            Method::Fixed | Method::Sphere | Method::Relaxed => Manner::Plain,
        };
        Some(Space { cells, shift, eye: self.eye, pixel: self.footprint, pace: self.pace, manner })
    }

    /// The width of the cone around a ray at a distance from the camera.
    fn width_at(&self, distance: f64) -> f32 {
        let [fixed, growth] = self.footprint;
        fixed + growth * distance as f32
    }
}

impl Cloud {
    pub(crate) fn clear(&mut self) {
        for numbers in &mut self.point {
            numbers.clear();
        }
    }

    pub(crate) fn push(&mut self, point: Triple) {
        for (numbers, number) in self.point.iter_mut().zip(point) {
            numbers.push(number);
        }
    }

    pub(crate) fn gradient_at(&self, index: usize) -> Triple {
        [self.gradient[0][index], self.gradient[1][index], self.gradient[2][index]]
    }

    fn points(point: &[Vec<f32>; 3]) -> Points<'_> {
        Points { x: &point[0], y: &point[1], z: &point[2] }
    }

    /// Computes the field at the points, where `part` holds, and returns how many there are.
    pub(crate) fn values(&mut self, field: &mut Evaluator<'_>, part: &Part) -> u64 {
        self.value.resize(self.point[0].len(), 0.0);
        field.values_in(part, Self::points(&self.point), &mut self.value);
        self.value.len() as u64
    }

    /// Computes values and gradients at some of the points, where `part` holds, and returns how many there are.
    pub(crate) fn gradients(&mut self, field: &mut Evaluator<'_>, part: &Part, range: Range<usize>) -> u64 {
        let count = self.point[0].len();
        self.value.resize(count, 0.0);
        for numbers in &mut self.gradient {
            numbers.resize(count, 0.0);
        }
        let gradient = self.gradient.each_mut().map(|numbers| &mut numbers[range.clone()]);
        let [x, y, z] = self.point.each_ref().map(|numbers| &numbers[range.clone()]);
        let places = range.len() as u64;
        field.gradients_in(part, Points { x, y, z }, &mut self.value[range], gradient);
        places
    }

    fn shares(&mut self, field: &mut Evaluator<'_>, part: &Part, shares: &mut Shares) -> u64 {
        field.shares_in(part, Self::points(&self.point), shares);
        self.point[0].len() as u64
    }
}
