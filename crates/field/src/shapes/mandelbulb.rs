//! Mandelbulb: the points whose orbits under z^k + p stay bounded, with the power of White and Nylander (2009), which raises
//! the length to the power and multiplies both polar angles with it. The bound is that of `escape.rs`.
//!
//! With r the length, θ the angle from the axis and φ the one around it, the power stretches by k r^(k-1) along r and θ,
//! and by k r^(k-1) |sin kθ / sin θ| along φ. No angle is computed: with ρ = r sin θ and z = r cos θ,
//! (z + iρ)^k = A + iρQ for A = r^k cos kθ and Q = r^(k-1) sin kθ / sin θ, and the angle around the axis goes as
//! ((x + iy) / ρ)^k. So L is k times the largest of r^(k-1), |Q| and a floor.

use super::escape::{
    BAILOUT, Escape, FLOOR, MAX_ITERATIONS, Radii, complex_power, iterations, least_with, power, power_below,
    steepest_power,
};
use crate::shape::AXIS;
use crate::shape_prelude::*;
use std::f64::consts::PI;

/// See [`mandelbulb`].
#[derive(Clone, Copy, Debug)]
pub struct Mandelbulb;

/// The descriptor of [`mandelbulb`].
pub static MANDELBULB: Shape = Shape::primitive::<Mandelbulb>();

/// The Mandelbulb of a power, 8 being the common one, with 8 iterations, around z.
#[track_caller]
pub fn mandelbulb(power: u32) -> Form<Mandelbulb> {
    Form::new(&MANDELBULB, [power.into()])
}

/// Before the radii: the number of iterations. After them come as many as the power is high: the formula knows the power by
/// that.
const RADII: usize = 1;
const LEADING: usize = RADII + Escape::<f64>::COUNT;

/// Keeps the direction around the axis defined on it.
const LEAST_RADIUS: f64 = 1e-18;

/// Angles at which the slope of L is looked at, and what the largest one may be above those found.
const ANGLES: u32 = 4096;
const BETWEEN_ANGLES: f64 = 1.01;

impl Primitive for Mandelbulb {
    const ABOUT: About = About {
        name: "mandelbulb",
        summary: "The points p whose orbits from p under z^power + p stay bounded, by the power that multiplies polar angles.",
        params: &[power(&[8.0]), iterations(&[8.0]), BAILOUT, AXIS],
        elsewhere: &["White-Nylander fractal"],
        example: r#"{ "mandelbulb": { "power": 8 } }"#,
    };

    const IS_LOOSE: bool = true;

    fn prepare(args: &[f64]) -> Vec<f64> {
        let mut constants = vec![args[1]];
        constants.extend(radii(args).constants());
        constants.resize(LEADING + args[0] as usize, 0.0);
        constants
    }

    fn contract(_args: &[f64]) -> Contract {
        Contract::BOUND
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        (radii(args).extent + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        match (c.count() - LEADING) as u32 {
            8 => orbit(8, p, c),
            power => orbit(power, p, c),
        }
    }
}

fn radii(args: &[f64]) -> Radii {
    let (k, iterations, bailout) = (args[0], args[1], args[2]);
    // From |p| >= 2^(1/(k-1)) on, an orbit never comes nearer than p: |z^k + p| >= |z| (|z|^(k-1) - 1) >= |z|.
    let least = 2.0_f64.powf(1.0 / (k - 1.0));
    let escapes = |from: f64| {
        let mut radius = from;
        for _ in 0..iterations as u32 {
            radius = radius.powf(k) - from;
        }
        radius > bailout.max(least)
    };
    let extent = least_with(least, escapes);
    let lambda = 0.5 * steepest_power(k).max(steepest_around(k));
    Radii::new(k, extent, [iterations, bailout.max(least)], Some(extent), lambda)
}

/// An upper bound of the slope of ln |Q| where |Q| is above r^(k-1) and the floor.
fn steepest_around(k: f64) -> f64 {
    let at = |i: u32| {
        let angle = PI * f64::from(i) / f64::from(ANGLES);
        let (sin, cos) = angle.sin_cos();
        let (sin_k, cos_k) = (k * angle).sin_cos();
        let ratio = sin_k / sin;
        let slope = k * cos_k / sin_k - cos / sin;
        // |Q| = r^(k-1) |ratio| reaches the floor at this radius.
        let radius = FLOOR * ratio.abs().powf(-1.0 / (k - 1.0));
        if ratio.abs() < 1.0 { 0.0 } else { (k - 1.0).hypot(slope) / radius }
    };
    BETWEEN_ANGLES * (1..ANGLES).map(at).fold(0.0, f64::max)
}

#[inline(always)]
fn orbit<S: Scalar>(power: u32, p: Vec3<S>, constants: &Constants<'_, S>) -> S {
    let [limit] = constants.get::<RADII>();
    let escape = Escape::read(constants, RADII);
    let (zero, one) = (limit.lift(0.0), limit.lift(1.0));
    let floor = FLOOR.powi(power as i32 - 1);
    let start = [p.x, p.y, p.z, escape.lambda, zero, escape.never(), zero];
    let [x, y, z, stretch, sum, inverse, _] = S::iterate(
        MAX_ITERATIONS,
        start,
        #[inline(always)]
        |[x, y, z, stretch, sum, inverse, n]| {
            let across = x.square() + y.square();
            let square = across + z.square();
            let inverse = escape.sooner(inverse, n, square, stretch, sum);
            let radius = S::length2(x, y);
            let unit = one / radius.max(one.lift(LEAST_RADIUS));
            let (ux, uy) = (x * unit, y * unit);
            let [along, q] = complex_power(power, z, across);
            let [cos, sin] = complex_power(power, ux, uy.square());
            let new_radius = radius * q;
            let by = power_below(power, square).max(q.abs()).max(one.lift(floor)) * f64::from(power);
            let n = n + 1.0;
            let next = [
                new_radius * cos + p.x,
                new_radius * (uy * sin) + p.y,
                along + p.z,
                escape.stretched(stretch, by) + escape.lambda,
                sum + stretch,
                inverse,
                n,
            ];
            (next, escape.goes_on(square) & n.lt(limit))
        },
    );
    let square = x.square() + y.square() + z.square();
    escape.field(inverse, square, stretch, sum, S::length3(p.x, p.y, p.z))
}
