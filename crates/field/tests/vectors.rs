//! Vectors in formulas, and names that are given values.

use freikugel_field::Formula;
use freikugel_field::formula::name_fault;
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

const POINT: DVec3 = DVec3::new(0.7, -1.3, 2.1);

fn value(text: &str) -> f64 {
    Formula::parse(text).unwrap_or_else(|error| panic!("{text}: {error}")).value(POINT.to_array())
}

#[test]
fn vectors_mean_what_they_do_in_geometry() {
    let (p, q) = (POINT, DVec3::new(1.0, 2.0, -0.5));
    for (text, expected) in [
        ("length(p)", p.length()),
        ("length(p.xy)", p.truncate().length()),
        ("length(p - vec(1, 2, -0.5))", p.distance(q)),
        ("distance(p, vec(1, 2, -0.5))", p.distance(q)),
        ("distance(p.xz, vec(1, 2))", DVec2::new(p.x, p.z).distance(DVec2::new(1.0, 2.0))),
        ("dot(p, vec(1, 2, -0.5))", p.dot(q)),
        ("dot(p.zx, vec(3, 4))", 3.0 * p.z + 4.0 * p.x),
        ("cross(p, vec(1, 2, -0.5)).x", p.cross(q).x),
        ("cross(p, vec(1, 2, -0.5)).y", p.cross(q).y),
        ("cross(p, vec(1, 2, -0.5)).z", p.cross(q).z),
        ("normalize(p).z", p.normalize().z),
        ("length(normalize(p.yz))", 1.0),
        ("p.x + 10p.y + 100 p.z", p.x + 10.0 * p.y + 100.0 * p.z),
        ("p.zyx.x", p.z),
        ("(2p).y", 2.0 * p.y),
        ("(-p).y", -p.y),
        ("(p + 1).z", p.z + 1.0),
        ("(1 - p).x", 1.0 - p.x),
        ("(p * vec(1, 2, 3)).y", 2.0 * p.y),
        ("(p / vec(1, 2, 3)).z", p.z / 3.0),
        ("(6 / p).x", 6.0 / p.x),
        ("(p^2).y + (p²).y", 2.0 * p.y * p.y),
        ("abs(p).y", p.y.abs()),
        ("max(p, 0).y + max(p, 0).z", p.z),
        ("max(p, vec(0, 0, 3), vec(1, 1, 1)).z", 3.0),
        ("mod(p, 1).y", p.y.rem_euclid(1.0)),
        ("clamp(p, vec(0, 0, 0), vec(1, 1, 1)).z", 1.0),
        ("mix(p, vec(1, 1, 1), 0.25).x", 0.75 * p.x + 0.25),
        ("vec(p.xy, 5).z + vec(5, p.xy).z", 5.0 + p.y),
        (
            "q = abs(p) - vec(1, 1, 1); length(max(q, 0)) + min(max(q.x, q.y, q.z), 0)",
            (0.3_f64.powi(2) + 1.1_f64.powi(2)).sqrt(),
        ),
        ("c = vec(1, 0); d = p.xy - c; dot(d, d)", (p.truncate() - DVec2::X).length_squared()),
    ] {
        assert!((value(text) - expected).abs() < 1e-12, "{text} is {}, not {expected}", value(text));
    }
}

#[test]
fn vectors_are_gone_when_a_formula_is_read() {
    let terms = |text: &str| Formula::parse(text).expect("a formula").to_string();
    assert_eq!(terms("length(p) - 1"), terms("sqrt(x^2 + y^2 + z^2) - 1"));
    assert_eq!(terms("dot(p, p) - 1"), terms("x^2 + y^2 + z^2 - 1"));
    assert_eq!(terms("(p - p).x + dot(p.xy, vec(0, 1))"), "y");
}

#[test]
fn mistakes_with_vectors_are_explained() {
    for (text, column, message, hint) in [
        ("p", 1, "a formula is a number, but this is a vector of 3", "length(v)"),
        ("p^2 - 1", 1, "a formula is a number", "v.x"),
        ("1 + p.xy", 1, "this is a vector of 2", ""),
        ("length(p.xy + p)", 13, "a vector of 2 and a vector of 3 have no common parts", ""),
        ("length(max(p.xy, p))", 8, "`max` can't take a vector of 2 and a vector of 3", "max(a, b, ...)"),
        ("p.w", 2, "a vector of 3 has no part `.w`", ".xyz"),
        ("p.xy.z", 5, "a vector of 2 has no part `.z`", ".xy"),
        ("p.xxyz", 2, "no part `.xxyz`", "up to three"),
        ("x.y", 2, "a number has no part `.y`", "x * y"),
        ("dot(p, x)", 1, "takes two vectors of the same length, not a vector of 3 and a number", "dot(v, w)"),
        ("dot(p, p.xy)", 1, "not a vector of 3 and a vector of 2", ""),
        ("cross(p.xy, p.yx).x", 1, "takes two vectors of 3", "cross(v, w)"),
        ("length(x)", 1, "abs(a)", ""),
        ("length(p, x)", 1, "one vector, or two or three numbers", ""),
        ("normalize(x)", 1, "sign(a)", ""),
        ("vec(1).x", 1, "two numbers at least", "vec(a, b, c)"),
        ("vec(p, 1).x", 1, "4 parts", ""),
        ("vec3(1, 2, 3).x", 1, "`vec3` has no meaning", "vec(a, b, c)"),
        ("p = 1; p", 1, "`p` has a meaning already", ""),
        ("p(1)", 1, "`p` is no function", ""),
        ("t - 1", 1, "`t` has no meaning", "in scenes"),
        (".x", 1, "can't stand here", ""),
    ] {
        let error = Formula::parse(text).expect_err(text);
        assert!(error.message.contains(message), "{text}: {error}");
        assert_eq!(error.column, column, "{text}: {error}");
        assert!(error.hint.as_deref().unwrap_or_default().contains(hint), "{text}: {error}");
    }
}

fn given(names: &[(&str, f64)]) -> BTreeMap<String, f64> {
    names.iter().map(|&(name, value)| (name.to_owned(), value)).collect()
}

#[test]
fn names_have_the_values_they_are_given() {
    let names = given(&[("radius", 2.0), ("unused", 1.0), ("t", 0.5)]);
    let formula = Formula::parse_with("length(p) - radius * (1 + t)", &names).expect("a formula");
    assert!((formula.value([3.0, 0.0, 4.0]) - 2.0).abs() < 1e-12);
    assert_eq!(formula.names(), ["radius", "t"]);
    assert_eq!(formula.text(), "length(p) - radius * (1 + t)");
    assert_eq!(Formula::parse_with("radius^2 / 8 + t", &names).expect("a formula").constant(), Some(1.0));
    assert_eq!(Formula::parse_with("radius + x", &names).expect("a formula").constant(), None);
    let error = Formula::parse_with("radios - x", &names).expect_err("a misspelt name");
    assert_eq!(error.hint.as_deref(), Some("did you mean `radius`?"));
    let error = Formula::parse_with("radius = 1; radius", &names).expect_err("a name twice");
    assert!(error.message.contains("`radius` has a meaning already"), "{error}");
    let error = Formula::parse_with("1 / (radius - 2)", &names).expect_err("no value");
    assert!(error.message.contains("no finite value"), "{error}");
}

#[test]
fn names_of_the_language_can_be_given_no_value() {
    for name in ["radius", "t", "_", "a1", "X"] {
        assert_eq!(name_fault(name), None, "{name}");
    }
    for name in ["x", "p", "pi", "sin", "vec", "", "1a", "a b", "ä", "a.b"] {
        assert!(name_fault(name).is_some(), "{name}");
    }
}
