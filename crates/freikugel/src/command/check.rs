//! `freikugel check`: diagnostics only.

use super::{Failure, input};
use freikugel::scene::Inputs;
use std::path::PathBuf;

/// Checks all scenes, also after one that has errors.
pub(super) fn run(scenes: &[PathBuf], inputs: &Inputs) -> Result<(), Failure> {
    let mut broken = 0;
    for path in scenes {
        match input::read(path, inputs) {
            Ok(_) => {}
            Err(failure) => {
                broken += 1;
                failure.report();
            }
        }
    }
    if broken == 0 { Ok(()) } else { Err(Failure::Input(String::new())) }
}
