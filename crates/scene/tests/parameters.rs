//! Numbers by formulas, parameters, the time, and shapes with names.

use freikugel_scene::{Diagnostic, Inputs, NoFiles, Reading, Scene, Severity, read, read_at};

fn at(text: &str, set: &[(&str, f64)], time: f64) -> Reading {
    let set = set.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
    read_at(text, NoFiles, &Inputs { set, time })
}

fn sound(reading: Reading) -> Scene {
    reading.into_result().unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// The arguments of the first object's outermost function.
fn numbers(scene: &Scene) -> Vec<f64> {
    scene.objects[0].shape.node().numbers()
}

fn errors(reading: &Reading) -> Vec<&Diagnostic> {
    reading.diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error).collect()
}

const BALL: &str = r#"{
    "parameters": {
        "depth": "size / 2",
        "size": { "value": 3, "from": 1, "to": 5, "unit": "m", "about": "how large it is" }
    },
    "camera": { "eye": [4, "-size", "sin(t)"], "fov": "10 size" },
    "picture": { "width": "100 * size" },
    "objects": [ { "shape": { "box": { "size": ["size", "depth + t", 1], "round": "depth/10" } } } ]
}"#;

#[test]
fn numbers_may_be_formulas_of_parameters_and_time() {
    let reading = at(BALL, &[], 0.0);
    assert!(reading.uses_time);
    let scene = sound(reading);
    assert_eq!(numbers(&scene)[..4], [3.0, 1.5, 1.0, 0.15]);
    assert_eq!(scene.picture.width, 300);
    assert_eq!(scene.camera.expect("a camera").eye.to_array(), [4.0, -3.0, 0.0]);
    let names: Vec<&str> = scene.parameters.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["depth", "size"], "as they are written, in whatever order they are computed");
    assert_eq!(scene.parameters[1].1.unit, "m");

    let scene = sound(at(BALL, &[("size", 2.0)], 0.5));
    assert_eq!(numbers(&scene)[..4], [2.0, 1.5, 1.0, 0.1]);
    assert_eq!(scene.parameters[0].1.value, 1.0);
    assert_eq!(sound(at(BALL, &[("size", 2.0), ("size", 4.0)], 0.0)).picture.width, 400, "the last one counts");
    assert_eq!(numbers(&sound(at(BALL, &[("depth", 4.0)], 0.0)))[1], 4.0, "a computed one can be set, too");
}

#[test]
fn formulas_of_shapes_may_use_parameters() {
    let text = r#"{ "parameters": { "r": 2 }, "objects": [ { "shape": { "formula": "length(p) - r - t" } } ] }"#;
    let scene = sound(at(text, &[], 0.25));
    let formula = scene.objects[0].shape.node().formula(0).expect("a formula").clone();
    assert_eq!(formula.value([3.0, 0.0, 0.0]), 0.75);
    assert_eq!(formula.text(), "length(p) - r - t");
}

#[test]
fn numbers_may_have_keyframes() {
    let text = r#"{
        "parameters": { "far": { "keyframes": [[0, 1], [2, 3]], "ease": "linear" } },
        "camera": { "eye": { "keyframes": [[0, ["2 far", 0, 0]], [1, [0, 4, 0]]], "ease": "linear" } },
        "objects": [ { "shape": { "box": { "size": { "keyframes": [[1, [1, 1, 1]], [3, [3, 2, 1]]] }, "round": 0.1 } } },
                     { "shape": { "box": { "size": { "keyframes": [[0, 1], [1, 2]], "ease": "step" } } } } ]
    }"#;
    let (first, second) = (sound(at(text, &[], 0.5)), sound(at(text, &[], 2.0)));
    assert!(at(text, &[], 0.0).uses_time);
    assert_eq!(first.parameters[0].1.value, 1.5);
    assert_eq!(first.camera.expect("a camera").eye.to_array(), [1.5, 2.0, 0.0]);
    assert_eq!(first.objects[0].shape.node().numbers()[..3], [1.0, 1.0, 1.0]);
    assert_eq!(second.objects[0].shape.node().numbers()[..3], [2.0, 1.5, 1.0]);
    assert_eq!(second.objects[1].shape.node().numbers()[..3], [2.0, 2.0, 2.0]);
    for (keyframes, place, message) in [
        (r#"{ "keyframes": [[0, 1]] }"#, "[[0, 1]]", "`keyframes` of `radius` needs two entries"),
        (r#"{ "keyframes": [[0, 1], [0, 2]] }"#, "0", "keyframe 2 of `radius` is at the time 0, which is not after 0"),
        (r#"{ "keyframes": [[0, 1], [1]] }"#, "[1]", "keyframe 2 of `radius` must be [time, number], not a list"),
        (r#"{ "keyframes": [[0, 1], [1, [2]]] }"#, "[2]", "keyframe 2 of `radius` must be a number, not a list"),
        (r#"{ "keyframes": [[0, 1], [1, 2]], "ease": "soft" }"#, "\"soft\"", "`ease` can't be `soft`"),
        (r#"{ "keyframes": [[0, 1], [1, 2]], "easy": 1 }"#, "\"easy\"", "`radius` has no key `easy`"),
        (
            r#"{ "frames": [[0, 1], [1, 2]] }"#,
            r#"{ "frames": [[0, 1], [1, 2]] }"#,
            "`radius` must be a number, not an object",
        ),
    ] {
        let text = format!(r#"{{ "objects": [ {{ "shape": {{ "sphere": {{ "radius": {keyframes} }} }} }} ] }}"#);
        let reading = read(&text);
        let errors = errors(&reading);
        let [only] = &errors[..] else { panic!("{text}: {errors:?}") };
        assert!(only.message.starts_with(message), "{text}: {only:?}");
        assert_eq!(&text[only.span.clone()], place, "{text}: {only:?}");
    }
}

#[test]
fn scenes_without_time_say_so() {
    assert!(!read(r#"{ "objects": [ { "shape": { "sphere": { "radius": "1 + 1" } } } ] }"#).uses_time);
    assert!(read(r#"{ "objects": [ { "shape": { "displace": { "by": "sin(x + t)", "shape": { "sphere": { "radius": 1 } } } } } ] }"#).uses_time);
}

/// The text, what is set, the place and beginning of what is said about it, and a part of the hint.
type Mistake = (&'static str, &'static [(&'static str, f64)], &'static str, &'static str, &'static str);

const MISTAKES: [Mistake; 16] = [
    (
        r#"{ "objects": [ { "shape": { "sphere": { "radius": "2 * size" } } } ] }"#,
        &[],
        "size",
        "`size` has no meaning here",
        "x, y, z",
    ),
    (r#"{ "objects": [ { "shape": { "sphere": { "radius": "2 +" } } } ] }"#, &[], "+", "an operand is missing", ""),
    (
        r#"{ "objects": [ { "shape": { "sphere": { "radius": "x" } } } ] }"#,
        &[],
        "\"x\"",
        "`radius` is one number, which can't depend on x",
        "`t`",
    ),
    (r#"{ "objects": [ { "shape": { "sphere": { "radius": "-1" } } } ] }"#, &[], "\"-1\"", "", ""),
    (
        r#"{ "objects": [ { "shape": { "sphere": { "radius": true } } } ] }"#,
        &[],
        "true",
        "`radius` must be a number",
        "",
    ),
    (
        r#"{ "parameters": { "size": 1 }, "objects": [ { "shape": { "sphere": { "radius": "sise" } } } ] }"#,
        &[],
        "sise",
        "`sise` has no meaning",
        "did you mean `size`?",
    ),
    (
        r#"{ "parameters": { "a": "b", "b": "a + 1" }, "objects": [ { "shape": { "sphere": { "radius": "a" } } } ] }"#,
        &[],
        "\"b\"",
        "`a` depends on itself, or",
        "among `a`, `b`",
    ),
    (
        r#"{ "parameters": { "a": "2a" }, "objects": [ { "shape": { "sphere": { "radius": "a" } } } ] }"#,
        &[],
        "\"2a\"",
        "`a` depends on itself",
        "",
    ),
    (
        r#"{ "parameters": { "x": 1 }, "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#,
        &[],
        "\"x\"",
        "`x` has a meaning",
        "another name",
    ),
    (
        r#"{ "parameters": { "t": 1 }, "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#,
        &[],
        "\"t\"",
        "`t` is the time",
        "another name",
    ),
    (
        r#"{ "parameters": { "a b": 1 }, "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#,
        &[],
        "\"a b\"",
        "`a b` is no name",
        "",
    ),
    (
        r#"{ "parameters": { "a": { "value": 1, "from": 2 } }, "objects": [ { "shape": { "sphere": { "radius": "a" } } } ] }"#,
        &[],
        "1",
        "`value` is 1, below `from`",
        "",
    ),
    (
        r#"{ "parameters": { "a": { "value": 1, "to": 2 } }, "objects": [ { "shape": { "sphere": { "radius": "a" } } } ] }"#,
        &[("a", 3.0)],
        "{ \"value\": 1, \"to\": 2 }",
        "`a` is set to 3, but can be at most 2",
        "",
    ),
    (
        r#"{ "parameters": { "a": 1 }, "objects": [ { "shape": { "sphere": { "radius": "a" } } } ] }"#,
        &[("b", 3.0)],
        "{ \"a\": 1 }",
        "the scene has no parameter `b`",
        "`a`",
    ),
    (
        r#"{ "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#,
        &[("b", 3.0)],
        "{",
        "the scene has no parameter `b`",
        "`parameters`",
    ),
    (
        r#"{ "parameters": [], "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#,
        &[],
        "[]",
        "`parameters` must be an object",
        "",
    ),
];

#[test]
fn mistakes_have_places_and_hints() {
    for (text, set, place, message, hint) in MISTAKES {
        let reading = at(text, set, 0.0);
        let errors = errors(&reading);
        let first = errors.first().unwrap_or_else(|| panic!("{text} is sound"));
        assert!(first.message.starts_with(message), "{text}: {first:?}");
        assert_eq!(&text[first.span.clone()], place, "{text}: {first:?}");
        assert!(first.hint.as_deref().unwrap_or_default().contains(hint), "{text}: {first:?}");
    }
}

#[test]
fn parameters_that_no_formula_uses_are_pointed_out() {
    let text = r#"{ "parameters": { "a": 1, "b": 2 }, "objects": [ { "shape": { "sphere": { "radius": "a" } } } ] }"#;
    let reading = read(text);
    assert!(reading.scene.is_some());
    let [warning] = &reading.diagnostics[..] else { panic!("{:?}", reading.diagnostics) };
    assert_eq!((warning.severity, &text[warning.span.clone()]), (Severity::Warning, "\"b\""));
}

#[test]
fn shapes_with_names_are_used_wherever_one_stands() {
    let text = r#"{
        "shapes": { "pair": { "union": [ { "use": "ball" }, { "translate": { "by": [3, 0, 0], "shape": { "use": "ball" } } } ] },
                    "ball": { "sphere": { "radius": 1.5 } }, "spot": { "circle": { "radius": 0.25 } } },
        "objects": [ { "shape": { "use": "pair" } }, { "shape": { "extrude": { "height": 1, "shape": { "use": "spot" } } } } ]
    }"#;
    let scene = sound(read(text));
    let pair = scene.objects[0].shape.node();
    assert_eq!(pair.shape.about.name, "union");
    assert_eq!(pair.children[0].node().numbers(), [1.5]);
    assert_eq!(pair.children[1].node().children[0].node().numbers(), [1.5]);
    assert_eq!(scene.shapes.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["pair", "ball", "spot"]);
}

#[test]
fn mistakes_with_named_shapes_are_explained_once() {
    for (text, place, message, hint) in [
        (
            r#"{ "shapes": { "ball": { "sphere": { "radius": 1 } } }, "objects": [ { "shape": { "use": "bal" } } ] }"#,
            "\"bal\"",
            "there is no shape called `bal`",
            "did you mean `ball`?",
        ),
        (
            r#"{ "objects": [ { "shape": { "use": "ball" } } ] }"#,
            "\"ball\"",
            "there is no shape called `ball`",
            "under `shapes`",
        ),
        (r#"{ "objects": [ { "shape": { "use": 1 } } ] }"#, "1", "`use` must be the name of a shape, not a number", ""),
        (
            r#"{ "shapes": { "a": { "shell": { "thickness": 1, "shape": { "use": "a" } } } }, "objects": [ { "shape": { "use": "a" } } ] }"#,
            "\"a\"",
            "`a` uses itself",
            "",
        ),
        (
            r#"{ "shapes": { "a": { "sphere": { "radius": -1 } } }, "objects": [ { "shape": { "use": "a" } }, { "shape": { "use": "a" } } ] }"#,
            "-1",
            "",
            "",
        ),
        (
            r#"{ "shapes": { "a": { "sphere": { "radios": 1 } } }, "objects": [ { "shape": { "use": "a" } }, { "shape": { "use": "a" } } ] }"#,
            "\"radios\"",
            "`sphere` has no key `radios`",
            "`radius`",
        ),
        (
            r#"{ "shapes": { "a": { "sphere": { "radius": 1 } } }, "objects": [ { "shape": { "use": "a", "sphere": { "radius": 1 } } } ] }"#,
            "\"sphere\"",
            "`sphere` stands in the same object as `use`",
            "",
        ),
    ] {
        let reading = read(text);
        let errors = errors(&reading);
        let [only] = &errors[..] else { panic!("{text}: {errors:?}") };
        assert!(only.message.starts_with(message), "{text}: {only:?}");
        assert_eq!(&text[only.span.clone()], place, "{text}: {only:?}");
        assert!(only.hint.as_deref().unwrap_or_default().contains(hint), "{text}: {only:?}");
    }
}

#[test]
fn shapes_that_grow_beyond_all_bounds_are_refused() {
    let double = |index: usize| {
        format!(r#""s{}": {{ "union": [ {{ "use": "s{index}" }}, {{ "use": "s{index}" }} ] }}"#, index + 1)
    };
    let doubles: Vec<String> = (0..40).map(double).collect();
    let text = format!(
        r#"{{ "shapes": {{ "s0": {{ "sphere": {{ "radius": 1 }} }}, {} }}, "objects": [ {{ "shape": {{ "use": "s40" }} }} ] }}"#,
        doubles.join(", ")
    );
    let reading = read(&text);
    assert!(errors(&reading)[0].message.contains("is made of more than"), "{:?}", reading.diagnostics);
    let uses = [r#"{ "shape": { "use": "s19" } }"#; 9].join(", ");
    let text = format!(
        r#"{{ "shapes": {{ "s0": {{ "sphere": {{ "radius": 1 }} }}, {} }}, "objects": [ {uses} ] }}"#,
        doubles[..19].join(", ")
    );
    let reading = read(&text);
    assert!(errors(&reading)[0].message.starts_with("the scene is made of more than"), "{:?}", reading.diagnostics);
}
