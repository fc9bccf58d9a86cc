//! Points in PLY files (Turk, "The PLY Polygon File Format", 1994): text, or binary in either order of bytes.

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// What these files begin with.
const MAGIC: &[u8] = b"ply";

/// The element that points are.
const VERTEX: &str = "vertex";

/// The numbers that a vertex may have here.
const PROPERTIES: [&str; 4] = ["x", "y", "z", "radius"];

/// Whether this is a PLY file.
pub(crate) fn is_ply(contents: &[u8]) -> bool {
    contents.strip_prefix(MAGIC).is_some_and(|rest| rest.starts_with(b"\n") || rest.starts_with(b"\r"))
}

/// The first `width` of x, y, z and radius of each vertex.
///
/// # Errors
/// What is wrong with the file, as the end of a sentence.
pub(crate) fn vertices(contents: &[u8], width: usize) -> Result<Vec<f64>, String> {
    let wanted = &PROPERTIES[..width];
    let broken = |error: ply_rs_bw::parser::ParseError| format!("is no sound PLY file: {error}");
    let mut reader = Reader::new(contents);
    let header = Parser::<Vertex>::new().read_header(&mut reader).map_err(broken)?;
    let Some(vertex) = header.elements.get(VERTEX) else {
        return Err("is a PLY file without vertices".into());
    };
    if let Some(missing) = wanted.iter().find(|&&name| !vertex.properties.contains_key(name)) {
        return Err(format!("is a PLY file whose vertices have no `{missing}`"));
    }
    for before in header.elements.values().take_while(|element| element.name != VERTEX) {
        Parser::<Passed>::new().read_payload_for_element(&mut reader, before, &header).map_err(broken)?;
    }
    let vertices = Parser::<Vertex>::new().read_payload_for_element(&mut reader, vertex, &header).map_err(broken)?;
    let rows = || vertices.iter().map(|Vertex(numbers)| &numbers[..width]);
    match rows().position(|row| !row.iter().all(|number| number.is_finite())) {
        Some(index) => Err(format!("is a PLY file whose vertex {} is not finite", index + 1)),
        None => Ok(rows().flatten().copied().collect()),
    }
}

/// The numbers of a vertex; what is not among [`PROPERTIES`] is left out.
#[derive(Debug, Default)]
struct Vertex([f64; PROPERTIES.len()]);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let number = match property {
            Property::Char(number) => number.into(),
            Property::UChar(number) => number.into(),
            Property::Short(number) => number.into(),
            Property::UShort(number) => number.into(),
            Property::Int(number) => number.into(),
            Property::UInt(number) => number.into(),
            Property::Float(number) => number.into(),
            Property::Double(number) => number,
            _ => return PropertyAccessResult::Ignored,
        };
        let Some(place) = PROPERTIES.iter().position(|&known| known == name) else {
            return PropertyAccessResult::Ignored;
        };
        self.0[place] = number;
        PropertyAccessResult::Set
    }
}

/// What stands before the vertices.
#[derive(Debug, Default)]
struct Passed;

impl PropertyAccess for Passed {
    fn new() -> Self {
        Self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str =
        "element vertex 2\nproperty float x\nproperty double y\nproperty uchar red\nproperty short z\nend_header\n";

    fn text(header: &str, body: &str) -> Vec<u8> {
        format!("ply\nformat ascii 1.0\ncomment two points\n{header}{body}").into_bytes()
    }

    fn binary(order: &str, put: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
        let mut file = format!("ply\nformat binary_{order}_endian 1.0\n{HEADER}").into_bytes();
        put(&mut file);
        file
    }

    #[test]
    fn points_are_read_in_all_formats() {
        let expected = Ok(vec![0.5, -1.25, 3.0, 2.0, 4.0, -1.0]);
        let little = binary("little", |file| {
            for (x, y, z) in [(0.5_f32, -1.25_f64, 3_i16), (2.0, 4.0, -1)] {
                file.extend(x.to_le_bytes().into_iter().chain(y.to_le_bytes()).chain([7]).chain(z.to_le_bytes()));
            }
        });
        let big = binary("big", |file| {
            for (x, y, z) in [(0.5_f32, -1.25_f64, 3_i16), (2.0, 4.0, -1)] {
                file.extend(x.to_be_bytes().into_iter().chain(y.to_be_bytes()).chain([7]).chain(z.to_be_bytes()));
            }
        });
        for file in [text(HEADER, "0.5 -1.25 7 3\n2 4 7 -1\n"), little, big] {
            assert!(is_ply(&file));
            assert_eq!(vertices(&file, 3), expected);
            assert_eq!(vertices(&file, 2), Ok(vec![0.5, -1.25, 2.0, 4.0]));
        }
        let after = text(
            "element edge 1\nproperty list uchar int ends\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
            "2 0 0\n1 2 3\n",
        );
        assert_eq!(vertices(&after, 3), Ok(vec![1.0, 2.0, 3.0]));
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (file, width, part) in [
            (text(HEADER, "0.5 -1.25 7 3\n2 4 7 -1\n"), 4, "no `radius`"),
            (text(HEADER, "0.5 -1.25 7 3\n2 4 7\n"), 3, "no sound PLY file"),
            (text(HEADER, "0.5 -1.25 7 3\n"), 3, "no sound PLY file"),
            (text("element face 0\nproperty float x\nend_header\n", ""), 3, "without vertices"),
            (b"ply\nformat odd 1.0\nend_header\n".to_vec(), 3, "no sound PLY file"),
            (binary("little", |file| file.extend([255; 30])), 3, "vertex 1 is not finite"),
        ] {
            let fault = vertices(&file, width).expect_err(part);
            assert!(fault.contains(part), "{fault}, not {part}");
        }
        assert!(!is_ply(b"plywood") && !is_ply(b"1 2 3\n"));
    }
}
