//! All that lies between two parallel planes. Exact.

use crate::shape_prelude::*;

/// See [`slab`].
#[derive(Clone, Copy, Debug)]
pub struct Slab;

/// The descriptor of [`slab`].
pub static SLAB: Shape = Shape::primitive::<Slab>();

/// All that lies within half of a thickness from the plane through the origin across the z axis.
#[track_caller]
pub fn slab(thickness: impl Into<Value>) -> Form<Slab> {
    Form::new(&SLAB, [thickness.into()])
}

impl Primitive for Slab {
    const ABOUT: About = About {
        name: "slab",
        summary: "A plate without edges: all between two parallel planes, its middle at the origin.",
        params: &[Param::required("thickness", ParamKind::Positive, "Distance of the two planes."), AXIS],
        elsewhere: &["plate", "thick plane"],
        example: r#"{ "intersection": [ { "sphere": { "radius": 1 } }, { "slab": { "thickness": 0.8 } } ] }"#,
    };

    fn prepare(args: &[f64]) -> Vec<f64> {
        vec![args[0] / 2.0]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        if direction.x == 0.0 && direction.y == 0.0 {
            (args[0] / 2.0 + level) * direction.z.abs()
        } else {
            f64::INFINITY
        }
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [half] = c.get();
        p.z.abs() - half
    }
}
