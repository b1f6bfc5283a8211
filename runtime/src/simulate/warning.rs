//! What makes the numbers of a run doubtful, as data. In: what a run met. Out: [`RunWarning`]s. Never stops anything.

use std::f64::consts::PI;
use std::fmt;

use super::settings::Integrator;

/// Something about a run that makes its numbers doubtful. Nothing is stopped for it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum RunWarning {
    /// The steps are long against the oscillation of a contact.
    StepTooCoarse {
        /// The joint.
        joint: String,
        /// Longest step taken [s].
        step: f64,
        /// Largest angular frequency of the contact, sqrt(k/m) [rad/s].
        frequency: f64,
        /// Step times frequency up to which the method is accurate.
        accurate: f64,
        /// Step times frequency up to which it is stable at all.
        stable: f64,
    },
    /// A contact is pressed in by more than its clearance.
    DeepContact {
        /// The joint.
        joint: String,
        /// Time of the largest depth [s].
        t: f64,
        /// That depth [m].
        penetration: f64,
        /// Radial clearance [m].
        clearance: f64,
    },
    /// A flexible body bends further than linear shapes are good for.
    BentFar {
        /// The body.
        body: String,
        /// Time of the largest deflection [s].
        t: f64,
        /// That deflection [m].
        deflection: f64,
        /// Length of the body [m].
        length: f64,
    },
    /// The energy balance does not close.
    EnergyOff {
        /// Largest error of the balance [J].
        error: f64,
        /// Energy that went through [J].
        throughput: f64,
    },
    /// An angle is so large that rounding shows in where it stands in its turn.
    AngleRounded {
        /// Its coordinate, or its driven joint.
        angle: String,
        /// The angle at the end [rad].
        reached: f64,
        /// Its last place there [rad].
        rounding: f64,
    },
    /// The motion passes a singular position in which forces grow without bounds.
    ForcesUnbounded {
        /// When rows or steps met it first [s].
        t: f64,
        /// Columns that hold only what is left of such a force there.
        columns: Vec<String>,
    },
    /// The mechanism is in a singular position that its motion does not pass through: at a dead point, or at rest.
    ForcesUnknown {
        /// When rows or steps met it first [s].
        t: f64,
        /// Columns that the loops leave open there.
        columns: Vec<String>,
    },
    /// Rows hold a larger force than the steps met, by which peaks are told.
    PeakBetween {
        /// The joint.
        joint: String,
        /// Time of the row [s].
        t: f64,
        /// Its force [N].
        force: f64,
        /// The peak by the steps [N].
        peak: f64,
    },
    /// A journal does not run steadily, and leaves that so slowly that turns do not show where it gets to.
    GrowsSlowly {
        /// Turns in which a swing grows by a factor e.
        turns: f64,
        /// Turns that were run before one was measured.
        ran: u32,
    },
    /// The bodies were apart for most of a turn.
    ContactLost {
        /// The joint.
        joint: String,
        /// The turn in which contact was rarest, counted from 1.
        turn: u64,
        /// Part of its time in which the bodies touched.
        touching_part: f64,
    },
}

impl fmt::Display for RunWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StepTooCoarse { joint, step, frequency, accurate, stable } => {
                let what = if step * frequency > *stable { "unstable" } else { "inaccurate" };
                write!(
                    f,
                    "joint `{joint}`: steps of {step:.3e} s are {what} for a contact of {:.4} kHz; take {:.2e} s \
                     or less",
                    frequency / (2.0 * PI) * 1e-3,
                    accurate / frequency
                )
            }
            Self::DeepContact { joint, t, penetration, clearance } => write!(
                f,
                "joint `{joint}` is pressed in by {penetration:.3e} m at t = {t:.6} s, more than its clearance of \
                 {clearance:.3e} m: laws of contact hold for small depths; check loads and stiffness"
            ),
            Self::BentFar { body, t, deflection, length } => write!(
                f,
                "`{body}` bends by {deflection:.3e} m at t = {t:.6} s, {:.0} % of its length of {length:.3e} m: linear shapes (`order = 1`) \
                 hold for small deflections; take `order = 2`, or a stiffer section",
                100.0 * deflection / length
            ),
            Self::EnergyOff { error, throughput } => write!(
                f,
                "the energy balance is off by {error:.3e} J while {throughput:.3e} J went through ({:.1} %); shorten \
                 the step or tighten the tolerance",
                100.0 * error / throughput
            ),
            Self::AngleRounded { angle, reached, rounding } => write!(
                f,
                "`{angle}` reaches {reached:.3e} rad, where its last place is {rounding:.1e} rad: forces and all else that goes \
                 with the place in its turn are known no better; check its speed, or run fewer turns"
            ),
            Self::ForcesUnbounded { t, columns } => write!(
                f,
                "at t = {t:.6} s the mechanism is in a singular position, where {} without bounds: its rows leave that \
                 part out, and peaks depend on where steps fall; change a length, or add a link that holds the loop there",
                listed(columns, ["grows", "grow"])
            ),
            Self::ForcesUnknown { t, columns } => write!(
                f,
                "at t = {t:.6} s the mechanism stands in a singular position, at rest or at a dead point: the loops leave open \
                 how large {} there, and rows hold the smallest forces that fit; let it stop a little beside it",
                listed(columns, ["is", "are"])
            ),
            Self::PeakBetween { joint, t, force, peak } => write!(
                f,
                "joint `{joint}` has a force of {force:.4e} N in the row at t = {t:.6} s and a peak of {peak:.4e} N by the steps: it grows \
                 and falls faster than they are long, as near a position in which its reactions are not unique; `check` lists those"
            ),
            Self::GrowsSlowly { turns, ran } => write!(
                f,
                "journals do not run steadily here: a small swing grows, by a factor e in {turns:.0} turns, and after the {ran} turns \
                 that were run it may still grow; see where it gets to by a longer `--settle`"
            ),
            Self::ContactLost { joint, turn, touching_part } => write!(
                f,
                "joint `{joint}` is without contact for {:.1} % of turn {turn}; forces and wear are those of \
                 impacts: drive it slower, or check load and clearance",
                100.0 * (1.0 - touching_part)
            ),
        }
    }
}

/// Rounding of an angle [rad] from which it draws a warning: ten times the tolerance that runs have unless told otherwise.
const ANGLE_DOUBTFUL: f64 = 1e-8;

/// The warning for the largest of some angles [rad], if it needs one.
pub(super) fn rounded_angle<'a>(angles: impl Iterator<Item = (&'a str, f64)>) -> Option<RunWarning> {
    let (angle, reached) = angles.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let rounding = f64::EPSILON * reached.abs();
    let warning = RunWarning::AngleRounded { angle: angle.to_owned(), reached, rounding };
    (rounding > ANGLE_DOUBTFUL).then_some(warning)
}

/// Names of columns are told up to this number.
const TOLD: usize = 4;

/// Columns and their verb, for one and for several.
fn listed(columns: &[String], [one, several]: [&str; 2]) -> String {
    let told = columns.iter().take(TOLD).map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match columns.len().saturating_sub(TOLD) {
        0 if columns.len() == 1 => format!("{told} {one}"),
        0 => format!("{told} {several}"),
        more => format!("{told} and {more} more columns {several}"),
    }
}

/// Step times contact frequency up to which a method of fixed step is accurate, and stable.
///
/// Runge-Kutta loses (h omega)^6/144 of an oscillation per step and is stable to 2 sqrt 2. Generalised-alpha is
/// stable, but its phase is off by (h omega)²/12: 2 % at a half. Adaptive steps look after themselves.
pub(super) fn step_limits(integrator: Integrator) -> Option<(f64, f64)> {
    match integrator {
        Integrator::Rk4 { .. } => Some((1.0, 2.0 * std::f64::consts::SQRT_2)),
        Integrator::GeneralizedAlpha { .. } => Some((0.5, f64::INFINITY)),
        Integrator::Dopri5 { .. }
        | Integrator::Rodas5P { .. }
        | Integrator::Switching { .. }
        | Integrator::Rk43 { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_angle_is_named_once_its_rounding_shows() {
        let angles = |turns: f64| [("R1", -2.0 * PI * turns), ("R2.q", 3.0)].into_iter();
        assert_eq!(rounded_angle(angles(1e6)), None);
        let Some(RunWarning::AngleRounded { angle, reached, rounding }) = rounded_angle(angles(1e7)) else {
            panic!("ten million turns are known to 1.4e-8 rad")
        };
        assert_eq!((angle.as_str(), reached), ("R1", -2.0 * PI * 1e7));
        assert!((1.3e-8..1.5e-8).contains(&rounding), "{rounding}");
    }
}
