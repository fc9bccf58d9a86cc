//! What is wrong, or doubtful, with a field.

use crate::field::Origin;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The field works, but perhaps not as meant.
    Warning,
    /// The field can't be used.
    Error,
}

/// One fault of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// What it is, as a sentence without the full stop.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
    /// The node it is about.
    pub origin: Origin,
    /// The parameter of that node it is about.
    pub param: Option<usize>,
}

impl std::fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Origin::Code(location) = self.origin {
            write!(f, "{location}: ")?;
        }
        f.write_str(match self.severity {
            Severity::Warning => "warning: ",
            Severity::Error => "error: ",
        })?;
        f.write_str(&self.message)?;
        if let Some(hint) = &self.hint {
            write!(f, " ({hint})")?;
        }
        Ok(())
    }
}
