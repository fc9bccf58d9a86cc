//! The camera rays of a wave, side by side.
//!
//! Directions, and where rays enter the box around all that is marched, are computed in double precision: what marches in
//! single precision begins there, so that its numbers stay small.

use crate::bundle::LANES;
use crate::march::Start;
use crate::prepare::Frame;
use crate::vector::{Triple, length};
use crate::view::{Ray, walls};
use freikugel_field::simd;
use glam::{DVec2, DVec3};

/// Camera rays, by their places in the wave. All lists are filled up to whole rows of lanes.
#[derive(Default)]
pub(crate) struct Rays {
    count: usize,
    /// The points of the picture they go through, in raster coordinates.
    raster: [Vec<f64>; 2],
    origin: [Vec<f64>; 3],
    direction: [Vec<f64>; 3],
    /// The nearest exact object, or [`Rays::NOTHING`]; and how far to look: at most as far as that.
    exact: Vec<u32>,
    limit: Vec<f64>,
    /// How far from the ray's origin its march begins.
    begin: Vec<f64>,
    pub(crate) starts: Starts,
    /// The steps they took.
    pub(crate) steps: Vec<u32>,
}

/// Where marches along rays start, in single precision and relative to the frame's origin. See [`Start`].
#[derive(Default)]
pub(crate) struct Starts {
    pub(crate) origin: [Vec<f32>; 3],
    pub(crate) direction: [Vec<f32>; 3],
    /// How far the march goes; 0 for a ray that does not march.
    pub(crate) end: Vec<f32>,
    pub(crate) base: Vec<f32>,
    pub(crate) growth: Vec<f32>,
}

impl Rays {
    const NOTHING: u32 = u32::MAX;

    pub(crate) fn clear(&mut self) {
        self.count = 0;
        self.raster.iter_mut().for_each(Vec::clear);
    }

    /// Adds the ray through a point of the picture.
    pub(crate) fn push(&mut self, raster: DVec2) {
        self.count += 1;
        self.raster[0].push(raster.x);
        self.raster[1].push(raster.y);
    }

    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// The places of those that march.
    pub(crate) fn marching(&self) -> impl Iterator<Item = usize> {
        (0..self.count).filter(|&ray| self.starts.end[ray] > 0.0)
    }

    /// A ray as cast.
    pub(crate) fn ray(&self, index: usize) -> Ray {
        let at = |lists: &[Vec<f64>; 3]| DVec3::new(lists[0][index], lists[1][index], lists[2][index]);
        Ray { origin: at(&self.origin), direction: at(&self.direction) }
    }

    /// The nearest exact object that a ray meets, and how far away.
    pub(crate) fn exact(&self, index: usize) -> Option<(usize, f64)> {
        (self.exact[index] != Self::NOTHING).then(|| (self.exact[index] as usize, self.limit[index]))
    }

    /// Forgets the exact object: something else is nearer.
    pub(crate) fn forget_exact(&mut self, index: usize) {
        self.exact[index] = Self::NOTHING;
    }

    /// How far from a ray's origin its march begins.
    pub(crate) fn begin(&self, index: usize) -> f64 {
        self.begin[index]
    }

    /// Computes all rays, their nearest exact objects, and where they march.
    pub(crate) fn cast(&mut self, frame: &Frame<'_>, has_marched: bool) {
        let lanes = self.count.next_multiple_of(LANES);
        self.resize(lanes);
        self.aim(frame);
        self.meet_exact(frame);
        if has_marched {
            self.find_spans(frame);
        } else {
            self.begin.fill(0.0);
            self.starts.end.fill(0.0);
        }
    }

    /// The lanes left over repeat the last ray.
    fn resize(&mut self, lanes: usize) {
        for list in &mut self.raster {
            let last = list.last().copied().unwrap_or(0.0);
            list.resize(lanes, last);
        }
        let Self { origin, direction, exact, limit, begin, starts, steps, .. } = self;
        origin.iter_mut().chain(direction).chain([limit, begin]).for_each(|list| list.resize(lanes, 0.0));
        exact.resize(lanes, Self::NOTHING);
        steps.clear();
        steps.resize(lanes, 0);
        let Starts { origin, direction, end, base, growth } = starts;
        origin.iter_mut().chain(direction).chain([end, base, growth]).for_each(|list| list.resize(lanes, 0.0));
    }

    fn aim(&mut self, frame: &Frame<'_>) {
        let Self { raster: [x, y], origin, direction, .. } = self;
        let view = &frame.view;
        simd::with(
            frame.level,
            #[inline(always)]
            || {
                for start in (0..x.len()).step_by(LANES) {
                    let (x, y) = (lanes(x, start), lanes(y, start));
                    let [ox, oy, oz] = origin.each_mut().map(|list| lanes_mut(list, start));
                    let [dx, dy, dz] = direction.each_mut().map(|list| lanes_mut(list, start));
                    for lane in 0..LANES {
                        let ray = view.ray(DVec2::new(x[lane], y[lane]));
                        (ox[lane], oy[lane], oz[lane]) = ray.origin.into();
                        (dx[lane], dy[lane], dz[lane]) = ray.direction.into();
                    }
                }
            },
        );
    }

    fn meet_exact(&mut self, frame: &Frame<'_>) {
        self.exact.fill(Self::NOTHING);
        let farthest = frame.renderer.scene.tracer.max_distance;
        self.limit.fill(farthest);
        let objects = &frame.renderer.exact;
        if objects.is_empty() {
            return;
        }
        for index in 0..self.count {
            let ray = self.ray(index);
            let nearest = objects
                .iter()
                .enumerate()
                .filter_map(|(object, exact)| Some((object, exact.form.hit(&ray, farthest)?)))
                .filter(|(_, t)| t.is_finite())
                .min_by(|(_, a), (_, b)| a.total_cmp(b));
            if let Some((object, t)) = nearest {
                self.exact[index] = object as u32;
                self.limit[index] = t;
            }
        }
    }

    /// Finds where rays enter and leave the box around all that is marched, and the tolerances on that way.
    fn find_spans(&mut self, frame: &Frame<'_>) {
        let Self { origin, direction, limit, begin, starts, .. } = self;
        let farthest = frame.renderer.scene.tracer.max_distance;
        let bounds = frame.bounds;
        simd::with(
            frame.level,
            #[inline(always)]
            || {
                for start in (0..limit.len()).step_by(LANES) {
                    let [ox, oy, oz] = origin.each_ref().map(|list| lanes(list, start));
                    let [dx, dy, dz] = direction.each_ref().map(|list| lanes(list, start));
                    let [fx, fy, fz] = starts.origin.each_mut().map(|list| lanes_mut(list, start));
                    let [gx, gy, gz] = starts.direction.each_mut().map(|list| lanes_mut(list, start));
                    let (limit, begin) = (lanes(limit, start), lanes_mut(begin, start));
                    let length = lanes_mut(&mut starts.end, start);
                    for lane in 0..LANES {
                        let ray = Ray {
                            origin: DVec3::new(ox[lane], oy[lane], oz[lane]),
                            direction: DVec3::new(dx[lane], dy[lane], dz[lane]),
                        };
                        let (near, far) = match &bounds {
                            Some(bounds) => walls(bounds, &ray),
                            None => (0.0, farthest),
                        };
                        // Also what an exact object hides does not have to be found.
                        let limit = if farthest < limit[lane] { farthest } else { limit[lane] };
                        let marches = (near <= far) & (near < limit);
                        let first = if marches { near } else { 0.0 };
                        let last = if far < limit { far } else { limit };
                        // The march begins at the box's wall, computed in double precision, so that `t` stays small.
                        let place = ray.origin + ray.direction * first - frame.origin;
                        begin[lane] = first;
                        length[lane] = if marches { (last - near) as f32 } else { 0.0 };
                        (fx[lane], fy[lane], fz[lane]) = place.as_vec3().into();
                        (gx[lane], gy[lane], gz[lane]) = ray.direction.as_vec3().into();
                    }
                }
            },
        );
        self.tolerate(frame);
    }

    /// Finds the tolerances on the ways of all rays.
    fn tolerate(&mut self, frame: &Frame<'_>) {
        let in_values = 1.0 / f64::from(frame.pace.scale);
        let Starts { origin, end, base, growth, .. } = &mut self.starts;
        let (begin, tolerance) = (&self.begin, frame.tolerance);
        simd::with(
            frame.level,
            #[inline(always)]
            || {
                for start in (0..begin.len()).step_by(LANES) {
                    let [x, y, z] = origin.each_ref().map(|list| lanes(list, start));
                    let (begin, end) = (lanes(begin, start), lanes(end, start));
                    let (base, growth) = (lanes_mut(base, start), lanes_mut(growth, start));
                    for lane in 0..LANES {
                        let offset = f64::from(length([x[lane], y[lane], z[lane]]));
                        let last = begin[lane] + f64::from(end[lane]);
                        let [at, slope] = tolerance.along(begin[lane], last, offset);
                        base[lane] = (at * in_values) as f32;
                        growth[lane] = (slope * in_values) as f32;
                    }
                }
            },
        );
    }

    /// The unit vector against a ray, in single precision.
    pub(crate) fn viewer(&self, index: usize) -> Triple {
        self.direction.each_ref().map(|list| -(list[index] as f32))
    }

    /// Where the march along a ray starts.
    pub(crate) fn start(&self, index: usize) -> Start {
        let Starts { origin, direction, end, base, growth } = &self.starts;
        let at = |lists: &[Vec<f32>; 3]| -> Triple { [lists[0][index], lists[1][index], lists[2][index]] };
        Start {
            id: index as u32,
            origin: at(origin),
            direction: at(direction),
            span: [0.0, end[index]],
            tolerance: [base[index], growth[index]],
            steps: self.steps[index],
            sharpness: 1.0,
        }
    }
}

impl Starts {
    /// Changes the tolerance of a ray.
    pub(crate) fn tolerate(&mut self, index: usize, [base, growth]: [f32; 2]) {
        self.base[index] = base;
        self.growth[index] = growth;
    }
}

/// A row of a list that starts at a ray.
#[inline(always)]
fn lanes<T>(list: &[T], start: usize) -> &[T; LANES] {
    list[start..start + LANES].try_into().expect("a row")
}

/// A row of a list that starts at a ray, to be written.
#[inline(always)]
fn lanes_mut<T>(list: &mut [T], start: usize) -> &mut [T; LANES] {
    (&mut list[start..start + LANES]).try_into().expect("a row")
}
