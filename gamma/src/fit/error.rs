//! Why a process cannot be fitted. Never knows files.

use thiserror::Error;

/// Why a fit did not come about.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum FitError {
    /// Wear is an exact function of Lambda: the likelihood grows without end as the scatter vanishes.
    #[error("wear follows Lambda without any scatter, so the scatter of the process has no estimate")]
    NoScatter,
    /// Wear that may fall does not grow on average: the drift has no estimate above 0.
    #[error(
        "wear does not grow on average: its increments sum to 0 or less, so the drift has no estimate above 0"
    )]
    NoGrowth,
    /// Less scatter than a gauge that rounds can tell from none.
    #[error(
        "the gauge rounds so coarsely that wear cannot be told from wear without scatter, so alpha has no finite estimate"
    )]
    ScatterBelowGauge,
    /// Newton's method has not found a maximum.
    #[error("the likelihood has no maximum inside; a parameter runs off")]
    NotConverged,
    /// What the increments say of the exponent or of a covariate's power is less than the rounding of what all say of it.
    #[error(
        "the readings do not tell the exponent, or the power of a covariate, apart from the other parameters"
    )]
    NotTold,
    /// Numbers whose squares and products may be no numbers.
    #[error(
        "wear or exposure grows by less than 1e-100 or more than 1e100 in its unit: no fit of such numbers was found"
    )]
    OutOfRange,
    /// Too few increments.
    #[error("{increments} increments cannot give {parameters} parameters")]
    TooFew {
        /// How many there are.
        increments: usize,
        /// How many parameters are sought.
        parameters: usize,
    },
    /// Hardly any increment that is more than a bound.
    #[error(
        "{increments} increment(s) of known wear beside bounds: two at least are needed to see it scatter"
    )]
    TooFewExact {
        /// How many there are.
        increments: usize,
    },
    /// A gauge's step that is not a positive number.
    #[error("the gauge's resolution must be a positive number, and its error a number of 0 or more")]
    BadResolution,
    /// A step far below the error of the gauge.
    #[error(
        "the gauge's error is more than a hundred times its resolution; state a resolution of a tenth of the error"
    )]
    LargeError,
    /// More readings of a coarse gauge than can be taken together.
    #[error(
        "the gauge is coarse for {readings} readings, whose true wear is sought within its step: at most {most} such readings can be taken together"
    )]
    TooManyWindows {
        /// How many there are.
        readings: usize,
        /// How many there may be.
        most: usize,
    },
    /// A gauge's step for a process that has no use for it.
    #[error("only the Gamma process takes readings as rounded to a step of the gauge")]
    NoResolution,
    /// Units cannot differ in this process.
    #[error("no law is known by which units of this process differ")]
    NoRandomEffect,
    /// Bounds or entries, and readings that are rounded.
    #[error("bounds of wear, and limits that units entered below, are taken of exact readings only")]
    RoundedBounds,
    /// A bound on the way to a reading.
    #[error(
        "a reading below the gauge's range, with a reading after it, has no likelihood in closed form for this process"
    )]
    NoBridge,
    /// Several bounds of a unit whose parameter may have either sign.
    #[error("several bounds of one unit have no likelihood for this process where units differ")]
    ManyBounds,
    /// Sizes that change within a unit whose drift is its own.
    #[error(
        "covariates of size change within a unit: with units that differ only the Gamma process takes that"
    )]
    SizesWithinUnit,
    /// One unit.
    #[error("readings of one unit cannot say how units differ")]
    OneUnit,
}
