//! Extrusion of a plane figure. Exact where the figure's distance is.

use super::product;
use super::slab::SLAB;
use crate::shape_prelude::*;

/// See [`Extrude::extrude`].
#[derive(Clone, Copy, Debug)]
pub struct Extrusion;

/// The descriptor of [`Extrude::extrude`].
pub static EXTRUDE: Shape = Shape::product::<Extrusion>();

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

    fn contract(args: &[f64], figure: Contract, _range: Contract) -> Result<Contract, String> {
        let &[height, round] = args else { unreachable!("two numbers") };
        if round > height / 2.0 {
            return Err("`round` of `extrude` must not exceed half the height".into());
        }
        let product = product::contract(figure)?;
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
        Ok(Contract { outside, inside, ..product })
    }

    fn settle(figure: Interval, range: Interval, constants: &[f64]) -> Settled {
        // Rounding moves values.
        if constants[0] == 0.0 { product::settle(figure, range) } else { Settled::Open }
    }

    #[inline(always)]
    fn combine<S: Scalar>(figure: S, range: S, c: &Constants<'_, S>) -> S {
        let [round] = c.get();
        product::distance(figure + round, range + round) - round
    }

    /// All of it looks as the figure does.
    #[inline(always)]
    fn share<S: Scalar>(a: S, _b: S, _c: &Constants<'_, S>) -> S {
        a.lift(0.0)
    }
}

impl Product for Extrusion {
    fn range(args: &[f64]) -> RangeCall {
        (&SLAB, vec![args[0], 2.0])
    }
}
