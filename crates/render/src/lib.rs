//! Pictures of scenes of distance fields, computed on the CPU.
//!
//! A [`Scene`](freikugel_scene::Scene) goes in; [`render`] compiles its fields, traces rays through the pixels that the
//! [`Options`] name, lights what they hit, and returns a [`Rendered`]: an [`Image`] of linear colours, and [`Stats`] that
//! say what it took and what could not be resolved. [`encode_png`] and [`encode_exr`] make files of it. Who renders
//! several pictures of one scene keeps the [`Renderer`], which holds the compiled fields and what pictures found out about
//! them: the next picture is faster, from whatever side.
//!
//! ```
//! use freikugel_field::shapes::sphere;
//! use freikugel_render::{Compression, Options, Tone, encode_png, render};
//! use freikugel_scene::{Light, Object, Scene, Sun};
//!
//! let scene = Scene {
//!     objects: vec![Object { name: "ball".into(), material: None, shape: sphere(1.0).into() }],
//!     lights: vec![Light::Sun(Sun { direction: glam::DVec3::new(1.0, -1.0, 2.0), ..Sun::default() })],
//!     ..Scene::default()
//! };
//! let options = Options { width: 32, height: 18, samples: 4, ..Options::of(&scene) };
//! let picture = render(&scene, &options, &())?;
//! assert_eq!(picture.stats.unresolved.pixels, 0);
//! let file = encode_png(&picture.image, &Tone::of(&scene.picture), Compression::Quick)?;
//! assert!(file.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # How a picture comes about
//!
//! Threads take tiles in turn. A tile's rays travel in waves of some thousands, each stage working on all of them before
//! the next begins: cast rays and intersect planes and equal balls exactly; march through everything else, batch by batch;
//! normals by dual numbers at the hits; shares of the materials there; ambient occlusion; for each light, shadow rays for the
//! hits that face it. All policy is decided per picture, light or wave, never per step.
//!
//! Rays are made in double precision, start their march at the wall of the box around the objects, and are rounded to
//! single precision once, relative to an origin near the camera. A ray stops when the surface is nearer than a tolerance
//! that grows with its distance from the camera; the same number later lifts shadow rays off the surface. A ray that runs
//! out of steps is counted, pixel by pixel, and never mistaken for a hit or a miss.
//!
//! A pixel depends on its own rays alone and is the same, bit by bit, for any number of threads, any instruction set, and
//! any crop of the frame.

mod bundle;
mod compare;
mod encode;
mod exact;
mod filter;
mod fixed;
mod image;
mod isolines;
mod keep;
mod layers;
mod light;
mod loose;
mod march;
mod material;
mod occlusion;
mod options;
mod packet;
mod prepare;
mod rays;
mod relaxed;
mod run;
mod search;
mod section;
mod shade;
mod slice;
mod squad;
mod stats;
mod trace;
mod vector;
mod view;
mod wave;

pub use compare::{Comparison, Outcome, Trial, Verdict, compare};
pub use encode::{Compression, EncodeError, encode_exr, encode_png};
pub use filter::offsets as sample_offsets;
pub use image::{Image, Tone, srgb_encode8};
pub use isolines::{Isoline, isolines};
pub use layers::{Layer, Layers};
pub use options::{MAX_PIXELS, MAX_SAMPLES, MAX_SIDE, MAX_TILE, Options, OptionsError, Rect};
pub use prepare::plan::{self, Plan};
pub use prepare::{PrepareError, Renderer};
pub use run::{Progress, RenderError, Rendered, render};
pub use section::Section;
pub use slice::{MOST_STEPS, Show, Slice};
pub use stats::{Rays, Stats, Times, Unresolved};
pub use view::CameraError;
