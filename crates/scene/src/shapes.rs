//! Shapes in files, read and described by their descriptors.
//!
//! A shape is an object whose one key is the name of a function and whose value holds its parameters; the shapes it works
//! on stand under `shape` or `shapes`. A function of many shapes that needs no parameters may have the list for a value.
//! Which functions there are, nothing here knows but [`freikugel_field::shapes::ALL`].

mod param;

use crate::files::FileNotation;
use crate::named::{USE, used};
use crate::notation::{FormulaNotation, Notation};
use crate::object::MaterialNotation;
use crate::reader::{Entries, NodePlace, Reader, name_span, span};
use crate::schema::{Definitions, Need, ObjectSchema};
use crate::suggest::{closest, quote};
use crate::syntax::Written;
use freikugel_field::shape::{FileParam, FormulaParam};
use freikugel_field::{Arity, Field, Formula, Kind, MaterialId, Origin, Shape, Value, shapes};
use jsonc_parser::ast::ObjectProp;
use serde_json::{Value as Json, json};

/// The notation of shapes.
pub(crate) struct ShapeNotation;

/// The key of the shape that a function works on.
const CHILD: &str = "shape";

/// The key of the shapes that a function works on.
const CHILDREN: &str = "shapes";

/// The key of the material that a function paints with.
const MATERIAL: &str = "material";

fn by_name(name: &str) -> Option<&'static Shape> {
    shapes::ALL.iter().copied().find(|shape| shape.about.name == name)
}

impl Notation<Field> for ShapeNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Field> {
        let field = read_shape(reader, value)?;
        reader.roots.push(field.clone());
        Some(field)
    }

    fn write(&self, _value: &Field) -> Option<Json> {
        None
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        definitions.define("shape", |definitions| {
            let mut functions: serde_json::Map<_, _> = shapes::ALL
                .iter()
                .map(|shape| (shape.about.name.to_string(), function_schema(shape, definitions)))
                .collect();
            let used = json!({ "type": "string", "description": "The name of a shape under `shapes`." });
            functions.insert(USE.into(), used);
            json!({
                "description": "A shape: an object with one key, its name, and its parameters as the value.",
                "type": "object",
                "properties": functions,
                "additionalProperties": false,
                "minProperties": 1,
                "maxProperties": 1,
            })
        })
    }
}

/// A shape and all within it. If it can't be read, the sound parts of it become roots of their own.
pub(crate) fn read_shape(reader: &mut Reader, value: &Written<'_>) -> Option<Field> {
    let Written::Object(object) = value else {
        reader.mistyped(value, "a shape", Some(for_instance(&shapes::SPHERE)));
        return None;
    };
    let mut found: Option<(Callee, &ObjectProp<'_>)> = None;
    let mut strangers = Vec::new();
    let mut is_alone = true;
    for prop in &object.properties {
        let key = prop.name.as_str();
        match (Callee::by_name(key), found) {
            (Some(callee), None) => found = Some((callee, prop)),
            (Some(_), Some((first, _))) => {
                let message = format!("{} stands in the same object as `{}`", quote(key), first.name());
                reader.error(name_span(prop), message, Some("give each shape an object of its own".into()));
                is_alone = false;
            }
            (None, _) => strangers.push(prop),
        }
    }
    for prop in &strangers {
        stranger(reader, prop, found.map(|(callee, _)| callee.name()));
    }
    if object.properties.is_empty() {
        reader.error(span(value), "a shape is missing here", Some(for_instance(&shapes::SPHERE)));
    }
    let field = match found? {
        (Callee::Use, prop) => used(reader, &prop.value),
        (Callee::Shape(shape), prop) => {
            let index = reader.nodes.len();
            reader.nodes.push(NodePlace { name: name_span(prop), params: vec![None; shape.about.params.len()] });
            reader.labelled(quote(shape.about.name), |reader| call(reader, shape, index, &prop.value))
        }
    };
    if is_alone && strangers.is_empty() {
        return field;
    }
    reader.roots.extend(field);
    None
}

/// What the key of a shape says.
#[derive(Clone, Copy)]
enum Callee {
    /// A function.
    Shape(&'static Shape),
    /// That a shape with a name is meant.
    Use,
}

impl Callee {
    fn by_name(name: &str) -> Option<Self> {
        if name == USE { Some(Self::Use) } else { by_name(name).map(Self::Shape) }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Shape(shape) => shape.about.name,
            Self::Use => USE,
        }
    }
}

/// Reports a key that names no shape where one should.
fn stranger(reader: &mut Reader, prop: &ObjectProp<'_>, beside: Option<&str>) {
    let (key, place) = (prop.name.as_str(), name_span(prop));
    if let Some(name) = beside {
        let message = format!("{} can't stand beside `{name}`", quote(key));
        let hint = "what belongs to a shape goes into its own braces";
        return reader.error(place, message, Some(hint.into()));
    }
    let known = shapes::ALL.iter().map(|shape| shape.about.name);
    let elsewhere = shapes::ALL.iter().find(|shape| shape.about.elsewhere.contains(&key));
    let hint = match (elsewhere, closest(key, known.clone())) {
        (Some(shape), _) => format!("here it is called `{}`", shape.about.name),
        (None, Some(guess)) => format!("did you mean `{guess}`?"),
        (None, None) => {
            let more = if known.len() > MOST_LISTED { ", ..." } else { "" };
            format!("there are {}{more}", known.take(MOST_LISTED).collect::<Vec<_>>().join(", "))
        }
    };
    reader.error(place, format!("there is no shape {}", quote(key)), Some(hint));
}

/// As many names of shapes as a hint can hold and still be read.
const MOST_LISTED: usize = 40;

/// The example of a shape in a hint, on one line.
pub(crate) fn for_instance(shape: &Shape) -> String {
    format!("for instance {}", shape.about.example.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// A call of `shape` with the parameters and shapes in `value`.
fn call(reader: &mut Reader, shape: &'static Shape, index: usize, value: &Written<'_>) -> Option<Field> {
    let about = &shape.about;
    let arity = shape.arity();
    let is_paint = matches!(shape.kind, Kind::Paint);
    let is_formula = matches!(shape.kind, Kind::Formula);
    let mut keys: Vec<&'static str> = shape.formulas().iter().map(|formula| formula.name).collect();
    keys.extend(about.params.iter().map(|param| param.name));
    keys.extend(is_paint.then_some(MATERIAL));
    keys.extend(shape.file.map(|file| file.name));
    keys.extend(child_key(arity));
    let what = quote(about.name);

    if let (Arity::Many, Written::Array(_)) = (arity, value) {
        let children = list(reader, value);
        let missing: Vec<_> = about.params.iter().filter(|param| param.default.is_none()).collect();
        for param in &missing {
            let message = format!("{what} needs `{}`", param.name);
            reader.error(reader.nodes[index].name.clone(), message, Some(for_instance(shape)));
        }
        let args = missing.is_empty().then(Vec::new);
        return finish(reader, shape, index, args, Some(None), children);
    }
    if let (true, Written::StringLit(_)) = (is_formula, value) {
        let expression = FormulaNotation.read(reader, value)?;
        let field = finish(reader, shape, index, Some(Vec::new()), Some(None), Vec::new())?;
        return Some(field.with_formula(Ok(expression)));
    }
    if !matches!(value, Written::Object(_)) {
        let wanted = if keys == [CHILDREN] { "a list of shapes" } else { "an object with its parameters" };
        reader.mistyped(value, wanted, Some(for_instance(shape)));
        return None;
    }
    let entries = reader.entries(value, &keys)?;
    let args = arguments(reader, shape, index, &entries);
    let material = if is_paint {
        entries.require(reader, MATERIAL, "the name of a material");
        entries.read(reader, MATERIAL, &MaterialNotation).map(Some)
    } else {
        Some(None)
    };
    let children = match arity {
        Arity::None => Vec::new(),
        Arity::One => {
            let child = entries.require(reader, CHILD, "the shape it works on");
            vec![child.and_then(|child| reader.labelled(quote(CHILD), |reader| read_shape(reader, child)))]
        }
        Arity::Many => match entries.require(reader, CHILDREN, "the shapes it works on") {
            Some(value) => reader.labelled(quote(CHILDREN), |reader| list(reader, value)),
            None => vec![None],
        },
    };
    if let Some((file, value)) = shape.file.and_then(|file| Some((file, entries.get(file.name)?))) {
        return made_with(reader, &file, value, index, args);
    }
    let formulas = formulas(reader, shape, &entries);
    let field = finish(reader, shape, index, args, material, children)?;
    Some(field.with_formulas(formulas?.into_iter().map(Ok)))
}

/// The shape that is made with a file, or `None` after reporting what is wrong with it.
fn made_with(
    reader: &mut Reader,
    file: &FileParam,
    value: &Written<'_>,
    index: usize,
    args: Option<Vec<f64>>,
) -> Option<Field> {
    let contents = reader.labelled(quote(file.name), |reader| FileNotation.read(reader, value));
    let built = (file.build)(&args?, &contents?);
    // Its arguments are others than those that stand in the document.
    reader.nodes[index].params.clear();
    let field = built.map_err(|fault| reader.error(span(value), fault, None)).ok()?;
    Some(field.written_at(origin(index)))
}

/// Where a node of the document was written.
fn origin(index: usize) -> Origin {
    Origin::Document(u32::try_from(index).unwrap_or(u32::MAX))
}

/// All formulas that a function takes, or `None` after reporting what is wrong with them.
fn formulas(reader: &mut Reader, shape: &Shape, entries: &Entries<'_>) -> Option<Vec<Formula>> {
    let read = |param: &FormulaParam| match param.default.filter(|_| entries.get(param.name).is_none()) {
        Some(text) => Formula::parse(text).ok(),
        None => {
            entries.require(reader, param.name, param.about);
            entries.read(reader, param.name, &FormulaNotation)
        }
    };
    // All of them are looked at.
    let formulas: Vec<Option<Formula>> = shape.formulas().iter().map(read).collect();
    formulas.into_iter().collect()
}

fn child_key(arity: Arity) -> Option<&'static str> {
    match arity {
        Arity::None => None,
        Arity::One => Some(CHILD),
        Arity::Many => Some(CHILDREN),
    }
}

/// The shapes of a list, `None` for those that can't be read.
fn list(reader: &mut Reader, value: &Written<'_>) -> Vec<Option<Field>> {
    let Written::Array(array) = value else {
        reader.mistyped(value, "a list of shapes", None);
        return vec![None];
    };
    let outer = reader.label().to_string();
    let labels = (1..).map(|number| format!("entry {number} of {outer}"));
    let elements = array.elements.iter().zip(labels);
    elements.map(|(element, label)| reader.labelled(label, |reader| read_shape(reader, element))).collect()
}

/// The node, if all of it could be read; otherwise its sound children become roots.
fn finish(
    reader: &mut Reader,
    shape: &'static Shape,
    index: usize,
    args: Option<Vec<f64>>,
    material: Option<Option<MaterialId>>,
    children: Vec<Option<Field>>,
) -> Option<Field> {
    let is_whole = children.iter().all(Option::is_some);
    let children = children.into_iter().flatten();
    let (Some(args), Some(material), true) = (args, material, is_whole) else {
        reader.roots.extend(children);
        return None;
    };
    let args = args.into_iter().map(Value::Literal);
    Some(Field::with_origin(shape, args, children, material, origin(index)))
}

/// The numbers of all parameters, defaults included, or `None` after reporting what is wrong with them.
fn arguments(reader: &mut Reader, shape: &Shape, index: usize, entries: &Entries<'_>) -> Option<Vec<f64>> {
    let mut args = Vec::new();
    let mut is_sound = true;
    for (place, param) in shape.about.params.iter().enumerate() {
        let written = match param.default {
            Some(_) => entries.get(param.name),
            None => entries.require(reader, param.name, param.about),
        };
        let numbers = match written {
            Some(value) => {
                reader.nodes[index].params[place] = Some(span(value));
                reader.labelled(quote(param.name), |reader| param.kind.read(reader, value))
            }
            None => param.default.map(<[f64]>::to_vec),
        };
        is_sound &= numbers.is_some();
        args.extend(numbers.unwrap_or_default());
    }
    is_sound.then_some(args)
}

/// The schema of a call of `shape`.
fn function_schema(shape: &'static Shape, definitions: &mut Definitions) -> Json {
    let about = &shape.about;
    let mut object = ObjectSchema::default();
    for param in about.params {
        let need = match param.default {
            None => Need::Required,
            Some(default) => Need::Optional(param.kind.write(&default.to_vec())),
        };
        object.key(param.name, param.about, param.kind.schema(definitions), need);
    }
    if matches!(shape.kind, Kind::Paint) {
        let name = MaterialNotation.schema(definitions);
        object.key(MATERIAL, "The name of a material.", name, Need::Required);
    }
    for param in shape.formulas() {
        let need = match param.default {
            None => Need::Required,
            Some(text) => Need::Optional(Some(json!(text))),
        };
        object.key(param.name, param.about, FormulaNotation.schema(definitions), need);
    }
    if let Some(file) = shape.file {
        object.key(file.name, file.about, FileNotation.schema(definitions), Need::Optional(None));
    }
    // A shape's definition is under construction here; this only names it.
    let child = || json!({ "$ref": "#/$defs/shape" });
    let several = || json!({ "type": "array", "items": child(), "minItems": 1 });
    match shape.arity() {
        Arity::None => {}
        Arity::One => object.key(CHILD, "The shape it works on.", child(), Need::Required),
        Arity::Many => object.key(CHILDREN, "The shapes it works on.", several(), Need::Required),
    }
    let is_plain = about.params.iter().all(|param| param.default.is_some());
    let mut schema = match shape.arity() {
        Arity::Many if is_plain => json!({ "anyOf": [several(), object.finish()] }),
        _ if matches!(shape.kind, Kind::Formula) => {
            json!({ "anyOf": [FormulaNotation.schema(definitions), object.finish()] })
        }
        _ => object.finish(),
    };
    schema["description"] = about.summary.into();
    schema
}
