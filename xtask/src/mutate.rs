//! Mutations: single operators of formulas are changed, one at a time, to see whether a test fails.
//!
//! The changes are made in a copy of the workspace. What no test notices is listed, with its place: either a test is missing, or
//! the change makes no difference. `docs/mutations.md` explains what is known to survive.

use crate::probe::copy_tracked;
use crate::run::{Result, root};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Where formulas are.
const FOLDER: &str = "crates/field/src/shapes";

/// Functions that hold formulas, or their constants.
const FUNCTIONS: [&str; 12] = [
    "distance",
    "map",
    "combine",
    "modify",
    "share",
    "depth",
    "farther",
    "value",
    "prepare",
    "constants",
    "general",
    "places",
];

/// What is changed into what.
const CHANGES: [(&str, &str); 13] = [
    (" + ", " - "),
    (" - ", " + "),
    (" * ", " / "),
    (" / ", " * "),
    (".min(", ".max("),
    (".max(", ".min("),
    (" & ", " | "),
    (" | ", " & "),
    (".abs()", ""),
    ("sin * ", "cos * "),
    ("cos * ", "sin * "),
    (" += ", " -= "),
    (" -= ", " += "),
];

/// Tests that know nothing of single shapes, or measure time.
const LEFT_OUT: [&str; 6] = ["elementary", "formula_nodes", "formulas", "inlining", "numbers", "slopes"];

/// Tests that take half a minute, so that they run if no other has noticed anything.
const SLOW: [&str; 2] = ["cells", "contracts"];

/// What takes longer goes round in circles.
const LONGEST: Duration = Duration::from_secs(900);

/// This share of the changes at least must be noticed.
const LEAST_SHARE: f64 = 0.96;

/// A place where an operator stands.
#[derive(Clone, Debug)]
struct Site {
    file: PathBuf,
    /// Counted from 1.
    line: usize,
    column: usize,
    change: (&'static str, &'static str),
}

/// Makes `count` changes, chosen by `seed`.
pub(crate) fn mutate(count: usize, seed: u64) -> Result {
    let (from, scratch) = (root(), root().join("target/mutate/workspace"));
    if scratch.exists() {
        std::fs::remove_dir_all(&scratch).map_err(|e| e.to_string())?;
    }
    copy_tracked(&from, &scratch)?;
    let mut sites = sites(&scratch.join(FOLDER))?;
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    if test(&scratch)? != Verdict::Unnoticed {
        return Err("the tests fail without any change".into());
    }
    let (mut noticed, mut survivors) = (0, Vec::new());
    while noticed + survivors.len() < count && !sites.is_empty() {
        let site = sites.swap_remove(random.below(sites.len()));
        let before = std::fs::read_to_string(&site.file).map_err(|e| e.to_string())?;
        std::fs::write(&site.file, changed(&before, &site)).map_err(|e| e.to_string())?;
        let verdict = test(&scratch)?;
        std::fs::write(&site.file, &before).map_err(|e| e.to_string())?;
        let shown = describe(&site, &before, &scratch);
        eprintln!("{verdict:?}: {shown}");
        match verdict {
            Verdict::NoProgram => {}
            Verdict::Noticed => noticed += 1,
            Verdict::Unnoticed => survivors.push(shown),
        }
    }
    let all = noticed + survivors.len();
    println!("{noticed} of {all} changes were noticed");
    survivors.iter().for_each(|survivor| println!("survived: {survivor}"));
    if noticed as f64 >= LEAST_SHARE * all as f64 { Ok(()) } else { Err("too few changes were noticed".into()) }
}

/// All operators in formulas of a folder.
fn sites(folder: &Path) -> Result<Vec<Site>> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .map_err(|e| e.to_string())?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<std::result::Result<_, _>>()
        .map_err(|e| e.to_string())?;
    files.sort();
    let mut sites = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file).map_err(|e| format!("can't read {}: {e}", file.display()))?;
        for (line, content) in formulas(&text) {
            let code = content.split("//").next().unwrap_or_default();
            let found = CHANGES
                .iter()
                .flat_map(|&change| code.match_indices(change.0).map(move |(column, _)| (column, change)));
            // Texts and types are no formulas.
            let is_formula = !code.contains('"') && !code.contains("where ") && !code.contains("impl ");
            sites.extend(found.filter(|_| is_formula).map(|(column, change)| Site {
                file: file.clone(),
                line,
                column,
                change,
            }));
        }
    }
    Ok(sites)
}

/// The lines of the functions that hold formulas, with their numbers.
fn formulas(text: &str) -> impl Iterator<Item = (usize, &str)> {
    // The indentation of the function that a line is in, if it holds formulas.
    let mut within: Option<usize> = None;
    (1..).zip(text.lines()).filter(move |(_, line)| {
        let indent = line.len() - line.trim_start().len();
        if let Some(name) = line.trim_start().trim_start_matches("pub(crate) ").strip_prefix("fn ") {
            let name = name.split(['(', '<']).next().unwrap_or_default();
            within = FUNCTIONS.contains(&name).then_some(indent);
            return false;
        }
        if within == Some(indent) && line.trim() == "}" {
            within = None;
        }
        within.is_some()
    })
}

/// A text with one operator changed.
fn changed(text: &str, site: &Site) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let (old, new) = site.change;
    lines[site.line - 1].replace_range(site.column..site.column + old.len(), new);
    lines.join("\n") + "\n"
}

fn describe(site: &Site, text: &str, folder: &Path) -> String {
    let line = text.lines().nth(site.line - 1).unwrap_or_default().trim();
    let file = site.file.strip_prefix(folder).unwrap_or(&site.file).display();
    let (old, new) = site.change;
    format!("{file}:{}: `{}` to `{}` in `{line}`", site.line, old.trim(), new.trim())
}

/// What tests say of a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    /// It is no program any more.
    NoProgram,
    /// A test fails.
    Noticed,
    /// All tests pass.
    Unnoticed,
}

/// Runs the tests of fields.
fn test(workspace: &Path) -> Result<Verdict> {
    let mut names: Vec<String> = std::fs::read_dir(workspace.join("crates/field/tests"))
        .map_err(|e| e.to_string())?
        .filter_map(|entry| Some(entry.ok()?.path().file_name()?.to_str()?.strip_suffix(".rs")?.to_owned()))
        .filter(|name| !LEFT_OUT.contains(&name.as_str()))
        .collect();
    let succeeds = |tests: &[String], is_build| -> Result<bool> {
        Ok(cargo(workspace, tests, is_build)?.is_some_and(|status| status.success()))
    };
    if !succeeds(&names, true)? {
        return Ok(Verdict::NoProgram);
    }
    let slow: Vec<String> = names.extract_if(.., |name| SLOW.contains(&name.as_str())).collect();
    Ok(if succeeds(&names, false)? && succeeds(&slow, false)? { Verdict::Unnoticed } else { Verdict::Noticed })
}

/// Builds the named tests of fields, or runs them as well; `None` if that takes too long.
fn cargo(workspace: &Path, tests: &[String], is_build: bool) -> Result<Option<ExitStatus>> {
    let mut command = Command::new("cargo");
    // With kernels for one instruction set, which are built several times as fast.
    command.args(["test", "--quiet", "--package", "freikugel-field", "--no-default-features"]);
    tests.iter().for_each(|test| {
        command.args(["--test", test]);
    });
    if is_build {
        command.arg("--no-run");
    }
    let target = workspace.with_file_name("target");
    // One file at a time changes, so that most of what was built before can be kept.
    command.current_dir(workspace).env("CARGO_TARGET_DIR", target).env("CARGO_INCREMENTAL", "1");
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.process_group(0);
    let mut child = command.spawn().map_err(|e| format!("can't run cargo: {e}"))?;
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().map_err(|e| e.to_string())? {
            return Ok(Some(status));
        }
        if start.elapsed() > LONGEST {
            // With the tests that it runs.
            let group = format!("-{}", child.id());
            Command::new("kill").args(["-KILL", "--", &group]).status().map_err(|e| e.to_string())?;
            child.wait().map_err(|e| e.to_string())?;
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// A small seeded generator (xorshift64*).
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) % count as u64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operators_are_found_in_formulas_alone_and_changed_one_at_a_time() {
        let text = "fn check(a: f64) {\n    a + 1\n}\nfn distance(a: f64) -> f64 {\n    // a - b\n    a - a * 2.0\n}\nfn other() {\n}\n";
        let lines: Vec<usize> = formulas(text).map(|(line, _)| line).collect();
        assert_eq!(lines, [5, 6]);
        let site = Site { file: "x.rs".into(), line: 6, column: 5, change: (" - ", " + ") };
        assert_eq!(changed(text, &site), text.replace("a - a", "a + a"));
    }
}
