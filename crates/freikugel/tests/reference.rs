//! A picture against that of another renderer, which intersects the same solids in closed form: geometry, camera, lights,
//! shadows and shading have to agree.

use freikugel::prelude::*;
use std::path::Path;

/// The reference was made with POV-Ray 3.7 from scenes/bench/pov/s1_csg.pov, 320x180 without antialiasing, its checkered
/// ground replaced by one of reflectance 0.55: our checkers are filtered over the pixel, POV-Ray's are not.
const REFERENCE: &str = "tests/reference/s1-plain.png";

/// Differences of 8-bit values above this count as another surface or another shadow.
const TOLERANCE: u8 = 6;

/// The share of pixels that may differ: those whose centre is so near an edge that rounding decides.
const EDGES: f64 = 0.002;

#[test]
fn the_csg_scene_looks_as_in_another_renderer() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(folder.join("../../scenes/bench/s1-csg.json")).expect("the scene is there");
    let checker = r#"{ "checker": { "colors": [[0.25, 0.25, 0.25], [0.85, 0.85, 0.85]], "size": 1 } }"#;
    assert!(text.contains(checker), "the ground of the scene has changed");
    let scene = freikugel::scene::read(&text.replace(checker, "[0.55, 0.55, 0.55]")).scene.expect("a sound scene");
    let options = Options { width: 320, height: 180, samples: 1, ..Options::of(&scene) };
    let rendered = freikugel::render::render(&scene, &options, &()).expect("it renders");
    let ours = rendered.image.to_srgb8(&freikugel::render::Tone::of(&scene.picture));

    let file = std::fs::File::open(folder.join(REFERENCE)).expect("the reference is there");
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a picture");
    let mut theirs = vec![0; reader.output_buffer_size().expect("fits")];
    let info = reader.next_frame(&mut theirs).expect("a frame");
    assert_eq!((info.width, info.height, theirs.len()), (320, 180, ours.len()));

    let differs = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > TOLERANCE);
    let different = ours.chunks(3).zip(theirs.chunks(3)).filter(differs).count();
    let share = different as f64 / f64::from(320 * 180);
    println!("{different} pixels differ");
    assert!(share <= EDGES, "{different} pixels differ by more than {TOLERANCE}: {:.2} %", 100.0 * share);
}
