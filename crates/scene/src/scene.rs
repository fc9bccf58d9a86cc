//! The scene: everything a picture is made of, as plain data, and the methods that build one in code.

use crate::camera::Camera;
use crate::light::{Light, LightNotation};
use crate::material::Material;
use crate::named::NamedShapesNotation;
use crate::notation::{List, Maybe, Remark};
use crate::object::{MaterialsNotation, Object, ObjectsNotation};
use crate::parameter::{Parameter, ParametersNotation};
use crate::read::VersionNotation;
use crate::record::{Record, RecordNotation, record};
use crate::settings::{Picture, Tracer};
use crate::surroundings::{Ambient, AmbientNotation, Background, BackgroundNotation, Occlusion, OcclusionNotation};
use freikugel_field::{Dimension, Field, MaterialId, analyse};
use std::panic::Location;

record! {
    /// A scene: objects, what they are made of, the light on them, and how the picture is taken.
    #[derive(Clone, Debug)]
    pub struct Scene = "scene" {
        /// Numbers with names, which formulas all over the scene may use.
        pub parameters: Vec<(String, Parameter)> = Vec::new(), optional ParametersNotation;
        /// Where the picture is taken from; if missing, so that all objects are seen, from the front right and above.
        pub camera: Option<Camera> = None, optional Maybe(RecordNotation);
        /// The lights; if missing, three suns that show shapes well.
        pub lights: Vec<Light> = Light::rig(), optional List(LightNotation);
        /// The light from all sides: a colour, or one for the sky and one for the ground.
        pub ambient: Ambient = Ambient::default(), optional AmbientNotation;
        /// How corners keep the ambient light out; `false` if they don't.
        pub occlusion: Option<Occlusion> = Some(Occlusion::default()), optional OcclusionNotation;
        /// What is seen where no object is: a colour, or `{ "gradient": { "top": ..., "bottom": ... } }`.
        pub background: Background = Background::default(), optional BackgroundNotation;
        /// The materials by their names.
        pub materials: Vec<(String, Material)> = Vec::new(), optional MaterialsNotation;
        /// Shapes by their names, which others use: `{ "use": "name" }`.
        pub shapes: Vec<(String, Field)> = Vec::new(), optional NamedShapesNotation;
        /// The objects: shapes with their names and materials.
        pub objects: Vec<Object> = Vec::new(), required ObjectsNotation;
        /// How rays find surfaces, and the limits of that.
        pub tracer: Tracer = Tracer::default(), optional RecordNotation;
        /// The size of the picture and how light becomes colour in it.
        pub picture: Picture = Picture::default(), optional RecordNotation;
    }
    in code {
        /// Where the parts of a scene that was built in code come from.
        pub origins: Origins;
    }
    in files {
        /// The version of the format.
        "version": VersionNotation;
        /// The address of the JSON Schema of scenes, for editors.
        "$schema": Remark;
    }
}

/// Where the parts of a scene that was built in code come from: the calls of the methods that added them.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    pub(crate) camera: Option<&'static Location<'static>>,
    pub(crate) lights: Vec<Option<&'static Location<'static>>>,
    pub(crate) materials: Vec<Option<&'static Location<'static>>>,
    pub(crate) objects: Vec<Option<&'static Location<'static>>>,
}

/// Notes the origin of the part that comes next after `count` others, some of which may have been added without origin.
fn note(origins: &mut Vec<Option<&'static Location<'static>>>, count: usize, location: &'static Location<'static>) {
    origins.resize(count, None);
    origins.push(Some(location));
}

/// Building a scene in code. No step fails; [`Scene::check`] finds what is wrong.
impl Scene {
    /// Whether its objects are plane figures, through which no rays can be traced.
    pub fn is_plane(&self) -> bool {
        let mut analyses = self.objects.iter().filter_map(|object| analyse(&object.shape).0);
        !self.objects.is_empty() && analyses.all(|analysis| analysis.contract.dimension == Dimension::Plane)
    }

    /// Whether another scene looks the same as this one but for where it is seen from. What its numbers were computed from does not matter.
    pub fn differs_only_in_camera(&self, other: &Self) -> bool {
        let rest = |scene: &Self| {
            let mut json = scene.write();
            for key in ["camera", "parameters"] {
                json.as_object_mut().map(|object| object.remove(key));
            }
            json
        };
        self.objects == other.objects && rest(self) == rest(other)
    }

    /// A scene without objects, in the light of [`Light::rig`].
    pub fn new() -> Self {
        Self::default()
    }

    /// A scene of one object.
    ///
    /// ```
    /// use freikugel_field::shapes::*;
    /// use freikugel_scene::Scene;
    ///
    /// let scene = Scene::of(sphere(1.0) - sphere(0.8).at([0, 0, 1]));
    /// assert!(scene.check().is_empty());
    /// ```
    #[track_caller]
    pub fn of(shape: impl Into<Field>) -> Self {
        let mut scene = Self::new();
        scene.add("object", shape);
        scene
    }

    /// Adds a material, and gives the handle to paint shapes with.
    #[track_caller]
    pub fn material(&mut self, name: impl Into<String>, material: Material) -> MaterialId {
        note(&mut self.origins.materials, self.materials.len(), Location::caller());
        self.materials.push((name.into(), material));
        MaterialId(u32::try_from(self.materials.len() - 1).unwrap_or(u32::MAX))
    }

    /// Adds an object.
    #[track_caller]
    pub fn add(&mut self, name: impl Into<String>, shape: impl Into<Field>) -> &mut Self {
        note(&mut self.origins.objects, self.objects.len(), Location::caller());
        self.objects.push(Object { name: name.into(), material: None, shape: shape.into() });
        self
    }

    /// Adds a light. The first one takes the place of the lights that a new scene has.
    #[track_caller]
    pub fn light(&mut self, light: impl Into<Light>) -> &mut Self {
        if self.origins.lights.is_empty() && self.lights == Light::rig() {
            self.lights.clear();
        }
        note(&mut self.origins.lights, self.lights.len(), Location::caller());
        self.lights.push(light.into());
        self
    }

    /// Sets the camera.
    #[track_caller]
    pub fn camera(&mut self, camera: Camera) -> &mut Self {
        self.origins.camera = Some(Location::caller());
        self.camera = Some(camera);
        self
    }
}
