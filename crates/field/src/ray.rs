//! Exact ray intersections, for shapes that have one and profit from it: planes, which a marched ray only crawls along.

use crate::analysis::{axis_map, place_map};
use crate::field::Field;
use crate::shape::{Kind, RayFn};
use glam::{DAffine3, DVec3};

/// A field that is nothing but one placed and painted primitive with an exact intersection.
#[derive(Clone, Debug)]
pub struct ExactRay {
    local_from_world: DAffine3,
    args: Vec<f64>,
    hit: RayFn,
}

impl ExactRay {
    /// The intersection of `field`, if it has one.
    pub fn of(field: &Field) -> Option<Self> {
        let mut world_from_local = DAffine3::IDENTITY;
        let mut field = field;
        loop {
            let node = field.node();
            match &node.shape.kind {
                Kind::Primitive(table) => {
                    if let Some(axis) = node.axis() {
                        world_from_local *= DAffine3::from_mat3(axis_map(axis));
                    }
                    return Some(Self {
                        local_from_world: world_from_local.inverse(),
                        args: node.numbers(),
                        hit: table.ray?,
                    });
                }
                Kind::Place(_) => world_from_local *= place_map(node)?.0,
                Kind::Paint => {}
                Kind::Combine(_) if node.children.len() == 1 => {}
                Kind::Combine(_) | Kind::Modify(_) => return None,
            }
            field = node.children.first()?;
        }
    }

    /// The distance along the ray from `origin` along the unit vector `direction` to the first point on the surface or
    /// inside, if there is one.
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let local = self.local_from_world.transform_vector3(direction);
        let scale = local.length();
        (self.hit)(
            &self.args,
            self.local_from_world.transform_point3(origin),
            local / scale,
        )
        .map(|t| t / scale)
    }
}
