//! Revolution of a plane figure about an axis. Exact where the figure's distance is and the figure lies on one side of the axis.
//!
//! Points are turned into the half-plane of the figure, which never lengthens a distance.

use crate::shape_prelude::*;

/// See [`Revolve::revolve`].
#[derive(Clone, Copy, Debug)]
pub struct Revolution;

/// The descriptor of [`Revolve::revolve`].
pub static REVOLVE: Shape = Shape::map::<Revolution>();

/// Making a body of revolution of a plane figure.
pub trait Revolve: Into<Field> {
    /// The body that the figure's part with x above 0 sweeps when it turns about its y axis, which comes to lie along z.
    /// `with("offset", ...)` moves the figure away from the axis first.
    #[track_caller]
    fn revolve(self) -> Field {
        Field::new(&REVOLVE, [], [self.into()])
    }
}

impl<F: Into<Field>> Revolve for F {}

impl Map for Revolution {
    const ABOUT: About = About {
        name: "revolve",
        summary: "Makes a body of a plane figure that turns about its y axis, which comes to lie along z. What lies at negative x is cut off.",
        params: &[Param::optional(
            "offset",
            ParamKind::Number,
            &[0.0],
            "How far the figure is moved away from the axis first.",
        )],
        elsewhere: &["rotate_extrude", "opRevolution", "lathe"],
        example: r#"{ "revolve": { "offset": 0.8, "shape": { "rectangle": { "size": [0.5, 0.7], "round": 0.1 } } } }"#,
    };

    const TAKES: Dimension = Dimension::Plane;

    fn contract(args: &[f64], child: Contract, reach: Supports<'_>) -> Result<Contract, String> {
        let is_beside = reach(DVec3::NEG_X) <= args[0];
        Ok(if is_beside { child } else { child.at_most_bound() })
    }

    fn support(args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        let across = libm::hypot(direction.x, direction.y);
        reach(DVec3::new(across, direction.z, 0.0)) + across * args[0]
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [offset] = c.get();
        vec3(S::length2(p.x, p.y) - offset, p.z, p.x.lift(0.0))
    }
}
