//! Graphics processors: rendering with them, listing them, and what to say where this program was built without them.

use super::Failure;
use super::frame::Watch;
use clap::ValueEnum;
use freikugel::render::{Options, Rendered};
use freikugel::scene::Scene;

/// What computes pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Backend {
    /// The CPU: the reference, the same bytes on all machines.
    Cpu,
    /// The graphics processor.
    Gpu,
    /// The graphics processor if there is one that is no software, and it can draw the scene; otherwise the CPU.
    Auto,
}

/// How a graphics processor draws.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "nothing draws"))]
pub(super) struct How<'a> {
    /// A part of its name; the best one by default.
    pub(super) adapter: Option<&'a str>,
    /// How many voxels there are along the longest side, if the scene is to be sampled.
    pub(super) voxels: Option<u32>,
}

/// A picture, and what computed it, if that is of interest.
pub(super) type Made = (Rendered, Option<String>);

#[cfg(feature = "gpu")]
pub(super) use with::{Processor, choice, list, render, render_if_able};

#[cfg(not(feature = "gpu"))]
pub(super) use without::{Processor, list, missing, render, render_if_able};

#[cfg(feature = "gpu")]
mod with {
    use super::super::bench::{Length, Row, measured, swinging};
    use super::{Failure, How, Made, Options, Scene, Watch};
    use freikugel::gpu::{AdapterError, Choice, DrawError, Frames, Gpu, GpuRenderer, adapters};
    use freikugel::render::Renderer;
    use std::sync::Arc;

    /// A graphics processor whose frames are timed.
    pub(in super::super) struct Processor {
        gpu: Arc<Gpu>,
    }

    impl Processor {
        /// Makes the one with a name ready, or the best one.
        pub(in super::super) fn open(adapter: Option<&str>) -> Result<Self, Failure> {
            let gpu = Gpu::open(&choice(adapter)).map_err(|error| Failure::Input(error.to_string()))?;
            Ok(Self { gpu: Arc::new(gpu) })
        }

        /// Times frames of a scene.
        pub(in super::super) fn measure(
            &self,
            name: &str,
            scene: &Scene,
            options: &Options,
            voxels: Option<u32>,
            length: Length,
            watch: &Watch,
        ) -> Result<Row, Failure> {
            let camera = Renderer::new(scene).map(|renderer| renderer.camera(options.width, options.height));
            let camera = camera.map_err(|error| Failure::Input(format!("{name}: {error}")))?;
            let mut frames = Frames::new(&self.gpu, scene, options, voxels).map_err(failure)?;
            let measured = measured(length, watch, |number, is_practice| {
                let camera = swinging(&camera, number);
                let time = if is_practice { frames.practise(&camera) } else { frames.draw(&camera) };
                time.map_err(failure)
            })?;
            let creation = frames.creation();
            Ok(Row::new(name, &self.gpu.summary().name, creation.text, Some(creation.pipelines), &measured))
        }
    }

    /// All graphics processors, the one that is taken first; a line for each.
    pub(in super::super) fn list() -> Result<String, Failure> {
        let adapters = adapters();
        if adapters.is_empty() {
            return Err(Failure::Input(AdapterError::None.to_string()));
        }
        Ok(adapters.iter().map(|adapter| format!("{adapter}\n")).collect())
    }

    /// The graphics processor with a name, or the best one.
    pub(in super::super) fn choice(adapter: Option<&str>) -> Choice {
        adapter.map_or(Choice::Automatic, |name| Choice::Named(name.to_owned()))
    }

    /// Renders with a graphics processor.
    pub(in super::super) fn render(
        scene: &Scene,
        options: &Options,
        how: How<'_>,
        watch: &Watch,
    ) -> Result<Made, Failure> {
        let gpu = Gpu::open(&choice(how.adapter)).map_err(|error| Failure::Input(error.to_string()))?;
        draw(&Arc::new(gpu), scene, options, how, watch).map_err(failure)
    }

    /// Renders with a graphics processor if there is one that is no software, unless it was named, and it can draw the scene.
    ///
    /// # Errors
    /// Why it has to be done otherwise.
    pub(in super::super) fn render_if_able(
        scene: &Scene,
        options: &Options,
        how: How<'_>,
        watch: &Watch,
    ) -> Result<Result<Made, Failure>, String> {
        let gpu = Gpu::open(&choice(how.adapter)).map_err(|error| error.to_string())?;
        if gpu.summary().is_software() && how.adapter.is_none() {
            return Err(format!("{} is software", gpu.summary().name));
        }
        match draw(&Arc::new(gpu), scene, options, how, watch) {
            Err(error @ (DrawError::Shader(_) | DrawError::Gpu(_))) => Err(error.to_string()),
            drawn => Ok(drawn.map_err(failure)),
        }
    }

    fn draw(gpu: &Arc<Gpu>, scene: &Scene, options: &Options, how: How<'_>, watch: &Watch) -> Result<Made, DrawError> {
        let mut by = gpu.summary().to_string();
        let mut renderer = match how.voxels {
            None => GpuRenderer::new(gpu, scene)?,
            Some(count) => GpuRenderer::of_voxels(gpu, scene, count)?,
        };
        if how.voxels.is_some() {
            by.push_str(&format!("; voxels take {:.1} MB", renderer.voxel_bytes() as f64 / 1e6));
        }
        Ok((renderer.render(options, watch)?, Some(by)))
    }

    fn failure(error: DrawError) -> Failure {
        match error {
            DrawError::Cancelled => Failure::Interrupted,
            DrawError::Options(error) => Failure::Usage(error.to_string()),
            error => Failure::Input(error.to_string()),
        }
    }
}

#[cfg(not(feature = "gpu"))]
mod without {
    use super::super::bench::{Length, Row};
    use super::{Failure, How, Made, Options, Scene, Watch};

    /// There is none.
    pub(in super::super) enum Processor {}

    impl Processor {
        pub(in super::super) fn open(_: Option<&str>) -> Result<Self, Failure> {
            Err(missing("bench --gpu"))
        }

        pub(in super::super) fn measure(
            &self,
            _: &str,
            _: &Scene,
            _: &Options,
            _: Option<u32>,
            _: Length,
            _: &Watch,
        ) -> Result<Row, Failure> {
            match *self {}
        }
    }

    /// What is said where something needs graphics processors.
    pub(in super::super) fn missing(what: &str) -> Failure {
        Failure::Input(format!(
            "{what} needs a freikugel that was built with the feature gpu:\n  \
             cargo install --path crates/freikugel --features gpu\n\
             or, without installing it,\n  \
             cargo run --release --features gpu -- {what} ..."
        ))
    }

    pub(in super::super) fn list() -> Result<String, Failure> {
        Err(missing("info --gpu"))
    }

    pub(in super::super) fn render(_: &Scene, _: &Options, _: How<'_>, _: &Watch) -> Result<Made, Failure> {
        Err(missing("render --backend gpu"))
    }

    pub(in super::super) fn render_if_able(
        _: &Scene,
        _: &Options,
        _: How<'_>,
        _: &Watch,
    ) -> Result<Result<Made, Failure>, String> {
        Err("this freikugel was built without graphics processors".into())
    }
}
