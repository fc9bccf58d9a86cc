//! Line along the graph of a polynomial, with a width and round ends. It becomes arcs within a tolerance; the distance from these
//! is exact outside.

use super::polyline::Stroke;
use super::tube::{TOLERANCE, along};
use crate::arcs3::of_curve;
use crate::curve::Bezier;
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`graph`].
#[derive(Clone, Copy, Debug)]
pub struct Graph;

/// The descriptor of [`graph`].
pub static GRAPH: Shape = Shape::special::<Graph>();

/// A line of some width along `y = c0 + c1 x + c2 x^2 + ...` between two values of x.
#[track_caller]
pub fn graph<V: Into<Value>>(
    width: impl Into<Value>,
    from: impl Into<Value>,
    to: impl Into<Value>,
    coefficients: impl IntoIterator<Item = V>,
) -> Form<Graph> {
    let before = [width.into(), from.into(), to.into()];
    Form::new(&GRAPH, before.into_iter().chain(coefficients.into_iter().map(Into::into)))
}

/// Of higher degrees, coefficients by powers say too little in double precision.
const MOST_DEGREE: usize = 20;

/// The parameters that say which graph it is.
pub(crate) const FROM: Param = Param::required("from", ParamKind::Number, "Where it begins along x.");
pub(crate) const TO: Param = Param::required("to", ParamKind::Number, "Where it ends along x, above `from`.");
pub(crate) const COEFFICIENTS: Param = Param::required(
    "coefficients",
    ParamKind::Numbers,
    "What the powers of x are multiplied by, from the constant on: [1, 0, -2] is 1 - 2 x^2. At most 21.",
);

/// What is wrong with the ends of a graph.
///
/// # Errors
/// The fault.
pub(crate) fn check_ends(name: &str, [from, to]: [f64; 2]) -> Result<(), String> {
    if to > from { Ok(()) } else { Err(format!("`to` of `{name}` is not above `from`")) }
}

/// What is wrong with a graph.
///
/// # Errors
/// The fault.
pub(crate) fn check(name: &str, ends: [f64; 2], coefficients: &[f64]) -> Result<(), String> {
    check_ends(name, ends)?;
    if coefficients.len() > MOST_DEGREE + 1 {
        return Err(format!(
            "`{name}` has {} coefficients; at most {} are possible",
            coefficients.len(),
            MOST_DEGREE + 1
        ));
    }
    Ok(())
}

/// The graph as a Bézier curve, which moves evenly along x.
pub(crate) fn curve([from, to]: [f64; 2], coefficients: &[f64]) -> Bezier<DVec3> {
    let degree = (coefficients.len() - 1).max(1);
    // By the share of the way from one end to the other, of which x is a polynomial of degree 1 (Horner's scheme).
    let mut powers = vec![0.0; degree + 1];
    for &coefficient in coefficients.iter().rev() {
        for index in (0..=degree).rev() {
            let below = if index > 0 { powers[index - 1] * (to - from) } else { coefficient };
            powers[index] = powers[index] * from + below;
        }
    }
    // A power of the share is a mean of as many control points as there are ways to choose them.
    let chosen = |from: usize, count: usize| (0..count).map(|i| (from - i) as f64 / (i + 1) as f64).product::<f64>();
    let height = |point: usize| -> f64 {
        (0..=point).map(|power| powers[power] * chosen(point, power) / chosen(degree, power)).sum()
    };
    let place = |point: usize| from + (to - from) * point as f64 / degree as f64;
    Bezier::new((0..=degree).map(|point| DVec3::new(place(point), height(point), 0.0)).collect())
}

impl Special for Graph {
    type General = Stroke;

    const ABOUT: About = About {
        name: "graph",
        summary: "A plane figure: a line of some width along the graph of a polynomial.",
        params: &[Param::required("width", ParamKind::Positive, "Full width of the line."), FROM, TO, COEFFICIENTS],
        elsewhere: &["function graph", "plot", "y = f(x)"],
        example: r#"{ "extrude": { "height": 0.6, "shape": { "graph": { "width": 0.08, "from": -1.1, "to": 1.1, "coefficients": [-0.2, -1.2, 0.6,
            1.2] } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        check("graph", [args[1], args[2]], &args[3..])
    }

    fn general(args: &[f64]) -> Vec<f64> {
        remembered("graph", args, || {
            let curve = curve([args[1], args[2]], &args[3..]);
            along(args[0] / 2.0, of_curve(&curve, args[0] / 2.0 * TOLERANCE))
        })
    }
}
