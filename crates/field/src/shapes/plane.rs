//! Half-space bounded by a plane. Exact.

use crate::shape_prelude::*;

/// See [`plane`].
#[derive(Clone, Copy, Debug)]
pub struct Plane;

/// The descriptor of [`plane`].
pub static PLANE: Shape = Shape::primitive::<Plane>();

/// Everything behind the plane through the origin that this vector is normal to.
#[track_caller]
pub fn plane(normal: impl Into<Triple>) -> Form<Plane> {
    Form::new(&PLANE, normal.into().0)
}

impl Form<Plane> {
    /// Moves the plane this far along its normal.
    #[must_use]
    pub fn offset_by(self, offset: impl Into<Value>) -> Self {
        self.with("offset", &[offset.into()])
    }
}

/// The parameters of a plane.
pub(crate) const PLANE_PARAMS: &[Param] = &[
    Param::optional("normal", ParamKind::Direction, &[0.0, 0.0, 1.0], "Points out of the plane."),
    Param::optional("offset", ParamKind::Number, &[0.0], "Distance of the plane from the origin, along its normal."),
];

/// Unit normal and offset.
pub(crate) fn prepare_plane(args: &[f64]) -> Vec<f64> {
    let normal = DVec3::from_slice(args).normalize();
    vec![normal.x, normal.y, normal.z, args[3]]
}

/// Two unit vectors closer than this point the same way.
const SAME_DIRECTION: f64 = 1e-12;

/// How far the plane moved by `level` reaches along a direction: finite only along its normal.
pub(crate) fn support_of_plane(args: &[f64], direction: DVec3, level: f64) -> f64 {
    let normal = DVec3::from_slice(args).normalize();
    let length = direction.length();
    if length > 0.0 && normal.cross(direction / length).length() < SAME_DIRECTION && normal.dot(direction) > 0.0 {
        (args[3] + level) * length
    } else {
        f64::INFINITY
    }
}

impl Primitive for Plane {
    const ABOUT: About = About {
        name: "plane",
        summary: "The half-space behind a plane. By default everything below z = 0.",
        params: PLANE_PARAMS,
        elsewhere: &["half_space", "ground", "sdPlane"],
        example: r#"{ "intersection": [ { "sphere": { "radius": 1 } }, { "plane": { "normal": [1, 0, 2], "offset": 0.2 } } ] }"#,
    };

    const MODELS: Option<PrimitiveKernel> = Some(primitive_models::<Self>);

    fn exact_form(args: &[f64]) -> Option<ExactForm> {
        Some(ExactForm::HalfSpace { normal: DVec3::from_slice(args).normalize(), offset: args[3] })
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        prepare_plane(args)
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        support_of_plane(args, direction, level)
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [x, y, z, offset] = c.get();
        p.dot(vec3(x, y, z)) - offset
    }
}
