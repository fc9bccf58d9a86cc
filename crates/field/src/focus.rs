//! What matters of a long union at some points.
//!
//! Gradients and shares cost several times what values do. At any point one operand of a union decides all of them, so that
//! for a few points near each other it pays to look first which operands have the least value anywhere, and then to forget
//! the others. Those that are left have the same gradients and shares there, bit for bit.

use crate::bank::{Bank, Values};
use crate::evaluator::{Points, batches};
use crate::kernel::Block;
use crate::operation::Steps;
use crate::program::{Part, Program};
use crate::simd::Level;
use crate::spine::Excerpt;

/// Of so many operands one may be left for the others to be worth forgetting.
const WORTH: usize = 2;

/// The scratch memory of one thread.
#[derive(Default)]
pub(crate) struct Focus {
    bank: Bank<Values>,
    /// Operand by operand, the values at a batch of points.
    rows: Vec<Block>,
    kept: Vec<bool>,
    excerpt: Excerpt,
}

impl Focus {
    /// The operands that are the least ones somewhere, as a part; nothing if `part` is no long union, or most of it matters.
    pub(crate) fn on(&mut self, program: &Program, part: &Part, level: Level, points: Points<'_>) -> Option<Part> {
        let spine = part.spine()?;
        let entries = spine.entries();
        let listing = part.one_by_one();
        self.bank.prepare(listing);
        self.rows.resize(entries.len().max(self.rows.len()), Block::default());
        self.kept.clear();
        self.kept.resize(entries.len(), false);
        for batch in batches(points.count()) {
            let given = batch.len();
            let count = self.bank.load(points.slice(batch));
            let mut next = entries.iter().zip(&mut self.rows).peekable();
            for (index, op) in listing.ops.iter().enumerate() {
                self.bank.step(program, op, level, count);
                // An operand's register is taken again as soon as its minimum is known.
                if let Some((entry, row)) = next.next_if(|(entry, _)| entry.operand().index() == index + 1) {
                    let register = listing.place[entry.operand().index()] as usize;
                    row.0[..given].copy_from_slice(&self.bank.value(register)[0].0[..given]);
                }
            }
            let least = &self.bank.value(listing.result?)[0].0[..given];
            for (row, kept) in self.rows.iter().zip(&mut self.kept) {
                if !can_drop(&row.0[..given], least)? {
                    *kept = true;
                }
            }
        }
        if self.kept.iter().filter(|&&kept| kept).count() * WORTH > entries.len() {
            return None;
        }
        let kept = (0..entries.len()).filter(|&entry| self.kept[entry]);
        let result = self.excerpt.take(&part.steps, spine, kept)?;
        Some(Part::new(Steps { list: self.excerpt.list.clone(), result: Some(result) }))
    }
}

/// Whether all values are above the least ones. Unknown if some are no numbers: what a minimum makes of these depends on all
/// of its operands.
fn can_drop(values: &[f32], least: &[f32]) -> Option<bool> {
    let (mut above, mut unknown) = (0_u32, 0_u32);
    for (value, least) in values.iter().zip(least) {
        above += u32::from(value > least);
        unknown += u32::from(value.is_nan() || least.is_nan());
    }
    (unknown == 0).then_some(above as usize == values.len())
}
