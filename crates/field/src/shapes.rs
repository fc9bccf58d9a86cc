//! All shapes, one file each.
//!
//! Written by `cargo xtask shapes` from the files in the folder of the same name. To add a shape, write its file and run
//! that command.

pub mod align;
pub mod any_order;
pub mod arc;
pub mod arch;
pub mod b_spline;
pub mod b_spline_patch;
pub mod bend;
pub mod bezier;
pub mod bezier_patch;
mod blend;
pub mod box_frame;
pub mod capped_torus;
pub mod capsule;
mod carve;
pub mod chamfer;
pub mod chamfered_box;
pub mod chamfered_rectangle;
pub mod circle;
pub mod circle_segment;
pub mod clothoid;
pub mod columns;
pub mod complement;
pub mod cone;
pub mod convex_polyhedron;
pub mod convex_polyhedron_bound;
pub mod cross;
pub mod cross_section;
pub mod cuboid;
pub mod curl;
pub mod cut_sphere;
pub mod cylinder;
pub mod difference;
pub mod disc;
pub mod displace;
pub mod dodecahedron;
pub mod egg;
pub mod ellipse;
pub mod ellipsoid;
pub mod ellipsoid_bound;
pub mod elongate;
pub mod engrave;
mod escape;
pub mod exponential;
pub mod extrude;
mod facets;
pub mod formula;
pub mod formula_graph;
pub mod gear;
pub mod graph;
pub mod groove;
pub mod heart;
pub mod horseshoe;
pub mod hyperbola;
pub mod icosahedron;
pub mod intersection;
pub mod lens;
pub mod link;
pub mod loft;
pub mod logarithmic_spiral;
pub mod mandelbulb;
pub mod matrix;
pub mod moon;
pub mod morph;
pub mod nurbs;
pub mod nurbs_patch;
pub mod octahedron;
pub mod offset;
pub mod outline;
pub mod paint;
pub mod parabola;
pub mod parallelogram;
pub mod perimeter_sweep;
pub mod pipe;
pub mod plane;
pub mod point_set;
pub mod polygon;
pub mod polyline;
mod polynomial;
mod product;
pub mod pyramid;
pub mod quad;
pub mod quaternion_julia;
pub mod rectangle;
pub mod reflect;
pub mod regular_polygon;
pub mod repeat;
pub mod repeat_endless;
pub mod repeat_mirrored;
pub mod repeat_polar;
pub mod repeat_varied;
pub mod revolve;
pub mod revolve_part;
pub mod rhombus;
pub mod ring;
pub mod ring_sector;
pub mod root;
pub mod rotate;
pub mod rotate_euler;
pub mod rotate_quaternion;
pub mod round;
pub mod round_cone;
pub mod scale;
pub mod scatter;
pub mod sector;
pub mod shear;
pub mod sheet;
pub mod shell;
pub mod slab;
pub mod smooth_difference;
pub mod smooth_intersection;
pub mod smooth_point_set;
pub mod smooth_union;
pub mod solid_angle;
pub mod sphere;
pub mod spiral;
pub mod spline;
mod spline_sheet;
pub mod staircase;
pub mod stairs;
pub mod star;
pub mod stretch;
pub mod stroke;
pub mod superellipse;
pub mod svg;
pub mod svg_path;
pub mod sweep;
pub mod swirl;
pub mod symmetry;
pub mod taper;
pub mod tapered_b_spline;
pub mod tapered_bezier;
pub mod tapered_spline;
pub mod tapered_tube;
pub mod tetrahedron;
pub mod text;
pub mod tongue;
pub mod torus;
pub mod translate;
pub mod trapezoid;
pub mod triangle;
pub mod truncated_octahedron;
pub mod tube;
pub mod twist;
pub mod under_formula_graph;
pub mod under_graph;
pub mod uneven_capsule;
pub mod union;
pub mod warp;
pub mod wedge;
pub mod xor;

pub use align::*;
pub use any_order::*;
pub use arc::*;
pub use arch::*;
pub use b_spline::*;
pub use b_spline_patch::*;
pub use bend::*;
pub use bezier::*;
pub use bezier_patch::*;
pub use box_frame::*;
pub use capped_torus::*;
pub use capsule::*;
pub use chamfer::*;
pub use chamfered_box::*;
pub use chamfered_rectangle::*;
pub use circle::*;
pub use circle_segment::*;
pub use clothoid::*;
pub use columns::*;
pub use complement::*;
pub use cone::*;
pub use convex_polyhedron::*;
pub use convex_polyhedron_bound::*;
pub use cross::*;
pub use cross_section::*;
pub use cuboid::*;
pub use curl::*;
pub use cut_sphere::*;
pub use cylinder::*;
pub use difference::*;
pub use disc::*;
pub use displace::*;
pub use dodecahedron::*;
pub use egg::*;
pub use ellipse::*;
pub use ellipsoid::*;
pub use ellipsoid_bound::*;
pub use elongate::*;
pub use engrave::*;
pub use exponential::*;
pub use extrude::*;
pub use formula::*;
pub use formula_graph::*;
pub use gear::*;
pub use graph::*;
pub use groove::*;
pub use heart::*;
pub use horseshoe::*;
pub use hyperbola::*;
pub use icosahedron::*;
pub use intersection::*;
pub use lens::*;
pub use link::*;
pub use loft::*;
pub use logarithmic_spiral::*;
pub use mandelbulb::*;
pub use matrix::*;
pub use moon::*;
pub use morph::*;
pub use nurbs::*;
pub use nurbs_patch::*;
pub use octahedron::*;
pub use offset::*;
pub use outline::*;
pub use paint::*;
pub use parabola::*;
pub use parallelogram::*;
pub use perimeter_sweep::*;
pub use pipe::*;
pub use plane::*;
pub use point_set::*;
pub use polygon::*;
pub use polyline::*;
pub use pyramid::*;
pub use quad::*;
pub use quaternion_julia::*;
pub use rectangle::*;
pub use reflect::*;
pub use regular_polygon::*;
pub use repeat::*;
pub use repeat_endless::*;
pub use repeat_mirrored::*;
pub use repeat_polar::*;
pub use repeat_varied::*;
pub use revolve::*;
pub use revolve_part::*;
pub use rhombus::*;
pub use ring::*;
pub use ring_sector::*;
pub use root::*;
pub use rotate::*;
pub use rotate_euler::*;
pub use rotate_quaternion::*;
pub use round::*;
pub use round_cone::*;
pub use scale::*;
pub use scatter::*;
pub use sector::*;
pub use shear::*;
pub use sheet::*;
pub use shell::*;
pub use slab::*;
pub use smooth_difference::*;
pub use smooth_intersection::*;
pub use smooth_point_set::*;
pub use smooth_union::*;
pub use solid_angle::*;
pub use sphere::*;
pub use spiral::*;
pub use spline::*;
pub use staircase::*;
pub use stairs::*;
pub use star::*;
pub use stretch::*;
pub use stroke::*;
pub use superellipse::*;
pub use svg::*;
pub use svg_path::*;
pub use sweep::*;
pub use swirl::*;
pub use symmetry::*;
pub use taper::*;
pub use tapered_b_spline::*;
pub use tapered_bezier::*;
pub use tapered_spline::*;
pub use tapered_tube::*;
pub use tetrahedron::*;
pub use text::*;
pub use tongue::*;
pub use torus::*;
pub use translate::*;
pub use trapezoid::*;
pub use triangle::*;
pub use truncated_octahedron::*;
pub use tube::*;
pub use twist::*;
pub use under_formula_graph::*;
pub use under_graph::*;
pub use uneven_capsule::*;
pub use union::*;
pub use warp::*;
pub use wedge::*;
pub use xor::*;

use crate::shape::Shape;

/// The descriptors of all shapes, by name.
pub static ALL: &[&Shape] = &[
    &ALIGN,
    &POLYNOMIAL_UNION,
    &POLYNOMIAL_INTERSECTION,
    &POLYNOMIAL_DIFFERENCE,
    &ARC,
    &ARCH,
    &B_SPLINE,
    &B_SPLINE_PATCH,
    &BEND,
    &BEZIER,
    &BEZIER_PATCH,
    &BOX_FRAME,
    &CAPPED_TORUS,
    &CAPSULE,
    &CHAMFER_UNION,
    &CHAMFER_INTERSECTION,
    &CHAMFER_DIFFERENCE,
    &CHAMFERED_BOX,
    &CHAMFERED_RECTANGLE,
    &CIRCLE,
    &CIRCLE_SEGMENT,
    &CLOTHOID,
    &COLUMNS_UNION,
    &COLUMNS_INTERSECTION,
    &COLUMNS_DIFFERENCE,
    &COMPLEMENT,
    &CONE,
    &CONVEX_POLYHEDRON,
    &CONVEX_POLYHEDRON_BOUND,
    &CROSS,
    &CROSS_SECTION,
    &BOX,
    &CURL,
    &CUT_SPHERE,
    &CYLINDER,
    &DIFFERENCE,
    &DISC,
    &DISPLACE,
    &DODECAHEDRON,
    &EGG,
    &ELLIPSE,
    &ELLIPSOID,
    &ELLIPSOID_BOUND,
    &ELONGATE,
    &ENGRAVE,
    &EXPONENTIAL_UNION,
    &EXPONENTIAL_INTERSECTION,
    &EXPONENTIAL_DIFFERENCE,
    &EXTRUDE,
    &FORMULA,
    &FORMULA_GRAPH,
    &GEAR,
    &GRAPH,
    &GROOVE,
    &HEART,
    &HORSESHOE,
    &HYPERBOLA,
    &ICOSAHEDRON,
    &INTERSECTION,
    &LENS,
    &LINK,
    &LOFT,
    &LOGARITHMIC_SPIRAL,
    &MANDELBULB,
    &MATRIX,
    &MOON,
    &MORPH,
    &NURBS,
    &NURBS_PATCH,
    &OCTAHEDRON,
    &OFFSET,
    &OUTLINE,
    &PAINT,
    &PARABOLA,
    &PARALLELOGRAM,
    &PERIMETER_SWEEP,
    &PIPE,
    &PLANE,
    &POINT_SET,
    &POLYGON,
    &POLYLINE,
    &PYRAMID,
    &QUAD,
    &QUATERNION_JULIA,
    &RECTANGLE,
    &REFLECT,
    &REGULAR_POLYGON,
    &REPEAT,
    &REPEAT_ENDLESS,
    &REPEAT_MIRRORED,
    &REPEAT_POLAR,
    &REPEAT_VARIED,
    &REVOLVE,
    &REVOLVE_PART,
    &RHOMBUS,
    &RING,
    &RING_SECTOR,
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
    &SCATTER,
    &SECTOR,
    &SHEAR,
    &SHEET,
    &SHELL,
    &SLAB,
    &SMOOTH_DIFFERENCE,
    &SMOOTH_INTERSECTION,
    &SMOOTH_POINT_SET,
    &SMOOTH_UNION,
    &SOLID_ANGLE,
    &SPHERE,
    &SPIRAL,
    &SPLINE,
    &STAIRCASE,
    &STAIRS_UNION,
    &STAIRS_INTERSECTION,
    &STAIRS_DIFFERENCE,
    &STAR,
    &STRETCH,
    &STROKE,
    &SUPERELLIPSE,
    &SVG,
    &SVG_PATH,
    &SWEEP,
    &SWIRL,
    &SYMMETRY,
    &TAPER,
    &TAPERED_B_SPLINE,
    &TAPERED_BEZIER,
    &TAPERED_SPLINE,
    &TAPERED_TUBE,
    &TETRAHEDRON,
    &TEXT,
    &TONGUE,
    &TORUS,
    &TRANSLATE,
    &TRAPEZOID,
    &TRIANGLE,
    &TRUNCATED_OCTAHEDRON,
    &TUBE,
    &TWIST,
    &UNDER_FORMULA_GRAPH,
    &UNDER_GRAPH,
    &UNEVEN_CAPSULE,
    &UNION,
    &WARP,
    &WEDGE,
    &XOR,
];
