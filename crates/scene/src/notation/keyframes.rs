//! Keyframes: numbers that are given at some times, and go from one to the next between them.

use crate::names::TIME;
use crate::notation::{Flag, Notation, formula_or_number_schema, index_of};
use crate::reader::{Reader, span};
use crate::suggest::listed;
use crate::syntax::Written;
use serde_json::{Value as Json, json};

/// The key by which an object is known to hold keyframes.
const KEYFRAMES: &str = "keyframes";

/// How values go from one keyframe to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Ease {
    /// Evenly, with corners.
    Linear,
    /// From rest to rest.
    Smooth,
    /// From rest, faster and faster.
    In,
    /// Slower and slower, to rest.
    Out,
    /// Along a curve without corners, whose slope at a keyframe is that between its neighbours (Catmull and Rom, "A Class of Local
    /// Interpolating Splines", 1974, for times at any distance).
    Spline,
    /// Not at all, until the next keyframe's time.
    Step,
}

const EASES: [(&str, Ease); 6] = [
    ("smooth", Ease::Smooth),
    ("linear", Ease::Linear),
    ("in", Ease::In),
    ("out", Ease::Out),
    ("spline", Ease::Spline),
    ("step", Ease::Step),
];

/// Whether a value is an object that holds keyframes.
pub(crate) fn are_keyframes(value: &Written<'_>) -> bool {
    value.as_object().is_some_and(|object| object.get(KEYFRAMES).is_some())
}

/// What keyframes say at the time of the scene: one number, or as many as `names` has for each.
pub(crate) fn keyed(reader: &mut Reader, value: &Written<'_>, names: Option<&[&'static str]>) -> Option<Vec<f64>> {
    reader.names.note(&[TIME.to_owned()]);
    let entries = reader.entries(value, &[KEYFRAMES, "ease", "loop"])?;
    let written = entries.require(reader, KEYFRAMES, "a list of times with values")?;
    let ease = match entries.get("ease") {
        None => Some(Ease::Smooth),
        Some(ease) => reader.labelled("`ease`".into(), |reader| match ease {
            Written::StringLit(name) => {
                let index = index_of(reader, ease, &name.value, EASES.iter().map(|(name, _)| *name))?;
                Some(EASES[index].1)
            }
            _ => {
                let names = listed(EASES.iter().map(|(name, _)| *name));
                reader.mistyped(ease, &format!("one of {names}"), None);
                None
            }
        }),
    };
    let is_loop = match entries.get("loop") {
        None => Some(false),
        Some(flag) => reader.labelled("`loop`".into(), |reader| Flag.read(reader, flag)),
    };
    let frames = frames(reader, written, names)?;
    Some(Keyframes { frames, ease: ease?, is_loop: is_loop? }.at(reader.names.time()))
}

/// The times with their values, which must rise.
fn frames(reader: &mut Reader, written: &Written<'_>, names: Option<&[&'static str]>) -> Option<Vec<(f64, Vec<f64>)>> {
    let what = if names.is_some() { "[time, [...]]" } else { "[time, number]" };
    let outer = reader.label().to_owned();
    let Written::Array(array) = written else {
        reader.labelled(format!("`{KEYFRAMES}` of {outer}"), |reader| {
            reader.mistyped(written, &format!("a list of {what}"), None);
        });
        return None;
    };
    if array.elements.len() < 2 {
        reader.error(span(written), format!("`{KEYFRAMES}` of {outer} needs two entries at least"), None);
        return None;
    }
    let mut frames: Vec<(f64, Vec<f64>)> = Vec::new();
    let mut is_sound = true;
    for (number, element) in (1..).zip(&array.elements) {
        let label = format!("keyframe {number} of {outer}");
        let frame = reader.labelled(label, |reader| {
            let pair = element.as_array().filter(|pair| pair.elements.len() == 2);
            let Some(pair) = pair else {
                reader.mistyped(element, what, None);
                return None;
            };
            let time = reader.plain_number(&pair.elements[0])?;
            let value = match names {
                None => vec![reader.plain_number(&pair.elements[1])?],
                Some(names) => reader.list(&pair.elements[1], names)?,
            };
            if let Some((before, _)) = frames.last().filter(|(before, _)| *before >= time) {
                let message = format!("{} is at the time {time}, which is not after {before}", reader.label());
                reader.error(span(&pair.elements[0]), message, None);
                return None;
            }
            Some((time, value))
        });
        is_sound &= frame.is_some();
        frames.extend(frame);
    }
    is_sound.then_some(frames)
}

/// Values at times.
struct Keyframes {
    frames: Vec<(f64, Vec<f64>)>,
    ease: Ease,
    is_loop: bool,
}

impl Keyframes {
    /// The value at a time: before the first keyframe that of the first, after the last one that of the last.
    fn at(&self, time: f64) -> Vec<f64> {
        let (first, last) = (&self.frames[0], &self.frames[self.frames.len() - 1]);
        let time = if self.is_loop { first.0 + (time - first.0).rem_euclid(last.0 - first.0) } else { time };
        let next = self.frames.partition_point(|(at, _)| *at <= time);
        let Some(index) = next.checked_sub(1) else { return first.1.clone() };
        let Some((to, after)) = self.frames.get(next) else { return last.1.clone() };
        let (from, before) = &self.frames[index];
        let length = to - from;
        let share = (time - from) / length;
        let mixed = |share: f64| before.iter().zip(after).map(|(a, b)| a + (b - a) * share).collect();
        match self.ease {
            Ease::Linear => mixed(share),
            Ease::Smooth => mixed(share * share * (3.0 - 2.0 * share)),
            Ease::In => mixed(share * share),
            Ease::Out => mixed(share * (2.0 - share)),
            Ease::Step => before.clone(),
            Ease::Spline => {
                let (at, rest) = (share, 1.0 - share);
                let slopes = [index, next].map(|frame| self.slope(frame));
                // The cubic with these values and slopes at its ends.
                let ends = before.iter().zip(after).zip(slopes[0].iter().zip(&slopes[1]));
                ends.map(|((a, b), (down, up))| {
                    let chord = a * rest * rest * (1.0 + 2.0 * at) + b * at * at * (1.0 + 2.0 * rest);
                    chord + length * (down * at * rest * rest - up * at * at * rest)
                })
                .collect()
            }
        }
    }

    /// How fast values change at a keyframe of a spline.
    fn slope(&self, index: usize) -> Vec<f64> {
        let last = self.frames.len() - 1;
        let slope = |from: &(f64, Vec<f64>), to: &(f64, Vec<f64>), length: f64| {
            from.1.iter().zip(&to.1).map(|(a, b)| (b - a) / length).collect()
        };
        let is_end = index == 0 || index == last;
        // A closed one goes on from its end.
        if is_end && self.is_loop && self.frames[0].1 == self.frames[last].1 {
            let (before, after) = (&self.frames[last - 1], &self.frames[1]);
            return slope(before, after, self.frames[last].0 - before.0 + after.0 - self.frames[0].0);
        }
        let (before, after) = (&self.frames[index.saturating_sub(1)], &self.frames[(index + 1).min(last)]);
        slope(before, after, after.0 - before.0)
    }
}

/// The name of the schema's definition of keyframes with so many numbers each.
pub(crate) fn definition(count: usize) -> String {
    if count == 1 { KEYFRAMES.into() } else { format!("{KEYFRAMES}_of_{count}") }
}

/// A reference to it.
pub(crate) fn reference(count: usize) -> Json {
    json!({ "$ref": format!("#/$defs/{}", definition(count)) })
}

/// The definitions that [`reference()`] names, for all counts that there are.
pub(crate) fn definitions() -> impl Iterator<Item = (String, Json)> {
    (1..=MOST_NUMBERS).map(|count| {
        let number = formula_or_number_schema;
        let list = json!({ "type": "array", "items": number(), "minItems": count, "maxItems": count });
        let value = if count == 1 { number() } else { list };
        let frame = json!({ "type": "array", "prefixItems": [number(), value], "minItems": 2, "maxItems": 2 });
        let schema = json!({
            "type": "object",
            "description": "Values at times, in seconds, and between them.",
            "properties": {
                KEYFRAMES: { "type": "array", "items": frame, "minItems": 2, "description": "Times with values." },
                "ease": {
                    "enum": EASES.map(|(name, _)| name),
                    "default": "smooth",
                    "description": "How values go from one keyframe to the next.",
                },
                "loop": {
                    "type": "boolean",
                    "default": false,
                    "description": "Whether they begin again after the last one.",
                },
            },
            "required": [KEYFRAMES],
            "additionalProperties": false,
        });
        (definition(count), schema)
    })
}

/// The longest lists of numbers that have names: quaternions.
const MOST_NUMBERS: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;

    fn keyframes(ease: Ease, is_loop: bool) -> Keyframes {
        let frames = [(1.0, 0.0), (2.0, 4.0), (4.0, 2.0), (5.0, 0.0)];
        Keyframes { frames: frames.iter().map(|&(t, v)| (t, vec![v, -v])).collect(), ease, is_loop }
    }

    #[test]
    fn all_eases_meet_the_keyframes_and_end_there() {
        for (_, ease) in EASES {
            let keyframes = keyframes(ease, false);
            for (time, value) in [(0.0, 0.0), (1.0, 0.0), (2.0, 4.0), (4.0, 2.0), (5.0, 0.0), (9.0, 0.0)] {
                assert_eq!(keyframes.at(time), [value, -value], "{ease:?} at {time}");
            }
            if ease != Ease::Step {
                let (before, after) = (keyframes.at(2.0 - 1e-9)[0], keyframes.at(2.0 + 1e-9)[0]);
                assert!((before - after).abs() < 1e-7, "{ease:?} jumps");
            }
        }
    }

    #[test]
    fn eases_go_as_they_are_called() {
        let at = |ease, time| keyframes(ease, false).at(time)[0];
        assert_eq!(at(Ease::Linear, 1.25), 1.0);
        assert_eq!(at(Ease::Smooth, 1.5), 2.0);
        assert_eq!(at(Ease::Smooth, 1.25), 4.0 * 0.15625);
        assert_eq!(at(Ease::In, 1.5), 1.0);
        assert_eq!(at(Ease::Out, 1.5), 3.0);
        assert_eq!(at(Ease::Step, 1.999), 0.0);
        assert_eq!(keyframes(Ease::Linear, true).at(1.25 + 3.0 * 4.0), keyframes(Ease::Linear, true).at(1.25));
        assert_eq!(keyframes(Ease::Linear, true).at(-2.75), [1.0, -1.0]);
    }

    #[test]
    fn splines_have_no_corners() {
        for (is_loop, times) in [(false, &[2.0, 4.0][..]), (true, &[2.0, 4.0, 5.0, 9.0])] {
            let at = |time: f64| keyframes(Ease::Spline, is_loop).at(time)[0];
            for &time in times {
                let step = 1e-6;
                let (before, after) = ((at(time) - at(time - step)) / step, (at(time + step) - at(time)) / step);
                assert!((before - after).abs() < 1e-4, "at {time}: {before} and {after}");
            }
        }
        // Of values on a line, it is the line; the slope at a keyframe is that between its neighbours.
        let line = Keyframes {
            frames: [0.0, 1.0, 3.0, 4.0].map(|t| (t, vec![2.0 * t])).to_vec(),
            ease: Ease::Spline,
            is_loop: false,
        };
        assert!((line.at(2.2)[0] - 4.4).abs() < 1e-12);
        assert!((keyframes(Ease::Spline, false).slope(1)[0] - 2.0 / 3.0).abs() < 1e-12);
    }
}
