//! The value of a union of many shapes at single points, by looking only at those that can be the nearest.
//!
//! The shapes hang in a hierarchy of boxes (`bvh.rs`). A heap holds what is still to be looked at, ordered by what its
//! values are at least. Whoever comes out of the heap and lies farther than the least value so far ends the search
//! (best-first search; Hjaltason and Samet, "Distance Browsing in Spatial Databases", 1999).

use crate::analysis::{analyse, copies};
use crate::bvh::{Bvh, Waiting};
use crate::diagnostic::{Diagnostic, Severity};
use crate::field::Field;
use crate::program::Program;
use crate::shape::Kind;
use crate::structure::Structure;
use glam::DVec3;

/// A union prepared for queries at points.
#[derive(Debug)]
pub struct Nearest {
    shapes: Vec<Program>,
    tree: Bvh,
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

impl Nearest {
    /// Prepares the union of `fields`. Unions among them are taken apart, and copies that are moved and never turned.
    ///
    /// # Errors
    /// All errors of the fields.
    pub fn new(fields: &[Field]) -> Result<Self, Vec<Diagnostic>> {
        let mut parts = Vec::new();
        fields.iter().for_each(|field| take_apart(field, &mut parts));
        let (mut shapes, mut known, mut faults) = (Vec::new(), Vec::new(), Vec::new());
        for part in parts {
            let (analysis, diagnostics) = analyse(&part);
            faults.extend(diagnostics.into_iter().filter(|d| d.severity == Severity::Error));
            let Some(analysis) = analysis else { continue };
            match moved_copies(&part) {
                Some(copies) => {
                    known.extend(copies.iter().filter_map(|copy| analyse(copy).0));
                    shapes.extend(copies);
                }
                None => {
                    known.push(analysis);
                    shapes.push(part);
                }
            }
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let mut programs = Vec::with_capacity(shapes.len());
        for shape in &shapes {
            programs.push(Structure::compile(std::slice::from_ref(shape))?.program(DVec3::ZERO));
        }
        Ok(Self { tree: Bvh::new(&shapes, &known), shapes: programs })
    }

    /// The value of the union at a point, in `f64`: the same number as that of a program of all shapes. Infinite if there
    /// are none.
    pub fn value(&self, p: DVec3) -> f64 {
        self.find(p).map_or(f64::INFINITY, |hit| hit.value)
    }

    /// The shape with the least value at a point; nothing if there are no shapes.
    pub fn find(&self, p: DVec3) -> Option<NearestHit> {
        self.find_after(p, None, &mut Waiting::new())
    }

    /// The values at many points. Points near each other one after another take fewer evaluations, since the nearest shape of
    /// one is a good guess for the next.
    ///
    /// # Panics
    /// If `out` has not as many places as there are points.
    pub fn values(&self, points: &[DVec3], out: &mut [f64]) {
        assert_eq!(points.len(), out.len(), "one place for each point");
        let mut heap = Waiting::new();
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

    fn find_after(&self, p: DVec3, guess: Option<usize>, waiting: &mut Waiting) -> Option<NearestHit> {
        let mut best: Option<NearestHit> = None;
        let mut evaluations = 0;
        let mut look = |shape: usize| {
            evaluations += 1;
            let value = self.shapes[shape].value(p);
            let hit = match best {
                Some(hit) if hit.value <= value => NearestHit { evaluations, ..hit },
                _ => NearestHit { value, shape, evaluations },
            };
            best = Some(hit);
            hit.value
        };
        let first = self.tree.free().iter().map(|&shape| shape as usize).chain(guess);
        let mut most = first.fold(f64::INFINITY, |_, shape| look(shape));
        self.tree.nearest(p, most, waiting, |shape| {
            if Some(shape as usize) != guess {
                most = look(shape as usize);
            }
            most
        });
        best
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

/// The copies that a sound field is the union of, if they are moved and never turned: these have the same bits by themselves.
fn moved_copies(field: &Field) -> Option<Vec<Field>> {
    match &field.node().shape.kind {
        Kind::Copies(table) if table.are_moved => copies(field),
        _ => None,
    }
}
