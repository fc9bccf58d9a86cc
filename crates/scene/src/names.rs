//! The names that formulas in a scene may use besides those of their language: parameters, and the time.

use std::collections::{BTreeMap, BTreeSet};

/// The name of the time, in seconds.
pub(crate) const TIME: &str = "t";

/// What a scene file is read with besides its text: numbers that stand for those in it, and the time.
///
/// ```
/// use freikugel_scene::{Inputs, NoFiles, read_at};
///
/// let text = r#"{ "parameters": { "size": 1 }, "objects": [ { "shape": { "sphere": { "radius": "size * (1 + t)" } } } ] }"#;
/// let inputs = Inputs { set: vec![("size".into(), 2.0)], time: 0.5 };
/// let scene = read_at(text, NoFiles, &inputs).into_result().expect("the scene is sound");
/// assert_eq!(scene.objects[0].shape.node().args[0].number(), 3.0);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    /// Values of parameters by their names, instead of those in the file.
    pub set: Vec<(String, f64)>,
    /// The time that formulas call `t`, in seconds.
    pub time: f64,
}

/// The names with their values, as far as they are known while a scene is read.
#[derive(Debug)]
pub(crate) struct Names {
    known: BTreeMap<String, f64>,
    used: BTreeSet<String>,
    inputs: Inputs,
}

impl Names {
    pub(crate) fn new(inputs: &Inputs) -> Self {
        let known = BTreeMap::from([(TIME.to_owned(), inputs.time)]);
        Self { known, used: BTreeSet::new(), inputs: inputs.clone() }
    }

    /// All values by name.
    pub(crate) fn known(&self) -> &BTreeMap<String, f64> {
        &self.known
    }

    /// The time, in seconds.
    pub(crate) fn time(&self) -> f64 {
        self.inputs.time
    }

    /// Gives a name its value.
    pub(crate) fn define(&mut self, name: &str, value: f64) {
        self.known.insert(name.to_owned(), value);
    }

    /// The value that a parameter is set to from outside.
    pub(crate) fn set(&self, name: &str) -> Option<f64> {
        self.inputs.set.iter().rfind(|(set, _)| set == name).map(|&(_, value)| value)
    }

    /// The names that are set from outside.
    pub(crate) fn all_set(&self) -> impl Iterator<Item = &str> {
        self.inputs.set.iter().map(|(name, _)| name.as_str())
    }

    /// Notes that formulas use these names.
    pub(crate) fn note(&mut self, names: &[String]) {
        self.used.extend(names.iter().cloned());
    }

    /// Whether a formula that was read uses a name.
    pub(crate) fn is_used(&self, name: &str) -> bool {
        self.used.contains(name)
    }
}
