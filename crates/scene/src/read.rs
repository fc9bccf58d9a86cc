//! Reading scene files.

use crate::diagnostic::{Diagnostic, Severity};
use crate::files::{Files, NoFiles};
use crate::named::are_too_large;
use crate::names::{Inputs, TIME};
use crate::notation::Notation;
use crate::parameter::report_unused;
use crate::reader::{Reader, span};
use crate::record::Record;
use crate::scene::Scene;
use crate::schema::Definitions;
use crate::syntax::{Written, parse};
use freikugel_field::{Origin, analyse, analyse_together};
use serde_json::{Value as Json, json};

/// What reading a scene file gave.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The scene, if there was no error.
    pub scene: Option<Scene>,
    /// All mistakes, in the order of their places.
    pub diagnostics: Vec<Diagnostic>,
    /// The names of the files that were read for it.
    pub files: Vec<String>,
    /// Whether the time stands in one of its formulas.
    pub uses_time: bool,
}

impl Reading {
    /// The scene, warnings aside.
    ///
    /// # Errors
    /// All mistakes, if one of them is an error.
    pub fn into_result(self) -> Result<Scene, Vec<Diagnostic>> {
        self.scene.ok_or(self.diagnostics)
    }
}

/// The version of the format that this program reads and writes.
pub const VERSION: u32 = 1;

/// Reads a scene file.
///
/// Files are JSON, and may hold comments (`//` and `/* */`). All mistakes are reported at once, each once, with its place;
/// only text whose structure can't be made out (an unclosed bracket, nesting deeper than [`MOST_NESTED`]) ends the search.
///
/// ```
/// let text = r#"{ "objects": [ { "shape": { "sphere": { "radios": 1 } } } ] }"#;
/// let reading = freikugel_scene::read(text);
/// assert!(reading.scene.is_none());
/// assert_eq!(reading.diagnostics[0].hint.as_deref(), Some("did you mean `radius`?"));
/// assert_eq!(&text[reading.diagnostics[0].span.clone()], "\"radios\"");
/// ```
pub fn read(text: &str) -> Reading {
    read_with(text, NoFiles)
}

/// Reads a scene file that may name other files: fonts, pictures, lists of points. See [`read()`].
pub fn read_with(text: &str, files: impl Files + 'static) -> Reading {
    read_at(text, files, &Inputs::default())
}

/// Reads a scene file with other values for its parameters, and at a time. See [`read()`].
pub fn read_at(text: &str, files: impl Files + 'static, inputs: &Inputs) -> Reading {
    // Some editors begin a file with a byte order mark, which is no part of the JSON.
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reading = read_body(body, Reader::new(files, inputs));
    for diagnostic in &mut reading.diagnostics {
        let shift = text.len() - body.len();
        diagnostic.span = diagnostic.span.start + shift..diagnostic.span.end + shift;
    }
    reading
}

/// How many brackets may enclose a value in a scene file; two are spent on a shape within a shape.
pub const MOST_NESTED: usize = crate::syntax::DEEPEST;

fn read_body(text: &str, mut reader: Reader) -> Reading {
    let Some(root) = parse(text, &mut reader.diagnostics) else {
        return nothing(reader.diagnostics);
    };
    if let Some(newer) = newer_version(&root) {
        return nothing(vec![newer]);
    }
    let scene = reader.labelled("the scene".into(), |reader| Scene::read(reader, &root));
    analyse_roots(&mut reader);
    report_unused(&mut reader, &root);
    let uses_time = reader.names.is_used(TIME);
    let mut diagnostics = std::mem::take(&mut reader.diagnostics);
    diagnostics.sort_by_key(|diagnostic| diagnostic.span.start);
    // A shape with a name is looked at wherever it is used.
    diagnostics.dedup();
    let is_sound = diagnostics.iter().all(|diagnostic| diagnostic.severity != Severity::Error);
    Reading { scene: scene.filter(|_| is_sound), diagnostics, files: reader.into_files(), uses_time }
}

/// What reading gives where there is nothing to read.
fn nothing(diagnostics: Vec<Diagnostic>) -> Reading {
    Reading { scene: None, diagnostics, files: Vec::new(), uses_time: false }
}

/// What to say of a file for a newer program: nothing else in it can be judged.
fn newer_version(root: &Written<'_>) -> Option<Diagnostic> {
    let value = &root.as_object()?.get("version")?.value;
    let version: u32 = value.as_number_lit()?.value.parse().ok()?;
    (version > VERSION).then(|| Diagnostic {
        severity: Severity::Error,
        message: format!("this scene has version {version}, but this program knows only {VERSION}"),
        hint: Some("get a newer Freikugel".into()),
        span: span(value),
    })
}

/// Reports what the fields say of themselves, in terms of the document.
fn analyse_roots(reader: &mut Reader) {
    let (roots, named) = (std::mem::take(&mut reader.roots), std::mem::take(&mut reader.named));
    if are_too_large(reader, &roots) {
        return;
    }
    let alone = named.iter().map(|field| analyse(field).1);
    let together = analyse_together(&roots).into_iter().map(|(_, faults)| faults);
    for faults in alone.chain(together) {
        for fault in faults {
            let Origin::Document(index) = fault.origin else {
                continue;
            };
            let Some(node) = reader.nodes.get(index as usize) else {
                continue;
            };
            let param = fault.param.and_then(|param| node.params.get(param)?.clone());
            let place = param.unwrap_or_else(|| node.name.clone());
            reader.report(fault.severity, place, fault.message, fault.hint);
        }
    }
}

/// The notation of the format's version.
pub(crate) struct VersionNotation;

impl Notation<()> for VersionNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<()> {
        let Written::NumberLit(_) = value else {
            reader.mistyped(value, "a number", None);
            return None;
        };
        let version = reader.number(value)?;
        if version != f64::from(VERSION) {
            reader.error(span(value), format!("`version` must be {VERSION}"), None);
        }
        Some(())
    }

    fn write(&self, (): &()) -> Option<Json> {
        Some(json!(VERSION))
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        json!({ "const": VERSION })
    }
}
