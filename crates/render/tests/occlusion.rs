//! Ambient occlusion: what cells and first-order clearances make of it, beside the definition in double precision.

mod common;

use common::*;
use freikugel_field::shapes::*;
use freikugel_field::{Field, Structure};
use freikugel_render::Renderer;
use freikugel_scene::{Ambient, Method, Occlusion, Scene, Tracer};
use glam::DVec3;

const REACH: f64 = 0.5;
const HEIGHT: f64 = 6.0;
const PIXELS: u32 = 96;

/// Shapes in nothing but ambient light, seen from above.
fn scene(shapes: impl IntoIterator<Item = Field>) -> Scene {
    let ambient = Ambient { sky: [1.0; 3], ground: [1.0; 3] };
    let occlusion = Some(Occlusion { strength: 1.0, reach: Some(REACH) });
    let mut scene = Scene { ambient, occlusion, camera: Some(from_above(8.0, HEIGHT)), ..dark() };
    for shape in shapes {
        add(&mut scene, shape, chalk());
    }
    scene
}

/// Renders a scene and compares each pixel with what the distances of `field` make of its hit. Returns the mean and the
/// largest difference, and the brightness of the darkest hit.
fn judge(scene: &Scene, field: &Field) -> [f64; 3] {
    let options = options(PIXELS, PIXELS);
    let image = picture(scene, &options).image;
    let layers = Renderer::new(scene).expect("sound").layers(&options, &()).expect("layers").0;
    let program = Structure::compile(std::slice::from_ref(field)).expect("sound").program(DVec3::ZERO);
    let (mut sum, mut most, mut darkest, mut hits) = (0.0, 0.0_f64, 1.0_f64, 0);
    for (index, (layer, color)) in layers.pixels().iter().zip(image.pixels()).enumerate() {
        if layer.object.is_none() {
            continue;
        }
        let along = |pixel: usize| ((pixel as f64 + 0.5) / f64::from(PIXELS) - 0.5) * HEIGHT;
        let (x, y) = (along(index % PIXELS as usize), -along(index / PIXELS as usize));
        let hit = DVec3::new(x, y, 8.0 - f64::from(layer.distance));
        let normal = DVec3::from_array(layer.normal.map(f64::from));
        let (mut occluded, mut all) = (0.0, 0.0);
        for sample in 1..=5 {
            let (height, weight) = (REACH * f64::from(sample) / 5.0, 0.5_f64.powi(sample));
            occluded += weight * (height - program.value(hit + normal * height)).max(0.0);
            all += weight * height;
        }
        let expected = (1.0 - occluded / all).clamp(0.0, 1.0);
        let difference = (expected - f64::from(color[0])).abs();
        (sum, most, darkest, hits) = (sum + difference, most.max(difference), darkest.min(expected), hits + 1);
    }
    assert!(hits > 1000, "{hits} hits");
    [sum / f64::from(hits), most, darkest]
}

#[test]
fn samples_in_cells_see_what_the_whole_field_sees() {
    let crowd = (0..60).map(|i| {
        let (x, y) = (f64::from(i % 8) * 0.6 - 2.1, f64::from(i / 8) * 0.6 - 2.1);
        match i % 3 {
            0 => sphere(0.33).at([x, y, 0.2]),
            _ => cuboid([0.5, 0.45, 0.3 + 0.1 * f64::from(i % 5)]).rotate([1.0, 0.0, 1.0], 20.0).at([x, y, 0.0]),
        }
    });
    let crowd: Vec<Field> = crowd.chain([plane([0.0, 0.0, 1.0]).into()]).collect();
    let whole = union(crowd.clone());
    // Once every object on its own, so that the ground is met exactly, once all in one union; and without cells.
    for shapes in [crowd, vec![whole.clone()]] {
        for method in [Method::Auto, Method::Sphere] {
            let scene = Scene { tracer: Tracer { method, ..Tracer::default() }, ..scene(shapes.clone()) };
            let [mean, most, darkest] = judge(&scene, &whole);
            assert!(mean < 1e-5 && most < 1e-3, "{method:?}: {mean}, at most {most}");
            assert!(darkest < 0.7, "there are dark corners: {darkest}");
        }
    }
}

#[test]
fn a_formula_is_as_dark_in_corners_as_the_distance_it_stands_for() {
    let distance = cuboid([4.0, 4.0, 0.5]) | cuboid([0.5, 3.0, 3.0]);
    for factor in [0.01, 1.0, 100.0] {
        let block = |[x, y, z]: [f64; 3]| {
            let [a, b, c] = ["x", "y", "z"].map(|axis| format!("max(abs({axis}) - "));
            let outside = format!("sqrt({a}{x}, 0)^2 + {b}{y}, 0)^2 + {c}{z}, 0)^2)");
            format!("({outside} + min(max(abs(x) - {x}, abs(y) - {y}, abs(z) - {z}), 0))")
        };
        let text = format!("{factor} * min({}, {})", block([2.0, 2.0, 0.25]), block([0.25, 1.5, 1.5]));
        let formula: Field = formula(&text).within_box([8.0, 8.0, 8.0]).into();
        let [mean, most, darkest] = judge(&scene([formula]), &distance);
        assert!(mean < 1e-4, "factor {factor}: {mean}, at most {most}");
        assert!(darkest < 0.7, "there are dark corners: {darkest}");
    }
}
