//! Plane sections are what the whole program says at each point, bit by bit.

use freikugel_field::shapes::*;
use freikugel_field::{Evaluator, Field, Form, Formula, Points, Program, Structure, shapes};
use freikugel_render::{Options, OptionsError, Rect, RenderError, Section, Show, Slice};
use glam::DVec3;
use proptest::prelude::*;

/// The section's points, and the field there by the whole program.
fn pointwise(program: &Program, section: &Section, width: u32, height: u32) -> Vec<f32> {
    let mut coordinates: [Vec<f32>; 3] = Default::default();
    for row in 0..height {
        for column in 0..width {
            let point = (section.point([width, height], [column, row]) - program.origin()).as_vec3().to_array();
            coordinates.iter_mut().zip(point).for_each(|(all, coordinate)| all.push(coordinate));
        }
    }
    let [x, y, z] = &coordinates;
    let mut values = vec![0.0; x.len()];
    Evaluator::new(program).values(Points { x, y, z }, &mut values);
    values
}

fn check(field: &Field, section: &Section, width: u32, height: u32) {
    let program = Structure::compile(std::slice::from_ref(field)).expect("a sound field");
    let program = program.program(DVec3::new(0.1, -0.2, 0.05));
    let expected = pointwise(&program, section, width, height);
    for threads in [1, 3] {
        let options = Options { width, height, threads: Some(threads), ..Options::default() };
        let values = section.values(&program, &options, &()).expect("nobody cancels");
        for (place, (value, expected)) in values.iter().zip(&expected).enumerate() {
            assert_eq!(value.to_bits(), expected.to_bits(), "place {place}: {value} instead of {expected}");
        }
        let mask = section.mask(&program, &options, &()).expect("nobody cancels");
        let signs: Vec<bool> = expected.iter().map(|&value| value < 0.0).collect();
        assert!(mask == signs, "the mask has other signs than the values");
    }
}

/// Sections in all directions through the cube from -2 to 2.
fn sections() -> impl Strategy<Value = Section> {
    let vector = || prop::array::uniform3(-2.0..2.0_f64).prop_map(DVec3::from_array);
    prop_oneof![
        (vector(), 0.5..4.0_f64, 0.5..4.0_f64)
            .prop_map(|(middle, width, height)| Section::from_above(middle, width, height)),
        (vector(), vector(), vector()).prop_map(|(middle, u, v)| Section { origin: middle - (u + v) / 2.0, u, v }),
    ]
}

/// Expression graphs of operations that have a value everywhere: each line takes results from before.
fn graphs() -> impl Strategy<Value = String> {
    let line = (0..9_usize, any::<prop::sample::Index>(), any::<prop::sample::Index>());
    prop::collection::vec(line, 1..60).prop_map(|lines| {
        let mut text = String::from("0 var-x\n1 var-y\n2 const 0.37\n3 const -1.25\n");
        for (index, (op, a, b)) in lines.into_iter().enumerate() {
            let name = index + 4;
            let (a, b) = (a.index(name), b.index(name));
            text += &match op {
                0 => format!("{name} add {a} {b}\n"),
                1 => format!("{name} sub {a} {b}\n"),
                2 => format!("{name} min {a} {b}\n"),
                3 => format!("{name} max {a} {b}\n"),
                4 => format!("{name} abs {a}\n"),
                5 => format!("{name} sin {a}\n"),
                6 => format!("{name} neg {a}\n"),
                7 => format!("{name} atan2 {a} {b}\n"),
                // Bounded factors, lest squares of squares overflow.
                _ => format!("{name}a sin {a}\n{name}b sin {b}\n{name} mul {name}a {name}b\n"),
            };
        }
        text
    })
}

fn of_graph(text: &str) -> Field {
    Form::<shapes::Formula>::from(Formula::from_vm(text).expect("a graph")).into()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn graphs_have_the_same_values_in_sections(
        text in graphs(), section in sections(), width in 1..150_u32, height in 1..80_u32,
    ) {
        check(&of_graph(&text), &section, width, height);
    }
}

#[test]
fn shapes_have_the_same_values_in_sections() {
    let parts: [Field; 3] = [
        torus(0.8, 0.3).rotate([1.0, 2.0, 0.5], 40.0),
        cuboid([1.0, 0.8, 0.6]).round(0.1).at([0.4, 0.3, 0.0]),
        formula("x^2 + 2y^2 + z^2 - 0.4").at([-0.5, 0.2, 0.1]),
    ];
    let [a, b, c] = parts;
    let field = (smooth_union(0.2, [a, b.clone()]) - sphere(0.4).at([0.2, 0.0, 0.1])) | c;
    for section in [
        Section::from_above(DVec3::ZERO, 3.0, 2.0),
        Section::from_above(DVec3::new(0.0, 0.0, 0.2), 5.0, 5.0),
        Section { origin: DVec3::new(-1.0, -1.0, 1.0), u: DVec3::new(2.0, 1.0, 0.0), v: DVec3::new(0.0, 1.0, -2.0) },
    ] {
        check(&field, &section, 300, 200);
        check(&b, &section, 1, 1);
    }
}

#[test]
fn a_crop_is_a_cut_of_the_whole_and_samples_average() {
    let program = Structure::compile(&[sphere(0.7).into()]).expect("a sphere").program(DVec3::ZERO);
    let section = Section::from_above(DVec3::ZERO, 2.0, 2.0);
    let whole = Options { width: 301, height: 280, samples: 9, threads: Some(1), ..Options::default() };
    let colors = [[0.0; 3], [1.0; 3]];
    let picture = |options: &Options| section.picture(&program, options, colors, &()).expect("nobody cancels").image;
    let crop = Rect { x: 130, y: 3, width: 140, height: 170 };
    let (all, cut) = (picture(&whole), picture(&Options { crop: Some(crop), ..whole.clone() }));
    for y in 0..crop.height {
        for x in 0..crop.width {
            assert_eq!(cut.pixel(x, y), all.pixel(crop.x + x, crop.y + y));
        }
    }
    // Each pixel is the mean of nine finer ones.
    let fine = Options { width: 3 * whole.width, height: 3 * whole.height, ..whole.clone() };
    let mask = section.mask(&program, &fine, &()).expect("nobody cancels");
    for (x, y) in [(0, 0), (150, 140), (45, 140), (46, 139), (150, 42), (300, 279)] {
        let inside = (0..9).filter(|i| mask[((3 * y + i / 3) * fine.width + 3 * x + i % 3) as usize]).count();
        assert_eq!(all.pixel(x, y), [1.0 - inside as f32 / 9.0; 3], "pixel ({x}, {y})");
    }
    let area = mask.iter().filter(|&&inside| inside).count() as f64 / mask.len() as f64 * 4.0;
    assert!((area - std::f64::consts::PI * 0.49).abs() < 0.005, "{area}");
    let stop = std::sync::atomic::AtomicBool::new(true);
    assert!(matches!(section.mask(&program, &whole, &stop), Err(RenderError::Cancelled)));
    assert!(matches!(section.mask(&program, &Options { width: 0, ..whole }, &()), Err(RenderError::Options(_))));
}

#[test]
fn slices_hear_who_gives_up_and_name_the_options_that_were_asked_for() {
    let program = Structure::compile(&[sphere(0.7).into()]).expect("a sphere").program(DVec3::ZERO);
    let section = Section::from_above(DVec3::ZERO, 2.0, 2.0);
    let options = Options { width: 40, height: 30, samples: 3, threads: Some(1), ..Options::default() };
    for show in [Show::Distance, Show::Slope, Show::Steps] {
        let slice = Slice { section, show, spacing: 0.1 };
        let stop = std::sync::atomic::AtomicBool::new(true);
        assert!(matches!(slice.picture(&program, &options, &stop), Err(RenderError::Cancelled)), "{show:?}");
        let image = slice.picture(&program, &options, &()).expect("nobody cancels").image;
        assert_eq!((image.width(), image.height()), (40, 30));
        let none = Options { samples: 0, ..options.clone() };
        let fault = slice.picture(&program, &none, &()).err();
        assert!(matches!(fault, Some(RenderError::Options(OptionsError::Samples(0)))), "{show:?}: {fault:?}");
    }
}
