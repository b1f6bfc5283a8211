//! What a user is told of joints that cannot move, with and without drivers.
//! In: what the analysis found. Out: diagnostics with places and cures. Never computes.

use linkwear_runtime::CLOSED_AT_START;

use crate::diagnostic::{Code, Diagnostic};
use crate::id::JointId;
use crate::model::{Coupling, Joint, Mechanism};

use super::analysis::Analysis;
use super::exactness::{NEARLY, ROUNDING};
use super::failures::{at_joint, named, quoted};
use super::rank::Rows;

/// No freedom at all.
pub fn locked(mechanism: &Mechanism, analysis: &Analysis) -> Diagnostic {
    let names = quoted(mechanism.joints.iter().map(|joint| joint.name.as_str()));
    let message = format!(
        "nothing can move: {} speeds are held by {} independent constraint rows",
        analysis.speeds, analysis.independent_rows
    );
    let cut = analysis.cuts.first().and_then(|cut| named(mechanism, cut));
    let couplings: Vec<&Coupling> = mechanism.rigid_couplings().collect();
    let diagnostic = Diagnostic::new(Code::Locked, message);
    // Without a loop of joints it is the couplings that hold them.
    if cut.is_none() && !couplings.is_empty() {
        return diagnostic
            .at_each(couplings.iter().map(|coupling| coupling.span), "couples them")
            .help(contradict(&couplings));
    }
    diagnostic.at_each(cut.map(|joint| joint.span), "the loop closed here is rigid").help(format!(
        "the joints {names} form a structure; free one of them (for instance make a revolute spherical) \
         or correct axes that should be parallel or meet in a point"
    ))
}

/// What helps where couplings leave no motion.
fn contradict(couplings: &[&Coupling]) -> String {
    let names = quoted(couplings.iter().map(|coupling| coupling.name.as_str()));
    format!(
        "the couplings {names} ask for ratios that contradict each other, or hold joints that stand: correct teeth, radii or factors, or \
         take one away"
    )
}

/// Some joints can never move, although others do or links bend.
pub fn rigid_part(mechanism: &Mechanism, joints: &[JointId]) -> Diagnostic {
    let names = quoted(joints.iter().map(|joint| mechanism.joint(*joint).name.as_str()));
    let others = match joints.len() < mechanism.joints.len() {
        true => "though other joints do",
        false => "and there are no other joints: links can only bend",
    };
    Diagnostic::new(Code::RigidPart, format!("the loops let {names} never move, {others}"))
        .help("make them `fixed` if that is meant; otherwise free one, or correct lengths and axes")
        .at_each(joints.iter().map(|joint| mechanism.joint(*joint).span), "cannot move")
}

/// Drivers must prescribe independent freedoms. `misses`: by which part of the mechanism the loops stay open when the driver of
/// this speed goes on by a small step; `rigid`: joints that cannot move without drivers either.
pub fn conflicts(
    mechanism: &Mechanism,
    drivers: &[(JointId, usize)],
    rows: &Rows,
    (misses, rigid): (&dyn Fn(usize) -> f64, &dyn Fn() -> Vec<JointId>),
) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    for group in rows.driver_conflicts() {
        let joints: Vec<&Joint> = group.iter().map(|driver| mechanism.joint(drivers[*driver].0)).collect();
        let names = quoted(joints.iter().map(|joint| joint.name.as_str()));
        let (code, message) = if joints.len() == 1 {
            (Code::DriverOnDependentCoordinate, format!("the loops leave joint {names} no motion to drive"))
        } else {
            let message =
                format!("the loops couple the driven joints {names}: they cannot all be prescribed");
            (Code::DriversInConflict, message)
        };
        let alone = group.first().filter(|_| group.len() == 1).map(|driver| drivers[*driver]);
        let help = alone.and_then(|(joint, _)| held_without_driver(mechanism, joint, &rigid()));
        let mut error = Diagnostic::new(code, message)
            .help(help.unwrap_or_else(|| "keep as many drivers as there are freedoms to drive".to_owned()))
            .at_each(joints.iter().map(|joint| joint.span), "driven here");
        let nearly = alone.map(|(_, speed)| misses(speed));
        // What closes but for rounding is no matter of digits.
        if let Some(part) = nearly.filter(|part| (ROUNDING..NEARLY).contains(part)) {
            error = error.help(format!(
                "its loop misses that motion by {part:.1e} of its size only: correct lengths and axes, or give them more \
                 digits; {CLOSED_AT_START:e} is close enough"
            ));
        }
        errors.push(error);
    }
    errors
}

/// What helps where a joint cannot move without its driver either; nothing where it can.
fn held_without_driver(mechanism: &Mechanism, driven: JointId, rigid: &[JointId]) -> Option<String> {
    let names = quoted(rigid.iter().map(|joint| mechanism.joint(*joint).name.as_str()));
    let ties = |coupling: &&Coupling| coupling.terms.iter().all(|term| rigid.contains(&term.joint));
    let couplings: Vec<&Coupling> = mechanism.rigid_couplings().filter(ties).collect();
    // One alone leaves joints their motion; several of the same joints may not.
    let of_driven = couplings.iter().filter(|one| one.terms.iter().any(|term| term.joint == driven)).count();
    rigid.contains(&driven).then(|| match of_driven {
        2.. => format!("{names} cannot move without a driver either: {}", contradict(&couplings)),
        _ => format!(
            "{names} cannot move without a driver either: correct points and axes that should be elsewhere, free one of these \
             joints (for instance make a revolute spherical), or drive a joint that moves"
        ),
    })
}

/// Loops that close in one position alone.
pub fn stretched(mechanism: &Mechanism, joint: &str) -> Diagnostic {
    let message = format!(
        "nothing can move: the loop through `{joint}` is stretched to its limit, or folded to it, and closes where it is drawn alone"
    );
    let diagnostic = Diagnostic::new(Code::Locked, message).help(
        "lengthen a link of it, or bring its points nearer to each other (shorten a link, if it is folded)",
    );
    at_joint(diagnostic, mechanism, joint, "in this loop")
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::super::samples::{ClosedPositions, Position};
    use super::*;
    use crate::input::Reach;
    use crate::model::{Overrides, resolve};
    use crate::source::SourceFile;
    use crate::sparse_rows::SparseRows;
    use crate::spec;

    #[test]
    fn a_loop_that_misses_by_nothing_is_not_told_to_be_made_more_exact() {
        let text = "spec = 1\nname = \"bar\"\ngravity = [0, 0, 0]\n[points]\nO = [0, 0, 0]\nA = [\"1 m\", 0, 0]\n[bodies]\n\
                    bar = { rod = [\"O\", \"A\"], radius = \"8 mm\", mass = \"1 kg\" }\n[joints]\n\
                    R = { revolute = [\"ground\", \"bar\"], at = \"O\", axis = [0, 0, 1], drive = \"1 rad/s*t\" }\n";
        let source = SourceFile { name: "bar.toml".to_owned(), text: text.to_owned() };
        let (mechanism, _) =
            resolve(&spec::parse(&source).unwrap(), &Overrides::default(), Reach::Below).unwrap();
        let drivers = [(mechanism.drives().next().unwrap().0, 0)];
        // One row that holds the driven speed.
        let held = Position::new(Vec::new(), DVector::zeros(1), SparseRows::units(1, &[0]));
        let positions = ClosedPositions { positions: vec![held], arm: 1.0, open: Vec::new() };
        let helps = |part: f64| {
            let errors =
                conflicts(&mechanism, &drivers, &Rows::new(&positions, vec![0]), (&|_| part, &Vec::new));
            assert_eq!(errors.len(), 1);
            errors[0].help.iter().any(|help| help.contains("misses that motion"))
        };
        assert_eq!([0.0, 1e-16, 1e-9, 1e-5, 0.1].map(helps), [false, false, true, true, false]);
    }
}
