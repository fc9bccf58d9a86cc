//! Small pictures against the ones kept in `golden/`.
//!
//! `BLESS=1 cargo test -p freikugel-render --test golden` writes them anew; look at them before you commit.

mod common;

use common::*;
use freikugel_field::MaterialId;
use freikugel_field::shapes::*;
use freikugel_render::{Compression, Image, Options, Tone, encode_png};
use freikugel_scene::{
    Ambient, Background, Camera, Light, Material, Model, Object, Occlusion, Overbright, Pattern, Point, Scene, Shadow,
    Spot, Sun,
};
use glam::DVec3;
use std::fs;
use std::io::Cursor;
use std::path::Path;

/// A byte may differ by this much, on account of powers that other machines round otherwise.
const SLIGHT: u8 = 2;

/// So many pixels may differ by more: where an edge falls on the other side of a ray.
const OUTLIERS: usize = 12;

fn check(name: &str, scene: &Scene, tone: &Tone) {
    let options = Options { samples: 9, ..options(64, 48) };
    let file = encode_png(&picture(scene, &options).image, tone, Compression::Thorough).expect("a file");
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("{name}.png"));
    if std::env::var_os("BLESS").is_some() {
        fs::create_dir_all(kept.parent().expect("a directory")).expect("a place for golden pictures");
        fs::write(&kept, file).expect("room for a golden picture");
        return;
    }
    let expected = fs::read(&kept).unwrap_or_else(|error| {
        panic!("{}: {error}; BLESS=1 makes it", kept.display());
    });
    let (new, old) = (pixels(&file), pixels(&expected));
    assert_eq!(new.len(), old.len(), "{name} has another size");
    let differences: Vec<u8> = new.iter().zip(&old).map(|(a, b)| a.abs_diff(*b)).collect();
    let outliers = differences.chunks(3).filter(|pixel| pixel.iter().any(|&d| d > SLIGHT)).count();
    if outliers > OUTLIERS {
        // New, old, and eight times their difference, side by side.
        let panels = [new, old, differences.iter().map(|&d| d.saturating_mul(8)).collect()];
        let row = |y: usize| panels.iter().flat_map(move |panel| panel[y * 192..(y + 1) * 192].chunks(3));
        let colors = (0..48)
            .flat_map(row)
            .map(|p| [p[0], p[1], p[2]].map(|c| freikugel_scene::color::linear(f64::from(c) / 255.0) as f32))
            .collect();
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
        fs::create_dir_all(&directory).expect("a place for the difference");
        let path = directory.join(format!("{name}.png"));
        let panels =
            encode_png(&Image::new(3 * 64, 48, colors), &Tone::default(), Compression::Thorough).expect("a file");
        fs::write(&path, panels).expect("room for the difference");
        panic!("{outliers} pixels of {name} differ; see new, old, difference in {}", path.display());
    }
}

fn pixels(file: &[u8]) -> Vec<u8> {
    let mut reader = png::Decoder::new(Cursor::new(file)).read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a small picture")];
    reader.next_frame(&mut bytes).expect("pixels");
    bytes
}

/// A cup: differences, rounded edges, a soft sun, hemispheric light with occlusion.
#[test]
fn cup() {
    let mut scene = Scene {
        camera: Some(Camera { eye: DVec3::new(3.0, -5.0, 3.5), ..Camera::default() }),
        ambient: Ambient { sky: [0.35, 0.45, 0.6], ground: [0.2, 0.15, 0.1] },
        background: Background::Gradient { top: [0.3, 0.5, 0.9], bottom: [0.9, 0.9, 0.9] },
        occlusion: Some(Occlusion::default()),
        ..dark()
    };
    let direction = DVec3::new(1.5, -1.0, 2.0);
    scene.lights.push(Light::Sun(Sun { direction, shadow: Shadow::Hardness(12.0), ..Sun::default() }));
    let clay = Material { color: Pattern::Solid([0.6, 0.25, 0.12]), ..Material::default() };
    add(&mut scene, cylinder(1.0, 2.0).round(0.05) - cylinder(0.85, 2.0).at([0.0, 0.0, 0.2]), clay);
    add(&mut scene, plane([0.0, 0.0, 1.0]).offset_by(-1.0), Material::default());
    check("cup", &scene, &Tone::default());
}

/// A blend of two materials on a checkered ground, a lamp with its own clearance, overbright pixels scaled down.
#[test]
fn blend() {
    let mut scene = Scene {
        camera: Some(Camera { eye: DVec3::new(0.5, -5.0, 2.5), ..Camera::default() }),
        ambient: Ambient { sky: [0.1; 3], ground: [0.05; 3] },
        ..dark()
    };
    scene.lights.push(Light::Point(Point {
        position: DVec3::new(-2.0, -2.5, 3.5),
        intensity: 40.0,
        shadow: Shadow::Clearance { angle: None },
        ..Point::default()
    }));
    let paint = |color| Material { color: Pattern::Solid(color), model: Model::Phong, ..Material::default() };
    scene.materials = vec![("a".into(), paint([0.8, 0.1, 0.1])), ("b".into(), paint([0.1, 0.2, 0.8]))];
    let shape = smooth_union(
        0.4,
        [
            sphere(0.7).at([-0.5, 0.0, 0.2]).painted(MaterialId(0)),
            torus(0.7, 0.25).rotate([0.0, 1.0, 0.0], 30.0).at([0.6, 0.0, 0.0]).painted(MaterialId(1)),
        ],
    );
    scene.objects.push(Object { name: "blend".into(), material: None, shape });
    let colors = [[0.8; 3], [0.1, 0.3, 0.2]];
    let checker = Pattern::Checker { colors, size: 0.5 };
    add(&mut scene, plane([0.0, 0.0, 1.0]).offset_by(-0.6), Material { color: checker, ..Material::default() });
    check("blend", &scene, &Tone { exposure: 0.5, overbright: Overbright::ScaleDown });
}

/// A framed scene without ground: spot, hard shadow within an object, orthographic after all defaults failed to apply.
#[test]
fn frame() {
    let mut scene = Scene { background: Background::Solid([0.02, 0.02, 0.05]), ..dark() };
    scene.lights.push(Light::Spot(Spot {
        position: DVec3::new(3.0, -4.0, 5.0),
        angle: 0.6,
        softness: 0.3,
        intensity: 60.0,
        ..Spot::default()
    }));
    scene.lights.push(Light::Sun(Sun {
        direction: DVec3::new(-1.0, -1.0, 0.5),
        color: [0.3, 0.4, 0.8],
        intensity: 0.4,
        ..Sun::default()
    }));
    let frame = cuboid([2.0, 2.0, 2.0]).round(0.1)
        - cuboid([3.0, 1.4, 1.4])
        - cuboid([1.4, 3.0, 1.4])
        - cuboid([1.4, 1.4, 3.0]);
    add(&mut scene, frame | sphere(0.5), Material { specular: 0.5, ..Material::default() });
    check("frame", &scene, &Tone::default());
}
