//! The edges of a box as bars. Exact outside.

use crate::shape_prelude::*;

/// See [`box_frame`].
#[derive(Clone, Copy, Debug)]
pub struct BoxFrame;

/// The descriptor of [`box_frame`].
pub static BOX_FRAME: Shape = Shape::primitive::<BoxFrame>();

/// The twelve edges of a box with these full edge lengths, as square bars of this thickness inside of it.
#[track_caller]
pub fn box_frame(size: impl Into<Triple>, thickness: impl Into<Value>) -> Form<BoxFrame> {
    let [x, y, z] = size.into().0;
    Form::new(&BOX_FRAME, [x, y, z, thickness.into()])
}

impl Primitive for BoxFrame {
    const ABOUT: About = About {
        name: "box_frame",
        summary: "The edges of a box as square bars, its middle at the origin.",
        params: &[
            Param::required("size", ParamKind::Size, "Full edge lengths of the box along x, y and z."),
            Param::required("thickness", ParamKind::Positive, "Thickness of the bars, which lie inside of the box."),
        ],
        elsewhere: &["wireframe_box", "sdBoxFrame"],
        example: r#"{ "box_frame": { "size": [1.6, 1.2, 1], "thickness": 0.15 } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[x, y, z, thickness] = args else { unreachable!("four numbers") };
        if thickness > x.min(y).min(z) / 2.0 {
            return Err("`thickness` of `box_frame` must not exceed half the smallest edge".into());
        }
        Ok(())
    }

    /// Half the edges of the box, and half the thickness of the bars.
    fn prepare(args: &[f64]) -> Vec<f64> {
        args.iter().map(|length| length / 2.0).collect()
    }

    fn contract(_args: &[f64]) -> Contract {
        // Where bars meet, the nearest surface is farther than that of each of them.
        Contract { inside: Metric::Bound, ..Contract::EXACT }
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        (DVec3::from_slice(args) / 2.0).dot(direction.abs()) + level * direction.length()
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [x, y, z, half] = c.get();
        let p = p.abs() - vec3(x, y, z);
        // Across the bars, from their middles.
        let q = (p + vec3(half, half, half)).abs() - vec3(half, half, half);
        bar(p.x, q.y, q.z).min(bar(q.x, p.y, q.z)).min(bar(q.x, q.y, p.z))
    }
}

/// The distance from a bar by those from its three pairs of sides.
#[inline(always)]
fn bar<S: Scalar>(x: S, y: S, z: S) -> S {
    let zero = x.lift(0.0);
    S::length3(x.max(zero), y.max(zero), z.max(zero)) + zero.min(x.max(y).max(z))
}
