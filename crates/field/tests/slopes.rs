//! Slopes over regions, found without help: never exceeded, and near to what is there.

mod common;

use common::{Random, tree};
use freikugel_field::shapes::*;
use freikugel_field::{Field, Interval, Program, Structure, analyse};
use glam::DVec3;

/// Formulas with kinks, cancelling terms, lengths and poles outside of where they are tested.
const TEXTS: [&str; 8] = [
    "x^2 + 2y^2 + z^2 - 0.6",
    "x^4 + y^4 + z^4 - (x^2 + y^2 + z^2) / 2 + x*y / 5 - 0.1",
    "sin(3x) * cos(3y) + sin(3y) * cos(3z) + sin(3z) * cos(3x)",
    "max(abs(x) - 0.5, min(y, exp(z) - 1.2), abs(abs(z - 0.3) - 1) - 0.7)",
    "r = hypot(x, y); hypot(r - 1, z) - 0.4 - sin(3x) * sin(3y) / 9",
    "1 / (4 + x) - tan(z / 4) * acos(y / 9) + asin(x / 9) - pow(4 + y, 1.3) / 5 + 0.2",
    "ln(4 + y) - sqrt(4 + z) + atan2(y, x + 4)",
    "x^3 - 3x*y^2 + (z + 4)^-2 / 9",
];

fn program(field: impl Into<Field>) -> Program {
    Structure::compile(&[field.into()]).expect("a sound field").program(DVec3::ZERO)
}

fn cube(middle: DVec3, half: f64) -> [Interval; 3] {
    middle.to_array().map(|c| Interval::new(c - half, c + half))
}

/// The steepest slope found in a box by sampling.
fn steepest(program: &Program, region: [Interval; 3], samples: usize, random: &mut Random) -> f64 {
    let mut at = || DVec3::from_array(region.map(|side| random.range(side.lo(), side.hi())));
    (0..samples).map(|_| program.gradient(at()).1.length()).fold(0.0, f64::max)
}

/// Formulas alone, cut, placed, and under operators.
fn fields(random: &mut Random) -> Vec<(String, Field)> {
    let mut all: Vec<(String, Field)> = TEXTS.iter().map(|text| (text.to_string(), formula(text).into())).collect();
    for text in TEXTS {
        let turned = |field: Field| field.rotate([1.0, 2.0, 3.0], 40.0).at([0.2, -0.1, 0.3]);
        let cut: Field = formula(text).within_sphere(1.5).into();
        all.push((format!("placed {text}"), turned(cut)));
        let stretched = formula(text).stretch([0.5, 1.5, -1.0]).offset(0.1).shell(0.2);
        all.push((format!("stretched {text}"), stretched));
        let mut solid = |depth| loop {
            let tree = tree(depth, random);
            if analyse(&tree).0.is_some_and(|analysis| analysis.contract.signed) {
                break tree;
            }
        };
        let blend = smooth_union(0.3, [turned(formula(text).into()), solid(2)]);
        all.push((format!("blended {text}"), blend - solid(1)));
    }
    all
}

#[test]
fn a_slope_over_a_region_is_never_exceeded() {
    let mut random = Random::new(1);
    for (name, field) in fields(&mut random) {
        let program = program(field);
        for _ in 0..6 {
            let region = cube(random.point(1.5), 10f64.powf(random.range(-3.0, 0.0)));
            let bound = program.lipschitz_over(region).expect("bounded here");
            let rounding = 1e-12;
            for _ in 0..150 {
                let mut at = || DVec3::from_array(region.map(|side| random.range(side.lo(), side.hi())));
                let (p, q) = (at(), at());
                let rise = (program.value(p) - program.value(q)).abs();
                assert!(rise <= bound * p.distance(q) * (1.0 + 1e-9) + rounding, "{name}: {rise} from {p} to {q}");
                let slope = program.gradient(p).1.length();
                assert!(slope <= bound * (1.0 + 1e-9), "{name} at {p}: {slope} above {bound}");
            }
        }
    }
}

#[test]
fn a_slope_over_a_region_is_not_lazy() {
    let mut random = Random::new(2);
    for text in TEXTS {
        let program = program(formula(text));
        for half in [1.5, 0.3, 0.01] {
            let region = cube(random.point(0.5), half);
            let bound = program.lipschitz_over(region).expect("bounded here");
            let found = steepest(&program, region, 40_000, &mut random);
            // Several waves with a slope of the same size everywhere use up the budget.
            let factor = if text.contains("sin(3x)") && half > 1.0 { 1.45 } else { 1.3 };
            assert!(bound <= factor * found, "{text} over {region:?}: {bound} for {found}");
        }
    }
}

#[test]
fn a_range_over_a_region_holds_all_values_and_little_else() {
    let mut random = Random::new(44);
    for (index, (name, field)) in fields(&mut random).into_iter().enumerate() {
        let program = program(field);
        let half = [0.05, 0.3, 1.0][index % 3];
        let region = cube(random.point(0.5), half);
        let range = program.range_over(region);
        // Also corners, where the least and largest values often are.
        let mut at = || {
            let side = |side: Interval| random.range(-0.3, 1.3).clamp(0.0, 1.0) * side.width() + side.lo();
            DVec3::from_array(region.map(side))
        };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in (0..3000).map(|_| program.value(at())) {
            assert!(range.contains(value), "{name}: {value} outside of {range:?}");
            (low, high) = (low.min(value), high.max(value));
        }
        // Blends are so intricate that the search stops early.
        let is_near = range.width() < 1.25 * (high - low) || name.contains("blended");
        assert!(is_near, "{name} over {region:?}: {range:?} for {low} to {high}");
    }
}

#[test]
fn known_ranges_are_found() {
    let over = |text: &str, sides: [[f64; 2]; 3]| {
        let range = program(formula(text)).range_over(sides.map(|[lo, hi]| Interval::new(lo, hi)));
        [range.lo(), range.hi()]
    };
    for (text, sides, expected) in [
        ("x^2 - x", [[0.0, 1.0], [0.0; 2], [0.0; 2]], [-0.25, 0.0]),
        ("x*y - z", [[0.0, 1.0], [-1.0, 1.0], [0.5; 2]], [-1.5, 0.5]),
        ("3", [[0.0, 1.0]; 3], [3.0, 3.0]),
        ("x", [[2.0; 2]; 3], [2.0, 2.0]),
    ] {
        let found = over(text, sides);
        let slack = 1e-3 * (expected[1] - expected[0]) + 1e-12;
        assert!(found[0] <= expected[0] && found[1] >= expected[1], "{text}: {found:?}");
        assert!(found[0] >= expected[0] - slack && found[1] <= expected[1] + slack, "{text}: {found:?}");
    }
    // Where there is no value, or no bound, there is none.
    assert_eq!(over("1 / x", [[-1.0, 1.0]; 3]), [f64::NEG_INFINITY, f64::INFINITY]);
}

#[test]
fn known_slopes_are_found() {
    let over = |field: Field, half: f64| program(field).lipschitz_over(cube(DVec3::ZERO, half));
    let is_near = |bound: Option<f64>, exact: f64| {
        let bound = bound.expect("bounded");
        assert!(exact <= bound && bound <= 1.25 * exact * (1.0 + 1e-9), "{bound} for {exact}");
    };
    is_near(over(formula("x^2 + y^2 + z^2 - 1").into(), 1.0), 2.0 * 3f64.sqrt());
    is_near(over(formula("5x - 2").into(), 100.0), 5.0);
    // A length is as steep as its argument, also where that is 0.
    is_near(over(formula("hypot(x, y, z) - 1").into(), 1.0), 1.0);
    is_near(over(formula("hypot(3x, y) - 1").into(), 1.0), 3.0);
    // Both terms are steepest together only where the sine's slope and the square's meet.
    is_near(over(formula("sin(40x) / 20 + y^2").into(), 1.0), 8f64.sqrt());
    // At (1, 1/2, 1/2) of the formula's own space: (yz, xz, xy).
    is_near(over(formula("x*y*z").scale(2.0).at([1.0, 0.0, 0.0]), 1.0), 0.75);
}

#[test]
fn steps_and_cusps_have_no_slope() {
    for text in ["floor(3x)", "sqrt(abs(x))", "1 / x", "step(x, y)", "ln(x^2)"] {
        assert_eq!(program(formula(text)).lipschitz_over(cube(DVec3::ZERO, 1.0)), None, "{text}");
        let away = program(formula(text)).lipschitz_over(cube(DVec3::new(0.6, 0.2, 0.0), 0.05));
        assert!(away.is_some(), "{text} away from its step or pole");
    }
}

#[test]
fn a_distance_is_no_steeper_over_a_region_than_everywhere() {
    let mut random = Random::new(3);
    for seed in 0..60 {
        let field = tree(3, &mut Random::new(seed));
        let lipschitz = analyse(&field).0.expect("sound").contract.lipschitz.expect("known");
        let program = program(field);
        let region = cube(random.point(1.0), 0.5);
        let bound = program.lipschitz_over(region).expect("known");
        assert!(bound <= lipschitz, "seed {seed}: {bound} above {lipschitz}");
        let found = steepest(&program, region, 300, &mut random);
        assert!(found <= bound * (1.0 + 1e-9), "seed {seed}: {found} above {bound}");
    }
}
