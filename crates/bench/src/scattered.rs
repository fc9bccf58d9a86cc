//! Large scenes: many small primitives, scattered over a cube.
//!
//! The centres lie anywhere in the cube from -1 to 1. Sizes are random up to a share of 0.9 / cube root of the count, the mean
//! distance between neighbours, so that the picture is equally dense for any count. The same count and kind give the
//! same scene, byte by byte.

use std::fmt::Write;

/// What is scattered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// Cubes with rounded edges.
    Boxes,
    /// Balls.
    Spheres,
    /// Cubes, balls, rings and rods.
    Mixed,
}

/// How the scene is lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// By ambient light alone, without occlusion.
    Ambient,
    /// By a sun with hard shadows and by ambient light with occlusion, above a floor.
    Sun,
}

/// The largest number of primitives: more would exceed the largest scene file that the command reads.
pub const MOST: usize = 300_000;

/// The same for any count, so that scenes can be told apart by that alone.
const SEED: u64 = 0x9E37_79B9_7F4A_7C15;

/// The height of the floor: below all primitives of scenes of ten or more, none of which is higher than 0.5.
const FLOOR: f64 = -1.5;

/// The colours in turn.
const COLORS: [&str; 5] = ["#c8825a", "#6d8fb3", "#93a86c", "#d6b65c", "#a07aa6"];

/// Numbers from 0 to 1 by Marsaglia, "Xorshift RNGs" (2003).
pub(crate) struct Random(u64);

impl Default for Random {
    fn default() -> Self {
        Self(SEED)
    }
}

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f64 / (1_u64 << 24) as f64
    }
}

/// The text of a scene of `count` primitives: an object each, or with `blend` one object that blends all within this
/// distance. Unlit ones have no lights besides the ambient one, so that camera rays are all there is to trace.
pub fn scene(count: usize, kind: Kind, blend: Option<f64>, light: Light) -> String {
    let mut random = Random::default();
    let spacing = 0.9 / (count.max(1) as f64).cbrt();
    let mut text = String::from(
        "{\n  \"version\": 1,\n  \"picture\": { \"width\": 640, \"height\": 360, \"samples\": 1 },\n  \
         \"camera\": { \"eye\": [1.5, -1.7, 0.9], \"target\": [0, 0, 0], \"fov\": 62 },\n  \
         ",
    );
    text += match light {
        Light::Ambient => {
            "\"ambient\": { \"sky\": [1, 1, 1], \"ground\": [0.2, 0.2, 0.25] },\n  \
             \"occlusion\": false,\n  \"lights\": [],\n  "
        }
        Light::Sun => {
            "\"ambient\": { \"sky\": [0.25, 0.27, 0.3], \"ground\": [0.15, 0.13, 0.12] },\n  \
             \"occlusion\": { \"strength\": 1, \"reach\": 0.3 },\n  \
             \"lights\": [ { \"sun\": { \"direction\": [0.5, -0.8, 1.4], \"shadow\": true } } ],\n  "
        }
    };
    text += "\"materials\": {\n";
    for (index, color) in COLORS.iter().enumerate() {
        let comma = if index + 1 < COLORS.len() { "," } else { "" };
        let _ = writeln!(text, "    \"{index}\": {{ \"color\": \"{color}\" }}{comma}");
    }
    text += "  },\n  \"objects\": [\n";
    if light == Light::Sun {
        let _ = writeln!(text, r#"    {{ "shape": {{ "plane": {{ "offset": {FLOOR} }} }} }},"#);
    }
    if let Some(blend) = blend {
        let _ = writeln!(
            text,
            "    {{ \"material\": \"0\", \"shape\": {{ \"smooth_union\": {{ \"k\": {blend}, \"shapes\": ["
        );
    }
    for index in 0..count {
        let [x, y, z] = [(); 3].map(|()| random.next() * 2.0 - 1.0);
        let core = spacing * 0.6 * random.next();
        let round = spacing * (0.15 + 0.35 * random.next());
        let half = core + round;
        let shape = match (kind, index % 4) {
            (Kind::Boxes, _) | (Kind::Mixed, 0) => {
                let size = 2.0 * half;
                format!(r#""box": {{ "size": [{size:.6}, {size:.6}, {size:.6}], "round": {round:.6} }}"#)
            }
            (Kind::Spheres, _) | (Kind::Mixed, 1) => format!(r#""sphere": {{ "radius": {half:.6} }}"#),
            (Kind::Mixed, 2) => {
                format!(r#""torus": {{ "major": {half:.6}, "minor": {:.6} }}"#, round / 2.0)
            }
            (Kind::Mixed, _) => {
                format!(r#""cylinder": {{ "radius": {:.6}, "height": {:.6} }}"#, half / 2.0, 2.0 * half)
            }
        };
        let placed = format!(r#"{{ "translate": {{ "by": [{x:.6}, {y:.6}, {z:.6}], "shape": {{ {shape} }} }} }}"#);
        let comma = if index + 1 < count { "," } else { "" };
        let _ = match blend {
            Some(_) => writeln!(text, "      {placed}{comma}"),
            None => writeln!(text, "    {{ \"material\": \"{}\", \"shape\": {placed} }}{comma}", index % COLORS.len()),
        };
    }
    if blend.is_some() {
        text += "    ] } } }\n";
    }
    text + "  ]\n}\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenes_of_frame_rates_are_as_this_writes_them() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/gpu");
        for count in [10, 20, 100, 300] {
            let path = folder.join(format!("primitives-{count}.json"));
            let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            assert!(text == scene(count, Kind::Mixed, None, Light::Sun), "{}", path.display());
        }
    }
}
