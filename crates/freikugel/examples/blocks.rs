//! Shapes made by a loop: a spiral of blocks. `cargo run --release -p freikugel --example blocks`.

use freikugel::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    const BLOCKS: u32 = 24;
    let mut scene = Scene::new();
    let low = scene.material("low", Material::color("#2f6f7e"));
    let high = scene.material("high", Material::color("#d6a13a"));

    let blocks = (0..BLOCKS).map(|i| {
        let share = f64::from(i) / f64::from(BLOCKS);
        let block = cuboid([0.8, 0.5, 0.25]).round(0.04).painted(if share < 0.5 { low } else { high });
        block.at([1.2, 0.0, 0.15 * f64::from(i)]).rotate([0.0, 0.0, 1.0], 720.0 * share)
    });
    scene.add("stairs", union(blocks));
    scene.save(&scene.render()?, "blocks.png")?;
    Ok(())
}
