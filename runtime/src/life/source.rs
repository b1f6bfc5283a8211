//! Where the coarse scale meets the fine one. Out: the trait and what passes through it.
//! Never knows how a revolution is computed.

use super::flow::WearFlow;
use super::settings::LifeSettings;
use crate::wear::{ContactMeasure, Profile};

/// The fine scale: what one settled revolution wears at a given state of wear.
pub trait WearSource {
    /// What the fine scale carries from one measurement to the next: positions, speeds, impact memories. Its default
    /// is that of a mechanism that has not run yet. It is saved with the trajectory, so a measurement must depend on
    /// nothing but the wear and this.
    type State: Clone + Default;
    /// Why a measurement failed.
    type Error;

    /// What one settled revolution wears, per wearing joint in the order given; a mean over revolutions where one is
    /// not enough. The depth per cycle of its extremes is set by the coarse scale.
    ///
    /// # Errors
    /// If the revolution cannot be computed.
    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut Self::State,
    ) -> Result<Vec<ContactMeasure>, Self::Error>;

    /// The same at several states of wear, each from a state of its own: side by side, where the fine scale can, in the same bits.
    ///
    /// # Errors
    /// If one of the revolutions cannot be computed.
    fn measure_each(
        &mut self,
        joints: &[Vec<JointWear>],
        states: &mut [Self::State],
    ) -> Result<Vec<Vec<ContactMeasure>>, Self::Error> {
        one_by_one(self, joints, states)
    }

    /// The mean paths of the joints, solved beforehand. Nothing unless what a joint wears depends on its own W alone and nothing
    /// can stop a life before its threshold; lives then go cycle by cycle through [`run_life`](super::run_life).
    fn flow(&self, settings: &LifeSettings) -> Option<WearFlow> {
        let _ = settings;
        None
    }
}

/// Measures at several states of wear, one after the other.
///
/// # Errors
/// Of the first that cannot be measured.
pub fn one_by_one<F: WearSource + ?Sized>(
    source: &mut F,
    joints: &[Vec<JointWear>],
    states: &mut [F::State],
) -> Result<Vec<Vec<ContactMeasure>>, F::Error> {
    joints.iter().zip(states).map(|(joints, state)| source.measure(joints, state)).collect()
}

impl<F: WearSource + ?Sized> WearSource for &mut F {
    type State = F::State;
    type Error = F::Error;

    fn measure(
        &mut self,
        joints: &[JointWear],
        state: &mut F::State,
    ) -> Result<Vec<ContactMeasure>, F::Error> {
        (**self).measure(joints, state)
    }

    fn measure_each(
        &mut self,
        joints: &[Vec<JointWear>],
        states: &mut [F::State],
    ) -> Result<Vec<Vec<ContactMeasure>>, F::Error> {
        (**self).measure_each(joints, states)
    }

    fn flow(&self, settings: &LifeSettings) -> Option<WearFlow> {
        (**self).flow(settings)
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
    /// The same of the journal, by its own angle.
    pub journal: Option<Profile>,
}
