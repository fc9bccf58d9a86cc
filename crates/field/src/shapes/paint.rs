//! Paint: a material for a part of a tree. Changes no distance.

use crate::field::{Field, MaterialId, Origin};
use crate::shape::{About, Kind, Shape};
use std::panic::Location;

/// Giving a shape a material.
pub trait Paint: Into<Field> {
    /// The shape in a material; what was painted on a part of it before stays.
    #[track_caller]
    fn painted(self, material: MaterialId) -> Field {
        Field::with_origin(&PAINT, [], [self.into()], Some(material), Origin::Code(Location::caller()))
    }
}

impl<F: Into<Field>> Paint for F {}

/// The descriptor of [`Paint::painted`].
pub static PAINT: Shape = Shape {
    about: About {
        name: "paint",
        summary: "Gives a shape a material. The innermost paint wins; blends mix their parts' materials.",
        params: &[],
        elsewhere: &["color", "material"],
        example: r##"{ "paint": { "material": "clay", "shape": { "sphere": { "radius": 1 } } } }"##,
    },
    kind: Kind::Paint,
    file: None,
};
