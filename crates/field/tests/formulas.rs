//! The formula language: what texts mean, what is wrong with others, and what may be done with formulas.

use freikugel_field::formula::{Formula, MOST_NESTED, Term, functions};
use freikugel_field::{Dual, Interval, Scalar, vec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::cell::Cell;
use std::f64::consts::{E, PI, TAU};

fn formula(text: &str) -> Formula {
    Formula::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// What is printed of a text's terms.
fn printed(text: &str) -> String {
    formula(text).to_string()
}

const POINT: [f64; 3] = [0.7, -1.3, 2.1];

#[test]
fn texts_mean_what_people_mean() {
    let [x, y, z] = POINT;
    for (text, value) in [
        ("x", x),
        (" \t x\n", x),
        ("1 + 2 * 3", 7.0),
        ("1 - 2 - 3", -4.0),
        ("24 / 4 / 3", 2.0),
        ("24 / 4 * 3", 18.0),
        ("2^3^2", 512.0),
        ("2**3", 8.0),
        ("-x^2", -(x * x)),
        ("-2^2", -4.0),
        ("(-2)^2", 4.0),
        ("2^-1", 0.5),
        ("2^-2^2", 1.0 / 16.0),
        ("2 * -x", -2.0 * x),
        ("x - -y", x + y),
        ("--x", x),
        ("+x", x),
        ("-+-x", x),
        ("x−y", x - y),
        ("x·y × z ÷ 2", x * y * z / 2.0),
        ("x² + y³", x * x + y * y * y),
        ("x¹²", x.powi(12)),
        ("x⁻²", 1.0 / (x * x)),
        ("-x²", -(x * x)),
        ("2^x²", (x * x).exp2()),
        (".5 + 5. + 1e2 + 1E-2 + 2.5e+1", 130.51),
        ("2x", 2.0 * x),
        ("3(x + 1)", 3.0 * (x + 1.0)),
        ("2x^2", 2.0 * x * x),
        ("-2x^2", -2.0 * x * x),
        ("4 / 2 * 3x", 6.0 * x),
        ("2sin(x)", 2.0 * x.sin()),
        ("2e", 2.0 * E),
        ("2e + 1", 2.0 * E + 1.0),
        ("2e1", 20.0),
        ("90deg", PI / 2.0),
        ("0.25 turn", PI / 2.0),
        ("pi + π + tau + τ", 2.0 * PI + 2.0 * TAU),
        ("e^x", x.exp()),
        ("sin(x) + cos(y) + tan(z)", x.sin() + y.cos() + z.tan()),
        ("asin(x) + acos(x) * atan(y)", x.asin() + x.acos() * y.atan()),
        ("atan2(y, x)", y.atan2(x)),
        ("sinh(x) + cosh(y) * tanh(z)", x.sinh() + y.cosh() * z.tanh()),
        ("tanh(1000)", 1.0),
        ("cosh(x) + tanh(y)", x.cosh() + y.tanh()),
        ("exp(x) + ln(z)", x.exp() + z.ln()),
        ("log2(z) * log10(z)", z.log2() * z.log10()),
        ("pow(z, x)", z.powf(x)),
        ("z^x", z.powf(x)),
        ("z^0.5 + z^-0.5", z.sqrt() + 1.0 / z.sqrt()),
        ("sqrt(z)", z.sqrt()),
        ("cbrt(y) + cbrt(z)", y.cbrt() + z.cbrt()),
        ("hypot(x, y) + length(x, y)", 2.0 * x.hypot(y)),
        ("hypot(x, y, z)", (x * x + y * y + z * z).sqrt()),
        ("abs(y)", 1.3),
        ("sign(y) + 10 sign(z) + 100 sign(x - x)", 9.0),
        ("floor(y) + 10 ceil(y) + 100 round(y)", -2.0 - 10.0 - 100.0),
        ("round(2.5) + round(-2.5)", 1.0),
        ("fract(y)", 0.7),
        ("mod(y, 1) + mod(7, 3) + mod(-7, 3)", 0.7 + 1.0 + 2.0),
        ("mod(7, -3)", -2.0),
        ("min(x, y) + 10 max(x, y, z)", -1.3 + 21.0),
        ("min(3, 2, 5, 4)", 2.0),
        ("clamp(x, 0, 0.5) + clamp(y, 0, 0.5)", 0.5),
        ("mix(x, y, 0.25)", 0.75 * x + 0.25 * y),
        ("less(x, y) + 10 less(y, x) + 100 less(x, x)", 10.0),
        ("step(x, y) + 10 step(y, x) + 100 step(x, x)", 110.0),
        ("smoothstep(0, 1, 0.25)", 0.15625),
        ("smoothstep(2, 4, z) + smoothstep(0, 1, y) + smoothstep(0, 1, z)", 0.0025 * 2.9 + 1.0),
        ("r = hypot(x, y); t = atan2(y, x); r * cos(t)", x),
        ("a=x;b=a+1;a*b", x * (x + 1.0)),
    ] {
        let error = (formula(text).value(POINT) - value).abs();
        assert!(error < 1e-12, "{text} is {}, not {value}", formula(text).value(POINT));
    }
}

#[test]
fn values_end_where_parts_have_none() {
    for text in [
        "sqrt(y)",
        "sqrt(y) - sqrt(y)",
        "0 * ln(y)",
        "sqrt(y)^2",
        "min(asin(z), asin(z))",
        "y^0.5 * y^0.5",
        "0 * sqrt(x - 1)",
        "max(y^1.5, 1) * 0 + y^1.5",
    ] {
        assert!(formula(text).value(POINT).is_nan(), "{text}");
    }
}

#[test]
fn equal_formulas_have_equal_terms() {
    for (one, other) in [
        ("sin(x + y) - sin(y + x)", "0"),
        ("x * x", "x^2"),
        ("x * y * x", "x^2 * y"),
        ("x^2 * x^3", "x^5"),
        ("x * x * x * x", "x^4"),
        ("(x^2)^3", "x^6"),
        ("x + x", "2x"),
        ("x + y - x", "y"),
        ("2x + y + 3x", "5x + y"),
        ("1 + x + 2", "x + 3"),
        ("1 - x + 2 - 4", "-1 - x"),
        ("2 * x * 3", "6x"),
        ("x / 4", "0.25x"),
        ("x / 3 / 5", "x / 15"),
        ("-(x - y)", "y - x"),
        ("-(-x)", "x"),
        ("x - (-y)", "x + y"),
        ("(-x) * y", "-(x * y)"),
        ("(-x) * (-y)", "x * y"),
        ("(-x)^2", "x^2"),
        ("(-x)^3", "-x^3"),
        ("sin(-x)", "-sin(x)"),
        ("cos(-x)", "cos(x)"),
        ("abs(-x)", "abs(x)"),
        ("sqrt(x^2)", "abs(x)"),
        ("sqrt(x^4)", "x^2"),
        ("abs(x^2 + 1)", "x^2 + 1"),
        ("sqrt(x^2 + y^2)^2", "x^2 + y^2"),
        ("x * 0 + y", "y"),
        ("1x + 0y", "x"),
        ("x^1 + y^0", "x + 1"),
        ("ln(exp(x))", "x"),
        ("max(x, x)", "x"),
        ("max(x, min(x, y))", "x"),
        ("min(min(x, 2), 1)", "min(x, 1)"),
        ("max(x^2, 0)", "x^2"),
        ("e^x", "exp(x)"),
        ("x * (1 / y)", "x / y"),
        ("cos(pi)", "-1"),
        ("1 - (1 - less(x, y))", "less(x, y)"),
        ("hypot(x, y)", "sqrt(x^2 + y^2)"),
    ] {
        assert_eq!(printed(one), printed(other), "{one} and {other}");
        assert_eq!(formula(one).terms(), formula(other).terms(), "{one} and {other}");
    }
    assert_eq!(formula("sin(x) + sin(x)^2").terms().len(), 4, "x, sin, square, sum");
}

#[test]
fn print_has_no_parentheses_too_many() {
    for text in [
        "x^2 + y^2 + z^2 - 1",
        "2 * x * y - 3 * (x + y) * z",
        "x - (y - z)",
        "x - (y + z)",
        "x / (y * z)",
        "x * (y / z)",
        "x / y * z",
        "-(x^2 + y)",
        "(-x)^y",
        "(x^y)^z",
        "x^y^z",
        "x^(y + 1)",
        "x^-y",
        "x^-3",
        "2^x",
        "(x + y)^2",
        "sin(x + y)^2",
        "min(x, y, z)",
        "min(x, min(y, z))",
        "max(min(x, y), 0.5)",
        "atan2(y, x)",
        "-(2 * x / y)",
        "-x / y",
        "1 - x",
        "1 / x - 1e-9",
        "pi * x - 1e300 * y",
        "-sin(x)",
        "x / 3",
        "x - y * z",
    ] {
        assert_eq!(printed(text), text);
    }
}

#[test]
fn mistakes_have_a_place_and_a_hint() {
    for (text, column, message, hint) in [
        ("", 1, "empty", ""),
        ("   ", 4, "empty", ""),
        ("x +", 3, "operand is missing after `+`", ""),
        ("x + * y", 3, "operand is missing after `+`", ""),
        ("* x", 1, "operand is missing before `*`", ""),
        ("²", 1, "operand is missing before `²`", ""),
        ("x^", 2, "operand is missing after `^`", ""),
        ("-", 1, "operand is missing after `-`", ""),
        ("sin(x", 4, "never closed", ""),
        ("2 * (x + (y - 1)", 5, "never closed", ""),
        ("(", 1, "never closed", ""),
        ("x + y)", 6, "never opened", ""),
        (")", 1, "never opened", ""),
        ("x * ()", 5, "nothing in these parentheses", ""),
        ("sin()", 1, "takes 1 argument, but has 0", "sin(a)"),
        ("atan2(y)", 1, "takes 2 arguments, but has 1", "atan2(y, x)"),
        ("1 + hypot(x)", 5, "takes 2 or 3 arguments, but has 1", "hypot(a, b)"),
        ("max(x)", 1, "takes 2 arguments or more, but has 1", "max(a, b, ...)"),
        ("max(x,)", 7, "argument is missing", ""),
        ("max(,x)", 5, "argument is missing", ""),
        ("max(x, ", 8, "argument is missing", ""),
        ("(x, y)", 3, "comma", ""),
        ("x + 1,5", 6, "comma", "decimal point"),
        ("x y", 3, "operator is missing between `x` and `y`", "x * y"),
        ("2x y", 4, "operator is missing", "x * y"),
        ("2 pi x", 6, "operator is missing between `pi` and `x`", "pi * x"),
        ("x 2", 3, "operator is missing", "x * 2"),
        ("2 3", 3, "two numbers", ""),
        ("1.2.3", 4, "two numbers", ""),
        ("(x)(y)", 4, "operator is missing", ") * ("),
        ("x²y", 3, "operator is missing", ""),
        ("x(y + 1)", 1, "`x` is no function", "x * (...)"),
        ("2x(y)", 2, "`x` is no function", "x * (...)"),
        ("pi(x)", 1, "`pi` is no function", "pi * (...)"),
        ("1/2x", 2, "divide by 2 or by 2x", "/ (2 * x"),
        ("x^2y", 2, "is 2 or 2y the exponent", "^2 * y"),
        ("x^2(y)", 2, "is 2 or 2( the exponent", "^2 * ("),
        ("xy + 1", 1, "`xy` has no meaning", "x * y"),
        ("X + 1", 1, "`X` has no meaning", "`x`"),
        ("Sin(x)", 1, "`Sin` has no meaning", "`sin`"),
        ("sqr(x)", 1, "`sqr` has no meaning", "a^2"),
        ("sqroot(x)", 1, "`sqroot` has no meaning", "`sqrt`"),
        ("smothstep(0, 1, x)", 1, "no meaning", "`smoothstep`"),
        ("r - 1", 1, "`r` has no meaning", "hypot"),
        ("radius = 1; radios + x", 13, "`radios` has no meaning", "`radius`"),
        ("log(x)", 1, "`log` has no meaning", "ln(a)"),
        ("bogus(x)", 1, "`bogus` has no meaning", "numbers and functions"),
        ("sin x", 1, "needs its arguments in parentheses", "sin(x)"),
        ("sin^2(x)", 1, "needs its arguments in parentheses", "sin(...)^2"),
        ("2 * sin", 5, "needs its arguments in parentheses", "sin(a)"),
        ("x^2 + y^2 < 1", 11, "comparison with `<`", "left - right"),
        ("x >= y", 3, "comparison with `>=`", "left - right"),
        ("x == y", 3, "no equation", "left - right"),
        ("x^2 + y^2 = 1", 11, "no equation", "left - right"),
        ("z = x^2", 3, "`z` is a coordinate", "left - right"),
        ("x != y", 3, "no operator `!=`", "less"),
        ("x && y", 3, "no operator `&&`", "less"),
        ("x % 2", 3, "no operator `%`", "mod(a, b)"),
        ("|x|", 1, "no `|`", "abs(x)"),
        ("√x", 1, "no `√`", "sqrt"),
        ("[x]", 1, "`[` has no meaning", "( and )"),
        ("x – y", 3, "dash", "-"),
        ("x $ y", 3, "`$` has no meaning", ""),
        ("ä + ö", 1, "`ä` has no meaning", ""),
        ("x\u{7}", 2, "U+0007", ""),
        ("1e999", 1, "too large", "numbers go up to"),
        (".", 1, "point without digits", ""),
        ("x⁻", 2, "no digits", ""),
        ("x⁹⁹⁹⁹⁹⁹⁹⁹⁹⁹⁹", 2, "too large", ""),
        ("x + 1/0", 6, "no finite value", ""),
        ("x/(y - y)", 2, "no finite value", ""),
        ("mod(x, 1 - 1) + 1", 1, "no finite value", ""),
        ("sqrt(-1)", 1, "no finite value", ""),
        ("(x - x)^-1", 8, "no finite value", ""),
        ("r = 1; r = 2; r", 8, "`r` has a meaning already", "another name"),
        ("e = 1; e", 1, "`e` has a meaning already", ""),
        ("sin = 1; sin", 1, "`sin` has a meaning already", ""),
        ("r = x", 1, "no `;` after the definition of `r`", ""),
        ("r = x;", 7, "nothing follows the definitions", ""),
        ("r = ; x", 3, "no value", ""),
        ("r = x; r; x", 9, "`;` can only stand after a definition", ""),
        ("(x; y)", 3, "`;` can't stand within parentheses", ""),
        ("sin(r = 1)", 5, "no meaning", ""),
        ("täb", 2, "`ä` has no meaning", ""),
    ] {
        let Err(error) = Formula::parse(text) else { panic!("{text} is a formula") };
        assert!(error.message.contains(message), "{text}: {error}");
        assert_eq!(error.column, column, "{text}: {error}");
        assert_eq!(text[..error.span.start].chars().count() + 1, column, "{text}: {error}");
        assert!(error.span.start <= error.span.end && text.is_char_boundary(error.span.end), "{text}: {error}");
        match &error.hint {
            None => assert_eq!(hint, "", "{text}: {error}"),
            Some(given) => assert!(given.contains(hint) && !(hint.is_empty() && given.is_empty()), "{text}: {error}"),
        }
    }
    let spans = [("x + foo(y)", "foo"), ("max(x) + 1", "max(x)"), ("2 * (x + 1", "("), ("x <= y", "<=")];
    for (text, place) in spans {
        let error = Formula::parse(text).expect_err("a mistake");
        assert_eq!(&text[error.span], place, "{text}");
    }
}

#[test]
fn nothing_exhausts_the_stack() {
    for (open, close) in [("(", ")"), ("sin(", ")"), ("x^", ""), ("max(x, ", ")"), ("2^-", ""), ("1 - (", ")")] {
        let deep = |levels: usize| format!("{}x{}", open.repeat(levels), close.repeat(levels));
        assert!(Formula::parse(&deep(MOST_NESTED)).is_ok(), "{open}");
        let error = Formula::parse(&deep(100_000)).expect_err("nested too deep");
        assert!(error.message.contains("nested"), "{open}: {error}");
    }
    for text in [format!("{}x", "-".repeat(1_000_001)), format!("x{}", "²".repeat(3)), "(".repeat(100_000)] {
        let _ = Formula::parse(&text);
    }
    // Sums and products of any length nest to the left only.
    let long: String = (1..20_000).map(|n| format!(" + sin({n}x) * {n}y")).collect();
    let sum = formula(&format!("x{long}"));
    assert_eq!(Formula::parse(&sum.to_string()).expect("its print").terms(), sum.terms());
    assert!(sum.derivative(0).terms().len() > 20_000);
}

#[test]
fn large_formulas_are_refused() {
    let mut text = String::from("x");
    for n in 0..400_000 {
        text += &format!("+sin({n}.5x)");
    }
    let error = Formula::parse(&text).expect_err("too large");
    assert!(error.message.contains("operations"), "{error}");
}

#[test]
fn shared_parts_are_printed_once_where_repeating_them_would_be_long() {
    let mut text = String::from("t = x;");
    for n in 0..80 {
        text += &format!("a{n} = {}; ", if n == 0 { "t * y + t".into() } else { format!("a{0} * y + a{0}", n - 1) });
    }
    let shared = formula(&format!("{text}a79").replace("t = x;", "t = sin(x);"));
    assert_eq!(shared.terms().len(), 4 + 2 * 80 - 1);
    let printed = shared.to_string();
    assert!(printed.len() < 4000, "{}", printed.len());
    assert_eq!(formula(&printed).terms(), shared.terms());
    // Nested further than can be read.
    let deep = (0..1000).fold(String::from("a = x; a"), |text, _| {
        let (definitions, last) = text.rsplit_once(';').unwrap_or_default();
        let name = format!("a{}", definitions.len());
        format!("{definitions}; {name} = sin({last}); {name}")
    });
    let deep = formula(&deep);
    assert_eq!(deep.terms().len(), 1001);
    assert_eq!(formula(&deep.to_string()).terms(), deep.terms());
}

#[test]
fn every_function_is_found_and_can_be_called() {
    for function in functions() {
        let call = function.signature.replace("...", "z").replace("edge", "x").replace("low", "x").replace("high", "z");
        let call = call.replace("(a", "(x").replace(" a", " x").replace(" b", " y").replace(" c", " z");
        let call = call.replace(" t)", " x)").replace("(v", "(p").replace(" w", " p");
        let is_sound = Formula::parse(&call).is_ok() || Formula::parse(&format!("length({call})")).is_ok();
        assert!(is_sound, "{call}");
    }
    let names: std::collections::BTreeSet<_> = functions().map(freikugel_field::formula::Function::name).collect();
    assert_eq!(names.len(), functions().count(), "two functions of one name");
}

#[test]
fn coordinates_that_matter_are_known() {
    let uses = |text: &str| [0, 1, 2].map(|axis| formula(text).uses(axis));
    assert_eq!(uses("x + z"), [true, false, true]);
    assert_eq!(uses("x + y - x"), [false, true, false]);
    assert_eq!(uses("1"), [false, false, false]);
}

#[test]
fn derivatives_are_those_of_calculus() {
    for (text, axis, derivative) in [
        ("x^2 + y^2 - 1", 0, "2 * x"),
        ("x^3 * y", 0, "3 * x^2 * y"),
        ("x^3 * y", 1, "x^3"),
        ("x^3 * y", 2, "0"),
        ("sin(2x)", 0, "2 * cos(2 * x)"),
        ("exp(x * y)", 1, "exp(x * y) * x"),
        ("ln(z)", 2, "1 / z"),
        ("1 / x", 0, "-1 / x^2"),
        ("sqrt(x)", 0, "0.5 / sqrt(x)"),
        ("2^x", 0, "2^x * 0.6931471805599453"),
        ("z^1.5", 2, "1.5 * sqrt(z)"),
        ("floor(x)", 0, "0"),
        ("min(x, y)", 0, "less(x, y)"),
        ("abs(x)", 0, "1 - 2 * less(x, 0)"),
    ] {
        assert_eq!(formula(text).derivative(axis).text(), printed(derivative), "{text}");
    }
}

#[test]
fn polynomials_are_expanded() {
    let monomials = |text: &str| {
        let polynomial = formula(text).polynomial()?;
        Some(polynomial.monomials().iter().map(|m| (m.exponents, m.coefficient)).collect::<Vec<_>>())
    };
    assert_eq!(monomials("(x + y)^2 - 2x*y - 1"), Some(vec![([0, 0, 0], -1.0), ([0, 2, 0], 1.0), ([2, 0, 0], 1.0)]));
    assert_eq!(monomials("(x - 2y*z) / 4 * 2"), Some(vec![([0, 1, 1], -1.0), ([1, 0, 0], 0.5)]));
    assert_eq!(monomials("(x + 1)^2 - x^2 - 2x - 1"), Some(vec![]));
    assert_eq!(formula("(x^2 + y^2 + z^2 + 3)^2 - 16(x^2 + y^2)").polynomial().map(|p| p.degree()), Some(4));
    assert_eq!(formula("x^12 + 1").polynomial().map(|p| p.degree()), Some(12));
    for text in ["x^13", "x^7 * y^7", "sin(x)", "1 / x", "abs(x)", "x^y", "max(x, y)", "x^-2"] {
        assert_eq!(formula(text).polynomial(), None, "{text}");
    }
}

#[test]
fn graphs_are_read() {
    let text = "# A ring\n_0 var-x\n_1 square _0 # inside a line\n\n_2 var-y\n_3 square _2\n_4 add _1 _3\n_5 sqrt _4\n\
                _6 const 2.5\n_7 sub _5 _6\n0xdead mul _7 _7\n_8 var-z\n_9 square _8\n_a add 0xdead _9\n_b const 1\n\
                _c sub _a _b\n";
    let ring = Formula::from_vm(text).expect("a graph");
    assert_eq!(ring.terms(), formula("(sqrt(x^2 + y^2) - 2.5)^2 + z^2 - 1").terms());
    assert_eq!(ring.text(), "(sqrt(x^2 + y^2) - 2.5)^2 + z^2 - 1");

    let value = |operation: &str, a: f64, b: f64| {
        let text = format!("a const {a}\nb const {b}\nx var-x\ny var-y\nc {operation}");
        Formula::from_vm(&text).expect("a graph").value([a, b, 0.0])
    };
    for (operation, a, b, result) in [
        ("mod x y", -7.0, 3.0, 2.0),
        ("mod x y", -7.0, -3.0, 2.0),
        ("mod a b", 7.5, -3.0, 1.5),
        ("compare x y", 1.0, 2.0, -1.0),
        ("compare x y", 2.0, 2.0, 0.0),
        ("compare x y", 3.0, 2.0, 1.0),
        ("not x", 0.0, 0.0, 1.0),
        ("not x", -0.5, 0.0, 0.0),
        ("and x y", 0.0, 5.0, 0.0),
        ("and x y", -2.0, 5.0, 5.0),
        ("or x y", 0.0, 5.0, 5.0),
        ("or x y", -2.0, 5.0, -2.0),
        ("atan2 x y", 1.0, -1.0, 0.75 * PI),
        ("round x", 1.4, 0.0, 1.0),
        ("ceil x", 1.4, 0.0, 2.0),
        ("neg a", 1.5, 0.0, -1.5),
    ] {
        assert_eq!(value(operation, a, b), result, "{operation} of {a} and {b}");
    }
    for (text, line, column, message) in [
        ("", 1, 1, "no operation"),
        ("# nothing\n\n", 2, 1, "no operation"),
        ("a", 1, 1, "followed by no operation"),
        ("a var-x\nb sqrt", 2, 3, "followed by 1 word, but here by 0"),
        ("a var-x\nb add a", 2, 3, "followed by 2 words"),
        ("a var-x a", 1, 9, "followed by 0 words"),
        ("a var-x\nb  sqrt c", 2, 9, "no `c` before"),
        ("b sqrt b", 1, 8, "no `b` before"),
        ("a var-x\na var-y", 2, 1, "given twice"),
        ("ä var-x\n\nü sqroot ä", 3, 3, "did you mean `sqrt`"),
        ("a frobnicate", 1, 3, "no operation `frobnicate`"),
        ("a const", 1, 3, "followed by 1 word"),
        ("a const one", 1, 9, "no finite number"),
        ("\ta const inf", 1, 10, "no finite number"),
    ] {
        let error = Formula::from_vm(text).expect_err(text);
        assert_eq!((error.line, error.column), (line, column), "{text}: {error}");
        assert!(error.to_string().contains(message), "{text}: {error}");
        assert!(text.get(error.span.clone()).is_some(), "{text}: {:?}", error.span);
    }
}

/// A formula as a tree, with its meaning written down a second time.
#[derive(Clone, Debug)]
enum Tree {
    Input(usize),
    Number(f64),
    Unary(&'static str, Box<Tree>),
    Binary(&'static str, Box<Tree>, Box<Tree>),
    Power(Box<Tree>, i32),
}

use Tree::{Input, Number};

const CALLS: &[&str] = &[
    "sin", "cos", "tan", "asin", "acos", "atan", "exp", "ln", "sqrt", "abs", "floor", "sign", "ceil", "fract", "tanh",
    "cosh", "sinh",
];
const PAIRS: &[&str] = &["min", "max", "atan2", "mod", "less", "step", "hypot", "pow"];
const OPERATORS: &[&str] = &["+", "-", "*", "/"];

impl Tree {
    fn text(&self) -> String {
        match self {
            Input(axis) => ["x", "y", "z"][*axis].into(),
            Number(number) => format!("({number})"),
            Self::Unary("-", a) => format!("(-{})", a.text()),
            Self::Unary(name, a) => format!("{name}({})", a.text()),
            Self::Power(a, n) => format!("({}^{n})", a.text()),
            Self::Binary(op, a, b) if OPERATORS.contains(op) => format!("({} {op} {})", a.text(), b.text()),
            Self::Binary(name, a, b) => format!("{name}({}, {})", a.text(), b.text()),
        }
    }

    /// The value, and whether all its parts have one. `check` looks at each value and what it was computed from.
    fn eval<S: Scalar>(&self, p: [S; 3], check: &impl Fn(S, [S; 2]) -> (S, bool)) -> (S, bool) {
        let lift = |number: f64| p[0].lift(number);
        let less = |a: S, b: S| S::select(a.lt(b), lift(1.0), lift(0.0));
        let (value, is_whole, operands) = match self {
            Input(axis) => return (p[*axis], true),
            Number(number) => return (lift(*number), true),
            Self::Power(a, n) => {
                let (a, is_whole) = a.eval(p, check);
                (a.powi(*n), is_whole, [a; 2])
            }
            Self::Unary(name, a) => {
                let (a, is_whole) = a.eval(p, check);
                let value = match *name {
                    "-" => -a,
                    "sin" => a.sin(),
                    "cos" => a.cos(),
                    "tan" => a.tan(),
                    "asin" => a.asin(),
                    "acos" => a.acos(),
                    "atan" => a.atan(),
                    "exp" => a.exp(),
                    "ln" => a.ln(),
                    "sqrt" => a.sqrt(),
                    "abs" => a.abs(),
                    "floor" => a.floor(),
                    "ceil" => -(-a).floor(),
                    "fract" => a - a.floor(),
                    "sign" => less(lift(0.0), a) - less(a, lift(0.0)),
                    "sinh" => (a.exp() - (-a).exp()) * 0.5,
                    "cosh" => (a.exp() + (-a).exp()) * 0.5,
                    "tanh" => lift(1.0) - lift(2.0) / ((a * 2.0).exp() + 1.0),
                    _ => unreachable!("{name}"),
                };
                (value, is_whole, [a; 2])
            }
            Self::Binary(name, a, b) => {
                let ((a, a_whole), (b, b_whole)) = (a.eval(p, check), b.eval(p, check));
                let value = match *name {
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "/" => a / b,
                    "min" => a.min(b),
                    "max" => a.max(b),
                    "atan2" => a.atan2(b),
                    "pow" => a.pow(b),
                    "mod" => a - b * (a / b).floor(),
                    "less" => less(a, b),
                    "step" => lift(1.0) - less(b, a),
                    "hypot" => (a * a + b * b).sqrt(),
                    _ => unreachable!("{name}"),
                };
                (value, a_whole && b_whole, [a, b])
            }
        };
        let (value, is_there) = check(value, operands);
        (value, is_whole && is_there)
    }
}

fn trees(calls: &'static [&'static str], pairs: &'static [&'static str]) -> impl Strategy<Value = Tree> {
    let numbers = prop_oneof![(-8..9).prop_map(f64::from), -3.0..3.0, Just(0.5), Just(PI), Just(1e-7)];
    let leaf = prop_oneof![3 => (0..3_usize).prop_map(Input), 2 => numbers.prop_map(Number)];
    leaf.prop_recursive(6, 40, 2, move |inner| {
        let boxed = inner.prop_map(Box::new);
        let call = prop_oneof![1 => Just("-"), 4 => prop::sample::select(calls)];
        prop_oneof![
            4 => (prop::sample::select(OPERATORS), boxed.clone(), boxed.clone())
                .prop_map(|(op, a, b)| Tree::Binary(op, a, b)),
            2 => (call, boxed.clone()).prop_map(|(name, a)| Tree::Unary(name, a)),
            1 => (prop::sample::select(pairs), boxed.clone(), boxed.clone())
                .prop_map(|(name, a, b)| Tree::Binary(name, a, b)),
            1 => (boxed, -4..7_i32).prop_map(|(a, n)| Tree::Power(a, n)),
        ]
    })
}

fn points() -> impl Strategy<Value = [f64; 3]> {
    [-3.0..3.0, -3.0..3.0, -3.0..3.0]
}

/// Another one makes other trees.
const SEED: u64 = 1;

/// What is said of a constant like 1/0.
const NO_VALUE: &str = "no finite value";

/// Runs `test` on many trees with points, the same ones each time; it says whether a case told it anything. At least half of them must.
fn many<T: Strategy<Value = Tree>>(trees: T, test: impl Fn(Tree, [f64; 3]) -> Result<bool, TestCaseError>) {
    let (all, telling) = (Cell::new(0_u32), Cell::new(0_u32));
    let mut runner = TestRunner::new(Config {
        cases: 100_000,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(SEED),
        ..Config::default()
    });
    let result = runner.run(&(trees, points()), |(tree, point)| {
        let tells = test(tree, point)?;
        all.set(all.get() + 1);
        telling.set(telling.get() + u32::from(tells));
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    assert!(2 * telling.get() > all.get(), "{} of {} cases tell something", telling.get(), all.get());
}

/// The formula of a tree, unless a part of it is a constant without value.
fn of(tree: &Tree) -> Result<Option<Formula>, TestCaseError> {
    match Formula::parse(&tree.text()) {
        Ok(formula) => Ok(Some(formula)),
        Err(error) if error.message.contains(NO_VALUE) => Ok(None),
        Err(error) => Err(TestCaseError::fail(error.to_string())),
    }
}

#[test]
fn simplifying_changes_no_value() {
    many(trees(CALLS, PAIRS), |tree, point| {
        let Some(formula) = of(&tree)? else { return Ok(false) };
        // The exact value lies in here, and what rounding makes of it and of all its parts.
        let (range, is_bounded) = tree.eval(point.map(Interval::point), &|range: Interval, [a, b]| {
            let size = [range, a, b].map(|part| part.abs().hi()).into_iter().fold(0.0, f64::max);
            let rounded = range + Interval::new(-1e-14 * size, 1e-14 * size);
            (rounded, rounded.width().is_finite())
        });
        if !is_whole(&tree, point) || !is_bounded {
            return Ok(false);
        }
        let value = formula.value(point);
        prop_assert!(range.contains(value), "{}: {value} not in {range:?}, printed as {formula}", tree.text());
        Ok(true)
    });
}

/// Whether all parts of the formula have finite values.
fn is_whole(tree: &Tree, point: [f64; 3]) -> bool {
    tree.eval(point, &|value: f64, _| (value, value.is_finite())).1
}

#[test]
fn prints_are_read_back_as_they_were() {
    many(trees(CALLS, PAIRS), |tree, _| {
        let Some(formula) = of(&tree)? else { return Ok(false) };
        let print = formula.to_string();
        let again = match Formula::parse(&print) {
            Ok(again) => again,
            Err(error) => return Err(TestCaseError::fail(format!("{print}: {error}"))),
        };
        prop_assert_eq!(again.terms(), formula.terms(), "{} printed as {}", tree.text(), print);
        prop_assert_eq!(again.to_string(), print);
        Ok(true)
    });
}

#[test]
fn intervals_enclose() {
    many(trees(CALLS, PAIRS), |tree, corner| {
        let Some(formula) = of(&tree)? else { return Ok(false) };
        const SIZE: f64 = 0.5;
        let cell = corner.map(|c| Interval::new(c, c + SIZE));
        let range = formula.eval(cell.into());
        let mut tells = false;
        for place in 0..64 {
            let share = |shift: u32| f64::from(place >> shift & 3) / 3.0;
            let point = [corner[0] + SIZE * share(0), corner[1] + SIZE * share(2), corner[2] + SIZE * share(4)];
            let point = [0, 1, 2].map(|axis| point[axis].clamp(cell[axis].lo(), cell[axis].hi()));
            let value = formula.value(point);
            // Where a part has no value, the rest need not be enclosed.
            if !is_whole(&tree, point) || !value.is_finite() {
                continue;
            }
            tells |= range.width().is_finite();
            prop_assert!(range.contains(value), "{formula} at {point:?}: {value} not in {range:?}");
        }
        Ok(tells || range.width().is_infinite())
    });
}

#[test]
fn derivatives_agree_with_dual_numbers() {
    many(trees(CALLS, PAIRS), |tree, point| {
        let Some(formula) = of(&tree)? else { return Ok(false) };
        let dual = formula.eval::<Dual<f64>>(vec3(
            Dual::input(point[0], 0),
            Dual::input(point[1], 1),
            Dual::input(point[2], 2),
        ));
        let mut tells = false;
        for axis in 0..3 {
            let derivative = formula.derivative(axis);
            match Formula::parse(derivative.text()) {
                Ok(again) => prop_assert!(again.terms() == derivative.terms(), "{derivative}"),
                // The square of a huge constant.
                Err(error) if error.message.contains(NO_VALUE) => continue,
                Err(error) => prop_assert!(false, "{derivative}: {error:?}"),
            }
            let (slope, expected) = (derivative.value(point), dual.gradient[axis]);
            // How much rounding the terms of the derivative can do.
            let range = derivative.eval(point.map(Interval::point).into());
            if !slope.is_finite() || !expected.is_finite() || !range.width().is_finite() {
                continue;
            }
            let slack = 1e3 * range.width() + 1e-9 * (1.0 + expected.abs());
            prop_assert!((slope - expected).abs() <= slack, "{formula}, axis {axis}: {slope}, not {expected}");
            tells = true;
        }
        Ok(tells)
    });
}

#[test]
fn derivatives_agree_with_differences() {
    const STEP: f64 = 1e-5;
    for text in [
        "x^2 * sin(y) - z^3 / x",
        "exp(x - y) * atan2(y, z)",
        "sqrt(x^2 + y^2 + 1) - ln(z) + asin(x / 4) * acos(y / 4)",
        "z^x + x^-3 + tan(x) + atan(y * z)",
        "abs(x - y) + max(x, y * z) - min(x, z)",
        "smoothstep(0, 3, x * z) + tanh(y) + cosh(x) - sinh(z)",
        "fract(x) * y + mod(z, 0.75) + cbrt(y)",
        "mix(x, y, z) + hypot(x, y, z)",
    ] {
        let formula = formula(text);
        for axis in 0..3 {
            let at = |step: f64| {
                let mut point = POINT;
                point[axis] += step;
                formula.value(point)
            };
            let difference = (at(STEP) - at(-STEP)) / (2.0 * STEP);
            let slope = formula.derivative(axis).value(POINT);
            assert!((slope - difference).abs() < 1e-8 * (1.0 + slope.abs()), "{text}: {slope}, not {difference}");
        }
    }
}

#[test]
fn graphs_survive_being_written() {
    many(trees(CALLS, PAIRS), |tree, point| {
        let Some(formula) = of(&tree)? else { return Ok(false) };
        let again = match Formula::from_vm(&formula.to_vm()) {
            Ok(again) => again,
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        let is_power = |term: &Term| matches!(term, Term::Binary(freikugel_field::formula::Binary::Pow, ..));
        let (value, range) = (again.value(point), formula.eval(point.map(Interval::point).into()));
        if formula.terms().iter().any(is_power) || !range.width().is_finite() || !formula.value(point).is_finite() {
            return Ok(false);
        }
        let slack = 1e3 * range.width() + 1e-12 * value.abs();
        prop_assert!((value - formula.value(point)).abs() <= slack, "{formula}: {value}");
        Ok(true)
    });
}

#[test]
fn expanded_polynomials_have_the_same_values() {
    const NONE: &[&str] = &["-"];
    let degrees = |tree: Tree, point: [f64; 3]| {
        let Some(formula) = of(&tree)? else { return Ok(false) };
        let Some(polynomial) = formula.polynomial() else { return Ok(true) };
        let (value, expected) = (polynomial.value(point), formula.value(point));
        let size: f64 = polynomial
            .monomials()
            .iter()
            .map(|m| {
                let factors = [0, 1, 2].map(|axis| point[axis].abs().powi(i32::from(m.exponents[axis])));
                m.coefficient.abs() * factors.iter().product::<f64>()
            })
            .sum();
        let range = formula.eval(point.map(Interval::point).into());
        let slack = 1e-12 * size + 1e3 * range.width();
        prop_assert!((value - expected).abs() <= slack, "{formula}: {value}, not {expected}");
        Ok(true)
    };
    many(trees(NONE, &["+", "*"]), degrees);
}

proptest! {
    #![proptest_config(Config { cases: 3000, failure_persistence: None, ..Config::default() })]

    #[test]
    fn no_text_panics(text in any::<String>()) {
        soup(&text)?;
    }

    #[test]
    fn no_row_of_words_panics(words in prop::collection::vec(prop::sample::select(WORDS), 0..30)) {
        soup(&words.concat())?;
        soup(&words.join(" "))?;
    }

    #[test]
    fn no_graph_panics(words in prop::collection::vec(prop::sample::select(VM_WORDS), 0..40)) {
        let _ = Formula::from_vm(&words.join(" "));
    }
}

const WORDS: &[&str] = &[
    "x", "y", "z", "r", "1", "2.5", "0", "1e3", ".", "e", "pi", "+", "-", "*", "/", "^", "**", "²", "⁻", "(", "(", ")",
    ")", ",", ";", "=", "sin", "sin(", "max(", "atan2", "r =", "<", "|", "ä", "π", "√", "\n", "p", ".x", ".yx", "vec(",
    "length(", "dot(p,", "cross(",
];

const VM_WORDS: &[&str] =
    &["a", "b", "c", "\n", "\n", "\n", "var-x", "const", "1", "add", "sqrt", "mod", "#", "a", "not"];

/// Any text: it is a formula that can be printed, or has a mistake in it that has a place.
fn soup(text: &str) -> Result<(), TestCaseError> {
    match Formula::parse(text) {
        Ok(formula) => {
            let again = Formula::parse(&formula.to_string());
            prop_assert_eq!(again.map(|again| again.terms() == formula.terms()), Ok(true), "{}", formula);
            formula.value(POINT);
        }
        Err(error) => {
            prop_assert!(text.get(error.span.clone()).is_some(), "{error}");
            prop_assert!(!error.to_string().is_empty());
        }
    }
    Ok(())
}
