//! Ellipse in the plane. Exact, by iteration to the foot point, in the way of the ellipsoid.

use super::ellipsoid::{MAX_RATIO, MAX_STEPS, OFF_PLANE, RESIDUAL};
use crate::shape_prelude::*;

/// See [`ellipse`].
#[derive(Clone, Copy, Debug)]
pub struct Ellipse;

/// The descriptor of [`ellipse`].
pub static ELLIPSE: Shape = Shape::primitive::<Ellipse>();

/// A filled ellipse around the origin of the plane, with these radii along x and y.
#[track_caller]
pub fn ellipse(x: impl Into<Value>, y: impl Into<Value>) -> Form<Ellipse> {
    Form::new(&ELLIPSE, [x.into(), y.into()])
}

impl Primitive for Ellipse {
    const ABOUT: About = About {
        name: "ellipse",
        summary: "A plane figure: an ellipse around the origin; its radii may differ by a factor of 1000.",
        params: &[Param::required("radii", ParamKind::Size2, "Distances from the centre to the edge along x and y.")],
        elsewhere: &["sdEllipse", "oval"],
        example: r#"{ "extrude": { "height": 0.5, "shape": { "ellipse": { "radii": [1, 0.6] } } } }"#,
    };

    const DIMENSION: Dimension = Dimension::Plane;

    fn check(args: &[f64]) -> Result<(), String> {
        if args[0].max(args[1]) > MAX_RATIO * args[0].min(args[1]) {
            return Err(format!("the radii of an ellipse must not differ by more than a factor of {MAX_RATIO}"));
        }
        Ok(())
    }

    /// The radii, by how much their squares exceed that of the smaller one, that square, and how near to an axis points may lie.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let &[x, y] = args else { unreachable!("two numbers") };
        let smaller = x.min(y);
        let square = smaller * smaller;
        vec![x, y, x * x - square, y * y - square, square, smaller * OFF_PLANE]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        in_plane(direction, |across| libm::hypot(args[0] * direction.x, args[1] * direction.y) + level * across)
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [ax, ay, ex, ey, smaller_squared, off_axis] = c.get();
        let (x, y) = (p.x.abs().max(off_axis), p.y.abs().max(off_axis));
        let (wx, wy) = (ax * x, ay * y);
        let one = p.x.lift(1.0);

        let start = (wx - ex).max(wy - ey);
        let [s] = S::iterate(
            MAX_STEPS,
            [start],
            #[inline(always)]
            |[s]| {
                let (ix, iy) = (one / (s + ex), one / (s + ey));
                let (ux, uy) = ((wx * ix).square(), (wy * iy).square());
                let n_squared = ux + uy;
                let residual = n_squared.sqrt() - one;
                let slope = ux * ix + uy * iy;
                ([s + residual * n_squared / slope], one.lift(RESIDUAL).lt(residual))
            },
        );
        (s - smaller_squared) * S::length2(x / (s + ex), y / (s + ey))
    }
}
