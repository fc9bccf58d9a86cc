//! All tracers see the same, but for what is known to tell them apart.

mod common;
#[path = "../../field/tests/common/mod.rs"]
mod fields;

use common::*;
use fields::{Random, notation, tree};
use freikugel_field::shapes::*;
use freikugel_field::{Extent, Field, Structure, extent};
use freikugel_render::{Comparison, Options, PrepareError, Rect, RenderError, Renderer, Verdict, compare, render};
use freikugel_scene::{Camera, Light, Method, Projection, Scene, Shadow, Sun, Tracer};
use glam::DVec3;

fn compared(scene: &Scene, options: &Options, methods: &[Method]) -> Comparison {
    compare(scene, options, methods, 1, &()).expect("a sound scene")
}

fn scene_of(shape: impl Into<Field>) -> Scene {
    let mut scene = dark();
    add(&mut scene, shape, chalk());
    scene
}

/// A look at a field from a random side, so that it fills the frame.
fn around(field: &Field, random: &mut Random) -> Option<Scene> {
    let Extent::Finite(aabb) = extent(field) else { return None };
    let radius = aabb.size().length() / 2.0;
    let eye = aabb.center() + random.direction() * 3.0 * radius;
    let projection = Projection::Perspective { fov: 40_f64.to_radians(), axis: freikugel_scene::FovAxis::Vertical };
    let camera = Camera { eye, target: aabb.center(), up: random.direction(), projection };
    Some(Scene { camera: Some(camera), ..scene_of(field.clone()) })
}

/// Random trees, each from a random side.
///
/// Without fractals: these have detail at all sizes, so that rays graze them everywhere.
fn trees(count: usize) -> impl Iterator<Item = (Field, Scene)> {
    let fields = (0..).map(|seed| (tree(3, &mut Random::new(seed + 500)), Random::new(seed)));
    let is_loose = |field: &Field| {
        Structure::compile(std::slice::from_ref(field)).is_ok_and(|it| it.program(DVec3::ZERO).whole().is_loose())
    };
    let fields = fields.filter(move |(field, _)| !is_loose(field));
    fields.filter_map(|(field, mut random)| Some((field.clone(), around(&field, &mut random)?))).take(count)
}

/// Those that may not miss anything.
const BOUNDED: [Method; 4] = [Method::Auto, Method::Sphere, Method::Relaxed, Method::Guaranteed];

#[test]
fn cells_leave_nothing_out() {
    // The same march, with the whole field at each step and with what is left of it in cells: the steps differ, and so does
    // where a ray stops within the tolerance. A ray whose fate differs comes within it of a surface that it does not meet.
    let (mut rays, mut differing) = (0, 0);
    for (_, scene) in trees(40) {
        let options = options(60, 60);
        let layers = |method| {
            let scene = Scene { tracer: scene.tracer.clone().method(method), ..scene.clone() };
            Renderer::new(&scene).expect("sound").layers(&options, &()).expect("layers").0
        };
        let (auto, plain) = (layers(Method::Auto), layers(Method::Sphere));
        rays += auto.pixels().len();
        differing += auto.pixels().iter().zip(plain.pixels()).filter(|(a, b)| a.object != b.object).count();
    }
    println!("{differing} of {rays} rays hit in one way only");
    assert!(differing * 10_000 <= rays, "{differing} of {rays}");
}

#[test]
fn no_tracer_but_the_fixed_one_misses_or_invents_a_surface() {
    for (field, scene) in trees(40) {
        let comparison = compared(&scene, &options(40, 40), &Method::ALL);
        for trial in &comparison.trials {
            let outcome = trial.outcome.as_ref().expect("every constant is known");
            if trial.method == Method::Fixed {
                assert_eq!(outcome.count(Verdict::False), 0, "pixels of {} with fixed steps", notation(&field));
                continue;
            }
            for wrong in [Verdict::Missed, Verdict::False, Verdict::Unresolved, Verdict::Unjudged] {
                let count = outcome.count(wrong);
                assert_eq!(count, 0, "{:?} pixels of {} by {:?}", wrong, notation(&field), trial.method);
            }
        }
    }
}

#[test]
fn at_most_one_ray_in_ten_thousand_grazes() {
    // Windows into a frame of so many pixels that tolerances, which grow with the pixels, are small beside the shapes; but not so
    // small that what enclosures of long formulas add for rounding in single precision would count as another place.
    const SIDE: u32 = 10_000;
    const WINDOW: u32 = 4;
    const WINDOWS: usize = 36;
    let (mut rays, mut grazing) = (0, [0; BOUNDED.len()]);
    let mut grazed = Vec::new();
    for (index, (field, scene)) in trees(60).enumerate() {
        let mut random = Random::new(index as u64 + 900);
        for _ in 0..WINDOWS {
            let place = |random: &mut Random| random.below((SIDE - WINDOW) as usize) as u32;
            let crop = Rect { x: place(&mut random), y: place(&mut random), width: WINDOW, height: WINDOW };
            let options = Options { crop: Some(crop), ..options(SIDE, SIDE) };
            let comparison = compared(&scene, &options, &BOUNDED);
            rays += crop.pixels() as usize;
            for (grazing, trial) in grazing.iter_mut().zip(&comparison.trials) {
                let outcome = trial.outcome.as_ref().expect("every constant is known");
                let count = outcome.count(Verdict::Grazing);
                *grazing += count;
                grazed.extend((count > 0).then(|| format!("{count} by {:?} of {}", trial.method, notation(&field))));
                let agreeing = outcome.count(Verdict::Agrees) + outcome.count(Verdict::Grazing);
                let found = [Verdict::Missed, Verdict::False, Verdict::Unresolved, Verdict::Unjudged]
                    .map(|verdict| (verdict, outcome.count(verdict)));
                let all = outcome.verdicts.len();
                assert_eq!(agreeing, all, "{} by {:?}: {found:?} of {crop:?}", notation(&field), trial.method);
            }
        }
    }
    println!("{grazing:?} of {rays} rays graze, by {BOUNDED:?}");
    assert!(grazing.iter().all(|&count| count * 10_000 <= rays), "{grazing:?} of {rays} rays: {grazed:#?}");
}

#[test]
fn coarse_fixed_steps_miss_a_thin_plate_and_fine_ones_do_not() {
    let camera = Camera { eye: DVec3::new(0.0, -5.0, 0.0), target: DVec3::ZERO, ..Camera::default() };
    // A block gives the box around it all some depth to step through.
    let plate = cuboid([2.0, 0.01, 2.0]) | sphere(0.3).at([0.0, -1.0, 0.0]) | sphere(0.3).at([0.0, 1.0, 0.0]);
    let mut scene = Scene { camera: Some(camera), ..scene_of(plate) };
    let missed = |scene: &Scene| {
        let comparison = compared(scene, &options(40, 40), &[Method::Fixed, Method::Sphere]);
        assert_eq!(comparison.outcome(Method::Sphere).map(|outcome| outcome.count(Verdict::Missed)), Some(0));
        comparison.outcome(Method::Fixed).map(|outcome| outcome.count(Verdict::Missed)).expect("it needs nothing")
    };
    scene.tracer.step = Some(0.3);
    let coarse = missed(&scene);
    assert!(coarse > 200, "{coarse} pixels of the plate are missed");
    scene.tracer.step = Some(0.004);
    assert_eq!(missed(&scene), 0);
}

#[test]
fn fixed_steps_find_surfaces_without_a_sign() {
    // A sheet has no inside; its distance falls to 0 between two steps and rises again.
    let eye = DVec3::new(0.0, -4.0, 0.3);
    let mut scene = Scene { camera: Some(Camera { eye, ..Camera::default() }), ..scene_of(sheet([0.0, 1.0, 0.2])) };
    scene.tracer = Tracer { step: Some(0.37), ..scene.tracer };
    let comparison = compared(&scene, &options(24, 24), &Method::ALL);
    for trial in &comparison.trials {
        let outcome = trial.outcome.as_ref().expect("a distance");
        assert_eq!(outcome.count(Verdict::Agrees), 24 * 24, "{:?}", trial.method);
        assert_eq!(outcome.stats.hits, 24 * 24, "{:?}", trial.method);
    }
}

#[test]
fn over_relaxation_and_half_a_pixel_save_evaluations() {
    let still_life = (torus(1.0, 0.3) | cuboid([0.4, 0.4, 3.0])) - sphere(0.5).at([1.0, 0.0, 0.0]);
    let mut scene = scene_of(still_life | cuboid([6.0, 6.0, 0.2]).at([0.0, 0.0, -1.0]));
    let evaluations = |scene: &Scene| {
        let comparison = compared(scene, &options(80, 60), &[Method::Sphere, Method::Relaxed]);
        let of = |method| comparison.outcome(method).expect("distances").stats.evaluations;
        [of(Method::Sphere), of(Method::Relaxed)]
    };
    let [plain, relaxed] = evaluations(&scene);
    scene.tracer.relaxation = 1.0;
    let [_, unrelaxed] = evaluations(&scene);
    assert!(relaxed < unrelaxed && unrelaxed < plain, "{relaxed} {unrelaxed} {plain}");
}

#[test]
fn relaxed_rays_stop_within_half_a_pixel_before_the_surface() {
    let (eye, radius) = (DVec3::new(0.0, -10.0, 0.0), 2.0);
    let mut scene =
        Scene { camera: Some(Camera { eye, target: DVec3::ZERO, ..Camera::default() }), ..scene_of(sphere(radius)) };
    scene.tracer.method = Method::Relaxed;
    let options = options(60, 60);
    let (layers, _) = Renderer::new(&scene).expect("sound").layers(&options, &()).expect("layers");
    let camera = scene.camera.as_ref().expect("a camera");
    let mut farthest = 0.0_f64;
    for (index, pixel) in layers.pixels().iter().enumerate().filter(|(_, pixel)| pixel.object.is_some()) {
        let center = (index as f64 % 60.0 + 0.5, (index / 60) as f64 + 0.5);
        let (origin, direction) = camera_ray(camera, (60, 60), (center.0.floor() + 0.5, center.1));
        let distance = (origin + direction * f64::from(pixel.distance)).length() - radius;
        let Projection::Perspective { fov, .. } = camera.projection else { panic!("a perspective") };
        let half_a_pixel = f64::from(pixel.distance) * (fov / 2.0).tan() / 60.0;
        assert!(distance >= -1e-5 && distance <= 1.02 * half_a_pixel, "{distance} of {half_a_pixel}");
        farthest = farthest.max(distance / half_a_pixel);
    }
    assert!(farthest > 0.5, "the rule is made use of: {farthest}");
}

#[test]
fn formulas_can_be_marched_where_their_slope_has_a_bound() {
    let scene = |formula: &str| {
        let json = format!(r#"{{ "objects": [ {{ "name": "formula", "shape": {{ "formula": {formula} }} }} ] }}"#);
        freikugel_scene::read(&json).into_result().expect("sound")
    };
    let quartic = r#"{ "f": "x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 0.4", "within": { "sphere": 1.3 } }"#;
    let bounded = Scene { tracer: Tracer { max_steps: 20_000, ..Tracer::default() }, ..scene(quartic) };
    let comparison = compared(&bounded, &options(48, 32), &Method::ALL);
    for trial in &comparison.trials {
        let outcome = trial.outcome.as_ref().expect("a bound is found");
        let [missed, invented, open] =
            [Verdict::Missed, Verdict::False, Verdict::Unresolved].map(|verdict| outcome.count(verdict));
        assert!(missed + invented == 0 || trial.method == Method::Fixed, "{:?}: {missed}, {invented}", trial.method);
        // Where the slope along a silhouette is far below its bound, rays creep.
        assert!(open * 200 <= outcome.verdicts.len(), "{:?}: {open}", trial.method);
        assert!(outcome.stats.hits > 100);
    }

    for method in [Method::Sphere, Method::Relaxed] {
        let endless = Scene { tracer: Tracer::default().method(method), ..scene(r#""z - x^2 * y""#) };
        let error = render(&endless, &options(8, 8), &()).expect_err("there is no bound everywhere");
        assert!(matches!(error, RenderError::Prepare(PrepareError::NoScale { index: 0, .. })), "{error}");
        let said = error.to_string();
        assert!(said.contains("formula") && said.contains(method.name()) && said.contains("`guaranteed`"), "{said}");
    }
}

#[test]
fn formulas_that_are_distances_but_for_a_factor_are_found_whatever_the_factor() {
    // Their slope is even, so that they are marched by it in most cells.
    let hits = [1e-3, 1.0, 1e3].map(|factor| {
        let text = "max(sqrt(x^2 + y^2 + z^2) - 1, 0.4 - sqrt(x^2 + y^2), abs(z) - 0.7, 0.3 - max(abs(x), abs(y), z))";
        let field = formula(&format!("{factor} * {text}"));
        let field = field.within_sphere(1.2).into();
        let scene = around(&field, &mut Random::new(77)).expect("it has an extent");
        let comparison = compared(&scene, &options(160, 120), &[Method::Auto]);
        let outcome = comparison.trials[0].outcome.as_ref().expect("no constant is needed");
        for wrong in [Verdict::Missed, Verdict::False, Verdict::Unresolved, Verdict::Unjudged] {
            assert_eq!(outcome.count(wrong), 0, "{wrong:?} with the factor {factor}");
        }
        outcome.stats.hits
    });
    assert!(hits[1] > 2000 && hits.iter().all(|count| count.abs_diff(hits[1]) <= 2), "{hits:?}");
}

#[test]
fn pictures_with_shadows_look_alike() {
    let mut scene = scene_of(cuboid([6.0, 6.0, 0.2]).at([0.0, 0.0, -0.1]));
    add(&mut scene, sphere(0.6).at([0.0, 0.0, 0.9]) - cuboid([0.5, 2.0, 0.5]).at([0.0, 0.0, 1.2]), chalk());
    scene.camera = Some(Camera { eye: DVec3::new(2.0, -4.0, 3.0), ..Camera::default() });
    for (direction, shadow) in [([1.0, -0.3, 1.5], Shadow::Hardness(6.0)), ([-1.0, -1.0, 1.0], Shadow::Hard)] {
        scene.lights.push(Light::Sun(Sun { direction: direction.into(), shadow, intensity: 0.5, ..Sun::default() }));
    }
    scene.tracer.step = Some(0.01);
    let image = |method| {
        let scene = Scene { tracer: scene.tracer.clone().method(method), ..scene.clone() };
        picture(&scene, &options(48, 36)).image
    };
    let expected = image(Method::Auto);
    for method in Method::ALL {
        // Steps of a soft march end at other places, and so does the least ratio they see.
        let differs = |(a, b): &(&[f32; 3], &[f32; 3])| (a[0] - b[0]).abs() > 0.03;
        let image = image(method);
        let count = image.pixels().iter().zip(expected.pixels()).filter(differs).count();
        // Where an edge, or that of a shadow, falls on the other side of a ray; and the half pixel that relaxed rays let
        // silhouettes grow by.
        let allowed = image.pixels().len() / if method == Method::Relaxed { 10 } else { 100 };
        assert!(count <= allowed, "{method:?}: {count} pixels differ");
    }
}

#[test]
fn unresolved_pixels_have_the_warning_colour() {
    let warning = [0.9, 0.1, 0.7];
    for method in Method::ALL {
        let mut scene = scene_of(torus(1.0, 0.4) | sphere(0.5));
        scene.tracer =
            Tracer { max_steps: 4, warning: Some(warning), step: Some(0.1), ..Tracer::default().method(method) };
        let rendered = picture(&scene, &Options { samples: 4, ..options(32, 32) });
        let warned = rendered.image.pixels().iter().filter(|&&pixel| pixel == warning).count();
        assert!(warned > 10, "{method:?}");
        assert_eq!(warned as u64, rendered.stats.unresolved.pixels, "{method:?}");
    }
}

#[test]
fn the_precision_is_a_power_of_the_distance() {
    // How far before a wall rays stop that come to it at right angles, which a step factor keeps from arriving exactly.
    let gap = |distance: f64, exponent: f64| {
        let camera = Camera {
            eye: DVec3::new(0.0, -distance, 0.0),
            target: DVec3::ZERO,
            projection: Projection::Orthographic { height: 1e-6 },
            ..Camera::default()
        };
        let wall = cuboid([4.0, 1.0, 4.0]).at([0.0, 0.5, 0.0]) | sphere(0.1).at([0.0, -0.5 * distance, 1.5]);
        let mut scene = Scene { camera: Some(camera), ..scene_of(wall) };
        scene.tracer = Tracer { precision: 0.01, precision_exponent: exponent, step_factor: 0.1, ..scene.tracer };
        scene.tracer.method = Method::Sphere;
        let (layers, _) = Renderer::new(&scene).expect("sound").layers(&options(1, 1), &()).expect("layers");
        distance - f64::from(layers.pixels()[0].distance)
    };
    for exponent in [0.0, 0.5, 1.0, 1.5, 2.0] {
        for distance in [1.0, 4.0, 9.0] {
            let (gap, wanted) = (gap(distance, exponent), 0.01 * distance.powf(exponent));
            // From half way on a straight line stands for the power, below it; and then there is the last step.
            assert!(gap <= 1.001 * wanted && gap > 0.5 * wanted, "{gap} for {wanted} = 0.01 {distance}^{exponent}");
        }
    }
}
