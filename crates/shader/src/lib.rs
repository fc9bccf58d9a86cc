//! Scenes as shaders: text in WGSL, GLSL, HLSL and MSL, and the numbers it reads.
//!
//! A [`Shader`] is made of a scene. Its text depends on what the scene is built of, and on no number: positions, sizes, colours,
//! lights and cameras are entries of a table, the [`Parameters`]. Changing one of them needs a new table and nothing else.
//!
//! ```
//! use freikugel_field::shapes::*;
//! use freikugel_scene::Scene;
//! use freikugel_shader::{Shader, Target, View};
//!
//! let mut scene = Scene::new();
//! scene.add("ball", sphere(1.0)).add("ring", torus(2.0, 0.2));
//! let shader = Shader::new(&scene)?;
//! let text = shader.text(Target::Wgsl, &shader.parameters(&scene)?)?;
//! assert!(text.contains("ball"));
//!
//! // Another radius: the same text, another table.
//! scene.objects[0].shape = sphere(1.5).into();
//! let parameters = shader.parameters(&scene)?;
//! assert_eq!(shader.text(Target::Wgsl, &parameters)?, text);
//! assert_eq!(View::of(640, 360).bytes().len(), View::SIZE);
//! # Ok::<(), freikugel_shader::ShaderError>(())
//! ```
//!
//! # What the WGSL module offers
//!
//! All bindings are in group 0. Coordinates in the shader are relative to [`Parameters::origin`].
//!
//! | binding | name | is |
//! |---|---|---|
//! | 0 | `parameters` | `array<vec4<f32>, n>`, uniform or (beyond [`MOST_UNIFORM_BYTES`]) storage, read: [`Parameters::numbers`] |
//! | 1 | `view` | uniform of 48 bytes: [`View::bytes`] |
//! | 2 | `output` | `array<vec4<f32>>`, storage, read and write: one entry for each pixel of the tile, row by row |
//! | 3 | `points` | `array<vec4<f32>>`, storage, read |
//! | 4 | `results` | `array<vec4<f32>>`, storage, read and write |
//! | 5 | `voxels` | only of [`Shader::of_voxels`]: `array<vec2<f32>>`, storage, read: [`Parameters::voxels`] |
//!
//! | entry point | does |
//! |---|---|
//! | `render`, compute, 8 x 8 | writes `keep * output + weight * sample` for each pixel of the tile ([`View`], [`Show`]) |
//! | `probe`, compute, 64 | writes the gradient of the field (xyz) and its value (w) at each of `points` |
//! | `cover`, vertex | a triangle that covers the picture; draw three vertices |
//! | `show`, fragment | what a display shows, in sRGB, with exposure; the first pixel is `view.tile` |
//!
//! # How it comes about
//!
//! Objects, and what unions at the top of objects hold, are *parts*. Each part is compiled into steps, and each step becomes one
//! line; functions of shapes are written once, recorded from the same generic formulas that the processor runs, with their
//! gradients by the rules of dual numbers. Parts far away are passed over by their boxes; many parts are found through a
//! hierarchy of boxes in the table of numbers, and share one function for each form, so that the text stays short. Tracing,
//! lighting and materials are a library, written in a part of WGSL, read into the same [form](tree) as the formulas, and printed
//! from there in each language. What a formula has no scale for is marched by a bound of its slope, which is a parameter.
//!
//! [`Shader::of_voxels`] samples all that is marched instead: its text does not depend on shapes at all, and a ray takes as long
//! whatever the shapes cost.
//!
//! No threads, files or clocks: this crate runs in a browser.

#![forbid(unsafe_code)]

mod curvature;
mod fill;
mod formula;
pub mod glsl;
mod helpers;
mod hierarchy;
mod layout;
mod many;
mod module;
mod names;
mod numbers;
pub mod parse;
mod part;
mod print;
mod rounds;
mod sampled;
mod scene;
mod shader;
mod target;
pub mod tree;
mod view;
pub mod wgsl;

pub use sampled::{SampleError, sample};
pub use shader::{Parameters, Shader, ShaderError};
pub use target::{MOST_UNIFORM_BYTES, TEXTURE_WIDTH, Target, VOXELS_WIDTH};
pub use view::{Show, View};
