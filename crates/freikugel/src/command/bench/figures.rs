//! Frame rates as lines of a table in Markdown, and as JSON.

use super::Measured;
use serde_json::{Value as Json, json};
use std::time::Duration;

/// The heading of the table. Frame rates are those of single frames, so that their mean is not the inverse of the mean time.
pub(super) const HEADING: &str = "\
| scene | by | frames/s: min | max | mean | deviation | ms: min | max | mean | deviation | prepare, ms | pipelines, ms | first frame, ms | CPU time a frame, ms |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|
";

/// A scene on one processor.
#[derive(Debug)]
pub(in super::super) struct Row {
    scene: String,
    by: String,
    prepared: Duration,
    pipelines: Option<Duration>,
    first: Duration,
    rates: Spread,
    milliseconds: Spread,
    frames: usize,
    processor: Option<f64>,
}

/// How some numbers are spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spread {
    min: f64,
    max: f64,
    mean: f64,
    /// The standard deviation of a sample: 0 for a single number.
    deviation: f64,
}

impl Spread {
    /// The spread of one number or more.
    fn of(numbers: impl Iterator<Item = f64> + Clone) -> Self {
        let count = numbers.clone().count() as f64;
        let mean = numbers.clone().sum::<f64>() / count;
        let squares: f64 = numbers.clone().map(|number| (number - mean).powi(2)).sum();
        Self {
            min: numbers.clone().fold(f64::INFINITY, f64::min),
            max: numbers.fold(f64::NEG_INFINITY, f64::max),
            mean,
            deviation: if count > 1.0 { (squares / (count - 1.0)).sqrt() } else { 0.0 },
        }
    }

    fn cells(self) -> String {
        [self.min, self.max, self.mean, self.deviation].map(short).join(" | ")
    }

    fn json(self) -> Json {
        json!({ "min": self.min, "max": self.max, "mean": self.mean, "deviation": self.deviation })
    }
}

impl Row {
    /// The figures of a scene: what was measured, and how long it took to prepare it, and to make pipelines if there are any.
    pub(in super::super) fn new(
        scene: &str,
        by: &str,
        prepared: Duration,
        pipelines: Option<Duration>,
        measured: &Measured,
    ) -> Self {
        // A clock may be too coarse for a frame.
        let seconds = measured.seconds.iter().map(|seconds| seconds.max(1e-9));
        Self {
            scene: scene.to_owned(),
            by: by.to_owned(),
            prepared,
            pipelines,
            first: measured.first,
            rates: Spread::of(seconds.clone().map(f64::recip)),
            milliseconds: Spread::of(seconds.map(|seconds| 1e3 * seconds)),
            frames: measured.seconds.len(),
            processor: measured.processor,
        }
    }

    /// A line of the table.
    pub(super) fn markdown(&self) -> String {
        let known = |milliseconds: Option<f64>| milliseconds.map_or("".into(), short);
        let once = [Some(ms(self.prepared)), self.pipelines.map(ms), Some(ms(self.first))].map(known).join(" | ");
        format!(
            "| {} | {} | {} | {} | {once} | {} |\n",
            self.scene,
            self.by,
            self.rates.cells(),
            self.milliseconds.cells(),
            known(self.processor.map(|seconds| 1e3 * seconds))
        )
    }

    /// All figures.
    pub(super) fn json(&self) -> Json {
        json!({
            "scene": self.scene,
            "by": self.by,
            "frames": self.frames,
            "frames_per_second": self.rates.json(),
            "milliseconds": self.milliseconds.json(),
            "prepare_ms": ms(self.prepared),
            "pipelines_ms": self.pipelines.map(ms),
            "first_frame_ms": ms(self.first),
            "cpu_time_ms": self.processor.map(|seconds| 1e3 * seconds),
        })
    }
}

fn ms(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// Three digits that count.
fn short(number: f64) -> String {
    let digits = if number == 0.0 || !number.is_finite() { 0.0 } else { number.abs().log10().floor() };
    format!("{number:.*}", (2.0 - digits).clamp(0.0, 4.0) as usize)
}

/// Clock ticks a second in what Linux reports about processes: the same on all processors that Rust supports there.
const TICKS: f64 = 100.0;

/// The processor time of all threads of this process in user mode so far, in seconds; `None` where the system does not say.
pub(super) fn processor_time() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program comes second, in parentheses, and may hold anything. The 14th field is the time.
    let (_, fields) = status.rsplit_once(')')?;
    Some(fields.split_whitespace().nth(11)?.parse::<f64>().ok()? / TICKS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_those_of_single_frames() {
        let measured =
            Measured { first: Duration::from_secs(1), seconds: vec![0.01, 0.02, 0.03, 0.04], processor: Some(0.05) };
        let row = Row::new("ball", "us", Duration::from_millis(5), Some(Duration::from_millis(7)), &measured);
        assert_eq!((row.rates.min, row.rates.max), (25.0, 100.0));
        assert!((row.rates.mean - (100.0 + 50.0 + 100.0 / 3.0 + 25.0) / 4.0).abs() < 1e-9);
        assert!((row.milliseconds.mean - 25.0).abs() < 1e-9);
        // Deviations of 15, 5, 5 and 15: the squares' sum is 500, a third of it is 166.7.
        assert!((row.milliseconds.deviation - (500.0f64 / 3.0).sqrt()).abs() < 1e-9);
        let line = row.markdown();
        assert_eq!(line.matches('|').count(), HEADING.lines().next().expect("a line").matches('|').count());
        assert!(line.ends_with("| 5.00 | 7.00 | 1000 | 50.0 |\n"), "{line}");
    }

    #[test]
    fn a_single_frame_has_no_deviation() {
        let spread = Spread::of([4.0].into_iter());
        assert_eq!(spread, Spread { min: 4.0, max: 4.0, mean: 4.0, deviation: 0.0 });
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn processor_time_grows_with_work() {
        let start = processor_time().expect("Linux tells");
        let mut sum = 0.0f64;
        while processor_time().expect("Linux tells") < start + 0.05 {
            (0..100_000).for_each(|i| sum += f64::from(i).sin());
        }
        assert!(sum.is_finite());
    }
}
