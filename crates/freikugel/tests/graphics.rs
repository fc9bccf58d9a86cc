//! The command with a graphics processor, and without the feature that brings it.

use std::process::{Command, Output};

fn run(folder: &std::path::Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_freikugel"));
    // Not the user's choice, and no screen.
    for variable in ["WGPU_ADAPTER_NAME", "WGPU_BACKEND", "DISPLAY", "WAYLAND_DISPLAY"] {
        command.env_remove(variable);
    }
    command.args(args).current_dir(folder).output().expect("the command runs")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

const BALL: &str = r#"{ "picture": { "width": 40, "height": 30, "samples": 2 },
    "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder for the test");
    std::fs::write(folder.path().join("ball.json"), BALL).expect("can write");
    folder
}

#[test]
fn options_of_the_other_processor_are_refused() {
    let folder = folder();
    for (args, part) in [
        (&["--backend", "gpu", "--simd", "AVX2"][..], "--simd"),
        (&["--backend", "gpu", "--threads", "1"], "--threads"),
        (&["--backend", "gpu", "--tracer", "sphere"], "--tracer"),
        (&["--adapter", "x"], "--adapter"),
    ] {
        let output = run(folder.path(), &[&["render", "ball.json"][..], args].concat());
        // An instruction set that the machine has not is a mistake as well.
        assert_eq!(output.status.code(), Some(2), "{args:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(part) || stderr(&output).contains("instruction set"), "{}", stderr(&output));
        assert!(!folder.path().join("ball.png").exists());
    }
}

#[test]
fn auto_always_makes_a_picture_and_says_by_what() {
    let folder = folder();
    let output = run(folder.path(), &["render", "ball.json", "--backend", "auto"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains(", on "), "{}", stderr(&output));
    assert!(folder.path().join("ball.png").exists());
}

#[cfg(not(feature = "gpu"))]
#[test]
fn without_the_feature_commands_say_how_to_get_it() {
    let folder = folder();
    for args in [
        &["view", "ball.json"][..],
        &["render", "ball.json", "--backend", "gpu"],
        &["info", "--gpu"],
        &["bench", "--gpu", "ball.json"],
    ] {
        let output = run(folder.path(), args);
        assert_eq!(output.status.code(), Some(1), "{args:?}");
        assert!(
            stderr(&output).contains("cargo install --path crates/freikugel --features gpu"),
            "{}",
            stderr(&output)
        );
    }
}

#[cfg(feature = "gpu")]
#[test]
fn the_graphics_processor_renders_the_same_picture() {
    let folder = folder();
    let pixels = |name: &str| {
        let file = std::fs::File::open(folder.path().join(name)).expect("a file");
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a picture");
        let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut pixels).expect("pixels");
        pixels
    };
    let output =
        run(folder.path(), &["render", "ball.json", "--backend", "gpu", "-o", "gpu.png", "--stats", "gpu.json"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let output = run(folder.path(), &["render", "ball.json", "-o", "cpu.png"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let (gpu, cpu) = (pixels("gpu.png"), pixels("cpu.png"));
    let sum: u32 = gpu.iter().zip(&cpu).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
    assert!(f64::from(sum) / (gpu.len() as f64) < 0.5, "{sum}");
    let stats = std::fs::read_to_string(folder.path().join("gpu.json")).expect("statistics");
    assert!(stats.contains("\"camera\": 2400") && stats.contains("graphics_processor"), "{stats}");
}

#[cfg(feature = "gpu")]
#[test]
fn voxels_are_drawn_and_counted() {
    let folder = folder();
    let args = ["render", "ball.json", "--backend", "auto", "--voxels", "40", "-o", "voxels.png"];
    let output = run(folder.path(), &args);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("voxels take 0."), "{}", stderr(&output));
    let output = run(folder.path(), &["render", "ball.json", "--backend", "gpu", "--voxels", "4"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("choose 16 to 1024"), "{}", stderr(&output));
    for args in [&["render", "ball.json", "--voxels", "50"][..], &["bench", "ball.json", "--voxels", "50"]] {
        assert_eq!(run(folder.path(), args).status.code(), Some(2), "{args:?}");
    }
}

#[cfg(feature = "gpu")]
#[test]
fn adapters_are_listed_and_chosen_by_name() {
    let folder = folder();
    let output = run(folder.path(), &["info", "--gpu"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let list = String::from_utf8_lossy(&output.stdout).into_owned();
    let name = list.split(" (").next().expect("a name");
    let output = run(folder.path(), &["render", "ball.json", "--backend", "gpu", "--adapter", name]);
    assert!(output.status.success() && stderr(&output).contains(name), "{}", stderr(&output));
    let output = run(folder.path(), &["render", "ball.json", "--backend", "gpu", "--adapter", "no such"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("there are: "), "{}", stderr(&output));
}

#[cfg(all(feature = "gpu", target_os = "linux"))]
#[test]
fn a_window_without_a_screen_is_refused_with_a_way_out() {
    let folder = folder();
    let output = run(folder.path(), &["view", "ball.json"]);
    assert_eq!(output.status.code(), Some(1));
    let text = stderr(&output);
    assert!(text.contains("DISPLAY") && text.contains("freikugel render"), "{text}");
}

/// The rows of figures in a file, each checked for what holds on any machine, however slow or busy.
fn frame_rates(path: &std::path::Path) -> Vec<serde_json::Value> {
    let text = std::fs::read_to_string(path).expect("figures");
    let all: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let rows = all["rows"].as_array().expect("rows").clone();
    for row in &rows {
        let number = |group: &str, key: &str| row[group][key].as_f64().unwrap_or(f64::NAN);
        for group in ["frames_per_second", "milliseconds"] {
            let [min, mean, max, deviation] = ["min", "mean", "max", "deviation"].map(|key| number(group, key));
            assert!(0.0 < min && min <= mean && mean <= max && max.is_finite(), "{row}");
            assert!((0.0..=max - min).contains(&deviation), "{row}");
        }
        assert!((number("milliseconds", "min") * number("frames_per_second", "max") - 1e3).abs() < 1e-6, "{row}");
        assert!((number("milliseconds", "max") * number("frames_per_second", "min") - 1e3).abs() < 1e-6, "{row}");
        assert!(row["first_frame_ms"].as_f64() > Some(0.0) && row["prepare_ms"].as_f64() > Some(0.0), "{row}");
    }
    rows
}

#[test]
fn frames_of_the_cpu_are_timed() {
    let folder = folder();
    let args = ["bench", "ball.json", "--frames", "5", "--width", "32", "--height", "18", "--json", "rates.json"];
    let output = run(folder.path(), &args);
    assert!(output.status.success(), "{}", stderr(&output));
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(table.contains("| ball.json | CPU, "), "{table}");
    let rows = frame_rates(&folder.path().join("rates.json"));
    assert_eq!(rows.len(), 1);
    assert_eq!((&rows[0]["frames"], &rows[0]["pipelines_ms"]), (&5.into(), &serde_json::Value::Null));
    for args in [&["bench", "--filter", "no such"][..], &["bench", "--frames", "0"], &["bench", "--adapter", "x"]] {
        assert_eq!(run(folder.path(), args).status.code(), Some(2), "{args:?}");
    }
}

#[cfg(feature = "gpu")]
#[test]
fn frames_of_all_scenes_are_timed_on_both_processors() {
    let folder = folder();
    let args = ["bench", "--gpu", "--frames", "2", "--width", "64", "--height", "36", "--json", "rates.json"];
    let output = run(folder.path(), &args);
    assert!(output.status.success(), "{}", stderr(&output));
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    let rows = frame_rates(&folder.path().join("rates.json"));
    let scenes = ["box", "columns", "Mandelbulb", "room", "50^3 voxels", "10 prim", "20 prim", "100 prim", "300 prim"];
    let mut left = rows.iter();
    for name in scenes {
        // The CPU draws no voxels.
        for on_gpu in [true, false].into_iter().filter(|on_gpu| *on_gpu || !name.contains("voxels")) {
            let row = left.next().unwrap_or_else(|| panic!("{name} is missing: {table}"));
            assert!(row["scene"].as_str().is_some_and(|scene| scene.starts_with(name)), "{row}");
            assert_eq!(row["pipelines_ms"].as_f64() > Some(0.0), on_gpu, "{row}");
        }
    }
    assert!(left.next().is_none(), "{table}");
    assert_eq!(table.lines().filter(|line| line.starts_with("| ")).count(), 1 + rows.len(), "{table}");
}
