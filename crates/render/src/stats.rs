//! What a picture took, and what it could not resolve.
//!
//! All counts are sums over pixels, so they depend neither on threads nor on instruction sets; the times do.

use std::ops::AddAssign;
use std::time::Duration;

/// Counts and times of one rendering.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stats {
    /// Rays and samples, by what they were for.
    pub rays: Rays,
    /// Camera rays that met a surface.
    pub hits: u64,
    /// Camera rays that started inside a solid object. They show its material at the eye.
    pub inside: u64,
    /// Values of the field computed, over all purposes; gradients and shares count as one each.
    pub evaluations: u64,
    /// Steps of camera and shadow rays.
    pub steps: u64,
    /// What was given up.
    pub unresolved: Unresolved,
    /// Where the time went.
    pub times: Times,
}

/// Rays and samples, by what they were for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rays {
    /// From the camera into the scene.
    pub camera: u64,
    /// From surfaces towards lights that cast shadows, where the surface faces the light.
    pub shadow: u64,
    /// Samples along normals for ambient occlusion.
    pub occlusion: u64,
}

/// What ran out of steps. The picture holds a best guess there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unresolved {
    /// Pixels with at least one unresolved camera ray.
    pub pixels: u64,
    /// Unresolved camera rays.
    pub camera: u64,
    /// Unresolved shadow rays.
    pub shadow: u64,
}

/// Where the time went.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Times {
    /// Threads in use.
    pub threads: u64,
    /// From start to end of the rendering.
    pub wall: Duration,
    /// The time all threads together were at work.
    pub work: Duration,
}

/// Adds the counts and the work; wall time and threads belong to the whole and are left alone.
impl AddAssign for Stats {
    fn add_assign(&mut self, other: Self) {
        self.rays.camera += other.rays.camera;
        self.rays.shadow += other.rays.shadow;
        self.rays.occlusion += other.rays.occlusion;
        self.hits += other.hits;
        self.inside += other.inside;
        self.evaluations += other.evaluations;
        self.steps += other.steps;
        self.unresolved.pixels += other.unresolved.pixels;
        self.unresolved.camera += other.unresolved.camera;
        self.unresolved.shadow += other.unresolved.shadow;
        self.times.work += other.times.work;
    }
}
