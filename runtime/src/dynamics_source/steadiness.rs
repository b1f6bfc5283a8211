//! How steady turns are. In: what turns wear. Out: [`Steadiness`]. Never runs anything.

/// How steady the turns were that a revolution was measured by, of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Steadiness {
    /// What the revolution adds to W [m].
    pub wear: f64,
    /// By how much of it the revolution differs from the last turn that settled; nothing if none did.
    pub drift: Option<f64>,
    /// Standard error of the mean over the turns measured, as a part of it: by their scatter, or for a single one by its
    /// difference from the turn before, which has the scatter of two. Nothing if there is one turn in all.
    pub scatter: Option<f64>,
}

impl Steadiness {
    /// From W per turn [m] of the last turn that settled, and of those measured.
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
}

#[cfg(test)]
mod tests {
    use super::*;

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
