//! The built command, as a user meets it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A folder of its own for each test, removed at the end.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder for the test"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
        std::fs::write(self.path(name), text).expect("can write");
        self.path(name)
    }

    /// Runs the command in this folder.
    fn run(&self, args: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_freikugel"))
            .args(args)
            .current_dir(self.0.path())
            .stdin(Stdio::null())
            .output()
            .expect("the command runs")
    }

    fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.0.path())
            .expect("can list")
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("it exits")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

const BALL: &str = r#"{ "picture": { "width": 40, "height": 30, "samples": 2 }, "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#;

#[test]
fn renders_to_the_named_file_and_to_the_default_one() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    let output = folder.run(&["render", "ball.json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stderr(&output).contains("ball.png: 40 x 30"), "{}", stderr(&output));
    assert_eq!(stdout(&output), "");
    let output = folder.run(&["render", "ball.json", "-o", "other.EXR", "--quiet", "--stats", "stats.json"]);
    assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
    assert_eq!(folder.names(), ["ball.json", "ball.png", "other.EXR", "stats.json"]);
    assert!(std::fs::read(folder.path("ball.png")).expect("there").starts_with(b"\x89PNG"));
    assert!(std::fs::read(folder.path("other.EXR")).expect("there").starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    let stats: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path("stats.json")).expect("there")).expect("JSON");
    assert_eq!(stats["rays"]["camera"], 40 * 30 * 2);
    assert_eq!(stats["unresolved"]["pixels"], 0);
}

#[test]
fn the_same_bytes_for_any_threads_and_instruction_set() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    let picture = |args: &[&str]| {
        let output = folder.run(&[&["render", "ball.json", "-o", "x.png"], args].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        std::fs::read(folder.path("x.png")).expect("there")
    };
    let first = picture(&["--threads", "1"]);
    assert_eq!(first, picture(&["--threads", "3"]));
    for level in freikugel::field::simd::available() {
        assert_eq!(first, picture(&["--simd", freikugel::field::simd::name(level)]));
    }
    assert_ne!(first, picture(&["--quality", "draft"]));
}

#[test]
fn a_broken_scene_gets_all_its_mistakes_and_code_1() {
    let folder = Folder::new();
    folder.write(
        "broken.json",
        r#"{
  "objects": [
    { "shape": { "sphere": { "radios": 1 } } },
    { "shape": { "box": { "size": [1, -2, 3] } } },
    { "shape": { "union": [] } }
  ]
}"#,
    );
    for command in ["check", "render", "info"] {
        let output = folder.run(&[command, "broken.json"]);
        assert_eq!(code(&output), 1);
        let text = stderr(&output);
        for part in ["broken.json:3:", "did you mean `radius`", "broken.json:4:", "broken.json:5:", "has 3 errors"] {
            assert!(text.contains(part), "{command} does not say {part:?}: {text}");
        }
        assert_eq!(folder.names(), ["broken.json"], "{command} leaves nothing behind");
    }
}

#[test]
fn impossible_inputs_get_a_message() {
    let folder = Folder::new();
    folder.write("binary.json", [0xff, 0xfe, 0x00, 0x80]);
    folder.write("empty.json", "");
    std::fs::create_dir(folder.path("folder")).expect("can make");
    // A sparse file of 2 GB takes no room.
    let huge = std::fs::File::create(folder.path("huge.json")).expect("can make");
    huge.set_len(2 << 30).expect("sparse");
    for (name, says) in [
        ("missing.json", "No such file"),
        ("binary.json", "not text"),
        ("folder", "it is a folder"),
        ("huge.json", "larger than 64 MiB"),
        ("empty.json", "error"),
    ] {
        for command in ["check", "render", "info"] {
            let mut args = vec![command, name];
            if command == "render" {
                args.extend(["-o", "x.png"]);
            }
            let output = folder.run(&args);
            let text = stderr(&output);
            assert_eq!(code(&output), 1, "{command} {name}: {text}");
            assert!(text.contains(says) && !text.contains("panicked"), "{command} {name}: {text}");
        }
    }
    assert!(!folder.path("x.png").exists());
}

#[test]
fn impossible_outputs_get_a_message_before_any_work() {
    let folder = Folder::new();
    folder.write("ball.json", BALL.replace("40", "40000"));
    std::fs::create_dir(folder.path("folder.png")).expect("can make");
    for (path, says) in [("folder.png", "it is a folder"), ("no/such/x.png", "there is no folder")] {
        let output = folder.run(&["render", "ball.json", "-o", path, "--height", "1000"]);
        assert_eq!(code(&output), 1);
        assert!(stderr(&output).contains(says), "{}", stderr(&output));
    }
    assert_eq!(folder.names(), ["ball.json", "folder.png"]);
}

#[test]
fn off_words_get_code_2() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    for args in [
        &["render", "ball.json", "--wdith", "3"][..],
        &["render", "ball.json", "--width", "0"],
        &["render", "ball.json", "--width", "wide"],
        &["render", "ball.json", "-o", "x.bmp"],
        &["render", "ball.json", "--crop", "1,2,3"],
        &["render", "ball.json", "--crop", "30,0,20,20"],
        &["render", "ball.json", "--threads", "0"],
        &["render", "ball.json", "--simd", "mmx"],
        &["render", "ball.json", "--samples", "4", "--quality", "fine"],
        &["render"],
        &["rendre", "ball.json"],
        &["help", "shapes", "sphreoid"],
        &["help", "nothing"],
        &["check"],
        &[],
    ] {
        let output = folder.run(args);
        assert_eq!(code(&output), 2, "{args:?}: {}", stderr(&output));
        assert!(!stderr(&output).is_empty() && !stderr(&output).contains("panicked"), "{args:?}");
    }
    assert_eq!(folder.names(), ["ball.json"]);
}

#[test]
fn a_crop_is_a_cut_of_the_whole() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    let image = |args: &[&str]| {
        let output = folder.run(&[&["render", "ball.json", "-o", "x.png"], args].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let file = std::fs::File::open(folder.path("x.png")).expect("there");
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a picture");
        let mut pixels = vec![0; reader.output_buffer_size().expect("fits")];
        let info = reader.next_frame(&mut pixels).expect("a frame");
        (info.width as usize, pixels)
    };
    let (whole_width, whole) = image(&[]);
    let (width, cut) = image(&["--crop", "7,5,20,11"]);
    assert_eq!(width, 20);
    for y in 0..11 {
        let start = 3 * ((y + 5) * whole_width + 7);
        assert_eq!(cut[3 * 20 * y..3 * 20 * (y + 1)], whole[start..start + 60], "row {y}");
    }
}

#[test]
fn info_schema_and_help_say_what_there_is() {
    let folder = Folder::new();
    folder.write(
        "cup.json",
        r##"{ "materials": { "clay": { "color": "#c8825a" } }, "objects": [ { "name": "cup", "material": "clay", "shape":
            { "difference": [ { "cylinder": { "radius": 1, "height": 2 } }, { "sphere": { "radius": 0.5 } } ] } } ] }"##,
    );
    let text = stdout(&folder.run(&["info", "cup.json"]));
    for part in [
        r#"object "cup", material "clay", box (-1.0000, -1.0000, -1.0000) to (1.0000, 1.0000, 1.0000)"#,
        "difference keep_material=false  [bound outside, exact inside]",
        "cylinder radius=1 height=2 round=0 axis=z  [exact]",
        "1 object, 3 nodes, 2 primitives, 3 operations, 1 material, 3 lights",
    ] {
        assert!(text.contains(part), "no {part:?} in {text}");
    }
    folder.write(
        "found.json",
        r#"{ "objects": [ { "name": "bare", "shape": { "formula": "x^2 + y^2 + z^2 - 1" } },
            { "name": "cut", "shape": { "formula": { "f": "3*x", "within": { "sphere": 2 } } } },
            { "name": "quadric", "shape": { "formula": { "f": "x^2 - y", "within": { "sphere": 2 } } } },
            { "name": "warped", "shape": { "warp": { "y": "y + sin(x)", "shape": { "sphere": { "radius": 1 } } } } },
            { "name": "graph", "shape": { "extrude": { "height": 1, "shape": { "formula_graph":
                { "width": 0.1, "from": 0, "to": 1, "f": "sin(x)" } } } } },
            { "name": "open", "shape": { "formula": "x*y - 1" } } ] }"#,
    );
    let text = stdout(&folder.run(&["info", "found.json"]));
    for part in [
        "object \"bare\", material \"\", box (-1.000",
        "(found)\n  formula f=\"x^2 + y^2 + z^2 - 1\" kind=solid",
        "cut=capped  [implicit, slope at most 3]",
        "within (-2.0000, -2.0000, -2.0000) to (2.0000, 2.0000, 2.0000)]",
        "object \"warped\", material \"\", box (-1.0000, -2.0000, -1.0000) to (1.0000, 2.0000, 1.0000)",
        "warp y=\"y + sin(x)\" within=",
        "formula_graph width=0.1 from=0 to=1 f=\"sin(x)\"  [exact outside",
        "object \"open\", material \"\", unbounded",
        "[implicit, slope unknown]",
    ] {
        assert!(text.contains(part), "no {part:?} in {text}");
    }
    let points = (0..1000).map(|index| format!("[{index}, 0, 0.25]")).collect::<Vec<String>>().join(", ");
    folder.write(
        "many.json",
        format!(r#"{{ "objects": [ {{ "shape": {{ "point_set": {{ "radius": 1, "points": [{points}] }} }} }} ] }}"#),
    );
    let text = stdout(&folder.run(&["info", "many.json"]));
    assert!(text.contains("points=0,0,0.25,1,0,0.25") && text.contains(",... (3000 numbers)  ["), "{text}");
    let schema: serde_json::Value = serde_json::from_str(&stdout(&folder.run(&["schema"]))).expect("JSON");
    assert!(schema.is_object());
    let shapes = stdout(&folder.run(&["help", "shapes"]));
    for shape in freikugel::field::shapes::ALL {
        assert!(shapes.contains(shape.about.name), "{shapes}");
        let text = stdout(&folder.run(&["help", "shapes", shape.about.name]));
        let lines = shape.about.example.lines().map(str::trim);
        assert!(text.contains(shape.about.summary) && lines.clone().all(|line| text.contains(line)), "{text}");
    }
    for args in [&["help"][..], &["help", "render"], &["--help"], &["render", "--help"]] {
        let output = folder.run(args);
        assert_eq!(code(&output), 0);
        assert!(stdout(&output).contains("Examples:"), "{args:?}");
    }
}

#[test]
fn every_example_of_a_shape_is_a_sound_scene() {
    let folder = Folder::new();
    for shape in freikugel::field::shapes::ALL {
        let scene =
            format!(r#"{{ "materials": {{ "clay": {{}} }}, "objects": [ {{ "shape": {} }} ] }}"#, shape.about.example);
        folder.write("example.json", scene);
        let output = folder.run(&["check", "example.json"]);
        assert_eq!((code(&output), stderr(&output).as_str()), (0, ""), "{}", shape.about.name);
    }
}

#[test]
fn shapes_may_stand_alone_as_a_list_where_the_help_says_so() {
    let folder = Folder::new();
    let mut counts = [0, 0];
    for shape in freikugel::field::shapes::ALL.iter().filter(|shape| shape.arity() == freikugel::field::Arity::Many) {
        let name = shape.about.name;
        let says_so = stdout(&folder.run(&["help", "shapes", name])).contains("they may stand alone as a list");
        let takes_figures = matches!(shape.kind, freikugel::field::Kind::Loft | freikugel::field::Kind::PerimeterSweep);
        let round = if takes_figures { "circle" } else { "sphere" };
        let child = format!(r#"{{ "{round}": {{ "radius": 1 }} }}"#);
        let scene = format!(r#"{{ "objects": [ {{ "shape": {{ "{name}": [ {child}, {child} ] }} }} ] }}"#);
        folder.write("alone.json", scene);
        assert_eq!(code(&folder.run(&["check", "alone.json"])) == 0, says_so, "{name}");
        counts[usize::from(says_so)] += 1;
    }
    assert!(counts.into_iter().all(|count| count > 2), "{counts:?}");
    let paint = stdout(&folder.run(&["help", "shapes", "paint"]));
    assert!(paint.contains("the name of a material; required"), "{paint}");
}

#[test]
fn every_scene_that_comes_along_is_sound_and_shows_something() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let folder = Folder::new();
    let mut count = 0;
    let mut folders = vec![scenes];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(&next).expect("the scenes are there") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            if path.extension().is_none_or(|suffix| suffix != "json") {
                continue;
            }
            let name = path.display().to_string();
            let size = ["--width", "32", "--height", "24", "--samples", "1"];
            let output = folder.run(&[&["render", &name, "-o", "x.png", "--stats", "stats.json"], &size[..]].concat());
            assert_eq!(code(&output), 0, "{name}: {}", stderr(&output));
            assert!(!stderr(&output).contains("error"), "{name}: {}", stderr(&output));
            let stats: serde_json::Value =
                serde_json::from_slice(&std::fs::read(folder.path("stats.json")).expect("there")).expect("JSON");
            assert!(stats["hits"].as_u64().expect("a count") > 32 * 24 / 10, "{name}: {stats}");
            count += 1;
        }
    }
    assert!(count > 30, "only {count} scenes");
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_no_partial_file() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    let mut child = Command::new(env!("CARGO_BIN_EXE_freikugel"))
        .args(["render", "ball.json", "--width", "4000", "--height", "4000", "--samples", "4000"])
        .current_dir(folder.0.path())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    // Long enough for the unfinished file to be there, far too short for the picture.
    let deadline = std::time::Instant::now() + std::time::Duration::from_secs(30);
    while folder.names().len() == 1 && std::time::Instant::now() < deadline {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert_eq!(folder.names().len(), 2, "the file that will be the picture");
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(kill.success());
    let status = child.wait().expect("it ends");
    assert_eq!(status.code(), Some(130));
    assert_eq!(folder.names(), ["ball.json"]);
}

#[cfg(unix)]
#[test]
fn links_and_devices_are_written_through() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    folder.write("real.png", "old");
    std::os::unix::fs::symlink(folder.path("real.png"), folder.path("link.png")).expect("can link");
    assert_eq!(code(&folder.run(&["render", "ball.json", "-o", "link.png"])), 0);
    assert!(folder.path("link.png").is_symlink());
    assert!(std::fs::read(folder.path("real.png")).expect("there").starts_with(b"\x89PNG"));
    std::os::unix::fs::symlink("/dev/null", folder.path("null.png")).expect("can link");
    assert_eq!(code(&folder.run(&["render", "ball.json", "-o", "null.png"])), 0);
    assert!(!Path::new("/dev/null").is_file());
}

/// Width and height of a PNG file.
fn size(path: &Path) -> (u32, u32) {
    let file = std::io::BufReader::new(std::fs::File::open(path).expect("there"));
    let reader = png::Decoder::new(file).read_info().expect("a PNG");
    (reader.info().width, reader.info().height)
}

#[test]
fn a_tracer_can_be_chosen_and_is_named_in_the_statistics() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    for tracer in ["auto", "fixed", "sphere", "relaxed", "guaranteed"] {
        let output =
            folder.run(&["render", "ball.json", "-o", "x.png", "--tracer", tracer, "--stats", "stats.json", "--quiet"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let stats: serde_json::Value =
            serde_json::from_slice(&std::fs::read(folder.path("stats.json")).expect("there")).expect("JSON");
        assert_eq!(stats["tracer"], tracer);
        assert!(stats["hits"].as_u64().expect("a count") > 100, "{tracer}");
    }
    let output = folder.run(&["render", "ball.json", "--tracer", "spere"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("auto, fixed, sphere, relaxed, guaranteed"), "{}", stderr(&output));
    let output = folder.run(&["render", "ball.json", "--warning-color", "pink"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("#rrggbb"), "{}", stderr(&output));

    folder.write("wave.json", r#"{ "objects": [ { "name": "wave", "shape": { "formula": "z - x^2 * y" } } ] }"#);
    let output = folder.run(&["render", "wave.json", "--tracer", "sphere"]);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("`sphere` can't find \"wave\""), "{}", stderr(&output));
    assert!(!folder.path("wave.png").exists());
}

#[test]
fn compare_prints_a_table_and_writes_sheet_pictures_and_figures() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    let output = folder.run(&["compare", "ball.json", "--runs", "1", "--json", "figures.json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let table = stdout(&output);
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 6, "{table}");
    assert!(lines.iter().all(|line| line.len() == lines[0].len()), "the columns are aligned: {table}");
    let figures: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path("figures.json")).expect("there")).expect("JSON");
    for (line, tracer) in lines[1..].iter().zip(["auto", "fixed", "sphere", "relaxed", "guaranteed"]) {
        assert!(line.starts_with(tracer), "{line}");
        let figures = &figures["tracers"][tracer];
        let number = |key: &str| figures[key].as_u64().unwrap_or_else(|| panic!("{tracer} has no {key}"));
        assert_eq!(number("false"), 0);
        assert!(number("field_evaluations") > 0 && number("hits") > 100);
        assert!(line.split_whitespace().any(|word| word == number("hits").to_string()), "{line}");
    }
    assert_eq!(figures["width"], 40);
    // Five pictures of 40 pixels beside each other, three of 30 below.
    let (width, height) = size(&folder.path("ball-compare.png"));
    assert!(width > 5 * 40 && height > 3 * 30, "{width} x {height}");

    let output = folder.run(&["compare", "ball.json", "--runs", "1", "-o", "parts", "--quiet", "--width", "20"]);
    assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
    assert_eq!(std::fs::read_dir(folder.path("parts")).expect("made").count(), 1 + 3 * 5);
    assert_eq!(size(&folder.path("parts/relaxed-steps.png")), (20, 30));
}

#[test]
fn compare_names_the_reason_why_a_tracer_can_not_be_used() {
    let folder = Folder::new();
    folder.write(
        "wave.json",
        r#"{ "picture": { "width": 24, "height": 16 }, "objects": [ { "name": "wave", "shape": { "formula": "z - x^2 * y" } } ] }"#,
    );
    let output = folder.run(&["compare", "wave.json", "--runs", "1", "--json", "figures.json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let table = stdout(&output);
    for tracer in ["sphere", "relaxed"] {
        let line = table.lines().find(|line| line.starts_with(tracer)).expect("a line");
        assert!(line.contains("can't find \"wave\""), "{line}");
    }
    let figures: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path("figures.json")).expect("there")).expect("JSON");
    assert!(figures["tracers"]["sphere"]["can_not_be_used"].as_str().expect("a reason").contains("wave"));
    assert!(figures["tracers"]["guaranteed"]["hits"].as_u64().expect("a count") > 0);
}

#[test]
fn a_sweep_over_one_number_is_a_row_and_over_two_a_grid() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    let sweep = |args: &[&str], name: &str| {
        let output = folder.run(&[&["sweep", "ball.json", "--samples", "1", "-o", name], args].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        size(&folder.path(name))
    };
    // A title that is shorter than all, so that it does not count.
    let radius = "objects[0].shape.sphere.radius=0.5,1";
    let wide = ["--width", "400"];
    let one = sweep(&[&["--vary", radius], &wide[..]].concat(), "one.png");
    let three = sweep(&[&["--vary", "tracer.max_steps=5,10,100"], &wide[..]].concat(), "three.png");
    assert_eq!(three.0 - one.0, 400 + 10, "one picture and one gap more");
    let grid = ["--vary", radius, "--vary", "tracer.max_steps=50,60,100"];
    let grid = sweep(&[&grid[..], &wide[..]].concat(), "grid.png");
    let tall = sweep(&["--vary", radius, "--vary", "picture.height=30,70,20", "--width", "400"], "tall.png");
    assert!(grid.0 > three.0, "the names of rows stand on the left");
    assert_eq!(tall.0, grid.0, "as many pictures, and the same names of rows");
    assert_eq!(tall.1 - grid.1, 2 * (70 - 30), "each row is as high as its highest picture");
    let column =
        sweep(&[&["--vary", "tracer.max_steps=50,60,100", "--columns", "1"], &wide[..]].concat(), "column.png");
    assert_eq!(column.0, 400 + 2 * 14, "one picture and two margins");

    let output = folder.run(&["sweep", "ball.json", "--vary", "picture.exposure=-1..1:3", "--quiet"]);
    assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
    assert!(folder.path("ball-sweep.png").exists());
}

#[test]
fn wrong_sweeps_are_explained_before_anything_is_written() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    let before = folder.names();
    let vary = |axes: &[&str], exit: i32, says: &[&str]| {
        let args: Vec<&str> = axes.iter().flat_map(|axis| ["--vary", axis]).collect();
        let output = folder.run(&[&["sweep", "ball.json"], &args[..]].concat());
        assert_eq!(code(&output), exit, "{axes:?}: {}", stderr(&output));
        for part in says {
            assert!(stderr(&output).contains(part), "{axes:?} does not say {part:?}: {}", stderr(&output));
        }
        assert_eq!(folder.names(), before, "{axes:?} leaves nothing behind");
    };
    vary(&["objects[0].shape.spere.radius=1,2"], 1, &["does not write `spere`; did you mean `sphere`?"]);
    vary(&["tracer.max_step=1,2"], 1, &["has no key `max_step`", "did you mean `max_steps`?"]);
    vary(&["objects[3].shape=1"], 1, &["there is no [3]: `objects` has one entry, [0]"]);
    vary(&["camera.eye[2]=1"], 1, &["can't vary camera.eye[2]", "does not write `camera`"]);
    vary(
        &["objects[0].shape.sphere.radius=1,-2"],
        1,
        &["must be above 0, but is -2", "ball.json with objects[0].shape.sphere.radius=-2"],
    );
    vary(&["tracer.max_steps=5..6:3"], 1, &["must be a whole number, but is 5.5"]);
    vary(&["a=1", "b=2", "c=3"], 2, &["a sheet has two axes"]);
    vary(&["tracer.max_steps"], 2, &["write PATH=VALUES"]);
    vary(&["tracer.max_steps=1..100:100", "picture.samples=1..9:9"], 2, &["900 pictures"]);
    let output = folder.run(&["sweep", "ball.json", "--vary", "picture.samples=1", "-o", "x.exr"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("the suffix must be .png"), "{}", stderr(&output));
}

/// A ball as an expression graph.
const BALL_GRAPH: &str = "# a ball\n_0 var-x\n_1 square _0\n_2 var-y\n_3 square _2\n_4 var-z\n_5 square _4\n\
                          _6 add _1 _3\n_7 add _5 _6\n_8 sqrt _7\n_9 const 0.75\n_a sub _8 _9\n";

/// The right half of the plane.
const HALF_GRAPH: &str = "a var-x\nb neg a\n";

/// The bytes of a picture's pixels, and its width.
fn pixels(path: &Path) -> (Vec<u8>, u32) {
    let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).expect("there")));
    let mut reader = decoder.read_info().expect("a picture");
    let mut bytes = vec![0; reader.output_buffer_size().expect("it fits")];
    let info = reader.next_frame(&mut bytes).expect("pixels");
    (bytes, info.width)
}

#[test]
fn a_graph_with_z_is_rendered_as_a_solid() {
    let folder = Folder::new();
    folder.write("ball.vm", BALL_GRAPH);
    let size = ["--width", "60", "--height", "40", "--samples", "1", "--stats", "stats.json"];
    let output = folder.run(&[&["render", "ball.vm"], &size[..]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let stats: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path("stats.json")).expect("there")).expect("JSON");
    let hits = stats["hits"].as_u64().expect("a number");
    assert!((100..1200).contains(&hits), "{hits} pixels of 2400 show the ball");
    assert_eq!(stats["unresolved"]["pixels"], 0);
    assert!(folder.path("ball.png").exists());
    let info = folder.run(&["info", "ball.vm"]);
    assert!(stdout(&info).contains("box (-1.0000, -1.0000, -1.0000) to (1.0000, 1.0000, 1.0000)"), "{}", stdout(&info));
    assert_eq!(code(&folder.run(&["check", "ball.vm"])), 0);
}

#[test]
fn a_graph_without_z_is_rendered_as_a_region_of_the_plane() {
    let folder = Folder::new();
    folder.write("half.vm", HALF_GRAPH);
    let output = folder.run(&["render", "half.vm", "--width", "50"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stderr(&output).contains("half.png: 50 x 50"), "{}", stderr(&output));
    let (bytes, width) = pixels(&folder.path("half.png"));
    let (light, dark) = ([0xf4, 0xf1, 0xea], [0x2b, 0x2f, 0x36]);
    for (index, pixel) in bytes.chunks(3).enumerate() {
        assert_eq!(pixel, if index as u32 % width < width / 2 { light } else { dark }, "pixel {index}");
    }
    // Any threads, any crop: the same bytes.
    let args = ["render", "half.vm", "--width", "51", "--height", "40", "-o"];
    assert_eq!(code(&folder.run(&[&args[..], &["whole.png", "--threads", "1"]].concat())), 0);
    assert_eq!(code(&folder.run(&[&args[..], &["cut.png", "--threads", "2", "--crop", "20,7,11,5"]].concat())), 0);
    let (whole, width) = pixels(&folder.path("whole.png"));
    let (cut, _) = pixels(&folder.path("cut.png"));
    for (row, line) in cut.chunks(11 * 3).enumerate() {
        let start = ((7 + row) * width as usize + 20) * 3;
        assert_eq!(line, &whole[start..start + 11 * 3], "row {row}");
    }
    assert_eq!(code(&folder.run(&["check", "half.vm"])), 0);
    assert!(stdout(&folder.run(&["info", "half.vm"])).contains("f=\"-x\""));
}

#[test]
fn mistakes_in_graphs_are_shown_with_their_places() {
    let folder = Folder::new();
    folder.write("bad.vm", "_0 var-x\n_1 sqroot _0\n");
    for command in ["render", "check", "info"] {
        let output = folder.run(&[command, "bad.vm"]);
        assert_eq!(code(&output), 1);
        let text = stderr(&output);
        assert!(text.contains("bad.vm:2:4"), "{text}");
        assert!(text.contains("there is no operation `sqroot`") && text.contains("did you mean `sqrt`?"), "{text}");
        assert!(text.contains("bad.vm has 1 error"), "{text}");
    }
    assert_eq!(folder.names(), ["bad.vm"]);
}

#[test]
fn a_small_file_has_the_same_pixels() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    for args in
        [&["render", "ball.json", "-o", "quick.png"][..], &["render", "ball.json", "-o", "small.png", "--small"]]
    {
        assert_eq!(code(&folder.run(args)), 0);
    }
    assert_eq!(pixels(&folder.path("quick.png")), pixels(&folder.path("small.png")));
    let length = |name: &str| std::fs::metadata(folder.path(name)).expect("there").len();
    assert!(length("small.png") < length("quick.png"));
}

#[test]
fn shaders_are_written_for_every_target() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    for (target, file, word) in [
        ("wgsl", "ball.wgsl", "@compute"),
        ("glsl", "ball.glsl", "#version 300 es"),
        ("shadertoy", "ball.glsl", "mainImage"),
        ("hlsl", "ball.compute", "#pragma kernel render"),
        ("msl", "ball.metal", "kernel void render"),
    ] {
        let output = folder.run(&["shader", "ball.json", "--target", target]);
        assert_eq!(code(&output), 0, "{target}: {}", stderr(&output));
        let text = std::fs::read_to_string(folder.path(file)).expect("the file");
        assert!(text.contains(word), "{target}");
    }
    let output = folder.run(&["shader", "ball.json", "-t", "wgsl", "-o", "-", "--numbers", "ball.f32"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stdout(&output).contains("fn nearest"));
    let bytes = std::fs::read(folder.path("ball.f32")).expect("the numbers");
    assert!(bytes.len() > 400 && bytes.len().is_multiple_of(4), "{}", bytes.len());
}

#[test]
fn voxels_come_in_a_file_of_their_own() {
    let folder = Folder::new();
    folder.write("ball.json", BALL);
    let args = ["shader", "ball.json", "-t", "glsl", "--voxels", "32", "-o", "-", "--voxel-numbers", "ball.f32"];
    let output = folder.run(&args);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stdout(&output).contains("uniform sampler2D voxels"));
    let bytes = std::fs::read(folder.path("ball.f32")).expect("the voxels");
    // Middles of 4 x 4 x 4 bricks, and all samples of some.
    assert!(bytes.len() > 8 * 64 && (bytes.len() - 8 * 64).is_multiple_of(8 * 729), "{}", bytes.len());
    let output = folder.run(&["shader", "ball.json", "-t", "glsl", "--voxel-numbers", "ball.f32"]);
    assert_eq!(code(&output), 2, "{}", stderr(&output));
    let output = folder.run(&["shader", "ball.json", "-t", "shadertoy", "--voxels", "32"]);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("Shadertoy has no place for voxels"), "{}", stderr(&output));
}

#[test]
fn shaders_of_what_is_no_scene_are_refused() {
    let folder = Folder::new();
    folder.write("bad.json", r#"{ "objects": [ { "shape": { "sphere": { "radius": -1 } } } ] }"#);
    folder.write("ball.json", BALL);
    let output = folder.run(&["shader", "bad.json", "--target", "wgsl"]);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("radius"), "{}", stderr(&output));
    let output = folder.run(&["shader", "ball.json", "--target", "basic"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("shadertoy"), "{}", stderr(&output));
    assert_eq!(folder.names(), ["bad.json", "ball.json"], "nothing was written");
}
