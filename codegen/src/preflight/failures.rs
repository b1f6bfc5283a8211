//! What a user is told when a mechanism cannot be assembled, cannot move, or is driven against itself.
//! In: what the analysis found. Out: diagnostics with places and cures. Never computes.

use linkwear_runtime::{AssemblyError, CLOSED_AT_START, Description};

use crate::diagnostic::{Code, Diagnostic};
use crate::id::JointId;
use crate::model::{Joint, Mechanism, Start};

use super::analysis::Analysis;
use super::assemblies::{Coordinate, as_guesses};
use super::exactness::Opening;
use super::rank::Lost;

const CLOSE: &str = "check lengths and points, or start Newton nearer to the wanted assembly with [assembly]";

pub(super) fn named<'a>(mechanism: &'a Mechanism, name: &str) -> Option<&'a Joint> {
    mechanism.joint_of_contact(name)
}

/// `R1`, `R2` and so on, in backticks.
pub(super) fn quoted<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

fn rounded(gap: f64) -> String {
    if (1e-3..1e6).contains(&gap) { format!("{gap:.3}") } else { format!("{gap:.1e}") }
}

/// How far loops stay open: only the kinds that are, rounded.
fn gap(metres: f64, radians: f64) -> String {
    /// Next to a gap that people are told of, less is rounding.
    const SMALL: f64 = 1e-9;
    let metres = Some(metres).filter(|gap| *gap > SMALL || radians <= SMALL);
    let radians = Some(radians).filter(|gap| *gap > SMALL);
    let parts = [metres.map(|gap| rounded(gap) + " m"), radians.map(|gap| rounded(gap) + " rad")];
    parts.into_iter().flatten().collect::<Vec<_>>().join(" and ")
}

/// Assembly failed although no driver stands in the way.
pub fn cannot_close(mechanism: &Mechanism, error: &AssemblyError) -> Diagnostic {
    match error {
        AssemblyError::NoConvergence { joint, meaning, residual_m, residual_rad, .. } => {
            let open = gap(*residual_m, *residual_rad);
            let message = format!("the loop through `{joint}` does not close: it stays open by {open}");
            let diagnostic = Diagnostic::new(Code::LoopDoesNotClose, message).help(CLOSE);
            at_joint(diagnostic, mechanism, joint, &format!("worst: {meaning}"))
        }
        AssemblyError::HeldPositions { names, residual_m, residual_rad } => {
            let open = gap(*residual_m, *residual_rad);
            let message = format!(
                "the start values of {} cannot all be met: with them the loops stay open by {open}",
                names.join(", ")
            );
            start_impossible(mechanism, names, message)
        }
        AssemblyError::TurnedRound { joint } => {
            let message = format!(
                "the loop through `{joint}` closes only with that joint turned half round: its axis reversed, or its parts upside \
                 down"
            );
            let diagnostic = Diagnostic::new(Code::LoopDoesNotClose, message).help(
                "start nearer to the wanted assembly with [assembly]; values there, in [initial], or of drivers at t = 0 may be \
                 half a turn off",
            );
            at_joint(diagnostic, mechanism, joint, "turned half round")
        }
        AssemblyError::HeldSpeeds { names, joint, .. } => {
            let message = format!(
                "the start speeds of {} cannot all be met: the loop through `{joint}` forbids it",
                names.join(", ")
            );
            start_impossible(mechanism, names, message)
        }
        AssemblyError::SpeedsImpossible { joint, .. } => {
            let message = format!("no speeds fit the loop through `{joint}` in the start position");
            let diagnostic =
                Diagnostic::new(Code::LoopDoesNotClose, message).help("start in another position");
            at_joint(diagnostic, mechanism, joint, "in this loop")
        }
        AssemblyError::OutsideClearance { joint, distance, clearance } => {
            let message = format!(
                "the parts of joint `{joint}` cannot be put together: the centres of journal and bearing stay {} apart, \
                 with a radial clearance of {clearance:.3e} m",
                gap(*distance, 0.0)
            );
            let diagnostic = Diagnostic::new(Code::LoopDoesNotClose, message).help(CLOSE);
            at_joint(diagnostic, mechanism, joint, "journal and bearing do not meet")
        }
        AssemblyError::NonFinite { what } => {
            let message = format!("the {what} is not a finite number in the start position");
            let diagnostic = Diagnostic::new(Code::StartNotFinite, message)
                .help("check the points, start values and parameters of this joint");
            // `what` ends with the joint, or one of its variables.
            let name = what.rsplit(' ').next().unwrap_or_default();
            let of_variable = name.rsplit_once('.').map_or(name, |(joint, _)| joint);
            let joint = if named(mechanism, name).is_some() { name } else { of_variable };
            at_joint(diagnostic, mechanism, joint, "this joint")
        }
        AssemblyError::Setup(error) => Diagnostic::new(Code::StartNotFinite, error.to_string()),
    }
}

/// The loops close where the mechanism is drawn, and open along its motion.
pub fn opens_along_motion(mechanism: &Mechanism, description: &Description, opening: &Opening) -> Diagnostic {
    let row = &description.rows[opening.row];
    let message = format!(
        "the loop through `{}` closes where it starts, but cannot stay closed: along its motion it opens by {} {}",
        row.joint,
        rounded(opening.amount),
        if row.angular { "rad" } else { "m" }
    );
    let diagnostic = Diagnostic::new(Code::LoopDoesNotClose, message).help(format!(
        "more joints hold it than its motion needs, so that lengths and axes have to fit to {CLOSED_AT_START:e} of its \
         size: correct them, give them more digits, or free a joint (for instance make a revolute spherical)"
    ));
    at_joint(diagnostic, mechanism, &row.joint, &format!("worst: {}", row.meaning))
}

pub(super) fn at_joint(diagnostic: Diagnostic, mechanism: &Mechanism, joint: &str, text: &str) -> Diagnostic {
    diagnostic.at_each(named(mechanism, joint).map(|joint| joint.span), text)
}

/// Whether a variable of the joint is among `names`, each of which begins with `` `joint.q` ``.
fn among(names: &[String], joint: &Joint) -> bool {
    names.iter().any(|name| {
        name.strip_prefix('`').and_then(|rest| rest.strip_prefix(&*joint.name)?.strip_prefix('.')).is_some()
    })
}

/// `names`: variables as assembly lists them.
fn start_impossible(mechanism: &Mechanism, names: &[String], message: String) -> Diagnostic {
    let driven = mechanism.joints.iter().filter(|joint| !joint.drives.is_empty() && among(names, joint));
    let diagnostic = Diagnostic::new(Code::StartImpossible, message)
        .at_each(driven.map(|joint| joint.span), "driven from there")
        .at_each(demanded(mechanism, names).map(|start| start.span), "demanded here");
    let starts = mechanism.starts.iter().filter(|start| start.held && start.position.is_some());
    diagnostic.help(match starts.count() + mechanism.drives().count() {
        1 => "the loops do not let it get there: demand what they reach, or change lengths; in [assembly] it is a guess",
        _ => {
            "demand no more start values than there are freedoms without a driver, and give the others in [assembly] as \
             guesses"
        }
    })
}

/// Demanded start values among `names`.
fn demanded<'a>(mechanism: &'a Mechanism, names: &'a [String]) -> impl Iterator<Item = &'a Start> {
    let starts = mechanism.starts.iter().filter(|start| start.held);
    starts.filter(|start| among(names, mechanism.joint(start.joint)))
}

/// The loops close, but not where the drivers start.
pub fn out_of_reach(
    mechanism: &Mechanism,
    drivers: &[(JointId, usize)],
    (error, guesses): (&AssemblyError, Option<&[Coordinate]>),
) -> Diagnostic {
    let (names, loops) = match error {
        AssemblyError::HeldPositions { names, .. } if demanded(mechanism, names).next().is_some() => {
            return cannot_close(mechanism, error);
        }
        AssemblyError::HeldPositions { names, residual_m, residual_rad } => {
            (names.as_slice(), format!("the loops stay open by {}", gap(*residual_m, *residual_rad)))
        }
        AssemblyError::NoConvergence { joint, residual_m, residual_rad, .. } => {
            let open = gap(*residual_m, *residual_rad);
            (&[][..], format!("the loop through `{joint}` stays open by {open}"))
        }
        other => return cannot_close(mechanism, other),
    };
    let stuck = |joint: &&Joint| names.is_empty() || among(names, joint);
    let joints: Vec<&Joint> = drivers.iter().map(|(id, _)| mechanism.joint(*id)).filter(stuck).collect();
    if joints.is_empty() {
        return cannot_close(mechanism, error);
    }
    let names_of_drivers = quoted(joints.iter().map(|joint| joint.name.as_str()));
    let mut diagnostic = if let Some(guesses) = guesses {
        let message = format!(
            "where the driver of {names_of_drivers} starts, at t = 0, the loops can be closed, but not from the guesses \
             of the file: from there {loops}"
        );
        let help =
            format!("start from a nearer guess, for instance `[assembly]` with `{}`", as_guesses(guesses));
        Diagnostic::new(Code::LoopDoesNotClose, message).help(help)
    } else {
        let message = format!("where the driver of {names_of_drivers} starts, at t = 0, {loops}");
        Diagnostic::new(Code::LoopDoesNotClose, message)
            .help("let the law start at a position that the loop can reach, or change lengths")
    };
    if !names.is_empty() && guesses.is_none() {
        diagnostic = diagnostic.help(format!("nearest positions found: {}", names.join(", ")));
    }
    diagnostic.at_each(joints.iter().map(|joint| joint.span), "driven here")
}

/// By how much the loops stay open [m, rad] where a start is out of reach.
fn left_open(error: &AssemblyError) -> Option<(f64, f64)> {
    match error {
        AssemblyError::HeldPositions { residual_m, residual_rad, .. }
        | AssemblyError::NoConvergence { residual_m, residual_rad, .. } => Some((*residual_m, *residual_rad)),
        _ => None,
    }
}

/// A start in a singular position, or one that assembly did not leave: `refusal`; `held` are the joints of the speeds that
/// were asked about.
pub fn singular_start(
    mechanism: &Mechanism,
    analysis: &Analysis,
    held: &[JointId],
    (lost, refusal): (&Lost, Option<&AssemblyError>),
) -> Diagnostic {
    let joints: Vec<&Joint> = match lost {
        Lost::Rows => analysis.cuts.iter().filter_map(|cut| named(mechanism, cut)).take(1).collect(),
        Lost::Held(list) => list.iter().map(|at| mechanism.joint(held[*at])).collect(),
    };
    let names = quoted(joints.iter().map(|joint| joint.name.as_str()));
    let driver = mechanism.joints.iter().find(|joint| !joint.drives.is_empty());
    let (message, label) = match lost {
        Lost::Rows => (
            format!(
                "the mechanism starts in a singular position: the loop through {names} can leave it in more ways than \
                 one, and its forces there have no bounds"
            ),
            "this loop",
        ),
        Lost::Held(_) => (
            format!(
                "the mechanism starts at a dead point of {names}: there the other joints of its loop can move while it \
                 rests, so it cannot set them going either way"
            ),
            "held at its dead point",
        ),
    };
    let mut diagnostic =
        Diagnostic::new(Code::SingularStart, message).at_each(joints.iter().map(|joint| joint.span), label);
    if let Some((metres, radians)) = refusal.and_then(left_open) {
        let open = gap(metres, radians);
        diagnostic = diagnostic.help(format!(
            "no position nearer to the start that is asked for was found: with its values the loops stay open by {open}"
        ));
    }
    diagnostic.help(match (driver, lost) {
        (Some(driver), Lost::Rows) => format!(
            "start a little beside it: let the law of `{}` begin 1 deg (or 1 % of its stroke) away, and say with \
             [assembly] on which branch the other joints are",
            driver.name
        ),
        (None, Lost::Rows) => "start a little beside it: give a joint of the loop a start value 1 deg away in [initial], \
                               and say with [assembly] on which branch the other joints are"
            .to_owned(),
        (_, Lost::Held(_)) => "start a little beside it, drive another joint of the loop, or, if its own start is \
                               elsewhere, give another joint of the loop a guess on the wanted side in [assembly], \
                               5 deg for instance"
            .to_owned(),
    })
}

/// A linkage that moves only thanks to its clearances, with the reason: what is so when they are closed.
pub fn moves_by_clearance(mechanism: &Mechanism, reason: &str) -> Diagnostic {
    let loose = mechanism.joints.iter().filter(|joint| joint.clearance.is_some());
    Diagnostic::new(Code::MovesByClearance, format!("only thanks to its clearances can the linkage move: {reason}"))
        .at_each(loose.map(|joint| joint.span), "with clearance")
        .help(
            "if that is not meant, correct lengths and axes, or free a joint (for instance make a revolute spherical)",
        )
}

/// Says that play was not counted as freedom.
pub fn with_closed_clearances(error: Diagnostic) -> Diagnostic {
    error.help("this holds with the clearances closed: play is no freedom that could be driven")
}

/// Constants of the equations that overflow, shown where the number that is farthest from 1 in size is written.
pub fn beyond_numbers(mechanism: &Mechanism) -> Diagnostic {
    let values = mechanism.parameter_values();
    let parameters = mechanism.parameters.iter().map(|parameter| (parameter.value, parameter.span));
    let positions = mechanism.points.iter().flat_map(|point| point.position_for(point.carrier));
    let positions = positions.map(|own| (own.value(&values).unwrap_or(0.0), own.span));
    let far = |value: f64| if value == 0.0 { 0.0 } else { value.abs().log10().abs() };
    let extreme = parameters.chain(positions).max_by(|a, b| far(a.0).total_cmp(&far(b.0)));
    Diagnostic::new(Code::NotFinite, "the constants of the equations are beyond what numbers can hold")
        .at_each(extreme.map(|(_, span)| span), "the most extreme number")
        .help("check exponents and units: mass, size and inertia are products of these numbers")
}

/// A motion without inertia.
pub fn massless(mechanism: &Mechanism, joint: JointId, body: &str) -> Diagnostic {
    let joint = mechanism.joint(joint);
    let message = format!("joint `{}` can move `{body}` without moving any mass", joint.name);
    Diagnostic::new(Code::MasslessFreedom, message)
        .at(joint.span, "this motion has no inertia")
        .help(format!("give `{body}` a moment of inertia, or use a joint without that freedom"))
}

/// A driver whose law has no finite first or second derivative at t = 0.
pub fn abrupt_driver(mechanism: &Mechanism, joint: &str, what: &str) -> Diagnostic {
    let message =
        format!("the {what} that the driver of `{joint}` prescribes is not a finite number at t = 0");
    let diagnostic = Diagnostic::new(Code::StartNotFinite, message)
        .help("let the law set out smoothly, for instance with `t^2` in place of `sqrt(t)`");
    at_joint(diagnostic, mechanism, joint, "driven here")
}
