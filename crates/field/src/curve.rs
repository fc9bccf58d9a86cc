//! Polynomial curves by control points: Bézier curves and B-splines, also rational ones.
//!
//! Points are anything that can be added and multiplied with numbers: [`glam::DVec2`], [`glam::DVec3`], or [`glam::DVec4`] for
//! rational curves, whose points are `(w x, w y, w z, w)`.
//!
//! ```
//! use freikugel_field::curve::{BSpline, Bezier};
//! use glam::DVec3;
//!
//! let bow = Bezier::new(vec![DVec3::ZERO, DVec3::Y, DVec3::X]);
//! assert_eq!(bow.at(0.5), DVec3::new(0.25, 0.5, 0.0));
//! let [left, right] = bow.split(0.5);
//! assert_eq!(left.at(1.0), right.at(0.0));
//!
//! let spline = BSpline::clamped(2, vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::Z])?;
//! assert_eq!(spline.at(spline.domain().0), DVec3::ZERO);
//! assert_eq!(spline.beziers().len(), 2);
//! # Ok::<(), String>(())
//! ```

use std::ops::{Add, Mul, Sub};

/// What control points can be.
pub trait Point: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> {}

impl<P: Copy + Add<Output = P> + Sub<Output = P> + Mul<f64, Output = P>> Point for P {}

/// The point at `share` of the way from one to the other.
fn between<P: Point>(a: P, b: P, share: f64) -> P {
    a * (1.0 - share) + b * share
}

/// A Bézier curve: its degree is one less than the number of its control points.
#[derive(Clone, Debug, PartialEq)]
pub struct Bezier<P> {
    points: Vec<P>,
}

impl<P: Point> Bezier<P> {
    /// The curve with these control points, which begins at the first one and ends at the last one.
    ///
    /// # Panics
    /// If there are none.
    pub fn new(points: Vec<P>) -> Self {
        assert!(!points.is_empty(), "a curve has points");
        Self { points }
    }

    /// The control points.
    pub fn points(&self) -> &[P] {
        &self.points
    }

    /// The degree.
    pub fn degree(&self) -> usize {
        self.points.len() - 1
    }

    /// The point at `t`, 0 for the beginning and 1 for the end, by de Casteljau's algorithm.
    pub fn at(&self, t: f64) -> P {
        let mut points = self.points.clone();
        for count in (1..points.len()).rev() {
            for index in 0..count {
                points[index] = between(points[index], points[index + 1], t);
            }
        }
        points[0]
    }

    /// The curves before and after `t`, each over 0 to 1: the sides of de Casteljau's triangle.
    pub fn split(&self, t: f64) -> [Self; 2] {
        let mut points = self.points.clone();
        let (mut before, mut after) = (vec![points[0]], vec![points[points.len() - 1]]);
        for count in (1..points.len()).rev() {
            for index in 0..count {
                points[index] = between(points[index], points[index + 1], t);
            }
            before.push(points[0]);
            after.push(points[count - 1]);
        }
        after.reverse();
        [Self::new(before), Self::new(after)]
    }

    /// The derivative by `t`: a curve of one degree less.
    pub fn derivative(&self) -> Self {
        let degree = self.degree() as f64;
        match self.points.len() {
            1 => Self::new(vec![self.points[0] * 0.0]),
            _ => Self::new(self.points.windows(2).map(|pair| (pair[1] - pair[0]) * degree).collect()),
        }
    }

    /// The same curve with one control point more.
    #[must_use]
    pub fn elevated(&self) -> Self {
        let (count, last) = (self.points.len(), self.points[self.points.len() - 1]);
        let inner = (1..count).map(|index| {
            let share = index as f64 / count as f64;
            between(self.points[index], self.points[index - 1], share)
        });
        Self::new([self.points[0]].into_iter().chain(inner).chain([last]).collect())
    }
}

/// A B-spline: pieces of polynomial curves that go over into one another at the knots.
#[derive(Clone, Debug, PartialEq)]
pub struct BSpline<P> {
    degree: usize,
    knots: Vec<f64>,
    points: Vec<P>,
}

impl<P: Point> BSpline<P> {
    /// The spline of a degree with these knots and control points.
    ///
    /// # Errors
    /// If there are not as many knots as points, degree and one together, or they fall, or one is there more often than the degree
    /// and one, or nothing lies between the first and the last that count.
    pub fn new(degree: usize, knots: Vec<f64>, points: Vec<P>) -> Result<Self, String> {
        if degree == 0 || points.len() <= degree {
            return Err(format!(
                "a spline of degree {degree} has at least {} points, and a degree above 0",
                degree + 1
            ));
        }
        if knots.len() != points.len() + degree + 1 {
            let wanted = points.len() + degree + 1;
            let (count, own) = (points.len(), knots.len());
            return Err(format!("a spline of degree {degree} with {count} points has {wanted} knots, not {own}"));
        }
        if !knots.is_sorted() || knots.iter().any(|knot| !knot.is_finite()) {
            return Err("knots must be finite, and must not fall".into());
        }
        if knots.windows(degree + 2).any(|run| run[0] == run[degree + 1]) {
            return Err(format!("a spline of degree {degree} has no knot more than {} times", degree + 1));
        }
        if knots[degree] == knots[points.len()] {
            return Err(format!("nothing lies between the first {degree} knots and the last {degree}"));
        }
        Ok(Self { degree, knots, points })
    }

    /// The spline that begins at the first point and ends at the last one, with knots at equal distances between.
    ///
    /// # Errors
    /// If there are too few points.
    pub fn clamped(degree: usize, points: Vec<P>) -> Result<Self, String> {
        let inner = points.len().saturating_sub(degree);
        let knots = (0..points.len() + degree + 1).map(|index| index.clamp(degree, degree + inner) as f64);
        Self::new(degree, knots.collect(), points)
    }

    /// The spline that goes around and closes, with knots at equal distances.
    ///
    /// # Errors
    /// If there are too few points.
    pub fn closed(degree: usize, points: &[P]) -> Result<Self, String> {
        let knots: Vec<f64> = (0..=points.len()).map(|index| index as f64).collect();
        Self::closed_with(degree, &knots, points)
    }

    /// The spline that goes around and closes, with the knots of one round: one more than there are points, of which the last is
    /// the first of the next round.
    ///
    /// # Errors
    /// If there are too few points or another count of knots, or knots fall, or one is there more often than the degree, at which
    /// the curve would break; or nothing lies between the first and the last.
    pub fn closed_with(degree: usize, knots: &[f64], points: &[P]) -> Result<Self, String> {
        let (count, own) = (points.len(), knots.len());
        if count <= degree {
            return Err(format!("a closed spline of degree {degree} has at least {} points", degree + 1));
        }
        if own != count + 1 {
            let wanted = count + 1;
            return Err(format!(
                "a closed spline of degree {degree} with {count} points has {wanted} knots, not {own}"
            ));
        }
        // As many as the degree of the rounds before and after, too. Knots that are the same stay the same.
        let (first, last) = (knots[0], knots[count]);
        let knot = |index: usize| {
            let place = index + count - degree;
            let own = knots[place % count];
            match place / count {
                0 => first - (last - own),
                1 => own,
                _ => last + (own - first),
            }
        };
        let all: Vec<f64> = (0..=count + 2 * degree).map(knot).collect();
        if first < last && all.windows(degree + 1).any(|run| run[0] == run[degree]) {
            return Err(format!("a closed spline of degree {degree} has no knot more than {degree} times"));
        }
        let around: Vec<P> = points.iter().chain(points.iter().cycle().take(degree)).copied().collect();
        Self::new(degree, all, around)
    }

    /// The spline with the same degree and knots, and as many other control points.
    pub(crate) fn through(&self, points: Vec<P>) -> Self {
        debug_assert_eq!(points.len(), self.points.len());
        Self { degree: self.degree, knots: self.knots.clone(), points }
    }

    /// The degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The knots.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The control points.
    pub fn points(&self) -> &[P] {
        &self.points
    }

    /// From where to where it leads.
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.degree], self.knots[self.points.len()])
    }

    /// The index of the knot before `u`, among those between which there is a piece.
    fn span(&self, u: f64) -> usize {
        let last = self.points.len() - 1;
        let span = self.knots[..=last].partition_point(|&knot| knot <= u).saturating_sub(1).max(self.degree);
        // The last piece holds its end, too.
        (self.degree..=span).rev().find(|&index| self.knots[index] < self.knots[index + 1]).unwrap_or(span)
    }

    /// The point at `u`, by de Boor's algorithm; beyond the domain, of the first or the last piece.
    pub fn at(&self, u: f64) -> P {
        let (degree, span) = (self.degree, self.span(u));
        let mut points: Vec<P> = self.points[span - degree..=span].to_vec();
        for round in 1..=degree {
            for index in (round..=degree).rev() {
                let first = span - degree + index;
                let (low, high) = (self.knots[first], self.knots[first + degree + 1 - round]);
                points[index] = between(points[index - 1], points[index], (u - low) / (high - low));
            }
        }
        points[degree]
    }

    /// The same spline with one more knot, by Boehm's algorithm.
    ///
    /// # Errors
    /// If the knot lies outside of the domain, or is there as often as the degree already.
    pub fn inserted(&self, knot: f64) -> Result<Self, String> {
        let (low, high) = self.domain();
        if !(low..=high).contains(&knot) {
            return Err(format!("a knot at {knot} is outside of the spline, which leads from {low} to {high}"));
        }
        if self.knots.iter().filter(|&&own| own == knot).count() >= self.degree {
            return Err(format!("the knot at {knot} is there {} times already", self.degree));
        }
        let (degree, span) = (self.degree, self.span(knot));
        let mut points = Vec::with_capacity(self.points.len() + 1);
        points.extend_from_slice(&self.points[..=span - degree]);
        for index in span - degree + 1..=span {
            let (low, high) = (self.knots[index], self.knots[index + degree]);
            points.push(between(self.points[index - 1], self.points[index], (knot - low) / (high - low)));
        }
        points.extend_from_slice(&self.points[span..]);
        let mut knots = self.knots.clone();
        knots.insert(span + 1, knot);
        Ok(Self { degree, knots, points })
    }

    /// Its pieces as Bézier curves: every knot is inserted as often as the degree.
    pub fn beziers(&self) -> Vec<Bezier<P>> {
        let (low, high) = self.domain();
        let mut all = self.clone();
        let mut knots: Vec<f64> = self.knots.iter().copied().filter(|knot| (low..=high).contains(knot)).collect();
        knots.dedup();
        for &knot in &knots {
            while let Ok(more) = all.inserted(knot) {
                all = more;
            }
        }
        let first = |knot: f64| all.knots.iter().rposition(|&own| own == knot).unwrap_or(0);
        knots
            .windows(2)
            .map(|pair| {
                // The piece after a knot has the points that the knot's last copy leads.
                let start = first(pair[0]) - self.degree;
                Bezier::new(all.points[start..=start + self.degree].to_vec())
            })
            .collect()
    }

    /// The derivative by the parameter: a spline of one degree less.
    ///
    /// # Errors
    /// If the degree is 1: the derivative jumps at the knots, and is no spline of this kind.
    pub fn derivative(&self) -> Result<Self, String> {
        if self.degree == 1 {
            return Err("the derivative of a spline of degree 1 jumps".into());
        }
        let degree = self.degree as f64;
        let points = self
            .points
            .windows(2)
            .enumerate()
            .map(|(index, pair)| {
                let length = self.knots[index + self.degree + 1] - self.knots[index + 1];
                (pair[1] - pair[0]) * if length > 0.0 { degree / length } else { 0.0 }
            })
            .collect();
        Self::new(self.degree - 1, self.knots[1..self.knots.len() - 1].to_vec(), points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, DVec4};

    fn points() -> Vec<DVec3> {
        [[0.0, 0.0, 0.0], [1.0, 2.0, 0.5], [2.0, -1.0, 1.0], [3.0, 1.0, -1.0], [4.0, 0.0, 2.0], [2.0, 3.0, 1.0]]
            .map(DVec3::from_array)
            .to_vec()
    }

    /// The sum over Bernstein polynomials.
    fn bernstein(points: &[DVec3], t: f64) -> DVec3 {
        let n = points.len() as u32 - 1;
        let choose = |k: u32| (0..k).fold(1.0, |product, i| product * f64::from(n - i) / f64::from(i + 1));
        (0..=n).map(|k| points[k as usize] * (choose(k) * t.powi(k as i32) * (1.0 - t).powi((n - k) as i32))).sum()
    }

    /// The basis function by its recursion (Cox and de Boor, 1972).
    fn basis(knots: &[f64], i: usize, degree: usize, u: f64, end: f64) -> f64 {
        if degree == 0 {
            // The end belongs to the last piece.
            let holds =
                if u == end { knots[i] < end && knots[i + 1] == end } else { knots[i] <= u && u < knots[i + 1] };
            return f64::from(u8::from(holds));
        }
        let part = |above: f64, below: f64, rest: f64| if below == 0.0 { 0.0 } else { above / below * rest };
        part(u - knots[i], knots[i + degree] - knots[i], basis(knots, i, degree - 1, u, end))
            + part(
                knots[i + degree + 1] - u,
                knots[i + degree + 1] - knots[i + 1],
                basis(knots, i + 1, degree - 1, u, end),
            )
    }

    #[test]
    fn casteljau_is_the_sum_over_bernstein_polynomials() {
        for count in 1..=6 {
            let curve = Bezier::new(points()[..count].to_vec());
            let [left, right] = curve.split(0.3);
            let (slope, higher) = (curve.derivative(), curve.elevated());
            for step in 0..=20 {
                let t = f64::from(step) / 20.0;
                let p = curve.at(t);
                assert!(p.distance(bernstein(curve.points(), t)) < 1e-12);
                assert!(left.at(t).distance(curve.at(0.3 * t)) < 1e-12);
                assert!(right.at(t).distance(curve.at(0.3 + 0.7 * t)) < 1e-12);
                assert!(higher.at(t).distance(p) < 1e-12 && higher.degree() == count);
                let difference = (curve.at(t + 1e-6) - curve.at(t - 1e-6)) / 2e-6;
                assert!(slope.at(t).distance(difference) < 1e-6);
            }
        }
    }

    fn splines() -> Vec<BSpline<DVec3>> {
        let mut splines: Vec<_> =
            (1..=4).map(|degree| BSpline::clamped(degree, points()).expect("enough points")).collect();
        splines.extend((1..=3).map(|degree| BSpline::closed(degree, &points()).expect("enough points")));
        let round = [-1.0, -0.5, 0.3, 0.3, 1.1, 2.0, 2.5];
        splines.extend((2..=3).map(|degree| BSpline::closed_with(degree, &round, &points()).expect("a sound spline")));
        splines.push(
            BSpline::new(2, vec![0.0, 0.0, 0.0, 0.3, 0.3, 2.0, 2.5, 2.5, 3.0], points()).expect("a sound spline"),
        );
        splines
    }

    #[test]
    fn de_boor_is_the_sum_over_basis_functions() {
        for spline in splines() {
            let (low, high) = spline.domain();
            for step in 0..=40 {
                let u = low + (high - low) * f64::from(step) / 40.0;
                let sum: DVec3 = (0..spline.points().len())
                    .map(|i| spline.points()[i] * basis(spline.knots(), i, spline.degree(), u, high))
                    .sum();
                assert!(spline.at(u).distance(sum) < 1e-12, "{spline:?} at {u}");
            }
        }
    }

    #[test]
    fn knots_and_pieces_change_nothing() {
        for spline in splines() {
            let (low, high) = spline.domain();
            let more = spline.inserted(low + 0.37 * (high - low)).and_then(|s| s.inserted(low + 0.81 * (high - low)));
            let more = more.expect("two knots more");
            assert_eq!(more.points().len(), spline.points().len() + 2);
            let slope = spline.derivative();
            for step in 1..40 {
                let u = low + (high - low) * f64::from(step) / 40.0;
                assert!(spline.at(u).distance(more.at(u)) < 1e-12);
                if let (Ok(slope), true) = (&slope, spline.degree() > 2) {
                    let difference = (spline.at(u + 1e-6) - spline.at(u - 1e-6)) / 2e-6;
                    assert!(slope.at(u).distance(difference) < 1e-5);
                }
            }
            let mut knots: Vec<f64> =
                spline.knots().iter().copied().filter(|knot| (low..=high).contains(knot)).collect();
            knots.dedup();
            let pieces = spline.beziers();
            assert_eq!(pieces.len(), knots.len() - 1);
            for (piece, pair) in pieces.iter().zip(knots.windows(2)) {
                assert_eq!(piece.degree(), spline.degree());
                for share in [0.0, 0.2, 0.7, 1.0] {
                    let there = spline.at(pair[0] + share * (pair[1] - pair[0]));
                    assert!(piece.at(share).distance(there) < 1e-12, "{spline:?}");
                }
            }
        }
    }

    #[test]
    fn rounds_join_as_smoothly_as_the_degree_allows() {
        let round = [-1.0, -0.5, 0.3, 0.7, 1.1, 2.0, 2.5];
        let spline = BSpline::closed_with(3, &round, &points()).expect("a sound spline");
        let slope = spline.derivative().expect("of degree 2");
        let bend = slope.derivative().expect("of degree 1");
        assert_eq!(spline.domain(), (-1.0, 2.5));
        for one in [&spline, &slope, &bend] {
            assert!(one.at(-1.0).distance(one.at(2.5)) < 1e-12, "{one:?}");
        }
    }

    #[test]
    fn a_rational_spline_is_a_circle() {
        let w = 0.5_f64.sqrt();
        let corners = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [-1.0, 1.0], [-1.0, 0.0]];
        let weighted = corners.iter().enumerate().map(|(index, [x, y])| {
            let w = if index % 2 == 1 { w } else { 1.0 };
            DVec4::new(x * w, y * w, 0.0, w)
        });
        let spline = BSpline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0], weighted.collect()).expect("sound");
        for step in 0..=40 {
            let p = spline.at(f64::from(step) / 20.0);
            assert!(((p.x / p.w).hypot(p.y / p.w) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn splines_that_are_none_are_refused() {
        for (degree, knots) in [
            (2, vec![0.0, 1.0, 2.0]),
            (2, vec![0.0, 1.0, 2.0, 3.0, 2.5, 4.0, 5.0, 6.0, 7.0]),
            (2, vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0]),
            (0, vec![0.0; 7]),
            (6, vec![0.0; 13]),
        ] {
            assert!(BSpline::new(degree, knots.clone(), points()).is_err(), "{degree} {knots:?}");
        }
        for knots in [
            vec![0.0, 1.0, 2.0],
            vec![0.0, 1.0, 2.0, 1.5, 4.0, 5.0, 6.0],
            vec![0.0, 1.0, 1.0, 1.0, 4.0, 5.0, 6.0],
            vec![0.0, 0.0, 1.0, 2.0, 4.0, 6.0, 6.0],
            vec![0.0; 7],
        ] {
            assert!(BSpline::closed_with(2, &knots, &points()).is_err(), "{knots:?}");
        }
        let spline = BSpline::clamped(2, points()).expect("sound");
        assert!(spline.inserted(-1.0).is_err() && spline.inserted(0.0).is_err());
    }
}
