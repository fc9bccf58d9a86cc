//! Parameters of shapes: how each [`ParamKind`] is written.

use crate::files::{FileNotation, rows_of};
use crate::notation::{
    Notation, are_keyframes, count_schema, direction_schema, index_of, keyed, keyframes_reference, named_direction,
    number_schema, number_schema_with, numbers_schema, tidy, tidy_degrees,
};
use crate::ply;
use crate::reader::{Reader, span};
use crate::schema::Definitions;
use crate::suggest::listed;
use crate::syntax::Written;
use freikugel_field::ParamKind;
use serde_json::{Value as Json, json};

/// What is wrong with a list parameter that lists nothing.
const NO_ENTRIES: &str = "must have an entry";

/// The numbers of one parameter, as a node holds them.
impl Notation<Vec<f64>> for ParamKind {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Vec<f64>> {
        let numbers = match (*self, value) {
            (
                Self::Text | Self::Points2 | Self::Points3 | Self::HalfSpaces | Self::Balls | Self::Weighted,
                Written::Object(_),
            ) => in_file(reader, *self, value)?,
            (Self::Number | Self::Length | Self::Positive | Self::Factor | Self::Count(..), _) => {
                vec![reader.number(value)?]
            }
            (Self::Angle, _) => vec![reader.number(value)?.to_radians()],
            (Self::Choice(names), _) => vec![choice(reader, names, value)? as f64],
            (Self::Flag, Written::BooleanLit(literal)) => vec![f64::from(u8::from(literal.value))],
            (Self::Flag, _) => {
                reader.mistyped(value, "`true` or `false`", None);
                return None;
            }
            (Self::Direction, Written::StringLit(name)) => {
                named_direction(reader, value, &name.value)?.to_array().to_vec()
            }
            (Self::Size | Self::Counts(..), Written::Object(_)) if are_keyframes(value) => either(reader, value, 3)?,
            (Self::Size2, Written::Object(_)) if are_keyframes(value) => either(reader, value, 2)?,
            (Self::Size, Written::NumberLit(_) | Written::StringLit(_)) => vec![reader.number(value)?; 3],
            (Self::Size, Written::Array(_)) | (Self::Vector | Self::Direction | Self::Lengths | Self::Factors, _) => {
                reader.numbers(value, ["x", "y", "z"])?.to_vec()
            }
            (Self::Counts(..), Written::NumberLit(_) | Written::StringLit(_)) => vec![reader.number(value)?; 3],
            (Self::Counts(..), Written::Array(_)) => reader.numbers(value, ["x", "y", "z"])?.to_vec(),
            (Self::Counts(..), _) => {
                reader.mistyped(value, "a whole number or a list of 3 whole numbers, [x, y, z]", None);
                return None;
            }
            (Self::Size2, Written::NumberLit(_) | Written::StringLit(_)) => vec![reader.number(value)?; 2],
            (Self::Size2, Written::Array(_)) => reader.numbers(value, ["x", "y"])?.to_vec(),
            (Self::Size2, _) => {
                reader.mistyped(value, "a number or a list of 2 numbers, [x, y]", None);
                return None;
            }
            (Self::Size, _) => {
                reader.mistyped(value, "a number or a list of 3 numbers, [x, y, z]", None);
                return None;
            }
            (Self::Angles, _) => reader.numbers(value, ["x", "y", "z"])?.map(f64::to_radians).to_vec(),
            (Self::Quaternion, _) => reader.numbers(value, ["x", "y", "z", "w"])?.to_vec(),
            (Self::Quadruple, _) => reader.numbers(value, ["real", "i", "j", "k"])?.to_vec(),
            (Self::Matrix, _) => rows(reader, value)?,
            (Self::Region, _) => region(reader, value)?,
            (Self::HalfSpaces, _) => entries(reader, value, "half-spaces, [x, y, z, d]", ["x", "y", "z", "d"])?,
            (Self::Contours, _) => contours(reader, value)?,
            (Self::Knots, _) => knots(reader, value)?,
            (Self::Numbers, Written::Array(array)) => {
                each(reader, &array.elements, "entry", |reader, _, number| Some(vec![reader.number(number)?]))?
            }
            (Self::Numbers, _) => {
                reader.mistyped(value, "a list of numbers", None);
                return None;
            }
            (Self::Net, _) => net(reader, value, "points, [x, y, z]", ["x", "y", "z"])?,
            (Self::WeightedNet, _) => {
                net(reader, value, "points with a weight, [x, y, z, weight]", ["x", "y", "z", "weight"])?
            }
            (Self::Text, Written::StringLit(text)) => characters(&text.value),
            (Self::Text, _) => {
                reader.mistyped(value, "a text", None);
                return None;
            }
            (Self::Balls, _) => {
                entries(reader, value, "points with a radius, [x, y, z, radius]", ["x", "y", "z", "radius"])?
            }
            (Self::Weighted, _) => {
                entries(reader, value, "points with a weight, [x, y, z, weight]", ["x", "y", "z", "weight"])?
            }
            (Self::Points3, _) => entries(reader, value, "points, [x, y, z]", ["x", "y", "z"])?,
            (Self::Points2, _) => entries(reader, value, "points, [x, y]", ["x", "y"])?,
        };
        let fault = if numbers.is_empty() { Some(NO_ENTRIES.into()) } else { ParamKind::fault(*self, &numbers) };
        reader.sound(value, numbers, fault)
    }

    fn write(&self, value: &Vec<f64>) -> Option<Json> {
        let first = *value.first()?;
        Some(match *self {
            Self::Number | Self::Length | Self::Positive | Self::Factor | Self::Count(..) => tidy(first),
            Self::Angle => tidy_degrees(first),
            Self::Angles => value.iter().map(|&angle| tidy_degrees(angle)).collect(),
            Self::Choice(names) => {
                let name = *names.get(first as usize)?;
                name.parse().map_or_else(|_| json!(name), tidy)
            }
            Self::Flag => json!(first != 0.0),
            Self::Region => match *value.as_slice() {
                [1.0, radius, ..] => json!({ "sphere": tidy(radius) }),
                [2.0, ref size @ ..] => json!({ "box": list(size) }),
                _ => return None,
            },
            Self::HalfSpaces | Self::Balls | Self::Weighted => value.chunks(4).map(list).collect(),
            Self::Points2 => value.chunks(2).map(list).collect(),
            Self::Points3 | Self::Matrix => value.chunks(3).map(list).collect(),
            Self::Text => json!(value.iter().filter_map(|&code| char::from_u32(code as u32)).collect::<String>()),
            Self::Contours => {
                let corner = |c: &[f64]| match c[2] {
                    0.0 => list(&c[..2]),
                    turn => json!([tidy(c[0]), tidy(c[1]), tidy_degrees(turn)]),
                };
                let corners: Vec<&[f64]> = value.chunks(4).collect();
                let lines: Vec<Json> = corners
                    .split_inclusive(|c| c[3] != 0.0)
                    .map(|line| line.iter().map(|c| corner(c)).collect())
                    .collect();
                match lines.len() {
                    1 => lines.into_iter().next()?,
                    _ => Json::Array(lines),
                }
            }
            Self::Knots if value.len() == 1 => json!(Self::KNOTS.get(first as usize)?),
            Self::Knots => list(&value[1..]),
            Self::Net | Self::WeightedNet => {
                let last = self.width() - 1;
                let points: Vec<&[f64]> = value.chunks(self.width()).collect();
                let rows = points.split_inclusive(|point| point[last] != 0.0);
                rows.map(|row| row.iter().map(|point| list(&point[..last])).collect::<Json>()).collect()
            }
            Self::Vector
            | Self::Direction
            | Self::Size
            | Self::Size2
            | Self::Lengths
            | Self::Counts(..)
            | Self::Factors
            | Self::Quaternion
            | Self::Quadruple
            | Self::Numbers => list(value),
        })
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        let factor = || number_schema_with(json!({ "not": { "const": 0 } }));
        let length = || number_schema_with(json!({ "exclusiveMinimum": 0 }));
        let numbers = || json!({ "type": "array", "items": number_schema(), "minItems": 1 });
        let three = |item: Json| json!({ "type": "array", "items": item, "minItems": 3, "maxItems": 3 });
        match *self {
            Self::Number | Self::Angle => number_schema(),
            Self::Length => number_schema_with(json!({ "minimum": 0 })),
            Self::Positive => length(),
            Self::Factor => factor(),
            Self::Count(least, most) => count_schema(least, most),
            Self::Choice(names) => {
                let numbers = names.iter().filter_map(|name| name.parse().ok()).map(tidy);
                let numbers = numbers.filter(|_| are_numbers(names));
                json!({ "enum": names.iter().map(|name| json!(name)).chain(numbers).collect::<Vec<_>>() })
            }
            Self::Flag => json!({ "type": "boolean" }),
            Self::Vector | Self::Angles => numbers_schema(3),
            Self::Direction => direction_schema(),
            Self::Size => json!({ "anyOf": [length(), three(length()), keyframes_reference(3)] }),
            Self::Counts(least, most) => {
                json!({ "anyOf": [count_schema(least, most), three(count_schema(least, most)), keyframes_reference(3)] })
            }
            Self::Size2 => {
                let two = json!({ "type": "array", "items": length(), "minItems": 2, "maxItems": 2 });
                json!({ "anyOf": [length(), two, keyframes_reference(2)] })
            }
            Self::Factors => json!({ "anyOf": [three(factor()), keyframes_reference(3)] }),
            Self::Lengths => {
                json!({ "anyOf": [three(number_schema_with(json!({ "minimum": 0 }))), keyframes_reference(3)] })
            }
            Self::Matrix => three(numbers_schema(3)),
            Self::Quaternion | Self::Quadruple => numbers_schema(4),
            Self::Region => {
                let one = |name: &str, value: Json| {
                    json!({ "type": "object", "properties": { name: value }, "required": [name],
                        "additionalProperties": false })
                };
                json!({ "anyOf": [
                    one("sphere", length()),
                    one("box", json!({ "anyOf": [length(), three(length()), keyframes_reference(3)] })),
                ] })
            }
            Self::HalfSpaces | Self::Balls | Self::Weighted | Self::Points3 | Self::Points2 => {
                let list = json!({ "type": "array", "items": numbers_schema(self.width()), "minItems": 1 });
                json!({ "anyOf": [list, FileNotation.schema(definitions)] })
            }
            Self::Numbers => numbers(),
            Self::Knots => json!({ "anyOf": [{ "enum": Self::KNOTS }, numbers()] }),
            Self::Net | Self::WeightedNet => {
                let row = json!({ "type": "array", "items": numbers_schema(self.width() - 1), "minItems": 2 });
                json!({ "type": "array", "items": row, "minItems": 2 })
            }
            Self::Text => json!({ "anyOf": [{ "type": "string", "minLength": 1 }, FileNotation.schema(definitions)] }),
            Self::Contours => {
                let corner = json!({ "type": "array", "items": number_schema(), "minItems": 2, "maxItems": 3 });
                let line = || json!({ "type": "array", "items": corner, "minItems": 2 });
                json!({ "anyOf": [line(), { "type": "array", "items": line(), "minItems": 1 }] })
            }
        }
    }
}

fn list(numbers: &[f64]) -> Json {
    numbers.iter().map(|&number| tidy(number)).collect()
}

/// Keyframes of numbers that stand for all of `count` sides, or of lists of as many numbers.
fn either(reader: &mut Reader, value: &Written<'_>, count: usize) -> Option<Vec<f64>> {
    let frames = value.as_object().and_then(|object| object.get_array("keyframes"));
    let first = frames.and_then(|frames| frames.elements.first()?.as_array()?.elements.get(1));
    if let Some(Written::Array(_)) = first {
        return keyed(reader, value, Some(&["x", "y", "z"][..count]));
    }
    Some(keyed(reader, value, None)?.repeat(count))
}

/// The place of a choice among its names.
fn choice(reader: &mut Reader, names: &'static [&'static str], value: &Written<'_>) -> Option<usize> {
    match value {
        Written::StringLit(name) => index_of(reader, value, &name.value, names.iter().copied()),
        Written::NumberLit(literal) if are_numbers(names) => {
            let number = reader.number(value)?;
            let index = names.iter().position(|name| name.parse() == Ok(number));
            index.or_else(|| index_of(reader, value, literal.value, names.iter().copied()))
        }
        _ => {
            reader.mistyped(value, &format!("one of {}", listed(names.iter().copied())), None);
            None
        }
    }
}

/// Whether all names of a choice are numbers, which may then stand without quotes.
fn are_numbers(names: &[&str]) -> bool {
    names.iter().all(|name| name.parse::<f64>().is_ok())
}

/// The numbers of a list that stands in a file: a text as it is, points and planes as rows of numbers, points also as vertices of
/// a PLY file.
fn in_file(reader: &mut Reader, kind: ParamKind, value: &Written<'_>) -> Option<Vec<f64>> {
    let contents = FileNotation.read(reader, value)?;
    let mut refuse = |fault: String| reader.error(span(value), format!("the file of {} {fault}", reader.label()), None);
    if kind != ParamKind::Text && ply::is_ply(&contents) {
        if !matches!(kind, ParamKind::Points2 | ParamKind::Points3 | ParamKind::Balls) {
            refuse("is a PLY file, which holds points".into());
            return None;
        }
        return ply::vertices(&contents, kind.width()).map_err(refuse).ok();
    }
    let Ok(text) = std::str::from_utf8(&contents) else {
        refuse("is no text".into());
        return None;
    };
    if kind == ParamKind::Text {
        return Some(characters(text));
    }
    rows_of(text, kind.width()).map_err(refuse).ok()
}

/// A text by the numbers of its characters.
fn characters(text: &str) -> Vec<f64> {
    text.chars().map(|c| f64::from(u32::from(c))).collect()
}

/// A sphere or a box around the origin.
fn region(reader: &mut Reader, value: &Written<'_>) -> Option<Vec<f64>> {
    let hint = r#"for instance { "sphere": 2 } or { "box": [2, 2, 1] }"#;
    if !matches!(value, Written::Object(_)) {
        reader.mistyped(value, "a sphere or a box", Some(hint.into()));
        return None;
    }
    let entries = reader.entries(value, &["sphere", "box"])?;
    match (entries.get("sphere"), entries.get("box")) {
        (Some(radius), None) => Some(vec![1.0, reader.number(radius)?, 0.0, 0.0]),
        (None, Some(size)) => {
            let mut numbers = vec![2.0];
            numbers.extend(ParamKind::Size.read(reader, size)?);
            Some(numbers)
        }
        _ => {
            reader.error(span(value), "either a sphere or a box must stand here", Some(hint.into()));
            None
        }
    }
}

/// A matrix: a list of three rows.
fn rows(reader: &mut Reader, value: &Written<'_>) -> Option<Vec<f64>> {
    match value {
        Written::Array(array) if array.elements.len() == 3 => {
            entries(reader, value, "rows, [x, y, z]", ["x", "y", "z"])
        }
        _ => {
            reader.mistyped(value, "a list of 3 rows, [x, y, z] each", None);
            None
        }
    }
}

/// A closed line, or a list of several: lists of corners, [x, y] or [x, y, angle].
fn contours(reader: &mut Reader, value: &Written<'_>) -> Option<Vec<f64>> {
    const WHAT: &str = "a list of corners, [x, y] or [x, y, angle] each, or a list of such lists";
    let Written::Array(array) = value else {
        reader.mistyped(value, WHAT, None);
        return None;
    };
    // What holds lists of lists holds several lines.
    let is_line = |value: &Written<'_>| match value {
        Written::Array(line) => line.elements.first().is_some_and(|first| matches!(first, Written::Array(_))),
        _ => false,
    };
    if !array.elements.iter().any(is_line) {
        return contour(reader, value);
    }
    each(reader, &array.elements, "line", |reader, _, line| contour(reader, line))
}

/// A closed line: a list of corners.
fn contour(reader: &mut Reader, value: &Written<'_>) -> Option<Vec<f64>> {
    let Written::Array(array) = value else {
        reader.mistyped(value, "a list of corners, [x, y] or [x, y, angle] each", None);
        return None;
    };
    if array.elements.len() < 2 {
        reader.error(span(value), "a line has at least two corners", None);
        return None;
    }
    each(reader, &array.elements, "corner", |reader, number, element| {
        let [x, y, degrees] = match element {
            Written::Array(parts) if parts.elements.len() == 3 => reader.numbers(element, ["x", "y", "angle"])?,
            _ => reader.numbers(element, ["x", "y"]).map(|[x, y]| [x, y, 0.0])?,
        };
        Some(vec![x, y, degrees.to_radians(), f64::from(u8::from(number == array.elements.len()))])
    })
}

/// Knots: one of their names, or a list of numbers, as a node holds them.
fn knots(reader: &mut Reader, value: &Written<'_>) -> Option<Vec<f64>> {
    let names = ParamKind::KNOTS;
    match value {
        Written::StringLit(name) => Some(vec![index_of(reader, value, &name.value, names.iter().copied())? as f64]),
        Written::Array(array) => {
            let knots = each(reader, &array.elements, "entry", |reader, _, knot| Some(vec![reader.number(knot)?]))?;
            Some([&[(names.len() + knots.len()) as f64], &knots[..]].concat())
        }
        _ => {
            reader.mistyped(value, &format!("{} or a list of numbers", listed(names.iter().copied())), None);
            None
        }
    }
}

/// A net: a list of rows, which are lists of points.
fn net<const N: usize>(
    reader: &mut Reader,
    value: &Written<'_>,
    what: &str,
    names: [&'static str; N],
) -> Option<Vec<f64>> {
    let Written::Array(array) = value else {
        reader.mistyped(value, &format!("a list of rows, which are lists of {what} each"), None);
        return None;
    };
    each(reader, &array.elements, "row", |reader, _, row| {
        let points = entries(reader, row, what, names)?;
        if points.is_empty() {
            reader.error(span(row), format!("{} has no points", reader.label()), None);
            return None;
        }
        let last = points.len() / N;
        let point = |(number, point): (usize, &[f64])| [point, &[f64::from(u8::from(number == last))]].concat();
        Some((1..).zip(points.chunks(N)).flat_map(point).collect())
    })
}

/// A list of entries that are lists of numbers themselves.
fn entries<const N: usize>(
    reader: &mut Reader,
    value: &Written<'_>,
    what: &str,
    names: [&'static str; N],
) -> Option<Vec<f64>> {
    let Written::Array(array) = value else {
        reader.mistyped(value, &format!("a list of {what} each"), None);
        return None;
    };
    each(reader, &array.elements, "entry", |reader, _, entry| Some(reader.numbers(entry, names)?.to_vec()))
}

/// The numbers of all elements of a list, each with its number, counted from 1, as a label. All are read, also after a fault.
fn each<'a>(
    reader: &mut Reader,
    elements: &'a [Written<'a>],
    what: &str,
    read: impl Fn(&mut Reader, usize, &'a Written<'a>) -> Option<Vec<f64>>,
) -> Option<Vec<f64>> {
    let outer = reader.label().to_string();
    let mut numbers = Some(Vec::new());
    for (number, element) in (1..).zip(elements) {
        let own = reader.labelled(format!("{what} {number} of {outer}"), |reader| read(reader, number, element));
        match (&mut numbers, own) {
            (Some(numbers), Some(own)) => numbers.extend(own),
            _ => numbers = None,
        }
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::{Notation, ParamKind, Reader};
    use crate::files::NoFiles;
    use crate::names::Inputs;
    use crate::syntax::parse;
    use serde_json::json;

    fn read(kind: ParamKind, text: &str) -> Result<Vec<f64>, String> {
        let mut reader = Reader::new(NoFiles, &Inputs::default());
        let value = parse(text, &mut reader.diagnostics).expect("JSON");
        kind.read(&mut reader, &value).ok_or_else(|| reader.diagnostics[0].message.clone())
    }

    #[test]
    fn values_are_stored_as_nodes_want_them() {
        const ORDER: ParamKind = ParamKind::Choice(&["2", "3"]);
        for (kind, text, numbers) in [
            (ParamKind::Angle, "180", vec![std::f64::consts::PI]),
            (ParamKind::Angles, "[0, 0, 180]", vec![0.0, 0.0, std::f64::consts::PI]),
            (ParamKind::Direction, "\"-y\"", vec![0.0, -1.0, 0.0]),
            (ParamKind::Direction, "[1, 2, 3]", vec![1.0, 2.0, 3.0]),
            (ParamKind::Size, "2", vec![2.0; 3]),
            (ParamKind::Size2, "2", vec![2.0; 2]),
            (ParamKind::Points2, "[[1, 2], [3, 4], [5, 6]]", vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
            (ParamKind::Counts(1, 9), "3", vec![3.0; 3]),
            (ParamKind::Counts(1, 9), "[1, 2, 3]", vec![1.0, 2.0, 3.0]),
            (ParamKind::Size2, "[2, 3]", vec![2.0, 3.0]),
            (ParamKind::Flag, "true", vec![1.0]),
            (ParamKind::Quaternion, "[0, 0, 0, 1]", vec![0.0, 0.0, 0.0, 1.0]),
            (ParamKind::HalfSpaces, "[[1, 0, 0, 1], [0, 1, 0, 2]]", vec![1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 2.0]),
            (ORDER, "\"3\"", vec![1.0]),
            (ORDER, "3", vec![1.0]),
            (ORDER, "2.0", vec![0.0]),
            (ParamKind::Count(1, 8), "8", vec![8.0]),
            (ParamKind::Quadruple, "[0, 0, 0, 0]", vec![0.0; 4]),
            (ParamKind::Knots, "\"pieces\"", vec![1.0]),
            (ParamKind::Knots, "[0, 0, 0.5, 2]", vec![6.0, 0.0, 0.0, 0.5, 2.0]),
        ] {
            assert_eq!(read(kind, text), Ok(numbers), "{kind:?} {text}");
        }
        for (kind, text) in [
            (ORDER, "4"),
            (ORDER, "true"),
            (ParamKind::Choice(&["x", "y"]), "0"),
            (ParamKind::Flag, "1"),
            (ParamKind::Count(1, 8), "0"),
            (ParamKind::Count(1, 8), "9"),
            (ParamKind::Count(1, 8), "2.5"),
            (ParamKind::Counts(1, 8), "[1, 2, 9]"),
            (ParamKind::Counts(1, 8), "[1, 2, 2.5]"),
            (ParamKind::Vector, "\"x\""),
            (ParamKind::Factors, "[1, 0, 1]"),
            (ParamKind::Lengths, "[1, 0, -1]"),
            (ParamKind::Quaternion, "[0, 0, 0, 0]"),
            (ParamKind::Matrix, "[[1, 0, 0], [0, 1, 0]]"),
            (ParamKind::Matrix, "[1, 0, 0, 0, 1, 0, 0, 0, 1]"),
            (ParamKind::Matrix, "[[1, 2, 3], [4, 5, 6], [7, 8, 9]]"),
            (ParamKind::Knots, "\"odd\""),
            (ParamKind::Knots, "3"),
            (ParamKind::Knots, "[0, 2, 1]"),
            (ParamKind::Knots, "[0, [1]]"),
            (ParamKind::Net, "[[1, 2, 3], [4, 5, 6]]"),
            (ParamKind::Net, "[[[1, 2, 3], [4, 5, 6]]]"),
            (ParamKind::Net, "[[[1, 2, 3]], [[4, 5, 6]]]"),
            (ParamKind::Net, "[[[1, 2, 3], [4, 5, 6]], [[4, 5, 6]]]"),
            (ParamKind::Net, "[[[1, 2, 3], [4, 5, 6]], []]"),
            (ParamKind::WeightedNet, "[[[1, 2, 3, 1], [4, 5, 6, 0]], [[1, 2, 3, 1], [4, 5, 6, 1]]]"),
            (ParamKind::Contours, "[[1, 2], [3, 4, 360]]"),
            (ParamKind::Contours, "[[1, 2]]"),
            (ParamKind::Contours, "[[[1, 2], [3, 4, 90]], [1, 2]]"),
            (ParamKind::Contours, "[[1, 2], [3, 4, 90, 1]]"),
        ] {
            assert!(read(kind, text).is_err(), "{kind:?} {text}");
        }
    }

    #[test]
    fn what_is_written_is_read_back() {
        for (kind, written) in [
            (ParamKind::Angle, json!(30)),
            (ParamKind::Angles, json!([10, 20.5, 33])),
            (ParamKind::Choice(&["x", "y"]), json!("y")),
            (ParamKind::Flag, json!(false)),
            (ParamKind::Size, json!([1, 2, 3])),
            (ParamKind::HalfSpaces, json!([[1, 0, 0, 0.5]])),
            (ParamKind::Numbers, json!([1, 0.5, -2])),
            (ParamKind::Points2, json!([[1, 0], [0.5, 2], [0, 1]])),
            (ParamKind::Points3, json!([[1, 0, 0.5], [0.5, 2, 3]])),
            (ParamKind::Matrix, json!([[1, 0.5, 0], [0, 1, -2], [0, 0, 1]])),
            (ParamKind::Balls, json!([[1, 0, 0.5, 0], [0.5, 2, 3, 0.25]])),
            (ParamKind::Weighted, json!([[1, 0, 0.5, 1], [0.5, 2, 3, 0.25]])),
            (ParamKind::Knots, json!("even")),
            (ParamKind::Knots, json!([0, 0, 0.5, 2.25])),
            (ParamKind::Net, json!([[[1, 0, 0.5], [2, 0, 0]], [[0, 1, 0], [2, 2, 3]], [[0, 4, 0], [2, 4, -1]]])),
            (ParamKind::WeightedNet, json!([[[1, 0, 0.5, 1], [2, 0, 0, 2]], [[0, 1, 0, 1], [2, 2, 3, 0.5]]])),
            (ParamKind::Text, json!("Grüße\n")),
            (ParamKind::Contours, json!([[1, 0], [0.5, 2, 90], [0, 1]])),
            (ParamKind::Contours, json!([[[1, 0, 180], [0.5, 2]], [[0, 1], [1, 1], [2, 2, -30.5]]])),
        ] {
            let numbers = read(kind, &written.to_string()).expect("it is sound");
            assert_eq!(kind.write(&numbers), Some(written));
        }
    }
}
