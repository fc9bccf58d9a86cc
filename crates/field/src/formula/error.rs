//! What is wrong with the text of a formula.

use std::fmt;
use std::ops::Range;

/// A mistake in a text, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormulaError {
    /// What it is, as a sentence without the full stop.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
    /// The place, as a range of bytes in the text.
    pub span: Range<usize>,
    /// The character the place starts with, from 1.
    pub column: usize,
}

impl FormulaError {
    /// A mistake at `span` of `text`.
    pub(super) fn new(text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let column = text[..span.start].chars().count() + 1;
        Self { message: message.into(), hint: None, span, column }
    }

    /// The same with a hint.
    pub(super) fn hint(self, hint: impl Into<String>) -> Self {
        Self { hint: Some(hint.into()), ..self }
    }
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "column {}: {}", self.column, self.message)?;
        match &self.hint {
            Some(hint) => write!(f, " ({hint})"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for FormulaError {}
