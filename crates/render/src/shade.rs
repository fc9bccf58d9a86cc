//! From hits to colours: ambient light and its occlusion, lights and their shadows.
//!
//! Shadow rays go from the surface towards the light, in waves like camera rays. Soft shadows come in two forms
//! that differ in one number only: the factor is the least of `sharpness * clearance / distance` along the ray, from
//! 0 at a hit to 1, where the sharpness is a light's hardness, or the distance to the light over the light's own
//! clearance (K 6.1), or for a sun the cotangent of half its apparent diameter. What rays are intersected with exactly dims
//! them in closed form, before they march.

use crate::light::{Dimming, Incoming, Lamp};
use crate::march::{Fate, Start};
use crate::occlusion::Occlusion;
use crate::packet::Quest;
use crate::prepare::{Frame, rounding};
use crate::trace::{Hit, Tracer};
use crate::vector::{Triple, add_scaled, dot, length, mix, times};
use crate::view::{Ray, clip};
use freikugel_field::Aabb;
use freikugel_scene::Background;
use glam::DVec3;

/// Shadow rays start this many uncertainties of their hit above the surface, and hit what is nearer than so many
/// tolerances, so that they can't hit the surface they leave: not even where the hit was that far on its wrong side.
const SHADOW_START: f32 = 2.0;
const SHADOW_HIT: f32 = 0.5;

/// Working memory for shading.
#[derive(Default)]
pub(crate) struct Shading<'f> {
    occlusion: Occlusion<'f>,
    lit: Vec<Lit>,
}

/// A hit that faces a light.
#[derive(Clone, Copy)]
struct Lit {
    hit: u32,
    incoming: Incoming,
    n_dot_l: f32,
    /// The part of the light that arrives.
    factor: f32,
}

impl<'f> Tracer<'f> {
    /// Writes the colour that each ray of the wave sees.
    pub(crate) fn shade(&mut self, memory: &mut Shading<'f>, colors: &mut Vec<Triple>) {
        let background = &self.frame.renderer.scene.background;
        colors.clear();
        colors.extend((0..self.rays.count()).map(|ray| seen_behind(background, &self.rays.ray(ray))));
        memory.occlusion.measure(self);
        let ambient = &self.frame.renderer.scene.ambient;
        for (hit, &openness) in self.hits.iter().zip(&memory.occlusion.openness) {
            let around = mix(ambient.ground, ambient.sky, 0.5 + 0.5 * hit.normal[2]);
            let surface = &hit.surface;
            colors[hit.ray as usize] =
                add_scaled(surface.emissive, surface.ambient * openness, times(surface.color, around));
        }
        for lamp in &self.frame.lamps {
            self.find_lit(lamp, &mut memory.lit);
            self.cast_shadows(lamp, &mut memory.lit);
            for lit in memory.lit.iter().filter(|lit| lit.factor > 0.0) {
                let Hit { ray, normal, viewer, surface, .. } = &self.hits[lit.hit as usize];
                let Incoming { direction, light, .. } = lit.incoming;
                let color = &mut colors[*ray as usize];
                let reflected = surface.reflected(light, *normal, *viewer, direction, lit.n_dot_l);
                *color = add_scaled(*color, lit.factor, reflected);
            }
        }
    }

    fn find_lit(&mut self, lamp: &Lamp, lit: &mut Vec<Lit>) {
        lit.clear();
        for (index, hit) in self.hits.iter().enumerate() {
            if hit.surface.diffuse <= 0.0 && hit.surface.specular <= 0.0 {
                continue;
            }
            let Some(incoming) = lamp.at(hit.position) else {
                continue;
            };
            let n_dot_l = dot(hit.normal, incoming.direction);
            if n_dot_l > 0.0 {
                lit.push(Lit { hit: index as u32, incoming, n_dot_l, factor: 1.0 });
            }
        }
    }

    fn cast_shadows(&mut self, lamp: &Lamp, lit: &mut [Lit]) {
        let frame = self.frame;
        if lamp.dimming == Dimming::None {
            return;
        }
        self.stats.rays.shadow += lit.len() as u64;
        for (id, lit) in lit.iter_mut().enumerate() {
            let hit = &self.hits[lit.hit as usize];
            let Incoming { direction, distance, .. } = lit.incoming;
            let origin = add_scaled(hit.position, SHADOW_START * hit.uncertainty, hit.normal);
            let ray = Ray {
                origin: frame.origin + DVec3::from(origin.map(f64::from)),
                direction: DVec3::from(direction.map(f64::from)),
            };
            let sharpness = match lamp.dimming {
                Dimming::None | Dimming::Hard => None,
                Dimming::Sharpness(sharpness) => Some(sharpness),
                Dimming::Clearance(clearance) => Some(distance / clearance),
            };
            lit.factor = frame.light_past_exact(&ray, distance, sharpness);
            if lit.factor == 0.0 {
                continue;
            }
            let Some([near, far]) = frame.shadow_span(&ray, sharpness) else {
                continue;
            };
            let far = far.min(distance);
            if self.marched.is_none() || near >= far {
                continue;
            }
            let exactness = rounding(length(origin));
            self.wave.push(&Start {
                id: id as u32,
                origin,
                direction,
                span: [near, far],
                tolerance: [(SHADOW_HIT * hit.tolerance + exactness) * hit.gradient, rounding(1.0) * hit.gradient],
                steps: 0,
                sharpness: sharpness.unwrap_or(1.0),
            });
        }
        let (Some(field), Some(encloser)) = (&mut self.marched, &mut self.encloser) else { return };
        let space = frame.space().expect("what is marched has cells");
        let quest = match lamp.dimming {
            Dimming::None | Dimming::Hard => Quest::Any,
            Dimming::Sharpness(_) | Dimming::Clearance(_) => Quest::Least,
        };
        self.ends.clear();
        self.stats.evaluations += self.wave.travel(&space, quest, field, encloser, &mut self.splitter, &mut self.ends);
        for end in &self.ends {
            let factor = &mut lit[end.id as usize].factor;
            *factor = factor.min(end.factor);
            self.stats.steps += u64::from(end.steps);
            self.stats.unresolved.shadow += u64::from(end.fate == Fate::Exhausted);
        }
    }
}

impl Frame<'_> {
    /// The share of a light `distance` away along a ray that comes past all exact objects.
    fn light_past_exact(&self, ray: &Ray, distance: f32, sharpness: Option<f32>) -> f32 {
        let limit = self.renderer.scene.tracer.max_distance;
        let objects = self.renderer.exact.iter();
        objects.fold(1.0, |least, exact| {
            if least > 0.0 { exact.form.light_past(ray, distance.into(), limit, sharpness).min(least) } else { least }
        })
    }

    /// The part of a shadow ray on which marched objects can dim it.
    fn shadow_span(&self, ray: &Ray, sharpness: Option<f32>) -> Option<[f32; 2]> {
        let limit = self.renderer.scene.tracer.max_distance;
        let (near, far) = match (&self.bounds, sharpness) {
            (None, _) => (0.0, limit),
            (Some(bounds), None) => clip(bounds, ray)?,
            (Some(bounds), Some(sharpness)) => penumbra(bounds, ray, f64::from(sharpness))?,
        };
        Some([near as f32, far.min(limit) as f32])
    }
}

/// The part of a ray where the ball around a box is nearer than the distance travelled over `sharpness`: elsewhere the
/// factor of a soft shadow is 1.
fn penumbra(bounds: &Aabb, ray: &Ray, sharpness: f64) -> Option<(f64, f64)> {
    let radius = bounds.size().length() / 2.0;
    let away = ray.origin - bounds.center();
    // |away + t direction| <= radius + t / sharpness, squared.
    let spread = sharpness.recip();
    let a = 1.0 - spread * spread;
    let b = away.dot(ray.direction) - radius * spread;
    let c = away.length_squared() - radius * radius;
    if a <= 0.0 {
        // The cone is at least as wide as a half-space; what lies behind the ray is near enough to matter.
        return Some((0.0, f64::INFINITY));
    }
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let (near, far) = ((-b - root) / a, (-b + root) / a);
    (far > 0.0).then_some((near.max(0.0), far))
}

/// What a ray sees that meets nothing.
fn seen_behind(background: &Background, ray: &Ray) -> Triple {
    match *background {
        Background::Solid(color) => color,
        Background::Gradient { top, bottom } => mix(bottom, top, 0.5 + 0.5 * ray.direction.z as f32),
    }
}
