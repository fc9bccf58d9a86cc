//! Searches of trees ([`Scalar::fold_tree`]) as loops, whose state tells which node comes next: without a stack.

use super::{Condition, Expr, Moved, Slots};
use crate::scalar::{Constants, Scalar, Tree};

/// More nodes than any tree has.
const MOST_NODES: u32 = 1 << 30;

/// More levels than any tree has.
const MOST_LEVELS: u32 = 32;

/// A search to be recorded. Nodes are whole numbers; single precision has all those of trees of 16 million constants.
pub(super) struct TreeSearch<'g, B, S> {
    leaves: Expr<'g>,
    /// The slot of the tree's first constant.
    first: u32,
    tree: Tree,
    bound: B,
    step: S,
}

impl<'g, B, S> TreeSearch<'g, B, S>
where
    B: Fn(&Constants<'_, Expr<'g>>) -> Expr<'g>,
{
    pub(super) fn new(constants: &Constants<'_, Expr<'g>>, tree: Tree, bound: B, step: S) -> Self {
        Self { leaves: constants.at(Tree::LEAVES), first: constants.place(), tree, bound, step }
    }

    /// See [`Scalar::fold_tree`].
    pub(super) fn all<const N: usize>(&self, state: [Expr<'g>; N]) -> [Expr<'g>; N]
    where
        S: Fn([Expr<'g>; N], &Constants<'_, Expr<'g>>) -> [Expr<'g>; N],
    {
        let (graph, one) = (self.leaves.graph, self.leaves.lift(1.0));
        let (_, state) = graph.repeat_with(MOST_NODES, one, state, |node, state| {
            let is_entered = self.bound_of(node).lt(state[0]);
            let is_inner = node.lt(self.leaves);
            let state = self.rows(state, node, is_entered & !is_inner);
            let [after] = graph.repeat(MOST_LEVELS, [node + 1.0], |[node]| {
                let half = node * 0.5;
                let is_even = !half.floor().lt(half);
                ([Expr::select(is_even, half, node)], is_even)
            });
            let next = Expr::select(is_entered & is_inner, node * 2.0, after);
            (next, state, one.lt(next))
        });
        state
    }

    /// See [`Scalar::fold_leaf`].
    pub(super) fn near<const N: usize>(&self, state: [Expr<'g>; N]) -> [Expr<'g>; N]
    where
        S: Fn([Expr<'g>; N], &Constants<'_, Expr<'g>>) -> [Expr<'g>; N],
    {
        let one = self.leaves.lift(1.0);
        let [node] = self.leaves.graph.repeat(MOST_LEVELS, [one], |[node]| {
            // The tree may have a single leaf.
            let is_inner = node.lt(self.leaves);
            let left = Expr::select(is_inner, node * 2.0, node);
            let right = Expr::select(is_inner, left + 1.0, node);
            let node = Expr::select(self.bound_of(right).lt(self.bound_of(left)), right, left);
            ([node], node.lt(self.leaves))
        });
        self.rows(state, node, !node.lt(self.leaves))
    }

    fn constants<R>(&self, index: Expr<'g>, count: usize, read: impl FnOnce(&Constants<'_, Expr<'g>>) -> R) -> R {
        read(&Constants::new(self.leaves, &Slots { first: self.first, moved: Moved::By(index.id) }, count))
    }

    fn bound_of(&self, node: Expr<'g>) -> Expr<'g> {
        let width = self.tree.node;
        self.constants(node * width as f64, width, &self.bound)
    }

    /// The state after the rows of a leaf, if it is wanted.
    fn rows<const N: usize>(&self, state: [Expr<'g>; N], node: Expr<'g>, is_wanted: Condition<'g>) -> [Expr<'g>; N]
    where
        S: Fn([Expr<'g>; N], &Constants<'_, Expr<'g>>) -> [Expr<'g>; N],
    {
        let Tree { node: node_width, row: width, leaf } = self.tree;
        // Where no leaf is wanted, that of some leaf, so that nothing is read from elsewhere.
        let before = node.max(self.leaves) - self.leaves;
        let place = self.leaves * (2 * node_width) as f64 + before * (leaf * width) as f64;
        let (_, state) = self.leaves.graph.repeat_with(leaf as u32, place, state, |place, state| {
            let next = self.constants(place, width, |row| (self.step)(state, row));
            let mut index = 0;
            let state = state.map(|before| {
                index += 1;
                Expr::select(is_wanted, next[index - 1], before)
            });
            (place + width as f64, state, is_wanted)
        });
        state
    }
}
