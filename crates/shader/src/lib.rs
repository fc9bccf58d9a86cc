//! Scenes as shaders.

mod formula;
pub mod glsl;
mod helpers;
mod layout;
mod module;
mod names;
pub mod parse;
mod part;
mod print;
mod scene;
mod shader;
mod target;
pub mod tree;
mod view;
pub mod wgsl;

pub use shader::{Parameters, Shader, ShaderError};
pub use target::{TEXTURE_WIDTH, Target};
pub use view::{Show, View};
