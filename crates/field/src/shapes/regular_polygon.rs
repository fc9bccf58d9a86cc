//! Regular polygon in the plane. Exact: folded into one half of one of its sectors.

use crate::shape_prelude::*;

/// See [`regular_polygon`].
#[derive(Clone, Copy, Debug)]
pub struct RegularPolygon;

/// The descriptor of [`regular_polygon`].
pub static REGULAR_POLYGON: Shape = Shape::primitive::<RegularPolygon>();

/// A polygon with so many equal sides and corners at this distance from the origin.
#[track_caller]
pub fn regular_polygon(sides: u32, radius: impl Into<Value>) -> Form<RegularPolygon> {
    Form::new(&REGULAR_POLYGON, [sides.into(), radius.into()])
}

impl Form<RegularPolygon> {
    /// Rounds all corners with this radius; the sides stay where they are.
    #[must_use]
    pub fn round(self, radius: impl Into<Value>) -> Self {
        self.with("round", &[radius.into()])
    }
}

impl Primitive for RegularPolygon {
    const ABOUT: About = About {
        name: "regular_polygon",
        summary: "A plane figure: a polygon with equal sides around the origin, with one corner on the y axis.",
        params: &[
            Param::required("sides", ParamKind::Count(3, 1000), "How many sides it has."),
            Param::required("radius", ParamKind::Positive, "Distance of the corners from the origin."),
            Param::optional(
                "round",
                ParamKind::Length,
                &[0.0],
                "Radius of the rounded corners; the sides stay where they are.",
            ),
        ],
        elsewhere: &[
            "ngon",
            "equilateral_triangle",
            "pentagon",
            "hexagon",
            "octagon",
            "sdHexagon",
            "sdEquilateralTriangle",
        ],
        example: r#"{ "extrude": { "height": 0.6, "shape": { "regular_polygon": { "sides": 6, "radius": 0.9, "round": 0.1 } } } }"#,
    };

    const DIMENSION: Dimension = Dimension::Plane;

    fn check(args: &[f64]) -> Result<(), String> {
        let &[sides, radius, round] = args else { unreachable!("three numbers") };
        if round > radius * libm::cos(std::f64::consts::PI / sides) {
            return Err("`round` of `regular_polygon` must not exceed the distance of its sides from the origin".into());
        }
        Ok(())
    }

    /// Sectors in half a turn; then, of the polygon without what is rounded off, the distance of a side and half its length; and
    /// the radius of the corners.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let &[sides, radius, round] = args else { unreachable!("three numbers") };
        let (sin, cos) = libm::sincos(std::f64::consts::PI / sides);
        let core = radius - round / cos;
        vec![sides / std::f64::consts::PI, std::f64::consts::PI / sides, core * cos, core * sin, round]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let &[sides, radius, round] = args else { unreachable!("three numbers") };
        let step = std::f64::consts::PI / sides;
        let core = radius - round / libm::cos(step);
        let along = |index: u32| {
            let (sin, cos) = libm::sincos(2.0 * step * f64::from(index));
            core * (sin * direction.x + cos * direction.y)
        };
        let farthest = (0..sides as u32).map(along).fold(f64::NEG_INFINITY, f64::max);
        in_plane(direction, |across| farthest + (round + level) * across)
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [sectors, step, apothem, half, round] = c.get();
        let (zero, one) = (p.x.lift(0.0), p.x.lift(1.0));
        // The angle from the middle of the nearest side: a side's middle lies between two corners.
        let from_corner = (p.x.atan2(p.y) * sectors).zigzag();
        let (sin, cos) = ((one - from_corner) * step).sin_cos();
        let radius = S::length2(p.x, p.y);
        let (height, along) = (radius * cos - apothem, (radius * sin - half).max(zero));
        S::select(height.lt(zero), height, S::length2(height, along)) - round
    }
}
