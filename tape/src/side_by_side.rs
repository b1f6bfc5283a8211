//! Work on several items at once. In: items, what is done with each. Out: the results, in the order of the items. Never knows tapes.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{Builder, scope};

/// Works on every item, on so many threads at most: which does what changes no result.
pub fn side_by_side<I: Sync, O: Send>(items: &[I], threads: usize, work: impl Fn(&I) -> O + Sync) -> Vec<O> {
    let next = AtomicUsize::new(0);
    let all = || {
        let mut done = Vec::new();
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(place) else { return done };
            done.push((place, work(item)));
        }
    };
    let mut done = scope(|scope| {
        // Where the system gives no thread, this one does it all.
        let others = 1..threads.min(items.len());
        let others: Vec<_> = others.map_while(|_| Builder::new().spawn_scoped(scope, all).ok()).collect();
        let mut done = all();
        for other in others {
            done.extend(other.join().unwrap_or_else(|panic| resume_unwind(panic)));
        }
        done
    });
    done.sort_unstable_by_key(|(place, _)| *place);
    done.into_iter().map(|(_, result)| result).collect()
}
