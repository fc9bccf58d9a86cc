//! Numbers of a scene as they stand in the table of parameters: slopes, the header, boxes and lights.

use crate::layout::{Layout, write};
use crate::part::Part;
use freikugel_field::{Aabb, Interval};
use freikugel_render::Plan;
use freikugel_render::plan::{Place, PlannedLight, PlannedShadow};
use freikugel_scene::{Background, Camera, FovAxis, Overbright, Projection, Scene};
use glam::DVec3;

/// Half the edge of a box that holds everything.
const EVERYWHERE: f64 = 1e18;

/// Where no bound of a slope is found, the largest gradient at this many points along each axis is multiplied with the
/// factor.
const SLOPE_SAMPLES: usize = 12;
const SLOPE_FACTOR: f64 = 2.0;

/// A bound of a part's slope where it is marched, or a guess and a notice.
pub(crate) fn slope(part: &Part, bounds: Option<Aabb>, scene: &Scene, plan: &Plan, notices: &mut Vec<String>) -> f64 {
    let region = bounds.or(plan.bounds).unwrap_or_else(|| {
        let reach = DVec3::splat(scene.tracer.max_distance);
        Aabb { min: plan.camera.eye - reach, max: plan.camera.eye + reach }
    });
    let program = part.structure.program(DVec3::ZERO);
    let side = |axis: usize| Interval::new(region.min[axis], region.max[axis]);
    if let Some(slope) = program.lipschitz_over([side(0), side(1), side(2)])
        && slope.is_finite()
        && slope > 0.0
    {
        return slope;
    }
    notices.push(format!(
        "{:?}: no bound of its slope is known, so that rays go by the steepest of some samples and may miss thin places",
        part.source.name
    ));
    let place = |axis: usize, index: usize| {
        region.min[axis] + region.size()[axis] * (index as f64 + 0.5) / SLOPE_SAMPLES as f64
    };
    let all = 0..SLOPE_SAMPLES.pow(3);
    let gradient = |index: usize| {
        let at = [index % SLOPE_SAMPLES, index / SLOPE_SAMPLES % SLOPE_SAMPLES, index / SLOPE_SAMPLES.pow(2)];
        program.gradient(DVec3::new(place(0, at[0]), place(1, at[1]), place(2, at[2]))).1.length()
    };
    let steepest = all.map(gradient).filter(|slope| slope.is_finite()).fold(0.0, f64::max);
    (SLOPE_FACTOR * steepest).max(1e-6)
}

/// The numbers of the header.
pub(crate) fn head(numbers: &mut [f32], scene: &Scene, plan: &Plan) {
    let mut set = |name: &str, values: &[f64]| Layout::set(numbers, name, values);
    let wide = |color: [f32; 3]| color.map(f64::from);
    set("SCALE", &[plan.scale]);
    set("STEP_FACTOR", &[scene.tracer.step_factor]);
    set("MAX_STEPS", &[f64::from(scene.tracer.max_steps)]);
    set("MAX_DISTANCE", &[scene.tracer.max_distance]);
    let (min, max) = match plan.bounds {
        Some(bounds) => (bounds.min - plan.origin, bounds.max - plan.origin),
        None => (DVec3::splat(-EVERYWHERE), DVec3::splat(EVERYWHERE)),
    };
    set("BOUNDS", &[min.x, min.y, min.z, max.x, max.y, max.z]);
    let pair = |a: [f32; 3], b: [f32; 3]| [wide(a), wide(b)].concat();
    set("AMBIENT", &pair(scene.ambient.ground, scene.ambient.sky));
    set(
        "BACKGROUND",
        &match scene.background {
            Background::Solid(color) => pair(color, color),
            Background::Gradient { top, bottom } => pair(bottom, top),
        },
    );
    let occlusion: Vec<f64> = plan.occlusion.unwrap_or_default().iter().flatten().copied().map(f64::from).collect();
    set("OCCLUSION", &occlusion);
    set("GAIN", &[f64::from(scene.picture.exposure).exp2()]);
    set("SCALES_DOWN", &[f64::from(u8::from(scene.picture.overbright == Overbright::ScaleDown))]);
    let warning = scene.tracer.warning.map_or([0.0; 4], |color| {
        let [r, g, b] = wide(color);
        [1.0, r, g, b]
    });
    set("WARNING", &warning);
    set("SCENE_SIZE", &[plan.size]);
    set("LIGHT_COUNT", &[plan.lights.len() as f64]);
    look(numbers, scene, plan, plan.origin);
}

/// The numbers of the header that belong to the camera.
pub(crate) fn look(numbers: &mut [f32], scene: &Scene, plan: &Plan, origin: DVec3) {
    let mut set = |name: &str, values: &[f64]| Layout::set(numbers, name, values);
    let camera = &plan.camera;
    set("EYE", &(camera.eye - origin).to_array());
    set("RIGHT", &camera.right.to_array());
    set("UP", &camera.up.to_array());
    set("FORWARD", &camera.forward.to_array());
    let target = match &scene.camera {
        Some(Camera { target, .. }) => *target,
        None => camera.eye + camera.forward * plan.size,
    };
    set("TARGET", &(target - origin).to_array());
    let is_horizontal = matches!(
        scene.camera,
        Some(Camera { projection: Projection::Perspective { axis: FovAxis::Horizontal, .. }, .. })
    );
    set("HALF", &[camera.half[usize::from(!is_horizontal)]]);
    set("IS_HORIZONTAL", &[f64::from(u8::from(is_horizontal))]);
    set("IS_PERSPECTIVE", &[f64::from(u8::from(camera.is_perspective))]);
    set("FOOTPRINT", &camera.footprint);
    let tolerance = plan.tolerance;
    set("TOLERANCE", &[tolerance.fixed, tolerance.growth, tolerance.precision, tolerance.exponent]);
}

pub(crate) fn write_singles(to: &mut [f32], numbers: &[f32]) {
    to[..numbers.len()].copy_from_slice(numbers);
}

/// The middle of a box and half its edges, relative to the origin; everything if there is none.
pub(crate) fn write_box(to: &mut [f32], bounds: Option<Aabb>, origin: DVec3) {
    let (middle, half) = match bounds {
        Some(bounds) => (bounds.center() - origin, bounds.size() / 2.0),
        None => (DVec3::ZERO, DVec3::splat(EVERYWHERE)),
    };
    write(to, &[middle.x, middle.y, middle.z, half.x, half.y, half.z]);
}

pub(crate) fn write_light(to: &mut [f32], light: &PlannedLight) {
    let (kind, place) = match light.place {
        Place::Sun(direction) => (0.0, direction),
        Place::Lamp(position) => (1.0, position),
    };
    let (axis, outer, inner) = light.cone.unwrap_or(([0.0; 3], 0.0, 0.0));
    let (shadow, measure) = match light.shadow {
        PlannedShadow::None => (0.0, 0.0),
        PlannedShadow::Hard => (1.0, 0.0),
        PlannedShadow::Sharpness(sharpness) => (2.0, sharpness),
        PlannedShadow::Clearance(clearance) => (3.0, clearance),
    };
    let falloff = light.falloff.map(|c| c as f32);
    let has_cone = f32::from(u8::from(light.cone.is_some()));
    let all = [&[kind], &place[..], &light.power, &falloff, &[has_cone], &axis, &[outer, inner, shadow, measure]];
    to.copy_from_slice(&all.concat());
}
