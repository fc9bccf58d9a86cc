//! Showing sums of samples on a surface or texture: scaling, exposure, sRGB, and a panel of text above.

use super::overlay::Panel;
use super::refine::Fine;
use crate::device::{Gpu, GpuError};
use crate::kernel::{Access, Sums, bind, layout};
use freikugel_render::Tone;
use freikugel_scene::Overbright;
use std::sync::Arc;
use wgpu::{
    BindGroupLayout, Buffer, BufferUsages, Color, ColorTargetState, CommandEncoderDescriptor, FragmentState, LoadOp,
    MultisampleState, Operations, PipelineCompilationOptions, PipelineLayoutDescriptor, PrimitiveState,
    RenderPassColorAttachment, RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, StoreOp, TextureFormat,
    TextureView, VertexState,
};

/// Bytes of what the shader wants to know.
const SCREEN_BYTES: u64 = 64;

/// Shows pictures.
#[derive(Debug)]
pub(crate) struct Presenter {
    gpu: Arc<Gpu>,
    pipeline: RenderPipeline,
    layout: BindGroupLayout,
    screen: Buffer,
    panel: Buffer,
    panel_size: [u32; 2],
    is_encoded_later: bool,
}

/// What to show.
pub(crate) struct Picture<'s> {
    /// The surface's size in pixels.
    pub(crate) size: [u32; 2],
    /// A picture of fewer pixels, with one sample.
    pub(crate) coarse: &'s Sums,
    /// Its size in pixels.
    pub(crate) coarse_size: [u32; 2],
    /// A picture in the surface's size.
    pub(crate) fine: &'s Sums,
    /// What that holds.
    pub(crate) progress: Fine,
    /// How light becomes colour; nothing if the pictures are no light.
    pub(crate) tone: Option<Tone>,
}

impl Presenter {
    /// For surfaces or textures of a format.
    ///
    /// # Errors
    /// If the device refuses.
    pub(crate) fn new(gpu: &Arc<Gpu>, format: TextureFormat) -> Result<Self, GpuError> {
        let module = gpu.module(include_str!("present.wgsl"))?;
        let layout = layout(gpu, &[Access::Uniform, Access::Read, Access::Read, Access::Read])?;
        let layouts = [Some(&layout)];
        let descriptor = PipelineLayoutDescriptor { label: None, bind_group_layouts: &layouts, immediate_size: 0 };
        let pipeline_layout = gpu.checked(|| gpu.device().create_pipeline_layout(&descriptor))?;
        let pipeline = gpu.render_pipeline(&RenderPipelineDescriptor {
            label: Some("present"),
            layout: Some(&pipeline_layout),
            vertex: VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: PrimitiveState::default(),
            depth_stencil: None,
            multisample: MultisampleState::default(),
            fragment: Some(FragmentState {
                module: &module,
                entry_point: Some("color"),
                compilation_options: PipelineCompilationOptions::default(),
                targets: &[Some(ColorTargetState::from(format))],
            }),
            multiview_mask: None,
            cache: None,
        })?;
        let screen = gpu.buffer("the window", SCREEN_BYTES, BufferUsages::UNIFORM | BufferUsages::COPY_DST)?;
        let panel = gpu.buffer("text", 0, BufferUsages::STORAGE | BufferUsages::COPY_DST)?;
        Ok(Self {
            gpu: Arc::clone(gpu),
            pipeline,
            layout,
            screen,
            panel,
            panel_size: [0; 2],
            is_encoded_later: format.is_srgb(),
        })
    }

    /// Takes another text.
    ///
    /// # Errors
    /// If memory does not suffice.
    pub(crate) fn set_panel(&mut self, panel: &Panel) -> Result<(), GpuError> {
        let bytes = panel.pixels.as_flattened();
        if bytes.len() as u64 > self.panel.size() {
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
            self.panel = self.gpu.buffer("text", bytes.len() as u64, usage)?;
        }
        self.gpu.queue().write_buffer(&self.panel, 0, bytes);
        self.panel_size = [panel.width, panel.height];
        Ok(())
    }

    /// Draws a picture over all of a surface or texture.
    ///
    /// # Errors
    /// If the device refuses.
    pub(crate) fn draw(&self, target: &TextureView, picture: &Picture<'_>) -> Result<(), GpuError> {
        let Picture { size, coarse_size, progress, tone, .. } = *picture;
        let [rows, band, columns] = progress.covered;
        let gain = tone.map_or(0.0, |tone| tone.exposure.exp2());
        let is_scaled_down = tone.is_some_and(|tone| tone.overbright == Overbright::ScaleDown);
        let numbers = [
            size[0],
            size[1],
            coarse_size[0],
            coarse_size[1],
            self.panel_size[0],
            self.panel_size[1],
            progress.samples,
            rows,
            band,
            columns,
            gain.to_bits(),
            is_scaled_down.into(),
            self.is_encoded_later.into(),
        ];
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.gpu.queue().write_buffer(&self.screen, 0, &bytes);
        let buffers = [&self.screen, picture.coarse.buffer(), picture.fine.buffer(), &self.panel];
        let bindings = bind(&self.gpu, &self.layout, &buffers)?;
        let mut encoder = self.gpu.device().create_command_encoder(&CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: None,
                color_attachments: &[Some(RenderPassColorAttachment {
                    view: target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store },
                })],
                depth_stencil_attachment: None,
                timestamp_writes: None,
                occlusion_query_set: None,
                multiview_mask: None,
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &bindings, &[]);
            pass.draw(0..3, 0..1);
        }
        self.gpu.queue().submit([encoder.finish()]);
        Ok(())
    }
}
