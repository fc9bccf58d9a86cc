//! `freikugel help`: the commands, and the shapes from their descriptors.

use super::{Failure, print, reference};
use clap::CommandFactory;
use freikugel::field::{Arity, Kind, Param, ParamKind, Shape, shapes};
use std::fmt::Write;

/// Explain a command, or the shapes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A command, or `shapes` and perhaps the name of one.
    topic: Vec<String>,
    /// Print the example of a shape as a scene file.
    #[arg(long)]
    scene: bool,
    /// Print the reference of all shapes as a page of Markdown.
    #[arg(long, conflicts_with = "scene")]
    markdown: bool,
}

/// Prints the explanation.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let topic: Vec<&str> = arguments.topic.iter().map(String::as_str).collect();
    match topic[..] {
        ["shapes"] if arguments.markdown => print(&reference::markdown()),
        _ if arguments.markdown => Err(Failure::Usage("--markdown goes with `help shapes`".into())),
        ref other if arguments.scene && !matches!(other, ["shapes", _]) => {
            Err(Failure::Usage("--scene goes with `help shapes NAME`".into()))
        }
        [] => print(&super::Arguments::command().render_help().to_string()),
        ["shapes"] => print(&list()),
        ["shapes", name] => {
            let shape = shapes::ALL.iter().find(|shape| shape.about.name == name);
            let shape = shape.ok_or_else(|| {
                Failure::Usage(format!("there is no shape {name:?}; `freikugel help shapes` lists them"))
            })?;
            print(&if arguments.scene { reference::example_scene(shape) } else { describe(shape) })
        }
        [name] => {
            let mut command = super::Arguments::command();
            command.build();
            match command.find_subcommand_mut(name) {
                Some(command) => print(&command.render_long_help().to_string()),
                None => Err(Failure::Usage(format!("there is no command {name:?}; `freikugel help` lists them"))),
            }
        }
        _ => Err(Failure::Usage("give one command, or `shapes` and a name".into())),
    }
}

fn list() -> String {
    let mut text = String::new();
    let kinds = [(Arity::None, "Primitives"), (Arity::Many, "Combinations"), (Arity::One, "Changes")];
    for (arity, title) in kinds {
        let _ = writeln!(text, "{title}:");
        for shape in shapes::ALL.iter().filter(|shape| shape.arity() == arity) {
            let _ = writeln!(text, "  {:24} {}", shape.about.name, shape.about.summary);
        }
        text.push('\n');
    }
    text
}

fn describe(shape: &Shape) -> String {
    let about = &shape.about;
    let mut text = format!("{}: {}\n\n", about.name, about.summary);
    for Entry { name, takes, about } in entries(shape) {
        let _ = writeln!(text, "  {name:16} {about}\n  {:16} ({takes})", "");
    }
    if matches!(shape.kind, Kind::Formula) {
        text.push_str("  The formula may stand alone as a text.\n");
    }
    if !about.elsewhere.is_empty() {
        let _ = writeln!(text, "\nKnown elsewhere as: {}", about.elsewhere.join(", "));
    }
    text.push_str("\nExample:\n");
    for (number, line) in about.example.lines().enumerate() {
        let _ = writeln!(text, "{:indent$}{}", "", line.trim(), indent = if number == 0 { 2 } else { 4 });
    }
    text
}

/// Something that a call of a shape holds.
pub(super) struct Entry {
    /// Its key in scene files.
    pub(super) name: &'static str,
    /// What it takes, and what it is if left out.
    pub(super) takes: String,
    /// What it means.
    pub(super) about: &'static str,
}

/// All that a call of a shape holds.
pub(super) fn entries(shape: &Shape) -> Vec<Entry> {
    let mut entries: Vec<Entry> = shape
        .about
        .params
        .iter()
        .map(|param| {
            let (takes, default) = values(param);
            Entry { name: param.name, takes: format!("{takes}; {default}"), about: param.about }
        })
        .collect();
    entries.extend(shape.formulas().iter().map(|param| {
        let default = param.default.map_or("required".to_owned(), |text| format!("{text} if left out"));
        Entry { name: param.name, takes: format!("a formula in x, y and z; {default}"), about: param.about }
    }));
    entries.extend(shape.file.map(|file| Entry {
        name: file.name,
        takes: "{ \"file\": NAME }; may be left out".into(),
        about: file.about,
    }));
    let mut required = |name, takes: &str, about| {
        entries.push(Entry { name, takes: format!("{takes}; required"), about });
    };
    if matches!(shape.kind, Kind::Paint) {
        required(
            "material",
            "the name of a material",
            "What the shape is made of, where nothing within it says otherwise.",
        );
    }
    // As a list alone they leave no room for anything else.
    let may_be_alone = shape.about.params.iter().all(|param| param.default.is_some());
    match shape.arity() {
        Arity::None => {}
        Arity::One => required("shape", "a shape", "The shape that is changed."),
        Arity::Many if may_be_alone => {
            required("shapes", "a list of shapes", "One or more shapes, in order; they may stand alone as a list.");
        }
        Arity::Many => required("shapes", "a list of shapes", "One or more shapes, in order."),
    }
    entries
}

/// What a parameter takes, in a few words, and what it is if left out.
fn values(param: &Param) -> (String, String) {
    let kind = match param.kind {
        ParamKind::Number => "a number".to_owned(),
        ParamKind::Length => "a length, 0 or more".into(),
        ParamKind::Positive => "a length above 0".into(),
        ParamKind::Factor => "a number other than 0".into(),
        ParamKind::Count(least, most) => format!("a whole number from {least} to {most}"),
        ParamKind::Angle => "degrees".into(),
        ParamKind::Choice(names) => format!("one of {}", names.join(", ")),
        ParamKind::Flag => "true or false".into(),
        ParamKind::Vector => "[x, y, z]".into(),
        ParamKind::Direction => "[x, y, z], or an axis such as \"x\" or \"-z\"".into(),
        ParamKind::Size => "[x, y, z], or one number for all three".into(),
        ParamKind::Counts(least, most) => {
            format!("whole numbers [x, y, z] from {least} to {most}, or one for all three")
        }
        ParamKind::Lengths => "[x, y, z], none of them below 0".into(),
        ParamKind::Size2 => "[x, y], or one number for both".into(),
        ParamKind::Factors => "[x, y, z], none of them 0".into(),
        ParamKind::Angles => "[x, y, z] in degrees".into(),
        ParamKind::Matrix => "three rows of three numbers".into(),
        ParamKind::Quaternion => "[x, y, z, w]".into(),
        ParamKind::Quadruple => "[real, i, j, k]".into(),
        ParamKind::Region => "{ \"sphere\": radius } or { \"box\": size }".into(),
        ParamKind::Numbers => "a list of numbers".into(),
        ParamKind::Text => "a text, or { \"file\": NAME }".into(),
        ParamKind::Points2 => "a list of [x, y], or { \"file\": NAME } with a row of numbers for each".into(),
        ParamKind::Points3 => "a list of [x, y, z], or { \"file\": NAME } with a row of numbers for each".into(),
        ParamKind::Balls => {
            "a list of [x, y, z, radius], radii 0 or more, or { \"file\": NAME } with a row of numbers for each".into()
        }
        ParamKind::Weighted => {
            "a list of [x, y, z, weight], weights above 0, or { \"file\": NAME } with a row of numbers for each".into()
        }
        ParamKind::Knots => format!("{}, or a list of numbers", ParamKind::KNOTS.join(", ")),
        ParamKind::Net => "a list of rows, each of them a list of [x, y, z]".into(),
        ParamKind::WeightedNet => "a list of rows, each of them a list of [x, y, z, weight], weights above 0".into(),
        ParamKind::Contours => "a list of [x, y] or [x, y, angle], or a list of such lists".into(),
        ParamKind::HalfSpaces => "a list of [x, y, z, d], or { \"file\": NAME } with a row of numbers for each".into(),
    };
    let default = match (param.default, param.kind) {
        (None, _) => "required".to_owned(),
        (Some(numbers), ParamKind::Choice(names)) => format!("{} if left out", names[numbers[0] as usize]),
        (Some(_), ParamKind::Knots) => format!("{} if left out", ParamKind::KNOTS[0]),
        (Some(_), ParamKind::Region) => "everywhere if left out".to_owned(),
        // Without the noise of the conversion.
        (Some(angle), ParamKind::Angle) => format!("{} if left out", (angle[0].to_degrees() * 1e9).round() / 1e9),
        (Some(numbers), ParamKind::Flag) => format!("{} if left out", numbers[0] != 0.0),
        (Some(numbers), _) => {
            let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
            format!("{} if left out", numbers.join(", "))
        }
    };
    (kind, default)
}
