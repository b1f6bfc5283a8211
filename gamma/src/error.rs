//! What can be wrong with a question about life. Never knows files.

/// Why a life cannot be told. Every message names the value and the cure.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LifeError {
    /// A number that must be positive and finite is not.
    #[error("{what} is {value}: a positive, finite number is needed")]
    NotPositive {
        /// What the number stands for.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// A number that must be finite and not negative is not.
    #[error("{what} is {value}: a finite number of zero or more is needed")]
    Negative {
        /// What the number stands for.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// There is nothing left to wear.
    #[error(
        "the present wear {current} has reached the threshold {threshold}: the joint has failed, or the threshold is \
         in another unit than the wear"
    )]
    Failed {
        /// Wear at failure.
        threshold: f64,
        /// Wear now.
        current: f64,
    },
    /// A probability is not between 0 and 1.
    #[error("{value} is no probability: give a number between 0 and 1, both excluded")]
    Probability {
        /// The number.
        value: f64,
    },
    /// A table of exposure over time is too short.
    #[error("the table of exposure has {rows} rows: at least two are needed")]
    ShortTable {
        /// Rows it has.
        rows: usize,
    },
    /// A table of exposure over time does not rise.
    #[error(
        "row {row} of the table of exposure: {what} {value} does not exceed the {before} of the row before; sort the rows by time"
    )]
    TableOrder {
        /// Row, from 1.
        row: usize,
        /// `time` or `exposure`.
        what: &'static str,
        /// Value of the row.
        value: f64,
        /// Value of the row before.
        before: f64,
    },
    /// The covariance is no covariance.
    #[error(
        "the covariance of the parameters is not usable ({reason}): give a symmetric, positive semi-definite matrix of {size} rows"
    )]
    Covariance {
        /// What is wrong with it.
        reason: &'static str,
        /// Rows it needs: one for each parameter.
        size: usize,
    },
    /// Present wear needs the present exposure when Lambda is curved.
    #[error(
        "with an exponent other than 1 the wear to come depends on the exposure so far: give the present exposure too"
    )]
    ExposureMissing,
    /// Too little is known for a mean: the tail of the predictive law is too heavy.
    #[error(
        "with {increments} increments and a flat prior the mean and standard deviation are not finite: use quantiles, a fit as prior, or {needed} increments"
    )]
    HeavyTail {
        /// Increments known.
        increments: usize,
        /// Increments a finite variance needs.
        needed: usize,
    },
    /// An unknown exponent may be so small that lives have no mean.
    #[error(
        "with an unknown exponent and a flat prior the mean and standard deviation are not finite: use quantiles, or a fit as prior"
    )]
    HeavyExponent,
    /// An unknown drift may be so slow that lives have no mean.
    #[error(
        "with a flat prior the drift of a Wiener process may be near zero, so mean and standard deviation are not finite: use quantiles, or a fit as prior"
    )]
    HeavyDrift,
    /// The drift of a unit may be so slow, or below zero, that lives have no mean.
    #[error(
        "the drift of a Wiener process that differs between units by a normal law may be near zero, so mean and standard deviation are not finite: use quantiles, or another process"
    )]
    DriftOfUnits,
    /// Part of the lives never end.
    #[error(
        "no time is known by which the part {p} has failed: the part {ever} ever fails, as drifts of units may be below zero; fit another process"
    )]
    Never {
        /// The part asked for.
        p: f64,
        /// The part that ever fails.
        ever: f64,
    },
    /// Numbers of a joint whose life is none.
    #[error(
        "the life comes out as {typical}, beyond what can be computed: check the threshold, the exposure until now, the rate, and the units of all three"
    )]
    OutOfRange {
        /// What comes out.
        typical: f64,
    },
    /// A time beyond all numbers.
    #[error(
        "the time by which the part {p} has failed is beyond all numbers: too little is known of the exponent, which may be near zero; give more readings, or take a fit as prior"
    )]
    Endless {
        /// The part asked for.
        p: f64,
    },
    /// The readings of a unit say that it does not wear.
    #[error(
        "by its readings the drift of the unit is not above zero, so nothing is known of when it fails: fit another process, or read it again later"
    )]
    UnitStandsStill,
    /// No law is known by which units differ.
    #[error("no law is known by which units of the {process} process differ")]
    NoRandomEffect {
        /// The process.
        process: &'static str,
    },
    /// A shared factor that is near zero too often for a mean.
    #[error(
        "a Gamma factor of coefficient of variation {cov} is near zero so often that mean or standard deviation are not finite: below {below:.3} they are; use quantiles, or a lognormal factor"
    )]
    HeavyFactor {
        /// Its coefficient of variation.
        cov: f64,
        /// Where a finite variance begins.
        below: f64,
    },
    /// An integral over a reliability is outside of the bounds that a falling function has.
    #[error(
        "the {what} of the life cannot be computed: its quadrature fails the check against bounds by steps; use the quantiles, and report the parameters"
    )]
    Moments {
        /// `mean` or `variance`.
        what: &'static str,
    },
    /// Statistics of too few lives.
    #[error("{lives} lives: at least two are needed for a standard deviation")]
    FewLives {
        /// Lives given.
        lives: usize,
    },
    /// A life among the lives is no number.
    #[error(
        "life {row} is {value}: lives are positive, finite numbers; leave out trajectories that did not fail only with a censored estimate"
    )]
    Life {
        /// Place in the list, from 1.
        row: usize,
        /// The value.
        value: f64,
    },
    /// A range of a catalogue that is none.
    #[error(
        "{from} to {to} is no range of wear per unit of exposure: give two positive numbers, the smaller one first"
    )]
    CatalogueRange {
        /// Its begin.
        from: f64,
        /// Its end.
        to: f64,
    },
    /// No part gets as old as one is said to be.
    #[error(
        "by the fit fewer than one part in 1e12 goes on for {age} without failing: check the time, its unit and the rate, or fit again"
    )]
    NoneSurvives {
        /// The time without failure.
        age: f64,
    },
    /// A time span that ends before it begins.
    #[error(
        "a mission from {from} to {to} does not end after it begins: give times from now on, the later one second"
    )]
    Span {
        /// Its begin.
        from: f64,
        /// Its end.
        to: f64,
    },
    /// A system without members.
    #[error("a system needs at least one wearing joint")]
    NoMember,
}

/// Refuses what is not positive and finite.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<f64, LifeError> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(LifeError::NotPositive { what, value }) }
}

/// Refuses what is not between 0 and 1, both excluded.
pub(crate) fn probability(value: f64) -> Result<f64, LifeError> {
    if value > 0.0 && value < 1.0 { Ok(value) } else { Err(LifeError::Probability { value }) }
}

/// Refuses what is negative or not finite.
pub(crate) fn non_negative(what: &'static str, value: f64) -> Result<f64, LifeError> {
    if value.is_finite() && value >= 0.0 { Ok(value) } else { Err(LifeError::Negative { what, value }) }
}
