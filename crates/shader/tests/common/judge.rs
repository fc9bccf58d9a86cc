//! How much pictures of one scene by different processors may differ.

use freikugel_scene::Scene;

/// How much a picture may differ on the mean over all channels, of 255.
pub(crate) const MEAN: f64 = 0.5;

/// How far a channel of a pixel may be off, of 255, unless its pixel counts as an outlier.
pub(crate) const FAR: u8 = 8;

/// The part of the pixels that may be outliers: a ray that grazes an edge may hit it on one processor and miss it on the other,
/// since they are rounded differently.
pub(crate) const OUTLIERS: f64 = 1e-3;

/// What is as fine as a pixel everywhere, such as a fractal, looks different as soon as rays stop elsewhere within their
/// tolerance. There the CPU is compared with itself, going steps of this length, and the difference between the processors may
/// be this many times as large.
const OTHER_STEPS: f64 = 0.95;
const RESTLESS: f64 = 2.0;

/// How much two pictures differ.
pub(crate) struct Difference {
    pub(crate) mean: f64,
    pub(crate) outliers: usize,
    pub(crate) pixels: usize,
}

impl Difference {
    /// Of pictures as bytes, three for each pixel.
    pub(crate) fn of(a: &[u8], b: &[u8]) -> Self {
        assert_eq!(a.len(), b.len());
        let off: Vec<u8> = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).collect();
        Self {
            mean: off.iter().map(|&channel| f64::from(channel)).sum::<f64>() / off.len() as f64,
            outliers: off.chunks_exact(3).filter(|pixel| pixel.iter().any(|&channel| channel > FAR)).count(),
            pixels: off.len() / 3,
        }
    }

    /// Whether it is more than this mean, or this part of outliers.
    pub(crate) fn exceeds(&self, mean: f64, outliers: f64) -> bool {
        self.mean > mean || self.outliers as f64 > outliers * self.pixels as f64
    }

    /// Whether it is more than pictures of this scene may differ, the CPU's of which is `expected` and comes from `on_cpu`.
    pub(crate) fn is_too_large(&self, scene: &Scene, expected: &[u8], on_cpu: impl Fn(&Scene) -> Vec<u8>) -> bool {
        if !self.exceeds(MEAN, OUTLIERS) {
            return false;
        }
        let mut other = scene.clone();
        other.tracer.step_factor *= OTHER_STEPS;
        let own = Self::of(&on_cpu(&other), expected);
        println!("    the CPU differs from itself by {:.4} in {} pixels", own.mean, own.outliers);
        self.mean > MEAN.max(RESTLESS * own.mean) || self.outliers as f64 > RESTLESS * own.outliers as f64
    }
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { mean, outliers, pixels } = self;
        write!(f, "mean {mean:.4} of 255, {outliers} of {pixels} pixels off by more than {FAR}")
    }
}
