//! A cup, as in the documentation of the crate: `cargo run --release -p freikugel --example cup`.

use freikugel::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = Scene::new();
    let clay = scene.material("clay", Material::color("#c8825a").specular(0.2).exponent(32));
    let floor = scene.material("floor", Material::color("#d8cfc0"));

    let body = cylinder(1.0, 2.0).round(0.05) - cylinder(0.85, 2.0).at([0.0, 0.0, 0.2]);
    let handle = torus(0.55, 0.12).along(Axis::Y).at([-1.0, 0.0, 0.0]) - cylinder(0.9, 3.0);
    let cup = smooth_union(0.1, [body, handle]);

    scene
        .add("cup", cup.painted(clay).at([0.0, 0.0, 1.0]))
        .add("floor", plane([0.0, 0.0, 1.0]).painted(floor))
        .camera(Camera::look([4.0, -6.0, 3.5], [-0.2, 0.0, 0.8]).fov(32));

    let picture = scene.render()?;
    scene.save(&picture, "cup.png")?;
    println!("cup.png: {} unresolved pixels", picture.stats.unresolved.pixels);
    Ok(())
}
