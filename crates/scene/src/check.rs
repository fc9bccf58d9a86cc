//! Checking scenes that were built in code.
//!
//! A document is checked as it is read, where each mistake has its place in the text; this finds the same mistakes in a
//! scene that has no text, by the same declarations.

use crate::diagnostic::Severity;
use crate::record::{Fault, Record};
use crate::scene::Scene;
use crate::suggest::quote;
use freikugel_field::{Diagnostic, Field, Origin, analyse_together};
use std::collections::HashSet;
use std::panic::Location;

impl Scene {
    /// What is wrong with the scene: nothing, if it was read from a file without errors.
    ///
    /// Each diagnostic names the line of code that added the faulty part; for a part that was put into the scene's fields
    /// directly, the line of this call.
    ///
    /// ```
    /// use freikugel_field::shapes::*;
    /// use freikugel_scene::{Camera, Scene};
    ///
    /// let mut scene = Scene::new();
    /// scene.add("ball", sphere(-1)).camera(Camera::look([4, -6, 3], [0, 0, 0]).fov(400));
    /// let mistakes = scene.check();
    /// assert_eq!(mistakes.len(), 2);
    /// assert!(mistakes[0].to_string().contains("must be below 180 degrees, but is 400"));
    /// ```
    #[track_caller]
    pub fn check(&self) -> Vec<Diagnostic> {
        let mut check = Check { diagnostics: Vec::new(), here: Location::caller() };
        check.surroundings(self);
        check.materials(self);
        check.objects(self);
        check.diagnostics
    }
}

struct Check {
    diagnostics: Vec<Diagnostic>,
    /// The place of parts without origin.
    here: &'static Location<'static>,
}

impl Check {
    fn error(&mut self, at: Option<&'static Location<'static>>, message: String) {
        let origin = Origin::Code(at.unwrap_or(self.here));
        self.diagnostics.push(Diagnostic { severity: Severity::Error, message, hint: None, origin, param: None });
    }

    fn faults(&mut self, at: Option<&'static Location<'static>>, what: &str, faults: Vec<Fault>) {
        let origin = Origin::Code(at.unwrap_or(self.here));
        self.diagnostics.extend(faults.into_iter().map(|fault| Diagnostic {
            severity: fault.severity,
            message: format!("{what}: {}", fault.message),
            hint: fault.hint,
            origin,
            param: None,
        }));
    }

    fn surroundings(&mut self, scene: &Scene) {
        // The record's own faults are those of parts that are no records: the background, for one.
        self.faults(None, "scene", scene.faults());
        if let Some(camera) = &scene.camera {
            self.faults(scene.origins.camera, "camera", camera.faults());
        }
        for (index, light) in scene.lights.iter().enumerate() {
            let at = scene.origins.lights.get(index).copied().flatten();
            self.faults(at, &format!("light {}", index + 1), light.faults());
        }
        self.faults(None, "ambient", scene.ambient.faults());
        if let Some(occlusion) = &scene.occlusion {
            self.faults(None, "occlusion", occlusion.faults());
        }
        self.faults(None, "tracer", scene.tracer.faults());
        self.faults(None, "picture", scene.picture.faults());
    }

    fn materials(&mut self, scene: &Scene) {
        let mut names = HashSet::new();
        for (index, (name, material)) in scene.materials.iter().enumerate() {
            let at = scene.origins.materials.get(index).copied().flatten();
            if name.is_empty() {
                self.error(at, "the name of a material must not be empty".into());
            }
            if !names.insert(name) {
                self.error(at, format!("another material is called {} already", quote(name)));
            }
            self.faults(at, &format!("material {}", quote(name)), material.faults());
        }
    }

    fn objects(&mut self, scene: &Scene) {
        if scene.objects.is_empty() {
            self.error(None, "the scene has no objects".into());
        }
        let mut names = HashSet::new();
        let shapes: Vec<Field> = scene.objects.iter().map(|object| object.shape.clone()).collect();
        let analyses = analyse_together(&shapes);
        for (index, (object, (analysis, faults))) in scene.objects.iter().zip(analyses).enumerate() {
            let at = scene.origins.objects.get(index).copied().flatten();
            if !names.insert(&object.name) {
                self.error(at, format!("another object is called {} already", quote(&object.name)));
            }
            self.faults(at, &format!("object {}", quote(&object.name)), object.faults());
            self.diagnostics.extend(faults);
            let is_foreign = object.material.is_some_and(|id| id.0 as usize >= scene.materials.len());
            // Without an analysis the tree may be too deep to walk through.
            if is_foreign || analysis.is_some() && is_painted_beyond(&object.shape, scene.materials.len()) {
                self.error(at, format!("object {} has a material of another scene", quote(&object.name)));
            }
        }
    }
}

/// Whether a field is painted with a material that a table of `count` materials does not have.
fn is_painted_beyond(field: &Field, count: usize) -> bool {
    let node = field.node();
    node.material.is_some_and(|id| id.0 as usize >= count)
        || node.children.iter().any(|child| is_painted_beyond(child, count))
}
