//! One scene's shader on a graphics processor: compiled once, with its numbers in a buffer.
//!
//! The shader computes one sample of each pixel of a tile; a second, fixed shader adds that to the sums of a picture.
//! Neither a change of numbers nor of the view compiles anything.

use crate::device::{self, Gpu, GpuError, bytes_of};
use freikugel_render::Rect;
use freikugel_shader::Parameters;
use std::sync::{Arc, OnceLock};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingType, Buffer, BufferBindingType, BufferUsages, CommandEncoderDescriptor, ComputePassDescriptor,
    ComputePipeline, PipelineLayoutDescriptor, ShaderStages, SubmissionIndex,
};

/// The side of a workgroup of the shaders that draw.
const GROUP: u32 = 8;

/// The size of a workgroup of the shader that evaluates fields.
const PROBE_GROUP: u32 = 64;

/// Points evaluated in one dispatch: within the least number of workgroups that any device offers, 65535.
const PROBES: usize = PROBE_GROUP as usize * 65_535;

/// Pixels that a tile can have: 16 MiB for their colours, far below what any device allows for a buffer.
pub(crate) const MOST_TILE_PIXELS: u64 = 1 << 20;

/// Bytes of what the adding shader wants to know.
const PLACE_BYTES: u64 = 32;

/// One scene's shader on a graphics processor.
#[derive(Debug)]
pub(crate) struct Kernel {
    gpu: Arc<Gpu>,
    module: wgpu::ShaderModule,
    /// How the shader reads the scene's numbers.
    access: Access,
    render: ComputePipeline,
    slice: OnceLock<ComputePipeline>,
    layout: BindGroupLayout,
    parameters: Buffer,
    /// Samples of the scene, if the shader reads some.
    voxels: Option<Buffer>,
    view: Buffer,
    tile: Buffer,
    bindings: BindGroup,
    add: ComputePipeline,
    add_layout: BindGroupLayout,
    place: Buffer,
}

/// The numbers of a scene, and where the shader wants them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Table<'a> {
    pub(crate) numbers: &'a [f32],
    pub(crate) is_uniform: bool,
    /// Samples of the scene; the shader reads them if there are some.
    pub(crate) voxels: &'a [[f32; 2]],
}

impl<'a> From<&'a Parameters> for Table<'a> {
    fn from(parameters: &'a Parameters) -> Self {
        Self { numbers: parameters.numbers(), is_uniform: parameters.is_uniform(), voxels: parameters.voxels() }
    }
}

impl Table<'_> {
    fn access(self) -> Access {
        if self.is_uniform { Access::Uniform } else { Access::Read }
    }

    fn usage(self) -> BufferUsages {
        BufferUsages::COPY_DST | if self.is_uniform { BufferUsages::UNIFORM } else { BufferUsages::STORAGE }
    }
}

/// What computes a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Entry {
    /// Rays through the scene.
    Render,
    /// The field on a plane.
    Slice,
}

/// Sums of the samples of each pixel of a picture.
#[derive(Debug)]
pub(crate) struct Sums {
    pixels: u64,
    buffer: Buffer,
    bindings: BindGroup,
    /// Where they are copied to be read.
    readable: Buffer,
}

impl Kernel {
    /// Compiles a scene's shader.
    ///
    /// # Errors
    /// If the device refuses it, or its memory does not suffice.
    pub(crate) fn new(gpu: &Arc<Gpu>, text: &str, table: Table<'_>, view_bytes: usize) -> Result<Self, GpuError> {
        let module = gpu.module(text)?;
        let voxels = voxel_buffer(gpu, table.voxels)?;
        let mut accesses = vec![(0, table.access()), (1, Access::Uniform), (2, Access::Write)];
        accesses.extend(voxels.iter().map(|_| (VOXELS, Access::Read)));
        let layout = layout_at(gpu, &accesses)?;
        let render = pipeline(gpu, &module, &layout, "render")?;
        let add_layout = self::layout(gpu, &[Access::Uniform, Access::Read, Access::Write])?;
        let adder = gpu.module(include_str!("accumulate.wgsl"))?;
        let add = pipeline(gpu, &adder, &add_layout, "add")?;

        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let parameters = filled(gpu, "the scene's numbers", table.numbers, table.usage())?;
        let view = gpu.buffer("the view", view_bytes as u64, uniform)?;
        let tile = gpu.buffer("a tile's colours", MOST_TILE_PIXELS * PIXEL, BufferUsages::STORAGE)?;
        let place = gpu.buffer("a tile's place", PLACE_BYTES, uniform)?;
        let bindings = drawing(gpu, &layout, [&parameters, &view, &tile], voxels.as_ref())?;
        Ok(Self {
            gpu: Arc::clone(gpu),
            module,
            access: table.access(),
            render,
            slice: OnceLock::new(),
            layout,
            parameters,
            voxels,
            view,
            tile,
            bindings,
            add,
            add_layout,
            place,
        })
    }

    /// Takes other numbers for the same shader, as many as it has.
    pub(crate) fn set_parameters(&self, numbers: &[f32]) {
        debug_assert!(size_of_val(numbers) as u64 <= self.parameters.size(), "{} numbers", numbers.len());
        self.gpu.queue().write_buffer(&self.parameters, 0, &bytes_of(numbers));
    }

    /// Takes other numbers and samples for the same shader.
    ///
    /// # Errors
    /// If memory does not suffice for the samples; nothing has changed then.
    pub(crate) fn set_table(&mut self, table: Table<'_>) -> Result<(), GpuError> {
        if self.voxels.is_some() {
            let voxels = voxel_buffer(&self.gpu, table.voxels)?;
            let own = [&self.parameters, &self.view, &self.tile];
            self.bindings = drawing(&self.gpu, &self.layout, own, voxels.as_ref())?;
            self.voxels = voxels;
        }
        self.set_parameters(table.numbers);
        Ok(())
    }

    /// Sums for a picture, undefined until the first samples are added.
    ///
    /// # Errors
    /// If memory does not suffice for them.
    pub(crate) fn sums(&self, pixels: u64) -> Result<Sums, GpuError> {
        let what = "the picture's colours";
        let buffer = self.gpu.buffer(what, pixels * PIXEL, BufferUsages::STORAGE | BufferUsages::COPY_SRC)?;
        let readable = self.gpu.buffer(what, pixels * PIXEL, BufferUsages::MAP_READ | BufferUsages::COPY_DST)?;
        let bindings = bind(&self.gpu, &self.add_layout, &[&self.place, &self.tile, &buffer])?;
        Ok(Sums { pixels, buffer, bindings, readable })
    }

    /// Computes one sample of each pixel of a tile and adds it to sums, or replaces them if it is the first. `tile` is the
    /// tile's place in the picture of sums, `width` that picture's; `view` are the bytes of the shader's view of the tile.
    ///
    /// # Errors
    /// If this is the first slice, and the device refuses it.
    pub(crate) fn add_sample(
        &self,
        entry: Entry,
        view: &[u8],
        tile: Rect,
        width: u32,
        is_first: bool,
        sums: &Sums,
    ) -> Result<SubmissionIndex, GpuError> {
        let drawing = match entry {
            Entry::Render => &self.render,
            Entry::Slice => self.slice()?,
        };
        debug_assert!(u64::from(width) * u64::from(tile.y + tile.height) <= sums.pixels, "{tile:?} of {width}");
        debug_assert!(tile.pixels() <= MOST_TILE_PIXELS, "{tile:?}");
        let place = [tile.x, tile.y, tile.width, tile.height, width, u32::from(is_first), 0, 0];
        let place: Vec<u8> = place.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.gpu.queue().write_buffer(&self.view, 0, view);
        self.gpu.queue().write_buffer(&self.place, 0, &place);
        let mut encoder = self.gpu.device().create_command_encoder(&CommandEncoderDescriptor::default());
        for (pipeline, bindings) in [(drawing, &self.bindings), (&self.add, &sums.bindings)] {
            let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, bindings, &[]);
            pass.dispatch_workgroups(tile.width.div_ceil(GROUP), tile.height.div_ceil(GROUP), 1);
        }
        Ok(self.gpu.queue().submit([encoder.finish()]))
    }

    /// The pipeline of slices, made when it is needed first.
    fn slice(&self) -> Result<&ComputePipeline, GpuError> {
        if let Some(pipeline) = self.slice.get() {
            return Ok(pipeline);
        }
        let made = pipeline(&self.gpu, &self.module, &self.layout, "slice")?;
        Ok(self.slice.get_or_init(|| made))
    }

    /// The first sums, in the order of the picture's pixels, after all work submitted so far.
    ///
    /// # Errors
    /// If some of that work failed.
    pub(crate) fn read(&self, sums: &Sums, pixels: u64) -> Result<Vec<[f32; 4]>, GpuError> {
        debug_assert!(pixels <= sums.pixels, "{pixels} of {}", sums.pixels);
        self.copy_back(&sums.buffer, &sums.readable, pixels)
    }

    /// Gradients and values of the scene's field: x, y, z of the gradient, and the value as the fourth.
    ///
    /// # Errors
    /// If the device refuses, or its memory does not suffice.
    pub(crate) fn probe(&self, view: &[u8], points: &[[f32; 3]]) -> Result<Vec<[f32; 4]>, GpuError> {
        let gpu = &self.gpu;
        let mut accesses = vec![(0, self.access), (1, Access::Uniform), (3, Access::Read), (4, Access::Write)];
        accesses.extend(self.voxels.iter().map(|_| (VOXELS, Access::Read)));
        let layout = layout_at(gpu, &accesses)?;
        let pipeline = pipeline(gpu, &self.module, &layout, "probe")?;
        gpu.queue().write_buffer(&self.view, 0, view);
        let mut results = Vec::with_capacity(points.len());
        for points in points.chunks(PROBES) {
            let numbers: Vec<f32> = points.iter().flat_map(|&[x, y, z]| [x, y, z, 0.0]).collect();
            let storage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
            let given = filled(gpu, "points", &numbers, storage)?;
            let bytes = points.len() as u64 * PIXEL;
            let found = gpu.buffer("values", bytes, BufferUsages::STORAGE | BufferUsages::COPY_SRC)?;
            let readable = gpu.buffer("values", bytes, BufferUsages::MAP_READ | BufferUsages::COPY_DST)?;
            let mut buffers = vec![(0, &self.parameters), (1, &self.view), (3, &given), (4, &found)];
            buffers.extend(self.voxels.iter().map(|voxels| (VOXELS, voxels)));
            let bindings = bind_at(gpu, &layout, &buffers)?;
            let mut encoder = gpu.device().create_command_encoder(&CommandEncoderDescriptor::default());
            {
                let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &bindings, &[]);
                pass.dispatch_workgroups((points.len() as u32).div_ceil(PROBE_GROUP), 1, 1);
            }
            gpu.queue().submit([encoder.finish()]);
            results.extend(self.copy_back(&found, &readable, points.len() as u64)?);
        }
        Ok(results)
    }

    /// The graphics processor it runs on.
    pub(crate) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    fn copy_back(&self, from: &Buffer, to: &Buffer, pixels: u64) -> Result<Vec<[f32; 4]>, GpuError> {
        let mut encoder = self.gpu.device().create_command_encoder(&CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(from, 0, to, 0, pixels * PIXEL);
        self.gpu.queue().submit([encoder.finish()]);
        let numbers = self.gpu.read(to, pixels as usize * 4)?;
        Ok(numbers.chunks_exact(4).map(|four| [four[0], four[1], four[2], four[3]]).collect())
    }
}

impl Sums {
    /// The buffer with a vector of four numbers for each pixel.
    pub(crate) fn buffer(&self) -> &Buffer {
        &self.buffer
    }
}

/// The binding of samples.
const VOXELS: u32 = 5;

/// The buffer of samples, if there are some.
fn voxel_buffer(gpu: &Gpu, voxels: &[[f32; 2]]) -> Result<Option<Buffer>, GpuError> {
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
    (!voxels.is_empty()).then(|| filled(gpu, device::VOXELS, voxels.as_flattened(), usage)).transpose()
}

/// What the shaders that draw are bound to.
fn drawing(
    gpu: &Gpu,
    layout: &BindGroupLayout,
    [parameters, view, tile]: [&Buffer; 3],
    voxels: Option<&Buffer>,
) -> Result<BindGroup, GpuError> {
    let mut buffers = vec![(0, parameters), (1, view), (2, tile)];
    buffers.extend(voxels.map(|voxels| (VOXELS, voxels)));
    bind_at(gpu, layout, &buffers)
}

/// Bytes of a pixel: four numbers.
const PIXEL: u64 = 16;

/// How a shader uses a buffer.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Access {
    Uniform,
    Read,
    Write,
}

/// A layout of bindings 0, 1, 2 and so on.
pub(crate) fn layout(gpu: &Gpu, accesses: &[Access]) -> Result<BindGroupLayout, GpuError> {
    let numbered: Vec<(u32, Access)> = (0..).zip(accesses.iter().copied()).collect();
    layout_at(gpu, &numbered)
}

fn layout_at(gpu: &Gpu, accesses: &[(u32, Access)]) -> Result<BindGroupLayout, GpuError> {
    let entries: Vec<BindGroupLayoutEntry> = accesses
        .iter()
        .map(|&(binding, access)| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::COMPUTE | ShaderStages::FRAGMENT,
            ty: BindingType::Buffer {
                ty: match access {
                    Access::Uniform => BufferBindingType::Uniform,
                    Access::Read => BufferBindingType::Storage { read_only: true },
                    Access::Write => BufferBindingType::Storage { read_only: false },
                },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        })
        .collect();
    gpu.checked(|| gpu.device().create_bind_group_layout(&BindGroupLayoutDescriptor { label: None, entries: &entries }))
}

/// Buffers for bindings 0, 1, 2 and so on.
pub(crate) fn bind(gpu: &Gpu, layout: &BindGroupLayout, buffers: &[&Buffer]) -> Result<BindGroup, GpuError> {
    let numbered: Vec<(u32, &Buffer)> = (0..).zip(buffers.iter().copied()).collect();
    bind_at(gpu, layout, &numbered)
}

fn bind_at(gpu: &Gpu, layout: &BindGroupLayout, buffers: &[(u32, &Buffer)]) -> Result<BindGroup, GpuError> {
    let entries: Vec<BindGroupEntry<'_>> = buffers
        .iter()
        .map(|&(binding, buffer)| BindGroupEntry { binding, resource: buffer.as_entire_binding() })
        .collect();
    gpu.checked(|| gpu.device().create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries }))
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    layout: &BindGroupLayout,
    entry_point: &str,
) -> Result<ComputePipeline, GpuError> {
    let bind_group_layouts = [Some(layout)];
    let descriptor =
        PipelineLayoutDescriptor { label: None, bind_group_layouts: &bind_group_layouts, immediate_size: 0 };
    let layout = gpu.checked(|| gpu.device().create_pipeline_layout(&descriptor))?;
    gpu.compute_pipeline(module, &layout, entry_point)
}

/// A buffer that holds numbers.
fn filled(gpu: &Gpu, what: &'static str, numbers: &[f32], usage: BufferUsages) -> Result<Buffer, GpuError> {
    let bytes = bytes_of(numbers);
    let buffer = gpu.buffer(what, bytes.len() as u64, usage)?;
    gpu.queue().write_buffer(&buffer, 0, &bytes);
    Ok(buffer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapter::Choice;
    use crate::picture::{Stopped, mean};
    use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
    use std::time::Duration;

    /// Draws a number of its own for each pixel and sample, and a field with a gradient of its own.
    const TEXT: &str = "
        struct View { origin: vec2<u32>, size: vec2<u32>, sample: u32 }
        @group(0) @binding(0) var<storage, read> parameters: array<f32>;
        @group(0) @binding(1) var<uniform> view: View;
        @group(0) @binding(2) var<storage, read_write> output: array<vec4<f32>>;
        @group(0) @binding(3) var<storage, read> points: array<vec4<f32>>;
        @group(0) @binding(4) var<storage, read_write> results: array<vec4<f32>>;

        @compute @workgroup_size(8, 8) fn render(@builtin(global_invocation_id) id: vec3<u32>) {
            if any(id.xy >= view.size) { return; }
            let at = view.origin + id.xy;
            output[id.y * view.size.x + id.x] = vec4(vec2<f32>(at), f32(view.sample), parameters[0]);
        }

        @compute @workgroup_size(64) fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
            if id.x >= arrayLength(&points) { return; }
            let p = points[id.x].xyz;
            results[id.x] = vec4(2.0 * p, dot(p, p) - parameters[0]);
        }
    ";

    fn view(tile: Rect, sample: u32) -> Vec<u8> {
        let numbers = [tile.x, tile.y, tile.width, tile.height, sample, 0];
        numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
    }

    fn table(numbers: &[f32]) -> Table<'_> {
        Table { numbers, is_uniform: false, voxels: &[] }
    }

    fn kernel(parameters: &[f32]) -> Kernel {
        let gpu = Gpu::open(&Choice::Automatic).unwrap_or_else(|error| panic!("{error}"));
        Kernel::new(&Arc::new(gpu), TEXT, table(parameters), 24).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn each_pixel_gets_the_mean_of_its_samples() {
        let kernel = kernel(&[3.5]);
        let region = Rect { x: 5, y: 9, width: 203, height: 141 };
        let furthest = AtomicU64::new(0);
        struct Watch<'a>(&'a AtomicU64);
        impl freikugel_render::Progress for Watch<'_> {
            fn advanced(&self, done: u64, total: u64) {
                assert_eq!(total, 203 * 141);
                assert!(done > self.0.swap(done, Ordering::Relaxed));
            }
        }
        let pixels = mean(&kernel, region, 5, Duration::from_millis(1), view, &Watch(&furthest)).expect("a picture");
        assert_eq!(furthest.into_inner(), region.pixels());
        for (index, pixel) in (0..).zip(pixels) {
            let expected = [5 + index % 203, 9 + index / 203].map(|n: u32| n as f32);
            for (found, expected) in pixel.into_iter().zip([expected[0], expected[1], 2.0, 3.5]) {
                assert!((found - expected).abs() <= expected * 1e-6, "{index}: {pixel:?}");
            }
        }
    }

    #[test]
    fn new_numbers_need_no_pipeline() {
        let kernel = kernel(&[1.0]);
        let region = Rect { x: 0, y: 0, width: 16, height: 16 };
        let before = kernel.gpu().pipelines();
        for number in [2.0, 3.0] {
            kernel.set_parameters(&[number]);
            let pixels = mean(&kernel, region, 1, Duration::from_secs(1), view, &()).expect("a picture");
            assert!(pixels.iter().all(|pixel| pixel[3] == number));
        }
        assert_eq!(kernel.gpu().pipelines(), before);
    }

    #[test]
    fn fields_are_evaluated_at_points() {
        let kernel = kernel(&[2.0]);
        let points: Vec<[f32; 3]> = (0..1000).map(|i| [i as f32, 0.5 * i as f32, -1.0]).collect();
        let found = kernel.probe(&view(Rect { x: 0, y: 0, width: 1, height: 1 }, 0), &points).expect("values");
        assert_eq!(found.len(), points.len());
        for ([x, y, z], found) in points.into_iter().zip(found) {
            assert_eq!(found[..3], [2.0 * x, 2.0 * y, 2.0 * z]);
            let value = x * x + y * y + z * z - 2.0;
            assert!((found[3] - value).abs() <= 1e-6 * value.abs() + 1e-6, "{value} {found:?}");
        }
    }

    #[test]
    fn a_rendering_can_be_stopped() {
        let region = Rect { x: 0, y: 0, width: 512, height: 512 };
        let stopped = mean(&kernel(&[0.0]), region, 4, Duration::from_secs(1), view, &AtomicBool::new(true));
        assert_eq!(stopped, Err(Stopped::Cancelled));
    }

    #[test]
    fn faults_are_values() {
        let gpu = Arc::new(Gpu::open(&Choice::Automatic).unwrap_or_else(|error| panic!("{error}")));
        let error = Kernel::new(&gpu, "fn render() { nonsense }", table(&[]), 16).expect_err("no shader");
        assert!(matches!(&error, GpuError::Invalid(reason) if reason.contains("nonsense")), "{error}");
        let error = Kernel::new(&gpu, "fn other() {}", table(&[]), 16).expect_err("no entry point");
        assert!(matches!(&error, GpuError::Invalid(reason) if reason.contains("render")), "{error}");
        let error = gpu.buffer("stars", u64::MAX / 2, BufferUsages::STORAGE).expect_err("too large");
        assert!(matches!(error, GpuError::TooLarge { what: "stars", .. }), "{error}");
        // It still works after all that.
        assert!(Kernel::new(&gpu, TEXT, table(&[0.0]), 24).is_ok());
    }

    #[test]
    fn unknown_names_are_answered_with_those_there_are() {
        let error = Gpu::open(&Choice::Named("no such thing".into())).expect_err("no adapter").to_string();
        assert!(error.contains("no such thing") && error.contains("there are"), "{error}");
    }
}
