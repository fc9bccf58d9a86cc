//! Arguments that take long to be turned into others, and are asked for again and again.

use std::cell::RefCell;
use std::collections::VecDeque;

/// So many results are kept in each thread, the newest ones;
const KEPT: usize = 32;

/// and no more than so many numbers of their arguments and theirs: 128 MB.
const MOST_NUMBERS: usize = 1 << 24;

type Entry = (&'static str, Vec<f64>, Vec<f64>);

thread_local! {
    static RESULTS: RefCell<VecDeque<Entry>> = const { RefCell::new(VecDeque::new()) };
}

/// What `make` yields for these arguments of a shape, or has yielded before.
pub(crate) fn remembered(shape: &'static str, args: &[f64], make: impl FnOnce() -> Vec<f64>) -> Vec<f64> {
    let known = RESULTS.with_borrow(|results| {
        let is_it = |(of, own, _): &&Entry| *of == shape && own == args;
        results.iter().find(is_it).map(|(.., result)| result.clone())
    });
    known.unwrap_or_else(|| {
        let result = make();
        RESULTS.with_borrow_mut(|results| {
            results.push_front((shape, args.to_vec(), result.clone()));
            let mut numbers = 0;
            let fits = |(_, args, result): &&Entry| {
                numbers += args.len() + result.len();
                numbers <= MOST_NUMBERS
            };
            let kept = results.iter().take(KEPT).take_while(fits).count();
            results.truncate(kept);
        });
        result
    })
}
