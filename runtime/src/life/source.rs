//! Where the coarse scale meets the fine one. Out: the trait and what passes through it.
//! Never knows how a revolution is computed.

use crate::wear::{Observed, Profile};

/// The fine scale: what one settled revolution wears at a given state of wear.
pub trait WearSource {
    /// What the fine scale carries from one measurement to the next: positions, speeds, impact memories. Its default
    /// is that of a mechanism that has not run yet. It is saved with the trajectory, so a measurement must depend on
    /// nothing but the wear and this.
    type State: Clone + Default;
    /// Why a measurement failed.
    type Error;

    /// What one settled revolution wears, per wearing joint in the order given.
    ///
    /// # Errors
    /// If the revolution cannot be computed.
    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<RevolutionWear>, Self::Error>;
}

impl<F: WearSource + ?Sized> WearSource for &mut F {
    type State = F::State;
    type Error = F::Error;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut F::State,
    ) -> Result<Vec<RevolutionWear>, F::Error> {
        (**self).measure(joints, state)
    }
}

/// How worn a joint is, as the fine scale has to know it.
#[derive(Clone, Debug, PartialEq)]
pub struct JointWear {
    /// Radial clearance [m]; with a profile that of the unworn joint.
    pub clearance: f64,
    /// Wear W so far [m]: what a table looks up.
    pub wear: f64,
    /// Depth by bearing angle that is fed back to the local gap; nothing if wear feeds back as one number.
    pub profile: Option<Profile>,
}

/// What one settled revolution did to a joint; a mean over revolutions where one is not enough.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RevolutionWear {
    /// Wear integral S of the revolution [J].
    pub wear_integral: f64,
    /// Depth by the model of the contact area [m].
    pub depth: f64,
    /// Depth gained by the direction of the journal's offset, if asked for: by bearing angle, where the bearing is round.
    pub profile: Option<Profile>,
    /// Mean normal force [N].
    pub mean_force: f64,
    /// Largest normal force [N].
    pub peak_force: f64,
    /// How often contact was lost [1], not whole if it is a mean.
    pub contact_losses: f64,
    /// Part of the revolution without contact, 0 to 1.
    pub separated: f64,
    /// Extremes for the warnings; its depth per cycle is set by the coarse scale.
    pub observed: Observed,
}

impl RevolutionWear {
    /// The first of its numbers that is not finite, by name; depth below zero counts too.
    pub(super) fn flaw(&self) -> Option<(&'static str, f64)> {
        let seen = &self.observed;
        let numbers = [
            ("wear integral", self.wear_integral),
            ("depth", self.depth),
            ("mean force", self.mean_force),
            ("peak force", self.peak_force),
            ("number of contact losses", self.contact_losses),
            ("separated part", self.separated),
            ("pressure", seen.pressure),
            ("pressure times speed", seen.pressure_speed),
            ("half-width of the contact", seen.hertz_half_width),
            ("penetration", seen.penetration),
        ];
        // A largest penetration below zero is that of a joint that never touched.
        let wrong = |name: &str, value: f64| !value.is_finite() || (value < 0.0 && name != "penetration");
        numbers.into_iter().find(|(name, value)| wrong(name, *value)).or_else(|| {
            let depths = self.profile.iter().flat_map(|profile| profile.depths());
            depths.copied().find(|depth| *depth < 0.0).map(|depth| ("depth of the profile", depth))
        })
    }
}
