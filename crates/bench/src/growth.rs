//! How time and memory grow with the number of objects.
//!
//! Each count is measured in a process of its own, so that its peak memory can be told.

use crate::measure::{Clock, median, peak_memory};
use crate::scattered::{self, Kind, Light};
use crate::table::short;
use freikugel::render::{Options, Renderer};
use serde_json::{Value as Json, json};
use std::process::{Command, Stdio};

/// The counts of the table.
pub const COUNTS: [usize; 5] = [10, 100, 1_000, 10_000, 100_000];

/// The heading of the table.
pub const HEADING: &str = "\
| rounded boxes | read | compile | first picture, 1 thread | next picture, 1 thread | first, all threads | next, all threads | peak memory |
|---|---|---|---|---|---|---|---|
";

/// The name of a count, for the choice of rows.
pub fn name(count: usize) -> String {
    format!("growth: {count} rounded boxes")
}

/// Measures one count in this process: milliseconds to read the scene and to compile it, both in processor time; and for a
/// picture of camera rays and normals at 640 x 360, in processor time on one thread and from start to end on `threads` of
/// them. The first picture of a renderer makes the cells, the next ones find them there. And bytes of memory.
///
/// # Errors
/// If the scene that was made can't be read.
pub fn measure(count: usize, threads: usize, runs: usize) -> Result<Json, String> {
    let text = scattered::scene(count, Kind::Boxes, None, Light::Ambient);
    let start = Clock::Thread.now();
    let scene = freikugel::scene::read(&text).into_result().map_err(|faults| faults[0].message.clone())?;
    let read = Clock::Thread.now() - start;
    let mut compile = Vec::new();
    let mut times: [Vec<f64>; 4] = Default::default();
    for _ in 0..runs {
        for (place, (threads, clock)) in [(1, Clock::Thread), (threads, Clock::Wall)].into_iter().enumerate() {
            let start = Clock::Thread.now();
            let renderer = Renderer::new(&scene).map_err(|error| error.to_string())?;
            compile.push((Clock::Thread.now() - start).as_secs_f64());
            let options = Options { threads: Some(threads), ..Options::of(&scene) };
            for times in &mut times[2 * place..2 * place + 2] {
                let start = clock.now();
                renderer.layers(&options, &()).map_err(|error| error.to_string())?;
                times.push((clock.now() - start).as_secs_f64());
            }
        }
    }
    let milliseconds = |times: &[f64]| median(times) * 1e3;
    Ok(json!({
        "count": count,
        "read_ms": read.as_secs_f64() * 1e3,
        "compile_ms": milliseconds(&compile),
        "first_cpu_ms": milliseconds(&times[0]),
        "next_cpu_ms": milliseconds(&times[1]),
        "first_wall_ms": milliseconds(&times[2]),
        "next_wall_ms": milliseconds(&times[3]),
        "threads": threads,
        "peak_bytes": peak_memory(),
    }))
}

/// Has a process of its own measure a count.
///
/// # Errors
/// What went wrong.
pub fn in_process(count: usize, threads: usize, runs: usize) -> Result<Json, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new(own)
        .args(["grow", &count.to_string(), "--threads", &threads.to_string(), "--runs", &runs.to_string()])
        .stdin(Stdio::null())
        .output()
        .map_err(|error| error.to_string())?;
    match output.status.success() {
        true => serde_json::from_slice(&output.stdout).map_err(|error| error.to_string()),
        false => Err(String::from_utf8_lossy(&output.stderr).trim().to_owned()),
    }
}

/// One line of the table.
pub fn markdown(count: usize, figures: &Result<Json, String>) -> String {
    match figures {
        Err(reason) => format!("| {count} | {reason} | | | | | | |\n"),
        Ok(figures) => {
            let number = |key: &str| figures[key].as_f64().unwrap_or(f64::NAN);
            format!(
                "| {count} | {} ms | {} ms | {} ms | {} ms | {} ms | {} ms | {} MB |\n",
                short(number("read_ms")),
                short(number("compile_ms")),
                short(number("first_cpu_ms")),
                short(number("next_cpu_ms")),
                short(number("first_wall_ms")),
                short(number("next_wall_ms")),
                short(number("peak_bytes") / 1e6)
            )
        }
    }
}
