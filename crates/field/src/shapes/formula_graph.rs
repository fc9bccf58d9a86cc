//! Line along the graph of a formula in x, with a width and round ends. It becomes arcs that are proven to be within a tolerance; the
//! distance from these is exact outside.

use super::graph::{FROM, TO, check_ends};
use super::polyline::Stroke;
use super::tube::{TOLERANCE, along};
use crate::graphs::Graph;
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`formula_graph`].
#[derive(Clone, Copy, Debug)]
pub struct FormulaGraph;

/// The descriptor of [`formula_graph`].
pub static FORMULA_GRAPH: Shape = Shape::special::<FormulaGraph>();

/// A line of some width along `y = f(x)`, for a formula in x, between two values of x.
#[track_caller]
pub fn formula_graph(
    width: impl Into<Value>,
    from: impl Into<Value>,
    to: impl Into<Value>,
    formula: &str,
) -> Form<FormulaGraph> {
    let characters = formula.chars().map(|c| Value::from(u32::from(c)));
    Form::new(&FORMULA_GRAPH, [width.into(), from.into(), to.into()].into_iter().chain(characters))
}

/// The formula.
pub(crate) const F: Param = Param::required(
    "f",
    ParamKind::Text,
    "The height y as a formula in x, such as `\"sin(3 * x) / 2\"`. It must have a value, and no jump, from one end to the other.",
);

/// What is wrong with the graph of a formula between two ends, given how its arguments are made, and how they are remembered: as none if
/// something is.
///
/// # Errors
/// The fault.
pub(crate) fn check_graph(
    name: &str,
    ends: [f64; 2],
    args: &[f64],
    remembered: fn(&[f64]) -> Vec<f64>,
    made: fn(&[f64]) -> Result<Vec<f64>, String>,
) -> Result<(), String> {
    check_ends(name, ends)?;
    if !remembered(args).is_empty() {
        return Ok(());
    }
    made(args).map(|_| ()).map_err(|fault| format!("`f` of `{name}` {fault}"))
}

fn arguments(args: &[f64]) -> Result<Vec<f64>, String> {
    let graph = Graph::new(&args[3..], [args[1], args[2]])?;
    Ok(along(args[0] / 2.0, graph.arcs(args[0] / 2.0 * TOLERANCE)?))
}

impl Special for FormulaGraph {
    type General = Stroke;

    const ABOUT: About = About {
        name: "formula_graph",
        summary: "A plane figure: a line of some width along the graph of a formula in x.",
        params: &[Param::required("width", ParamKind::Positive, "Full width of the line."), FROM, TO, F],
        elsewhere: &["function graph", "plot", "y = f(x)"],
        example: r#"{ "extrude": { "height": 0.5, "shape": { "formula_graph": { "width": 0.06, "from": -1.2, "to": 1.2,
            "f": "0.7 * exp(-2 * x^2) * cos(12 * x)" } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        check_graph("formula_graph", [args[1], args[2]], args, Self::general, arguments)
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("formula_graph", args, || arguments(args).unwrap_or_default())
    }
}
