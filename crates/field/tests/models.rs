//! Taylor models along rays: what they promise, how fast they converge, and that they have the same bits everywhere.

mod common;

use common::Random;
use freikugel_field::kernel::{BATCH, WIDEST};
use freikugel_field::shapes::*;
use freikugel_field::{Encloser, Field, ModelLanes, Program, Structure, simd};
use glam::{DVec3, Vec3};

/// Formulas of all sorts. Where they have no value at all, models say so; where only partly, they know nothing.
const TEXTS: [&str; 12] = [
    "x^2 + 2y^2 + z^2 - 0.6",
    "x^4 + y^4 + z^4 - (x^2 + y^2 + z^2) / 2 + x*y / 5 - 0.1",
    "sin(3x) * cos(3y) + sin(3y) * cos(3z) + sin(3z*x) * cos(3x - y^2)",
    "max(abs(x) - 0.5, min(y, exp(z) - 1.2), abs(abs(z - 0.3) - 1) - 0.7)",
    "floor(2x) / 2 + ln(4 + y) - sqrt(abs(z)) + atan2(y, x + 4)",
    "1 / (4 + x) - tan(z / 4) * acos(y / 9) + asin(x / 9) - pow(4 + y, 1.3) / 5 + 0.2",
    "x^3 - 3x*y^2 + z^-2 / 9 + step(x, y) / 3",
    "sqrt(x^2 + y^2) - exp(-3z^2) * cos(7x*y) + atan(x*y*z)",
    "ln(2 + x*y) + 1 / (3 + sin(x) * z) - sqrt(4 - x^2)",
    "ln(x) - y",
    "sqrt(y - 0.3) + z * exp(x)",
    "max(x - y, z^2 - x*y, cos(4z))",
];

/// Stretches side by side.
struct Lanes {
    origin: Vec<Vec3>,
    direction: Vec<Vec3>,
    middle: Vec<f32>,
    half: Vec<f32>,
}

impl Lanes {
    fn random(random: &mut Random, longest: f64) -> Self {
        let count = 4 * WIDEST;
        Self {
            origin: (0..count).map(|_| random.point(2.0).as_vec3()).collect(),
            direction: (0..count).map(|_| random.direction().as_vec3()).collect(),
            middle: (0..count).map(|_| random.range(0.0, 1.5) as f32).collect(),
            half: (0..count).map(|_| (longest * 10.0f64.powf(random.range(-4.0, 0.0))) as f32).collect(),
        }
    }

    fn count(&self) -> usize {
        self.middle.len()
    }

    /// The point of a stretch at a parameter, as exact numbers.
    fn point(&self, lane: usize, s: f64) -> DVec3 {
        let t = f64::from(self.middle[lane]) + s * f64::from(self.half[lane]);
        self.origin[lane].as_dvec3() + self.direction[lane].as_dvec3() * t
    }
}

/// The models of a field's zeros: of the first field and of the cut.
type Numbers = [Option<[Vec<f32>; 6]>; 2];

fn models(encloser: &mut Encloser<'_>, program: &Program, lanes: &Lanes) -> Numbers {
    let zeros = encloser.models(program.whole(), lanes.count(), |out| {
        for (axis, (origin, direction)) in out.origin.into_iter().zip(out.direction).enumerate() {
            for lane in 0..lanes.count() {
                (origin[lane], direction[lane]) = (lanes.origin[lane][axis], lanes.direction[lane][axis]);
            }
        }
        out.middle.copy_from_slice(&lanes.middle);
        out.half.copy_from_slice(&lanes.half);
    });
    let numbers = |model: ModelLanes<'_>| {
        let [a, b, c, d, e] = model.p.map(<[f32]>::to_vec);
        [a, b, c, d, e, model.r.to_vec()]
    };
    [Some(numbers(zeros.first)), zeros.cut.map(numbers)]
}

/// Checks the promise of some models of `field` and returns how many know something.
fn check(text: &str, [p @ .., r]: &[Vec<f32>; 6], field: &Program, lanes: &Lanes) -> usize {
    let mut known = 0;
    for lane in 0..lanes.count() {
        let bound = f64::from(r[lane]);
        let is_undefined = p[0][lane].is_nan();
        known += usize::from(bound.is_finite() && !is_undefined);
        for i in 0..=40 {
            let s = f64::from(i) / 20.0 - 1.0;
            let value = field.value(field.origin() + lanes.point(lane, s));
            if is_undefined || value.is_nan() {
                // Where there is a value on a part of the stretch alone, the model holds there.
                assert!(value.is_nan(), "{text}: {value} where there should be no value");
                continue;
            }
            let model = p.iter().rev().fold(0.0, |sum, term| sum * s + f64::from(term[lane]));
            assert!(
                !bound.is_finite() || (value - model).abs() <= bound,
                "{text}: {value} is not within {bound} of {model} at {s}, half {}",
                lanes.half[lane]
            );
        }
    }
    known
}

fn program(field: impl Into<Field>) -> Program {
    Structure::compile(&[field.into()]).expect("sound").program(DVec3::new(0.5, 0.1, -0.2))
}

#[test]
fn models_hold_what_they_promise() {
    let mut random = Random::new(11);
    for text in TEXTS {
        let placed = |field: Field| field.rotate([1.0, 2.0, 3.0], 40.0).at([0.2, -0.3, 0.4]);
        let bare = program(placed(formula(text).into()));
        let ball = program(placed(sphere(1.6).into()));
        let block = program(placed(cuboid([2.0, 3.0, 2.5]).into()));
        for (region, field) in [
            (None, formula(text)),
            (Some(&ball), formula(text).within_sphere(1.6)),
            (Some(&block), formula(text).within_box([2.0, 3.0, 2.5])),
        ] {
            let cut = program(placed(field.into()));
            let mut known = 0;
            for _ in 0..10 {
                let lanes = Lanes::random(&mut random, 1.0);
                let all = simd::available();
                let numbers: Vec<Numbers> =
                    all.iter().map(|&level| models(&mut Encloser::new(&cut, level), &cut, &lanes)).collect();
                let bits = |numbers: &Numbers| -> Vec<u32> {
                    numbers.iter().flatten().flatten().flatten().map(|number| number.to_bits()).collect()
                };
                for other in &numbers[1..] {
                    assert_eq!(bits(&numbers[0]), bits(other), "{text}: on another instruction set");
                }
                let [first, other] = &numbers[0];
                match (first, other, region) {
                    // A formula that is a maximum itself is taken apart as well.
                    (Some(_), Some(_), None) => known = usize::MAX,
                    (Some(first), Some(other), Some(region)) if !text.starts_with("max") => {
                        known += check(text, first, &bare, &lanes);
                        assert_eq!(check(text, other, region, &lanes), lanes.count(), "regions are known everywhere");
                    }
                    (Some(first), None, None) => known += check(text, first, &bare, &lanes),
                    _ => known = usize::MAX,
                }
            }
            assert!(known > 0, "{text}: no model knows anything");
        }
    }
}

#[test]
fn combinations_with_distances_hold_as_well() {
    let mut random = Random::new(12);
    for text in TEXTS {
        let field: Field = formula(text).within_sphere(1.6).into();
        let shapes: [Field; 4] = [
            field.clone().rotate([1.0, 2.0, 3.0], 40.0) | sphere(0.4).at([0.9, 0.2, 0.1]),
            field.clone() - cuboid([1.0, 1.0, 1.0]).at([0.5, 0.5, 0.5]),
            smooth_union(0.3, [field.clone(), torus(1.0, 0.3).into()]),
            field.scale(1.5) & cylinder(0.8, 2.0),
        ];
        // Functions with steps and without values have no place in a blend.
        if text.contains("ln(x)") || text.contains("sqrt(y") {
            continue;
        }
        for shape in shapes {
            let program = program(shape);
            let lanes = Lanes::random(&mut random, 0.5);
            let mut encloser = Encloser::new(&program, simd::best());
            if let [Some(first), None] = models(&mut encloser, &program, &lanes) {
                check(text, &first, &program, &lanes);
            }
        }
    }
}

#[test]
fn models_of_warps_and_displacements_hold() {
    const MAPS: [[&str; 3]; 4] = [
        ["x + 0.2*sin(3z)", "y + 0.1*cos(2x)", "z"],
        ["x*cos(z) + y*sin(z)", "y*cos(z) - x*sin(z)", "z"],
        ["x + exp(-20*((x - 0.5)^2 + y^2 + z^2)) / 3", "y", "z - 0.1*x^2"],
        ["abs(x) - 0.5", "y", "max(z, -0.4)"],
    ];
    let mut random = Random::new(15);
    let children: [Field; 4] = [
        sphere(0.8).into(),
        cuboid([0.9, 1.1, 1.3]) - cylinder(0.3, 2.0),
        torus(0.6, 0.25).rotate([1.0, 2.0, 0.5], 30.0),
        formula("x^4 + y^4 + z^4 - 0.4").into(),
    ];
    let warped = children.iter().flat_map(|child| MAPS.map(|map| child.clone().warp(map)));
    let displaced = children.iter().map(|child| child.clone().displace("0.1*sin(5x)*sin(5y)*sin(5z) + x*y/9"));
    let twisted = children[..3].iter().map(|child| child.clone().twist(40.0));
    for (number, field) in warped.chain(displaced).chain(twisted).enumerate() {
        let program = program(field.rotate([3.0, 1.0, -1.0], 25.0).at([0.2, -0.3, 0.4]));
        let mut known = 0;
        for level in simd::available() {
            let lanes = Lanes::random(&mut random, 0.5);
            let mut encloser = Encloser::new(&program, level);
            match models(&mut encloser, &program, &lanes) {
                [Some(first), None] => known += check(&format!("field {number}"), &first, &program, &lanes),
                // The cut of a maximum is another field.
                _ => known += 1,
            }
        }
        assert!(known > 0, "nothing is known of field {number}");
    }
}

#[test]
fn the_bound_shrinks_with_the_fifth_power() {
    let program = program(formula("sin(2x) * cos(y + z^2) + exp(x*y / 3) - 1 / (4 + z)"));
    let mut encloser = Encloser::new(&program, simd::best());
    let bounds = |encloser: &mut Encloser<'_>, half: f32| {
        let lanes = Lanes { half: vec![half; 4 * WIDEST], ..Lanes::random(&mut Random::new(13), 1.0) };
        let [Some(first), None] = models(encloser, &program, &lanes) else { panic!("one field") };
        first[5].clone()
    };
    // Long enough that rounding errors are small beside what is left out.
    let (long, short) = (bounds(&mut encloser, 0.5), bounds(&mut encloser, 0.25));
    let shrinks = long.iter().zip(&short).filter(|(long, short)| **short < **long / 24.0).count();
    assert!(shrinks > long.len() * 9 / 10, "{shrinks} of {}", long.len());
}

#[test]
fn polynomials_are_exact_but_for_rounding() {
    let program = program(formula("x^4 - 3x^2*y*z + y^3 - 2z + 1"));
    let mut encloser = Encloser::new(&program, simd::best());
    let lanes = Lanes { half: vec![2.0; 4 * WIDEST], ..Lanes::random(&mut Random::new(14), 1.0) };
    let [Some([.., r]), None] = models(&mut encloser, &program, &lanes) else { panic!("one field") };
    for (lane, bound) in r.into_iter().enumerate() {
        // How large the terms are before they cancel.
        let reach = lanes.origin[lane].length() + lanes.middle[lane] + lanes.half[lane];
        let size = 4.0 * reach.powi(4) + 1.0;
        assert!(bound < 16.0 * f32::EPSILON * size, "{bound} for {size}");
    }
    assert!(lanes.count() <= BATCH);
}
