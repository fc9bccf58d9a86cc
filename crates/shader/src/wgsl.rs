//! The WebGPU Shading Language.

use crate::print::{self, Language, decimal};
use crate::tree::{Function, Item, Type};
use std::fmt::Write;

/// The text of some items. Parameters are read from an array of vectors of four called `parameters`; places that are computed go
/// through the function `parameter`.
pub fn items(items: &[Item]) -> String {
    print::items(&Wgsl, items)
}

struct Wgsl;

impl Language for Wgsl {
    fn of_type(&self, ty: &Type) -> String {
        match ty {
            Type::Bool => "bool".into(),
            Type::Int => "i32".into(),
            Type::Float => "f32".into(),
            Type::Vector(count) => format!("vec{count}<f32>"),
            Type::Matrix => "mat3x3<f32>".into(),
            Type::Struct(name) => name.clone(),
        }
    }

    fn float(&self, number: f32) -> String {
        decimal(number)
    }

    fn builtin<'n>(&self, name: &'n str) -> &'n str {
        name
    }

    fn parameter(&self, place: Result<usize, String>) -> String {
        match place {
            Ok(place) => format!("parameters[{}].{}", place / 4, ["x", "y", "z", "w"][place % 4]),
            Err(place) => format!("parameter({place})"),
        }
    }

    fn select(&self, condition: &str, yes: &str, no: &str) -> String {
        format!("select({no}, {yes}, {condition})")
    }

    fn name(&self, name: &str) -> String {
        name.into()
    }

    fn binding(&self, name: &str, ty: &Type, is_variable: bool) -> String {
        // The type follows from the value; only a variable that starts with a whole number could mean another.
        match (is_variable, ty) {
            (false, _) => format!("let {name}"),
            (true, ty) => format!("var {name}: {}", self.of_type(ty)),
        }
    }

    fn head(&self, function: &Function) -> String {
        let arguments: Vec<String> =
            function.arguments.iter().map(|(name, ty)| format!("{name}: {}", self.of_type(ty))).collect();
        format!("fn {}({}) -> {}", function.name, arguments.join(", "), self.of_type(&function.result))
    }

    fn count(&self, name: &str, from: &str, to: &str) -> String {
        format!("for (var {name}: i32 = {from}; {name} < {to}; {name}++)")
    }

    fn endless(&self) -> &'static str {
        "loop"
    }

    fn condition(&self, condition: &str) -> String {
        format!("if {condition}")
    }

    fn structure(&self, name: &str, members: &[(String, Type)]) -> String {
        let mut text = format!("struct {name} {{\n");
        for (member, ty) in members {
            let _ = writeln!(text, "    {member}: {},", self.of_type(ty));
        }
        text + "}\n"
    }

    fn constant(&self, name: &str, ty: &Type) -> String {
        format!("const {name}: {}", self.of_type(ty))
    }
}
