//! All shapes, one file each.
//!
//! Written by `cargo xtask shapes` from the files in the folder of the same name. To add a shape, write its file and run
//! that command.

pub mod capsule;
pub mod circle;
pub mod complement;
pub mod cone;
pub mod convex_polyhedron;
pub mod convex_polyhedron_bound;
pub mod cuboid;
pub mod cylinder;
pub mod difference;
pub mod displace;
pub mod ellipsoid;
pub mod ellipsoid_bound;
pub mod elongate;
mod escape;
pub mod extrude;
pub mod formula;
pub mod intersection;
pub mod mandelbulb;
pub mod offset;
pub mod paint;
pub mod plane;
mod polynomial;
pub mod quaternion_julia;
pub mod rectangle;
pub mod reflect;
pub mod repeat;
pub mod repeat_mirrored;
pub mod repeat_polar;
pub mod revolve;
pub mod rotate;
pub mod rotate_euler;
pub mod rotate_quaternion;
pub mod scale;
pub mod sheet;
pub mod shell;
pub mod slab;
pub mod smooth_difference;
pub mod smooth_intersection;
pub mod smooth_union;
pub mod sphere;
pub mod stretch;
pub mod symmetry;
pub mod torus;
pub mod translate;
pub mod twist;
pub mod union;
pub mod warp;
pub mod xor;

pub use capsule::*;
pub use circle::*;
pub use complement::*;
pub use cone::*;
pub use convex_polyhedron::*;
pub use convex_polyhedron_bound::*;
pub use cuboid::*;
pub use cylinder::*;
pub use difference::*;
pub use displace::*;
pub use ellipsoid::*;
pub use ellipsoid_bound::*;
pub use elongate::*;
pub use extrude::*;
pub use formula::*;
pub use intersection::*;
pub use mandelbulb::*;
pub use offset::*;
pub use paint::*;
pub use plane::*;
pub use quaternion_julia::*;
pub use rectangle::*;
pub use reflect::*;
pub use repeat::*;
pub use repeat_mirrored::*;
pub use repeat_polar::*;
pub use revolve::*;
pub use rotate::*;
pub use rotate_euler::*;
pub use rotate_quaternion::*;
pub use scale::*;
pub use sheet::*;
pub use shell::*;
pub use slab::*;
pub use smooth_difference::*;
pub use smooth_intersection::*;
pub use smooth_union::*;
pub use sphere::*;
pub use stretch::*;
pub use symmetry::*;
pub use torus::*;
pub use translate::*;
pub use twist::*;
pub use union::*;
pub use warp::*;
pub use xor::*;

use crate::shape::Shape;

/// The descriptors of all shapes, by name.
pub static ALL: &[&Shape] = &[
    &CAPSULE,
    &CIRCLE,
    &COMPLEMENT,
    &CONE,
    &CONVEX_POLYHEDRON,
    &CONVEX_POLYHEDRON_BOUND,
    &BOX,
    &CYLINDER,
    &DIFFERENCE,
    &DISPLACE,
    &ELLIPSOID,
    &ELLIPSOID_BOUND,
    &ELONGATE,
    &EXTRUDE,
    &FORMULA,
    &INTERSECTION,
    &MANDELBULB,
    &OFFSET,
    &PAINT,
    &PLANE,
    &QUATERNION_JULIA,
    &RECTANGLE,
    &REFLECT,
    &REPEAT,
    &REPEAT_MIRRORED,
    &REPEAT_POLAR,
    &REVOLVE,
    &ROTATE,
    &ROTATE_EULER,
    &ROTATE_QUATERNION,
    &SCALE,
    &SHEET,
    &SHELL,
    &SLAB,
    &SMOOTH_DIFFERENCE,
    &SMOOTH_INTERSECTION,
    &SMOOTH_UNION,
    &SPHERE,
    &STRETCH,
    &SYMMETRY,
    &TORUS,
    &TRANSLATE,
    &TWIST,
    &UNION,
    &WARP,
    &XOR,
];
