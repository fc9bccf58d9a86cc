//! Fields as values: trees of shapes with their arguments.
//!
//! A [`Field`] is cheap to clone and never fails to be built; mistakes are found by [`crate::analyse`], which reports
//! all of them with the place they come from. Equal subtrees stay separate: changing one never changes the other.

use crate::formula::{Formula, FormulaError};
use crate::shape::{ParamKind, Shape};
use crate::shapes;
use std::marker::PhantomData;
use std::ops::{Add, BitAnd, BitOr, Neg, Not, Sub};
use std::panic::Location;
use std::sync::Arc;

/// A number in a field.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Value {
    /// The number itself.
    Literal(f64),
}

impl Value {
    /// The number.
    pub fn number(self) -> f64 {
        match self {
            Self::Literal(number) => number,
        }
    }
}

macro_rules! value_from {
    ($($number:ty),*) => {$(
        impl From<$number> for Value {
            fn from(number: $number) -> Self {
                Self::Literal(f64::from(number))
            }
        }
    )*};
}

value_from!(f64, f32, i32, u32, u8);

/// Three numbers, where a point, displacement or direction is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triple(pub [Value; 3]);

impl<V: Into<Value>> From<[V; 3]> for Triple {
    fn from(numbers: [V; 3]) -> Self {
        Self(numbers.map(Into::into))
    }
}

impl<A: Into<Value>, B: Into<Value>, C: Into<Value>> From<(A, B, C)> for Triple {
    fn from((x, y, z): (A, B, C)) -> Self {
        Self([x.into(), y.into(), z.into()])
    }
}

impl From<glam::DVec3> for Triple {
    fn from(v: glam::DVec3) -> Self {
        v.to_array().into()
    }
}

/// Names a material. What it looks like is no concern of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MaterialId(pub u32);

/// Where a node was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// In Rust code.
    Code(&'static Location<'static>),
    /// In a document, which knows the place by this number.
    Document(u32),
}

/// A shape as a value. See the [module documentation](self).
#[derive(Clone, Debug)]
pub struct Field(Arc<Node>);

/// One function call in a tree.
#[derive(Clone, Debug)]
pub struct Node {
    /// The function.
    pub shape: &'static Shape,
    /// Its arguments, one after another in the order of its parameters.
    pub args: Vec<Value>,
    /// The fields it changes or combines, in the order of evaluation.
    pub children: Vec<Field>,
    /// The material it paints with.
    pub material: Option<MaterialId>,
    /// The formulas of [`Shape::formulas`], or what is wrong with their texts.
    pub formulas: Vec<Result<Formula, FormulaError>>,
    /// Where it was written.
    pub origin: Origin,
    depth: u32,
}

impl Field {
    /// A call of `shape`. The arguments are not checked here; missing ones at the end take their defaults.
    #[track_caller]
    pub fn new(
        shape: &'static Shape,
        args: impl IntoIterator<Item = Value>,
        children: impl IntoIterator<Item = Field>,
    ) -> Self {
        Self::with_origin(shape, args, children, None, Origin::Code(Location::caller()))
    }

    /// As [`Field::new`], with everything said.
    pub fn with_origin(
        shape: &'static Shape,
        args: impl IntoIterator<Item = Value>,
        children: impl IntoIterator<Item = Field>,
        material: Option<MaterialId>,
        origin: Origin,
    ) -> Self {
        let mut args: Vec<Value> = args.into_iter().collect();
        let mut place = 0;
        for param in shape.about.params {
            if place >= args.len() {
                args.extend(param.default.unwrap_or_default().iter().map(|&number| Value::Literal(number)));
            }
            place += param.kind.length(args.get(place..).unwrap_or_default());
        }
        let children: Vec<Field> = children.into_iter().collect();
        let depth = 1 + children.iter().map(|c| c.0.depth).max().unwrap_or(0);
        Self(Arc::new(Node { shape, args, children, material, formulas: Vec::new(), origin, depth }))
    }

    /// The same call, written elsewhere.
    #[must_use]
    pub fn written_at(mut self, origin: Origin) -> Self {
        Arc::make_mut(&mut self.0).origin = origin;
        self
    }

    /// The call with the one formula that it takes.
    #[must_use]
    pub fn with_formula(self, formula: Result<Formula, FormulaError>) -> Self {
        self.with_formulas([formula])
    }

    /// The call with the formulas that it takes, in order.
    #[must_use]
    pub fn with_formulas(mut self, formulas: impl IntoIterator<Item = Result<Formula, FormulaError>>) -> Self {
        Arc::make_mut(&mut self.0).formulas = formulas.into_iter().collect();
        self
    }

    /// The outermost call.
    pub fn node(&self) -> &Node {
        &self.0
    }

    /// How many calls lie on the longest path to a primitive, both ends included.
    pub fn depth(&self) -> u32 {
        self.0.depth
    }

    /// The node with parameter `name` set to `numbers`, as [`ParamKind`] says that they are stored.
    ///
    /// # Panics
    /// If the shape has no such parameter, or another count of numbers, unless these are knots.
    #[must_use]
    pub fn with(mut self, name: &str, numbers: &[Value]) -> Self {
        let node = Arc::make_mut(&mut self.0);
        let index = node.shape.about.params.iter().position(|p| p.name == name);
        let index = index.unwrap_or_else(|| panic!("{} has no parameter {name}", node.shape.about.name));
        let range = node.shape.range(index, &node.args);
        match node.shape.about.params[index].kind {
            ParamKind::Knots => drop(node.args.splice(range, numbers.iter().copied())),
            _ => node.args[range].copy_from_slice(numbers),
        }
        self
    }

    /// The same tree with other numbers, taken from the front of `numbers` in the order of a walk through it.
    ///
    /// # Panics
    /// If there are too few.
    pub(crate) fn with_numbers(&self, numbers: &mut &[f64]) -> Self {
        let node = self.node();
        let (own, rest) = numbers.split_at(node.args.len());
        *numbers = rest;
        let args = own.iter().map(|&number| Value::Literal(number)).collect();
        let children = node.children.iter().map(|child| child.with_numbers(numbers)).collect();
        let mut copy = node.clone();
        (copy.args, copy.children) = (args, children);
        Self(Arc::new(copy))
    }

    /// Combines two fields, joining chains of the same parameterless function into one call.
    #[track_caller]
    fn fold(shape: &'static Shape, a: Field, b: Field) -> Self {
        let origin = Origin::Code(Location::caller());
        let mut a = a;
        let children = match Arc::get_mut(&mut a.0) {
            Some(node) if std::ptr::eq(node.shape, shape) => {
                let mut children = std::mem::take(&mut node.children);
                children.push(b);
                children
            }
            _ => vec![a, b],
        };
        Self::with_origin(shape, [], children, None, origin)
    }
}

/// Two trees are equal if they call the same functions with the same numbers, formulas and materials, wherever they were written.
impl PartialEq for Field {
    fn eq(&self, other: &Self) -> bool {
        let mut pending = vec![(self, other)];
        while let Some((one, other)) = pending.pop() {
            let (a, b) = (one.node(), other.node());
            let is_same = std::ptr::eq(a.shape, b.shape)
                && a.args == b.args
                && a.material == b.material
                && a.formulas == b.formulas
                && a.children.len() == b.children.len();
            if !is_same {
                return false;
            }
            // What is shared need not be looked through.
            let children = a.children.iter().zip(&b.children);
            pending.extend(children.filter(|(one, other)| !Arc::ptr_eq(&one.0, &other.0)));
        }
        true
    }
}

/// Takes a tree down from the top: a chain of any length must not exhaust the stack.
impl Drop for Node {
    fn drop(&mut self) {
        let mut pending = std::mem::take(&mut self.children);
        while let Some(field) = pending.pop() {
            if let Some(mut node) = Arc::into_inner(field.0) {
                pending.append(&mut node.children);
            }
        }
    }
}

impl Node {
    /// The arguments as plain numbers.
    pub fn numbers(&self) -> Vec<f64> {
        self.args.iter().map(|value| value.number()).collect()
    }

    /// The numbers of parameter `index`.
    pub fn argument(&self, index: usize) -> Vec<f64> {
        self.args[self.shape.range(index, &self.args)].iter().map(|value| value.number()).collect()
    }

    /// Formula number `index`, if it is there and sound.
    pub fn formula(&self, index: usize) -> Option<&Formula> {
        self.formulas.get(index)?.as_ref().ok()
    }

    /// The axis it stands along as 0, 1 or 2, if it is a shape that has one.
    pub fn axis(&self) -> Option<usize> {
        let last = self.shape.about.params.len().checked_sub(1)?;
        (self.shape.is_axial()).then(|| self.argument(last)[0] as usize)
    }
}

/// A primitive under construction: a field that still knows which parameters it has.
#[derive(Clone, Debug)]
pub struct Form<P> {
    field: Field,
    kind: PhantomData<P>,
}

impl<P> Form<P> {
    /// A call of the primitive's descriptor; see [`Field::new`].
    #[track_caller]
    pub fn new(shape: &'static Shape, args: impl IntoIterator<Item = Value>) -> Self {
        Self { field: Field::new(shape, args, []), kind: PhantomData }
    }

    /// The same with its field changed.
    pub(crate) fn map(self, change: impl FnOnce(Field) -> Field) -> Self {
        Self { field: change(self.field), ..self }
    }

    /// See [`Field::with`].
    #[must_use]
    pub fn with(self, name: &str, numbers: &[Value]) -> Self {
        Self { field: self.field.with(name, numbers), ..self }
    }

    /// The same with a list of knots as parameter `name`.
    pub(crate) fn with_knots<V: Into<Value>>(self, name: &str, knots: impl IntoIterator<Item = V>) -> Self {
        let knots: Vec<Value> = knots.into_iter().map(Into::into).collect();
        let first = Value::Literal((ParamKind::KNOTS.len() + knots.len()) as f64);
        self.with(name, &[&[first], &knots[..]].concat())
    }
}

impl<P> From<Form<P>> for Field {
    fn from(form: Form<P>) -> Self {
        form.field
    }
}

macro_rules! operators {
    ($($Trait:ident $method:ident $SHAPE:ident),*) => {$(
        impl<R: Into<Field>> $Trait<R> for Field {
            type Output = Field;
            #[track_caller]
            fn $method(self, rhs: R) -> Field {
                Field::fold(&shapes::$SHAPE, self, rhs.into())
            }
        }

        impl<P, R: Into<Field>> $Trait<R> for Form<P> {
            type Output = Field;
            #[track_caller]
            fn $method(self, rhs: R) -> Field {
                Field::fold(&shapes::$SHAPE, self.into(), rhs.into())
            }
        }
    )*};
}

operators!(Add add UNION, BitOr bitor UNION, BitAnd bitand INTERSECTION, Sub sub DIFFERENCE);

macro_rules! complement_operators {
    ($($Trait:ident $method:ident),*) => {$(
        impl $Trait for Field {
            type Output = Field;
            #[track_caller]
            fn $method(self) -> Field {
                Field::new(&shapes::COMPLEMENT, [], [self])
            }
        }

        impl<P> $Trait for Form<P> {
            type Output = Field;
            #[track_caller]
            fn $method(self) -> Field {
                Field::new(&shapes::COMPLEMENT, [], [self.into()])
            }
        }
    )*};
}

complement_operators!(Neg neg, Not not);

/// The axis an axial shape stands along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the axes speak for themselves")]
pub enum Axis {
    X,
    Y,
    Z,
}

impl<P> Form<P> {
    /// Stands an axial shape along another axis than z.
    ///
    /// # Panics
    /// If the shape has no axis.
    #[must_use]
    pub fn along(self, axis: Axis) -> Self {
        self.with("axis", &[Value::Literal(f64::from(axis as u8))])
    }
}
