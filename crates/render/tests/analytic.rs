//! Pictures of balls and grounds against closed forms.

mod common;

use common::*;
use freikugel_field::shapes::plane;
use freikugel_scene::{
    Ambient, Background, Camera, Falloff, FovAxis, Light, Material, Model, Pattern, Point, Projection, Scene, Shadow,
    Spot, Sun,
};
use glam::DVec3;

const SIZE: (u32, u32) = (320, 240);

/// The share of pixels a test may leave out because an edge runs through them.
const EDGES: f64 = 0.03;

/// How far from its place a pixel's colour may come from: twice the tolerance of a hit, in pixels.
const NEAR: f64 = 0.06;

fn camera(eye: [f64; 3]) -> Camera {
    Camera { eye: eye.into(), target: DVec3::new(0.0, 0.0, 0.8), ..Camera::default() }
}

fn glossy(model: Model) -> Material {
    Material {
        color: Pattern::Solid([0.8, 0.4, 0.2]),
        diffuse: 0.7,
        specular: 0.3,
        exponent: 20.0,
        model,
        ..Material::default()
    }
}

fn ball(material: Material) -> Balls {
    Balls { balls: vec![(DVec3::new(0.2, 0.0, 1.0), 1.0, material)], ground: None }
}

#[test]
fn a_ball_under_a_sun() {
    for model in [Model::Phong, Model::BlinnPhong] {
        let balls = ball(glossy(model));
        let mut scene = Scene { camera: Some(camera([2.0, -4.0, 2.0])), ..dark() };
        let sun = Sun { direction: DVec3::new(1.0, -0.5, 2.0), color: [1.0, 0.9, 0.8], ..Sun::default() };
        scene.lights.push(Light::Sun(sun));
        balls.add_to(&mut scene);
        compare(&scene, &balls, SIZE, NEAR, EDGES);
    }
}

#[test]
fn ambient_light_emission_and_background() {
    let balls = ball(Material { emissive: [0.1, 0.0, 0.3], ambient: 0.5, ..glossy(Model::Phong) });
    let mut scene = Scene {
        camera: Some(camera([2.0, -4.0, -1.0])),
        ambient: Ambient { sky: [0.5, 0.7, 1.0], ground: [0.2, 0.1, 0.05] },
        background: Background::Gradient { top: [0.1, 0.2, 0.8], bottom: [0.9, 0.8, 0.7] },
        ..dark()
    };
    balls.add_to(&mut scene);
    compare(&scene, &balls, SIZE, NEAR, EDGES);
}

#[test]
fn point_lights_fall_off_and_cast_shadows() {
    for falloff in [Falloff::None, Falloff::InverseSquare, Falloff::Polynomial([0.5, 0.1, 0.05])] {
        let mut balls = ball(glossy(Model::BlinnPhong));
        balls.balls.push((DVec3::new(-1.2, -0.8, 0.4), 0.4, chalk()));
        balls.ground = Some(chalk());
        let mut scene = Scene { camera: Some(camera([1.0, -5.0, 3.0])), ..dark() };
        let lamp = Point {
            position: DVec3::new(-2.0, -2.5, 3.0),
            intensity: if let Falloff::InverseSquare = falloff { 8.0 } else { 1.0 },
            falloff,
            ..Point::default()
        };
        scene.lights.push(Light::Point(lamp));
        balls.add_to(&mut scene);
        compare(&scene, &balls, SIZE, NEAR, 2.0 * EDGES);
    }
}

#[test]
fn spots_have_an_edge() {
    for softness in [0.1, 0.8] {
        let balls = Balls { ground: Some(chalk()), ..ball(chalk()) };
        let mut scene = Scene { camera: Some(camera([1.0, -5.0, 3.0])), ..dark() };
        scene.lights.push(Light::Spot(Spot {
            position: DVec3::new(2.0, -2.5, 4.0),
            angle: 0.6,
            softness,
            intensity: 20.0,
            ..Spot::default()
        }));
        balls.add_to(&mut scene);
        compare(&scene, &balls, SIZE, NEAR, 0.1);
    }
}

#[test]
fn hard_shadows_of_a_sun_fall_where_geometry_says() {
    let mut balls = ball(chalk());
    balls.balls.push((DVec3::new(-1.0, 0.5, 2.2), 0.5, chalk()));
    balls.ground = Some(chalk());
    let mut scene = Scene { camera: Some(camera([0.5, -6.0, 4.0])), ..dark() };
    let sun = Sun { direction: DVec3::new(-1.0, -0.3, 1.0), ..Sun::default() };
    scene.lights.push(Light::Sun(sun.clone()));
    balls.add_to(&mut scene);
    let shadowed = compare(&scene, &balls, SIZE, NEAR, 2.0 * EDGES);

    scene.lights = vec![Light::Sun(Sun { shadow: Shadow::None, ..sun })];
    let unshadowed = compare(&scene, &balls, SIZE, NEAR, EDGES);
    assert_ne!(shadowed, unshadowed);
}

#[test]
fn a_plane_ends_at_the_horizon_and_nowhere_before() {
    // One pixel is a tenth of a degree: the rows next to the horizon see the ground hundreds of heights away.
    for height in [0.001, 1.0, 100.0] {
        let balls = Balls { ground: Some(chalk()), ..Balls::default() };
        let eye = DVec3::new(3.0, 2.0, height);
        let mut scene = Scene {
            camera: Some(Camera { eye, target: eye + DVec3::Y, ..Camera::default() }),
            background: Background::Solid([0.0, 0.0, 1.0]),
            ..dark()
        };
        scene.lights.push(Light::Sun(Sun { direction: DVec3::Z, ..Sun::default() }));
        balls.add_to(&mut scene);
        let image = compare(&scene, &balls, (20, 400), NEAR, 0.0);
        assert_eq!(image.pixel(10, 199), [0.0, 0.0, 1.0]);
        assert_eq!(image.pixel(10, 200), [1.0; 3]);
    }
}

#[test]
fn tilted_and_painted_planes_are_exact_too() {
    use freikugel_field::shapes::{Rotate, Translate};
    let mut scene = Scene { camera: Some(camera([2.0, -4.0, 2.0])), ..dark() };
    scene.lights.push(Light::Sun(Sun { direction: DVec3::new(0.0, -1.0, 1.0), ..Sun::default() }));
    // A plane that faces the sun and passes through (0, 0, 0.8), the middle of the picture.
    let shape = plane([0.0, 0.0, 2.0]).rotate([1.0, 0.0, 0.0], 45.0).at([0.0, 0.0, 0.8]);
    add(&mut scene, shape, chalk());
    let rendered = picture(&scene, &options(9, 9));
    assert!((rendered.image.pixel(4, 4)[0] - 1.0).abs() < 1e-5, "{:?}", rendered.image.pixel(4, 4));
    assert_eq!(rendered.stats.steps, 0, "no ray marches");
}

#[test]
fn projections_have_the_scale_they_name() {
    let degrees = f64::to_radians;
    for projection in [
        Projection::Orthographic { height: 3.0 },
        Projection::Perspective { fov: degrees(30.0), axis: FovAxis::Vertical },
        Projection::Perspective { fov: degrees(50.0), axis: FovAxis::Horizontal },
    ] {
        let balls = Balls { ground: Some(chalk()), ..ball(glossy(Model::Phong)) };
        let camera = Camera { projection, ..camera([2.0, -4.0, 2.0]) };
        let mut scene = Scene { camera: Some(camera), ..dark() };
        scene.lights.push(Light::Sun(Sun { direction: DVec3::new(1.0, -2.0, 2.0), ..Sun::default() }));
        balls.add_to(&mut scene);
        compare(&scene, &balls, SIZE, NEAR, 2.0 * EDGES);
    }
}

#[test]
fn an_orthographic_ball_covers_its_cross_section() {
    let balls = Balls { balls: vec![(DVec3::ZERO, 1.0, chalk())], ground: None };
    let mut scene = Scene { camera: Some(from_above(10.0, 4.0)), ..dark() };
    scene.ambient = Ambient { sky: [1.0; 3], ground: [1.0; 3] };
    balls.add_to(&mut scene);
    let rendered = picture(&scene, &options(200, 100));
    let area = rendered.stats.hits as f64 * 0.04 * 0.04;
    assert!((area - std::f64::consts::PI).abs() < 0.03, "{area}");
}

#[test]
fn a_checkered_ground_is_sharp_near_and_even_far_away() {
    let colors = [[1.0; 3], [0.0; 3]];
    let material = Material { color: Pattern::Checker { colors, size: 0.75 }, ..chalk() };
    let balls = Balls { ground: Some(material), ..Balls::default() };
    let ambient = Ambient { sky: [1.0; 3], ground: [1.0; 3] };
    let mut scene = Scene { camera: Some(from_above(10.0, 3.3)), ambient, ..dark() };
    balls.add_to(&mut scene);
    // Straight down, the footprint is a pixel: cells of 109 pixels keep their inner 107 by 107.
    compare(&scene, &balls, (480, 480), 0.51, 1.0 - (106.0f64 / 109.0).powi(2));

    let eye = DVec3::new(0.1, 0.2, 1.0);
    scene.camera = Some(Camera { eye, target: eye + DVec3::Y, ..Camera::default() });
    let image = picture(&scene, &options(40, 400)).image;
    for x in 0..40 {
        let value = image.pixel(x, 201)[0];
        assert!((value - 0.5).abs() < 0.1, "{x}: {value}");
    }
}
