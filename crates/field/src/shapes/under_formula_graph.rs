//! Area between the graph of a formula in x and a line along x. Its border becomes arcs that are proven to be within a tolerance, from
//! which the distance is exact.

use super::formula_graph::{F, check_graph};
use super::graph::{FROM, TO};
use super::outline::Outline;
use super::under_graph::{BASE, TOLERANCE, base_line};
use crate::graphs::Graph;
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`under_formula_graph`].
#[derive(Clone, Copy, Debug)]
pub struct UnderFormulaGraph;

/// The descriptor of [`under_formula_graph`].
pub static UNDER_FORMULA_GRAPH: Shape = Shape::special::<UnderFormulaGraph>();

/// All that lies between `y = f(x)` and the axis, for a formula in x, and for x between two values. `with("base", ...)` moves the axis
/// along y.
#[track_caller]
pub fn under_formula_graph(from: impl Into<Value>, to: impl Into<Value>, formula: &str) -> Form<UnderFormulaGraph> {
    let characters = formula.chars().map(|c| Value::from(u32::from(c)));
    Form::new(&UNDER_FORMULA_GRAPH, [from.into(), to.into(), 0.into()].into_iter().chain(characters))
}

fn arguments(args: &[f64]) -> Result<Vec<f64>, String> {
    let &[from, to, base, ref codes @ ..] = args else { unreachable!("four numbers at least") };
    let graph = Graph::new(codes, [from, to])?;
    let heights = graph.heights().map(|height| (height - base).abs()).filter(|height| height.is_finite());
    let tolerance = heights.fold(to - from, f64::max) * TOLERANCE;
    let arcs = graph.arcs(tolerance)?;
    if arcs.iter().all(|arc| arc.from.y == base && arc.to.y == base && arc.half_turn() == 0.0) {
        return Err("surrounds nothing: its graph lies on its base".into());
    }
    let mut lines = base_line([from, to], base, arcs[0].from.truncate(), tolerance);
    lines.along(arcs);
    Ok(lines.finish())
}

impl Special for UnderFormulaGraph {
    type General = Outline;

    const ABOUT: About = About {
        name: "under_formula_graph",
        summary: "A plane figure: all between the graph of a formula in x and the x axis, on either side of it.",
        params: &[FROM, TO, BASE, F],
        elsewhere: &["area under a curve", "function graph", "y < f(x)"],
        example: r#"{ "revolve": { "shape": { "rotate": { "axis": "z", "angle": 90, "shape": { "under_formula_graph": { "from": -1, "to": 1,
            "f": "-0.35 - 0.2 * sin(4 * x) - 0.05 * cos(23 * x)" } } } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        check_graph("under_formula_graph", [args[0], args[1]], args, Self::general, arguments)
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("under_formula_graph", args, || arguments(args).unwrap_or_default())
    }
}
