//! Exact ray intersections, for shapes that have one and profit from it: planes, which a marched ray only crawls along.

use crate::analysis::axis_map;
use crate::field::{Field, Node};
use crate::shape::{ExactForm, Kind};
use glam::{DAffine3, DMat3, DVec3};

/// A field that is nothing but one placed and painted primitive with an exact intersection.
#[derive(Clone, Copy, Debug)]
pub struct ExactRay(ExactForm);

impl ExactRay {
    /// The intersection of `field`, if it has one.
    pub fn of(field: &Field) -> Option<Self> {
        let (primitive, map) = placed_primitive(field)?;
        let Kind::Primitive(table) = &primitive.shape.kind else { return None };
        (table.exact_form)(&primitive.numbers()).map(|form| Self(form.mapped(&map)))
    }

    /// The surface.
    pub fn form(&self) -> ExactForm {
        self.0
    }

    /// The distance along the ray from `origin` along the unit vector `direction` to the first point on the surface or
    /// inside, if there is one.
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        match self.0 {
            ExactForm::HalfSpace { normal, offset } => {
                let height = normal.dot(origin) - offset;
                if height <= 0.0 {
                    return Some(0.0);
                }
                let descent = -normal.dot(direction);
                (descent > 0.0).then(|| height / descent)
            }
            ExactForm::Sheet { normal, offset } => {
                let t = (offset - normal.dot(origin)) / normal.dot(direction);
                (t.is_finite() && t >= 0.0).then_some(t)
            }
        }
    }
}

/// The primitive that a field is, but for paint and its place in space, and the map that leads there.
pub(crate) fn placed_primitive(field: &Field) -> Option<(&Node, DAffine3)> {
    let mut map = DAffine3::IDENTITY;
    let mut field = field;
    loop {
        let node = field.node();
        match &node.shape.kind {
            Kind::Primitive(_) => {
                if let Some(axis) = node.axis() {
                    map *= DAffine3::from_mat3(axis_map(axis));
                }
                return Some((node, map));
            }
            Kind::Place(table) => map *= (table.map)(&node.numbers()),
            Kind::Paint => {}
            Kind::Combine(_) if node.children.len() == 1 => {}
            Kind::Combine(_)
            | Kind::Map(_)
            | Kind::Modify(_)
            | Kind::Product(_)
            | Kind::Loft
            | Kind::PerimeterSweep
            | Kind::Copies(_)
            | Kind::Endless { .. }
            | Kind::Formula
            | Kind::Warp
            | Kind::Displace
            | Kind::Twist => return None,
        }
        field = node.children.first()?;
    }
}

impl ExactForm {
    /// The surface after an affine map of space.
    fn mapped(self, map: &DAffine3) -> Self {
        let covector: DMat3 = map.matrix3.inverse().transpose();
        let plane = |normal: DVec3, offset: f64| {
            let point = map.transform_point3(normal * offset);
            let normal = (covector * normal).normalize();
            (normal, normal.dot(point))
        };
        match self {
            Self::HalfSpace { normal, offset } => {
                let (normal, offset) = plane(normal, offset);
                Self::HalfSpace { normal, offset }
            }
            Self::Sheet { normal, offset } => {
                let (normal, offset) = plane(normal, offset);
                Self::Sheet { normal, offset }
            }
        }
    }
}
