//! How worn a joint is, between two cycles.

use crate::wear::Profile;

/// How worn a joint is.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WearState {
    /// Clearance [m]; with feedback by profile that of the unworn joint.
    pub clearance: f64,
    /// Wear W [m].
    pub wear: f64,
    /// Sum Lambda of the mean increments [m].
    pub exposure: f64,
    /// Estimated error of the life by the wear steps [cycles], summed over all steps.
    pub error: f64,
    /// Depth by bearing angle, if it is kept.
    pub profile: Option<Profile>,
    /// Depth of the journal by its own angle, if it wears.
    #[cfg_attr(feature = "serde", serde(default))]
    pub journal: Option<Profile>,
    /// Half-width of its contact in the revolutions measured last, as an angle [rad]; zero if unknown. It moves nothing.
    #[cfg_attr(feature = "serde", serde(default))]
    pub half_angle: f64,
}
