//! Scenes as shaders.
