//! Revolution of a plane figure by part of a turn. Exact where `revolve` is.
//!
//! The point nearest to one outside of the angles lies on the nearer end, since that of an arc of a circle does. So the figure is
//! looked up there, in the plane of that end, and the way to this plane is the other leg of a right triangle. Between the ends it
//! is looked up in the half-plane of the point itself, as `revolve` does, and the way is that to the nearer end.

use super::plane::PLANE;
use super::product;
use super::sector::part_of_turn;
use crate::shape_prelude::*;

/// See [`RevolvePart::revolve_part`].
#[derive(Clone, Copy, Debug)]
pub struct PartialRevolution;

/// The descriptor of [`RevolvePart::revolve_part`].
pub static REVOLVE_PART: Shape = Shape::product::<PartialRevolution>();

/// Making part of a body of revolution of a plane figure.
pub trait RevolvePart: Into<Field> {
    /// What the figure's part with x above 0 sweeps when it turns about its y axis, which comes to lie along z, by this angle in
    /// degrees: half of it to each side of the x axis. `with("offset", ...)` moves the figure away from the axis first.
    #[track_caller]
    fn revolve_part(self, degrees: f64) -> Field {
        Field::new(&REVOLVE_PART, [degrees.to_radians().into()], [self.into()])
    }
}

impl<F: Into<Field>> RevolvePart for F {}

impl Combine for PartialRevolution {
    const ABOUT: About = About {
        name: "revolve_part",
        summary: "Makes a body of a plane figure that turns about its y axis, which comes to lie along z, by part of a turn: half of \
                  it to each side of the x axis. What lies at negative x is cut off.",
        params: &[
            Param::required("angle", ParamKind::Angle, "How far it turns in all: degrees, above 0 and below 360."),
            Param::optional(
                "offset",
                ParamKind::Number,
                &[0.0],
                "How far the figure is moved away from the axis first.",
            ),
        ],
        elsewhere: &["rotate_extrude with angle", "partial revolve", "capped revolution"],
        example: r#"{ "rotate": { "axis": [0, 0, 1], "angle": 80, "shape": {
            "revolve_part": { "angle": 250, "offset": 0.75, "shape": { "difference": [
                { "rectangle": { "size": [0.6, 0.8], "round": 0.1 } }, { "circle": { "radius": 0.2 } } ] } } } } }"#,
    };

    const HULL: Hull = Hull::Common;

    fn prepare(_args: &[f64]) -> Vec<f64> {
        Vec::new()
    }

    fn contract(_args: &[f64], figure: Contract, _range: Contract) -> Result<Contract, String> {
        product::contract(figure)
    }

    fn settle(figure: Interval, range: Interval, _constants: &[f64]) -> Settled {
        product::settle(figure, range)
    }

    #[inline(always)]
    fn combine<S: Scalar>(figure: S, range: S, _c: &Constants<'_, S>) -> S {
        product::distance(figure, range)
    }

    /// All of it looks as the figure does.
    #[inline(always)]
    fn share<S: Scalar>(figure: S, _range: S, _c: &Constants<'_, S>) -> S {
        figure.lift(0.0)
    }
}

impl Product for PartialRevolution {
    const FRAME: Option<MapTable> = Some(MapTable::of::<Self>());

    /// All that is not beyond an end.
    fn range(_args: &[f64]) -> RangeCall {
        (&PLANE, vec![0.0, 0.0, 1.0, 0.0])
    }
}

/// The frame: where a point lies in the plane of the figure, and how far beyond the nearer end; negative between the ends.
impl Map for PartialRevolution {
    const ABOUT: About = <Self as Combine>::ABOUT;

    const TAKES: Dimension = Dimension::Plane;

    /// The direction of one end, and how far the figure is moved.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let &[angle, offset] = args else { unreachable!("two numbers") };
        let (sin, cos) = libm::sincos(angle / 2.0);
        vec![cos, sin, offset]
    }

    fn contract(args: &[f64], figure: Contract, reach: Supports<'_>) -> Result<Contract, String> {
        let &[angle, offset] = args else { unreachable!("two numbers") };
        part_of_turn("revolve_part", angle)?;
        let is_beside = reach(DVec3::NEG_X) <= offset;
        Ok(if is_beside { figure } else { figure.at_most_bound() })
    }

    fn support(args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        let &[angle, offset] = args else { unreachable!("two numbers") };
        let within = |across: f64, beyond: f64| reach(DVec3::new(across, direction.z, beyond)) + across * offset;
        // Between the ends the one half-plane counts that leads most in the direction.
        let across = libm::hypot(direction.x, direction.y);
        let aside = libm::atan2(direction.y.abs(), direction.x) - angle / 2.0;
        let between = within(if aside > 0.0 { across * libm::cos(aside) } else { across }, 0.0);
        let (sin, cos) = libm::sincos(angle / 2.0);
        let beyond = |side: f64| {
            let y = direction.y * side;
            within(direction.x * cos + y * sin, (y * cos - direction.x * sin).max(0.0))
        };
        between.max(beyond(1.0)).max(beyond(-1.0))
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [cos, sin, offset] = c.get();
        let zero = p.x.lift(0.0);
        // Both sides of the x axis are alike. Where `along` is negative, neither term of `beyond` has the other sign.
        let y = p.y.abs();
        let (along, beyond) = (p.x * cos + y * sin, y * cos - p.x * sin);
        let is_between = beyond.lt(zero);
        let radius = S::length2(p.x, p.y);
        let across = S::select(is_between, radius, along);
        // A quarter turn or more from both ends, the axis is nearest.
        let depth = S::select(is_between & along.lt(zero), -radius, beyond);
        vec3(across - offset, p.z, depth)
    }
}
