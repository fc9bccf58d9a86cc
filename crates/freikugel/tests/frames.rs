//! `freikugel render --frames`, `--set` and `--time`, as a user meets them.

use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

fn command(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_freikugel"));
    command.args(args).current_dir(folder);
    command
}

fn run(folder: &Path, args: &[&str]) -> (i32, String) {
    let Output { status, stderr, .. } = command(folder, args).output().expect("the command runs");
    (status.code().expect("it exits"), String::from_utf8(stderr).expect("text"))
}

/// A folder with a scene in which a ball grows and another moves, and the camera with it.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), r#"{ "sphere": { "radius": "size * (1 + t)" } }"#, r#"[4, "-6 - t", 3]"#);
    folder
}

fn write(folder: &Path, shape: &str, eye: &str) {
    let text = format!(
        r#"{{ "parameters": {{ "size": {{ "value": 0.5, "from": 0.1, "to": 2 }} }}, "camera": {{ "eye": {eye} }},
        "picture": {{ "width": 48, "height": 32, "samples": 1 }}, "objects": [ {{ "shape": {shape} }},
        {{ "shape": {{ "translate": {{ "by": [1, 0, "sin(size + t)"], "shape": {{ "sphere": {{ "radius": 0.3 }} }} }} }} }} ] }}"#
    );
    std::fs::write(folder.join("s.json"), text).expect("can write");
}

fn bytes(folder: &Path, name: &str) -> Vec<u8> {
    std::fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("a name")).collect();
    names.sort();
    names
}

#[test]
fn frames_are_pictures_at_their_times() {
    let folder = folder();
    let (code, text) = run(folder.path(), &["render", "s.json", "--frames", "2..5", "--fps", "4", "-o", "f.png"]);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("f-0002.png to f-0004.png: 3 frames"), "{text}");
    assert_eq!(names(folder.path()), ["f-0002.png", "f-0003.png", "f-0004.png", "s.json"], "nothing else stays");
    for (name, time) in [("f-0002.png", "1/2"), ("f-0003.png", "0.75"), ("f-0004.png", "1")] {
        let (code, text) = run(folder.path(), &["render", "s.json", "--time", time, "-o", "one.png", "-q"]);
        assert_eq!(code, 0, "{text}");
        assert_eq!(bytes(folder.path(), name), bytes(folder.path(), "one.png"), "{name}");
    }
    let (code, text) = run(
        folder.path(),
        &["render", "s.json", "--frames", "0..1", "--time", "0.75", "--set", "size=1", "-o", "late.exr"],
    );
    assert_eq!(code, 0, "{text}");
    let (code, text) =
        run(folder.path(), &["render", "s.json", "--set", "size=2/2", "--time", "0.75", "-o", "one.exr", "-q"]);
    assert_eq!(code, 0, "{text}");
    assert_eq!(bytes(folder.path(), "late-0000.exr"), bytes(folder.path(), "one.exr"));
}

#[test]
fn what_only_the_camera_sees_otherwise_is_prepared_once_and_looks_the_same() {
    let folder = folder();
    write(folder.path(), r#"{ "box": { "size": "size" } }"#, r#"["4 cos(t)", "-6 sin(t)", 3]"#);
    let scene = std::fs::read_to_string(folder.path().join("s.json")).expect("text").replace("size + t", "size");
    std::fs::write(folder.path().join("s.json"), scene).expect("can write");
    let (code, text) = run(folder.path(), &["render", "s.json", "--frames", "0..3", "--fps", "2", "-o", "f.png"]);
    assert_eq!(code, 0, "{text}");
    let (code, text) = run(folder.path(), &["render", "s.json", "--time", "1", "-o", "one.png", "-q"]);
    assert_eq!(code, 0, "{text}");
    assert_eq!(bytes(folder.path(), "f-0002.png"), bytes(folder.path(), "one.png"));
}

#[test]
fn frames_go_into_one_file() {
    let folder = folder();
    for name in ["m.gif", "m.webp", "m.apng"] {
        let (code, text) = run(folder.path(), &["render", "s.json", "--frames", "0..4", "-o", name]);
        assert_eq!(code, 0, "{text}");
        assert!(text.contains(&format!("{name}: 4 frames")), "{text}");
    }
    assert_eq!(names(folder.path()), ["m.apng", "m.gif", "m.webp", "s.json"], "nothing else stays");
    assert!(bytes(folder.path(), "m.gif").starts_with(b"GIF89a"));
    assert!(bytes(folder.path(), "m.webp")[8..].starts_with(b"WEBPVP8X"));
    let mut reader =
        png::Decoder::new(std::io::Cursor::new(bytes(folder.path(), "m.apng"))).read_info().expect("a PNG");
    assert_eq!(reader.info().animation_control.expect("frames").num_frames, 4);
    let mut frames = vec![vec![0; 48 * 32 * 3]; 4];
    for frame in &mut frames {
        reader.next_frame(frame).expect("a frame");
    }
    assert!(frames.windows(2).all(|pair| pair[0] != pair[1]), "the ball grows");
}

#[test]
fn an_interrupted_sequence_goes_on() {
    let folder = folder();
    let args = ["render", "s.json", "--frames", "0..6", "-o", "f.png", "--width", "480", "--height", "320"];
    let child = command(folder.path(), &[&args[..], &["--samples", "4"]].concat()).stderr(Stdio::piped()).spawn();
    let child = child.expect("the command runs");
    let start = Instant::now();
    while !folder.path().join("f-0000.png").exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "no frame comes");
        std::thread::sleep(Duration::from_millis(2));
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(kill.success());
    let output = child.wait_with_output().expect("it exits");
    let text = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(130), "{text}");
    assert!(text.contains("of 6 frames; the same command goes on"), "{text}");
    let first = bytes(folder.path(), "f-0000.png");

    // A frame that is there is not rendered again: one that was changed stays as it is.
    std::fs::write(folder.path().join("f-0000.png"), b"kept").expect("can write");
    let (code, text) = run(folder.path(), &[&args[..], &["--samples", "4"]].concat());
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("going on: "), "{text}");
    assert_eq!(bytes(folder.path(), "f-0000.png"), b"kept");
    assert_eq!(names(folder.path()).len(), 7, "{:?}", names(folder.path()));
    let (code, text) = run(folder.path(), &[&args[..], &["--samples", "4"]].concat());
    assert_eq!(code, 0, "{text}");
    assert!(!text.contains("going on"), "what is complete is rendered anew: {text}");
    assert_eq!(bytes(folder.path(), "f-0000.png"), first);

    // A list of another scene counts for nothing.
    std::fs::write(folder.path().join(".f-frames"), "0123456789abcdef\n0\n1\n").expect("can write");
    let (code, text) = run(folder.path(), &[&args[..], &["--samples", "4"]].concat());
    assert_eq!(code, 0, "{text}");
    assert!(!text.contains("going on"), "{text}");
}

#[test]
fn videos_are_made_by_ffmpeg() {
    let folder = folder();
    let args = ["render", "s.json", "--frames", "0..3", "--fps", "25", "-o", "m.mp4"];
    let output = command(folder.path(), &args).env("PATH", folder.path()).output().expect("the command runs");
    let text = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("ffmpeg, which is not installed; .gif, .webp and .apng need no other program"), "{text}");
    assert_eq!(names(folder.path()), ["s.json"], "nothing was rendered for nothing");

    // A program in its place notes what it is told, and writes what it is sent to the last of its words.
    let program =
        "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\necho \"$@\" > words\nfor last; do :; done\ncat > \"$last\"\n";
    let path = folder.path().join("ffmpeg");
    std::fs::write(&path, program).expect("can write");
    let made = Command::new("chmod").arg("+x").arg(&path).status().expect("chmod runs");
    assert!(made.success());
    let search = format!("{}:{}", folder.path().display(), std::env::var("PATH").unwrap_or_default());
    let output = command(folder.path(), &args).env("PATH", &search).output().expect("the command runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(bytes(folder.path(), "m.mp4").len(), 3 * 3 * 48 * 32, "three frames of bytes");
    let words = String::from_utf8(bytes(folder.path(), "words")).expect("text");
    assert!(words.contains("-s 48x32 -r 25") && words.contains("libx264"), "{words}");
    assert_eq!(names(folder.path()), ["ffmpeg", "m.mp4", "s.json", "words"]);

    let failing = "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\necho no such codec >&2\nexit 1\n";
    std::fs::write(&path, failing).expect("can write");
    let output = command(folder.path(), &args).env("PATH", &search).output().expect("the command runs");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("ffmpeg failed: no such codec"), "{text}");
}

#[test]
fn mistakes_come_out_before_hours_have_passed() {
    let folder = folder();
    let shrinking = r#"{ "sphere": { "radius": "0.5 - t" } }"#;
    write(folder.path(), shrinking, r"[4, -6, 3]");
    let (code, text) = run(folder.path(), &["render", "s.json", "--frames", "0..20", "-o", "f.png"]);
    assert_eq!(code, 1, "{text}");
    assert!(text.contains("s.json at t = 0.6") && text.contains("no sound scene in frame 19"), "{text}");
    assert_eq!(names(folder.path()), ["s.json"]);

    for (args, code, says) in [
        (&["--frames", "5..5"][..], 2, "has no frames"),
        (&["--frames", "0..3", "--fps", "0"], 2, "0"),
        (&["--frames", "0..3", "-o", "f.jpg"], 2, ".apng, .gif, .webp, .mp4, .webm"),
        (&["--frames", "0..3", "-o", "nowhere/f.gif"], 1, "no folder nowhere"),
        (&["--frames", "0..3", "--fps", "60", "-o", "f.gif"], 2, "GIF has 50 frames a second at most, not 60"),
        (&["--frames", "0..3", "--stats", "s"], 2, "--stats"),
        (&["--fps", "3"], 2, "--frames"),
        (&["--set", "size=9"], 1, "`size` is set to 9, but can be at most 2"),
        (&["--set", "width=9"], 1, "the scene has no parameter `width`"),
        (&["--set", "size"], 2, "NAME=NUMBER"),
        (&["--time", "soon"], 2, "soon"),
    ] {
        let (got, text) = run(folder.path(), &[&["render", "s.json"], args].concat());
        assert_eq!(got, code, "{args:?}: {text}");
        assert!(text.contains(says), "{args:?}: {text}");
    }
    assert_eq!(names(folder.path()), ["s.json"]);
}

#[test]
fn scenes_that_do_not_move_are_pointed_out() {
    let folder = folder();
    std::fs::write(folder.path().join("s.json"), r#"{ "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#)
        .expect("can write");
    let args = ["render", "s.json", "--frames", "0..2", "--width", "20", "--height", "20", "-o", "f.png"];
    let (code, text) = run(folder.path(), &args);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("all frames are alike"), "{text}");
    std::fs::write(folder.path().join("m.vm"), "a var-x\n").expect("can write");
    let (code, text) = run(folder.path(), &["render", "m.vm", "--frames", "0..2", "-o", "f.png"]);
    assert_eq!(code, 2, "{text}");
    assert!(text.contains("a model does not move"), "{text}");
}

#[test]
fn other_commands_take_settings_and_times_as_well() {
    let folder = folder();
    let output = command(folder.path(), &["info", "s.json", "--set", "size=0.75", "--time", "1"]).output();
    let text = String::from_utf8(output.expect("the command runs").stdout).expect("text");
    assert!(text.contains("sphere radius=1.5"), "{text}");
    let (code, text) = run(folder.path(), &["check", "s.json", "--set", "size=5"]);
    assert_eq!(code, 1, "{text}");
    let args = ["slice", "s.json", "--set", "size=1", "--time", "0.5", "-o", "a.png", "-q"];
    assert_eq!(run(folder.path(), &args).0, 0);
    assert_eq!(run(folder.path(), &["slice", "s.json", "-o", "b.png", "-q"]).0, 0);
    assert_ne!(bytes(folder.path(), "a.png"), bytes(folder.path(), "b.png"));
    let args = ["sweep", "s.json", "--vary", "parameters.size.value=0.5,1", "-o", "w.png", "-q"];
    assert_eq!(run(folder.path(), &args).0, 0);
    let output =
        command(folder.path(), &["formula", "length(p) - r + t", "--set", "r=2", "--time", "1", "--at", "3,0,4"]);
    let text = String::from_utf8({ output }.output().expect("the command runs").stdout).expect("text");
    assert!(text.contains("value     4\n"), "{text}");
}
