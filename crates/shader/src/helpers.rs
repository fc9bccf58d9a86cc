//! One function for each function of shapes that a scene uses, and one for its derivatives: written once, with the constants
//! as arguments.

use crate::formula::{Table, statements};
use crate::names::Names;
use crate::tree::{Expr, Function, Statement, Type};
use freikugel_field::expr::{self, Graph, Slots};
use freikugel_field::formula::{Binary, Unary};
use freikugel_field::mix::mixed;
use freikugel_field::{Constants, Dual, Kind, ParamKind, Shape};
use std::collections::HashMap;

/// With more constants than this a function gets the place of the first one instead.
const MOST_ARGUMENTS: usize = 10;

/// The argument that says how many rows a list has.
const ROWS: &str = "rows";

/// The functions written so far.
pub(crate) struct Helpers {
    pub(crate) names: Names,
    pub(crate) functions: Vec<Function>,
    known: HashMap<String, Known>,
    /// What was found for shapes of these names with so many constants.
    lists: HashMap<(&'static str, usize), List>,
}

/// A function that is there: its name, and which constants it takes.
#[derive(Clone)]
struct Known {
    name: String,
    takes: Vec<usize>,
}

/// Where the constants of a part begin in the table of parameters.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Base {
    /// At this place.
    At(usize),
    /// At the place that the function has got as `first`: it serves all parts of the same form.
    First,
}

impl Base {
    /// The place of a constant.
    pub(crate) fn place(self, constant: usize) -> Expr {
        match self {
            Self::At(base) => Expr::Int((base + constant) as i64),
            Self::First if constant == 0 => Expr::name("first"),
            Self::First => Expr::name("first") + Expr::Int(constant as i64),
        }
    }

    /// A constant.
    pub(crate) fn parameter(self, constant: usize) -> Expr {
        Expr::Parameter(Box::new(self.place(constant)))
    }
}

/// The number of the round, in loops over steps that come again with other constants.
pub(crate) const ROUND: &str = "piece";

/// A constant of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) base: Base,
    /// Where it is among those of its part,
    pub(crate) constant: usize,
    /// and how much farther on it is in each round.
    pub(crate) stride: usize,
}

impl Place {
    /// The same one in each round.
    pub(crate) fn always(base: Base, constant: usize) -> Self {
        Self { base, constant, stride: 0 }
    }

    /// The place in the table of parameters.
    pub(crate) fn place(self) -> Expr {
        let place = self.base.place(self.constant);
        match self.stride {
            0 => place,
            stride => place + Expr::Int(stride as i64) * Expr::name(ROUND),
        }
    }

    /// The constant that comes so many later.
    pub(crate) fn after(self, count: usize) -> Self {
        Self { constant: self.constant + count, ..self }
    }

    /// The constant.
    pub(crate) fn parameter(self) -> Expr {
        Expr::Parameter(Box::new(self.place()))
    }
}

/// The constants of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Own {
    pub(crate) first: Place,
    pub(crate) count: usize,
}

/// What is wanted of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Want {
    /// Its value.
    Value,
    /// Its gradient, and its value as a fourth component.
    Gradient,
}

/// What is wanted of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mapping {
    /// The mapped point.
    Point,
    /// The derivatives.
    Derivative,
}

/// How constants come into a function.
enum Passing {
    /// By themselves, under these names.
    Each(Vec<String>),
    /// By the place of the first one.
    First,
    /// By the place of the first one and the number of rows: one function serves lists of all lengths.
    Rows(usize),
}

impl Helpers {
    pub(crate) fn new(names: Names) -> Self {
        Self { names, functions: Vec::new(), known: HashMap::new(), lists: HashMap::new() }
    }

    /// The function that was defined under a key.
    pub(crate) fn known(&self, key: &str) -> Option<String> {
        self.known.get(key).map(|known| known.name.clone())
    }

    /// Notes what a function was defined under.
    pub(crate) fn remember(&mut self, key: String, name: &str) {
        self.known.insert(key, Known { name: name.to_owned(), takes: Vec::new() });
    }

    /// A call of a primitive at a point.
    pub(crate) fn primitive(&mut self, want: Want, shape: &'static Shape, at: Expr, constants: Own) -> Expr {
        let table = shape.distance().expect("a distance");
        let record = |graph: &Graph, count: usize| {
            let point: [expr::Expr<'_>; 3] = graph.point();
            (table.kernels.expr)(point.into(), &Constants::new(point[0], &Slots::at(0), count)).id()
        };
        let arguments = vec![("p", Type::Vector(3), at)];
        let inputs: Vec<Expr> = ["x", "y", "z"].map(|axis| Expr::name("p").member(axis)).into();
        self.call(want, shape, arguments, &inputs, constants, &record, |d| match d {
            [x, y, z] => [x.clone(), y.clone(), z.clone()].into(),
            _ => unreachable!("three derivatives"),
        })
    }

    /// A combination of two values, or of two values with their gradients.
    pub(crate) fn combine(&mut self, want: Want, shape: &'static Shape, [a, b]: [Expr; 2], constants: Own) -> Expr {
        let table = shape.combination().expect("a combination");
        if table.is_minimum {
            return Expr::call(if want == Want::Value { "min" } else { "nearer" }, [a, b]);
        }
        let record = |graph: &Graph, count: usize| {
            let [a, b] = [0, 1].map(|input| graph.input(input));
            (table.kernels.expr)(a, b, &Constants::new(a, &Slots::at(0), count)).id()
        };
        self.of_values(want, shape, &[a, b], constants, &record)
    }

    /// The share of the second value in a combination of two.
    pub(crate) fn share(&mut self, shape: &'static Shape, [a, b]: [Expr; 2], constants: Own) -> Expr {
        let table = shape.combination().expect("a combination");
        let (passing, key) = self.passing(shape, constants.count, "share");
        let known = match self.known.get(&key) {
            Some(known) => known.clone(),
            None => {
                let graph = Graph::new();
                let [x, y] = [0, 1].map(|input| graph.input(input));
                let share = (table.share)(x, y, &Constants::new(x, &Slots::at(0), constants.count));
                let inputs = ["a", "b"].map(Expr::name);
                let (mut body, mut results) = statements(&graph, &[share], &inputs, &passing);
                body.push(Statement::Return(results.remove(0)));
                let values = vec![("a", Type::Float), ("b", Type::Float)];
                self.define(key, values, &passing, Type::Float, body, Vec::new())
            }
        };
        passing.call(known, vec![a, b], constants)
    }

    /// The point that a map takes a point to, or the map's derivatives there: those of the new point by each old coordinate, by
    /// columns.
    pub(crate) fn map(&mut self, wants: Mapping, shape: &'static Shape, at: Expr, constants: Own) -> Expr {
        let table = shape.mapping().expect("a map");
        let is_all = matches!(shape.kind, Kind::Map(_));
        let suffix = match wants {
            Mapping::Point if is_all => "",
            Mapping::Derivative if is_all => "derivative",
            // What else the shape does has its plain name.
            Mapping::Point => "frame",
            Mapping::Derivative => "frame_derivative",
        };
        let (passing, key) = self.passing(shape, constants.count, suffix);
        let known = match self.known.get(&key) {
            Some(known) => known.clone(),
            None => {
                let graph = Graph::new();
                let point: [expr::Expr<'_>; 3] = graph.point();
                let slots = Slots::at(0);
                let constants = Constants::new(point[0], &slots, constants.count);
                let mapped = (table.kernels.expr)(point.into(), &constants);
                let results = [mapped.x, mapped.y, mapped.z];
                let inputs: Vec<Expr> = ["x", "y", "z"].map(|axis| Expr::name("p").member(axis)).into();
                let comment = vec![shape.about.summary.to_owned()];
                let (ty, body, comment) = match wants {
                    Mapping::Point => {
                        let (mut body, parts) = statements(&graph, &results, &inputs, &passing);
                        body.push(Statement::Return(Expr::vector(parts)));
                        (Type::Vector(3), body, comment)
                    }
                    Mapping::Derivative => (Type::Matrix, derivative(&graph, &results, &inputs, &passing), Vec::new()),
                };
                self.define(key, vec![("p", Type::Vector(3))], &passing, ty, body, comment)
            }
        };
        passing.call(known, vec![at], constants)
    }

    /// A mixture of two values by a height, or of two values with their gradients.
    pub(crate) fn mix(&mut self, want: Want, shape: &'static Shape, values: &[Expr; 3], constants: Own) -> Expr {
        let record = |graph: &Graph, count: usize| {
            let [a, b, height] = graph.point();
            mixed(a, b, height, &Constants::new(a, &Slots::at(0), count)).id()
        };
        self.of_values(want, shape, values, constants, &record)
    }

    /// A change of a value, or of a value with its gradient.
    pub(crate) fn modify(&mut self, want: Want, shape: &'static Shape, from: Expr, constants: Own) -> Expr {
        let Kind::Modify(table) = &shape.kind else { unreachable!("a change of values") };
        let record = |graph: &Graph, count: usize| {
            let value = graph.input(0);
            (table.kernels.expr)(value, &Constants::new(value, &Slots::at(0), count)).id()
        };
        self.of_values(want, shape, &[from], constants, &record)
    }

    /// A function of one value outside of formulas.
    pub(crate) fn unary(&mut self, want: Want, op: Unary, a: Expr) -> Expr {
        let record = |graph: &Graph| op.apply(graph.input(0)).id();
        self.operation(want, &format!("{op:?}"), &[a], &record)
    }

    /// A function of two values outside of formulas.
    pub(crate) fn binary(&mut self, want: Want, op: Binary, [a, b]: [Expr; 2]) -> Expr {
        let record = |graph: &Graph| op.apply(graph.input(0), graph.input(1)).id();
        self.operation(want, &format!("{op:?}"), &[a, b], &record)
    }

    fn operation(&mut self, want: Want, op: &str, values: &[Expr], record: &dyn Fn(&Graph) -> u32) -> Expr {
        if want == Want::Value {
            // Written where it is needed.
            let graph = Graph::new();
            record(&graph);
            let last = graph.terms().len() - 1;
            let result = graph.at(last as u32);
            let (body, mut results) = statements(&graph, &[result], values, &|_| unreachable!("no constants"));
            if body.is_empty() {
                return results.remove(0);
            }
        }
        let key = match want {
            Want::Value => format!("{op}_value"),
            Want::Gradient => format!("{op}_gradient"),
        };
        let passing = Passing::Each(Vec::new());
        let known = match self.known.get(&key) {
            Some(known) => known.clone(),
            None => self.value_function(want, key, values.len(), &passing, &|graph, _| record(graph), 0),
        };
        passing.call(known, values.to_vec(), Own { first: Place::always(Base::First, 0), count: 0 })
    }

    fn of_values(
        &mut self,
        want: Want,
        shape: &'static Shape,
        values: &[Expr],
        constants: Own,
        record: &dyn Fn(&Graph, usize) -> u32,
    ) -> Expr {
        let (passing, key) = self.passing(shape, constants.count, want.suffix());
        let known = match self.known.get(&key) {
            Some(known) => known.clone(),
            None => self.value_function(want, key, values.len(), &passing, record, constants.count),
        };
        passing.call(known, values.to_vec(), constants)
    }

    /// Defines a function of up to three values.
    fn value_function(
        &mut self,
        want: Want,
        key: String,
        count: usize,
        passing: &Passing,
        record: &dyn Fn(&Graph, usize) -> u32,
        constants: usize,
    ) -> Known {
        let graph = Graph::new();
        // Inputs come first, so that they are there even if nothing reads them.
        let _ = graph.point();
        let result = graph.at(record(&graph, constants));
        let letters = &["a", "b", "height"][..count];
        match want {
            Want::Value => {
                let inputs: Vec<Expr> = letters.iter().map(|&letter| Expr::name(letter)).collect();
                let (mut body, mut results) = statements(&graph, &[result], &inputs, passing);
                body.push(Statement::Return(results.remove(0)));
                let values = letters.iter().map(|&letter| (letter, Type::Float)).collect();
                self.define(key, values, passing, Type::Float, body, Vec::new())
            }
            Want::Gradient => {
                let inputs: Vec<Expr> = letters.iter().map(|&letter| Expr::name(letter).member("w")).collect();
                let derivatives = Graph::new();
                let dual: Dual<expr::Expr<'_>, 3> = graph.differentiate(&[result], &derivatives).remove(0);
                let wanted: Vec<expr::Expr<'_>> = dual.gradient[..count].iter().copied().chain([dual.value]).collect();
                let (mut body, mut results) = statements(&derivatives, &wanted, &inputs, passing);
                let value = results.pop().expect("the value was wanted");
                let sum = letters.iter().zip(results).filter_map(|(&letter, by)| {
                    let gradient = Expr::name(letter).member("xyz");
                    match by {
                        Expr::Float(0.0) => None,
                        Expr::Float(1.0) => Some(gradient),
                        Expr::Float(-1.0) => Some(Expr::Negate(Box::new(gradient))),
                        by => Some(by * gradient),
                    }
                });
                let zero = || Expr::Make(Type::Vector(3), vec![Expr::Float(0.0)]);
                let gradient = sum.reduce(|a, b| a + b).unwrap_or_else(zero);
                body.push(Statement::Return(Expr::Make(Type::Vector(4), vec![gradient, value])));
                let values = letters.iter().map(|&letter| (letter, Type::Vector(4))).collect();
                self.define(key, values, passing, Type::Vector(4), body, Vec::new())
            }
        }
    }

    #[allow(clippy::too_many_arguments, reason = "one for each thing that differs")]
    fn call(
        &mut self,
        want: Want,
        shape: &'static Shape,
        arguments: Vec<(&'static str, Type, Expr)>,
        inputs: &[Expr],
        constants: Own,
        record: &dyn Fn(&Graph, usize) -> u32,
        gradient: impl Fn(&[Expr]) -> Vec<Expr>,
    ) -> Expr {
        let (passing, key) = self.passing(shape, constants.count, want.suffix());
        let known = match self.known.get(&key) {
            Some(known) => known.clone(),
            None => {
                let graph = Graph::new();
                let _ = graph.point();
                let result = graph.at(record(&graph, constants.count));
                let values = arguments.iter().map(|(name, ty, _)| (*name, ty.clone())).collect();
                let (ty, body, comment) = match want {
                    Want::Value => {
                        let (mut body, mut results) = statements(&graph, &[result], inputs, &passing);
                        body.push(Statement::Return(results.remove(0)));
                        (Type::Float, body, vec![shape.about.summary.to_owned()])
                    }
                    Want::Gradient => {
                        let (body, results) = dual_statements(&graph, result, inputs, &passing);
                        let (value, by) = results.split_last().expect("a value");
                        let mut parts = gradient(by);
                        parts.push(value.clone());
                        let mut body = body;
                        body.push(Statement::Return(Expr::vector(parts)));
                        (Type::Vector(4), body, Vec::new())
                    }
                };
                self.define(key, values, &passing, ty, body, comment)
            }
        };
        let values = arguments.into_iter().map(|(.., value)| value).collect();
        passing.call(known, values, constants)
    }

    fn define(
        &mut self,
        key: String,
        values: Vec<(&str, Type)>,
        passing: &Passing,
        result: Type,
        body: Vec<Statement>,
        comment: Vec<String>,
    ) -> Known {
        let name = self.names.make(&key);
        let mut arguments: Vec<(String, Type)> = values.into_iter().map(|(name, ty)| (name.into(), ty)).collect();
        let mut takes = Vec::new();
        match passing {
            // What a formula does not read, such as the axis that its point was turned for, is not passed.
            Passing::Each(names) => {
                for (place, name) in names.iter().enumerate().filter(|(_, name)| reads(&body, name)) {
                    takes.push(place);
                    arguments.push((name.clone(), Type::Float));
                }
            }
            Passing::First => arguments.push(("first".into(), Type::Int)),
            Passing::Rows(_) => arguments.extend(["first", ROWS].map(|name| (name.into(), Type::Int))),
        }
        self.functions.push(Function { name: name.clone(), comment, arguments, result, body });
        let known = Known { name, takes };
        self.known.insert(key, known.clone());
        known
    }

    /// How a shape's constants are passed, and what tells its functions apart: lists have any number of constants.
    fn passing(&mut self, shape: &'static Shape, count: usize, suffix: &str) -> (Passing, String) {
        let name = shape.about.name;
        let key = if suffix.is_empty() { name.to_owned() } else { format!("{name}_{suffix}") };
        let list = *self.lists.entry((name, count)).or_insert_with(|| List::of(shape, count));
        match (list, count) {
            (List::Rows(rows), _) => (Passing::Rows(rows), key),
            (List::Tree, _) => (Passing::First, key),
            (List::None, 0..=MOST_ARGUMENTS) => (Passing::Each(constant_names(shape, count)), key),
            (List::None, _) => (Passing::First, format!("{key}_{count}")),
        }
    }
}

/// What of a primitive's constants differs in number, so that one function serves any number of them.
#[derive(Clone, Copy, Debug)]
enum List {
    None,
    /// So many rows, if the formula goes through all of them row by row and does nothing else.
    Rows(usize),
    /// The leaves of a tree, which itself says how many there are.
    Tree,
}

impl List {
    fn of(shape: &Shape, count: usize) -> Self {
        let Some(table) = shape.distance() else { return Self::None };
        let graph = Graph::new();
        let point: [expr::Expr<'_>; 3] = graph.point();
        (table.kernels.expr)(point.into(), &Constants::new(point[0], &Slots::at(0), count));
        if graph.terms().iter().any(|term| matches!(term, expr::Term::Entry(..))) {
            return Self::Tree;
        }
        match graph.loops().as_slice() {
            [only] if only.row.is_some() => Self::Rows(only.limit as usize),
            _ => Self::None,
        }
    }
}

/// Statements that return the derivatives of a point by each coordinate of the point it was made from, by columns.
pub(crate) fn derivative(
    graph: &Graph,
    point: &[expr::Expr<'_>; 3],
    inputs: &[Expr],
    table: &dyn Table,
) -> Vec<Statement> {
    let derivatives = Graph::new();
    let duals = graph.differentiate::<3>(point, &derivatives);
    let columns: Vec<expr::Expr<'_>> =
        (0..3).flat_map(|axis| duals.iter().map(move |dual| dual.gradient[axis])).collect();
    let (mut body, parts) = statements(&derivatives, &columns, inputs, table);
    let columns = parts.chunks(3).map(|column| Expr::vector(column.iter().cloned()));
    body.push(Statement::Return(Expr::Make(Type::Matrix, columns.collect())));
    body
}

/// Statements for a number and its derivatives by three inputs: the derivatives, then the number.
pub(crate) fn dual_statements(
    graph: &Graph,
    result: expr::Expr<'_>,
    inputs: &[Expr],
    table: &dyn Table,
) -> (Vec<Statement>, Vec<Expr>) {
    let derivatives = Graph::new();
    let dual: Dual<expr::Expr<'_>, 3> = graph.differentiate(&[result], &derivatives).remove(0);
    let [x, y, z] = dual.gradient;
    statements(&derivatives, &[x, y, z, dual.value], inputs, table)
}

impl Want {
    pub(crate) fn suffix(self) -> &'static str {
        match self {
            Self::Value => "",
            Self::Gradient => "gradient",
        }
    }
}

impl Table for Passing {
    fn slot(&self, slot: usize) -> Expr {
        match self {
            Self::Each(names) => Expr::name(&*names[slot]),
            Self::First | Self::Rows(_) => Expr::Parameter(Box::new(Expr::name("first") + Expr::Int(slot as i64))),
        }
    }

    fn rows(&self, recorded: u32) -> Expr {
        match self {
            Self::Rows(_) => Expr::name(ROWS),
            _ => Expr::Int(recorded.into()),
        }
    }
}

impl Passing {
    fn call(&self, known: Known, mut values: Vec<Expr>, constants: Own) -> Expr {
        match self {
            Self::Each(_) => {
                values.extend(known.takes.iter().map(|&place| constants.first.after(place).parameter()));
            }
            Self::First => values.push(constants.first.place()),
            Self::Rows(rows) => {
                values.extend([constants.first.place(), Expr::Int(*rows as i64)]);
            }
        }
        Expr::Call(known.name, values)
    }
}

/// Whether some statements read a name.
fn reads(body: &[Statement], name: &str) -> bool {
    fn in_expr(expr: &Expr, name: &str) -> bool {
        matches!(expr, Expr::Name(own) if own == name) || expr.parts().into_iter().any(|part| in_expr(part, name))
    }
    body.iter().any(|statement| match statement {
        Statement::Let(_, _, value) | Statement::Var(_, _, value) | Statement::Return(value) => in_expr(value, name),
        Statement::Assign(_, value) => in_expr(value, name),
        Statement::If(condition, yes, no) => in_expr(condition, name) || reads(yes, name) || reads(no, name),
        Statement::Count(_, _, _, body) | Statement::Loop(body) => reads(body, name),
        Statement::Comment(_) | Statement::Break | Statement::Continue => false,
    })
}

/// Names of a shape's constants: those of the parameters that they are or are half of, as a sample of arguments shows.
fn constant_names(shape: &Shape, count: usize) -> Vec<String> {
    let prepare = match &shape.kind {
        Kind::Primitive(table) => table.prepare,
        Kind::Combine(table) => table.prepare,
        Kind::Product(table) => match &table.frame {
            Some(frame) if count > 0 => frame.prepare,
            _ => table.combine.prepare,
        },
        Kind::Map(table) => table.prepare,
        Kind::Modify(table) => table.prepare,
        _ => |args: &[f64]| args.to_vec(),
    };
    let mut sample = Vec::new();
    let mut labels = Vec::new();
    // The constants of lists follow from no single number.
    let is_list = shape.about.params.iter().any(|param| param.kind.is_list());
    for param in if is_list { &[] } else { shape.about.params } {
        let width = param.kind.width();
        for place in 0..width {
            // Numbers that no computation yields by accident.
            sample.push(match param.kind {
                ParamKind::Count(least, _) => f64::from(least),
                ParamKind::Choice(_) | ParamKind::Flag => 0.0,
                _ => 0.711 + 0.0137 * sample.len() as f64,
            });
            let letter = if width == 1 { "" } else { ["_x", "_y", "_z", "_w"][place] };
            labels.push(format!("{}{letter}", param.name));
        }
    }
    let constants = if is_list || shape.about.params.is_empty() { Vec::new() } else { prepare(&sample) };
    let mut names = Names::new();
    ["p", "a", "b", "height", "first", ROUND].into_iter().for_each(|name| names.take(name));
    let name = |place: usize| {
        let known = (constants.len() == count).then(|| constants[place]);
        let find =
            |factor: f64| known.and_then(|own| sample.iter().position(|number| number * factor == own && own != 0.0));
        match (find(1.0), find(0.5)) {
            (Some(at), _) => labels[at].clone(),
            (_, Some(at)) => format!("half_{}", labels[at]),
            _ => format!("c{place}"),
        }
    };
    (0..count).map(|place| names.make(&name(place))).collect()
}
