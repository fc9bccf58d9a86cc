//! What a fill rule makes of closed lines: lines that don't cross, each of which has the figure on one side only.
//!
//! Where lines cross or touch, they are overlaid as polygons, and the corners of these that lie on arcs become arcs again.

use crate::shapes::outline::{Edge, closed, edges};
use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape;
use i_overlay::float::single::SingleFloatOverlay;
use std::ops::Range;

/// What is inside where lines lie within others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rule {
    /// What lines lead around more often in one direction than in the other.
    NonZero,
    /// What is inside of an odd number of lines.
    EvenOdd,
}

impl Rule {
    /// Whether a point is inside that lines lead around so often, counter-clockwise.
    fn fills(self, winding: i32) -> bool {
        match self {
            Self::NonZero => winding != 0,
            Self::EvenOdd => winding % 2 != 0,
        }
    }
}

/// A step to either side of an edge, as a share of its length: less than to the next edge, but for the finest of figures.
const BESIDE: f64 = 1e-4;

/// No arc turns by more than a little over half a turn: ends of longer ones say less and less about them.
const MOST_TURN: f64 = 3.3;

/// An arc that turns by less is a straight edge.
const STRAIGHT: f64 = 1e-9;

/// The border of what the rule fills, within the tolerance; lines are given and returned as the arguments of an outline.
pub(crate) fn filled(lines: &[f64], rule: Rule, tolerance: f64) -> Vec<f64> {
    let edges = edges(lines);
    // Half of it is for the polygon, and half for the arcs that are found in it.
    let polygons = polygons(lines, &edges, tolerance / 2.0);
    if do_cross(&polygons) {
        return overlaid(&polygons, rule, tolerance / 2.0);
    }
    borders(lines, &edges, rule)
}

/// What two figures have in common, within the tolerance; both are given by lines that [`filled`] returned.
pub(crate) fn common(a: &[f64], b: &[f64], tolerance: f64) -> Vec<f64> {
    let [a, b] = [a, b].map(|lines| coordinates(&polygons(lines, &edges(lines), tolerance / 2.0)));
    let shapes = a.overlay(&b, OverlayRule::Intersect, FillRule::NonZero);
    rounded(shapes.into_iter().flatten(), tolerance / 2.0)
}

/// Closed lines in groups, each of which is a figure by itself that no other one overlaps: a line and the holes in it. A single
/// group if lines cross.
pub(crate) fn components(lines: &[f64], tolerance: f64) -> Vec<Vec<f64>> {
    let all = edges(lines);
    let ends = (1..).zip(lines.chunks_exact(4)).filter(|(_, corner)| corner[3] != 0.0).map(|(end, _)| end);
    let starts = std::iter::once(0).chain(ends.clone());
    let ranges: Vec<Range<usize>> = starts.zip(ends).map(|(start, end)| start..end).collect();
    if ranges.len() < 2 || do_cross(&polygons(lines, &all, tolerance)) {
        return vec![lines.to_vec()];
    }
    // Which lines surround each of them, from any point of it.
    let surrounding = |range: &Range<usize>| -> Vec<usize> {
        let p = all[range.start].middle();
        let surrounds = |other: &Range<usize>| other != range && winding(&all[other.clone()], p) % 2 != 0;
        (0..ranges.len()).filter(|&other| surrounds(&ranges[other])).collect()
    };
    let surrounding: Vec<Vec<usize>> = ranges.iter().map(surrounding).collect();
    let depth = |line: usize| surrounding[line].len();
    let outer = (0..ranges.len()).filter(|&line| depth(line) % 2 == 0);
    outer
        .map(|outer| {
            let is_hole = |&line: &usize| depth(line) == depth(outer) + 1 && surrounding[line].contains(&outer);
            let own = std::iter::once(outer).chain((0..ranges.len()).filter(is_hole));
            own.flat_map(|line| &lines[4 * ranges[line].start..4 * ranges[line].end]).copied().collect()
        })
        .collect()
}

/// Those of closed lines that don't cross on one side of which the figure lies, in such a direction that it is to their left.
fn borders(lines: &[f64], edges: &[Edge], rule: Rule) -> Vec<f64> {
    let mut kept = Vec::new();
    let mut first = 0;
    for (index, corner) in lines.chunks_exact(4).enumerate() {
        if corner[3] == 0.0 {
            continue;
        }
        // Beside the middle of the longest edge.
        let own = &edges[first..=index];
        let longest = own.iter().copied().max_by(|a, b| a.length().total_cmp(&b.length()));
        if let Some(edge) = longest {
            let beside = |sign: f64| edge.middle() + edge.normal() * (sign * BESIDE * edge.length());
            let line = &lines[4 * first..4 * (index + 1)];
            match [1.0, -1.0].map(|sign| rule.fills(winding(edges, beside(sign)))) {
                [true, false] => kept.extend_from_slice(line),
                [false, true] => kept.extend(reversed(line)),
                _ => {}
            }
        }
        first = index + 1;
    }
    kept
}

/// A closed line in the other direction.
fn reversed(line: &[f64]) -> Vec<f64> {
    let corners: Vec<&[f64]> = line.chunks_exact(4).collect();
    // It starts at the same corner, with what was the last edge.
    let starts = corners.iter().take(1).chain(corners[1..].iter().rev());
    let corners: Vec<[f64; 3]> =
        starts.zip(corners.iter().rev()).map(|(start, edge)| [start[0], start[1], -edge[2]]).collect();
    closed(&corners)
}

/// How often edges lead around a point, counter-clockwise.
fn winding(edges: &[Edge], p: DVec2) -> i32 {
    let mut count = 0;
    for edge in edges {
        let is_left = (edge.to - edge.from).perp_dot(p - edge.from) > 0.0;
        match (edge.from.y <= p.y, edge.to.y <= p.y) {
            (true, false) if is_left => count += 1,
            (false, true) if !is_left => count -= 1,
            _ => {}
        }
        if let Some((centre, radius)) = edge.circle() {
            let is_beyond_chord = is_left != (edge.turn > 0.0);
            if is_beyond_chord && p.distance(centre) < radius {
                count += if edge.turn > 0.0 { 1 } else { -1 };
            }
        }
    }
    count
}

/// Closed lines with corners so dense on arcs that edges are within the tolerance.
fn polygons(lines: &[f64], edges: &[Edge], tolerance: f64) -> Vec<Vec<DVec2>> {
    let mut polygons = Vec::new();
    let mut polygon = Vec::new();
    for (corner, edge) in lines.chunks_exact(4).zip(edges) {
        polygon.push(edge.from);
        if let Some((centre, radius)) = edge.circle() {
            // An edge that turns by `step` is off by radius (1 - cos(step / 2)).
            let step = 2.0 * libm::acos(1.0 - (tolerance / radius).min(0.5));
            let count = (edge.turn.abs() / step).ceil().max(1.0);
            let arm = edge.from - centre;
            polygon.extend(
                (1..count as u32)
                    .map(|number| centre + DVec2::from_angle(edge.turn * f64::from(number) / count).rotate(arm)),
            );
        }
        if corner[3] != 0.0 {
            polygons.push(std::mem::take(&mut polygon));
        }
    }
    polygons
}

/// The sides of a polygon.
fn sides(polygon: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    polygon.iter().copied().zip(polygon.iter().copied().cycle().skip(1))
}

/// Whether two sides of some polygons have a point in common that is no corner of both.
fn do_cross(polygons: &[Vec<DVec2>]) -> bool {
    let mut all: Vec<(DVec2, DVec2)> = polygons.iter().flat_map(|polygon| sides(polygon)).collect();
    all.sort_by(|(a, b), (c, d)| a.x.min(b.x).total_cmp(&c.x.min(d.x)));
    all.iter().enumerate().any(|(index, &side)| {
        let right = side.0.x.max(side.1.x);
        let beside = all[index + 1..].iter().take_while(|other| other.0.x.min(other.1.x) <= right);
        beside.into_iter().any(|&other| do_meet(side, other))
    })
}

/// Whether two segments have a point in common that is no end of both.
fn do_meet((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> bool {
    if a.y.max(b.y) < c.y.min(d.y) || c.y.max(d.y) < a.y.min(b.y) {
        return false;
    }
    let is_joint = [a, b].iter().any(|end| [c, d].contains(end));
    let side = |p: DVec2| (b - a).perp_dot(p - a);
    let other_side = |p: DVec2| (d - c).perp_dot(p - c);
    !is_joint && side(c) * side(d) <= 0.0 && other_side(a) * other_side(b) <= 0.0
}

/// The border of what the rule fills of polygons that may cross.
fn overlaid(polygons: &[Vec<DVec2>], rule: Rule, tolerance: f64) -> Vec<f64> {
    let rule = match rule {
        Rule::NonZero => FillRule::NonZero,
        Rule::EvenOdd => FillRule::EvenOdd,
    };
    rounded(coordinates(polygons).simplify_shape(rule).into_iter().flatten(), tolerance)
}

fn coordinates(polygons: &[Vec<DVec2>]) -> Vec<Vec<[f64; 2]>> {
    polygons.iter().map(|polygon| polygon.iter().map(DVec2::to_array).collect()).collect()
}

/// The lines of some polygons, with arcs where corners lie on such.
fn rounded(polygons: impl Iterator<Item = Vec<[f64; 2]>>, tolerance: f64) -> Vec<f64> {
    let line = |polygon: Vec<[f64; 2]>| polygon.into_iter().map(DVec2::from).collect::<Vec<_>>();
    polygons.flat_map(|polygon| closed(&arcs(&line(polygon), tolerance))).collect()
}

/// The corners of a polygon, of which those that lie on arcs are left out: x, y, and the angle by which the edge to the next one
/// turns.
fn arcs(polygon: &[DVec2], tolerance: f64) -> Vec<[f64; 3]> {
    let count = polygon.len();
    let bend = |index: usize| {
        let [before, here, after] = [index + count - 1, index, index + 1].map(|index| polygon[index % count]);
        (here - before).angle_to(after - here).abs()
    };
    let Some(start) = (0..count).max_by(|&a, &b| bend(a).total_cmp(&bend(b))) else { return Vec::new() };
    let round: Vec<DVec2> = (start..=start + count).map(|index| polygon[index % count]).collect();
    let mut corners = Vec::new();
    let mut at = 0;
    while at < count {
        // As far as one arc leads.
        let (mut to, mut turn) = (at + 1, 0.0);
        while let Some(farther) = (to < count).then(|| arc(&round[at..=to + 1], tolerance)).flatten() {
            (to, turn) = (to + 1, farther);
        }
        corners.push([round[at].x, round[at].y, turn]);
        at = to;
    }
    corners
}

/// By how much the arc turns from the first to the last one of some points through all of them, if there is one.
fn arc(points: &[DVec2], tolerance: f64) -> Option<f64> {
    let &[from, .., to] = points else { return None };
    let middle = points[points.len() / 2];
    // Seen from the middle, the chords to both ends make half the angle that the arc turns by.
    let turn = 2.0 * (middle - from).angle_to(to - middle);
    let turn = if turn.abs() < STRAIGHT { 0.0 } else { turn };
    if from == to || turn.abs() > MOST_TURN {
        return None;
    }
    let edge = Edge { from, to, turn };
    let off = |p: DVec2| match edge.circle() {
        Some((centre, radius)) => (p.distance(centre) - radius).abs(),
        None => (to - from).normalize().perp_dot(p - from).abs(),
    };
    let is_near = points.iter().all(|&p| off(p) <= tolerance);
    // Sides were as near to the arcs that they stand for.
    let are_near = points.windows(2).all(|side| off(side[0].midpoint(side[1])) <= 2.0 * tolerance);
    (is_near && are_near).then_some(turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    const TOLERANCE: f64 = 1e-4;

    /// A circle of two arcs, counter-clockwise or the other way round.
    fn circle(centre: DVec2, radius: f64, way: f64) -> Vec<f64> {
        closed(&[[centre.x - radius, centre.y, way * PI], [centre.x + radius, centre.y, way * PI]])
    }

    /// The area within lines, by Green's theorem.
    fn area(lines: &[f64]) -> f64 {
        let own = |edge: Edge| {
            let segment =
                edge.circle().map_or(0.0, |(_, radius)| radius * radius / 2.0 * (edge.turn - libm::sin(edge.turn)));
            edge.from.perp_dot(edge.to) / 2.0 + segment
        };
        edges(lines).into_iter().map(own).sum()
    }

    #[test]
    fn circles_that_cross_become_one_line_of_few_arcs() {
        let (a, b) = (circle(DVec2::ZERO, 1.0, 1.0), circle(DVec2::X, 1.0, 1.0));
        // What two circles through each other's middle have in common.
        let lens = 2.0 * PI / 3.0 - 3.0_f64.sqrt() / 2.0;
        for (rule, expected) in [(Rule::NonZero, TAU - lens), (Rule::EvenOdd, TAU - 2.0 * lens)] {
            let lines = filled(&[a.clone(), b.clone()].concat(), rule, TOLERANCE);
            assert!((area(&lines) - expected).abs() < 10.0 * TOLERANCE, "{rule:?}: {}", area(&lines));
            assert!(lines.len() / 4 <= 16, "{rule:?}: {} edges", lines.len() / 4);
        }
    }

    #[test]
    fn lines_that_do_not_cross_stay_as_they_are() {
        let (outer, inner) = (circle(DVec2::ZERO, 1.0, 1.0), circle(DVec2::ZERO, 0.5, 1.0));
        let hole = circle(DVec2::ZERO, 0.5, -1.0);
        assert_eq!(filled(&[outer.clone(), inner.clone()].concat(), Rule::NonZero, TOLERANCE), outer);
        let ring = [outer.clone(), hole].concat();
        assert_eq!(filled(&ring, Rule::NonZero, TOLERANCE), ring);
        // The figure comes to lie to the left of all lines.
        assert_eq!(filled(&[outer, inner].concat(), Rule::EvenOdd, TOLERANCE), ring);
    }

    #[test]
    fn figures_are_cut_to_what_they_have_in_common() {
        let square = closed(&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]);
        let lines = common(&circle(DVec2::ZERO, 1.0, 1.0), &square, TOLERANCE);
        assert!((area(&lines) - PI / 4.0).abs() < 4.0 * TOLERANCE, "{}", area(&lines));
    }

    #[test]
    fn a_star_drawn_in_one_stroke_has_its_middle_or_not() {
        let corners: Vec<[f64; 3]> = (0..5)
            .map(|number| DVec2::from_angle(f64::from(number) * 2.0 * TAU / 5.0))
            .map(|corner| [corner.x, corner.y, 0.0])
            .collect();
        let middle = DVec2::ZERO;
        for (rule, is_inside) in [(Rule::NonZero, true), (Rule::EvenOdd, false)] {
            let lines = filled(&closed(&corners), rule, TOLERANCE);
            assert_eq!(winding(&edges(&lines), middle) != 0, is_inside, "{rule:?}");
        }
    }

    #[test]
    fn figures_fall_into_lines_with_their_holes() {
        let ring = |x: f64| [circle(DVec2::X * x, 1.0, 1.0), circle(DVec2::X * x, 0.8, 1.0)].concat();
        let island = circle(DVec2::ZERO, 0.5, 1.0);
        let lines = [ring(0.0), island.clone(), ring(3.0)].concat();
        assert_eq!(components(&lines, TOLERANCE), [ring(0.0), island, ring(3.0)]);
        let crossing = [ring(0.0), ring(1.0)].concat();
        assert_eq!(components(&crossing, TOLERANCE), [crossing]);
    }

    #[test]
    fn corners_stay_corners() {
        // Two squares that cross: an octagon's star outline, of which no corner may be rounded.
        let square = |turned: f64| {
            let corner = |number: u32| DVec2::from_angle(turned + f64::from(number) * TAU / 4.0);
            closed(&[0, 1, 2, 3].map(corner).map(|corner| [corner.x, corner.y, 0.0]))
        };
        let lines = filled(&[square(0.0), square(TAU / 8.0)].concat(), Rule::NonZero, TOLERANCE);
        assert_eq!(lines.len() / 4, 16);
        assert!(lines.chunks(4).all(|corner| corner[2] == 0.0));
    }
}
