//! Descriptors: everything the system knows about a function that makes or changes a field.
//!
//! A [`Shape`] is static data plus the kernels instantiated from one generic formula. The scene reader, the schema, the
//! documentation, the evaluator and the shader text all read descriptors; none of them keeps a list of its own. A new
//! function is one file under `shapes/` that implements one of the eight traits here:
//!
//! - [`Primitive`]: a point and parameters to a distance;
//! - [`Special`]: a primitive that is another one with certain arguments, by whose kernels it is computed;
//! - [`Combine`]: distances of several children to one, folded from left to right;
//! - [`Place`]: an affine map of space;
//! - [`Map`]: any other map of space, or from space to the plane of a figure and back;
//! - [`Product`]: a body of a figure and a range;
//! - [`Copies`]: a union of copies in several places;
//! - [`Modify`]: one distance to another.

mod param;
mod table;
mod traits;

use crate::field::Value;

pub use param::{AXIS, About, FileParam, Param, ParamKind, SHORTEST_DIRECTION};
pub(crate) use param::{of_rows, smallest_stretch};
pub(crate) use table::range_constants;
pub use table::{CombineTable, CopiesTable, MapTable, ModifyTable, PlaceTable, PrimitiveTable, ProductTable};
pub(crate) use traits::in_plane;
pub use traits::{
    Combine, Copies, ExactForm, Hull, Map, Modify, Place, PlaceCall, Primitive, Product, RangeCall, Settled, Special,
    Supports,
};

/// A function that makes or changes a field.
#[derive(Debug)]
pub struct Shape {
    /// Description and parameters.
    pub about: About,
    /// What it does.
    pub kind: Kind,
    /// A file that it can be made with.
    pub file: Option<FileParam>,
}

/// The kinds of functions.
#[derive(Debug)]
pub enum Kind {
    /// See [`Primitive`].
    Primitive(PrimitiveTable),
    /// See [`Combine`].
    Combine(CombineTable),
    /// See [`Place`].
    Place(PlaceTable),
    /// See [`Map`].
    Map(MapTable),
    /// See [`Modify`].
    Modify(ModifyTable),
    /// See [`Copies`].
    Copies(CopiesTable),
    /// See [`Product`].
    Product(ProductTable),
    /// Makes a body whose cross-section goes from one figure to the next.
    Loft,
    /// Makes a body of one figure that moves along the outline of another.
    PerimeterSweep,
    /// Repeats its child without end.
    Endless {
        /// Where each copy is looked up.
        fold: MapTable,
        /// The distance from the boxes that copies lie in.
        boxes: PrimitiveTable,
    },
    /// Gives its child a material.
    Paint,
    /// Computes a formula.
    Formula,
    /// Looks its child up at other points, by three formulas.
    Warp,
    /// Adds a formula to its child's value.
    Displace,
    /// Turns its child about an axis, the more the farther along it.
    Twist,
}

/// A formula in x, y and z among what a function takes.
#[derive(Clone, Copy, Debug)]
pub struct FormulaParam {
    /// Its key in scene files.
    pub name: &'static str,
    /// Its text if the user writes none; `None` if it is required.
    pub default: Option<&'static str>,
    /// What it means.
    pub about: &'static str,
}

impl Shape {
    /// The descriptor of a primitive.
    pub const fn primitive<P: Primitive>() -> Self {
        Self { about: P::ABOUT, kind: Kind::Primitive(PrimitiveTable::of::<P>()), file: None }
    }

    /// The descriptor of a special case of a primitive.
    pub const fn special<S: Special>() -> Self {
        Self { about: S::ABOUT, kind: Kind::Primitive(PrimitiveTable::of_special::<S>()), file: None }
    }

    /// The descriptor of a way to combine fields.
    pub const fn combine<C: Combine>() -> Self {
        Self { about: C::ABOUT, kind: Kind::Combine(CombineTable::of::<C>()), file: None }
    }

    /// The descriptor of a way to make bodies of figures.
    pub const fn product<P: Product>() -> Self {
        Self { about: <P as Combine>::ABOUT, kind: Kind::Product(ProductTable::of::<P>()), file: None }
    }

    /// The descriptor of an affine map.
    pub const fn place<P: Place>() -> Self {
        Self { about: P::ABOUT, kind: Kind::Place(PlaceTable::of::<P>()), file: None }
    }

    /// The descriptor of a map.
    pub const fn map<M: Map>() -> Self {
        Self { about: M::ABOUT, kind: Kind::Map(MapTable::of::<M>()), file: None }
    }

    /// The descriptor of a union of copies.
    pub const fn copies<C: Copies>() -> Self {
        Self { about: C::ABOUT, kind: Kind::Copies(CopiesTable::of::<C>()), file: None }
    }

    /// The descriptor of a change of the distance.
    pub const fn modify<M: Modify>() -> Self {
        Self { about: M::ABOUT, kind: Kind::Modify(ModifyTable::of::<M>()), file: None }
    }

    /// The same, with a file that it can be made with.
    #[must_use]
    pub const fn with_file(self, file: FileParam) -> Self {
        Self { about: self.about, kind: self.kind, file: Some(file) }
    }

    /// The functions by which it gets a value from a point, if it does.
    pub fn distance(&self) -> Option<&PrimitiveTable> {
        match &self.kind {
            Kind::Primitive(table) | Kind::Endless { boxes: table, .. } => Some(table),
            _ => None,
        }
    }

    /// The functions by which it looks its child up at other points, if it does.
    pub fn mapping(&self) -> Option<&MapTable> {
        match &self.kind {
            Kind::Map(table) | Kind::Endless { fold: table, .. } => Some(table),
            Kind::Product(table) => table.frame.as_ref(),
            _ => None,
        }
    }

    /// The functions by which it combines two values, if it does.
    pub fn combination(&self) -> Option<&CombineTable> {
        match &self.kind {
            Kind::Combine(table) => Some(table),
            Kind::Product(table) => Some(&table.combine),
            _ => None,
        }
    }

    /// How many children it takes: none, exactly one, or any number above 0.
    pub fn arity(&self) -> Arity {
        match self.kind {
            Kind::Primitive(_) | Kind::Formula => Arity::None,
            Kind::Combine(_) | Kind::Loft | Kind::PerimeterSweep => Arity::Many,
            Kind::Place(_)
            | Kind::Map(_)
            | Kind::Modify(_)
            | Kind::Product(_)
            | Kind::Copies(_)
            | Kind::Endless { .. }
            | Kind::Paint
            | Kind::Warp
            | Kind::Displace
            | Kind::Twist => Arity::One,
        }
    }

    /// The formulas that it takes, in order.
    pub fn formulas(&self) -> &'static [FormulaParam] {
        const fn coordinate(name: &'static str, about: &'static str) -> FormulaParam {
            FormulaParam { name, default: Some(name), about }
        }
        match self.kind {
            Kind::Formula => &[FormulaParam {
                name: "f",
                default: None,
                about: "The formula in x, y and z that is 0 on the surface.",
            }],
            Kind::Warp => {
                const {
                    &[
                        coordinate("x", "A formula: the x at which the shape is looked up."),
                        coordinate("y", "A formula: the y at which the shape is looked up."),
                        coordinate("z", "A formula: the z at which the shape is looked up."),
                    ]
                }
            }
            Kind::Displace => &[FormulaParam {
                name: "by",
                default: None,
                about: "The formula in x, y and z that is added; where it is negative, the surface moves outward.",
            }],
            _ => &[],
        }
    }

    /// Whether it stands along an axis the user chooses (its last parameter is then [`AXIS`]).
    pub fn is_axial(&self) -> bool {
        self.about.params.last().is_some_and(|p| p.name == AXIS.name)
    }

    /// Where the numbers of parameter `index` lie among all arguments of a node.
    ///
    /// # Panics
    /// If there is no such parameter.
    pub fn range(&self, index: usize, args: &[Value]) -> std::ops::Range<usize> {
        let end = |start: usize, param: &Param| {
            start.saturating_add(param.kind.length(args.get(start..).unwrap_or_default()))
        };
        let start = self.about.params[..index].iter().fold(0, end);
        start..end(start, &self.about.params[index])
    }
}

/// How many children a function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arity {
    /// None.
    None,
    /// Exactly one.
    One,
    /// One or more.
    Many,
}
