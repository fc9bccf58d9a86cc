//! What reading a document carries along: the diagnostics so far, the names to resolve, the places of nodes.
//!
//! Every value is read to the end whatever is wrong around it, and each mistake is reported once, where it is.

use crate::diagnostic::{Diagnostic, Severity};
use crate::files::Files;
use crate::names::{Inputs, Names};
use crate::notation::{Notation, are_keyframes, computed, keyed};
use crate::suggest::{closest, listed, quote};
use crate::syntax::Written;
use freikugel_field::{Field, Origin};
use jsonc_parser::ast::ObjectProp;
use jsonc_parser::common::Ranged;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::sync::Arc;

/// The state of reading one document.
#[derive(Debug)]
pub(crate) struct Reader {
    /// Where files come from that the document names.
    files: Box<dyn Files>,
    /// The contents of those that were read, by their names.
    files_read: BTreeMap<String, Arc<[u8]>>,
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// The names that formulas may use.
    pub(crate) names: Names,
    /// The materials by name; `None` if nothing sound is known about them.
    pub(crate) materials: Option<HashMap<String, u32>>,
    /// The shapes by name; `None` for those that have a fault.
    pub(crate) shapes: BTreeMap<String, Option<Field>>,
    /// The nodes of all fields, in the order of their [`freikugel_field::Origin::Document`] numbers.
    pub(crate) nodes: Vec<NodePlace>,
    /// The fields to analyse: of each object, or the sound parts of one that has faults.
    pub(crate) roots: Vec<Field>,
    /// The shapes with names, to analyse each by itself.
    pub(crate) named: Vec<Field>,
    /// What the value now read is called, as it stands in a sentence.
    label: String,
    errors: usize,
}

/// Where a node was written.
#[derive(Debug)]
pub(crate) struct NodePlace {
    /// Its name.
    pub(crate) name: Range<usize>,
    /// Its parameters, as far as they were written.
    pub(crate) params: Vec<Option<Range<usize>>>,
}

impl Reader {
    /// For a document with these files, and without materials, until some are read.
    pub(crate) fn new(files: impl Files + 'static, inputs: &Inputs) -> Self {
        Self {
            names: Names::new(inputs),
            files: Box::new(files),
            files_read: BTreeMap::new(),
            diagnostics: Vec::new(),
            materials: Some(HashMap::new()),
            shapes: BTreeMap::new(),
            nodes: Vec::new(),
            roots: Vec::new(),
            named: Vec::new(),
            label: String::new(),
            errors: 0,
        }
    }

    /// The contents of a file, which is read once however often it is named.
    ///
    /// # Errors
    /// Why there are none.
    pub(crate) fn contents(&mut self, name: &str) -> Result<Arc<[u8]>, String> {
        if let Some(known) = self.files_read.get(name) {
            return Ok(Arc::clone(known));
        }
        let contents: Arc<[u8]> = self.files.contents(name)?.into();
        self.files_read.insert(name.to_owned(), Arc::clone(&contents));
        Ok(contents)
    }

    /// The names of the files that were read.
    pub(crate) fn into_files(self) -> Vec<String> {
        self.files_read.into_keys().collect()
    }

    /// Where the name of a node was written.
    pub(crate) fn place(&self, origin: Origin) -> Option<Range<usize>> {
        let Origin::Document(index) = origin else {
            return None;
        };
        Some(self.nodes.get(index as usize)?.name.clone())
    }

    pub(crate) fn report(
        &mut self,
        severity: Severity,
        span: Range<usize>,
        message: impl Into<String>,
        hint: Option<String>,
    ) {
        self.errors += usize::from(severity == Severity::Error);
        self.diagnostics.push(Diagnostic { severity, message: message.into(), hint, span });
    }

    pub(crate) fn error(&mut self, span: Range<usize>, message: impl Into<String>, hint: Option<String>) {
        self.report(Severity::Error, span, message, hint);
    }

    /// How many errors there are so far.
    pub(crate) fn errors(&self) -> usize {
        self.errors
    }

    /// Reads with messages calling the value `label`.
    pub(crate) fn labelled<T>(&mut self, label: String, read: impl FnOnce(&mut Self) -> T) -> T {
        let outer = std::mem::replace(&mut self.label, label);
        let result = read(self);
        self.label = outer;
        result
    }

    /// What the value now read is called, as it stands in a sentence.
    pub(crate) fn label(&self) -> &str {
        &self.label
    }

    /// Reports a value of another type than `wanted`, which is a noun with its article.
    pub(crate) fn mistyped(&mut self, value: &Written<'_>, wanted: &str, hint: Option<String>) {
        let found = match value {
            Written::StringLit(_) => "a text",
            Written::NumberLit(_) => "a number",
            Written::BooleanLit(literal) if literal.value => "`true`",
            Written::BooleanLit(_) => "`false`",
            Written::Object(_) => "an object",
            Written::Array(_) => "a list",
            Written::NullKeyword(_) => "`null`",
        };
        let message = format!("{} must be {wanted}, not {found}", self.label());
        self.error(span(value), message, hint);
    }

    /// Reports what `fault` says of a value, if anything, and hands the value on otherwise.
    pub(crate) fn sound<T>(&mut self, value: &Written<'_>, result: T, fault: Option<String>) -> Option<T> {
        let Some(fault) = fault else {
            return Some(result);
        };
        let message = format!("{} {fault}", self.label());
        self.error(span(value), message, None);
        None
    }

    /// A finite number, or a formula or keyframes for one.
    pub(crate) fn number(&mut self, value: &Written<'_>) -> Option<f64> {
        if are_keyframes(value) {
            return keyed(self, value, None)?.first().copied();
        }
        self.plain_number(value)
    }

    /// A finite number, or a formula for one.
    pub(crate) fn plain_number(&mut self, value: &Written<'_>) -> Option<f64> {
        let literal = match value {
            Written::NumberLit(literal) => literal,
            Written::StringLit(_) => return computed(self, value),
            _ => {
                self.mistyped(value, "a number", None);
                return None;
            }
        };
        // Where the parser lets other numbers than JSON's pass, it has reported them.
        let number: f64 = literal.value.parse().ok().filter(|_| !literal.value.contains(['N', 'I']))?;
        if number.is_infinite() {
            let message = format!("{} is too large: {}", self.label(), quote(literal.value));
            self.error(span(value), message, Some(format!("numbers go up to {:e}", f64::MAX)));
            return None;
        }
        Some(number)
    }

    /// Exactly `N` finite numbers, or keyframes for them.
    pub(crate) fn numbers<const N: usize>(
        &mut self,
        value: &Written<'_>,
        names: [&'static str; N],
    ) -> Option<[f64; N]> {
        let numbers = if are_keyframes(value) { keyed(self, value, Some(&names)) } else { self.list(value, &names) };
        numbers?.try_into().ok()
    }

    /// As many finite numbers as there are names for.
    pub(crate) fn list(&mut self, value: &Written<'_>, names: &[&'static str]) -> Option<Vec<f64>> {
        let wanted = || format!("a list of {} numbers, [{}]", names.len(), names.join(", "));
        let Written::Array(array) = value else {
            self.mistyped(value, &wanted(), None);
            return None;
        };
        if array.elements.len() != names.len() {
            let message = format!("{} must be {}, but has {}", self.label(), wanted(), array.elements.len());
            self.error(span(value), message, None);
            return None;
        }
        // All of them are looked at.
        let numbers: Vec<Option<f64>> = names
            .iter()
            .zip(&array.elements)
            .map(|(name, element)| {
                let label = format!("{name} of {}", self.label);
                self.labelled(label, |reader| reader.number(element))
            })
            .collect();
        numbers.into_iter().collect()
    }

    /// The entries of an object by the places of their keys in `keys`; unknown and repeated ones are reported.
    pub(crate) fn entries<'v>(&mut self, value: &'v Written<'v>, keys: &'v [&'static str]) -> Option<Entries<'v>> {
        let Written::Object(object) = value else {
            self.mistyped(value, "an object", Some(format!("its keys: {}", listed(keys.iter().copied()))));
            return None;
        };
        let what = self.label.clone();
        let mut entries =
            Entries { what, keys, values: vec![None; keys.len()], guesses: Vec::new(), span: span(value) };
        for prop in &object.properties {
            let key = prop.name.as_str();
            if let Some(index) = keys.iter().position(|&known| known == key) {
                match entries.values[index] {
                    None => entries.values[index] = Some(&prop.value),
                    Some(_) => self.duplicate(prop),
                }
                continue;
            }
            let hint = match closest(key, keys.iter().copied()) {
                Some(guess) => {
                    entries.guesses.push(guess);
                    format!("did you mean `{guess}`?")
                }
                None => format!("its keys: {}", listed(keys.iter().copied())),
            };
            self.error(name_span(prop), format!("{} has no key {}", entries.what, quote(key)), Some(hint));
        }
        Some(entries)
    }

    /// Reports a key that was there before.
    pub(crate) fn duplicate(&mut self, prop: &ObjectProp<'_>) {
        let message = format!("{} is given twice", quote(prop.name.as_str()));
        self.error(name_span(prop), message, Some("keep one of the two".into()));
    }

    /// The one entry of an object that says by its key which of several things it is: the place of the key in `names`,
    /// and the value. `what` is a noun with its article.
    pub(crate) fn variant<'v>(
        &mut self,
        value: &'v Written<'v>,
        what: &str,
        names: &[&'static str],
    ) -> Option<(usize, &'v Written<'v>)> {
        let Written::Object(object) = value else {
            self.mistyped(value, "an object", Some(format!("{what} is one of {}", listed(names.iter().copied()))));
            return None;
        };
        let mut found = None;
        let mut is_sound = true;
        for prop in &object.properties {
            let key = prop.name.as_str();
            match names.iter().position(|&known| known == key) {
                Some(_) if found.is_some() => {
                    let message = format!("{what} has one key, but here is another");
                    self.error(name_span(prop), message, None);
                    is_sound = false;
                }
                Some(index) => found = Some((index, &prop.value)),
                None => {
                    let message = format!("{what} can't be {}", quote(key));
                    let hint = match closest(key, names.iter().copied()) {
                        Some(guess) => format!("did you mean `{guess}`?"),
                        None => format!("it is one of {}", listed(names.iter().copied())),
                    };
                    self.error(name_span(prop), message, Some(hint));
                    is_sound = false;
                }
            }
        }
        if object.properties.is_empty() {
            let hint = format!("it is one of {}", listed(names.iter().copied()));
            self.error(span(value), format!("{what} is missing here"), Some(hint));
        }
        found.filter(|_| is_sound)
    }
}

/// The entries of an object with known keys.
#[derive(Debug)]
pub(crate) struct Entries<'v> {
    what: String,
    keys: &'v [&'static str],
    values: Vec<Option<&'v Written<'v>>>,
    /// The keys that misspelt ones were taken for: they are not missing, too.
    guesses: Vec<&'static str>,
    span: Range<usize>,
}

impl<'v> Entries<'v> {
    /// The whole object.
    pub(crate) fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// The value of a key, if it was written.
    pub(crate) fn get(&self, key: &str) -> Option<&'v Written<'v>> {
        self.keys.iter().position(|&known| known == key).and_then(|index| self.values[index])
    }

    /// The value of a key; if it was not written, that is reported.
    pub(crate) fn require(&self, reader: &mut Reader, key: &'static str, about: &str) -> Option<&'v Written<'v>> {
        let value = self.get(key);
        if value.is_none() && !self.guesses.contains(&key) {
            reader.error(self.span(), format!("{} needs `{key}`", self.what), Some(format!("`{key}`: {about}")));
        }
        value
    }

    /// Reports that two keys were written that say the same thing in two ways.
    pub(crate) fn exclude(&self, reader: &mut Reader, one: &str, other: &str) {
        if let (Some(_), Some(value)) = (self.get(one), self.get(other)) {
            let message = format!("{} can't have both `{one}` and `{other}`", self.what);
            reader.error(span(value), message, Some("keep one of the two".into()));
        }
    }

    /// What a key says in a notation, or `None` if it was not written or is faulty.
    pub(crate) fn read<T>(&self, reader: &mut Reader, key: &'static str, notation: &dyn Notation<T>) -> Option<T> {
        let value = self.get(key)?;
        reader.labelled(quote(key), |reader| notation.read(reader, value))
    }
}

/// The place of a value.
pub(crate) fn span(value: &Written<'_>) -> Range<usize> {
    value.start()..value.end()
}

/// The place of an entry's key.
pub(crate) fn name_span(prop: &ObjectProp<'_>) -> Range<usize> {
    prop.name.start()..prop.name.end()
}
