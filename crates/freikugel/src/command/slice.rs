//! `freikugel slice`: the values of a scene's field in a plane.

use super::frame::{Frame, Samples, Watch, cannot_render, cannot_write, open, output_path};
use super::given::Given;
use super::input::{self, Input};
use super::interrupt::Interrupt;
use super::{Failure, input::name};
use clap::ValueEnum;
use freikugel::field::shapes::Extrude;
use freikugel::field::{Aabb, Extent, Field, Limits, Program, Structure, extent, find_extent};
use freikugel::files::Format;
use freikugel::render::{Compression, Isoline, MOST_STEPS, Options, Progress, Rendered, Section, Show, Slice};
use freikugel::scene::{Picture, Scene};
use glam::{DVec2, DVec3};
use std::fmt::Write;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Inside is blue, outside orange, the surface a thick line, and thin lines stand at equal values. With --show slope, white are
places where the gradient has length 1, as that of a distance has; blue and red those where values grow too slowly or too fast.
With --show steps, colours from dark to light count the steps of the field's value that lead down its gradient to the surface.

Examples:
  freikugel slice cup.json
  freikugel slice cup.json --axis y --at 0.2 --show slope -o slope.png
  freikugel slice cup.json --lines 0.05 --middle 0.4,0 --span 0.5 --quality fine
  freikugel slice logo.json -o logo.svg";

/// Show the values of a scene's field in a plane.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The scene file, or - for standard input; or a model, whose file is called `.vm`.
    scene: PathBuf,
    #[command(flatten)]
    given: Given,
    /// The picture: PNG, EXR, or the lines as SVG; by default the scene's name with `-slice.png`, in the current folder.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The axis that the plane lies across. Seen against z, x leads to the right and y up; against y, x and z; against x, y and z.
    #[arg(long, value_name = "AXIS", default_value = "z")]
    axis: Axis,
    /// Where the plane crosses the axis.
    #[arg(long, value_name = "PLACE", default_value_t = 0.0, allow_negative_numbers = true)]
    at: f64,
    /// What the colours stand for.
    #[arg(long, value_name = "WHAT", default_value = "distance")]
    show: ShowArgument,
    /// From line to line; 0 for no lines but the surface. By default a round number near a twentieth of the width.
    #[arg(long, value_name = "DISTANCE", value_parser = parse_spacing)]
    lines: Option<f64>,
    /// The middle of the picture, by the two coordinates in the plane; by default that of the objects.
    #[arg(long, value_name = "A,B", value_parser = parse_pair, allow_hyphen_values = true)]
    middle: Option<DVec2>,
    /// Width of the picture in units of the scene; by default so that all objects are seen.
    #[arg(long, value_name = "WIDTH", value_parser = parse_span)]
    span: Option<f64>,
    #[command(flatten)]
    frame: Frame,
    #[command(flatten)]
    samples: Samples,
    /// Show no progress and no summary.
    #[arg(short, long)]
    quiet: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Axis {
    X,
    Y,
    Z,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ShowArgument {
    /// The values.
    Distance,
    /// The length of the gradient.
    Slope,
    /// Steps to the surface.
    Steps,
}

fn parse_spacing(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|number: &f64| number.is_finite() && *number >= 0.0)
        .ok_or("give a distance, 0 or more".into())
}

fn parse_span(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0).ok_or("give a width above 0".into())
}

fn parse_pair(text: &str) -> Result<DVec2, String> {
    let numbers: Vec<f64> = text.split(',').map_while(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [a, b] if a.is_finite() && b.is_finite() && text.split(',').count() == 2 => Ok(DVec2::new(a, b)),
        _ => Err("give two numbers: a,b".into()),
    }
}

/// Draws the slice.
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let path = output_path(arguments.output.as_deref(), &arguments.scene, "-slice.png")?;
    let is_svg = path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("svg"));
    let format = Format::of(&path);
    if !is_svg && format.is_none() {
        return Err(Failure::Usage(format!("{}: the suffix must be .png, .exr or .svg", path.display())));
    }
    let (scene, is_plane) = match input::read(&arguments.scene, &arguments.given.inputs())? {
        Input::Scene(scene) => (*scene, false),
        Input::Figures(scene) => (*scene, true),
        Input::Region(region) => (Scene::of(region.field()), true),
    };
    if is_plane && (arguments.axis != Axis::Z || arguments.at != 0.0) {
        return Err(Failure::Usage(format!(
            "{} lies in the plane of x and y: leave out --axis and --at",
            name(&arguments.scene)
        )));
    }
    let options = arguments.samples.over(arguments.frame.over(Options::of(&scene)));
    options.region().map_err(|error| Failure::Usage(error.to_string()))?;
    let plane = Plane { axis: arguments.axis, at: arguments.at, middle: arguments.middle, span: arguments.span };
    let show = match arguments.show {
        ShowArgument::Distance => Show::Distance,
        ShowArgument::Slope => Show::Slope,
        ShowArgument::Steps => Show::Steps,
    };
    let (program, slice) = cut(&scene, &plane, &options, show, arguments.lines)?;

    let interrupt = Interrupt::listen();
    let file = open(&path, &interrupt)?;
    let watch = Watch::new(arguments.quiet, &interrupt);
    let drawn = match format {
        Some(format) => slice.picture(&program, &options, &watch).map(|rendered| Drawn::Picture(rendered, format)),
        None => slice.lines(&program, &options, &watch).map(Drawn::Lines),
    };
    watch.bar.finish_and_clear();
    let bytes = match drawn.map_err(cannot_render)? {
        Drawn::Picture(rendered, format) => format
            .encode(&rendered, &Picture::default(), Compression::Quick)
            .map_err(|error| Failure::Input(error.to_string()))?,
        Drawn::Lines(lines) => svg(&lines, &slice, &options).into_bytes(),
    };
    if interrupt.is_requested() {
        return Err(Failure::Interrupted);
    }
    file.write(&bytes).map_err(|error| cannot_write(&path, &error))?;
    if !arguments.quiet {
        summarise(&path, &slice, &options);
    }
    Ok(())
}

/// What comes of a slice.
enum Drawn {
    /// A picture, and the kind of file it is for.
    Picture(Rendered, Format),
    /// The lines at each value.
    Lines(Vec<(f64, Vec<Isoline>)>),
}

/// The picture of a scene of plane figures.
pub(super) fn picture_of_figures(
    scene: &Scene,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Rendered, Failure> {
    let plane = Plane { axis: Axis::Z, at: 0.0, middle: None, span: None };
    let (program, slice) = cut(scene, &plane, options, Show::Distance, None)?;
    slice.picture(&program, options, progress).map_err(cannot_render)
}

/// Which part of which plane is seen.
struct Plane {
    axis: Axis,
    at: f64,
    middle: Option<DVec2>,
    span: Option<f64>,
}

/// How much of the picture's width and height objects take up by default.
const FILLED: f64 = 0.7;

/// Half the width that is seen of what has no end.
const HALF_OF_ENDLESS: f64 = 2.0;

/// So many lines fit beside each other, about.
const LINES: f64 = 20.0;

/// The field of a scene, and what is seen of it.
fn cut(
    scene: &Scene,
    plane: &Plane,
    options: &Options,
    show: Show,
    lines: Option<f64>,
) -> Result<(Program, Slice), Failure> {
    let fields: Vec<Field> = scene.objects.iter().map(|object| object.shape.clone()).collect();
    let structure = Structure::compile(&fields).map_err(|diagnostics| {
        let messages: Vec<String> = diagnostics.iter().map(|diagnostic| diagnostic.message.clone()).collect();
        Failure::Input(messages.join("; "))
    })?;
    let (right, up, across) = match plane.axis {
        Axis::X => (DVec3::Y, DVec3::Z, DVec3::X),
        Axis::Y => (DVec3::X, DVec3::Z, DVec3::Y),
        Axis::Z => (DVec3::X, DVec3::Y, DVec3::Z),
    };
    let extent = seen(&fields, scene.is_plane());
    let project = |p: DVec3| DVec2::new(p.dot(right), p.dot(up));
    let middle = plane.middle.unwrap_or_else(|| project((extent.min + extent.max) / 2.0));
    let aspect = f64::from(options.height) / f64::from(options.width);
    let size = project(extent.max - extent.min);
    let width = plane.span.unwrap_or_else(|| (size.x.max(size.y / aspect) / FILLED).max(f64::MIN_POSITIVE));
    let (u, v) = (right * width, -up * width * aspect);
    let middle = right * middle.x + up * middle.y + across * plane.at;
    let section = Section { origin: middle - (u + v) / 2.0, u, v };
    let spacing = lines.unwrap_or_else(|| round_number(width / LINES));
    Ok((structure.program(middle), Slice { section, show, spacing }))
}

/// The box of all objects, or what stands for it where they have no end.
fn seen(fields: &[Field], are_figures: bool) -> Aabb {
    let boxes: Vec<Aabb> = fields
        .iter()
        .filter_map(|field| {
            // A figure has no end along z.
            let field = if are_figures { field.clone().extrude(1.0) } else { field.clone() };
            match extent(&field) {
                Extent::Finite(aabb) => Some(aabb),
                Extent::Empty => None,
                Extent::Unbounded => match find_extent(&field, &Limits::default()) {
                    Extent::Finite(aabb) => Some(aabb),
                    _ => None,
                },
            }
        })
        .collect();
    let join = |a: Aabb, b: Aabb| Aabb { min: a.min.min(b.min), max: a.max.max(b.max) };
    let endless = Aabb { min: DVec3::splat(-HALF_OF_ENDLESS), max: DVec3::splat(HALF_OF_ENDLESS) };
    boxes.into_iter().reduce(join).unwrap_or(endless)
}

/// The nearest of 1, 2 and 5 times a power of ten that is not larger.
fn round_number(number: f64) -> f64 {
    let power = 10f64.powf(number.log10().floor());
    let factor = [5.0, 2.0].into_iter().find(|factor| factor * power <= number).unwrap_or(1.0);
    factor * power
}

fn summarise(path: &Path, slice: &Slice, options: &Options) {
    let Slice { section, show, spacing } = slice;
    let mut text =
        format!("{}: {} x {}, {} wide", path.display(), options.width, options.height, brief(section.u.length()));
    if *spacing > 0.0 {
        let _ = write!(text, ", a line every {}", brief(*spacing));
    }
    match show {
        Show::Distance => {}
        Show::Slope => text.push_str("; white: slope 1, blue: less (full at 1/2), red: more (full at 2)"),
        Show::Steps => {
            let _ = write!(text, "; steps from 1 (dark blue) to {MOST_STEPS} (yellow)");
        }
    }
    eprintln!("{text}");
}

/// Four digits of a number.
fn brief(number: f64) -> String {
    let unit = 10f64.powf(number.abs().max(f64::MIN_POSITIVE).log10().floor() - 3.0);
    format!("{}", ((number / unit).round() * unit * 1e9).round() / 1e9)
}

/// The lines as an SVG file: a group for each value, with that value as its name. Points are in pixels.
fn svg(lines: &[(f64, Vec<Isoline>)], slice: &Slice, options: &Options) -> String {
    let (width, height) = (options.width, options.height);
    let scale = slice.section.u.length() / f64::from(width);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         fill=\"none\" stroke-linejoin=\"round\">\n<desc>Lines of equal values of a distance field; a pixel is {scale} wide.</desc>\n"
    );
    for (level, lines) in lines {
        let (color, stroke) = match level {
            0.0 => ("#202124", 2.2),
            level if *level < 0.0 => ("#3c7fc0", 0.8),
            _ => ("#d07a28", 0.8),
        };
        let _ = writeln!(text, "<g data-value=\"{}\" stroke=\"{color}\" stroke-width=\"{stroke}\">", brief(*level));
        for line in lines {
            text.push_str("<path d=\"");
            for (index, [x, y]) in line.points.iter().enumerate() {
                let _ = write!(text, "{}{x:.2} {y:.2}", if index == 0 { 'M' } else { 'L' });
            }
            text.push_str(if line.is_closed { "Z\"/>\n" } else { "\"/>\n" });
        }
        text.push_str("</g>\n");
    }
    text.push_str("</svg>\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spacings_are_round_numbers() {
        for (number, round) in [(0.0999, 0.05), (0.1, 0.1), (0.37, 0.2), (0.51, 0.5), (7.0, 5.0), (40.0, 20.0)] {
            assert!((round_number(number) - round).abs() < 1e-12 * round, "{number}: {}", round_number(number));
        }
    }
}
