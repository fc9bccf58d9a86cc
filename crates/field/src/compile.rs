//! From trees to operations on two banks of registers, one for points and one for values.
//!
//! Chains of affine maps are joined into one; a mere translation costs nothing, since every primitive subtracts one anyway;
//! a primitive under a union is folded into the running minimum in one kernel. Each operation's constants are described
//! by a [`Derive`], which binding evaluates in `f64`.

use crate::field::{Field, MaterialId, Node};
use crate::kernel::AFFINE_CONSTANTS;
use crate::operation::{Code, Derive, Link, Op, Region, Registers};
use crate::shape::{CombineTable, Kind, PlaceTable};
use crate::shapes;
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

/// The axis that formulas of axial shapes are written for: a shape along it needs no map.
const FORMULA_AXIS: usize = 2;

/// The operations for the union of `objects`, which are sound, and the numbers of the trees in the order of their slots.
pub(crate) fn compile(objects: &[Field]) -> (Code, Vec<f64>) {
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
    (code, compiler.values)
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
        Slotted { node, args, children: node.children.iter().map(|child| self.slots(child)).collect() }
    }

    fn emit_objects(&mut self, objects: &[Slotted<'_>], fuse: bool) -> (Vec<Op>, Registers) {
        let registers = Registers { points: 1, values: 0, result: 0 };
        let mut emission =
            Emission { ops: Vec::new(), fuse, registers, free_points: Vec::new(), free_values: Vec::new(), object: 0 };
        let root = Space { point: 0, chain: Vec::new() };
        let Kind::Combine(union) = &shapes::UNION.kind else { unreachable!("union combines") };
        let mut result = None;
        for (index, object) in objects.iter().enumerate() {
            emission.object = index;
            result = Some(match result {
                None => self.emit(&mut emission, object, &root, None, None),
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
            return self.emit(emission, tree, space, material, Some(before));
        }
        let b = self.emit(emission, tree, space, material, None);
        let out = emission.value_register();
        emission.ops.push(Op::Combine { table, a: before, b, out, constants });
        emission.release_value(before);
        emission.release_value(b);
        out
    }

    /// Emits `tree`, or its minimum with the value in register `before`. Returns the register of the result.
    fn emit(
        &mut self,
        emission: &mut Emission,
        tree: &Slotted<'_>,
        space: &Space,
        material: Option<MaterialId>,
        before: Option<usize>,
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
                let out = emission.value_register();
                let region = self.region(Region { object: emission.object, material });
                emission.ops.push(Op::Primitive { table, point: space.point, at, constants, before, out, region });
                if let Some(before) = before {
                    emission.release_value(before);
                }
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
                let Some(first) = children.next() else { unreachable!("analysis refuses empty combinations") };
                let mut result = self.emit(emission, first, &space, material, before);
                for child in children {
                    result = self.emit_folded(emission, child, &space, material, result, (table, constants.clone()));
                }
                emission.release(&space, outer);
                result
            }
            Kind::Place(table) => {
                let mut space = space.clone();
                space.chain.push(Link::Place { table, args: tree.args.clone() });
                let from = self.emit(emission, &tree.children[0], &space, material, before);
                if is_rigid(node) {
                    return from;
                }
                let (factor, out) = (self.factor(table, &tree.args), emission.value_register());
                emission.ops.push(Op::Scale { from, out, factor });
                emission.release_value(from);
                out
            }
            Kind::Modify(table) => {
                let from = self.emit(emission, &tree.children[0], space, material, before);
                let (constants, out) = (self.prepared(table.prepare, &tree.args), emission.value_register());
                emission.ops.push(Op::Modify { table, from, out, constants });
                emission.release_value(from);
                out
            }
            Kind::Paint => {
                let material = node.material.or(material);
                self.emit(emission, &tree.children[0], space, material, before)
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
        emission.ops.push(Op::Affine { from: space.point, to, constants });
        Space { point: to, chain: Vec::new() }
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
        self.derived(Wanted::Prepare(args.start), count, |out| Derive::Prepare { prepare, args, out })
    }

    fn factor(&mut self, table: &'static PlaceTable, args: &Range<usize>) -> usize {
        let args = args.clone();
        let wanted = Wanted::Factor(args.start);
        self.derived(wanted, 1, |out| Derive::Factor { table, args, out: out.start }).start
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

    /// Gives back a register whose value has been used; where all values are kept, it stays taken.
    fn release_value(&mut self, register: usize) {
        if self.fuse {
            self.free_values.push(register);
        }
    }

    /// Gives back the register of a space that was made for a node which is done.
    fn release(&mut self, space: &Space, outer: &Space) {
        if space.point != outer.point {
            self.free_points.push(space.point);
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
