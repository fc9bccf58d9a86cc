//! Which items of a module are needed, and in an order in which nothing is used before it is there.

use crate::tree::{Expr, Function, Item, Statement, Type};
use std::collections::HashMap;

/// The items that those with the given names need, everything after what it uses, otherwise in their order.
pub(crate) fn needed(items: &[Item], roots: &[&str]) -> Vec<Item> {
    let index: HashMap<&str, usize> = items.iter().enumerate().map(|(index, item)| (item.name(), index)).collect();
    let uses: Vec<Vec<usize>> = items.iter().map(|item| uses(item, &index)).collect();
    let mut is_needed = vec![false; items.len()];
    let mut pending: Vec<usize> = roots.iter().filter_map(|root| index.get(root).copied()).collect();
    while let Some(item) = pending.pop() {
        if !std::mem::replace(&mut is_needed[item], true) {
            pending.extend(&uses[item]);
        }
    }
    let mut order = Vec::new();
    let mut is_placed = vec![false; items.len()];
    // Constants and structures first, then functions.
    for is_wanted in [|item: &Item| !matches!(item, Item::Function(_)), |_: &Item| true] {
        for item in (0..items.len()).filter(|&item| is_needed[item] && is_wanted(&items[item])) {
            place(item, &uses, &mut is_placed, &mut order);
        }
    }
    order.into_iter().map(|item| items[item].clone()).collect()
}

fn place(item: usize, uses: &[Vec<usize>], is_placed: &mut [bool], order: &mut Vec<usize>) {
    if !std::mem::replace(&mut is_placed[item], true) {
        // No shading language allows recursion, so that this ends.
        uses[item].iter().for_each(|&used| place(used, uses, is_placed, order));
        order.push(item);
    }
}

fn uses(item: &Item, index: &HashMap<&str, usize>) -> Vec<usize> {
    let mut found = Vec::new();
    let mut note = |name: &str| {
        if let Some(&item) = index.get(name)
            && !found.contains(&item)
        {
            found.push(item);
        }
    };
    let of_type = |ty: &Type, note: &mut dyn FnMut(&str)| {
        if let Type::Struct(name) = ty {
            note(name);
        }
    };
    match item {
        Item::Constant(_, _, value, _) => expression(value, &mut note),
        Item::Struct(_, members, _) => members.iter().for_each(|(_, ty)| of_type(ty, &mut note)),
        Item::Function(Function { arguments, result, body, .. }) => {
            arguments.iter().for_each(|(_, ty)| of_type(ty, &mut note));
            of_type(result, &mut note);
            body.iter().for_each(|s| statement(s, &mut note));
        }
    }
    found
}

fn statement(of: &Statement, note: &mut dyn FnMut(&str)) {
    match of {
        Statement::Comment(_) | Statement::Break | Statement::Continue => {}
        Statement::Let(_, ty, value) | Statement::Var(_, ty, value) => {
            if let Type::Struct(name) = ty {
                note(name);
            }
            expression(value, note);
        }
        Statement::Assign(place, value) => {
            expression(place, note);
            expression(value, note);
        }
        Statement::If(condition, yes, no) => {
            expression(condition, note);
            yes.iter().chain(no).for_each(|s| statement(s, note));
        }
        Statement::Count(_, from, to, body) => {
            expression(from, note);
            expression(to, note);
            body.iter().for_each(|s| statement(s, note));
        }
        Statement::Loop(body) => body.iter().for_each(|s| statement(s, note)),
        Statement::Return(value) => expression(value, note),
    }
}

fn expression(of: &Expr, note: &mut dyn FnMut(&str)) {
    match of {
        Expr::Name(name) | Expr::Call(name, _) | Expr::Make(Type::Struct(name), _) => note(name),
        _ => {}
    }
    of.parts().into_iter().for_each(|part| expression(part, note));
}
