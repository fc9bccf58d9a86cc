//! Figure within one branch of a hyperbola, up to a height. Exact, by iteration to the foot point.
//!
//! In units of the radius of curvature at the vertex the branch is h(s) = s^2 / (1 + q) with q = sqrt(1 + f s^2), where f is that
//! radius over the distance of the vertex from the hyperbola's centre; f = 0 makes it a parabola. At the foot point of (x, v) g(s)
//! = s - x + s (h - v) / q vanishes. Beyond the height of the centre g is convex in s >= 0, below it concave, so that Newton's
//! method neither misses nor passes the root if it starts on the right side of it: from the asymptote, which lies farther out, or
//! nearer below the centre; or from bounds for the cubic that g is near the vertex. The way from the foot point is measured along
//! the normal there, so that an error of the foot point counts only by its square.

use crate::shape_prelude::*;

/// See [`hyperbola`].
#[derive(Clone, Copy, Debug)]
pub struct Hyperbola;

/// The descriptor of [`hyperbola`].
pub static HYPERBOLA: Shape = Shape::primitive::<Hyperbola>();

/// A figure that opens upwards within a branch of a hyperbola: with this full width and height, and this radius of curvature at its
/// vertex. Its box is centred at the origin.
#[track_caller]
pub fn hyperbola(width: impl Into<Value>, height: impl Into<Value>, radius: impl Into<Value>) -> Form<Hyperbola> {
    Form::new(&HYPERBOLA, [width.into(), height.into(), radius.into()])
}

/// The radius of curvature at the vertex of the parabola with this full width and height.
pub(crate) fn radius_of_parabola(width: f64, height: f64) -> f64 {
    width * width / (8.0 * height)
}

/// Newton's method took at most so many steps in double precision, from any of a million points and for all hyperbolas tried.
const MAX_STEPS: u32 = 8;

/// Another step is taken while one moves the foot point by more than this share of its distance from the axis; convergence is
/// quadratic.
const RESIDUAL: f64 = 1e-4;

/// Points nearer to the axis than this, in radii of curvature, are moved off it, where the foot point is not unique. It is a few
/// units in the last place of single precision.
const OFF_AXIS: f64 = 1e-6;

/// For s^2 f <= 1 the inverse of q is at most 1 - CHORD s^2 f: it is convex in s^2, so that it lies below its chord.
const CHORD: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// Keeps divisors above 0 where what is divided by them is not used.
const TINY: f64 = 1e-6;

/// The square root of the inverse of f is no larger than this, also for a parabola, whose centre is infinitely far.
const FARTHEST: f64 = 1e10;

/// The radius of curvature at the vertex over the distance of the vertex from the centre.
fn flatness(args: &[f64]) -> f64 {
    let &[width, height, radius] = args else { unreachable!("three numbers") };
    ((width * width / 4.0 - 2.0 * radius * height) / (height * height)).max(0.0)
}

impl Primitive for Hyperbola {
    const ABOUT: About = About {
        name: "hyperbola",
        summary: "A plane figure within one branch of a hyperbola, which opens upwards, up to some height.",
        params: &[
            Param::required("width", ParamKind::Positive, "Full width at the upper end."),
            Param::required("height", ParamKind::Positive, "Full height."),
            Param::required(
                "radius",
                ParamKind::Positive,
                "Radius of curvature at the vertex, the lowest point: from 0, for a triangle, to width^2 / (8 height), for a parabola.",
            ),
        ],
        elsewhere: &["sdHyperbola", "conic section"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "hyperbola": { "width": 1.8, "height": 1.6, "radius": 0.06 } } } }"#,
    };

    const DIMENSION: Dimension = Dimension::Plane;

    fn check(args: &[f64]) -> Result<(), String> {
        let most = radius_of_parabola(args[0], args[1]);
        if args[2] > most {
            return Err(format!("`radius` of `hyperbola` must not exceed {most}, that of the parabola of its size"));
        }
        Ok(())
    }

    /// The radius of curvature and its inverse; half the height; flatness, and the square root of its inverse; in radii of
    /// curvature half the width and the height.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let &[width, height, radius] = args else { unreachable!("three numbers") };
        let flatness = flatness(args);
        let far = (1.0 / flatness.sqrt()).min(FARTHEST);
        vec![radius, 1.0 / radius, height / 2.0, flatness, far, width / 2.0 / radius, height / radius]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let &[width, height, radius] = args else { unreachable!("three numbers") };
        let flatness = flatness(args);
        let (x, y) = (direction.x.abs(), direction.y);
        let corner = (x * width + y * height) / 2.0;
        // Where the branch has the slope of the direction's normal, if it gets as steep and does so below the corner.
        let steepness = (y * y - flatness * x * x).sqrt();
        let s = x / steepness;
        let on_branch = || {
            let rise = s * s / (1.0 + (1.0 + flatness * s * s).sqrt());
            x * s * radius + y * (rise * radius - height / 2.0)
        };
        let meets_branch = y < 0.0 && steepness > 0.0 && s * radius < width / 2.0;
        in_plane(direction, |across| if meets_branch { on_branch() } else { corner } + level * across)
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [radius, inverse, middle, flatness, far, half, height] = c.get();
        let (zero, one, tiny) = (p.x.lift(0.0), p.x.lift(1.0), p.x.lift(TINY));
        let x = (p.x.abs() * inverse).max(one.lift(OFF_AXIS));
        let v = (p.y + middle) * inverse;

        let above_centre = flatness * v + one;
        let asymptote = (flatness * x + above_centre * far) / (flatness + one);
        let linear = one - v;
        // A root of linear * s + cubic * s^3 = x is at most the sum of those without x and without the linear part.
        let cubic = (above_centre * CHORD).max(tiny);
        let near_vertex = ((-linear).max(tiny) / cubic).sqrt() + (x / cubic).pow(one.lift(1.0 / 3.0));
        let from_outside = S::select(near_vertex.lt(far), near_vertex.min(asymptote), asymptote);
        let from_inside = asymptote.max(x / linear.max(tiny));
        let start = S::select(zero.lt(above_centre), from_outside, from_inside);
        let [s] = S::iterate(
            MAX_STEPS,
            [start],
            #[inline(always)]
            |[s]| {
                let q = (s.square() * flatness + one).sqrt();
                let lift = (s.square() / (q + one) - v) / q;
                let slope = lift / q.square() + (s / q).square() + one;
                let step = (s * lift + (s - x)) / slope;
                ([s - step], (s * RESIDUAL).lt(step.abs()))
            },
        );
        let q = (s.square() * flatness + one).sqrt();
        let (rise, steepness) = (s.square() / (q + one), s / q);
        let of_branch = ((x - s) * steepness + (rise - v)) / (steepness.square() + one).sqrt();
        let of_corner = S::length2(x - half, v - height);
        let meets_corner = (half.lt(s) & zero.lt(of_branch)) | (half.lt(x) & height.lt(v));
        S::select(meets_corner, of_corner, of_branch.max(v - height)) * radius
    }
}
