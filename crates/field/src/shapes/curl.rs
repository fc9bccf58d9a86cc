//! Curl: a shape turned about the z axis by an angle that grows along x. It is no bend that keeps lengths, but simple, and well
//! known.

use super::swirl::on_circle;
use crate::shape_prelude::*;

/// See [`Curl::curl`].
#[derive(Clone, Copy, Debug)]
pub struct Curling;

/// The descriptor of [`Curl::curl`].
pub static CURL: Shape = Shape::map::<Curling>();

/// Curling a shape.
pub trait Curl: Into<Field> {
    /// The shape turned about the z axis by an angle in degrees for each unit along x, at the point that it is looked up for.
    #[track_caller]
    fn curl(self, degrees: f64) -> Field {
        Field::new(&CURL, [degrees.to_radians().into()], [self.into()])
    }
}

impl<F: Into<Field>> Curl for F {}

impl Map for Curling {
    const ABOUT: About = About {
        name: "curl",
        summary: "Turns a shape about the z axis, the more the larger x: the simple bend of shaders.",
        params: &[Param::required("rate", ParamKind::Angle, "Degrees for each unit along x.")],
        elsewhere: &["opCheapBend", "cheap bend", "bend"],
        example: r#"{ "curl": { "rate": 40, "shape": { "box": { "size": [2, 0.4, 0.8], "round": 0.1 } } } }"#,
    };

    const IS_SHORT: bool = false;

    const IS_PLANAR: bool = true;

    fn contract(args: &[f64], child: Contract, reach: Supports<'_>) -> Result<Contract, String> {
        if [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y].into_iter().any(|side| reach(side) == f64::INFINITY) {
            return Err("the shape to be curled has no bound across z; intersect it with a cylinder or a box".into());
        }
        if args[0] == 0.0 {
            return Ok(child);
        }
        Ok(Contract { outside: Metric::Implicit, inside: Metric::Implicit, lipschitz: None, ..child })
    }

    fn support(_args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        on_circle(direction, reach)
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [rate] = c.get();
        let (sin, cos) = (p.x * rate).sin_cos();
        vec3(p.x * cos - p.y * sin, p.x * sin + p.y * cos, p.z)
    }
}
