//! How the picture is computed: the tracer's limits, and the picture's size and exposure.

use crate::color::{ColorNotation, Rgb};
use crate::notation::{ChoiceNotation, Maybe, Number, OrNull, choice};
use crate::record::record;

record! {
    /// How rays find surfaces, and the limits of that.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Tracer = "tracer" {
        /// How a ray finds the first surface.
        pub method: Method = Method::Auto, optional ChoiceNotation, setter method;
        /// How far a ray goes before it counts as a miss.
        pub max_distance: f64 = 1000.0, optional Number::ANY.above(0.0), setter max_distance;
        /// How near to a surface a ray must come to hit it, as a share of the distance it has gone.
        pub precision: f64 = 1e-4, optional Number::ANY.above(0.0).at_most(1.0), setter precision;
        /// The power of the distance that `precision` is multiplied with: 1 for a share of the distance, 0 for a length
        /// that is the same everywhere.
        pub precision_exponent: f64 = 1.0, optional EXPONENT, setter precision_exponent;
        /// How many steps a ray may take before it counts as unresolved. Few rays come near the default, those that graze
        /// a long flat face, so that it costs no time.
        pub max_steps: u32 = 1024, optional Number::ANY.at_least(1.0).at_most(MOST_STEPS), setter max_steps;
        /// The share of the free distance that a step goes.
        pub step_factor: f64 = 1.0, optional Number::ANY.above(0.0).at_most(1.0), setter step_factor;
        /// How far a step goes with the method `fixed`; if missing, a 256th of the scene's size.
        pub step: Option<f64> = None, optional Maybe(Number::ANY.above(0.0));
        /// By what the free distance is multiplied for a step with the method `relaxed`.
        pub relaxation: f64 = 1.2, optional Number::ANY.at_least(1.0).below(2.0), setter relaxation;
        /// The colour of pixels with a ray that ran out of steps; if missing, they show a best guess.
        pub warning: Option<Rgb> = None, optional OrNull(ColorNotation);
    }
}

/// Beyond the square of the distance there is no use: the footprint of a pixel grows with its first power.
const EXPONENT: Number = Number::ANY.at_least(0.0).at_most(2.0);

choice! {
    /// How a ray finds the first surface.
    pub enum Method {
        /// For each object what its contract allows: distances are marched, formulas are searched, planes are intersected
        /// directly; what can't matter in a region is left out there.
        Auto = "auto",
        /// Steps of one length, until the sign changes between two of them.
        Fixed = "fixed",
        /// Sphere tracing: steps as long as the free distance, with all objects at each.
        Sphere = "sphere",
        /// Sphere tracing with longer steps, taken back where they might have passed a surface.
        Relaxed = "relaxed",
        /// A search by interval arithmetic that passes no surface, for distances too.
        Guaranteed = "guaranteed",
    }
    default Auto
}

impl Method {
    /// All methods, in the order of their introduction.
    pub const ALL: [Self; 5] = [Self::Auto, Self::Fixed, Self::Sphere, Self::Relaxed, Self::Guaranteed];
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
