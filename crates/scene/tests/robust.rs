//! The reader survives everything: no text makes it panic, overflow its stack, or take long.

use freikugel_scene::{MOST_NESTED, Scene, read, report};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::time::{Duration, Instant};

const SCENE: &str = r##"{ "camera": { "eye": [4, -6, 3], "target": [0, 0, 1], "fov": 40 }, // the view
  "lights": [ { "sun": { "direction": [1, -1, 2], "color": "#fff5e0", "shadow": { "hardness": 16 } } } ],
  "materials": { "clay": { "color": "#c8825a", "specular": 0.2 } },
  "objects": [ { "name": "cup", "material": "clay", "shape": { "difference": [
    { "cylinder": { "radius": 1, "height": 2, "round": 0.05 } },
    { "translate": { "by": [0, 0, 0.2], "shape": { "cylinder": { "radius": 0.85, "height": 2 } } } } ] } } ] }"##;

/// Reads a text and prints what is wrong with it; every place must lie in the text.
fn survives(text: &str) {
    let reading = read(text);
    for diagnostic in &reading.diagnostics {
        assert!(diagnostic.span.start <= diagnostic.span.end, "{diagnostic:?}");
        assert!(text.get(diagnostic.span.clone()).is_some(), "{diagnostic:?} lies outside of {text:?}");
    }
    let printed = report(text, "scene.json", &reading.diagnostics, false);
    assert!(printed.len() < 100_000, "{} bytes", printed.len());
    assert_eq!(printed.is_empty(), reading.diagnostics.is_empty());
}

/// The longest that a text of a few megabytes may take in a debug build on a slow machine: a method that takes the square
/// of its length would take hours.
const PATIENCE: Duration = Duration::from_secs(20);

#[test]
fn large_texts_are_read_quickly() {
    let spheres = r#"{ "sphere": { "radius": 1 } },"#.repeat(50_000);
    for (name, text) in [
        ("brackets", "[".repeat(5_000_000)),
        ("braces", "{".repeat(5_000_000)),
        ("nested objects", "{\"a\":".repeat(1_000_000)),
        ("nested pairs", "[{\"a\":".repeat(1_000_000)),
        ("zeros", format!("[{}0]", "0,".repeat(1_000_000))),
        ("a long number", "1".repeat(5_000_000)),
        ("a long text", format!("\"{}\"", "x".repeat(5_000_000))),
        ("an endless text", format!("\"{}", "\\\"".repeat(2_000_000))),
        ("unknown keys", format!("{{{}\"z\": 0}}", "\"camra\": 0,".repeat(100_000))),
        ("duplicate materials", format!("{{\"materials\": {{{}\"z\": 0}}}}", "\"a\": {},".repeat(100_000))),
        ("lines", "\n".repeat(5_000_000)),
        ("comments", "/**/".repeat(1_000_000)),
        ("a wide union", format!(r#"{{ "objects": [ {{ "shape": {{ "union": [ {spheres} 1 ] }} }} ] }}"#)),
        ("zero bytes", "\0".repeat(1_000_000)),
    ] {
        let start = Instant::now();
        survives(&text);
        assert!(start.elapsed() < PATIENCE, "{name}: {:?}", start.elapsed());
    }
}

/// A scene of shapes in shapes, `depth` in all.
fn nested(depth: usize) -> String {
    let (before, after) = (r#"{ "translate": { "by": [0, 0, 1], "shape": "#, " } }");
    let [before, after] = [before, after].map(|part| part.repeat(depth - 1));
    format!(r#"{{ "objects": [ {{ "shape": {before}{{ "sphere": {{ "radius": 1 }} }}{after} }} ] }}"#)
}

#[test]
fn the_deepest_scene_is_read_on_a_small_thread() {
    // Three brackets stand around the outermost shape, and each shape has two.
    let deepest = (MOST_NESTED - 3) / 2;
    let read_in_thread = move |depth| {
        let reading = std::thread::Builder::new().stack_size(1 << 20).spawn(move || {
            let scene: Option<Scene> = read(&nested(depth)).scene;
            scene.map(|scene| scene.check().len())
        });
        reading.expect("a thread").join().expect("no overflow")
    };
    assert_eq!(read_in_thread(deepest), Some(0));
    assert_eq!(read_in_thread(deepest + 1), None);
    assert_eq!(read_in_thread(100_000), None);
}

/// Pieces of scenes, to be put together at random.
fn token() -> impl Strategy<Value = String> {
    prop_oneof![
        proptest::sample::select(vec![
            "{",
            "}",
            "[",
            "]",
            ",",
            ":",
            "\"",
            "'",
            "//",
            "/*",
            "*/",
            "\\",
            "\\u12",
            "\\ud800",
            "-",
            "1e999",
            "0x1",
            "01",
            "NaN",
            "null",
            "true",
            "\n",
            "\r",
            "\u{feff}",
            "\u{a0}",
            "\u{202e}",
            "宽",
            "\"objects\":",
            "\"shape\":",
            "\"sphere\":",
            "\"radius\":",
            "\"union\":",
            "\"paint\":",
            "\"material\":",
            "\"lights\":",
            "\"sun\":",
            "1",
            "-1",
            "{}",
            "[]",
        ])
        .prop_map(str::to_string),
        any::<String>(),
    ]
}

/// Every run tests the same cases: a failure is never a matter of luck.
const SEED: u64 = 1;

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, rng_seed: RngSeed::Fixed(SEED), ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_survived(text in any::<String>()) {
        survives(&text);
    }

    #[test]
    fn any_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        survives(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn any_tokens_are_survived(tokens in prop::collection::vec(token(), 0..40)) {
        survives(&tokens.concat());
    }

    #[test]
    fn broken_scenes_are_survived(
        cuts in prop::collection::vec((any::<prop::sample::Index>(), 0..12_usize, token()), 1..5),
    ) {
        let mut text = SCENE.to_string();
        for (at, length, token) in cuts {
            let start = text.floor_char_boundary(at.index(text.len().max(1)));
            let end = text.floor_char_boundary(start + length);
            text.replace_range(start..end, &token);
        }
        survives(&text);
    }

    /// But for comments and a byte order mark, what is read without errors is JSON for others, too.
    #[test]
    fn what_is_read_is_json(
        at in any::<prop::sample::Index>(),
        length in 0..12_usize,
        token in token(),
    ) {
        let mut text = SCENE.replace("// the view", "");
        let start = text.floor_char_boundary(at.index(text.len()));
        let end = text.floor_char_boundary(start + length);
        text.replace_range(start..end, &token);
        let has_comments = text.contains("//") || text.contains("/*");
        if read(&text).scene.is_some() && !has_comments {
            let other: Result<serde_json::Value, _> = serde_json::from_str(text.trim_start_matches('\u{feff}'));
            prop_assert!(other.is_ok(), "{text}");
        }
    }
}
