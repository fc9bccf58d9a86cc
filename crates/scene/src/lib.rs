//! Scenes of signed distance fields: the document.
//!
//! A [`Scene`] is plain data: [`Object`]s with shapes (fields of `freikugel-field`), [`Material`]s, [`Light`]s, a
//! [`Camera`], and how the picture is taken. It is read from JSON by [`read()`], which reports all mistakes at once with
//! their places, and [`report`] prints these for a person; or it is built in code, and [`Scene::check`] finds the same
//! mistakes there. [`schema()`] describes the files to other programs.
//!
//! ```
//! use freikugel_field::shapes::*;
//! use freikugel_scene::{Camera, Material, Scene, Sun};
//!
//! let mut scene = Scene::new();
//! let clay = scene.material("clay", Material::color("#c8825a").exponent(40));
//! let cup = cylinder(1.0, 2.0) - cylinder(0.85, 2.0).at([0.0, 0.0, 0.2]);
//! scene
//!     .add("cup", cup.painted(clay))
//!     .light(Sun::towards([1, -1, 2]).color("#fff5e0"))
//!     .camera(Camera::look([4, -6, 3], [0, 0, 1]).fov(40));
//! assert!(scene.check().is_empty());
//! ```
//!
//! Nothing here knows how anything is computed. Each record is declared once ([`Camera`], say, with its documentation,
//! defaults, ranges, and notation), and reading, checking and the schema follow from that; shapes are read and described
//! by their descriptors alone.

mod argument;
mod camera;
mod check;
pub mod color;
mod diagnostic;
pub mod edit;
mod files;
mod light;
mod material;
mod named;
mod names;
mod notation;
mod object;
mod parameter;
mod ply;
mod read;
mod reader;
mod record;
mod scene;
mod schema;
mod settings;
mod shadow;
mod shapes;
mod suggest;
mod surroundings;
mod syntax;

pub use argument::Argument;
pub use camera::{Camera, FovAxis, Projection};
pub use color::Rgb;
pub use diagnostic::{Diagnostic, MOST_REPORTED, Severity, report};
pub use files::{Files, Folder, NoFiles};
pub use light::{Falloff, Light, Point, Spot, Sun};
pub use material::{Material, Model, Pattern};
pub use names::Inputs;
pub use object::Object;
pub use parameter::Parameter;
pub use read::{MOST_NESTED, Reading, VERSION, read, read_at, read_with};
pub use scene::{Origins, Scene};
pub use schema::schema;
pub use settings::{Method, Overbright, Picture, Tracer};
pub use shadow::Shadow;
pub use surroundings::{Ambient, Background, Occlusion};
