//! Everything a change must pass.

use crate::install::{install, runs};
use crate::run::{Result, SCHEMA, output, root, run, run_with};
use crate::{browser, compilers, probe, reference, shapes};
use std::process::Command;

/// Runs all checks, the quick ones first.
pub(crate) fn all() -> Result {
    let root = root();
    let warnings_are_errors = [("RUSTDOCFLAGS", "-D warnings")];
    install_components()?;
    run(&root, "cargo", &["fmt", "--all", "--check"])?;
    shapes::check()?;
    // The graphics processor's crate is left to a step of its own: its libraries take minutes to build.
    let workspace = ["--workspace", "--exclude", GPU_CRATE, "--locked"];
    run(&root, "cargo", &[&["clippy"][..], &workspace, &["--all-targets", "--", "-D", "warnings"]].concat())?;
    run(&root, "cargo", &[&["test"][..], &workspace].concat())?;
    schema_is_fresh()?;
    reference::check()?;
    run_with(
        &root,
        "cargo",
        &["doc", "--workspace", "--all-features", "--no-deps", "--locked", "--document-private-items"],
        &warnings_are_errors,
    )?;
    probe::shape()?;
    on_graphics_processor()?;
    compilers::test()?;
    browser::test()?;
    install_deny()?;
    run(&root, "cargo", &["deny", "--log-level", "error", "check", "licenses", "bans", "sources"])?;
    eprintln!("xtask: all checks passed");
    Ok(())
}

/// The crate of graphics processors, and its package of software that stands in for one.
const GPU_CRATE: &str = "freikugel-gpu";
const GPU_SOFTWARE: &str = "mesa-vulkan-drivers";

/// Lints and tests what needs a graphics processor, or software that stands in for one.
pub(crate) fn on_graphics_processor() -> Result {
    let root = root();
    install_graphics_software()?;
    let command = ["-p", "freikugel", "--features", "gpu", "--locked"];
    run(&root, "cargo", &["clippy", "-p", GPU_CRATE, "--all-targets", "--locked", "--", "-D", "warnings"])?;
    run(&root, "cargo", &[&["clippy"][..], &command, &["--all-targets", "--", "-D", "warnings"]].concat())?;
    // The tests of the command run with it, too: most ask nothing of a graphics processor, and must not notice it.
    run(&root, "cargo", &["test", "-p", GPU_CRATE, "--locked"])?;
    run(&root, "cargo", &[&["test"][..], &command].concat())
}

/// Pictures are compared on whatever graphics processor there is. On Debian and its kin, where none has a driver for Vulkan,
/// software is installed; elsewhere the tests say what is missing.
fn install_graphics_software() -> Result {
    let drivers = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
    let has_driver =
        drivers.iter().any(|folder| std::fs::read_dir(folder).is_ok_and(|mut files| files.next().is_some()));
    if has_driver || !cfg!(target_os = "linux") || !runs("apt-get") {
        return Ok(());
    }
    install(
        &[GPU_SOFTWARE],
        "the tests of graphics processors need software that stands in for one, or a driver for Vulkan",
    )
}

fn schema_is_fresh() -> Result {
    let root = root();
    let fresh = output(&root, "cargo", &["run", "--quiet", "--locked", "-p", "freikugel", "--", "schema"])?;
    let present = std::fs::read_to_string(root.join(SCHEMA)).map_err(|e| format!("can't read {SCHEMA}: {e}"))?;
    if fresh == present { Ok(()) } else { Err(format!("{SCHEMA} is out of date; run `cargo xtask schema`")) }
}

/// Whether a cargo subcommand is there.
fn has(subcommand: &str) -> bool {
    Command::new("cargo").args([subcommand, "--version"]).output().is_ok_and(|output| output.status.success())
}

/// Formatting and lints come with the toolchain, but not with its smallest installation.
fn install_components() -> Result {
    for (subcommand, component) in [("fmt", "rustfmt"), ("clippy", "clippy")] {
        if !has(subcommand) {
            eprintln!("xtask: installing the toolchain's component {component}");
            run(&root(), "rustup", &["component", "add", component])?;
        }
    }
    Ok(())
}

fn install_deny() -> Result {
    if has("deny") {
        return Ok(());
    }
    eprintln!("xtask: installing cargo-deny into cargo's own folder (some minutes, once)");
    run(&root(), "cargo", &["install", "cargo-deny", "--locked"])
}
