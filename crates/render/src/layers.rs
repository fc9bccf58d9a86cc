//! What lies at the centre of each pixel, other than its colour: distance, depth, normal, object, steps.

use crate::trace::Tracer;

/// One value of each kind for each pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    width: u32,
    height: u32,
    pixels: Vec<Layer>,
}

/// What lies at the centre of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Distance from the eye along the ray (from the eye's plane, in an orthographic view); infinite where the ray
    /// meets nothing.
    pub distance: f32,
    /// Distance from the eye's plane, the "true z"; infinite where the ray meets nothing.
    pub depth: f32,
    /// The unit normal; 0 where the ray meets nothing.
    pub normal: [f32; 3],
    /// The object's place in the scene, by the largest share.
    pub object: Option<u32>,
    /// Steps the ray took.
    pub steps: u32,
    /// Whether the ray ran out of steps.
    pub is_unresolved: bool,
}

impl Layers {
    /// A ray that meets nothing.
    pub const NOTHING: Layer = Layer {
        distance: f32::INFINITY,
        depth: f32::INFINITY,
        normal: [0.0; 3],
        object: None,
        steps: 0,
        is_unresolved: false,
    };

    /// Layers that were computed elsewhere.
    ///
    /// # Panics
    /// If there are not `width` times `height` pixels.
    pub fn new(width: u32, height: u32, pixels: Vec<Layer>) -> Self {
        assert_eq!(u64::from(width) * u64::from(height), pixels.len() as u64, "one layer for each pixel");
        Self { width, height, pixels }
    }

    /// Pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The pixels, row by row from the top.
    pub fn pixels(&self) -> &[Layer] {
        &self.pixels
    }

    /// Reads one wave of rays, one for each pixel, whose places among the pixels `place` tells.
    pub(crate) fn collect(tracer: &Tracer<'_>, pixels: &mut [Layer], place: impl Fn(usize) -> usize) {
        for (ray, &steps) in tracer.rays.steps[..tracer.rays.count()].iter().enumerate() {
            pixels[place(ray)].steps = steps;
        }
        for &ray in &tracer.unresolved {
            pixels[place(ray as usize)].is_unresolved = true;
        }
        for hit in &tracer.hits {
            let ray = hit.ray as usize;
            let pixel = &mut pixels[place(ray)];
            pixel.distance = hit.distance as f32;
            pixel.depth = tracer.frame.view.depth(&tracer.rays.ray(ray), hit.distance) as f32;
            pixel.normal = hit.normal;
            pixel.object = Some(hit.object);
        }
    }
}
