//! `freikugel formula`, as a user meets it.

use std::process::{Command, Output};

fn run(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_freikugel")).arg("formula").args(args).output().expect("the command runs")
}

fn explained(args: &[&str]) -> String {
    let output = run(args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

fn refused(args: &[&str], code: i32) -> String {
    let output = run(args);
    assert_eq!(output.status.code(), Some(code), "{args:?}");
    assert!(output.stdout.is_empty(), "{args:?}");
    String::from_utf8(output.stderr).expect("text")
}

#[test]
fn formulas_are_explained() {
    let text = explained(&["x^2+y^2-1", "--derive", "x", "--derive", "xy", "--at", "1,2,3", "--at=-1,0,0"]);
    assert_eq!(
        text,
        "x^2 + y^2 - 1\n  4 operations in x and y, a polynomial of degree 2\n\
         derivative by x\n  2 * x\n\
         derivative by xy\n  0\n\
         at (1, 2, 3)\n  value     4\n  gradient  (2, 4, 0), 4.472135955 long\n  by x      2\n  by xy     0\n\
         at (-1, 0, 0)\n  value     0\n  gradient  (-2, 0, 0), 2 long\n  by x      -2\n  by xy     0\n"
    );
    let text = explained(&["-x", "--derive", "x"]);
    assert!(text.starts_with("-x\n  1 operation in x, a polynomial of degree 1\nderivative by x\n  -1\n"), "{text}");
    assert!(explained(&["2 * 3"]).starts_with("6\n  0 operations with a constant result"), "{}", explained(&["2 * 3"]));
    let text = explained(&["ln(x)", "--at", "0.5,0,0", "--at=-1,0,0"]);
    assert!(
        text.contains("value     -0.6931471806\n")
            && text.contains("at (-1, 0, 0)\n  value     none\n  gradient  (none, none, none)"),
        "{text}"
    );
}

/// The numbers after a word in a line, which has others before.
fn numbers(text: &str, word: &str) -> Vec<f64> {
    let line = text.lines().find_map(|line| line.split_once(word)).expect("the word");
    line.1.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn ranges_hold_all_values_and_little_else() {
    for (formula, region, least, most, slope) in [
        ("x^2 - x", "0..1,0,0", -0.25, 0.0, 1.0),
        ("x*y - z", "0..1,-1..1,0.5", -1.5, 0.5, 3.0_f64.sqrt()),
        ("sin(x) + cos(y)", "-1..1", 0.5403023 - 0.841471, 1.841471, (1.0 + 0.841471_f64.powi(2)).sqrt()),
        ("hypot(x, y, z)", "1..2", 3.0_f64.sqrt(), 12.0_f64.sqrt(), 1.0),
    ] {
        let text = explained(&[formula, "--over", region]);
        let values = numbers(&text, "values");
        assert!(values[0] <= least + 1e-6 && values[1] >= most - 1e-6, "{text}");
        assert!(values[1] - values[0] < 1.01 * (most - least), "{text}");
        let found = numbers(&text, "slope")[0];
        assert!(found >= slope - 1e-6 && found < 1.3 * slope, "{text}");
    }
    assert!(explained(&["floor(x)", "--over", "-1..1"]).contains("slope     without a bound"));
}

#[test]
fn mistakes_have_their_place() {
    let text = refused(&["x + sinn(y)"], 1);
    assert!(text.contains("\n  | x + sinn(y)\n  |     ^^^^\n  = help: "), "{text}");
    let text = refused(&["r = hypot(x, y);\nr - k"], 1);
    assert!(text.contains("\n  | r - k\n  |     ^"), "{text}");
    assert!(refused(&["x", "--derive", "w"], 2).contains("write x, y or z"));
    assert!(refused(&["x", "--at", "1,2"], 2).contains("write three numbers, such as 1,2,3"));
    assert!(refused(&["x", "--at", "1,b,2"], 2).contains("\"b\" is no number"));
    assert!(refused(&["x", "--over", "2..1"], 2).contains("goes down"));
    assert!(refused(&["x", "--over", "0..1,0..1"], 2).contains("write a range for all coordinates"));
}
