//! What shaders compute is what the processor computes: fields, gradients, and what pixels show, by an interpreter of the form
//! that all text comes from.

mod common;
#[path = "../../field/tests/common/mod.rs"]
mod fields;

use common::{Machine, Value, read, scene_of};
use fields::Random;
use freikugel_field::{Structure, shapes};
use freikugel_render::{Options, Renderer};
use freikugel_scene::Scene;
use freikugel_shader::{Shader, Show, Target, View};
use glam::DVec3;
use std::path::Path;

/// Points for each shape.
const POINTS: usize = 150;

/// Parameters are rounded to single precision, which is all that may differ: some units in the last place of coordinates, as
/// often as a formula magnifies them.
const ROUNDING: f64 = 2e-4;

/// A share of the points may lie at an edge, where another side is taken for the derivative.
const AT_EDGES: f64 = 0.03;

/// A scene of one object, whose field is to be that of the processor.
fn assert_agreement(name: &str, scene: &Scene) {
    let shader = Shader::new(scene).expect("a shader");
    let parameters = shader.parameters(scene).expect("parameters");
    let machine = Machine::new(&shader, &parameters, &View::of(1, 1));
    let field = Structure::compile(&[scene.objects[0].shape.clone()]).expect("a field").program(DVec3::ZERO);
    let mut at_edges = 0;
    let mut random = Random::new(1);
    for p in (0..POINTS).map(|_| random.point(1.5)) {
        let relative = Value::Vector((p - parameters.origin()).to_array().to_vec());
        let out = machine.call("field_gradient", vec![relative]);
        let [x, y, z, value] = *out.vector() else { panic!("four numbers") };
        let (expected, gradient) = field.gradient(p);
        let reach = ROUNDING * (1.0 + gradient.length());
        assert!((value - expected).abs() < reach, "{name} at {p}: {value}, not {expected}");
        let is_same = gradient.distance(DVec3::new(x, y, z)) < 50.0 * reach;
        at_edges += usize::from(!is_same);
    }
    assert!((at_edges as f64) < AT_EDGES * POINTS as f64, "{name}: {at_edges} gradients differ");
}

#[test]
fn fields_and_gradients_agree_for_every_shape() {
    for shape in shapes::ALL {
        assert_agreement(shape.about.name, &scene_of(shape.about.example));
    }
}

/// A shape at random places.
fn scattered(shape: &str, random: &mut Random, count: usize) -> String {
    let copies = (0..count).map(|_| {
        let [x, y, z] = random.point(1.0).to_array();
        let angle = random.range(0.0, 90.0);
        let turned = format!(r#"{{ "rotate": {{ "axis": [1, 2, 3], "angle": {angle}, "shape": {shape} }} }}"#);
        format!(r#"{{ "translate": {{ "by": [{x}, {y}, {z}], "shape": {turned} }} }}"#)
    });
    copies.collect::<Vec<_>>().join(", ")
}

#[test]
fn fields_agree_where_steps_come_in_rounds() {
    let mut random = Random::new(3);
    let balls = scattered(r#"{ "sphere": { "radius": 0.2 } }"#, &mut random, 30);
    let boxes =
        scattered(r#"{ "scale": { "factor": 0.8, "shape": { "box": { "size": [0.3, 0.2, 0.4] } } } }"#, &mut random, 7);
    let blend = format!(r#"{{ "smooth_union": {{ "k": 0.2, "shapes": [{balls}] }} }}"#);
    let carved = format!(r#"{{ "difference": [{blend}, {boxes}] }}"#);
    let moved =
        format!(r#"{{ "twist": {{ "rate": 20, "shape": {{ "offset": {{ "by": 0.05, "shape": {carved} }} }} }} }}"#);
    // What comes before a chain, after it, and between the rounds of two is not taken for a part of one.
    let round = r#"{ "sphere": { "radius": 0.3 } }"#;
    let mixed = format!(r#"{{ "smooth_difference": {{ "k": 0.1, "shapes": [{round}, {balls}, {boxes}, {balls}] }} }}"#);
    let swept = r#"{ "intersection": [ { "translate": { "by": [0.1, 0.2, 0.3], "shape": { "sweep": { "points": [[-1, 0, 0], [0, 0.4, 0.3],
        [1, 0, 0]], "shape": { "smooth_union": { "k": 0.05, "shapes": [{ "circle": { "radius": 0.1 } },
        { "rectangle": { "size": [0.3, 0.1] } }] } } } } } }, { "sphere": { "radius": 1 } } ] }"#;
    for (name, shape) in [("carved", &*carved), ("moved", &*moved), ("mixed", &*mixed), ("swept", swept)] {
        let scene = scene_of(shape);
        assert_agreement(name, &scene);
        let shader = Shader::new(&scene).expect("a shader");
        let parameters = shader.parameters(&scene).expect("parameters");
        let text = shader.text(Target::Wgsl, &parameters).expect("text");
        assert!(text.contains("var piece"), "{name} has a loop");
    }
}

/// How many pixels of a small picture differ by more than 8 steps of 8 bits, and the mean difference in such steps.
fn difference(scene: &Scene, width: u32, height: u32) -> (usize, f64) {
    let mut scene = scene.clone();
    (scene.picture.width, scene.picture.height, scene.picture.samples) = (width, height, 1);
    let options = Options { threads: Some(1), ..Options::of(&scene) };
    let rendered = freikugel_render::render(&scene, &options, &()).expect("a picture");
    let shader = Shader::new(&scene).expect("a shader");
    let parameters = shader.parameters(&scene).expect("parameters");
    let machine = Machine::new(&shader, &parameters, &View::of(width, height));
    let tone = freikugel_render::Tone::of(&scene.picture);
    let expected = rendered.image.to_srgb8(&tone);
    let (mut outliers, mut sum) = (0, 0.0);
    for (index, expected) in expected.chunks(3).enumerate() {
        let (column, row) = (index as u32 % width, index as u32 / width);
        let raster = Value::Vector(vec![f64::from(column) + 0.5, f64::from(row) + 0.5]);
        let ray = machine.call("camera_ray", vec![raster]);
        let color = machine.call("shown_along", vec![ray]);
        let differences = color.vector().iter().zip(expected).map(|(c, e)| (c * 255.0 - f64::from(*e)).abs());
        let largest = differences.clone().fold(0.0, f64::max);
        outliers += usize::from(largest > 8.0);
        sum += differences.sum::<f64>() / 3.0;
    }
    (outliers, sum / f64::from(width * height))
}

/// Scenes, with as many pixels of 32 x 18 as may be off by more than 8 steps, and the mean difference of all.
///
/// Pixels are coarse here, and with them the tolerances: a ray that passes a silhouette within a sixteenth of a pixel may
/// hit on one side and pass on the other, and the edges of shadows move by as much. Where warped distances dim a light, the
/// processor goes by the slope of a cell, the shader by that at the point. Rounding to bytes alone makes a quarter of a step in
/// the mean.
const PICTURES: [(&str, usize, f64); 10] = [
    ("first-light.json", 2, 0.4),
    ("sources/blends.json", 1, 0.4),
    ("tracers/thin.json", 2, 0.4),
    ("bench/s1-csg.json", 2, 0.4),
    ("shapes/sheet.json", 1, 0.4),
    ("shapes/paint.json", 1, 0.4),
    ("shapes/warp.json", 1, 0.4),
    ("shapes/displace.json", 3, 0.6),
    ("shapes/formula.json", 1, 0.4),
    ("bench/s2-quartic.json", 1, 0.4),
];

#[test]
fn pictures_agree() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    for (file, outliers, most) in PICTURES {
        let (found, mean) = difference(&read(&folder.join(file)), 32, 18);
        println!("{file}: {found} outliers, mean {mean:.3}");
        assert!(mean < most && found <= outliers, "{file}: {found} outliers, mean {mean}");
    }
}

#[test]
fn layers_agree() {
    let mut scene = read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join("first-light.json"));
    (scene.picture.width, scene.picture.height, scene.picture.samples) = (24, 14, 1);
    let renderer = Renderer::new(&scene).expect("a renderer");
    let (layers, _) = renderer.layers(&Options::of(&scene), &()).expect("layers");
    let shader = Shader::new(&scene).expect("a shader");
    let parameters = shader.parameters(&scene).expect("parameters");
    let mut others = 0;
    for show in [Show::LayerNormal, Show::LayerNumbers] {
        let machine = Machine::new(&shader, &parameters, &View { show, ..View::of(24, 14) });
        for (index, layer) in layers.pixels().iter().enumerate() {
            let raster = Value::Vector(vec![(index % 24) as f64 + 0.5, (index / 24) as f64 + 0.5]);
            let ray = machine.call("camera_ray", vec![raster]);
            let out = machine.call("sample_along", vec![ray]);
            let out = out.vector();
            let is_same = match show {
                Show::LayerNormal => {
                    let distance = if layer.distance.is_finite() { f64::from(layer.distance) } else { -1.0 };
                    let normal: f64 = (0..3).map(|i| (out[i] - f64::from(layer.normal[i])).abs()).sum();
                    (out[3] - distance).abs() < 2e-2 && normal < 0.15
                }
                _ => out[1] == layer.object.map_or(-1.0, f64::from),
            };
            others += usize::from(!is_same);
        }
    }
    assert!(others <= 4, "{others} pixels differ");
}
