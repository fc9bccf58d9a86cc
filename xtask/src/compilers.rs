//! The tests that need compilers of shaders other than those that come as libraries.

use crate::install::{install, runs};
use crate::run::{Result, root, run};

/// Installs what is missing, and has texts of shaders compiled.
pub(crate) fn test() -> Result {
    if !runs("glslangValidator") {
        install(&["glslang-tools"], "the tests of shaders in HLSL and GLSL need glslangValidator")?;
    }
    run(&root(), "cargo", &["test", "-p", "freikugel-shader", "--locked", "--test", "compilers", "--", "--ignored"])
}
