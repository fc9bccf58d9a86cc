//! The tests that need a browser, and what they need besides it.

use crate::run::{Result, root, run};
use std::process::Command;

/// Where the program lies that drives the browser, with the lock file of what it needs.
const DRIVER: &str = "crates/shader/tests/browser";

/// What it needs of npm.
const DRIVER_PACKAGE: &str = "node_modules/playwright-core/package.json";

/// Names of browsers that will do; `run.mjs` looks for the same.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Installs what is missing, and draws pictures in a browser.
pub(crate) fn test() -> Result {
    let has_browser = std::env::var_os("CHROME_PATH").is_some() || BROWSERS.into_iter().any(runs);
    if !has_browser {
        install("chromium", "the tests in a browser need Chromium; CHROME_PATH can name another one")?;
    }
    if !(runs("node") && runs("npm")) {
        install("nodejs npm", "the tests in a browser need Node.js 20 or later, and npm")?;
    }
    let driver = root().join(DRIVER);
    if !driver.join(DRIVER_PACKAGE).is_file() {
        eprintln!("xtask: installing playwright-core, which drives the browser, into {DRIVER}/node_modules");
        run(&driver, "npm", &["ci", "--no-audit", "--no-fund"])
            .map_err(|error| format!("{error}; the tests in a browser need the package playwright-core of npm"))?;
    }
    let test = ["test", "-p", "freikugel-shader", "--locked", "--test", "browser"];
    run(&root(), "cargo", &[&test[..], &["--", "--ignored", "--nocapture"]].concat())
}

/// Whether a program is there.
fn runs(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// Installs packages where that is done by apt-get, and otherwise says what is missing.
fn install(packages: &str, need: &str) -> Result {
    if !cfg!(target_os = "linux") || !runs("apt-get") {
        return Err(format!("{need}; please install it"));
    }
    eprintln!("xtask: installing {packages}");
    // Without lists of packages nothing can be installed; if they can't be brought up to date, old ones may do.
    let _ = run(&root(), "apt-get", &["update", "-q"]);
    let names: Vec<&str> = packages.split(' ').collect();
    run(&root(), "apt-get", &[&["install", "-y", "-q", "--no-install-recommends"][..], &names].concat())
        .map_err(|error| format!("{error}; {need}"))
}
