//! Ellipsoid by scaling a unit ball. A bound, much cheaper than the exact distance.

use super::ellipsoid::RADII;
use crate::shape_prelude::*;

/// See [`ellipsoid_bound`].
#[derive(Clone, Copy, Debug)]
pub struct EllipsoidBound;

/// The descriptor of [`ellipsoid_bound`].
pub static ELLIPSOID_BOUND: Shape = Shape::primitive::<EllipsoidBound>();

/// An ellipsoid with these radii along x, y and z; its field is a stretched ball's times the smallest radius.
#[track_caller]
pub fn ellipsoid_bound(radii: impl Into<Triple>) -> Form<EllipsoidBound> {
    Form::new(&ELLIPSOID_BOUND, radii.into().0)
}

impl Primitive for EllipsoidBound {
    const ABOUT: About = About {
        name: "ellipsoid_bound",
        summary: "An ellipsoid whose field is only a bound, for speed.",
        params: &[RADII],
        elsewhere: &["stretched sphere"],
        example: r#"{ "ellipsoid_bound": { "radii": [1, 0.6, 0.4] } }"#,
    };

    fn prepare(args: &[f64]) -> Vec<f64> {
        let radii = DVec3::from_slice(args);
        let inverse = radii.recip();
        vec![inverse.x, inverse.y, inverse.z, radii.min_element()]
    }

    fn contract(_args: &[f64]) -> Contract {
        Contract::BOUND
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let radii = DVec3::from_slice(args);
        (radii * direction).length() * (1.0 + level / radii.min_element())
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [x, y, z, smallest] = c.get();
        (S::length3(p.x * x, p.y * y, p.z * z) - p.x.lift(1.0)) * smallest
    }
}
