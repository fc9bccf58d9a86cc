//! The functions of each trait's items as data.

use super::{
    Combine, Copies, ExactForm, Hull, Kind, Map, Modify, Place, PlaceCall, Primitive, Product, RangeCall, Settled,
    Shape, Special, Supports,
};
use crate::contract::{Contract, Dimension};
use crate::expr::Expr;
use crate::kernel::{CombineKernels, MapKernels, ModifyKernels, PrimitiveKernel, PrimitiveKernels};
use crate::scalar::{Constants, Interval};
use glam::{DAffine3, DVec3};
use std::ops::Range;

/// The functions of a [`Primitive`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct PrimitiveTable {
    pub is_loose: bool,
    pub dimension: Dimension,
    pub check: fn(&[f64]) -> Result<(), String>,
    pub prepare: fn(&[f64]) -> Vec<f64>,
    pub parts: fn(&[f64]) -> Vec<usize>,
    pub contract: fn(&[f64]) -> Contract,
    pub support: fn(&[f64], DVec3, f64) -> f64,
    pub exact_form: fn(&[f64]) -> Option<ExactForm>,
    pub models: Option<PrimitiveKernel>,
    pub kernels: PrimitiveKernels,
}

/// The functions of a [`Combine`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct CombineTable {
    pub is_minimum: bool,
    pub prepare: fn(&[f64]) -> Vec<f64>,
    pub contract: fn(&[f64], Contract, Contract) -> Result<Contract, String>,
    pub settle: fn(Interval, Interval, &[f64]) -> Settled,
    pub hull: Hull,
    pub level: fn(&[f64], f64, usize) -> f64,
    pub kernels: CombineKernels,
    pub share: for<'g> fn(Expr<'g>, Expr<'g>, &Constants<'_, Expr<'g>>) -> Expr<'g>,
}

/// The functions of a [`Place`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct PlaceTable {
    pub is_rigid: bool,
    pub is_translation: bool,
    pub map: fn(&[f64]) -> DAffine3,
    pub factor: fn(&[f64]) -> f64,
    pub is_similarity: fn(&[f64]) -> bool,
}

/// The functions of a [`Map`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct MapTable {
    pub takes: Dimension,
    pub gives: Dimension,
    pub is_short: bool,
    pub is_planar: bool,
    pub prepare: fn(&[f64]) -> Vec<f64>,
    pub contract: fn(&[f64], Contract, Supports<'_>) -> Result<Contract, String>,
    pub support: fn(&[f64], DVec3, Supports<'_>) -> f64,
    pub kernels: MapKernels,
}

/// The functions of a [`Product`].
#[derive(Debug)]
pub struct ProductTable {
    /// See [`Product::FRAME`].
    pub frame: Option<MapTable>,
    /// See [`Product::parts`].
    pub parts: fn(&[f64]) -> usize,
    /// See [`Product::range`].
    pub range: fn(&[f64]) -> RangeCall,
    /// The constants of the range's formula.
    pub range_constants: fn(&[f64]) -> Vec<f64>,
    /// How the figure's distance is combined with that from the range.
    pub combine: CombineTable,
}

impl ProductTable {
    /// The support in the frame, from that of the figure at the same level; see [`Primitive::support`].
    pub fn support(&self, args: &[f64], direction: DVec3, level: f64, figure: Supports<'_>) -> f64 {
        let (across, along) = (direction.with_z(0.0), DVec3::Z * direction.z);
        let (shape, own) = (self.range)(args);
        let range = |along| (range_table(shape).support)(&own, along, level);
        (if across == DVec3::ZERO { 0.0 } else { figure(across) })
            + if along == DVec3::ZERO { 0.0 } else { range(along) }
    }
}

/// The functions of the primitive that a range is a call of.
fn range_table(shape: &'static Shape) -> &'static PrimitiveTable {
    shape.distance().expect("a range is a call of a primitive")
}

/// The constants of a range's formula.
pub(crate) fn range_constants((shape, args): RangeCall) -> Vec<f64> {
    (range_table(shape).prepare)(&args)
}

/// The functions of a [`Copies`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct CopiesTable {
    pub are_moved: bool,
    pub counted: Range<usize>,
    pub count: fn(&[f64]) -> usize,
    pub places: fn(&[f64], usize) -> Vec<PlaceCall>,
}

impl CopiesTable {
    /// The map that places a copy.
    pub fn map(&self, args: &[f64], index: usize) -> DAffine3 {
        let places = (self.places)(args, index);
        places.iter().fold(DAffine3::IDENTITY, |map, (shape, args)| match &shape.kind {
            Kind::Place(table) => map * (table.map)(args),
            _ => unreachable!("copies are placed by affine maps"),
        })
    }
}

/// The functions of a [`Modify`].
#[derive(Debug)]
#[allow(missing_docs, reason = "documented at the trait's items of the same names")]
pub struct ModifyTable {
    pub prepare: fn(&[f64]) -> Vec<f64>,
    pub contract: fn(&[f64], Contract) -> Result<Contract, String>,
    pub warning: fn(&[f64], Contract) -> Option<String>,
    pub level: fn(&[f64], f64) -> Option<f64>,
    pub kernels: ModifyKernels,
}

impl PrimitiveTable {
    /// The functions of one primitive.
    pub const fn of<P: Primitive>() -> Self {
        Self {
            is_loose: P::IS_LOOSE,
            dimension: P::DIMENSION,
            check: P::check,
            prepare: P::prepare,
            parts: P::parts,
            contract: P::contract,
            support: P::support,
            exact_form: P::exact_form,
            models: P::MODELS,
            kernels: PrimitiveKernels::of::<P>(),
        }
    }

    /// Those of the primitive that one is a case of, with its arguments turned into that one's.
    pub const fn of_special<S: Special>() -> Self {
        fn support<S: Special>(args: &[f64], direction: DVec3, level: f64) -> f64 {
            S::General::support(&S::general(args), direction, level)
        }
        Self {
            check: S::check,
            prepare: |args| S::General::prepare(&S::general(args)),
            parts: |args| S::General::parts(&S::general(args)),
            contract: |args| S::General::contract(&S::general(args)),
            support: support::<S>,
            exact_form: |args| S::General::exact_form(&S::general(args)),
            ..Self::of::<S::General>()
        }
    }
}

impl CombineTable {
    /// The functions of one combination.
    pub const fn of<C: Combine>() -> Self {
        fn share<'g, C: Combine>(a: Expr<'g>, b: Expr<'g>, c: &Constants<'_, Expr<'g>>) -> Expr<'g> {
            C::share(a, b, c)
        }
        Self {
            is_minimum: C::IS_MINIMUM,
            prepare: C::prepare,
            contract: C::contract,
            settle: C::settle,
            hull: C::HULL,
            level: C::level,
            kernels: CombineKernels::of::<C>(),
            share: share::<C>,
        }
    }
}

impl PlaceTable {
    /// The functions of one affine map.
    pub const fn of<P: Place>() -> Self {
        Self {
            is_rigid: P::IS_RIGID,
            is_translation: P::IS_TRANSLATION,
            map: P::map,
            factor: P::factor,
            is_similarity: P::is_similarity,
        }
    }
}

impl MapTable {
    /// The functions of one map.
    pub const fn of<M: Map>() -> Self {
        Self {
            takes: M::TAKES,
            gives: M::GIVES,
            is_short: M::IS_SHORT,
            is_planar: M::IS_PLANAR,
            prepare: M::prepare,
            contract: M::contract,
            support: M::support,
            kernels: MapKernels::of::<M>(),
        }
    }
}

impl ProductTable {
    /// The functions of one kind of product.
    pub const fn of<P: Product>() -> Self {
        Self {
            frame: P::FRAME,
            parts: P::parts,
            range: P::range,
            range_constants: |args| range_constants(P::range(args)),
            combine: CombineTable::of::<P>(),
        }
    }
}

impl CopiesTable {
    /// The functions of one kind of copies.
    pub const fn of<C: Copies>() -> Self {
        Self { are_moved: C::ARE_MOVED, counted: C::COUNTED, count: C::count, places: C::places }
    }
}

impl ModifyTable {
    /// The functions of one change of the distance.
    pub const fn of<M: Modify>() -> Self {
        Self {
            prepare: M::prepare,
            contract: M::contract,
            warning: M::warning,
            level: M::level,
            kernels: ModifyKernels::of::<M>(),
        }
    }
}
