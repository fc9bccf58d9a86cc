//! The parts a scene is made of: objects, and what unions at the top of objects hold. Each becomes one function.
//!
//! Parts are tried one after another for the nearest, so that those far away can be passed over by their boxes.

use crate::formula::statements;
use crate::helpers::{Base, Helpers, Mapping, Own, Place, ROUND, Want, derivative, dual_statements};
use crate::names::Names;
use crate::rounds::Rounds;
use crate::tree::{Expr, Function, Statement, Type};
use freikugel_field::expr::{self, Graph, Loop, Slots};
use freikugel_field::field::Origin;
use freikugel_field::formula::Binary;
use freikugel_field::shapes;
use freikugel_field::{Action, Field, Kind, MaterialId, Outline, Scalar, Structure, copies};
use std::collections::HashMap;
use std::ops::Range;

/// A field of its own among those of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    /// The object it belongs to.
    pub(crate) object: usize,
    /// What it is called.
    pub(crate) name: String,
    pub(crate) field: Field,
}

/// The parts of one object.
pub(crate) fn sources(object: usize, name: &str, field: &Field) -> Vec<Source> {
    let mut found = Vec::new();
    split(field, None, &mut found);
    let is_whole = found.len() == 1;
    let named = |(index, field): (usize, Field)| {
        let name = if is_whole { name.to_owned() } else { format!("{name} {}", index + 1) };
        Source { object, name, field }
    };
    found.into_iter().enumerate().map(named).collect()
}

/// Takes unions apart that nothing but paint lies above.
fn split(field: &Field, paint: Option<MaterialId>, found: &mut Vec<Field>) {
    let node = field.node();
    match &node.shape.kind {
        Kind::Combine(table) if table.is_minimum => {
            node.children.iter().for_each(|child| split(child, paint, found));
        }
        Kind::Copies(_) => copies(field).into_iter().flatten().for_each(|copy| split(&copy, paint, found)),
        // The innermost paint holds.
        Kind::Paint => split(&node.children[0], node.material.or(paint), found),
        _ => found.push(match paint {
            Some(material) => {
                let origin: Origin = node.origin;
                Field::with_origin(&shapes::PAINT, [], [field.clone()], Some(material), origin)
            }
            None => field.clone(),
        }),
    }
}

/// A part whose functions are to be written.
pub(crate) struct Part {
    pub(crate) source: Source,
    pub(crate) structure: Structure,
    pub(crate) outline: Outline,
    /// Where its constants begin in the table of parameters.
    pub(crate) base: usize,
    /// Where its regions are among those of the scene.
    pub(crate) regions: Vec<usize>,
    /// Whether it needs a slope to be marched.
    pub(crate) is_measured: bool,
}

/// Costs of steps, in simple operations.
const COST_OF_PRIMITIVE: usize = 12;
const COST_OF_COMBINATION: usize = 3;

impl Part {
    /// About how many simple operations it takes.
    pub(crate) fn cost(&self) -> usize {
        let loops = |shape: &freikugel_field::Shape, count: usize| match &shape.kind {
            Kind::Primitive(table) | Kind::Endless { boxes: table, .. } => {
                let graph = Graph::new();
                let point = graph.point();
                (table.kernels.expr)(point.into(), &freikugel_field::Constants::new(point[0], &Slots::at(0), count));
                // Lists are gone through to their end; few other loops run to their limit.
                let steps = |this: &Loop| if this.row.is_some() { this.limit as usize } else { 4 };
                graph.terms().len() * (1 + graph.loops().iter().map(steps).sum::<usize>())
            }
            _ => COST_OF_PRIMITIVE,
        };
        let cost = |action: &Action| match action {
            Action::Primitive { shape, constants, .. } => loops(shape, constants.len()),
            Action::Affine { .. } | Action::Map { .. } => COST_OF_PRIMITIVE,
            _ => COST_OF_COMBINATION,
        };
        self.outline.steps.iter().map(cost).sum()
    }

    /// Where functions that all parts of its form share find its constants: formulas have functions of their own.
    pub(crate) fn shared_base(&self) -> Base {
        if self.is_measured { Base::First } else { Base::At(self.base) }
    }

    /// What tells its form apart: parts of the same form differ in their constants only. Formulas have constants of their own
    /// in functions of their own, so that those are parts of a kind.
    pub(crate) fn form(&self, index: usize) -> String {
        if self.is_measured { outline_key(&self.outline, false) } else { format!("formula {index}") }
    }

    /// Statements that compute its value, or value and gradient, at the point `p`, and the result.
    pub(crate) fn value(&self, want: Want, base: Base, name: &str, helpers: &mut Helpers) -> (Vec<Statement>, Expr) {
        let result = self.outline.result.expect("a part is something");
        let mut walk = Walk::new(self, want, base, name, helpers);
        let mut next = 0;
        for rounds in Rounds::of(&self.outline.steps, result) {
            walk.steps(next..rounds.first);
            next = rounds.first + rounds.steps * rounds.count;
            walk.rounds(&rounds);
        }
        walk.steps(next..self.outline.steps.len());
        let value = walk.values[result].clone().expect("every step has a value");
        let mut body = walk.body;
        match body.pop() {
            // The last line needs no name.
            Some(Statement::Let(name, _, last)) if value == Expr::name(&*name) => (body, last),
            last => {
                body.extend(last);
                (body, value)
            }
        }
    }

    /// Statements that compute the shares of its regions at the point `p`, and one for each region.
    pub(crate) fn shares(&self, base: Base, name: &str, helpers: &mut Helpers) -> (Vec<Statement>, Vec<Expr>) {
        let mut walk = Walk::new(self, Want::Value, base, name, helpers);
        walk.steps(0..self.outline.steps.len());
        walk.shares()
    }
}

/// What tells outlines apart.
pub(crate) fn outline_key(outline: &Outline, with_regions: bool) -> String {
    let mut key = format!("{:?}", outline.result);
    for action in &outline.steps {
        // Shapes are told apart by their names; their descriptors would fill pages.
        let text = match action {
            Action::Primitive { shape, point, at, constants, region } => {
                let region = region.filter(|_| with_regions);
                format!("{} {point} {at} {constants:?} {region:?}", shape.about.name)
            }
            Action::Map { shape, from, at, constants } => format!("{} {from} {at} {constants:?}", shape.about.name),
            Action::Combine { shape, a, b, constants } => format!("{} {a} {b} {constants:?}", shape.about.name),
            Action::Mix { shape, a, b, height, constants } => {
                format!("{} {a} {b} {height} {constants:?}", shape.about.name)
            }
            Action::Modify { shape, from, constants } => format!("{} {from} {constants:?}", shape.about.name),
            other => format!("{other:?}"),
        };
        key.push('\n');
        key.push_str(&text);
    }
    key
}

struct Walk<'a> {
    part: &'a Part,
    want: Want,
    base: Base,
    name: &'a str,
    helpers: &'a mut Helpers,
    body: Vec<Statement>,
    /// The points and values of steps.
    points: Vec<Option<Expr>>,
    values: Vec<Option<Expr>>,
    /// For each point other than the first one, the step it was made from, and the derivatives of the map.
    maps: Vec<Option<(usize, Expr)>>,
    /// Which steps are terms of formulas, and how often each step is read by others.
    is_formula: Vec<bool>,
    reads: Vec<usize>,
    local: Names,
    numbers: HashMap<String, usize>,
    /// In a loop, how much farther on constants are in each round.
    strides: HashMap<usize, usize>,
}

impl<'a> Walk<'a> {
    fn new(part: &'a Part, want: Want, base: Base, name: &'a str, helpers: &'a mut Helpers) -> Self {
        let steps = &part.outline.steps;
        let mut is_formula: Vec<bool> = Vec::with_capacity(steps.len());
        let mut reads = vec![0; steps.len()];
        for action in steps {
            is_formula.push(match *action {
                Action::Coordinate { .. } | Action::Literal { .. } => true,
                Action::Unary { from, .. } | Action::Power { from, .. } => is_formula[from],
                Action::Binary { a, b, .. } => is_formula[a] && is_formula[b],
                _ => false,
            });
            // Only points are counted: those that several steps read get a name.
            match *action {
                Action::Primitive { point, .. }
                | Action::Affine { from: point, .. }
                | Action::Map { from: point, .. } => {
                    reads[point] += 1;
                }
                Action::Coordinate { point, .. } => reads[point] += 1,
                _ => {}
            }
        }
        let count = steps.len();
        let local = helpers.names.clone();
        Self {
            part,
            want,
            base,
            name,
            helpers,
            body: Vec::new(),
            points: vec![None; count],
            values: vec![None; count],
            maps: vec![None; count],
            is_formula,
            reads,
            local,
            numbers: HashMap::new(),
            strides: HashMap::new(),
        }
    }

    fn steps(&mut self, steps: Range<usize>) {
        steps.for_each(|index| self.step(index));
    }

    /// Writes a loop for steps that come again and again.
    fn rounds(&mut self, rounds: &Rounds) {
        let (before, end) = (rounds.first - 1, rounds.first + rounds.steps);
        let start = self.read(before);
        let name = self.local.make("joined");
        self.body.push(Statement::Var(name.clone(), self.ty(), start.clone()));
        let outside = std::mem::take(&mut self.body);
        self.values[before] = Some(Expr::name(&*name));
        self.strides.clone_from(&rounds.strides);
        self.steps(rounds.first..end);
        self.strides.clear();
        let result = self.read(end - 1);
        self.body.push(Statement::Assign(Expr::name(&*name), result));
        let round = std::mem::replace(&mut self.body, outside);
        self.body.push(Statement::Count(ROUND.into(), Expr::Int(0), Expr::Int(rounds.count as i64), round));
        self.values[before] = Some(start);
        self.values[rounds.first + rounds.steps * rounds.count - 1] = Some(Expr::Name(name));
    }

    /// Where a constant is.
    fn place(&self, constant: usize) -> Place {
        Place { base: self.base, constant, stride: self.strides.get(&constant).copied().unwrap_or(0) }
    }

    fn own(&self, constants: &Range<usize>) -> Own {
        Own { first: self.place(constants.start), count: constants.len() }
    }

    fn ty(&self) -> Type {
        match self.want {
            Want::Value => Type::Float,
            Want::Gradient => Type::Vector(4),
        }
    }

    /// Gives a value a name made of a word and a number.
    fn bind(&mut self, word: &str, ty: Type, value: Expr) -> Expr {
        let number = self.numbers.entry(word.to_owned()).or_insert(0);
        *number += 1;
        let name = self.local.make(&format!("{word}{number}"));
        self.body.push(Statement::Let(name.clone(), ty, value));
        Expr::Name(name)
    }

    fn read(&mut self, step: usize) -> Expr {
        if self.is_formula[step] && self.values[step].is_none() {
            let value = self.formula(step);
            self.values[step] = Some(value);
        }
        self.values[step].clone().expect("operands come before what reads them")
    }

    fn point(&self, step: usize) -> Expr {
        self.points[step].clone().expect("points come before what reads them")
    }

    /// A point less three constants.
    fn moved(&self, point: usize, at: usize) -> Expr {
        self.point(point) - triple(self.place(at).place())
    }

    /// A value with its gradient by the coordinates of `point`, seen from the first point.
    fn seen(&self, mut value: Expr, mut point: usize) -> Expr {
        if self.want == Want::Gradient {
            while let Some((from, map)) = &self.maps[point] {
                value = Expr::call("turned", [value, map.clone()]);
                point = *from;
            }
        }
        value
    }

    fn step(&mut self, index: usize) {
        if self.is_formula[index] {
            return;
        }
        let want = self.want;
        let value = match &self.part.outline.steps[index] {
            Action::Point => {
                self.points[index] = Some(Expr::name("p"));
                return;
            }
            &Action::Affine { from, constants } => {
                let matrix = Expr::call("matrix", [self.place(constants).place()]);
                self.maps[index] = Some((from, matrix.clone()));
                let point = matrix * self.point(from) + triple(self.place(constants).after(9).place());
                self.set_point(index, point);
                return;
            }
            Action::Map { shape, from, at, constants } => {
                let own = self.own(constants);
                let at = self.moved(*from, *at);
                if want == Want::Gradient {
                    let derivative = self.helpers.map(Mapping::Derivative, shape, at.clone(), own);
                    let map = self.bind("bend", Type::Matrix, derivative);
                    self.maps[index] = Some((*from, map));
                }
                let point = self.helpers.map(Mapping::Point, shape, at, own);
                self.set_point(index, point);
                return;
            }
            &Action::Warp { from } => {
                self.warp(index, from);
                return;
            }
            Action::Primitive { shape, point, at, constants, .. } => {
                let at = self.moved(*point, *at);
                let value = self.helpers.primitive(want, shape, at, self.own(constants));
                let value = self.seen(value, *point);
                self.bind(shape.about.name, self.ty(), value)
            }
            Action::Combine { shape, a, b, constants } => {
                let values = [self.read(*a), self.read(*b)];
                let value = self.helpers.combine(want, shape, values, self.own(constants));
                self.bind(shape.about.name, self.ty(), value)
            }
            Action::Mix { shape, a, b, height, constants } => {
                let values = [*a, *b, *height].map(|step| self.read(step));
                let value = self.helpers.mix(want, shape, &values, self.own(constants));
                self.bind(shape.about.name, self.ty(), value)
            }
            Action::Modify { shape, from, constants } => {
                let from = self.read(*from);
                let value = self.helpers.modify(want, shape, from, self.own(constants));
                self.bind(shape.about.name, self.ty(), value)
            }
            &Action::Scale { from, factor } => {
                let value = self.read(from) * self.place(factor).parameter();
                self.bind("scaled", self.ty(), value)
            }
            &Action::Surface { from, .. } => self.read(from),
            &Action::Altered { op, from, by } => {
                let values = [self.read(from), self.read(by)];
                let value = self.helpers.binary(want, op, values);
                self.bind(if op == Binary::Max { "cut" } else { "altered" }, self.ty(), value)
            }
            &Action::Unary { op, from } => {
                let from = self.read(from);
                let value = self.helpers.unary(want, op, from);
                self.bind(&format!("{op:?}").to_lowercase(), self.ty(), value)
            }
            &Action::Binary { op, a, b } => {
                let values = [self.read(a), self.read(b)];
                let value = self.helpers.binary(want, op, values);
                self.bind(if op == Binary::Max { "cut" } else { "combined" }, self.ty(), value)
            }
            Action::Power { .. } | Action::Coordinate { .. } | Action::Literal { .. } => {
                unreachable!("only formulas hold these")
            }
        };
        self.values[index] = Some(value);
    }

    fn set_point(&mut self, index: usize, point: Expr) {
        let point = if self.reads[index] > 1 { self.bind("q", Type::Vector(3), point) } else { point };
        self.points[index] = Some(point);
    }

    /// The value of the formula that ends with a step.
    fn formula(&mut self, root: usize) -> Expr {
        let (point, at) = self.space(&[root]);
        let graph = Graph::new();
        let results = self.record(&graph, &[root]);
        let inputs: Vec<Expr> = ["x", "y", "z"].map(|axis| Expr::name("p").member(axis)).into();
        let base = Base::At(self.part.base);
        let slot = move |slot: usize| base.parameter(slot);
        let (suffix, ty, body) = match self.want {
            Want::Value => {
                let (mut body, mut results) = statements(&graph, &results, &inputs, &slot);
                body.push(Statement::Return(results.remove(0)));
                ("formula", Type::Float, body)
            }
            Want::Gradient => {
                let (mut body, results) = dual_statements(&graph, results[0], &inputs, &slot);
                body.push(Statement::Return(Expr::vector(results)));
                ("formula_gradient", Type::Vector(4), body)
            }
        };
        let name = self.define(suffix, root, ty, body);
        let point_value = match at {
            Some(at) => self.moved(point, at),
            None => self.point(point),
        };
        let value = self.seen(Expr::call(name, [point_value]), point);
        self.bind("formula", self.ty(), value)
    }

    fn warp(&mut self, index: usize, from: [usize; 3]) {
        if from.iter().any(|&step| !self.is_formula[step]) {
            return self.warp_by_values(index, from);
        }
        let (point, at) = self.space(&from);
        let graph = Graph::new();
        let results = self.record(&graph, &from);
        let inputs: Vec<Expr> = ["x", "y", "z"].map(|axis| Expr::name("p").member(axis)).into();
        let base = Base::At(self.part.base);
        let slot = move |slot: usize| base.parameter(slot);
        let (mut body, parts) = statements(&graph, &results, &inputs, &slot);
        body.push(Statement::Return(Expr::vector(parts)));
        let name = self.define("warp", index, Type::Vector(3), body);
        let at = match at {
            Some(at) => self.moved(point, at),
            None => self.point(point),
        };
        if self.want == Want::Gradient {
            let results = results.try_into().expect("three coordinates");
            let body = derivative(&graph, &results, &inputs, &slot);
            let name = self.define("warp_derivative", index, Type::Matrix, body);
            let map = self.bind("bend", Type::Matrix, Expr::call(name, [at.clone()]));
            self.maps[index] = Some((point, map));
        }
        self.set_point(index, Expr::call(name, [at]));
    }

    /// A point whose coordinates are values of other steps, which change with the first point of all.
    fn warp_by_values(&mut self, index: usize, from: [usize; 3]) {
        let values = from.map(|step| self.read(step));
        let all = |member: &str| Expr::vector(values.iter().map(|value| value.clone().member(member)));
        let point = match self.want {
            Want::Value => Expr::vector(values.iter().cloned()),
            Want::Gradient => {
                let first = self.part.outline.steps.iter().position(|action| matches!(action, Action::Point));
                let columns = ["x", "y", "z"].map(all).into();
                let map = self.bind("bend", Type::Matrix, Expr::Make(Type::Matrix, columns));
                self.maps[index] = Some((first.expect("values are those at points"), map));
                all("w")
            }
        };
        self.set_point(index, point);
    }

    /// The point that formulas are about, and what is subtracted from it.
    fn space(&self, roots: &[usize]) -> (usize, Option<usize>) {
        let is_needed = self.needed(roots);
        let found = self.part.outline.steps.iter().zip(is_needed).find_map(|(action, is_needed)| match *action {
            Action::Coordinate { point, at, .. } if is_needed => Some((point, Some(at))),
            _ => None,
        });
        found.unwrap_or((0, None))
    }

    /// Which steps the formulas with these ends are made of.
    fn needed(&self, roots: &[usize]) -> Vec<bool> {
        let steps = &self.part.outline.steps;
        let mut is_needed = vec![false; steps.len()];
        roots.iter().for_each(|&root| is_needed[root] = true);
        for index in (0..steps.len()).rev().filter(|&index| self.is_formula[index]) {
            if is_needed[index] {
                match steps[index] {
                    Action::Unary { from, .. } | Action::Power { from, .. } => is_needed[from] = true,
                    Action::Binary { a, b, .. } => {
                        is_needed[a] = true;
                        is_needed[b] = true;
                    }
                    _ => {}
                }
            }
        }
        is_needed
    }

    fn record<'g>(&self, graph: &'g Graph, roots: &[usize]) -> Vec<expr::Expr<'g>> {
        let inputs = graph.point();
        let mut terms: HashMap<usize, expr::Expr<'g>> = HashMap::new();
        for (index, _) in self.needed(roots).into_iter().enumerate().filter(|(_, is_needed)| *is_needed) {
            let term = match self.part.outline.steps[index] {
                Action::Coordinate { axis, .. } => inputs[axis],
                Action::Literal { constant } => inputs[0].constant(&Slots::at(constant as u32), 0),
                Action::Unary { op, from } => op.apply(terms[&from]),
                Action::Binary { op, a, b } => op.apply(terms[&a], terms[&b]),
                Action::Power { from, exponent } => terms[&from].powi(exponent),
                _ => unreachable!("no term of a formula"),
            };
            terms.insert(index, term);
        }
        roots.iter().map(|root| terms[root]).collect()
    }

    /// Defines a function of a point that belongs to this part alone, unless that was done.
    fn define(&mut self, suffix: &str, step: usize, result: Type, body: Vec<Statement>) -> String {
        let key = format!("{}#{suffix}#{step}", self.name);
        let wanted = format!("{}_{suffix}", self.name);
        self.helpers.once(key, &wanted, result, body)
    }

    fn shares(mut self) -> (Vec<Statement>, Vec<Expr>) {
        let steps = &self.part.outline.steps;
        let mut weights: Vec<Option<Expr>> = vec![None; steps.len()];
        let mut sums: Vec<Option<Expr>> = vec![None; self.part.regions.len()];
        weights[self.part.outline.result.expect("a part is something")] = Some(Expr::Float(1.0));
        for index in (0..steps.len()).rev() {
            let Some(weight) = weights[index].clone() else { continue };
            let mut add = |region: usize| {
                let sum = sums[region].take();
                sums[region] = Some(sum.map_or(weight.clone(), |sum| sum + weight.clone()));
            };
            match &steps[index] {
                Action::Combine { shape, a, b, constants } => {
                    let values = [*a, *b].map(|step| self.values[step].clone().expect("a value"));
                    let share = self.helpers.share(shape, values, self.own(constants));
                    let share = if weight == Expr::Float(1.0) { share } else { weight.clone() * share };
                    let second = self.bind("share", Type::Float, share);
                    weights[*a] = Some(self.bind("rest", Type::Float, weight - second.clone()));
                    weights[*b] = Some(second);
                }
                Action::Mix { shape, a, b, height, constants } => {
                    // What 0 and 1 mix to is the share of the second value.
                    let height = self.values[*height].clone().expect("a value");
                    let values = [Expr::Float(0.0), Expr::Float(1.0), height];
                    let share = self.helpers.mix(Want::Value, shape, &values, self.own(constants));
                    let second = self.bind("share", Type::Float, weight.clone() * share);
                    weights[*a] = Some(self.bind("rest", Type::Float, weight - second.clone()));
                    weights[*b] = Some(second);
                }
                Action::Primitive { region: Some(region), .. } | Action::Surface { region, .. } => add(*region),
                Action::Modify { from, .. } | Action::Scale { from, .. } | Action::Altered { from, .. } => {
                    weights[*from] = Some(weight);
                }
                _ => {}
            }
        }
        let sums = sums.into_iter().map(|sum| sum.unwrap_or(Expr::Float(0.0))).collect();
        (self.body, sums)
    }
}

/// Three parameters as a vector.
fn triple(place: Expr) -> Expr {
    Expr::call("triple", [place])
}

impl Helpers {
    /// Defines a function of a point under a key of its own, once.
    pub(crate) fn once(&mut self, key: String, wanted: &str, result: Type, body: Vec<Statement>) -> String {
        if let Some(name) = self.known(&key) {
            return name;
        }
        let name = self.names.make(wanted);
        let arguments = vec![("p".to_owned(), Type::Vector(3))];
        self.functions.push(Function { name: name.clone(), comment: Vec::new(), arguments, result, body });
        self.remember(key, &name);
        name
    }
}
