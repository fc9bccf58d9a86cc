//! `freikugel slice`, as a user meets it.

use std::path::Path;
use std::process::{Command, Output};

fn run(folder: &Path, args: &[&str]) -> (i32, String) {
    let Output { status, stderr, .. } = Command::new(env!("CARGO_BIN_EXE_freikugel"))
        .args(args)
        .current_dir(folder)
        .output()
        .expect("the command runs");
    (status.code().expect("it exits"), String::from_utf8(stderr).expect("text"))
}

/// Width, height and pixels of a PNG file.
fn pixels(path: &Path) -> (usize, usize, Vec<u8>) {
    let file = std::fs::File::open(path).expect("there");
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a picture");
    let mut pixels = vec![0; reader.output_buffer_size().expect("fits")];
    let info = reader.next_frame(&mut pixels).expect("a frame");
    (info.width as usize, info.height as usize, pixels)
}

fn scene(shape: &str) -> String {
    format!(r#"{{ "picture": {{ "width": 80, "height": 60 }}, "objects": [ {{ "shape": {shape} }} ] }}"#)
}

#[test]
fn inside_is_blue_and_outside_orange_in_every_plane() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(
        folder.path().join("s.json"),
        scene(r#"{ "translate": { "by": [0.5, 1, 2], "shape": { "box": { "size": [1, 1, 1] } } } }"#),
    )
    .expect("can write");
    for (axis, at, middle, misses) in [("x", "0.5", "1,2", "5"), ("y", "1", "0.5,2", "-3"), ("z", "2", "0.5,1", "0")] {
        for (at, is_inside) in [(at, true), (misses, false)] {
            let args =
                ["slice", "s.json", "--axis", axis, "--at", at, "--middle", middle, "--span", "2", "-o", "s.png"];
            let (code, text) = run(folder.path(), &args);
            assert_eq!(code, 0, "{text}");
            assert!(text.contains("s.png: 80 x 60, 2 wide"), "{text}");
            let (width, height, pixels) = pixels(&folder.path().join("s.png"));
            assert_eq!((width, height), (80, 60));
            let color = |x: usize, y: usize| &pixels[3 * (y * width + x)..][..3];
            // Beside the lines that cross the middle.
            let middle = color(38, 27);
            assert_eq!(middle[2] > middle[0], is_inside, "{axis} at {at}: {middle:?}");
            let corner = color(2, 3);
            assert!(corner[0] > corner[2], "{axis} at {at}: {corner:?}");
        }
    }
}

#[test]
fn slopes_are_white_where_values_are_distances_and_colored_elsewhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let color = |shape: &str, show: &str| {
        std::fs::write(folder.path().join("s.json"), scene(shape)).expect("can write");
        let args = ["slice", "s.json", "--show", show, "--lines", "0", "--span", "8", "-o", "s.png", "-q"];
        assert_eq!(run(folder.path(), &args), (0, String::new()));
        let (width, _, pixels) = pixels(&folder.path().join("s.png"));
        let at = 3 * (30 * width + 10);
        [pixels[at], pixels[at + 1], pixels[at + 2]]
    };
    let exact = color(r#"{ "sphere": { "radius": 1 } }"#, "slope");
    assert!(exact.iter().all(|&channel| channel > 235), "{exact:?}");
    let slow = color(r#"{ "formula": "sqrt(x^2 + y^2 + z^2)/2 - 1" }"#, "slope");
    assert!(slow[2] > slow[0] + 60, "{slow:?}");
    let fast = color(r#"{ "formula": "2*sqrt(x^2 + y^2 + z^2) - 2" }"#, "slope");
    assert!(fast[0] > fast[2] + 60, "{fast:?}");
    // One step from an exact distance, dark; many from a bound far away, light.
    let (one, many) = (
        color(r#"{ "sphere": { "radius": 1 } }"#, "steps"),
        color(r#"{ "formula": "(sqrt(x^2 + y^2 + z^2) - 1)/9" }"#, "steps"),
    );
    assert!(one.iter().all(|&channel| channel < 100) && many[0] > 200, "{one:?} {many:?}");
}

#[test]
fn lines_are_written_with_their_values() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("s.json"), scene(r#"{ "circle": { "radius": 1 } }"#)).expect("can write");
    let args =
        ["slice", "s.json", "--lines", "0.25", "--span", "4", "--width", "400", "--height", "400", "-o", "s.svg"];
    let (code, text) = run(folder.path(), &args);
    assert_eq!(code, 0, "{text}");
    let svg = std::fs::read_to_string(folder.path().join("s.svg")).expect("there");
    for value in ["-0.75", "-0.5", "-0.25", "0", "0.25", "1", "1.75"] {
        let group = svg.split("<g data-value=\"").find(|group| group.starts_with(&format!("{value}\"")));
        let group = group.unwrap_or_else(|| panic!("no line at {value}"));
        // All points lie on the circle of that radius around the middle, a hundred pixels to the unit.
        let data = group.split("<path d=\"M").nth(1).and_then(|rest| rest.split(['Z', '"']).next()).expect("a path");
        let mut count = 0;
        for point in data.split('L') {
            let numbers: Vec<f64> = point.split(' ').map(|number| number.parse().expect("a number")).collect();
            let radius = (numbers[0] - 200.0).hypot(numbers[1] - 200.0) / 100.0;
            let expected = 1.0 + value.parse::<f64>().expect("a number");
            assert!((radius - expected).abs() < 2e-3, "{value}: {radius}");
            count += 1;
        }
        assert!(count > 15, "{value}: {count} points");
    }
}

#[test]
fn scenes_of_figures_are_drawn_as_slices_and_refused_by_what_traces_rays() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |text: String| std::fs::write(folder.path().join("s.json"), text).expect("can write");
    write(scene(r#"{ "circle": { "radius": 1 } }"#));
    assert_eq!(run(folder.path(), &["check", "s.json"]), (0, String::new()));
    assert_eq!(run(folder.path(), &["render", "s.json", "-o", "r.png"]).0, 0);
    assert_eq!(run(folder.path(), &["slice", "s.json", "-o", "s.png"]).0, 0);
    let [rendered, sliced] = ["r.png", "s.png"].map(|name| pixels(&folder.path().join(name)));
    assert!(rendered == sliced);
    assert_eq!(run(folder.path(), &["render", "s.json", "-o", "c.png", "--crop", "30,20,11,7"]).0, 0);
    let ((width, height, cut), (whole_width, _, whole)) = (pixels(&folder.path().join("c.png")), rendered);
    assert_eq!((width, height), (11, 7));
    for (y, row) in cut.chunks(3 * width).enumerate() {
        let start = 3 * ((y + 20) * whole_width + 30);
        assert!(*row == whole[start..start + 3 * width], "row {y} of the crop");
    }
    for args in [
        &["compare", "s.json"][..],
        &["shader", "s.json", "--target", "wgsl"],
        &["sweep", "s.json", "--vary", "objects[0].shape.circle.radius=1,2"],
    ] {
        let (code, text) = run(folder.path(), args);
        assert!(code == 1 && text.contains("plane figure"), "{args:?}: {text}");
    }
    for (args, message) in [
        (&["slice", "s.json", "--axis", "x"][..], "lies in the plane of x and y"),
        (&["slice", "s.json", "-o", "s.bmp"], "must be .png, .exr or .svg"),
        (&["slice", "s.json", "--span", "0"], "a width above 0"),
        (&["slice", "s.json", "--middle", "1"], "two numbers"),
        (&["render", "s.json", "--backend", "gpu"], "on the CPU"),
    ] {
        let (code, text) = run(folder.path(), args);
        assert!(code == 2 && text.contains(message), "{args:?}: {text}");
    }
    let (code, text) = run(folder.path(), &["slice", "s.json", "--lines", "1e-6", "-o", "s.svg"]);
    assert!(code == 1 && text.contains("more than 10000 lines"), "{text}");
    write(scene(r#"{ "circle": { "radius": 1 } } }, { "shape": { "sphere": { "radius": 1 } }"#));
    let (code, text) = run(folder.path(), &["check", "s.json"]);
    assert!(code == 1 && text.contains("makes a plane figure, which has no height"), "{text}");
}
