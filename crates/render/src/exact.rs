//! Objects that rays are intersected with exactly: planes, which a marched ray only crawls along, and equal balls, of which a marched
//! ray would ask for the nearest one at every step.

use crate::prepare::Paint;
use crate::view::Ray;
use freikugel_field::balls::Balls;
use freikugel_field::ray::ExactRay;
use freikugel_field::{Aabb, Extent, Field, Structure};
use glam::DVec3;

/// An object that rays are intersected with exactly.
pub(crate) struct Exact<'s> {
    pub(crate) form: Form,
    pub(crate) paint: Paint<'s>,
    pub(crate) structure: Structure,
    pub(crate) extent: Extent,
}

impl Exact<'_> {
    /// Whether it may be nearer to a point than `reach`.
    pub(crate) fn is_near(&self, point: DVec3, reach: f64) -> bool {
        match self.extent {
            Extent::Empty => false,
            Extent::Finite(Aabb { min, max }) => point.distance_squared(point.clamp(min, max)) < reach * reach,
            Extent::Unbounded => true,
        }
    }
}

/// What rays are intersected with.
pub(crate) enum Form {
    Plane(ExactRay),
    Balls(Box<Balls>),
}

impl Form {
    /// What a field is, if it is one of these.
    pub(crate) fn of(field: &Field) -> Option<Self> {
        let plane = ExactRay::of(field).map(Self::Plane);
        plane.or_else(|| Balls::of(field).map(|balls| Self::Balls(Box::new(balls))))
    }

    /// How far along a ray it begins; if it is finite, only within `limit`.
    pub(crate) fn hit(&self, ray: &Ray, limit: f64) -> Option<f64> {
        match self {
            Self::Plane(plane) => plane.hit(ray.origin, ray.direction),
            Self::Balls(balls) => balls.hit(ray.origin, ray.direction, limit),
        }
    }

    /// The share of a light `distance` away along a ray that comes past it; if it is finite, only what is within `limit` counts. Planes
    /// are either in the way or not; for all others, with a sharpness, that is the factor of a soft shadow.
    pub(crate) fn light_past(&self, ray: &Ray, distance: f64, limit: f64, sharpness: Option<f32>) -> f32 {
        let far = distance.min(limit);
        match (self, sharpness) {
            (Self::Plane(plane), _) => {
                f32::from(u8::from(plane.hit(ray.origin, ray.direction).is_none_or(|t| t >= distance)))
            }
            (Self::Balls(balls), None) => f32::from(u8::from(!balls.is_hit(ray.origin, ray.direction, far))),
            (Self::Balls(balls), Some(sharpness)) => {
                let sharpness = f64::from(sharpness);
                let clearance = balls.least_clearance(ray.origin, ray.direction, far, sharpness.recip());
                ((sharpness * clearance) as f32).min(1.0)
            }
        }
    }
}
