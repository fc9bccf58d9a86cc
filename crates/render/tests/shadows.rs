//! Soft shadows and ambient occlusion against a scalar marcher in double precision.

mod common;

use common::*;
use freikugel_field::shapes::*;
use freikugel_scene::{Ambient, Light, Occlusion, Point, Scene, Shadow, Sun};
use glam::DVec3;

/// The obstacle of most scenes here: a ball above the ground.
const CENTER: DVec3 = DVec3::new(0.0, 0.0, 1.4);
const RADIUS: f64 = 0.6;

/// Soft marches may miss a factor's least value by this share of it; see the shortest step of the march.
const MISSED: f64 = 0.035;

const VIEW: f64 = 6.0;

/// Fine pixels, so that the tolerances that come with their size stay small; only each `STRIDE`th is compared.
const SIZE: (u32, u32) = (480, 480);
const STRIDE: usize = 10;

fn scene_with(light: Light) -> Scene {
    let mut scene = Scene { camera: Some(from_above(20.0, VIEW)), ..dark() };
    scene.lights.push(light);
    add(&mut scene, sphere(RADIUS).at(CENTER), chalk());
    add(&mut scene, plane([0.0, 0.0, 1.0]), chalk());
    scene
}

/// The point of the ground a pixel shows, unless the ball is in the way.
fn ground_at(x: u32, y: u32) -> Option<DVec3> {
    let camera = from_above(20.0, VIEW);
    let (origin, _) = camera_ray(&camera, SIZE, (f64::from(x) + 0.5, f64::from(y) + 0.5));
    let point = DVec3::new(origin.x, origin.y, 0.0);
    let beside = (point - CENTER).truncate().length();
    (beside > RADIUS * 1.02).then_some(point)
}

/// The factor of a soft shadow by its definition: small fixed steps, no bounds, no shortcuts.
fn factor(start: DVec3, direction: DVec3, end: f64, sharpness: f64) -> f64 {
    let steps = 4000;
    let mut least = 1.0f64;
    for step in 1..=steps {
        let t = end * f64::from(step) / f64::from(steps);
        let clearance = (start + direction * t - CENTER).length() - RADIUS;
        least = least.min(sharpness * clearance / t);
    }
    least.max(0.0)
}

/// Compares all of the ground with `expected`, the light that arrives at a point of it.
fn compare_ground(light: Light, expected: impl Fn(DVec3) -> (f64, f64)) {
    let rendered = picture(&scene_with(light), &options(SIZE.0, SIZE.1));
    let mut partial = 0;
    for y in (0..SIZE.1).step_by(STRIDE) {
        for x in (0..SIZE.0).step_by(STRIDE) {
            let Some(point) = ground_at(x, y) else { continue };
            let (light, factor) = expected(point);
            let value = f64::from(rendered.image.pixel(x, y)[0]) / light;
            assert!((0.0..=1.0 + 1e-4).contains(&value), "({x}, {y}): {value}");
            assert!((value - factor).abs() <= MISSED * factor + 4e-3, "({x}, {y}): {value} instead of {factor}",);
            partial += usize::from(factor > 0.05 && factor < 0.95);
        }
    }
    assert!(partial > 10, "only {partial} pixels in the penumbra");
}

#[test]
fn hardness_of_a_sun() {
    for hardness in [2.0f32, 8.0, 32.0] {
        let direction = DVec3::new(1.0, 0.3, 1.2).normalize();
        let sun = Sun { direction, shadow: Shadow::Hardness(hardness), ..Sun::default() };
        compare_ground(Light::Sun(sun), |point| (direction.z, factor(point, direction, 12.0, hardness.into())));
    }
}

#[test]
fn hardness_below_one_is_wider_than_a_half_space() {
    let direction = DVec3::new(1.0, 0.3, 1.2).normalize();
    let sun = Sun { direction, shadow: Shadow::Hardness(0.8), ..Sun::default() };
    let mut scene = scene_with(Light::Sun(sun));
    // Where the ray goes to infinity the ratio tends to 1, and the factor to the hardness.
    scene.tracer.max_distance = 1e4;
    let rendered = picture(&scene, &options(SIZE.0, SIZE.1));
    let far = f64::from(rendered.image.pixel(0, 240)[0]) / direction.z;
    assert!(far > 0.0 && far <= 0.81, "{far}");
}

#[test]
fn clearance_of_a_lamp() {
    let position = DVec3::new(1.8, 0.4, 3.0);
    let lamp = Point { position, intensity: 10.0, shadow: Shadow::Clearance { angle: None }, ..Point::default() };
    // K 6.1: the reference radius at t is t / l times the light's own distance to the scene, ground included.
    let clearance = ((position - CENTER).length() - RADIUS).min(position.z);
    compare_ground(Light::Point(lamp), |point| {
        let way = position - point;
        let l = way.length();
        let light = 10.0 / (l * l) * way.z / l;
        (light, factor(point, way / l, l, l / clearance))
    });
}

#[test]
fn clearance_of_a_sun_is_its_apparent_size() {
    let direction = DVec3::new(-1.0, 0.0, 1.0).normalize();
    let angle = 5f64.to_radians();
    let shadow = Shadow::Clearance { angle: Some(2.0 * angle) };
    compare_ground(Light::Sun(Sun { direction, shadow, ..Sun::default() }), |point| {
        (direction.z, factor(point, direction, 12.0, 1.0 / angle.tan()))
    });
}

#[test]
fn harder_shadows_are_nowhere_darker_and_end_at_the_hard_one() {
    let image = |shadow| {
        let direction = DVec3::new(1.0, 0.3, 1.2);
        let sun = Sun { direction, shadow, ..Sun::default() };
        picture(&scene_with(Light::Sun(sun)), &options(SIZE.0, SIZE.1)).image
    };
    let hard = image(Shadow::Hard);
    let none = image(Shadow::None);
    let mut before = image(Shadow::Hardness(1.5));
    for hardness in [3.0, 6.0, 12.0, 100.0, 10_000.0] {
        let harder = image(Shadow::Hardness(hardness));
        for (soft, hard) in before.pixels().iter().zip(harder.pixels()) {
            let slack = soft[0] * MISSED as f32 + 1e-3;
            assert!(soft[0] <= hard[0] + slack, "{hardness}: {} {}", soft[0], hard[0]);
        }
        before = harder;
    }
    let differing = before.pixels().iter().zip(hard.pixels()).filter(|(a, b)| (a[0] - b[0]).abs() > 1e-2).count();
    assert!(differing <= 600, "{differing} pixels differ at the limit");
    assert!(hard.pixels().iter().zip(none.pixels()).all(|(a, b)| a[0] <= b[0]));
}

#[test]
fn what_stands_behind_a_lamp_casts_no_hard_shadow() {
    let mut scene = Scene { camera: Some(from_above(20.0, 2.0)), ..dark() };
    let position = DVec3::new(0.0, 0.0, 1.0);
    scene.lights.push(Light::Point(Point { position, ..Point::default() }));
    add(&mut scene, plane([0.0, 0.0, 1.0]), chalk());
    add(&mut scene, cuboid([10.0, 10.0, 1.0]).at([0.0, 0.0, -4.0]), chalk());
    let open = picture(&scene, &options(8, 8)).image;
    add(&mut scene, cuboid([3.0, 3.0, 0.2]).at([0.0, 5.0, 2.0]), chalk());
    add(&mut scene, plane([0.0, 1.0, 0.0]).offset_by(-6.0), chalk());
    // Not the same bits, since the picture's origin follows the objects.
    for (a, b) in picture(&scene, &options(8, 8)).image.pixels().iter().zip(open.pixels()) {
        assert!((a[0] - b[0]).abs() < 1e-5, "{a:?} {b:?}");
    }
}

/// A picture of nothing but ambient light.
fn occluded(objects: impl FnOnce(&mut Scene), occlusion: Occlusion) -> Vec<f32> {
    let mut scene = Scene {
        camera: Some(from_above(20.0, 4.0)),
        ambient: Ambient { sky: [1.0; 3], ground: [1.0; 3] },
        occlusion: Some(occlusion),
        ..dark()
    };
    objects(&mut scene);
    picture(&scene, &options(40, 40)).image.pixels()[800..840].iter().map(|c| c[0]).collect()
}

#[test]
fn an_open_plane_is_not_occluded() {
    let ground = |scene: &mut Scene| add(scene, plane([0.0, 0.0, 1.0]), chalk());
    let open = occluded(ground, Occlusion { strength: 1.0, reach: Some(1.0) });
    assert!(open.iter().all(|value| (value - 1.0).abs() < 1e-5));
    let marched = |scene: &mut Scene| add(scene, cuboid([200.0, 20.0, 2.0]).at([0.0, 0.0, -1.0]), chalk());
    let open = occluded(marched, Occlusion { strength: 1.0, reach: Some(1.0) });
    assert!(open.iter().all(|value| (value - 1.0).abs() < 1e-3), "{open:?}");
}

#[test]
fn occlusion_is_the_sum_of_its_five_samples() {
    // A wall along x = 0 beside the ground, once intersected exactly and once marched.
    let reach = 0.8f64;
    for strength in [0.5f32, 1.0] {
        let occlusion = Occlusion { strength, reach: Some(reach) };
        let planes = occluded(
            |scene| {
                add(scene, plane([0.0, 0.0, 1.0]), chalk());
                add(scene, plane([-1.0, 0.0, 0.0]).offset_by(-0.02), chalk());
            },
            occlusion.clone(),
        );
        let marched = occluded(
            |scene| {
                add(scene, plane([0.0, 0.0, 1.0]), chalk());
                add(scene, cuboid([4.0, 40.0, 40.0]).at([2.02, 0.0, 0.0]), chalk());
            },
            occlusion,
        );
        let mut lowest = 1.0f64;
        for x in 0..20 {
            // The wall stands at x = 0.02, and the pixels left of it show the ground at these distances from it.
            let wall = 0.02 - (f64::from(x) + 0.5 - 20.0) * 0.1;
            let (mut occluded, mut all) = (0.0, 0.0);
            for sample in 1..=5 {
                let (height, weight) = (reach * f64::from(sample) / 5.0, 0.5f64.powi(sample));
                occluded += weight * (height - height.min(wall)).max(0.0);
                all += weight * height;
            }
            let expected = (1.0 - f64::from(strength) * occluded / all).clamp(0.0, 1.0);
            lowest = lowest.min(expected);
            for values in [&planes, &marched] {
                let value = f64::from(values[x as usize]);
                assert!((value - expected).abs() < 1e-3, "{x}: {value} instead of {expected}");
            }
        }
        assert!(lowest < 0.99, "the corner is darker");
    }
}
