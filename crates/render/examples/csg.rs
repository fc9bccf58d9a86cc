//! Renders the CSG benchmark scene built in code, prints where the time went, and writes a PNG.
//!
//! `cargo run --release -p freikugel-render --example csg -- csg.png [samples [threads]]`

use freikugel_field::shapes::*;
use freikugel_field::{Field, MaterialId};
use freikugel_render::{Options, Tone, encode_png, render};
use freikugel_scene::{
    Ambient, Background, Camera, Falloff, FovAxis, Light, Material, Model, Object, Pattern, Point, Projection, Rgb,
    Scene, Sun,
};
use glam::DVec3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("name the PNG to write")?;
    let samples = arguments.next().map_or(Ok(1), |text| text.parse())?;
    let threads = arguments.next().map(|text| text.parse()).transpose()?;
    let scene = scene();
    let options = Options { samples, threads, ..Options::of(&scene) };
    let picture = render(&scene, &options, &())?;
    println!("{:#?}", picture.stats);
    std::fs::write(path, encode_png(&picture.image, &Tone::of(&scene.picture))?)?;
    Ok(())
}

/// Nine primitives combined to five objects, on a checkered ground, under a sun and a lamp that cast hard shadows.
fn scene() -> Scene {
    let degrees = f64::to_radians;
    let finish = |color: Rgb| Material {
        color: Pattern::Solid(color),
        ambient: 0.08,
        specular: 0.5,
        exponent: 40.0,
        model: Model::Phong,
        ..Material::default()
    };
    let checker = Pattern::Checker { colors: [[0.85; 3], [0.25; 3]], size: 1.0 };
    let ground = Material { color: checker, ambient: 0.08, specular: 0.0, ..Material::default() };
    let about_z = |shape: Field, angle: f64| shape.rotate([0.0, 0.0, 1.0], angle);
    let objects = [
        ("ground", [0.0; 3], plane([0.0, 0.0, 1.0]).into()),
        (
            "bitten box",
            [0.85, 0.25, 0.2],
            about_z(cuboid([2.0, 2.0, 2.0]).at([0.0, 0.0, 1.0]) - sphere(1.05).at([0.3, -0.6, 1.6]), 25.0)
                .at([-3.2, 0.0, 0.0]),
        ),
        ("rounded box", [0.25, 0.65, 0.3], about_z(cuboid([1.8, 1.8, 1.8]) & sphere(1.15), 30.0).at([0.0, 0.0, 0.9])),
        (
            "ball on box",
            [0.25, 0.4, 0.85],
            about_z(cuboid([1.8, 1.0, 0.8]).at([0.0, 0.0, 0.4]) | sphere(0.7).at([0.0, 0.0, 1.2]), -20.0)
                .at([3.0, -0.2, 0.0]),
        ),
        ("ring", [0.9, 0.75, 0.2], torus(0.8, 0.25).rotate([1.0, 0.0, 0.0], 60.0).at([-1.7, -2.8, 0.9])),
        ("tube", [0.7, 0.4, 0.75], (cylinder(0.6, 1.6) - cylinder(0.4, 3.0)).at([1.8, -2.6, 0.8])),
    ];
    let mut scene = Scene {
        camera: Some(Camera {
            eye: DVec3::new(0.0, -9.5, 4.2),
            target: DVec3::new(0.0, 0.0, 0.8),
            projection: Projection::Perspective { fov: degrees(50.0), axis: FovAxis::Horizontal },
            ..Camera::default()
        }),
        lights: vec![
            Light::Sun(Sun { direction: DVec3::new(5.0, -4.0, 8.0), color: [0.7; 3], ..Sun::default() }),
            Light::Point(Point {
                position: DVec3::new(-4.0, -5.0, 6.0),
                color: [0.9, 0.8, 0.6],
                falloff: Falloff::Polynomial([0.5, 0.0, 0.5 / 64.0]),
                ..Point::default()
            }),
        ],
        ambient: Ambient { sky: [1.0; 3], ground: [1.0; 3] },
        occlusion: None,
        background: Background::Solid([0.55, 0.7, 0.9]),
        ..Scene::default()
    };
    for (index, (name, color, shape)) in objects.into_iter().enumerate() {
        let material = if index == 0 { ground.clone() } else { finish(color) };
        scene.materials.push((name.into(), material));
        scene.objects.push(Object { name: name.into(), material: Some(MaterialId(index as u32)), shape });
    }
    scene
}
