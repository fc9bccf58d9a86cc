//! Honest tracing: what is given up is counted, what is empty stays empty, and no number goes astray.

mod common;

use common::*;
use freikugel_field::shapes::*;
use freikugel_field::{Field, MaterialId};
use freikugel_render::{Options, PrepareError, RenderError, Renderer, render};
use freikugel_scene::{
    Ambient, Background, Camera, Light, Material, Method, Object, Occlusion, Pattern, Point, Scene, Shadow, Sun, Tracer,
};
use glam::DVec3;

const WHITE: Ambient = Ambient { sky: [1.0; 3], ground: [1.0; 3] };

fn still_life() -> Scene {
    let mut scene = Scene { ambient: WHITE, occlusion: Some(Occlusion::default()), ..dark() };
    scene.lights.push(Light::Sun(Sun { direction: DVec3::new(1.0, -1.0, 2.0), ..Sun::default() }));
    add(&mut scene, torus(1.0, 0.4) | sphere(0.5), Material::default());
    add(&mut scene, plane([0.0, 0.0, 1.0]).offset_by(-0.5), chalk());
    scene
}

#[test]
fn rays_out_of_steps_are_counted_and_are_neither_hits_nor_misses() {
    let size = options(48, 32);
    let mut scene = still_life();
    let good = picture(&scene, &size).stats;
    assert_eq!(good.unresolved, Default::default());

    scene.tracer = Tracer { max_steps: 3, ..Tracer::default() };
    let poor = picture(&scene, &size).stats;
    assert!(poor.unresolved.pixels > 100, "{poor:?}");
    assert_eq!(poor.unresolved.pixels, poor.unresolved.camera, "one ray for each pixel");
    assert!(poor.unresolved.shadow > 0);
    assert!(poor.steps <= 3 * (poor.rays.camera + poor.rays.shadow));

    // Several unresolved rays make one unresolved pixel.
    let many = picture(&scene, &Options { samples: 16, ..size }).stats;
    assert!(many.unresolved.pixels < many.unresolved.camera && many.unresolved.pixels <= 48 * 32);
}

#[test]
fn an_empty_scene_is_its_background() {
    let scene = Scene { background: Background::Solid([0.25, 0.5, 0.75]), ..dark() };
    let rendered = picture(&scene, &options(8, 8));
    assert!(rendered.image.pixels().iter().all(|&c| c == [0.25, 0.5, 0.75]));
    assert_eq!((rendered.stats.hits, rendered.stats.evaluations), (0, 0));

    // So is one whose only object has no surface.
    let mut scene = scene;
    add(&mut scene, sphere(1.0) & sphere(1.0).at([5.0, 0.0, 0.0]), chalk());
    assert_eq!(picture(&scene, &options(8, 8)).stats.hits, 0);
}

#[test]
fn planes_alone_need_no_marching() {
    let mut scene = Scene { ambient: WHITE, occlusion: Some(Occlusion::default()), ..dark() };
    scene.lights.push(Light::Point(Point { position: DVec3::Z, ..Point::default() }));
    add(&mut scene, plane([0.0, 0.0, 1.0]), chalk());
    add(&mut scene, sheet([0.0, 1.0, 0.0]).offset_by(2.0), Material::default());
    let rendered = picture(&scene, &options(32, 24));
    assert_eq!(rendered.stats.steps, 0);
    assert!(rendered.stats.hits > 0 && rendered.stats.rays.occlusion > 0);
}

#[test]
fn a_sheet_is_lit_on_the_side_that_is_seen() {
    for side in [-1.0, 1.0] {
        let eye = DVec3::new(0.0, -4.0 * side, 0.0);
        let mut scene = Scene { camera: Some(Camera { eye, ..Camera::default() }), ..dark() };
        let direction = DVec3::new(0.0, -side, 0.0);
        scene.lights.push(Light::Sun(Sun { direction, ..Sun::default() }));
        // Once alone, where it is intersected exactly, and once cut to a disc and marched.
        add(&mut scene, sheet([0.0, 1.0, 0.0]), chalk());
        let exact = picture(&scene, &options(9, 9)).image;
        scene.objects.clear();
        add(&mut scene, sheet([0.0, 1.0, 0.0]).offset(0.01) & sphere(3.0), chalk());
        let marched = picture(&scene, &options(9, 9)).image;
        for image in [exact, marched] {
            assert!((image.pixel(4, 4)[0] - 1.0).abs() < 1e-3, "{side}: {:?}", image.pixel(4, 4));
        }
    }
}

#[test]
fn a_camera_inside_an_object_sees_its_material_and_says_so() {
    let mut scene = still_life();
    let eye = DVec3::new(1.0, 0.0, 0.0);
    scene.camera = Some(Camera { eye, target: DVec3::ZERO, ..Camera::default() });
    let rendered = picture(&scene, &options(16, 16));
    assert_eq!(rendered.stats.inside, 256);
    assert_eq!(rendered.stats.hits, 256);
    assert_eq!(picture(&still_life(), &options(16, 16)).stats.inside, 0);

    // Below ground is inside the half-space.
    let eye = DVec3::new(0.0, -5.0, -2.0);
    scene.camera = Some(Camera { eye, target: DVec3::ZERO, ..Camera::default() });
    assert_eq!(picture(&scene, &options(16, 16)).stats.inside, 256);
}

#[test]
fn layers_tell_objects_apart_that_look_alike() {
    let mut scene = Scene { camera: Some(from_above(8.0, 4.0)), ..dark() };
    for x in [-1.0, 0.0, 1.0] {
        scene.objects.push(Object { name: x.to_string(), material: None, shape: sphere(0.4).at([x, 0.0, 0.0]) });
    }
    let layers = Renderer::new(&scene).expect("sound").layers(&options(40, 40), &()).expect("layers").0;
    let at = |column: usize| layers.pixels()[20 * 40 + column].object;
    assert_eq!([at(10), at(15), at(20), at(30)], [Some(0), None, Some(1), Some(2)]);
}

#[test]
fn a_flat_field_makes_no_false_hits() {
    // Stretched a hundred times along y, a ball's field falls to a hundredth of the distance beyond its tips. Stopping by
    // value alone would lengthen the needle by a hundred tolerances, here by 0.5.
    let shape = sphere(0.1).stretch([1.0, 100.0, 1.0]);
    let mut scene = Scene { camera: Some(from_above(50.0, 6.0)), ambient: WHITE, ..dark() };
    scene.camera.as_mut().expect("a camera").eye.y = 12.0;
    scene.camera.as_mut().expect("a camera").target.y = 12.0;
    scene.tracer = Tracer { precision: 1e-4, max_steps: 100_000, ..Tracer::default() };
    add(&mut scene, shape, chalk());
    // Something beyond the picture, so that the objects' box does not end at the tip.
    add(&mut scene, sphere(0.1).at([0.0, 30.0, 0.0]), chalk());
    let rendered = picture(&scene, &options(5, 121));
    assert_eq!(rendered.stats.unresolved.pixels, 0);
    // The column through the axis shows y from 15 at the top to 9 at the bottom.
    for row in 0..121 {
        let y = 15.0 - (f64::from(row) + 0.5) * 6.0 / 121.0;
        let is_hit = rendered.image.pixel(2, row)[0] > 0.0;
        if !(9.9..=10.2).contains(&y) {
            assert_eq!(is_hit, y < 10.0, "at {y}");
        }
    }
}

#[test]
fn far_away_is_as_good_as_near() {
    // The same parallel view from a thousand times the distance, and a million units away from the world's origin.
    let mut counts = Vec::new();
    for (distance, offset) in [(10.0, 0.0), (10_000.0, 0.0), (10.0, 1e6)] {
        let center = DVec3::new(offset, -offset, 0.0);
        let camera = Camera { eye: center - DVec3::Y * distance, target: center, ..from_above(1.0, 2.5) };
        let camera = Camera { up: DVec3::Z, ..camera };
        let mut scene = Scene { camera: Some(camera), ambient: WHITE, ..dark() };
        scene.tracer.max_distance = 1e6;
        scene.tracer.precision = 0.0;
        add(&mut scene, sphere(1.0).at(center), chalk());
        let rendered = picture(&scene, &options(100, 100));
        assert_eq!(rendered.stats.unresolved.pixels, 0);
        counts.push(rendered.stats.hits);
    }
    assert!(counts.iter().all(|count| count.abs_diff(counts[0]) <= 8), "{counts:?}");
}

#[test]
fn blends_mix_materials_and_unions_do_not() {
    let paint = |color| Material { color: Pattern::Solid(color), ..chalk() };
    let mut scene = Scene { ambient: WHITE, camera: Some(from_above(10.0, 2.0)), ..dark() };
    scene.materials = vec![("red".into(), paint([1.0, 0.0, 0.0])), ("blue".into(), paint([0.0, 0.0, 1.0]))];
    let ball = |x: f64, id| sphere(0.5).at([x, 0.0, 0.0]).painted(MaterialId(id));
    let mut at_the_seam = |shape| {
        scene.objects = vec![Object { name: "pair".into(), material: None, shape }];
        let image = picture(&scene, &options(101, 101)).image;
        let colors = [20, 50, 80].map(|x| image.pixel(x, 50));
        assert_eq!([colors[0], colors[2]], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], "far from the seam");
        colors[1]
    };
    let [r, g, b] = at_the_seam(smooth_union(0.3, [ball(-0.45, 0), ball(0.45, 1)]));
    assert!((r - 0.5).abs() < 0.05 && g == 0.0 && (r + b - 1.0).abs() < 1e-5, "{r} {g} {b}");
    let [r, g, b] = at_the_seam(ball(-0.45, 0) | ball(0.45, 1));
    assert!((r == 1.0 && b == 0.0) || (r == 0.0 && b == 1.0), "{r} {g} {b}");
}

#[test]
fn awkward_lights_and_materials_stay_numbers() {
    let mut scene = still_life();
    scene.lights.push(Light::Point(Point { position: DVec3::new(1.0, 0.0, 0.4), ..Point::default() }));
    scene.lights.push(Light::Point(Point {
        position: DVec3::new(1.0, 0.0, 0.0),
        shadow: Shadow::Clearance { angle: None },
        ..Point::default()
    }));
    scene.materials[0].1.exponent = 0.0;
    scene.materials[1].1.color = Pattern::Checker { colors: [[1.0; 3], [0.0; 3]], size: 1e-12 };
    for samples in [1, 5] {
        picture(&scene, &Options { samples, ..options(40, 30) });
    }
}

#[test]
fn a_scene_without_camera_is_framed() {
    for extra in [None, Some(plane([0.0, 0.0, 1.0]).into())] {
        let mut scene = Scene { ambient: WHITE, ..dark() };
        add(&mut scene, cuboid([1.0, 2.0, 0.5]).at([40.0, -30.0, 7.0]), chalk());
        if let Some(ground) = extra {
            scene.objects.push(Object { name: "ground".into(), material: None, shape: ground });
        }
        let renderer = Renderer::new(&scene).expect("a sound scene");
        let (layers, _) = renderer.layers(&options(64, 36), &()).expect("layers");
        let seen = |x: usize, y: usize| layers.pixels()[y * 64 + x].object == Some(0);
        assert!(seen(32, 18), "the box is in the middle");
        let border = (0..64).flat_map(|x| [(x, 0), (x, 35)]).chain((0..36).flat_map(|y| [(0, y), (63, y)]));
        assert!(border.into_iter().all(|(x, y)| !seen(x, y)), "and wholly visible");
    }
}

#[test]
fn layers_tell_distance_depth_normal_and_object() {
    let mut scene = Scene { ..dark() };
    scene.camera = Some(Camera { eye: DVec3::new(0.0, -5.0, 0.0), ..Camera::default() });
    add(&mut scene, sphere(1.0), chalk());
    add(&mut scene, plane([0.0, -1.0, 0.0]).offset_by(-2.0), chalk());
    let renderer = Renderer::new(&scene).expect("a sound scene");
    let (layers, stats) = renderer.layers(&options(161, 161), &()).expect("layers");
    assert_eq!(stats.rays.camera, 161 * 161);
    let middle = layers.pixels()[80 * 161 + 80];
    assert!((middle.distance - 4.0).abs() < 1e-3 && (middle.depth - 4.0).abs() < 1e-3, "{middle:?}");
    assert!((middle.normal[1] + 1.0).abs() < 1e-4 && middle.object == Some(0) && middle.steps > 0);
    let corner = layers.pixels()[0];
    assert!((corner.depth - 7.0).abs() < 1e-4 && corner.distance > 7.5, "{corner:?}");
    assert_eq!((corner.normal, corner.object), ([0.0, -1.0, 0.0], Some(1)));
}

#[test]
fn faults_are_reported() {
    let fault = |scene: &Scene, options: &Options| match render(scene, options, &()) {
        Err(error) => error,
        Ok(_) => panic!("there should be no picture"),
    };
    let good = options(8, 8);
    let mut scene = dark();
    add(&mut scene, sphere(-1.0), chalk());
    add(&mut scene, torus(-1.0, 0.1), chalk());
    match fault(&scene, &good) {
        RenderError::Prepare(PrepareError::Fields(all)) => assert_eq!(all.len(), 2, "{all:?}"),
        other => panic!("{other}"),
    }
    let eye = DVec3::ONE;
    let blind = Scene { camera: Some(Camera { eye, target: eye, ..Camera::default() }), ..dark() };
    assert!(matches!(fault(&blind, &good), RenderError::Prepare(PrepareError::Camera(_))));
    let mut unlit = dark();
    unlit.lights.push(Light::Sun(Sun::default()));
    unlit.lights.push(Light::Sun(Sun { direction: DVec3::ZERO, ..Sun::default() }));
    assert!(matches!(fault(&unlit, &good), RenderError::Prepare(PrepareError::Light { index: 1, .. })));
    let frozen = Scene { tracer: Tracer { step_factor: 0.0, ..Tracer::default() }, ..dark() };
    assert!(matches!(fault(&frozen, &good), RenderError::Prepare(PrepareError::Tracing(_))));
    assert!(matches!(fault(&dark(), &options(0, 8)), RenderError::Options(_)));
}

/// Where a ray ends on the surface itself, fields that are roots have no slope: there the normal is none that leads to the eye.
#[test]
fn surfaces_have_normals_where_values_vanish() {
    let square = || polygon([[-0.25, -0.25], [0.25, -0.25], [0.25, 0.25], [-0.25, 0.25]]).extrude(1.0);
    let shapes: [(Field, f64); 5] = [
        (cuboid([0.5, 0.5, 1.0]).into(), 0.04),
        (square(), 0.04),
        (rectangle(0.5, 0.5).extrude(1.0), 0.04),
        (cylinder(8.0, 1.0) & cuboid([0.5, 0.5, 2.0]), 0.04),
        (sheet([0.0, 0.0, 1.0]) & cylinder(1.0, 1.0), 0.03),
    ];
    for (shape, edges) in shapes {
        for method in Method::ALL {
            let camera = Camera { eye: DVec3::new(2.5, -4.0, 3.0), ..Camera::default() };
            let mut scene = Scene { camera: Some(camera), ..dark() };
            add(&mut scene, shape.clone(), chalk());
            scene.tracer = scene.tracer.method(method);
            scene.tracer.step = Some(0.01);
            let renderer = Renderer::new(&scene).expect("sound");
            let (layers, _) = renderer.layers(&options(160, 120), &()).expect("layers");
            let hits: Vec<_> = layers.pixels().iter().filter(|pixel| pixel.object.is_some()).collect();
            let is_slanted = |normal: [f32; 3]| normal.iter().all(|along| along.abs() < 0.999);
            let slanted = hits.iter().filter(|pixel| is_slanted(pixel.normal)).count();
            let most = (edges * hits.len() as f64) as usize;
            assert!(hits.len() > 300 && slanted <= most, "{method:?}: {slanted} of {} normals", hits.len());
        }
    }
}
