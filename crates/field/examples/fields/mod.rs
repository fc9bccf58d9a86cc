//! Fields that speed is measured with.

#![allow(unreachable_pub, reason = "the benchmark includes this file as a public module")]

use freikugel_field::{Field, shapes::*};

/// 10 primitives with 9 operators, some of them blends.
pub fn csg20() -> Field {
    let body = cuboid([1.0, 1.0, 0.6]).round(0.05) - cylinder(0.25, 1.2);
    let body = smooth_union(0.1, [body, torus(0.35, 0.08).at([0.0, 0.0, 0.3])]);
    let body = smooth_union(0.08, [body, sphere(0.2).at([0.55, 0.0, 0.2])]);
    let body = smooth_union(0.08, [body, sphere(0.2).at([-0.55, 0.0, 0.2])]);
    let body = body - cuboid([0.16, 0.4, 1.0]).at([0.0, 0.5, 0.1]).rotate([0.0, 0.0, 1.0], 40.0);
    let body = body | cylinder(0.1, 1.0);
    let body = smooth_union(0.05, [body, sphere(0.14).at([0.0, 0.0, 0.55])]);
    body | cuboid([1.4, 1.4, 0.14]).round(0.02).at([0.0, 0.0, -0.45])
        | torus(0.6, 0.05).at([0.0, 0.0, -0.35]).rotate([0.0, 0.0, 1.0], 40.0)
}

/// This many small primitives in a cube of edge 1.6, every eighth of them blended with those before it.
pub fn many(count: usize) -> Field {
    let mut seed = 0x1234_5678_u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 8) / f64::from(1 << 24)
    };
    let mut all: Option<Field> = None;
    for i in 0..count {
        let at = [(); 3].map(|()| random() * 1.6 - 0.8);
        let q = 0.04 + 0.06 * random();
        let next = match i % 4 {
            0 => sphere(q).at(at),
            1 => cuboid([2.0 * q, 2.0 * q, 1.2 * q]).round(0.01).at(at),
            2 => torus(q, 0.3 * q).at(at),
            _ => cylinder(0.6 * q, 2.0 * q).at(at),
        };
        all = Some(match all {
            None => next,
            Some(all) if i % 8 == 0 => smooth_union(0.03, [all, next]),
            Some(all) => all | next,
        });
    }
    all.expect("at least one")
}
