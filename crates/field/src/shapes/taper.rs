//! Taper: cuts across z are scaled, evenly from one height to another.

use crate::shape_prelude::*;

/// See [`Taper::taper`].
#[derive(Clone, Copy, Debug)]
pub struct Tapering;

/// The descriptor of [`Taper::taper`].
pub static TAPER: Shape = Shape::map::<Tapering>();

/// Tapering a shape.
pub trait Taper: Into<Field> {
    /// The shape with cuts across z that are scaled: not at all below `from`, by the factor `scale` above `to`, and evenly between.
    #[track_caller]
    fn taper(self, from: impl Into<Value>, to: impl Into<Value>, scale: impl Into<Value>) -> Field {
        Field::new(&TAPER, [from.into(), to.into(), scale.into()], [self.into()])
    }
}

impl<F: Into<Field>> Taper for F {}

impl Map for Tapering {
    const ABOUT: About = About {
        name: "taper",
        summary: "Scales the cuts of a shape across z by a factor that changes evenly from one height to another.",
        params: &[
            Param::required("from", ParamKind::Number, "The height below which nothing changes."),
            Param::required("to", ParamKind::Number, "The height above which all cuts are scaled alike."),
            Param::required("scale", ParamKind::Positive, "The factor there."),
        ],
        elsewhere: &["linear taper", "taper_xy_z", "extrude with scale"],
        example: r#"{ "taper": { "from": -0.9, "to": 0.9, "scale": 0.4, "shape": { "box": { "size": [1.6, 1.2, 1.8] } } } }"#,
    };

    const IS_SHORT: bool = false;

    /// The height where it begins, one over the height of the change, and what the factor changes by.
    fn prepare(args: &[f64]) -> Vec<f64> {
        let &[from, to, scale] = args else { unreachable!("three numbers") };
        vec![from, 1.0 / (to - from), scale - 1.0]
    }

    fn contract(args: &[f64], child: Contract, reach: Supports<'_>) -> Result<Contract, String> {
        let &[from, to, scale] = args else { unreachable!("three numbers") };
        if to <= from {
            return Err("`from` of `taper` must be below `to`".into());
        }
        if [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y].into_iter().any(|side| reach(side) == f64::INFINITY) {
            return Err("the shape to be tapered has no bound across z; intersect it with a cylinder or a box".into());
        }
        if scale == 1.0 {
            return Ok(child);
        }
        Ok(Contract { outside: Metric::Implicit, inside: Metric::Implicit, lipschitz: None, ..child })
    }

    fn support(args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        let across = DVec3::new(direction.x, direction.y, 0.0);
        let flat = if across == DVec3::ZERO { 0.0 } else { reach(across) };
        let rise = if direction.z == 0.0 { 0.0 } else { reach(DVec3::Z * direction.z) };
        flat.max(flat * args[2]) + rise
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [from, inverse, change] = c.get();
        let one = p.x.lift(1.0);
        let share = ((p.z - from) * inverse).clamp(0.0, 1.0);
        let shrink = one / (one + share * change);
        vec3(p.x * shrink, p.y * shrink, p.z)
    }
}
