//! The tests that need a browser, and what they need besides it.

use crate::install::{install as install_packages, runs};
use crate::run::{Result, root, run};

/// Where the program lies that drives the browser, with the lock file of what it needs.
const DRIVER: &str = "crates/shader/tests/browser";

/// What it needs of npm.
const DRIVER_PACKAGE: &str = "node_modules/playwright-core/package.json";

/// Names of browsers that will do; `run.mjs` looks for the same.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Installs what is missing, and draws pictures in a browser.
pub(crate) fn test() -> Result {
    install()?;
    run_tests(&["-p", "freikugel-shader", "--locked"])
}

/// Installs what is missing.
pub(crate) fn install() -> Result {
    let has_browser = std::env::var_os("CHROME_PATH").is_some() || BROWSERS.into_iter().any(runs);
    if !has_browser {
        install_packages(&["chromium"], "the tests in a browser need Chromium; CHROME_PATH can name another one")?;
    }
    if !(runs("node") && runs("npm")) {
        install_packages(&["nodejs", "npm"], "the tests in a browser need Node.js 20 or later, and npm")?;
    }
    let driver = root().join(DRIVER);
    if !driver.join(DRIVER_PACKAGE).is_file() {
        eprintln!("xtask: installing playwright-core, which drives the browser, into {DRIVER}/node_modules");
        run(&driver, "npm", &["ci", "--no-audit", "--no-fund"])
            .map_err(|error| format!("{error}; the tests in a browser need the package playwright-core of npm"))?;
    }
    Ok(())
}

/// Draws pictures in a browser, by tests among these packages.
pub(crate) fn run_tests(selection: &[&str]) -> Result {
    run(
        &root(),
        "cargo",
        &[&["test"][..], selection, &["--test", "browser", "--", "--ignored", "--nocapture"]].concat(),
    )
}
