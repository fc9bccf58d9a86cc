//! Symmetry: one side of a shape, and its mirror image on the other. Exact where the shape keeps to its side.

use super::blend::inverse;
use crate::shape_prelude::*;

/// See [`Symmetry::symmetric`].
#[derive(Clone, Copy, Debug)]
pub struct Symmetric;

/// The descriptor of [`Symmetry::symmetric`].
pub static SYMMETRY: Shape = Shape::map::<Symmetric>();

/// The choices of axes; number n holds x if n + 1 has its first bit set, y with the second one, z with the third.
const AXES: &[&str] = &["x", "y", "xy", "z", "xz", "yz", "xyz"];

/// Making shapes symmetric.
pub trait Symmetry: Into<Field> {
    /// What of the shape lies at positive coordinates, and its mirror images at negative ones, along the axes in `axes`, such
    /// as `"x"` or `"xz"`.
    ///
    /// # Panics
    /// If `axes` is none of x, y, xy, z, xz, yz and xyz.
    #[track_caller]
    fn symmetric(self, axes: &str) -> Field {
        let choice = AXES.iter().position(|&own| own == axes).unwrap_or_else(|| panic!("no axes are called {axes:?}"));
        Field::new(&SYMMETRY, [Value::Literal(choice as f64)], [self.into()])
    }
}

impl<F: Into<Field>> Symmetry for F {}

/// Whether a choice holds an axis.
fn holds(choice: f64, axis: usize) -> bool {
    (choice as usize + 1) >> axis & 1 == 1
}

impl Map for Symmetric {
    const ABOUT: About = About {
        name: "symmetry",
        summary: "What of a shape lies at positive coordinates, and its mirror images at negative ones.",
        params: &[
            Param::optional("axes", ParamKind::Choice(AXES), &[0.0], "Along which axes."),
            Param::optional(
                "k",
                ParamKind::Length,
                &[0.0],
                "How far from each mirror both halves blend into one another; 0 for a sharp seam.",
            ),
        ],
        elsewhere: &["opSymX", "symmetric", "fold", "mirror_copy", "smooth mirror"],
        example: r#"{ "symmetry": { "axes": "xy", "shape": {
            "translate": { "by": [0.6, 0.5, 0], "shape": { "sphere": { "radius": 0.4 } } } } } }"#,
    };

    const IS_PLANAR: bool = true;

    /// For each axis 1 if it is folded, and 0 if not; then how far blends reach, and half of one over that.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(u8::from(holds(args[0], axis))));
        vec![x, y, z, args[1], inverse(args[1]) / 2.0]
    }

    fn contract(args: &[f64], child: Contract, reach: Supports<'_>) -> Result<Contract, String> {
        let keeps = args[1] == 0.0 && (0..3).all(|axis| !holds(args[0], axis) || reach(-DVec3::AXES[axis]) <= 0.0);
        // Inside, the other side of a fold is no farther than the nearest surface.
        Ok(if keeps { child } else { child.at_most_bound() })
    }

    fn support(args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        let mut folded = direction;
        for axis in (0..3).filter(|&axis| holds(args[0], axis)) {
            folded[axis] = direction[axis].abs();
        }
        reach(folded)
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [x, y, z, k, half] = c.get();
        let one = p.x.lift(1.0);
        vec3(
            smooth_abs(p.x, k, half) * x + p.x * (one - x),
            smooth_abs(p.y, k, half) * y + p.y * (one - y),
            smooth_abs(p.z, k, half) * z + p.z * (one - z),
        )
    }
}

/// The absolute value, with a parabola between -k and k; `half` is 1 / 2k. Its slope is never above 1.
#[inline(always)]
fn smooth_abs<S: Scalar>(p: S, k: S, half: S) -> S {
    let size = p.abs();
    S::select(size.lt(k), p.square() * half + k * 0.5, size)
}
