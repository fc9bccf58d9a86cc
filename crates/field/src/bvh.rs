//! A hierarchy of boxes around the operands of a union, which tells what their values are at least in some place.
//!
//! The field of an exact distance is no smaller than the distance to the box. That of a bound can be; for those, each box of
//! the hierarchy is kept for several levels: a point outside of the box for a level has a value above that level.

use crate::analysis::{Analysis, extent_at};
use crate::contract::{Aabb, Extent, Metric};
use crate::field::Field;
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Levels for which boxes of bounds are kept, each half of the next one. The largest is the size of everything.
const LEVELS: usize = 12;

/// What a distance to a box is lowered by, relative to the distance and to the size of everything: more than the rounding
/// errors of values, so that no operand is left out that might have the least value by a rounding error.
pub(crate) const SLACK: f64 = 1e-9;

/// The hierarchy. Operands are known by their places in the list that it was built from.
#[derive(Debug)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    /// The boxes for the levels, of all nodes that need them.
    boxes: Vec<[Aabb; LEVELS]>,
    levels: [f64; LEVELS],
    slack: f64,
    /// Operands without a box, of which nothing is known.
    free: Vec<u32>,
}

#[derive(Debug)]
struct Node {
    aabb: Aabb,
    /// Where its boxes for levels are, if the distance to its box is not a lower bound.
    levels: Option<u32>,
    kind: NodeKind,
}

#[derive(Clone, Copy, Debug)]
enum NodeKind {
    Operand(u32),
    Pair(u32, u32),
}

/// An operand with its boxes, while the hierarchy is built.
struct Leaf {
    operand: u32,
    aabb: Aabb,
    levels: Option<Box<[Aabb; LEVELS]>>,
}

/// What a search for the operands with the least values works with.
pub(crate) type Waiting = BinaryHeap<Next>;

impl Bvh {
    /// The hierarchy over some fields with what is known about them.
    pub(crate) fn new(fields: &[Field], known: &[Analysis]) -> Self {
        let all = known.iter().filter_map(|analysis| match analysis.extent {
            Extent::Finite(aabb) => Some(aabb),
            _ => None,
        });
        let all = all.reduce(Aabb::hull).unwrap_or(Aabb { min: DVec3::ZERO, max: DVec3::ZERO });
        let size = all.size().length();
        let mut tree = Self {
            nodes: Vec::with_capacity(2 * fields.len()),
            boxes: Vec::new(),
            levels: std::array::from_fn(|k| size * 0.5_f64.powi((LEVELS - 1 - k) as i32)),
            slack: SLACK * (size + all.min.abs().max(all.max.abs()).max_element()),
            free: Vec::new(),
        };
        let mut leaves = Vec::with_capacity(fields.len());
        for (operand, (field, analysis)) in (0..).zip(fields.iter().zip(known)) {
            let leaf = match analysis.extent {
                // What is empty may still have the least value, as an intersection far from both operands.
                Extent::Finite(aabb) => tree.leaf(operand, field, aabb, analysis.contract.outside),
                Extent::Empty | Extent::Unbounded => None,
            };
            match leaf {
                Some(leaf) => leaves.push(leaf),
                None => tree.free.push(operand),
            }
        }
        if !leaves.is_empty() {
            tree.build(&mut leaves);
        }
        tree
    }

    /// The operands without a box.
    pub(crate) fn free(&self) -> &[u32] {
        &self.free
    }

    /// The box of all operands that have one.
    pub(crate) fn extent(&self) -> Option<Aabb> {
        self.nodes.first().map(|root| root.aabb)
    }

    /// Shows the operands that have a box to `look`, those with the least lower bounds at a point first, until these are
    /// above what `look` returns: the least value that is known of.
    pub(crate) fn nearest(&self, p: DVec3, most: f64, waiting: &mut Waiting, mut look: impl FnMut(u32) -> f64) {
        let place = Aabb { min: p, max: p };
        let mut most = most;
        waiting.clear();
        if !self.nodes.is_empty() {
            waiting.push(Next { least: self.least(0, place), node: 0 });
        }
        while let Some(Next { least, node }) = waiting.pop() {
            if least > most {
                break;
            }
            match self.nodes[node as usize].kind {
                NodeKind::Operand(operand) => most = look(operand),
                NodeKind::Pair(a, b) => {
                    let next = [a, b].map(|node| Next { least: self.least(node, place), node });
                    waiting.extend(next.into_iter().filter(|next| next.least <= most));
                }
            }
        }
    }

    /// What all values in a box are at least.
    pub(crate) fn floor(&self, place: Aabb, waiting: &mut Waiting) -> f64 {
        if !self.free.is_empty() {
            return f64::NEG_INFINITY;
        }
        waiting.clear();
        if !self.nodes.is_empty() {
            waiting.push(Next { least: self.least(0, place), node: 0 });
        }
        while let Some(Next { least, node }) = waiting.pop() {
            match self.nodes[node as usize].kind {
                // The bounds of all others are above.
                NodeKind::Operand(_) => return least,
                NodeKind::Pair(a, b) => {
                    waiting.extend([a, b].map(|node| Next { least: self.least(node, place), node }));
                }
            }
        }
        f64::INFINITY
    }

    /// Appends all operands with values in a box that may be as small as `most`.
    pub(crate) fn within(&self, place: Aabb, most: f64, out: &mut Vec<u32>) {
        out.extend(&self.free);
        let mut pending = vec![0];
        while let Some(node) = pending.pop() {
            if self.nodes.is_empty() || self.least(node, place) > most {
                continue;
            }
            match self.nodes[node as usize].kind {
                NodeKind::Operand(operand) => out.push(operand),
                NodeKind::Pair(a, b) => pending.extend([a, b]),
            }
        }
    }

    /// What the values of all operands of a node are at least in a box.
    fn least(&self, node: u32, place: Aabb) -> f64 {
        let node = &self.nodes[node as usize];
        let Some(levels) = node.levels else {
            let gap = (node.aabb.min - place.max).max(place.min - node.aabb.max).max(DVec3::ZERO);
            let distance = gap.length();
            // Inside of its box an operand may have any value.
            return if distance > 0.0 { distance * (1.0 - SLACK) - self.slack } else { f64::NEG_INFINITY };
        };
        let is_outside =
            |aabb: &Aabb| place.max.cmplt(aabb.min - self.slack).any() || place.min.cmpgt(aabb.max + self.slack).any();
        if !is_outside(&node.aabb) {
            return f64::NEG_INFINITY;
        }
        let passed = self.boxes[levels as usize].iter().take_while(|aabb| is_outside(aabb)).count();
        let level = if passed > 0 { self.levels[passed - 1] } else { 0.0 };
        level * (1.0 - SLACK) - self.slack
    }

    fn leaf(&self, operand: u32, field: &Field, aabb: Aabb, outside: Metric) -> Option<Leaf> {
        if outside == Metric::Exact {
            return Some(Leaf { operand, aabb, levels: None });
        }
        let mut boxes = [aabb; LEVELS];
        for (level, place) in self.levels.into_iter().zip(&mut boxes) {
            match extent_at(field, level) {
                Extent::Finite(aabb) => *place = aabb,
                Extent::Empty | Extent::Unbounded => return None,
            }
        }
        Some(Leaf { operand, aabb, levels: Some(Box::new(boxes)) })
    }

    /// Builds the node of some operands, halving them along the longest side of their middles' box, and returns its place.
    fn build(&mut self, leaves: &mut [Leaf]) -> u32 {
        let place = self.nodes.len() as u32;
        let aabb = leaves.iter().map(|leaf| leaf.aabb).reduce(Aabb::hull).expect("there are leaves");
        let levels = leaves.iter().any(|leaf| leaf.levels.is_some()).then(|| {
            self.boxes.push(std::array::from_fn(|k| {
                let at_level = |leaf: &Leaf| match &leaf.levels {
                    Some(boxes) => boxes[k],
                    None => Aabb { min: leaf.aabb.min - self.levels[k], max: leaf.aabb.max + self.levels[k] },
                };
                leaves.iter().map(at_level).reduce(Aabb::hull).expect("there are leaves")
            }));
            self.boxes.len() as u32 - 1
        });
        self.nodes.push(Node { aabb, levels, kind: NodeKind::Operand(leaves[0].operand) });
        if leaves.len() > 1 {
            let middles = leaves.iter().map(|leaf| leaf.aabb.center()).map(|middle| Aabb { min: middle, max: middle });
            let size = middles.reduce(Aabb::hull).expect("there are leaves").size();
            let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
            let half = leaves.len() / 2;
            leaves.select_nth_unstable_by(half, |a, b| a.aabb.center()[axis].total_cmp(&b.aabb.center()[axis]));
            let (first, second) = leaves.split_at_mut(half);
            let (first, second) = (self.build(first), self.build(second));
            self.nodes[place as usize].kind = NodeKind::Pair(first, second);
        }
        place
    }
}

/// A node that is still to be looked at; the one with the least lower bound comes first.
#[derive(Debug)]
pub(crate) struct Next {
    least: f64,
    node: u32,
}

impl Ord for Next {
    fn cmp(&self, other: &Self) -> Ordering {
        other.least.total_cmp(&self.least).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Next {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Next {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Next {}
