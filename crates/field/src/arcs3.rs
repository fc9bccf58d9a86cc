//! Curves as chains of circular arcs, each of which lies in a plane of its own.
//!
//! A curve is split until each piece is as near to a biarc, two arcs that go over into one another with the curve's directions at
//! both ends, as is asked for (Bolton, "Biarc curves", 1975). Errors fall with the cube of the pieces' length, so that few arcs do.

use crate::curve::Bezier;
use crate::scalar::Scalar;
use glam::{DVec2, DVec3, DVec4};

/// A curve of which both halves are curves of the same kind.
pub(crate) trait Divisible: Clone {
    /// Points of which the first and the last are its ends, where it leads from or to the nearest one in order that lies elsewhere.
    fn controls(&self) -> Vec<DVec3>;

    /// The point at `t`, 0 for the beginning and 1 for the end.
    fn at(&self, t: f64) -> DVec3;

    /// The curves before and after the middle, each over 0 to 1.
    fn halves(&self) -> [Self; 2];
}

impl Divisible for Bezier<DVec3> {
    fn controls(&self) -> Vec<DVec3> {
        self.points().to_vec()
    }

    fn at(&self, t: f64) -> DVec3 {
        self.at(t)
    }

    fn halves(&self) -> [Self; 2] {
        self.split(0.5)
    }
}

/// A rational Bézier curve, by control points `(w x, w y, w z, w)` with weights above 0.
#[derive(Clone, Debug)]
pub(crate) struct Rational(pub(crate) Bezier<DVec4>);

impl Divisible for Rational {
    fn controls(&self) -> Vec<DVec3> {
        self.0.points().iter().map(|point| point.truncate() / point.w).collect()
    }

    fn at(&self, t: f64) -> DVec3 {
        let point = self.0.at(t);
        point.truncate() / point.w
    }

    fn halves(&self) -> [Self; 2] {
        self.0.split(0.5).map(Self)
    }
}

/// Pieces of a curve are halved at most so often.
const DEEPEST: u32 = 12;

/// At so many places between both ends a piece is compared with its biarc.
const PLACES: u32 = 7;

/// Directions that differ by less, in the square, are the same.
const PARALLEL: f64 = 1e-18;

/// No single arc turns by more than a quarter and what rounding adds, so that none is taken for the other way round.
const MOST_TURN: f64 = std::f64::consts::FRAC_PI_2 * 1.01;

/// Where the directions at both ends of a biarc differ by less, in the square, the equation for its joint is linear.
const SAME_WAY: f64 = 1e-9;

/// How many constants an arc has; see [`Arc3::constants`].
pub(crate) const ROW: usize = 13;

/// Where half the length of the chord stands among them, after which come sine, cosine, and radius.
pub(crate) const HALF: usize = 9;

/// An arc from point to point that starts in a direction, of length 1; a straight edge if that is the direction of the other point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc3 {
    pub(crate) from: DVec3,
    pub(crate) to: DVec3,
    pub(crate) direction: DVec3,
}

impl Arc3 {
    /// A straight edge; the points may be the same.
    pub(crate) fn straight(from: DVec3, to: DVec3) -> Self {
        Self { from, to, direction: (to - from).normalize_or(DVec3::X) }
    }

    /// An arc in the plane of x and y that turns to the left by an angle, 0 for a straight edge.
    pub(crate) fn flat(from: DVec2, to: DVec2, turn: f64) -> Self {
        let direction = DVec2::from_angle(-turn / 2.0).rotate((to - from).normalize_or(DVec2::X));
        Self { from: from.extend(0.0), to: to.extend(0.0), direction: direction.extend(0.0) }
    }

    /// Direction of the chord, that across it towards the arc, and half of the angle that it turns by.
    fn frame(&self) -> (DVec3, DVec3, f64) {
        let along = (self.to - self.from).normalize_or(self.direction);
        let across = self.direction - along * self.direction.dot(along);
        if across.length_squared() < PARALLEL {
            return (along, along.any_orthonormal_vector(), 0.0);
        }
        let half_turn = libm::atan2(across.length(), self.direction.dot(along));
        // Of a short difference, rounding errors are a large part: once more, so that both are at a right angle.
        let across = across.normalize();
        (along, (across - along * across.dot(along)).normalize(), half_turn)
    }

    /// Half of the angle that it turns by; 0 for a straight edge.
    pub(crate) fn half_turn(&self) -> f64 {
        self.frame().2
    }

    /// The direction in which it ends, of length 1.
    pub(crate) fn end_direction(&self) -> DVec3 {
        // At both ends it makes the same angle with the chord.
        let along = self.frame().0;
        along * (2.0 * self.direction.dot(along)) - self.direction
    }

    /// The direction across the chord on whose side of it the arc lies.
    pub(crate) fn side_of_chord(&self) -> DVec3 {
        self.frame().1
    }

    /// The middle of the chord, its direction, and that across it towards the arc; half its length; sine and cosine of half the
    /// angle that the arc turns by; its radius, 0 for a straight edge.
    pub(crate) fn constants(&self) -> [f64; ROW] {
        let (along, across, half_turn) = self.frame();
        let (middle, half) = ((self.from + self.to) / 2.0, self.from.distance(self.to) / 2.0);
        let (sin, cos) = libm::sincos(half_turn);
        let radius = if half_turn > 0.0 && half > 0.0 { half / sin } else { 0.0 };
        let (sin, cos) = if radius > 0.0 { (sin, cos) } else { (0.0, 1.0) };
        let [mx, my, mz] = middle.to_array();
        let [ax, ay, az] = along.to_array();
        let [nx, ny, nz] = across.to_array();
        [mx, my, mz, ax, ay, az, nx, ny, nz, half, sin, cos, radius]
    }

    /// Its length.
    pub(crate) fn length(&self) -> f64 {
        let (chord, half_turn) = (self.from.distance(self.to), self.half_turn());
        if half_turn > 0.0 { chord * half_turn / libm::sin(half_turn) } else { chord }
    }

    /// The share of its length that lies before the point nearest to `p`.
    pub(crate) fn share_before(&self, p: DVec3) -> f64 {
        let row = self.constants();
        let (q, along, across) =
            (p - DVec3::from_slice(&row), DVec3::from_slice(&row[3..]), DVec3::from_slice(&row[6..]));
        let [half, cos, radius] = [row[9], row[11], row[12]];
        let (place, end) = if radius > 0.0 {
            (libm::atan2(q.dot(along), q.dot(across) + radius * cos), self.half_turn())
        } else {
            (q.dot(along), half)
        };
        if end > 0.0 { (place / end).clamp(-1.0, 1.0) / 2.0 + 0.5 } else { 0.0 }
    }

    /// The distance of a point.
    pub(crate) fn distance(&self, p: DVec3) -> f64 {
        let row = self.constants();
        let q = p - DVec3::from_slice(&row);
        let (along, across) = (DVec3::from_slice(&row[3..]), DVec3::from_slice(&row[6..]));
        let [half, sin, cos, radius] = [row[9], row[10], row[11], row[12]];
        let (s, t, out) = (q.dot(along).abs(), q.dot(across), q.dot(along.cross(across)));
        if sin * t + cos * (half - s) <= 0.0 {
            return DVec3::new(s - half, t, out).length();
        }
        let gap = if radius > 0.0 { libm::hypot(s, t + radius * cos) - radius } else { t };
        libm::hypot(gap, out)
    }
}

/// Arcs have larger radii than this. That of straight edges is 0, of which enclosures know no more than that it is less.
const LEAST_RADIUS: f64 = 1e-30;

/// Whether an edge of this radius, one of its constants, is an arc.
#[inline(always)]
pub(crate) fn is_arc<S: Scalar>(radius: S) -> S::Mask {
    radius.lift(LEAST_RADIUS).lt(radius)
}

/// The largest of `direction . p` over the points of an arc with these constants.
pub(crate) fn reach(row: &[f64], direction: DVec3) -> f64 {
    let (middle, along, across) = (DVec3::from_slice(row), DVec3::from_slice(&row[3..]), DVec3::from_slice(&row[6..]));
    let &[half, _, cos, radius] = &row[HALF..ROW] else { unreachable!("four numbers") };
    let (forward, sideways) = (direction.dot(along), direction.dot(across));
    let flat = libm::hypot(forward, sideways);
    // The farthest point of the circle, if it lies on the arc: less than half of the turn from the arc's middle.
    if radius > 0.0 && sideways > cos * flat {
        return direction.dot(middle - across * (radius * cos)) + radius * flat;
    }
    direction.dot(middle) + half * forward.abs()
}

/// Arcs that are at most `tolerance` away from a curve.
pub(crate) fn of_curve<C: Divisible>(curve: &C, tolerance: f64) -> Vec<Arc3> {
    let fits = |piece: &C, arcs: &[Arc3]| {
        places().all(|place| {
            let point = piece.at(place);
            arcs.iter().map(|arc| arc.distance(point)).fold(f64::INFINITY, f64::min) <= tolerance
        })
    };
    pieces(curve, &fits).into_iter().flat_map(|(_, arcs)| arcs).collect()
}

/// Where between both ends a piece of a curve is compared with its arcs.
pub(crate) fn places() -> impl Iterator<Item = f64> {
    (1..=PLACES).map(|place| f64::from(place) / f64::from(PLACES + 1))
}

/// A curve in pieces, each with the arcs that stand for it: as few as `fits` lets pass. A piece that is one point has none.
pub(crate) fn pieces<C: Divisible>(curve: &C, fits: &impl Fn(&C, &[Arc3]) -> bool) -> Vec<(C, Vec<Arc3>)> {
    let mut pieces = Vec::new();
    halve(curve.clone(), fits, DEEPEST, &mut pieces);
    pieces
}

fn halve<C: Divisible>(curve: C, fits: &impl Fn(&C, &[Arc3]) -> bool, depth: u32, pieces: &mut Vec<(C, Vec<Arc3>)>) {
    let controls = curve.controls();
    let (first, last) = (controls[0], controls[controls.len() - 1]);
    if depth == 0 {
        return pieces.push((curve, vec![Arc3::straight(first, last)]));
    }
    if controls.iter().all(|point| *point == first) {
        return pieces.push((curve, Vec::new()));
    }
    if let Some(arcs) = biarc(&controls) {
        let is_tame = arcs.iter().all(|arc| 2.0 * arc.half_turn() <= MOST_TURN);
        if is_tame && fits(&curve, &arcs) {
            let is_straight = arcs.iter().all(|arc| arc.half_turn() == 0.0);
            let arcs = if is_straight { vec![Arc3::straight(first, last)] } else { arcs.to_vec() };
            return pieces.push((curve, arcs.into_iter().filter(|arc| arc.from != arc.to).collect()));
        }
    }
    for half in curve.halves() {
        halve(half, fits, depth - 1, pieces);
    }
}

/// Two arcs with the directions of a curve at its ends, of which both start equally far from where they meet along these.
fn biarc(points: &[DVec3]) -> Option<[Arc3; 2]> {
    let (a, d) = (points[0], points[points.len() - 1]);
    let first = points.iter().find(|point| **point != a)?;
    let last = points.iter().rev().find(|point| **point != d)?;
    let (first, last) = ((*first - a).normalize(), (d - *last).normalize());
    let (chord, sum) = (d - a, first + last);
    let (product, opening) = (chord.dot(sum), 2.0 * (1.0 - first.dot(last)));
    let length = if opening < SAME_WAY {
        let along = chord.dot(last);
        if along <= 0.0 {
            return None;
        }
        chord.length_squared() / (4.0 * along)
    } else {
        ((product * product + opening * chord.length_squared()).sqrt() - product) / opening
    };
    let joint = (a + d + (first - last) * length) / 2.0;
    // At the joint both arcs have the direction of the line between the ends of the two tangents.
    let middle = (d - last * length - (a + first * length)).normalize_or(first);
    Some([Arc3 { from: a, to: joint, direction: first }, Arc3 { from: joint, to: d, direction: middle }])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcs_are_near_their_curve_and_join() {
        const TOLERANCE: f64 = 1e-4;
        let p = DVec3::new;
        for (points, most) in [
            (vec![p(0.0, 0.0, 0.0), p(1.0, 2.0, 0.5), p(2.0, -1.0, 1.0), p(3.0, 1.0, -1.0)], 120),
            (vec![p(0.0, 0.0, 0.0), p(0.0, 1.0, 1.0), p(1.0, 1.0, 0.0)], 40),
            (vec![p(0.0, 0.0, 0.0), p(1.0, 0.0, 1.0)], 2),
            (vec![p(0.0, 0.0, 0.0), p(0.0, 0.0, 0.0), p(1.0, 0.0, 1.0), p(2.0, 1.0, 1.0)], 80),
            (vec![p(0.0, 0.0, 0.0), p(2.0, 0.0, 0.0), p(-1.0, 0.0, 0.0), p(1.0, 0.0, 0.0)], 80),
            (vec![p(1.0, 1.0, 1.0); 3], 0),
            // In the plane: a bow, an s, a loop, a cusp, a straight edge, no handles, one point, and to and fro.
            (vec![p(0.0, 0.0, 0.0), p(0.3, 0.6, 0.0), p(0.9, 0.5, 0.0), p(1.0, 0.0, 0.0)], 24),
            (vec![p(0.0, 0.0, 0.0), p(1.0, 0.2, 0.0), p(-0.2, 0.9, 0.0), p(1.0, 1.0, 0.0)], 40),
            (vec![p(0.0, 0.0, 0.0), p(1.5, 1.0, 0.0), p(-0.5, 1.0, 0.0), p(1.0, 0.0, 0.0)], 48),
            (vec![p(0.0, 0.0, 0.0), p(1.0, 1.0, 0.0), p(0.0, 1.0, 0.0), p(1.0, 0.0, 0.0)], 64),
            (vec![p(0.0, 0.0, 0.0), p(0.2, 0.2, 0.0), p(0.7, 0.7, 0.0), p(1.0, 1.0, 0.0)], 2),
            (vec![p(0.0, 0.0, 0.0), p(0.0, 0.0, 0.0), p(1.0, 0.5, 0.0), p(1.0, 0.5, 0.0)], 2),
            (vec![p(0.2, 0.3, 0.0); 4], 0),
            (vec![p(0.0, 0.0, 0.0), p(2.0, 0.0, 0.0), p(-1.0, 0.0, 0.0), p(1.0, 0.0, 0.0)], 64),
        ] {
            let curve = Bezier::new(points.clone());
            let arcs = of_curve(&curve, TOLERANCE);
            assert!(arcs.len() <= most, "{points:?}: {} arcs", arcs.len());
            for pair in arcs.windows(2) {
                assert!(pair[0].to.distance(pair[1].from) < 1e-12);
            }
            for step in 0..=1000 {
                let point = curve.at(f64::from(step) / 1000.0);
                let gap = arcs.iter().map(|arc| arc.distance(point)).fold(f64::INFINITY, f64::min);
                assert!(arcs.is_empty() || gap < 1.5 * TOLERANCE, "{points:?}: {gap}");
            }
        }
    }

    #[test]
    fn a_rational_quarter_of_a_circle_is_two_arcs_of_it() {
        let half = 0.5_f64.sqrt();
        let points =
            vec![DVec4::new(2.0, 0.0, 1.0, 1.0), DVec4::new(2.0, 2.0, 1.0, 1.0) * half, DVec4::new(0.0, 2.0, 1.0, 1.0)];
        let arcs = of_curve(&Rational(Bezier::new(points)), 1e-9);
        assert_eq!(arcs.len(), 2);
        for arc in arcs {
            assert!(
                (arc.constants()[12] - 2.0).abs() < 1e-12 && (arc.length() - std::f64::consts::FRAC_PI_2).abs() < 1e-12
            );
        }
    }

    #[test]
    fn arcs_reach_as_far_as_their_points() {
        let arc = Arc3 {
            from: DVec3::new(0.2, 0.1, 0.3),
            to: DVec3::new(1.0, 0.4, -0.2),
            direction: DVec3::new(0.2, 1.0, 0.6).normalize(),
        };
        let row = arc.constants();
        let (along, across, half_turn) = arc.frame();
        let centre = DVec3::from_slice(&row) - across * (row[12] * row[11]);
        let points: Vec<DVec3> = (0..=4000)
            .map(|step| half_turn * (f64::from(step) / 2000.0 - 1.0))
            .map(|angle| centre + (along * angle.sin() + across * angle.cos()) * row[12])
            .collect();
        assert!(points[0].distance(arc.from) < 1e-12 && points[4000].distance(arc.to) < 1e-12);
        let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        assert!((arc.length() - length).abs() < 1e-6);
        for (step, point) in points.iter().enumerate() {
            assert!((arc.share_before(*point) - step as f64 / 4000.0).abs() < 1e-9);
        }
        for direction in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z, DVec3::ONE] {
            let farthest = points.iter().map(|point| point.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
            assert!((reach(&row, direction) - farthest).abs() < 1e-6, "{direction}");
        }
    }
}
