//! A joint over its life. In: its description. Out: what its wear is, and how an increment changes it. Never knows the fine scale.

use super::settings_error::SettingsError;
use super::worn::WearState;
use crate::contact::{OutOfRange, positive};
use crate::description::Description;
use crate::tables::{ContactInfo, WearInfo};
use crate::wear::{ContactMeasure, Limits, Measure, Profile, ScalarFeedback};

/// Where bush and journal both wear, one wears on when the other has opened the gap by this part of the clearance ...
const OPENED_AT_ONCE: f64 = 0.005;
/// ... but in no more parts than this.
const MOST_PARTS: f64 = 1024.0;

/// What counts as the wear W of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum WearOf {
    /// The depth by the model of the contact area.
    Depth,
    /// The mean or maximum of the depth by bearing angle.
    Profile(Measure),
}

impl WearOf {
    /// As a description has it: the mean or maximum of the profile if it says so or the profile feeds back (then the mean),
    /// else the depth by the model of the area.
    pub fn described(wear: &WearInfo) -> Self {
        match wear.measure {
            Some(measure) => Self::Profile(measure),
            None if wear.profile => Self::Profile(Measure::Mean),
            None => Self::Depth,
        }
    }

    /// What a revolution adds to the W of an unworn joint [m].
    pub fn of(self, measured: &ContactMeasure) -> f64 {
        let bush = match (self, &measured.deposit) {
            (Self::Profile(measure), Some(profile)) => measure.of(profile.depths()),
            _ => measured.depth,
        };
        measured.journal.as_ref().map_or(bush, |journal| bush + self.of_journal(journal))
    }

    /// What a journal has in W [m]: its contact runs round, so that by the depth of the area its mean counts.
    fn of_journal(self, journal: &Profile) -> f64 {
        match self {
            Self::Profile(measure) => measure.of(journal.depths()),
            Self::Depth => journal.mean(),
        }
    }
}

/// What wear does to the geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Feedback {
    /// The clearance grows: c_(n+1) = c_n + gamma dW_n.
    Scalar(ScalarFeedback),
    /// The gap grows where the profile says so.
    Profile,
}

/// A wearing joint over its life. SI.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct JointLife {
    /// Its name.
    pub joint: String,
    /// Radius of the journal or ball [m].
    pub journal_radius: f64,
    /// Clearance c0 of the unworn joint [m].
    pub clearance: f64,
    /// Wear `W_crit` at which it has failed [m].
    pub threshold: f64,
    /// Revolutions that one cycle stands for.
    pub revolutions_per_cycle: f64,
    /// What W is.
    pub wear: WearOf,
    /// What W does.
    pub feedback: Feedback,
    /// Bins of the profile to keep; nothing if none is kept.
    pub bins: Option<usize>,
    /// Bins of the journal's profile; nothing if it does not wear.
    #[cfg_attr(feature = "serde", serde(default))]
    pub journal_bins: Option<usize>,
    /// Where the models end.
    pub limits: Limits,
}

impl JointLife {
    /// A joint of a description that wears, its journal included, by its index among those with clearance; nothing if it does not
    /// wear.
    ///
    /// # Errors
    /// If a number of the joint is out of range.
    pub fn of_joint(
        description: &Description,
        contact: usize,
        clearance: f64,
    ) -> Result<Option<Self>, SettingsError> {
        let Some(info) = description.contacts.get(contact) else { return Ok(None) };
        let bins = info.wear.map(|wear| wear.bins).filter(|_| description.journal_ratio(contact).is_some());
        let lives = Self::of_contact(info, clearance)?.map(|lives| Self { journal_bins: bins, ..lives });
        lives.as_ref().map_or(Ok(()), Self::check)?;
        Ok(lives)
    }

    /// The joint of a description that wears, its bush alone, with clearance c0 [m]; nothing if it does not wear.
    ///
    /// # Errors
    /// If a number of the joint is out of range.
    pub fn of_contact(contact: &ContactInfo, clearance: f64) -> Result<Option<Self>, SettingsError> {
        let Some(wear) = contact.wear else { return Ok(None) };
        let joint = contact.joint.to_string();
        let feedback = if wear.profile {
            Feedback::Profile
        } else {
            let wrong = |reason| SettingsError::Joint { joint: joint.clone(), reason };
            Feedback::Scalar(ScalarFeedback::new(wear.feedback).map_err(wrong)?)
        };
        let lives = Self {
            joint,
            journal_radius: contact.journal_radius,
            clearance,
            threshold: wear.threshold,
            revolutions_per_cycle: wear.revolutions_per_cycle,
            wear: WearOf::described(&wear),
            feedback,
            bins: wear.keeps_profile().then_some(wear.bins),
            journal_bins: None,
            limits: Limits { hardness: wear.hardness, pressure_speed: wear.pressure_speed },
        };
        lives.check()?;
        Ok(Some(lives))
    }

    /// Whether its numbers make sense.
    pub(super) fn check(&self) -> Result<(), SettingsError> {
        let numbers = [
            ("the journal radius", self.journal_radius),
            ("the clearance", self.clearance),
            ("the wear threshold", self.threshold),
            ("revolutions_per_cycle", self.revolutions_per_cycle),
        ];
        let wrong = |reason| SettingsError::Joint { joint: self.joint.clone(), reason };
        for (name, value) in numbers {
            positive(name, value).map_err(wrong)?;
        }
        match (self.bins.or(self.journal_bins), self.bins) {
            (Some(bins), _) if bins < Profile::FEWEST_BINS => {
                let (name, need) = ("the number of bins", "4 or more");
                Err(wrong(OutOfRange { name, value: bins as f64, need }))
            }
            (_, None) if self.wear != WearOf::Depth || self.feedback == Feedback::Profile => {
                Err(SettingsError::NoProfile { joint: self.joint.clone() })
            }
            _ => Ok(()),
        }
    }

    /// Length of the joint's increments: the depth, then the bins of the bush, then those of the journal.
    pub(super) fn width(&self) -> usize {
        1 + self.bins.unwrap_or(0) + self.journal_bins.unwrap_or(0)
    }

    /// gamma [1], zero if only the profile feeds back.
    pub fn gamma(&self) -> f64 {
        match self.feedback {
            Feedback::Scalar(feedback) => feedback.gamma(),
            Feedback::Profile => 0.0,
        }
    }

    /// The joint after `factor` times a mean increment (see [`Self::width`]).
    pub(super) fn after(&self, state: &WearState, increment: &[f64], factor: f64) -> WearState {
        let (bush, pin) = increment[1..].split_at(self.bins.unwrap_or(0));
        let (mut profile, mut journal) = (state.profile.clone(), state.journal.clone());
        let fits = match self.feedback {
            Feedback::Scalar(_) => {
                let add = |(worn, increment): (&mut Option<Profile>, &[f64])| {
                    worn.as_mut().is_none_or(|worn| worn.add_depths(increment, factor))
                };
                [(&mut profile, bush), (&mut journal, pin)].map(add) == [true; 2]
            }
            Feedback::Profile => {
                wear_in_both([&mut profile, &mut journal], [bush, pin], factor, state.clearance)
            }
        };
        debug_assert!(fits, "increments are as wide as the joint says");
        let of_journal =
            |journal: &Option<Profile>| journal.as_ref().map(|journal| self.wear.of_journal(journal));
        let wear = match (self.wear, &profile) {
            (WearOf::Profile(measure), Some(profile)) => {
                let bush = measure.of(profile.depths());
                of_journal(&journal).map_or(bush, |journal| bush + journal)
            }
            _ => {
                let bush = state.wear + factor * increment[0];
                let gained = of_journal(&journal).zip(of_journal(&state.journal));
                gained.map_or(bush, |(after, before)| bush + (after - before))
            }
        };
        let clearance = match self.feedback {
            Feedback::Scalar(feedback) => feedback.next_clearance(state.clearance, wear - state.wear),
            Feedback::Profile => state.clearance,
        };
        WearState { clearance, wear, profile, journal, ..*state }
    }

    /// The part of an increment that W is made of.
    pub(super) fn decisive<'i>(&self, increment: &'i [f64]) -> &'i [f64] {
        match self.wear {
            WearOf::Depth if self.journal_bins.is_none() => &increment[..1],
            WearOf::Depth => increment,
            WearOf::Profile(_) => &increment[1..],
        }
    }
}

/// Wears bush and journal, those that are kept, by `factor` times their increments. Each makes room for the other, to which it is
/// round, as it passes all its places: where both wear they do so in turns, in parts that open the gap by little.
fn wear_in_both(
    worn: [&mut Option<Profile>; 2],
    increments: [&[f64]; 2],
    factor: f64,
    clearance: f64,
) -> bool {
    let opened: f64 = increments.map(|increment| Measure::Mean.of(increment)).iter().sum();
    let parts = if worn.iter().all(|surface| surface.is_some()) {
        (factor * opened / (OPENED_AT_ONCE * clearance)).ceil().clamp(1.0, MOST_PARTS)
    } else {
        1.0
    };
    let mut fits = true;
    for _ in 0..parts as usize {
        for (surface, increment) in increments.into_iter().enumerate() {
            let room = worn[1 - surface].as_ref().map_or(0.0, Profile::mean);
            if let Some(own) = worn[surface].as_mut() {
                fits &= own.wear_in(increment, factor / parts, clearance + room);
            }
        }
    }
    fits
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Restitution, Stiffness};
    use crate::wear::Area;

    fn contact(wear: Option<WearInfo>) -> ContactInfo {
        ContactInfo {
            joint: "R1".into(),
            ball: false,
            journal_radius: 0.01,
            length: 0.02,
            modulus: 115e9,
            stiffness: Stiffness::Hertz { modulus: 115e9 },
            law: Restitution::LankaraniNikravesh,
            restitution: 0.9,
            exponent: 1.5,
            impact_speed_floor: 1e-3,
            friction: None,
            wear,
        }
    }

    const WEAR: WearInfo = WearInfo {
        coefficient: 1e-8,
        hardness: 3.5e9,
        area: Area::Hertz,
        measure: None,
        feedback: 0.1,
        profile: false,
        bins: 72,
        threshold: 80e-6,
        revolutions_per_cycle: 1e7,
        pressure_speed: Some(2e6),
        scatter: None,
        cycle_variation: None,
    };

    #[test]
    fn a_described_joint_lives_as_its_description_says() {
        let of = |wear| JointLife::of_contact(&contact(wear), 1e-5);
        assert_eq!(of(None), Ok(None));
        let scalar = of(Some(WEAR)).unwrap().unwrap();
        assert_eq!((scalar.wear, scalar.bins, scalar.gamma()), (WearOf::Depth, None, 0.1));
        assert_eq!((scalar.clearance, scalar.threshold, scalar.revolutions_per_cycle), (1e-5, 80e-6, 1e7));
        assert_eq!(scalar.limits, Limits { hardness: 3.5e9, pressure_speed: Some(2e6) });
        let profile = of(Some(WearInfo { profile: true, ..WEAR })).unwrap().unwrap();
        assert_eq!((profile.wear, profile.bins), (WearOf::Profile(Measure::Mean), Some(72)));
        assert_eq!(profile.feedback, Feedback::Profile);
        // The deepest place decides, the clearance follows it all round.
        let deepest = of(Some(WearInfo { measure: Some(Measure::Maximum), ..WEAR })).unwrap().unwrap();
        assert_eq!((deepest.wear, deepest.bins), (WearOf::Profile(Measure::Maximum), Some(72)));
        assert_eq!(deepest.gamma(), 0.1);
        for wrong in [WearInfo { feedback: -1.0, ..WEAR }, WearInfo { threshold: 0.0, ..WEAR }] {
            assert!(matches!(of(Some(wrong)), Err(SettingsError::Joint { .. })));
        }
    }

    #[test]
    fn a_journal_wears_beside_its_bush_and_both_open_the_clearance() {
        let of = |measure, profile, increment: &[f64]| {
            let wear = WearInfo { measure, profile, bins: 4, ..WEAR };
            let lives = JointLife::of_contact(&contact(Some(wear)), 1e-5).unwrap().unwrap();
            let lives = JointLife { journal_bins: Some(4), ..lives };
            lives.check().expect("a profile of each");
            let unworn = |bins: usize| Profile::unworn(bins).ok();
            let (exposure, error) = (0.0, 0.0);
            let start = WearState {
                clearance: 1e-5,
                wear: 0.0,
                exposure,
                error,
                profile: lives.bins.and_then(unworn),
                journal: unworn(4),
                half_angle: 0.0,
            };
            lives.after(&start, increment, 2.0)
        };
        let both = [7e-7, 1e-7, 0.0, 0.0, 3e-7, 1e-7, 2e-7, 2e-7, 1e-7];
        // Twice the increments: means of 2e-7 and 3e-7, largest depths of 6e-7 and 4e-7; gamma is 0.1. A few roundings.
        for (measure, expected) in [(Measure::Mean, 5e-7), (Measure::Maximum, 1e-6)] {
            let after = of(Some(measure), false, &both);
            assert!((after.wear / expected - 1.0).abs() < 1e-14, "{after:?}");
            assert!((after.clearance / (1e-5 + 0.1 * expected) - 1.0).abs() < 1e-15);
        }
        // By the depth of the area: 1.4e-6 and the journal's mean.
        let after = of(None, false, &[7e-7, 1e-7, 2e-7, 2e-7, 1e-7]);
        assert!((after.wear / 1.7e-6 - 1.0).abs() < 1e-14 && after.profile.is_none(), "{after:?}");
        // Fed back by angle, the volumes of both stay, and the clearance of the round bearing.
        let after = of(None, true, &both);
        let mean = |profile: &Option<Profile>| profile.as_ref().map_or(0.0, Profile::mean);
        assert!((mean(&after.profile) / 2e-7 - 1.0).abs() < 1e-14);
        assert!((mean(&after.journal) / 3e-7 - 1.0).abs() < 1e-14);
        assert_eq!(after.clearance, 1e-5);
    }
}
