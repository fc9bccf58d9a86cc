//! Endless repetition without mirroring, right for shapes that lie anywhere in their cells or overhang them. A bound outside.
//!
//! Around each point the nearest copies are looked at, so many along each axis as the shape's box and the distance of copies
//! demand. Each of them stands for every n-th copy, by a map that jumps where two of those are equally far. What it is worth
//! there does not count: a copy is never nearer than its box, and no value is larger than the least distance from the boxes of
//! copies that are not looked at. So values are continuous, and nowhere more than the distance.

use crate::analysis::support;
use crate::shape::Kind;
use crate::shape_prelude::*;

/// The descriptor of [`RepeatEndless::repeat_endless`].
pub static REPEAT_ENDLESS: Shape = Shape {
    about: ABOUT,
    kind: Kind::Endless { fold: MapTable::of::<Fold>(), boxes: PrimitiveTable::of::<Boxes>() },
    file: None,
};

/// Endless copies of a shape.
pub trait RepeatEndless: Into<Field> {
    /// Copies of the shape without end along each axis, at this distance from each other. Along an axis where it is 0 nothing is
    /// repeated.
    #[track_caller]
    fn repeat_endless(self, spacing: impl Into<Triple>) -> Field {
        Field::new(&REPEAT_ENDLESS, spacing.into().0, [self.into()])
    }
}

impl<F: Into<Field>> RepeatEndless for F {}

const ABOUT: About = About {
    name: "repeat_endless",
    summary: "Endless copies of a shape in rows, columns and layers. They may overlap, and lie anywhere in their cells.",
    params: &[Param::required(
        "spacing",
        ParamKind::Lengths,
        "Distance from one copy to the next, along x, y and z; 0 for no repetition along an axis.",
    )],
    elsewhere: &["opRep", "infinite repetition", "pMod3", "tiling", "domain repetition"],
    example: r#"{ "intersection": [ { "box": { "size": [2.4, 2.4, 1] } }, { "repeat_endless": { "spacing": [0.6, 0.8, 0], "shape": {
        "rotate": { "axis": [1, 1, 0], "angle": 35, "shape": { "torus": { "major": 0.35, "minor": 0.07 } } } } } } ] }"#,
};

/// So far away from a point is at least what is not looked at, in parts of the distance of copies: the less, the shorter the steps
/// of rays between copies; the more, the more copies are looked at.
const CLEARANCE: f64 = 0.25;

/// The most copies that are looked at: each costs as much as the shape by itself.
const MOST: u32 = 64;

/// Larger than all scenes, and with room to be squared in single precision by those who divide by it.
const ENDLESS: f64 = 1e18;

/// Where copies lie, and how many of them are looked at.
struct Lattice {
    spacing: DVec3,
    /// How many copies are looked at along each axis.
    count: [usize; 3],
    /// The middle of the shape's box, and half its edges; no end along an axis that is not repeated is beyond all scenes.
    middle: DVec3,
    half: DVec3,
}

impl Lattice {
    /// # Errors
    /// If too many copies would have to be looked at.
    fn of(spacing: &[f64], reach: Supports<'_>) -> Result<Self, String> {
        let spacing = DVec3::from_slice(spacing);
        let (mut middle, mut half, mut count) = (DVec3::ZERO, DVec3::ZERO, [1; 3]);
        let mut product = 1.0;
        for axis in 0..3 {
            let (low, high) = (-reach(-DVec3::AXES[axis]), reach(DVec3::AXES[axis]));
            // Nothing at all lies anywhere.
            if low > high {
                continue;
            }
            let is_finite = (high - low).is_finite();
            if is_finite {
                (middle[axis], half[axis]) = ((low + high) / 2.0, (high - low) / 2.0);
            } else {
                half[axis] = ENDLESS;
            }
            if spacing[axis] > 0.0 {
                if !is_finite {
                    return Err(format!(
                        "the shape to be repeated has no end along {}; intersect it with a box, or leave that axis out with a \
                         spacing of 0",
                        ["x", "y", "z"][axis]
                    ));
                }
                let needed = (2.0 * half[axis] / spacing[axis] + 2.0 * CLEARANCE).ceil();
                product *= needed;
                count[axis] = needed as usize;
            }
        }
        if product > f64::from(MOST) {
            return Err(format!(
                "`repeat_endless` would look at {product} copies that overlap around each point; at most {MOST} are possible, so \
                 make the `spacing` larger or the shape smaller"
            ));
        }
        Ok(Self { spacing, count, middle, half })
    }

    /// Every so far along an axis lies a copy that one that is looked at stands for.
    fn period(&self, axis: usize) -> f64 {
        if self.spacing[axis] == 0.0 { ENDLESS } else { self.spacing[axis] * self.count[axis] as f64 }
    }

    /// How far from the point copies begin at least that are not looked at.
    fn clearance(&self) -> f64 {
        let repeated = (0..3).filter(|&axis| self.spacing[axis] > 0.0);
        repeated.map(|axis| self.period(axis) / 2.0 - self.half[axis]).fold(ENDLESS, f64::min)
    }

    /// The constants of [`Fold`] for a copy.
    fn fold(&self, copy: [usize; 3]) -> [f64; CONSTANTS] {
        each_axis(|axis| {
            let (period, shift) = (self.period(axis), self.spacing[axis] * copy[axis] as f64);
            [1.0 / period, 0.5 - (self.middle[axis] + shift) / period, period, shift]
        })
    }

    /// The constants of [`Boxes`] for a copy.
    fn boxes(&self, copy: [usize; 3]) -> [f64; CONSTANTS] {
        each_axis(|axis| {
            let (period, shift) = (self.period(axis), self.spacing[axis] * copy[axis] as f64);
            [2.0 / period, -2.0 * (self.middle[axis] + shift) / period, period / 2.0, self.half[axis]]
        })
    }

    /// The constants of [`Boxes`] for what is not looked at: along axes that are not repeated it is no farther than the box.
    fn others(&self) -> [f64; CONSTANTS] {
        let repeated: Vec<usize> = (0..3).filter(|&axis| self.spacing[axis] > 0.0).collect();
        let mut others = self.boxes([0; 3]);
        for (place, axis) in repeated.into_iter().enumerate() {
            let half = if place == 0 { -self.clearance() } else { ENDLESS };
            others[4 * axis..4 * axis + 4].copy_from_slice(&[0.0, 0.0, 0.0, half]);
        }
        others
    }
}

/// How many constants each formula has: four for each axis.
pub(crate) const CONSTANTS: usize = 12;

fn each_axis(of: impl Fn(usize) -> [f64; 4]) -> [f64; CONSTANTS] {
    let [x, y, z] = [of(0), of(1), of(2)];
    std::array::from_fn(|index| [x, y, z][index / 4][index % 4])
}

/// The constants of a sound node of this kind: of [`Boxes`] for what is not looked at, then of [`Fold`] and of [`Boxes`] for each
/// copy that is.
pub(crate) fn constants(field: &Field) -> Vec<f64> {
    let node = field.node();
    let reach = |direction: DVec3| support(&node.children[0], direction, 0.0);
    let lattice = Lattice::of(&node.numbers(), &reach).expect("analysis refuses too many copies");
    let [x, y, z] = lattice.count;
    let copies = (0..x * y * z).map(|index| [index % x, index / x % y, index / (x * y)]);
    let of_copies = copies.flat_map(|copy| [lattice.fold(copy), lattice.boxes(copy)]);
    std::iter::once(lattice.others()).chain(of_copies).flatten().collect()
}

/// The point as seen by the nearest of the copies that one stands for.
struct Fold;

impl Map for Fold {
    const ABOUT: About = ABOUT;

    const IS_PLANAR: bool = true;

    /// Those for a single point at the origin; what larger shapes want, [`constants`] knows.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let spacing = DVec3::from_slice(args);
        Lattice { spacing, count: [1; 3], middle: DVec3::ZERO, half: DVec3::ZERO }.fold([0; 3]).to_vec()
    }

    fn contract(args: &[f64], child: Contract, reach: Supports<'_>) -> Result<Contract, String> {
        let lattice = Lattice::of(args, reach)?;
        if args.iter().all(|&spacing| spacing == 0.0) {
            return Err("`spacing` of `repeat_endless` must be above 0 along some axis".into());
        }
        let are_apart = (0..3).all(|axis| args[axis] == 0.0 || 2.0 * lattice.half[axis] < args[axis]);
        Ok(Contract {
            outside: child.outside.max(Metric::Bound),
            inside: if are_apart { child.inside } else { child.inside.max(Metric::Bound) },
            lipschitz: child.lipschitz.map(|slope| slope.max(1.0)),
            ..child
        })
    }

    fn support(args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        let is_endless = (0..3).any(|axis| args[axis] != 0.0 && direction[axis] != 0.0);
        if is_endless { f64::INFINITY } else { reach(direction) }
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        vec3(nearest(p.x, &c.part(0, 4)), nearest(p.y, &c.part(4, 4)), nearest(p.z, &c.part(8, 4)))
    }
}

#[inline(always)]
fn nearest<S: Scalar>(p: S, c: &Constants<'_, S>) -> S {
    let [inverse, phase, period, shift] = c.get();
    p - ((p * inverse + phase).floor() * period + shift)
}

/// The distance from the boxes of the copies that one stands for. Inside them it is negative, and no nearer to 0 than that from
/// the faces.
struct Boxes;

impl Primitive for Boxes {
    const ABOUT: About = ABOUT;

    fn support(_args: &[f64], _direction: DVec3, _level: f64) -> f64 {
        f64::INFINITY
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let zero = p.x.lift(0.0);
        let (x, y, z) = (beyond(p.x, &c.part(0, 4)), beyond(p.y, &c.part(4, 4)), beyond(p.z, &c.part(8, 4)));
        S::length3(x.max(zero), y.max(zero), z.max(zero)) + zero.min(x.max(y).max(z))
    }
}

/// How far a point lies beyond the nearest box along an axis. The distance from its middle goes up and down without a jump.
#[inline(always)]
fn beyond<S: Scalar>(p: S, c: &Constants<'_, S>) -> S {
    let [frequency, phase, amplitude, half] = c.get();
    (p * frequency + phase).zigzag() * amplitude - half
}
