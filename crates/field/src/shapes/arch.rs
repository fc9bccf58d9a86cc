//! A rectangle with a round top. Exact.

use super::outline::{Outline, closed};
use crate::shape_prelude::*;
use std::f64::consts::PI;

/// See [`arch`].
#[derive(Clone, Copy, Debug)]
pub struct Arch;

/// The descriptor of [`arch`].
pub static ARCH: Shape = Shape::special::<Arch>();

/// A rectangle whose upper side is replaced by a half disc. Its box is centred at the origin.
#[track_caller]
pub fn arch(width: impl Into<Value>, height: impl Into<Value>) -> Form<Arch> {
    Form::new(&ARCH, [width.into(), height.into()])
}

impl Special for Arch {
    type General = Outline;

    const ABOUT: About = About {
        name: "arch",
        summary: "A plane figure: a rectangle with a half disc on top.",
        params: &[Param::required(
            "size",
            ParamKind::Size2,
            "Full width, and full height with the round top; the height must exceed half the width.",
        )],
        elsewhere: &["sdTunnel", "tunnel", "door", "mailbox"],
        example: r#"{ "extrude": { "height": 0.4, "shape": { "arch": { "size": [1.2, 1.6] } } } }"#,
    };

    fn check(args: &[f64]) -> Result<(), String> {
        let &[width, height] = args else { unreachable!("two numbers") };
        if height <= width / 2.0 {
            return Err("the height of `arch` must be above half its width; for less use `circle_segment`".into());
        }
        Ok(())
    }

    fn general(args: &[f64]) -> Vec<f64> {
        let &[width, height] = args else { unreachable!("two numbers") };
        let (right, top) = (width / 2.0, (height - width) / 2.0);
        closed(&[[-right, -height / 2.0, 0.0], [right, -height / 2.0, 0.0], [right, top, PI], [-right, top, 0.0]])
    }
}
