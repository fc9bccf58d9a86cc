//! Measuring: contenders take turns, and the median counts.

use nix::sys::resource::{UsageWho, getrusage};
use nix::time::{ClockId, clock_gettime};
use std::time::{Duration, Instant};

/// How long a sample must take at least, so that the clock's grain and the first touches of memory don't count.
const SHORTEST: Duration = Duration::from_millis(20);

/// What is measured of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// The processor time of the thread that does it, which other processes don't lengthen.
    Thread,
    /// From start to end.
    Wall,
    /// The processor time that finished child processes spent in user mode.
    Children,
}

impl Clock {
    /// What the clock shows.
    pub fn now(self) -> Duration {
        match self {
            Self::Thread => clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map_or(Duration::ZERO, Duration::from),
            Self::Wall => {
                static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
                START.get_or_init(Instant::now).elapsed()
            }
            Self::Children => getrusage(UsageWho::RUSAGE_CHILDREN).map_or(Duration::ZERO, |usage| {
                let time = usage.user_time();
                Duration::from_secs(time.tv_sec() as u64) + Duration::from_micros(time.tv_usec() as u64)
            }),
        }
    }
}

/// The largest amount of memory this process has had, in bytes.
pub fn peak_memory() -> u64 {
    // Linux counts in units of 1024 bytes.
    getrusage(UsageWho::RUSAGE_SELF).map_or(0, |usage| usage.max_rss() as u64 * 1024)
}

/// What the figures of a row mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Millions of points a second.
    Points(usize),
    /// Milliseconds.
    Milliseconds,
    /// Seconds.
    Seconds,
}

impl Unit {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Points(_) => "M points/s",
            Self::Milliseconds => "ms",
            Self::Seconds => "s",
        }
    }

    /// The figure for a time.
    pub fn figure(self, time: f64) -> f64 {
        match self {
            Self::Points(points) => points as f64 / time / 1e6,
            Self::Milliseconds => time * 1e3,
            Self::Seconds => time,
        }
    }
}

/// One way to do some work.
pub struct Contender<'a> {
    /// Who does it, and how.
    pub name: String,
    /// Does it once. What it says is wrong is printed instead of a figure.
    pub work: Box<dyn FnMut() -> Result<(), String> + 'a>,
    /// What is measured of it.
    pub clock: Clock,
}

impl<'a> Contender<'a> {
    /// Work that can't fail.
    pub fn new(name: impl Into<String>, clock: Clock, mut work: impl FnMut() + 'a) -> Self {
        let work = Box::new(move || {
            work();
            Ok(())
        });
        Self { name: name.into(), work, clock }
    }

    /// A contender that is not there.
    pub fn missing(name: impl Into<String>, reason: impl Into<String>) -> Self {
        let reason = reason.into();
        Self { name: name.into(), work: Box::new(move || Err(reason.clone())), clock: Clock::Wall }
    }
}

/// Some work, and all who do it.
pub struct Row<'a> {
    /// What is done.
    pub name: String,
    /// What its figures mean.
    pub unit: Unit,
    /// Who does it. The ratios of the others are to the first.
    pub contenders: Vec<Contender<'a>>,
}

/// Times of one contender in seconds, or why there are none.
pub type Times = Result<Vec<f64>, String>;

impl Row<'_> {
    /// Has each contender do the work `runs` times, in turns, after once for practice.
    pub fn run(&mut self, runs: usize) -> Vec<Times> {
        let mut repeats = vec![1_u32; self.contenders.len()];
        let mut times: Vec<Times> = self
            .contenders
            .iter_mut()
            .zip(&mut repeats)
            .map(|(contender, repeats)| {
                let start = Clock::Wall.now();
                (contender.work)()?;
                let once = (Clock::Wall.now() - start).max(Duration::from_nanos(100));
                if contender.clock != Clock::Children {
                    *repeats = (SHORTEST.as_secs_f64() / once.as_secs_f64()).ceil() as u32;
                }
                Ok(Vec::with_capacity(runs))
            })
            .collect();
        for _ in 0..runs {
            for ((contender, times), &repeats) in self.contenders.iter_mut().zip(&mut times).zip(&repeats) {
                let Ok(list) = times else { continue };
                let start = contender.clock.now();
                let outcome = (0..repeats).try_for_each(|_| (contender.work)());
                let time = contender.clock.now().saturating_sub(start);
                match outcome {
                    Ok(()) => list.push(time.as_secs_f64() / f64::from(repeats)),
                    Err(reason) => *times = Err(reason),
                }
            }
        }
        times
    }
}

/// The middle one of some times; the mean of the middle two where there are two.
pub fn median(times: &[f64]) -> f64 {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => f64::NAN,
        odd if odd % 2 == 1 => sorted[middle],
        _ => 0.5 * (sorted[middle - 1] + sorted[middle]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_are_in_the_middle() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn contenders_take_turns_and_a_missing_one_is_no_failure() {
        let order = std::cell::RefCell::new(String::new());
        let slow = |name: char| {
            let order = &order;
            Contender::new(name, Clock::Wall, move || {
                order.borrow_mut().push(name);
                std::thread::sleep(SHORTEST);
            })
        };
        let contenders = vec![slow('a'), Contender::missing("peer", "not installed"), slow('b')];
        let times = Row { name: "work".into(), unit: Unit::Milliseconds, contenders }.run(2);
        assert_eq!(*order.borrow(), "ababab");
        assert_eq!(times[1], Err("not installed".into()));
        for times in [&times[0], &times[2]] {
            let times = times.as_ref().expect("figures");
            assert_eq!(times.len(), 2);
            assert!(median(times) >= SHORTEST.as_secs_f64());
        }
    }
}
