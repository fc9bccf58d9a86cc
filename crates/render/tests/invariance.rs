//! The same bytes, however a picture is computed; and that computing it can be watched and stopped.

mod common;

use common::*;
use freikugel_field::shapes::*;
use freikugel_field::simd;
use freikugel_render::{Options, Progress, Rect, RenderError, Renderer, render};
use freikugel_scene::{
    Ambient, Background, Camera, Light, Material, Method, Occlusion, Pattern, Point, Scene, Shadow, Spot, Sun, Tracer,
};
use glam::DVec3;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Something of everything: planes, blends, all lights, all shadows, occlusion, patterns.
fn rich() -> Scene {
    let mut scene = Scene {
        ambient: Ambient { sky: [0.3, 0.4, 0.5], ground: [0.1; 3] },
        background: Background::Gradient { top: [0.2, 0.4, 0.9], bottom: [1.0; 3] },
        occlusion: Some(Occlusion::default()),
        ..dark()
    };
    let blend = smooth_union(
        0.3,
        [
            torus(0.8, 0.25).rotate([1.0, 0.0, 0.0], 70.0).at([0.0, 0.0, 0.9]),
            cuboid([0.8, 0.8, 0.6]).at([0.4, -0.2, 0.3]),
        ],
    );
    let checker = Pattern::Checker { colors: [[0.9; 3], [0.2, 0.3, 0.3]], size: 0.5 };
    add(&mut scene, blend, Material::default());
    add(&mut scene, sphere(0.5).at([-1.0, -0.6, 0.5]) - cuboid([1.0, 1.0, 0.2]).at([-1.0, -0.6, 0.6]), chalk());
    add(&mut scene, plane([0.0, 0.0, 1.0]), Material { color: checker, ..Material::default() });
    let shadow = Shadow::Hardness(8.0);
    scene.lights.push(Light::Sun(Sun { direction: DVec3::new(1.0, -1.0, 2.0), shadow, ..Sun::default() }));
    scene.lights.push(Light::Point(Point {
        position: DVec3::new(-2.0, -2.0, 3.0),
        intensity: 4.0,
        shadow: Shadow::Clearance { angle: None },
        ..Point::default()
    }));
    scene.lights.push(Light::Spot(Spot { position: DVec3::new(2.0, -3.0, 3.0), intensity: 9.0, ..Spot::default() }));
    scene
}

fn bits(scene: &Scene, options: &Options) -> Vec<[u32; 3]> {
    picture(scene, options).image.pixels().iter().map(|c| c.map(f32::to_bits)).collect()
}

#[test]
fn threads_tiles_and_instruction_sets_change_nothing() {
    let scene = rich();
    let base = Options { samples: 3, threads: Some(1), ..options(75, 50) };
    let expected = bits(&scene, &base);
    for threads in [2, 5] {
        assert!(bits(&scene, &Options { threads: Some(threads), ..base.clone() }) == expected, "{threads}");
    }
    for tile in [1, 7, 64, 1024] {
        assert!(bits(&scene, &Options { tile, ..base.clone() }) == expected, "{tile}");
    }
    for level in simd::available() {
        assert!(bits(&scene, &Options { level: Some(level), ..base.clone() }) == expected, "{level:?}");
    }
}

#[test]
fn every_tracer_computes_the_same_bytes() {
    for method in Method::ALL {
        let mut scene = rich();
        scene.tracer = Tracer { step: Some(0.05), ..scene.tracer.method(method) };
        let base = Options { samples: 2, threads: Some(1), ..options(40, 30) };
        let expected = bits(&scene, &base);
        assert!(bits(&scene, &Options { threads: Some(3), tile: 7, ..base.clone() }) == expected, "{method:?}");
        for level in simd::available() {
            assert!(bits(&scene, &Options { level: Some(level), ..base.clone() }) == expected, "{method:?} {level:?}");
        }
    }
}

#[test]
fn counts_do_not_depend_on_threads() {
    let scene = rich();
    let counts = |threads| {
        let options = Options { samples: 2, threads: Some(threads), ..options(60, 40) };
        let mut stats = picture(&scene, &options).stats;
        assert_eq!(stats.times.threads, threads as u64);
        assert!(stats.times.wall > std::time::Duration::ZERO);
        stats.times = Default::default();
        stats
    };
    let one = counts(1);
    assert_eq!(one, counts(3));
    assert_eq!(one.rays.camera, 60 * 40 * 2);
    assert_eq!(one.rays.occlusion, one.hits * 5);
    assert!(one.evaluations > one.steps);
}

#[test]
fn a_crop_is_a_cut_of_the_whole() {
    let scene = rich();
    let whole = Options { samples: 4, ..options(75, 50) };
    let image = picture(&scene, &whole).image;
    for crop in [
        Rect { x: 0, y: 0, width: 75, height: 50 },
        Rect { x: 31, y: 17, width: 9, height: 21 },
        Rect { x: 74, y: 49, width: 1, height: 1 },
    ] {
        let part = picture(&scene, &Options { crop: Some(crop), ..whole.clone() }).image;
        assert_eq!((part.width(), part.height()), (crop.width, crop.height));
        for y in 0..crop.height {
            for x in 0..crop.width {
                let expected = image.pixel(crop.x + x, crop.y + y);
                assert_eq!(part.pixel(x, y).map(f32::to_bits), expected.map(f32::to_bits));
            }
        }
    }
}

#[test]
fn more_samples_than_a_wave_holds_are_one_mean() {
    // A ball whose edge crosses the pixels, with so many samples that a pixel spans several waves.
    let mut scene = Scene { camera: Some(from_above(5.0, 4.0)), ..dark() };
    scene.ambient = Ambient { sky: [1.0; 3], ground: [1.0; 3] };
    add(&mut scene, sphere(1.0), chalk());
    let many = picture(&scene, &Options { samples: 5000, ..options(4, 4) });
    assert_eq!(many.stats.rays.camera, 5000 * 16);
    // Each pixel is the mean of the disc under the filter's window, here by a fine grid over the window.
    let window = |x: f64| {
        let terms = [0.35875, 0.48829, 0.14128, 0.01168];
        (0..4).map(|k| terms[k] * (std::f64::consts::TAU * k as f64 * x / 3.0).cos()).sum::<f64>()
    };
    for (x, y) in [(0, 0), (1, 0), (1, 1), (2, 1), (3, 3)] {
        let (mut inside, mut all) = (0.0, 0.0);
        for i in -150..150 {
            for j in -150..150 {
                let (dx, dy) = ((f64::from(i) + 0.5) / 100.0, (f64::from(j) + 0.5) / 100.0);
                let weight = window(dx) * window(dy);
                let (px, py) = (f64::from(x) + 0.5 + dx - 2.0, f64::from(y) + 0.5 + dy - 2.0);
                all += weight;
                inside += if px.hypot(py) < 1.0 { weight } else { 0.0 };
            }
        }
        let value = f64::from(many.image.pixel(x, y)[0]);
        assert!((value - inside / all).abs() < 5e-3, "({x}, {y}): {value} {}", inside / all);
    }
}

#[test]
fn a_renderer_can_be_used_again() {
    let scene = rich();
    let renderer = Renderer::new(&scene).expect("a sound scene");
    let options = options(24, 16);
    let first = renderer.render(&options, &()).expect("a picture").image;
    let other = renderer.render(&Options { width: 48, height: 32, ..options.clone() }, &());
    assert_eq!(other.expect("a picture").image.width(), 48);
    assert_eq!(renderer.render(&options, &()).expect("a picture").image, first);
}

#[test]
fn kept_cells_change_nothing() {
    // Cameras on all sides and within; a scene with planes and one of bounded objects alone.
    let cameras: Vec<Camera> = [[3.0, -4.0, 2.0], [-2.0, 3.0, 4.0], [0.1, -0.9, 1.4], [9.0, 0.0, 1.0]]
        .into_iter()
        .map(|eye| Camera { eye: DVec3::from_array(eye), target: DVec3::new(0.0, 0.0, 0.4), ..Camera::default() })
        .collect();
    let mut bounded = rich();
    bounded.objects.pop();
    for scene in [rich(), bounded] {
        let with = |camera: &Camera| Scene { camera: Some(camera.clone()), ..scene.clone() };
        let scenes: Vec<Scene> = cameras.iter().map(with).collect();
        let options = Options { threads: Some(2), tile: 16, ..options(40, 30) };
        let fresh: Vec<_> = scenes.iter().map(|scene| bits(scene, &options)).collect();
        let renderer = Renderer::new(&scene).expect("a sound scene");
        let shot = |camera: usize| {
            let options = Options { camera: Some(cameras[camera].clone()), ..options.clone() };
            let picture = renderer.render(&options, &()).expect("a picture");
            picture.image.pixels().iter().map(|c| c.map(f32::to_bits)).collect::<Vec<_>>()
        };
        for camera in [0, 1, 2, 3, 2, 0, 3, 1] {
            assert!(shot(camera) == fresh[camera], "camera {camera}");
        }
        // Several at once.
        std::thread::scope(|scope| {
            let shot = &shot;
            let shots: Vec<_> = (0..4).map(|camera| (camera, scope.spawn(move || shot(camera)))).collect();
            for (camera, shot) in shots {
                assert!(shot.join().expect("no panic") == fresh[camera], "camera {camera}");
            }
        });
    }
}

#[test]
fn progress_rises_to_the_end() {
    #[derive(Default)]
    struct Heard(Mutex<Vec<(u64, u64)>>);
    impl Progress for Heard {
        fn advanced(&self, done: u64, total: u64) {
            self.0.lock().expect("no panic").push((done, total));
        }
    }
    let heard = Heard::default();
    let options = Options { threads: Some(3), tile: 8, ..options(40, 30) };
    render(&rich(), &options, &heard).expect("a picture");
    let heard = heard.0.into_inner().expect("no panic");
    assert_eq!(heard.len(), 5 * 4);
    assert!(heard.windows(2).all(|pair| pair[0].0 < pair[1].0));
    assert_eq!(heard.last(), Some(&(1200, 1200)));
}

#[test]
fn cancelling_stops_and_yields_nothing() {
    let cancelled = AtomicBool::new(true);
    let result = render(&rich(), &options(40, 30), &cancelled);
    assert!(matches!(result, Err(RenderError::Cancelled)));

    /// Cancels after the first tile.
    #[derive(Default)]
    struct Impatient(AtomicU64);
    impl Progress for Impatient {
        fn advanced(&self, _done: u64, _total: u64) {
            self.0.fetch_add(1, Ordering::SeqCst);
        }
        fn is_cancelled(&self) -> bool {
            self.0.load(Ordering::SeqCst) > 0
        }
    }
    let impatient = Impatient::default();
    let options = Options { threads: Some(2), tile: 8, ..options(400, 300) };
    assert!(matches!(render(&rich(), &options, &impatient), Err(RenderError::Cancelled)));
    assert!(impatient.0.into_inner() <= 2, "at most what was under way");
}
