//! What keys do: the one table that both the window and its help read.

/// What the window shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Show {
    /// The lit scene.
    #[default]
    Lit,
    /// Normals as colours.
    Normals,
    /// How many steps each ray took.
    Steps,
    /// How far each surface is.
    Depth,
    /// The field's values on a plane through the target.
    Slice,
}

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Action {
    /// Ends the program.
    Close,
    /// Shows or hides the list of keys.
    Help,
    /// Reads the scene anew.
    Reload,
    /// Stops or continues time.
    Pause,
    /// Shows something else.
    Show(Show),
    /// Saves what the window shows.
    Screenshot,
    /// Back to the scene's camera.
    ResetCamera,
    /// Orbit or flight.
    ToggleFlight,
    /// Prints the camera in the notation of scene files.
    PrintCamera,
    /// Shows or hides the times of frames.
    Times,
}

/// A key as winit names it: letters in lower case, others by their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Key<'t> {
    /// A key that writes a letter or a digit.
    Letter(&'t str),
    /// Escape.
    Escape,
    /// The space bar.
    Space,
    /// F5.
    F5,
}

/// Keys that do one thing when they are pressed, with what the help says of them.
const KEYS: [(Key<'static>, &str, Action, &str); 14] = [
    (Key::Escape, "Esc", Action::Close, "close the window"),
    (Key::Letter("h"), "H", Action::Help, "show or hide this list"),
    (Key::Letter("t"), "T", Action::Times, "show or hide frame times"),
    (Key::Letter("1"), "1", Action::Show(Show::Lit), "lit scene"),
    (Key::Letter("2"), "2", Action::Show(Show::Normals), "normals"),
    (Key::Letter("3"), "3", Action::Show(Show::Steps), "steps of rays"),
    (Key::Letter("4"), "4", Action::Show(Show::Depth), "depth"),
    (Key::Letter("5"), "5", Action::Show(Show::Slice), "distances on a plane through the target"),
    (Key::Space, "Space", Action::Pause, "stop or continue time"),
    (Key::F5, "F5", Action::Reload, "read the scene anew (a changed file is read by itself)"),
    (Key::Letter("p"), "P", Action::Screenshot, "save a picture"),
    (Key::Letter("c"), "C", Action::PrintCamera, "print the camera, for the scene file"),
    (Key::Letter("r"), "R", Action::ResetCamera, "back to the scene's camera"),
    (Key::Letter("f"), "F", Action::ToggleFlight, "orbit or flight"),
];

/// What the mouse and held keys do.
const HELD: [(&str, &str); 5] = [
    ("left drag", "turn"),
    ("right drag", "move sideways (also: middle, or left with Shift)"),
    ("wheel", "nearer or farther; in flight, faster or slower"),
    ("W A S D", "fly forward, left, back, right"),
    ("E Q", "fly up, down"),
];

/// What a key asks for when it is pressed, if anything.
pub(crate) fn action(key: Key<'_>) -> Option<Action> {
    KEYS.iter().find(|(known, ..)| *known == key).map(|(_, _, action, _)| *action)
}

/// The direction that a held key flies in: right, forward, up.
pub(crate) fn flight(letter: &str) -> Option<[f64; 3]> {
    Some(match letter {
        "w" => [0.0, 1.0, 0.0],
        "s" => [0.0, -1.0, 0.0],
        "d" => [1.0, 0.0, 0.0],
        "a" => [-1.0, 0.0, 0.0],
        "e" => [0.0, 0.0, 1.0],
        "q" => [0.0, 0.0, -1.0],
        _ => return None,
    })
}

/// The list of all keys, line by line.
pub(crate) fn help() -> Vec<String> {
    let pressed = KEYS.iter().map(|&(_, name, _, text)| (name, text));
    pressed.chain(HELD).map(|(name, text)| format!("{name:<12}{text}")).collect()
}

impl Show {
    /// Its name, as the help has it.
    pub(crate) fn name(self) -> &'static str {
        KEYS.iter().find(|(.., action, _)| *action == Action::Show(self)).map_or("", |(.., text)| text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_does_two_things() {
        for (index, (key, ..)) in KEYS.iter().enumerate() {
            assert!(KEYS[..index].iter().all(|(other, ..)| other != key), "{key:?}");
            if let Key::Letter(letter) = key {
                assert_eq!(flight(letter), None, "{letter} flies");
            }
        }
    }

    #[test]
    fn the_help_names_all_keys_and_views_have_names() {
        let help = help().join("\n");
        for name in ["Esc", "H ", "F5", "Space", "1 ", "5 ", "P ", "W A S D", "wheel"] {
            assert!(help.contains(name), "{name}");
        }
        for show in [Show::Lit, Show::Normals, Show::Steps, Show::Depth, Show::Slice] {
            assert!(!show.name().is_empty());
        }
        assert_eq!(action(Key::Escape), Some(Action::Close));
        assert_eq!(action(Key::Letter("x")), None);
    }
}
