//! What the documentation shows: its scenes are sound, and its commands say what stands there.

use freikugel::scene::{Files, Inputs, Severity, read_at};
use serde_json::{Value as Json, json};
use std::path::{Path, PathBuf};
use std::process::Command;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// The blocks of a language in a document.
fn blocks(name: &str, language: &str) -> Vec<String> {
    let text = std::fs::read_to_string(docs().join(name)).expect("a document");
    let fence = format!("```{language}\n");
    text.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap_or_default().to_owned()).collect()
}

/// Files that examples name: any picture, points and font.
#[derive(Debug)]
struct Samples;

impl Files for Samples {
    fn contents(&self, name: &str) -> Result<Vec<u8>, String> {
        let contents = match Path::new(name).extension().and_then(|suffix| suffix.to_str()) {
            Some("svg") => {
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><circle cx="4" cy="4" r="3"/></svg>"#
            }
            Some("ply") => {
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n"
            }
            _ => return Err(format!("{name} is no file of an example")),
        };
        Ok(contents.into())
    }
}

/// A whole scene around a piece of one: an object if there is none, and the object around a shape.
fn whole(piece: Json) -> Json {
    let ball = json!({ "sphere": { "radius": 1 } });
    let keys: Vec<&str> = piece.as_object().expect("an object").keys().map(String::as_str).collect();
    const PARTS: [&str; 9] =
        ["objects", "materials", "lights", "ambient", "occlusion", "camera", "picture", "tracer", "parameters"];
    if !keys.iter().any(|key| PARTS.contains(key)) {
        return json!({ "objects": [ { "shape": piece } ] });
    }
    let mut scene = piece;
    if scene.get("objects").is_none() {
        scene["objects"] = json!([ { "shape": ball } ]);
    }
    scene
}

#[test]
fn all_scenes_in_the_documents_are_sound() {
    let mut count = 0;
    for name in ["scenes.md", "formulas.md"] {
        for block in blocks(name, "json") {
            let piece: Json = serde_json::from_str(&block).unwrap_or_else(|error| panic!("{name}: {error}\n{block}"));
            let reading = read_at(&whole(piece).to_string(), Samples, &Inputs { time: 0.5, ..Inputs::default() });
            let errors: Vec<_> = reading.diagnostics.iter().filter(|d| d.severity == Severity::Error).collect();
            assert!(errors.is_empty(), "{name}: {errors:?}\n{block}");
            count += 1;
        }
    }
    assert!(count > 25, "{count} scenes");
}

#[test]
fn commands_say_what_stands_in_the_documents() {
    let mut count = 0;
    for name in ["scenes.md", "formulas.md"] {
        for block in blocks(name, "console").into_iter().chain(blocks(name, "")) {
            let Some((line, said)) = block.split_once('\n') else { continue };
            let Some(line) = line.strip_prefix("$ freikugel ") else { continue };
            // The words of these lines are quoted as a whole or not at all.
            let words: Vec<&str> = line
                .split('"')
                .enumerate()
                .flat_map(|(index, part)| match index % 2 {
                    0 => part.split_whitespace().collect::<Vec<_>>(),
                    _ => vec![part],
                })
                .collect();
            let output = Command::new(env!("CARGO_BIN_EXE_freikugel")).args(&words).output().expect("the command runs");
            let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
            assert_eq!(format!("{out}{err}"), said, "{name}: {line}");
            count += 1;
        }
    }
    assert!(count >= 3, "{count} commands");
}
