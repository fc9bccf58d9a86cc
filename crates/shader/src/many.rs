//! The functions of scenes with many parts. These are found through a hierarchy of boxes in the table of parameters, and all
//! parts of a form share one function, which gets the place of their constants: the text grows with the number of forms,
//! not with that of parts.

use crate::helpers::{Helpers, Want};
use crate::part::{Part, outline_key};
use crate::scene::{one, surface_body};
use crate::tree::{Expr, Function, Item, Operator, Statement, Type};
use std::collections::HashMap;

/// For each part of several regions the number of the form of its surface.
pub(crate) fn surface_kinds(parts: &[Part]) -> Vec<Option<usize>> {
    let mut forms: HashMap<String, usize> = HashMap::new();
    let kind = |(index, part): (usize, &Part)| {
        (part.regions.len() > 1).then(|| {
            let form = if part.is_measured { outline_key(&part.outline, true) } else { part.form(index) };
            let next = forms.len();
            *forms.entry(form).or_insert(next)
        })
    };
    parts.iter().enumerate().map(kind).collect()
}

/// What the walks go by: values, gradients and surfaces of parts by their forms.
pub(crate) fn items(parts: &[Part], kinds: &[usize], plane_count: usize, mut helpers: Helpers) -> Vec<Item> {
    let mut own = Vec::new();
    let mut names: Vec<String> = Vec::new();
    let mut values = Vec::new();
    let mut gradients = Vec::new();
    for (part, &kind) in parts.iter().zip(kinds) {
        if kind == names.len() {
            let base = part.shared_base();
            let name = helpers.names.make(&part.source.name);
            values.push(one(part, Want::Value, base, &name, &mut helpers, &mut own));
            gradients.push(one(part, Want::Gradient, base, &name, &mut helpers, &mut own));
            names.push(name);
        }
    }
    let mut surfaces = Vec::new();
    for ((part, &kind), surface) in parts.iter().zip(kinds).zip(surface_kinds(parts)) {
        if surface == Some(surfaces.len()) {
            surfaces.push(surface_of(part, &names[kind], &mut helpers, &mut own));
        }
    }
    let last = [
        crate::scene::whole(plane_count),
        part_value(&values),
        crate::scene::part_gradient(&gradients),
        crate::scene::whole_gradient(),
        surface_at(&surfaces),
    ];
    helpers.functions.into_iter().chain(own).chain(last).map(Item::Function).collect()
}

/// Writes the function of a surface's form, and returns its call.
fn surface_of(part: &Part, name: &str, helpers: &mut Helpers, own: &mut Vec<Function>) -> Expr {
    let base = part.shared_base();
    let region = |index: usize| match index {
        0 => Expr::name("REGIONS") + Expr::name("REGION_SIZE") * Expr::name("part"),
        1 => Expr::name("second"),
        other => Expr::name("second") + Expr::Int(other as i64 - 1) * Expr::name("REGION_SIZE"),
    };
    let body = surface_body(part, base, region, name, helpers);
    let numbers = ["part", "first", "second"];
    let mut arguments: Vec<(String, Type)> = numbers.iter().map(|name| ((*name).to_owned(), Type::Int)).collect();
    arguments.push(("spot".into(), Type::Struct("Spot".into())));
    let name = helpers.names.make(&format!("{name}_surface"));
    let call = Expr::call(name.clone(), arguments.iter().map(|(name, _)| Expr::name(&**name)));
    own.push(Function { name, comment: Vec::new(), arguments, result: Type::Struct("Surface".into()), body });
    call
}

/// A whole number from the table of parameters.
fn number(place: Expr) -> Expr {
    Expr::Make(Type::Int, vec![Expr::Parameter(Box::new(place))])
}

fn of_part(place: i64) -> Expr {
    Expr::name("PARTS") + Expr::name("PART_SIZE") * Expr::name("part") + Expr::Int(place)
}

/// One of some results by the number of a form.
fn by_form(results: &[Expr]) -> Vec<Statement> {
    let mut body: Vec<Statement> = Vec::with_capacity(results.len());
    for (form, result) in results.iter().enumerate() {
        let given = Statement::Return(result.clone());
        // What is left in the end needs no question.
        body.push(if form + 1 == results.len() {
            given
        } else {
            let is_it = Expr::binary(Operator::Equal, Expr::name("form"), Expr::Int(form as i64));
            Statement::If(is_it, vec![given], Vec::new())
        });
    }
    body
}

fn part_value(values: &[Expr]) -> Function {
    let mut body = by_form(values);
    if values.len() > 1 {
        body.insert(0, Statement::Let("form".into(), Type::Int, number(of_part(8))));
    }
    Function {
        name: "part_value".into(),
        comment: vec!["The value of a part's field at a point. Its constants begin at `first`.".into()],
        arguments: vec![("part".into(), Type::Int), ("first".into(), Type::Int), ("p".into(), Type::Vector(3))],
        result: Type::Float,
        body,
    }
}

fn surface_at(surfaces: &[Expr]) -> Function {
    let mut body = Vec::new();
    if !surfaces.is_empty() {
        let place = || Expr::name("SURFACES") + Expr::name("SURFACE_SIZE") * Expr::name("part");
        let is_form = |form: usize| Expr::binary(Operator::Equal, Expr::name("form"), Expr::Int(form as i64));
        let mut of_parts = vec![
            Statement::Let("form".into(), Type::Int, number(place())),
            Statement::Let("first".into(), Type::Int, number(of_part(9))),
            Statement::Let("second".into(), Type::Int, number(place() + Expr::Int(1))),
        ];
        of_parts.extend(
            surfaces.iter().enumerate().map(|(form, surface)| {
                Statement::If(is_form(form), vec![Statement::Return(surface.clone())], Vec::new())
            }),
        );
        // Planes are numbered after all parts.
        let is_part = Expr::binary(Operator::Less, Expr::name("part"), Expr::name("PART_COUNT"));
        body.push(Statement::If(is_part, of_parts, Vec::new()));
    }
    crate::scene::surface_at(body)
}
