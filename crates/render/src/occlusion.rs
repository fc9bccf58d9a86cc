//! Ambient occlusion: the clearance at five points along the normal, compared with what it would be over an open plane
//! (Evans, "Fast Approximations for Global Illumination on Dynamic Scenes", 2006; K 6.2).
//!
//! Each sample is looked up in the smallest cell around it, where it takes no more of the field than matters there. Where the
//! field has no scale, its clearance is its value over its slope at the point: right to first order.

use crate::prepare::{OCCLUSION_SAMPLES, OcclusionSamples};
use crate::trace::Tracer;
use crate::vector::{Triple, add_scaled, length};
use freikugel_field::{Cell, Occupancy};
use glam::DVec3;

/// Working memory.
#[derive(Default)]
pub(crate) struct Occlusion<'f> {
    /// The unoccluded share of ambient light at each hit.
    pub(crate) openness: Vec<f32>,
    /// Sample by sample.
    points: Vec<Triple>,
    clearances: Vec<f32>,
    /// The samples whose clearance has to be computed, and the cells around them.
    places: Vec<(&'f Cell, u32)>,
    /// The samples that may be near to an exact object.
    near: Vec<u32>,
}

impl<'f> Occlusion<'f> {
    /// Measures how open all hits of the wave are.
    pub(crate) fn measure(&mut self, tracer: &mut Tracer<'f>) {
        self.openness.clear();
        self.openness.resize(tracer.hits.len(), 1.0);
        let Some(OcclusionSamples { heights, weights }) = tracer.frame.occlusion else { return };
        self.points.clear();
        for hit in &tracer.hits {
            self.points.extend(heights.map(|height| add_scaled(hit.position, height, hit.normal)));
        }
        tracer.stats.rays.occlusion += self.points.len() as u64;
        self.clearances.clear();
        self.clearances.resize(self.points.len(), f32::INFINITY);
        self.find_places(tracer, &heights);
        self.clear_marched(tracer);
        self.clear_exact(tracer, &heights);
        let samples = self.clearances.chunks_exact(OCCLUSION_SAMPLES);
        for (open, clearances) in self.openness.iter_mut().zip(samples) {
            let mut occluded = 0.0;
            for ((clearance, height), weight) in clearances.iter().zip(heights).zip(weights) {
                // A field that grows faster than the distance must not make up for another sample.
                occluded += weight * (height - clearance).max(0.0);
            }
            *open = (1.0 - occluded).clamp(0.0, 1.0);
        }
    }

    /// Finds the cells around all samples, except where all that matters is far away.
    fn find_places(&mut self, tracer: &mut Tracer<'f>, heights: &[f32; OCCLUSION_SAMPLES]) {
        self.places.clear();
        let Some(space) = tracer.frame.space() else { return };
        for (index, &point) in self.points.iter().enumerate() {
            let cell = space.cell_at(point, &mut tracer.splitter);
            let is_open = match cell.occupancy() {
                Occupancy::Outside(clearance) if cell.part().is_measured() => {
                    clearance >= heights[index % OCCLUSION_SAMPLES]
                }
                _ => false,
            };
            if !is_open {
                self.places.push((cell, index as u32));
            }
        }
        self.places.sort_unstable_by_key(|&(cell, index)| (std::ptr::from_ref(cell), index));
    }

    /// The clearances of what is marched.
    fn clear_marched(&mut self, tracer: &mut Tracer<'f>) {
        let Some(field) = &mut tracer.marched else { return };
        let cloud = &mut tracer.cloud;
        for places in self.places.chunk_by(|a, b| std::ptr::eq(a.0, b.0)) {
            cloud.clear();
            for &(_, index) in places {
                cloud.push(self.points[index as usize]);
            }
            let part = places[0].0.part();
            if part.is_measured() {
                tracer.stats.evaluations += cloud.values(field, part);
                for (&(_, index), &value) in places.iter().zip(&cloud.value) {
                    self.clearances[index as usize] = value;
                }
                continue;
            }
            tracer.stats.evaluations += cloud.gradients(field, part, 0..places.len());
            for (place, &(_, index)) in places.iter().enumerate() {
                // In cells that is all that is known inside: the sign.
                let value = cloud.value[place].max(0.0);
                let clearance = value / length(cloud.gradient_at(place));
                // Without a slope, or without a value, nothing is known to be near.
                self.clearances[index as usize] = if clearance.is_nan() { f32::INFINITY } else { clearance };
            }
        }
    }

    /// The clearances of exact objects, where these are less.
    fn clear_exact(&mut self, tracer: &mut Tracer<'f>, heights: &[f32; OCCLUSION_SAMPLES]) {
        let frame = tracer.frame;
        for (exact, evaluator) in frame.renderer.exact.iter().zip(&mut tracer.exact) {
            tracer.cloud.clear();
            self.near.clear();
            for (index, &point) in self.points.iter().enumerate() {
                let place = frame.origin + DVec3::from(point.map(f64::from));
                if exact.is_near(place, heights[index % OCCLUSION_SAMPLES].into()) {
                    self.near.push(index as u32);
                    tracer.cloud.push(point);
                }
            }
            tracer.stats.evaluations += tracer.cloud.values(evaluator, evaluator.program().whole());
            for (&index, &value) in self.near.iter().zip(&tracer.cloud.value) {
                let clearance = &mut self.clearances[index as usize];
                *clearance = clearance.min(value);
            }
        }
    }
}
