//! One of several names.

use super::Notation;
use crate::reader::{Reader, span};
use crate::schema::Definitions;
use crate::suggest::{closest, listed, quote};
use crate::syntax::Written;
use serde_json::{Value as Json, json};

/// A type whose values have names. See [`choice!`].
pub(crate) trait Choice: Copy + PartialEq + 'static {
    /// The values with their names and what they mean.
    const ALL: &'static [(Self, &'static str, &'static str)];
}

/// The notation of a [`Choice`]: the name as a text.
#[derive(Debug)]
pub(crate) struct ChoiceNotation;

impl<C: Choice + Sync> Notation<C> for ChoiceNotation {
    fn read(&self, reader: &mut Reader, value: &Written<'_>) -> Option<C> {
        let Written::StringLit(name) = value else {
            let hint = format!("it is one of {}", listed(C::ALL.iter().map(|entry| entry.1)));
            reader.mistyped(value, "a text", Some(hint));
            return None;
        };
        let index = index_of(reader, value, &name.value, C::ALL.iter().map(|entry| entry.1))?;
        Some(C::ALL[index].0)
    }

    fn write(&self, value: &C) -> Option<Json> {
        C::ALL.iter().find(|entry| entry.0 == *value).map(|entry| json!(entry.1))
    }

    fn schema(&self, _definitions: &mut Definitions) -> Json {
        let values: Vec<Json> =
            C::ALL.iter().map(|(_, name, about)| json!({ "const": name, "description": about })).collect();
        json!({ "oneOf": values })
    }
}

/// The place of `name` among `names`, or `None` after reporting that it is not there.
pub(crate) fn index_of<'n>(
    reader: &mut Reader,
    value: &Written<'_>,
    name: &str,
    names: impl Iterator<Item = &'n str> + Clone,
) -> Option<usize> {
    let index = names.clone().position(|known| known == name);
    if index.is_none() {
        let message = format!("{} can't be {}", reader.label(), quote(name));
        let hint = match closest(name, names.clone()) {
            Some(guess) => format!("did you mean `{guess}`?"),
            None => format!("it is one of {}", listed(names)),
        };
        reader.error(span(value), message, Some(hint));
    }
    index
}

/// Declares an enumeration whose values have names in files.
macro_rules! choice {
    (
        $(#[doc = $about:literal])+
        pub enum $Choice:ident {
            $( $(#[doc = $doc:literal])+ $Value:ident = $name:literal, )+
        }
        default $Default:ident
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $Choice {
            $( $(#[doc = $doc])+ $Value, )+
        }

        impl $Choice {
            /// Its name in files.
            pub fn name(self) -> &'static str {
                match self {
                    $( Self::$Value => $name, )+
                }
            }

            /// The value of a name.
            pub fn from_name(name: &str) -> Option<Self> {
                <Self as $crate::notation::Choice>::ALL.iter().find(|entry| entry.1 == name).map(|entry| entry.0)
            }
        }

        impl Default for $Choice {
            fn default() -> Self {
                Self::$Default
            }
        }

        impl $crate::notation::Choice for $Choice {
            const ALL: &'static [(Self, &'static str, &'static str)] =
                &[$( (Self::$Value, $name, concat!($($doc),+).trim_ascii()) ),+];
        }
    };
}

pub(crate) use choice;
