//! Scenes that name files.

use freikugel_field::{Field, ParamKind};
use freikugel_scene::{Files, Folder, Reading, read, read_with};
use std::collections::HashMap;
use std::path::Path;

/// Files by their names.
#[derive(Clone, Debug, Default)]
struct Kept(HashMap<&'static str, Vec<u8>>);

impl Files for Kept {
    fn contents(&self, name: &str) -> Result<Vec<u8>, String> {
        self.0.get(name).cloned().ok_or_else(|| "there is none".into())
    }
}

const FONT: &[u8] = include_bytes!("../../field/assets/NotoSans-Regular.ttf");

fn kept() -> Kept {
    Kept(HashMap::from([
        ("line.csv", b"x,y,z\n0,0,0\n1,0,0\n1,1,0\n".to_vec()),
        ("short.csv", b"0,0,0\n1,0\n".to_vec()),
        ("empty.csv", b"# none\n".to_vec()),
        ("letter.svg", b"<svg xmlns='http://www.w3.org/2000/svg'><rect width='2' height='1'/></svg>".to_vec()),
        ("words.txt", "Ähre\n".into()),
        ("font.ttf", FONT.to_vec()),
        ("bytes.bin", vec![0xFF, 0xFE, 0x00]),
    ]))
}

fn scene(shape: &str) -> String {
    format!("{{ \"objects\": [ {{ \"shape\": {shape} }} ] }}")
}

fn shape(reading: Reading) -> Field {
    reading.into_result().expect("a sound scene").objects[0].shape.clone()
}

#[test]
fn lists_may_stand_in_files() {
    for (by_file, written, file) in [
        (
            r#"{ "tube": { "radius": 0.1, "points": { "file": "line.csv" } } }"#,
            r#"{ "tube": { "radius": 0.1, "points": [[0, 0, 0], [1, 0, 0], [1, 1, 0]] } }"#,
            "line.csv",
        ),
        (
            r#"{ "extrude": { "height": 1, "shape": { "svg": { "picture": { "file": "letter.svg" } } } } }"#,
            r#"{ "extrude": { "height": 1, "shape": { "svg": { "picture":
                "<svg xmlns='http://www.w3.org/2000/svg'><rect width='2' height='1'/></svg>" } } } }"#,
            "letter.svg",
        ),
        (
            r#"{ "extrude": { "height": 1, "shape": { "text": { "size": 1, "text": { "file": "words.txt" } } } } }"#,
            r#"{ "extrude": { "height": 1, "shape": { "text": { "size": 1, "text": "Ähre\n" } } } }"#,
            "words.txt",
        ),
    ] {
        let reading = read_with(&scene(by_file), kept());
        assert_eq!(reading.files, [file]);
        let (one, other) = (shape(reading), shape(read(&scene(written))));
        let numbers = |field: &Field| -> Vec<Vec<f64>> {
            let inner = field.node().children.iter().map(|child| child.node().numbers());
            std::iter::once(field.node().numbers()).chain(inner).collect()
        };
        assert_eq!(numbers(&one), numbers(&other), "{by_file}");
    }
}

#[test]
fn a_font_makes_a_text_an_outline() {
    let with_font = r#"{ "extrude": { "height": 1, "shape":
        { "text": { "size": 1, "text": "ab", "font": { "file": "font.ttf" } } } } }"#;
    let reading = read_with(&scene(with_font), kept());
    assert_eq!(reading.files, ["font.ttf"]);
    let outline = shape(reading).node().children[0].clone();
    assert_eq!(outline.node().shape.about.params[0].kind, ParamKind::Contours);
}

#[test]
fn what_is_wrong_with_a_file_is_said_where_it_is_named() {
    let tube = |points: &str| format!(r#"{{ "tube": {{ "radius": 0.1, "points": {points} }} }}"#);
    let text = |font: &str| format!(r#"{{ "text": {{ "size": 1, "text": "a中", "font": {font} }} }}"#);
    for (shape, message, place) in [
        (tube(r#"{ "file": "none.csv" }"#), "can't read `none.csv`: there is none", r#""none.csv""#),
        (tube(r#"{ "file": "short.csv" }"#), "has no 3 numbers on line 2", r#"{ "file": "short.csv" }"#),
        (tube(r#"{ "file": "empty.csv" }"#), "must have an entry", r#"{ "file": "empty.csv" }"#),
        (tube(r#"{ "file": "bytes.bin" }"#), "is no text", r#"{ "file": "bytes.bin" }"#),
        (tube(r#"{ "file": 7 }"#), "`file` must be a text, not a number", "7"),
        (tube(r#"{ "name": "line.csv" }"#), "has no key `name`", r#""name""#),
        (text(r#"{ "file": "words.txt" }"#), "is no TrueType or OpenType font", r#"{ "file": "words.txt" }"#),
        (text(r#"{ "file": "font.ttf" }"#), "has no letter '中'", r#"{ "file": "font.ttf" }"#),
        (text(r#""font.ttf""#), "`font` must be a file, not a text", r#""font.ttf""#),
    ] {
        let json = scene(&shape);
        let reading = read_with(&json, kept());
        assert!(reading.scene.is_none(), "{shape}");
        let found = reading.diagnostics.iter().find(|diagnostic| diagnostic.message.contains(message));
        let found = found.unwrap_or_else(|| panic!("{shape}: {:?}", reading.diagnostics));
        assert_eq!(&json[found.span.clone()], place, "{shape}");
    }
}

#[test]
fn a_text_alone_has_no_files_and_a_folder_has_its_own() {
    let json = scene(r#"{ "tube": { "radius": 0.1, "points": { "file": "line.csv" } } }"#);
    let reading = read(&json);
    assert!(reading.diagnostics[0].message.contains("without files"), "{}", reading.diagnostics[0].message);

    let folder = std::env::temp_dir().join(format!("freikugel-files-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("line.csv"), "0 0 0\n1 1 1\n").expect("a file");
    let reading = read_with(&json, Folder::of(Path::new(&folder.join("scene.json"))));
    std::fs::remove_dir_all(&folder).expect("the folder is removed");
    assert_eq!(shape(reading).node().args.len(), 2 + 6);
}
