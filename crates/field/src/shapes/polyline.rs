//! Line along points of the plane, with a width, and round joints and ends: a tube in the plane. Exact outside.

use super::tube::{Tube, Wire};
use crate::shape_prelude::*;

/// All that a disc fills while it moves along straight edges and arcs of the plane: what lines of all kinds are cases of. Its
/// arguments are those of the tube around them.
#[derive(Clone, Copy, Debug)]
pub struct Stroke;

impl Primitive for Stroke {
    const ABOUT: About =
        About { name: "stroke", summary: "A line along arcs of the plane.", params: &[], elsewhere: &[], example: "" };

    const DIMENSION: Dimension = Dimension::Plane;

    fn contract(args: &[f64]) -> Contract {
        Wire::contract(args)
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        in_plane(direction, |_| Wire::support(args, direction, level))
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        Wire::distance(vec3(p.x, p.y, p.z.lift(0.0)), c)
    }
}

/// See [`polyline`].
#[derive(Clone, Copy, Debug)]
pub struct Polyline;

/// The descriptor of [`polyline`].
pub static POLYLINE: Shape = Shape::special::<Polyline>();

/// All that a disc of this width fills while its middle moves from point to point. `with("closed", ...)` leads from the last one
/// back to the first.
#[track_caller]
pub fn polyline<V: Into<Value>>(width: impl Into<Value>, points: impl IntoIterator<Item = [V; 2]>) -> Form<Polyline> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&POLYLINE, [width.into(), 0.into()].into_iter().chain(points))
}

/// The arguments of the tube around the line.
fn tube(args: &[f64]) -> Vec<f64> {
    let points = args[2..].chunks_exact(2).flat_map(|point| [point[0], point[1], 0.0]);
    [args[0] / 2.0, args[1]].into_iter().chain(points).collect()
}

impl Special for Polyline {
    type General = Stroke;

    const ABOUT: About = About {
        name: "polyline",
        summary: "A plane figure: a line of some width from point to point, with round joints and ends.",
        params: &[
            Param::required("width", ParamKind::Positive, "Full width of the line."),
            Param::optional("closed", ParamKind::Flag, &[0.0], "Whether the last point is joined to the first."),
            Param::required("points", ParamKind::Points2, "The points [x, y], one after another: two at least."),
        ],
        elsewhere: &["segment", "stroke", "line2", "sdSegment", "oriented_rect with round ends"],
        example: r#"{ "extrude": { "height": 0.3, "shape": { "polyline": { "width": 0.25, "points":
            [[-0.9, -0.5], [-0.5, 0.6], [0, -0.5], [0.5, 0.6], [0.9, -0.5]] } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        Tube::check(&tube(args)).map_err(|fault| fault.replace("`tube`", "`polyline`"))
    }

    fn general(args: &[f64]) -> Vec<f64> {
        Tube::general(&tube(args))
    }
}
