//! The tracers beside each other: what each takes, and where it sees something else than the guaranteed one.
//!
//! One ray goes through the centre of each pixel. Two tracers agree if they stop at the same surface up to their
//! tolerances. Where they don't, the field in double precision decides who is right: whether there is a surface where a
//! tracer stopped, and whether the ray runs through one where it did not.

use crate::layers::{Layer, Layers};
use crate::options::{Options, Rect};
use crate::prepare::{Frame, Renderer, rounding};
use crate::run::{Progress, RenderError};
use crate::stats::Stats;
use crate::view::Ray;
use freikugel_field::Program;
use freikugel_scene::{Method, Scene};
use glam::{DVec2, DVec3};
use std::time::Duration;

/// Two tracers may stop this many of their tolerances apart, measured across the surface, on the same surface.
const AGREEMENT: f64 = 4.0;

/// The slowest fall of the field along a ray, for distances the sine of an angle, at which a ray's distance to a surface is told
/// apart from the way that is left.
const SLOWEST_FALL: f64 = 1e-2;

/// Where a surface may be that a ray just touched is looked for at so many places on either side of where the guaranteed
/// tracer stopped.
const PLACES: i32 = 64;

/// The tracers beside each other.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// One for each method asked for, in that order.
    pub trials: Vec<Trial>,
}

/// One method.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Which.
    pub method: Method,
    /// What came out, or why the method can't be used on this scene, as a sentence.
    pub outcome: Result<Outcome, String>,
}

/// What one method made of the scene.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What lies at the centre of each pixel.
    pub layers: Layers,
    /// Counts of one run; its times are those of the last one.
    pub stats: Stats,
    /// The median of the times that tracing took, over several runs.
    pub time: Duration,
    /// Steps of a ray on average.
    pub mean_steps: f64,
    /// The most steps of a ray.
    pub most_steps: u32,
    /// One for each pixel, row by row from the top.
    pub verdicts: Vec<Verdict>,
}

/// What a method made of a pixel, compared with the guaranteed tracer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// The same surface, or nothing, as the guaranteed tracer.
    Agrees,
    /// There is a surface, but the method went on through it.
    Missed,
    /// The method stopped where there is no surface.
    False,
    /// The ray comes as near to a surface as the tolerance, but does not run through it: both answers are right.
    Grazing,
    /// The method ran out of steps.
    Unresolved,
    /// The guaranteed tracer itself ran out of steps.
    Unjudged,
}

impl Outcome {
    /// How many pixels have a verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.verdicts.iter().filter(|&&other| other == verdict).count()
    }
}

impl Comparison {
    /// What came out of a method, if it was asked for and can be used.
    pub fn outcome(&self, method: Method) -> Option<&Outcome> {
        self.trials.iter().find(|trial| trial.method == method)?.outcome.as_ref().ok()
    }
}

/// Traces one ray through each pixel of the frame or its crop with each method, `runs` times each, and compares what they meet
/// with what the guaranteed tracer does.
///
/// # Errors
/// If the scene or the options are faulty even for the guaranteed tracer, or the work was cancelled.
pub fn compare(
    scene: &Scene,
    options: &Options,
    methods: &[Method],
    runs: usize,
    progress: &dyn Progress,
) -> Result<Comparison, RenderError> {
    let with = |method| Scene { tracer: scene.tracer.clone().method(method), ..scene.clone() };
    let options = Options { samples: 1, ..options.clone() };
    let region = options.region()?;
    let scene_of_judge = with(Method::Guaranteed);
    let judge = Judge::new(&scene_of_judge, &options, progress)?;
    let mut trials = Vec::new();
    for &method in methods {
        let scene = with(method);
        let outcome = match Renderer::new(&scene) {
            Ok(renderer) => Ok(judge.try_out(&renderer, &options, runs, progress)?),
            Err(error) => Err(error.to_string()),
        };
        trials.push(Trial { method, outcome });
    }
    Ok(Comparison { width: region.width, height: region.height, trials })
}

/// What the guaranteed tracer found.
struct Judge {
    layers: Layers,
    /// Rays, tolerances and distances by which it found it.
    rays: Vec<Ray>,
    tolerance: Vec<f64>,
    field: Option<Program>,
    is_sheet: Vec<bool>,
    max_distance: f64,
}

impl Judge {
    fn new(scene: &Scene, options: &Options, progress: &dyn Progress) -> Result<Self, RenderError> {
        let renderer = Renderer::new(scene)?;
        let layers = renderer.layers(options, progress)?.0;
        let frame = Frame::new(&renderer, options)?;
        let Rect { x, y, width, height } = options.region()?;
        let centers = (y..y + height).flat_map(|y| (x..x + width).map(move |x| (x, y)));
        let centers = centers.map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)) + 0.5);
        let rays: Vec<Ray> = centers.map(|center| frame.view.ray(center)).collect();
        let tolerance = tolerances(&frame, &rays, &layers);
        let mut is_sheet = vec![false; scene.objects.len()];
        for paint in &renderer.paints {
            is_sheet[paint.object as usize] |= paint.is_sheet;
        }
        let max_distance = scene.tracer.max_distance;
        Ok(Self { layers, rays, tolerance, field: frame.marched, is_sheet, max_distance })
    }

    fn try_out(
        &self,
        renderer: &Renderer<'_>,
        options: &Options,
        runs: usize,
        progress: &dyn Progress,
    ) -> Result<Outcome, RenderError> {
        let mut times = Vec::new();
        let (mut layers, mut stats) = renderer.layers(options, progress)?;
        times.push(stats.times.wall);
        for _ in 1..runs {
            (layers, stats) = renderer.layers(options, progress)?;
            times.push(stats.times.wall);
        }
        times.sort_unstable();
        let frame = Frame::new(renderer, options)?;
        let tolerance = tolerances(&frame, &self.rays, &layers);
        let verdicts = (0..self.rays.len()).map(|pixel| self.judge(pixel, &layers.pixels()[pixel], tolerance[pixel]));
        let verdicts = verdicts.collect();
        let steps = layers.pixels().iter().map(|pixel| pixel.steps);
        let mean_steps = steps.clone().map(f64::from).sum::<f64>() / self.rays.len() as f64;
        let most_steps = steps.max().unwrap_or(0);
        Ok(Outcome { stats, time: times[times.len() / 2], mean_steps, most_steps, verdicts, layers })
    }

    fn judge(&self, pixel: usize, other: &Layer, tolerance: f64) -> Verdict {
        let (own, ray) = (&self.layers.pixels()[pixel], &self.rays[pixel]);
        if own.is_unresolved {
            return Verdict::Unjudged;
        }
        if other.is_unresolved {
            return Verdict::Unresolved;
        }
        // Nothing is to be seen beyond, though planes that are intersected directly are.
        let within = |layer: &Layer| Some(f64::from(layer.distance)).filter(|&t| t <= self.max_distance);
        let own_tolerance = self.tolerance[pixel];
        match (within(own), within(other)) {
            (None, None) => Verdict::Agrees,
            (Some(own_t), Some(t)) if (t - own_t).abs() <= self.slack(own, ray, tolerance.max(own_tolerance)) => {
                Verdict::Agrees
            }
            (own_t, Some(t)) if own_t.is_none_or(|own_t| t < own_t) => match self.is_surface_near(ray, t, tolerance) {
                true => Verdict::Grazing,
                false => Verdict::False,
            },
            (Some(own_t), _) => match self.is_crossed(own, ray, own_t, tolerance.max(own_tolerance)) {
                true => Verdict::Missed,
                false => Verdict::Grazing,
            },
            (None, Some(_)) => unreachable!("a hit where the judge has none is nearer than infinity"),
        }
    }

    /// How far apart two hits on one surface may lie on a ray: farther where the ray meets it under a flat angle, and where the
    /// field changes more slowly than a distance.
    fn slack(&self, hit: &Layer, ray: &Ray, tolerance: f64) -> f64 {
        let sine = DVec3::from(hit.normal.map(f64::from)).dot(ray.direction).abs();
        let place = ray.origin + ray.direction * f64::from(hit.distance);
        let slope = self.field.as_ref().map_or(1.0, |field| field.gradient(place).1.length());
        let fall = sine * if slope < 1.0 { slope } else { 1.0 };
        AGREEMENT * tolerance / fall.max(SLOWEST_FALL)
    }

    /// Whether there is a surface near a place on a ray, judged by the field and its gradient.
    fn is_surface_near(&self, ray: &Ray, t: f64, tolerance: f64) -> bool {
        let Some(field) = &self.field else { return false };
        let (value, gradient) = field.gradient(ray.origin + ray.direction * t);
        let slope = gradient.length();
        value.abs() <= AGREEMENT * tolerance * if slope.is_finite() { slope } else { 1.0 }
    }

    /// Whether a ray runs through a surface near a place where it comes as near as the tolerance.
    fn is_crossed(&self, hit: &Layer, ray: &Ray, t: f64, tolerance: f64) -> bool {
        let Some(field) = &self.field else { return false };
        let reach = self.slack(hit, ray, tolerance);
        let spacing = reach / f64::from(PLACES);
        let point = |place: i32| ray.origin + ray.direction * (t + spacing * f64::from(place));
        let values = (-PLACES..=PLACES).map(|place| (field.value(point(place)), place));
        let Some((least, place)) = values.min_by(|a, b| a.0.total_cmp(&b.0)) else { return false };
        let nearest = point(place);
        let rounding = f64::from(rounding((nearest - field.origin()).length() as f32));
        if hit.object.is_some_and(|object| self.is_sheet[object as usize]) {
            // The field has no other side there; on a surface that is crossed it falls to 0 between two places.
            return least <= spacing * field.gradient(nearest).1.length() + rounding;
        }
        least < -rounding
    }
}

/// How far from a surface each ray may have stopped.
fn tolerances(frame: &Frame<'_>, rays: &[Ray], layers: &Layers) -> Vec<f64> {
    let at = |(ray, layer): (&Ray, &Layer)| {
        let t = f64::from(layer.distance);
        if !t.is_finite() {
            return 0.0;
        }
        frame.tolerance.at(t, (ray.origin + ray.direction * t - frame.origin).length())
    };
    rays.iter().zip(layers.pixels()).map(at).collect()
}
