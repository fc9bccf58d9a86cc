//! Running other programs, and the chores that are no more than that.

use std::path::{Path, PathBuf};
use std::process::Command;

/// What went wrong, as a sentence.
pub(crate) type Result<T = ()> = std::result::Result<T, String>;

/// The folder of the workspace.
pub(crate) fn root() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().expect("xtask lies in the workspace").to_owned()
}

/// Runs a program in `folder`, showing the command and its output.
pub(crate) fn run(folder: &Path, program: &str, args: &[&str]) -> Result {
    run_with(folder, program, args, &[])
}

/// Runs a program with additional environment variables.
pub(crate) fn run_with(folder: &Path, program: &str, args: &[&str], variables: &[(&str, &str)]) -> Result {
    eprintln!("+ {program} {}", args.join(" "));
    let status = Command::new(program)
        .args(args)
        .envs(variables.iter().copied())
        .current_dir(folder)
        .status()
        .map_err(|e| format!("can't run {program}: {e}"))?;
    if status.success() { Ok(()) } else { Err(format!("{program} {} failed ({status})", args.join(" "))) }
}

/// What a program prints.
pub(crate) fn output(folder: &Path, program: &str, args: &[&str]) -> Result<String> {
    eprintln!("+ {program} {}", args.join(" "));
    let output = Command::new(program)
        .args(args)
        .current_dir(folder)
        .output()
        .map_err(|e| format!("can't run {program}: {e}"))?;
    if !output.status.success() {
        let errors = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{program} {} failed ({})\n{errors}", args.join(" "), output.status));
    }
    String::from_utf8(output.stdout).map_err(|e| format!("{program} printed no text: {e}"))
}

/// What the command of the workspace in `root` prints. It is built as small as it gets, since it is asked for texts alone.
pub(crate) fn freikugel(root: &Path, args: &[&str]) -> Result<String> {
    let command = ["run", "--quiet", "-p", "freikugel", "--no-default-features", "--"];
    output(root, "cargo", &[&command[..], args].concat())
}

/// What the command prints that the tests were just run for, and which lies beside this program.
pub(crate) fn tested_freikugel(args: &[&str]) -> Result<String> {
    let own = std::env::current_exe().map_err(|e| e.to_string())?;
    let name = format!("freikugel{}", std::env::consts::EXE_SUFFIX);
    output(&root(), &own.with_file_name(name).display().to_string(), args)
}

/// Where the schema of scene files is kept.
pub(crate) const SCHEMA: &str = "schema/scene.schema.json";

/// Writes the schema of scene files.
pub(crate) fn schema(root: &Path) -> Result {
    let text = freikugel(root, &["schema"])?;
    let path = root.join(SCHEMA);
    std::fs::create_dir_all(path.parent().expect("a file in a folder")).map_err(|e| e.to_string())?;
    std::fs::write(&path, text).map_err(|e| format!("can't write {}: {e}", path.display()))
}
