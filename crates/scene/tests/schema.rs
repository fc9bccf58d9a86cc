//! The schema and the reader say the same: what one accepts, so does the other, apart from what no schema can say.

use freikugel_scene::{Severity, read, schema};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use serde_json::{Map, Value as Json, json};
use std::sync::LazyLock;

/// Scenes that use every part of the format.
const SCENES: [&str; 7] = [
    r#"{ "objects": [ { "shape": { "sphere": { "radius": 1 } } } ] }"#,
    r##"{ "version": 1, "$schema": "scene.schema.json",
      "camera": { "eye": [4, -6, 3], "target": [0, 0, 1], "up": "z", "fov": 40 },
      "lights": [ { "sun": { "direction": [1, -1, 2], "color": "#fff5e0", "shadow": { "hardness": 16 } } },
                  { "sun": { "direction": "-y", "shadow": { "clearance": 0.5 } } },
                  { "point": { "position": [-3, -4, 5], "intensity": 30, "falloff": "inverse_square" } },
                  { "spot": { "position": [0, 0, 5], "target": [0, 0, 0], "angle": 30, "softness": 0.2,
                              "falloff": [1, 0, 0.5], "shadow": { "clearance": true } } } ],
      "ambient": { "sky": [0.2, 0.2, 0.3], "ground": "#211" }, "occlusion": { "strength": 0.8, "reach": 0.5 },
      "background": { "gradient": { "top": "#456", "bottom": "#ccc" } },
      "materials": { "clay": { "color": "#c8825a", "specular": 0.2, "exponent": 32, "model": "phong" },
                     "tiles": { "color": { "checker": { "colors": ["#fff", [0, 0, 0]], "size": 0.5 } } } },
      "objects": [ { "name": "cup", "material": "clay", "shape":
        { "difference": [ { "cylinder": { "radius": 1, "height": 2, "round": 0.05 } },
                          { "translate": { "by": [0, 0, 0.2], "shape": { "cylinder": { "radius": 0.85, "height": 2 } } } } ] } },
        { "name": "floor", "shape": { "paint": { "material": "tiles", "shape": { "plane": { "normal": "z" } } } } } ],
      "tracer": { "max_distance": 100, "precision": 1e-5, "max_steps": 512, "step_factor": 0.9,
                  "method": "fixed", "step": 0.1, "relaxation": 1.5, "precision_exponent": 0, "warning": null },
      "picture": { "width": 320, "height": 180, "samples": 4, "exposure": -0.5, "overbright": "scale_down" } }"##,
    r##"{ "camera": { "eye": [0, 0, 9], "height": 4 }, "lights": [], "ambient": "#333", "occlusion": false, "background": "#000",
      "objects": [ { "shape": { "smooth_union": { "k": 0.4, "shapes":
        [ { "box": { "size": 1 } }, { "rotate": { "axis": "x", "angle": 30, "shape": { "torus": { "major": 1, "minor": 0.25 } } } } ] } } } ] }"##,
    r#"{ "camera": { "eye": [0, 0, 9], "fov": { "horizontal": 60 } }, "occlusion": true,
      "lights": [ { "point": { "position": [1, 1, 1], "falloff": "none", "shadow": false } } ],
      "objects": [ { "shape": { "convex_polyhedron": { "half_spaces":
        [ [1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1] ] } } } ] }"#,
    r#"{ "objects": [ { "shape": { "formula": { "f": "x^2 + y^2 - z", "kind": "sheet", "within": { "box": 2 }, "cut": "open" } } },
      { "shape": { "warp": { "x": "x + 0.1*sin(3z)", "z": "z / 2", "within": { "sphere": 2 }, "shape":
        { "twist": { "rate": 60, "axis": "x", "shape": { "displace": { "by": "sin(9y) / 20", "shape":
          { "sphere": { "radius": 1 } } } } } } } } } ] }"#,
    r#"{ "parameters": { "size": 1, "turns": { "value": "2 * abs(size)", "from": 0, "to": 9, "unit": "turns", "about": "how often" } },
      "shapes": { "part": { "box": { "size": ["2/2", 2, "t + 1"], "round": "1 / 8" } }, "two": { "union": [ { "use": "part" } ] } },
      "objects": [ { "shape": { "twist": { "rate": "360 turns", "shape": { "use": "two" } } } } ],
      "camera": { "eye": [4, "-6 cos(t) - size", 3], "fov": "40" }, "picture": { "width": "100" } }"#,
    r#"{ "camera": { "eye": { "keyframes": [[0, [4, -6, 3]], [2, [6, 0, "3 + 1"]], ["4", [4, -6, 3]]], "ease": "spline", "loop": true },
                     "fov": { "keyframes": [[0, 40], [1, 30]] } },
      "objects": [ { "shape": { "translate": { "by": [0, { "keyframes": [[0, 1], [2, 3]], "ease": "in" }, 0], "shape":
        { "box": { "size": { "keyframes": [[0, [1, 2, 3]], [5, [3, 2, 1]]], "ease": "linear" } } } } } } ] }"#,
];

/// The part of JSON Schema that scenes need. Anything else in a schema panics, so that nothing is passed over.
struct Validator(Json);

static VALIDATOR: LazyLock<Validator> = LazyLock::new(|| Validator(schema()));

impl Validator {
    fn resolve<'s>(&'s self, schema: &'s Json) -> &'s Json {
        match schema.get("$ref").and_then(Json::as_str) {
            Some(path) => self.0.pointer(path.trim_start_matches('#')).expect("the reference leads somewhere"),
            None => schema,
        }
    }

    fn accepts(&self, value: &Json) -> bool {
        self.matches(&self.0, value)
    }

    fn matches(&self, schema: &Json, value: &Json) -> bool {
        let keywords = schema.as_object().expect("a schema is an object");
        keywords.iter().all(|(keyword, wanted)| self.meets(keywords, keyword, wanted, value))
    }

    fn meets(&self, schema: &Map<String, Json>, keyword: &str, wanted: &Json, value: &Json) -> bool {
        let alternatives = || wanted.as_array().expect("a list of schemas").iter();
        let bound = || wanted.as_f64().expect("a number");
        let count = || wanted.as_u64().expect("a count") as usize;
        match keyword {
            "$schema" | "$defs" | "title" | "description" | "default" => true,
            "$ref" => self.matches(self.resolve(&json!({ "$ref": wanted })), value),
            "type" => types(wanted).into_iter().any(|wanted| match wanted {
                "object" => value.is_object(),
                "array" => value.is_array(),
                "string" => value.is_string(),
                "boolean" => value.is_boolean(),
                "number" => value.is_number(),
                "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
                other => panic!("type {other}"),
            }),
            "minimum" => value.as_f64().is_none_or(|number| number >= bound()),
            "exclusiveMinimum" => value.as_f64().is_none_or(|number| number > bound()),
            "maximum" => value.as_f64().is_none_or(|number| number <= bound()),
            "exclusiveMaximum" => value.as_f64().is_none_or(|number| number < bound()),
            "const" => same(wanted, value),
            "enum" => alternatives().any(|wanted| same(wanted, value)),
            "anyOf" => alternatives().any(|schema| self.matches(schema, value)),
            "oneOf" => alternatives().filter(|schema| self.matches(schema, value)).count() == 1,
            "not" => !self.matches(wanted, value),
            "items" => value.as_array().is_none_or(|list| list.iter().all(|entry| self.matches(wanted, entry))),
            "prefixItems" => {
                let Some(list) = value.as_array() else { return true };
                alternatives().zip(list).all(|(schema, entry)| self.matches(schema, entry))
            }
            "minItems" => value.as_array().is_none_or(|list| list.len() >= count()),
            "maxItems" => value.as_array().is_none_or(|list| list.len() <= count()),
            "minLength" => value.as_str().is_none_or(|text| text.chars().count() >= count()),
            "pattern" => {
                assert_eq!(wanted, "^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$", "the one pattern that is known here");
                value.as_str().is_none_or(|text| {
                    text.starts_with('#')
                        && [4, 7].contains(&text.len())
                        && text[1..].bytes().all(|b| b.is_ascii_hexdigit())
                })
            }
            "required" => value
                .as_object()
                .is_none_or(|object| alternatives().all(|key| object.contains_key(key.as_str().expect("a key")))),
            "minProperties" => value.as_object().is_none_or(|object| object.len() >= count()),
            "maxProperties" => value.as_object().is_none_or(|object| object.len() <= count()),
            "properties" => value.as_object().is_none_or(|object| {
                object.iter().all(|(key, value)| wanted.get(key).is_none_or(|schema| self.matches(schema, value)))
            }),
            "additionalProperties" => value.as_object().is_none_or(|object| {
                let others = object.iter().filter(|(key, _)| {
                    schema.get("properties").is_none_or(|properties| properties.get(key.as_str()).is_none())
                });
                others.into_iter().all(|(_, value)| wanted != &Json::Bool(false) && self.matches(wanted, value))
            }),
            "propertyNames" => {
                value.as_object().is_none_or(|object| object.keys().all(|key| self.matches(wanted, &json!(key))))
            }
            other => panic!("keyword {other}"),
        }
    }

    /// A small value that meets a schema.
    fn least(&self, schema: &Json) -> Json {
        let schema = self.resolve(schema);
        let first = ["anyOf", "oneOf", "enum"].iter().find_map(|keyword| Some((keyword, schema.get(keyword)?.get(0)?)));
        match (first, schema.get("const")) {
            (Some((&"enum", value)), _) | (_, Some(value)) => return value.clone(),
            (Some((_, schema)), _) => return self.least(schema),
            _ => {}
        }
        match types(&schema["type"])[0] {
            "boolean" => json!(false),
            "string" if schema.get("pattern").is_some() => json!("#abc"),
            "string" => json!("clay"),
            "number" | "integer" => {
                let numbers = [json!(1), json!(0.05), json!(0), json!(0.5), json!(2), json!(3)];
                numbers.into_iter().find(|number| self.matches(schema, number)).expect("a number in range")
            }
            "array" => {
                if let Some(each) = schema.get("prefixItems").and_then(Json::as_array) {
                    return each.iter().map(|schema| self.least(schema)).collect();
                }
                let count = schema.get("minItems").and_then(Json::as_u64).unwrap_or(1);
                vec![self.least(&schema["items"]); count as usize].into()
            }
            "object" => {
                let Some(properties) = schema.get("properties").and_then(Json::as_object) else {
                    return json!({ "clay": self.least(&schema["additionalProperties"]) });
                };
                let required = schema.get("required").and_then(Json::as_array).cloned().unwrap_or_default();
                let mut keys: Vec<&str> = required.iter().filter_map(Json::as_str).collect();
                if keys.is_empty() && schema.get("minProperties").is_some() {
                    // A shape that needs no others.
                    let takes = |schema: &Json, key| self.resolve(schema)["properties"].get(key).is_some();
                    let is_leaf = |schema: &&Json| !takes(schema, "shape") && !takes(schema, "shapes");
                    let leaf = properties.iter().find(|(_, schema)| is_leaf(schema)).map(|(key, _)| key);
                    keys.extend(leaf.or(properties.keys().next()).map(String::as_str));
                }
                keys.into_iter()
                    .map(|key| (key.to_string(), self.least(&properties[key])))
                    .collect::<Map<_, _>>()
                    .into()
            }
            other => panic!("type {other}"),
        }
    }

    /// Values that meet a schema: together they use every key and every alternative in it, with shapes in shapes down to
    /// `depth`.
    fn samples(&self, schema: &Json, depth: usize) -> Vec<Json> {
        let schema = self.resolve(schema);
        // They may stand for any number: one kind of them does for all.
        if schema["properties"].get("keyframes").is_some() {
            return vec![self.least(schema)];
        }
        let is_shape = schema == &self.0["$defs"]["shape"];
        if is_shape && depth == 0 {
            return vec![self.least(schema)];
        }
        let depth = depth - usize::from(is_shape);
        for keyword in ["anyOf", "oneOf"] {
            if let Some(alternatives) = schema.get(keyword).and_then(Json::as_array) {
                return alternatives.iter().flat_map(|schema| self.samples(schema, depth)).collect();
            }
        }
        if let Some(values) = schema.get("enum").and_then(Json::as_array) {
            return values.clone();
        }
        if let (Some(items), Some(_)) = (schema.get("items"), schema.get("type")) {
            let count = schema.get("minItems").and_then(Json::as_u64).unwrap_or(1);
            return self.samples(items, depth).into_iter().map(|item| vec![item; count as usize].into()).collect();
        }
        if let Some(values) = schema.get("additionalProperties").filter(|values| values.is_object()) {
            return self.samples(values, depth).into_iter().map(|value| json!({ "clay": value })).collect();
        }
        let Some(properties) = schema.get("properties").and_then(Json::as_object) else {
            let least = self.least(schema);
            // A number may be written as a formula.
            let written = schema.get("type").filter(|kinds| types(kinds).len() > 1).map(|_| json!(least.to_string()));
            return [least].into_iter().chain(written).collect();
        };
        let is_variant = schema.get("maxProperties").is_some();
        let least = if is_variant { json!({}) } else { self.least(schema) };
        let mut samples = Vec::new();
        for (key, property) in properties {
            for value in self.samples(property, depth) {
                let mut object = least.clone();
                object[key.as_str()] = value;
                samples.push(object);
            }
        }
        samples
    }
}

/// The types that a schema names, one or several.
fn types(wanted: &Json) -> Vec<&str> {
    match wanted.as_array() {
        Some(several) => several.iter().filter_map(Json::as_str).collect(),
        None => vec![wanted.as_str().expect("a type")],
    }
}

fn same(a: &Json, b: &Json) -> bool {
    a == b || a.as_f64().is_some_and(|a| Some(a) == b.as_f64())
}

/// What the reader says of keys, types and alternatives: all of that the schema knows, too.
const STRUCTURAL: [&str; 8] = [
    " has no key ",
    " must be a",
    " can't be ",
    " needs ",
    " can't have both ",
    " in the same object ",
    " can't stand beside ",
    "is missing here",
];

#[test]
fn scenes_are_valid_for_both() {
    let validator = &*VALIDATOR;
    for text in SCENES {
        let reading = read(text);
        assert!(reading.scene.is_some(), "{:?}\n{text}", reading.diagnostics);
        assert!(validator.accepts(&serde_json::from_str(text).expect("JSON")), "{text}");
    }
}

#[test]
fn the_reader_knows_all_that_the_schema_has() {
    let validator = &*VALIDATOR;
    let samples = validator.samples(&validator.0, 2);
    assert!(samples.len() > 1000, "{} samples", samples.len());
    for sample in samples {
        assert!(validator.accepts(&sample), "{sample}");
        for diagnostic in read(&sample.to_string()).diagnostics {
            let message = diagnostic.message;
            assert!(!STRUCTURAL.iter().any(|phrase| message.contains(phrase)), "{message}\n{sample}");
        }
    }
}

/// A change of one value in a tree.
#[derive(Clone, Debug)]
enum Change {
    Replace(Json),
    Remove,
    Rename,
    Add,
}

fn change() -> impl Strategy<Value = Change> {
    let values = [
        json!(null),
        json!(true),
        json!(-1),
        json!(0),
        json!(0.5),
        json!(3),
        json!(1e9),
        json!(1e300),
        json!("x"),
        json!("#fff"),
        json!("clay"),
        json!([]),
        json!({}),
        json!([1, 2, 3]),
        json!([0, 0, 0]),
        json!([1, 2, 3, 4]),
        json!({ "sphere": { "radius": 1 } }),
    ];
    prop_oneof![
        proptest::sample::select(values.to_vec()).prop_map(Change::Replace),
        Just(Change::Remove),
        Just(Change::Rename),
        Just(Change::Add),
    ]
}

/// Applies a change at the value with the number `at`, counted through the tree.
fn apply(value: &mut Json, at: &mut usize, change: &Change) {
    if *at == 0 && !matches!(change, Change::Remove | Change::Rename) {
        if let (Change::Add, Some(object)) = (change, value.as_object_mut()) {
            object.insert("surplus".into(), json!(1));
        } else if let (Change::Add, Some(list)) = (change, value.as_array_mut()) {
            list.extend(list.first().cloned());
        } else if let Change::Replace(other) = change {
            *value = other.clone();
        }
        *at = usize::MAX;
        return;
    }
    let is_parent = |at: usize, change: &Change| at == 1 && matches!(change, Change::Remove | Change::Rename);
    match value {
        Json::Array(list) => {
            for index in 0..list.len() {
                if is_parent(*at, change) {
                    list.remove(index);
                    *at = usize::MAX;
                    return;
                }
                *at = at.wrapping_sub(1);
                apply(&mut list[index], at, change);
            }
        }
        Json::Object(object) => {
            for key in object.keys().cloned().collect::<Vec<_>>() {
                if is_parent(*at, change) {
                    let value = object.remove(&key).expect("it is there");
                    if matches!(change, Change::Rename) {
                        object.insert(format!("{key}s"), value);
                    }
                    *at = usize::MAX;
                    return;
                }
                *at = at.wrapping_sub(1);
                apply(&mut object[&key], at, change);
            }
        }
        _ => {}
    }
}

fn count(value: &Json) -> usize {
    1 + match value {
        Json::Array(list) => list.iter().map(count).sum(),
        Json::Object(object) => object.values().map(count).sum(),
        _ => 0,
    }
}

/// Every run tests the same cases: a failure is never a matter of luck.
const SEED: u64 = 1;

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, rng_seed: RngSeed::Fixed(SEED), ..ProptestConfig::default() })]

    #[test]
    fn changed_scenes_are_judged_alike(
        scene in 0..SCENES.len(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), change()), 1..3),
    ) {
        let mut value: Json = serde_json::from_str(SCENES[scene]).expect("JSON");
        for (at, change) in changes {
            let mut at = at.index(count(&value));
            apply(&mut value, &mut at, &change);
        }
        let diagnostics = read(&value.to_string()).diagnostics;
        let errors: Vec<_> = diagnostics.iter().filter(|d| d.severity == Severity::Error).collect();
        let is_valid = VALIDATOR.accepts(&value);
        prop_assert!(is_valid || !errors.is_empty(), "the reader accepts what the schema does not: {value}");
        let structural = errors.iter().find(|error| STRUCTURAL.iter().any(|phrase| error.message.contains(phrase)));
        prop_assert!(!is_valid || structural.is_none(), "the schema accepts {value}, but: {}", structural.unwrap().message);
    }
}
