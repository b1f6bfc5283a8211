//! What can be wrong with a beam.

use thiserror::Error;

/// Why a beam has no modes.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BeamError {
    /// A beam needs a segment.
    #[error("the beam has no segment")]
    NoSegment,
    /// A number that must be positive and finite is not.
    #[error("{what} of segment {segment} must be positive and finite, not {value}")]
    NotPositive {
        /// Which number.
        what: &'static str,
        /// Index of the segment, from 0.
        segment: usize,
        /// Its value, SI.
        value: f64,
    },
    /// Poisson's ratio outside -1 to 0.5.
    #[error("Poisson's ratio of segment {segment} must lie between -1 and 0.5, not {value}")]
    PoissonRatio {
        /// Index of the segment, from 0.
        segment: usize,
        /// Its value.
        value: f64,
    },
    /// A tube whose bore is not smaller than its outside.
    #[error("the bore of segment {segment} must be smaller than its outer radius")]
    Bore {
        /// Index of the segment, from 0.
        segment: usize,
    },
    /// Shear deformation was asked for on a section that does not say how it shears.
    #[error("segment {segment} needs shear coefficients for Timoshenko's theory")]
    NoShearCoefficient {
        /// Index of the segment, from 0.
        segment: usize,
    },
    /// A concentrated mass that no body can have.
    #[error("concentrated mass {index} must be positive, with moments of inertia of a real body")]
    ConcentratedMass {
        /// Index of the concentrated mass, from 0.
        index: usize,
    },
    /// A place outside the beam.
    #[error("x = {x} m lies outside the beam, which ends at {length} m")]
    Outside {
        /// The place [m].
        x: f64,
        /// Length of the beam [m].
        length: f64,
    },
    /// The two held places of a chord frame coincide, or attachments are not in rising order.
    #[error("held places must lie apart, in rising order")]
    HeldTogether,
    /// Fewer than two attachments: no chord.
    #[error("a chord frame needs two attachments")]
    NoChord,
    /// A damping ratio below zero or not finite.
    #[error("the damping ratio must not be negative, and finite, not {value}")]
    DampingRatio {
        /// The ratio.
        value: f64,
    },
    /// More modes than one plane is ever resolved for.
    #[error("{asked} modes are more than the {limit} a family may have")]
    TooManyModes {
        /// Modes asked for.
        asked: usize,
        /// The limit.
        limit: usize,
    },
    /// The stiffness or mass matrix lost its definiteness to rounding: proportions beyond double precision.
    #[error("the proportions of the beam are beyond double precision")]
    Extreme,
}
