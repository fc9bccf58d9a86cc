//! Pictures of signed distance fields, computed on graphics processors, and the native window.
//!
//! [`Gpu`] is a graphics processor ready for work, [`GpuRenderer`] a scene on it: the shader of
//! [`freikugel_shader`], compiled once, and its numbers, which may change as often as one likes. Options, images and layers
//! are those of [`freikugel_render`]. [`view`] shows a scene in a window until it is closed.
//!
//! ```no_run
//! use freikugel_gpu::{Choice, Gpu, GpuRenderer};
//! use freikugel_render::Options;
//! use freikugel_scene::{Object, Scene};
//! use std::sync::Arc;
//!
//! let scene = Scene {
//!     objects: vec![Object {
//!         name: "ball".into(),
//!         material: None,
//!         shape: freikugel_field::shapes::sphere(1.0).into(),
//!     }],
//!     ..Scene::default()
//! };
//! let gpu = Arc::new(Gpu::open(&Choice::Automatic)?);
//! let picture = GpuRenderer::new(&gpu, &scene)?.render(&Options::of(&scene), &())?;
//! println!("{} by {}", picture.image.width(), gpu.summary());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Nothing here runs for long without a look at the clock: pictures are cut into tiles that fit a [`BUDGET`].

mod adapter;
mod device;
mod frames;
mod kernel;
mod picture;
mod renderer;
mod source;
mod tiler;
mod window;

pub use adapter::{AdapterError, AdapterSummary, Choice, adapters};
pub use device::{Gpu, GpuError, OpenError};
pub use frames::{Creation, Frames};
pub use freikugel_shader::ShaderError;
pub use renderer::{DrawError, GpuRenderer};
pub use tiler::{BUDGET, Tiler};
pub use window::{FrameTimes, Host, Summary, ViewError, WindowOptions, view};
