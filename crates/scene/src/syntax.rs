//! The JSON layer: from text to a tree of values with their places.
//!
//! Files are JSON with comments (`//` and `/* */`), and nothing else beyond JSON. Where a text goes beyond it in a way
//! that leaves no doubt what is meant (a comma too many, single quotes, ...), each kind of trespass is reported and the
//! text is read all the same, so that mistakes further in come out in the same run.

use crate::diagnostic::{Diagnostic, Severity};
use jsonc_parser::errors::{ParseError, ParseErrorKind};
use jsonc_parser::{CollectOptions, ParseOptions, ParseStringErrorKind, parse_to_ast};
use std::ops::Range;

/// A value as it stands in the text.
pub(crate) use jsonc_parser::ast::Value as Written;

/// How many brackets may enclose a value: deeper text would exhaust the stack of a small thread. The parser counts an
/// object in an object twice and has a limit of 512 of its own, which this one keeps out of reach.
pub(crate) const DEEPEST: usize = 256;

/// The value a text holds, unless it is beyond understanding.
pub(crate) fn parse<'a>(text: &'a str, diagnostics: &mut Vec<Diagnostic>) -> Option<Written<'a>> {
    if let Err(fault) = scan(text) {
        diagnostics.push(fault);
        return None;
    }
    let error = match read(text, &ParseOptions { allow_comments: true, ..STRICT }) {
        Ok(Some(value)) => return Some(value),
        Ok(None) => {
            diagnostics.push(Diagnostic {
                severity: Severity::Error,
                message: "the file holds nothing".into(),
                hint: Some("a scene is an object: { \"objects\": [ ... ] }".into()),
                span: 0..0,
            });
            return None;
        }
        Err(error) => error,
    };
    let Ok(Some(value)) = read(text, &ParseOptions::default()) else {
        diagnostics.push(explain(text, &error));
        return None;
    };
    for strict_in in RELAXATIONS {
        let mut options = ParseOptions::default();
        *strict_in(&mut options) = false;
        if let Err(error) = read(text, &options) {
            diagnostics.push(explain(text, &error));
        }
    }
    Some(value)
}

/// JSON as the standard has it.
const STRICT: ParseOptions = ParseOptions {
    allow_comments: false,
    allow_loose_object_property_names: false,
    allow_trailing_commas: false,
    allow_missing_commas: false,
    allow_single_quoted_strings: false,
    allow_hexadecimal_numbers: false,
    allow_unary_plus_numbers: false,
    allow_bare_decimal_point_numbers: false,
    allow_non_finite_numbers: false,
    allow_extended_string_escapes: false,
};

/// The ways in which the parser can read more than JSON, other than comments.
const RELAXATIONS: [fn(&mut ParseOptions) -> &mut bool; 9] = [
    |options| &mut options.allow_loose_object_property_names,
    |options| &mut options.allow_trailing_commas,
    |options| &mut options.allow_missing_commas,
    |options| &mut options.allow_single_quoted_strings,
    |options| &mut options.allow_hexadecimal_numbers,
    |options| &mut options.allow_unary_plus_numbers,
    |options| &mut options.allow_bare_decimal_point_numbers,
    |options| &mut options.allow_non_finite_numbers,
    |options| &mut options.allow_extended_string_escapes,
];

fn read<'a>(text: &'a str, options: &ParseOptions) -> Result<Option<Written<'a>>, ParseError> {
    parse_to_ast(text, &CollectOptions::default(), options).map(|result| result.value)
}

/// Finds what the parser lets pass: nesting that is too deep, texts that run over lines, blanks that JSON does not know.
fn scan(text: &str) -> Result<(), Diagnostic> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let start = at;
        at += 1;
        match byte {
            b'{' | b'[' => {
                depth += 1;
                if depth > DEEPEST {
                    let message = format!("brackets are nested more than {DEEPEST} deep here");
                    return Err(fault(message, "join nested unions into one", start..at));
                }
            }
            b'}' | b']' => depth = depth.saturating_sub(1),
            b'"' => at = scan_string(bytes, start)?,
            b'/' if bytes.get(at) == Some(&b'/') => {
                at += bytes[at..].iter().take_while(|b| !matches!(b, b'\n' | b'\r')).count();
            }
            b'/' if bytes.get(at) == Some(&b'*') => {
                at = text[at + 1..].find("*/").map_or(text.len(), |end| at + 1 + end + 2);
            }
            0x0b | 0x0c | 0x80.. => {
                let c = text[start..].chars().next().unwrap_or_default();
                at = start + c.len_utf8();
                if c.is_whitespace() {
                    let message = format!("U+{:04X} is not a blank that JSON knows", u32::from(c));
                    return Err(fault(message, "put an ordinary space there", start..at));
                }
            }
            _ => {}
        }
    }
    Ok(())
}

/// The end of the string that starts at `start`.
fn scan_string(bytes: &[u8], start: usize) -> Result<usize, Diagnostic> {
    let mut at = start + 1;
    loop {
        match bytes.get(at) {
            Some(b'"') => return Ok(at + 1),
            Some(b'\\') => at += 2,
            Some(b'\n' | b'\r') | None => {
                let end = at.min(bytes.len());
                return Err(fault("this text has no end".into(), "close it with \", or one before it", start..end));
            }
            Some(&byte @ ..0x20) => {
                let message = format!("a text holds the control character U+{byte:04X}");
                return Err(fault(message, &format!("write it as \\u{byte:04x}"), at..at + 1));
            }
            Some(_) => at += 1,
        }
    }
}

fn fault(message: String, hint: &str, span: Range<usize>) -> Diagnostic {
    Diagnostic { severity: Severity::Error, message, hint: Some(hint.into()), span }
}

const NOT_FINITE: (&str, &str) = ("every number must be finite", "");

/// The parser's error in our words.
fn explain(text: &str, error: &ParseError) -> Diagnostic {
    use ParseErrorKind as Kind;
    let Range { start, end } = error.range().start..error.range().end;
    let (message, hint) = match error.kind() {
        Kind::CommentsNotAllowed => ("comments are not allowed here", ""),
        Kind::ExpectedColonAfterObjectKey => ("there is no `:` after this key", "write \"key\": value"),
        Kind::ExpectedObjectValue => ("this key has no value", "write \"key\": value"),
        Kind::ExpectedDigit
        | Kind::ExpectedDigitFollowingNegativeSign
        | Kind::ExpectedPlusMinusOrDigitInNumberLiteral => ("this number lacks a digit", ""),
        Kind::ExpectedStringObjectProperty => ("this key is not in quotes", "write \"key\": value"),
        Kind::ExpectedComma => ("there is no comma here", "put one between a value and what follows it"),
        Kind::MultipleRootJsonValues => {
            ("the scene ends before this", "remove the rest, or one bracket too many before it")
        }
        Kind::BareDecimalPointNumbersNotAllowed => ("this number has no digit beside its point", "write 0.5 or 5"),
        Kind::HexadecimalNumbersNotAllowed => ("JSON has no hexadecimal numbers", "write it in decimals"),
        Kind::UnaryPlusNumbersNotAllowed => ("a number does not start with +", "leave it out"),
        Kind::NonFiniteNumbersNotAllowed => NOT_FINITE,
        Kind::SingleQuotedStringsNotAllowed => ("a text stands in double quotes", "write \" for '"),
        Kind::TrailingCommasNotAllowed => ("nothing follows this comma", "leave it out"),
        Kind::String(ParseStringErrorKind::UnterminatedStringLiteral) => ("this text has no end", "close it with \""),
        Kind::String(ParseStringErrorKind::ExpectedFourHexDigits) => ("\\u is followed by four hexadecimal digits", ""),
        Kind::String(ParseStringErrorKind::InvalidUnicodeEscapeSequence(_)) => ("no character has this number", ""),
        Kind::String(_) => ("JSON has no such escape sequence", "write \\\\ for a backslash"),
        Kind::UnexpectedCloseBrace => ("a value is expected before this `}`", ""),
        Kind::UnexpectedCloseBracket => ("a value is expected before this `]`", ""),
        Kind::UnexpectedColon => ("a value is expected before this `:`", ""),
        Kind::UnexpectedComma => ("a value is expected before this comma", ""),
        Kind::UnexpectedWord if ["NaN", "Infinity"].contains(&&text[start..end]) => NOT_FINITE,
        Kind::UnexpectedWord => ("this is no JSON value", "texts stand in double quotes"),
        Kind::UnexpectedTokenInObject => ("a key is expected here, in double quotes", "write \"key\": value"),
        Kind::UnterminatedArray => ("this `[` is never closed", ""),
        Kind::UnterminatedObject => ("this `{` is never closed", ""),
        Kind::UnterminatedCommentBlock => ("this comment has no end", "close it with */"),
        Kind::NestingDepthExceeded => ("brackets are nested too deep here", ""),
        Kind::UnexpectedToken => ("this is no JSON", ""),
    };
    Diagnostic {
        severity: Severity::Error,
        message: message.into(),
        hint: (!hint.is_empty()).then(|| hint.into()),
        span: start..end,
    }
}
