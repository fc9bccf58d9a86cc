//! What scenes mean: read from files, and built in code.

use freikugel_field::shapes::*;
use freikugel_field::{Aabb, Extent, Field, MaterialId, Origin, analyse};
use freikugel_scene::*;
use glam::DVec3;

/// The scene that a sound text holds.
fn sound(text: &str) -> Scene {
    let reading = read(text);
    let printed = report(text, "scene.json", &reading.diagnostics, false);
    reading.into_result().unwrap_or_else(|_| panic!("{printed}"))
}

#[test]
fn one_object_is_a_scene() {
    let scene = sound(r#"{ "objects": [ { "shape": { "sphere": { "radius": 2 } } } ] }"#);
    let default = Scene::default();
    assert_eq!(scene.camera, None);
    assert_eq!(scene.lights, Light::rig());
    assert_eq!(scene.ambient, default.ambient);
    assert_eq!(scene.occlusion, Some(Occlusion { strength: 1.0, reach: None }));
    assert_eq!(scene.background, default.background);
    assert!(scene.materials.is_empty());
    assert_eq!(scene.tracer, Tracer::default());
    assert_eq!(scene.picture, Picture::default());
    assert_eq!(scene.objects[0].name, "object 1");
    assert_eq!(scene.objects[0].material, None);
    let extent = analyse(&scene.objects[0].shape).0.expect("sound").extent;
    assert_eq!(extent, Extent::Finite(Aabb { min: DVec3::splat(-2.0), max: DVec3::splat(2.0) }));
}

#[test]
fn a_full_scene_has_all_its_values() {
    let scene = sound(
        r##"{ "camera": { "eye": [4, -6, 3], "target": [0, 0, 1], "fov": 90 },
          "lights": [ { "sun": { "direction": "-y", "color": "#ffffff", "shadow": { "hardness": 16 } } },
                      { "sun": { "direction": [1, 0, 1], "shadow": { "clearance": 180e-1 } } },
                      { "point": { "position": [-3, -4, 5], "intensity": 30, "falloff": "inverse_square" } },
                      { "spot": { "position": [0, 0, 5], "target": [0, 0, 0], "angle": 18, "falloff": [1, 0, 0.5],
                                  "shadow": { "clearance": true } } } ],
          "materials": { "steel": { "color": [0.5, 0.25, 2] }, "clay": { "color": "#000", "specular": 0.1, "model": "phong" } },
          "ambient": "#fff", "occlusion": false, "background": { "gradient": { "top": "#fff", "bottom": [0, 0, 1] } },
          "objects": [ { "name": "cup", "material": "clay", "shape": { "paint": { "material": "steel", "shape":
                         { "sphere": { "radius": 1 } } } } } ] }"##,
    );
    let fov = std::f64::consts::FRAC_PI_2;
    let camera = scene.camera.expect("a camera");
    assert_eq!((camera.eye, camera.target, camera.up), (DVec3::new(4.0, -6.0, 3.0), DVec3::Z, DVec3::Z));
    assert_eq!(camera.projection, Projection::Perspective { fov, axis: FovAxis::Vertical });
    let clearance = Shadow::Clearance { angle: Some(18_f64.to_radians()) };
    assert_eq!(
        scene.lights,
        [
            Sun::towards([0, -1, 0]).shadow(Shadow::Hardness(16.0)).into(),
            Sun::towards([1, 0, 1]).shadow(clearance).into(),
            Point::at([-3, -4, 5]).intensity(30).into(),
            Spot::at([0, 0, 5], [0, 0, 0])
                .angle(18)
                .falloff(Falloff::Polynomial([1.0, 0.0, 0.5]))
                .shadow(Shadow::Clearance { angle: None })
                .into(),
        ] as [Light; 4]
    );
    let (name, clay) = &scene.materials[1];
    assert_eq!(name, "clay");
    assert_eq!(*clay, Material::color([0.0; 3]).specular(0.1).model(Model::Phong));
    assert_eq!(scene.materials[0].1.color, Pattern::Solid([0.5, 0.25, 2.0]));
    assert_eq!(scene.ambient, Ambient { sky: [1.0; 3], ground: [1.0; 3] });
    assert_eq!(scene.occlusion, None);
    assert_eq!(scene.background, Background::Gradient { top: [1.0; 3], bottom: [0.0, 0.0, 1.0] });
    assert_eq!(scene.objects[0].material, Some(MaterialId(1)));
    assert_eq!(scene.objects[0].shape.node().material, Some(MaterialId(0)));
}

#[test]
fn an_empty_list_of_lights_is_darkness() {
    let scene = sound(r#"{ "lights": [], "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#);
    assert!(scene.lights.is_empty());
}

#[test]
fn files_may_hold_comments() {
    sound("{ // a ball\n \"objects\": [ /* one */ { \"shape\": { \"sphere\": { \"radius\": 1 } } } ] }");
}

/// Every shape's example is a shape.
#[test]
fn examples_are_sound() {
    for shape in ALL {
        let text =
            format!(r#"{{ "materials": {{ "clay": {{}} }}, "objects": [ {{ "shape": {} }} ] }}"#, shape.about.example);
        let scene = sound(&text);
        assert_eq!(scene.check(), [], "{}", shape.about.name);
    }
}

/// A shape in a file is the same as the one from code.
#[test]
fn files_and_code_agree() {
    let scene = sound(
        r#"{ "objects": [ { "shape": { "difference": [
            { "cylinder": { "radius": 1, "height": 2 } },
            { "translate": { "by": [0, 0, 0.2], "shape": { "cylinder": { "radius": 0.85, "height": 2 } } } } ] } } ] }"#,
    );
    let cup = cylinder(1.0, 2.0) - cylinder(0.85, 2.0).at([0.0, 0.0, 0.2]);
    let mut pairs = vec![(&scene.objects[0].shape, &cup)];
    while let Some((read, built)) = pairs.pop() {
        let (read, built) = (read.node(), built.node());
        assert_eq!(read.shape.about.name, built.shape.about.name);
        assert_eq!(read.numbers(), built.numbers());
        assert_eq!(read.children.len(), built.children.len());
        pairs.extend(read.children.iter().zip(&built.children));
    }
}

/// The places of a scene's mistakes, as lines relative to `start`, with their messages.
/// Knots and nets in files are those from code.
#[test]
fn curved_shapes_in_files_and_code_agree() {
    let curve = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]];
    let net = [[[0, 0, 0, 1], [0, 1, 0, 2], [0, 2, 0, 1]], [[1, 0, 0, 1], [1, 1, 1, 3], [1, 2, 0, 1]]];
    let plain = net.map(|row| row.map(|[x, y, z, _]| [x, y, z]));
    let cases: [(&str, Field); 5] = [
        (
            r#"{ "b_spline": { "radius": 0.1, "degree": 2, "knots": [0, 0, 0, 0.25, 1, 1, 1],
                "points": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]] } }"#,
            b_spline(0.1, 2, curve).knots([0.0, 0.0, 0.0, 0.25, 1.0, 1.0, 1.0]).into(),
        ),
        (
            r#"{ "b_spline": { "radius": 0.1, "points": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]], "knots": "pieces" } }"#,
            b_spline(0.1, 3, curve).with("knots", &[1.into()]).into(),
        ),
        (
            r#"{ "bezier_patch": { "radius": 0.1, "points": [[[0, 0, 0], [0, 1, 0], [0, 2, 0]], [[1, 0, 0], [1, 1, 1], [1, 2, 0]]] } }"#,
            bezier_patch(0.1, plain).into(),
        ),
        (
            r#"{ "b_spline_patch": { "radius": 0.1, "degree_u": 1, "degree_v": 2, "closed_v": true, "tolerance": 0.2,
                "points": [[[0, 0, 0], [0, 1, 0], [0, 2, 0]], [[1, 0, 0], [1, 1, 1], [1, 2, 0]]] } }"#,
            b_spline_patch(0.1, [1, 2], plain).with("closed_v", &[1.into()]).with("tolerance", &[0.2.into()]).into(),
        ),
        (
            r#"{ "nurbs_patch": { "radius": 0.1, "degree_u": 1, "degree_v": 1, "knots_u": [0, 0, 3, 3], "knots_v": [0, 0, 1, 4, 4],
                "points": [[[0, 0, 0, 1], [0, 1, 0, 2], [0, 2, 0, 1]], [[1, 0, 0, 1], [1, 1, 1, 3], [1, 2, 0, 1]]] } }"#,
            nurbs_patch(0.1, [1, 1], net).knots_u([0, 0, 3, 3]).knots_v([0, 0, 1, 4, 4]).into(),
        ),
    ];
    for (text, built) in cases {
        let scene = sound(&format!(r#"{{ "objects": [ {{ "shape": {text} }} ] }}"#));
        assert_eq!(scene.objects[0].shape.node().numbers(), built.node().numbers(), "{text}");
        assert_eq!(scene.check(), [], "{text}");
    }
}

fn mistakes(found: &[freikugel_field::Diagnostic], start: u32) -> Vec<(u32, &str)> {
    let place = |origin| match origin {
        Origin::Code(location) => location.line() - start,
        Origin::Document(_) => panic!("this scene has no text"),
    };
    found.iter().map(|mistake| (place(mistake.origin), mistake.message.as_str())).collect()
}

#[test]
fn mistakes_in_code_have_lines() {
    let start = line!();
    let mut scene = Scene::new();
    let red = scene.material("red", Material::color("red"));
    scene.material("red", Material::default().specular(-1));
    scene.add("a", (sphere(1) | sphere(-1)).painted(red));
    scene.add("a", sphere(1) + sphere(2).at([0, 0, 1]).painted(MaterialId(7)));
    scene.light(Sun::towards([0, 0, 0]));
    scene.camera(Camera::look([1, 2, 3], [0, 0, 0]).orthographic(0).up([f64::NAN; 3]));
    scene.picture.width = 0;
    // A part that no method added has the place of the check.
    let diagnostics = scene.check();
    let found = mistakes(&diagnostics, start);
    let expected = [
        (7, "camera: `up` must be finite"),
        (7, "camera: `height` must be above 0, but is 0"),
        (6, "light 1: `direction` must not be the zero vector"),
        (10, "picture: `width` must be at least 1, but is 0"),
        (
            2,
            "material `red`: `color` is not a colour: a colour is \"#rrggbb\" or \"#rgb\", or linear [red, green, blue]",
        ),
        (3, "another material is called `red` already"),
        (3, "material `red`: `specular` must not be negative, but is -1"),
        (4, "`radius` of `sphere` must be above 0, but is -1"),
        (5, "another object is called `a` already"),
        (5, "object `a` has a material of another scene"),
    ];
    assert_eq!(found, expected);
    assert_eq!(Scene::new().check()[0].message, "the scene has no objects");
}

#[test]
fn the_first_light_ends_the_default_ones() {
    let mut scene = Scene::of(sphere(1.0));
    assert_eq!(scene.lights.len(), 3);
    scene.light(Sun::default()).light(Point::default());
    assert_eq!(scene.lights, [Light::from(Sun::default()), Light::from(Point::default())]);
}

#[test]
fn what_is_read_passes_the_check() {
    let scene = sound(
        r#"{ "materials": { "a": { "diffuse": 1 } }, "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#,
    );
    let mistakes = scene.check();
    assert_eq!(mistakes.len(), 1, "{mistakes:?}");
    assert_eq!(mistakes[0].severity, Severity::Warning);
}
