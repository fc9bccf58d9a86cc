//! The value of a union of many shapes at single points, by looking only at those that can be the nearest.
//!
//! The shapes hang in a hierarchy of boxes. A heap holds what is still to be looked at, ordered by what its values are at
//! least: the distance to its box. Whoever comes out of the heap and lies farther than the least value so far ends the search
//! (best-first search; Hjaltason and Samet, "Distance Browsing in Spatial Databases", 1999).
//!
//! The field of an exact distance is no smaller than the distance to the box. That of a bound can be; for those, each box of
//! the hierarchy is kept for several levels: a point outside of the box for a level has a value above that level.

use crate::analysis::{analyse, extent_at};
use crate::contract::{Aabb, Extent, Metric};
use crate::diagnostic::{Diagnostic, Severity};
use crate::field::Field;
use crate::program::Program;
use crate::shape::Kind;
use crate::structure::Structure;
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Levels for which boxes of bounds are kept, each half of the next one. The largest is the size of everything.
const LEVELS: usize = 12;

/// What a distance to a box is lowered by, relative to the distance and to the size of everything: more than the rounding
/// errors of values, so that no shape is left out that might have the least value by a rounding error.
const SLACK: f64 = 1e-9;

/// A union prepared for queries at points.
#[derive(Debug)]
pub struct Nearest {
    shapes: Vec<Program>,
    /// Shapes without a box, which are always looked at.
    free: Vec<usize>,
    nodes: Vec<Node>,
    /// The boxes for the levels, of all nodes that need them.
    boxes: Vec<[Aabb; LEVELS]>,
    levels: [f64; LEVELS],
    slack: f64,
}

/// What a query found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestHit {
    /// The value of the union.
    pub value: f64,
    /// Which shape has that value, in the order in which they were given, unions taken apart.
    pub shape: usize,
    /// How many shapes were evaluated.
    pub evaluations: usize,
}

#[derive(Debug)]
struct Node {
    aabb: Aabb,
    /// Where its boxes for levels are, if the distance to its box is not a lower bound.
    levels: Option<u32>,
    kind: NodeKind,
}

#[derive(Clone, Copy, Debug)]
enum NodeKind {
    Shape(u32),
    Pair(u32, u32),
}

/// A shape with its boxes, while the hierarchy is built.
struct Leaf {
    shape: usize,
    aabb: Aabb,
    levels: Option<Box<[Aabb; LEVELS]>>,
}

impl Nearest {
    /// Prepares the union of `fields`. Unions among them are taken apart.
    ///
    /// # Errors
    /// All errors of the fields.
    pub fn new(fields: &[Field]) -> Result<Self, Vec<Diagnostic>> {
        let mut shapes = Vec::new();
        fields.iter().for_each(|field| take_apart(field, &mut shapes));
        let mut faults = Vec::new();
        let mut known = Vec::with_capacity(shapes.len());
        for shape in &shapes {
            let (analysis, diagnostics) = analyse(shape);
            faults.extend(diagnostics.into_iter().filter(|d| d.severity == Severity::Error));
            known.extend(analysis);
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let all = known.iter().filter_map(|analysis| match analysis.extent {
            Extent::Finite(aabb) => Some(aabb),
            _ => None,
        });
        let all = all.reduce(Aabb::hull).unwrap_or(Aabb { min: DVec3::ZERO, max: DVec3::ZERO });
        let size = all.size().length();
        let mut nearest = Self {
            shapes: Vec::with_capacity(shapes.len()),
            free: Vec::new(),
            nodes: Vec::new(),
            boxes: Vec::new(),
            levels: std::array::from_fn(|k| size * 0.5_f64.powi((LEVELS - 1 - k) as i32)),
            slack: SLACK * (size + all.min.abs().max(all.max.abs()).max_element()),
        };
        let mut leaves = Vec::with_capacity(shapes.len());
        for (index, (shape, analysis)) in shapes.iter().zip(known).enumerate() {
            nearest.shapes.push(Structure::compile(std::slice::from_ref(shape))?.program(DVec3::ZERO));
            let leaf = match analysis.extent {
                // What is empty may still have the least value, as an intersection far from both operands.
                Extent::Finite(aabb) => nearest.leaf(index, shape, aabb, analysis.contract.outside),
                Extent::Empty | Extent::Unbounded => None,
            };
            match leaf {
                Some(leaf) => leaves.push(leaf),
                None => nearest.free.push(index),
            }
        }
        if !leaves.is_empty() {
            nearest.build(&mut leaves);
        }
        Ok(nearest)
    }

    /// The value of the union at a point, in `f64`: the same number as that of a program of all shapes. Infinite if there
    /// are none.
    pub fn value(&self, p: DVec3) -> f64 {
        self.find(p).map_or(f64::INFINITY, |hit| hit.value)
    }

    /// The shape with the least value at a point; nothing if there are no shapes.
    pub fn find(&self, p: DVec3) -> Option<NearestHit> {
        self.find_after(p, None, &mut BinaryHeap::new())
    }

    /// The values at many points. Points near each other one after another take fewer evaluations, since the nearest shape of
    /// one is a good guess for the next.
    ///
    /// # Panics
    /// If `out` has not as many places as there are points.
    pub fn values(&self, points: &[DVec3], out: &mut [f64]) {
        assert_eq!(points.len(), out.len(), "one place for each point");
        let mut heap = BinaryHeap::new();
        let mut guess = None;
        for (&p, out) in points.iter().zip(out) {
            let hit = self.find_after(p, guess, &mut heap);
            guess = hit.map(|hit| hit.shape);
            *out = hit.map_or(f64::INFINITY, |hit| hit.value);
        }
    }

    /// How many shapes there are.
    pub fn count(&self) -> usize {
        self.shapes.len()
    }

    fn find_after(&self, p: DVec3, guess: Option<usize>, heap: &mut BinaryHeap<Waiting>) -> Option<NearestHit> {
        let mut best: Option<NearestHit> = None;
        let mut evaluations = 0;
        let mut look = |shape: usize, best: &mut Option<NearestHit>| {
            evaluations += 1;
            let value = self.shapes[shape].value(p);
            match best {
                Some(hit) if hit.value <= value => hit.evaluations = evaluations,
                _ => *best = Some(NearestHit { value, shape, evaluations }),
            }
        };
        self.free.iter().chain(&guess).for_each(|&shape| look(shape, &mut best));
        heap.clear();
        if !self.nodes.is_empty() {
            heap.push(Waiting { least: self.least(0, p), node: 0 });
        }
        while let Some(Waiting { least, node }) = heap.pop() {
            if best.is_some_and(|hit| least > hit.value) {
                break;
            }
            match self.nodes[node as usize].kind {
                NodeKind::Shape(shape) if Some(shape as usize) == guess => {}
                NodeKind::Shape(shape) => look(shape as usize, &mut best),
                NodeKind::Pair(a, b) => {
                    for node in [a, b] {
                        let least = self.least(node, p);
                        if best.is_none_or(|hit| least <= hit.value) {
                            heap.push(Waiting { least, node });
                        }
                    }
                }
            }
        }
        best
    }

    /// What the values of all shapes in a node are at least.
    fn least(&self, node: u32, p: DVec3) -> f64 {
        let node = &self.nodes[node as usize];
        let Some(levels) = node.levels else {
            let distance = p.distance(p.clamp(node.aabb.min, node.aabb.max));
            // Inside of its box a shape may have any value.
            return if distance > 0.0 { distance * (1.0 - SLACK) - self.slack } else { f64::NEG_INFINITY };
        };
        let is_outside = |aabb: &Aabb| p.cmplt(aabb.min - self.slack).any() || p.cmpgt(aabb.max + self.slack).any();
        if !is_outside(&node.aabb) {
            return f64::NEG_INFINITY;
        }
        let passed = self.boxes[levels as usize].iter().take_while(|aabb| is_outside(aabb)).count();
        let level = if passed > 0 { self.levels[passed - 1] } else { 0.0 };
        level * (1.0 - SLACK) - self.slack
    }

    fn leaf(&self, shape: usize, field: &Field, aabb: Aabb, outside: Metric) -> Option<Leaf> {
        if outside == Metric::Exact {
            return Some(Leaf { shape, aabb, levels: None });
        }
        let mut boxes = [aabb; LEVELS];
        for (level, place) in self.levels.into_iter().zip(&mut boxes) {
            match extent_at(field, level) {
                Extent::Finite(aabb) => *place = aabb,
                Extent::Empty | Extent::Unbounded => return None,
            }
        }
        Some(Leaf { shape, aabb, levels: Some(Box::new(boxes)) })
    }

    /// Builds the node of some shapes, halving them along the longest side of their middles' box, and returns its place.
    fn build(&mut self, leaves: &mut [Leaf]) -> u32 {
        let place = self.nodes.len() as u32;
        let aabb = leaves.iter().map(|leaf| leaf.aabb).reduce(Aabb::hull).expect("there are leaves");
        let levels = leaves.iter().any(|leaf| leaf.levels.is_some()).then(|| {
            self.boxes.push(std::array::from_fn(|k| {
                let at_level = |leaf: &Leaf| match &leaf.levels {
                    Some(boxes) => boxes[k],
                    None => Aabb { min: leaf.aabb.min - self.levels[k], max: leaf.aabb.max + self.levels[k] },
                };
                leaves.iter().map(at_level).reduce(Aabb::hull).expect("there are leaves")
            }));
            self.boxes.len() as u32 - 1
        });
        let shape = NodeKind::Shape(leaves[0].shape as u32);
        self.nodes.push(Node { aabb, levels, kind: shape });
        if leaves.len() > 1 {
            let middles = leaves.iter().map(|leaf| leaf.aabb.center()).map(|middle| Aabb { min: middle, max: middle });
            let size = middles.reduce(Aabb::hull).expect("there are leaves").size();
            let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
            let half = leaves.len() / 2;
            leaves.select_nth_unstable_by(half, |a, b| a.aabb.center()[axis].total_cmp(&b.aabb.center()[axis]));
            let (first, second) = leaves.split_at_mut(half);
            let (first, second) = (self.build(first), self.build(second));
            self.nodes[place as usize].kind = NodeKind::Pair(first, second);
        }
        place
    }
}

/// Collects the shapes of which a field is the union.
fn take_apart(field: &Field, shapes: &mut Vec<Field>) {
    match &field.node().shape.kind {
        Kind::Combine(table) if table.is_minimum && !field.node().children.is_empty() => {
            field.node().children.iter().for_each(|child| take_apart(child, shapes));
        }
        _ => shapes.push(field.clone()),
    }
}

/// A node that is still to be looked at; the one with the least lower bound comes first.
struct Waiting {
    least: f64,
    node: u32,
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        other.least.total_cmp(&self.least).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}
