//! What a contact did in a turn, or on average over several: the one measure of runs, revolutions and cycles.
//! In: numbers of turns. Out: their mean. Never knows where they come from.

use super::limits::Observed;
use super::profile::Profile;
use crate::column::{Column, Quantity};

/// What a contact did in a turn of the turn driver, or in a settled revolution as the mean of several turns.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactMeasure {
    /// Wear integral S = ∫ F_n |v_t| dt [J].
    pub wear_integral: f64,
    /// Depth by the model of the contact area, ∫ k/(H A) F_n |v_t| dt [m]; zero if the joint does not wear.
    pub depth: f64,
    /// Average over time of the normal force [N].
    pub mean_force: f64,
    /// Largest normal force at the end of a step [N].
    pub peak_force: f64,
    /// How often the bodies came apart [1]; not whole if it is a mean.
    pub losses: f64,
    /// Part of the time in which they touched, 0 to 1, by steps that ended in contact.
    pub touching: f64,
    /// Energy lost in damping and friction [J].
    pub loss: f64,
    /// Depth gained by the direction of the journal's offset: by bearing angle, where the bearing is round. Nothing
    /// if the joint keeps no profile.
    pub deposit: Option<Profile>,
    /// Depth that the journal lost, by the direction in its own frame in which it points from the bearing's centre. Nothing if it
    /// does not wear.
    #[cfg_attr(feature = "serde", serde(default))]
    pub journal: Option<Profile>,
    /// Extremes, for warnings of the wear laws; nothing if the joint does not wear.
    pub observed: Option<Observed>,
}

impl ContactMeasure {
    /// Its numbers, as CSV, JSON and text name them.
    pub const COLUMNS: [Quantity<Self>; 7] = [
        (
            Column::new(
                ("wear integral", "S", "J"),
                "Wear integral, of normal force times sliding speed over time",
            ),
            |one| one.wear_integral,
        ),
        (
            Column::new(
                ("depth", "h", "m"),
                "Depth of wear by the contact area; zero if the joint does not wear",
            )
            .detail(),
            |one| one.depth,
        ),
        (Column::new(("mean force", "Fn_mean", "N"), "Normal force on average over time"), |one| {
            one.mean_force
        }),
        (Column::new(("peak force", "Fn_peak", "N"), "Largest normal force at the end of a step"), |one| {
            one.peak_force
        }),
        (
            Column::new(
                ("contact losses", "losses", "1"),
                "How often the bodies came apart; not whole if it is a mean of turns",
            ),
            |one| one.losses,
        ),
        (
            Column::new(("touching part", "touching", "1"), "Part of the time in which they touched, 0 to 1")
                .detail(),
            |one| one.touching,
        ),
        (Column::new(("loss", "E_lost", "J"), "Energy lost in damping and friction").detail(), |one| {
            one.loss
        }),
    ];

    /// What a journal that wears has besides.
    pub const JOURNAL: [Quantity<Self>; 2] = [
        (
            Column::new(
                ("journal depth", "hj_mean", "m"),
                "Depth that the journal lost, mean over its angle",
            ),
            |one| one.journal.as_ref().map_or(0.0, Profile::mean),
        ),
        (
            Column::new(
                ("journal largest depth", "hj_max", "m"),
                "Depth that the journal lost where it lost most",
            ),
            |one| one.journal.as_ref().map_or(0.0, Profile::maximum),
        ),
    ];

    /// Its numbers without profiles and extremes.
    pub fn numbers(&self) -> Self {
        Self { deposit: None, journal: None, observed: None, ..*self }
    }

    /// The same revolution, had it worn this part of what it has.
    pub(crate) fn scale_wear(&mut self, part: f64) {
        self.wear_integral *= part;
        self.depth *= part;
    }

    /// The mean of turns of one joint; extremes are those of all turns.
    pub fn mean(turns: &[&Self]) -> Self {
        let count = turns.len() as f64;
        let mean = |of: fn(&Self) -> f64| turns.iter().map(|turn| of(turn)).sum::<f64>() / count;
        Self {
            wear_integral: mean(|turn| turn.wear_integral),
            depth: mean(|turn| turn.depth),
            mean_force: mean(|turn| turn.mean_force),
            peak_force: turns.iter().map(|turn| turn.peak_force).fold(0.0, f64::max),
            losses: mean(|turn| turn.losses),
            touching: mean(|turn| turn.touching),
            loss: mean(|turn| turn.loss),
            deposit: mean_profile(turns, |turn| turn.deposit.as_ref()),
            journal: mean_profile(turns, |turn| turn.journal.as_ref()),
            observed: turns.iter().filter_map(|turn| turn.observed).reduce(Observed::larger),
        }
    }

    /// The mean of several ways to run, each with its share of the revolutions and of the time; extremes are those of all.
    pub fn mean_by_shares(parts: &[(&Self, f64, f64)]) -> Self {
        let by_revolution =
            |of: fn(&Self) -> f64| parts.iter().map(|(part, share, _)| share * of(part)).sum::<f64>();
        let by_time =
            |of: fn(&Self) -> f64| parts.iter().map(|(part, _, share)| share * of(part)).sum::<f64>();
        let profile = |of: fn(&Self) -> Option<&Profile>| {
            let profiles = parts.iter().map(|(part, share, _)| Some((of(part)?.depths(), *share)));
            profiles.collect::<Option<Vec<_>>>().and_then(|all| {
                let bins = all.first()?.0.len();
                let depth = |bin: usize| all.iter().map(|(depths, share)| share * depths[bin]).sum::<f64>();
                Profile::try_from((0..bins).map(depth).collect::<Vec<_>>()).ok()
            })
        };
        Self {
            wear_integral: by_revolution(|part| part.wear_integral),
            depth: by_revolution(|part| part.depth),
            mean_force: by_time(|part| part.mean_force),
            peak_force: parts.iter().map(|(part, ..)| part.peak_force).fold(0.0, f64::max),
            losses: by_revolution(|part| part.losses),
            touching: by_time(|part| part.touching).min(1.0),
            loss: by_revolution(|part| part.loss),
            deposit: profile(|part| part.deposit.as_ref()),
            journal: profile(|part| part.journal.as_ref()),
            observed: parts.iter().filter_map(|(part, ..)| part.observed).reduce(Observed::larger),
        }
    }

    /// The first of its numbers that is not finite, by name; what is below zero counts too.
    pub(crate) fn flaw(&self) -> Option<(&'static str, f64)> {
        let seen = self.observed.iter().flat_map(|seen| {
            [
                ("pressure", seen.pressure),
                ("pressure times speed", seen.pressure_speed),
                ("half-width of the contact", seen.hertz_half_width),
                ("penetration", seen.penetration),
            ]
        });
        let numbers = Self::COLUMNS.iter().map(|(column, value)| (column.name, value(self))).chain(seen);
        let depths = self.deposit.iter().chain(&self.journal).flat_map(|profile| profile.depths());
        // A largest penetration below zero is that of a joint that never touched; a loss may be rounding.
        let wrong = |name: &str, value: f64| {
            !value.is_finite() || (value < 0.0 && !["penetration", "loss"].contains(&name))
        };
        numbers
            .chain(depths.map(|depth| ("depth of the profile", *depth)))
            .find(|(name, value)| wrong(name, *value))
    }
}

fn mean_profile(turns: &[&ContactMeasure], of: fn(&ContactMeasure) -> Option<&Profile>) -> Option<Profile> {
    let (first, rest) = turns.split_first()?;
    let mut sum = of(first)?.clone();
    for turn in rest {
        let fits = sum.add_depths(of(turn).map_or(&[], Profile::depths), 1.0);
        debug_assert!(fits, "turns of one joint have profiles of one width");
    }
    let count = turns.len() as f64;
    Profile::try_from(sum.depths().iter().map(|depth| depth / count).collect::<Vec<_>>()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn(depth: f64, peak: f64) -> ContactMeasure {
        let mut observed = Observed::nothing(1e-5, 1e-2);
        observed.pressure = peak;
        ContactMeasure {
            wear_integral: 2.0 * depth,
            depth,
            peak_force: peak,
            losses: 3.0,
            touching: 1.0,
            deposit: Profile::try_from(vec![depth; 4]).ok(),
            observed: Some(observed),
            ..ContactMeasure::default()
        }
    }

    #[test]
    fn turns_give_their_mean_and_the_largest_of_their_extremes() {
        let mean = ContactMeasure::mean(&[&turn(1.0, 5.0), &turn(3.0, 4.0)]);
        assert_eq!((mean.depth, mean.wear_integral, mean.losses), (2.0, 4.0, 3.0));
        assert_eq!((mean.peak_force, mean.observed.map(|seen| seen.pressure)), (5.0, Some(5.0)));
        assert_eq!(mean.deposit.expect("a profile").depths(), [2.0; 4]);
    }

    #[test]
    fn columns_are_named_for_every_output() {
        let (force, _) = ContactMeasure::COLUMNS[2];
        let names = [force.key(), force.head(), force.title()];
        assert_eq!(names, ["mean_force_N", "Fn_mean [N]", "mean force [N]"]);
    }
}
