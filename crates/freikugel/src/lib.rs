//! Freikugel: signed distance fields, written once and seen in light.
//!
//! Shapes are values. Primitives are functions; methods place and change them; `|` (or `+`), `&` and `-` combine them. A
//! [`Scene`](prelude::Scene) puts materials, lights and a camera to them, and [`Render`](prelude::Render) makes a picture:
//!
//! ```
//! use freikugel::prelude::*;
//!
//! let mut scene = Scene::new();
//! let clay = scene.material("clay", Material::color("#c8825a").specular(0.2).exponent(32));
//!
//! let cup = cylinder(1.0, 2.0).round(0.05) - cylinder(0.85, 2.0).at([0.0, 0.0, 0.2]);
//! let handle = torus(0.5, 0.1).along(Axis::X).at([0.0, 1.0, 0.0]);
//! scene
//!     .add("cup", (cup | handle).painted(clay))
//!     .light(Sun::towards([1, -1, 2]).color("#fff5e0").shadow(Shadow::Hardness(16.0)))
//!     .camera(Camera::look([4, -6, 3], [0, 0, 0]).fov(40));
//! scene.picture.width = 64;
//! scene.picture.height = 36;
//!
//! let picture = scene.render()?;
//! assert_eq!(picture.stats.unresolved.pixels, 0);
//! # let folder = std::env::temp_dir().join(format!("freikugel-doc-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder)?;
//! # let path = folder.join("cup.png");
//! scene.save(&picture, &path)?;
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Constructors never fail. What is wrong with a scene (a negative radius, say) is found when it is rendered, or before
//! by [`Scene::check`](prelude::Scene::check), all at once and with the line of the Rust code it comes from.
//!
//! The layers below can be used alone: [`field`] for fields and their evaluation, [`scene`] for documents, [`mod@render`]
//! for pictures, [`shader`] for the text of shaders. Only this crate promises stability.

#![forbid(unsafe_code)]

pub mod animation;
pub mod files;
pub mod model;

pub use freikugel_field as field;
#[cfg(feature = "gpu")]
pub use freikugel_gpu as gpu;
pub use freikugel_render as render;
pub use freikugel_scene as scene;
pub use freikugel_shader as shader;

/// What most programs need: `use freikugel::prelude::*;`.
pub mod prelude {
    pub use crate::files::Render;
    pub use freikugel_field::shapes::*;
    pub use freikugel_field::{Axis, Field, MaterialId};
    pub use freikugel_render::{Image, Options, Rendered, Stats};
    pub use freikugel_scene::{
        Ambient, Background, Camera, Falloff, Light, Material, Method, Model, Object, Occlusion, Overbright, Pattern,
        Picture, Point, Projection, Scene, Shadow, Spot, Sun, Tracer,
    };
}
