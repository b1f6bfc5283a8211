//! How revolutions are run that a measurement is made of. In: what a mechanism wears. Out: settings. Never knows its motion.

use crate::description::Description;
use crate::simulate::Integrator;

/// Steps whose wear is off by this part leave so many times as much to settling, ...
const PER_TOLERANCE: f64 = 10.0;
/// ... at most this.
const MOST_UNSETTLED: f64 = 1e-4;
/// Where steps have one length, nobody says how exact they are.
const UNSETTLED: f64 = 1e-5;
/// Accuracy of the wear integral where a worn profile is fed back: its journal rolls over the edges of bins, which costs three times
/// the steps at 1e-6, and the steps of a life are as coarse as 1e-4 then.
const OF_PROFILES: f64 = 1e-5;

/// How revolutions are run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevolutionSettings {
    /// The method.
    pub integrator: Integrator,
    /// Turns after each change of wear before one is measured. Nothing: until later turns would wear alike.
    pub settle: Option<u32>,
    /// Turns whose mean is taken, at least 1. One is enough for a periodic motion; one that chatters needs 20 or more.
    pub average: u32,
}

impl Default for RevolutionSettings {
    /// Adaptive Runge-Kutta, until later turns would wear alike.
    ///
    /// The wear of a revolution is off by 1e-6 to 1e-5 of itself then in the case study, the more the looser the joint has
    /// become; its life by 3e-6 of itself.
    fn default() -> Self {
        Self { integrator: Integrator::Rk43 { tolerance: 1e-6, max_step: None }, settle: None, average: 1 }
    }
}

impl RevolutionSettings {
    /// Those that suit lives of a mechanism: the default; where a worn profile is fed back, revolutions to 1e-5 of their wear.
    pub fn of(description: &Description) -> Self {
        let integrator = Integrator::Rk43 { tolerance: OF_PROFILES, max_step: None };
        if description.feeds_profiles_back() {
            Self { integrator, ..Self::default() }
        } else {
            Self::default()
        }
    }

    /// Turns have settled where later ones would differ by no more than this part of their wear.
    pub(super) fn settled(&self) -> f64 {
        let by_tolerance = |tolerance: f64| (PER_TOLERANCE * tolerance).min(MOST_UNSETTLED);
        self.integrator.tolerance().map_or(UNSETTLED, by_tolerance)
    }
}
