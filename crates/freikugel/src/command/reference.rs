//! The reference of shapes as a page of Markdown, from their descriptors.

use super::help::{Entry, entries};
use super::info::promise;
use freikugel::field::{Arity, Dimension, Field, Kind, Shape, analyse, shapes};
use freikugel::scene::{self, Scene};
use std::fmt::Write;

/// A complete scene file with the example of a shape.
pub(super) fn example_scene(shape: &Shape) -> String {
    let example: Vec<&str> = shape.about.example.lines().map(str::trim).collect();
    // Figures are extruded flat, and show their form from above.
    let camera = if is_primitive(shape, Dimension::Plane) {
        "\"camera\": { \"eye\": [0.6, -2.4, 3.4], \"target\": [0, 0, 0], \"fov\": 34 },\n  "
    } else {
        ""
    };
    format!(
        "{{\n  \"version\": 1,\n  \"picture\": {{ \"width\": 320, \"height\": 240, \"samples\": 16 }},\n  {camera}\
         \"materials\": {{ \"clay\": {{ \"color\": \"#c9996b\" }}, \"gold\": {{ \"color\": \"#d9a441\" }} }},\n  \
         \"objects\": [\n    {{ \"name\": \"{}\", \"material\": \"gold\", \"shape\":\n      {} }}\n  ]\n}}\n",
        shape.about.name,
        example.join("\n        ")
    )
}

/// The title of a group of shapes, a remark on them, and which they are.
type Group = (&'static str, &'static str, fn(&Shape) -> bool);

/// The groups of shapes.
const GROUPS: [Group; 6] = [
    (
        "Plane figures",
        "They lie in the plane of x and y. `extrude` and `revolve` make bodies of them; a scene of nothing but figures is drawn as a \
         slice.",
        |shape| is_primitive(shape, Dimension::Plane),
    ),
    ("Bodies", "Round the origin, unless their parameters say otherwise.", |shape| {
        is_primitive(shape, Dimension::Space) || matches!(shape.kind, Kind::Formula)
    }),
    ("Combinations", "Several shapes become one, from the first to the last.", |shape| {
        matches!(shape.kind, Kind::Combine(_))
    }),
    ("From the plane to space, and back", "A figure becomes a body, or a body a figure.", |shape| {
        matches!(&shape.kind, Kind::Product(_) | Kind::Loft | Kind::PerimeterSweep)
            || matches!(&shape.kind, Kind::Map(table) if table.takes != table.gives)
    }),
    ("Places and maps of space", "They move, turn, bend, fold or repeat what they are given.", |shape| {
        match &shape.kind {
            Kind::Map(table) => table.takes == table.gives,
            Kind::Place(_) | Kind::Copies(_) | Kind::Endless { .. } | Kind::Warp | Kind::Twist => true,
            _ => false,
        }
    }),
    ("Changes of the surface", "They change distances, or what a shape is made of.", |shape| {
        matches!(shape.kind, Kind::Modify(_) | Kind::Paint | Kind::Displace)
    }),
];

fn is_primitive(shape: &Shape, dimension: Dimension) -> bool {
    matches!(&shape.kind, Kind::Primitive(table) if table.dimension == dimension)
}

/// The page.
pub(super) fn markdown() -> String {
    let mut text = String::from(
        "# Shapes\n\nEvery shape, with its parameters, what its values are, and a picture of its example. \
         `freikugel help shapes NAME` shows the same, `freikugel help shapes NAME --scene` prints the example as a scene file. \
         This page is written by `cargo xtask reference` from the descriptors under `crates/field/src/shapes`; \
         [coverage](coverage.md) lists what other systems have and how it is called here.\n\n\
         *exact*: the distance to the surface. *bound*: never more than that distance. Both are safe to march along. \
         *implicit*: right where it is 0 and in its sign. *unsigned*: without an inside. *slope unknown*: marched by its slope in each \
         cell of space. Angles are in degrees.\n",
    );
    for (title, about, belongs) in GROUPS {
        let members = || shapes::ALL.iter().copied().filter(|shape| belongs(shape));
        let _ = write!(text, "\n## {title}\n\n{about}\n\n");
        let names: Vec<String> = members().map(|shape| format!("[{0}](#{0})", shape.about.name)).collect();
        let _ = writeln!(text, "{}", names.join(" · "));
        for shape in members() {
            section(shape, &mut text);
        }
    }
    text
}

fn section(shape: &'static Shape, text: &mut String) {
    let about = &shape.about;
    let name = about.name;
    let _ = write!(text, "\n### {name}\n\n![{name}](../../gallery/reference/{name}.png)\n\n{}\n", about.summary);
    if let Some(promise) = promise_of(shape) {
        let _ = write!(text, "\nValues: {promise}.\n");
    }
    let entries = entries(shape);
    if !entries.is_empty() {
        text.push_str("\n| parameter | takes | |\n|---|---|---|\n");
        for Entry { name, takes, about } in entries {
            let _ = writeln!(text, "| `{name}` | {} | {} |", takes.replace('|', "\\|"), about.replace('|', "\\|"));
        }
    }
    if !about.elsewhere.is_empty() {
        let _ = write!(text, "\nKnown elsewhere as: {}.\n", about.elsewhere.join(", "));
    }
    let lines: Vec<&str> = about.example.lines().map(str::trim).collect();
    let _ = write!(text, "\n```json\n{}\n```\n", lines.join("\n  "));
}

/// What the values of a shape's example are, of the shape itself if the example does more with it.
fn promise_of(shape: &'static Shape) -> Option<String> {
    let scene: Scene = scene::read(&example_scene(shape)).scene?;
    let field = find(&scene.objects[0].shape, shape)?;
    let promise = promise(analyse(&field).0?.contract);
    let is_changed = shape.arity() != Arity::None;
    Some(if is_changed { format!("{promise} (of this example)") } else { promise })
}

/// The first node of a kind, from the top.
fn find(field: &Field, shape: &'static Shape) -> Option<Field> {
    let node = field.node();
    if std::ptr::eq(node.shape, shape) {
        return Some(field.clone());
    }
    node.children.iter().find_map(|child| find(child, shape))
}
