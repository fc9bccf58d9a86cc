//! Figures bounded by Bézier curves as lines of straight edges and arcs, which are those of curves in space that stay in the plane.

use crate::arcs3::of_curve;
use crate::curve::Bezier;
use glam::DVec2;

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
        self.curve_to([control, to]);
    }

    /// A cubic curve.
    pub(crate) fn cubic_to(&mut self, first: DVec2, second: DVec2, to: DVec2) {
        self.curve_to([first, second, to]);
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

    /// A curve with these control points, as arcs in the plane.
    fn curve_to<const N: usize>(&mut self, points: [DVec2; N]) {
        let curve = Bezier::new([self.at].iter().chain(&points).map(|point| point.extend(0.0)).collect());
        for arc in of_curve(&curve, self.tolerance) {
            let (from, to) = (arc.from.truncate(), arc.to.truncate());
            if from != to {
                // An arc to the left of its chord turns to the right.
                let is_left = (to - from).perp_dot(arc.side_of_chord().truncate()) > 0.0;
                let turn = 2.0 * arc.half_turn();
                self.corners.push([from.x, from.y, if is_left { 0.0 - turn } else { turn }]);
            }
        }
        self.at = points[N - 1];
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
