//! Polynomial surfaces by nets of control points: Bézier patches and B-spline surfaces, also rational ones.
//!
//! A surface is a curve of curves. Its first parameter u leads from row to row of the net, the second one v along a row; the
//! algorithms of [`crate::curve`] run along each row, and then across the points that they yield (Farin, "Curves and Surfaces for
//! CAGD", 2002). Points are what they are there, with [`glam::DVec4`] for rational surfaces.
//!
//! ```
//! use freikugel_field::surface::{BSplinePatch, BezierPatch};
//! use glam::DVec3;
//!
//! let saddle = BezierPatch::new(vec![vec![DVec3::ZERO, DVec3::Y], vec![DVec3::X, DVec3::ONE]]);
//! assert_eq!(saddle.at(0.5, 0.5), DVec3::new(0.5, 0.5, 0.25));
//!
//! let row = |x: f64| (0..4).map(|y| DVec3::new(x, f64::from(y), x * x)).collect();
//! let surface = BSplinePatch::clamped([1, 2], vec![row(0.0), row(1.0), row(2.0)])?;
//! let [(u, _), (_, v)] = surface.domain();
//! assert_eq!(surface.at(u, v), DVec3::new(0.0, 3.0, 0.0));
//! assert_eq!(surface.beziers().len(), 2);
//! # Ok::<(), String>(())
//! ```

use crate::curve::{BSpline, Bezier, Point};

/// A Bézier patch: of each direction the degree is one less than the number of its control points.
#[derive(Clone, Debug, PartialEq)]
pub struct BezierPatch<P> {
    rows: Vec<Bezier<P>>,
}

impl<P: Point> BezierPatch<P> {
    /// The patch with these rows of control points, whose corners are those of the net.
    ///
    /// # Panics
    /// If there are none, or rows are not equally long.
    pub fn new(rows: Vec<Vec<P>>) -> Self {
        assert!(!rows.is_empty(), "a patch has rows");
        assert!(rows.iter().all(|row| row.len() == rows[0].len()), "all rows of a patch are equally long");
        Self { rows: rows.into_iter().map(Bezier::new).collect() }
    }

    /// The rows of control points, as curves along v.
    pub fn rows(&self) -> &[Bezier<P>] {
        &self.rows
    }

    /// All control points, row by row.
    pub fn points(&self) -> impl Iterator<Item = P> {
        self.rows.iter().flat_map(|row| row.points().iter().copied())
    }

    /// The degrees along u and v.
    pub fn degrees(&self) -> [usize; 2] {
        [self.rows.len() - 1, self.rows[0].degree()]
    }

    /// The point at `u` and `v`, 0 for the first and 1 for the last row or point of a row, by de Casteljau's algorithm.
    pub fn at(&self, u: f64, v: f64) -> P {
        Bezier::new(self.rows.iter().map(|row| row.at(v)).collect()).at(u)
    }

    /// The patches before and after `u`, each over 0 to 1. What they have in common has the same bits in both.
    pub fn split_u(&self, u: f64) -> [Self; 2] {
        let columns: Vec<[Bezier<P>; 2]> = self.columns().map(|column| column.split(u)).collect();
        [0, 1].map(|half| across(columns.iter().map(|halves| halves[half].clone())))
    }

    /// The patches before and after `v`, each over 0 to 1. What they have in common has the same bits in both.
    pub fn split_v(&self, v: f64) -> [Self; 2] {
        let rows: Vec<[Bezier<P>; 2]> = self.rows.iter().map(|row| row.split(v)).collect();
        [0, 1].map(|half| Self { rows: rows.iter().map(|halves| halves[half].clone()).collect() })
    }

    /// The columns of control points, as curves along u.
    fn columns(&self) -> impl Iterator<Item = Bezier<P>> {
        let column = |index: usize| Bezier::new(self.rows.iter().map(|row| row.points()[index]).collect());
        (0..=self.rows[0].degree()).map(column)
    }

    /// The derivative by `u`: a patch of one degree less in this direction.
    #[must_use]
    pub fn derivative_u(&self) -> Self {
        across(self.columns().map(|column| column.derivative()))
    }

    /// The derivative by `v`: a patch of one degree less in this direction.
    #[must_use]
    pub fn derivative_v(&self) -> Self {
        Self { rows: self.rows.iter().map(Bezier::derivative).collect() }
    }
}

/// The patch with these columns of control points, all of the same degree.
fn across<P: Point>(columns: impl Iterator<Item = Bezier<P>>) -> BezierPatch<P> {
    let columns: Vec<Bezier<P>> = columns.collect();
    let row = |index: usize| columns.iter().map(|column| column.points()[index]).collect();
    BezierPatch::new((0..=columns[0].degree()).map(row).collect())
}

/// A B-spline surface: Bézier patches that go over into one another at the knots of both directions.
#[derive(Clone, Debug, PartialEq)]
pub struct BSplinePatch<P> {
    /// The spline along u through the first points of all rows.
    across: BSpline<P>,
    rows: Vec<BSpline<P>>,
}

impl<P: Point> BSplinePatch<P> {
    /// The surface of these degrees along u and v, with these knots and rows of control points.
    ///
    /// # Errors
    /// If rows are not equally long, or a row or a column is no spline: see [`BSpline::new`].
    pub fn new(degrees: [usize; 2], [u, v]: [Vec<f64>; 2], rows: Vec<Vec<P>>) -> Result<Self, String> {
        let first: Vec<P> = rows.iter().filter_map(|row| row.first().copied()).collect();
        if first.len() < rows.len() || rows.iter().any(|row| row.len() != rows[0].len()) {
            return Err("all rows of a surface have points, and equally many".into());
        }
        let across = BSpline::new(degrees[0], u, first)?;
        let rows = rows.into_iter().map(|row| BSpline::new(degrees[1], v.clone(), row));
        Ok(Self { across, rows: rows.collect::<Result<_, _>>()? })
    }

    /// The surface whose corners are those of the net, with knots at equal distances between.
    ///
    /// # Errors
    /// If there are too few points, or rows are not equally long.
    pub fn clamped(degrees: [usize; 2], rows: Vec<Vec<P>>) -> Result<Self, String> {
        let first = rows.first().cloned().unwrap_or_default();
        let column = rows.iter().filter_map(|row| row.first().copied()).collect();
        let knots = |degree: usize, points: Vec<P>| BSpline::clamped(degree, points).map(|s| s.knots().to_vec());
        let knots = [knots(degrees[0], column)?, knots(degrees[1], first)?];
        Self::new(degrees, knots, rows)
    }

    /// The degrees along u and v.
    pub fn degrees(&self) -> [usize; 2] {
        [self.across.degree(), self.rows[0].degree()]
    }

    /// The knots along u and v.
    pub fn knots(&self) -> [&[f64]; 2] {
        [self.across.knots(), self.rows[0].knots()]
    }

    /// The rows of control points, as curves along v.
    pub fn rows(&self) -> &[BSpline<P>] {
        &self.rows
    }

    /// From where to where u and v lead.
    pub fn domain(&self) -> [(f64, f64); 2] {
        [self.across.domain(), self.rows[0].domain()]
    }

    /// The point at `u` and `v`, by de Boor's algorithm; beyond the domain, of the first or the last patch.
    pub fn at(&self, u: f64, v: f64) -> P {
        self.across.through(self.rows.iter().map(|row| row.at(v)).collect()).at(u)
    }

    /// Its pieces as Bézier patches: for each piece along u, those along v. What they have in common has the same bits in both.
    pub fn beziers(&self) -> Vec<Vec<BezierPatch<P>>> {
        let rows: Vec<Vec<Bezier<P>>> = self.rows.iter().map(BSpline::beziers).collect();
        // Of each piece along v its columns, each in pieces along u.
        let columns: Vec<Vec<Vec<Bezier<P>>>> = (0..rows[0].len())
            .map(|piece| {
                let column = |index: usize| rows.iter().map(|row| row[piece].points()[index]).collect();
                (0..=rows[0][piece].degree()).map(|index| self.across.through(column(index)).beziers()).collect()
            })
            .collect();
        let patch =
            |piece: usize, columns: &Vec<Vec<Bezier<P>>>| across(columns.iter().map(|pieces| pieces[piece].clone()));
        (0..columns[0][0].len()).map(|piece| columns.iter().map(|columns| patch(piece, columns)).collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, DVec4};

    const ROUNDING: f64 = 1e-12;

    fn net(rows: usize, columns: usize) -> Vec<Vec<DVec3>> {
        let bump = |row: usize, column: usize| ((row * 7 + column * 5) % 11) as f64 / 5.0 - 1.0;
        let point = |row: usize, column: usize| DVec3::new(row as f64, column as f64, bump(row, column));
        (0..rows).map(|row| (0..columns).map(|column| point(row, column)).collect()).collect()
    }

    fn places() -> impl Iterator<Item = (f64, f64)> {
        (0..=10).flat_map(|u| (0..=10).map(move |v| (f64::from(u) / 10.0, f64::from(v) / 10.0)))
    }

    /// The value of a Bernstein polynomial.
    fn bernstein(degree: usize, index: usize, t: f64) -> f64 {
        let choose = (0..index).fold(1.0, |product, i| product * (degree - i) as f64 / (i + 1) as f64);
        choose * t.powi(index as i32) * (1.0 - t).powi((degree - index) as i32)
    }

    #[test]
    fn patches_are_sums_over_products_of_bernstein_polynomials() {
        for (rows, columns) in [(1, 1), (2, 2), (2, 4), (4, 4), (5, 3)] {
            let net = net(rows, columns);
            let patch = BezierPatch::new(net.clone());
            assert_eq!((patch.degrees(), patch.points().count()), ([rows - 1, columns - 1], rows * columns));
            let (along_u, along_v) = (patch.derivative_u(), patch.derivative_v());
            for (u, v) in places() {
                let term = |i: usize, j: usize| net[i][j] * (bernstein(rows - 1, i, u) * bernstein(columns - 1, j, v));
                let sum: DVec3 = (0..rows).flat_map(|i| (0..columns).map(move |j| term(i, j))).sum();
                assert!(patch.at(u, v).distance(sum) < ROUNDING, "{rows} {columns} at {u} {v}");
                let step = 1e-6;
                let differences = [
                    (patch.at(u + step, v) - patch.at(u - step, v)) / (2.0 * step),
                    (patch.at(u, v + step) - patch.at(u, v - step)) / (2.0 * step),
                ];
                assert!(along_u.at(u, v).distance(differences[0]) < 1e-6);
                assert!(along_v.at(u, v).distance(differences[1]) < 1e-6);
            }
            let [[before_u, after_u], [before_v, after_v]] = [patch.split_u(0.3), patch.split_v(0.3)];
            for (u, v) in places() {
                assert!(before_u.at(u, v).distance(patch.at(0.3 * u, v)) < ROUNDING);
                assert!(after_u.at(u, v).distance(patch.at(0.3 + 0.7 * u, v)) < ROUNDING);
                assert!(before_v.at(u, v).distance(patch.at(u, 0.3 * v)) < ROUNDING);
                assert!(after_v.at(u, v).distance(patch.at(u, 0.3 + 0.7 * v)) < ROUNDING);
                assert!(before_u.at(1.0, v) == after_u.at(0.0, v) && before_v.at(u, 1.0) == after_v.at(u, 0.0));
            }
        }
    }

    /// A basis function by its recursion (Cox and de Boor, 1972), short of the domain's end.
    fn basis(knots: &[f64], index: usize, degree: usize, t: f64) -> f64 {
        if degree == 0 {
            return f64::from(u8::from(knots[index] <= t && t < knots[index + 1]));
        }
        let part = |above: f64, below: f64, rest: f64| if below == 0.0 { 0.0 } else { above / below * rest };
        let (low, high) = (knots[index], knots[index + degree + 1]);
        part(t - low, knots[index + degree] - low, basis(knots, index, degree - 1, t))
            + part(high - t, high - knots[index + 1], basis(knots, index + 1, degree - 1, t))
    }

    #[test]
    fn surfaces_are_sums_over_products_of_basis_functions_and_fall_into_patches() {
        let uneven = [vec![-1.0, 0.0, 0.5, 0.5, 2.0, 2.5, 3.0, 4.0], vec![0.0, 0.0, 0.0, 0.0, 0.7, 1.0, 1.0, 1.0, 1.0]];
        let surfaces = [
            BSplinePatch::clamped([1, 3], net(3, 6)).expect("sound"),
            BSplinePatch::clamped([3, 2], net(4, 5)).expect("sound"),
            BSplinePatch::new([2, 3], uneven, net(5, 5)).expect("sound"),
        ];
        for surface in surfaces {
            let [of_u, of_v] = surface.domain();
            let [knots_u, knots_v] = surface.knots();
            let [degree_u, degree_v] = surface.degrees();
            let within = |(low, high): (f64, f64), share: f64| low + (high - low) * share * (1.0 - 1e-12);
            for (u, v) in places() {
                let (u, v) = (within(of_u, u), within(of_v, v));
                let row = |i: usize| -> DVec3 {
                    let points = surface.rows()[i].points();
                    (0..points.len()).map(|j| points[j] * basis(knots_v, j, degree_v, v)).sum()
                };
                let sum: DVec3 = (0..surface.rows().len()).map(|i| row(i) * basis(knots_u, i, degree_u, u)).sum();
                assert!(surface.at(u, v).distance(sum) < 1e-9, "{surface:?} at {u} {v}");
            }
            let steps = |knots: &[f64], (low, high): (f64, f64)| {
                let mut knots: Vec<f64> = knots.iter().copied().filter(|k| (low..=high).contains(k)).collect();
                knots.dedup();
                knots
            };
            let (steps_u, steps_v) = (steps(knots_u, of_u), steps(knots_v, of_v));
            let patches = surface.beziers();
            assert_eq!((patches.len(), patches[0].len()), (steps_u.len() - 1, steps_v.len() - 1));
            for (row, ends_u) in patches.iter().zip(steps_u.windows(2)) {
                for (patch, ends_v) in row.iter().zip(steps_v.windows(2)) {
                    for (u, v) in places() {
                        let between = |ends: &[f64], share: f64| ends[0] + (ends[1] - ends[0]) * share;
                        let there = surface.at(between(ends_u, u), between(ends_v, v));
                        assert!(patch.at(u, v).distance(there) < ROUNDING, "{surface:?}");
                    }
                }
                for pair in row.windows(2) {
                    assert!(places().all(|(u, _)| pair[0].at(u, 1.0) == pair[1].at(u, 0.0)), "no gap");
                }
            }
            for pair in patches.windows(2) {
                assert!(places().all(|(_, v)| pair[0][0].at(1.0, v) == pair[1][0].at(0.0, v)), "no gap");
            }
        }
    }

    #[test]
    fn a_rational_patch_is_an_octant_of_a_sphere() {
        let patch = BezierPatch::new(octant());
        for (u, v) in places() {
            let point = patch.at(u, v);
            let point = point.truncate() / point.w;
            assert!((point.length() - 1.0).abs() < ROUNDING && point.min_element() > -ROUNDING, "{point}");
        }
    }

    /// An eighth of the unit sphere: a quarter of a circle, turned about z, whose end at the pole is one point three times.
    fn octant() -> Vec<Vec<DVec4>> {
        let half = 0.5_f64.sqrt();
        let quarter = [(1.0, 0.0, 1.0), (1.0, 1.0, half), (0.0, 1.0, 1.0)];
        let row = |(x, y, w): (f64, f64, f64)| {
            quarter.iter().map(|(r, z, own)| DVec4::new(x * r, y * r, *z, 1.0) * (w * own)).collect()
        };
        quarter.map(row).to_vec()
    }

    #[test]
    fn surfaces_that_are_none_are_refused() {
        let mut uneven = net(4, 4);
        uneven[2].pop();
        assert!(BSplinePatch::clamped([2, 2], uneven).is_err());
        assert!(BSplinePatch::clamped([4, 2], net(4, 4)).is_err() && BSplinePatch::clamped([2, 4], net(4, 4)).is_err());
        assert!(BSplinePatch::<DVec3>::clamped([1, 1], vec![Vec::new(), Vec::new()]).is_err());
        assert!(BSplinePatch::new([1, 1], [vec![0.0, 1.0, 2.0], vec![0.0; 4]], net(2, 2)).is_err());
    }
}
