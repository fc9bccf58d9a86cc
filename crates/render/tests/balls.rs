//! Sets of equal balls, which rays are intersected with exactly, beside unions of spheres, which they march to.

mod common;

use common::*;
use freikugel_field::shapes::*;
use freikugel_field::{Field, MaterialId};
use freikugel_render::Renderer;
use freikugel_scene::{Camera, Light, Method, Occlusion, Point, Scene, Shadow, Sun};
use glam::DVec3;

const RADIUS: f64 = 0.12;

/// Points along a winding line above the ground.
fn points() -> impl Iterator<Item = DVec3> {
    (0..60).map(|index| {
        let t = f64::from(index) * 0.23;
        DVec3::new(t.cos(), (1.3 * t).sin(), 0.7 + 0.45 * (2.1 * t).sin())
    })
}

fn as_set() -> Field {
    point_set(RADIUS, points().map(|point| point.to_array())).into()
}

fn as_spheres() -> Field {
    union(points().map(|point| sphere(RADIUS).at(point)))
}

/// Balls among other objects, over a ground, in light.
fn scene(balls: Field, ground: impl Into<Field>, light: Light) -> Scene {
    let camera = Camera { eye: DVec3::new(2.5, -4.0, 3.0), ..Camera::default() };
    let mut scene = Scene { camera: Some(camera), lights: vec![light], ..dark() };
    scene.occlusion = Some(Occlusion::default());
    scene.ambient.sky = [0.3; 3];
    add(&mut scene, ground, chalk());
    add(&mut scene, balls, chalk());
    add(&mut scene, cuboid([0.5, 0.5, 1.0]).at([-0.2, 0.1, 0.5]), chalk());
    scene
}

/// The share of a picture's pixels that differ from those of another one.
fn difference(a: &Scene, b: &Scene) -> f64 {
    let [a, b] = [a, b].map(|scene| picture(scene, &options(160, 120)).image);
    // Steps of a soft march end at other places than that of the least ratio.
    let differs = |(a, b): &(&[f32; 3], &[f32; 3])| (a[0] - b[0]).abs() > 0.05;
    a.pixels().iter().zip(b.pixels()).filter(differs).count() as f64 / a.pixels().len() as f64
}

#[test]
fn balls_look_like_spheres_in_all_light() {
    let sun = |shadow| Light::Sun(Sun { direction: DVec3::new(1.0, -0.6, 1.2), shadow, ..Sun::default() });
    let lamp = |shadow| {
        let position = DVec3::new(0.3, -1.5, 2.5);
        Light::Point(Point { position, intensity: 6.0, shadow, ..Point::default() })
    };
    let clearance = Shadow::Clearance { angle: None };
    let sized = Shadow::Clearance { angle: Some(0.1) };
    let kinds = [Shadow::None, Shadow::Hard, Shadow::Hardness(0.8), Shadow::Hardness(6.0), Shadow::Hardness(50.0)];
    let suns = kinds.into_iter().chain([sized]).map(sun);
    for light in suns.chain([Shadow::Hard, Shadow::Hardness(8.0), clearance].map(lamp)) {
        let [set, spheres] = [as_set(), as_spheres()].map(|balls| scene(balls, plane([0.0, 0.0, 1.0]), light.clone()));
        let share = difference(&set, &spheres);
        // A march goes from a ball itself by steps as long as it is high, and misses some of the shade that it casts on itself, which
        // is wide if the shadow is softer than the light is high, or the light near.
        let is_wide = match &light {
            Light::Sun(sun) => matches!(sun.shadow, Shadow::Hardness(hardness) if hardness < 1.0),
            Light::Point(lamp) => lamp.shadow == clearance,
            Light::Spot(_) => false,
        };
        assert!(share < if is_wide { 0.03 } else { 0.01 }, "{light:?}: {share} of all pixels differ");
    }
}

#[test]
fn balls_look_alike_by_all_tracers() {
    let sun = Sun { direction: DVec3::new(1.0, -0.6, 1.2), shadow: Shadow::Hard, ..Sun::default() };
    // Not an endless ground, along which fixed steps end.
    let scene = scene(as_set(), cuboid([5.0, 5.0, 0.2]).at([0.0, 0.0, -0.1]), Light::Sun(sun));
    for method in Method::ALL {
        let mut other = scene.clone();
        other.tracer = other.tracer.method(method);
        other.tracer.step = Some(0.01);
        let share = difference(&other, &scene);
        let allowed = if method == Method::Relaxed { 0.1 } else { 0.01 };
        assert!(share < allowed, "{method:?}: {share} of all pixels differ");
    }
}

/// Distances are those of closed form, and objects and materials the right ones, also where others stand before and behind.
#[test]
fn balls_are_where_they_are() {
    let set = as_set().painted(MaterialId(2)).rotate([0.0, 0.0, 1.0], 30.0).scale(0.5).at([100.0, 0.0, 0.0]);
    let mut scene = Scene {
        camera: Some(Camera { eye: DVec3::new(101.5, -4.0, 2.0), target: DVec3::X * 100.0, ..Camera::default() }),
        ..dark()
    };
    add(&mut scene, cuboid([0.2, 0.2, 3.0]).at([100.0, 0.0, 0.0]), chalk());
    add(&mut scene, set, chalk());
    scene.materials.push(("red".into(), freikugel_scene::Material { emissive: [1.0, 0.0, 0.0], ..chalk() }));
    let size = (120, 90);
    let renderer = Renderer::new(&scene).expect("sound");
    let (layers, _) = renderer.layers(&options(size.0, size.1), &()).expect("layers");
    let image = picture(&scene, &options(size.0, size.1)).image;
    let turn = glam::DMat3::from_rotation_z(30f64.to_radians());
    let centers: Vec<DVec3> = points().map(|point| turn * point * 0.5 + DVec3::X * 100.0).collect();
    let mut seen = 0;
    for y in 0..size.1 {
        for x in 0..size.0 {
            let camera = scene.camera.as_ref().expect("one");
            let (origin, direction) = camera_ray(camera, size, (f64::from(x) + 0.5, f64::from(y) + 0.5));
            let hit = |center: &DVec3| {
                let (along, radius) = ((center - origin).dot(direction), RADIUS * 0.5);
                let beside = (center - origin - direction * along).length();
                (beside < radius).then(|| along - (radius * radius - beside * beside).sqrt())
            };
            let pixel = &layers.pixels()[(y * size.0 + x) as usize];
            let is_red = image.pixel(x, y)[0] == 1.0;
            assert_eq!(is_red, pixel.object == Some(1), "({x}, {y})");
            let distance = f64::from(pixel.distance);
            match (centers.iter().filter_map(hit).min_by(f64::total_cmp), pixel.object) {
                (Some(t), Some(1)) => {
                    seen += 1;
                    assert!((distance - t).abs() < 1e-6 * t, "({x}, {y}): {distance} for {t}");
                }
                (Some(t), Some(0)) => assert!(distance < t, "({x}, {y}): the box is behind"),
                (Some(_), _) => panic!("({x}, {y}): nothing seen of a ball"),
                (None, Some(1)) => panic!("({x}, {y}): no ball is there"),
                (None, _) => {}
            }
        }
    }
    assert!(seen > 300, "{seen}");
}
