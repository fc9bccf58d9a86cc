//! Reading scene files, whatever they turn out to be.

use super::Failure;
use freikugel::scene::{Diagnostic, Reading, Scene, Severity, read, report};
use std::io::{IsTerminal, Read};
use std::path::Path;

/// The largest scene file. A thousand objects take about a quarter of a megabyte.
const MAX_BYTES: u64 = 64 << 20;

/// A scene file's text.
fn text_of(path: &Path) -> Result<String, String> {
    let mut bytes = Vec::new();
    let read = if path == Path::new("-") {
        std::io::stdin().lock().take(MAX_BYTES + 1).read_to_end(&mut bytes)
    } else {
        if path.is_dir() {
            return Err("it is a folder, not a scene file".into());
        }
        std::fs::File::open(path).and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes))
    };
    read.map_err(|error| error.to_string())?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(format!("it is larger than {} MiB, too large for a scene file", MAX_BYTES >> 20));
    }
    String::from_utf8(bytes).map_err(|_| "it is not text in UTF-8, hence no scene file".into())
}

/// Reads a scene, printing all diagnostics to standard error.
pub(super) fn scene(path: &Path) -> Result<Scene, Failure> {
    parsed(&text(path)?, &name(path))
}

/// Reads a scene file's text.
pub(super) fn text(path: &Path) -> Result<String, Failure> {
    text_of(path).map_err(|fault| Failure::Input(format!("can't read {}: {fault}", name(path))))
}

/// What messages call a file.
pub(super) fn name(path: &Path) -> String {
    if path == Path::new("-") { "standard input".into() } else { path.display().to_string() }
}

/// The scene of a text, printing all diagnostics to standard error.
pub(super) fn parsed(text: &str, name: &str) -> Result<Scene, Failure> {
    let Reading { scene, diagnostics } = read(text);
    show(text, name, &diagnostics);
    scene.ok_or_else(|| {
        let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
        Failure::Input(format!("{name} has {errors} error{}", if errors == 1 { "" } else { "s" }))
    })
}

/// Prints diagnostics to standard error.
pub(super) fn show(text: &str, name: &str, diagnostics: &[Diagnostic]) {
    if !diagnostics.is_empty() {
        let color = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
        eprint!("{}", report(text, name, diagnostics, color));
    }
}
