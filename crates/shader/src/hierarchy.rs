//! A hierarchy of the boxes of parts, as numbers that a shader walks through without a stack.
//!
//! Nodes stand in the order of a walk that visits all of them, the first child right after its parent; each names the node to
//! go on with where it is passed over. How many there are depends on the number of parts alone, so that parts that have moved
//! change nothing but numbers.

use crate::numbers::write_box;
use freikugel_field::Aabb;
use glam::DVec3;

/// Numbers of a node: the middle of its box and half its edges, where to go on if it is passed over, and its part, or -1. What
/// holds a part needs no place to go on with, since that is always the next one; the place of the part's constants is there
/// instead.
pub(crate) const NODE_SIZE: usize = 8;

/// Where these are in a node.
const NEXT: usize = 6;
const PART: usize = 7;

/// A pair of children gets no less than one in this many parts for each, so that the longest way down stays short however
/// unevenly boxes lie.
const LEAST_SHARE: usize = 8;

/// How many nodes there are for some parts, of which there must be one at least.
pub(crate) fn node_count(parts: usize) -> usize {
    2 * parts - 1
}

/// A part in the hierarchy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub(crate) part: usize,
    /// Where it is; `None` if it may be anywhere.
    pub(crate) bounds: Option<Aabb>,
    /// The place of its constants in the table of parameters.
    pub(crate) constants: usize,
}

/// Writes all nodes to where the table of parameters has them, beginning at `first`.
pub(crate) fn write_nodes(table: &mut [f32], first: usize, leaves: &mut [Leaf], origin: DVec3) {
    let mut next = first;
    write(table, &mut next, leaves, origin);
    debug_assert_eq!(next, first + NODE_SIZE * node_count(leaves.len()), "all nodes are there");
}

fn write(table: &mut [f32], next: &mut usize, leaves: &mut [Leaf], origin: DVec3) {
    let own = *next;
    *next += NODE_SIZE;
    if let [leaf] = leaves {
        write_box(&mut table[own..], leaf.bounds, origin);
        table[own + NEXT] = leaf.constants as f32;
        table[own + PART] = leaf.part as f32;
        return;
    }
    let all = leaves.iter().map(|leaf| leaf.bounds).reduce(|a, b| Some(a?.hull(b?))).flatten();
    write_box(&mut table[own..], all, origin);
    table[own + PART] = -1.0;
    let middle = divide(leaves);
    let (left, right) = leaves.split_at_mut(middle);
    write(table, next, left, origin);
    write(table, next, right, origin);
    table[own + NEXT] = *next as f32;
}

/// Sorts leaves so that a good place to part them is at the number that is returned. What has no box comes first, alone, so
/// that it does not spoil the boxes of the others; these are parted where the sum over both sides of surface times count is
/// least (the surface area heuristic: MacDonald and Booth, "Heuristics for ray tracing using space subdivision", 1990).
fn divide(leaves: &mut [Leaf]) -> usize {
    let count = leaves.len();
    leaves.sort_by_key(|leaf| (leaf.bounds.is_some(), leaf.part));
    let free = leaves.iter().take_while(|leaf| leaf.bounds.is_none()).count();
    if free == count {
        return count / 2;
    }
    if free > 0 {
        return free;
    }
    let box_of = |leaf: &Leaf| leaf.bounds.expect("all have one");
    let least = count.div_ceil(LEAST_SHARE).max(1);
    let mut best = (f64::INFINITY, 0, count / 2);
    for axis in 0..3 {
        sort(leaves, axis);
        let sums = |boxes: &mut dyn Iterator<Item = Aabb>| -> Vec<f64> {
            let mut so_far: Option<Aabb> = None;
            let mut surface = |own: Aabb| {
                let all = so_far.map_or(own, |all| all.hull(own));
                so_far = Some(all);
                let size = all.size();
                size.x * size.y + size.y * size.z + size.z * size.x
            };
            boxes.map(&mut surface).collect()
        };
        let before = sums(&mut leaves.iter().map(box_of));
        let after = sums(&mut leaves.iter().rev().map(box_of));
        for at in least..=count - least {
            let cost = before[at - 1] * at as f64 + after[count - at - 1] * (count - at) as f64;
            if cost < best.0 {
                best = (cost, axis, at);
            }
        }
    }
    sort(leaves, best.1);
    best.2
}

/// Sorts leaves with boxes by their middles along an axis, those at the same place by their number.
fn sort(leaves: &mut [Leaf], axis: usize) {
    let middle = |leaf: &Leaf| leaf.bounds.map_or(0.0, |bounds| bounds.center()[axis]);
    leaves.sort_by(|a, b| middle(a).total_cmp(&middle(b)).then(a.part.cmp(&b.part)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A place for the nodes other than 0.
    const FIRST: usize = 16;

    /// The parts that a walk from `p` visits which passes over all boxes farther away than `least`.
    fn visited(table: &[f32], p: DVec3, least: f32) -> Vec<usize> {
        let mut node = FIRST;
        let mut found = Vec::new();
        while node < table.len() {
            let number = |at: usize| table[node + at];
            let apart = |axis: usize| ((p[axis] as f32 - number(axis)).abs() - number(3 + axis)).max(0.0);
            let distance = (0..3).map(|axis| apart(axis).powi(2)).sum::<f32>().sqrt();
            let is_leaf = number(PART) >= 0.0;
            if distance <= least {
                if is_leaf {
                    assert_eq!(number(NEXT), 7.0 * number(PART), "the place of its constants");
                    found.push(number(PART) as usize);
                }
                node += NODE_SIZE;
            } else {
                node = if is_leaf { node + NODE_SIZE } else { number(NEXT) as usize };
            }
        }
        assert_eq!(node, table.len());
        found.sort_unstable();
        found
    }

    proptest! {
        #[test]
        fn a_walk_visits_all_that_is_near(
            boxes in prop::collection::vec(
                prop::option::weighted(0.9, (prop::array::uniform3(-9.0f64..9.0), prop::array::uniform3(0.0f64..3.0))),
                1..60,
            ),
            p in prop::array::uniform3(-12.0f64..12.0),
            least in 0.0f32..9.0,
        ) {
            let bounds = |(middle, half): ([f64; 3], [f64; 3])| {
                let (middle, half) = (DVec3::from(middle), DVec3::from(half));
                Aabb { min: middle - half, max: middle + half }
            };
            let boxes = boxes.into_iter().map(|given| given.map(bounds)).enumerate();
            let mut leaves: Vec<Leaf> =
                boxes.map(|(part, bounds)| Leaf { part, bounds, constants: 7 * part }).collect();
            let given = leaves.clone();
            let mut table = vec![0.0; FIRST + NODE_SIZE * node_count(leaves.len())];
            write_nodes(&mut table, FIRST, &mut leaves, DVec3::ZERO);
            prop_assert_eq!(visited(&table, DVec3::ZERO, f32::INFINITY), (0..given.len()).collect::<Vec<_>>());
            let found = visited(&table, p.into(), least);
            for Leaf { part, bounds, .. } in given {
                let distance = bounds.map_or(0.0, |bounds| {
                    let p = DVec3::from(p);
                    p.distance(p.clamp(bounds.min, bounds.max))
                });
                // Between these the rounding decides.
                if distance < f64::from(least) - 1e-5 {
                    prop_assert!(found.contains(&part), "{part} is {distance} away");
                } else if distance > f64::from(least) + 1e-5 {
                    prop_assert!(!found.contains(&part), "{part} is {distance} away");
                }
            }
        }
    }

    #[test]
    fn the_way_down_is_short_however_boxes_lie() {
        // Each twice as large as the one before and around it: nothing parts them well.
        let nested = |part: usize| {
            let half = DVec3::splat(2f64.powi(part as i32 % 90));
            Leaf { part, bounds: Some(Aabb { min: -half, max: half }), constants: 0 }
        };
        fn depth(leaves: &mut [Leaf]) -> usize {
            if leaves.len() == 1 {
                return 1;
            }
            let middle = divide(leaves);
            let (left, right) = leaves.split_at_mut(middle);
            1 + depth(left).max(depth(right))
        }
        let mut leaves: Vec<Leaf> = (0..10_000).map(nested).collect();
        // The logarithm of 10,000 to the base of 8/7 is 69.
        assert!(depth(&mut leaves) <= 72);
    }
}
