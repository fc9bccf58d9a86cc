//! The operands of a long union: what is known of each, and which of them can matter in a box.

use crate::analysis::{Analysis, analyse, copies};
use crate::bvh::{Bvh, Waiting};
use crate::compile::{can_fold, is_rigid};
use crate::contract::Aabb;
use crate::field::{Field, Node};
use crate::program::Program;
use crate::shape::Kind;
use crate::spine::Spine;
use std::sync::OnceLock;

/// Unions of no more operands are surveyed as a whole: that takes no longer than to look for those that matter.
pub(crate) const CROWD: usize = 128;

/// Rounding errors of values in single precision, relative to the largest coordinates: those of three coordinates, and those
/// that bounds of values are widened by when boxes are surveyed, twice over.
const ROUNDING: f64 = 2.0 * 3.0 * 16.0 * f32::EPSILON as f64;

/// The fields of a program, and what is known of the operands of their union.
#[derive(Debug)]
pub(crate) struct Operands {
    objects: Vec<Field>,
    known: OnceLock<Option<Known>>,
}

/// What is known of the operands.
#[derive(Debug)]
pub(crate) struct Known {
    tree: Bvh,
    /// The largest slope of each; infinite if that is not known.
    slopes: Vec<f64>,
}

impl Operands {
    pub(crate) fn new(objects: Vec<Field>) -> Self {
        Self { objects, known: OnceLock::new() }
    }

    /// The fields.
    pub(crate) fn objects(&self) -> &[Field] {
        &self.objects
    }

    /// What is known of the operands of a crowd, in their order in `spine`.
    fn known(&self, spine: &Spine) -> Option<&Known> {
        let find = || {
            let mut fields = Vec::new();
            for (index, object) in self.objects.iter().enumerate() {
                take_apart(object, &mut Vec::new(), index == 0, &mut fields);
            }
            if fields.len() != spine.entries().len() {
                return None;
            }
            let known: Option<Vec<Analysis>> = fields.iter().map(|field| analyse(field).0).collect();
            let known = known?;
            let slope = |analysis: &Analysis| match (analysis.contract.lipschitz, analysis.contract.within) {
                (Some(slope), None) => slope,
                _ => f64::INFINITY,
            };
            Some(Known { slopes: known.iter().map(slope).collect(), tree: Bvh::new(&fields, &known) })
        };
        self.known.get_or_init(find).as_ref()
    }
}

/// The operands of a program that is a union of many.
pub(crate) struct Crowd<'p> {
    program: &'p Program,
    spine: &'p Spine,
    known: &'p Known,
}

/// What the search in a crowd works with.
#[derive(Default)]
pub(crate) struct Search {
    waiting: Waiting,
    /// The operands found, in their order.
    pub(crate) found: Vec<u32>,
}

impl<'p> Crowd<'p> {
    /// The operands of a program, if there are many.
    pub(crate) fn of(program: &'p Program) -> Option<Self> {
        let spine = program.whole.spine().filter(|spine| spine.entries().len() > CROWD)?;
        Some(Self { program, spine, known: program.operands().known(spine)? })
    }

    /// The chain of the operands.
    pub(crate) fn spine(&self) -> &'p Spine {
        self.spine
    }

    /// What all values in a box, in the coordinates of the world, are at least.
    pub(crate) fn floor(&self, place: Aabb, search: &mut Search) -> f64 {
        self.known.tree.floor(place, &mut search.waiting) - self.rounding(place)
    }

    /// Finds the operands that can be the least somewhere in a box: those that can be as small as the largest value there of
    /// some operand near its middle.
    pub(crate) fn find(&self, place: Aabb, search: &mut Search) {
        let Self { program, spine, known } = self;
        let Search { waiting, found } = search;
        let (middle, radius) = (place.center(), place.size().length() / 2.0);
        let (mut least, mut ceiling) = (f64::INFINITY, f64::INFINITY);
        let mut look = |operand: u32| {
            let entry = spine.entries()[operand as usize];
            let value = program.value_of(entry.own(), entry.operand(), middle);
            let most = value + known.slopes[operand as usize] * radius;
            // What is no number bounds nothing.
            if most < ceiling {
                ceiling = most;
            }
            if value < least {
                least = value;
            }
            least
        };
        let most = known.tree.free().iter().fold(f64::INFINITY, |_, &operand| look(operand));
        known.tree.nearest(middle, most, waiting, look);
        found.clear();
        known.tree.within(place, ceiling + 2.0 * self.rounding(place), found);
        found.sort_unstable();
    }

    /// How far values in a box may be from what they should be.
    fn rounding(&self, place: Aabb) -> f64 {
        let all = self.known.tree.extent().map_or(place, |extent| extent.hull(place));
        let origin = self.program.origin();
        ROUNDING * (all.max - origin).abs().max((all.min - origin).abs()).max_element()
    }
}

/// Collects the operands of the chain of minima that a field is compiled to, each with all that places it. `is_first` says
/// that there is no operand before it.
fn take_apart<'f>(field: &'f Field, places: &mut Vec<&'f Field>, is_first: bool, operands: &mut Vec<Field>) {
    let node = field.node();
    match &node.shape.kind {
        Kind::Combine(table) if table.is_minimum && (is_first || can_fold(node)) => {
            for (index, child) in node.children.iter().enumerate() {
                take_apart(child, places, is_first && index == 0, operands);
            }
        }
        Kind::Copies(_) if is_first || can_fold(node) => {
            for (index, copy) in copies(field).into_iter().flatten().enumerate() {
                let mut copied = Vec::new();
                take_apart(&copy, &mut Vec::new(), is_first && index == 0, &mut copied);
                operands.extend(copied.into_iter().map(|operand| placed(operand, places)));
            }
        }
        Kind::Place(_) | Kind::Paint if is_passed_on(node) && holds_union(&node.children[0]) => {
            places.push(field);
            take_apart(&node.children[0], places, is_first, operands);
            places.pop();
        }
        _ => operands.push(placed(field.clone(), places)),
    }
}

/// A field below some nodes of one child each, the outermost first.
fn placed(field: Field, places: &[&Field]) -> Field {
    places.iter().rev().fold(field, |inner, place| {
        let Node { shape, args, material, origin, .. } = place.node();
        Field::with_origin(shape, args.iter().copied(), [inner], *material, *origin)
    })
}

/// Whether the value of the only child of a node is that of the node.
fn is_passed_on(node: &Node) -> bool {
    matches!(&node.shape.kind, Kind::Paint) || is_rigid(node)
}

/// Whether a field is a union, perhaps painted or moved.
fn holds_union(field: &Field) -> bool {
    let node = field.node();
    match &node.shape.kind {
        Kind::Combine(table) => table.is_minimum,
        Kind::Copies(_) => true,
        Kind::Place(_) | Kind::Paint => is_passed_on(node) && holds_union(&node.children[0]),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::*;
    use crate::structure::Structure;
    use glam::DVec3;

    /// Balls in rows, some of them painted, moved, nested or made of several.
    fn rows() -> Vec<Field> {
        let ball = |x: i32, y: i32| sphere(0.3).at([f64::from(x), f64::from(y), 0.0]);
        (0..20)
            .map(|y| {
                let row: Vec<Field> = (0..10).map(|x| ball(x, y)).collect();
                match y % 5 {
                    0 => union(row),
                    1 => union([union(row).at([0.0, 0.0, 1.0]), ball(20, y)]),
                    2 => union(row).painted(crate::field::MaterialId(1)).at([0.0, 0.0, 2.0]),
                    3 => union(row) - cuboid([1.0, 1.0, 1.0]),
                    _ => ball(3, y),
                }
            })
            .collect()
    }

    #[test]
    fn operands_are_those_of_the_chain() {
        let mut rows = rows();
        for _ in 0..rows.len() {
            // Another one is the first.
            rows.rotate_left(1);
            let program = Structure::compile(&rows).expect("sound").program(DVec3::ZERO);
            let crowd = Crowd::of(&program).expect("there are many operands");
            let mut fields = Vec::new();
            for (index, object) in rows.iter().enumerate() {
                take_apart(object, &mut Vec::new(), index == 0, &mut fields);
            }
            assert_eq!(fields.len(), crowd.spine().entries().len());
            let p = DVec3::new(1.3, 7.2, 0.4);
            for (entry, field) in crowd.spine().entries().iter().zip(&fields) {
                let alone = Structure::compile(std::slice::from_ref(field)).expect("sound").program(DVec3::ZERO);
                assert_eq!(program.value_of(entry.own(), entry.operand(), p), alone.value(p));
            }
        }
    }
}
