//! The field of every shape, on the graphics processor and on the CPU, at points around it.

mod common;

use freikugel_field::{Evaluator, Points, Structure, shapes};
use freikugel_gpu::GpuRenderer;
use freikugel_render::Renderer;
use freikugel_scene::Scene;
use glam::DVec3;

/// Points for each shape.
const POINTS: usize = 10_000;

/// How far the points go beyond the shape, relative to its size.
const BEYOND: f64 = 0.5;

/// Values may differ by this part of the largest coordinate or value: some tens of roundings of single precision, since
/// graphics processors may fuse, reorder, and take functions from tables (WGSL grants square roots and divisions 2.5 ulp, powers
/// and sines more).
const VALUES: f64 = 4e-6;

/// Gradients may differ by this length.
const GRADIENTS: f64 = 2e-3;

/// How far, relative to the size, a crease may be from a point whose gradient belongs to one side on one processor and to the
/// other side on the other.
const CREASE: f64 = 1e-4;

/// The part of the points that may lie on creases.
const ON_CREASES: f64 = 0.01;

/// Numbers from 0 to 1, the same each time.
fn numbers(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        // SplitMix64 (Steele, Lea, Flood 2014).
        seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// What is wrong with a shape's field on the graphics processor, and what was seen.
fn compare(gpu: &std::sync::Arc<freikugel_gpu::Gpu>, name: &str, scene: &Scene) -> Result<String, String> {
    let mut renderer = GpuRenderer::new(gpu, scene).map_err(|error| format!("{name}: {error}"))?;
    let extent = Renderer::new(scene).expect("the example can be rendered").extent();
    let (middle, half) = extent.map_or((DVec3::ZERO, DVec3::ONE), |extent| (extent.center(), extent.size() / 2.0));
    let mut number = numbers(7);
    // Points in single precision, relative to the origin, are the same on both processors.
    let origin = renderer.origin();
    let reach = half * (1.0 + BEYOND) + half.max_element() * 0.1;
    let relative: Vec<glam::Vec3> = (0..POINTS)
        .map(|_| {
            let unit = DVec3::new(number(), number(), number()) * 2.0 - 1.0;
            (middle - origin + unit * reach).as_vec3()
        })
        .collect();
    let points: Vec<DVec3> = relative.iter().map(|point| origin + point.as_dvec3()).collect();
    let found = renderer.probe(&points).map_err(|error| format!("{name}: {error}"))?;

    let fields: Vec<_> = scene.objects.iter().map(|object| object.shape.clone()).collect();
    let program = Structure::compile(&fields).expect("the example is sound").program(origin);
    let axis = |axis: usize| relative.iter().map(|point| point[axis]).collect::<Vec<f32>>();
    let [x, y, z] = [axis(0), axis(1), axis(2)];
    let mut values = vec![0.0; POINTS];
    let mut gradients = [vec![0.0; POINTS], vec![0.0; POINTS], vec![0.0; POINTS]];
    let [gx, gy, gz] = &mut gradients;
    Evaluator::new(&program).gradients(Points { x: &x, y: &y, z: &z }, &mut values, [gx, gy, gz]);

    let size = reach.max_element();
    let (mut worst_value, mut worst_gradient, mut on_creases) = (0.0f64, 0.0f64, 0);
    for (index, (gradient, value)) in found.into_iter().enumerate() {
        let point = relative[index].as_dvec3();
        let expected = f64::from(values[index]);
        let slope = DVec3::new(gradients[0][index].into(), gradients[1][index].into(), gradients[2][index].into());
        // A steep field turns roundings of coordinates into larger ones of values.
        let scale = (point.abs().max_element() * slope.length().max(1.0)).max(expected.abs());
        worst_value = worst_value.max((value - expected).abs() / scale);
        let off = (gradient - slope).length() / slope.length().max(1.0);
        if off > GRADIENTS {
            let world = points[index];
            let steps = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
            let mut sides = steps.map(|axis| program.gradient(world + axis * (CREASE * size)).1);
            let own = program.gradient(world).1;
            if sides.any(|side| (side - own).length() > 0.5 * (gradient - slope).length()) {
                on_creases += 1;
                continue;
            }
        }
        worst_gradient = worst_gradient.max(off);
    }
    let summary = format!("{name}: values {worst_value:.1e}, gradients {worst_gradient:.1e}, {on_creases} on creases");
    let is_good =
        worst_value <= VALUES && worst_gradient <= GRADIENTS && f64::from(on_creases) <= ON_CREASES * POINTS as f64;
    if is_good { Ok(summary) } else { Err(summary) }
}

#[test]
fn every_shape_has_the_same_field_on_both_processors() {
    let gpu = common::gpu();
    let mut faults = Vec::new();
    for shape in shapes::ALL {
        let name = shape.about.name;
        let text = format!(
            r##"{{ "version": 1, "materials": {{ "clay": {{ "color": "#c8825a" }} }}, "objects": [{{ "shape": {} }}] }}"##,
            shape.about.example
        );
        match compare(&gpu, name, &common::scene(&text, name)) {
            Ok(summary) => println!("{summary}"),
            Err(fault) => {
                println!("{fault} !");
                faults.push(fault);
            }
        }
    }
    assert!(faults.is_empty(), "{} shapes differ:\n{}", faults.len(), faults.join("\n"));
}
