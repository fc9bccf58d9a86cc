//! `freikugel info`: what a scene is made of.

use super::given::Given;
use super::input::{self, Input};
use super::{Failure, graphics, print};
use freikugel::field::shape::FormulaParam;
use freikugel::field::{
    Contract, Extent, Field, Formula, Limits, Metric, ParamKind, Structure, analyse, explore, extent, find_extent,
};
use freikugel::scene::Scene;
use std::fmt::Write;
use std::path::PathBuf;

/// Show what a scene is made of.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The scene file, or - for standard input; or a model, whose file is called `.vm`.
    #[arg(required_unless_present = "gpu")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    given: Given,
    /// List the graphics processors of this machine, the one that is taken first.
    #[arg(long)]
    gpu: bool,
}

/// How many characters of a formula or another text are shown: those of models can fill many pages.
const LONGEST_TEXT: usize = 200;

/// How many numbers of a list are shown: there may be millions.
const LONGEST_LIST: usize = 24;

/// Prints the scene's objects with their trees, and the sums; or the graphics processors.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.gpu {
        print(&graphics::list()?)?;
    }
    let Some(path) = &arguments.scene else {
        return Ok(());
    };
    match input::read(path, &arguments.given.inputs())? {
        Input::Scene(scene) | Input::Figures(scene) => print(&describe(&scene)),
        Input::Region(region) => print(&describe(&Scene::of(region.field()))),
    }
}

fn describe(scene: &Scene) -> String {
    let mut text = String::new();
    let (mut nodes, mut primitives) = (0, 0);
    for object in &scene.objects {
        let material = object.material.and_then(|id| scene.materials.get(id.0 as usize)).map_or("", |(name, _)| name);
        let _ = writeln!(text, "object {:?}, material {material:?}, {}", object.name, extent_of(&object.shape));
        if let (Some(analysis), _) = analyse(&object.shape) {
            nodes += analysis.nodes;
            primitives += analysis.primitives;
        }
        tree(&object.shape, 1, scene, &mut text);
    }
    let shapes: Vec<Field> = scene.objects.iter().map(|object| object.shape.clone()).collect();
    let operations = Structure::compile(&shapes).map_or(0, |structure| structure.operations());
    let sums = [
        (scene.objects.len(), "object"),
        (nodes, "node"),
        (primitives, "primitive"),
        (operations, "operation"),
        (scene.materials.len(), "material"),
        (scene.lights.len(), "light"),
    ];
    let sums: Vec<String> = sums.into_iter().map(|(number, noun)| count(number, noun)).collect();
    let _ = writeln!(text, "{}", sums.join(", "));
    text
}

/// The box of an object, and whether it had to be looked for.
fn extent_of(field: &Field) -> String {
    match extent(field) {
        Extent::Unbounded => match find_extent(field, &Limits::default()) {
            Extent::Unbounded => boxed(Extent::Unbounded),
            found => format!("{} (found)", boxed(found)),
        },
        known => boxed(known),
    }
}

fn tree(field: &Field, depth: usize, scene: &Scene, text: &mut String) {
    let node = field.node();
    let about = &node.shape.about;
    let _ = write!(text, "{:indent$}{}", "", about.name, indent = 2 * depth);
    for (param, formula) in about_formulas(field) {
        let size = || count(formula.terms().len(), "operation");
        let _ = write!(text, " {}={}", param.name, quoted(formula.text(), size));
    }
    for (index, param) in about.params.iter().enumerate() {
        let _ = write!(text, " {}={}", param.name, written(param.kind, &node.argument(index)));
    }
    if let Some((name, _)) = node.material.and_then(|id| scene.materials.get(id.0 as usize)) {
        let _ = write!(text, " material={name:?}");
    }
    if let Some(analysis) = explore(field, &Limits::default()) {
        let _ = write!(text, "  [{}]", promise(analysis.contract));
    }
    text.push('\n');
    for child in &node.children {
        tree(child, depth + 1, scene, text);
    }
}

/// The formulas of a node that are not what they are if left out.
fn about_formulas(field: &Field) -> impl Iterator<Item = (&'static FormulaParam, &Formula)> {
    let node = field.node();
    let sound = node.formulas.iter().map(|formula| formula.as_ref().ok());
    node.shape.formulas().iter().zip(sound).filter_map(|(param, formula)| {
        formula.filter(|formula| param.default != Some(formula.text())).map(|formula| (param, formula))
    })
}

/// An argument as a scene file has it.
fn written(kind: ParamKind, numbers: &[f64]) -> String {
    let one = |number: &f64| match kind {
        ParamKind::Choice(names) => names[*number as usize].to_owned(),
        ParamKind::Flag => (*number != 0.0).to_string(),
        // Written in degrees, stored in radians: the last digits are the conversion's.
        ParamKind::Angle | ParamKind::Angles => format!("{}", (number.to_degrees() * 1e9).round() / 1e9),
        _ => number.to_string(),
    };
    let rest = match (kind, numbers) {
        (ParamKind::Text, characters) => {
            let character = |code: &f64| char::from_u32(*code as u32).unwrap_or(char::REPLACEMENT_CHARACTER);
            return quoted(&characters.iter().map(character).collect::<String>(), || {
                count(characters.len(), "character")
            });
        }
        (ParamKind::Knots, [name]) => {
            return ParamKind::KNOTS.get(*name as usize).copied().unwrap_or_default().to_owned();
        }
        (ParamKind::Knots, [_, knots @ ..]) => knots,
        _ => numbers,
    };
    let mut text = rest.iter().take(LONGEST_LIST).map(one).collect::<Vec<String>>().join(",");
    if rest.len() > LONGEST_LIST {
        let _ = write!(text, ",... ({} numbers)", rest.len());
    }
    text
}

/// A text as a scene file has it, or what it begins with and its size.
fn quoted(text: &str, size: impl Fn() -> String) -> String {
    match text.char_indices().nth(LONGEST_TEXT) {
        None => format!("{text:?}"),
        Some((end, _)) => format!("{:?}... ({})", &text[..end], size()),
    }
}

/// A count with its noun.
pub(super) fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// What a contract promises, in a few words.
pub(super) fn promise(contract: Contract) -> String {
    let name = |metric| match metric {
        Metric::Exact => "exact",
        Metric::Bound => "bound",
        Metric::Implicit => "implicit",
    };
    let mut text = match (contract.signed, contract.outside == contract.inside) {
        (false, _) => format!("{}, unsigned", name(contract.outside)),
        (true, true) => name(contract.outside).to_owned(),
        (true, false) => format!("{} outside, {} inside", name(contract.outside), name(contract.inside)),
    };
    match contract.lipschitz {
        Some(1.0) => {}
        Some(constant) => {
            let _ = write!(text, ", slope at most {}", brief(constant));
        }
        None => text.push_str(", slope unknown"),
    }
    if let (Some(_), Some(within)) = (contract.lipschitz, contract.within) {
        let _ = write!(text, " within {} to {}", corner(within.min), corner(within.max));
    }
    text
}

fn boxed(extent: Extent) -> String {
    match extent {
        Extent::Empty => "empty".into(),
        Extent::Unbounded => "unbounded".into(),
        Extent::Finite(aabb) => format!("box {} to {}", corner(aabb.min), corner(aabb.max)),
    }
}

/// Four decimals of each coordinate.
fn corner(c: glam::DVec3) -> String {
    format!("({:.4}, {:.4}, {:.4})", c.x, c.y, c.z)
}

/// Four digits of a number, rounded up unless nothing but rounding errors stands behind them.
fn brief(number: f64) -> String {
    let unit = 10f64.powf(number.abs().max(f64::MIN_POSITIVE).log10().floor() - 3.0);
    let rounded = (number / unit * (1.0 - 1e-12)).ceil() * unit;
    if rounded < 1e6 {
        format!("{rounded:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{rounded:.3e}")
    }
}
