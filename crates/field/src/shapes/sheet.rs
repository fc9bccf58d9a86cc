//! Plane without thickness, seen from both sides. Exact, unsigned.

use super::plane::{PLANE_PARAMS, prepare_plane, support_of_plane};
use crate::shape_prelude::*;

/// See [`sheet`].
#[derive(Clone, Copy, Debug)]
pub struct Sheet;

/// The descriptor of [`sheet`].
pub static SHEET: Shape = Shape::primitive::<Sheet>();

/// The plane through the origin that this vector is normal to, as a sheet without thickness.
#[track_caller]
pub fn sheet(normal: impl Into<Triple>) -> Form<Sheet> {
    Form::new(&SHEET, normal.into().0)
}

impl Form<Sheet> {
    /// Moves the plane this far along its normal.
    #[must_use]
    pub fn offset_by(self, offset: impl Into<Value>) -> Self {
        self.with("offset", &[offset.into()])
    }
}

impl Primitive for Sheet {
    const ABOUT: About = About {
        name: "sheet",
        summary: "A plane without thickness. It has no inside; give it one with `offset` before cutting with it.",
        params: PLANE_PARAMS,
        elsewhere: &["unsigned plane"],
        example: r#"{ "intersection": [ { "sphere": { "radius": 1 } }, { "sheet": { "normal": [1, 0, 2] } } ] }"#,
    };

    fn exact_form(args: &[f64]) -> Option<ExactForm> {
        Some(ExactForm::Sheet { normal: DVec3::from_slice(args).normalize(), offset: args[3] })
    }

    fn contract(_args: &[f64]) -> Contract {
        Contract::SHEET
    }

    fn prepare(args: &[f64]) -> Vec<f64> {
        prepare_plane(args)
    }

    fn support(args: &[f64], direction: DVec3, level: f64) -> f64 {
        let back = [-args[0], -args[1], -args[2], -args[3]];
        support_of_plane(args, direction, level).min(support_of_plane(&back, direction, level))
    }

    #[inline(always)]
    fn distance<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> S {
        let [x, y, z, offset] = c.get();
        (p.dot(vec3(x, y, z)) - offset).abs()
    }
}
