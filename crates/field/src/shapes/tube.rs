//! Tube along straight pieces from point to point, with round joints and ends. Exact outside.

use super::capsule::segment;
use crate::shape_prelude::*;

/// See [`tube`].
#[derive(Clone, Copy, Debug)]
pub struct Tube;

/// The descriptor of [`tube`].
pub static TUBE: Shape = Shape::primitive::<Tube>();

/// All that a ball of this radius fills while its middle moves from point to point. `with("closed", ...)` leads from the last one
/// back to the first.
#[track_caller]
pub fn tube<V: Into<Value>>(radius: impl Into<Value>, points: impl IntoIterator<Item = [V; 3]>) -> Form<Tube> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&TUBE, [radius.into(), 0.into()].into_iter().chain(points))
}

/// How many arguments stand before the points.
const BEFORE: usize = 2;

/// How many constants a piece has.
const PIECE: usize = 7;

impl Primitive for Tube {
    const ABOUT: About = About {
        name: "tube",
        summary: "A round tube along straight pieces from point to point.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the tube."),
            Param::optional("closed", ParamKind::Flag, &[0.0], "Whether the last point is joined to the first."),
            Param::required("points", ParamKind::Points3, "The points [x, y, z], one after another: two at least."),
        ],
        elsewhere: &["polyline", "pipe along points", "line_strip", "wire"],
        example: r#"{ "tube": { "radius": 0.15, "points":
            [[-0.9, -0.5, -0.6], [-0.9, 0.5, 0.6], [0, -0.5, 0.6], [0.2, 0.5, -0.6], [0.9, 0, 0.6]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let points: Vec<&[f64]> = args[BEFORE..].chunks_exact(3).collect();
        if points.len() < 2 {
            return Err("`tube` has fewer than two points".into());
        }
        match points.windows(2).position(|pair| pair[0] == pair[1]) {
            Some(index) => Err(format!("point {} of `tube` and the next one are the same", index + 1)),
            None => Ok(()),
        }
    }

    /// The pieces; then the radius, as a row of its own would be: nothing but rows is read in a loop.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let points: Vec<DVec3> = args[BEFORE..].chunks_exact(3).map(DVec3::from_slice).collect();
        // From the last point back to itself, if the tube is open.
        let end = if args[1] == 0.0 { points[points.len() - 1] } else { points[0] };
        let mut constants = vec![args[0]];
        for (from, to) in points.iter().zip(points[1..].iter().chain([&end])) {
            let along = *to - *from;
            let inverse = 1.0 / along.length_squared().max(f64::MIN_POSITIVE);
            constants.extend([from.x, from.y, from.z, along.x, along.y, along.z, inverse]);
        }
        constants
    }

    fn contract(_args: &[f64]) -> Contract {
        Contract { inside: Metric::Bound, ..Contract::EXACT }
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let points = args[BEFORE..].chunks_exact(3).map(|point| direction.dot(DVec3::from_slice(point)));
        points.fold(f64::NEG_INFINITY, f64::max) + (args[0] + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let pieces = c.part(1, c.count() - 1);
        let [nearest] = S::fold_rows(
            &pieces,
            PIECE,
            [p.x.lift(f64::from(f32::MAX))],
            #[inline(always)]
            |[nearest], piece| {
                let [fx, fy, fz, ax, ay, az, inverse] = piece.get();
                [nearest.min(segment(p, vec3(fx, fy, fz), vec3(ax, ay, az), inverse))]
            },
        );
        nearest - c.at(0)
    }
}
