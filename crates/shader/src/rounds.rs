//! Steps that come again and again with other constants, as rounds of a loop: pieces of a sweep, copies in a blend. So the text
//! does not grow with them, nor does the time that drivers take to compile it.

use freikugel_field::Action;
use std::collections::HashMap;

/// Fewer rounds are written out.
const LEAST_ROUNDS: usize = 3;

/// Longer rounds are not looked for.
const MOST_STEPS: usize = 64;

/// Steps that a loop does in rounds. Each round reads what came before all of them, itself, and the last step of the round before,
/// or, in the first round, the step before that.
#[derive(Debug)]
pub(crate) struct Rounds {
    /// The first step of the first round.
    pub(crate) first: usize,
    /// How many steps a round has.
    pub(crate) steps: usize,
    /// How many rounds there are.
    pub(crate) count: usize,
    /// By how much the places of constants of the first round grow from round to round.
    pub(crate) strides: HashMap<usize, usize>,
}

impl Rounds {
    /// All of them, in order.
    pub(crate) fn of(steps: &[Action], result: usize) -> Vec<Self> {
        let mut found = Vec::new();
        let mut first = 1;
        while first < steps.len() {
            let most = MOST_STEPS.min((steps.len() - first) / LEAST_ROUNDS);
            let rounds = (1..=most).find_map(|length| Self::at(steps, first, length, result));
            first += rounds.as_ref().map_or(1, |rounds| rounds.steps * rounds.count);
            found.extend(rounds);
        }
        found
    }

    /// The most rounds of so many steps from one on.
    fn at(steps: &[Action], first: usize, length: usize, result: usize) -> Option<Self> {
        let last = &steps[first + length - 1];
        if matches!(last, Action::Affine { .. } | Action::Map { .. })
            || !steps[first..first + length].iter().all(is_plain)
        {
            return None;
        }
        let mut rounds = Self { first, steps: length, count: 1, strides: HashMap::new() };
        while rounds.goes_on(steps) {
            rounds.count += 1;
        }
        let end = first + length * rounds.count;
        let is_read = |step: usize| {
            let is_inside = |read: &usize| (first..end - 1).contains(read);
            reads(&steps[step]).iter().any(is_inside)
        };
        let is_closed = !(first..end - 1).contains(&result) && !(end..steps.len()).any(is_read);
        (rounds.count >= LEAST_ROUNDS && is_closed).then_some(rounds)
    }

    /// Whether another round follows; then its constants are as far away as they should be.
    fn goes_on(&mut self, steps: &[Action]) -> bool {
        let offset = self.count * self.steps;
        let first = self.first;
        let Some(round) = steps.get(first + offset..first + offset + self.steps) else { return false };
        let mut strides = self.strides.clone();
        let mut is_joined = false;
        for (one, other) in steps[first..first + self.steps].iter().zip(round) {
            if !is_alike(one, other) {
                return false;
            }
            for (from, to) in reads(one).into_iter().zip(reads(other)) {
                let is_own = from + 1 >= first && to == from + offset;
                is_joined |= is_own && from + 1 == first;
                // What came before all of the rounds; but of the step before them only the first round takes the value.
                if !is_own && (to != from || from + 1 >= first) {
                    return false;
                }
            }
            for (from, to) in constants(one).into_iter().zip(constants(other)) {
                let Some(way) = to.checked_sub(from) else { return false };
                let stride = *strides.entry(from).or_insert(way / self.count);
                if stride * self.count != way {
                    return false;
                }
            }
        }
        self.strides = strides;
        is_joined
    }
}

/// Whether a step can be done in rounds: formulas have functions of their own.
fn is_plain(step: &Action) -> bool {
    use Action::{Affine, Combine, Map, Mix, Modify, Primitive, Scale, Surface};
    matches!(
        step,
        Affine { .. }
            | Map { .. }
            | Primitive { .. }
            | Combine { .. }
            | Mix { .. }
            | Modify { .. }
            | Scale { .. }
            | Surface { .. }
    )
}

/// Whether steps do the same with different operands and constants.
fn is_alike(one: &Action, other: &Action) -> bool {
    use Action::{Affine, Combine, Map, Mix, Modify, Primitive, Scale, Surface};
    match (one, other) {
        (Map { shape: a, constants: c, .. }, Map { shape: b, constants: d, .. })
        | (Primitive { shape: a, constants: c, .. }, Primitive { shape: b, constants: d, .. })
        | (Combine { shape: a, constants: c, .. }, Combine { shape: b, constants: d, .. })
        | (Mix { shape: a, constants: c, .. }, Mix { shape: b, constants: d, .. })
        | (Modify { shape: a, constants: c, .. }, Modify { shape: b, constants: d, .. }) => {
            std::ptr::eq(*a, *b) && c.len() == d.len()
        }
        (Affine { .. }, Affine { .. }) | (Scale { .. }, Scale { .. }) | (Surface { .. }, Surface { .. }) => true,
        _ => false,
    }
}

/// The steps that one reads.
fn reads(step: &Action) -> Vec<usize> {
    match *step {
        Action::Affine { from, .. }
        | Action::Map { from, .. }
        | Action::Modify { from, .. }
        | Action::Scale { from, .. }
        | Action::Surface { from, .. }
        | Action::Unary { from, .. }
        | Action::Power { from, .. } => vec![from],
        Action::Primitive { point, .. } | Action::Coordinate { point, .. } => vec![point],
        Action::Combine { a, b, .. } | Action::Binary { a, b, .. } => vec![a, b],
        Action::Mix { a, b, height, .. } => vec![a, b, height],
        Action::Altered { from, by, .. } => vec![from, by],
        Action::Warp { from } => from.to_vec(),
        Action::Point | Action::Literal { .. } => Vec::new(),
    }
}

/// Where the constants of a plain step are.
fn constants(step: &Action) -> Vec<usize> {
    match step {
        Action::Affine { constants, .. } => vec![*constants],
        Action::Map { at, constants, .. } | Action::Primitive { at, constants, .. } => {
            [*at].into_iter().chain(constants.clone().next()).collect()
        }
        Action::Combine { constants, .. } | Action::Mix { constants, .. } | Action::Modify { constants, .. } => {
            constants.clone().take(1).collect()
        }
        Action::Scale { factor, .. } => vec![*factor],
        _ => Vec::new(),
    }
}
