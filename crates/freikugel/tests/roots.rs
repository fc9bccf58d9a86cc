//! The first zeros that the renderer finds along rays, against those found by an independent way in double precision: the
//! quartic by the exact polynomial along each ray, the periodic surface by dense samples.

use freikugel::prelude::*;
use freikugel::render::{Layer, Renderer};
use freikugel::scene::Projection;
use glam::DVec3;
use std::path::Path;

/// Every so many pixels in both directions are compared.
const QUARTIC_STRIDE: usize = 3;
const PERIODIC_STRIDE: usize = 8;

/// How far two finds of one zero may be apart, in pixels: the renderer stops within a sixteenth of half a pixel, measured
/// across the surface; where the surface is steep to the ray that is more along it.
const NEAR: f64 = 0.5;

/// A ray that comes into the solid by less than this many pixels, or passes it at less, only grazes it.
const GRAZE: f64 = 1.0 / 16.0;

/// What the renderer's tolerance is to hold on both scenes: 0.01 % of the pixels.
const UNRESOLVED: f64 = 1e-4;

/// A scene of the benchmark with one formula, cut to a ball around the origin.
struct Subject {
    layers: Vec<Layer>,
    width: usize,
    eye: DVec3,
    rays: Vec<DVec3>,
    /// The width of a pixel at distance 1.
    pixel: f64,
    radius: f64,
}

/// What is found along a ray.
struct Zero {
    /// The distance of the first point that is inside.
    t: f64,
    /// How far the field falls below 0 on the way through, over its slope.
    depth: f64,
}

impl Subject {
    fn of(name: &str, radius: f64) -> Self {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/bench").join(name);
        let text = std::fs::read_to_string(file).expect("the scene is there");
        let scene = freikugel::scene::read(&text).scene.expect("a sound scene");
        let options = Options::of(&scene);
        let (layers, stats) =
            Renderer::new(&scene).expect("a sound scene").layers(&options, &()).expect("it can be rendered");
        let pixels = f64::from(options.width * options.height);
        assert!(stats.unresolved.pixels as f64 <= UNRESOLVED * pixels, "{:?}", stats.unresolved);
        let camera = scene.camera.expect("the scene has a camera");
        let Projection::Perspective { fov, .. } = camera.projection else { panic!("a perspective view") };
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(DVec3::Z).normalize();
        let up = right.cross(forward);
        let (width, height) = (f64::from(options.width), f64::from(options.height));
        let half = (fov / 2.0).tan();
        let ray = |pixel: u32| {
            let (x, y) = (f64::from(pixel % options.width) + 0.5, f64::from(pixel / options.width) + 0.5);
            let (x, y) = (2.0 * x / width - 1.0, (1.0 - 2.0 * y / height) * height / width);
            (forward + (right * x + up * y) * half).normalize()
        };
        Self {
            layers: layers.pixels().to_vec(),
            width: options.width as usize,
            eye: camera.eye,
            rays: (0..options.width * options.height).map(ray).collect(),
            pixel: 2.0 * half / width,
            radius,
        }
    }

    /// Where a ray enters and leaves the ball.
    fn span(&self, ray: DVec3) -> Option<[f64; 2]> {
        let b = self.eye.dot(ray);
        let root = (b * b - self.eye.length_squared() + self.radius * self.radius).sqrt();
        (root > 0.0).then(|| [-b - root, -b + root])
    }

    /// Compares with what `first` finds between two distances along a ray, besides the least ratio of the field and its slope.
    fn compare(&self, stride: usize, first: impl Fn(DVec3, [f64; 2]) -> (Option<Zero>, f64)) {
        let (mut rays, mut missed, mut invented, mut grazing) = (0, 0, 0, 0);
        for (place, (layer, &ray)) in self.layers.iter().zip(&self.rays).enumerate() {
            if !(place % self.width).is_multiple_of(stride) || !(place / self.width).is_multiple_of(stride) {
                continue;
            }
            rays += 1;
            let found = f64::from(layer.distance);
            let (zero, clearance) = match self.span(ray) {
                Some(span) => first(ray, span),
                // The ball's own edge.
                None => (None, self.eye.cross(ray).length() - self.radius),
            };
            let pixel = self.pixel * found.min(self.eye.length());
            match zero {
                Some(zero) if found > zero.t + NEAR * pixel => {
                    let is_grazing = zero.depth < GRAZE * pixel;
                    grazing += usize::from(is_grazing);
                    missed += usize::from(!is_grazing);
                }
                Some(zero) if found < zero.t - NEAR * pixel => {
                    invented += usize::from(clearance > GRAZE * pixel);
                    grazing += usize::from(clearance <= GRAZE * pixel);
                }
                None if found.is_finite() => {
                    invented += usize::from(clearance > GRAZE * pixel);
                    grazing += usize::from(clearance <= GRAZE * pixel);
                }
                _ => {}
            }
        }
        println!("{rays} rays: {missed} zeros missed, {invented} invented, {grazing} rays graze and differ");
        assert!(rays > 1000);
        assert_eq!((missed, invented), (0, 0), "of {rays} rays");
        // Rays that graze by less than rounding tells are few.
        assert!(grazing * 1000 <= rays, "{grazing} of {rays} rays");
    }
}

/// A polynomial in one variable, the constant term first.
#[derive(Clone)]
struct Polynomial(Vec<f64>);

impl Polynomial {
    fn line(a: f64, b: f64) -> Self {
        Self(vec![a, b])
    }

    fn times(&self, other: &Self) -> Self {
        let mut out = vec![0.0; self.0.len() + other.0.len() - 1];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                out[i + j] += a * b;
            }
        }
        Self(out)
    }

    fn plus(&self, factor: f64, other: &Self) -> Self {
        let at = |terms: &[f64], i: usize| terms.get(i).copied().unwrap_or(0.0);
        let count = self.0.len().max(other.0.len());
        Self((0..count).map(|i| at(&self.0, i) + factor * at(&other.0, i)).collect())
    }

    fn value(&self, t: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, term| sum * t + term)
    }

    fn derivative(&self) -> Self {
        Self(self.0.iter().enumerate().skip(1).map(|(i, term)| term * i as f64).collect())
    }

    /// All sign changes between `a` and `b`, in order: between two neighbouring extremes there is at most one.
    fn roots(&self, a: f64, b: f64) -> Vec<f64> {
        if self.0.len() < 2 {
            return Vec::new();
        }
        let mut ends = vec![a];
        ends.extend(self.derivative().roots(a, b));
        ends.push(b);
        let changes = ends.windows(2).filter(|pair| (self.value(pair[0]) > 0.0) != (self.value(pair[1]) > 0.0));
        changes.map(|pair| bisect(|t| self.value(t), pair[0], pair[1])).collect()
    }
}

/// The sign change between two places at which the signs differ.
fn bisect(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let begins_above = f(a) > 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if (f(middle) > 0.0) == begins_above { a = middle } else { b = middle }
    }
    0.5 * (a + b)
}

#[test]
fn no_zero_of_the_quartic_is_missed() {
    let subject = Subject::of("s2-quartic.json", 3.55);
    subject.compare(QUARTIC_STRIDE, |ray, [near, far]| {
        // Relative to where the ray enters.
        let start = subject.eye + ray * near;
        let [x, y, z] = [0, 1, 2].map(|axis| Polynomial::line(start[axis], ray[axis]));
        let [xx, yy, zz] = [&x, &y, &z].map(|c| c.times(c));
        let mut f = Polynomial(vec![22.0]);
        for square in [&xx, &yy, &zz] {
            // (c - 2)^2 (c + 2)^2 = (c^2 - 4)^2
            let inner = square.plus(-4.0, &Polynomial(vec![1.0]));
            f = f.plus(1.0, &inner.times(&inner)).plus(-10.0, square);
        }
        f = f.plus(3.0, &xx.times(&yy)).plus(3.0, &xx.times(&zz)).plus(3.0, &yy.times(&zz));
        f = f.plus(-6.0, &x.times(&y).times(&z));
        let length = far - near;
        let roots = f.roots(0.0, length);
        let slope = f.derivative();
        let lowest = |from: f64, to: f64| {
            let mut places = slope.roots(from, to);
            places.extend([from, to]);
            places.into_iter().map(|t| f.value(t)).fold(f64::INFINITY, f64::min)
        };
        // The field's slope near its surface.
        let steep = 60.0;
        let first = if f.value(0.0) <= 0.0 { Some(0.0) } else { roots.first().copied() };
        let until = first.unwrap_or(length);
        let zero = first.map(|t| {
            let end = roots.iter().copied().find(|&root| root > t + 1e-12).unwrap_or(length);
            Zero { t: near + t, depth: -lowest(t, end) / steep }
        });
        (zero, lowest(0.0, (until - 1e-3).max(0.0)) / steep)
    });
}

#[test]
fn no_zero_of_the_periodic_surface_is_missed() {
    let subject = Subject::of("s3-periodic.json", std::f64::consts::TAU);
    subject.compare(PERIODIC_STRIDE, |ray, [near, far]| {
        let f = |t: f64| {
            let p = subject.eye + ray * t;
            let ([sx, sy, sz], [cx, cy, cz]) = (p.to_array().map(f64::sin), p.to_array().map(f64::cos));
            sx * cz * cy - sx * sz * sy + cx * sz * cy - cx * cz * sy
        };
        // The second derivative is at most 9: between samples the field falls by less than 4e-6 more.
        let step = 2e-3;
        let count = ((far - near) / step).ceil() as usize;
        let at = |i: usize| near + (far - near) * i as f64 / count as f64;
        let mut clearance = f64::INFINITY;
        let mut before = f(near);
        if before <= 0.0 {
            return (Some(Zero { t: near, depth: (far - near).min(-before) }), clearance);
        }
        for i in 1..=count {
            let value = f(at(i));
            if value <= 0.0 {
                let depth = (i..=count).map(|i| f(at(i))).take_while(|&value| value <= 0.0).fold(0.0, f64::min);
                return (Some(Zero { t: bisect(f, at(i - 1), at(i)), depth: -depth }), clearance);
            }
            clearance = clearance.min(before);
            before = value;
        }
        (None, clearance.min(before))
    });
}
