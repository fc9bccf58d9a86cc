//! Files that a scene names: fonts, pictures, lists of points.

use crate::notation::Notation;
use crate::reader::{Reader, span};
use crate::schema::Definitions;
use crate::suggest::quote;
use crate::syntax::Written;
use serde_json::{Value as Json, json};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where the files come from that a scene names.
pub trait Files: fmt::Debug {
    /// The contents of the file that a scene calls `name`.
    ///
    /// # Errors
    /// Why there are none.
    fn contents(&self, name: &str) -> Result<Vec<u8>, String>;
}

/// No files at all, for scenes that are nothing but a text.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl Files for NoFiles {
    fn contents(&self, _name: &str) -> Result<Vec<u8>, String> {
        Err("this scene is read without files beside it".into())
    }
}

/// The files of a folder, to which names are relative.
#[derive(Clone, Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// The folder of this path.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self(path.into())
    }

    /// The folder that a file lies in.
    pub fn of(file: &Path) -> Self {
        Self(file.parent().unwrap_or(Path::new("")).to_owned())
    }

    /// Where the file is that a scene in this folder calls `name`.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Files for Folder {
    fn contents(&self, name: &str) -> Result<Vec<u8>, String> {
        std::fs::read(self.path(name)).map_err(|error| error.to_string())
    }
}

/// The contents of a file, in the place of a value: `{ "file": NAME }`.
pub(crate) struct FileNotation;

impl Notation<Arc<[u8]>> for FileNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Arc<[u8]>> {
        if !matches!(value, Written::Object(_)) {
            reader.mistyped(value, "a file", Some(r#"for instance { "file": "name.suffix" }"#.into()));
            return None;
        }
        let entries = reader.entries(value, &["file"])?;
        let named = entries.require(reader, "file", "the name of the file")?;
        let Written::StringLit(name) = named else {
            reader.labelled(quote("file"), |reader| reader.mistyped(named, "a text", None));
            return None;
        };
        let contents = reader.contents(&name.value).map_err(|fault| {
            let hint = "names of files are relative to the folder of the scene";
            reader.error(span(named), format!("can't read {}: {fault}", quote(&name.value)), Some(hint.into()));
        });
        contents.ok()
    }

    fn write(&self, _contents: &Arc<[u8]>) -> Option<Json> {
        None
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        let about = "The name of a file, relative to the folder of the scene.";
        definitions.define("file", |_| {
            json!({
                "type": "object",
                "properties": { "file": { "type": "string", "description": about } },
                "required": ["file"],
                "additionalProperties": false,
            })
        })
    }
}

/// The rows of `width` numbers in a text: one on each line, with blanks, commas or semicolons between them. Empty lines, what
/// follows a `#`, and a first line of words are left out; so are further numbers of a row.
///
/// # Errors
/// The line that is none, as the end of a sentence.
pub(crate) fn rows_of(text: &str, width: usize) -> Result<Vec<f64>, String> {
    let mut numbers = Vec::new();
    let mut is_first = true;
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split('#').next().unwrap_or_default();
        let is_between = |c: char| c.is_whitespace() || c == ',' || c == ';';
        let words: Vec<&str> = line.split(is_between).filter(|word| !word.is_empty()).collect();
        let row: Vec<f64> = words.iter().map_while(|word| word.parse().ok()).filter(|n: &f64| n.is_finite()).collect();
        if words.is_empty() {
            continue;
        }
        let is_heading = is_first && row.is_empty();
        is_first = false;
        if row.len() >= width {
            numbers.extend_from_slice(&row[..width]);
        } else if !is_heading {
            return Err(format!("has no {width} numbers on line {number}: {}", quote(line.trim())));
        }
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::rows_of;

    #[test]
    fn rows_are_read_in_all_usual_forms() {
        for text in ["1 2 3\n4 5 6", "x,y,z\n1,2,3\n4,5,6\n", "# points\n1;2;3 # first\n\n 4\t5\t6 255 0 0\r\n"] {
            assert_eq!(rows_of(text, 3), Ok(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), "{text:?}");
        }
    }

    #[test]
    fn what_is_no_row_is_named() {
        for text in ["1 2 3\n4 5", "1 2 3\n\n4 nan 6", "1 2", "x y z\na b c"] {
            let fault = rows_of(text, 3).expect_err(text);
            let line = text.lines().count();
            assert!(fault.contains(&format!("line {line}")), "{fault}");
        }
    }
}
