//! Changing single values of a scene file's text, by paths such as `camera.eye[2]`.
//!
//! The text stays what it is, comments and all, but for the value; so diagnostics of the changed text point at places that
//! its author knows. Keys that a file leaves to their defaults can be set as well: they are added.

use crate::diagnostic::Diagnostic;
use crate::suggest::{closest, listed, quote};
use crate::syntax::{Written, parse};
use jsonc_parser::common::Ranged;
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// A way to a value in a scene file: keys, and places in lists from 0.
///
/// ```
/// let path: freikugel_scene::edit::Path = "camera.eye[2]".parse()?;
/// assert_eq!(path.to_string(), "camera.eye[2]");
/// assert_eq!(path.short(), "eye[2]");
/// # Ok::<(), freikugel_scene::edit::PathError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Path {
    steps: Vec<Step>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Step {
    Key(String),
    Place(usize),
}

/// Why a text is no [`Path`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathError {
    text: String,
    fault: &'static str,
}

/// A changed text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edited {
    /// The whole text.
    pub text: String,
    /// If the value was not there before: what is, as a sentence that helps whoever misspelt a key.
    pub added: Option<String>,
}

/// Why a text was not changed.
#[derive(Clone, Debug)]
pub enum EditError {
    /// It is no JSON.
    Text(Vec<Diagnostic>),
    /// The path leads nowhere: what is there instead, as a sentence.
    Path(String),
}

/// The text with another value at `path`, which is JSON.
///
/// # Errors
/// If the text is no JSON, or the path goes through something that has no such part.
pub fn with_value(text: &str, path: &Path, value: &str) -> Result<Edited, EditError> {
    let mut diagnostics = Vec::new();
    let root = parse(text, &mut diagnostics).ok_or(EditError::Text(diagnostics))?;
    let spliced = |range: Range<usize>, by: &str| [&text[..range.start], by, &text[range.end..]].concat();
    let mut at = &root;
    for (index, step) in path.steps.iter().enumerate() {
        let here = || if index == 0 { "the scene".into() } else { format!("`{}`", shown(&path.steps[..index])) };
        at = match (step, at) {
            (Step::Key(key), Written::Object(object)) => {
                let Some(prop) = object.properties.iter().find(|prop| prop.name.as_str() == key) else {
                    let names: Vec<&str> = object.properties.iter().map(|prop| prop.name.as_str()).collect();
                    let sentence = missing(&here(), key, &names);
                    let entry = entry(&path.steps[index..], value).ok_or(EditError::Path(sentence.clone()))?;
                    let comma = if names.is_empty() { "" } else { "," };
                    let start = object.start() + 1;
                    let text = spliced(start..start, &format!(" {entry}{comma}"));
                    return Ok(Edited { text, added: Some(sentence) });
                };
                &prop.value
            }
            (Step::Place(place), Written::Array(array)) => array.elements.get(*place).ok_or_else(|| {
                let count = array.elements.len();
                let holds = match count {
                    0 => "is empty".into(),
                    1 => "has one entry, [0]".into(),
                    _ => format!("has {count} entries, [0] to [{}]", count - 1),
                };
                EditError::Path(format!("there is no [{place}]: {} {holds}", here()))
            })?,
            (Step::Key(key), Written::Array(_)) => {
                let sentence =
                    format!("there is no {}: {} is a list, whose entries are [0], [1], ...", quote(key), here());
                return Err(EditError::Path(sentence));
            }
            (Step::Place(place), Written::Object(object)) => {
                let names = some(object.properties.iter().map(|prop| prop.name.as_str()));
                return Err(EditError::Path(format!("there is no [{place}]: {} is no list, it holds {names}", here())));
            }
            _ => return Err(EditError::Path(format!("{} has no parts", here()))),
        };
    }
    Ok(Edited { text: spliced(at.start()..at.end(), value), added: None })
}

/// What is there instead of a key.
fn missing(here: &str, key: &str, names: &[&str]) -> String {
    let is_not_there = format!("{here} does not write {}", quote(key));
    match closest(key, names.iter().copied()) {
        Some(guess) => format!("{is_not_there}; did you mean `{guess}`?"),
        None if names.is_empty() => format!("{is_not_there}, it is empty"),
        None => format!("{is_not_there}, but {}", some(names.iter().copied())),
    }
}

/// More names than this in a row are not read any more.
const MOST_LISTED: usize = 12;

fn some<'n>(names: impl Iterator<Item = &'n str> + Clone) -> String {
    let more = if names.clone().nth(MOST_LISTED).is_some() { ", ..." } else { "" };
    listed(names.take(MOST_LISTED)) + more
}

/// The entry that an object needs for a path to lead to `value`, unless the path goes through lists.
fn entry(steps: &[Step], value: &str) -> Option<String> {
    let [first, rest @ ..] = steps else { return None };
    let Step::Key(key) = first else { return None };
    let key = serde_json::Value::from(key.as_str());
    Some(match rest {
        [] => format!("{key}: {value}"),
        rest => format!("{key}: {{ {} }}", entry(rest, value)?),
    })
}

fn shown(steps: &[Step]) -> String {
    let mut text = String::new();
    for step in steps {
        match step {
            Step::Place(place) => text += &format!("[{place}]"),
            Step::Key(key) if is_word(key) && text.is_empty() => text += key,
            Step::Key(key) if is_word(key) => text += &format!(".{key}"),
            Step::Key(key) => text += &format!("[{}]", serde_json::Value::from(key.as_str())),
        }
    }
    text
}

/// Whether a key needs no quotes in a path.
fn is_word(key: &str) -> bool {
    !key.is_empty() && !key.contains(['.', '[', ']', '"', '='])
}

impl Path {
    /// The last key and what follows it: a name short enough for a label.
    pub fn short(&self) -> String {
        let last = self.steps.iter().rposition(|step| matches!(step, Step::Key(_))).unwrap_or(0);
        shown(&self.steps[last..])
    }
}

impl FromStr for Path {
    type Err = PathError;

    fn from_str(text: &str) -> Result<Self, PathError> {
        let fault = |fault| PathError { text: text.into(), fault };
        let mut steps = Vec::new();
        let mut rest = text;
        while !rest.is_empty() {
            if let Some(inner) = rest.strip_prefix("[\"") {
                let (key, after) = inner.split_once("\"]").ok_or(fault("a `[\"` lacks its `\"]`"))?;
                steps.push(Step::Key(key.into()));
                rest = after;
            } else if let Some(inner) = rest.strip_prefix('[') {
                let (place, after) = inner.split_once(']').ok_or(fault("a `[` lacks its `]`"))?;
                let place = place.trim().parse().map_err(|_| fault("a place in a list is a whole number"))?;
                steps.push(Step::Place(place));
                rest = after;
            } else {
                let key = match rest.strip_prefix('.') {
                    Some(key) if !steps.is_empty() => key,
                    None if steps.is_empty() => rest,
                    _ => return Err(fault("keys are separated by single points")),
                };
                let end = key.find(['.', '[']).unwrap_or(key.len());
                if !is_word(&key[..end]) {
                    return Err(fault("a key is missing"));
                }
                steps.push(Step::Key(key[..end].into()));
                rest = &key[end..];
            }
        }
        if steps.is_empty() { Err(fault("it is empty")) } else { Ok(Self { steps }) }
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&shown(&self.steps))
    }
}

impl fmt::Display for PathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is no path such as camera.eye[2]: {}", quote(&self.text), self.fault)
    }
}

impl std::error::Error for PathError {}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"{
  // A comment.
  "tracer": { "max_steps": 64 },
  "camera": { "eye": [1, 2, 3] },
  "materials": { "my.clay": { "specular": 0.5 } },
  "lights": [], "picture": {},
  "objects": [ { "shape": { "sphere": { "radius": 1 } } } ]
}"#;

    fn edit(path: &str, value: &str) -> Result<Edited, String> {
        let path: Path = path.parse().map_err(|error: PathError| error.to_string())?;
        with_value(SCENE, &path, value).map_err(|error| match error {
            EditError::Path(sentence) => sentence,
            EditError::Text(diagnostics) => format!("{diagnostics:?}"),
        })
    }

    #[test]
    fn values_are_replaced_where_they_stand() {
        for (path, from, to) in [
            ("tracer.max_steps", "64", "5"),
            ("camera.eye[2]", "3]", "-7.5]"),
            ("objects[0].shape.sphere.radius", "1 }", "2 }"),
            (r#"materials["my.clay"].specular"#, "0.5", "0.25"),
            ("camera.eye", "[1, 2, 3]", "[0, 0, 0]"),
        ] {
            let value = to.trim_end_matches([']', ' ', '}']);
            let value = if to.starts_with('[') { to } else { value };
            assert_eq!(edit(path, value), Ok(Edited { text: SCENE.replacen(from, to, 1), added: None }), "{path}");
        }
    }

    #[test]
    fn missing_keys_are_added_and_what_is_there_is_told() {
        for (path, now, told) in [
            ("tracer.precision", r#""tracer": { "precision": 8, "max_steps": 64 }"#, "but `max_steps`"),
            ("tracer.max_step", r#"{ "max_step": 8, "max_steps": 64 }"#, "did you mean `max_steps`?"),
            ("picture.width", r#""picture": { "width": 8}"#, "it is empty"),
            ("occlusion.reach", "{ \"occlusion\": { \"reach\": 8 },\n  // A comment.", "but `tracer`, `camera`,"),
        ] {
            let edited = edit(path, "8").expect(path);
            assert!(edited.text.contains(now), "{path}: {}", edited.text);
            let added = edited.added.expect("it was not there");
            assert!(added.contains(told), "{path}: {added}");
            serde_json::from_str::<serde_json::Value>(&edited.text.replace("// A comment.", "")).expect("JSON");
        }
    }

    #[test]
    fn wrong_paths_are_explained() {
        for (path, told) in [
            ("objects[1].shape", "there is no [1]: `objects` has one entry, [0]"),
            ("camera.eye[3]", "`camera.eye` has 3 entries, [0] to [2]"),
            ("lights[0]", "`lights` is empty"),
            ("objects.shape", "there is no `shape`: `objects` is a list"),
            ("camera[0]", "`camera` is no list, it holds `eye`"),
            ("tracer.max_steps.more", "`tracer.max_steps` has no parts"),
            ("camera.target[0]", "`camera` does not write `target`, but `eye`"),
            ("", "it is empty"),
            ("a..b", "a key is missing"),
            ("a[x]", "a whole number"),
            ("a[0", "lacks its"),
            ("a[0]b", "separated by single points"),
        ] {
            let sentence = edit(path, "1").expect_err(path);
            assert!(sentence.contains(told), "{path}: {sentence}");
        }
    }

    #[test]
    fn paths_survive_being_written() {
        for text in ["a", "a.b[0].c", "a[0][1]", r#"materials["my.clay"].color"#] {
            let path: Path = text.parse().expect(text);
            assert_eq!(path.to_string(), text);
        }
        let short = |text: &str| text.parse::<Path>().expect(text).short();
        assert_eq!([short("a.b.c"), short("a.b[0][1]"), short("[2]")], ["c", "b[0][1]", "[2]"]);
    }
}
