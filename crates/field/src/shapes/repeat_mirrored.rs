//! Endless repetition in which every other copy is a mirror image. Exact where the shape keeps to its cell.
//!
//! Space is folded at the walls of cells, so that distances stay continuous, however many cells there are.

use crate::shape_prelude::*;

/// See [`RepeatMirrored::repeat_mirrored`].
#[derive(Clone, Copy, Debug)]
pub struct Folded;

/// The descriptor of [`RepeatMirrored::repeat_mirrored`].
pub static REPEAT_MIRRORED: Shape = Shape::map::<Folded>();

/// Endless mirror images of a shape.
pub trait RepeatMirrored: Into<Field> {
    /// Cells with these edges, endless along each axis, around one whose middle is the origin; each holds what the middle one
    /// holds of the shape, mirrored in the wall between them. Along an axis where the edge is 0 nothing is repeated.
    #[track_caller]
    fn repeat_mirrored(self, spacing: impl Into<Triple>) -> Field {
        Field::new(&REPEAT_MIRRORED, spacing.into().0, [self.into()])
    }
}

impl<F: Into<Field>> RepeatMirrored for F {}

impl Map for Folded {
    const ABOUT: About = About {
        name: "repeat_mirrored",
        summary: "Endless cells, each the mirror image of its neighbours, around one whose middle is the origin. What reaches out of the cell is cut off.",
        params: &[Param::required(
            "spacing",
            ParamKind::Lengths,
            "Edges of the cells along x, y and z; 0 for no repetition along an axis.",
        )],
        elsewhere: &["pModMirror", "mirrored tiling", "mirror_repeat"],
        example: r#"{ "intersection": [ { "box": { "size": [2.4, 2.4, 0.6] } }, { "repeat_mirrored": { "spacing": [0.8, 0.8, 0], "shape": {
            "translate": { "by": [0.1, 0, 0], "shape": { "torus": { "major": 0.2, "minor": 0.08 } } } } } } ] }"#,
    };

    const IS_PLANAR: bool = true;

    /// For each axis half the edge, the inverse of the edge, and 1 if it is repeated at all.
    fn prepare(args: &[f64]) -> Vec<f64> {
        args.iter().flat_map(|&edge| if edge == 0.0 { [0.0; 3] } else { [edge / 2.0, 1.0 / edge, 1.0] }).collect()
    }

    fn contract(args: &[f64], child: Contract, reach: Supports<'_>) -> Result<Contract, String> {
        let keeps = (0..3).filter(|&axis| args[axis] > 0.0).all(|axis| {
            let side = |sign: f64| reach(DVec3::AXES[axis] * sign);
            side(1.0).max(side(-1.0)) <= args[axis] / 2.0
        });
        Ok(if keeps { child } else { child.at_most_bound() })
    }

    fn support(args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        let is_endless = (0..3).any(|axis| args[axis] != 0.0 && direction[axis] != 0.0);
        if is_endless { f64::INFINITY } else { reach(direction) }
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [hx, ix, x, hy, iy, y, hz, iz, z] = c.get();
        vec3(folded(p.x, hx, ix, x), folded(p.y, hy, iy, y), folded(p.z, hz, iz, z))
    }
}

/// A coordinate in the middle cell: it goes up through one cell and down through the next. `inverse` is that of the edge.
#[inline(always)]
fn folded<S: Scalar>(p: S, half: S, inverse: S, is_repeated: S) -> S {
    let one = p.lift(1.0);
    let way = ((p + half) * inverse).zigzag();
    ((way + way) - one) * half * is_repeated + p * (one - is_repeated)
}
