//! The reference page, which the program writes itself, and the page of all its pictures.

use crate::run::{Result, freikugel, root};
use std::fmt::Write;
use std::path::Path;

const PAGE: &str = "docs/reference/shapes.md";

const GALLERY: &str = "gallery/README.md";

/// So many pictures stand side by side.
const IN_A_ROW: usize = 6;

/// Writes both pages.
pub(crate) fn write(root: &Path) -> Result {
    for (path, text) in pages(&|args| freikugel(root, args))? {
        std::fs::write(root.join(path), text).map_err(|e| format!("can't write {path}: {e}"))?;
    }
    Ok(())
}

/// What the command prints for some arguments.
pub(crate) type Ask<'a> = &'a dyn Fn(&[&str]) -> Result<String>;

/// Fails if the pages are not what [`write()`] would write, or a shape has no picture.
pub(crate) fn check(ask: Ask<'_>) -> Result {
    let root = root();
    for (path, text) in pages(ask)? {
        let present = std::fs::read_to_string(root.join(path)).map_err(|e| format!("can't read {path}: {e}"))?;
        if present != text {
            return Err(format!("{path} is out of date; run `cargo xtask reference`"));
        }
    }
    let picture = |name: &String| root.join("gallery/reference").join(name).with_extension("png");
    match names(ask)?.into_iter().find(|name| !picture(name).is_file()) {
        Some(name) => Err(format!("gallery/reference has no picture of {name}; run `cargo xtask gallery`")),
        None => Ok(()),
    }
}

/// The paths of both pages, and what they should hold.
fn pages(ask: Ask<'_>) -> Result<[(&'static str, String); 2]> {
    let page = ask(&["help", "shapes", "--markdown"])?;
    let gallery = gallery(&page);
    Ok([(PAGE, page), (GALLERY, gallery)])
}

/// The pictures of all shapes of the reference, in its groups.
fn gallery(page: &str) -> String {
    let mut text = String::from(
        "# Gallery\n\nA picture of each shape; they lead to the [reference](../docs/reference/shapes.md). Pictures of scenes are in \
         the other folders here. Written by `cargo xtask reference`.\n",
    );
    for group in page.split("\n## ").skip(1) {
        let _ = write!(text, "\n## {}\n\n", group.lines().next().unwrap_or_default());
        text.push_str(&format!("{}|\n{}|\n", "| ".repeat(IN_A_ROW), "|---".repeat(IN_A_ROW)));
        let names: Vec<&str> = group.lines().filter_map(|line| line.strip_prefix("### ")).collect();
        for row in names.chunks(IN_A_ROW) {
            for name in row {
                let _ = write!(text, "| [![](reference/{name}.png)<br>{name}](../{PAGE}#{name}) ");
            }
            text.push_str("|\n");
        }
    }
    text
}

/// The names of all shapes.
pub(crate) fn names(ask: Ask<'_>) -> Result<Vec<String>> {
    let list = ask(&["help", "shapes"])?;
    let name = |line: &str| line.strip_prefix("  ")?.split_whitespace().next().map(str::to_owned);
    Ok(list.lines().filter_map(name).collect())
}
