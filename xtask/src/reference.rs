//! The reference pages, which the program writes itself.

use crate::run::{Result, output, root};
use std::path::Path;

const PAGE: &str = "docs/reference/shapes.md";

const PROGRAM: [&str; 8] = ["run", "--quiet", "--locked", "-p", "freikugel", "--", "help", "shapes"];

/// Writes the page.
pub(crate) fn write(root: &Path) -> Result {
    let path = root.join(PAGE);
    std::fs::write(&path, page(root)?).map_err(|e| format!("can't write {}: {e}", path.display()))
}

/// Fails if the page is not what [`write()`] would write, or a shape has no picture.
pub(crate) fn check() -> Result {
    let root = root();
    let present = std::fs::read_to_string(root.join(PAGE)).map_err(|e| format!("can't read {PAGE}: {e}"))?;
    if present != page(&root)? {
        return Err(format!("{PAGE} is out of date; run `cargo xtask reference`"));
    }
    let picture = |name: &String| root.join("gallery/reference").join(name).with_extension("png");
    match names(&root)?.into_iter().find(|name| !picture(name).is_file()) {
        Some(name) => Err(format!("gallery/reference has no picture of {name}; run `cargo xtask gallery`")),
        None => Ok(()),
    }
}

fn page(root: &Path) -> Result<String> {
    output(root, "cargo", &[&PROGRAM[..], &["--markdown"]].concat())
}

/// The names of all shapes.
pub(crate) fn names(root: &Path) -> Result<Vec<String>> {
    let list = output(root, "cargo", &PROGRAM)?;
    let name = |line: &str| line.strip_prefix("  ")?.split_whitespace().next().map(str::to_owned);
    Ok(list.lines().filter_map(name).collect())
}
