//! `freikugel compare`: the tracers beside each other on one scene.

use super::frame::{Frame, Watch, cannot_render, cannot_write, open, output_path};
use super::given::Given;
use super::interrupt::Interrupt;
use super::sheet::{Bitmap, Color, Sheet, Tile, wrapped};
use super::{Failure, input, print};
use freikugel::render::{Comparison, Options, Outcome, Tone, Trial, Verdict, compare, render};
use freikugel::scene::{Method, Scene};
use std::fmt::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  freikugel compare cup.json                     prints the table, writes cup-compare.png
  freikugel compare cup.json -o sheet.png        the same, to another file
  freikugel compare cup.json -o folder           besides the sheet, each picture as a file of its own
  freikugel compare cup.json --json figures.json

One ray goes through the centre of each pixel. A pixel is missed if the guaranteed tracer finds a surface there that
the method goes through; false, if the method stops where there is none. Rays that come as near to a surface as the
tolerance without running through it count as grazing: both answers are right.";

/// Compare all tracers on a scene: steps, field evaluations, time, and wrong pixels.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The scene file, or - for standard input.
    scene: PathBuf,
    #[command(flatten)]
    given: Given,
    /// The contact sheet, a .png, or a folder for it and for each picture on it; by default the scene's name with
    /// -compare.png, in the current folder.
    #[arg(short, long, value_name = "FILE or FOLDER")]
    output: Option<PathBuf>,
    /// Write the table to this file, as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// How often each tracer runs; the time is the median.
    #[arg(long, value_name = "COUNT", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
    runs: u16,
    #[command(flatten)]
    frame: Frame,
    /// Show no progress and no summary; the table is printed all the same.
    #[arg(short, long)]
    quiet: bool,
}

/// From no steps to the most.
const HEAT: [Color; 6] = [[4, 4, 14], [58, 22, 106], [150, 40, 112], [225, 82, 60], [250, 165, 45], [253, 245, 190]];

/// Colours of pixels that differ, and what they are called.
const MARKS: [(Verdict, Color, &str); 5] = [
    (Verdict::Missed, [225, 30, 45], "missed"),
    (Verdict::False, [20, 110, 230], "false"),
    (Verdict::Grazing, [235, 190, 0], "grazing"),
    (Verdict::Unresolved, [225, 40, 220], "unresolved"),
    (Verdict::Unjudged, [0, 160, 150], "unresolved by the guaranteed tracer, too"),
];

/// Rays a pixel of the pictures, if the scene has more: they only show what the figures are about.
const MOST_SAMPLES: u32 = 4;

/// How much of a picture's contrast is left below the marks.
const FADING: f32 = 0.35;

/// Compares the tracers, prints the table, and writes the pictures.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = input::scene(&arguments.scene, &arguments.given.inputs())?;
    let target = output_path(arguments.output.as_deref(), &arguments.scene, "-compare.png")?;
    let is_picture = target.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("png"));
    let options = arguments.frame.over(Options::of(&scene));
    options.region().map_err(|error| Failure::Usage(error.to_string()))?;
    if !is_picture {
        std::fs::create_dir_all(&target).map_err(|error| cannot_write(&target, &error))?;
    }
    let interrupt = Interrupt::listen();
    let sheet_path = if is_picture { target.clone() } else { target.join("sheet.png") };
    let sheet_file = open(&sheet_path, &interrupt)?;
    let json_file = arguments.json.as_deref().map(|path| open(path, &interrupt)).transpose()?;

    let watch = Watch::new(arguments.quiet, &interrupt);
    let compared = compare(&scene, &options, &Method::ALL, usize::from(arguments.runs), &watch);
    let comparison = compared.map_err(cannot_render)?;
    let options = Options { samples: options.samples.min(MOST_SAMPLES), ..options };
    let mut pictures = Vec::new();
    for trial in &comparison.trials {
        let scene = Scene { tracer: scene.tracer.clone().method(trial.method), ..scene.clone() };
        let picture = match trial.outcome {
            Ok(_) => Some(render(&scene, &options, &watch).map_err(cannot_render)?),
            Err(_) => None,
        };
        pictures.push(picture.map(|picture| Bitmap::of(&picture.image, &Tone::of(&scene.picture))));
    }
    watch.bar.finish_and_clear();

    print(&table(&comparison))?;
    if let (Some(file), Some(path)) = (json_file, &arguments.json) {
        file.write(figures(&comparison).as_bytes()).map_err(|error| cannot_write(path, &error))?;
    }
    let name = arguments.scene.file_name().map_or("scene".into(), |name| name.to_string_lossy());
    let (sheet, parts) = sheet(&name, &comparison, &pictures);
    let encode = |bitmap: &Bitmap| bitmap.encode().map_err(|error| Failure::Input(error.to_string()));
    if !is_picture {
        for (name, bitmap) in &parts {
            let path = target.join(name);
            open(&path, &interrupt)?.write(&encode(bitmap)?).map_err(|error| cannot_write(&path, &error))?;
        }
    }
    sheet_file.write(&encode(&sheet.draw())?).map_err(|error| cannot_write(&sheet_path, &error))?;
    if !arguments.quiet {
        eprintln!("{}", sheet_path.display());
    }
    Ok(())
}

/// The figures in aligned columns.
fn table(comparison: &Comparison) -> String {
    const HEADS: [&str; 10] =
        ["steps", "most", "evaluations", "ms", "hits", "unresolved", "missed", "false", "grazing", "unjudged"];
    let cells = |outcome: &Outcome| {
        let count = |verdict| outcome.count(verdict).to_string();
        [
            format!("{:.2}", outcome.mean_steps),
            outcome.most_steps.to_string(),
            outcome.stats.evaluations.to_string(),
            format!("{:.1}", 1e3 * outcome.time.as_secs_f64()),
            outcome.stats.hits.to_string(),
            outcome.stats.unresolved.pixels.to_string(),
            count(Verdict::Missed),
            count(Verdict::False),
            count(Verdict::Grazing),
            count(Verdict::Unjudged),
        ]
    };
    let rows: Vec<(&Trial, Option<[String; 10]>)> =
        comparison.trials.iter().map(|trial| (trial, trial.outcome.as_ref().ok().map(cells))).collect();
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|(_, cells)| Some(cells.as_ref()?[column].len()));
        cells.chain([HEADS[column].len()]).max().unwrap_or(0)
    };
    let mut text = format!("{:10}", "tracer");
    for (column, head) in HEADS.iter().enumerate() {
        let _ = write!(text, "  {head:>width$}", width = width(column));
    }
    text.push('\n');
    for (trial, cells) in &rows {
        let _ = write!(text, "{:10}", trial.method.name());
        match (cells, &trial.outcome) {
            (Some(cells), _) => {
                for (column, cell) in cells.iter().enumerate() {
                    let _ = write!(text, "  {cell:>width$}", width = width(column));
                }
            }
            (None, outcome) => {
                let _ = write!(text, "  {}", outcome.as_ref().err().map_or("", String::as_str));
            }
        }
        text.push('\n');
    }
    text
}

/// The figures as JSON.
fn figures(comparison: &Comparison) -> String {
    let tracers: serde_json::Map<_, _> = comparison
        .trials
        .iter()
        .map(|Trial { method, outcome }| {
            let value = match outcome {
                Err(reason) => serde_json::json!({ "can_not_be_used": reason }),
                Ok(outcome) => serde_json::json!({
                    "steps": { "mean": outcome.mean_steps, "most": outcome.most_steps },
                    "field_evaluations": outcome.stats.evaluations,
                    "seconds": outcome.time.as_secs_f64(),
                    "hits": outcome.stats.hits,
                    "unresolved": outcome.stats.unresolved.pixels,
                    "missed": outcome.count(Verdict::Missed),
                    "false": outcome.count(Verdict::False),
                    "grazing": outcome.count(Verdict::Grazing),
                    "unjudged": outcome.count(Verdict::Unjudged),
                }),
            };
            (method.name().to_owned(), value)
        })
        .collect();
    let value = serde_json::json!({ "width": comparison.width, "height": comparison.height, "tracers": tracers });
    format!("{value:#}\n")
}

/// The contact sheet, and the pictures on it by the names of their files.
fn sheet(name: &str, comparison: &Comparison, pictures: &[Option<Bitmap>]) -> (Sheet, Vec<(String, Bitmap)>) {
    let (width, height) = (comparison.width, comparison.height);
    let outcomes = || comparison.trials.iter().filter_map(|trial| trial.outcome.as_ref().ok());
    let most = outcomes().map(|outcome| outcome.most_steps).max().unwrap_or(1).max(1);
    let mut rows = ["picture", "steps", "differences"].map(|label| (label.to_owned(), Vec::new()));
    let mut parts = Vec::new();
    for (trial, picture) in comparison.trials.iter().zip(pictures) {
        let (Ok(outcome), Some(picture)) = (&trial.outcome, picture) else {
            let reason = trial.outcome.as_ref().err().map_or("", String::as_str);
            for (row, (_, tiles)) in rows.iter_mut().enumerate() {
                let caption = if row + 1 == 3 { wrapped(reason, width) } else { Vec::new() };
                tiles.push(Tile { picture: Bitmap::filled(width, height, [226, 225, 221]), caption });
            }
            continue;
        };
        let steps = Bitmap {
            width,
            height,
            pixels: outcome.layers.pixels().iter().map(|pixel| heat(pixel.steps, most)).collect(),
        };
        let marked = picture.pixels.iter().zip(&outcome.verdicts).map(|(&color, verdict)| {
            MARKS.iter().find(|(of, ..)| of == verdict).map_or(faded(color), |&(_, mark, _)| mark)
        });
        let differences = Bitmap { width, height, pixels: marked.collect() };
        for ((label, tiles), bitmap) in rows.iter_mut().zip([picture.clone(), steps, differences]) {
            parts.push((format!("{}-{label}.png", trial.method.name()), bitmap.clone()));
            tiles.push(Tile { picture: bitmap, caption: Vec::new() });
        }
        let caption = &mut rows[2].1.last_mut().expect("just added").caption;
        *caption = vec![
            format!("{:.1} steps, {} at most", outcome.mean_steps, outcome.most_steps),
            format!("{} evaluations", short(outcome.stats.evaluations)),
            format!("{} missed, {} false", outcome.count(Verdict::Missed), outcome.count(Verdict::False)),
            format!("{} grazing", outcome.count(Verdict::Grazing)),
            format!("{} unresolved", outcome.stats.unresolved.pixels),
        ];
    }
    let ticks = [0, 1, 3, 10, 30, 100, 300, 1000, 3000, 10_000, 100_000, 1_000_000];
    let scale = ticks.iter().filter(|&&tick| tick <= most).map(|&tick| (heat(tick, most), format!("{tick}")));
    let mut scale: Vec<(Color, String)> = scale.collect();
    if let Some((_, text)) = scale.last_mut() {
        text.push_str(" steps");
    }
    let is_seen = |verdict| outcomes().any(|outcome| outcome.count(verdict) > 0);
    let marks = MARKS.iter().filter(|&&(verdict, ..)| is_seen(verdict));
    let marks: Vec<(Color, String)> = marks.map(|&(_, color, text)| (color, text.to_owned())).collect();
    let legend = [scale, marks].into_iter().filter(|line| !line.is_empty()).collect();
    let columns = comparison.trials.iter().map(|trial| trial.method.name().to_owned()).collect();
    (Sheet { title: format!("{name}: all tracers"), legend, columns, rows: rows.into() }, parts)
}

/// A count in a few digits.
fn short(count: u64) -> String {
    match count {
        0..10_000 => count.to_string(),
        10_000..10_000_000 => format!("{:.0} k", count as f64 / 1e3),
        _ => format!("{:.0} M", count as f64 / 1e6),
    }
}

/// The colour of a number of steps, on a logarithmic scale.
fn heat(steps: u32, most: u32) -> Color {
    let share = f64::from(steps).ln_1p() / f64::from(most).ln_1p();
    let place = share.clamp(0.0, 1.0) * (HEAT.len() - 1) as f64;
    let below = (place as usize).min(HEAT.len() - 2);
    let part = place - below as f64;
    let between = |channel: usize| {
        let (low, high) = (f64::from(HEAT[below][channel]), f64::from(HEAT[below + 1][channel]));
        (low + (high - low) * part).round() as u8
    };
    [between(0), between(1), between(2)]
}

/// Grey, and lighter.
fn faded(color: Color) -> Color {
    let [r, g, b] = color.map(f32::from);
    let grey = 0.3 * r + 0.6 * g + 0.1 * b;
    [(255.0 - FADING * (255.0 - grey)) as u8; 3]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_steps_are_brighter() {
        let brightness = |steps| heat(steps, 1000).iter().map(|&channel| u32::from(channel)).sum::<u32>();
        let ladder: Vec<u32> = [0, 1, 2, 5, 10, 30, 100, 300, 1000].map(brightness).into();
        assert!(ladder.is_sorted_by(|a, b| a < b), "{ladder:?}");
        assert_eq!((heat(0, 1000), heat(1000, 1000), heat(5000, 1000)), (HEAT[0], HEAT[5], HEAT[5]));
    }
}
