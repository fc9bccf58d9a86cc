//! Area between the graph of a polynomial and a line along x. Its border becomes arcs within a tolerance, from which the distance is
//! exact.

use super::graph::{COEFFICIENTS, FROM, TO, check, curve};
use super::outline::Outline;
use crate::arcs::Lines;
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`under_graph`].
#[derive(Clone, Copy, Debug)]
pub struct UnderGraph;

/// The descriptor of [`under_graph`].
pub static UNDER_GRAPH: Shape = Shape::special::<UnderGraph>();

/// All that lies between `y = c0 + c1 x + c2 x^2 + ...` and the axis, for x between two values. `with("base", ...)` moves the axis
/// along y.
#[track_caller]
pub fn under_graph<V: Into<Value>>(
    from: impl Into<Value>,
    to: impl Into<Value>,
    coefficients: impl IntoIterator<Item = V>,
) -> Form<UnderGraph> {
    let before = [from.into(), to.into(), 0.into()];
    Form::new(&UNDER_GRAPH, before.into_iter().chain(coefficients.into_iter().map(Into::into)))
}

/// Where the axis is that the area reaches to.
pub(crate) const BASE: Param =
    Param::optional("base", ParamKind::Number, &[0.0], "The height y of the line that takes the place of the x axis.");

/// Arcs are within this share of the figure's size from the graph.
pub(crate) const TOLERANCE: f64 = 1e-4;

/// The border of an area along its base, up to where its graph begins.
pub(crate) fn base_line([from, to]: [f64; 2], base: f64, begin: DVec2, tolerance: f64) -> Lines {
    let mut lines = Lines::new(tolerance);
    lines.move_to(DVec2::new(to, base));
    lines.line_to(DVec2::new(from, base));
    lines.line_to(begin);
    lines
}

impl Special for UnderGraph {
    type General = Outline;

    const ABOUT: About = About {
        name: "under_graph",
        summary: "A plane figure: all between the graph of a polynomial and the x axis, on either side of it.",
        params: &[FROM, TO, BASE, COEFFICIENTS],
        elsewhere: &["area under a curve", "function graph", "y < f(x)"],
        example: r#"{ "revolve": { "shape": { "rotate": { "axis": "z", "angle": 90, "shape": { "under_graph": { "from": -1, "to": 1,
            "coefficients": [-0.35, -0.5, 0.1, 0.6] } } } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        check("under_graph", [args[0], args[1]], &args[3..])?;
        if args[3] == args[2] && args[4..].iter().all(|&coefficient| coefficient == 0.0) {
            return Err("`under_graph` surrounds nothing: its graph lies on its base".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[from, to, base, ref coefficients @ ..] = args else { unreachable!("four numbers at least") };
        remembered("under_graph", args, || {
            let curve = curve([from, to], coefficients);
            let points: Vec<DVec2> = curve.points().iter().map(|point| point.truncate()).collect();
            let size = points.iter().map(|point| (point.y - base).abs()).fold(to - from, f64::max);
            let mut lines = base_line([from, to], base, points[0], size * TOLERANCE);
            lines.bezier_to(&points[1..]);
            lines.finish()
        })
    }
}
