//! Figures bounded by Bézier curves, and by others with known directions, as lines of straight edges and arcs.
//!
//! A curve is split until each piece is as near to a biarc, two arcs that go over into one another with the curve's directions at
//! both ends, as is asked for (Bolton, "Biarc curves", 1975). Errors fall with the cube of the pieces' length, so that few arcs do.

use glam::DVec2;

/// Pieces of a curve are halved at most so often.
const DEEPEST: u32 = 12;

/// At so many places between both ends a piece is compared with its biarc.
const PLACES: u32 = 7;

/// An arc that turns by less is a straight edge.
const STRAIGHT: f64 = 1e-9;

/// A curve: its point at a parameter, and its direction there.
pub(crate) type Curve<'a> = &'a dyn Fn(f64) -> (DVec2, DVec2);

/// Closed lines under construction, in the form of the arguments of an outline.
#[derive(Debug)]
pub(crate) struct Lines {
    /// The finished ones: corners of x, y, turn, and whether a line ends.
    arguments: Vec<f64>,
    /// Corners of the one that is being drawn.
    corners: Vec<[f64; 3]>,
    start: DVec2,
    at: DVec2,
    tolerance: f64,
}

impl Lines {
    /// No lines; those that come are at most so far from the curves that they stand for.
    pub(crate) fn new(tolerance: f64) -> Self {
        Self { arguments: Vec::new(), corners: Vec::new(), start: DVec2::ZERO, at: DVec2::ZERO, tolerance }
    }

    /// Closes the line that is being drawn, and starts another one.
    pub(crate) fn move_to(&mut self, to: DVec2) {
        self.close();
        (self.start, self.at) = (to, to);
    }

    /// A straight edge.
    pub(crate) fn line_to(&mut self, to: DVec2) {
        if to != self.at {
            self.corners.push([self.at.x, self.at.y, 0.0]);
            self.at = to;
        }
    }

    /// A quadratic curve.
    pub(crate) fn quadratic_to(&mut self, control: DVec2, to: DVec2) {
        let towards = |end: DVec2| end + (control - end) * (2.0 / 3.0);
        self.cubic_to(towards(self.at), towards(to), to);
    }

    /// A cubic curve.
    pub(crate) fn cubic_to(&mut self, first: DVec2, second: DVec2, to: DVec2) {
        self.piece([self.at, first, second, to], DEEPEST);
        self.at = to;
    }

    /// An arc that turns to the left by this angle.
    pub(crate) fn arc_to(&mut self, to: DVec2, turn: f64) {
        self.corners.push([self.at.x, self.at.y, turn]);
        self.at = to;
    }

    /// A smooth curve, along its parameter from one value to another. Its directions, of any length but 0, are those in which it is drawn.
    pub(crate) fn follow(&mut self, curve: Curve<'_>, [from, to]: [f64; 2]) {
        self.stretch(curve, [from, to], DEEPEST);
        self.at = curve(to).0;
    }

    /// Closes the line that is being drawn.
    pub(crate) fn close(&mut self) {
        self.line_to(self.start);
        let last = self.corners.len().saturating_sub(1);
        // Straight there and back again surrounds nothing.
        let is_figure = last > 1 || self.corners.iter().any(|corner| corner[2] != 0.0);
        if last > 0 && is_figure {
            for (index, [x, y, turn]) in self.corners.iter().enumerate() {
                self.arguments.extend([*x, *y, *turn, f64::from(u8::from(index == last))]);
            }
        }
        self.corners.clear();
    }

    /// The arguments of the outline.
    pub(crate) fn finish(mut self) -> Vec<f64> {
        self.close();
        self.arguments
    }

    /// The corners of the line that is being drawn, which stays open, and its end.
    pub(crate) fn open(self) -> (Vec<[f64; 3]>, DVec2) {
        (self.corners, self.at)
    }

    fn piece(&mut self, curve: [DVec2; 4], depth: u32) {
        let [a, .., d] = curve;
        let Some(arcs) = biarc_of(curve) else {
            // All of it is one point, or the directions at its ends say nothing.
            match depth {
                0 => self.corners.extend((a != d).then_some([a.x, a.y, 0.0])),
                _ if a == d && curve[1] == a && curve[2] == a => {}
                _ => self.halves(curve, depth),
            }
            return;
        };
        if depth == 0 || self.fits(&arcs, |share| at(curve, share)) {
            self.push(&arcs);
        } else {
            self.halves(curve, depth);
        }
    }

    /// A part of a curve: two arcs, or those of its halves.
    fn stretch(&mut self, curve: Curve<'_>, [low, high]: [f64; 2], depth: u32) {
        let ((from, first), (to, last)) = (curve(low), curve(high));
        let point = |share: f64| curve(low + (high - low) * share).0;
        match biarc([from, to], [first.normalize(), last.normalize()]) {
            Some(arcs) if depth == 0 || self.fits(&arcs, point) => self.push(&arcs),
            None if depth == 0 => self.corners.push([from.x, from.y, 0.0]),
            _ => {
                let middle = (low + high) / 2.0;
                self.stretch(curve, [low, middle], depth - 1);
                self.stretch(curve, [middle, high], depth - 1);
            }
        }
    }

    /// Whether arcs are near enough to the curve that they stand for.
    fn fits(&self, arcs: &[Arc], point: impl Fn(f64) -> DVec2) -> bool {
        let is_near = (1..=PLACES).all(|place| {
            let point = point(f64::from(place) / f64::from(PLACES + 1));
            arcs.iter().map(|arc| arc.distance(point)).fold(f64::INFINITY, f64::min) <= self.tolerance
        });
        // No single arc goes far around, so that none is taken for the other way round.
        is_near && arcs.iter().all(|arc| arc.turn.abs() < std::f64::consts::FRAC_PI_2 * 1.01)
    }

    fn push(&mut self, arcs: &[Arc]) {
        for arc in arcs.iter().filter(|arc| arc.from != arc.to) {
            let turn = if arc.turn.abs() < STRAIGHT { 0.0 } else { arc.turn };
            self.corners.push([arc.from.x, arc.from.y, turn]);
        }
    }

    fn halves(&mut self, [a, b, c, d]: [DVec2; 4], depth: u32) {
        let (ab, bc, cd) = ((a + b) / 2.0, (b + c) / 2.0, (c + d) / 2.0);
        let (abc, bcd) = ((ab + bc) / 2.0, (bc + cd) / 2.0);
        let middle = (abc + bcd) / 2.0;
        self.piece([a, ab, abc, middle], depth - 1);
        self.piece([middle, bcd, cd, d], depth - 1);
    }
}

fn at([a, b, c, d]: [DVec2; 4], t: f64) -> DVec2 {
    let s = 1.0 - t;
    a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
}

/// A circular arc from point to point that turns to the left by an angle.
#[derive(Clone, Copy, Debug)]
struct Arc {
    from: DVec2,
    to: DVec2,
    turn: f64,
}

impl Arc {
    fn distance(&self, p: DVec2) -> f64 {
        let chord = self.to - self.from;
        let length = chord.length();
        if length == 0.0 {
            return p.distance(self.from);
        }
        let (along, normal) = (chord / length, -chord.perp() / length * f64::copysign(1.0, self.turn));
        let (s, t) = ((p - self.from).dot(along) - length / 2.0, (p - self.from).dot(normal));
        let (sin, cos) = libm::sincos(self.turn.abs() / 2.0);
        let half = length / 2.0;
        if sin * t + cos * (half - s.abs()) <= 0.0 {
            return libm::hypot(s.abs() - half, t);
        }
        if sin < STRAIGHT {
            return t.abs();
        }
        let (radius, to_centre) = (half / sin, half / sin * cos);
        let excess = (s - half) * (s + half) + t * (t + 2.0 * to_centre);
        (excess / (libm::hypot(s, t + to_centre) + radius)).abs()
    }
}

/// The biarc of a Bézier curve, if it has directions at its ends.
fn biarc_of([a, b, c, d]: [DVec2; 4]) -> Option<[Arc; 2]> {
    let direction = |ways: [DVec2; 3]| ways.into_iter().find(|way| *way != DVec2::ZERO).map(DVec2::normalize);
    biarc([a, d], [direction([b - a, c - a, d - a])?, direction([d - c, d - b, d - a])?])
}

/// Two arcs between points with these directions there, of length 1. Both start equally far from where they meet along these.
fn biarc([a, d]: [DVec2; 2], [first, last]: [DVec2; 2]) -> Option<[Arc; 2]> {
    let (chord, sum) = (d - a, first + last);
    let (product, opening) = (chord.dot(sum), 2.0 * (1.0 - first.dot(last)));
    let length = if opening < STRAIGHT {
        let along = chord.dot(last);
        if along <= 0.0 {
            return None;
        }
        chord.length_squared() / (4.0 * along)
    } else {
        ((product * product + opening * chord.length_squared()).sqrt() - product) / opening
    };
    let joint = (a + d + (first - last) * length) / 2.0;
    let turn = |from: DVec2, to: DVec2| 2.0 * libm::atan2(from.perp_dot(to), from.dot(to));
    Some([
        Arc { from: a, to: joint, turn: turn(first, joint - a) },
        Arc { from: joint, to: d, turn: turn(d - joint, last) },
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 1e-4;

    /// The largest distance of points of a curve from the arcs that stand for it, and how many those are.
    fn gap(curve: [DVec2; 4]) -> (f64, usize) {
        let mut lines = Lines::new(TOLERANCE);
        lines.move_to(curve[0]);
        lines.cubic_to(curve[1], curve[2], curve[3]);
        let corners = lines.corners.clone();
        let end = |index: usize| corners.get(index + 1).map_or(curve[3], |c| DVec2::new(c[0], c[1]));
        let arcs: Vec<Arc> = corners
            .iter()
            .enumerate()
            .map(|(index, c)| Arc { from: DVec2::new(c[0], c[1]), to: end(index), turn: c[2] })
            .collect();
        let gap = (0..=2000)
            .map(|step| at(curve, f64::from(step) / 2000.0))
            .map(|p| arcs.iter().map(|arc| arc.distance(p)).fold(f64::INFINITY, f64::min))
            .fold(0.0, f64::max);
        (gap, arcs.len())
    }

    #[test]
    fn arcs_are_near_their_curve() {
        let p = DVec2::new;
        for (name, curve, most) in [
            ("a bow", [p(0.0, 0.0), p(0.3, 0.6), p(0.9, 0.5), p(1.0, 0.0)], 24),
            ("an s", [p(0.0, 0.0), p(1.0, 0.2), p(-0.2, 0.9), p(1.0, 1.0)], 40),
            ("a loop", [p(0.0, 0.0), p(1.5, 1.0), p(-0.5, 1.0), p(1.0, 0.0)], 48),
            ("a cusp", [p(0.0, 0.0), p(1.0, 1.0), p(0.0, 1.0), p(1.0, 0.0)], 64),
            ("a straight edge", [p(0.0, 0.0), p(0.2, 0.2), p(0.7, 0.7), p(1.0, 1.0)], 2),
            ("no handles", [p(0.0, 0.0), p(0.0, 0.0), p(1.0, 0.5), p(1.0, 0.5)], 2),
            ("one point", [p(0.2, 0.3); 4], 0),
            ("to and fro", [p(0.0, 0.0), p(2.0, 0.0), p(-1.0, 0.0), p(1.0, 0.0)], 64),
        ] {
            let (gap, count) = gap(curve);
            assert!(name == "one point" || gap <= 1.5 * TOLERANCE, "{name}: {gap}");
            assert!(count <= most, "{name}: {count} arcs");
        }
    }

    #[test]
    fn a_circle_of_four_curves_is_round() {
        // The usual quarter circle, whose error is 2.7e-4 of the radius.
        const HANDLE: f64 = 0.552_284_749_831;
        let mut lines = Lines::new(TOLERANCE);
        let mut quarter = [DVec2::X, DVec2::new(1.0, HANDLE), DVec2::new(HANDLE, 1.0), DVec2::Y];
        lines.move_to(quarter[0]);
        for _ in 0..4 {
            lines.cubic_to(quarter[1], quarter[2], quarter[3]);
            quarter = quarter.map(DVec2::perp);
        }
        let arguments = lines.finish();
        let turned: f64 = arguments.chunks(4).map(|corner| corner[2]).sum();
        assert!((turned - std::f64::consts::TAU).abs() < 1e-9, "{turned}");
        assert!(arguments.len() / 4 <= 32 && arguments[arguments.len() - 1] == 1.0);
    }
}
