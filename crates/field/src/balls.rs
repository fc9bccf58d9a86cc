//! Rays among equal balls, in closed form: what a `point_set` is, if it is neither stretched nor combined with others.
//!
//! A marched ray asks for the nearest of all points at every step. Here it goes once through the tree that the set is searched by, and
//! meets only the boxes on its way. How far a ball is from the ray is computed in double precision; boxes are passed over in single
//! precision, with a margin.

use crate::field::Field;
use crate::point_tree::{Quest, TREE, rows, walk};
use crate::ray::placed_primitive;
use crate::shape::Primitive;
use crate::shapes::{POINT_SET, PointSet};
use glam::{DAffine3, DVec3};

/// How much edges of a map's cube may differ, relative to their lengths, that keeps balls what they are: more than the rounding errors
/// of a few turns.
const ROUND: f64 = 1e-9;

/// What boxes are widened by, relative to all coordinates of a search: more than the rounding errors of keys in single precision.
const SLACK: f64 = 16.0 * f32::EPSILON as f64;

/// Inverse components of directions are no larger: where a ray goes along a side of a box, there is no division by 0.
const STEEPEST: f32 = 1e18;

/// Equal balls around the points of a [`crate::shapes::point_set()`].
#[derive(Clone, Debug)]
pub struct Balls {
    /// The boxes of the tree, by their middle and half their size, relative to `middle`; and the points in its leaves.
    boxes: Vec<f32>,
    points: Vec<f64>,
    leaves: usize,
    radius: f64,
    /// The middle of all balls, and the radius of the ball around it that holds them.
    middle: DVec3,
    reach: f64,
    /// From the world to where the points are, and how much longer a way is there.
    inward: DAffine3,
    growth: f64,
}

impl Balls {
    /// The balls that `field` is: a painted, moved, turned, reflected or uniformly scaled `point_set`. Nothing if it is anything else.
    pub fn of(field: &Field) -> Option<Self> {
        let (primitive, map) = placed_primitive(field).filter(|(node, _)| std::ptr::eq(node.shape, &POINT_SET))?;
        let inward = map.inverse();
        let growth = inward.matrix3.x_axis.length();
        let shape = inward.matrix3.transpose() * inward.matrix3;
        if !shape.abs_diff_eq(glam::DMat3::from_diagonal(DVec3::splat(growth * growth)), ROUND * growth * growth) {
            return None;
        }
        let numbers = primitive.numbers();
        let mut boxes = PointSet::prepare(&numbers);
        let leaves = TREE.leaves(boxes.len());
        let points = boxes.split_off(2 * leaves * TREE.node);
        let root = &boxes[TREE.node..];
        let (middle, half) = (DVec3::from_slice(root), DVec3::from_slice(&root[3..]));
        for own in boxes.chunks_exact_mut(TREE.node) {
            (DVec3::from_slice(own) - middle).write_to_slice(own);
        }
        let radius = numbers[0];
        let reach = half.length() + radius;
        let boxes = boxes.into_iter().map(|number| number as f32).collect();
        Some(Self { boxes, points, leaves, radius, middle, reach, inward, growth })
    }

    /// The distance along the ray from `origin` along the unit vector `direction` to where it first meets a ball, or is inside of one,
    /// if that is less than `limit`.
    pub fn hit(&self, origin: DVec3, direction: DVec3, limit: f64) -> Option<f64> {
        self.search_hit(origin, direction, limit, false)
    }

    /// Whether the ray from `origin` along the unit vector `direction` meets a ball within less than `limit`.
    pub fn is_hit(&self, origin: DVec3, direction: DVec3, limit: f64) -> bool {
        self.search_hit(origin, direction, limit, true).is_some()
    }

    fn search_hit(&self, origin: DVec3, direction: DVec3, limit: f64, any: bool) -> Option<f64> {
        let ray = self.inside(origin, direction);
        let away = self.middle - ray.origin;
        let along = away.dot(ray.direction);
        if away.length_squared() - along * along > self.reach * self.reach * (1.0 + SLACK) {
            return None;
        }
        // Where single precision measures from: not before all balls.
        let start = (along - self.reach).max(0.0);
        let limit = limit * self.growth - start;
        let origin = ray.origin + ray.direction * start;
        let mut quest = First { ray: self.aim(Ray { origin, ..ray }), found: limit, any };
        if limit > 0.0 {
            walk(&self.boxes, self.leaves, (limit * (1.0 + SLACK)) as f32, &mut quest);
        }
        (quest.found < limit).then(|| (start + quest.found) / self.growth)
    }

    /// The least ratio of the clearance at a point of a ray to the distance from its `origin`, up to `far`; 0 where the ray meets a
    /// ball, and no more than `most`. (For each ball that is the sine of the angle that a cone around the ray opens by until it touches
    /// the ball, unless it touches beyond `far`.)
    pub fn least_clearance(&self, origin: DVec3, direction: DVec3, far: f64, most: f64) -> f64 {
        let ray = self.aim(self.inside(origin, direction));
        let mut quest = Narrowest { ray, far: far * self.growth, found: most };
        walk(&self.boxes, self.leaves, most as f32, &mut quest);
        quest.found
    }

    /// A ray where the points are.
    fn inside(&self, origin: DVec3, direction: DVec3) -> Ray {
        Ray {
            origin: self.inward.transform_point3(origin),
            direction: self.inward.transform_vector3(direction) / self.growth,
        }
    }

    fn aim(&self, ray: Ray) -> Aim<'_> {
        let from = ray.origin - self.middle;
        let margin = SLACK * (from.length() + self.reach);
        let slope = ray.direction.as_vec3().to_array();
        Aim {
            balls: self,
            ray,
            from: from.as_vec3().to_array(),
            slope,
            inverse: slope.map(|slope| slope.recip().clamp(-STEEPEST, STEEPEST)),
            widening: (self.radius + margin) as f32,
        }
    }
}

struct Ray {
    origin: DVec3,
    direction: DVec3,
}

/// A ray and the balls that it goes among.
struct Aim<'b> {
    balls: &'b Balls,
    ray: Ray,
    /// The ray in single precision, relative to the middle of the balls, and the inverse components of its direction.
    from: [f32; 3],
    slope: [f32; 3],
    inverse: [f32; 3],
    /// What boxes around points are widened by to hold their balls.
    widening: f32,
}

/// A point as a ray sees it.
struct Sight {
    /// How far along the ray it is, and how far beside; the square of its distance from the ray's origin.
    along: f64,
    beside: f64,
    square: f64,
}

impl Aim<'_> {
    /// What the ray sees of the points of a leaf.
    #[inline(always)]
    fn sights(&self, leaf: usize) -> [Sight; TREE.leaf] {
        rows(&self.balls.points, leaf).map(|point| {
            let away = DVec3::from(point) - self.ray.origin;
            let along = away.dot(self.ray.direction);
            // Not by the difference of squares, which has rounding errors of the larger ones.
            let beside = (away - self.ray.direction * along).length();
            Sight { along, beside, square: away.length_squared() }
        })
    }
}

/// The search for the first ball on a ray, or any one; its numbers are distances along the ray.
struct First<'b> {
    ray: Aim<'b>,
    found: f64,
    any: bool,
}

impl Quest for First<'_> {
    #[inline(always)]
    fn keys<const N: usize>(&self, boxes: &[f32]) -> [f32; N] {
        let Aim { from, inverse, widening, .. } = &self.ray;
        let (mut enter, mut leave) = ([0.0_f32; N], [f32::INFINITY; N]);
        for axis in 0..3 {
            for ((enter, leave), row) in enter.iter_mut().zip(&mut leave).zip(boxes.chunks_exact(TREE.node)) {
                let middle = (row[axis] - from[axis]) * inverse[axis];
                let half = (row[3 + axis] + widening) * inverse[axis].abs();
                *enter = enter.max(middle - half);
                *leave = leave.min(middle + half);
            }
        }
        std::array::from_fn(|index| if enter[index] <= leave[index] { enter[index] } else { f32::INFINITY })
    }

    #[inline(always)]
    fn visit(&mut self, leaf: usize, least: f32) -> f32 {
        let radius = self.ray.balls.radius;
        for Sight { along, beside, square } in self.ray.sights(leaf) {
            if beside > radius {
                continue;
            }
            let t = if square <= radius * radius { 0.0 } else { along - (radius * radius - beside * beside).sqrt() };
            if t >= 0.0 && t < self.found {
                self.found = t;
                if self.any {
                    return 0.0;
                }
            }
        }
        // A little more, so that rounding hides no box that may hold a nearer ball.
        least.min(self.found as f32 * (1.0 + SLACK as f32))
    }
}

/// The search for the least ratio of clearance to distance along a ray; these are its numbers.
struct Narrowest<'b> {
    ray: Aim<'b>,
    far: f64,
    found: f64,
}

impl Quest for Narrowest<'_> {
    /// The ratios for the balls around boxes.
    #[inline(always)]
    fn keys<const N: usize>(&self, boxes: &[f32]) -> [f32; N] {
        let Aim { from, slope, widening, .. } = &self.ray;
        let (mut along, mut size) = ([0.0; N], [0.0; N]);
        let mut away = [[0.0; N]; 3];
        for axis in 0..3 {
            for (index, row) in boxes.chunks_exact(TREE.node).enumerate() {
                away[axis][index] = row[axis] - from[axis];
                along[index] += away[axis][index] * slope[axis];
                size[index] += row[3 + axis] * row[3 + axis];
            }
        }
        let (mut square, mut beside) = ([f32::MIN_POSITIVE; N], [0.0; N]);
        for axis in 0..3 {
            for index in 0..N {
                let sideways = away[axis][index] - along[index] * slope[axis];
                square[index] += away[axis][index] * away[axis][index];
                beside[index] += sideways * sideways;
            }
        }
        let mut keys = [0.0; N];
        for index in 0..N {
            let (radius, beside) = (size[index].sqrt() + widening, beside[index].sqrt());
            let tangent = (square[index] - radius * radius).max(0.0).sqrt();
            let sine = (beside * tangent - along[index] * radius) / square[index];
            let cosine = along[index] * tangent + beside * radius;
            // No cone that is less than a half-space touches what lies behind.
            let ratio = if cosine > 0.0 { sine } else { 1.0 };
            keys[index] = if square[index] > radius * radius { (ratio - SLACK as f32).max(0.0) } else { 0.0 };
        }
        keys
    }

    #[inline(always)]
    fn visit(&mut self, leaf: usize, least: f32) -> f32 {
        let (radius, far) = (self.ray.balls.radius, self.far);
        for Sight { along, beside, square } in self.ray.sights(leaf) {
            if square <= radius * radius {
                self.found = 0.0;
                continue;
            }
            let tangent = (square - radius * radius).sqrt();
            let sine = (beside * tangent - along * radius) / square;
            let cosine = (along * tangent + beside * radius) / square;
            // The ball at the ray that touches this one lies `tangent / cosine` away.
            let ratio = if tangent < far * cosine { sine } else { ((along - far).hypot(beside) - radius) / far };
            self.found = self.found.min(ratio.max(0.0));
        }
        least.min(self.found as f32)
    }
}
