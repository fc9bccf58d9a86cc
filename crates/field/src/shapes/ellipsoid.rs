//! Ellipsoid. Exact, by iteration to the foot point.
//!
//! The foot point of y on the ellipsoid with radii a lies at x_i = a_i^2 y_i / (t + a_i^2) for the largest root t of
//! sum (a_i y_i / (t + a_i^2))^2 = 1 (Eberly, "Distance from a Point to an Ellipse, an Ellipse, or a Hyperellipse",
//! 2013). We solve for s = t + min a_i^2 by Newton's method on 1/N(s) - 1, N being the square root of that sum: the
//! secular function of trust-region methods (Moré and Sorensen, "Computing a Trust Region Step", 1983), which is concave
//! and almost linear. From a start with N >= 1 the iteration rises to the root and needs few steps.
//! The distance is t |x_i / a_i^2|, whose sign is that of t, and which is smooth across the surface.

use crate::shape_prelude::*;

/// See [`ellipsoid`].
#[derive(Clone, Copy, Debug)]
pub struct Ellipsoid;

/// The descriptor of [`ellipsoid`].
pub static ELLIPSOID: Shape = Shape::primitive::<Ellipsoid>();

/// An ellipsoid with these radii along x, y and z.
#[track_caller]
pub fn ellipsoid(radii: impl Into<Triple>) -> Form<Ellipsoid> {
    Form::new(&ELLIPSOID, radii.into().0)
}

/// The parameter of both ellipsoids.
pub(crate) const RADII: Param =
    Param::required("radii", ParamKind::Size, "Distances from the centre to the surface along x, y and z.");

/// More steps than any point within the supported ratio of radii was found to need (the tests count them).
pub(crate) const MAX_STEPS: u32 = 16;

/// Another step is taken while N differs from 1 by more than this; convergence is quadratic, so that the last step leaves
/// the square of it, and about this much of it in the derivative.
pub(crate) const RESIDUAL: f64 = 1e-6;

/// Points nearer to a plane of symmetry than this share of the smallest radius are moved off it, where the foot point is
/// not unique. It is a few units in the last place of single precision.
pub(crate) const OFF_PLANE: f64 = 1e-6;

/// The largest ratio between two radii.
pub(crate) const MAX_RATIO: f64 = 1e3;

impl Primitive for Ellipsoid {
    const ABOUT: About = About {
        name: "ellipsoid",
        summary: "An ellipsoid around the origin; its radii may differ by a factor of 1000.",
        params: &[RADII],
        elsewhere: &["sdEllipsoid (which is only a bound)"],
        example: r#"{ "ellipsoid": { "radii": [1, 0.6, 0.4] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let radii = DVec3::from_slice(args);
        if radii.max_element() > MAX_RATIO * radii.min_element() {
            return Err(format!("the radii of an ellipsoid must not differ by more than a factor of {MAX_RATIO}"));
        }
        Ok(())
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        let radii = DVec3::from_slice(args);
        let smallest = radii.min_element();
        let excess = radii * radii - smallest * smallest;
        vec![radii.x, radii.y, radii.z, excess.x, excess.y, excess.z, smallest * smallest, smallest * OFF_PLANE]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        (DVec3::from_slice(args) * direction).length() + level * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [ax, ay, az, ex, ey, ez, smallest_squared, off_plane] = c.get();
        let (x, y, z) = (p.x.abs().max(off_plane), p.y.abs().max(off_plane), p.z.abs().max(off_plane));
        let (wx, wy, wz) = (ax * x, ay * y, az * z);
        let one = p.x.lift(1.0);

        let start = (wx - ex).max(wy - ey).max(wz - ez);
        let [s] = S::iterate(
            MAX_STEPS,
            [start],
            #[inline(always)]
            |[s]| {
                let (ix, iy, iz) = (one / (s + ex), one / (s + ey), one / (s + ez));
                let (ux, uy, uz) = ((wx * ix).square(), (wy * iy).square(), (wz * iz).square());
                let n_squared = ux + uy + uz;
                let residual = n_squared.sqrt() - one;
                let slope = ux * ix + uy * iy + uz * iz;
                ([s + residual * n_squared / slope], one.lift(RESIDUAL).lt(residual))
            },
        );
        let normal = S::length3(x / (s + ex), y / (s + ey), z / (s + ez));
        (s - smallest_squared) * normal
    }
}
