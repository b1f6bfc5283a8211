//! What can go wrong when a mechanism is set up or run, as data. Every message says what happened,
//! where, and behind its last semicolon what to try. Out: error types, [`what_and_cure`].

use thiserror::Error;

use crate::contact::OutOfRange;

/// Numbers that do not belong to the mechanism, found before anything runs.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SetupError {
    /// A slice or list has the wrong length.
    #[error(
        "{found} {what} given, the mechanism has {expected}; pass one value per entry of its description"
    )]
    Length {
        /// What was counted.
        what: &'static str,
        /// Length that fits.
        expected: usize,
        /// Length that was given.
        found: usize,
    },
    /// A parameter is infinite or not a number.
    #[error("parameter `{name}` is {value}; give it a finite value")]
    Parameter {
        /// Name of the parameter.
        name: String,
        /// Its value.
        value: f64,
    },
    /// Samples of inputs that make no course.
    #[error("row {row} of the inputs: {reason}; give finite numbers at rising times")]
    Signals {
        /// Row, from 1.
        row: usize,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// Samples of an input that the mechanism does not have, or has already.
    #[error(
        "input `{name}` {}; the mechanism's inputs: {}",
        if *.twice { "is given twice" } else { "does not exist" },
        if .known.is_empty() { "none" } else { .known }
    )]
    Input {
        /// Name that was given.
        name: String,
        /// Names that there are.
        known: String,
        /// Whether it was given twice.
        twice: bool,
    },
    /// Inputs are known for another time than that of the run.
    #[error(
        "the inputs are known from {first} s to {last} s, the run is from {begin} s to {end} s; give inputs for all of it, or a shorter run"
    )]
    InputsEnd {
        /// First and last time of the inputs [s].
        first: f64,
        /// Last time of the inputs [s].
        last: f64,
        /// Begin of the run [s].
        begin: f64,
        /// End of the run [s].
        end: f64,
    },
    /// A constant of a joint with clearance is out of range.
    #[error("joint `{joint}`: {reason}")]
    Contact {
        /// The joint.
        joint: String,
        /// Which constant, its value, and what it must be.
        reason: OutOfRange,
    },
    /// The clearance of a joint is no clearance of its journal.
    #[error(
        "joint `{joint}` has a radial clearance of {clearance:.4e} m on a journal of radius {journal_radius:.4e} m: \
         it must be above zero and below the radius; change the parameters it comes from"
    )]
    Clearance {
        /// The joint.
        joint: String,
        /// Radial clearance, wear included [m].
        clearance: f64,
        /// Radius of the journal or ball [m].
        journal_radius: f64,
    },
    /// A law changed where the mechanism cannot follow at once.
    #[error(
        "{what} would jump by {jump:.3e} (m, rad, or per second) with the new values of the parameters: such values belong to a \
         start; begin another simulation with them"
    )]
    Jump {
        /// What would jump.
        what: String,
        /// How far [m, rad, m/s or rad/s].
        jump: f64,
    },
    /// Other values are given at a state that is not on its loops, whatever the values.
    #[error(
        "at t = {t:.6} s joint {joint} is open by {open:.3e} (m or rad) before any value changes: the states are not those of this \
         time; set the time and its states together, or put the states onto the loops, before other values"
    )]
    NotOnLoops {
        /// The joint.
        joint: String,
        /// How far it is open [m or rad].
        open: f64,
        /// Time [s].
        t: f64,
    },
    /// Controllers that act at sampled times, where somebody else takes the steps.
    #[error(
        "the mechanism has controllers that act at sampled times, which an integrator from outside does not know; take steps of its \
         own (co-simulation), or take `sample_time` out of [controllers] and let them act all the time"
    )]
    Sampled,
    /// A column is asked for that the run does not have.
    #[error(transparent)]
    NoColumn(#[from] NoColumn),
    /// A setting of the run makes no sense.
    #[error("setting `{name}` is {}; it must be {need}", plain(*value))]
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        need: &'static str,
    },
}

/// A column that a run does not have.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("the run has no column `{name}`{}", nearest.as_ref().map_or_else(String::new, |name| format!("; did you mean `{name}`?")))]
pub struct NoColumn {
    /// Its name.
    pub name: String,
    /// The column whose name is nearest.
    pub nearest: Option<String>,
}

/// No consistent start was found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum AssemblyError {
    /// Newton did not close the loops.
    #[error(
        "the loops do not close: after {iterations} iterations joint `{joint}` ({meaning}) is worst, largest \
         residuals {residual_m:.3e} m and {residual_rad:.3e} rad; check lengths and points of that loop, or \
         give start values nearer to the wanted position"
    )]
    NoConvergence {
        /// Iterations spent.
        iterations: usize,
        /// Cut joint with the largest residual.
        joint: String,
        /// What its row forbids.
        meaning: String,
        /// Largest residual of a row in metres.
        residual_m: f64,
        /// Largest residual of a row in radians.
        residual_rad: f64,
    },
    /// The loops close where a joint is turned half round, and nowhere else that was found.
    #[error(
        "the loops close only with joint `{joint}` turned half round, its axis reversed or its parts upside down, which it does not \
         allow; give start values nearer to the wanted position, or change demanded ones by half a turn"
    )]
    TurnedRound {
        /// The joint, one that closes a loop.
        joint: String,
    },
    /// The loops close, but not with the demanded start values.
    #[error(
        "the start values of {} cannot all be met: with them the loops stay open by {residual_m:.3e} m and \
         {residual_rad:.3e} rad; make some of them guesses, or change them (those that [initial] does not have follow from \
         the drivers, which then ask for what the loops do not allow)",
        names.join(", ")
    )]
    HeldPositions {
        /// Coordinates whose demanded values cannot be met, with the nearest reachable value.
        names: Vec<String>,
        /// Largest residual of a row in metres.
        residual_m: f64,
        /// Largest residual of a row in radians.
        residual_rad: f64,
    },
    /// Consistent speeds exist, but not with the demanded start speeds.
    #[error(
        "the start speeds of {} contradict the loops at joint `{joint}` (residual {residual:.3e} m/s or rad/s); \
         make some of them guesses, or change them (those that [initial] does not have follow from \
         the drivers, which then ask for what the loops do not allow)",
        names.join(", ")
    )]
    HeldSpeeds {
        /// Speeds whose demanded values cannot be met, with the nearest reachable value.
        names: Vec<String>,
        /// Cut joint with the largest residual.
        joint: String,
        /// That residual [m/s or rad/s].
        residual: f64,
    },
    /// The drivers demand speeds that the loops forbid in the start position.
    #[error(
        "no speeds fit the loops at joint `{joint}` in the start position (residual {residual:.3e} m/s or rad/s): \
         a driver pushes against a dead point; start elsewhere, or drive another joint"
    )]
    SpeedsImpossible {
        /// Cut joint with the largest residual.
        joint: String,
        /// That residual [m/s or rad/s].
        residual: f64,
    },
    /// The parts of a joint with clearance do not reach each other.
    #[error(
        "the parts of joint `{joint}` cannot be put together: the centres of journal and bearing stay {distance:.3e} m \
         apart, with a radial clearance of {clearance:.3e} m; check lengths, points and axes of its loop, or give start values nearer \
         to the wanted position"
    )]
    OutsideClearance {
        /// The joint that is farthest outside, measured in clearances.
        joint: String,
        /// Distance of the journal's centre from the bearing's [m].
        distance: f64,
        /// Radial clearance [m].
        clearance: f64,
    },
    /// The start values or the residuals are infinite or not numbers.
    #[error(
        "{what} is not a finite number in the start position; check parameters, start values and drivers"
    )]
    NonFinite {
        /// What it was.
        what: String,
    },
    /// The numbers given do not fit the mechanism.
    #[error(transparent)]
    Setup(#[from] SetupError),
}

/// Why a run could not start or go on. Times in seconds.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunError {
    /// The numbers given do not fit the mechanism.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// No consistent start.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// Turns were asked for, but no revolute joint is driven.
    #[error("no revolute joint is driven, so turns cannot be counted; ask for a time span")]
    NoTurns,
    /// The driver never gets round as often as asked.
    #[error(
        "the driver made {reached:.4} of {wanted} turns until t = {t} s and does not get further; ask for a \
         time span, or change the driver's law"
    )]
    TurnsNotReached {
        /// Turns asked for.
        wanted: f64,
        /// Turns made.
        reached: f64,
        /// Time up to which was searched.
        t: f64,
    },
    /// Turns never come to be alike.
    #[error(
        "{what} in {turns} turns, so no turn stands for the others; say after how many turns to measure (settle), or over how many to \
         take the mean (average)"
    )]
    NeverAlike {
        /// What goes on changing.
        what: String,
        /// Turns that were looked at.
        turns: usize,
    },
    /// The step size control found no step that meets the tolerance.
    #[error(
        "at t = {t} s the step had to shrink below {step:.3e} s, because of `{variable}`: the mechanism may pass \
         a singular position or a very stiff force acts there; loosen the tolerance, or soften the force"
    )]
    StepTooSmall {
        /// Time reached.
        t: f64,
        /// Last step tried.
        step: f64,
        /// Variable with the largest error.
        variable: String,
    },
    /// A driver cannot move on: the loops let it go no further.
    #[error(
        "at t = {t:.9} s the driver of `{joint}` is at its dead point, {}, where the loops let it go no further; let \
         its law turn round before, change lengths, or drive another joint",
        if *angular { format!("{:.6} deg", position.to_degrees()) } else { format!("{position:.9} m") }
    )]
    DeadPoint {
        /// Time at which it gets there.
        t: f64,
        /// The driven joint.
        joint: String,
        /// What the driver prescribes there [rad or m].
        position: f64,
        /// True for an angle, false for a length.
        angular: bool,
    },
    /// A loop can no longer be closed.
    #[error(
        "at t = {t} s joint `{joint}` cannot be closed any more ({residual_m:.3e} m, {residual_rad:.3e} rad): the \
         driver pushes past a dead point, or the step is too long; check the driver's range, or shorten the step"
    )]
    LostAssembly {
        /// Time at which closing failed.
        t: f64,
        /// Cut joint with the largest residual.
        joint: String,
        /// Largest residual of a row in metres.
        residual_m: f64,
        /// Largest residual of a row in radians.
        residual_rad: f64,
    },
    /// Closing the loops moved the mechanism by more than the step can explain.
    #[error(
        "at t = {t} s closing the loops moved `{variable}` by {jump:.3e} in one step: the mechanism jumps to \
         another branch; shorten the step or the tolerance, or avoid the singular position"
    )]
    BranchChange {
        /// Time of the jump.
        t: f64,
        /// Variable that jumped most.
        variable: String,
        /// Size of the jump in its unit.
        jump: f64,
    },
    /// Something became infinite or not a number.
    #[error(
        "at t = {t} s `{what}` is not a finite number; check the forces and expressions that act on it, and whether a table is asked outside its rows"
    )]
    NonFinite {
        /// Time at which it was evaluated.
        t: f64,
        /// What it was.
        what: String,
    },
    /// The mass matrix is asked for, and it is left out of the equations of so long a mechanism.
    #[error(
        "at t = {t} s the mass matrix is asked for, by the integrator or where loops lose their hold (a singular position), and it \
         is left out of mechanisms as long as this one; take another integrator, start elsewhere, or split the mechanism"
    )]
    MassLeftOut {
        /// Time at which it was evaluated.
        t: f64,
    },
    /// The Newton iteration of an implicit step failed.
    #[error(
        "at t = {t} s the implicit step of {step:.3e} s did not converge (last correction {correction:.3e}); \
         shorten the step"
    )]
    NewtonFailed {
        /// Time at the beginning of the step.
        t: f64,
        /// Step size.
        step: f64,
        /// Largest component of the last correction.
        correction: f64,
    },
    /// A contact is pressed in so far that no law of contact holds.
    #[error(
        "at t = {t} s joint `{joint}` is pressed in by {penetration:.3e} m, with a journal radius of \
         {journal_radius:.3e} m: no contact carries that; check assembly, loads and stiffness, or shorten the step"
    )]
    Penetration {
        /// Time at which it was seen.
        t: f64,
        /// The joint.
        joint: String,
        /// Depth of the contact [m].
        penetration: f64,
        /// Radius of the journal or ball [m].
        journal_radius: f64,
    },
    /// A flexible body deflects by more than its length.
    #[error(
        "at t = {t} s the flexible body `{body}` bends by {deflection:.3e} m, more than its length of {length:.3e} m: its linear shapes \
         (`order = 1`) do not hold there; take `order = 2` where it turns fast against its vibrations, or a stiffer section, and check \
         `young` and loads"
    )]
    BentTooFar {
        /// Time at which it was seen.
        t: f64,
        /// The body.
        body: String,
        /// Largest displacement of one of its places in the floating frame [m].
        deflection: f64,
        /// Length of the body [m].
        length: f64,
    },
    /// Energy appears or vanishes that no force explains.
    #[error(
        "up to t = {t} s the energy balance is off by {error:.3e} J while {throughput:.3e} J went through: the numbers \
         are wrong; shorten the step or tighten the tolerance, or check how stiff and how fast the mechanism is"
    )]
    EnergyLost {
        /// Time up to which the balance goes.
        t: f64,
        /// Largest error of the balance [J].
        error: f64,
        /// Energy that went through [J].
        throughput: f64,
    },
    /// A run failed on its way through a singular position.
    #[error(
        "{} (near t = {t:.6} s the mechanism passes a singular position, where its loops could go on in two ways); {}",
        what_and_cure(&cause.to_string()).0,
        if *is_adaptive {
            "start elsewhere, change a length, or add a link that holds the loop there"
        } else {
            "take adaptive steps (`--integrator dopri5`), change a length, or add a link that holds the loop there"
        }
    )]
    InSingularPosition {
        /// Time of the most singular state that was met there.
        t: f64,
        /// Whether the method chooses its steps.
        is_adaptive: bool,
        /// What failed.
        cause: Box<RunError>,
    },
    /// Steps are so short that the end is out of reach.
    #[error(
        "at t = {t} s the run makes no progress: {tried} steps gained {gained:.3e} s{}; check its start and how stiff \
         its forces are, or loosen the tolerance or lengthen the step",
        joint.as_ref().map_or_else(String::new, |joint| format!(", joint `{joint}` pressed in deepest"))
    )]
    NoProgress {
        /// Time reached.
        t: f64,
        /// Last steps, accepted or not.
        tried: u64,
        /// Time that they gained [s].
        gained: f64,
        /// Joint with clearance that is pressed in deepest, if there is one.
        joint: Option<String>,
    },
    /// An angle that is known only up to whole turns changes too fast to be followed.
    #[error(
        "at t = {t} s the step of {step:.3e} s is too long to tell how often `{angle}` turned in it; shorten the step, or \
         take a method of adaptive steps"
    )]
    TurnsUnclear {
        /// Time at the end of the step.
        t: f64,
        /// Time that cannot be bridged [s].
        step: f64,
        /// Column of the angle.
        angle: String,
    },
    /// A spring or a formula uses an angle where it jumps by a whole turn.
    #[error(
        "at t = {t:.6} s `{angle}` passes half a turn, and a force that depends on it would jump there: the joint closes a \
         loop, so that its angle is known only up to whole turns; write `cut = true` to another joint of that loop"
    )]
    AngleJumps {
        /// Time of the half turn.
        t: f64,
        /// Column of the angle.
        angle: String,
    },
    /// The caller asked to stop.
    #[error("stopped on request at t = {t} s; the samples up to then are kept")]
    Interrupted {
        /// Time reached.
        t: f64,
    },
}

/// A message of these errors in two: what happened, and what to try, which is empty where nothing can be tried.
pub fn what_and_cure(message: &str) -> (&str, &str) {
    message.rsplit_once("; ").unwrap_or((message, ""))
}

/// A number as people write it.
fn plain(value: f64) -> String {
    if is_long(value) { format!("{value:e}") } else { format!("{value}") }
}

/// Whether plain digits of a number are so many that people write an exponent.
pub(crate) fn is_long(value: f64) -> bool {
    value != 0.0 && value.is_finite() && !(1e-5..1e16).contains(&value.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_message_has_its_cure_behind_its_last_semicolon() {
        let messages = include_str!("error.rs").split("#[cfg(test)]").next().unwrap_or_default();
        let messages = messages.split("#[error(").skip(1);
        let messages: Vec<&str> = messages.filter_map(|rest| rest.split(")]").next()).collect();
        // Others hand on what has its cure.
        let hands_on = |text: &str| text.starts_with("transparent") || text.ends_with("{reason}\"");
        let own: Vec<&&str> = messages.iter().filter(|text| !hands_on(text)).collect();
        assert!(own.len() > 30, "{}", own.len());
        for text in own {
            // A message ends with its text or with the last of its values.
            assert!(what_and_cure(text).1.len() > 10, "{text}");
        }
    }

    #[test]
    fn what_failed_in_a_singular_position_has_one_cure() {
        let cause = Box::new(RunError::NewtonFailed { t: 0.1, step: 1e-3, correction: 2.0 });
        let text = RunError::InSingularPosition { t: 0.2, is_adaptive: true, cause }.to_string();
        let (what, cure) = what_and_cure(&text);
        assert!(what.contains("did not converge") && what.contains("singular position"), "{what}");
        assert_eq!(cure, "start elsewhere, change a length, or add a link that holds the loop there");
    }
}
