//! Everything a change must pass.

use crate::run::{Result, SCHEMA, output, root, run, run_with};
use crate::{probe, shapes};
use std::process::Command;

/// Runs all checks, the quick ones first.
pub(crate) fn all() -> Result {
    let root = root();
    let warnings_are_errors = [("RUSTDOCFLAGS", "-D warnings")];
    install_components()?;
    run(&root, "cargo", &["fmt", "--all", "--check"])?;
    shapes::check()?;
    run(&root, "cargo", &["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"])?;
    run(&root, "cargo", &["test", "--workspace", "--locked"])?;
    schema_is_fresh()?;
    run_with(
        &root,
        "cargo",
        &["doc", "--workspace", "--no-deps", "--locked", "--document-private-items"],
        &warnings_are_errors,
    )?;
    probe::shape()?;
    install_deny()?;
    run(&root, "cargo", &["deny", "--log-level", "error", "check", "licenses", "bans", "sources"])?;
    eprintln!("xtask: all checks passed");
    Ok(())
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
