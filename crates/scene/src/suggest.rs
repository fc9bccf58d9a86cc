//! "Did you mean": the known name that a misspelt one was probably meant to be.

/// Longer words are nobody's misspelling of a name, and comparing them takes time.
const LONGEST_WORD: usize = 40;

/// The name closest to `word`, if one is close enough to be meant by it.
pub(crate) fn closest<'n>(word: &str, names: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    if word.len() > LONGEST_WORD {
        return None;
    }
    let word = plain(word);
    names
        .into_iter()
        .filter_map(|name| Some((strangeness(&word, &plain(name))?, name)))
        .min_by_key(|&(strangeness, _)| strangeness)
        .map(|(_, name)| name)
}

/// The least that two words with different endings must share: shorter stems belong to unrelated words.
const SHORTEST_STEM: usize = 4;

/// The longest ending that a name may have in another form, as the one of `tracing` for `tracer`.
const LONGEST_ENDING: usize = 3;

/// How far apart two words are, or `None` if one is not meant by the other: at most one typing mistake in three letters,
/// a name cut short, or its stem with another ending.
fn strangeness(word: &str, name: &str) -> Option<usize> {
    let mistakes = strsim::damerau_levenshtein(word, name);
    let is_close = 3 * mistakes <= word.chars().count().max(name.chars().count());
    let is_cut = word.len() >= 3 && name.starts_with(word);
    let stem = word.chars().zip(name.chars()).take_while(|(a, b)| a == b).count();
    let is_inflected = stem >= SHORTEST_STEM && word.chars().count().max(name.chars().count()) <= stem + LONGEST_ENDING;
    (is_close || is_cut || is_inflected).then_some(mistakes)
}

/// Case and the ways to separate words make no difference.
fn plain(word: &str) -> String {
    word.chars().filter(|c| !matches!(c, '_' | '-' | ' ')).flat_map(char::to_lowercase).collect()
}

/// Text of a user in a message: within backticks, cut where it gets long, and with nothing in it that moves the cursor.
pub(crate) fn quote(text: &str) -> String {
    let mut quoted = String::from("`");
    for (index, c) in text.chars().enumerate() {
        if index == LONGEST_WORD {
            quoted.push('…');
            break;
        }
        if c.is_control() {
            quoted.extend(c.escape_default());
        } else {
            quoted.push(c);
        }
    }
    quoted.push('`');
    quoted
}

/// Names in a sentence: `a`, `b`, `c`.
pub(crate) fn listed<'n>(names: impl IntoIterator<Item = &'n str>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::{closest, quote};

    const NAMES: [&str; 8] = ["sphere", "box", "smooth_union", "position", "tracer", "rotate", "k", "by"];

    #[test]
    fn finds_what_was_meant() {
        for (word, meant) in [
            ("spere", Some("sphere")),
            ("Sphere", Some("sphere")),
            ("smoothUnion", Some("smooth_union")),
            ("smooth-union", Some("smooth_union")),
            ("pos", Some("position")),
            ("boxx", Some("box")),
            ("tracing", Some("tracer")),
            ("rotation", Some("rotate")),
            ("spheroids", None),
            ("r", None),
            ("teapot", None),
            ("", None),
        ] {
            assert_eq!(closest(word, NAMES), meant, "{word}");
        }
        assert_eq!(closest(&"s".repeat(1_000_000), NAMES), None);
    }

    #[test]
    fn quotes_harmlessly() {
        assert_eq!(quote("a\u{1b}[31m\nb"), "`a\\u{1b}[31m\\nb`");
        assert_eq!(quote(&"ä".repeat(100)).chars().count(), 43);
    }
}
