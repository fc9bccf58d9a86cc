//! Parameters: numbers with names, which formulas all over a scene may use.

use crate::diagnostic::Severity;
use crate::names::TIME;
use crate::notation::{Maybe, Notation, Number, Words, are_keyframes, number_schema, tidy};
use crate::reader::{Reader, name_span, span};
use crate::record::{Fault, Record, RecordNotation, record};
use crate::schema::Definitions;
use crate::suggest::{listed, quote};
use crate::syntax::Written;
use freikugel_field::formula::name_fault;
use jsonc_parser::ast::ObjectProp;
use serde_json::{Value as Json, json};

record! {
    /// A number with a name, which formulas all over the scene may use.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Parameter = "parameter" {
        /// Its value, unless it is set to another one from outside.
        pub value: f64 = 0.0, required Number::ANY;
        /// The least value that it can be set to.
        pub from: Option<f64> = None, optional Maybe(Number::ANY);
        /// The largest value that it can be set to.
        pub to: Option<f64> = None, optional Maybe(Number::ANY);
        /// What it is measured in, for people.
        pub unit: String = String::new(), optional Words;
        /// What it means, for people.
        pub about: String = String::new(), optional Words;
    }
    checked by out_of_range
}

fn out_of_range(parameter: &Parameter) -> Vec<Fault> {
    let fault = |message: String| vec![Fault { severity: Severity::Error, key: "value", message, hint: None }];
    match (parameter.from, parameter.to) {
        (Some(from), Some(to)) if from > to => {
            let message = format!("`from` is {from}, which is above `to`, {to}");
            vec![Fault { severity: Severity::Error, key: "from", message, hint: None }]
        }
        (Some(from), _) if parameter.value < from => fault(format!("`value` is {}, below `from`", parameter.value)),
        (_, Some(to)) if parameter.value > to => fault(format!("`value` is {}, above `to`", parameter.value)),
        _ => Vec::new(),
    }
}

/// The notation of one parameter: a number, or an object that says more about it.
struct ParameterNotation;

impl Notation<Parameter> for ParameterNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Parameter> {
        match value {
            Written::Object(_) if !are_keyframes(value) => RecordNotation.read(reader, value),
            _ => Some(Parameter { value: reader.number(value)?, ..Parameter::default() }),
        }
    }

    fn write(&self, parameter: &Parameter) -> Option<Json> {
        let plain = Parameter { value: parameter.value, ..Parameter::default() };
        if *parameter == plain { Some(tidy(parameter.value)) } else { Some(parameter.write()) }
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        json!({ "anyOf": [number_schema(), definitions.record::<Parameter>()] })
    }
}

/// The notation of the table of parameters: an object with their names as keys.
pub(crate) struct ParametersNotation;

impl Notation<Vec<(String, Parameter)>> for ParametersNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<Vec<(String, Parameter)>> {
        let Written::Object(object) = value else {
            reader.mistyped(value, "an object with a number for each name", None);
            return None;
        };
        let mut found: Vec<(String, Parameter)> = Vec::new();
        let mut pending: Vec<&ObjectProp<'_>> = Vec::new();
        for prop in &object.properties {
            let name = prop.name.as_str();
            let fault = if name == TIME { Some("is the time already") } else { name_fault(name) };
            if let Some(fault) = fault {
                reader.error(name_span(prop), format!("{} {fault}", quote(name)), Some("choose another name".into()));
            } else if pending.iter().any(|other| other.name.as_str() == name) {
                reader.duplicate(prop);
            } else {
                pending.push(prop);
            }
        }
        // In whatever order they are written: each after those that it uses.
        while let Some(index) = pending.iter().position(|prop| !uses_any(&prop.value, &pending)) {
            let prop = pending.remove(index);
            found.push((prop.name.as_str().to_owned(), parameter(reader, prop)));
        }
        for prop in &pending {
            let name = quote(prop.name.as_str());
            let (message, hint) = match &*pending {
                [_] => (format!("{name} depends on itself"), None),
                all => {
                    let all = listed(all.iter().map(|prop| prop.name.as_str()));
                    (format!("{name} depends on itself, or on another that does"), Some(format!("among {all}")))
                }
            };
            reader.error(span(&prop.value), message, hint);
            // One fault is enough: formulas may use its name.
            reader.names.define(prop.name.as_str(), 1.0);
        }
        let place = |name: &str| object.properties.iter().position(|prop| prop.name.as_str() == name);
        found.sort_by_key(|(name, _)| place(name));
        Some(found)
    }

    fn write(&self, value: &Vec<(String, Parameter)>) -> Option<Json> {
        let entry = |(name, parameter): &(String, Parameter)| Some((name.clone(), ParameterNotation.write(parameter)?));
        (!value.is_empty()).then(|| Json::Object(value.iter().filter_map(entry).collect()))
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        json!({
            "type": "object",
            "additionalProperties": ParameterNotation.schema(definitions),
        })
    }
}

/// Reads a parameter and gives its name the value that it has or is set to.
fn parameter(reader: &mut Reader, prop: &ObjectProp<'_>) -> Parameter {
    let name = prop.name.as_str();
    let read = reader.labelled(quote(name), |reader| ParameterNotation.read(reader, &prop.value));
    let Some(mut parameter) = read else {
        reader.names.define(name, 1.0);
        return Parameter::default();
    };
    if let Some(set) = reader.names.set(name) {
        let is_sound = parameter.joint_faults().is_empty();
        parameter.value = set;
        let below = parameter.from.filter(|&from| set < from).map(|from| format!("at least {from}"));
        let above = parameter.to.filter(|&to| set > to).map(|to| format!("at most {to}"));
        if let Some(limit) = below.or(above).filter(|_| is_sound) {
            reader.error(span(&prop.value), format!("{} is set to {set}, but can be {limit}", quote(name)), None);
        }
    }
    reader.names.define(name, parameter.value);
    parameter
}

/// Whether a value has texts that use one of the names of `others`.
fn uses_any(value: &Written<'_>, others: &[&ObjectProp<'_>]) -> bool {
    match value {
        Written::StringLit(text) => {
            let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
            let mut words = text.value.split(|c| !is_part(c));
            words.any(|word| {
                // A number may stand before a name: `2r`.
                let word = word.trim_start_matches(|c: char| c.is_ascii_digit());
                others.iter().any(|other| other.name.as_str() == word)
            })
        }
        Written::Object(object) => {
            // What is said to people is no formula.
            let numbers = object.properties.iter().filter(|prop| !matches!(prop.name.as_str(), "unit" | "about"));
            numbers.into_iter().any(|prop| uses_any(&prop.value, others))
        }
        _ => false,
    }
}

/// Reports names that are set from outside but are no parameters, and parameters that no formula uses.
pub(crate) fn report_unused(reader: &mut Reader, root: &Written<'_>) {
    let table = root.as_object().and_then(|root| root.get_object("parameters"));
    let names: Vec<&str> = table.iter().flat_map(|table| &table.properties).map(|prop| prop.name.as_str()).collect();
    let strangers: Vec<String> =
        reader.names.all_set().filter(|name| !names.contains(name)).map(str::to_owned).collect();
    for name in strangers {
        let place = table.map_or(span(root).start..span(root).start + 1, |table| table.range.start..table.range.end);
        let hint = match &*names {
            [] => "it has none; a scene has them under `parameters`".to_owned(),
            names => format!("it has {}", listed(names.iter().copied())),
        };
        reader.error(place, format!("the scene has no parameter {}", quote(&name)), Some(hint));
    }
    for prop in table.iter().flat_map(|table| &table.properties) {
        let name = prop.name.as_str();
        if name_fault(name).is_none() && name != TIME && !reader.names.is_used(name) {
            reader.report(Severity::Warning, name_span(prop), format!("no formula uses {}", quote(name)), None);
        }
    }
}
