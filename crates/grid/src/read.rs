//! Reading samples: values, distances that are safe to go, and what is nearest.

use crate::bricks::{Bricks, EMPTY, HALF_DIAGONAL, MARGIN};
use crate::lattice::{CELLS, SAMPLES};
use glam::{UVec3, Vec3};

impl Bricks {
    /// The field at a point: by trilinear interpolation between the fine samples around it, or where there are none, between
    /// the middles of bricks. Outside of the box it is no more than the distance to anything inside.
    ///
    /// With fine samples, it is off by no more than half the diagonal of a cell, where the field is smooth by no more than
    /// three eighths of the square of its edge times the largest second derivative; without, by half the diagonal of a brick.
    pub fn value(&self, p: Vec3) -> f32 {
        self.seen_from(p, |inside| self.value_inside(inside))
    }

    /// How far one may go from a point outside of the surface without meeting it; negative inside. Unlike [`Bricks::value`]
    /// it never exceeds the distance where there are no fine samples; where there are, it is the same.
    pub fn free(&self, p: Vec3) -> f32 {
        self.seen_from(p, |inside| {
            let (brick, _) = self.lattice.find(inside);
            let number = self.lattice.number(brick);
            if self.slots[number] != EMPTY {
                return self.value_inside(inside);
            }
            // A field changes by no more than the distance, and what holds no fine samples is no nearer than the margin.
            let middle = self.middles[number];
            let away = inside.distance(self.lattice.middle(brick));
            let least = (middle.abs() - away).max(MARGIN as f32 * self.lattice.voxel());
            least.copysign(middle)
        })
    }

    /// The number of what is nearest to a point, by the nearest sample; `None` where there are no fine ones.
    pub fn label(&self, p: Vec3) -> Option<u32> {
        let (brick, cells) = self.lattice.find(p);
        let slot = self.slots[self.lattice.number(brick)];
        let sample = (cells - (brick * CELLS).as_vec3()).round().clamp(Vec3::ZERO, Vec3::splat(CELLS as f32));
        (slot != EMPTY).then(|| self.labels[place(slot, sample.as_uvec3())])
    }

    /// From outside of the box: a surface in it is seen from the nearest point of the box at an obtuse angle, so that the squares
    /// of both distances add up to no more than that of the whole.
    fn seen_from(&self, p: Vec3, value: impl Fn(Vec3) -> f32) -> f32 {
        let inside = p.clamp(self.lattice.min(), self.lattice.max());
        let (value, away) = (value(inside), p.distance(inside));
        if away == 0.0 { value } else { away.hypot(value.max(0.0)) }
    }

    fn value_inside(&self, p: Vec3) -> f32 {
        let (brick, cells) = self.lattice.find(p);
        let slot = self.slots[self.lattice.number(brick)];
        if slot != EMPTY {
            let most = Vec3::splat(CELLS as f32);
            let local = (cells - (brick * CELLS).as_vec3()).clamp(Vec3::ZERO, most);
            let first = local.floor().min(most - 1.0);
            let corner = first.as_uvec3();
            return between(local - first, |step| self.values[place(slot, corner + step)]);
        }
        let last = self.lattice.bricks() - UVec3::ONE;
        let local = (cells / CELLS as f32 - 0.5).clamp(Vec3::ZERO, last.as_vec3());
        let first = local.floor();
        let corner = first.as_uvec3();
        let coarse = between(local - first, |step| self.middles[self.lattice.number((corner + step).min(last))]);
        // At the border of the box the middles around a point lie to one side of it, half a brick away at most.
        let reach = HALF_DIAGONAL * self.lattice.brick();
        let own = self.middles[self.lattice.number(brick)];
        coarse.clamp(own - reach, own + reach)
    }
}

/// The place of a sample among all.
fn place(slot: u32, sample: UVec3) -> usize {
    let [x, y, z] = sample.to_array().map(|place| place as usize);
    let side = SAMPLES as usize;
    slot as usize * side.pow(3) + x + side * (y + side * z)
}

/// Trilinear interpolation between the corners of a unit cube.
fn between(share: Vec3, corner: impl Fn(UVec3) -> f32) -> f32 {
    let at = |x, y, z| corner(UVec3::new(x, y, z));
    let line = |y, z| at(0, y, z) + share.x * (at(1, y, z) - at(0, y, z));
    let face = |z| line(0, z) + share.y * (line(1, z) - line(0, z));
    face(0) + share.z * (face(1) - face(0))
}
