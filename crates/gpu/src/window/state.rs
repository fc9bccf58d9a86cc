//! What the window knows apart from pixels: camera, what is shown, time, held keys, messages. It hears inputs and says what
//! follows from them; the glue to the system's windows is elsewhere.

use super::camera::{Controller, Mode};
use super::frame_times::Summary;
use super::keys::{self, Action, Key, Show};
use super::overlay::Ink;
use freikugel_scene::Camera;
use glam::{DVec2, DVec3};

/// The longest time that one frame moves the camera for, in seconds: after a pause nobody wants to be far away.
const LONGEST_STEP: f64 = 0.1;

/// Something that the user did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Input<'t> {
    /// A key went down or came up.
    Key {
        /// Which one.
        key: Key<'t>,
        /// Whether it went down.
        is_down: bool,
        /// Whether the system repeats it because it is held.
        is_repeat: bool,
    },
    /// A button of the mouse went down or came up.
    Button {
        /// Which one.
        button: Button,
        /// Whether it went down.
        is_down: bool,
    },
    /// The mouse is at a place of the window, in pixels from the upper left corner.
    Cursor(DVec2),
    /// The wheel turned by some notches, away from the user if positive.
    Wheel(f64),
    /// Shift is held, or not any more.
    Shift(bool),
    /// Another window gets the keys now.
    FocusLost,
}

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Button {
    /// Turns.
    Left,
    /// Moves sideways.
    Other,
}

/// What somebody else has to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effect {
    /// End the program.
    Close,
    /// Read the scene anew.
    Reload,
    /// Save a picture.
    Screenshot,
    /// Print the camera.
    PrintCamera,
}

/// How far the picture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Progress {
    /// The size of the window in pixels.
    pub(crate) size: [u32; 2],
    /// The size of pictures while things move.
    pub(crate) coarse: [u32; 2],
    /// Samples that each pixel has.
    pub(crate) samples: u32,
    /// Samples that it will have.
    pub(crate) most: u32,
}

/// What the window knows apart from pixels.
#[derive(Clone, Debug)]
pub(crate) struct State {
    controller: Controller,
    show: Show,
    is_help_shown: bool,
    are_times_shown: bool,
    is_paused: bool,
    time: f64,
    /// Whether anything that is seen depends on time.
    is_animated: bool,
    /// Directions of held keys: right, forward, up.
    flight: Vec<(String, DVec3)>,
    drag: Option<Button>,
    is_shift_held: bool,
    cursor: Option<DVec2>,
    /// What was said last.
    note: Option<String>,
    /// What is wrong with the scene's file.
    alarm: Option<String>,
    is_picture_stale: bool,
}

impl State {
    /// Starts with a camera.
    pub(crate) fn new(camera: Camera, is_animated: bool) -> Self {
        Self {
            controller: Controller::new(camera),
            show: Show::Lit,
            is_help_shown: false,
            are_times_shown: true,
            is_paused: false,
            time: 0.0,
            is_animated,
            flight: Vec::new(),
            drag: None,
            is_shift_held: false,
            cursor: None,
            note: Some("H lists the keys".into()),
            alarm: None,
            is_picture_stale: true,
        }
    }

    /// The camera as it stands.
    pub(crate) fn camera(&self) -> &Camera {
        self.controller.camera()
    }

    /// What is shown.
    pub(crate) fn show(&self) -> Show {
        self.show
    }

    /// The scene's time in seconds.
    pub(crate) fn time(&self) -> f64 {
        self.time
    }

    /// Takes the camera of a scene that was read anew.
    pub(crate) fn set_scene(&mut self, camera: Camera, is_animated: bool) {
        self.controller.set_home(camera);
        self.is_animated = is_animated;
        self.is_picture_stale = true;
    }

    /// Says something, until something else is said or a key is pressed.
    pub(crate) fn say(&mut self, note: impl Into<String>) {
        self.note = Some(note.into());
    }

    /// Says that something is wrong, until it is not any more.
    pub(crate) fn set_alarm(&mut self, alarm: Option<String>) {
        self.alarm = alarm;
    }

    /// Whether what is seen has changed since this was asked last.
    pub(crate) fn take_stale(&mut self) -> bool {
        std::mem::take(&mut self.is_picture_stale)
    }

    /// Whether the picture changes by itself, or may at any moment: no time for finer ones.
    pub(crate) fn is_moving(&self) -> bool {
        !self.flight.is_empty() || (self.is_animated && !self.is_paused)
    }

    /// Hears an input in a window of some size.
    pub(crate) fn input(&mut self, input: Input<'_>, size: DVec2) -> Option<Effect> {
        match input {
            Input::Key { key, is_down, is_repeat } => {
                if let Key::Letter(letter) = key
                    && let Some(direction) = keys::flight(letter)
                {
                    self.flight.retain(|(held, _)| held != letter);
                    if is_down {
                        self.flight.push((letter.to_owned(), direction.into()));
                    }
                    return None;
                }
                if !is_down || is_repeat {
                    return None;
                }
                let action = keys::action(key)?;
                self.note = None;
                self.act(action)
            }
            Input::Button { button, is_down } => {
                self.drag = is_down.then_some(button);
                None
            }
            Input::Cursor(cursor) => {
                let moved = self.cursor.replace(cursor).map_or(DVec2::ZERO, |before| cursor - before);
                match self.drag {
                    Some(Button::Left) if !self.is_shift_held => self.controller.turn(moved, size.y),
                    Some(_) => self.controller.pan(moved, size),
                    None => return None,
                }
                self.is_picture_stale |= moved != DVec2::ZERO;
                None
            }
            Input::Wheel(notches) => {
                self.controller.zoom(notches);
                self.is_picture_stale |= self.controller.mode() == Mode::Orbit;
                None
            }
            Input::Shift(is_held) => {
                self.is_shift_held = is_held;
                None
            }
            Input::FocusLost => {
                // Whoever lets go of a key elsewhere does not fly on here.
                (self.drag, self.is_shift_held) = (None, false);
                self.flight.clear();
                None
            }
        }
    }

    fn act(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Close => return Some(Effect::Close),
            Action::Reload => return Some(Effect::Reload),
            Action::Screenshot => return Some(Effect::Screenshot),
            Action::PrintCamera => return Some(Effect::PrintCamera),
            Action::Help => self.is_help_shown = !self.is_help_shown,
            Action::Times => self.are_times_shown = !self.are_times_shown,
            Action::Pause => {
                self.is_paused = !self.is_paused;
                let word = if self.is_paused { "stopped" } else { "runs" };
                let note = if self.is_animated { "" } else { " (nothing in this scene moves)" };
                self.say(format!("time {word}{note}"));
            }
            Action::Show(show) => {
                self.is_picture_stale |= self.show != show;
                self.show = show;
                self.say(show.name());
            }
            Action::ResetCamera => {
                self.controller.reset();
                self.is_picture_stale = true;
            }
            Action::ToggleFlight => {
                self.controller.toggle_mode();
                let text = match self.controller.mode() {
                    Mode::Orbit => "orbit: the mouse turns about the target",
                    Mode::Fly => "flight: the mouse turns the view, W A S D E Q move",
                };
                self.say(text);
            }
        }
        None
    }

    /// Lets some seconds pass.
    pub(crate) fn pass(&mut self, seconds: f64) {
        if !self.is_paused {
            self.time += seconds;
            self.is_picture_stale |= self.is_animated;
        }
        let direction: DVec3 = self.flight.iter().map(|(_, direction)| *direction).sum();
        if direction != DVec3::ZERO {
            self.controller.fly(direction, seconds.min(LONGEST_STEP));
            self.is_picture_stale = true;
        }
    }

    /// The lines of the panel.
    pub(crate) fn lines(&self, adapter: &str, times: Option<Summary>, progress: Progress) -> Vec<(Ink, String)> {
        let mut lines = Vec::new();
        if self.are_times_shown {
            let Progress { size: [width, height], coarse, samples, most } = progress;
            lines.push((Ink::Plain, adapter.to_owned()));
            let moving = if coarse == progress.size {
                String::new()
            } else {
                format!(", {} x {} while moving", coarse[0], coarse[1])
            };
            lines.push((Ink::Plain, format!("{width} x {height}{moving}, {samples} of {most} samples")));
            if let Some(Summary { min, mean, max, deviation, .. }) = times {
                let [min, average, max, deviation] = [min, mean, max, deviation].map(|seconds| 1e3 * seconds);
                lines.push((
                    Ink::Plain,
                    format!(
                        "frame {average:.1} ms ({min:.1} to {max:.1}, deviation {deviation:.1}), {:.1} frames/s",
                        1.0 / mean
                    ),
                ));
            }
        }
        if self.is_help_shown {
            lines.extend(keys::help().into_iter().map(|line| (Ink::Plain, line)));
        }
        for (ink, text) in [(Ink::Plain, &self.note), (Ink::Alarm, &self.alarm)] {
            lines.extend(text.iter().flat_map(|text| text.lines()).map(|line| (ink, line.to_owned())));
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: DVec2 = DVec2::new(640.0, 360.0);

    fn state() -> State {
        let mut state = State::new(Camera::look([4, -6, 3], [0, 0, 0]), false);
        assert!(state.take_stale());
        state
    }

    fn press(state: &mut State, key: Key<'_>) -> Option<Effect> {
        state.input(Input::Key { key, is_down: true, is_repeat: false }, SIZE)
    }

    fn text(state: &State) -> String {
        let progress = Progress { size: [640, 360], coarse: [320, 180], samples: 2, most: 16 };
        let times = Summary { count: 2, min: 0.01, mean: 0.02, max: 0.03, deviation: 0.005 };
        let lines = state.lines("a card", Some(times), progress);
        lines.into_iter().map(|(_, line)| line + "\n").collect()
    }

    #[test]
    fn drags_move_the_camera_and_make_the_picture_stale() {
        let mut state = state();
        let start = state.camera().clone();
        state.input(Input::Cursor(DVec2::new(100.0, 100.0)), SIZE);
        state.input(Input::Cursor(DVec2::new(120.0, 100.0)), SIZE);
        assert!(!state.take_stale(), "no button is held");
        state.input(Input::Button { button: Button::Left, is_down: true }, SIZE);
        state.input(Input::Cursor(DVec2::new(150.0, 110.0)), SIZE);
        assert!(state.take_stale());
        assert_eq!(state.camera().target, start.target);
        assert_ne!(state.camera().eye, start.eye);
        state.input(Input::Shift(true), SIZE);
        state.input(Input::Cursor(DVec2::new(170.0, 110.0)), SIZE);
        assert_ne!(state.camera().target, start.target, "with Shift it moves sideways");
        state.input(Input::Button { button: Button::Left, is_down: false }, SIZE);
        assert!(state.take_stale());
        state.input(Input::Cursor(DVec2::new(0.0, 0.0)), SIZE);
        assert!(!state.take_stale());
        press(&mut state, Key::Letter("r"));
        assert!(state.take_stale());
        assert_eq!(state.camera(), &start);
    }

    #[test]
    fn held_keys_fly_until_they_come_up() {
        let mut state = state();
        let start = state.camera().eye;
        press(&mut state, Key::Letter("w"));
        assert!(state.is_moving());
        state.pass(0.05);
        assert!(state.take_stale());
        let after = state.camera().eye;
        assert!((after - start).length() > 0.01);
        state.pass(100.0);
        assert!((state.camera().eye - after).length() < 1.0, "a long pause is no long flight");
        state.input(Input::Key { key: Key::Letter("w"), is_down: false, is_repeat: false }, SIZE);
        assert!(!state.is_moving());
        state.take_stale();
        state.pass(1.0);
        assert!(!state.take_stale());
        press(&mut state, Key::Letter("a"));
        state.input(Input::FocusLost, SIZE);
        assert!(!state.is_moving());
    }

    #[test]
    fn keys_have_their_effects() {
        let mut state = state();
        assert_eq!(press(&mut state, Key::Escape), Some(Effect::Close));
        assert_eq!(press(&mut state, Key::F5), Some(Effect::Reload));
        assert_eq!(press(&mut state, Key::Letter("p")), Some(Effect::Screenshot));
        assert_eq!(press(&mut state, Key::Letter("c")), Some(Effect::PrintCamera));
        assert_eq!(press(&mut state, Key::Letter("2")), None);
        assert_eq!(state.show(), Show::Normals);
        assert!(state.take_stale());
        press(&mut state, Key::Letter("2"));
        assert!(!state.take_stale(), "it is shown already");
        let repeat = Input::Key { key: Key::Letter("p"), is_down: true, is_repeat: true };
        assert_eq!(state.input(repeat, SIZE), None);
    }

    #[test]
    fn the_panel_tells_what_is_asked_for() {
        let mut state = state();
        let shown = text(&state);
        for part in ["a card", "320 x 180 while moving, 2 of 16", "20.0 ms (10.0 to 30.0, deviation 5.0), 50.0 frames"]
        {
            assert!(shown.contains(part), "{shown}");
        }
        assert!(!shown.contains("Esc"));
        press(&mut state, Key::Letter("h"));
        assert!(text(&state).contains("Esc"));
        press(&mut state, Key::Letter("h"));
        press(&mut state, Key::Letter("t"));
        assert_eq!(text(&state), "");
        state.set_alarm(Some("error\non two lines".into()));
        press(&mut state, Key::Letter("3"));
        assert_eq!(text(&state), format!("{}\nerror\non two lines\n", Show::Steps.name()));
        state.set_alarm(None);
        press(&mut state, Key::Letter("t"));
        press(&mut state, Key::Letter("t"));
        assert_eq!(text(&state), "");
    }

    #[test]
    fn time_passes_unless_it_is_stopped() {
        let mut state = State::new(Camera::default(), true);
        state.take_stale();
        state.pass(0.5);
        assert!(state.take_stale() && state.is_moving());
        press(&mut state, Key::Space);
        state.pass(0.5);
        assert!(!state.take_stale() && !state.is_moving());
        assert_eq!(state.time(), 0.5);
    }
}
