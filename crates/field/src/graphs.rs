//! Graphs of formulas as chains of arcs that are near to them everywhere, not only where they are compared.
//!
//! Between two points of a graph, bounds of the slope say how far it may be from the line that joins them, and bounds of its height, where
//! the slope has none, how far from either. Pieces are halved until arcs are proven to be within the tolerance (in the spirit of Tupper,
//! "Reliable Two-Dimensional Graphing Methods for Mathematical Formulae with Two Free Variables", 2001).

use crate::arcs3::{Arc3, Divisible, pieces};
use crate::formula::Formula;
use crate::scalar::Interval;
use crate::shapes::svg_path::text_of;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Pieces that fit no arcs are taken apart so often, each time into thousands: to less than the distances between numbers.
const ROUNDS: u32 = 4;

/// More arcs than this would take too long at every point.
const MOST_ARCS: usize = 4096;

/// Places where a graph is hard are few: more of them are a graph that is hard everywhere.
const MOST_HARD: usize = 64;

/// Pieces are compared with their arcs between so many halvings at most.
const DEEPEST: u32 = 16;

/// Where the slope a little beside the end of a piece, by this share of it, differs from that at the end by more than the second number,
/// relative to what both are, the end lies in a corner.
const BESIDE: f64 = 1e-6;
const CORNER: f64 = 1e-2;

/// The part of the tolerance that points which are compared may be away from arcs; the rest is for what lies between them.
const COMPARED: f64 = 0.75;

/// What rounding adds to a rise that a slope allows.
const ROUNDING: f64 = 1e-9;

/// The graph `y = f(x)` between two values of x.
pub(crate) struct Graph {
    height: Formula,
    slope: Formula,
    from: f64,
    to: f64,
}

impl Graph {
    /// That of the formula with these characters.
    ///
    /// # Errors
    /// Why there is none, as the end of a sentence that begins with the formula.
    pub(crate) fn new(codes: &[f64], [from, to]: [f64; 2]) -> Result<Self, String> {
        let height = Formula::parse(&text_of(codes)).map_err(|error| format!("is no formula: {error}"))?;
        for (axis, name) in [(1, "y"), (2, "z")] {
            if height.uses(axis) {
                return Err(format!("has {name} in it; a graph is that of a formula in x"));
            }
        }
        let slope = height.derivative(0);
        Ok(Self { height, slope, from, to })
    }

    /// Its heights at many places from one end to the other, among them both.
    pub(crate) fn heights(&self) -> impl Iterator<Item = f64> {
        const PLACES: u32 = 256;
        (0..=PLACES).map(|place| self.point(f64::from(place) / f64::from(PLACES)).y)
    }

    /// Arcs from one end to the other that are at most `tolerance` away from it, and it from them.
    ///
    /// # Errors
    /// Why there are none, as the end of a sentence that begins with the formula.
    pub(crate) fn arcs(&self, tolerance: f64) -> Result<Vec<Arc3>, String> {
        let whole = Stretch { graph: self, from: 0.0, to: 1.0 };
        let mut arcs = Vec::new();
        self.add_arcs(&whole, tolerance, ROUNDS, &mut arcs)?;
        Ok(arcs)
    }

    fn add_arcs(&self, stretch: &Stretch<'_>, tolerance: f64, rounds: u32, out: &mut Vec<Arc3>) -> Result<(), String> {
        let pieces = pieces(stretch, &|piece, arcs| piece.is_near(arcs, tolerance));
        let pieces: Vec<_> =
            pieces.into_iter().map(|(piece, arcs)| (piece.is_near(&arcs, tolerance), piece, arcs)).collect();
        let left = pieces.iter().filter(|(is_near, ..)| !is_near).count();
        let (is_hard_everywhere, goes_on) = (left > MOST_HARD && rounds == ROUNDS, left <= MOST_HARD && rounds > 1);
        for (is_near, piece, arcs) in pieces {
            if is_near {
                out.extend(arcs);
            } else if goes_on {
                self.add_arcs(&piece, tolerance, rounds - 1, out)?;
            } else if let Some(point) =
                [piece.from, piece.to].map(|t| self.point(t)).iter().find(|point| !point.is_finite())
            {
                return Err(format!("has no value at x = {}", shown(point.x)));
            } else if !is_hard_everywhere {
                return Err(format!("jumps at x = {}", shown(self.place(piece.from.midpoint(piece.to)))));
            }
            if out.len() > MOST_ARCS || is_hard_everywhere {
                return Err(format!("takes more than {MOST_ARCS} arcs: draw less of it, or a wider line"));
            }
        }
        Ok(())
    }

    /// Where along x a parameter from 0 to 1 is. Towards the ends it slows down, so that roots that end there move evenly.
    fn place(&self, t: f64) -> f64 {
        if t == 1.0 { self.to } else { self.from + (self.to - self.from) * libm::sin(PI / 2.0 * t).powi(2) }
    }

    fn point(&self, t: f64) -> DVec2 {
        let x = self.place(t);
        DVec2::new(x, self.height.value([x, 0.0, 0.0]))
    }

    /// The direction in which the graph leads at a place, of length 1.
    fn direction(&self, x: f64) -> Option<DVec2> {
        let slope = self.slope.value([x, 0.0, 0.0]);
        if slope.is_infinite() {
            return Some(DVec2::new(0.0, slope.signum()));
        }
        slope.is_finite().then(|| DVec2::new(1.0, slope).normalize())
    }

    /// How far the graph is at most, between two of its points, from the line that joins them.
    fn bow(&self, [a, b]: [DVec2; 2]) -> f64 {
        let over = |formula: &Formula| {
            formula.eval([Interval::new(a.x, b.x), Interval::point(0.0), Interval::point(0.0)].into())
        };
        let (slope, width) = (over(&self.slope), b.x - a.x);
        let (low, high) = (slope.lo() * width, slope.hi() * width);
        let rise = b.y - a.y;
        let slack = ROUNDING * (low.abs().max(high.abs()) + a.y.abs() + b.y.abs());
        // Steeper than it can be: it jumps.
        let is_smooth = low - slack <= rise && rise <= high + slack;
        // Across the line, of what it is upwards.
        let across = width / a.distance(b);
        let by_slope = if is_smooth { (high - low) / 4.0 * across } else { f64::INFINITY };
        let by_height = over(&self.height).width() + width;
        // Either may be no number.
        if by_slope <= by_height { by_slope } else { by_height }
    }
}

/// A place, to six digits and never as a negative 0.
fn shown(x: f64) -> String {
    const DIGITS: f64 = 1e6;
    format!("{:.6}", (x * DIGITS).round() / DIGITS + 0.0)
}

/// The part of a graph between two parameters.
#[derive(Clone)]
struct Stretch<'g> {
    graph: &'g Graph,
    from: f64,
    to: f64,
}

impl Stretch<'_> {
    /// Whether all of it is near to arcs, which are near to it.
    fn is_near(&self, arcs: &[Arc3], tolerance: f64) -> bool {
        let curvature =
            arcs.iter().map(|arc| 2.0 * libm::sin(arc.half_turn()) / arc.from.distance(arc.to).max(f64::MIN_POSITIVE));
        let curvature = curvature.fold(0.0, f64::max);
        let gap = |point: DVec2| arcs.iter().map(|arc| arc.distance(point.extend(0.0))).fold(f64::INFINITY, f64::min);
        // Whole pieces fail at few places first.
        let mut waiting = vec![(self.from, self.to, DEEPEST)];
        while let Some((from, to, depth)) = waiting.pop() {
            let ends = [self.graph.point(from), self.graph.point(to)];
            if !ends.iter().all(|point| point.is_finite() && gap(*point) <= tolerance * COMPARED) {
                return false;
            }
            let length = ends[0].distance(ends[1]);
            // An arc is no farther from its chord than this.
            let bulge = length * length * curvature / 8.0;
            if self.graph.bow(ends) + bulge <= tolerance * (1.0 - COMPARED) {
                continue;
            }
            let middle = from.midpoint(to);
            if depth == 0 || middle <= from || middle >= to {
                return false;
            }
            waiting.extend([(from, middle, depth - 1), (middle, to, depth - 1)]);
        }
        true
    }

    /// The direction at the end `at`, on the side of this piece.
    fn end_direction(&self, at: f64, toward: f64) -> DVec2 {
        let graph = self.graph;
        let there = graph.direction(graph.place(at));
        let beside = graph.direction(graph.place(at + (toward - at) * BESIDE));
        match (there, beside) {
            (Some(there), Some(beside)) if there.distance(beside) > CORNER => beside,
            (Some(there), _) => there,
            (None, Some(beside)) => beside,
            (None, None) => DVec2::X,
        }
    }
}

impl Divisible for Stretch<'_> {
    fn controls(&self) -> Vec<DVec3> {
        let [first, last] = [self.from, self.to].map(|t| self.graph.point(t));
        let (start, end) = (self.end_direction(self.from, self.to), self.end_direction(self.to, self.from));
        [first, first + start, last - end, last].map(|point| point.extend(0.0)).to_vec()
    }

    fn at(&self, t: f64) -> DVec3 {
        self.graph.point(self.from + (self.to - self.from) * t).extend(0.0)
    }

    fn halves(&self) -> [Self; 2] {
        let middle = self.from.midpoint(self.to);
        [Self { to: middle, ..self.clone() }, Self { from: middle, ..self.clone() }]
    }
}
