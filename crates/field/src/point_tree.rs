//! Points of space in a complete binary tree of boxes, as the constants that [`crate::Scalar::fold_tree`] searches.

use crate::scalar::Tree;
use glam::DVec3;
use std::array::from_fn;

/// Nodes are boxes, by their middle and half their size; rows are points.
pub(crate) const TREE: Tree = Tree { node: 6, row: 3, leaf: 8 };

/// Boxes are larger by this share of their size and of their place: more than single precision changes points, boxes and the
/// distances between them.
const MARGIN: f64 = 1e-6;

/// Every coordinate of what fills up the last leaf: so far away that it is never near, but not so far that squares of distances were
/// infinite.
const NOWHERE: f64 = 1e18;

/// Squares of distances from boxes are taken for less by this share, which is more than rounding adds to them.
pub(crate) const SHORTER: f64 = 1e-5;

/// Added to a square that shall be found once more: no smaller one makes a difference.
const LEAST: f32 = 1e-36;

/// So many nodes wait at most: three for each two levels of a tree, whose constants are counted by numbers of 32 bits, and those
/// that are being sorted.
const WAITING: usize = 3 * 16 + 4;

/// The constants of a tree of these points: at least one. Of node 0, which is none, those after the number of leaves are `own`.
pub(crate) fn constants(mut points: Vec<DVec3>, own: &[f64]) -> Vec<f64> {
    let leaves = points.len().div_ceil(TREE.leaf);
    let mut out = vec![0.0; leaves * (2 * TREE.node + TREE.leaf * TREE.row)];
    out[Tree::LEAVES] = leaves as f64;
    out[Tree::LEAVES + 1..][..own.len()].copy_from_slice(own);
    let mut below = vec![1; 2 * leaves];
    (1..leaves).rev().for_each(|node| below[node] = below[2 * node] + below[2 * node + 1]);
    fill(&mut out, &below, 1, &mut points);
    out
}

/// Writes the tree below a node, which has these points, and all its leaves full of them but for the last one; yields their box.
fn fill(out: &mut [f64], below: &[usize], node: usize, points: &mut [DVec3]) -> [DVec3; 2] {
    let leaves = below.len() / 2;
    let [low, high] = if node >= leaves {
        let first = below.len() * TREE.node + (node - leaves) * TREE.leaf * TREE.row;
        let full = points.iter().copied().chain(std::iter::repeat(DVec3::splat(NOWHERE))).take(TREE.leaf);
        full.zip(out[first..].chunks_exact_mut(TREE.row)).for_each(|(point, row)| point.write_to_slice(row));
        around(points)
    } else {
        let [low, high] = around(points);
        let axis = (high - low).max_position();
        let (left, ..) = points.select_nth_unstable_by(TREE.leaf * below[2 * node], |a, b| a[axis].total_cmp(&b[axis]));
        let left = left.len();
        let (left, right) = points.split_at_mut(left);
        let (a, b) = (fill(out, below, 2 * node, left), fill(out, below, 2 * node + 1, right));
        [a[0].min(b[0]), a[1].max(b[1])]
    };
    let middle = (low + high) / 2.0;
    let half = (high - low) / 2.0 + ((high - low) + low.abs().max(high.abs())) * MARGIN;
    let row = &mut out[node * TREE.node..][..TREE.node];
    middle.write_to_slice(row);
    half.write_to_slice(&mut row[3..]);
    [low, high]
}

fn around(points: &[DVec3]) -> [DVec3; 2] {
    let start = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    points.iter().fold(start, |[low, high], &point| [low.min(point), high.max(point)])
}

/// What is looked for in a tree of points: where the least of some numbers is found, none of which is below 0.
pub(crate) trait Quest {
    /// What no number in each of some boxes is below: at least 0.
    fn keys<const N: usize>(&self, boxes: &[f32]) -> [f32; N];

    /// Looks at a leaf, by its place among them, and returns the least number that is known now, given that before.
    fn visit(&mut self, leaf: usize, least: f32) -> f32;
}

/// Goes through a tree, given by its boxes, as long as there may be numbers below `least`. Boxes with smaller keys come first, and
/// those are passed over of which the key is above what was found (Friedman, Bentley and Finkel, "An Algorithm for Finding Best
/// Matches in Logarithmic Expected Time", 1977).
#[inline(always)]
pub(crate) fn walk(boxes: &[f32], leaves: usize, mut least: f32, quest: &mut impl Quest) {
    let (mut waiting, mut count) = ([Waiting::default(); WAITING], 1);
    waiting[0] = Waiting::new(0.0, 1);
    while count > 0 {
        count -= 1;
        let next = waiting[count];
        if next.key() >= least {
            continue;
        }
        let node = next.node();
        if node >= leaves {
            least = quest.visit(node - leaves, least);
            continue;
        }
        let mut push = |next: Waiting| {
            waiting[count] = next;
            count += usize::from(next.key() < least);
        };
        if 4 * node + 3 < 2 * leaves {
            let [a, b, c, d] = below(boxes, 4 * node, quest);
            // A sorting network, without branches.
            let ([a, b], [c, d]) = (ordered(a, b), ordered(c, d));
            let ([a, c], [b, d]) = (ordered(a, c), ordered(b, d));
            let [b, c] = ordered(b, c);
            for next in [a, b, c, d] {
                push(next);
            }
        } else {
            let [a, b] = below(boxes, 2 * node, quest);
            for next in ordered(a, b) {
                push(next);
            }
        }
    }
}

/// Some nodes, one after another, with their keys.
#[inline(always)]
fn below<const N: usize>(boxes: &[f32], first: usize, quest: &impl Quest) -> [Waiting; N] {
    let keys: [f32; N] = quest.keys(&boxes[first * TREE.node..][..N * TREE.node]);
    from_fn(|index| Waiting::new(keys[index], first + index))
}

/// Searches of one tree, one after another: what was found for a point is where the search for the next one begins.
pub(crate) struct Search<'t> {
    constants: &'t [f32],
    leaves: usize,
    found: [f32; 3],
}

impl<'t> Search<'t> {
    /// Of the tree with these constants.
    pub(crate) fn new(constants: &'t [f32]) -> Self {
        Self { constants, leaves: TREE.leaves(constants.len()), found: [NOWHERE as f32; 3] }
    }

    /// The row nearest to a point.
    ///
    /// It is code of the baseline on purpose: points do not take the same way through a tree, so that each lane goes its own.
    #[inline(never)]
    pub(crate) fn nearest(&mut self, p: [f32; 3]) -> [f32; 3] {
        let least = square_between(p, self.found) * (1.0 + SHORTER as f32) + LEAST;
        let (boxes, rows) = self.constants.split_at(2 * self.leaves * TREE.node);
        let mut quest = Nearest { p, rows, found: self.found };
        walk(boxes, self.leaves, least, &mut quest);
        self.found = quest.found;
        self.found
    }
}

/// The search for the row nearest to a point; its numbers are squares of distances.
struct Nearest<'t> {
    p: [f32; 3],
    rows: &'t [f32],
    found: [f32; 3],
}

impl Quest for Nearest<'_> {
    #[inline(always)]
    fn keys<const N: usize>(&self, boxes: &[f32]) -> [f32; N] {
        let mut squares = [0.0; N];
        for axis in 0..3 {
            for (square, row) in squares.iter_mut().zip(boxes.chunks_exact(TREE.node)) {
                let outside = ((self.p[axis] - row[axis]).abs() - row[3 + axis]).max(0.0);
                *square += outside * outside;
            }
        }
        squares.map(|square| square * (1.0 - SHORTER as f32))
    }

    #[inline(always)]
    fn visit(&mut self, leaf: usize, least: f32) -> f32 {
        let rows: [[f32; TREE.row]; TREE.leaf] = rows(self.rows, leaf);
        let squares = rows.map(|row| square_between(self.p, row));
        // From `least` on: at places without numbers no square is less than any.
        let square = squares.iter().fold(least, |least, &square| if square < least { square } else { least });
        if square < least {
            let place = squares.iter().position(|&other| other == square).expect("one of them");
            self.found = rows[place];
        }
        square
    }
}

/// The rows of a leaf, of those of all leaves.
#[inline(always)]
pub(crate) fn rows<T: Copy>(all: &[T], leaf: usize) -> [[T; TREE.row]; TREE.leaf] {
    let size = TREE.leaf * TREE.row;
    let rows = all[leaf * size..][..size].as_chunks().0;
    rows.try_into().expect("a leaf is full")
}

/// A node to be visited, and its key: one number, which is greater if the key is. (The bits of numbers that are not negative are ordered
/// as they are.)
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Waiting(u64);

impl Waiting {
    #[inline(always)]
    fn new(key: f32, node: usize) -> Self {
        Self(u64::from(key.to_bits()) << 32 | node as u64)
    }

    #[inline(always)]
    fn key(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    fn node(self) -> usize {
        self.0 as u32 as usize
    }
}

/// The greater one first.
#[inline(always)]
fn ordered(a: Waiting, b: Waiting) -> [Waiting; 2] {
    [a.max(b), a.min(b)]
}

#[inline(always)]
fn square_between(p: [f32; 3], q: [f32; 3]) -> f32 {
    let [x, y, z] = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    x * x + y * y + z * z
}
