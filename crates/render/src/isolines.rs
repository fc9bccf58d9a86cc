//! Lines along which values on a grid have a level, by marching squares (Lorensen and Cline, "Marching Cubes", 1987, in the plane).
//!
//! Between two neighbours with the level between them a line crosses; where a cell has four crossings, the mean of its corners says
//! which belong together. Crossings are shared by the cells on both sides, so that lines have no gaps.

use std::collections::HashMap;

/// A line: points in units of grid steps from the first value, and whether the last one is joined to the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Isoline {
    /// The points, x to the right and y downwards; what is below the level lies to the left of the way.
    pub points: Vec<[f32; 2]>,
    /// Whether it comes back to where it starts; otherwise both ends lie on the border, or beside values that are no numbers.
    pub is_closed: bool,
}

/// The edge between two neighbours on the grid: the first one's column and row, and whether the other one is below it.
type Crossing = (u32, u32, bool);

/// The lines of a level among `columns` times `rows` values, row by row.
///
/// # Panics
/// If there are not as many values.
pub fn isolines(values: &[f32], [columns, rows]: [u32; 2], level: f32) -> Vec<Isoline> {
    assert_eq!(values.len() as u64, u64::from(columns) * u64::from(rows), "one value for each place");
    let at = |x: u32, y: u32| values[(y * columns + x) as usize] - level;
    let mut next: HashMap<Crossing, Crossing> = HashMap::new();
    let mut starts: Vec<Crossing> = Vec::new();
    for y in 0..rows.saturating_sub(1) {
        for x in 0..columns.saturating_sub(1) {
            let corners = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            if corners.iter().any(|corner| corner.is_nan()) {
                continue;
            }
            let edges = [(x, y, false), (x + 1, y, true), (x, y + 1, false), (x, y, true)];
            // Around the cell from corner to corner: lines come in where values fall below the level, and leave where they rise.
            let falls: Vec<usize> = (0..4).filter(|&i| corners[i] >= 0.0 && corners[(i + 1) % 4] < 0.0).collect();
            let rises: Vec<usize> = (0..4).filter(|&i| corners[i] < 0.0 && corners[(i + 1) % 4] >= 0.0).collect();
            let is_high_between = corners.iter().sum::<f32>() >= 0.0;
            for &fall in &falls {
                // With two lines in a cell, each goes around one corner: a low one if the middle is high, and otherwise a high one.
                let step = if is_high_between { 1 } else { 3 };
                let rise = if rises.len() == 1 { rises[0] } else { (fall + step) % 4 };
                next.insert(edges[fall], edges[rise]);
                starts.push(edges[fall]);
            }
        }
    }
    let point = |(x, y, is_down): Crossing| {
        let (a, b) = (at(x, y), if is_down { at(x, y + 1) } else { at(x + 1, y) });
        // Infinite values leave the place open.
        let share = if a.is_finite() && b.is_finite() { a / (a - b) } else { 0.5 };
        if is_down { [x as f32, y as f32 + share] } else { [x as f32 + share, y as f32] }
    };
    let is_reached: std::collections::HashSet<Crossing> = next.values().copied().collect();
    let mut lines = Vec::new();
    // First those that come from nowhere, then what is left: circles.
    let open = starts.iter().filter(|start| !is_reached.contains(start)).copied().collect::<Vec<_>>();
    for start in open.into_iter().chain(starts) {
        let mut points = Vec::new();
        let mut crossing = start;
        let mut is_closed = false;
        while let Some(following) = next.remove(&crossing) {
            points.push(point(crossing));
            crossing = following;
            is_closed = crossing == start;
        }
        if points.is_empty() {
            continue;
        }
        if !is_closed {
            points.push(point(crossing));
        }
        lines.push(Isoline { points, is_closed });
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: u32 = 64;

    /// Values at the points of a grid over the square from -1 to 1.
    fn grid(value: impl Fn(f32, f32) -> f32) -> Vec<f32> {
        let at = |index: u32| 2.0 * index as f32 / (SIDE - 1) as f32 - 1.0;
        (0..SIDE * SIDE).map(|index| value(at(index % SIDE), at(index / SIDE))).collect()
    }

    fn unit([x, y]: [f32; 2]) -> [f32; 2] {
        [x, y].map(|c| 2.0 * c / (SIDE - 1) as f32 - 1.0)
    }

    #[test]
    fn circles_are_closed_lines_at_their_radius() {
        let values = grid(f32::hypot);
        for level in [0.3, 0.5, 0.9] {
            let lines = isolines(&values, [SIDE, SIDE], level);
            assert!(lines.len() == 1 && lines[0].is_closed, "{lines:?}");
            let mut turned = 0.0;
            for (index, &point) in lines[0].points.iter().enumerate() {
                let [x, y] = unit(point);
                assert!((x.hypot(y) - level).abs() < 1e-3, "{x} {y}");
                let [nx, ny] = unit(lines[0].points[(index + 1) % lines[0].points.len()]);
                turned += (x * ny - y * nx).atan2(x * nx + y * ny);
            }
            // The inside lies to the left; with y downwards that is a turn in the other direction.
            assert!((turned + std::f32::consts::TAU).abs() < 1e-3, "{turned}");
        }
    }

    #[test]
    fn lines_end_at_the_border_and_beside_gaps() {
        let lines = isolines(&grid(|x, y| x + 0.3 * y), [SIDE, SIDE], 0.1);
        assert!(lines.len() == 1 && !lines[0].is_closed);
        let ends = [lines[0].points[0], lines[0].points[lines[0].points.len() - 1]].map(unit);
        assert!(ends.iter().all(|end| (end[1].abs() - 1.0).abs() < 1e-6), "{ends:?}");
        let gap = grid(|x, y| if y.abs() < 0.2 { f32::NAN } else { x });
        assert_eq!(isolines(&gap, [SIDE, SIDE], 0.0).len(), 2);
    }

    #[test]
    fn saddles_keep_apart_what_is_apart() {
        // Two low corners with a high middle, and the other way round: two lines, around single corners.
        for (values, low_corners) in [([0.0, 3.0, 3.0, 0.0], true), ([0.0, 2.0, 2.0, 0.0], false)] {
            let level = if low_corners { 1.0 } else { 1.9 };
            let lines = isolines(&values, [2, 2], level);
            assert_eq!(lines.len(), 2, "{lines:?}");
            for line in lines {
                let middle = [0, 1].map(|axis| (line.points[0][axis] + line.points[1][axis]) / 2.0);
                let is_around_low = (middle[0] - middle[1]).abs() < 1e-6;
                assert_eq!(is_around_low, low_corners, "{line:?}");
            }
        }
    }
}
