//! How the picture is computed: the tracer's limits, and the picture's size and exposure.

use crate::notation::{ChoiceNotation, Number, choice};
use crate::record::record;

record! {
    /// The limits of tracing a ray.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Tracer = "tracer" {
        /// How far a ray goes before it counts as a miss.
        pub max_distance: f64 = 1000.0, optional Number::ANY.above(0.0), setter max_distance;
        /// How near to a surface a ray must come to hit it, as a share of the distance it has gone.
        pub precision: f64 = 1e-4, optional Number::ANY.above(0.0).at_most(0.1), setter precision;
        /// How many steps a ray may take before it counts as unresolved. Few rays come near the default, those that graze
        /// a long flat face, so that it costs no time.
        pub max_steps: u32 = 1024, optional Number::ANY.at_least(1.0).at_most(MOST_STEPS), setter max_steps;
        /// The share of the free distance that a step goes.
        pub step_factor: f64 = 1.0, optional Number::ANY.above(0.0).at_most(1.0), setter step_factor;
    }
}

/// Rays with more steps than this take minutes for a picture, and find nothing that a million did not.
const MOST_STEPS: f64 = 1e6;

record! {
    /// The size of the picture and how light becomes colour in it.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Picture = "picture" {
        /// How many pixels it is wide.
        pub width: u32 = 640, optional EDGE, setter width;
        /// How many pixels it is high.
        pub height: u32 = 360, optional EDGE, setter height;
        /// How many rays are averaged in each pixel.
        pub samples: u32 = 16, optional Number::ANY.at_least(1.0).at_most(MOST_SAMPLES), setter samples;
        /// By how many stops the picture is brightened: each doubles the light.
        pub exposure: f32 = 0.0, optional EXPOSURE, setter exposure;
        /// What becomes of colours brighter than the picture can hold.
        pub overbright: Overbright = Overbright::Clamp, optional ChoiceNotation, setter overbright;
    }
}

/// The length of an edge in pixels: four times that of the largest cinema pictures.
const EDGE: Number = Number::ANY.at_least(1.0).at_most(65_536.0);

/// Beyond this, the noise of an average is far below what a picture file resolves.
const MOST_SAMPLES: f64 = 65_536.0;

/// Outside this range the factor would leave the range of `f32` with ordinary light.
const EXPOSURE: Number = Number::ANY.at_least(-32.0).at_most(32.0);

choice! {
    /// What becomes of colours brighter than the picture can hold.
    pub enum Overbright {
        /// Each channel is cut by itself, which moves the hue towards white.
        Clamp = "clamp",
        /// All channels are scaled down together, which keeps the hue.
        ScaleDown = "scale_down",
    }
    default Clamp
}
