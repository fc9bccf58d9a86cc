//! What is evaluated and rendered.
//!
//! `csg20` and `many` are those of the example `throughput`. The fractals are formulas of which all iterations are written
//! out, without a test for points that have escaped, so that everybody computes the same.

use freikugel::field::{Field, Form, Formula, shapes};
use std::fmt::Write;

#[path = "../../field/examples/fields/mod.rs"]
mod shared;

pub use shared::{csg20, many};

/// The field of a formula, negative inside.
fn formula(text: &str) -> Field {
    let formula = Formula::parse(text).expect("the formulas are well-formed");
    Form::<shapes::Formula>::from(formula).into()
}

/// A gyroid of four periods in a sphere.
pub fn gyroid() -> Field {
    formula(
        "k = 4 pi; a = k * x; b = k * y; c = k * z;
         max(abs(sin(a) * cos(b) + sin(b) * cos(c) + sin(c) * cos(a)) - 0.4, hypot(x, y, z) - 0.9)",
    )
}

/// A quaternion Julia set: negative where the last of these many iterates is within 2 of the origin.
pub fn julia(iterations: usize) -> Field {
    let mut text = String::from("a0 = x; b0 = y; c0 = z; d0 = 0.1;\n");
    for last in 0..iterations {
        let next = last + 1;
        let _ = writeln!(
            text,
            "a{next} = a{last}^2 - b{last}^2 - c{last}^2 - d{last}^2 - 0.291; t{last} = 2a{last};
             b{next} = t{last} * b{last} - 0.399; c{next} = t{last} * c{last} + 0.339; d{next} = t{last} * d{last} + 0.437;"
        );
    }
    let _ = write!(text, "a{iterations}^2 + b{iterations}^2 + c{iterations}^2 + d{iterations}^2 - 4");
    formula(&text)
}

/// The Mandelbulb of power 8, by angles: negative where the last of these many iterates is within 2 of the origin.
pub fn mandelbulb(iterations: usize) -> Field {
    let mut text = String::from("x0 = x; y0 = y; z0 = z;\n");
    for last in 0..iterations {
        let next = last + 1;
        let _ = writeln!(
            text,
            "s{last} = x{last}^2 + y{last}^2; r{last} = (s{last} + z{last}^2)^4;
             u{last} = 8 atan2(sqrt(s{last}), z{last}); v{last} = 8 atan2(y{last}, x{last}); w{last} = r{last} * sin(u{last});
             x{next} = w{last} * cos(v{last}) + x; y{next} = w{last} * sin(v{last}) + y; z{next} = r{last} * cos(u{last}) + z;"
        );
    }
    let _ = write!(text, "x{iterations}^2 + y{iterations}^2 + z{iterations}^2 - 4");
    formula(&text)
}
