//! An interpreter for the form that all shader text comes from, in double precision: what a graphics processor would compute,
//! without one.
#![allow(dead_code, unused_imports, reason = "each test file uses a part")]

mod scenes;

pub(crate) use scenes::{read, scene, scene_files, scene_of};

use freikugel_shader::tree::{Expr, Function, Item, Operator, Statement, Type};
use freikugel_shader::{Parameters, Shader, View};
use std::collections::HashMap;

/// A value of the form.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Bool(bool),
    Int(i64),
    Float(f64),
    Vector(Vec<f64>),
    /// By columns.
    Matrix([[f64; 3]; 3]),
    Struct(Vec<Value>),
}

use Value::{Bool, Float, Int, Matrix, Struct, Vector};

impl Value {
    pub(crate) fn float(&self) -> f64 {
        match self {
            Float(x) => *x,
            other => panic!("{other:?} is no number"),
        }
    }

    pub(crate) fn vector(&self) -> &[f64] {
        match self {
            Vector(v) => v,
            other => panic!("{other:?} is no vector"),
        }
    }

    fn int(&self) -> i64 {
        match self {
            Int(i) => *i,
            other => panic!("{other:?} is no whole number"),
        }
    }

    fn bool(&self) -> bool {
        match self {
            Bool(b) => *b,
            other => panic!("{other:?} is no truth value"),
        }
    }
}

/// How a statement ended.
enum Flow {
    Next,
    Break,
    Continue,
    Return(Value),
}

/// A module with its parameters.
pub(crate) struct Machine<'s> {
    functions: HashMap<&'s str, &'s Function>,
    members: HashMap<&'s str, Vec<&'s str>>,
    constants: HashMap<&'s str, Value>,
    parameters: Vec<f64>,
    samples: &'s [[f32; 2]],
    view: Vec<Value>,
}

/// The members of the uniform, in the order of their values.
const VIEW: [&str; 2] = ["size", "show"];

type Scope<'e> = Vec<(String, Value)>;

impl<'s> Machine<'s> {
    pub(crate) fn new(shader: &'s Shader, parameters: &'s Parameters, view: &View) -> Self {
        let mut machine = Self {
            functions: HashMap::new(),
            members: HashMap::new(),
            constants: HashMap::new(),
            parameters: parameters.numbers().iter().map(|&n| f64::from(n)).collect(),
            samples: parameters.voxels(),
            view: vec![Vector(view.size.map(f64::from).to_vec()), Int(view.show.code().into())],
        };
        for item in shader.items() {
            match item {
                Item::Function(function) => {
                    machine.functions.insert(&function.name, function);
                }
                Item::Struct(name, members, _) => {
                    machine.members.insert(name, members.iter().map(|(name, _)| name.as_str()).collect());
                }
                Item::Constant(name, _, value, _) => {
                    let value = machine.expr(value, &mut Vec::new());
                    machine.constants.insert(name, value);
                }
            }
        }
        machine
    }

    /// Calls a function.
    pub(crate) fn call(&self, name: &str, arguments: Vec<Value>) -> Value {
        let function = self.functions.get(name).unwrap_or_else(|| panic!("there is no function {name}"));
        assert_eq!(function.arguments.len(), arguments.len(), "{name}");
        let mut scope: Scope<'_> = function.arguments.iter().map(|(name, _)| name.clone()).zip(arguments).collect();
        match self.block(&function.body, &mut scope) {
            Flow::Return(value) => value,
            _ => panic!("{name} returns nothing"),
        }
    }

    fn block(&self, statements: &[Statement], scope: &mut Scope<'_>) -> Flow {
        let depth = scope.len();
        for statement in statements {
            let flow = self.statement(statement, scope);
            if !matches!(flow, Flow::Next) {
                scope.truncate(depth);
                return flow;
            }
        }
        scope.truncate(depth);
        Flow::Next
    }

    fn statement(&self, statement: &Statement, scope: &mut Scope<'_>) -> Flow {
        match statement {
            Statement::Comment(_) => {}
            Statement::Let(name, ty, value) | Statement::Var(name, ty, value) => {
                let value = self.expr(value, scope);
                assert!(fits(&value, ty), "{name} is {ty:?}, not {value:?}");
                scope.push((name.clone(), value));
            }
            Statement::Assign(place, value) => {
                let value = self.expr(value, scope);
                match place {
                    Expr::Name(name) => *find(scope, name).expect("a variable") = value,
                    Expr::Member(of, member) => {
                        let Expr::Name(name) = of.as_ref() else { panic!("{place:?} is no variable") };
                        let Some(Struct(values)) = find(scope, name) else { panic!("{name} is no structure") };
                        let index = self.member(values.len(), member);
                        values[index] = value;
                    }
                    _ => panic!("{place:?} is no place"),
                }
            }
            Statement::If(condition, yes, no) => {
                let branch = if self.expr(condition, scope).bool() { yes } else { no };
                return self.block(branch, scope);
            }
            Statement::Count(name, from, to, body) => {
                let mut i = self.expr(from, scope).int();
                while i < self.expr(to, scope).int() {
                    scope.push((name.clone(), Int(i)));
                    let flow = self.block(body, scope);
                    scope.pop();
                    match flow {
                        Flow::Break => break,
                        Flow::Return(value) => return Flow::Return(value),
                        Flow::Next | Flow::Continue => {}
                    }
                    i += 1;
                }
            }
            Statement::Loop(body) => loop {
                match self.block(body, scope) {
                    Flow::Break => break,
                    Flow::Return(value) => return Flow::Return(value),
                    Flow::Next | Flow::Continue => {}
                }
            },
            Statement::Break => return Flow::Break,
            Statement::Continue => return Flow::Continue,
            Statement::Return(value) => return Flow::Return(self.expr(value, scope)),
        }
        Flow::Next
    }

    /// The place of a member, in whichever structure has as many members and one of this name.
    fn member(&self, count: usize, name: &str) -> usize {
        let mut all = self.members.values().filter(|members| members.len() == count);
        all.find_map(|members| members.iter().position(|own| *own == name))
            .unwrap_or_else(|| panic!("no member {name}"))
    }

    fn expr(&self, expr: &Expr, scope: &mut Scope<'_>) -> Value {
        match expr {
            Expr::Bool(value) => Bool(*value),
            Expr::Int(value) => Int(*value),
            Expr::Float(value) => Float(f64::from(*value)),
            Expr::Name(name) => match find(scope, name) {
                Some(value) => value.clone(),
                None => self.constants.get(name.as_str()).unwrap_or_else(|| panic!("no {name}")).clone(),
            },
            Expr::Parameter(place) => Float(self.parameters[self.expr(place, scope).int() as usize]),
            Expr::Member(of, member) => {
                if **of == Expr::name("view") {
                    let place = VIEW.iter().position(|own| own == member).expect("a member of the view");
                    return self.view[place].clone();
                }
                match self.expr(of, scope) {
                    Vector(v) => {
                        let parts: Vec<f64> = member.chars().map(|c| v["xyzw".find(c).expect("a component")]).collect();
                        if let [only] = parts[..] { Float(only) } else { Vector(parts) }
                    }
                    Struct(values) => values[self.member(values.len(), member)].clone(),
                    other => panic!("{other:?} has no members"),
                }
            }
            Expr::Index(of, place) => {
                let place = self.expr(place, scope).int() as usize;
                match self.expr(of, scope) {
                    Vector(v) => Float(v[place]),
                    Matrix(m) => Vector(m[place].to_vec()),
                    other => panic!("{other:?} has no entries"),
                }
            }
            Expr::Negate(a) => match self.expr(a, scope) {
                Int(i) => Int(-i),
                Float(x) => Float(-x),
                Vector(v) => Vector(v.into_iter().map(|x| -x).collect()),
                other => panic!("-{other:?}"),
            },
            Expr::Not(a) => Bool(!self.expr(a, scope).bool()),
            Expr::Binary(op, a, b) => {
                let left = self.expr(a, scope);
                match (op, &left) {
                    (Operator::And, Bool(false)) | (Operator::Or, Bool(true)) => return left,
                    _ => {}
                }
                binary(*op, left, self.expr(b, scope))
            }
            Expr::Call(name, parts) => {
                let values: Vec<Value> = parts.iter().map(|part| self.expr(part, scope)).collect();
                match self.functions.contains_key(name.as_str()) {
                    true => self.call(name, values),
                    // Four parameters as a vector, which shells define by their table.
                    false if name == "quad" => {
                        let place = values[0].int() as usize;
                        assert_eq!(place % 4, 0, "quads are aligned");
                        Vector(self.parameters[place..place + 4].to_vec())
                    }
                    false if name == "voxel" => Vector(self.samples[values[0].int() as usize].map(f64::from).to_vec()),
                    false => builtin(name, &values),
                }
            }
            Expr::Make(ty, parts) => {
                let values: Vec<Value> = parts.iter().map(|part| self.expr(part, scope)).collect();
                make(ty, values)
            }
            Expr::Select(condition, yes, no) => {
                let [condition, yes, no] = [condition, yes, no].map(|part| self.expr(part, scope));
                if condition.bool() { yes } else { no }
            }
        }
    }
}

fn find<'v>(scope: &'v mut Scope<'_>, name: &str) -> Option<&'v mut Value> {
    scope.iter_mut().rev().find(|(own, _)| own == name).map(|(_, value)| value)
}

fn fits(value: &Value, ty: &Type) -> bool {
    match (value, ty) {
        (Bool(_), Type::Bool) | (Int(_), Type::Int) | (Float(_), Type::Float) => true,
        (Matrix(_), Type::Matrix) | (Struct(_), Type::Struct(_)) => true,
        (Vector(v), Type::Vector(count)) => v.len() == usize::from(*count),
        _ => false,
    }
}

fn make(ty: &Type, values: Vec<Value>) -> Value {
    match (ty, values.as_slice()) {
        (Type::Struct(_), _) => Struct(values),
        (Type::Float, [Int(i)]) => Float(*i as f64),
        (Type::Int, [Float(x)]) => Int(x.trunc() as i64),
        (Type::Matrix, [Vector(a), Vector(b), Vector(c)]) => {
            Matrix([a, b, c].map(|column| [column[0], column[1], column[2]]))
        }
        (Type::Vector(count), _) => {
            let parts: Vec<f64> = values
                .iter()
                .flat_map(|value| match value {
                    Float(x) => vec![*x],
                    Vector(v) => v.clone(),
                    other => panic!("{other:?} in a vector"),
                })
                .collect();
            if parts.len() == 1 {
                return Vector(vec![parts[0]; usize::from(*count)]);
            }
            assert_eq!(parts.len(), usize::from(*count));
            Vector(parts)
        }
        other => panic!("{other:?}"),
    }
}

fn binary(op: Operator, a: Value, b: Value) -> Value {
    let number = |a: f64, b: f64| match op {
        Operator::Add => a + b,
        Operator::Sub => a - b,
        Operator::Mul => a * b,
        Operator::Div => a / b,
        other => panic!("{other:?} of numbers"),
    };
    let order = |less: bool, equal: bool| match op {
        Operator::Less => less,
        Operator::LessEqual => less || equal,
        Operator::Greater => !less && !equal,
        Operator::GreaterEqual => !less,
        Operator::Equal => equal,
        Operator::NotEqual => !equal,
        other => panic!("{other:?} is no comparison"),
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    match (op, a, b) {
        (Operator::And | Operator::Or, Bool(_), Bool(b)) => Bool(b),
        (Operator::Add, Int(a), Int(b)) => Int(a + b),
        (Operator::Sub, Int(a), Int(b)) => Int(a - b),
        (Operator::Mul, Int(a), Int(b)) => Int(a * b),
        (_, Int(a), Int(b)) => Bool(order(a < b, a == b)),
        (Operator::Add | Operator::Sub | Operator::Mul | Operator::Div, Float(a), Float(b)) => Float(number(a, b)),
        (_, Float(a), Float(b)) => Bool(order(a < b, a == b)),
        (_, Vector(a), Vector(b)) => {
            assert_eq!(a.len(), b.len(), "{op:?} of vectors of different sizes");
            Vector(a.into_iter().zip(b).map(|(a, b)| number(a, b)).collect())
        }
        (_, Float(a), Vector(b)) => Vector(b.into_iter().map(|b| number(a, b)).collect()),
        (_, Vector(a), Float(b)) => Vector(a.into_iter().map(|a| number(a, b)).collect()),
        (Operator::Mul, Matrix(m), Vector(v)) => {
            Vector((0..3).map(|row| (0..3).map(|column| m[column][row] * v[column]).sum()).collect())
        }
        (Operator::Mul, Vector(v), Matrix(m)) => Vector(m.iter().map(|column| dot(column, &v)).collect()),
        (op, a, b) => panic!("{op:?} of {a:?} and {b:?}"),
    }
}

fn builtin(name: &str, values: &[Value]) -> Value {
    let each = |f: fn(f64) -> f64| match &values[0] {
        Float(x) => Float(f(*x)),
        Vector(v) => Vector(v.iter().map(|&x| f(x)).collect()),
        other => panic!("{name} of {other:?}"),
    };
    let pairs = |f: fn(f64, f64) -> f64| match (&values[0], &values[1]) {
        (Float(a), Float(b)) => Float(f(*a, *b)),
        (Vector(a), Vector(b)) => Vector(a.iter().zip(b).map(|(&a, &b)| f(a, b)).collect()),
        other => panic!("{name} of {other:?}"),
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    match name {
        "abs" => each(f64::abs),
        "sqrt" => each(f64::sqrt),
        "floor" => each(f64::floor),
        "fract" => each(|x| x - x.floor()),
        "sin" => each(f64::sin),
        "cos" => each(f64::cos),
        "tan" => each(f64::tan),
        "asin" => each(f64::asin),
        "acos" => each(f64::acos),
        "atan" => each(f64::atan),
        "exp" => each(f64::exp),
        "log" => each(f64::ln),
        "sign" => each(|x| if x == 0.0 { 0.0 } else { x.signum() }),
        "min" => pairs(|a, b| if b < a { b } else { a }),
        "max" => pairs(|a, b| if a < b { b } else { a }),
        "pow" => pairs(f64::powf),
        "atan2" => pairs(f64::atan2),
        "clamp" => Float(values[0].float().max(values[1].float()).min(values[2].float())),
        "mix" => {
            let share = values[2].float();
            let mixed = values[0].vector().iter().zip(values[1].vector()).map(|(a, b)| a + (b - a) * share);
            Vector(mixed.collect())
        }
        "length" => Float(dot(values[0].vector(), values[0].vector()).sqrt()),
        "dot" => Float(dot(values[0].vector(), values[1].vector())),
        "normalize" => {
            let v = values[0].vector();
            let length = dot(v, v).sqrt();
            Vector(v.iter().map(|x| x / length).collect())
        }
        _ => panic!("no function {name}"),
    }
}
