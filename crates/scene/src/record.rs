//! Records: structs with one declaration for everything that is said about them.
//!
//! The declaration of a record yields the struct with its documentation and defaults, the reading of its JSON object with
//! all checks, and its JSON Schema. Each field names its key, whether the key is required, and its [`Notation`], where
//! its range stands; nothing of that is written a second time anywhere.
//!
//! [`Notation`]: crate::notation::Notation

use crate::diagnostic::Severity;
use crate::notation::Notation;
use crate::reader::Reader;
use crate::schema::{Definitions, RecordSchema};
use crate::syntax::Written;
use serde_json::Value as Json;
use std::fmt::Debug;

/// A struct that is an object with fixed keys in files. See [`record!`].
pub(crate) trait Record: Sized + Default {
    /// What messages and the schema call it.
    const NAME: &'static str;

    /// The record that an object holds; faulty and missing entries are reported and have their defaults.
    fn read(reader: &mut Reader, value: &Written<'_>) -> Option<Self>;

    /// The faults of its fields, each by itself; if there are none, those that several make together.
    fn faults(&self) -> Vec<Fault>;

    /// The faults that several fields make together, when each by itself is sound.
    fn joint_faults(&self) -> Vec<Fault>;

    /// All entries that differ from a missing key.
    fn write(&self) -> Json;

    /// The schema of the object.
    fn schema(schema: &mut RecordSchema<'_>);
}

/// What is wrong with a record.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) severity: Severity,
    /// The key it is about.
    pub(crate) key: &'static str,
    pub(crate) message: String,
    pub(crate) hint: Option<String>,
}

impl Fault {
    /// What a notation says of the value of a key.
    pub(crate) fn of<T>(key: &'static str, notation: &dyn Notation<T>, value: &T) -> Option<Self> {
        let message = format!("`{key}` {}", notation.fault(value)?);
        Some(Self { severity: Severity::Error, key, message, hint: None })
    }
}

/// The notation of a record.
#[derive(Debug)]
pub(crate) struct RecordNotation;

impl<R: Record> Notation<R> for RecordNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<R> {
        R::read(reader, value)
    }

    fn write(&self, value: &R) -> Option<Json> {
        Some(value.write())
    }

    fn schema(&self, definitions: &mut Definitions) -> Json {
        definitions.record::<R>()
    }
}

/// Declares a record: see the [module documentation](self).
///
/// A field is `key: Type = default, need NOTATION;`, where the need is `required` or `optional`. What follows the notation
/// is optional: `or "key" NOTATION` for another key that gives the same field another way, and `setter name` for a
/// chaining method. `checked by function` names a function from the record to its faults across fields; `in code` declares
/// fields that files don't have; `in files` keys that code doesn't have.
macro_rules! record {
    (
        $(#[doc = $about:literal])+
        #[derive($($Derive:ident),+)]
        $vis:vis struct $Record:ident = $name:literal {
            $(
                $(#[doc = $doc:literal])+
                pub $field:ident $(as $as:literal)?: $Type:ty = $default:expr, $need:ident $notation:expr
                    $(, or $or_key:literal $or_notation:expr)*
                    $(, setter $setter:ident)?;
            )+
        }
        $(in code { $( $(#[doc = $code_doc:literal])+ pub $code_field:ident: $CodeType:ty; )+ })?
        $(in files { $( $(#[doc = $file_doc:literal])+ $file_key:literal: $file_notation:expr; )+ })?
        $(checked by $check:expr)?
    ) => {
        $(#[doc = $about])+
        #[derive($($Derive),+)]
        $vis struct $Record {
            $( $(#[doc = $doc])+ pub $field: $Type, )+
            $($( $(#[doc = $code_doc])+ pub $code_field: $CodeType, )+)?
        }

        impl Default for $Record {
            fn default() -> Self {
                Self {
                    $( $field: $default, )+
                    $($( $code_field: <$CodeType>::default(), )+)?
                }
            }
        }

        impl $Record {
            $($(
                #[doc = concat!("The same with another [`", stringify!($field), "`](Self::", stringify!($field), ").")]
                #[must_use]
                pub fn $setter(self, $field: impl $crate::Argument<$Type>) -> Self {
                    Self { $field: $field.value(), ..self }
                }
            )?)+
        }

        impl $crate::record::Record for $Record {
            const NAME: &'static str = $name;

            fn read(
                reader: &mut $crate::reader::Reader,
                value: &$crate::syntax::Written<'_>,
            ) -> Option<Self> {
                const KEYS: &[&str] = &[
                    $( $crate::record::key!($field $($as)?), $($or_key,)* )+
                    $($( $file_key, )+)?
                ];
                let before = reader.errors();
                let entries = reader.entries(value, KEYS)?;
                $(
                    let key = $crate::record::key!($field $($as)?);
                    $crate::record::require!($need entries, reader, key, concat!($($doc),+));
                    let $field: Option<$Type> = entries.read(reader, key, &$notation);
                    $(
                        entries.exclude(reader, key, $or_key);
                        let $field = entries.read(reader, $or_key, &$or_notation).or($field);
                    )*
                )+
                $($( let _: Option<()> = entries.read(reader, $file_key, &$file_notation); )+)?
                let record = Self {
                    $( $field: $field.unwrap_or_else(|| $default), )+
                    $($( $code_field: <$CodeType>::default(), )+)?
                };
                if reader.errors() == before {
                    for fault in $crate::record::Record::joint_faults(&record) {
                        let span = entries.get(fault.key).map_or(entries.span(), $crate::reader::span);
                        reader.report(fault.severity, span, fault.message, fault.hint);
                    }
                }
                Some(record)
            }

            fn faults(&self) -> Vec<$crate::record::Fault> {
                let mut faults = Vec::new();
                $(
                    let key = $crate::record::key!($field $($as)?);
                    faults.extend($crate::record::Fault::of(key, &$notation, &self.$field));
                    $( faults.extend($crate::record::Fault::of($or_key, &$or_notation, &self.$field)); )*
                )+
                if faults.is_empty() { $crate::record::Record::joint_faults(self) } else { faults }
            }

            fn joint_faults(&self) -> Vec<$crate::record::Fault> {
                $( return $check(self); )?
                #[allow(unreachable_code, reason = "reached in records without joint faults")]
                Vec::new()
            }

            fn write(&self) -> serde_json::Value {
                let mut object = serde_json::Map::new();
                $(
                    let json = $crate::notation::Notation::<$Type>::write(&$notation, &self.$field);
                    object.extend(json.map(|json| ($crate::record::key!($field $($as)?).into(), json)));
                    $(
                        let json = $crate::notation::Notation::<$Type>::write(&$or_notation, &self.$field);
                        object.extend(json.map(|json| ($or_key.into(), json)));
                    )*
                )+
                object.into()
            }

            fn schema(schema: &mut $crate::schema::RecordSchema<'_>) {
                schema.about(concat!($($about),+));
                $(
                    let key = $crate::record::key!($field $($as)?);
                    let is_required = stringify!($need) == "required";
                    let default: $Type = $default;
                    let about = concat!($($doc),+);
                    schema.key(key, about, &$notation, (!is_required).then_some(&default));
                    $(
                        schema.key($or_key, about, &$or_notation, Some(&default));
                        schema.exclude(key, $or_key);
                    )*
                )+
                $($( schema.key($file_key, concat!($($file_doc),+), &$file_notation, Some(&())); )+)?
            }
        }
    };
}

/// The key of a field.
macro_rules! key {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident $as:literal) => {
        $as
    };
}

/// Reports a missing key, where the need is `required`.
macro_rules! require {
    (required $entries:ident, $reader:ident, $key:ident, $about:expr) => {
        $entries.require($reader, $key, $about.trim_ascii());
    };
    (optional $($rest:tt)*) => {};
}

pub(crate) use {key, record, require};

#[cfg(test)]
mod tests {
    use super::{Reader, Record};
    use crate::syntax::parse;
    use crate::*;
    use std::fmt::Debug;

    /// A record survives being written and read.
    fn survives<R: Record + PartialEq + Debug>(record: &R) {
        let text = record.write().to_string();
        let mut reader = Reader::new(NoFiles, &Inputs::default());
        let value = parse(&text, &mut reader.diagnostics).expect("JSON");
        let read = R::read(&mut reader, &value);
        assert!(reader.diagnostics.is_empty(), "{:?}\n{text}", reader.diagnostics);
        assert_eq!(read.as_ref(), Some(record), "{text}");
    }

    #[test]
    fn records_survive_their_notation() {
        survives(&Camera::default());
        survives(&Camera::look([1, 2, 3], [0.1, 0.2, 0.3]).fov(33.3));
        survives(&Camera::look([1, 2, 3], [4, 5, 6]).horizontal_fov(60).up([0, 1, 0]));
        survives(&Camera::look([1, 2, 3], [4, 5, 6]).orthographic(2.5));
        survives(&Sun::default());
        survives(&Sun::towards([0.1, 0.2, 0.3]).intensity(0.7).shadow(Shadow::Hardness(16.0)));
        survives(&Sun::default().shadow(Shadow::Clearance { angle: Some(0.5_f64.to_radians()) }));
        survives(&Point::default());
        survives(&Point::at([1, 2, 3]).falloff(Falloff::None).shadow(Shadow::None));
        survives(&Point::at([1, 2, 3]).falloff(Falloff::Polynomial([1.0, 0.1, 0.01])));
        survives(&Spot::default());
        survives(&Spot::at([1, 2, 3], [0, 0, 0]).angle(25).shadow(Shadow::Clearance { angle: None }));
        survives(&Material::default());
        survives(&Material::color("#c8825a").emissive([0.1, 0.2, 3.0]).model(Model::Phong));
        survives(&Material::checker("#fff", "#123", 0.3).exponent(1e9));
        survives(&Ambient::default());
        survives(&Occlusion::default());
        survives(&Occlusion { strength: 0.3, reach: Some(0.1) });
        survives(&Tracer::default().precision(1e-6).max_steps(1));
        survives(&Tracer {
            step: Some(0.125),
            warning: Some([1.0, 0.0, 0.5]),
            ..Tracer::default().method(Method::Fixed)
        });
        survives(&Picture::default().exposure(-1.5).width(65_536));
        survives(&Picture { overbright: Overbright::ScaleDown, ..Picture::default() });
    }

    #[test]
    fn defaults_have_no_faults() {
        let lights = Light::rig().iter().map(|light| light.faults().len()).sum::<usize>();
        let others = [
            Camera::default().faults(),
            Sun::default().faults(),
            Point::default().faults(),
            Spot::default().faults(),
            Material::default().faults(),
            Ambient::default().faults(),
            Occlusion::default().faults(),
            Tracer::default().faults(),
            Picture::default().faults(),
            Scene::default().faults(),
        ];
        assert_eq!(lights + others.iter().map(Vec::len).sum::<usize>(), 0);
    }
}
