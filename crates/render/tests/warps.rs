//! Fields without a scale, rendered without being told one: the same pixels are hit as by sampling every ray densely.

mod common;

use common::*;
use freikugel_field::shapes::*;
use freikugel_field::{Extent, Field, Structure};
use freikugel_render::Renderer;
use freikugel_scene::{Ambient, Scene};
use glam::DVec3;

const WIDTH: u32 = 40;
const HEIGHT: u32 = 40;

/// The height of the view, and of the camera above the ground.
const VIEW: f64 = 3.2;
const EYE: f64 = 6.0;

/// Samples along each ray of the reference, over this depth on either side of the ground.
const SAMPLES: u32 = 1000;
const DEPTH: f64 = 2.5;

/// A surface this near to a ray, as a field value, may count as met or as missed: a sixteenth of half a pixel, which is what the
/// renderer allows, and the rounding of samples.
const GRAZE: f64 = VIEW / HEIGHT as f64 / 32.0 + 1e-4;

fn fields() -> Vec<(&'static str, Field)> {
    vec![
        ("twist", cuboid([1.2, 0.6, 2.4]).rotate([1.0, 0.0, 0.0], 90.0).twist(70.0).with("axis", &[1.into()])),
        ("strong spot", sphere(1.0).warp(["x + exp(-30*((x - 0.6)^2 + y^2)) / 2", "y", "z"])),
        ("waves", torus(0.9, 0.3).warp(["x + 0.2*sin(4y)", "y + 0.2*sin(4x)", "z"])),
        ("bumps", sphere(1.0).displace("0.08*sin(14x)*sin(14y)*sin(14z)")),
        ("bend", cuboid([3.6, 0.4, 0.8]).rotate([1.0, 0.0, 0.0], 20.0).bend(80.0)),
        ("taper", cuboid([1.6, 1.2, 2.0]).taper(-0.7, 0.8, 0.3).rotate([1.0, 0.3, 0.0], 70.0)),
        ("swirl", cuboid([2.4, 0.5, 0.6]).swirl(150.0, 0.8)),
        ("curl", cuboid([2.4, 0.8, 0.8]).curl(40.0)),
        (
            "loft",
            loft(2.4, [rectangle(1.8, 0.3).into(), circle(0.3).at([0.3, 0.2, 0.0]), rectangle(0.3, 1.8).into()])
                .rotate([1.0, 0.3, 0.0], 80.0),
        ),
        (
            "copies that overhang",
            cuboid([1.4, 0.2, 0.3]).rotate([0.3, 0.2, 1.0], 40.0).repeat_endless([0.9, 0.7, 0.8])
                & cuboid([2.4, 2.6, 1.2]).rotate([1.0, 1.0, 0.0], 20.0),
        ),
        ("mixed", sphere(0.6).at([0.8, 0.0, 0.0]) | cuboid([0.8, 1.6, 0.8]).twist(90.0).at([-0.6, 0.0, 0.0])),
        ("bare formula", formula("x^4 + y^4 + z^4 - (x^2 + y^2 + z^2) - 0.1").into()),
    ]
}

#[test]
fn warped_fields_are_met_where_dense_sampling_meets_them() {
    for (name, field) in fields() {
        let program = Structure::compile(std::slice::from_ref(&field)).expect("sound").program(DVec3::ZERO);
        let ambient = Ambient { sky: [1.0; 3], ground: [1.0; 3] };
        let mut scene = Scene { camera: Some(from_above(EYE, VIEW)), ambient, ..dark() };
        add(&mut scene, field, chalk());
        let renderer = Renderer::new(&scene).expect("a sound scene");
        let (layers, _) = renderer.layers(&options(WIDTH, HEIGHT), &()).expect("layers");
        let mut hits = 0;
        for row in 0..HEIGHT {
            for column in 0..WIDTH {
                let at = |index: u32, count: u32| (f64::from(index) + 0.5) / f64::from(count) - 0.5;
                let (x, y) = (VIEW * at(column, WIDTH), -VIEW * at(row, HEIGHT));
                let height = |i: u32| DEPTH - 2.0 * DEPTH * f64::from(i) / f64::from(SAMPLES);
                let value = |i: u32| program.value(DVec3::new(x, y, height(i)));
                let first = (0..SAMPLES).find(|&i| value(i) < 0.0);
                let pixel = &layers.pixels()[(row * WIDTH + column) as usize];
                let is_hit = pixel.object == Some(0);
                hits += u32::from(is_hit);
                match first {
                    Some(i) => {
                        let least = (i..SAMPLES).map(value).fold(f64::INFINITY, f64::min);
                        assert!(is_hit || least > -GRAZE, "{name} at {x}, {y}: missed, at height {}", height(i));
                        // It stops before or at the first crossing, where the field nearly vanishes.
                        let t = f64::from(pixel.distance);
                        let there = program.value(DVec3::new(x, y, EYE - t)).abs();
                        assert!(!is_hit || there < 2.0 * GRAZE, "{name} at {x}, {y}: {there} at the hit");
                        let is_late = t > EYE - height(i) + 2.0 * DEPTH / f64::from(SAMPLES);
                        assert!(!(is_hit && is_late) || least > -GRAZE, "{name} at {x}, {y}: went through");
                    }
                    None => {
                        let least = (0..SAMPLES).map(value).fold(f64::INFINITY, f64::min);
                        assert!(!is_hit || least < GRAZE, "{name} at {x}, {y}: met nothing, {least} away");
                    }
                }
            }
        }
        assert!(hits > WIDTH * HEIGHT / 10, "{name}: {hits} hits");
    }
}

#[test]
fn an_extent_that_is_found_frames_the_picture() {
    let mut scene = dark();
    add(&mut scene, formula("(x - 7)^2 + y^2/4 + z^2 - 1"), chalk());
    let extent = Renderer::new(&scene).expect("a sound scene").extent().expect("found");
    assert!((extent.center() - DVec3::new(7.0, 0.0, 0.0)).length() < 0.01, "{extent:?}");
    assert!((extent.size() - DVec3::new(2.0, 4.0, 2.0)).abs().max_element() < 0.01, "{extent:?}");
    let open: Field = formula("x*y - 1").into();
    assert_eq!(freikugel_field::extent(&open), Extent::Unbounded);
    let mut scene = dark();
    add(&mut scene, open, chalk());
    assert_eq!(Renderer::new(&scene).expect("a sound scene").extent(), None);
}
