//! Sphere of which a plane has cut off a part. Exact.

use crate::shape_prelude::*;

/// See [`cut_sphere`].
#[derive(Clone, Copy, Debug)]
pub struct CutSphere;

/// The descriptor of [`cut_sphere`].
pub static CUT_SPHERE: Shape = Shape::primitive::<CutSphere>();

/// What of a sphere around the origin lies above z = `height`.
#[track_caller]
pub fn cut_sphere(radius: impl Into<Value>, height: impl Into<Value>) -> Form<CutSphere> {
    Form::new(&CUT_SPHERE, [radius.into(), height.into()])
}

impl Primitive for CutSphere {
    const ABOUT: About = About {
        name: "cut_sphere",
        summary: "What of a sphere around the origin lies above some height.",
        params: &[
            Param::required("radius", ParamKind::Positive, "Radius of the sphere."),
            Param::required(
                "height",
                ParamKind::Number,
                "Height of the cut along the axis; below 0 more than a half is left.",
            ),
            AXIS,
        ],
        elsewhere: &["sdCutSphere", "spherical cap", "hemisphere", "dome"],
        example: r#"{ "cut_sphere": { "radius": 0.9, "height": -0.2 } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        if args[1].abs() >= args[0] {
            Err("`height` of `cut_sphere` must lie within the sphere".into())
        } else {
            Ok(())
        }
    }

    /// The radius, the height, and the radius of the cut.
    fn prepare(args: &[f64]) -> Vec<f64> {
        vec![args[0], args[1], (args[0] * args[0] - args[1] * args[1]).sqrt()]
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let &[radius, height, _axis] = args else { unreachable!("three numbers") };
        let length = direction.length();
        // Where the sphere is farthest, if that is above the cut; otherwise on the rim.
        let farthest = if direction.z * radius >= height * length {
            radius * length
        } else {
            let rim = (radius * radius - height * height).sqrt();
            rim * libm::hypot(direction.x, direction.y) + height * direction.z
        };
        farthest + level * length
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [radius, height, rim] = c.get();
        let zero = p.x.lift(0.0);
        let across = S::length2(p.x, p.y);
        let of_sphere = S::length2(across, p.z) - radius;
        let of_cut = height - p.z;
        let of_rim = S::length2(across - rim, of_cut);
        // Outside: the sphere where the way from its middle passes above the rim, the cut below its disc, else the rim.
        let meets_cap = (across * height).lt(p.z * rim);
        let beside = S::select(across.lt(rim), of_cut, of_rim);
        let is_inside = of_sphere.lt(zero) & of_cut.lt(zero);
        let within = S::select(is_inside, of_sphere.max(of_cut), beside);
        S::select(meets_cap & !of_sphere.lt(zero), of_sphere, within)
    }
}
