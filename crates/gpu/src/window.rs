//! The native window: what is shown, how it is moved, and the glue to the system's windows.
//!
//! [`view`] runs it. Its parts know as little as they can: the camera, keys, state, text and schedule of work know neither
//! windows nor devices; the stage and the presenter know the device; only the app knows windows.

mod app;
mod camera;
mod frame_times;
mod keys;
mod overlay;
mod present;
mod refine;
mod stage;
mod state;

pub use app::{Host, ViewError, WindowOptions, view};
pub use frame_times::{FrameTimes, Summary};
