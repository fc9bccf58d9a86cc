//! From trees to programs.
//!
//! [`Structure::compile`] flattens the union of some fields into a list of coarse operations on two banks of registers,
//! one for points and one for values. Chains of affine maps are joined into one; a mere translation costs nothing, since
//! every primitive subtracts one anyway; a primitive under a union is folded into the running minimum in one kernel.
//!
//! A structure holds no numbers, only where they come from: each operation's constants are described by a `Derive`,
//! which binding evaluates in `f64`. Changing a number never changes the structure, with two exceptions: the number of
//! entries in a list, and the axis an axial shape stands along.

use crate::analysis::{analyse, axis_map};
use crate::diagnostic::{Diagnostic, Severity};
use crate::field::{Field, MaterialId, Node};
use crate::kernel::{AFFINE_CONSTANTS, Fold};
use crate::program::{BindError, Program};
use crate::shape::{CombineTable, Kind, ModifyTable, PlaceTable, PrimitiveTable};
use crate::shapes;
use glam::{DMat3, DVec3};
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;
use std::sync::Arc;

/// The axis that formulas of axial shapes are written for: a shape along it needs no map.
const FORMULA_AXIS: usize = 2;

/// One operation. Registers are numbered from 0; point register 0 holds the point itself.
#[derive(Clone, Debug)]
pub(crate) enum Op {
    /// `points[to] = M points[from] + t`.
    Affine {
        from: usize,
        to: usize,
        constants: Range<usize>,
    },
    /// `values[out] = fold(values[out], primitive(points[point] - at))`.
    Primitive {
        table: &'static PrimitiveTable,
        point: usize,
        at: Range<usize>,
        constants: Range<usize>,
        fold: Fold,
        out: usize,
        region: usize,
    },
    /// `values[out] = combine(values[a], values[b])`, with `out == a` except in programs for shares.
    Combine {
        table: &'static CombineTable,
        a: usize,
        b: usize,
        out: usize,
        constants: Range<usize>,
    },
    /// `values[value] = modify(values[value])`.
    Modify {
        table: &'static ModifyTable,
        value: usize,
        constants: Range<usize>,
    },
    /// `values[value] *= factor`.
    Scale { value: usize, factor: usize },
}

/// How a run of constants follows from the numbers of the tree.
#[derive(Clone, Debug)]
pub(crate) enum Derive {
    /// A node's own `prepare`.
    Prepare {
        prepare: fn(&[f64]) -> Vec<f64>,
        args: Range<usize>,
        out: Range<usize>,
    },
    /// The inverse of a chain of affine maps, to be applied to points of a register.
    Affine {
        chain: Vec<Link>,
        from_root: bool,
        out: Range<usize>,
    },
    /// The same for a chain of translations: what to subtract.
    Offset {
        chain: Vec<Link>,
        from_root: bool,
        out: Range<usize>,
    },
    /// A placing node's factor.
    Factor {
        table: &'static PlaceTable,
        args: Range<usize>,
        out: usize,
    },
}

/// One affine map of a chain, outermost first.
#[derive(Clone, Debug)]
pub(crate) enum Link {
    /// A placing node.
    Place {
        table: &'static PlaceTable,
        args: Range<usize>,
    },
    /// An axial shape's own axis, which is the last of its arguments.
    Axis { arg: usize },
}

/// A part of the surface that shades as one: an object, or what is painted within it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Region {
    /// The index of the object among those compiled.
    pub object: usize,
    /// The innermost material painted, if any.
    pub material: Option<MaterialId>,
}

/// A compiled union of fields, without its numbers.
#[derive(Clone, Debug)]
pub struct Structure {
    code: Arc<Code>,
    objects: Vec<Field>,
    values: Vec<f64>,
    lipschitz: Option<f64>,
    warnings: Vec<Diagnostic>,
}

/// The operations of a structure.
#[derive(Debug)]
pub(crate) struct Code {
    pub(crate) ops: Vec<Op>,
    /// The operations that keep every intermediate value, for shares.
    pub(crate) share_ops: Vec<Op>,
    pub(crate) derive: Vec<Derive>,
    pub(crate) constants: usize,
    pub(crate) registers: Registers,
    pub(crate) share_registers: Registers,
    pub(crate) regions: Vec<Region>,
    /// The slots whose numbers shaped the code.
    fixed: BTreeSet<usize>,
}

/// How many registers of each kind a program needs, and where the result ends up.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Registers {
    pub(crate) points: usize,
    pub(crate) values: usize,
    pub(crate) result: usize,
}

impl Structure {
    /// Compiles the union of `objects`.
    ///
    /// # Errors
    /// All errors of the fields, and their warnings. A program of no objects is no error; its value is infinite.
    pub fn compile(objects: &[Field]) -> Result<Self, Vec<Diagnostic>> {
        let (lipschitz, warnings) = lipschitz_of_union(objects)?;
        let mut compiler = Compiler::default();
        let trees: Vec<Slotted<'_>> = objects.iter().map(|object| compiler.slots(object)).collect();
        let (ops, registers) = compiler.emit_objects(&trees, true);
        let (share_ops, share_registers) = compiler.emit_objects(&trees, false);
        let code = Code {
            ops,
            share_ops,
            derive: compiler.derive,
            constants: compiler.constants,
            registers,
            share_registers,
            regions: compiler.regions,
            fixed: compiler.fixed,
        };
        let values = compiler.values;
        Ok(Self {
            code: Arc::new(code),
            objects: objects.to_vec(),
            values,
            lipschitz,
            warnings,
        })
    }

    /// The parts of the surface that shares are told apart for.
    pub fn regions(&self) -> &[Region] {
        &self.code.regions
    }

    /// The numbers of the fields, one slot for each, in the order of a walk through the trees.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// What [`analyse`] warned of.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// How many operations one evaluation takes.
    pub fn operations(&self) -> usize {
        self.code.ops.len()
    }

    /// A program with these numbers in the slots. Its batches take points relative to `origin`, so that single precision
    /// is spent on what lies near there.
    ///
    /// # Errors
    /// If there are not as many numbers as slots, if they are no sound arguments, or if they need other operations.
    pub fn bind(&self, values: &[f64], origin: DVec3) -> Result<Program, BindError> {
        if values.len() != self.values.len() {
            return Err(BindError::Count {
                given: values.len(),
                wanted: self.values.len(),
            });
        }
        if self.code.fixed.iter().any(|&slot| values[slot] != self.values[slot]) {
            return Err(BindError::Structure);
        }
        let mut lipschitz = self.lipschitz;
        if values != self.values {
            let mut rest = values;
            let objects: Vec<Field> = self
                .objects
                .iter()
                .map(|object| object.with_numbers(&mut rest))
                .collect();
            lipschitz = lipschitz_of_union(&objects).map_err(BindError::Faults)?.0;
        }
        Program::bind(&self.code, values, origin, lipschitz)
    }

    /// The program with the numbers that the fields were written with.
    pub fn program(&self, origin: DVec3) -> Program {
        self.bind(&self.values, origin)
            .expect("the structure was made for these numbers")
    }
}

/// The Lipschitz constant of the union of `objects`, and the warnings about them; or all diagnostics if one is an error.
fn lipschitz_of_union(objects: &[Field]) -> Result<(Option<f64>, Vec<Diagnostic>), Vec<Diagnostic>> {
    let mut diagnostics = Vec::new();
    let mut lipschitz = Some(0.0_f64);
    for object in objects {
        let (analysis, found) = analyse(object);
        diagnostics.extend(found);
        lipschitz = lipschitz
            .zip(analysis.and_then(|a| a.contract.lipschitz))
            .map(|(all, own)| all.max(own));
    }
    if diagnostics.iter().any(|d| d.severity == Severity::Error) {
        return Err(diagnostics);
    }
    Ok((lipschitz, diagnostics))
}

/// A tree whose numbers have got their slots.
struct Slotted<'f> {
    node: &'f Node,
    args: Range<usize>,
    children: Vec<Slotted<'f>>,
}

#[derive(Default)]
struct Compiler {
    values: Vec<f64>,
    derive: Vec<Derive>,
    constants: usize,
    regions: Vec<Region>,
    region_index: HashMap<Region, usize>,
    fixed: BTreeSet<usize>,
    /// Where the constants of each `Derive` in `derive` that was requested before lie, by what it was requested for.
    known: HashMap<Wanted, Range<usize>>,
}

/// Identifies a run of constants, so that both lists of operations share them.
#[derive(PartialEq, Eq, Hash)]
enum Wanted {
    Prepare(usize),
    Offset(Vec<usize>, bool),
    Affine(Vec<usize>, bool),
    Factor(usize),
}

/// The space a node is evaluated in: a register, and the maps that still lie between it and the node.
#[derive(Clone)]
struct Space {
    point: usize,
    chain: Vec<Link>,
}

/// The state of one emission.
struct Emission {
    ops: Vec<Op>,
    /// Whether primitives fold into minima and registers are used again.
    fuse: bool,
    registers: Registers,
    free_points: Vec<usize>,
    free_values: Vec<usize>,
    object: usize,
}

impl Compiler {
    fn slots<'f>(&mut self, field: &'f Field) -> Slotted<'f> {
        let node = field.node();
        let start = self.values.len();
        self.values.extend(node.numbers());
        let args = start..self.values.len();
        Slotted {
            node,
            args,
            children: node.children.iter().map(|child| self.slots(child)).collect(),
        }
    }

    fn emit_objects(&mut self, objects: &[Slotted<'_>], fuse: bool) -> (Vec<Op>, Registers) {
        let registers = Registers {
            points: 1,
            values: 0,
            result: 0,
        };
        let mut emission = Emission {
            ops: Vec::new(),
            fuse,
            registers,
            free_points: Vec::new(),
            free_values: Vec::new(),
            object: 0,
        };
        let root = Space {
            point: 0,
            chain: Vec::new(),
        };
        let Kind::Combine(union) = &shapes::UNION.kind else {
            unreachable!("union combines")
        };
        let mut result = None;
        for (index, object) in objects.iter().enumerate() {
            emission.object = index;
            result = Some(match result {
                None => self.emit_into(&mut emission, object, &root, None, None, Fold::Set),
                Some(before) => self.emit_folded(&mut emission, object, &root, None, before, (union, 0..0)),
            });
        }
        emission.registers.result = result.unwrap_or(0);
        emission.registers.values = emission.registers.values.max(1);
        (emission.ops, emission.registers)
    }

    /// Emits `tree` and combines it with the value in register `before`. Returns the register of the result.
    fn emit_folded(
        &mut self,
        emission: &mut Emission,
        tree: &Slotted<'_>,
        space: &Space,
        material: Option<MaterialId>,
        before: usize,
        (table, constants): (&'static CombineTable, Range<usize>),
    ) -> usize {
        if emission.fuse && table.is_minimum && can_fold(tree.node) {
            return self.emit_into(emission, tree, space, material, Some(before), Fold::Min);
        }
        let b = self.emit_into(emission, tree, space, material, None, Fold::Set);
        let out = if emission.fuse {
            before
        } else {
            emission.value_register()
        };
        emission.ops.push(Op::Combine {
            table,
            a: before,
            b,
            out,
            constants,
        });
        if emission.fuse {
            emission.free_values.push(b);
        }
        out
    }

    /// Emits `tree` into register `out` (a new one if `None`) and returns that register.
    fn emit_into(
        &mut self,
        emission: &mut Emission,
        tree: &Slotted<'_>,
        space: &Space,
        material: Option<MaterialId>,
        out: Option<usize>,
        fold: Fold,
    ) -> usize {
        let node = tree.node;
        match &node.shape.kind {
            Kind::Primitive(table) => {
                let outer = space;
                let mut space = space.clone();
                if let Some(axis) = node.axis() {
                    let arg = tree.args.end - 1;
                    self.fixed.insert(arg);
                    if axis != FORMULA_AXIS {
                        space.chain.push(Link::Axis { arg });
                    }
                }
                if !space.chain.iter().all(Link::is_translation) {
                    space = self.materialise(emission, &space);
                }
                let at = self.offset(&space);
                let constants = self.prepared(table.prepare, &tree.args);
                let out = out.unwrap_or_else(|| emission.value_register());
                let region = self.region(Region {
                    object: emission.object,
                    material,
                });
                emission.ops.push(Op::Primitive {
                    table,
                    point: space.point,
                    at,
                    constants,
                    fold,
                    out,
                    region,
                });
                emission.release(&space, outer);
                out
            }
            Kind::Combine(table) => {
                // Several children would each repeat the map.
                let outer = space;
                let space = if space.chain.iter().all(Link::is_translation) || tree.children.len() == 1 {
                    space.clone()
                } else {
                    self.materialise(emission, space)
                };
                let constants = self.prepared(table.prepare, &tree.args);
                let mut children = tree.children.iter();
                let Some(first) = children.next() else {
                    unreachable!("analysis refuses empty combinations")
                };
                let mut result = self.emit_into(emission, first, &space, material, out, fold);
                for child in children {
                    result = self.emit_folded(emission, child, &space, material, result, (table, constants.clone()));
                }
                emission.release(&space, outer);
                result
            }
            Kind::Place(table) => {
                let mut space = space.clone();
                space.chain.push(Link::Place {
                    table,
                    args: tree.args.clone(),
                });
                let result = self.emit_into(emission, &tree.children[0], &space, material, out, fold);
                if !is_rigid(node) {
                    let factor = self.factor(table, &tree.args);
                    emission.ops.push(Op::Scale { value: result, factor });
                }
                result
            }
            Kind::Modify(table) => {
                let result = self.emit_into(emission, &tree.children[0], space, material, out, fold);
                let constants = self.prepared(table.prepare, &tree.args);
                emission.ops.push(Op::Modify {
                    table,
                    value: result,
                    constants,
                });
                result
            }
            Kind::Paint => {
                let material = node.material.or(material);
                self.emit_into(emission, &tree.children[0], space, material, out, fold)
            }
        }
    }

    /// Applies the pending maps of `space` to its points.
    fn materialise(&mut self, emission: &mut Emission, space: &Space) -> Space {
        let from_root = space.point == 0;
        let wanted = Wanted::Affine(space.chain.iter().map(Link::slot).collect(), from_root);
        let chain = space.chain.clone();
        let constants = self.derived(wanted, AFFINE_CONSTANTS, |out| Derive::Affine { chain, from_root, out });
        let to = emission.free_points.pop().unwrap_or_else(|| {
            emission.registers.points += 1;
            emission.registers.points - 1
        });
        emission.ops.push(Op::Affine {
            from: space.point,
            to,
            constants,
        });
        Space {
            point: to,
            chain: Vec::new(),
        }
    }

    fn offset(&mut self, space: &Space) -> Range<usize> {
        let from_root = space.point == 0;
        let chain = space.chain.clone();
        let wanted = Wanted::Offset(chain.iter().map(Link::slot).collect(), from_root);
        self.derived(wanted, 3, |out| Derive::Offset { chain, from_root, out })
    }

    fn prepared(&mut self, prepare: fn(&[f64]) -> Vec<f64>, args: &Range<usize>) -> Range<usize> {
        let count = prepare(&self.values[args.clone()]).len();
        if count == 0 {
            return 0..0;
        }
        let args = args.clone();
        self.derived(Wanted::Prepare(args.start), count, |out| Derive::Prepare {
            prepare,
            args,
            out,
        })
    }

    fn factor(&mut self, table: &'static PlaceTable, args: &Range<usize>) -> usize {
        let args = args.clone();
        let wanted = Wanted::Factor(args.start);
        self.derived(wanted, 1, |out| Derive::Factor {
            table,
            args,
            out: out.start,
        })
        .start
    }

    fn derived(&mut self, wanted: Wanted, count: usize, make: impl FnOnce(Range<usize>) -> Derive) -> Range<usize> {
        if let Some(known) = self.known.get(&wanted) {
            return known.clone();
        }
        let out = self.constants..self.constants + count;
        self.constants = out.end;
        self.derive.push(make(out.clone()));
        self.known.insert(wanted, out.clone());
        out
    }

    fn region(&mut self, region: Region) -> usize {
        *self.region_index.entry(region).or_insert_with(|| {
            self.regions.push(region);
            self.regions.len() - 1
        })
    }
}

impl Emission {
    fn value_register(&mut self) -> usize {
        self.free_values.pop().unwrap_or_else(|| {
            self.registers.values += 1;
            self.registers.values - 1
        })
    }

    /// Gives back the register of a space that was made for a node which is done.
    fn release(&mut self, space: &Space, outer: &Space) {
        if space.point != outer.point {
            self.free_points.push(space.point);
        }
    }
}

impl Link {
    fn is_translation(&self) -> bool {
        matches!(self, Self::Place { table, .. } if table.is_translation)
    }

    /// The slot of its first number, which tells links apart.
    fn slot(&self) -> usize {
        match self {
            Self::Place { args, .. } => args.start,
            Self::Axis { arg } => *arg,
        }
    }

    /// The map of this link.
    pub(crate) fn map(&self, values: &[f64]) -> glam::DAffine3 {
        match self {
            Self::Place { table, args, .. } => (table.map)(&values[args.clone()]),
            Self::Axis { arg } => glam::DAffine3::from_mat3(axis_map(values[*arg] as usize)),
        }
    }
}

/// Whether a node's value goes unchanged into the minimum with what is there before.
fn can_fold(node: &Node) -> bool {
    match &node.shape.kind {
        Kind::Primitive(_) => true,
        Kind::Combine(table) => table.is_minimum && node.children.iter().all(|child| can_fold(child.node())),
        Kind::Place(_) => is_rigid(node) && can_fold(node.children[0].node()),
        Kind::Modify(_) => false,
        Kind::Paint => can_fold(node.children[0].node()),
    }
}

/// Whether a placing node never changes distances, whatever its numbers.
fn is_rigid(node: &Node) -> bool {
    matches!(&node.shape.kind, Kind::Place(table) if table.is_rigid)
}

/// The translation and linear part of the inverse of a chain of maps.
pub(crate) fn inverse_of(chain: &[Link], values: &[f64]) -> (DMat3, DVec3) {
    let map = chain
        .iter()
        .fold(glam::DAffine3::IDENTITY, |map, link| map * link.map(values));
    let inverse = map.inverse();
    (inverse.matrix3, inverse.translation)
}
