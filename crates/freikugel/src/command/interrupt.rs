//! Ctrl-C: the first one asks the work to stop, the second one ends the program at once. Neither leaves a partial file.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What an interrupted program exits with, as shells expect.
const INTERRUPTED: i32 = 130;

/// Whether the user wants to stop.
#[derive(Clone, Debug, Default)]
pub(super) struct Interrupt {
    requested: Arc<AtomicBool>,
    unfinished: Arc<Mutex<Vec<PathBuf>>>,
}

impl Interrupt {
    /// Listens to Ctrl-C from now on.
    pub(super) fn listen() -> Self {
        let interrupt = Self::default();
        let heard = interrupt.clone();
        // Without a handler Ctrl-C still ends the program; only an unfinished file may then stay.
        let _ = ctrlc::set_handler(move || {
            if heard.requested.swap(true, Ordering::Relaxed) {
                for path in heard.unfinished.lock().unwrap_or_else(PoisonError::into_inner).iter() {
                    let _ = std::fs::remove_file(path);
                }
                std::process::exit(INTERRUPTED);
            }
        });
        interrupt
    }

    /// Names a file that must not stay if the program ends early.
    pub(super) fn guard(&self, path: Option<&Path>) {
        self.unfinished.lock().unwrap_or_else(PoisonError::into_inner).extend(path.map(Path::to_owned));
    }

    /// Whether to stop.
    pub(super) fn is_requested(&self) -> bool {
        self.requested.load(Ordering::Relaxed)
    }
}
