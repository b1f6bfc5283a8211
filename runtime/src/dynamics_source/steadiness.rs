//! How steady turns are. In: what turns wear. Out: [`Steadiness`]. Never runs anything.

/// How steady the turns were that a revolution was measured by, of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Steadiness {
    /// What the revolution adds to W [m].
    pub wear: f64,
    /// By how much of it the revolution differs from the last turn that settled; nothing if none did.
    pub drift: Option<f64>,
    /// Standard error of the mean over the turns measured, as a part of it: by their scatter and how much a turn takes after the one
    /// before, or for a single one by its difference from the turn before, which has the scatter of two. Nothing if there is one
    /// turn in all.
    pub scatter: Option<f64>,
}

impl Steadiness {
    /// From W per turn [m] of the last turn that settled, and of those measured, as if they had nothing to do with one another.
    pub(super) fn of(before: Option<f64>, turns: &[f64]) -> Self {
        let count = turns.len() as f64;
        let wear = turns.iter().sum::<f64>() / count;
        // What does not wear at all is steady.
        let part = |of: f64| if of == 0.0 { 0.0 } else { of / wear };
        let drift = before.map(|before| part(wear - before));
        let squares: f64 = turns.iter().map(|turn| (turn - wear) * (turn - wear)).sum();
        let scatter = match turns.len() {
            1 => drift.map(|drift| drift.abs() * core::f64::consts::FRAC_1_SQRT_2),
            _ => Some(part(libm::sqrt(squares / (count * (count - 1.0))))),
        };
        Self { wear, drift, scatter }
    }

    /// The same of turns that take after the ones before, as under a load that beats against the turn: their mean is known as well as
    /// that of fewer. By their correlation r over a turn its standard error grows by the root of (1 + r)/(1 - r).
    pub(super) fn of_alike(before: Option<f64>, turns: &[f64]) -> Self {
        let alone = Self::of(before, turns);
        let beside = |turn: &f64| turn - alone.wear;
        let products: f64 = turns.windows(2).map(|pair| beside(&pair[0]) * beside(&pair[1])).sum();
        let squares: f64 = turns.iter().map(|turn| beside(turn) * beside(turn)).sum();
        let correlation = if products > 0.0 { products / squares } else { 0.0 };
        let grown = libm::sqrt((1.0 + correlation) / (1.0 - correlation));
        Self { scatter: alone.scatter.map(|scatter| grown * scatter), ..alone }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_of_a_slow_beat_tell_less_than_as_many_others() {
        let beat: Vec<f64> = (0..20).map(|turn| 1.0 + 0.1 * (0.06 * f64::from(turn)).sin()).collect();
        let mut shuffled = beat.clone();
        shuffled.sort_by_key(|wear| wear.to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let scatter = |turns: &[f64], of: fn(Option<f64>, &[f64]) -> Steadiness| of(None, turns).scatter;
        let [alone, alike] =
            [Steadiness::of, Steadiness::of_alike].map(|of| scatter(&beat, of).expect("turns"));
        assert!(alike > 3.0 * alone, "{alike} {alone}");
        let [alone, alike] =
            [Steadiness::of, Steadiness::of_alike].map(|of| scatter(&shuffled, of).expect("turns"));
        assert!(alike < 1.5 * alone, "{alike} {alone}");
        // Turns that swing from one to the next are not known better for it.
        assert_eq!(
            Steadiness::of_alike(None, &[1.0, 2.0, 1.0, 2.0]),
            Steadiness::of(None, &[1.0, 2.0, 1.0, 2.0])
        );
        let still = Steadiness { wear: 2.0, drift: None, scatter: Some(0.0) };
        assert_eq!(Steadiness::of_alike(None, &[2.0, 2.0, 2.0]), still);
    }

    #[test]
    fn turns_that_differ_say_how_far_their_mean_may_be_off() {
        // 2, 3 and 4: mean 3, standard deviation 1.
        let three = Steadiness::of(Some(2.7), &[2.0, 3.0, 4.0]);
        assert_eq!(three.wear, 3.0);
        assert!((three.drift.expect("a turn before") - 0.1).abs() < 1e-15);
        assert!((three.scatter.expect("three turns") - 1.0 / 3.0_f64.sqrt() / 3.0).abs() < 1e-15);
        let one = Steadiness::of(Some(2.0), &[4.0]);
        assert_eq!(one.drift, Some(0.5));
        assert!((one.scatter.expect("two turns") - 0.5 / 2.0_f64.sqrt()).abs() < 1e-15);
        let alone = Steadiness::of(None, &[4.0]);
        assert_eq!((alone.drift, alone.scatter), (None, None));
        let still = Steadiness { wear: 0.0, drift: Some(0.0), scatter: Some(0.0) };
        assert_eq!(Steadiness::of(Some(0.0), &[0.0, 0.0]), still);
    }
}
