//! Shell: a wall of some thickness around a shape's surface, |f| - t/2. Needs a distance; a bound changes its shape.

use crate::shape_prelude::*;

/// See [`Hollow::shell`].
#[derive(Clone, Copy, Debug)]
pub struct Shell;

/// The descriptor of [`Hollow::shell`].
pub static SHELL: Shape = Shape::modify::<Shell>();

/// Hollowing a shape.
pub trait Hollow: Into<Field> {
    /// A wall of this thickness, half of it on either side of the shape's surface.
    #[track_caller]
    fn shell(self, thickness: impl Into<Value>) -> Field {
        Field::new(&SHELL, [thickness.into()], [self.into()])
    }
}

impl<F: Into<Field>> Hollow for F {}

impl Modify for Shell {
    const ABOUT: About = About {
        name: "shell",
        summary: "A wall around a shape's surface, half of it on either side.",
        params: &[Param::required("thickness", ParamKind::Positive, "Thickness of the wall.")],
        elsewhere: &["onion", "annular"],
        example: r#"{ "difference": [ { "shell": { "thickness": 0.15, "shape": { "sphere": { "radius": 0.9 } } } },
            { "plane": { "normal": "-y" } } ] }"#,
    };

    fn prepare(args: &[f64]) -> Vec<f64> {
        vec![args[0] / 2.0]
    }

    fn contract(_args: &[f64], child: Contract) -> Result<Contract, String> {
        Ok(Contract {
            outside: if child.signed { child.outside.max(child.inside) } else { child.outside },
            inside: child.outside.max(child.inside).max(Metric::Bound),
            signed: true,
            ..child
        })
    }

    fn warning(_args: &[f64], child: Contract) -> Option<String> {
        (child.outside.max(child.inside) != Metric::Exact)
            .then(|| "the field under this shell is only a bound, so that the wall's thickness varies".into())
    }

    fn level(args: &[f64], level: f64) -> Option<f64> {
        Some(level + args[0] / 2.0)
    }

    #[inline(always)]
    fn modify<S: Scalar>(value: S, c: &Constants<'_, S>) -> S {
        let [half] = c.get();
        value.abs() - half
    }
}
