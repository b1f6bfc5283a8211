//! Wear of random lives at whole cycles, as they were lived. In: cycles as they are lived, in any order of the lives. Out: wear at the
//! same cycles for all lives, its quantiles. Never knows how lives are lived.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use linkwear_gamma::order::sorted_quantile;
use linkwear_runtime::life::JointLife;
use serde::{Deserialize, Serialize};

/// Lives that are followed, those of the lowest numbers: a quantile of wear is then good to 1.5 % of the lives.
pub const FOLLOWED: u64 = 1000;
/// Cycles at which wear is kept until the mean path ends: a curve shows no more.
const PER_LIFE: u64 = 40;
/// Cycles that are kept at most, three mean lives and more: rarer lives end without being followed so far.
const MOST: usize = 128;

/// Wear of one life.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct LifePath {
    /// Wear W [m] of every joint, joint after joint, at every cycle that is kept until the life ended.
    wear: Vec<f64>,
    /// At the end of its last cycle.
    last: Vec<f64>,
    /// Cycles until then, the last one counted in full.
    cycles: u64,
}

/// Wear of the lives that are followed.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct LifePaths {
    /// Cycles from one that is kept to the next.
    every: u64,
    /// By the numbers of the lives.
    lives: BTreeMap<u64, LifePath>,
}

/// Wear of all joints after a cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    /// After so many whole cycles.
    pub cycle: u64,
    /// Part of the lives that have ended by then.
    pub ended: f64,
    /// 10, 50 and 90 % of the lives have worn less [m], joint by joint. A life that has ended keeps the wear that it ended with, the
    /// joint that ended it its threshold.
    pub wear: Vec<[f64; 3]>,
}

/// Parts of the lives.
const PARTS: [f64; 3] = [0.1, 0.5, 0.9];

impl LifePaths {
    /// Number of lives that were followed.
    pub fn lives(&self) -> u64 {
        self.lives.len() as u64
    }

    /// Those of other lives too.
    pub(super) fn join(&mut self, others: Self) {
        self.lives.extend(others.lives);
    }

    /// Quantiles at every cycle that is kept, until all lives have ended.
    pub fn spread(&self, joints: &[JointLife]) -> Vec<Spread> {
        let (count, width) = (self.lives.len(), joints.len().max(1));
        let longest = self.lives.values().map(|life| life.cycles).max().unwrap_or(0);
        let at = |index: usize| {
            let cycle = self.every * (index as u64 + 1);
            let ended = self.lives.values().filter(|life| life.cycles <= cycle).count();
            let of = |(at, joint): (usize, &JointLife)| {
                let wear = |life: &LifePath| {
                    let worn = life.wear.get(index * width + at).or_else(|| life.last.get(at));
                    worn.map_or(f64::NAN, |worn| worn.min(joint.threshold))
                };
                let mut sorted: Vec<f64> = self.lives.values().map(wear).collect();
                sorted.sort_unstable_by(f64::total_cmp);
                PARTS.map(|p| sorted_quantile(&sorted, p))
            };
            Spread {
                cycle,
                ended: ended as f64 / count as f64,
                wear: joints.iter().enumerate().map(of).collect(),
            }
        };
        let shown = usize::try_from(longest.div_ceil(self.every)).unwrap_or(MOST);
        (0..shown.min(MOST)).map(at).collect()
    }
}

/// Follows lives while they are lived.
pub(super) struct Follower {
    every: u64,
    lives: Mutex<BTreeMap<u64, LifePath>>,
}

impl Follower {
    /// Of lives that last about so many cycles; some are known.
    pub fn new(cycles: f64, known: BTreeMap<u64, LifePath>) -> Self {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "below the limit on cycles"
        )]
        let cycles = cycles.ceil() as u64;
        Self { every: cycles.div_ceil(PER_LIFE).max(1), lives: Mutex::new(known) }
    }

    /// Hears of a cycle of a life.
    pub fn hear(&self, number: u64, cycle: u64, wear: &[f64]) {
        if number >= FOLLOWED {
            return;
        }
        let mut lives = self.lives.lock().unwrap_or_else(PoisonError::into_inner);
        let life = lives.entry(number).or_default();
        if cycle == 1 {
            // A life may be lived once more.
            life.wear.clear();
        }
        if cycle.is_multiple_of(self.every) && life.wear.len() < MOST * wear.len() {
            life.wear.extend_from_slice(wear);
        }
        wear.clone_into(&mut life.last);
        life.cycles = cycle;
    }

    /// The path of a life.
    pub fn path(&self, number: u64) -> Option<LifePath> {
        self.lives.lock().unwrap_or_else(PoisonError::into_inner).get(&number).cloned()
    }

    /// All of them, when all have ended.
    pub fn finish(self) -> LifePaths {
        let lives = self.lives.into_inner().unwrap_or_else(PoisonError::into_inner);
        LifePaths { every: self.every, lives }
    }
}
