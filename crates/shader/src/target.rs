//! The shells around the common text: what each language and host wants of a shader.

use crate::glsl::{BLOCK_VECTORS, Table};
use crate::sampled::SampleError;
use crate::shader::{Parameters, Shader, ShaderError};
use crate::{glsl, wgsl};
use std::fmt::Write;

/// A language, and a host that runs it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// WebGPU: the entry points `render`, `probe`, `cover` and `show`. See the [crate documentation](crate).
    Wgsl,
    /// WebGL 2: a fragment shader in GLSL ES 3.00.
    Glsl,
    /// Shadertoy: `mainImage`, with the numbers in the text.
    Shadertoy,
    /// A compute shader for Unity in HLSL.
    Hlsl,
    /// Metal.
    Msl,
}

impl Target {
    /// All of them with their names on the command line.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::Wgsl, "wgsl"),
        (Self::Glsl, "glsl"),
        (Self::Shadertoy, "shadertoy"),
        (Self::Hlsl, "hlsl"),
        (Self::Msl, "msl"),
    ];

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Wgsl => ".wgsl",
            Self::Glsl | Self::Shadertoy => ".glsl",
            Self::Hlsl => ".compute",
            Self::Msl => ".metal",
        }
    }
}

/// Bytes of uniforms that every WebGPU device has room for in one piece. Drivers load them at once for all rays that run side by
/// side, and from anywhere else for each of them.
pub const MOST_UNIFORM_BYTES: usize = 1 << 16;

/// WebGL 2 guarantees this many vectors of uniforms; a few are left for others.
const MOST_UNIFORMS: usize = 220;

/// WebGL 2 guarantees this many blocks of uniforms in a fragment shader.
const MOST_BLOCKS: usize = 12;

/// Vectors in a row of the texture that holds larger tables.
pub const TEXTURE_WIDTH: usize = 256;

/// Samples in a row of the texture that holds those of a scene in WebGL 2: what each device has room for.
pub const VOXELS_WIDTH: usize = 2048;

impl Shader {
    /// The text for a target. Only that for Shadertoy depends on the numbers; its host has no place for them outside the text.
    /// Those for WGSL and MSL keep up to [`MOST_UNIFORM_BYTES`] as uniforms, more in a storage buffer. That for WebGL 2 depends
    /// on how many there are: up to 220 vectors of four are uniforms, up to 12 times [`glsl::BLOCK_VECTORS`] come in blocks of
    /// uniforms, more in a texture.
    ///
    /// # Errors
    /// If the host has no place for samples, or the text does not pass validation, which would be a mistake of this crate.
    pub fn text(&self, target: Target, parameters: &Parameters) -> Result<String, ShaderError> {
        match target {
            Target::Wgsl => {
                let text = self.wgsl(WGSL_SHELL, parameters.is_uniform(), parameters);
                validated(&text)?;
                Ok(text)
            }
            Target::Glsl => Ok(self.webgl(parameters)),
            Target::Shadertoy if self.is_sampled() => Err(SampleError::Host("Shadertoy").into()),
            Target::Shadertoy => Ok(self.shadertoy(parameters)),
            Target::Hlsl => self.hlsl(parameters),
            Target::Msl => self.msl(parameters),
        }
    }

    fn wgsl(&self, shell: &str, is_uniform: bool, parameters: &Parameters) -> String {
        let mut text = String::from(WGSL_HEAD);
        // Of a length that is known, so that places are checked when the text is compiled, not on every ray.
        let space = if is_uniform { "uniform" } else { "storage, read" };
        let vectors = parameters.numbers().len() / 4;
        let _ = write!(
            text,
            "@group(0) @binding(0) var<{space}> parameters: array<vec4<f32>, {vectors}>;\n\n\
             fn parameter(place: i32) -> f32 {{\n    return parameters[place >> 2u][place & 3];\n}}\n\n\
             fn quad(place: i32) -> vec4<f32> {{\n    return parameters[place >> 2u];\n}}\n\n"
        );
        if self.is_sampled() {
            text.push_str(WGSL_SAMPLES);
        }
        text.push_str(&wgsl::items(self.items()));
        text.push_str(shell);
        text
    }

    fn webgl(&self, parameters: &Parameters) -> String {
        let count = parameters.numbers().len().div_ceil(4);
        let table = match count {
            0..=MOST_UNIFORMS => Table::Vectors,
            // Drivers take minutes for computed places in several blocks, which walks through many parts are full of.
            _ if count <= MOST_BLOCKS * BLOCK_VECTORS && !self.is_many() => Table::Blocks,
            _ => Table::Texture,
        };
        let mut text = String::from("#version 300 es\nprecision highp float;\nprecision highp int;\n\n");
        text.push_str(GLSL_VIEW);
        text.push_str("uniform View view;\n\n");
        text.push_str(&webgl_table(table, count));
        if self.is_sampled() {
            text.push_str(&webgl_samples());
        }
        text.push_str(&glsl::items(self.items(), table));
        text.push_str(WEBGL_SHELL);
        text
    }

    fn shadertoy(&self, parameters: &Parameters) -> String {
        let mut text = String::from(SHADERTOY_HEAD);
        let numbers = parameters.used();
        let _ = writeln!(text, "const float parameters[{0}] = float[{0}](", numbers.len());
        for (row, numbers) in numbers.chunks(10).enumerate() {
            let line: Vec<String> = numbers.iter().map(|&number| crate::print::decimal(number)).collect();
            let end = if (row + 1) * 10 >= parameters.used().len() { "" } else { "," };
            let _ = writeln!(text, "    {}{end}", line.join(", "));
        }
        text.push_str(");\n\n");
        text.push_str(SHADERTOY_QUAD);
        text.push_str(GLSL_VIEW);
        text.push_str("View view;\n\n");
        text.push_str(&glsl::items(self.items(), Table::Numbers));
        text.push_str(SHADERTOY_SHELL);
        text
    }

    fn hlsl(&self, parameters: &Parameters) -> Result<String, ShaderError> {
        let (module, info) = validated(&self.wgsl(UNITY_SHELL, false, parameters))?;
        let options = naga::back::hlsl::Options {
            shader_model: naga::back::hlsl::ShaderModel::V5_0,
            fake_missing_bindings: true,
            ..Default::default()
        };
        let pipeline = naga::back::hlsl::PipelineOptions::default();
        let mut text = String::new();
        naga::back::hlsl::Writer::new(&mut text, &options, &pipeline)
            .write(&module, &info, None)
            .map_err(|error| ShaderError::Invalid(error.to_string()))?;
        Ok(format!("{UNITY_HEAD}{text}{UNITY_TAIL}"))
    }

    fn msl(&self, parameters: &Parameters) -> Result<String, ShaderError> {
        let (module, info) = validated(&self.wgsl(WGSL_SHELL, parameters.is_uniform(), parameters))?;
        let options = naga::back::msl::Options { fake_missing_bindings: true, ..Default::default() };
        let (text, _) =
            naga::back::msl::write_string(&module, &info, &options, &naga::back::msl::PipelineOptions::default())
                .map_err(|error| ShaderError::Invalid(error.to_string()))?;
        Ok(text)
    }
}

/// How a shader for WebGL 2 comes by its parameters: their declaration, and the function for places that are computed.
fn webgl_table(table: Table, count: usize) -> String {
    match table {
        Table::Numbers | Table::Vectors => format!(
            "uniform vec4 parameters[{count}];\n\nfloat parameter(int place) {{\n    return parameters[place >> 2][place & 3];\n}}\n\n\
             vec4 quad(int place) {{\n    return parameters[place >> 2];\n}}\n\n"
        ),
        Table::Blocks => {
            // Blocks are told apart by literals only.
            let blocks = count.div_ceil(BLOCK_VECTORS);
            let mut text = format!(
                "layout(std140) uniform Parameters {{\n    vec4 block[{BLOCK_VECTORS}];\n}} parameters[{blocks}];\n\n\
                 float parameter(int place) {{\n    int vector = place >> 2;\n"
            );
            for block in 0..blocks {
                let end = (block + 1) * BLOCK_VECTORS;
                let condition = if block + 1 == blocks { String::new() } else { format!("if (vector < {end}) ") };
                let _ = writeln!(
                    text,
                    "    {condition}return parameters[{block}].block[vector - {}][place & 3];",
                    block * BLOCK_VECTORS
                );
            }
            text + "}\n\n"
        }
        Table::Texture => format!(
            "precision highp sampler2D;\nuniform sampler2D parameters;\n\n\
             vec4 quad(int place) {{\n    int texel = place >> 2;\n    \
             return texelFetch(parameters, ivec2(texel % {TEXTURE_WIDTH}, texel / {TEXTURE_WIDTH}), 0);\n}}\n\n\
             float parameter(int place) {{\n    return quad(place)[place & 3];\n}}\n\n"
        ),
    }
}

/// How a shader for WebGL 2 reads samples.
fn webgl_samples() -> String {
    format!(
        "// Samples in rows of {VOXELS_WIDTH}, in the red and the green channel.\nprecision highp sampler2D;\nuniform sampler2D voxels;\n\n\
         vec2 voxel(int place) {{\n    \
         return texelFetch(voxels, ivec2(place % {VOXELS_WIDTH}, place / {VOXELS_WIDTH}), 0).xy;\n}}\n\n"
    )
}

/// A module that an independent judge accepts.
pub(crate) fn validated(text: &str) -> Result<(naga::Module, naga::valid::ModuleInfo), ShaderError> {
    let module =
        naga::front::wgsl::parse_str(text).map_err(|error| ShaderError::Invalid(error.emit_to_string(text)))?;
    let flags = naga::valid::ValidationFlags::all();
    let info = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
        .validate(&module)
        .map_err(|error| ShaderError::Invalid(error.emit_to_string(text)))?;
    Ok((module, info))
}

const WGSL_HEAD: &str = include_str!("shells/head.wgsl");
const WGSL_SAMPLES: &str = "\
// Samples of the scene: values, each with a number.
@group(0) @binding(5) var<storage, read> voxels: array<vec2<f32>>;

fn voxel(place: i32) -> vec2<f32> {
    return voxels[place];
}

";
const WGSL_SHELL: &str = include_str!("shells/entries.wgsl");
const UNITY_SHELL: &str = include_str!("shells/unity.wgsl");
const UNITY_HEAD: &str = include_str!("shells/unity_head.hlsl");
const UNITY_TAIL: &str = include_str!("shells/unity_tail.hlsl");
const GLSL_VIEW: &str = include_str!("shells/view.glsl");
const WEBGL_SHELL: &str = include_str!("shells/webgl.glsl");
const SHADERTOY_HEAD: &str = include_str!("shells/shadertoy_head.glsl");
const SHADERTOY_QUAD: &str = "\
vec4 quad(int place) {
    return vec4(parameters[place], parameters[place + 1], parameters[place + 2], parameters[place + 3]);
}

";
const SHADERTOY_SHELL: &str = include_str!("shells/shadertoy.glsl");
