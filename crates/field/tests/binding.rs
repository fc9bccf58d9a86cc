//! Compiling once and binding often: numbers change, operations don't.

use freikugel_field::program::BindError;
use freikugel_field::shapes::*;
use freikugel_field::{Axis, Field, MAX_DEPTH, Region, Structure, analyse};
use glam::DVec3;

fn compile(field: &Field) -> Structure {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field")
}

fn cup(radius: f64, depth: f64, turn: f64) -> Field {
    let body = cylinder(radius, 2.0) - sphere(0.5 * radius).at([0.0, 0.0, depth]).scale(1.2);
    smooth_union(0.1, [body, torus(0.5, 0.1).along(Axis::X).at([radius, 0.0, 0.0])]).rotate([0.0, 1.0, 1.0], turn)
}

#[test]
fn binding_other_numbers_equals_compiling_with_them() {
    let (before, after) = (compile(&cup(1.0, 0.2, 30.0)), compile(&cup(1.3, 0.5, 75.0)));
    assert_eq!(before.values().len(), after.values().len());
    let (bound, compiled) =
        (before.bind(after.values(), DVec3::ZERO).expect("the same structure"), after.program(DVec3::ZERO));
    for i in 0..200 {
        let p = DVec3::new((f64::from(i) * 0.7).sin(), (f64::from(i) * 1.3).cos(), (f64::from(i) * 0.31).sin()) * 2.0;
        assert_eq!(bound.value(p), compiled.value(p));
    }
}

#[test]
fn numbers_that_are_no_sound_arguments_are_refused() {
    let structure = compile(&sphere(1.0).into());
    let fault = structure.bind(&[-1.0], DVec3::ZERO).expect_err("negative");
    assert!(fault.to_string().contains("`radius` of `sphere` must be above 0, but is -1"), "{fault}");
    assert!(matches!(structure.bind(&[f64::NAN], DVec3::ZERO), Err(BindError::Faults(_))));
    assert!(matches!(structure.bind(&[], DVec3::ZERO), Err(BindError::Count { given: 0, wanted: 1 })));
    assert!(matches!(structure.bind(&[1.0, 2.0], DVec3::ZERO), Err(BindError::Count { .. })));
}

#[test]
fn another_axis_needs_another_structure() {
    let structure = compile(&torus(1.0, 0.2).into());
    assert!(matches!(structure.bind(&[1.0, 0.2, 0.0], DVec3::ZERO), Err(BindError::Structure)));
    assert!(structure.bind(&[1.1, 0.3, 2.0], DVec3::ZERO).is_ok());
}

#[test]
fn moving_a_plane_of_a_polyhedron_keeps_the_structure() {
    let cube = |top: f64| -> Field {
        let sides = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
        let planes = sides.map(|n| (n.map(f64::from), if n[2] == 1 { top } else { 1.0 }));
        convex_polyhedron(planes).into()
    };
    let structure = compile(&cube(1.0));
    let low = structure.bind(compile(&cube(0.25)).values(), DVec3::ZERO).expect("the same structure");
    assert!((low.value(DVec3::new(0.0, 0.0, 2.0)) - 1.75).abs() < 1e-12);
    assert!((low.value(DVec3::new(2.0, 2.0, 1.25)) - 3.0_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn translations_and_unions_cost_no_operations() {
    let spheres = (0..10).map(|i| sphere(0.1).at([f64::from(i), 0.0, 0.0]));
    assert_eq!(compile(&union(spheres).at([1.0, 2.0, 3.0])).operations(), 10);
    // A chain of maps is one map.
    let turned = sphere(1.0).at([1.0, 0.0, 0.0]).rotate([1.0, 0.0, 0.0], 10.0).rotate_euler([1.0, 2.0, 3.0]);
    assert_eq!(compile(&turned).operations(), 2);
}

#[test]
fn equal_shapes_stay_separate() {
    let ball = sphere(0.5);
    let pair = ball.clone().at([-1.0, 0.0, 0.0]) | ball.at([1.0, 0.0, 0.0]);
    let structure = compile(&pair);
    let mut values = structure.values().to_vec();
    let slot = values.iter().position(|&v| v == 0.5).expect("the first radius");
    values[slot] = 0.75;
    let program = structure.bind(&values, DVec3::ZERO).expect("sound");
    assert_eq!(program.value(DVec3::new(-1.0, 0.0, 0.0)), -0.75);
    assert_eq!(program.value(DVec3::new(1.0, 0.0, 0.0)), -0.5);
}

#[test]
fn regions_name_objects_and_innermost_materials() {
    use freikugel_field::MaterialId;
    let (red, blue) = (MaterialId(0), MaterialId(1));
    let object = (sphere(1.0).painted(red) | sphere(1.0).at([3.0, 0.0, 0.0])).painted(blue);
    let structure = Structure::compile(&[object, cuboid([1.0; 3]).into()]).expect("sound");
    let region = |object: usize, material: Option<MaterialId>| Region { object, material };
    assert_eq!(structure.regions(), [region(0, Some(red)), region(0, Some(blue)), region(1, None)]);
}

#[test]
fn no_objects_are_infinitely_far() {
    let program = Structure::compile(&[]).expect("nothing is wrong").program(DVec3::ZERO);
    assert_eq!(program.value(DVec3::ZERO), f64::INFINITY);
    let mut values = [0.0; 3];
    let zeros = [0.0; 3];
    let points = freikugel_field::Points { x: &zeros, y: &zeros, z: &zeros };
    freikugel_field::Evaluator::new(&program).values(points, &mut values);
    assert_eq!(values, [f32::INFINITY; 3]);
}

#[test]
fn faults_are_all_reported_with_the_line_they_come_from() {
    let broken = sphere(-1.0) | cuboid([1.0, 0.0, 1.0]) | union([] as [Field; 0]) | (cylinder(1.0, 1.0).round(2.0));
    let (analysis, diagnostics) = analyse(&broken);
    assert!(analysis.is_none());
    let texts: Vec<String> = diagnostics.iter().map(ToString::to_string).collect();
    assert_eq!(texts.len(), 4, "{texts:#?}");
    for (text, part) in texts.iter().zip(["`radius`", "`size`", "has no shapes", "`round`"]) {
        assert!(text.contains(part) && text.contains("binding.rs:"), "{text}");
    }
}

#[test]
fn sheets_must_get_a_thickness_before_they_cut() {
    let sheet = || Field::from(sheet([0.0, 0.0, 1.0]));
    for field in [sphere(1.0) - sheet(), -sheet(), xor([sphere(1.0).into(), sheet()]), sheet().offset(-0.1)] {
        assert!(analyse(&field).0.is_none());
    }
    assert!(analyse(&(sphere(1.0) - sheet().offset(0.1))).0.is_some());
}

#[test]
fn offsets_of_bounds_are_warned_of() {
    let doubtful = (cuboid([1.0; 3]) & sphere(0.6)).offset(0.1);
    let (analysis, diagnostics) = analyse(&doubtful);
    assert!(analysis.is_some());
    assert_eq!(diagnostics.len(), 1);
    assert!(diagnostics[0].message.contains("only a bound"));
    assert!(analyse(&cuboid([1.0; 3]).offset(0.1)).1.is_empty());
}

#[test]
fn too_deep_a_tree_is_an_error_and_no_overflow() {
    let chain = |depth: u32| (1..depth).fold(Field::from(sphere(1.0)), |field, _| smooth_union(0.1, [field]));
    let deepest = chain(MAX_DEPTH);
    assert_eq!(compile(&deepest).program(DVec3::ZERO).value(DVec3::X * 3.0), 2.0);
    let field = chain(100_000);
    let (analysis, diagnostics) = analyse(&field);
    assert!(analysis.is_none());
    assert!(diagnostics[0].message.contains("nested"), "{}", diagnostics[0]);
    drop(field);
}
