//! The project's own chores: `cargo xtask help` lists them.

mod browser;
mod compilers;
mod gallery;
mod install;
mod mutate;
mod probe;
mod reference;
mod run;
mod shapes;
mod test;

use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask COMMAND

  test            everything a change must pass; installs what it needs and says so
  test-gpu        the part of it that needs a graphics processor, or software that stands in for one
  test-browser    the part of it that needs a browser
  test-compilers  the part of it that needs compilers of shaders
  shapes          writes the list of shapes from the files under crates/field/src/shapes
  schema          writes schema/scene.schema.json
  reference       writes docs/reference/shapes.md, and gallery/README.md
  gallery         renders all scenes and contact sheets into gallery/
  mutate          changes 50 operators in formulas, one at a time, and counts the changes that tests notice; or
                  mutate COUNT SEED
  probe-shape     proves that a new shape needs one file and nothing else
";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let result = match args.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["test"] => test::all(),
        ["test-gpu"] => test::on_graphics_processor(),
        ["test-browser"] => browser::test(),
        ["test-compilers"] => compilers::test(),
        ["shapes"] => shapes::write(&run::root()),
        ["schema"] => run::schema(&run::root()),
        ["reference"] => reference::write(&run::root()),
        ["gallery"] => gallery::gallery(),
        ["mutate"] => mutate::mutate(50, 1),
        ["mutate", count, seed] => match (count.parse(), seed.parse()) {
            (Ok(count), Ok(seed)) => mutate::mutate(count, seed),
            _ => Err("mutate takes two whole numbers: how many changes, and a seed".into()),
        },
        ["probe-shape"] => probe::shape(),
        ["help" | "--help" | "-h"] => {
            print!("{USAGE}");
            Ok(())
        }
        _ => {
            eprint!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}
