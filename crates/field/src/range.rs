//! The range of a program's values over a box, as narrow as one likes to see it.
//!
//! One enclosure of a whole box is wide where a formula repeats its variables. The part of the box with the largest bound is split
//! until that bound comes near a value that the field really has (interval branch and bound; Hansen and Walster, "Global Optimization
//! Using Interval Analysis", 2004).

use crate::program::Program;
use crate::scalar::Interval;
use crate::slope::{Part, halves};
use std::collections::BinaryHeap;

/// A bound this near to a value that was found, as a share of the spread of values, is good enough.
const GOOD_ENOUGH: f64 = 1e-3;

/// Into how many parts a box is divided at most, for each end of the range.
const MOST_PARTS: usize = 2048;

/// Along each side of the box, values are looked at in so many places to begin with.
const PLACES: u32 = 8;

impl Program {
    /// What the field's values over a box lie between, in the coordinates of the world. Both ends are no farther out than a thousandth
    /// of the spread of values, unless the field is so intricate there that the search stops early.
    pub fn range_over(&self, region: [Interval; 3]) -> Interval {
        let known = self.sampled(region);
        let slack = GOOD_ENOUGH * (known[1] - known[0]);
        let most = |sign: f64, known: f64| {
            let bound = |region: [Interval; 3]| {
                let values = self.interval(region);
                if sign > 0.0 { values.hi() } else { -values.lo() }
            };
            let mut known = known;
            let mut parts = BinaryHeap::from([Part { bound: bound(region), region }]);
            for _ in 0..MOST_PARTS {
                let Some(&Part { bound: above, region }) = parts.peek() else { break };
                let halves = halves(region, region.map(Interval::width)).filter(|_| above - known > slack);
                let Some(halves) = halves else { break };
                parts.pop();
                for half in halves {
                    let value = sign * self.value(half.map(Interval::middle).into());
                    known = known.max(value);
                    parts.push(Part { bound: bound(half), region: half });
                }
            }
            parts.peek().map_or(known, |part| part.bound)
        };
        let (low, high) = (-most(-1.0, -known[0]), most(1.0, known[1]));
        if low <= high { Interval::new(low, high) } else { Interval::new(f64::NEG_INFINITY, f64::INFINITY) }
    }

    /// The least and the largest of some values in a box; of none, infinities.
    fn sampled(&self, region: [Interval; 3]) -> [f64; 2] {
        let places = |side: Interval| {
            let count = if side.width() > 0.0 { PLACES } else { 0 };
            (0..=count).map(move |place| side.lo() + side.width() * (f64::from(place) / f64::from(count.max(1))))
        };
        let [x, y, z] = region;
        let points = places(x).flat_map(|x| places(y).flat_map(move |y| places(z).map(move |z| [x, y, z])));
        let values = points.map(|point| self.value(point.into())).filter(|value| !value.is_nan());
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
    }
}
