//! Superellipse: |x / a|^n + |y / b|^n <= 1 (Lamé curves). A quarter of its edge becomes arcs within a tolerance; the distance from
//! these and their mirror images is exact.
//!
//! Arcs go over into one another, so that none but the two on the axes has an end that could be the nearest point by itself.

use super::outline::Edge;
use crate::arcs::Lines;
use crate::arcs3::is_arc;
use crate::remember::remembered;
use crate::shape_prelude::*;

/// See [`superellipse`].
#[derive(Clone, Copy, Debug)]
pub struct Superellipse;

/// The descriptor of [`superellipse`].
pub static SUPERELLIPSE: Shape = Shape::primitive::<Superellipse>();

/// A superellipse around the origin with these radii along x and y: a star with dents for exponents below 1, at 1 a rhombus, at 2
/// an ellipse, and the more like a rectangle the larger the exponent is.
#[track_caller]
pub fn superellipse(x: impl Into<Value>, y: impl Into<Value>, exponent: impl Into<Value>) -> Form<Superellipse> {
    Form::new(&SUPERELLIPSE, [x.into(), y.into(), exponent.into()])
}

/// Arcs are within this share of the smaller radius of the curve.
const TOLERANCE: f64 = 1e-4;

/// Exponents beyond these make crosses of no width, or rectangles.
const LEAST: f64 = 0.2;
const MOST: f64 = 100.0;

/// Arcs count as longer by this share of the distance from them and of the radii, so that rounding in single precision leaves no gap
/// between two of them. Around a joint their circles differ by the square of it.
const OVERLAP: f64 = 1e-6;

/// How many constants stand before those of the arcs, and how many an arc has.
const RADII: usize = 2;
const ROW: usize = 9;

/// The arcs of the first quarter, counter-clockwise.
fn quarter(args: &[f64]) -> Vec<Edge> {
    let &[x, y, exponent] = args else { unreachable!("three numbers") };
    let ends = remembered("superellipse", args, || {
        let mut lines = Lines::new(TOLERANCE * x.min(y));
        lines.move_to(DVec2::new(x, 0.0));
        lines.follow(&|t| half_quarter(x, y, exponent, t), [0.0, 1.0]);
        // The other half is a mirror image, in the opposite direction.
        let mirrored = |(at, towards): (DVec2, DVec2)| (DVec2::new(at.y, at.x), -DVec2::new(towards.y, towards.x));
        lines.follow(&|t| mirrored(half_quarter(y, x, exponent, t)), [1.0, 0.0]);
        let (corners, end) = lines.open();
        corners.into_iter().chain([[end.x, end.y, 0.0]]).flatten().collect()
    });
    let ends: Vec<&[f64]> = ends.chunks_exact(3).collect();
    let edge =
        |pair: &[&[f64]]| Edge { from: DVec2::from_slice(pair[0]), to: DVec2::from_slice(pair[1]), turn: pair[0][2] };
    ends.windows(2).map(edge).collect()
}

/// The middle of an arc's chord; the normal of the chord towards the arc; half its length; sine and cosine of half the angle that
/// the arc turns by; its radius, 0 for a straight edge; and 1 if the arc bulges outward, -1 if it is a dent.
fn constants(edge: Edge) -> [f64; ROW] {
    let [ax, ay, bx, by, nx, ny, sin, cos, radius] = edge.constants();
    let outward = if edge.turn < 0.0 { -1.0 } else { 1.0 };
    [(ax + bx) / 2.0, (ay + by) / 2.0, nx, ny, edge.length() / 2.0, sin, cos, radius, outward]
}

impl Primitive for Superellipse {
    const ABOUT: About = About {
        name: "superellipse",
        summary: "A plane figure between an ellipse and a rectangle, or a rhombus, or a star: |x / a|^n + |y / b|^n <= 1.",
        params: &[
            Param::required("radii", ParamKind::Size2, "Distances from the centre to the edge along x and y."),
            Param::required(
                "exponent",
                ParamKind::Positive,
                "From 0.2 to 100: 1 for a rhombus, 2 for an ellipse, 4 for what is called a squircle.",
            ),
        ],
        elsewhere: &["squircle", "sdSquircle", "Lamé curve", "astroid"],
        example: r#"{ "extrude": { "height": 0.5, "shape": { "superellipse": { "radii": [1, 0.8], "exponent": 4 } } } }"#,
    };

    const DIMENSION: Dimension = Dimension::Plane;

    fn check(args: &[f64]) -> Result<(), String> {
        if (LEAST..=MOST).contains(&args[2]) {
            Ok(())
        } else {
            Err(format!("`exponent` of `superellipse` must lie between {LEAST} and {MOST}, but is {}", args[2]))
        }
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        args[..RADII].iter().copied().chain(quarter(args).into_iter().flat_map(constants)).collect()
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        in_plane(direction, |across| {
            let unit = direction.truncate().abs() / across;
            let farthest = quarter(args).into_iter().map(|edge| edge.support(unit)).fold(f64::NEG_INFINITY, f64::max);
            across * (farthest + level)
        })
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [a, b] = c.get();
        let (x, y, zero) = (p.x.abs(), p.y.abs(), p.x.lift(0.0));
        let (from_tip, from_top) = (S::length2(x - a, y), S::length2(x, y - b));
        let from_end = S::select(
            from_tip.lt(from_top),
            S::select(x.lt(a), -from_tip, from_tip),
            S::select(y.lt(b), -from_top, from_top),
        );
        let arcs = c.part(RADII, c.count() - RADII);
        let [nearest] = S::fold_rows(
            &arcs,
            ROW,
            [from_end],
            #[inline(always)]
            |[nearest], arc| {
                let [mx, my, nx, ny, half, sin, cos, radius, outward] = arc.get();
                // As in an outline.
                let (dx, dy) = (x - mx, y - my);
                let along = (dx * ny - dy * nx).abs();
                let across = dx * nx + dy * ny;
                let overlap = (along + across.abs() + half + a + b) * OVERLAP;
                let is_between = zero.lt(sin * across + cos * (half - along) + overlap);
                let to_centre = radius * cos;
                let excess = (along - half) * (along + half) + across * (across + to_centre * 2.0);
                let gap = excess / (S::length2(along, across + to_centre) + radius);
                let gap = S::select(is_arc(radius), gap, across);
                let is_nearer = is_between & gap.abs().lt(nearest.abs());
                [S::select(is_nearer, gap * outward, nearest)]
            },
        );
        nearest
    }
}

/// A point of the edge, and its direction there: from the end of the x axis at 0 to the diagonal of the box at 1.
fn half_quarter(a: f64, b: f64, exponent: f64, t: f64) -> (DVec2, DVec2) {
    // Below 2 the curve has tips on the axes, which are approached slowly.
    let ratio = libm::pow(t, (2.0 / exponent).max(1.0));
    let size = libm::pow(1.0 + libm::pow(ratio, exponent), -1.0 / exponent);
    // The curve's gradient, less a factor that keeps it finite.
    let normal = if exponent < 1.0 {
        DVec2::new(libm::pow(ratio, 1.0 - exponent) / a, 1.0 / b)
    } else {
        DVec2::new(1.0 / a, libm::pow(ratio, exponent - 1.0) / b)
    };
    (DVec2::new(a, b * ratio) * size, normal.perp())
}
