//! A graphics processor ready for work, and what can go wrong with it.
//!
//! wgpu reports most faults not by results but by scopes and callbacks. Here each of them becomes an error value of the
//! call that suffers from it: creation of modules, pipelines and buffers stands in error scopes; what comes up elsewhere,
//! and the loss of the device, is kept and returned by the next wait.

use crate::adapter::{self, AdapterError, AdapterSummary, Choice};
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, ComputePipeline, ComputePipelineDescriptor, Device, DeviceDescriptor,
    ErrorFilter, ExperimentalFeatures, Features, Limits, MapMode, MemoryHints, PollError, PollType, Queue,
    ShaderModule, ShaderModuleDescriptor, ShaderSource, SubmissionIndex, Trace,
};

/// What buffers of samples are called.
pub(crate) const VOXELS: &str = "the scene's voxels";

/// How long to wait for one piece of work. Systems give up on graphics processors after 2 to 10 s; software is
/// given more, since machines without a graphics processor are often busy with other things as well.
const PATIENCE: Duration = Duration::from_secs(120);

/// A graphics processor ready for work.
#[derive(Debug)]
pub struct Gpu {
    summary: AdapterSummary,
    device: Device,
    queue: Queue,
    /// The first thing that went wrong outside of any scope.
    fault: Arc<Mutex<Option<GpuError>>>,
    pipelines: AtomicUsize,
}

/// Why a graphics processor can't be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OpenError {
    /// There is none, or none with the name.
    Adapter(AdapterError),
    /// It does not let itself be used.
    Refused {
        /// The graphics processor.
        adapter: String,
        /// Its reason.
        reason: String,
    },
}

/// Why a graphics processor did not do what it should.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GpuError {
    /// Its memory does not suffice.
    Memory,
    /// It takes no buffers as large as needed.
    TooLarge {
        /// What the buffer would hold.
        what: &'static str,
        /// Bytes needed.
        bytes: u64,
        /// Bytes that one may have.
        most: u64,
    },
    /// It refuses the shader, or what is asked of it. This is a mistake of this program, or of its driver.
    Invalid(String),
    /// It was reset, unplugged, or crashed.
    Lost(String),
    /// It did not answer in time.
    Late,
}

impl Gpu {
    /// Makes a graphics processor ready.
    ///
    /// # Errors
    /// If there is none such, or its driver refuses.
    pub fn open(choice: &Choice) -> Result<Self, OpenError> {
        let instance = adapter::instance();
        let adapter = adapter::select(&instance, choice, |_| true).map_err(OpenError::Adapter)?;
        Self::of(&adapter)
    }

    /// Makes an adapter ready, with all the limits that it offers.
    pub(crate) fn of(adapter: &wgpu::Adapter) -> Result<Self, OpenError> {
        let summary = AdapterSummary::of(&adapter.get_info());
        let descriptor = DeviceDescriptor {
            label: None,
            required_features: Features::empty(),
            required_limits: adapter.limits(),
            experimental_features: ExperimentalFeatures::disabled(),
            memory_hints: MemoryHints::Performance,
            trace: Trace::Off,
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| OpenError::Refused { adapter: summary.name.clone(), reason: error.to_string() })?;
        let fault = Arc::new(Mutex::new(None));
        let keep = |fault: &Mutex<Option<GpuError>>, error| {
            fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        };
        let kept = Arc::clone(&fault);
        device.on_uncaptured_error(Arc::new(move |error| keep(&kept, GpuError::of(error))));
        let kept = Arc::clone(&fault);
        device.set_device_lost_callback(move |_, reason| keep(&kept, GpuError::Lost(reason)));
        Ok(Self { summary, device, queue, fault, pipelines: AtomicUsize::new(0) })
    }

    /// What it is.
    pub fn summary(&self) -> &AdapterSummary {
        &self.summary
    }

    /// Pipelines created so far. Each costs the driver tens of milliseconds to seconds, so changing numbers must
    /// create none.
    pub fn pipelines(&self) -> usize {
        self.pipelines.load(Ordering::Relaxed)
    }

    pub(crate) fn device(&self) -> &Device {
        &self.device
    }

    pub(crate) fn queue(&self) -> &Queue {
        &self.queue
    }

    pub(crate) fn limits(&self) -> Limits {
        self.device.limits()
    }

    /// What `work` makes, or the fault that wgpu found in it.
    pub(crate) fn checked<T>(&self, work: impl FnOnce() -> T) -> Result<T, GpuError> {
        let scopes = [ErrorFilter::OutOfMemory, ErrorFilter::Validation, ErrorFilter::Internal]
            .map(|filter| self.device.push_error_scope(filter));
        let made = work();
        // Scopes end in the opposite order of their beginning.
        let faults: Vec<wgpu::Error> =
            scopes.into_iter().rev().filter_map(|scope| pollster::block_on(scope.pop())).collect();
        match faults.into_iter().next() {
            Some(error) => Err(GpuError::of(error)),
            None => self.fault().map(|()| made),
        }
    }

    /// Compiles WGSL.
    pub(crate) fn module(&self, text: &str) -> Result<ShaderModule, GpuError> {
        let source = ShaderSource::Wgsl(text.into());
        self.checked(|| self.device.create_shader_module(ShaderModuleDescriptor { label: None, source }))
    }

    /// Makes a pipeline of an entry point, and counts it.
    pub(crate) fn compute_pipeline(
        &self,
        module: &ShaderModule,
        layout: &wgpu::PipelineLayout,
        entry_point: &str,
    ) -> Result<ComputePipeline, GpuError> {
        self.pipelines.fetch_add(1, Ordering::Relaxed);
        self.checked(|| {
            self.device.create_compute_pipeline(&ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(layout),
                module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        })
    }

    /// Makes a pipeline that draws, and counts it.
    pub(crate) fn render_pipeline(
        &self,
        descriptor: &wgpu::RenderPipelineDescriptor<'_>,
    ) -> Result<wgpu::RenderPipeline, GpuError> {
        self.pipelines.fetch_add(1, Ordering::Relaxed);
        self.checked(|| self.device.create_render_pipeline(descriptor))
    }

    /// A buffer of at least one element of 16 bytes, for what shaders read and write as arrays.
    ///
    /// # Errors
    /// If it would be larger than the device allows, or than its memory.
    pub(crate) fn buffer(&self, what: &'static str, bytes: u64, usage: BufferUsages) -> Result<Buffer, GpuError> {
        let limits = self.limits();
        let binding = if usage.contains(BufferUsages::STORAGE) {
            limits.max_storage_buffer_binding_size
        } else {
            limits.max_buffer_size
        };
        let most = binding.min(limits.max_buffer_size);
        if bytes > most {
            return Err(GpuError::TooLarge { what, bytes, most });
        }
        let size = bytes.max(SMALLEST_BUFFER).next_multiple_of(SMALLEST_BUFFER);
        self.checked(|| {
            self.device.create_buffer(&BufferDescriptor { label: Some(what), size, usage, mapped_at_creation: false })
        })
    }

    /// Waits until some work is done.
    ///
    /// # Errors
    /// If that or anything else since the last wait failed.
    pub(crate) fn wait(&self, submission: SubmissionIndex) -> Result<(), GpuError> {
        let wait = PollType::Wait { submission_index: Some(submission), timeout: Some(PATIENCE) };
        let waited = self.device.poll(wait);
        self.fault()?;
        waited.map(|_| ()).map_err(|error| match error {
            PollError::Timeout => GpuError::Late,
            error => GpuError::Invalid(error.to_string()),
        })
    }

    /// Reads the first numbers of a buffer made for reading, after all work submitted so far.
    pub(crate) fn read(&self, buffer: &Buffer, count: usize) -> Result<Vec<f32>, GpuError> {
        let slice = buffer.slice(..(count * size_of::<f32>()) as u64);
        let outcome = Arc::new(Mutex::new(None));
        let told = Arc::clone(&outcome);
        slice.map_async(MapMode::Read, move |result| {
            *told.lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
        });
        let wait = PollType::Wait { submission_index: None, timeout: Some(PATIENCE) };
        let waited = self.device.poll(wait);
        self.fault()?;
        waited.map_err(|_| GpuError::Late)?;
        let mapped = outcome.lock().unwrap_or_else(PoisonError::into_inner).take();
        match mapped {
            None => return Err(GpuError::Late),
            Some(Err(error)) => return Err(GpuError::Invalid(error.to_string())),
            Some(Ok(())) => {}
        }
        let view = slice.get_mapped_range().map_err(|error| GpuError::Invalid(error.to_string()))?;
        let numbers = view
            .chunks_exact(size_of::<f32>())
            .map(|bytes| f32::from_le_bytes(bytes.try_into().expect("four bytes")))
            .collect();
        drop(view);
        buffer.unmap();
        Ok(numbers)
    }

    /// What went wrong outside of any scope, once; a lost device stays lost.
    fn fault(&self) -> Result<(), GpuError> {
        let mut fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner);
        match &*fault {
            None => Ok(()),
            Some(lost @ GpuError::Lost(_)) => Err(lost.clone()),
            Some(_) => fault.take().map_or(Ok(()), Err),
        }
    }
}

/// No buffer may be empty, and bindings of vectors have to hold one at least.
const SMALLEST_BUFFER: u64 = 16;

/// Numbers as the bytes that graphics processors read.
pub(crate) fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

impl GpuError {
    fn of(error: wgpu::Error) -> Self {
        match error {
            wgpu::Error::OutOfMemory { .. } => Self::Memory,
            wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => {
                Self::Invalid(description)
            }
        }
    }
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Adapter(error) => error.fmt(f),
            Self::Refused { adapter, reason } => write!(f, "the graphics processor {adapter} can't be used: {reason}"),
        }
    }
}

impl fmt::Display for GpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Memory => f.write_str("the graphics processor's memory does not suffice"),
            Self::TooLarge { what, bytes, most } => write!(
                f,
                "the graphics processor takes {most} bytes in one piece, but {what} need {bytes}: {}",
                if *what == VOXELS { "choose fewer voxels" } else { "render on the CPU instead" }
            ),
            Self::Invalid(reason) => write!(f, "the graphics processor refuses the work: {reason}"),
            Self::Lost(reason) if reason.is_empty() => f.write_str("the graphics processor was lost"),
            Self::Lost(reason) => write!(f, "the graphics processor was lost: {reason}"),
            Self::Late => write!(f, "the graphics processor did not answer within {} s", PATIENCE.as_secs()),
        }
    }
}

impl std::error::Error for OpenError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Adapter(error) => Some(error),
            Self::Refused { .. } => None,
        }
    }
}

impl std::error::Error for GpuError {}
