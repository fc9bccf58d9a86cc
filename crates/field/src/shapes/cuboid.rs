//! Box, optionally with rounded edges. Exact outside and inside.

use crate::shape_prelude::*;

/// See [`cuboid`].
#[derive(Clone, Copy, Debug)]
pub struct Cuboid;

/// The descriptor of [`cuboid`].
pub static BOX: Shape = Shape::primitive::<Cuboid>();

/// A box with these full edge lengths, its middle at the origin. (`box` is a word of the language.)
#[track_caller]
pub fn cuboid(size: impl Into<Triple>) -> Form<Cuboid> {
    Form::new(&BOX, size.into().0)
}

impl Form<Cuboid> {
    /// Rounds all edges with this radius; the size stays.
    #[must_use]
    pub fn round(self, radius: impl Into<Value>) -> Self {
        self.with("round", &[radius.into()])
    }
}

impl Primitive for Cuboid {
    const ABOUT: About = About {
        name: "box",
        summary: "A box with its middle at the origin.",
        params: &[
            Param::required("size", ParamKind::Size, "Full edge lengths along x, y and z."),
            Param::optional("round", ParamKind::Length, &[0.0], "Radius of the rounded edges; the size stays."),
        ],
        elsewhere: &["cube", "cuboid", "rounded_box", "sdBox", "sdRoundBox"],
        example: r#"{ "box": { "size": [1.6, 1.2, 0.8], "round": 0.1 } }"#,
    };

    const MODELS: Option<PrimitiveKernel> = Some(primitive_models::<Self>);

    fn check(args: &[f64]) -> Result<(), String> {
        let &[x, y, z, round] = args else { unreachable!("four numbers") };
        if round > x.min(y).min(z) / 2.0 {
            return Err("`round` of `box` must not exceed half the smallest edge".into());
        }
        Ok(())
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        let &[x, y, z, round] = args else { unreachable!("four numbers") };
        vec![x / 2.0 - round, y / 2.0 - round, z / 2.0 - round, round]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let core = DVec3::from_slice(args) / 2.0 - args[3];
        core.dot(direction.abs()) + (args[3] + level) * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [x, y, z, round] = c.get();
        let q = p.abs() - vec3(x, y, z);
        let zero = p.x.lift(0.0);
        let outside = S::length3(q.x.max(zero), q.y.max(zero), q.z.max(zero));
        outside + zero.min(q.x.max(q.y).max(q.z)) - round
    }
}
