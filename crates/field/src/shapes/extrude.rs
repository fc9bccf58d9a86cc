//! Extrusion of a plane figure. Exact where the figure's distance is.
//!
//! The distance from a product of sets follows from those of its factors: outside both, they are the legs of a right triangle;
//! otherwise the larger one counts. The gradients of the two are at right angles, so that the slope is that of the steeper.

use crate::shape_prelude::*;

/// See [`Extrude::extrude`].
#[derive(Clone, Copy, Debug)]
pub struct Extrusion;

/// The descriptor of [`Extrude::extrude`].
pub static EXTRUDE: Shape = Shape::extrude::<Extrusion>();

/// Making a body of a plane figure.
pub trait Extrude: Into<Field> {
    /// The body of this height that the figure is the cross-section of, its middle at the origin. `with("round", ...)` rounds
    /// the edges.
    #[track_caller]
    fn extrude(self, height: impl Into<Value>) -> Field {
        Field::new(&EXTRUDE, [height.into()], [self.into()])
    }
}

impl<F: Into<Field>> Extrude for F {}

impl Combine for Extrusion {
    const ABOUT: About = About {
        name: "extrude",
        summary: "Makes a body of a plane figure: the figure lies across the z axis, the middle of the body at the origin.",
        params: &[
            Param::required("height", ParamKind::Positive, "Full height along z."),
            Param::optional(
                "round",
                ParamKind::Length,
                &[0.0],
                "Radius of the rounded edges; the size stays. What is thinner than twice the radius vanishes.",
            ),
        ],
        elsewhere: &["linear_extrude", "opExtrusion", "prism"],
        example: r#"{ "extrude": { "height": 0.6, "round": 0.1, "shape": { "difference": [
            { "rectangle": { "size": [1.6, 1], "round": 0.2 } }, { "circle": { "radius": 0.3 } } ] } } }"#,
    };

    const HULL: Hull = Hull::Common;

    fn prepare(args: &[f64]) -> Vec<f64> {
        vec![args[1]]
    }

    fn contract(args: &[f64], figure: Contract, _height: Contract) -> Result<Contract, String> {
        let &[height, round] = args else { unreachable!("two numbers") };
        if round > height / 2.0 {
            return Err("`round` of `extrude` must not exceed half the height".into());
        }
        if !figure.signed {
            return Err(
                "a line has no inside to be extruded; give it a thickness first, for instance with `offset`".into()
            );
        }
        // The rounded figure is the shrunk one grown again, which is exact outside if shrinking is.
        let is_shrunk = round > 0.0;
        let outside = if is_shrunk && figure.inside != Metric::Exact {
            figure.outside.max(Metric::Bound)
        } else if is_shrunk {
            figure.inside.max(Metric::Bound)
        } else {
            figure.outside
        };
        let inside = if is_shrunk { figure.inside.max(Metric::Bound) } else { figure.inside };
        Ok(Contract { outside, inside, lipschitz: figure.lipschitz.map(|slope| slope.max(1.0)), ..figure })
    }

    fn settle(a: Interval, b: Interval, constants: &[f64]) -> Settled {
        // Never to the height alone: ends look as the figure does, too. Rounding moves values.
        if constants[0] == 0.0 && b.hi() < 0.0 && b.hi() < a.lo() { Settled::First } else { Settled::Open }
    }

    #[inline(always)]
    fn combine<S: Scalar>(a: S, b: S, c: &Constants<'_, S>) -> S {
        let [round] = c.get();
        let zero = a.lift(0.0);
        // The height is given without what is rounded off.
        let a = a + round;
        S::select(zero.lt(a) & zero.lt(b), S::length2(a, b), a.max(b)) - round
    }

    /// All of it looks as the figure does.
    #[inline(always)]
    fn share<S: Scalar>(a: S, _b: S, _c: &Constants<'_, S>) -> S {
        a.lift(0.0)
    }
}

/// The constants of the slab that the body lies in, without what is rounded off.
pub(crate) fn core(args: &[f64]) -> Vec<f64> {
    vec![args[0] / 2.0 - args[1]]
}

/// The support of an extruded figure.
pub(crate) fn support(args: &[f64], direction: DVec3, level: f64, figure: impl Fn(DVec3, f64) -> f64) -> f64 {
    let across = DVec3::new(direction.x, direction.y, 0.0);
    let height = (args[0] / 2.0 + level) * direction.z.abs();
    if across == DVec3::ZERO { height } else { figure(across, level) + height }
}
