//! What is wrong with a document, as data, and printed with the place it is about.

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use std::ops::Range;

pub use freikugel_field::Severity;

/// One mistake in a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is. A document with an error makes no scene.
    pub severity: Severity,
    /// What is wrong, as a sentence without the full stop.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
    /// The place, as a range of bytes in the text.
    pub span: Range<usize>,
}

/// More diagnostics than these say nothing new to a person: they have one cause.
pub const MOST_REPORTED: usize = 50;

/// Lines up to this many bytes are shown as they are; of a longer one, the surroundings of the place.
const LONGEST_LINE: usize = 1000;

/// How many bytes of a long line are shown on each side of the place.
const SURROUNDINGS: usize = 60;

/// The diagnostics with file, line, column, excerpt and hint, for a person to read.
///
/// `name` is what the text is called, usually its path. With `color`, the result holds escape sequences for a terminal.
/// At most [`MOST_REPORTED`] are shown and the rest counted.
pub fn report(text: &str, name: &str, diagnostics: &[Diagnostic], color: bool) -> String {
    let renderer = if color { Renderer::styled() } else { Renderer::plain() };
    let lines = Lines::of(text);
    let mut report = String::new();
    for diagnostic in diagnostics.iter().take(MOST_REPORTED) {
        report += &renderer.render(&groups(&lines, name, diagnostic));
        report += "\n\n";
    }
    if let Some(rest @ 1..) = diagnostics.len().checked_sub(MOST_REPORTED) {
        report += &format!("and {rest} more\n");
    }
    report
}

fn groups<'a>(lines: &Lines<'a>, name: &'a str, diagnostic: &'a Diagnostic) -> Vec<Group<'a>> {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let hint = diagnostic.hint.as_deref().map(|hint| Level::HELP.message(hint));
    let title = level.clone().primary_title(diagnostic.message.as_str());
    let start = lines.text.floor_char_boundary(diagnostic.span.start);
    let end = lines.text.floor_char_boundary(diagnostic.span.end).max(start);
    let line = lines.at(start);
    let text = lines.line(line);
    // Only the first line of a long value is shown: its beginning says which one it is.
    let [from, to] = [start, end].map(|at| (at - lines.starts[line]).min(text.len()));
    if text.len() <= LONGEST_LINE {
        let excerpt =
            Snippet::source(text).path(name).line_start(line + 1).annotation(AnnotationKind::Primary.span(from..to));
        return vec![title.element(excerpt).elements(hint)];
    }
    let left = text.floor_char_boundary(from.saturating_sub(SURROUNDINGS));
    let right = text.floor_char_boundary(from + SURROUNDINGS);
    let before = if left > 0 { "… " } else { "" };
    let after = if right < text.len() { " …" } else { "" };
    let shift = before.len();
    let excerpt = Snippet::source(format!("{before}{}{after}", &text[left..right]))
        .line_start(line + 1)
        .annotation(AnnotationKind::Primary.span(from - left + shift..to.min(right) - left + shift));
    let column = text[..from].chars().count() + 1;
    vec![
        title.element(Origin::path(name).line(line + 1).char_column(column)),
        Group::with_level(level).element(excerpt).elements(hint),
    ]
}

/// Where the lines of a text start.
pub(crate) struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    pub(crate) fn of(text: &'a str) -> Self {
        let after_breaks = text.bytes().enumerate().filter(|&(_, b)| b == b'\n').map(|(at, _)| at + 1);
        Self { text, starts: std::iter::once(0).chain(after_breaks).collect() }
    }

    /// The line that holds a byte, from 0.
    pub(crate) fn at(&self, byte: usize) -> usize {
        self.starts.partition_point(|&start| start <= byte) - 1
    }

    fn line(&self, line: usize) -> &'a str {
        let end = self.starts.get(line + 1).map_or(self.text.len(), |&next| next - 1);
        self.text[self.starts[line]..end].trim_end_matches('\r')
    }
}
