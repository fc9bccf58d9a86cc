//! Signed distance fields: formulas, contracts, and evaluation.
//!
//! A [`Field`] is a tree of calls of [`Shape`]s: primitives, and functions that place, modify, combine and paint other
//! fields. [`analyse`] finds its mistakes, its [`Contract`] and its [`Extent`]. [`Structure::compile`] flattens it into a
//! short list of coarse operations, [`Structure::bind`] fills in the numbers, and an [`Evaluator`] runs the resulting
//! [`Program`] over batches of points on the best instruction set of the machine:
//!
//! ```
//! use freikugel_field::{Evaluator, Points, Structure, shapes::*};
//!
//! let cup = cylinder(1.0, 2.0) - cylinder(0.85, 2.0).at([0.0, 0.0, 0.2]);
//! let structure = Structure::compile(&[cup]).expect("a sound field");
//! let program = structure.program(glam::DVec3::ZERO);
//!
//! let (x, y, z) = ([0.0, 0.9, 3.0], [0.0; 3], [0.0; 3]);
//! let mut distances = [0.0; 3];
//! Evaluator::new(&program).values(Points { x: &x, y: &y, z: &z }, &mut distances);
//! assert!(distances[0] > 0.0, "the middle is hollow");
//! assert!(distances[1] < 0.0, "the wall is solid");
//! assert_eq!(distances[2], 2.0);
//! ```
//!
//! Every formula is written once, over a [`Scalar`]; see there for the number types it runs on. This crate knows nothing
//! of files, cameras, colours, threads or graphics processors.

pub mod analysis;
mod arcs;
mod arcs3;
pub mod balls;
mod bank;
mod bvh;
pub mod cells;
mod compile;
pub mod contract;
pub mod curve;
pub mod diagnostic;
mod drawing;
pub mod elementary;
pub mod enclose;
pub mod evaluator;
pub mod explore;
pub mod expr;
pub mod field;
mod fill;
mod focus;
pub mod formula;
mod formula_kernel;
mod glyphs;
mod graphs;
pub mod kernel;
mod lower;
pub mod mix;
pub mod nearest;
mod operands;
mod operation;
pub mod outline;
mod point_tree;
pub mod program;
mod prune;
mod range;
pub mod ray;
mod remember;
pub mod scalar;
mod second;
pub mod shape;
pub mod shapes;
pub mod simd;
mod slope;
mod spine;
pub mod structure;
pub mod surface;
mod tapers;
mod triangles;
pub mod vector;

pub use analysis::{Analysis, MAX_DEPTH, analyse, analyse_body, analyse_together, copies, extent};
pub use cells::{Cell, Cells, Occupancy, Slope, Splitter, Surveyed, Wanted};
pub use contract::{Aabb, Contract, Dimension, Extent, Metric};
pub use diagnostic::{Diagnostic, Severity};
pub use enclose::{Encloser, ModelLanes, StretchLanes, ZeroLanes};
pub use evaluator::{Evaluator, Points, Shares};
pub use explore::{Limits, explore, find_extent, find_radius, find_support};
pub use field::{Axis, Field, Form, MaterialId, Node, Origin, Triple, Value};
pub use formula::Formula;
pub use nearest::{Nearest, NearestHit};
pub use operation::Region;
pub use outline::{Action, Outline};
pub use program::{Part, Program};
pub use scalar::{Constants, Dual, Interval, Scalar};
pub use shape::{Arity, FileParam, Kind, Param, ParamKind, Shape};
pub use structure::Structure;
pub use vector::{Vec3, vec3};

/// What the files under `shapes/` need.
mod shape_prelude {
    pub(crate) use crate::contract::{Contract, Dimension, Metric};
    pub(crate) use crate::field::{Field, Form, Triple, Value};
    pub(crate) use crate::kernel::{PrimitiveKernel, primitive_models};
    pub(crate) use crate::scalar::{Constants, Interval, Scalar};
    pub(crate) use crate::shape::{
        AXIS, About, Combine, Copies, ExactForm, FileParam, Hull, Map, MapTable, Modify, Param, ParamKind, Place,
        PlaceCall, Primitive, PrimitiveTable, Product, RangeCall, Settled, Shape, Special, Supports, in_plane,
    };
    pub(crate) use crate::vector::{Vec3, vec3};
    pub(crate) use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
}
