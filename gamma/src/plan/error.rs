//! Why there is no plan. Never knows files.

use thiserror::Error;

use crate::error::LifeError;

/// A plan that cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PlanError {
    /// A question that the law of life has no answer to.
    #[error(transparent)]
    Life(#[from] LifeError),
    /// A planned replacement that is not cheaper than a failure.
    #[error(
        "a planned replacement costs {preventive}, a failure {failure}: replacing in time pays only where a failure costs more; give --failure all that it costs, downtime and damage too"
    )]
    NothingToSave {
        /// Cost of a planned replacement.
        preventive: f64,
        /// Cost of a failure.
        failure: f64,
    },
    /// A failure that nobody notices and that costs nothing while it lasts.
    #[error(
        "a failure that only a look finds must cost something while it lasts: give --downtime a cost per unit of time"
    )]
    FreeDowntime,
    /// Looks that could find nothing.
    #[error(
        "a look tells lives nothing but that a part has failed, and these failures show at once: give --downtime the cost of a unit of time with a failure that nobody has noticed"
    )]
    ShowsAtOnce,
    /// A wear to replace from above that at failure.
    #[error(
        "parts are to be replaced from wear {from} on, and have failed before, at the threshold {failure}: give --replace-from a wear below the threshold"
    )]
    ReplacedTooLate {
        /// Wear from which on parts are to be replaced.
        from: f64,
        /// Wear at failure.
        failure: f64,
    },
    /// No parts in use.
    #[error("spares for 0 parts: give --parts a number of 1 or more")]
    NoParts,
    /// Wear that falls now and then.
    #[error(
        "looks are computed for wear that never falls; by a Wiener process it may fall: fit a Gamma or an inverse Gaussian process, or plan by age alone, without --inspection and --look-at"
    )]
    FallingWear,
    /// Looks that follow each other so fast that a life has too many to count.
    #[error("with a look every {interval}, parts are still in use after {looks} looks: look less often")]
    TooOften {
        /// Time from look to look.
        interval: f64,
        /// Looks that are counted.
        looks: usize,
    },
    /// Units with rates of their own, which a look tells of.
    #[error(
        "units differ in this fit, and one look tells of a unit's own rate too: what that is worth is not computed; leave --look-at out, or fit without --random-effects as if units were alike"
    )]
    UnitsDiffer,
    /// Too many parts or replacements to count.
    #[error(
        "{parts} part(s) with more than {each} replacements of each are too many to count; plan for fewer parts or a shorter time"
    )]
    TooMany {
        /// Parts in use.
        parts: usize,
        /// Replacements of one.
        each: usize,
    },
}
