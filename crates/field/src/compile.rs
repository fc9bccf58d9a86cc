//! From trees to steps.
//!
//! Chains of affine maps are joined into one; a mere translation costs nothing, since every primitive subtracts one anyway;
//! nested unions become one chain of minima. Each step's constants are described by a [`Derive`], which binding evaluates
//! in `f64`.

use crate::field::{Field, MaterialId, Node};
use crate::formula::{Binary, Formula, Term, Unary};
use crate::kernel::AFFINE_CONSTANTS;
use crate::operation::{Code, Derive, Link, NO_REGION, Region, Run, Step, StepId, Steps};
use crate::shape::{CombineTable, Kind, Shape};
use crate::shapes::{self, formula};
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

/// The axis that formulas of axial shapes are written for: a shape along it needs no map.
const FORMULA_AXIS: usize = 2;

/// The steps for the union of `objects`, which are sound, and the numbers of the trees in the order of their slots.
pub(crate) fn compile(objects: &[Field]) -> (Code, Steps, Vec<f64>) {
    let mut compiler = Compiler::default();
    let trees: Vec<Slotted<'_>> = objects.iter().map(|object| compiler.slots(object)).collect();
    let result = compiler.emit_objects(&trees);
    let code = Code {
        derive: compiler.derive,
        constants: compiler.constants,
        regions: compiler.regions,
        fixed: compiler.fixed,
    };
    (code, Steps { list: compiler.steps, result }, compiler.values)
}

/// Makes the constants of a formula of its parameters.
type Prepare = fn(&[f64]) -> Vec<f64>;

/// A tree whose numbers have got their slots.
struct Slotted<'f> {
    node: &'f Node,
    args: Range<usize>,
    children: Vec<Slotted<'f>>,
}

#[derive(Default)]
struct Compiler {
    values: Vec<f64>,
    steps: Vec<Step>,
    derive: Vec<Derive>,
    constants: usize,
    regions: Vec<Region>,
    region_index: HashMap<Region, u32>,
    fixed: BTreeSet<usize>,
    /// The object that is being compiled.
    object: usize,
}

/// The space a node is evaluated in: a point, and the maps that still lie between it and the node.
#[derive(Clone)]
struct Space {
    point: StepId,
    chain: Vec<Link>,
}

impl Compiler {
    fn slots<'f>(&mut self, field: &'f Field) -> Slotted<'f> {
        let node = field.node();
        let start = self.values.len();
        self.values.extend(node.numbers());
        let args = start..self.values.len();
        Slotted { node, args, children: node.children.iter().map(|child| self.slots(child)).collect() }
    }

    fn push(&mut self, step: Step) -> StepId {
        let id = u32::try_from(self.steps.len()).expect("less than 2^32 steps");
        self.steps.push(step);
        StepId(id)
    }

    fn emit_objects(&mut self, objects: &[Slotted<'_>]) -> Option<StepId> {
        let point = self.push(Step::Point);
        let root = Space { point, chain: Vec::new() };
        let Kind::Combine(union) = &shapes::UNION.kind else { unreachable!("union combines") };
        let mut result = None;
        for (index, object) in objects.iter().enumerate() {
            self.object = index;
            result = Some(match result {
                None => self.emit(object, &root, None, None),
                Some(before) => self.emit_folded(object, &root, None, before, (union, Run::default())),
            });
        }
        result
    }

    /// Emits `tree` and combines it with the value of the step `before`.
    fn emit_folded(
        &mut self,
        tree: &Slotted<'_>,
        space: &Space,
        material: Option<MaterialId>,
        before: StepId,
        (table, constants): (&'static CombineTable, Run),
    ) -> StepId {
        if table.is_minimum && can_fold(tree.node) {
            return self.emit(tree, space, material, Some(before));
        }
        let b = self.emit(tree, space, material, None);
        self.push(Step::Combine { table, a: before, b, constants })
    }

    /// Emits `tree`, or its minimum with the value of the step `before`.
    fn emit(
        &mut self,
        tree: &Slotted<'_>,
        space: &Space,
        material: Option<MaterialId>,
        before: Option<StepId>,
    ) -> StepId {
        let node = tree.node;
        match &node.shape.kind {
            Kind::Primitive(table) => {
                let mut space = space.clone();
                if let Some(axis) = node.axis() {
                    let arg = tree.args.end - 1;
                    self.fixed.insert(arg);
                    if axis != FORMULA_AXIS {
                        space.chain.push(Link::Axis { arg });
                    }
                }
                if !space.chain.iter().all(Link::is_translation) {
                    space = self.materialise(&space);
                }
                let at = self.offset(&space);
                let constants = self.prepared(table.prepare, &tree.args);
                let region = self.region(Region { object: self.object, material });
                let args = tree.args.clone();
                let slope = self.derived(1, |out| Derive::Slope { table, args, out: out.start }).start() as u32;
                let point = space.point;
                let value = self.push(Step::Primitive { table, point, at, constants, slope, region });
                self.joined(before, value)
            }
            Kind::Formula => {
                let value = self.formula_node(tree, space, material);
                self.joined(before, value)
            }
            Kind::Combine(table) => {
                // Several children would each repeat the map.
                let space = if space.chain.iter().all(Link::is_translation) || tree.children.len() == 1 {
                    space.clone()
                } else {
                    self.materialise(space)
                };
                let constants = self.prepared(table.prepare, &tree.args);
                let mut children = tree.children.iter();
                let Some(first) = children.next() else { unreachable!("analysis refuses empty combinations") };
                let mut result = self.emit(first, &space, material, before);
                for child in children {
                    result = self.emit_folded(child, &space, material, result, (table, constants));
                }
                result
            }
            Kind::Place(table) => {
                let mut space = space.clone();
                space.chain.push(Link::Place { table, args: tree.args.clone() });
                let from = self.emit(&tree.children[0], &space, material, before);
                if is_rigid(node) {
                    return from;
                }
                let factor = self.derived(1, |out| Derive::Factor { table, args: tree.args.clone(), out: out.start });
                self.push(Step::Scale { from, factor: factor.start() as u32 })
            }
            Kind::Modify(table) => {
                let from = self.emit(&tree.children[0], space, material, before);
                let constants = self.prepared(table.prepare, &tree.args);
                self.push(Step::Modify { table, from, constants })
            }
            Kind::Paint => {
                let material = node.material.or(material);
                self.emit(&tree.children[0], space, material, before)
            }
        }
    }

    /// The minimum of a value and the one before it, if there is one.
    fn joined(&mut self, before: Option<StepId>, value: StepId) -> StepId {
        let Some(before) = before else { return value };
        let Kind::Combine(table) = &shapes::UNION.kind else { unreachable!("union combines") };
        self.push(Step::Combine { table, a: before, b: value, constants: Run::default() })
    }

    /// Emits a formula with its cut.
    fn formula_node(&mut self, tree: &Slotted<'_>, space: &Space, material: Option<MaterialId>) -> StepId {
        let expression = formula::expression(tree.node).expect("analysis refuses formulas that can't be read");
        let parts = formula::Parts::of(&tree.node.numbers());
        let space = if space.chain.iter().all(Link::is_translation) { space.clone() } else { self.materialise(space) };
        let (point, at) = (space.point, self.offset(&space));
        let mut value = self.formula(expression, point, at);
        if parts.is_sheet {
            value = self.push(Step::Unary { op: Unary::Abs, from: value });
        }
        // Which kind it is and what it is cut to shape the steps; the region's sizes are numbers like others.
        let args = &tree.args;
        self.fixed.extend([args.start, args.start + formula::REGION, args.end - 1]);
        let size = args.start + formula::REGION + 1..args.end - 1;
        let cut: Option<(&Shape, Prepare)> = match parts.region {
            formula::Region::Everywhere => None,
            formula::Region::Sphere { .. } => Some((&shapes::SPHERE, |size| size[..1].to_vec())),
            formula::Region::Box { .. } => {
                Some((&shapes::BOX, |size| vec![size[0] / 2.0, size[1] / 2.0, size[2] / 2.0, 0.0]))
            }
        };
        if let Some((shape, prepare)) = cut {
            let Kind::Primitive(table) = &shape.kind else { unreachable!("a sphere or a box") };
            let constants = self.prepared(prepare, &size);
            let slope = self.derived(1, |out| Derive::Literals { numbers: vec![1.0], out }).start() as u32;
            let b = self.push(Step::Primitive { table, point, at, constants, slope, region: NO_REGION });
            value = self.push(Step::Binary { op: Binary::Max, a: value, b });
        }
        let region = self.region(Region { object: self.object, material });
        self.push(Step::Surface { from: value, region })
    }

    /// Emits the terms of a formula in the coordinates of a point.
    fn formula(&mut self, formula: &Formula, point: StepId, at: Run) -> StepId {
        let literal = |term: &Term| match term {
            Term::Literal(number) => Some(*number),
            _ => None,
        };
        let numbers: Vec<f64> = formula.terms().iter().filter_map(literal).collect();
        let table = self.derived(numbers.len(), |out| Derive::Literals { numbers, out });
        let mut constant = table.start() as u32;
        let mut steps: Vec<StepId> = Vec::with_capacity(formula.terms().len());
        for term in formula.terms() {
            let step = match *term {
                Term::Input(axis) => Step::Coordinate { point, axis: axis as u8, at },
                Term::Literal(_) => {
                    constant += 1;
                    Step::Literal { constant: constant - 1 }
                }
                Term::Unary(op, a) => Step::Unary { op, from: steps[a.index()] },
                Term::Binary(op, a, b) => Step::Binary { op, a: steps[a.index()], b: steps[b.index()] },
                Term::Power(a, exponent) => Step::Power { from: steps[a.index()], exponent },
            };
            steps.push(self.push(step));
        }
        *steps.last().expect("a formula has a term")
    }

    /// Applies the pending maps of `space` to its point.
    fn materialise(&mut self, space: &Space) -> Space {
        let from_root = space.point == StepId::POINT;
        let chain = space.chain.clone();
        let constants = self.derived(AFFINE_CONSTANTS, |out| Derive::Affine { chain, from_root, out });
        Space { point: self.push(Step::Affine { from: space.point, constants }), chain: Vec::new() }
    }

    fn offset(&mut self, space: &Space) -> Run {
        let from_root = space.point == StepId::POINT;
        let chain = space.chain.clone();
        self.derived(3, |out| Derive::Offset { chain, from_root, out })
    }

    fn prepared(&mut self, prepare: fn(&[f64]) -> Vec<f64>, args: &Range<usize>) -> Run {
        let count = prepare(&self.values[args.clone()]).len();
        let args = args.clone();
        self.derived(count, |out| Derive::Prepare { prepare, args, out })
    }

    fn derived(&mut self, count: usize, make: impl FnOnce(Range<usize>) -> Derive) -> Run {
        let out = self.constants..self.constants + count;
        if count > 0 {
            self.constants = out.end;
            self.derive.push(make(out.clone()));
        }
        out.into()
    }

    fn region(&mut self, region: Region) -> u32 {
        *self.region_index.entry(region).or_insert_with(|| {
            self.regions.push(region);
            u32::try_from(self.regions.len() - 1).expect("less than 2^32 regions")
        })
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
        Kind::Formula => true,
    }
}

/// Whether a placing node never changes distances, whatever its numbers.
fn is_rigid(node: &Node) -> bool {
    matches!(&node.shape.kind, Kind::Place(table) if table.is_rigid)
}
