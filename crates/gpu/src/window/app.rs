//! The glue between the system's windows and the rest: events become inputs, and frames are drawn when there is something
//! new to see.

use super::frame_times::FrameTimes;
use super::keys::Key;
use super::overlay::{Panel, panel};
use super::present::Presenter;
use super::stage::{Stage, StageError};
use super::state::{Button, Effect, Input, Progress, State};
use crate::adapter::{self, Choice};
use crate::device::{Gpu, GpuError, OpenError};
use freikugel_scene::{Camera, Scene};
use glam::DVec2;
use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};
use wgpu::{
    CompositeAlphaMode, CurrentSurfaceTexture, Instance, InstanceDescriptor, PresentMode, Surface, SurfaceColorSpace,
    SurfaceConfiguration, TextureFormat, TextureUsages, TextureViewDescriptor,
};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{Key as WinitKey, NamedKey};
use winit::window::{Window, WindowId};

/// How often to look whether the scene's file has changed.
const LOOK: Duration = Duration::from_millis(250);

/// Frames whose times are summed up.
const FRAMES: usize = 120;

/// What touch pads send as pixels, as notches of a wheel.
const PIXELS_PER_NOTCH: f64 = 40.0;

/// What the window leaves to its caller: files and the terminal.
pub trait Host {
    /// Reads the scene.
    ///
    /// # Errors
    /// What is wrong with it, in lines of text.
    fn load(&mut self) -> Result<Scene, String>;

    /// Whether the scene has changed since it was read last.
    fn has_changed(&mut self) -> bool;

    /// Saves a picture, a PNG file; what to tell the user.
    ///
    /// # Errors
    /// Why it can't be saved.
    fn save(&mut self, png: &[u8]) -> Result<String, String>;

    /// Prints the camera where the user can copy it; what to tell the user.
    fn print_camera(&mut self, camera: &Camera) -> String;
}

/// How the window starts.
#[derive(Clone, Debug)]
pub struct WindowOptions {
    /// Its title.
    pub title: String,
    /// Its width in pixels; the user may change it.
    pub width: u32,
    /// Its height in pixels.
    pub height: u32,
    /// Rays a pixel in the end.
    pub samples: u32,
    /// How many voxels there are along the longest side, if the scene is to be sampled.
    pub voxels: Option<u32>,
    /// The graphics processor.
    pub choice: Choice,
}

/// Why the window does not open, or closes by itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ViewError {
    /// There is no screen, or the system gives no window.
    Window(String),
    /// There is no graphics processor that can draw to it.
    Open(OpenError),
    /// The graphics processor failed.
    Gpu(GpuError),
    /// The scene can't be shown.
    Scene(String),
}

/// Shows a scene in a window until the user closes it.
///
/// # Errors
/// If there is no screen or no graphics processor, or the scene can't be shown at first.
pub fn view(scene: Scene, options: &WindowOptions, host: &mut dyn Host) -> Result<(), ViewError> {
    let event_loop = EventLoop::new().map_err(|error| {
        let hint = if cfg!(all(unix, not(target_os = "macos"))) {
            " (a window needs a screen: DISPLAY or WAYLAND_DISPLAY must be set)"
        } else {
            ""
        };
        ViewError::Window(format!("{error}{hint}"))
    })?;
    let display = Box::new(event_loop.owned_display_handle());
    let instance = Instance::new(InstanceDescriptor::new_with_display_handle_from_env(display));
    let mut app = App { host, options, instance, scene: Some(scene), open: None, failure: None };
    event_loop.run_app(&mut app).map_err(|error| ViewError::Window(error.to_string()))?;
    app.failure.map_or(Ok(()), Err)
}

struct App<'h> {
    host: &'h mut dyn Host,
    options: &'h WindowOptions,
    instance: Instance,
    /// The first scene, until the window is there.
    scene: Option<Scene>,
    open: Option<Open>,
    failure: Option<ViewError>,
}

/// The window and what belongs to it.
struct Open {
    window: Arc<Window>,
    surface: Surface<'static>,
    configuration: SurfaceConfiguration,
    gpu: Arc<Gpu>,
    presenter: Presenter,
    stage: Stage,
    state: State,
    times: FrameTimes,
    panel: Option<Panel>,
    last: Instant,
    looked: Instant,
}

impl App<'_> {
    fn opened(&mut self, event_loop: &ActiveEventLoop, scene: Scene) -> Result<Open, ViewError> {
        let attributes = Window::default_attributes()
            .with_title(&self.options.title)
            .with_inner_size(PhysicalSize::new(self.options.width, self.options.height));
        let window = event_loop.create_window(attributes).map_err(|error| ViewError::Window(error.to_string()))?;
        let window = Arc::new(window);
        let surface =
            self.instance.create_surface(Arc::clone(&window)).map_err(|error| ViewError::Window(error.to_string()))?;
        let is_fit = |adapter: &wgpu::Adapter| adapter.is_surface_supported(&surface);
        let adapter = adapter::select(&self.instance, &self.options.choice, is_fit)
            .map_err(|error| ViewError::Open(OpenError::Adapter(error)))?;
        let gpu = Arc::new(Gpu::of(&adapter).map_err(ViewError::Open)?);

        let capabilities = surface.get_capabilities(&adapter);
        // Codes are computed by the shader, as for files; a format that encodes by itself is the second choice.
        let is_plain =
            |format: &&TextureFormat| matches!(format, TextureFormat::Bgra8Unorm | TextureFormat::Rgba8Unorm);
        let format = capabilities.formats.iter().find(is_plain).or_else(|| capabilities.formats.first());
        let format = *format.ok_or_else(|| ViewError::Window("the window takes no colours".into()))?;
        let PhysicalSize { width, height } = window.inner_size();
        let configuration = SurfaceConfiguration {
            usage: TextureUsages::RENDER_ATTACHMENT,
            format,
            color_space: SurfaceColorSpace::Auto,
            width: width.max(1),
            height: height.max(1),
            present_mode: PresentMode::AutoVsync,
            desired_maximum_frame_latency: 1,
            alpha_mode: CompositeAlphaMode::Auto,
            view_formats: Vec::new(),
        };
        gpu.checked(|| surface.configure(gpu.device(), &configuration)).map_err(ViewError::Gpu)?;
        let presenter = Presenter::new(&gpu, format).map_err(ViewError::Gpu)?;
        let size = [configuration.width, configuration.height];
        let WindowOptions { samples, voxels, .. } = *self.options;
        let stage = Stage::new(&gpu, scene, size, samples, voxels).map_err(ViewError::from)?;
        let state = State::new(stage.camera(), stage.is_animated());
        let now = Instant::now();
        Ok(Open {
            window,
            surface,
            configuration,
            gpu,
            presenter,
            stage,
            state,
            times: FrameTimes::new(FRAMES),
            panel: None,
            last: now,
            looked: now,
        })
    }

    fn input(&mut self, event_loop: &ActiveEventLoop, input: Input<'_>) {
        let Some(open) = &mut self.open else {
            return;
        };
        let size = DVec2::new(open.configuration.width.into(), open.configuration.height.into());
        match open.state.input(input, size) {
            None => {}
            Some(Effect::Close) => event_loop.exit(),
            Some(Effect::Reload) => open.reload(self.host),
            Some(Effect::PrintCamera) => {
                let answer = self.host.print_camera(open.state.camera());
                open.state.say(answer);
            }
            Some(Effect::Screenshot) => {
                let saved = open.stage.png().map_err(|error| error.to_string()).and_then(|png| self.host.save(&png));
                open.state.say(saved.unwrap_or_else(|error| error));
            }
        }
        open.window.request_redraw();
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, error: ViewError) {
        self.failure = Some(error);
        event_loop.exit();
    }
}

impl Open {
    fn reload(&mut self, host: &mut dyn Host) {
        let loaded = host.load().and_then(|scene| self.stage.set_scene(scene).map_err(|error| error.to_string()));
        match loaded {
            Ok(()) => {
                self.state.set_alarm(None);
                self.state.set_scene(self.stage.camera(), self.stage.is_animated());
                self.state.say("read anew");
                self.times.clear();
            }
            // The last good picture stays.
            Err(report) => self.state.set_alarm(Some(report)),
        }
        self.window.request_redraw();
    }

    fn resized(&mut self, size: PhysicalSize<u32>) -> Result<(), ViewError> {
        if size.width == 0 || size.height == 0 {
            return Ok(());
        }
        (self.configuration.width, self.configuration.height) = (size.width, size.height);
        self.gpu.checked(|| self.surface.configure(self.gpu.device(), &self.configuration)).map_err(ViewError::Gpu)?;
        self.stage.resize([size.width, size.height])?;
        self.times.clear();
        self.window.request_redraw();
        Ok(())
    }

    /// Draws what is new, and shows it.
    fn redraw(&mut self) -> Result<(), ViewError> {
        let start = Instant::now();
        let passed = start.duration_since(self.last).as_secs_f64();
        self.last = start;
        self.state.pass(passed);
        if self.state.take_stale() {
            self.stage.set_view(self.state.camera(), self.state.show(), self.state.time())?;
        }
        if let Some(moving) = self.stage.draw()? {
            self.times.push(moving);
        }
        let size = [self.configuration.width, self.configuration.height];
        let progress = Progress {
            size,
            coarse: self.stage.coarse_size(),
            samples: self.stage.fine().samples,
            most: self.stage.samples(),
        };
        let lines = self.state.lines(&self.gpu.summary().to_string(), self.times.summary(), progress);
        let drawn = panel(&lines, size[0]);
        if self.panel.as_ref() != Some(&drawn) {
            self.presenter.set_panel(&drawn).map_err(ViewError::Gpu)?;
            self.panel = Some(drawn);
        }
        match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(texture) | CurrentSurfaceTexture::Suboptimal(texture) => {
                let target = texture.texture.create_view(&TextureViewDescriptor::default());
                self.presenter.draw(&target, &self.stage.picture()).map_err(ViewError::Gpu)?;
                self.window.pre_present_notify();
                self.gpu.queue().present(texture);
            }
            // The window changed, or was hidden; there will be another chance.
            CurrentSurfaceTexture::Outdated | CurrentSurfaceTexture::Lost => {
                self.surface.configure(self.gpu.device(), &self.configuration);
                self.window.request_redraw();
            }
            CurrentSurfaceTexture::Timeout | CurrentSurfaceTexture::Occluded => {}
            CurrentSurfaceTexture::Validation => {
                let reason = "the window's surface is not valid".to_owned();
                return Err(ViewError::Gpu(GpuError::Invalid(reason)));
            }
        }
        if self.state.is_moving() || !self.stage.is_finished() {
            self.window.request_redraw();
        }
        Ok(())
    }
}

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let Some(scene) = self.scene.take() else {
            return;
        };
        match self.opened(event_loop, scene) {
            Ok(open) => {
                open.window.request_redraw();
                self.open = Some(open);
            }
            Err(error) => self.fail(event_loop, error),
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => {
                if let Some(Err(error)) = self.open.as_mut().map(|open| open.resized(size)) {
                    self.fail(event_loop, error);
                }
            }
            WindowEvent::RedrawRequested => {
                if let Some(Err(error)) = self.open.as_mut().map(Open::redraw) {
                    self.fail(event_loop, error);
                }
            }
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } => {
                let is_down = event.state == ElementState::Pressed;
                let is_repeat = event.repeat;
                let mut letter = String::new();
                let key = match &event.logical_key {
                    WinitKey::Named(NamedKey::Escape) => Key::Escape,
                    WinitKey::Named(NamedKey::Space) => Key::Space,
                    WinitKey::Named(NamedKey::F5) => Key::F5,
                    WinitKey::Character(text) => {
                        letter.push_str(&text.to_lowercase());
                        Key::Letter(&letter)
                    }
                    _ => return,
                };
                self.input(event_loop, Input::Key { key, is_down, is_repeat });
            }
            WindowEvent::MouseInput { state, button, .. } => {
                let button = if button == MouseButton::Left { Button::Left } else { Button::Other };
                self.input(event_loop, Input::Button { button, is_down: state == ElementState::Pressed });
            }
            WindowEvent::CursorMoved { position, .. } => {
                self.input(event_loop, Input::Cursor(DVec2::new(position.x, position.y)));
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => lines.into(),
                    MouseScrollDelta::PixelDelta(pixels) => pixels.y / PIXELS_PER_NOTCH,
                };
                self.input(event_loop, Input::Wheel(notches));
            }
            WindowEvent::ModifiersChanged(modifiers) => {
                self.input(event_loop, Input::Shift(modifiers.state().shift_key()));
            }
            WindowEvent::Focused(false) => self.input(event_loop, Input::FocusLost),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        if let Some(open) = &mut self.open
            && open.looked.elapsed() >= LOOK
        {
            open.looked = Instant::now();
            if self.host.has_changed() {
                open.reload(self.host);
            }
        }
        event_loop.set_control_flow(ControlFlow::WaitUntil(Instant::now() + LOOK));
    }
}

impl From<StageError> for ViewError {
    fn from(error: StageError) -> Self {
        match error {
            StageError::Gpu(error) => Self::Gpu(error),
            error => Self::Scene(error.to_string()),
        }
    }
}

impl fmt::Display for ViewError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Window(reason) => write!(f, "no window can be opened: {reason}"),
            Self::Open(error) => error.fmt(f),
            Self::Gpu(error) => error.fmt(f),
            Self::Scene(reason) => f.write_str(reason),
        }
    }
}

impl std::error::Error for ViewError {}
