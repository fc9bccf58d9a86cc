//! Each kind of mistake, as it is printed. The snapshots lie in `snapshots/`; run the tests with `INSTA_UPDATE=always` to
//! renew them, and review the difference.

use freikugel_scene::{read, report};

/// A scene with one object of this shape.
fn with_shape(shape: &str) -> String {
    format!("{{ \"objects\": [ {{ \"shape\":\n  {shape}\n}} ] }}")
}

/// A scene with a sound object and these entries besides.
fn with(entries: &str) -> String {
    format!("{{\n  {entries},\n  \"objects\": [ {{ \"shape\": {{ \"sphere\": {{ \"radius\": 1 }} }} }} ]\n}}")
}

fn shown(text: &str) -> String {
    let reading = read(text);
    let printed = report(text, "scene.json", &reading.diagnostics, false);
    let verdict = if reading.scene.is_some() { "a scene" } else { "no scene" };
    format!("{printed}=> {verdict}")
}

fn check(name: &str, text: &str) {
    insta::with_settings!({ description => text, omit_expression => true, prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!(name, shown(text));
    });
}

#[test]
fn syntax() {
    for (name, text) in [
        ("empty", ""),
        ("blank", "  \n // nothing\n"),
        ("not_an_object", "[1, 2]"),
        ("never_closed", "{ \"objects\": [ {"),
        ("closed_too_early", "{ \"objects\": [] ] }"),
        ("two_values", "{} {}"),
        ("text_over_the_line", "{ \"camera: { \"eye\": [1, 2, 3] },\n  \"objects\": [] }"),
        ("tab_in_text", "{ \"materials\": { \"a\tb\": {} } }"),
        ("no_break_space", "{\u{a0}\"objects\": [] }"),
        ("wrong_escape", r#"{ "materials": { "\q": {} } }"#),
        ("no_colon", "{ \"objects\" [] }"),
        ("no_value", "{ \"objects\": }"),
        ("word", "{ \"objects\": yes }"),
        ("missing_digit", "{ \"objects\": [-] }"),
        ("open_comment", "{ /* \"objects\": [] }"),
        (
            "relaxed_json",
            "{ camera: { 'eye': [+4, -6, .5], \"target\": [0x1, 0, 5.],},\n  \"tracer\": { \"step_factor\": NaN }\n  \
             \"objects\": [ { \"shape\": { \"sphere\": { \"radios\": 1 } } } ] }",
        ),
    ] {
        check(name, text);
    }
    check("too_deep", &with_shape(&"[".repeat(1000)));
}

#[test]
fn documents() {
    for (name, text) in [
        ("nothing_in_it", "{}"),
        ("no_objects", "{ \"objects\": [] }"),
        ("newer_version", "{ \"version\": 2, \"objcts\": true }"),
        ("no_shape", "{ \"objects\": [ { \"name\": \"a\" }, 3 ] }"),
        ("objects_by_name", "{ \"objects\": { \"a\": { \"sphere\": { \"radius\": 1 } } } }"),
    ] {
        check(name, text);
    }
    for (name, entries) in [
        ("wrong_version", r#""version": 0.5"#),
        ("version_as_text", r#""version": "1""#),
        ("unknown_key", r#""camra": {}, "tracing": {}, "fog": {}"#),
        ("duplicate_key", r#""tracer": {}, "tracer": {}"#),
        ("camera", r#""camera": { "target": [0, 0], "up": [0, 0, 0], "fov": 180, "height": 3 }"#),
        ("named_axis", r#""camera": { "eye": [1, 2, 3], "fov": { "diagonal": 30 }, "up": "up" }"#),
        ("lights", r##""lights": [ { "sun": {} }, { "lamp": {} }, {}, { "point": {}, "spot": {} }, 1 ]"##),
        ("sun", r#""lights": [ { "sun": { "direction": "w", "intensity": -1, "shadow": { "clearance": true } } } ]"#),
        (
            "point",
            r#""lights": [ { "point": { "position": [0, null, 1e999], "falloff": "inverse_squar", "shadow": "soft" } } ]"#,
        ),
        ("spot", r#""lights": [ { "spot": { "position": [0, 0, 1], "target": [0, 0, 1], "softness": 0.5 } } ]"#),
        (
            "falloff",
            r#""lights": [ { "point": { "position": [0, 0, 1], "falloff": [0, 0, 0] } }, { "point": { "position": [0, 0, 1], "falloff": [1, -1] } } ]"#,
        ),
        (
            "shadow",
            r#""lights": [ { "point": { "position": [0, 0, 1], "shadow": { "hardness": 0 } } }, { "point": { "position": [0, 0, 1], "shadow": { "clearance": false } } } ]"#,
        ),
        (
            "colours",
            r##""ambient": "#12", "background": "white", "materials": { "a": { "color": [1, 2], "emissive": [0, -1, 0] } }"##,
        ),
        (
            "checker",
            r##""materials": { "a": { "color": { "checker": { "colors": ["#fff"], "size": 0 } } }, "b": { "color": { "stripes": 1 } } }"##,
        ),
        (
            "hemispheres",
            r##""ambient": { "sky": "#fff" }, "background": { "gradient": { "top": 1, "bottom": "#000" } }"##,
        ),
        ("energy", r#""materials": { "a": { "diffuse": 0.9, "specular": 0.2 } }"#),
        ("model", r#""materials": { "a": { "model": "Phong" }, "b": { "model": "lambert" }, "c": { "model": 1 } }"#),
        ("same_material_twice", r#""materials": { "a": {}, "a": {} }"#),
        ("occlusion", r#""occlusion": { "strength": -1, "reach": 0 }"#),
        ("limits", r#""tracer": { "max_steps": 0.5, "precision": 0, "step_factor": 1.5, "max_distance": -1e300 }"#),
        (
            "picture",
            r#""picture": { "width": 0, "height": 1e9, "samples": -1, "exposure": 1e39, "overbright": "scale" }"#,
        ),
        ("null", r#""camera": null, "picture": { "width": null }"#),
    ] {
        check(name, &with(entries));
    }
    check(
        "names",
        r#"{ "materials": { "clay": {}, "steel": {} }, "objects": [
  { "name": "cup", "material": "caly", "shape": { "sphere": { "radius": 1 } } },
  { "name": "cup", "material": "wood", "shape": { "paint": { "material": "stel", "shape": { "sphere": { "radius": 1 } } } } },
  { "name": "", "material": 3, "shape": { "sphere": { "radius": 1 } } } ] }"#,
    );
}

#[test]
fn shapes() {
    for (name, shape) in [
        ("misspelt_parameter", r#"{ "sphere": { "radios": 1 } }"#),
        ("missing_parameter", r#"{ "sphere": {} }"#),
        ("negative_radius", r#"{ "sphere": { "radius": -1 } }"#),
        ("overflow", r#"{ "sphere": { "radius": 1e999 } }"#),
        ("misspelt_shape", r#"{ "shpere": { "radius": 1 } }"#),
        ("shape_from_elsewhere", r#"{ "ball": { "radius": 1 } }"#),
        ("number_for_parameters", r#"{ "sphere": 1 }"#),
        ("number_for_shape", "1"),
        ("empty_shape", "{}"),
        ("empty_union", r#"{ "union": [] }"#),
        ("empty_union_in_full", r#"{ "union": { "shapes": [] } }"#),
        ("two_shapes", r#"{ "sphere": { "radius": 1 }, "box": { "size": 0 } }"#),
        ("stranger", r#"{ "sphere": { "radius": -1 }, "material": "clay" }"#),
        ("list_without_parameters", r#"{ "smooth_union": [ { "sphere": { "radius": 0 } } ] }"#),
        (
            "size",
            r#"{ "union": [ { "box": { "size": [1, 2] } }, { "box": { "size": [1, -2, 1] } }, { "box": { "size": true } } ] }"#,
        ),
        (
            "degenerate_axis",
            r#"{ "rotate": { "axis": [0, 0, 0], "angle": 30, "shape": { "sphere": { "radius": -1 } } } }"#,
        ),
        ("axis", r#"{ "cylinder": { "radius": 1, "height": 2, "axis": "w" } }"#),
        ("half_spaces", r#"{ "convex_polyhedron": { "half_spaces": [ [0, 0, 1], [0, 0, 0, 1], 7 ] } }"#),
        ("no_child", r#"{ "translate": { "by": [0, 0, 1] } }"#),
        ("children_for_child", r#"{ "translate": { "by": [0, 0, 1], "shapes": [] } }"#),
        (
            "one_mistake_each",
            r#"{ "difference": [
    { "translate": { "by": [0, true, 0], "shape": { "sphere": { "radius": -1 } } } },
    { "scale": { "factor": 0, "shape": { "spher": { "radius": 1 } } } },
    { "torus": { "major": 1, "minor": 0.25, "axis": "z", "axis": "x" } } ] }"#,
        ),
        (
            "warps",
            r#"{ "union": [
    { "warp": { "x": "x + ", "y": 1, "w": "z", "shape": { "sphere": { "radius": 1 } } } },
    { "displace": { "shape": { "sphere": { "radius": 1 } } } } ] }"#,
        ),
        ("sheet_displaced", r#"{ "displace": { "by": "x", "shape": { "sheet": { "normal": "z" } } } }"#),
        ("endless_twist", r#"{ "twist": { "rate": 10, "shape": { "plane": { "normal": "x" } } } }"#),
        ("unpainted", r#"{ "paint": { "shape": { "sphere": { "radius": 1 } } } }"#),
    ] {
        check(name, &with_shape(shape));
    }
}

/// No snapshot, since every new shape is listed there.
/// What is said about knots and nets, and where.
#[test]
fn knots_and_nets() {
    let spline = |knots: &str| {
        format!(
            r#"{{ "b_spline": {{ "radius": 1, "degree": 1, "knots": {knots}, "points": [[0, 0, 0], [1, 0, 0]] }} }}"#
        )
    };
    let patch = |rows: &str| format!(r#"{{ "bezier_patch": {{ "radius": 1, "points": {rows} }} }}"#);
    for (shape, message, place) in [
        (spline("[0, 0, 1]"), "`b_spline`: a spline of degree 1 with 2 points has 4 knots, not 3", r#""b_spline""#),
        (spline("[0, 0, 0, 1]"), "`b_spline`: a spline of degree 1 has no knot more than 2 times", r#""b_spline""#),
        (spline("[0, 2, 1, 3]"), "`knots` must not fall, but entry 3 is 1 after 2", "[0, 2, 1, 3]"),
        (spline("\"odd\""), "`knots` can't be `odd`", r#""odd""#),
        (spline("[0, true, 2, 3]"), "entry 2 of `knots`", "true"),
        (
            patch("[[[0, 0, 0], [1, 0, 0]], [[0, 1, 0]]]"),
            "row 2 has 1, and the first one 2",
            "[[[0, 0, 0], [1, 0, 0]], [[0, 1, 0]]]",
        ),
        (patch("[[[0, 0, 0], [1, 0, 0]], [[0, 1], [1, 1, 0]]]"), "entry 1 of row 2 of `points`", "[0, 1]"),
        (patch("[[[0, 0, 0], [1, 0, 0]], 3]"), "row 2 of `points`", "3"),
    ] {
        let text = with_shape(&shape);
        let mut report = shown(&text);
        println!("{report}");
        assert!(report.contains(message), "{message}: {report}");
        // The place is underlined by as many marks as it is long, at least.
        report.retain(|c| c == '^');
        assert_eq!(report.len(), place.len(), "{place}");
    }
}

#[test]
fn unknown_shapes_are_answered_with_the_known_ones() {
    let diagnostics = read(&with_shape(r#"{ "teapot": {} }"#)).diagnostics;
    assert_eq!(diagnostics.len(), 1);
    assert_eq!(diagnostics[0].message, "there is no shape `teapot`");
    assert!(diagnostics[0].hint.as_ref().is_some_and(|hint| hint.contains(", cylinder, ")));
}

#[test]
fn long_lines_are_cut() {
    let text =
        format!("{{ \"objects\": [ {}0 ] }}", "{ \"shape\": { \"sphere\": { \"radius\": 1 } } }, ".repeat(50_000));
    let printed = shown(&text);
    assert!(printed.len() < 2000, "{} bytes", printed.len());
    insta::with_settings!({ omit_expression => true, prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!("long_line", printed);
    });
}

#[test]
fn many_mistakes_are_counted() {
    let text = format!("{{ \"objects\": [ {}0 ] }}", "0,\n".repeat(1000));
    let reading = read(&text);
    assert_eq!(reading.diagnostics.len(), 1001);
    let printed = report(&text, "scene.json", &reading.diagnostics, false);
    assert!(printed.ends_with("and 951 more\n"), "{printed}");
}

#[test]
fn a_byte_order_mark_moves_the_places() {
    let text = "\u{feff}{ \"objcts\": [] }";
    let reading = read(text);
    assert_eq!(&text[reading.diagnostics[0].span.clone()], "\"objcts\"");
}

#[test]
fn colour_adds_nothing_but_escapes() {
    let text = with_shape(r#"{ "sphere": { "radios": 1 } }"#);
    let diagnostics = read(&text).diagnostics;
    let colored = report(&text, "scene.json", &diagnostics, true);
    let mut plain = String::new();
    let mut rest = colored.as_str();
    while let Some((before, after)) = rest.split_once("\u{1b}[") {
        plain += before;
        rest = after.split_once('m').expect("an escape ends").1;
    }
    assert_eq!(plain + rest, report(&text, "scene.json", &diagnostics, false));
}
