//! The benchmark's command, as a user meets it.

use freikugel::field::Kind as ShapeKind;
use freikugel_bench::scattered::{Kind, Light, scene};
use std::process::{Command, Output};

fn run(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_freikugel-bench")).args(args).output().expect("the command runs")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

#[test]
fn a_filter_chooses_the_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let json = folder.path().join("figures.json");
    let path = json.to_str().expect("a path in UTF-8");
    let output = run(&["--filter", "gyroid", "--runs", "1", "--json", path]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = stdout(&output);
    let rows: Vec<&str> = text.lines().filter(|line| line.contains("M points/s")).collect();
    assert!(rows[0].starts_with("| gyroid in a sphere"), "{text}");
    assert!(rows.iter().any(|row| row.contains("fidget JIT")), "{text}");
    let figures: serde_json::Value = serde_json::from_slice(&std::fs::read(&json).expect("written")).expect("JSON");
    assert_eq!(figures["rows"].as_array().map(Vec::len), Some(1));
    for contender in figures["rows"][0]["contenders"].as_array().expect("contenders") {
        assert!(contender["figure"].as_f64().expect("a figure") > 0.0, "{contender}");
    }
}

#[test]
fn missing_models_are_reported_and_are_no_failure() {
    let output = run(&["--filter", "prospero", "--runs", "1", "--threads", "1"]);
    assert!(output.status.success());
    assert!(stdout(&output).contains("no folder of models: --data DIR"), "{}", stdout(&output));
}

#[test]
fn the_growth_table_measures_in_a_process_of_its_own() {
    let output = run(&["--filter", "growth: 100 rounded", "--runs", "1", "--threads", "1"]);
    assert!(output.status.success());
    let line = stdout(&output).lines().last().expect("a line").to_owned();
    assert!(line.starts_with("| 100 | ") && line.ends_with(" MB |"), "{line}");
}

#[test]
fn scenes_of_many_primitives_are_sound_and_always_the_same() {
    for kind in [Kind::Boxes, Kind::Spheres, Kind::Mixed] {
        for (blend, light) in [(None, Light::Ambient), (Some(0.05), Light::Ambient), (None, Light::Sun)] {
            let text = scene(50, kind, blend, light);
            assert_eq!(text, scene(50, kind, blend, light));
            let scene = freikugel::scene::read(&text).into_result().expect("a sound scene");
            let primitives: usize = scene
                .objects
                .iter()
                .map(|object| freikugel::field::analyse(&object.shape).0.expect("sound").primitives)
                .sum();
            // The floor is one more.
            let floors = usize::from(light == Light::Sun);
            assert_eq!(primitives, 50 + floors);
            match blend {
                None => assert_eq!(scene.objects.len(), 50 + floors),
                Some(_) => {
                    let node = scene.objects[0].shape.node();
                    assert!(matches!(node.shape.kind, ShapeKind::Combine(_)));
                    assert_eq!(node.children.len(), 50);
                }
            }
        }
    }
    assert_ne!(scene(50, Kind::Boxes, None, Light::Ambient), scene(51, Kind::Boxes, None, Light::Ambient));
    let output = run(&["scene", "50", "--kind", "mixed", "--blend", "0.05"]);
    assert_eq!(stdout(&output), scene(50, Kind::Mixed, Some(0.05), Light::Ambient));
    assert!(!run(&["scene", "0"]).status.success());
    assert!(!run(&["scene", "5", "--blend", "-1"]).status.success());
}
