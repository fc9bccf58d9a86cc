//! Repetition in a grid with chance displacements and turns: a union of copies, so that it is right for shapes of any size and
//! place.
//!
//! Chance comes from a hash of the seed, the copy's place in the grid, and what is asked for: the finaliser of SplitMix64 (Steele,
//! Lea and Flood, "Fast Splittable Pseudorandom Number Generators", 2014) after each of these numbers. It is the same everywhere,
//! and a copy keeps its own when others are added beyond it.

use super::repeat::{COUNT, SPACING, cell, copies, place};
use super::rotate::ROTATE;
use super::translate::TRANSLATE;
use crate::shape_prelude::*;
use std::ops::Range;

/// See [`RepeatVaried::repeat_varied`].
#[derive(Clone, Copy, Debug)]
pub struct Varied;

/// The descriptor of [`RepeatVaried::repeat_varied`].
pub static REPEAT_VARIED: Shape = Shape::copies::<Varied>();

/// Copies of a shape in rows, columns and layers that are not quite regular.
pub trait RepeatVaried: Into<Field> {
    /// As [`Repeat::repeat`](super::repeat::Repeat::repeat), each copy displaced by up to `jitter` along each axis. `with("turn",
    /// ...)` also turns them by up to this angle in radians, about `axis`; another `seed` gives others.
    #[track_caller]
    fn repeat_varied(self, spacing: impl Into<Triple>, count: [u32; 3], jitter: impl Into<Triple>) -> Field {
        let numbers = spacing.into().0.into_iter().chain(count.map(Value::from)).chain(jitter.into().0);
        Field::new(&REPEAT_VARIED, numbers, [self.into()])
    }
}

impl<F: Into<Field>> RepeatVaried for F {}

impl Copies for Varied {
    const ABOUT: About = About {
        name: "repeat_varied",
        summary: "Copies of a shape in rows, columns and layers around the origin, displaced and turned by chance. They may overlap.",
        params: &[
            SPACING,
            COUNT,
            Param::optional(
                "jitter",
                ParamKind::Lengths,
                &[0.0; 3],
                "How far copies are displaced at most, to either side along x, y and z.",
            ),
            Param::optional(
                "turn",
                ParamKind::Angle,
                &[0.0],
                "Degrees by which copies are turned at most, in either direction; 180 for any direction.",
            ),
            Param::optional(
                "seed",
                ParamKind::Count(0, u32::MAX),
                &[0.0],
                "Which of many arrangements: the same number always gives the same.",
            ),
            Param { about: "The axis that copies are turned about.", ..AXIS },
        ],
        elsewhere: &["tile with variation", "jittered repetition", "random_repeat"],
        example: r#"{ "repeat_varied": { "spacing": [0.55, 0.55, 0], "count": [4, 4, 1], "jitter": [0.1, 0.1, 0.05], "turn": 40, "shape":
            { "box": { "size": [0.36, 0.3, 0.4], "round": 0.04 } } } }"#,
    };

    const COUNTED: Range<usize> = 3..6;

    fn count(args: &[f64]) -> usize {
        copies(args)
    }

    fn places(args: &[f64], index: usize) -> Vec<PlaceCall> {
        let (jitter, &[turn, seed, axis]) = (&args[6..9], &args[9..]) else { unreachable!("three numbers more") };
        let cell = cell(args, index);
        let chance = |of: u64| chance(seed as u64, cell, of);
        let at = [0, 1, 2].map(|along| place(args, cell, along) + jitter[along] * chance(along as u64));
        let turned = [&DVec3::AXES[axis as usize].to_array()[..], &[turn * chance(3)]].concat();
        vec![(&TRANSLATE, at.to_vec()), (&ROTATE, turned)]
    }
}

/// A number from -1 to 1, evenly spread.
fn chance(seed: u64, cell: [usize; 3], of: u64) -> f64 {
    let bits =
        cell.into_iter().map(|place| place as u64).chain([of]).fold(mixed(seed), |hash, next| mixed(hash ^ next));
    // As many bits as fractions of double precision have.
    (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// The next number of SplitMix64 after the state `bits`.
fn mixed(bits: u64) -> u64 {
    let bits = bits.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^ (bits >> 31)
}
