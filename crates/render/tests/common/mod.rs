//! What the tests share: small scenes, and a ray tracer of their own for balls and grounds.
//!
//! The reference intersects in closed form, in double precision, one ray at a time, and shades by the formulas as they
//! stand in a textbook. It has nothing in common with the renderer but the scene.

#![allow(dead_code, reason = "each test program uses its own part")]

use freikugel_field::shapes::{Translate, plane, sphere};
use freikugel_field::{Field, MaterialId};
use freikugel_render::{Image, Options, Rendered, render};
use freikugel_scene::{
    Ambient, Background, Camera, Falloff, FovAxis, Light, Material, Model, Object, Pattern, Projection, Scene, Shadow,
    Tracer,
};
use glam::DVec3;

/// A scene with nothing in it: no light, black all around, to be traced as exactly as single precision allows.
pub(crate) fn dark() -> Scene {
    Scene {
        ambient: Ambient { sky: [0.0; 3], ground: [0.0; 3] },
        background: Background::Solid([0.0; 3]),
        occlusion: None,
        lights: Vec::new(),
        objects: Vec::new(),
        tracer: Tracer { precision: 1e-6, ..Tracer::default() },
        ..Scene::default()
    }
}

/// Adds an object of its own material.
pub(crate) fn add(scene: &mut Scene, shape: impl Into<Field>, material: Material) {
    let id = MaterialId(scene.materials.len() as u32);
    scene.materials.push((format!("material {}", id.0), material));
    let name = format!("object {}", scene.objects.len());
    scene.objects.push(Object { name, material: Some(id), shape: shape.into() });
}

/// White, diffuse, nothing else.
pub(crate) fn chalk() -> Material {
    Material { color: Pattern::Solid([1.0; 3]), ambient: 1.0, diffuse: 1.0, specular: 0.0, ..Material::default() }
}

/// A view straight down from the height `z` onto the ground.
pub(crate) fn from_above(z: f64, height: f64) -> Camera {
    Camera {
        eye: DVec3::new(0.0, 0.0, z),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height },
    }
}

/// Small pictures through pixel centres.
pub(crate) fn options(width: u32, height: u32) -> Options {
    Options { width, height, samples: 1, ..Options::default() }
}

/// Renders, all being well.
pub(crate) fn picture(scene: &Scene, options: &Options) -> Rendered {
    let rendered = render(scene, options, &()).expect("a picture");
    let is_sound = |color: &[f32; 3]| color.iter().all(|c| c.is_finite() && *c >= 0.0);
    assert!(rendered.image.pixels().iter().all(is_sound), "every colour is a number");
    rendered
}

/// Balls, and a ground at height 0 if it has a material.
#[derive(Default)]
pub(crate) struct Balls {
    pub(crate) balls: Vec<(DVec3, f64, Material)>,
    pub(crate) ground: Option<Material>,
}

impl Balls {
    /// Puts them into a scene.
    pub(crate) fn add_to(&self, scene: &mut Scene) {
        for (center, radius, material) in &self.balls {
            add(scene, sphere(*radius).at(*center), material.clone());
        }
        if let Some(material) = &self.ground {
            add(scene, plane([0.0, 0.0, 1.0]), material.clone());
        }
    }

    /// Distance, normal and material of what a ray meets first.
    fn hit(&self, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3, &Material)> {
        let mut nearest: Option<(f64, DVec3, &Material)> = None;
        let mut offer = |t: f64, normal: DVec3, material| {
            if t > 1e-9 && nearest.is_none_or(|(best, ..)| t < best) {
                nearest = Some((t, normal, material));
            }
        };
        for (center, radius, material) in &self.balls {
            let away = origin - *center;
            let b = away.dot(direction);
            let root = (b * b - away.length_squared() + radius * radius).sqrt();
            if root >= 0.0 {
                offer(-b - root, (away + direction * (-b - root)) / *radius, material);
            }
        }
        if let Some(material) = &self.ground {
            offer(-origin.z / direction.z, DVec3::Z, material);
        }
        nearest
    }

    /// What a ray sees.
    fn color(&self, scene: &Scene, origin: DVec3, direction: DVec3) -> DVec3 {
        let rgb = |c: [f32; 3]| DVec3::from(c.map(f64::from));
        let Some((t, normal, material)) = self.hit(origin, direction) else {
            return match scene.background {
                Background::Solid(color) => rgb(color),
                Background::Gradient { top, bottom } => rgb(bottom).lerp(rgb(top), 0.5 + 0.5 * direction.z),
            };
        };
        let point = origin + direction * t;
        let color = match material.color {
            Pattern::Solid(color) => rgb(color),
            Pattern::Checker { colors, size } => {
                let cell = ((point + normal * 1e-3 * size) / size).floor();
                rgb(colors[(cell.x + cell.y + cell.z).rem_euclid(2.0) as usize])
            }
        };
        let around = rgb(scene.ambient.ground).lerp(rgb(scene.ambient.sky), 0.5 + 0.5 * normal.z);
        let mut sum = rgb(material.emissive) + color * around * f64::from(material.ambient);
        for light in &scene.lights {
            let (to_light, distance, power, shadow) = arriving(light, point);
            let n_dot_l = normal.dot(to_light);
            let start = point + normal * 1e-7;
            let is_shadowed = shadow != Shadow::None && self.hit(start, to_light).is_some_and(|(t, ..)| t < distance);
            if n_dot_l <= 0.0 || is_shadowed {
                continue;
            }
            let viewer = -direction;
            let cosine = match material.model {
                Model::Phong => (2.0 * n_dot_l * normal - to_light).dot(viewer),
                Model::BlinnPhong => normal.dot((to_light + viewer).normalize()),
            };
            let highlight = cosine.max(0.0).powf(f64::from(material.exponent));
            let body = color * f64::from(material.diffuse) * n_dot_l;
            sum += power * (body + f64::from(material.specular) * highlight);
        }
        sum
    }
}

/// Direction, distance and strength of a light at a point, and its kind of shadow.
fn arriving(light: &Light, point: DVec3) -> (DVec3, f64, DVec3, Shadow) {
    let power = |color: [f32; 3], intensity: f32| DVec3::from(color.map(f64::from)) * f64::from(intensity);
    let fall = |falloff: Falloff, r: f64| match falloff {
        Falloff::None => 1.0,
        Falloff::InverseSquare => r.powi(-2),
        Falloff::Polynomial([a, b, c]) => 1.0 / (f64::from(a) + f64::from(b) * r + f64::from(c) * r * r),
    };
    match light {
        Light::Sun(sun) => (sun.direction.normalize(), f64::INFINITY, power(sun.color, sun.intensity), sun.shadow),
        Light::Point(lamp) => {
            let way = lamp.position - point;
            let r = way.length();
            (way / r, r, power(lamp.color, lamp.intensity) * fall(lamp.falloff, r), lamp.shadow)
        }
        Light::Spot(spot) => {
            let way = spot.position - point;
            let r = way.length();
            let cosine = (-way / r).dot((spot.target - spot.position).normalize());
            let (outer, inner) = (spot.angle / 2.0, spot.angle / 2.0 * (1.0 - spot.softness));
            let x = ((cosine - outer.cos()) / (inner.cos() - outer.cos())).clamp(0.0, 1.0);
            let share = x * x * (3.0 - 2.0 * x);
            (way / r, r, power(spot.color, spot.intensity) * fall(spot.falloff, r) * share, spot.shadow)
        }
    }
}

/// Origin and direction of a camera's ray, from the definition of its field of view.
pub(crate) fn camera_ray(camera: &Camera, (width, height): (u32, u32), (x, y): (f64, f64)) -> (DVec3, DVec3) {
    let (width, height) = (f64::from(width), f64::from(height));
    let forward = (camera.target - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    // Offsets from the middle of the picture in pixels, and the size of a pixel.
    let (dx, dy) = (x - width / 2.0, height / 2.0 - y);
    match camera.projection {
        Projection::Perspective { fov, axis } => {
            let pixels = match axis {
                FovAxis::Vertical => height,
                FovAxis::Horizontal => width,
            };
            let pixel = 2.0 * (fov / 2.0).tan() / pixels;
            (camera.eye, (forward + (right * dx + up * dy) * pixel).normalize())
        }
        Projection::Orthographic { height: world } => {
            let pixel = world / height;
            (camera.eye + (right * dx + up * dy) * pixel, forward)
        }
    }
}

/// Pictures are fine, so that the tolerances that come with the size of pixels stay small, but only each so many-th pixel
/// of each so many-th row is compared.
pub(crate) const STRIDE: u32 = 5;

/// See [`compare`].
const ACCURACY: f64 = 2e-3;

/// A change of colour that makes an edge.
const EDGE: f64 = 0.02;

/// Renders the scene and compares pixels with the reference: their colours must lie between those it has within `reach`
/// pixels, give or take 0.2 % of white or of what is brighter. Pixels are left out where these differ by too much, because
/// an edge of a ball, a shadow, or a cell runs through; at most `left_out` of all may be.
pub(crate) fn compare(scene: &Scene, balls: &Balls, size: (u32, u32), reach: f64, left_out: f64) -> Image {
    let camera = scene.camera.clone().expect("a camera");
    let rendered = picture(scene, &options(size.0, size.1));
    assert_eq!(rendered.stats.unresolved.pixels, 0);
    let (mut compared, mut skipped) = (0, 0);
    for y in (STRIDE / 2..size.1).step_by(STRIDE as usize) {
        for x in (STRIDE / 2..size.0).step_by(STRIDE as usize) {
            compared += 1;
            let at = |dx: f64, dy: f64| {
                let (origin, direction) = camera_ray(&camera, size, (f64::from(x) + 0.5 + dx, f64::from(y) + 0.5 + dy));
                balls.color(scene, origin, direction)
            };
            let expected = at(0.0, 0.0);
            let around = [at(reach, 0.0), at(-reach, 0.0), at(0.0, reach), at(0.0, -reach)];
            let low = around.iter().fold(expected, |low, c| low.min(*c));
            let high = around.iter().fold(expected, |high, c| high.max(*c));
            if (high - low).max_element() > EDGE {
                skipped += 1;
                continue;
            }
            let color = DVec3::from(rendered.image.pixel(x, y).map(f64::from));
            let slack = ACCURACY * high.max(DVec3::ONE);
            assert!(
                (low - slack).cmple(color).all() && color.cmple(high + slack).all(),
                "pixel ({x}, {y}): {color} instead of {expected}",
            );
        }
    }
    let share = f64::from(skipped) / f64::from(compared);
    assert!(share <= left_out, "{share} of the pixels are too close to an edge");
    rendered.image
}
