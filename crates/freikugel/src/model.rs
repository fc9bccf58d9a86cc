//! Models: expression graphs (`.vm`) that are rendered as they are, without a scene around them.
//!
//! By convention a model lives in the cube from -1 to 1 and is solid where its expression is negative. One that depends on
//! z is a solid, seen in the light of a scene with nothing else in it; one that does not is a region of the plane, seen
//! from above.

use freikugel_field::shapes::Formula as FormulaShape;
use freikugel_field::{Field, Form, Formula, Structure};
use freikugel_render::{Options, Progress, RenderError, Rendered, Section};
use freikugel_scene::color::from_hex;
use freikugel_scene::{Diagnostic, Scene, Severity};
use glam::DVec3;

/// The edge of the cube that models live in.
pub const SIZE: f64 = 2.0;

/// The colour of what lies inside a region, in sRGB.
pub const INSIDE: &str = "#2b2f36";

/// The colour of what lies outside a region, in sRGB.
pub const OUTSIDE: &str = "#f4f1ea";

/// The side of a region's picture in pixels, where nobody says otherwise.
pub const SIDE: u32 = 1024;

/// The coordinate that makes a model a solid.
const Z: usize = 2;

/// A model, by its dimension.
#[derive(Clone, Debug)]
pub enum Model {
    /// A solid, cut to the cube, alone in a scene.
    Solid(Box<Scene>),
    /// A region of the plane.
    Region(Region),
}

/// A region of the plane.
#[derive(Clone, Debug)]
pub struct Region(Formula);

/// Reads an expression graph, see [`Formula::from_vm`].
///
/// # Errors
/// The first mistake in it, with its place.
pub fn read(text: &str) -> Result<Model, Diagnostic> {
    // Some editors begin a file with a byte order mark, which is no part of it.
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let shift = text.len() - body.len();
    let formula = Formula::from_vm(body).map_err(|error| Diagnostic {
        severity: Severity::Error,
        message: error.message,
        hint: error.hint,
        span: error.span.start + shift..error.span.end + shift,
    })?;
    Ok(if formula.uses(Z) {
        let solid = Form::<FormulaShape>::from(formula).within_box(DVec3::splat(SIZE));
        Model::Solid(Box::new(Scene::of(solid)))
    } else {
        Model::Region(Region(formula))
    })
}

impl Region {
    /// The expression, negative inside.
    pub fn formula(&self) -> &Formula {
        &self.0
    }

    /// The field of the region, the same at all heights.
    pub fn field(&self) -> Field {
        Form::<FormulaShape>::from(self.0.clone()).into()
    }

    /// What pictures of the region are like if nobody says otherwise.
    pub fn options() -> Options {
        let scene = Scene::new();
        Options { width: SIDE, height: SIDE, ..Options::of(&scene) }
    }

    /// The square from -1 to 1, and as much beside it as a picture of this shape shows: x to the right, y up.
    pub fn section(width: u32, height: u32) -> Section {
        let pixel = SIZE / f64::from(width.min(height));
        Section::from_above(DVec3::ZERO, pixel * f64::from(width), pixel * f64::from(height))
    }

    /// A picture of the region, [`INSIDE`] on [`OUTSIDE`].
    ///
    /// # Errors
    /// If the options can't be followed, or the rendering was cancelled.
    pub fn render(&self, options: &Options, progress: &dyn Progress) -> Result<Rendered, RenderError> {
        let structure = Structure::compile(&[self.field()]).expect("a formula alone has no faults");
        let program = structure.program(DVec3::ZERO);
        let color = |hex: &str| from_hex(hex).expect("the colours are well-formed");
        let colors = [INSIDE, OUTSIDE].map(color);
        Self::section(options.width, options.height).picture(&program, options, colors, progress)
    }
}
