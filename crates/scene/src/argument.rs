//! What the chaining methods take: anything that plainly stands for a value.

use crate::{Falloff, Method, Model, Overbright, Rgb, Shadow};
use freikugel_field::Triple;
use glam::DVec3;

/// A value that stands for a `T` where one is set in code: `2` and `2.0` for a number, `[1, -1, 2]` for a direction,
/// `"#c8825a"` for a colour.
pub trait Argument<T> {
    /// The `T`.
    fn value(self) -> T;
}

macro_rules! numbers {
    ($($From:ty => $($To:ty),+;)+) => {$($(
        impl Argument<$To> for $From {
            fn value(self) -> $To {
                self as $To
            }
        }
    )+)+};
}

numbers! {
    i32 => f32, f64;
    u32 => f32, f64, u32;
    f32 => f32, f64;
    f64 => f32, f64;
}

macro_rules! themselves {
    ($($Type:ty),+) => {$(
        impl Argument<$Type> for $Type {
            fn value(self) -> $Type {
                self
            }
        }
    )+};
}

themselves!(Rgb, Shadow, Falloff, Method, Model, Overbright);

impl<V: Into<Triple>> Argument<DVec3> for V {
    fn value(self) -> DVec3 {
        DVec3::from_array(self.into().0.map(freikugel_field::Value::number))
    }
}
