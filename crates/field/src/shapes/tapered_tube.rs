//! Round tubes whose radius changes, along chains of straight edges and arcs. Exact outside.
//!
//! The value is the least over all balls of the distance from their middle less their radius. On an arc of curvature k, along which
//! the radius grows by s for each unit of length, the least is either at an end, or where the line to the ball's middle meets the
//! arc at an angle whose cosine is s. With d the distance from the arc's axis in radii, g that from its circle in the plane of the
//! arc, and h the height above that plane, such a place lies at the angle psi beyond the nearest point of the circle, where
//!
//! ```text
//! 1 - cos psi = s^2 k^2 (g^2 + h^2) / (d m),   m = k g + (1 - s^2) + sqrt((1 - s^2) (d^2 - s^2) - s^2 k^2 h^2),
//! ```
//!
//! and the distance from it is sqrt(g^2 + h^2) sqrt(1 + 2 s^2 / m). There is none where the root has no value. (The angle at which
//! a line meets the arc gives a quadratic equation for cos psi; its other solution is where the value is greatest.) Nothing is
//! divided by k: straight edges are arcs with k = 0, and those that are all but straight lose no digits.

use crate::shape_prelude::*;
use crate::tapers::{ROW, Taper, reach, rows};
use glam::DVec4;
use std::f64::consts::SQRT_2;

/// All that a ball fills while it moves along straight edges and arcs, and its radius changes evenly with the length: what such
/// tubes of all kinds are cases of. Its arguments are its constants: those of each arc.
#[derive(Clone, Copy, Debug)]
pub struct TaperedWire;

/// The coefficients of the series asin(v) / v in the square of v.
const ARC_SINE: [f64; 13] = {
    let mut series = [1.0; 13];
    let mut n = 1;
    while n < series.len() {
        let odd = (2 * n - 1) as f64;
        series[n] = series[n - 1] * odd * odd / ((odd + 1.0) * (odd + 2.0));
        n += 1;
    }
    series
};

/// `asin(v) / v` by the square of `v`, for an angle up to an eighth of a turn and a little: to 1e-12. Shading languages promise no
/// more than four digits of their own arc sines, which divided by a small curvature are none.
#[inline(always)]
fn angle_by_sine<S: Scalar>(square: S) -> S {
    let mut sum = square.lift(ARC_SINE[ARC_SINE.len() - 1]);
    let mut power = ARC_SINE.len() - 1;
    while power > 0 {
        power -= 1;
        sum = sum * square + ARC_SINE[power];
    }
    sum
}

/// Keeps divisors above 0 where nothing is made of the quotient.
const LEAST_DIVISOR: f64 = 1e-30;

impl Primitive for TaperedWire {
    const ABOUT: About = About {
        name: "tapered_wire",
        summary: "A round tube along arcs, whose radius changes.",
        params: &[],
        elsewhere: &[],
        example: "",
    };

    fn contract(_args: &[f64]) -> Contract {
        Contract { inside: Metric::Bound, ..Contract::EXACT }
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let farthest = args.chunks_exact(ROW).map(|row| reach(row, direction)).fold(f64::NEG_INFINITY, f64::max);
        farthest + level * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let (zero, one) = (p.x.lift(0.0), p.x.lift(1.0));
        let far = p.x.lift(f64::from(f32::MAX));
        let [nearest] = S::fold_rows(
            c,
            ROW,
            [far],
            #[inline(always)]
            |[nearest], taper| {
                let [mx, my, mz, ux, uy, uz, nx, ny, nz, half, bend, slope, radius, along, across, first] = taper.get();
                let (q, u, n) = (p - vec3(mx, my, mz), vec3(ux, uy, uz), vec3(nx, ny, nz));
                // From the middle of the arc: along it, away from its centre, and out of its plane.
                let (x, y) = (q.dot(u), q.dot(n));
                let out = q.dot(vec3(uy * nz - uz * ny, uz * nx - ux * nz, ux * ny - uy * nx));
                let ball = S::length3(x - along, y - across, out) - first;

                // How far from the axis, in radii; and from the circle, in its plane and in all.
                let (sin, cos) = (x * bend, y * bend + one);
                let from_axis = S::length2(sin, cos);
                let excess = y + y + (x.square() + y.square()) * bend;
                let gap = excess / (from_axis + one);
                let from_circle = S::length2(gap, out);

                // What the head of this file calls m and s^2 / m.
                let (steep, flat) = (slope.square(), one - slope.square());
                let root = flat * (flat + bend * excess) - steep * (bend * out).square();
                let sum = bend * gap + flat + root.max(zero).sqrt();
                let share = steep / sum.max(one.lift(LEAST_DIVISOR));

                // Cosine and sine of the angle from the nearest point of the circle on, the sine by the radius.
                let inverse = one / from_axis.max(one.lift(LEAST_DIVISOR));
                let turn = share * inverse;
                let turn_cos = one - (bend * from_circle).square() * turn;
                let turn_sin = from_circle * (turn * (turn_cos + one)).max(zero).sqrt();
                // The same of the angle from the middle of the arc on.
                let place_sin = (x * turn_cos + cos * turn_sin) * inverse;
                let place_cos = (cos * turn_cos - sin * bend * turn_sin) * inverse;
                let is_between = zero.lt(root) & place_sin.abs().lt(half) & zero.lt(place_cos);

                // The sine of half that angle, by the radius and the root of 2, gives the length of the arc up to there.
                let half_sine = place_sin.max(-half).min(half) / (place_cos.clamp(0.0, 1.0) + one).sqrt();
                let length = half_sine * angle_by_sine((bend * half_sine).square() * 0.5) * SQRT_2;
                let side = from_circle * (share + share + one).sqrt() - slope * length - radius;
                [nearest.min(ball).min(S::select(is_between, side, far))]
            },
        );
        nearest
    }
}

/// See [`tapered_tube`].
#[derive(Clone, Copy, Debug)]
pub struct TaperedTube;

/// The descriptor of [`tapered_tube`].
pub static TAPERED_TUBE: Shape = Shape::special::<TaperedTube>();

/// All that a ball fills while its middle moves straight from point to point, and its radius changes evenly: points x, y, z and the
/// radius there. `with("closed", ...)` leads from the last one back to the first.
#[track_caller]
pub fn tapered_tube<V: Into<Value>>(points: impl IntoIterator<Item = [V; 4]>) -> Form<TaperedTube> {
    let points = points.into_iter().flat_map(|point| point.map(Into::into));
    Form::new(&TAPERED_TUBE, [0.into()].into_iter().chain(points))
}

/// The balls that a list names.
pub(crate) fn balls(list: &[f64]) -> Vec<DVec4> {
    list.chunks_exact(4).map(DVec4::from_slice).collect()
}

impl Special for TaperedTube {
    type General = TaperedWire;

    const ABOUT: About = About {
        name: "tapered_tube",
        summary: "A round tube along straight pieces from point to point, whose radius changes.",
        params: &[
            Param::optional("closed", ParamKind::Flag, &[0.0], "Whether the last point is joined to the first."),
            Param::required(
                "points",
                ParamKind::Balls,
                "The points [x, y, z, radius], one after another: two at least. From each to the next the radius changes evenly.",
            ),
        ],
        elsewhere: &["sphere_sweep with linear_spline", "chain of round cones"],
        example: r#"{ "tapered_tube": { "points":
            [[-0.9, -0.5, -0.6, 0.3], [-0.9, 0.5, 0.6, 0.15], [0, -0.5, 0.6, 0.3], [0.2, 0.6, -0.6, 0.05], [0.9, 0, 0.6, 0.25]] } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let points: Vec<&[f64]> = args[1..].chunks_exact(4).map(|ball| &ball[..3]).collect();
        if points.len() < 2 {
            return Err("`tapered_tube` has fewer than two points".into());
        }
        match points.windows(2).position(|pair| pair[0] == pair[1]) {
            Some(index) => Err(format!("point {} of `tapered_tube` and the next one are in the same place", index + 1)),
            None => Ok(()),
        }
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let balls = balls(&args[1..]);
        let start = (args[0] != 0.0).then_some(balls[0]);
        let ends = balls[1..].iter().chain(&start);
        rows(&balls.iter().zip(ends).map(|(from, to)| Taper::straight(*from, *to)).collect::<Vec<_>>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arcs3::Arc3;
    use crate::kernel::{BATCH, Block, PrimitiveJob};
    use crate::scalar::Dual;
    use crate::shape::PrimitiveTable;
    use crate::simd::Level;

    /// Numbers between 0 and 1 that look random: the fractions of multiples of the golden ratio, and of some roots.
    fn number(index: u32, of: f64) -> f64 {
        (f64::from(index) * of.sqrt() * 1.618_033_988_75).fract()
    }

    /// Arcs of many sizes, bends and slopes, with the length of each, a point beside it, and whether its slope is below 1.
    fn cases() -> impl Iterator<Item = (Taper, DVec3)> {
        (1..400).map(|index| {
            let of = |root: f64| number(index, root);
            let vector = |a, b, c| DVec3::new(of(a), of(b), of(c)) * 2.0 - 1.0;
            let (from, to) = (vector(2.0, 3.0, 5.0), vector(6.0, 7.0, 10.0));
            let along = (to - from).normalize();
            let half_turn = [0.0, 1e-7, 1e-4, 0.1, 0.4, 0.79][index as usize % 6] * of(11.0);
            let across = along.cross(vector(13.0, 14.0, 15.0)).normalize();
            let arc = Arc3 { from, to, direction: along * half_turn.cos() + across * half_turn.sin() };
            let slope =
                [0.0, 0.2, 0.5, 0.9, 0.999, 1.2][index as usize / 6 % 6] * if of(17.0) < 0.5 { -1.0 } else { 1.0 };
            let growth = slope * arc.length();
            let first = of(19.0) * 0.3 + (-growth).max(0.0);
            // Also next to the axis, far off, and in the plane of the arc.
            let middle = (from + to) / 2.0;
            let p = match index % 5 {
                0 => middle + vector(21.0, 22.0, 23.0) * 0.1,
                1 => middle + vector(21.0, 22.0, 23.0) * 8.0,
                2 => middle + along * of(21.0) + across * (of(22.0) * 2.0 - 1.0),
                _ => middle + vector(21.0, 22.0, 23.0) * 1.5,
            };
            (Taper { arc, radii: [first, first + growth] }, p)
        })
    }

    /// The least over so many balls of the arc, whose steps leave an error of the square of one.
    const STEPS: u32 = 20_000;

    fn brute(taper: &Taper, p: DVec3) -> f64 {
        let half_turn = taper.arc.half_turn();
        let (from, chord) = (taper.arc.from, taper.arc.to - taper.arc.from);
        let at = |share: f64| {
            // The chord up to there is turned from the direction at the beginning by half of what the arc has turned by.
            let angle = half_turn * share;
            let part = if half_turn > 0.0 { libm::sin(angle) / libm::sin(half_turn) } else { share };
            let along = chord.normalize();
            let across = (taper.arc.direction - along * taper.arc.direction.dot(along)).normalize_or(DVec3::ZERO);
            let turned = along * libm::cos(half_turn - angle) + across * libm::sin(half_turn - angle);
            let middle = from + turned * (chord.length() * part);
            p.distance(middle) - (taper.radii[0] + (taper.radii[1] - taper.radii[0]) * share)
        };
        let best = (0..=STEPS).map(|step| (at(f64::from(step) / f64::from(STEPS)), step));
        let (_, step) = best.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there are steps");
        // Closer in on it: next to the least value there is no other one.
        let share = |step: f64| (step / f64::from(STEPS)).clamp(0.0, 1.0);
        let (mut low, mut high) = (share(f64::from(step) - 1.0), share(f64::from(step) + 1.0));
        for _ in 0..80 {
            let third = (high - low) / 3.0;
            if at(low + third) < at(high - third) { high -= third } else { low += third }
        }
        at(low)
    }

    fn value<S: Scalar<Table = [f64]>>(p: [S; 3], rows: &[f64]) -> S {
        TaperedWire::distance(vec3(p[0], p[1], p[2]), &Constants::new(p[0], rows, rows.len()))
    }

    #[test]
    fn balls_along_arcs_are_all_there_is() {
        for (index, (taper, p)) in cases().enumerate() {
            let (rows, expected) = (rows(&[taper]), brute(&taper, p));
            let found = value(p.to_array(), &rows);
            assert!((found - expected).abs() < 1e-11, "{index}: {found}, not {expected} at {p} of {taper:?}");
        }
    }

    #[test]
    fn single_precision_keeps_its_digits() {
        let kernel = PrimitiveTable::of::<TaperedWire>().kernels.values;
        for (index, (taper, p)) in cases().enumerate() {
            let constants: Vec<f32> = rows(&[taper]).into_iter().map(|c| c as f32).collect();
            let rounded = p.as_vec3();
            let mut points = vec![Block::default(); 3];
            (0..3).for_each(|axis| points[axis].0.fill(rounded[axis]));
            let mut out = vec![Block::default(); 1];
            let (points, out, at, constants) = (&points, &mut out[..], &[0.0; 3], &constants[..]);
            kernel(Level::new(), &mut PrimitiveJob { points, at, constants, before: None, out, count: BATCH });
            let expected = value(rounded.as_dvec3().to_array(), &rows(&[taper]));
            let found = f64::from(out[0].0[0]);
            assert!(
                (found - expected).abs() < 3e-6 * (1.0 + p.length()),
                "{index}: {found}, not {expected} at {p} of {taper:?}"
            );
        }
    }

    #[test]
    fn slopes_are_those_of_differences() {
        const STEP: f64 = 1e-6;
        for (index, (taper, p)) in cases().enumerate() {
            let rows = rows(&[taper]);
            let input = |axis: usize| Dual::input(p[axis], axis);
            let found = DVec3::from_array(value([input(0), input(1), input(2)], &rows).gradient);
            let at = |p: DVec3| value(p.to_array(), &rows);
            let sides = |axis: DVec3| [at(p + axis * STEP) - at(p), at(p) - at(p - axis * STEP)].map(|d| d / STEP);
            let slopes = DVec3::AXES.map(sides);
            // On a crease both sides have slopes of their own.
            if slopes.iter().all(|[after, before]| (after - before).abs() < 1e-4) {
                let expected = DVec3::from_array(slopes.map(|[after, before]| (after + before) / 2.0));
                assert!(found.distance(expected) < 1e-4, "{index}: {found}, not {expected} at {p} of {taper:?}");
                assert!((found.length() - 1.0).abs() < 1e-6, "{index}: {found}");
            }
        }
    }

    #[test]
    fn supports_are_those_of_the_balls() {
        for (index, (taper, p)) in cases().enumerate() {
            let rows = rows(&[taper]);
            let farthest = TaperedWire::support(&rows, p, 0.1);
            // From far away in that direction the distance is what is left up to there.
            let far = p.normalize() * 1e6;
            let expected = p.length() * (1e6 - value(far.to_array(), &rows) + 0.1);
            assert!((farthest - expected).abs() < 1e-4 * p.length(), "{index}: {farthest}, not {expected}");
        }
    }
}
