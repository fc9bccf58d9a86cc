//! `freikugel formula`: what a formula means: simplified, derived, at points and over boxes.

use super::given::Given;
use super::info::count;
use super::{Failure, print};
use freikugel::field::formula::{Formula, FormulaError, Term};
use freikugel::field::{Dual, Form, Interval, Program, Structure, shapes};
use glam::DVec3;
use std::fmt::Write;

const EXAMPLES: &str = "\
Examples:
  freikugel formula \"x^2 + y^2 - 1\" --derive x --at 1,2,3
  freikugel formula \"sin(x) / x\" --derive x --derive xx --at 0.5,0,0 --at 1,0,0
  freikugel formula \"r = hypot(x, y); hypot(r - 2, z) - 0.5\" --over -3..3
  freikugel formula \"x*y - z\" --over 0..1,-1..1,0.5
  freikugel formula \"length(p - vec(sin(t), 0, 0)) - radius\" --set radius=2 --time 0.5";

/// The names of the coordinates.
const COORDINATES: [char; 3] = ['x', 'y', 'z'];

/// Longer results of derivations are shown by their beginnings and sizes.
const LONGEST: usize = 2000;

/// Explain a formula: simplified, its derivatives, its values at points, and its range over boxes.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The formula, in x, y and z, as in a scene.
    #[arg(allow_hyphen_values = true)]
    formula: String,
    #[command(flatten)]
    given: Given,
    /// Show a derivative: by x, y or z; several letters for one after another.
    #[arg(long, value_name = "XYZ", value_parser = parse_derivative)]
    derive: Vec<Axes>,
    /// Show values at a point.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_point)]
    at: Vec<DVec3>,
    /// Show what values lie between over a box, and how steep they are: a range FROM..TO for all coordinates, or three ranges
    /// or numbers.
    #[arg(long, value_name = "RANGES", allow_hyphen_values = true, value_parser = parse_box)]
    over: Vec<Region>,
}

/// The coordinates that a formula is derived by, one after another.
#[derive(Clone, Debug)]
struct Axes(Vec<usize>);

/// A box by its sides.
#[derive(Clone, Copy, Debug)]
struct Region([Interval; 3]);

fn parse_derivative(text: &str) -> Result<Axes, String> {
    let axis = |letter: char| COORDINATES.iter().position(|&name| name == letter);
    match text.chars().map(axis).collect::<Option<Vec<usize>>>() {
        Some(axes) if !axes.is_empty() => Ok(Axes(axes)),
        _ => Err("write x, y or z, or several of them, such as xx or xy".into()),
    }
}

fn number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| format!("{text:?} is no number"))
}

fn parse_point(text: &str) -> Result<DVec3, String> {
    let numbers = text.split(',').map(number).collect::<Result<Vec<f64>, String>>()?;
    let point: [f64; 3] = numbers.try_into().map_err(|_| "write three numbers, such as 1,2,3")?;
    Ok(point.into())
}

fn parse_box(text: &str) -> Result<Region, String> {
    let side = |text: &str| {
        let (from, to) = text.split_once("..").unwrap_or((text, text));
        let (from, to) = (number(from)?, number(to)?);
        if from <= to { Ok(Interval::new(from, to)) } else { Err(format!("{text:?} goes down")) }
    };
    let sides = text.split(',').map(side).collect::<Result<Vec<Interval>, String>>()?;
    match *sides {
        [side] => Ok(Region([side; 3])),
        [x, y, z] => Ok(Region([x, y, z])),
        _ => Err("write a range for all coordinates, such as -1..1, or three, such as -1..1,0..2,0".into()),
    }
}

/// Explains a formula.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let formula = Formula::parse_with(&arguments.formula, &arguments.given.names())
        .map_err(|error| Failure::Input(pointed(&arguments.formula, &error)))?;
    let derivatives: Vec<(String, Formula)> = arguments.derive.iter().map(|axes| derivative(&formula, axes)).collect();
    let mut text = String::new();
    let _ = writeln!(text, "{}\n  {}", shown(&formula), kind(&formula));
    for (name, derivative) in &derivatives {
        let _ = writeln!(text, "derivative by {name}\n  {}", shown(derivative));
    }
    for &point in &arguments.at {
        at(&formula, &derivatives, point, &mut text);
    }
    if !arguments.over.is_empty() {
        let field = Form::<shapes::Formula>::from(formula).into();
        let structure = Structure::compile(&[field]).map_err(|faults| {
            Failure::Input(faults.iter().map(ToString::to_string).collect::<Vec<String>>().join("\n"))
        })?;
        let program = structure.program(DVec3::ZERO);
        arguments.over.iter().for_each(|region| over(&program, region, &mut text));
    }
    print(&text)
}

fn derivative(formula: &Formula, Axes(axes): &Axes) -> (String, Formula) {
    let derivative = axes.iter().fold(formula.clone(), |formula, &axis| formula.derivative(axis));
    (axes.iter().map(|&axis| COORDINATES[axis]).collect(), derivative)
}

/// What a formula is made of, in a few words.
fn kind(formula: &Formula) -> String {
    let used: Vec<&str> =
        ["x", "y", "z"].into_iter().enumerate().filter(|(axis, _)| formula.uses(*axis)).map(|(_, name)| name).collect();
    let inputs = match &*used {
        [] => "with a constant result".to_owned(),
        [one] => format!("in {one}"),
        [rest @ .., last] => format!("in {} and {last}", rest.join(", ")),
    };
    let is_operation = |term: &&Term| !matches!(term, Term::Input(_) | Term::Literal(_));
    let operations = count(formula.terms().iter().filter(is_operation).count(), "operation");
    let degree = formula.polynomial().map(|polynomial| format!(", a polynomial of degree {}", polynomial.degree()));
    format!("{operations} {inputs}{}", degree.unwrap_or_default())
}

/// A formula as it prints; the beginning of one that is long.
fn shown(formula: &Formula) -> String {
    let text = formula.to_string();
    match text.char_indices().nth(LONGEST) {
        None => text,
        Some((end, _)) => format!("{}... ({} terms)", &text[..end], formula.terms().len()),
    }
}

/// A number as people write it: without the last digits, which are those of rounding.
fn brief(number: f64) -> String {
    if number.is_nan() {
        return "none".into();
    }
    // Not a negative 0.
    format!("{}", format!("{number:.9e}").parse::<f64>().unwrap_or(number) + 0.0)
}

fn triple(v: DVec3) -> String {
    format!("({}, {}, {})", brief(v.x), brief(v.y), brief(v.z))
}

fn at(formula: &Formula, derivatives: &[(String, Formula)], point: DVec3, text: &mut String) {
    let dual = formula.eval([0, 1, 2].map(|axis| Dual::input(point[axis], axis)).into());
    // Where there is no value, there is no slope, whatever the derivatives are there.
    let gradient = if dual.value.is_nan() { DVec3::NAN } else { dual.gradient.into() };
    let _ = writeln!(text, "at {}\n  value     {}", triple(point), brief(dual.value));
    let _ = writeln!(text, "  gradient  {}, {} long", triple(gradient), brief(gradient.length()));
    for (name, derivative) in derivatives {
        let _ = writeln!(text, "  by {name:<6} {}", brief(derivative.value(point.to_array())));
    }
}

fn over(program: &Program, Region(region): &Region, text: &mut String) {
    let side = |(name, side): (char, Interval)| {
        if side.width() > 0.0 {
            format!("{name} {} to {}", brief(side.lo()), brief(side.hi()))
        } else {
            format!("{name} {}", brief(side.lo()))
        }
    };
    let sides: Vec<String> = COORDINATES.into_iter().zip(*region).map(side).collect();
    let values = program.range_over(*region);
    let _ = writeln!(text, "over {}\n  values    {} to {}", sides.join(", "), brief(values.lo()), brief(values.hi()));
    let _ = match program.lipschitz_over(*region) {
        Some(slope) => writeln!(text, "  slope     at most {}", brief(slope)),
        None => writeln!(text, "  slope     without a bound"),
    };
}

/// A mistake with the line it is in, and its place marked.
fn pointed(formula: &str, error: &FormulaError) -> String {
    let start = formula[..error.span.start].rfind('\n').map_or(0, |end| end + 1);
    let line = formula[start..].lines().next().unwrap_or_default();
    let before = formula[start..error.span.start].chars().count();
    let marked = formula[error.span.clone()].lines().next().unwrap_or_default().chars().count().max(1);
    let mut text = format!("{}\n  |\n  | {line}\n  | {:before$}{}", error.message, "", "^".repeat(marked));
    if let Some(hint) = &error.hint {
        let _ = write!(text, "\n  = help: {hint}");
    }
    text
}
