//! `freikugel sweep`: one scene with several values of a number, or of two, as a contact sheet.

use super::frame::{Frame, Samples, Watch, cannot_render, cannot_write, open, output_path, parse_method};
use super::given::Given;
use super::interrupt::Interrupt;
use super::sheet::{Bitmap, Sheet, Tile};
use super::{Failure, input};
use freikugel::render::{Options, Tone, render};
use freikugel::scene::edit::{EditError, Path as Way, with_value};
use freikugel::scene::{Folder, Inputs, Method, Scene, Severity, read_at};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  freikugel sweep cup.json --vary tracer.max_steps=5,10,100              writes cup-sweep.png
  freikugel sweep cup.json --vary 'camera.eye[2]=1..5:9' --columns 3     nine heights from 1 to 5
  freikugel sweep cup.json --vary 'lights[0].sun.shadow.hardness=8,64' --vary 'objects[0].shape.sphere.radius=0.5,1'
  freikugel sweep cup.json --vary tracer.method=fixed,sphere,relaxed -o tracers.png

A value is addressed as in the file: keys after points, places in lists in brackets, from 0; a key that is no
plain word as [\"my clay\"]. Keys that the file leaves to their defaults can be set, too.";

/// Render a scene with several values of a number, or of two, as a labelled contact sheet.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The scene file, or - for standard input.
    scene: PathBuf,
    /// What to vary: a list of values, or FROM..TO:COUNT. Given twice, the first is varied from row to row, the second
    /// from column to column.
    #[arg(long, value_name = "PATH=VALUES", required = true, value_parser = parse_axis)]
    vary: Vec<Axis>,
    /// The sheet, a .png; by default the scene's name with -sweep.png, in the current folder.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Pictures in a row, if one thing is varied.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..))]
    columns: Option<u16>,
    #[command(flatten)]
    given: Given,
    #[command(flatten)]
    frame: Frame,
    #[command(flatten)]
    samples: Samples,
    /// How rays find surfaces, instead of the scene's way.
    #[arg(long, value_name = "NAME", value_parser = parse_method)]
    tracer: Option<Method>,
    /// Show no progress.
    #[arg(short, long)]
    quiet: bool,
}

/// More pictures are not looked at on one sheet.
const MOST_PICTURES: usize = 256;

/// Pictures in a row, unless someone says otherwise.
const MOST_IN_A_ROW: usize = 4;

/// A place in the scene with the values it takes.
#[derive(Clone, Debug)]
struct Axis {
    path: Way,
    /// JSON values, and how they are shown.
    values: Vec<(String, String)>,
}

fn parse_axis(text: &str) -> Result<Axis, String> {
    let (path, values) = text.split_once('=').ok_or("write PATH=VALUES, such as tracer.max_steps=5,10,100")?;
    let path = path.trim().parse().map_err(|error: freikugel::scene::edit::PathError| error.to_string())?;
    let mut found = Vec::new();
    for item in items(values) {
        match parse_range(item)? {
            Some(range) => found.extend(range),
            None => found.push((json_of(item), item.to_owned())),
        }
        if found.len() > MOST_PICTURES {
            return Err(format!("these are more than {MOST_PICTURES} values"));
        }
    }
    if found.is_empty() { Err("there are no values".into()) } else { Ok(Axis { path, values: found }) }
}

/// The parts between commas, but for those within brackets, braces or quotes.
fn items(text: &str) -> Vec<&str> {
    let (mut depth, mut is_quoted, mut start) = (0_i32, false, 0);
    let mut items = Vec::new();
    for (at, c) in text.char_indices() {
        match c {
            '"' => is_quoted = !is_quoted,
            '[' | '{' if !is_quoted => depth += 1,
            ']' | '}' if !is_quoted => depth -= 1,
            ',' if !is_quoted && depth == 0 => {
                items.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    items.push(&text[start..]);
    items.into_iter().map(str::trim).filter(|item| !item.is_empty()).collect()
}

/// The numbers of FROM..TO:COUNT, if it is one.
fn parse_range(item: &str) -> Result<Option<Vec<(String, String)>>, String> {
    let Some((from, rest)) = item.split_once("..") else { return Ok(None) };
    let fault = || format!("{item:?} is no range FROM..TO:COUNT such as 1..5:9");
    let (to, count) = rest.split_once(':').ok_or_else(fault)?;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(fault);
    let (from, to) = (number(from)?, number(to)?);
    let count: usize = count.trim().parse().map_err(|_| fault())?;
    if !(2..=MOST_PICTURES).contains(&count) {
        return Err(format!("a range has 2 to {MOST_PICTURES} values, not {count}"));
    }
    let at = |index: usize| {
        let number = from + (to - from) * (index as f64 / (count - 1) as f64);
        // Without the last digits, which are those of the division.
        let text = format!("{number:.8e}").parse().map_or(String::new(), |number: f64| number.to_string());
        (text.clone(), text)
    };
    Ok(Some((0..count).map(at).collect()))
}

/// A value as JSON: a word that is none stands for a text.
fn json_of(item: &str) -> String {
    match serde_json::from_str::<serde_json::Value>(item) {
        Ok(_) => item.to_owned(),
        Err(_) => serde_json::Value::from(item).to_string(),
    }
}

/// Renders all pictures and writes the sheet.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let path = output_path(arguments.output.as_deref(), &arguments.scene, "-sweep.png")?;
    if path.extension().is_none_or(|suffix| !suffix.eq_ignore_ascii_case("png")) {
        return Err(Failure::Usage(format!("{}: the suffix must be .png", path.display())));
    }
    let [rows, columns] = match &arguments.vary[..] {
        [only] => [None, Some(only)],
        [rows, columns] => [Some(rows), Some(columns)],
        more => return Err(Failure::Usage(format!("--vary is given {} times, but a sheet has two axes", more.len()))),
    };
    let pictures: usize = arguments.vary.iter().map(|axis| axis.values.len()).product();
    if pictures > MOST_PICTURES {
        return Err(Failure::Usage(format!("these are {pictures} pictures, but a sheet has {MOST_PICTURES} at most")));
    }
    let text = input::text(&arguments.scene)?;
    let name = input::name(&arguments.scene);
    let inputs = arguments.given.inputs();
    input::parsed(&text, &arguments.scene, &inputs)?;
    let columns = columns.expect("there is one axis at least");
    let one = [(String::new(), String::new())];
    let row_values = rows.map_or(&one[..], |rows| &rows.values);
    let mut scenes = Vec::new();
    for row in row_values {
        for column in &columns.values {
            let changes = rows.map(|rows| (&rows.path, row)).into_iter().chain([(&columns.path, column)]);
            let mut scene = changed(&text, &arguments.scene, &inputs, changes)?;
            scene.tracer.method = arguments.tracer.unwrap_or(scene.tracer.method);
            scenes.push(scene);
        }
    }

    let interrupt = Interrupt::listen();
    let file = open(&path, &interrupt)?;
    let mut tiles = Vec::new();
    for (index, scene) in scenes.iter().enumerate() {
        let options = arguments.samples.over(arguments.frame.over(Options::of(scene)));
        let watch = Watch::new(arguments.quiet, &interrupt);
        let rendered = render(scene, &options, &watch);
        watch.bar.finish_and_clear();
        let rendered = rendered.map_err(cannot_render)?;
        let unresolved = rendered.stats.unresolved.pixels;
        let mut caption = Vec::new();
        if rows.is_none() {
            caption.push(labelled(columns, index));
        }
        if unresolved > 0 {
            let share = 100.0 * unresolved as f64 / rendered.image.pixels().len() as f64;
            caption.push(format!("{share:.2} % unresolved"));
        }
        tiles.push(Tile { picture: Bitmap::of(&rendered.image, &Tone::of(&scene.picture)), caption });
    }
    let stem = arguments.scene.file_name().map_or(name, |name| name.to_string_lossy().into_owned());
    let sheet = match rows {
        None => {
            let count = tiles.len();
            // Rows as full as can be.
            let in_a_row = usize::from(arguments.columns.unwrap_or(0));
            let in_a_row = if in_a_row > 0 { in_a_row } else { count.div_ceil(count.div_ceil(MOST_IN_A_ROW)) };
            let rows = tiles.chunks(in_a_row).map(|row| (String::new(), row.to_vec())).collect();
            Sheet { title: format!("{stem}: {}", columns.path), rows, ..Sheet::default() }
        }
        Some(rows) => Sheet {
            title: format!("{stem}: {} by {}", rows.path, columns.path),
            columns: (0..columns.values.len()).map(|index| labelled(columns, index)).collect(),
            rows: tiles
                .chunks(columns.values.len())
                .enumerate()
                .map(|(index, tiles)| (labelled(rows, index), tiles.to_vec()))
                .collect(),
            ..Sheet::default()
        },
    };
    let bytes = sheet.draw().encode().map_err(|error| Failure::Input(error.to_string()))?;
    file.write(&bytes).map_err(|error| cannot_write(&path, &error))?;
    if !arguments.quiet {
        eprintln!("{}: {pictures} pictures", path.display());
    }
    Ok(())
}

fn labelled(axis: &Axis, index: usize) -> String {
    format!("{} = {}", axis.path.short(), axis.values[index].1)
}

/// The scene with some values changed; if it is none then, that is reported.
fn changed<'a>(
    text: &str,
    path: &Path,
    inputs: &Inputs,
    changes: impl Iterator<Item = (&'a Way, &'a (String, String))>,
) -> Result<Scene, Failure> {
    let (mut text, name) = (text.to_owned(), &input::name(path));
    let (mut said, mut added) = (Vec::new(), Vec::new());
    for (way, (value, shown)) in changes {
        let edited = with_value(&text, way, value).map_err(|error| match error {
            EditError::Path(sentence) => Failure::Input(format!("can't vary {way}: {sentence}")),
            EditError::Text(diagnostics) => {
                input::show(&text, name, &diagnostics);
                Failure::Input(format!("{name} is no JSON"))
            }
        })?;
        text = edited.text;
        said.push(format!("{way}={shown}"));
        added.extend(edited.added.map(|sentence| format!("; {sentence}")));
    }
    let reading = read_at(&text, Folder::of(path), inputs);
    reading.scene.ok_or_else(|| {
        let errors: Vec<_> = reading.diagnostics.into_iter().filter(|d| d.severity == Severity::Error).collect();
        let said = said.join(" and ");
        input::show(&text, &format!("{name} with {said}"), &errors);
        Failure::Input(format!("{name} is no sound scene with {said}{}", added.concat()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Result<Vec<String>, String> {
        parse_axis(text).map(|axis| axis.values.into_iter().map(|(json, _)| json).collect())
    }

    #[test]
    fn lists_and_ranges() {
        assert_eq!(values("a=5, 10,100").expect("sound"), ["5", "10", "100"]);
        assert_eq!(values("a=1..5:3,7").expect("sound"), ["1", "3", "5", "7"]);
        assert_eq!(values("a=0..1:4").expect("sound"), ["0", "0.333333333", "0.666666667", "1"]);
        assert_eq!(values("a=-1..-2:2").expect("sound"), ["-1", "-2"]);
        assert_eq!(values("a=[1,2,3],[4,5,6]").expect("sound"), ["[1,2,3]", "[4,5,6]"]);
        assert_eq!(
            values(r##"a=fixed,true,null,#f0f,"x,y""##).expect("sound").join(" "),
            r##""fixed" true null "#f0f" "x,y""##
        );
    }

    #[test]
    fn faults_are_explained() {
        for (text, says) in [
            ("tracer.max_steps", "write PATH=VALUES"),
            ("a=", "there are no values"),
            ("a=1..5", "no range FROM..TO:COUNT"),
            ("a=1..x:5", "no range FROM..TO:COUNT"),
            ("a=1..5:1", "a range has 2 to 256 values, not 1"),
            ("a=1..5:200,1..5:200", "more than 256 values"),
            ("a..b=1", "a key is missing"),
        ] {
            let fault = values(text).expect_err(text);
            assert!(fault.contains(says), "{text}: {fault}");
        }
    }
}
