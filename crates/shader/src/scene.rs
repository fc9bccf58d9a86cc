//! From a scene to the functions that only its own shader has: `nearest`, `free_ahead`, `unscaled`, `whole`, `part_gradient`,
//! `surface_at`, and one for each part that is more than a call.

use crate::helpers::{Base, Helpers, Want};
use crate::layout::{Layout, PART_SIZE, REGION_SIZE};
use crate::part::Part;
use crate::tree::{Expr, Function, Item, Operator, Statement, Type};
use std::collections::HashMap;

/// A part that takes more simple operations than this is passed over by its box, which takes about ten.
const CHEAP: usize = 40;

/// For each part the number of its form, in the order in which forms appear.
pub(crate) fn kinds(parts: &[Part]) -> Vec<usize> {
    let mut forms: HashMap<String, usize> = HashMap::new();
    let kind = |(index, part): (usize, &Part)| {
        let next = forms.len();
        *forms.entry(part.form(index)).or_insert(next)
    };
    parts.iter().enumerate().map(kind).collect()
}

/// All functions that depend on a scene of few parts. Values, which take all the time, read constants at known places; gradients
/// are written once for each form.
pub(crate) fn items(parts: &[Part], kinds: &[usize], layout: &Layout, mut helpers: Helpers) -> Vec<Item> {
    let names: Vec<String> = parts.iter().map(|part| helpers.names.make(&part.source.name)).collect();
    let mut own = Vec::new();
    let mut values = Vec::new();
    let mut gradients = Vec::new();
    for (part, name) in parts.iter().zip(&names) {
        values.push(one(part, Want::Value, Base::At(part.base), name, &mut helpers, &mut own));
    }
    for ((part, name), &kind) in parts.iter().zip(&names).zip(kinds) {
        if kind == gradients.len() {
            let base = part.shared_base();
            gradients.push(one(part, Want::Gradient, base, name, &mut helpers, &mut own));
        }
    }
    let surfaces = surface_at(surfaces(parts, &names, layout, &mut helpers, &mut own));
    let has_steps = parts.iter().any(|part| !part.is_measured);
    let nearest = nearest(parts, &names, &values, layout);
    let unscaled = unscaled(parts, &names, &values, layout, has_steps);
    let free_ahead = free_ahead(parts, &names, &values, &gradients, kinds, layout);
    let last = [
        nearest,
        free_ahead,
        unscaled,
        whole(layout.plane_count),
        part_gradient(&gradients),
        whole_gradient(),
        surfaces,
    ];
    helpers.functions.into_iter().chain(own).chain(last).map(Item::Function).collect()
}

/// What computes a part: the expression itself if it is but a call, otherwise a call of a function for it.
pub(crate) fn one(
    part: &Part,
    want: Want,
    base: Base,
    name: &str,
    helpers: &mut Helpers,
    own: &mut Vec<Function>,
) -> Expr {
    let before = helpers.functions.len();
    let (mut body, result) = part.value(want, base, name, helpers);
    if body.is_empty() {
        return result;
    }
    // Formulas come with the part that they belong to.
    let formulas: Vec<Function> = {
        let belongs = |function: &Function| function.name.starts_with(&format!("{name}_"));
        let (formulas, others) = helpers.functions.split_off(before).into_iter().partition(belongs);
        helpers.functions.extend::<Vec<Function>>(others);
        formulas
    };
    own.extend(formulas);
    body.push(Statement::Return(result));
    let (name, result) = match want {
        Want::Value => (name.to_owned(), Type::Float),
        Want::Gradient => (helpers.names.make(&format!("{name}_gradient")), Type::Vector(4)),
    };
    let comment = match want {
        Want::Value if matches!(base, Base::First) => {
            vec![format!("The distance from {:?}, or another part of its form.", part.source.name)]
        }
        Want::Value => vec![format!("The distance from {:?}.", part.source.name)],
        Want::Gradient => Vec::new(),
    };
    let mut function = of_point(&name, comment, result, body);
    let mut arguments = vec![Expr::name("p")];
    if matches!(base, Base::First) {
        function.arguments.push(("first".into(), Type::Int));
        arguments.push(Expr::name("first"));
    }
    own.push(function);
    Expr::Call(name, arguments)
}

fn of_point(name: &str, comment: Vec<String>, result: Type, body: Vec<Statement>) -> Function {
    Function { name: name.into(), comment, arguments: vec![("p".into(), Type::Vector(3))], result, body }
}

/// A function that finds a value and a part where the value is less than a bound.
fn up_to(name: &str, comment: Vec<String>, body: Vec<Statement>) -> Function {
    let mut function = of_point(name, comment, Type::Vector(2), body);
    function.arguments.push(("most".into(), Type::Float));
    function
}

/// `d = closer(d, value, index)`
fn closer(value: Expr, index: usize) -> Statement {
    closer_of(value, index as f32)
}

fn closer_of(value: Expr, part: f32) -> Statement {
    let d = Expr::name("d");
    Statement::Assign(d.clone(), Expr::call("closer", [d, value, Expr::Float(part)]))
}

fn nothing() -> Statement {
    let far = Expr::vector([Expr::name("most"), Expr::Float(-1.0)]);
    Statement::Var("d".into(), Type::Vector(2), far)
}

fn apart(place: usize) -> Expr {
    Expr::call("apart", [Expr::name("p"), Expr::Int(place as i64)])
}

/// The nearest of all parts, one after another, with statements for each.
fn search(parts: &[Part], layout: &Layout, statement: impl Fn(usize) -> Vec<Statement>) -> Vec<Statement> {
    let is_nearer = |place: usize| Expr::binary(Operator::Less, apart(place), Expr::name("d").member("x"));
    let mut body = vec![nothing()];
    for (index, part) in parts.iter().enumerate() {
        let statements = statement(index);
        if part.cost() > CHEAP && index > 0 {
            let box_place = layout.parts + PART_SIZE * index;
            body.push(Statement::If(is_nearer(box_place), statements, Vec::new()));
        } else {
            body.extend(statements);
        }
    }
    body
}

/// A value under the part's name, and the nearer of it and what is so far. A call needs no second name.
fn tried(value: &Expr, name: &str, index: usize) -> Vec<Statement> {
    match value {
        Expr::Call(own, _) if own == name => vec![closer(value.clone(), index)],
        _ => {
            let name = format!("{name}_here");
            vec![Statement::Let(name.clone(), Type::Float, value.clone()), closer(Expr::Name(name), index)]
        }
    }
}

fn nearest(parts: &[Part], names: &[String], values: &[Expr], layout: &Layout) -> Function {
    let mut body = search(parts, layout, |index| {
        let plain = tried(&values[index], &names[index], index);
        if parts[index].is_measured {
            return plain;
        }
        // A formula has a slope in its box only; outside, the box is what is near, which is no surface.
        let place = layout.parts + PART_SIZE * index;
        let far = format!("{}_apart", names[index]);
        let slow = values[index].clone() * Expr::parameter(place + 6);
        vec![
            Statement::Let(far.clone(), Type::Float, apart(place)),
            Statement::If(
                Expr::binary(Operator::Greater, Expr::name(&*far), Expr::Float(0.0)),
                vec![closer_of(Expr::name(&*far) + Expr::parameter(place + 7), -2.0 - index as f32)],
                vec![closer(slow, index)],
            ),
        ]
    });
    body.push(Statement::Return(Expr::name("d")));
    let comment = vec![
        "How far a ray may go from a point before it meets a marched part, and which one: -2 for the box of the first, -3 for".into(),
        "that of the second, and so on; -1 where that is no less than `most`.".into(),
    ];
    up_to("nearest", comment, body)
}

/// As `nearest`, but along a ray: formulas are looked at by their slopes.
fn free_ahead(
    parts: &[Part],
    names: &[String],
    values: &[Expr],
    gradients: &[Expr],
    kinds: &[usize],
    layout: &Layout,
) -> Function {
    let mut body = vec![Statement::Var("free".into(), Type::Float, Expr::name("FAR"))];
    let free = || Expr::name("free");
    let least = |value: Expr| Statement::Assign(free(), Expr::call("min", [free(), value]));
    let scale = Expr::Parameter(Box::new(Expr::name("SCALE")));
    // Without formulas nobody asks.
    let asked = if parts.iter().all(|part| part.is_measured) { &[] } else { parts };
    for (index, part) in asked.iter().enumerate() {
        let place = layout.parts + PART_SIZE * index;
        if part.is_measured {
            let is_nearer = Expr::binary(Operator::Less, apart(place) * scale.clone(), free());
            let value = least(values[index].clone() * scale.clone());
            body.push(Statement::If(is_nearer, vec![value], Vec::new()));
            continue;
        }
        let far = format!("{}_apart", names[index]);
        let here = format!("{}_here", names[index]);
        let ahead = Expr::call(
            "ahead",
            [
                Expr::name(&*here),
                Expr::name("direction"),
                Expr::parameter(place + 11),
                Expr::parameter(place + 6) * scale.clone(),
            ],
        );
        body.push(Statement::Let(far.clone(), Type::Float, apart(place)));
        body.push(Statement::If(
            Expr::binary(Operator::Greater, Expr::name(&*far), Expr::Float(0.0)),
            vec![least((Expr::name(&*far) + Expr::parameter(place + 7)) * scale.clone())],
            vec![Statement::Let(here, Type::Vector(4), gradients[kinds[index]].clone()), least(ahead)],
        ));
    }
    body.push(Statement::Return(free()));
    let arguments = vec![("p".into(), Type::Vector(3)), ("direction".into(), Type::Vector(3))];
    let comment = vec!["How far a ray may go from a point in a direction.".into()];
    Function { name: "free_ahead".into(), comment, arguments, result: Type::Float, body }
}

/// The union of all marched parts, each by its own value.
fn unscaled(parts: &[Part], names: &[String], values: &[Expr], layout: &Layout, has_steps: bool) -> Function {
    let mut body = Vec::new();
    if has_steps {
        body = search(parts, layout, |index| tried(&values[index], &names[index], index));
        body.push(Statement::Return(Expr::name("d")));
    } else {
        body.push(Statement::Return(Expr::call("nearest", [Expr::name("p"), Expr::name("most")])));
    }
    let comment = vec![
        "The field of all that is marched at a point, and the part that it belongs to; -1 where that is no less than `most`."
            .into(),
    ];
    up_to("unscaled", comment, body)
}

/// The field of all parts and planes.
pub(crate) fn whole(plane_count: usize) -> Function {
    let marched = Expr::call("unscaled", [Expr::name("p"), Expr::name("FAR")]);
    let whole = match plane_count {
        0 => marched,
        _ => Expr::call("nearest_plane", [marched, Expr::name("p")]),
    };
    let comment = vec!["The field of the whole scene at a point, and the part that it belongs to.".into()];
    of_point("whole", comment, Type::Vector(2), vec![Statement::Return(whole)])
}

fn is_part(index: usize) -> Expr {
    Expr::binary(Operator::Equal, Expr::name("part"), Expr::Int(index as i64))
}

pub(crate) fn part_gradient(gradients: &[Expr]) -> Function {
    let number = |place: i64| {
        let at = Expr::name("PARTS") + Expr::name("PART_SIZE") * Expr::name("part") + Expr::Int(place);
        Expr::Make(Type::Int, vec![Expr::Parameter(Box::new(at))])
    };
    let mut body =
        vec![Statement::Let("form".into(), Type::Int, number(8)), Statement::Let("first".into(), Type::Int, number(9))];
    body.extend(gradients.iter().enumerate().map(|(index, gradient)| {
        let is_it = Expr::binary(Operator::Equal, Expr::name("form"), Expr::Int(index as i64));
        Statement::If(is_it, vec![Statement::Return(gradient.clone())], Vec::new())
    }));
    body.push(Statement::Return(Expr::Make(Type::Vector(4), vec![Expr::Float(0.0)])));
    Function {
        name: "part_gradient".into(),
        comment: vec!["The gradient of a part's field at a point, and its value.".into()],
        arguments: vec![("part".into(), Type::Int), ("p".into(), Type::Vector(3))],
        result: Type::Vector(4),
        body,
    }
}

/// The gradient of the whole scene's field.
pub(crate) fn whole_gradient() -> Function {
    let text = "
        // The gradient of the whole scene's field at a point, and its value.
        fn field_gradient(p: vec3<f32>) -> vec4<f32> {
            let d: vec2<f32> = whole(p);
            let part: i32 = i32(d.y);
            if (part < PART_COUNT) {
                return part_gradient(part, p);
            }
            let first: i32 = PLANES + PLANE_SIZE * (part - PART_COUNT);
            let is_turned: bool = parameters[first + 4] > 0.0 && dot(triple(first), p) < parameters[first + 3];
            return vec4<f32>(select(1.0, -1.0, is_turned) * parameters[first + 5] * triple(first), d.x);
        }";
    match crate::parse::parse(text).expect("the text is sound").remove(0) {
        Item::Function(function) => function,
        _ => unreachable!("it is a function"),
    }
}

/// The surface of a part of several regions, each with its share. `region` gives the place of a region.
pub(crate) fn surface_body(
    part: &Part,
    base: Base,
    region: impl Fn(usize) -> Expr,
    name: &str,
    helpers: &mut Helpers,
) -> Vec<Statement> {
    let spot = || Expr::name("spot");
    let (mut statements, shares) = part.shares(base, name, helpers);
    statements.insert(0, Statement::Let("p".into(), Type::Vector(3), spot().member("position")));
    let surface = Expr::name("surface");
    let empty = Expr::call("no_surface", []);
    statements.push(Statement::Var("surface".into(), Type::Struct("Surface".into()), empty));
    for (index, share) in shares.into_iter().enumerate() {
        let sum = Expr::call("with_share", [surface.clone(), share, region(index), spot()]);
        statements.push(Statement::Assign(surface.clone(), sum));
    }
    statements.push(Statement::Return(Expr::call("settled", [surface])));
    statements
}

/// The surfaces of those parts that have several regions, each by a function of its own.
fn surfaces(
    parts: &[Part],
    names: &[String],
    layout: &Layout,
    helpers: &mut Helpers,
    own: &mut Vec<Function>,
) -> Vec<Statement> {
    let mut body = Vec::new();
    for (index, (part, name)) in parts.iter().zip(names).enumerate().filter(|(_, (part, _))| part.regions.len() > 1) {
        let region = |region: usize| Expr::Int((layout.regions + REGION_SIZE * part.regions[region]) as i64);
        let statements = surface_body(part, Base::At(part.base), region, name, helpers);
        let name = helpers.names.make(&format!("{name}_surface"));
        own.push(Function {
            name: name.clone(),
            comment: Vec::new(),
            arguments: vec![("spot".into(), Type::Struct("Spot".into()))],
            result: Type::Struct("Surface".into()),
            body: statements,
        });
        let call = Expr::call(name, [Expr::name("spot")]);
        body.push(Statement::If(is_part(index), vec![Statement::Return(call)], Vec::new()));
    }
    body
}

/// The function of all surfaces: `body` returns those of several regions.
pub(crate) fn surface_at(mut body: Vec<Statement>) -> Function {
    let first = Expr::name("REGIONS") + Expr::name("REGION_SIZE") * Expr::name("part");
    let only = Expr::call("with_share", [Expr::call("no_surface", []), Expr::Float(1.0), first, Expr::name("spot")]);
    body.push(Statement::Return(only));
    Function {
        name: "surface_at".into(),
        comment: vec!["What a part or a plane looks like at a point of its surface.".into()],
        arguments: vec![("part".into(), Type::Int), ("spot".into(), Type::Struct("Spot".into()))],
        result: Type::Struct("Surface".into()),
        body,
    }
}
