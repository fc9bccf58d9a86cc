//! Quaternion Julia set: the points of a three-dimensional slice whose orbits under z^k + c stay bounded (Norton, "Generation
//! and Display of Geometric Fractals in 3-D", 1982). The bound is that of `escape.rs`.
//!
//! A power of a quaternion lies in the plane of its real part and its imaginary direction, and is that of a complex number
//! there. By the product rule its derivative along d is the sum of the k products z^i d z^(k-1-i), so that it stretches by
//! k |z|^(k-1) at most; L is an upper bound of that.

use super::escape::{
    BAILOUT, Escape, FLOOR, MAX_ITERATIONS, Radii, complex_power, iterations, power, power_below, steepest_power,
};
use crate::shape_prelude::*;

/// See [`quaternion_julia`].
#[derive(Clone, Copy, Debug)]
pub struct QuaternionJulia;

/// The descriptor of [`quaternion_julia`].
pub static QUATERNION_JULIA: Shape = Shape::primitive::<QuaternionJulia>();

/// The Julia set of z^2 + c with 10 iterations, in the slice of quaternions x + yi + zj.
#[track_caller]
pub fn quaternion_julia(c: [f64; 4]) -> Form<QuaternionJulia> {
    Form::new(&QUATERNION_JULIA, c.map(Into::into))
}

/// Before the radii: c, the slice, and the number of iterations. After them come as many as the power is high: the formula
/// knows the power by that.
const RADII: usize = 6;
const LEADING: usize = RADII + Escape::<f64>::COUNT;

/// Above this radius, the tangent at it bounds |z| more closely than that at 1.
const SECOND_TANGENT: f64 = 1.5;

impl Primitive for QuaternionJulia {
    const ABOUT: About = About {
        name: "quaternion_julia",
        summary: "The quaternions x + yi + zj + wk, w being fixed, whose orbits under z^power + c stay bounded.",
        params: &[
            Param::required(
                "c",
                ParamKind::Quadruple,
                "The quaternion that each step adds: its real part, then those along i, j and k.",
            ),
            power(&[2.0]),
            iterations(&[10.0]),
            BAILOUT,
            Param::optional("w", ParamKind::Number, &[0.0], "The fourth coordinate of the slice."),
        ],
        elsewhere: &["julia_fractal (POV-Ray)"],
        example: r#"{ "quaternion_julia": { "c": [-0.2, 0.6, 0.2, 0.2] } }"#,
    };

    const IS_LOOSE: bool = true;

    fn prepare(args: &[f64]) -> Vec<f64> {
        let (c, k, w) = (&args[..4], args[4], args[7]);
        let mut constants = vec![c[0], c[1], c[2], c[3], w, args[5]];
        constants.extend(radii(args).constants());
        constants.resize(LEADING + k as usize, 0.0);
        constants
    }

    fn contract(_args: &[f64]) -> Contract {
        Contract::BOUND
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let (radius, w) = (radii(args).extent + level, args[7]);
        // Nothing is left where the slice passes the ball.
        if radius < w.abs() { f64::NEG_INFINITY } else { (radius * radius - w * w).sqrt() * direction.length() }
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        match (c.count() - LEADING) as u32 {
            2 => orbit(2, p, c),
            power => orbit(power, p, c),
        }
    }
}

fn radii(args: &[f64]) -> Radii {
    let length = args[..4].iter().map(|x| x * x).sum::<f64>().sqrt();
    Radii::new(args[4], length, [args[5], args[6]], None, 0.5 * steepest_power(args[4]))
}

#[inline(always)]
fn orbit<S: Scalar>(power: u32, p: Vec3<S>, constants: &Constants<'_, S>) -> S {
    let [cx, cy, cz, cw, w, limit] = constants.get::<RADII>();
    let escape = Escape::read(constants, RADII);
    let zero = limit.lift(0.0);
    let floor = f64::from(power) * FLOOR.powi(power as i32 - 1);
    let start = [p.x, p.y, p.z, w, escape.lambda, zero, escape.never(), zero];
    let [x, y, z, w, stretch, sum, inverse, _] = S::iterate(
        MAX_ITERATIONS,
        start,
        #[inline(always)]
        |[x, y, z, w, stretch, sum, inverse, n]| {
            let imaginary = y.square() + z.square() + w.square();
            let square = x.square() + imaginary;
            let inverse = escape.sooner(inverse, n, square, stretch, sum);
            let [real, factor] = complex_power(power, x, imaginary);
            // Of k = 2 both terms are tangents of 2 |z| by its square; their slopes need no floor.
            let by = if power == 2 {
                (square + 1.0).min(square * (1.0 / SECOND_TANGENT) + SECOND_TANGENT)
            } else {
                (power_below(power, square) * f64::from(power)).max(square.lift(floor))
            };
            let n = n + 1.0;
            let next = [
                real + cx,
                factor * y + cy,
                factor * z + cz,
                factor * w + cw,
                escape.stretched(stretch, by),
                sum + stretch,
                inverse,
                n,
            ];
            (next, escape.goes_on(square) & n.lt(limit))
        },
    );
    let square = x.square() + y.square() + z.square() + w.square();
    let [.., w0, _] = constants.get::<RADII>();
    let length = S::length2(S::length3(p.x, p.y, p.z), w0);
    escape.field(inverse, square, stretch, sum, length)
}
