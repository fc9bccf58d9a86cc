//! Points of space in a complete binary tree of boxes, as the constants that [`crate::Scalar::fold_tree`] searches.

use crate::scalar::Tree;
use glam::DVec3;

/// Nodes are boxes, by their middle and half their size; rows are points.
pub(crate) const TREE: Tree = Tree { node: 6, row: 3, leaf: 8 };

/// Boxes are larger by this share of their size and of their place: more than single precision changes points, boxes and the
/// distances between them.
const MARGIN: f64 = 1e-6;

/// What fills up the last leaf: so far away that it is never near, but not so far that squares of distances were infinite.
const NOWHERE: DVec3 = DVec3::splat(1e18);

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
        let full = points.iter().chain(std::iter::repeat(&NOWHERE)).take(TREE.leaf);
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
