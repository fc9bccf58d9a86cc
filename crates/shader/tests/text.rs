//! The text of shaders: no number changes it, it stays small, it reads well, and it is GLSL, too.

mod common;

use common::{read, scene_files, scene_of};
use freikugel_field::{Field, ParamKind, shapes};
use freikugel_scene::{Light, Material, Pattern, Scene};
use freikugel_shader::glsl::{self, Table};
use freikugel_shader::{Shader, ShaderError, Target};
use proptest::prelude::*;

/// What a scene of a hundred primitives may take.
const MOST_BYTES: usize = 60_000;

/// All targets whose text has no numbers in it.
const PLAIN: [Target; 4] = [Target::Wgsl, Target::Glsl, Target::Hlsl, Target::Msl];

/// A field whose numbers are a little different.
fn changed(field: &Field, factor: f64) -> Field {
    let node = field.node();
    let mut args = node.numbers();
    for (index, param) in node.shape.about.params.iter().enumerate() {
        let range = node.shape.range(index, &node.args);
        match param.kind {
            // These shape the steps.
            ParamKind::Count(..)
            | ParamKind::Counts(..)
            | ParamKind::Choice(_)
            | ParamKind::Flag
            | ParamKind::Knots => {}
            ParamKind::Region => args[range.start + 1..range.end].iter_mut().for_each(|arg| *arg *= factor),
            _ => args[range].iter_mut().for_each(|arg| *arg *= factor),
        }
    }
    let children: Vec<Field> = node.children.iter().map(|child| changed(child, factor)).collect();
    let args = args.into_iter().map(Into::into);
    Field::with_origin(node.shape, args, children, node.material, node.origin).with_formulas(node.formulas.clone())
}

/// A scene all of whose numbers are a little different.
fn changed_scene(scene: &Scene, factor: f64) -> Scene {
    let mut scene = scene.clone();
    let small = factor as f32;
    for object in &mut scene.objects {
        object.shape = changed(&object.shape, factor);
    }
    for (_, material) in &mut scene.materials {
        let Material { color, ambient, diffuse, exponent, emissive, .. } = material;
        *color = match color {
            Pattern::Solid([r, g, b]) => Pattern::Checker { colors: [[*g, *b, *r]; 2], size: factor },
            Pattern::Checker { colors: [one, _], .. } => Pattern::Solid(*one),
        };
        *ambient *= small;
        *diffuse *= small;
        *exponent *= small;
        *emissive = [0.1 * small; 3];
    }
    for light in &mut scene.lights {
        match light {
            Light::Sun(sun) => sun.intensity *= small,
            Light::Point(point) => point.position *= factor,
            Light::Spot(spot) => spot.angle *= factor,
        }
    }
    if let Some(camera) = &mut scene.camera {
        camera.eye *= factor;
    }
    scene.picture.exposure += 0.5 * small;
    scene
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn no_number_changes_the_text(factor in 0.9f64..1.1) {
        let files = scene_files();
        for scene in files.iter().filter(|file| !file.ends_with("limits.json")).step_by(4).map(|file| read(file)) {
            let other = changed_scene(&scene, factor);
            let (shader, again) = (Shader::new(&scene).expect("a shader"), Shader::new(&other).expect("a shader"));
            let parameters = shader.parameters(&scene).expect("parameters");
            let changed = shader.parameters(&other).expect("the same structure");
            prop_assert_ne!(parameters.numbers(), changed.numbers());
            for target in PLAIN {
                let text = shader.text(target, &parameters).expect("text");
                prop_assert!(text == again.text(target, &changed).expect("text"), "{target:?}");
            }
        }
    }
}

#[test]
fn another_structure_is_refused() {
    let shader = Shader::new(&scene_of(r#"{ "sphere": { "radius": 1 } }"#)).expect("a shader");
    for other in [
        r#"{ "box": { "size": 1 } }"#,
        r#"{ "sheet": {} }"#,
        r#"{ "scale": { "factor": 2, "shape": { "sphere": { "radius": 1 } } } }"#,
    ] {
        let error = shader.parameters(&scene_of(other)).expect_err("another structure");
        assert!(matches!(error, ShaderError::OtherScene(_)), "{error}");
    }
}

#[test]
fn a_hundred_primitives_stay_small() {
    use shapes::*;
    let mut scene = Scene::new();
    for index in 0..100 {
        let x = f64::from(index % 10) - 4.5;
        let y = f64::from(index / 10) - 4.5;
        let field: Field = match index % 5 {
            0 => sphere(0.4).into(),
            1 => cuboid([0.6, 0.5, 0.4]).into(),
            2 => torus(0.3, 0.1).into(),
            3 => cylinder(0.2, 0.5).into(),
            _ => capsule([0.0, 0.0, -0.2], [0.0, 0.1, 0.2], 0.1).into(),
        };
        let field = if index % 3 == 0 { field.rotate([1.0, 0.0, 0.0], 30.0) } else { field };
        scene.add(format!("thing {index}"), field.at([x, y, 0.0]));
    }
    let shader = Shader::new(&scene).expect("a shader");
    let parameters = shader.parameters(&scene).expect("parameters");
    for target in [Target::Wgsl, Target::Glsl] {
        let size = shader.text(target, &parameters).expect("text").len();
        println!("{target:?}: {size} bytes");
        assert!(size < MOST_BYTES, "{target:?}: {size} bytes");
    }
}

/// GLSL as the one front end reads it that needs no installation: the same items between declarations for Vulkan.
fn vulkan_glsl(shader: &Shader) -> String {
    let head = "#version 450\n\
        struct View { vec2 size; vec2 tile; vec2 place; float time; int show; };\n\
        layout(set = 0, binding = 0) uniform Numbers { vec4 parameters[4096]; };\n\
        layout(set = 0, binding = 1) uniform Views { View view; };\n\
        layout(location = 0) in vec2 raster;\n\
        layout(location = 0) out vec4 color;\n\
        float parameter(int place) { return parameters[place >> 2][place & 3]; }\n\
        vec4 quad(int place) { return parameters[place >> 2]; }\n";
    let tail = "void main() { color = vec4(shown_along(camera_ray(raster)), 1.0); }\n";
    format!("{head}{}{tail}", glsl::items(shader.items(), Table::Vectors))
}

#[test]
fn the_same_items_are_valid_glsl() {
    let scenes = shapes::ALL.iter().map(|shape| scene_of(shape.about.example));
    let files = scene_files();
    for scene in scenes.chain(files.iter().map(|file| read(file))) {
        let name = &scene.objects[0].name;
        let text = vulkan_glsl(&Shader::new(&scene).expect("a shader"));
        let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
        let module = naga::front::glsl::Frontend::default()
            .parse(&options, &text)
            .unwrap_or_else(|errors| panic!("{name}: {}", errors.emit_to_string(&text)));
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(&text)));
    }
}

#[test]
fn texts_read_well() {
    let snapshot = |name: &str, shape: &str, target: Target| {
        let mut scene = scene_of(shape);
        scene.objects[0].name = "thing".into();
        let shader = Shader::new(&scene).expect("a shader");
        let parameters = shader.parameters(&scene).expect("parameters");
        insta::assert_snapshot!(name, shader.text(target, &parameters).expect("text"));
    };
    snapshot("torus.wgsl", r#"{ "torus": { "major": 0.8, "minor": 0.3 } }"#, Target::Wgsl);
    let blend = r#"{ "smooth_union": { "k": 0.4, "shapes": [
        { "paint": { "material": "clay", "shape": { "sphere": { "radius": 0.7 } } } },
        { "rotate": { "axis": "z", "angle": 30, "shape": { "box": { "size": [2, 0.6, 0.6] } } } } ] } }"#;
    snapshot("blend.glsl", blend, Target::Glsl);
    snapshot(
        "formula.shadertoy",
        r#"{ "formula": { "f": "x^2 + y^2 + z^4 - 1", "within": { "sphere": 2 } } }"#,
        Target::Shadertoy,
    );
}
