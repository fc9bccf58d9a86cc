//! The list of shapes, written from the files in the shapes folder.

use crate::run::{Result, root};
use std::fmt::Write;
use std::path::Path;

const LIST: &str = "crates/field/src/shapes.rs";
const FOLDER: &str = "crates/field/src/shapes";

const HEAD: &str = "\
//! All shapes, one file each.
//!
//! Written by `cargo xtask shapes` from the files in the folder of the same name. To add a shape, write its file and run
//! that command.

";

/// Writes the list.
pub(crate) fn write(root: &Path) -> Result {
    let path = root.join(LIST);
    std::fs::write(&path, list(root)?).map_err(|e| format!("can't write {}: {e}", path.display()))
}

/// Fails if the list is not what [`write()`] would write.
pub(crate) fn check() -> Result {
    let root = root();
    let present = std::fs::read_to_string(root.join(LIST)).map_err(|e| format!("can't read {LIST}: {e}"))?;
    if present == list(&root)? { Ok(()) } else { Err(format!("{LIST} is out of date; run `cargo xtask shapes`")) }
}

fn list(root: &Path) -> Result<String> {
    let folder = root.join(FOLDER);
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("can't read {FOLDER}: {e}"))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| e.to_string())?.path();
        let Some(name) = path.file_stem().and_then(|name| name.to_str()) else {
            continue;
        };
        let text = std::fs::read_to_string(&path).map_err(|e| format!("can't read {}: {e}", path.display()))?;
        // A reserved word can still name a module.
        let module = if name == "box" { "r#box".to_owned() } else { name.to_owned() };
        files.push((module, descriptors(&text)));
    }
    files.sort();

    let mut out = HEAD.to_owned();
    for (module, shapes) in &files {
        let visibility = if shapes.is_empty() { "" } else { "pub " };
        let _ = writeln!(out, "{visibility}mod {module};");
    }
    out.push('\n');
    for (module, _) in files.iter().filter(|(_, shapes)| !shapes.is_empty()) {
        let _ = writeln!(out, "pub use {module}::*;");
    }
    out.push_str(
        "\nuse crate::shape::Shape;\n\n/// The descriptors of all shapes, by name.\npub static ALL: &[&Shape] = &[\n",
    );
    for shape in files.iter().flat_map(|(_, shapes)| shapes) {
        let _ = writeln!(out, "    &{shape},");
    }
    out.push_str("];\n");
    Ok(out)
}

/// The names of the descriptors a file declares.
fn descriptors(text: &str) -> Vec<String> {
    text.lines()
        .filter_map(|line| line.strip_prefix("pub static ")?.split_once(": Shape"))
        .map(|(name, _)| name.to_owned())
        .collect()
}
