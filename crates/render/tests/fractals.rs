//! Rays against fractals, whose membership is decided by orbits in double precision.

mod common;

use common::*;
use freikugel_field::Field;
use freikugel_field::shapes::*;
use freikugel_render::Rendered;
use freikugel_scene::{Ambient, Background, Camera, Projection, Scene, Tracer};
use glam::DVec3;

/// How many points of a ray are looked at for each unit of length: more than twenty to a pixel.
const DENSITY: f64 = 2000.0;

const SIZE: (u32, u32) = (96, 72);

/// A picture in which hits are white.
fn silhouette(shape: Field) -> (Scene, Rendered) {
    let mut scene = Scene {
        ambient: Ambient { sky: [1.0; 3], ground: [1.0; 3] },
        background: Background::Solid([0.0; 3]),
        camera: Some(Camera {
            eye: DVec3::new(1.9, -3.1, 1.5),
            target: DVec3::ZERO,
            up: DVec3::Z,
            projection: Projection::Perspective { fov: 45_f64.to_radians(), axis: Default::default() },
        }),
        tracer: Tracer { precision: 1e-4, ..Tracer::default() },
        ..dark()
    };
    add(&mut scene, shape, chalk());
    let rendered = picture(&scene, &options(SIZE.0, SIZE.1));
    (scene, rendered)
}

/// Compares every other pixel of every other row. A ray that passes through the set must hit; one that hits must pass the
/// set nearly, by a field that is at most the distance.
fn check(shape: Field, contains: impl Fn(DVec3) -> bool, distance: impl Fn(DVec3) -> f64) {
    let (scene, rendered) = silhouette(shape);
    assert!(rendered.stats.unresolved.pixels < 5, "{:?}", rendered.stats.unresolved);
    let camera = scene.camera.clone().expect("a camera");
    let (mut inside, mut outside) = (0, 0);
    for y in (0..SIZE.1).step_by(2) {
        for x in (0..SIZE.0).step_by(2) {
            let (origin, direction) = camera_ray(&camera, SIZE, (f64::from(x) + 0.5, f64::from(y) + 0.5));
            let is_hit = rendered.image.pixel(x, y)[0] > 0.5;
            let middle = -origin.dot(direction);
            let steps = (3.2 * DENSITY) as u32;
            let mut places = (0..steps).map(|i| origin + direction * (middle - 1.6 + f64::from(i) / DENSITY));
            if is_hit {
                inside += 1;
                let nearest = places.map(&distance).fold(f64::INFINITY, f64::min);
                // A tolerance of 1e-4 of a way of 4 units, and the spacing of the points.
                assert!(nearest < 4e-4 + 1.0 / DENSITY, "pixel ({x}, {y}) hits nothing nearer than {nearest}");
            } else {
                outside += 1;
                assert!(places.all(|p| !contains(p)), "pixel ({x}, {y}) misses the set");
            }
        }
    }
    assert!(inside > 200 && outside > 200, "{inside} hits, {outside} misses");
}

#[test]
fn no_ray_misses_a_julia_set() {
    let (c, bailout) = ([-0.2, 0.6, 0.2, 0.2], 2.0);
    let shape = || Field::from(quaternion_julia(c)).with("bailout", &[bailout.into()]);
    let orbit = move |p: DVec3| {
        let [mut a, mut i, mut j, mut k] = [p.x, p.y, p.z, 0.0];
        let mut n = 0;
        while n < 10 && a * a + i * i + j * j + k * k <= bailout * bailout {
            [a, i, j, k] =
                [a * a - i * i - j * j - k * k + c[0], 2.0 * a * i + c[1], 2.0 * a * j + c[2], 2.0 * a * k + c[3]];
            n += 1;
        }
        a * a + i * i + j * j + k * k <= bailout * bailout
    };
    let program = freikugel_field::Structure::compile(&[shape()]).expect("sound").program(DVec3::ZERO);
    check(shape(), orbit, |p| program.value(p));
}

#[test]
fn no_ray_misses_a_mandelbulb() {
    let orbit = |p: DVec3| {
        let (mut q, mut n) = (p, 0);
        while n < 6 && q.length() <= 2.0 {
            let (r, polar, around) = (q.length(), q.x.hypot(q.y).atan2(q.z) * 8.0, q.y.atan2(q.x) * 8.0);
            q = DVec3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos()) * r.powi(8) + p;
            n += 1;
        }
        q.length() <= 2.0
    };
    let shape = || Field::from(mandelbulb(8)).with("iterations", &[6.into()]).with("bailout", &[2.into()]);
    let program = freikugel_field::Structure::compile(&[shape()]).expect("sound").program(DVec3::ZERO);
    check(shape(), orbit, |p| program.value(p));
}
