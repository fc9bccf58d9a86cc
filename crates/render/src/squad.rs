//! Some rays of a bundle, moved together so that no lane is idle: for work that costs more than moving them.

use crate::bundle::{Bundle, LANES, RAYS, Rows};
use freikugel_field::kernel::Block;

/// Rays side by side, with `N` further numbers for each.
pub(crate) struct Squad<const N: usize> {
    count: usize,
    /// Their places in the bundle.
    ray: [u32; RAYS],
    pub(crate) origin: [Block; 3],
    pub(crate) direction: [Block; 3],
    /// Where each ray is, and where its stretch ends.
    pub(crate) t: Block,
    pub(crate) end: Block,
    pub(crate) steps: [u32; RAYS],
    pub(crate) further: [Block; N],
}

impl<const N: usize> Default for Squad<N> {
    fn default() -> Self {
        Self {
            count: 0,
            ray: [0; RAYS],
            origin: Default::default(),
            direction: Default::default(),
            t: Block::default(),
            end: Block::default(),
            steps: [0; RAYS],
            further: std::array::from_fn(|_| Block::default()),
        }
    }
}

impl<const N: usize> Squad<N> {
    /// Takes the rays of some rows that meet the box tested last, on their stretches in it. `further` makes the further
    /// numbers of a ray, which it gets by its place in the bundle.
    pub(crate) fn gather(&mut self, bundle: &Bundle, rows: Rows, further: impl Fn(usize) -> [f32; N]) {
        self.count = 0;
        for ray in rows.starts().flat_map(|start| start..start + LANES) {
            let (enter, leave) = (bundle.enter.0[ray], bundle.leave.0[ray]);
            if leave == f32::NEG_INFINITY {
                continue;
            }
            let place = self.count;
            self.count += 1;
            self.ray[place] = ray as u32;
            for axis in 0..3 {
                self.origin[axis].0[place] = bundle.origin[axis].0[ray];
                self.direction[axis].0[place] = bundle.direction[axis].0[ray];
            }
            self.t.0[place] = enter;
            self.end.0[place] = leave;
            self.steps[place] = bundle.steps[ray];
            for (block, number) in self.further.iter_mut().zip(further(ray)) {
                block.0[place] = number;
            }
        }
    }

    /// How many rays there are.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// How many lanes they take. What the last ones hold does not matter.
    pub(crate) fn lanes(&self) -> usize {
        self.count.next_multiple_of(LANES)
    }

    /// Keeps the rays that `keep` wants, which it gets by their places here and in the bundle.
    pub(crate) fn retain(&mut self, mut keep: impl FnMut(&Self, usize, usize) -> bool) {
        let mut kept = 0;
        for place in 0..self.count {
            if !keep(self, place, self.ray[place] as usize) {
                continue;
            }
            if kept < place {
                self.ray[kept] = self.ray[place];
                self.steps[kept] = self.steps[place];
                let Self { origin, direction, t, end, further, .. } = self;
                for numbers in origin.iter_mut().chain(direction).chain([t, end]).chain(further) {
                    numbers.0[kept] = numbers.0[place];
                }
            }
            kept += 1;
        }
        self.count = kept;
    }
}
