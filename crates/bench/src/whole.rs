//! Whole processes: the command on a scene, and POV-Ray on the same one.

use crate::measure::{Clock, Contender, Row, Unit};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The size that the scenes are rendered in.
const SIZE: [&str; 2] = ["640", "360"];

/// The folder of the scenes: those for Freikugel in it, those for POV-Ray in `pov` below.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/bench")
}

/// The scenes, with the file for POV-Ray if there is one: `s1-csg.json` and `pov/s1_csg.pov`.
fn scenes() -> Vec<(PathBuf, Option<PathBuf>)> {
    let files = |folder: PathBuf, suffix: &str| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut files: Vec<PathBuf> = entries
            .map(|entry| entry.path())
            .filter(|path| path.extension().is_some_and(|own| own == suffix))
            .collect();
        files.sort();
        files
    };
    let number = |path: &Path| {
        let stem = path.file_stem()?.to_str()?.to_owned();
        stem.split(['-', '_']).next().map(ToOwned::to_owned)
    };
    let peers = files(folder().join("pov"), "pov");
    files(folder(), "json")
        .into_iter()
        .map(|scene| {
            let peer = peers.iter().find(|peer| number(peer) == number(&scene)).cloned();
            (scene, peer)
        })
        .collect()
}

/// All rows whose names `is_wanted`; with `others`, numbers of threads besides 1.
pub fn rows(is_wanted: &dyn Fn(&str) -> bool, others: &[usize]) -> Vec<Row<'static>> {
    let mut rows = Vec::new();
    let mut command: Option<Result<PathBuf, String>> = None;
    for (scene, peer) in scenes() {
        let file = scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let cpu = format!("{file}, whole process, {} x {}, user CPU time", SIZE[0], SIZE[1]);
        let wall = format!("{file}, whole process, {} x {}, from start to end", SIZE[0], SIZE[1]);
        for (name, clock) in [(cpu, Clock::Children), (wall, Clock::Wall)] {
            if !is_wanted(&name) {
                continue;
            }
            let command = command.get_or_insert_with(build);
            let ours = |threads: usize| ours(command, &scene, threads, clock);
            let mut contenders = match clock {
                Clock::Children => vec![ours(1)],
                _ => others.iter().map(|&threads| ours(threads)).chain([ours(1)]).collect(),
            };
            if clock == Clock::Children {
                contenders.extend(others.iter().map(|&threads| ours(threads)));
            }
            contenders.push(match &peer {
                Some(peer) => theirs(peer, clock),
                None => Contender::missing("POV-Ray", "there is no scene for it"),
            });
            rows.push(Row { name, unit: Unit::Seconds, contenders });
        }
    }
    rows
}

/// The `freikugel` command beside this one, built if cargo is at hand.
fn build() -> Result<PathBuf, String> {
    if let Some(cargo) = std::env::var_os("CARGO") {
        let status = Command::new(cargo).args(["build", "--release", "--quiet", "-p", "freikugel"]).status();
        if !status.is_ok_and(|status| status.success()) {
            return Err("cargo can't build the command".into());
        }
    }
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let command = own.with_file_name(format!("freikugel{}", std::env::consts::EXE_SUFFIX));
    if command.is_file() { Ok(command) } else { Err("the command is not built: cargo build --release".into()) }
}

fn ours(command: &Result<PathBuf, String>, scene: &Path, threads: usize, clock: Clock) -> Contender<'static> {
    let name = format!("Freikugel, {threads} thread{}", if threads == 1 { "" } else { "s" });
    let command = match command {
        Ok(command) => command.clone(),
        Err(reason) => return Contender::missing(name, reason.clone()),
    };
    let scene = scene.to_owned();
    let work = move |picture: &Path| {
        let mut command = Command::new(&command);
        command.arg("render").arg(&scene).arg("-o").arg(picture).args(["--quiet", "--samples", "1", "--threads"]);
        command.arg(threads.to_string()).args(["--width", SIZE[0], "--height", SIZE[1]]);
        command
    };
    Contender { name, work: process(work), clock }
}

fn theirs(scene: &Path, clock: Clock) -> Contender<'static> {
    let scene = scene.to_owned();
    let work = move |picture: &Path| {
        let mut command = Command::new("povray");
        // No display, no antialiasing, nothing on the console.
        command.args(["-D", "-A", "-GA", "+FN"]);
        command.arg(format!("+W{}", SIZE[0])).arg(format!("+H{}", SIZE[1]));
        command.arg(format!("+I{}", scene.display())).arg(format!("+O{}", picture.display()));
        command.arg(format!("+L{}", scene.parent().unwrap_or(Path::new(".")).display()));
        command
    };
    Contender { name: "POV-Ray".into(), work: process(work), clock }
}

/// Runs a process that writes a picture somewhere, and says what went wrong.
fn process(command: impl Fn(&Path) -> Command + 'static) -> Box<dyn FnMut() -> Result<(), String>> {
    Box::new(move || {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let mut command = command(&folder.path().join("picture.png"));
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        match command.status() {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(format!("failed with {status}")),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err("not installed".into()),
            Err(error) => Err(error.to_string()),
        }
    })
}
