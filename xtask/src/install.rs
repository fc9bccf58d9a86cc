//! Programs that tests need besides cargo.

use crate::run::{Result, root, run};
use std::process::Command;

/// Whether a program is there.
pub(crate) fn runs(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// Installs packages where that is done by apt-get, and otherwise says what is missing.
pub(crate) fn install(packages: &[&str], need: &str) -> Result {
    if !cfg!(target_os = "linux") || !runs("apt-get") {
        return Err(format!("{need}; please install it"));
    }
    eprintln!("xtask: installing {}", packages.join(" "));
    // Without lists of packages nothing can be installed; if they can't be brought up to date, old ones may do.
    let _ = run(&root(), "apt-get", &["update", "-q"]);
    run(&root(), "apt-get", &[&["install", "-y", "-q", "--no-install-recommends"], packages].concat())
        .map_err(|error| format!("{error}; {need}"))
}
