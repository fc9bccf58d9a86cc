//! Curves in space as chains of circular arcs, by biarcs as in the plane (see `arcs.rs`): each arc lies in a plane of its own.

use crate::curve::Bezier;
use glam::{DVec2, DVec3};

/// Pieces of a curve are halved at most so often.
const DEEPEST: u32 = 12;

/// At so many places between both ends a piece is compared with its biarc.
const PLACES: u32 = 7;

/// Directions that differ by less, in the square, are the same.
const PARALLEL: f64 = 1e-18;

/// No single arc turns by more.
const MOST_TURN: f64 = std::f64::consts::FRAC_PI_2;

/// How many constants an arc has; see [`Arc3::constants`].
pub(crate) const ROW: usize = 13;

/// An arc from point to point that starts in a direction, of length 1; a straight edge if that is the direction of the other point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc3 {
    pub(crate) from: DVec3,
    pub(crate) to: DVec3,
    direction: DVec3,
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
        (along, across.normalize(), libm::atan2(across.length(), self.direction.dot(along)))
    }

    /// The middle of the chord, its direction, and that across it towards the arc; half its length; sine and cosine of half the angle
    /// that the arc turns by; its radius, 0 for a straight edge.
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

    fn distance(&self, p: DVec3) -> f64 {
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

/// The largest of `direction . p` over the points of an arc with these constants.
pub(crate) fn reach(row: &[f64], direction: DVec3) -> f64 {
    let (middle, along, across) = (DVec3::from_slice(row), DVec3::from_slice(&row[3..]), DVec3::from_slice(&row[6..]));
    let &[half, _, cos, radius] = &row[9..ROW] else { unreachable!("four numbers") };
    let (forward, sideways) = (direction.dot(along), direction.dot(across));
    let flat = libm::hypot(forward, sideways);
    // The farthest point of the circle, if it lies on the arc: less than half of the turn from the arc's middle.
    if radius > 0.0 && sideways > cos * flat {
        return direction.dot(middle - across * (radius * cos)) + radius * flat;
    }
    direction.dot(middle) + half * forward.abs()
}

/// Arcs that are at most `tolerance` away from a Bézier curve.
pub(crate) fn of_curve(curve: &Bezier<DVec3>, tolerance: f64) -> Vec<Arc3> {
    let mut arcs = Vec::new();
    piece(curve, tolerance, DEEPEST, &mut arcs);
    arcs
}

fn piece(curve: &Bezier<DVec3>, tolerance: f64, depth: u32, arcs: &mut Vec<Arc3>) {
    let points = curve.points();
    let last = points[points.len() - 1];
    if depth == 0 {
        return arcs.push(Arc3::straight(points[0], last));
    }
    if points.iter().all(|point| *point == points[0]) {
        return;
    }
    if let Some(found) = biarc(points) {
        let is_near = (1..=PLACES).all(|place| {
            let point = curve.at(f64::from(place) / f64::from(PLACES + 1));
            found.iter().map(|arc| arc.distance(point)).fold(f64::INFINITY, f64::min) <= tolerance
        });
        if is_near && found.iter().all(|arc| 2.0 * arc.frame().2 <= MOST_TURN * 1.01) {
            return arcs.extend(found.into_iter().filter(|arc| arc.from != arc.to));
        }
    }
    for half in curve.split(0.5) {
        piece(&half, tolerance, depth - 1, arcs);
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
    let length = if opening < 1e-9 {
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
        for direction in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z, DVec3::ONE] {
            let farthest = points.iter().map(|point| point.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
            assert!((reach(&row, direction) - farthest).abs() < 1e-6, "{direction}");
        }
    }
}
