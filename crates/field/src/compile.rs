//! From trees to steps.
//!
//! Chains of affine maps are joined into one; a mere translation costs nothing, since every primitive subtracts one anyway;
//! nested unions become one chain of minima. Each step's constants are described by a [`Derive`], which binding evaluates
//! in `f64`.

use crate::field::{Field, MaterialId, Node};
use crate::formula::{Binary, Formula, Term, Unary};
use crate::kernel::AFFINE_CONSTANTS;
use crate::mix::MIX_CONSTANTS;
use crate::operation::{Code, Derive, Link, NO_REGION, Region, Run, Step, StepId, Steps};
use crate::shape::{CombineTable, Kind, MapTable, PrimitiveTable, ProductTable, Shape, range_constants};
use crate::shapes::{self, formula, loft, repeat_endless, twist};
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

/// The axis that formulas of axial shapes are written for: a shape along it needs no map.
const FORMULA_AXIS: usize = 2;

/// The steps for the union of `objects`, which are sound, and the numbers of the trees in the order of their slots.
/// Lists that fall into parts become several steps if they are `divided`.
pub(crate) fn compile(objects: &[Field], divided: bool) -> (Code, Steps, Vec<f64>) {
    let mut compiler = Compiler { divides: divided, ..Compiler::default() };
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
    field: &'f Field,
    node: &'f Node,
    args: Range<usize>,
    /// The slots of the whole tree.
    all: Range<usize>,
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
    /// Whether lists that fall into parts become several steps.
    divides: bool,
    /// Whether what is being compiled is a measure for something else, and no surface.
    is_measure: bool,
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
        let children = node.children.iter().map(|child| self.slots(child)).collect();
        Slotted { field, node, args, all: start..self.values.len(), children }
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
                let mut result = before;
                for constants in self.parts(table, &tree.args, constants) {
                    let value = self.push(Step::Primitive { table, point, at, constants, slope, region });
                    result = Some(self.joined(result, value));
                }
                result.expect("there is a part")
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
            Kind::Copies(table) => {
                // How many there are shapes the steps.
                self.fixed.extend(table.counted.clone().map(|index| tree.args.start + index));
                let Kind::Combine(union) = &shapes::UNION.kind else { unreachable!("union combines") };
                let numbers = node.numbers();
                let mut result = before;
                for index in 0..(table.count)(&numbers) {
                    let mut space = space.clone();
                    space.chain.push(Link::Copy { table, args: tree.args.clone(), index });
                    result = Some(match result {
                        Some(so_far) => {
                            self.emit_folded(&tree.children[0], &space, material, so_far, (union, Run::default()))
                        }
                        None => self.emit(&tree.children[0], &space, material, None),
                    });
                }
                result.expect("there is a copy")
            }
            Kind::Map(table) => {
                let (space, at) = self.settled(space);
                let constants = self.prepared(table.prepare, &tree.args);
                let point = self.push(Step::Map { table, from: space.point, at, constants });
                let value = self.emit(&tree.children[0], &Space { point, chain: Vec::new() }, material, None);
                self.joined(before, value)
            }
            Kind::Product(table) => {
                let (space, at) = self.settled(space);
                let value = self.product(tree, table, &space, at, material);
                self.joined(before, value)
            }
            Kind::Loft => {
                let (space, at) = self.settled(space);
                let value = self.lofted(tree, &space, at, material);
                let (cut, _) = loft::cut(&node.numbers());
                let constants = self.prepared(|args| range_constants(loft::cut(args)), &tree.args);
                let by = self.measure(cut, space.point, at, constants);
                let value = self.push(Step::Altered { op: Binary::Max, from: value, by });
                self.joined(before, value)
            }
            Kind::PerimeterSweep => {
                let (space, at) = self.settled(space);
                let distance = self.as_measure(|compiler| compiler.emit(&tree.children[0], &space, None, None));
                let zero = self.derived(1, |out| Derive::Literals { numbers: vec![0.0], out }).start() as u32;
                let zero = self.push(Step::Literal { constant: zero });
                let height = self.push(Step::Coordinate { point: space.point, axis: 2, at });
                let point = self.push(Step::Warp { x: distance, y: height, z: zero });
                let value = self.emit(&tree.children[1], &Space { point, chain: Vec::new() }, material, None);
                self.joined(before, value)
            }
            Kind::Endless { fold, .. } => {
                let (space, at) = self.settled(space);
                let value = self.repeated(tree, fold, &space, at, material);
                self.joined(before, value)
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
            Kind::Warp => {
                let (space, at) = self.settled(space);
                let formula = |axis| node.formula(axis).expect("analysis refuses formulas that can't be read");
                let [x, y, z] = [0, 1, 2].map(|axis| self.formula(formula(axis), space.point, at));
                let warped = Space { point: self.push(Step::Warp { x, y, z }), chain: Vec::new() };
                let value = self.emit(&tree.children[0], &warped, material, None);
                let value = match self.cut(formula::Region::of(&node.numbers()), tree.args.clone(), space.point, at) {
                    Some(by) => self.push(Step::Altered { op: Binary::Max, from: value, by }),
                    None => value,
                };
                self.joined(before, value)
            }
            Kind::Twist => {
                let (space, at) = self.settled(space);
                let point = self.twisted(tree, space.point, at);
                let value = self.emit(&tree.children[0], &Space { point, chain: Vec::new() }, material, None);
                self.joined(before, value)
            }
            Kind::Displace => {
                let (space, at) = self.settled(space);
                let from = self.emit(&tree.children[0], &space, material, None);
                let formula = node.formula(0).expect("analysis refuses formulas that can't be read");
                let by = self.formula(formula, space.point, at);
                let value = self.push(Step::Altered { op: Binary::Add, from, by });
                self.joined(before, value)
            }
        }
    }

    /// Emits the union of all parts of a product.
    fn product(
        &mut self,
        tree: &Slotted<'_>,
        table: &'static ProductTable,
        space: &Space,
        at: Run,
        material: Option<MaterialId>,
    ) -> StepId {
        let numbers = tree.node.numbers();
        let range = (table.range)(&numbers).0;
        let range_constants = self.prepared(table.range_constants, &tree.args);
        let constants = self.prepared(table.combine.prepare, &tree.args);
        let frames = table.frame.as_ref().map(|frame| (frame, self.prepared(frame.prepare, &tree.args).range()));
        let count = (table.parts)(&numbers);
        let mut union = None;
        for index in 0..count {
            let (space, at) = match &frames {
                None => (space.clone(), at),
                Some((table, all)) => {
                    let width = all.len() / count;
                    let start = all.start + index * width;
                    let constants = Run::from(start..start + width);
                    let point = self.push(Step::Map { table, from: space.point, at, constants });
                    self.settled(&Space { point, chain: Vec::new() })
                }
            };
            let a = self.emit(&tree.children[0], &space, material, None);
            let b = self.measure(range, space.point, at, range_constants);
            let value = self.push(Step::Combine { table: &table.combine, a, b, constants });
            union = Some(self.joined(union, value));
        }
        union.expect("there is a part")
    }

    /// Emits the mixture of all figures of a loft.
    fn lofted(&mut self, tree: &Slotted<'_>, space: &Space, at: Run, material: Option<MaterialId>) -> StepId {
        let (shape, numbers) = loft::height();
        let numbers = range_constants((shape, numbers));
        let constants = self.derived(numbers.len(), |out| Derive::Literals { numbers, out });
        let height = self.measure(shape, space.point, at, constants);
        let count = tree.children.len();
        let mut value = self.emit(&tree.children[0], space, material, None);
        for (index, child) in tree.children[1..].iter().enumerate() {
            let b = self.emit(child, space, material, None);
            let args = tree.args.clone();
            let constants = self.derived(MIX_CONSTANTS, |out| Derive::Mixture { args, index, count, out });
            value = self.push(Step::Mix { a: value, b, height, constants });
        }
        value
    }

    /// Emits the nearest of the copies of an endless repetition that are looked at, none of them nearer than its box and all of
    /// them no farther than the others.
    fn repeated(
        &mut self,
        tree: &Slotted<'_>,
        fold: &'static MapTable,
        space: &Space,
        at: Run,
        material: Option<MaterialId>,
    ) -> StepId {
        let (field, numbers) = (tree.field.clone(), tree.all.clone());
        let count = repeat_endless::constants(&field).len();
        let all = self.derived(count, |out| Derive::Endless { field, numbers, out }).range();
        let mut runs =
            all.step_by(repeat_endless::CONSTANTS).map(|start| Run::from(start..start + repeat_endless::CONSTANTS));
        let others = runs.next().expect("there are always others");
        let by_others = self.measure(tree.node.shape, space.point, at, others);
        let mut nearest = None;
        while let (Some(place), Some(boxes)) = (runs.next(), runs.next()) {
            let point = self.push(Step::Map { table: fold, from: space.point, at, constants: place });
            let from = self.emit(&tree.children[0], &Space { point, chain: Vec::new() }, material, None);
            let by = self.measure(tree.node.shape, space.point, at, boxes);
            let copy = self.push(Step::Altered { op: Binary::Max, from, by });
            nearest = Some(self.joined(nearest, copy));
        }
        let from = nearest.expect("a copy is looked at");
        self.push(Step::Altered { op: Binary::Min, from, by: by_others })
    }

    /// Emits a distance that bounds or measures something, but is no surface.
    fn measure(&mut self, shape: &'static Shape, point: StepId, at: Run, constants: Run) -> StepId {
        let table = shape.distance().expect("it is a distance");
        let slope = self.derived(1, |out| Derive::Literals { numbers: vec![1.0], out }).start() as u32;
        self.push(Step::Primitive { table, point, at, constants, slope, region: NO_REGION })
    }

    /// Emits something that changes other values, and is itself no surface.
    fn as_measure<R>(&mut self, emit: impl FnOnce(&mut Self) -> R) -> R {
        let before = std::mem::replace(&mut self.is_measure, true);
        let result = emit(self);
        self.is_measure = before;
        result
    }

    /// Emits the point turned back by the angle of a twist.
    fn twisted(&mut self, tree: &Slotted<'_>, point: StepId, at: Run) -> StepId {
        let [u, v, along] = twist::axes(tree.node);
        self.fixed.insert(tree.args.end - 1);
        let rate = self.prepared(|args| args[..1].to_vec(), &tree.args).start() as u32;
        let mut values = [0, 1, 2].map(|axis| self.push(Step::Coordinate { point, axis, at }));
        let rate = self.push(Step::Literal { constant: rate });
        let angle = self.push(Step::Binary { op: Binary::Mul, a: values[along], b: rate });
        let cos = self.push(Step::Unary { op: Unary::Cos, from: angle });
        let sin = self.push(Step::Unary { op: Unary::Sin, from: angle });
        let mut product = |a: StepId, b: StepId| self.push(Step::Binary { op: Binary::Mul, a, b });
        let (x, y) = (values[u], values[v]);
        let [x_cos, y_sin, y_cos, x_sin] = [product(x, cos), product(y, sin), product(y, cos), product(x, sin)];
        values[u] = self.push(Step::Binary { op: Binary::Add, a: x_cos, b: y_sin });
        values[v] = self.push(Step::Binary { op: Binary::Sub, a: y_cos, b: x_sin });
        let [x, y, z] = values;
        self.push(Step::Warp { x, y, z })
    }

    /// A space whose point needs nothing but a translation, and that translation.
    fn settled(&mut self, space: &Space) -> (Space, Run) {
        let space = if space.chain.iter().all(Link::is_translation) { space.clone() } else { self.materialise(space) };
        let at = self.offset(&space);
        (space, at)
    }

    /// Emits the distance from the region that the arguments `args` stand for, if that is not all of space.
    fn cut(&mut self, region: formula::Region, args: Range<usize>, point: StepId, at: Run) -> Option<StepId> {
        // What kind of region it is shapes the steps; its sizes are numbers like others.
        self.fixed.insert(args.start);
        let (shape, prepare): (&'static Shape, Prepare) = match region {
            formula::Region::Everywhere => return None,
            formula::Region::Sphere { .. } => (&shapes::SPHERE, |size| size[..1].to_vec()),
            formula::Region::Box { .. } => {
                (&shapes::BOX, |size| vec![size[0] / 2.0, size[1] / 2.0, size[2] / 2.0, 0.0])
            }
        };
        let constants = self.prepared(prepare, &(args.start + 1..args.end));
        Some(self.measure(shape, point, at, constants))
    }

    /// The minimum of a value and the one before it, if there is one.
    fn joined(&mut self, before: Option<StepId>, value: StepId) -> StepId {
        let Some(before) = before else { return value };
        let Kind::Combine(table) = &shapes::UNION.kind else { unreachable!("union combines") };
        self.push(Step::Combine { table, a: before, b: value, constants: Run::default() })
    }

    /// Emits a formula with its cut.
    fn formula_node(&mut self, tree: &Slotted<'_>, space: &Space, material: Option<MaterialId>) -> StepId {
        let expression = tree.node.formula(0).expect("analysis refuses formulas that can't be read");
        let parts = formula::Parts::of(&tree.node.numbers());
        let (Space { point, .. }, at) = self.settled(space);
        let mut value = self.formula(expression, point, at);
        if parts.is_sheet {
            value = self.push(Step::Unary { op: Unary::Abs, from: value });
        }
        let args = &tree.args;
        self.fixed.extend([args.start, args.end - 1]);
        if let Some(by) = self.cut(parts.region, args.start + formula::REGION..args.end - 1, point, at) {
            value = self.push(Step::Binary { op: Binary::Max, a: value, b: by });
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

    /// The constants of each part of a primitive.
    fn parts(&mut self, table: &'static PrimitiveTable, args: &Range<usize>, constants: Run) -> Vec<Run> {
        if !self.divides {
            return vec![constants];
        }
        let parts = (table.parts)(&self.values[args.clone()]);
        if parts.len() < 2 {
            return vec![constants];
        }
        let mut start = constants.start();
        let run = |count: &usize| {
            start += count;
            Run::from(start - count..start)
        };
        let runs = parts.iter().map(run).collect();
        self.derive.push(Derive::Parts { table, args: args.clone(), parts });
        runs
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
        if self.is_measure {
            return NO_REGION;
        }
        *self.region_index.entry(region).or_insert_with(|| {
            self.regions.push(region);
            u32::try_from(self.regions.len() - 1).expect("less than 2^32 regions")
        })
    }
}

/// Whether a node's value goes unchanged into the minimum with what is there before.
pub(crate) fn can_fold(node: &Node) -> bool {
    match &node.shape.kind {
        Kind::Primitive(_) => true,
        Kind::Combine(table) => table.is_minimum && node.children.iter().all(|child| can_fold(child.node())),
        Kind::Place(_) => is_rigid(node) && can_fold(node.children[0].node()),
        Kind::Modify(_) => false,
        Kind::Paint => can_fold(node.children[0].node()),
        Kind::Copies(_) => can_fold(node.children[0].node()),
        Kind::Map(_)
        | Kind::Product(_)
        | Kind::Loft
        | Kind::PerimeterSweep
        | Kind::Endless { .. }
        | Kind::Formula
        | Kind::Warp
        | Kind::Displace
        | Kind::Twist => true,
    }
}

/// Whether a placing node never changes distances, whatever its numbers.
pub(crate) fn is_rigid(node: &Node) -> bool {
    matches!(&node.shape.kind, Kind::Place(table) if table.is_rigid)
}
