//! The cut through a body: a plane figure. A bound, since the body's nearest surface need not lie in the plane.

use crate::shape_prelude::*;

/// See [`CrossSection::cross_section`].
#[derive(Clone, Copy, Debug)]
pub struct Cut;

/// The descriptor of [`CrossSection::cross_section`].
pub static CROSS_SECTION: Shape = Shape::map::<Cut>();

/// Making a plane figure of a body.
pub trait CrossSection: Into<Field> {
    /// The figure that the body has in the plane across z at this height.
    #[track_caller]
    fn cross_section(self, height: impl Into<Value>) -> Field {
        Field::new(&CROSS_SECTION, [height.into()], [self.into()])
    }
}

impl<F: Into<Field>> CrossSection for F {}

impl Map for Cut {
    const ABOUT: About = About {
        name: "cross_section",
        summary: "Makes a plane figure of a body: the cut through it across the z axis. For other cuts, turn the body first.",
        params: &[Param::optional("height", ParamKind::Number, &[0.0], "The z of the cut.")],
        elsewhere: &["slice", "projection with cut", "section", "cut_plane"],
        example: r#"{ "extrude": { "height": 0.3, "shape": { "cross_section": { "height": 0.4, "shape": {
            "rotate": { "axis": [1, 0, 0], "angle": 90, "shape": { "torus": { "major": 0.7, "minor": 0.35 } } } } } } } }"#,
    };

    const GIVES: Dimension = Dimension::Plane;

    fn contract(_args: &[f64], child: Contract, _reach: Supports<'_>) -> Result<Contract, String> {
        Ok(child.at_most_bound())
    }

    fn support(_args: &[f64], direction: DVec3, reach: Supports<'_>) -> f64 {
        if direction.z == 0.0 { reach(direction) } else { f64::INFINITY }
    }

    #[inline(always)]
    fn map<S: Scalar>(p: Vec3<S>, c: &Constants<'_, S>) -> Vec3<S> {
        let [height] = c.get();
        vec3(p.x, p.y, height)
    }
}
