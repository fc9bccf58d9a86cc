//! `freikugel info`: what a scene is made of.

use super::input::{self, Input};
use super::{Failure, print};
use freikugel::field::{Contract, Extent, Field, Metric, ParamKind, Structure, analyse, extent};
use freikugel::scene::Scene;
use std::fmt::Write;
use std::path::Path;

/// How many characters of a formula are shown: those of models can fill many pages.
const LONGEST_FORMULA: usize = 200;

/// Prints the scene's objects with their trees, and the sums.
pub(super) fn run(path: &Path) -> Result<(), Failure> {
    match input::read(path)? {
        Input::Scene(scene) => print(&describe(&scene)),
        Input::Region(region) => print(&describe(&Scene::of(region.field()))),
    }
}

fn describe(scene: &Scene) -> String {
    let mut text = String::new();
    let (mut nodes, mut primitives) = (0, 0);
    for object in &scene.objects {
        let material = object.material.and_then(|id| scene.materials.get(id.0 as usize)).map_or("", |(name, _)| name);
        let _ = writeln!(text, "object {:?}, material {material:?}, {}", object.name, boxed(extent(&object.shape)));
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

fn tree(field: &Field, depth: usize, scene: &Scene, text: &mut String) {
    let node = field.node();
    let about = &node.shape.about;
    let _ = write!(text, "{:indent$}{}", "", about.name, indent = 2 * depth);
    if let Some(Ok(formula)) = &node.formula {
        let written = formula.text();
        match written.char_indices().nth(LONGEST_FORMULA) {
            None => {
                let _ = write!(text, " f={written:?}");
            }
            Some((end, _)) => {
                let _ = write!(text, " f={:?}... ({} operations)", &written[..end], formula.terms().len());
            }
        }
    }
    for (index, param) in about.params.iter().enumerate() {
        let _ = write!(text, " {}={}", param.name, written(param.kind, &node.argument(index)));
    }
    if let Some((name, _)) = node.material.and_then(|id| scene.materials.get(id.0 as usize)) {
        let _ = write!(text, " material={name:?}");
    }
    if let (Some(analysis), _) = analyse(field) {
        let _ = write!(text, "  [{}]", promise(analysis.contract));
    }
    text.push('\n');
    for child in &node.children {
        tree(child, depth + 1, scene, text);
    }
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
    numbers.iter().map(one).collect::<Vec<String>>().join(",")
}

/// A count with its noun.
fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

fn promise(contract: Contract) -> String {
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
            let _ = write!(text, ", slope at most {constant}");
        }
        None => text.push_str(", slope unknown"),
    }
    text
}

fn boxed(extent: Extent) -> String {
    match extent {
        Extent::Empty => "empty".into(),
        Extent::Unbounded => "unbounded".into(),
        Extent::Finite(aabb) => {
            let corner = |c: glam::DVec3| format!("({:.4}, {:.4}, {:.4})", c.x, c.y, c.z);
            format!("box {} to {}", corner(aabb.min), corner(aabb.max))
        }
    }
}
