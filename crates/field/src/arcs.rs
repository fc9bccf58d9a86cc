//! Figures bounded by Bézier curves, and by others with known directions, as lines of straight edges and arcs, which are those of
//! curves in space that stay in the plane.

use crate::arcs3::{Arc3, Divisible, of_curve};
use crate::curve::Bezier;
use glam::{DVec2, DVec3};

/// A curve: its point at a parameter, and its direction there.
pub(crate) type Curve<'a> = &'a dyn Fn(f64) -> (DVec2, DVec2);

/// The part of a curve between two parameters.
#[derive(Clone)]
struct Stretch<'a> {
    curve: Curve<'a>,
    from: f64,
    to: f64,
}

impl Divisible for Stretch<'_> {
    fn controls(&self) -> Vec<DVec3> {
        let ((first, start), (last, end)) = ((self.curve)(self.from), (self.curve)(self.to));
        [first, first + start.normalize(), last - end.normalize(), last].map(|point| point.extend(0.0)).to_vec()
    }

    fn at(&self, t: f64) -> DVec3 {
        (self.curve)(self.from + (self.to - self.from) * t).0.extend(0.0)
    }

    fn halves(&self) -> [Self; 2] {
        let middle = self.from.midpoint(self.to);
        [Self { to: middle, ..self.clone() }, Self { from: middle, ..self.clone() }]
    }
}

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
        self.bezier_to(&[control, to]);
    }

    /// A cubic curve.
    pub(crate) fn cubic_to(&mut self, first: DVec2, second: DVec2, to: DVec2) {
        self.bezier_to(&[first, second, to]);
    }

    /// An arc that turns to the left by this angle.
    pub(crate) fn arc_to(&mut self, to: DVec2, turn: f64) {
        self.corners.push([self.at.x, self.at.y, turn]);
        self.at = to;
    }

    /// A smooth curve, along its parameter from one value to another. Its directions, of any length but 0, are those in which it is
    /// drawn.
    pub(crate) fn follow(&mut self, curve: Curve<'_>, [from, to]: [f64; 2]) {
        self.arcs(&Stretch { curve, from, to });
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

    /// A Bézier curve from where the line is, by its other control points.
    pub(crate) fn bezier_to(&mut self, points: &[DVec2]) {
        self.arcs(&Bezier::new([self.at].iter().chain(points).map(|point| point.extend(0.0)).collect()));
    }

    /// The arcs of a curve in the plane.
    fn arcs<C: Divisible>(&mut self, curve: &C) {
        self.along(of_curve(curve, self.tolerance));
    }

    /// A chain of arcs in the plane that begins where the line is.
    pub(crate) fn along(&mut self, arcs: Vec<Arc3>) {
        for arc in arcs {
            let (from, to) = (arc.from.truncate(), arc.to.truncate());
            if from != to {
                // An arc to the left of its chord turns to the right.
                let is_left = (to - from).perp_dot(arc.side_of_chord().truncate()) > 0.0;
                let turn = 2.0 * arc.half_turn();
                self.corners.push([from.x, from.y, if is_left { 0.0 - turn } else { turn }]);
            }
            self.at = to;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 1e-4;

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
