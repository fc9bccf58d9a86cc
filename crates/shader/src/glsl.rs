//! The OpenGL Shading Language for Embedded Systems, version 3.00: that of WebGL 2 and Shadertoy.

use crate::print::{self, Language, decimal};
use crate::tree::{Function, Item, Type};
use std::fmt::Write;

/// Where the parameters are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// In an array of numbers.
    Numbers,
    /// In an array of vectors of four numbers, which is how uniforms are packed.
    Vectors,
    /// In blocks of as many vectors of four numbers as a block can hold anywhere, [`BLOCK_VECTORS`], called `parameters[n].block`;
    /// places that are computed go through the function `parameter`.
    Blocks,
    /// In a texture of vectors of four numbers, through the function `parameter`.
    Texture,
}

/// Vectors of four numbers in a block of uniforms: the 16 KB that WebGL 2 guarantees.
pub const BLOCK_VECTORS: usize = 1024;

/// The text of some items. Parameters are read from what is called `parameters`.
pub fn items(items: &[Item], table: Table) -> String {
    format!("{SELECT}\n{}", print::items(&Glsl { table }, items))
}

/// Selections without branches. The conditional operator is one for some drivers, which compile a scene with hundreds of them
/// ten times as long.
const SELECT: &str = "\
// The second value if the condition holds, otherwise the first one.
float select(float no, float yes, bool condition) { return mix(no, yes, condition); }
vec2 select(vec2 no, vec2 yes, bool condition) { return mix(no, yes, bvec2(condition)); }
vec3 select(vec3 no, vec3 yes, bool condition) { return mix(no, yes, bvec3(condition)); }
vec4 select(vec4 no, vec4 yes, bool condition) { return mix(no, yes, bvec4(condition)); }
int select(int no, int yes, bool condition) { return condition ? yes : no; }
bool select(bool no, bool yes, bool condition) { return condition ? yes : no; }
";

struct Glsl {
    table: Table,
}

/// Names that are free in other languages and mean something here.
const RESERVED: &[&str] = &[
    "active",
    "asm",
    "attribute",
    "buffer",
    "cast",
    "centroid",
    "class",
    "common",
    "coherent",
    "distance",
    "enum",
    "extern",
    "external",
    "filter",
    "fixed",
    "flat",
    "goto",
    "half",
    "in",
    "inline",
    "inout",
    "input",
    "interface",
    "invariant",
    "layout",
    "long",
    "namespace",
    "noinline",
    "noise1",
    "noise2",
    "noise3",
    "noise4",
    "out",
    "output",
    "partition",
    "patch",
    "precise",
    "precision",
    "public",
    "readonly",
    "resource",
    "sample",
    "sampler",
    "shared",
    "short",
    "sizeof",
    "smooth",
    "static",
    "subroutine",
    "superp",
    "template",
    "this",
    "typedef",
    "uniform",
    "union",
    "unsigned",
    "using",
    "varying",
    "volatile",
    "writeonly",
    "lowp",
    "mediump",
    "highp",
    "main",
    "texture",
];

impl Language for Glsl {
    fn of_type(&self, ty: &Type) -> String {
        match ty {
            Type::Bool => "bool".into(),
            Type::Int => "int".into(),
            Type::Float => "float".into(),
            Type::Vector(count) => format!("vec{count}"),
            Type::Matrix => "mat3".into(),
            Type::Struct(name) => self.name(name),
        }
    }

    fn float(&self, number: f32) -> String {
        decimal(number)
    }

    fn builtin<'n>(&self, name: &'n str) -> &'n str {
        match name {
            "atan2" => "atan",
            "inverseSqrt" => "inversesqrt",
            other => other,
        }
    }

    fn parameter(&self, place: Result<usize, String>) -> String {
        match (self.table, place) {
            (Table::Vectors, Ok(place)) => {
                format!("parameters[{}].{}", place / 4, ["x", "y", "z", "w"][place % 4])
            }
            (Table::Blocks, Ok(place)) => {
                let vector = place / 4;
                let (block, vector) = (vector / BLOCK_VECTORS, vector % BLOCK_VECTORS);
                format!("parameters[{block}].block[{vector}].{}", ["x", "y", "z", "w"][place % 4])
            }
            (Table::Numbers, Ok(place)) => format!("parameters[{place}]"),
            (Table::Numbers, Err(place)) => format!("parameters[{place}]"),
            (Table::Texture, Ok(place)) => format!("parameter({place})"),
            (Table::Vectors | Table::Blocks | Table::Texture, Err(place)) => format!("parameter({place})"),
        }
    }

    fn select(&self, condition: &str, yes: &str, no: &str) -> String {
        format!("select({no}, {yes}, {condition})")
    }

    fn name(&self, name: &str) -> String {
        if RESERVED.contains(&name) { format!("{name}_") } else { name.into() }
    }

    fn binding(&self, name: &str, ty: &Type, _is_variable: bool) -> String {
        format!("{} {}", self.of_type(ty), self.name(name))
    }

    fn head(&self, function: &Function) -> String {
        let argument = |(name, ty): &(String, Type)| format!("{} {}", self.of_type(ty), self.name(name));
        let arguments: Vec<String> = function.arguments.iter().map(argument).collect();
        format!("{} {}({})", self.of_type(&function.result), self.name(&function.name), arguments.join(", "))
    }

    fn count(&self, name: &str, from: &str, to: &str) -> String {
        format!("for (int {name} = {from}; {name} < {to}; {name}++)")
    }

    fn endless(&self) -> &'static str {
        "while (true)"
    }

    fn condition(&self, condition: &str) -> String {
        format!("if ({condition})")
    }

    fn structure(&self, name: &str, members: &[(String, Type)]) -> String {
        let mut text = format!("struct {} {{\n", self.name(name));
        for (member, ty) in members {
            let _ = writeln!(text, "    {} {member};", self.of_type(ty));
        }
        text + "};\n"
    }

    fn constant(&self, name: &str, ty: &Type) -> String {
        format!("const {} {}", self.of_type(ty), self.name(name))
    }
}
