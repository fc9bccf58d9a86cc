//! Rectangle in the plane, optionally with rounded corners. Exact outside and inside.

use crate::shape_prelude::*;

/// See [`rectangle`].
#[derive(Clone, Copy, Debug)]
pub struct Rectangle;

/// The descriptor of [`rectangle`].
pub static RECTANGLE: Shape = Shape::primitive::<Rectangle>();

/// A rectangle with these full edge lengths, its middle at the origin of the plane.
#[track_caller]
pub fn rectangle(width: impl Into<Value>, height: impl Into<Value>) -> Form<Rectangle> {
    Form::new(&RECTANGLE, [width.into(), height.into()])
}

impl Form<Rectangle> {
    /// Rounds all corners with this radius; the size stays.
    #[must_use]
    pub fn round(self, radius: impl Into<Value>) -> Self {
        self.with("round", &[radius.into()])
    }
}

impl Primitive for Rectangle {
    const ABOUT: About = About {
        name: "rectangle",
        summary: "A plane figure: a rectangle with its middle at the origin.",
        params: &[
            Param::required("size", ParamKind::Size2, "Full edge lengths along x and y."),
            Param::optional("round", ParamKind::Length, &[0.0], "Radius of the rounded corners; the size stays."),
        ],
        elsewhere: &["box2", "square", "rounded_rectangle", "sdBox2D", "sdRoundedBox2D"],
        example: r#"{ "extrude": { "height": 0.5, "shape": { "rectangle": { "size": [1.6, 1], "round": 0.2 } } } }"#,
    };

    const DIMENSION: Dimension = Dimension::Plane;

    fn check(args: &[f64]) -> Result<(), String> {
        let &[x, y, round] = args else { unreachable!("three numbers") };
        if round > x.min(y) / 2.0 {
            return Err("`round` of `rectangle` must not exceed half the smaller edge".into());
        }
        Ok(())
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        let &[x, y, round] = args else { unreachable!("three numbers") };
        vec![x / 2.0 - round, y / 2.0 - round, round]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let &[x, y, round] = args else { unreachable!("three numbers") };
        let core = (x / 2.0 - round) * direction.x.abs() + (y / 2.0 - round) * direction.y.abs();
        in_plane(direction, |across| core + (round + level) * across)
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [x, y, round] = c.get();
        let zero = p.x.lift(0.0);
        let (x, y) = (p.x.abs() - x, p.y.abs() - y);
        S::length2(x.max(zero), y.max(zero)) + zero.min(x.max(y)) - round
    }
}
