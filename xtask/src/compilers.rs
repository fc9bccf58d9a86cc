//! The tests that need compilers of shaders other than those that come as libraries.

use crate::install::{install as install_packages, runs};
use crate::run::{Result, root, run};

/// Installs what is missing, and has texts of shaders compiled.
pub(crate) fn test() -> Result {
    install()?;
    run_tests(&["-p", "freikugel-shader", "--locked"])
}

/// Installs what is missing.
pub(crate) fn install() -> Result {
    if runs("glslangValidator") {
        return Ok(());
    }
    install_packages(&["glslang-tools"], "the tests of shaders in HLSL and GLSL need glslangValidator")
}

/// Has texts of shaders compiled, by tests among these packages.
pub(crate) fn run_tests(selection: &[&str]) -> Result {
    run(&root(), "cargo", &[&["test"][..], selection, &["--test", "compilers", "--", "--ignored"]].concat())
}
