//! Paint: a material for a part of a tree. Changes no distance.

use crate::shape::{About, Kind, Shape};

/// The descriptor of [`crate::Field::painted`].
pub static PAINT: Shape = Shape {
    about: About {
        name: "paint",
        summary: "Gives a shape a material. The innermost paint wins; blends mix their parts' materials.",
        params: &[],
        elsewhere: &["color", "material"],
        example: r##"{ "paint": { "material": "clay", "shape": { "sphere": { "radius": 1 } } } }"##,
    },
    kind: Kind::Paint,
};
