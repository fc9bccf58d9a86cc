//! How long frames take: the least, the mean, the most, and how much they vary.

use std::collections::VecDeque;
use std::time::Duration;

/// The times of the last frames.
#[derive(Clone, Debug)]
pub struct FrameTimes {
    /// In seconds, the latest last.
    seconds: VecDeque<f64>,
    capacity: usize,
}

/// What some frames took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// How many frames.
    pub count: usize,
    /// The shortest, in seconds.
    pub min: f64,
    /// The mean, in seconds.
    pub mean: f64,
    /// The longest, in seconds.
    pub max: f64,
    /// The standard deviation of a sample, in seconds: 0 for a single frame.
    pub deviation: f64,
}

impl FrameTimes {
    /// Remembers as many frames.
    ///
    /// # Panics
    /// If `capacity` is 0.
    pub fn new(capacity: usize) -> Self {
        assert!(capacity > 0, "some frame must fit");
        Self { seconds: VecDeque::with_capacity(capacity), capacity }
    }

    /// Adds a frame, and forgets the oldest if there are too many.
    pub fn push(&mut self, time: Duration) {
        if self.seconds.len() == self.capacity {
            self.seconds.pop_front();
        }
        self.seconds.push_back(time.as_secs_f64());
    }

    /// Forgets all frames.
    pub fn clear(&mut self) {
        self.seconds.clear();
    }

    /// What they took, if there are any.
    pub fn summary(&self) -> Option<Summary> {
        let count = self.seconds.len();
        if count == 0 {
            return None;
        }
        let mean = self.seconds.iter().sum::<f64>() / count as f64;
        let squares: f64 = self.seconds.iter().map(|time| (time - mean).powi(2)).sum();
        Some(Summary {
            count,
            min: self.seconds.iter().copied().fold(f64::INFINITY, f64::min),
            mean,
            max: self.seconds.iter().copied().fold(0.0, f64::max),
            deviation: if count > 1 { (squares / (count - 1) as f64).sqrt() } else { 0.0 },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_is_that_of_the_last_frames() {
        let mut times = FrameTimes::new(4);
        assert_eq!(times.summary(), None);
        times.push(Duration::from_millis(500));
        let one = times.summary().expect("a frame");
        assert_eq!((one.count, one.min, one.mean, one.max, one.deviation), (1, 0.5, 0.5, 0.5, 0.0));
        for milliseconds in [10, 20, 30, 40] {
            times.push(Duration::from_millis(milliseconds));
        }
        let four = times.summary().expect("frames");
        assert_eq!((four.count, four.min, four.max), (4, 0.01, 0.04));
        assert!((four.mean - 0.025).abs() < 1e-12);
        // Deviations of 15, 5, 5 and 15: the squares' sum is 500, a third of it is 166.7.
        assert!((four.deviation - 0.001 * (500.0f64 / 3.0).sqrt()).abs() < 1e-12);
        times.clear();
        assert_eq!(times.summary(), None);
    }
}
