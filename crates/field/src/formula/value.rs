//! What parts of a formula stand for: numbers, and vectors of two or three of them.
//!
//! Vectors exist while a formula is read, and no longer: all its terms are numbers.

use super::TermId;

/// A number, or a vector by its parts along x, y and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Value {
    parts: [TermId; Self::MOST],
    count: usize,
}

impl Value {
    /// How many parts a vector can have.
    pub(super) const MOST: usize = 3;

    pub(super) fn number(term: TermId) -> Self {
        Self { parts: [term; Self::MOST], count: 1 }
    }

    /// The vector with these parts, or the number that is the only one; `None` if there are too many of them, or none.
    pub(super) fn of(parts: &[TermId]) -> Option<Self> {
        let &first = parts.first()?;
        let mut all = [first; Self::MOST];
        all.get_mut(..parts.len())?.copy_from_slice(parts);
        Some(Self { parts: all, count: parts.len() })
    }

    /// The parts of a vector; a number is its only part.
    pub(super) fn parts(&self) -> &[TermId] {
        &self.parts[..self.count]
    }

    pub(super) fn as_number(&self) -> Option<TermId> {
        (self.count == 1).then_some(self.parts[0])
    }

    /// What it is, with an article.
    pub(super) fn kind(&self) -> &'static str {
        match self.count {
            1 => "a number",
            2 => "a vector of 2",
            _ => "a vector of 3",
        }
    }

    /// The part with this number; a number stands for each part of a vector.
    fn part(&self, index: usize) -> TermId {
        self.parts[if self.count == 1 { 0 } else { index }]
    }
}

/// `f` of numbers, of each part of vectors: numbers beside them count for all parts.
///
/// # Errors
/// Two vectors of different lengths.
pub(super) fn for_each_part(values: &[Value], mut f: impl FnMut(&[TermId]) -> TermId) -> Result<Value, [Value; 2]> {
    let mut vectors = values.iter().filter(|value| value.count > 1);
    let longest = vectors.next().copied();
    if let (Some(one), Some(&other)) =
        (longest, vectors.find(|other| Some(other.count) != longest.map(|one| one.count)))
    {
        return Err([one, other]);
    }
    let count = longest.map_or(1, |vector| vector.count);
    let mut parts = [TermId(0); Value::MOST];
    for (index, part) in parts.iter_mut().enumerate().take(count) {
        let arguments: Vec<TermId> = values.iter().map(|value| value.part(index)).collect();
        *part = f(&arguments);
    }
    Ok(Value { parts, count })
}
