//! Where a pixel's rays go: filter importance sampling (Ernst, Stamminger, Greiner 2006).
//!
//! Offsets from the pixel's centre are drawn from the reconstruction filter's own distribution, so that all
//! rays weigh the same, a pixel depends on no ray of its neighbours, and a crop equals a cut of the whole
//! picture. The filter is the four-term Blackman-Harris window, 3 pixels wide in each direction: as sharp as
//! a filter without negative lobes can be at that width, hence no ringing around bright edges, and its side
//! lobes of -92 dB leave nothing of what would alias. The points of the unit square behind the offsets are
//! a rank-1 lattice with the golden ratio, the same for each pixel: noise-free, and well spread for any count.

use glam::DVec2;
use std::f64::consts::TAU;

/// Full width of the filter in pixels.
const SUPPORT: f64 = 3.0;

/// The window's cosine terms (Harris 1978, minimum four-term).
const TERMS: [f64; 4] = [0.35875, 0.48829, 0.14128, 0.01168];

/// The fractional part of the golden ratio, whose multiples spread best over the unit interval.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Halvings of the support that find an offset to the last bit.
const HALVINGS: u32 = 60;

/// Offsets of `count` rays from the pixel's centre, in pixels. Their mean is 0, so that no picture is shifted;
/// a single one is exactly 0. All back ends use these, in this order, so that their pictures can be compared.
pub fn offsets(count: u32) -> Vec<DVec2> {
    if count == 1 {
        return vec![DVec2::ZERO];
    }
    let mut offsets: Vec<DVec2> = (0..count)
        .map(|index| {
            let place = f64::from(index) + 0.5;
            DVec2::new(offset_at(place / f64::from(count)), offset_at((place * GOLDEN).fract()))
        })
        .collect();
    let mean = offsets.iter().sum::<DVec2>() / f64::from(count);
    for offset in &mut offsets {
        *offset -= mean;
    }
    offsets
}

/// The offset below which a share of `quantile` of the filter lies.
fn offset_at(quantile: f64) -> f64 {
    let (mut low, mut high) = (-SUPPORT / 2.0, SUPPORT / 2.0);
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        if share_below(middle) < quantile {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low + high) / 2.0
}

/// The share of the filter below `offset`: the window's integral in closed form.
fn share_below(offset: f64) -> f64 {
    let x = offset / SUPPORT;
    let waves = (1..4).map(|order| {
        let frequency = TAU * order as f64;
        TERMS[order] * libm::sin(frequency * x) / frequency
    });
    x + 0.5 + waves.sum::<f64>() / TERMS[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_ray_goes_through_the_centre_and_many_around_it() {
        assert_eq!(offsets(1), [DVec2::ZERO]);
        for count in [2, 3, 4, 9, 16, 64, 1000] {
            let offsets = offsets(count);
            let mean = offsets.iter().sum::<DVec2>() / f64::from(count);
            assert!(mean.length() < 1e-12, "{count}: {mean}");
            assert!(offsets.iter().all(|o| o.abs().max_element() < SUPPORT / 2.0 + 0.2), "{count}");
        }
    }

    #[test]
    fn rays_follow_the_window() {
        // The window itself, summed over each tenth of its width, against the rays that land there.
        let window = |x: f64| (0..4).map(|order| TERMS[order] * (TAU * order as f64 * x / SUPPORT).cos()).sum::<f64>();
        let count = 40_000;
        let offsets = offsets(count);
        let cells = 10;
        for axis in 0..2 {
            for cell in 0..cells {
                let low = SUPPORT * (cell as f64 / cells as f64 - 0.5);
                let high = low + SUPPORT / cells as f64;
                let steps = 1000;
                let width = (high - low) / steps as f64;
                let expected = (0..steps).map(|step| window(low + (step as f64 + 0.5) * width) * width).sum::<f64>()
                    / (TERMS[0] * SUPPORT);
                let inside = offsets.iter().filter(|o| o[axis] >= low && o[axis] < high).count();
                let share = inside as f64 / f64::from(count);
                assert!((share - expected).abs() < 2e-4, "{axis} {cell}: {share} {expected}");
            }
        }
    }

    #[test]
    fn any_box_gets_its_share_of_lattice_points() {
        // The points behind the offsets, found again by the filter's integral.
        for count in [16u32, 25, 64, 256] {
            let points: Vec<DVec2> = (0..count)
                .map(|index| {
                    let place = f64::from(index) + 0.5;
                    DVec2::new(place / f64::from(count), (place * GOLDEN).fract())
                })
                .collect();
            let mut worst = 0.0f64;
            for corner in &points {
                let below = points.iter().filter(|p| p.x <= corner.x && p.y <= corner.y).count();
                worst = worst.max((below as f64 / f64::from(count) - corner.x * corner.y).abs());
            }
            // Random points would be off by about 1 / sqrt(count); these by about log(count) / count.
            let bound = 1.2 * f64::from(count).ln() / f64::from(count);
            assert!(worst < bound, "{count}: {worst} {bound}");
        }
    }
}
