//! Surfaces as triangles within a tolerance.
//!
//! Bézier patches are halved until each is cut evenly along both parameters, into as many steps as a bound of its second
//! derivatives asks for (Filip, Magedson and Markot, "Surface algorithms using bounds on derivatives", 1986). Patches side by
//! side are halved together and have their steps in common, and with them their corners: there are no gaps.
//!
//! Of rational patches it is the points `(w x, w y, w z, w)` that triangles of that space stand for: seen from the origin, these
//! are triangles, too (compare Zheng and Sederberg, "Estimating tessellation parameter intervals for rational curves and surfaces",
//! 2000). If a point `p` moves by `e` there and its weight by `f`, it moves by `(e - p f) / w` here.

use crate::surface::BezierPatch;
use glam::{DVec3, DVec4};

/// More triangles than this take too long to be looked at.
pub(crate) const MOST_TRIANGLES: usize = 20_000;

/// Patches of a surface: for each piece along its first parameter, those along the second one.
pub(crate) type Patches = Vec<Vec<BezierPatch<DVec4>>>;

/// Pieces that take more steps than this are halved: near their ends they may bend less.
const MOST_STEPS: f64 = 8.0;

/// So many times as many triangles as possible may be asked for before anything is halved; with each time it is, half as many.
const ALLOWANCE: f64 = 64.0;

/// Cells in blocks of so many by so many follow one another, so that triangles in a row lie near to each other.
const BLOCK: usize = 2;

/// So much more than a whole number is that number: the rest is rounding.
const ROUNDING: f64 = 1e-9;

/// A surface, and into how many steps its pieces are cut along both parameters.
#[derive(Debug)]
pub(crate) struct Cut {
    patches: Patches,
    steps: [Vec<usize>; 2],
}

impl Cut {
    /// The surface, so that triangles are at most `tolerance` from it.
    ///
    /// # Errors
    /// How many triangles it would take, if these are too many.
    pub(crate) fn new(mut patches: Patches, tolerance: f64) -> Result<Self, f64> {
        let mut allowance = ALLOWANCE;
        loop {
            let [of_u, of_v] = counts(&patches, tolerance);
            let triangles = 2.0 * of_u.iter().sum::<f64>() * of_v.iter().sum::<f64>();
            let is_long = |count: &f64| *count > MOST_STEPS;
            if !of_u.iter().chain(&of_v).any(is_long) && triangles <= MOST_TRIANGLES as f64 {
                let steps = [of_u, of_v].map(|counts| counts.into_iter().map(|count| count as usize).collect());
                return Ok(Self { patches, steps });
            }
            if !of_u.iter().chain(&of_v).any(is_long) || triangles > allowance * MOST_TRIANGLES as f64 {
                return Err(triangles);
            }
            allowance = (allowance / 2.0).max(1.0);
            for row in &mut patches {
                let pieces = row.drain(..).zip(&of_v);
                *row = pieces.flat_map(|(patch, count)| halves(patch, is_long(count), BezierPatch::split_v)).collect();
            }
            patches = patches.into_iter().zip(&of_u).flat_map(|(row, count)| halved(row, is_long(count))).collect();
        }
    }

    /// The triangles, each near to the ones before and after it. Some may be lines or points.
    pub(crate) fn triangles(&self) -> Vec<[DVec3; 3]> {
        let [of_u, of_v] = &self.steps;
        let mut triangles = Vec::new();
        for (row, rows) in self.patches.iter().zip(of_u) {
            for (patch, columns) in row.iter().zip(of_v) {
                triangles.extend(of_patch(patch, *rows, *columns));
            }
        }
        triangles
    }
}

/// Both halves of a patch, or the whole.
fn halves(
    patch: BezierPatch<DVec4>,
    is_long: bool,
    split: fn(&BezierPatch<DVec4>, f64) -> [BezierPatch<DVec4>; 2],
) -> Vec<BezierPatch<DVec4>> {
    if is_long { split(&patch, 0.5).to_vec() } else { vec![patch] }
}

/// Both halves along u of patches side by side, or the whole of them.
fn halved(row: Vec<BezierPatch<DVec4>>, is_long: bool) -> Patches {
    if !is_long {
        return vec![row];
    }
    let pairs: Vec<[BezierPatch<DVec4>; 2]> = row.iter().map(|patch| patch.split_u(0.5)).collect();
    [0, 1].map(|half| pairs.iter().map(|pair| pair[half].clone()).collect()).to_vec()
}

/// How many steps the pieces take along both parameters.
fn counts(patches: &Patches, tolerance: f64) -> [Vec<f64>; 2] {
    let bends: Vec<Vec<[f64; 2]>> = patches.iter().map(|row| row.iter().map(bends).collect()).collect();
    // Over a triangle with legs h and k a function is off by (h^2 uu + 2 h k uv + k^2 vv) / 8 at most. As 2 h k is at most
    // h^2 + k^2, each leg has its share of this: all of it if the other one needs none.
    let count = |[own, other]: [f64; 2]| (own / (if other > 0.0 { 4.0 } else { 8.0 } * tolerance)).sqrt();
    let whole = |count: f64| (count * (1.0 - ROUNDING)).ceil().max(1.0);
    let of_u = |row: &Vec<[f64; 2]>| whole(row.iter().map(|&bend| count(bend)).fold(0.0, f64::max));
    let of_v =
        |column: usize| whole(bends.iter().map(|row| row[column]).map(|[u, v]| count([v, u])).fold(0.0, f64::max));
    [bends.iter().map(of_u).collect(), (0..bends[0].len()).map(of_v).collect()]
}

/// Bounds of how far a patch bends along both parameters: of its second derivative by one of them and the mixed one together, with
/// weights taken into account.
fn bends(patch: &BezierPatch<DVec4>) -> [f64; 2] {
    let places: Vec<DVec3> = patch.points().map(|point| point.truncate() / point.w).collect();
    let (low, high) = places.iter().fold((places[0], places[0]), |(low, high), p| (low.min(*p), high.max(*p)));
    let middle = (low + high) / 2.0;
    let radius = places.iter().map(|place| place.distance(middle)).fold(0.0, f64::max);
    let lightest = patch.points().map(|point| point.w).fold(f64::INFINITY, f64::min);
    let size = |derivative: &BezierPatch<DVec4>| {
        let moved = |d: DVec4| (d.truncate() - middle * d.w).length() + radius * d.w.abs();
        derivative.points().map(moved).fold(0.0, f64::max) / lightest
    };
    let (along_u, along_v) = (patch.derivative_u(), patch.derivative_v());
    let mixed = size(&along_u.derivative_v());
    [size(&along_u.derivative_u()) + mixed, size(&along_v.derivative_v()) + mixed]
}

/// The triangles of a patch that is cut into so many rows and columns.
fn of_patch(patch: &BezierPatch<DVec4>, rows: usize, columns: usize) -> Vec<[DVec3; 3]> {
    let corner = |row: usize, column: usize| {
        let point = patch.at(row as f64 / rows as f64, column as f64 / columns as f64);
        point.truncate() / point.w
    };
    let corners: Vec<Vec<DVec3>> =
        (0..=rows).map(|row| (0..=columns).map(|column| corner(row, column)).collect()).collect();
    let mut triangles = Vec::with_capacity(2 * rows * columns);
    for (turn, top) in (0..rows).step_by(BLOCK).enumerate() {
        // There and back again, so that one block is beside the next.
        let mut lefts: Vec<usize> = (0..columns).step_by(BLOCK).collect();
        if turn % 2 == 1 {
            lefts.reverse();
        }
        for left in lefts {
            for row in top..rows.min(top + BLOCK) {
                for column in left..columns.min(left + BLOCK) {
                    let [a, b] = [corners[row][column], corners[row][column + 1]];
                    let [c, d] = [corners[row + 1][column + 1], corners[row + 1][column]];
                    // Across the shorter diagonal.
                    let halves = if a.distance_squared(c) <= b.distance_squared(d) {
                        [[a, b, c], [a, c, d]]
                    } else {
                        [[a, b, d], [b, c, d]]
                    };
                    triangles.extend(halves);
                }
            }
        }
    }
    triangles
}
