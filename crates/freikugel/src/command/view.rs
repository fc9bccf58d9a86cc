//! `freikugel view`: a scene in a window.

use super::Failure;
use super::frame::{Samples, Voxels};
use super::given::Given;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Keys: H lists them all; Escape closes. A changed file is read by itself.

Examples:
  freikugel view cup.json
  freikugel view cup.json --width 1280 --height 720 --samples 64
  freikugel view cup.json --adapter llvmpipe";

/// Show a scene in a window.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The scene file; or a model, whose file is called `.vm`.
    scene: PathBuf,
    /// Width of the window in pixels, instead of the scene's.
    #[arg(long, value_name = "PIXELS")]
    width: Option<u32>,
    /// Height of the window in pixels, instead of the scene's.
    #[arg(long, value_name = "PIXELS")]
    height: Option<u32>,
    #[command(flatten)]
    given: Given,
    #[command(flatten)]
    samples: Samples,
    #[command(flatten)]
    voxels: Voxels,
    /// A part of the name of the graphics processor; `info --gpu` lists them.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
}

/// Opens the window, and returns when it is closed.
#[cfg(feature = "gpu")]
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    window::run(arguments)
}

/// Says how to get a program with windows.
#[cfg(not(feature = "gpu"))]
pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene: _, given: _, width: _, height: _, samples: _, voxels: _, adapter: _ } = arguments;
    Err(super::graphics::missing("view"))
}

#[cfg(feature = "gpu")]
mod window {
    use super::super::{Failure, graphics, input};
    use super::Arguments;
    use freikugel::files::Output;
    use freikugel::gpu::{Host, ViewError, WindowOptions, view};
    use freikugel::render::Options;
    use freikugel::scene::{Camera, FovAxis, Inputs, Projection, Scene};
    use std::path::{Path, PathBuf};
    use std::time::SystemTime;

    pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
        let path = &arguments.scene;
        let inputs = arguments.given.inputs();
        let scene = input::scene(path, &inputs)?;
        let mut files = Files::of(path, inputs);
        let mut options = Options::of(&scene);
        options.width = arguments.width.unwrap_or(options.width);
        options.height = arguments.height.unwrap_or(options.height);
        options = arguments.samples.over(options);
        options.region().map_err(|error| Failure::Usage(error.to_string()))?;
        let window = WindowOptions {
            title: format!("{} - Freikugel", input::name(path)),
            width: options.width,
            height: options.height,
            samples: options.samples,
            voxels: arguments.voxels.count,
            choice: graphics::choice(arguments.adapter.as_deref()),
        };
        view(scene, &window, &mut files).map_err(|error| match error {
            ViewError::Window(_) | ViewError::Open(_) => Failure::Input(format!(
                "{error}\nwithout a window, this makes a picture: freikugel render {}",
                input::name(path)
            )),
            error => Failure::Input(error.to_string()),
        })
    }

    /// The scene's file, and it and all that it names with what is known of when they were changed last.
    struct Files<'p> {
        path: &'p Path,
        inputs: Inputs,
        stamps: Vec<(PathBuf, Option<Stamp>)>,
    }

    impl<'p> Files<'p> {
        fn of(path: &'p Path, inputs: Inputs) -> Self {
            let stamps = input::files(path, &inputs).into_iter().map(|path| (path.clone(), stamp(&path))).collect();
            Self { path, inputs, stamps }
        }
    }

    /// When a file was changed last, and its size.
    type Stamp = (SystemTime, u64);

    fn stamp(path: &Path) -> Option<Stamp> {
        let about = std::fs::metadata(path).ok()?;
        Some((about.modified().ok()?, about.len()))
    }

    impl Host for Files<'_> {
        fn load(&mut self) -> Result<Scene, String> {
            *self = Files::of(self.path, std::mem::take(&mut self.inputs));
            input::scene_or_report(self.path, &self.inputs)
        }

        fn has_changed(&mut self) -> bool {
            // Editors that write anew remove the file for a moment; it is read when it is back.
            self.stamps.iter().any(|(path, known)| stamp(path).is_some_and(|now| Some(now) != *known))
        }

        fn save(&mut self, png: &[u8]) -> Result<String, String> {
            let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
            let path = (1..)
                .map(|number| PathBuf::from(format!("{stem}-{number}.png")))
                .find(|path| !path.exists())
                .expect("some number is free");
            let written = Output::open(&path).and_then(|output| output.write(png));
            written.map_err(|error| format!("can't write {}: {error}", path.display()))?;
            Ok(format!("saved {}", path.display()))
        }

        fn print_camera(&mut self, camera: &Camera) -> String {
            let point = |point: glam::DVec3| {
                let [x, y, z] = point.to_array().map(|number| format!("{number:.4}"));
                format!("[{x}, {y}, {z}]")
            };
            let lens = match camera.projection {
                Projection::Perspective { fov, axis: FovAxis::Vertical } => format!("\"fov\": {}", fov.to_degrees()),
                Projection::Perspective { fov, axis: FovAxis::Horizontal } => {
                    format!("\"fov\": {{ \"horizontal\": {} }}", fov.to_degrees())
                }
                Projection::Orthographic { height } => format!("\"height\": {height}"),
            };
            let text = format!(
                "\"camera\": {{ \"eye\": {}, \"target\": {}, \"up\": {}, {lens} }}",
                point(camera.eye),
                point(camera.target),
                point(camera.up)
            );
            match super::super::print(&format!("{text}\n")) {
                Ok(()) => text,
                Err(_) => "can't write to standard output".into(),
            }
        }
    }
}
