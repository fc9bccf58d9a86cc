//! Elongation: a shape cut through its middle, with its halves moved apart and the gap filled. A bound.
//!
//! The map shortens distances, so that the result is never larger than the distance. It is the distance where the child is convex
//! and symmetric, since the nearest point then lies on the same side of the cut.

use crate::shape_prelude::*;

/// See [`Elongate::elongate`].
#[derive(Clone, Copy, Debug)]
pub struct Elongation;

/// The descriptor of [`Elongate::elongate`].
pub static ELONGATE: Shape = Shape::map::<Elongation>();

/// Stretching the middle of a shape.
pub trait Elongate: Into<Field> {
    /// The shape cut at the origin across each axis, with its halves moved apart by `by` in all, and the gap filled with the
    /// cross-section.
    #[track_caller]
    fn elongate(self, by: impl Into<Triple>) -> Field {
        Field::new(&ELONGATE, by.into().0, [self.into()])
    }
}

impl<F: Into<Field>> Elongate for F {}

impl Map for Elongation {
    const ABOUT: About = About {
        name: "elongate",
        summary: "Cuts a shape through the origin, moves the halves apart and fills the gap with the cross-section.",
        params: &[Param::required(
            "by",
            ParamKind::Lengths,
            "How far the halves are moved apart in all, along x, y and z; not negative.",
        )],
        elsewhere: &["opElongate", "stretch middle"],
        example: r#"{ "elongate": { "by": [0.8, 0.3, 0], "shape": { "torus": { "major": 0.5, "minor": 0.2 } } } }"#,
    };

    const IS_PLANAR: bool = true;

    fn prepare(args: &[f64]) -> Vec<f64> {
        args.iter().map(|by| by / 2.0).collect()
    }

    fn contract(args: &[f64], child: Contract, _reach: Supports<'_>) -> Result<Contract, String> {
        Ok(if args.iter().all(|&by| by == 0.0) { child } else { child.at_most_bound() })
    }

    fn support(args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        reach(direction) + (DVec3::from_slice(args) / 2.0).dot(direction.abs())
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [x, y, z] = c.get();
        vec3(apart(p.x, x), apart(p.y, y), apart(p.z, z))
    }
}

/// A coordinate after the gap of this half width is closed.
#[inline(always)]
fn apart<S: Scalar>(p: S, half: S) -> S {
    let zero = p.lift(0.0);
    (p - half).max(zero) + (p + half).min(zero)
}
