//! Reading scene files and models, whatever they turn out to be.

use super::Failure;
use freikugel::model::{self, Model, Region};
use freikugel::scene::{self, Diagnostic, Folder, Inputs, Reading, Scene, Severity, report};
use std::io::{IsTerminal, Read};
use std::path::Path;
#[cfg(feature = "gpu")]
use std::path::PathBuf;

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

/// What a file holds.
pub(super) enum Input {
    /// A scene, or a solid made one.
    Scene(Box<Scene>),
    /// A scene of plane figures.
    Figures(Box<Scene>),
    /// A region of the plane.
    Region(Region),
}

/// Reads a scene or, if the file is called `.vm`, a model, printing all diagnostics to standard error.
pub(super) fn read(path: &Path, inputs: &Inputs) -> Result<Input, Failure> {
    let (text, name) = (text(path)?, name(path));
    if !is_model(path) {
        let scene = Box::new(parsed(&text, path, inputs)?);
        return Ok(if scene.is_plane() { Input::Figures(scene) } else { Input::Scene(scene) });
    }
    if !inputs.set.is_empty() {
        return Err(Failure::Usage(format!("{name} is a model, which has no parameters that --set could set")));
    }
    match model::read(&text) {
        Ok(Model::Solid(scene)) => Ok(Input::Scene(scene)),
        Ok(Model::Region(region)) => Ok(Input::Region(region)),
        Err(fault) => {
            show(&text, &name, std::slice::from_ref(&fault));
            Err(faulty(&name, std::slice::from_ref(&fault)))
        }
    }
}

/// What is said of scenes through which no rays can be traced.
const FIGURES: &str = "holds plane figures, through which no rays are traced: give them a height with `extrude`, or draw them with \
                       `freikugel slice`";

/// Whether a file's name says that it holds a model.
pub(super) fn is_model(path: &Path) -> bool {
    path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("vm"))
}

/// Reads a scene, or a model that is a solid.
pub(super) fn scene(path: &Path, inputs: &Inputs) -> Result<Scene, Failure> {
    match read(path, inputs)? {
        Input::Scene(scene) => Ok(*scene),
        Input::Figures(_) => Err(Failure::Input(format!("{} {FIGURES}", name(path)))),
        Input::Region(_) => Err(Failure::Input(format!(
            "{} is a region of the plane, through which no rays are traced: its graph does not use z",
            name(path)
        ))),
    }
}

/// Reads a scene, or a model that is a solid, without printing anything; what is wrong with it comes back as text.
#[cfg(feature = "gpu")]
pub(super) fn scene_or_report(path: &Path, inputs: &Inputs) -> Result<Scene, String> {
    let name = name(path);
    let text = text_of(path).map_err(|fault| format!("can't read {name}: {fault}"))?;
    let (scene, diagnostics) = if is_model(path) {
        match model::read(&text) {
            Ok(Model::Solid(scene)) => (Some(*scene), Vec::new()),
            Ok(Model::Region(_)) => return Err(format!("{name} has become a region of the plane")),
            Err(fault) => (None, vec![fault]),
        }
    } else {
        let Reading { scene, diagnostics, .. } = scene::read_at(&text, Folder::of(path), inputs);
        (scene, diagnostics)
    };
    scene.ok_or_else(|| report(&text, &name, &diagnostics, false))
}

/// Reads a scene file's text.
pub(super) fn text(path: &Path) -> Result<String, Failure> {
    text_of(path).map_err(|fault| Failure::Input(format!("can't read {}: {fault}", name(path))))
}

/// What messages call a file.
pub(super) fn name(path: &Path) -> String {
    if path == Path::new("-") { "standard input".into() } else { path.display().to_string() }
}

/// The scene of a text that is, or stands for, that of the file `path`, printing all diagnostics to standard error.
pub(super) fn parsed(text: &str, path: &Path, inputs: &Inputs) -> Result<Scene, Failure> {
    let Reading { scene, diagnostics, .. } = scene::read_at(text, Folder::of(path), inputs);
    let name = name(path);
    show(text, &name, &diagnostics);
    scene.ok_or_else(|| faulty(&name, &diagnostics))
}

/// The scene's file, and the files that it names, as far as they could be read.
#[cfg(feature = "gpu")]
pub(super) fn files(path: &Path, inputs: &Inputs) -> Vec<PathBuf> {
    let folder = Folder::of(path);
    let text = if is_model(path) { None } else { text_of(path).ok() };
    let named = text.map(|text| scene::read_at(&text, folder.clone(), inputs).files).unwrap_or_default();
    std::iter::once(path.to_owned()).chain(named.iter().map(|name| folder.path(name))).collect()
}

/// Says how many errors a file has.
fn faulty(name: &str, diagnostics: &[Diagnostic]) -> Failure {
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
    Failure::Input(format!("{name} has {errors} error{}", if errors == 1 { "" } else { "s" }))
}

/// Prints diagnostics to standard error.
pub(super) fn show(text: &str, name: &str, diagnostics: &[Diagnostic]) {
    if !diagnostics.is_empty() {
        let color = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
        eprint!("{}", report(text, name, diagnostics, color));
    }
}
