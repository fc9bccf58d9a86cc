//! All shapes, one file each.
//!
//! Written by `cargo xtask shapes` from the files in the folder of the same name. To add a shape, write its file and run
//! that command.

pub mod any_order;
mod blend;
pub mod box_frame;
pub mod capped_torus;
pub mod capsule;
pub mod chamfer;
pub mod circle;
pub mod complement;
pub mod cone;
pub mod convex_polyhedron;
pub mod convex_polyhedron_bound;
pub mod cuboid;
pub mod cut_sphere;
pub mod cylinder;
pub mod difference;
pub mod displace;
pub mod ellipsoid;
pub mod ellipsoid_bound;
pub mod elongate;
mod escape;
pub mod exponential;
pub mod extrude;
pub mod formula;
pub mod intersection;
pub mod link;
pub mod mandelbulb;
pub mod octahedron;
pub mod offset;
pub mod paint;
pub mod plane;
pub mod polygon;
mod polynomial;
pub mod quaternion_julia;
pub mod rectangle;
pub mod reflect;
pub mod regular_polygon;
pub mod repeat;
pub mod repeat_mirrored;
pub mod repeat_polar;
pub mod revolve;
pub mod ring;
pub mod root;
pub mod rotate;
pub mod rotate_euler;
pub mod rotate_quaternion;
pub mod round;
pub mod round_cone;
pub mod scale;
pub mod sheet;
pub mod shell;
pub mod slab;
pub mod smooth_difference;
pub mod smooth_intersection;
pub mod smooth_union;
pub mod solid_angle;
pub mod sphere;
pub mod stairs;
pub mod star;
pub mod stretch;
pub mod symmetry;
pub mod torus;
pub mod translate;
pub mod twist;
pub mod union;
pub mod warp;
pub mod xor;

pub use any_order::*;
pub use box_frame::*;
pub use capped_torus::*;
pub use capsule::*;
pub use chamfer::*;
pub use circle::*;
pub use complement::*;
pub use cone::*;
pub use convex_polyhedron::*;
pub use convex_polyhedron_bound::*;
pub use cuboid::*;
pub use cut_sphere::*;
pub use cylinder::*;
pub use difference::*;
pub use displace::*;
pub use ellipsoid::*;
pub use ellipsoid_bound::*;
pub use elongate::*;
pub use exponential::*;
pub use extrude::*;
pub use formula::*;
pub use intersection::*;
pub use link::*;
pub use mandelbulb::*;
pub use octahedron::*;
pub use offset::*;
pub use paint::*;
pub use plane::*;
pub use polygon::*;
pub use quaternion_julia::*;
pub use rectangle::*;
pub use reflect::*;
pub use regular_polygon::*;
pub use repeat::*;
pub use repeat_mirrored::*;
pub use repeat_polar::*;
pub use revolve::*;
pub use ring::*;
pub use root::*;
pub use rotate::*;
pub use rotate_euler::*;
pub use rotate_quaternion::*;
pub use round::*;
pub use round_cone::*;
pub use scale::*;
pub use sheet::*;
pub use shell::*;
pub use slab::*;
pub use smooth_difference::*;
pub use smooth_intersection::*;
pub use smooth_union::*;
pub use solid_angle::*;
pub use sphere::*;
pub use stairs::*;
pub use star::*;
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
    &POLYNOMIAL_UNION,
    &POLYNOMIAL_INTERSECTION,
    &POLYNOMIAL_DIFFERENCE,
    &BOX_FRAME,
    &CAPPED_TORUS,
    &CAPSULE,
    &CHAMFER_UNION,
    &CHAMFER_INTERSECTION,
    &CHAMFER_DIFFERENCE,
    &CIRCLE,
    &COMPLEMENT,
    &CONE,
    &CONVEX_POLYHEDRON,
    &CONVEX_POLYHEDRON_BOUND,
    &BOX,
    &CUT_SPHERE,
    &CYLINDER,
    &DIFFERENCE,
    &DISPLACE,
    &ELLIPSOID,
    &ELLIPSOID_BOUND,
    &ELONGATE,
    &EXPONENTIAL_UNION,
    &EXPONENTIAL_INTERSECTION,
    &EXPONENTIAL_DIFFERENCE,
    &EXTRUDE,
    &FORMULA,
    &INTERSECTION,
    &LINK,
    &MANDELBULB,
    &OCTAHEDRON,
    &OFFSET,
    &PAINT,
    &PLANE,
    &POLYGON,
    &QUATERNION_JULIA,
    &RECTANGLE,
    &REFLECT,
    &REGULAR_POLYGON,
    &REPEAT,
    &REPEAT_MIRRORED,
    &REPEAT_POLAR,
    &REVOLVE,
    &RING,
    &ROOT_UNION,
    &ROOT_INTERSECTION,
    &ROOT_DIFFERENCE,
    &ROTATE,
    &ROTATE_EULER,
    &ROTATE_QUATERNION,
    &ROUND_UNION,
    &ROUND_INTERSECTION,
    &ROUND_DIFFERENCE,
    &ROUND_CONE,
    &SCALE,
    &SHEET,
    &SHELL,
    &SLAB,
    &SMOOTH_DIFFERENCE,
    &SMOOTH_INTERSECTION,
    &SMOOTH_UNION,
    &SOLID_ANGLE,
    &SPHERE,
    &STAIRS_UNION,
    &STAIRS_INTERSECTION,
    &STAIRS_DIFFERENCE,
    &STAR,
    &STRETCH,
    &SYMMETRY,
    &TORUS,
    &TRANSLATE,
    &TWIST,
    &UNION,
    &WARP,
    &XOR,
];
