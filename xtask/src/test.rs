//! Everything a change must pass.

use crate::install::{install, runs};
use crate::run::{Result, SCHEMA, root, run, run_with, tested_freikugel};
use crate::{browser, compilers, probe, reference, shapes};
use std::process::Command;

/// What all builds of the tests select. Selections that differ give libraries other features, and everything would be built anew
/// for each of them, kernels included, which take minutes.
const EVERYTHING: [&str; 4] = ["--workspace", "--features", "freikugel/gpu", "--locked"];

/// Runs all checks, the quick ones first.
pub(crate) fn all() -> Result {
    let root = root();
    let warnings_are_errors = [("RUSTDOCFLAGS", "-D warnings")];
    install_components()?;
    install_graphics_software()?;
    compilers::install()?;
    browser::install()?;
    run(&root, "cargo", &["fmt", "--all", "--check"])?;
    shapes::check()?;
    lint(&EVERYTHING)?;
    // The command without what is optional, whose tests run in the probe's workspace.
    lint(&["-p", "freikugel", "--no-default-features", "--locked"])?;
    run(&root, "cargo", &[&["test", "--no-fail-fast"][..], &EVERYTHING].concat())?;
    compilers::run_tests(&EVERYTHING)?;
    browser::run_tests(&EVERYTHING)?;
    schema_is_fresh()?;
    reference::check(&tested_freikugel)?;
    let documentation = ["doc", "--no-deps", "--document-private-items"];
    run_with(&root, "cargo", &[&documentation[..], &EVERYTHING].concat(), &warnings_are_errors)?;
    probe::shape()?;
    install_deny()?;
    run(&root, "cargo", &["deny", "--log-level", "error", "check", "licenses", "bans", "sources"])?;
    eprintln!("xtask: all checks passed");
    Ok(())
}

fn lint(selection: &[&str]) -> Result {
    run(&root(), "cargo", &[&["clippy"][..], selection, &["--all-targets", "--", "-D", "warnings"]].concat())
}

/// The software that stands in for a graphics processor.
const GPU_SOFTWARE: &str = "mesa-vulkan-drivers";

/// Lints and tests what needs a graphics processor, or software that stands in for one.
pub(crate) fn on_graphics_processor() -> Result {
    install_graphics_software()?;
    let selection = ["-p", "freikugel-gpu", "-p", "freikugel", "--features", "freikugel/gpu", "--locked"];
    lint(&selection)?;
    // The tests of the command run with it, too: most ask nothing of a graphics processor, and must not notice it.
    run(&root(), "cargo", &[&["test"][..], &selection].concat())
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
    let fresh = tested_freikugel(&["schema"])?;
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
    // Unoptimised, since it runs for a second and is built for minutes.
    eprintln!("xtask: installing cargo-deny into cargo's own folder (some minutes, once)");
    run(&root(), "cargo", &["install", "cargo-deny", "--locked", "--debug"])
}
