//! What scenes are read with besides their files: values of parameters, and the time.

use freikugel::field::Formula;
use freikugel::field::formula::name_fault;
use freikugel::scene::Inputs;
use std::collections::BTreeMap;

/// Values that a scene is read with.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct Given {
    /// Set a parameter of the scene: to a number, or a formula for one, such as 2*pi.
    #[arg(long, value_name = "NAME=NUMBER", value_parser = parse_setting)]
    set: Vec<(String, f64)>,
    /// The time that formulas in the scene call `t`, in seconds; 0 if not given.
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = parse_number)]
    time: Option<f64>,
}

impl Given {
    /// All of them by name, for a formula that is in no scene.
    pub(super) fn names(&self) -> BTreeMap<String, f64> {
        let time = self.time.map(|time| ("t".to_owned(), time));
        self.set.iter().cloned().chain(time).collect()
    }

    pub(super) fn inputs(&self) -> Inputs {
        Inputs { set: self.set.clone(), time: self.time.unwrap_or(0.0) }
    }
}

/// A name and its number.
pub(super) fn parse_setting(text: &str) -> Result<(String, f64), String> {
    let (name, number) = text.split_once('=').ok_or("write NAME=NUMBER, such as radius=2")?;
    let name = name.trim();
    match name_fault(name) {
        Some(fault) => Err(format!("{name:?} {fault}")),
        None => Ok((name.to_owned(), parse_number(number)?)),
    }
}

/// A number, also as a formula.
pub(super) fn parse_number(text: &str) -> Result<f64, String> {
    let formula = Formula::parse(text).map_err(|error| error.to_string())?;
    formula.constant().ok_or_else(|| format!("{:?} is no number, since it depends on a coordinate", text.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_names_with_numbers() {
        assert_eq!(parse_setting("radius=2"), Ok(("radius".into(), 2.0)));
        assert_eq!(parse_setting(" a = -1/4 "), Ok(("a".into(), -0.25)));
        for (text, says) in [
            ("radius", "write NAME=NUMBER"),
            ("a=", "empty"),
            ("a=x", "depends"),
            ("a=two", "two"),
            ("x=1", "already"),
            ("2a=1", "no name"),
        ] {
            let fault = parse_setting(text).expect_err(text);
            assert!(fault.contains(says), "{text}: {fault}");
        }
    }
}
