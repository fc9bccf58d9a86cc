//! Compiled fields without their numbers.
//!
//! [`Structure::compile`] flattens the union of some fields into a list of coarse operations; [`Structure::bind`] makes a
//! program of it with the fields' own numbers or others. A structure holds no numbers, only where they come from: changing
//! one never changes the structure, with two exceptions: the number of entries in a list, and the axis an axial shape
//! stands along.

use crate::analysis::analyse;
use crate::compile::compile;
use crate::diagnostic::{Diagnostic, Severity};
use crate::field::Field;
use crate::operands::Operands;
use crate::operation::{Code, Region};
use crate::program::{BindError, Part, Program};
use glam::DVec3;
use std::sync::Arc;

/// A compiled union of fields, without its numbers.
#[derive(Clone, Debug)]
pub struct Structure {
    code: Arc<Code>,
    whole: Arc<Part>,
    operands: Arc<Operands>,
    values: Vec<f64>,
    lipschitz: Option<f64>,
    warnings: Vec<Diagnostic>,
}

impl Structure {
    /// Compiles the union of `objects`.
    ///
    /// # Errors
    /// All errors of the fields, and their warnings. A program of no objects is no error; its value is infinite.
    pub fn compile(objects: &[Field]) -> Result<Self, Vec<Diagnostic>> {
        Self::new(objects, true)
    }

    /// The same, but each list is one step, even if it falls into parts of which boxes of space would keep the near ones: for those
    /// who have no such boxes, and would write out each step.
    ///
    /// # Errors
    /// As [`Structure::compile`].
    pub fn compile_undivided(objects: &[Field]) -> Result<Self, Vec<Diagnostic>> {
        Self::new(objects, false)
    }

    fn new(objects: &[Field], divided: bool) -> Result<Self, Vec<Diagnostic>> {
        let (lipschitz, warnings) = lipschitz_of_union(objects)?;
        let (code, steps, values) = compile(objects, divided);
        let whole = Arc::new(Part::new(steps));
        Ok(Self {
            code: Arc::new(code),
            whole,
            operands: Arc::new(Operands::new(objects.to_vec())),
            values,
            lipschitz,
            warnings,
        })
    }

    /// The parts of the surface that shares are told apart for.
    pub fn regions(&self) -> &[Region] {
        &self.code.regions
    }

    /// The numbers of the fields, one slot for each, in the order of a walk through the trees.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// What [`analyse`] warned of.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// How many operations one evaluation takes.
    pub fn operations(&self) -> usize {
        self.whole.listing().ops.len()
    }

    /// A program with these numbers in the slots. Its batches take points relative to `origin`, so that single precision
    /// is spent on what lies near there.
    ///
    /// # Errors
    /// If there are not as many numbers as slots, if they are no sound arguments, or if they need other operations.
    pub fn bind(&self, values: &[f64], origin: DVec3) -> Result<Program, BindError> {
        if values.len() != self.values.len() {
            return Err(BindError::Count { given: values.len(), wanted: self.values.len() });
        }
        if self.code.fixed.iter().any(|&slot| values[slot] != self.values[slot]) {
            return Err(BindError::Structure);
        }
        let (mut lipschitz, mut operands) = (self.lipschitz, Arc::clone(&self.operands));
        if values != self.values {
            let mut rest = values;
            let objects: Vec<Field> =
                self.operands.objects().iter().map(|object| object.with_numbers(&mut rest)).collect();
            lipschitz = lipschitz_of_union(&objects).map_err(BindError::Faults)?.0;
            operands = Arc::new(Operands::new(objects));
        }
        Program::bind(&self.code, &self.whole, operands, values, origin, lipschitz)
    }

    /// The program with the numbers that the fields were written with.
    pub fn program(&self, origin: DVec3) -> Program {
        self.bind(&self.values, origin).expect("the structure was made for these numbers")
    }
}

/// The Lipschitz constant of the union of `objects`, and the warnings about them; or all diagnostics if one is an error.
fn lipschitz_of_union(objects: &[Field]) -> Result<(Option<f64>, Vec<Diagnostic>), Vec<Diagnostic>> {
    let mut diagnostics = Vec::new();
    let mut lipschitz = Some(0.0_f64);
    for object in objects {
        let (analysis, found) = analyse(object);
        diagnostics.extend(found);
        lipschitz = lipschitz.zip(analysis.and_then(|a| a.contract.lipschitz)).map(|(all, own)| all.max(own));
    }
    if diagnostics.iter().any(|d| d.severity == Severity::Error) {
        return Err(diagnostics);
    }
    Ok((lipschitz, diagnostics))
}
