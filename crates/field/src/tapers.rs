//! Arcs along which the radius of a tube changes evenly with the length: what curves become on which it changes anyhow.

use crate::arcs3::{Arc3, Divisible, pieces, places};
use crate::curve::Bezier;
use glam::{DVec3, DVec4};

/// Arcs are within this share of the tube's radius from the curve, and their radii from its own, both together. That is half of
/// what tubes of one radius take: here slopes jump from arc to arc, which shades show.
const TOLERANCE: f64 = 1e-3;

/// Where a tube is thinner than this share of its largest radius, that counts in place of its own: tips would take arcs without
/// end.
const THINNEST: f64 = 0.05;

/// How many constants a taper has; see [`Taper::constants`].
pub(crate) const ROW: usize = 16;

/// An arc from ball to ball, whose radii lie between those at both ends as the places along the arc do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taper {
    pub(crate) arc: Arc3,
    pub(crate) radii: [f64; 2],
}

impl Taper {
    /// A straight piece between two balls x, y, z, radius.
    pub(crate) fn straight(from: DVec4, to: DVec4) -> Self {
        Self { arc: Arc3::straight(from.truncate(), to.truncate()), radii: [from.w, to.w] }
    }

    /// The point in its middle; its direction there, in which the radius grows, and that away from the centre of the arc; half the
    /// length of its chord; its curvature; how much the radius grows with the length; the radius in its middle; where its first
    /// ball lies from there, by both directions, and the radius of that.
    ///
    /// Where one ball holds all others, what is left is the first one by itself: a joint has the larger one, too.
    pub(crate) fn constants(&self) -> [f64; ROW] {
        let [mx, my, mz, ax, ay, az, nx, ny, nz, half, sin, cos, _radius] = self.arc.constants();
        let [first, last] = self.radii;
        let (length, growth) = (self.arc.length(), last - first);
        if growth.abs() >= length {
            let [x, y, z] = self.arc.from.to_array();
            return [x, y, z, ax, ay, az, nx, ny, nz, 0.0, 0.0, 0.0, first, 0.0, 0.0, first];
        }
        // The height of the arc over its chord, by the tangent of half the angle.
        let height = half * sin / (1.0 + cos);
        let [mx, my, mz] = [mx + nx * height, my + ny * height, mz + nz * height];
        let sign = if growth < 0.0 { -1.0 } else { 1.0 };
        let [ax, ay, az] = [ax * sign, ay * sign, az * sign];
        let (slope, middle) = (growth.abs() / length, (first + last) / 2.0);
        [mx, my, mz, ax, ay, az, nx, ny, nz, half, sin / half, slope, middle, -half * sign, -height, first]
    }

    /// How far a ball is from one of its own: by the place, and by the radius.
    fn gap(&self, ball: DVec4) -> f64 {
        let [first, last] = self.radii;
        let radius = first + (last - first) * self.arc.share_before(ball.truncate());
        self.arc.distance(ball.truncate()) + (radius - ball.w).abs()
    }
}

/// The largest of `direction . p` over the balls of a taper with these constants.
pub(crate) fn reach(row: &[f64], direction: DVec3) -> f64 {
    let (middle, along, across) = (DVec3::from_slice(row), DVec3::from_slice(&row[3..]), DVec3::from_slice(&row[6..]));
    let &[half, bend, slope, radius, _, down, _] = &row[9..ROW] else { unreachable!("seven numbers") };
    let length = direction.length();
    let (forward, outward, growth) = (direction.dot(along), direction.dot(across), slope * length);
    let half_turn = libm::asin(bend * half);
    let half_length = if bend > 0.0 { half_turn / bend } else { half };
    let end = outward * down + (forward * half + growth * half_length).abs();
    // Where the ball moves sideways as fast as its radius grows, if that is on the arc.
    let flat = libm::hypot(forward, outward);
    let angle = libm::atan2(forward, outward) + libm::asin(growth / flat);
    let farthest = if bend > 0.0 && angle.abs() < half_turn {
        let (sin, sin_of_half) = (libm::sin(angle), libm::sin(angle / 2.0));
        (forward * sin - outward * 2.0 * sin_of_half * sin_of_half + growth * angle) / bend
    } else {
        end
    };
    direction.dot(middle) + length * radius + end.max(farthest)
}

/// The constants of a chain of tapers. Each has its first ball, and the chain's last one stands at the end, unless it is closed.
pub(crate) fn rows(tapers: &[Taper]) -> Vec<f64> {
    let ends = tapers
        .first()
        .zip(tapers.last())
        .map(|(first, last)| (first.arc.from.extend(first.radii[0]), last.arc.to.extend(last.radii[1])));
    let end = ends.filter(|(first, last)| first != last).map(|(_, last)| Taper::straight(last, last));
    tapers.iter().chain(&end).flat_map(Taper::constants).collect()
}

/// A Bézier curve of balls x, y, z, radius.
#[derive(Clone, Debug)]
struct Balls(Bezier<DVec4>);

impl Divisible for Balls {
    fn controls(&self) -> Vec<DVec3> {
        self.0.points().iter().map(|ball| ball.truncate()).collect()
    }

    fn at(&self, t: f64) -> DVec3 {
        self.0.at(t).truncate()
    }

    fn halves(&self) -> [Self; 2] {
        self.0.split(0.5).map(Self)
    }
}

impl Balls {
    /// The largest radius of its control points.
    fn largest(&self) -> f64 {
        self.0.points().iter().fold(0.0, |largest, ball| ball.w.max(largest))
    }

    /// Arcs with the radii at both ends, and between them those that lie on the straight way.
    fn tapers(&self, arcs: &[Arc3]) -> Vec<Taper> {
        let (first, last) = (self.0.at(0.0), self.0.at(1.0));
        let length: f64 = arcs.iter().map(Arc3::length).sum();
        let mut before = 0.0;
        let radius = |before: f64| first.w + (last.w - first.w) * (before / length).min(1.0);
        let tapers = arcs.iter().map(|arc| {
            let start = radius(before);
            before += arc.length();
            Taper { arc: *arc, radii: [start, radius(before)] }
        });
        let mut tapers: Vec<Taper> = tapers.collect();
        match tapers.last_mut() {
            Some(end) => end.radii[1] = last.w,
            // The ball stays in one place, where the largest holds all others.
            None => tapers.push(Taper::straight(first.with_w(self.largest()), first.with_w(self.largest()))),
        }
        tapers
    }
}

/// Tapers along a chain of Bézier curves of balls x, y, z, radius.
pub(crate) fn of_curves(curves: &[Bezier<DVec4>]) -> Vec<Taper> {
    let curves: Vec<Balls> = curves.iter().cloned().map(Balls).collect();
    let largest = curves.iter().map(Balls::largest).fold(0.0, f64::max);
    let fits = |piece: &Balls, arcs: &[Arc3]| {
        let tolerance = TOLERANCE * piece.largest().max(THINNEST * largest);
        let tapers = piece.tapers(arcs);
        places().all(|place| {
            let ball = piece.0.at(place);
            tapers.iter().map(|taper| taper.gap(ball)).fold(f64::INFINITY, f64::min) <= tolerance
        })
    };
    let pieces = curves.iter().flat_map(|curve| pieces(curve, &fits));
    pieces.flat_map(|(piece, arcs)| piece.tapers(&arcs)).collect()
}
