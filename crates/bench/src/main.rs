//! The benchmark's command.

#![forbid(unsafe_code)]

use clap::{Parser, Subcommand};
use freikugel_bench::scattered::{self, Kind, Light};
use freikugel_bench::{evaluation, growth, measure::Row, nearest, picture, table, whole};
use serde_json::{Value as Json, json};
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  freikugel-bench --data models --json figures.json
  freikugel-bench --filter csg20 --runs 21
  freikugel-bench scene 10000 -o ten-thousand.json";

/// Measures Freikugel and its peers in turns, and prints a table in Markdown.
#[derive(Debug, Parser)]
#[command(name = "freikugel-bench", version, about, after_help = EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Job>,
    /// A folder with models: prospero.vm, hi.vm and colonnade.vm.
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Only work whose name contains this.
    #[arg(long, value_name = "NAME", default_value = "")]
    filter: String,
    /// How often each contender does each work.
    #[arg(long, value_name = "COUNT", default_value_t = 11, value_parser = clap::value_parser!(u32).range(1..))]
    runs: u32,
    /// With how many threads pictures are computed, besides one.
    #[arg(long, value_name = "COUNTS", value_delimiter = ',', default_value = "1,2")]
    threads: Vec<usize>,
    /// Also write all figures to this file.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
enum Job {
    /// Write a scene of many scattered primitives.
    Scene {
        /// How many.
        #[arg(value_parser = clap::value_parser!(u32).range(1..=scattered::MOST as i64))]
        count: u32,
        /// What they are.
        #[arg(long, default_value = "boxes")]
        kind: Kind,
        /// Blend them all within this distance.
        #[arg(long, value_name = "DISTANCE", value_parser = parse_blend)]
        blend: Option<f64>,
        /// Add a floor and a sun with shadows, and ambient occlusion.
        #[arg(long = "lit")]
        is_lit: bool,
        /// The scene file; by default it goes to standard output.
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Measure one count of the growth table, and print it as JSON.
    #[command(hide = true)]
    Grow {
        count: usize,
        #[arg(long, default_value_t = 2)]
        threads: usize,
        #[arg(long, default_value_t = 5)]
        runs: usize,
    },
}

fn parse_blend(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(blend) if blend > 0.0 && blend.is_finite() => Ok(blend),
        _ => Err("give a distance above 0".into()),
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match arguments.command {
        None => run(&arguments),
        Some(Job::Scene { count, kind, blend, is_lit, ref output }) => {
            let text = scattered::scene(count as usize, kind, blend, if is_lit { Light::Sun } else { Light::Ambient });
            match output {
                Some(path) => std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display())),
                None => std::io::stdout().write_all(text.as_bytes()).map_err(|error| error.to_string()),
            }
        }
        Some(Job::Grow { count, threads, runs }) => {
            growth::measure(count, threads, runs).map(|figures| println!("{figures}"))
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("freikugel-bench: {reason}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let is_wanted = |name: &str| name.contains(&arguments.filter) || arguments.filter.contains(name);
    let others: Vec<usize> = arguments.threads.iter().copied().filter(|&threads| threads > 1).collect();
    let runs = arguments.runs as usize;
    let mut figures: Vec<Json> = Vec::new();
    println!("{}\n\n{}", machine(), table::HEADING.trim_end());
    let mut measure = |mut rows: Vec<Row<'_>>| {
        for row in &mut rows {
            let times = row.run(runs);
            print!("{}", table::markdown(row, &times));
            let _ = std::io::stdout().flush();
            figures.push(table::json(row, &times));
        }
    };
    measure(evaluation::rows(&is_wanted));
    measure(nearest::rows(&is_wanted));
    measure(picture::rows(&is_wanted, arguments.data.as_deref(), &others));
    measure(whole::rows(&is_wanted, &others));
    let counts: Vec<usize> = growth::COUNTS.into_iter().filter(|&count| is_wanted(&growth::name(count))).collect();
    let mut grown: Vec<Json> = Vec::new();
    if !counts.is_empty() {
        let threads = arguments.threads.iter().copied().max().unwrap_or(1);
        println!(
            "\nWith up to {threads} threads, 640 x 360, camera rays and normals:\n\n{}",
            growth::HEADING.trim_end()
        );
        for count in counts {
            let row = growth::in_process(count, threads, runs);
            print!("{}", growth::markdown(count, &row));
            let _ = std::io::stdout().flush();
            grown.extend(row.ok());
        }
    }
    if let Some(path) = &arguments.json {
        let all = json!({ "machine": machine(), "runs": runs, "rows": figures, "growth": grown });
        std::fs::write(path, format!("{all:#}\n")).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}

/// What the figures were measured on.
fn machine() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let value = |key: &str| {
        let line = info.lines().find(|line| line.split(':').next().is_some_and(|word| word.trim() == key))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    let model = value("model name").unwrap_or_else(|| "an unknown processor".into());
    let family = [value("cpu family"), value("model")].map(Option::unwrap_or_default);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let levels: Vec<&str> = freikugel::field::simd::available().into_iter().map(freikugel::field::simd::name).collect();
    format!(
        "{cores} cores, {model} (family {}, model {}), {}, {}",
        family[0],
        family[1],
        levels.join(", "),
        std::env::consts::OS
    )
}
