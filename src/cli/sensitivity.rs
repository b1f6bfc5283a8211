//! `sensitivity`: how wear and life vary with the parameters of a mechanism.

mod arguments;

use serde_json::json;

pub use self::arguments::SensitivityArguments;
use super::answer::Answer;
use super::answer::sensitivity::SensitivityAnswer;
use super::failure::Failure;
use super::input::{options, print_remarks};
use super::table::{plural, table};
use crate::mechanism::{Mechanism, read_source};
use crate::number::{fixed, number};
use crate::progress::watched;
use crate::sensitivity::{Derived, SensitivityError, SensitivityResult, SensitivityStudy};

pub fn run(arguments: &SensitivityArguments) -> Result<Answer, Failure> {
    let file = &arguments.input.file;
    let source = read_source(file)?;
    let options = options(&arguments.input, false);
    let mechanism = Mechanism::compile(&source, &options, crate::backend::Backend::Auto)?;
    print_remarks(&mechanism);
    let study = SensitivityStudy {
        options,
        parameters: (!arguments.by.is_empty()).then(|| arguments.by.clone()),
        step: arguments.step,
        points: arguments.points.into(),
        trajectories: arguments.trajectories,
        seed: arguments.seed,
        threads: arguments.threads,
        ..SensitivityStudy::new(&source)
    };
    let found = watched("parameters", |watch| study.run_watched(watch));
    let found = found.map_err(|error| failed(arguments, error))?;
    let chosen = json!({
        "by": study.parameters,
        "trajectories": study.trajectories,
        "step_s": study.step,
        "points": study.points,
    });
    let seed = (study.trajectories > 0).then_some(study.seed);
    let provenance = mechanism.provenance(seed, chosen);
    let name = &mechanism.description.name;
    Ok(Answer::new(text(name, &found), SensitivityAnswer::new(name, &found), Some(&provenance)))
}

/// Why there are no derivatives, and what to do about it.
fn failed(arguments: &SensitivityArguments, error: SensitivityError) -> Failure {
    let file = &arguments.input.file;
    let life = |help: &str| Failure::life(file, &error, help);
    match &error {
        SensitivityError::Mechanism(diagnostics) => Failure::from(diagnostics.clone()),
        SensitivityError::UnknownParameter { parameter, known } => {
            Failure::unknown_name("parameter", parameter, known, known)
        }
        SensitivityError::NoParameters => life(
            "write a number of the file as a parameter: `c0 = \"10 um\"` in [parameters], and `\"c0\"` in its place",
        ),
        SensitivityError::Setting { .. } => Failure::usage(&error, "choose another value"),
        SensitivityError::Interrupted => Failure::stopped(file, &error, "it begins anew"),
        SensitivityError::Run(error) => Failure::run(file, error, None),
        SensitivityError::Formula { .. } => life("name the parameters in its formula"),
        SensitivityError::At { .. }
        | SensitivityError::OtherForm { .. }
        | SensitivityError::NoLives { .. } => {
            life("leave it out of --by; `study --vary` runs the life at values of it")
        }
        SensitivityError::SeveralTurns { .. } => {
            life("study --vary NAME=A..B:N --of life.mean has lives on both sides")
        }
        SensitivityError::NothingWears => life("give a joint a table in [clearance] and one in [wear]"),
        SensitivityError::NotSettled { .. } | SensitivityError::NoPeriod { .. } => {
            life("a motion without a period has no derivative; `study --vary` shows how its lives differ")
        }
        SensitivityError::NoProcess { .. } => {
            life("give it `alpha` and `beta` in [wear], or leave --trajectories out")
        }
        SensitivityError::SmallShape { .. } => life(
            "give a cycle more revolutions, or leave --trajectories out; `study --vary` runs random lives at values of a parameter",
        ),
        SensitivityError::TooLong { .. } => life("look at the motion by `simulate`"),
        _ => life("`study --vary` runs the life at values of its parameters"),
    }
}

fn text(name: &str, found: &SensitivityResult) -> String {
    let mut text = format!(
        "{name}: {} fails after {} cycles on its mean path\n\n",
        found.life.joint,
        number(found.life.cycles.value)
    );
    let wear = found.joints.iter().flat_map(|joint| {
        [
            (format!("{}.S", joint.joint), &joint.wear_integral),
            (format!("{}.depth", joint.joint), &joint.depth),
        ]
    });
    let life = ("life".to_owned(), &found.life.cycles);
    let mean = found.random.iter().map(|random| ("mean life".to_owned(), &random.mean));
    let quantities: Vec<(String, &Derived)> = std::iter::once(life).chain(mean).chain(wear).collect();
    let names = quantities.iter().map(|(name, _)| name.clone());
    let head: Vec<String> = ["parameter", "value", "unit", "d(life)/d(parameter)", "+-"]
        .map(str::to_owned)
        .into_iter()
        .chain(names.map(|name| format!("% of {name} per %")))
        .collect();
    let row = |at: usize| {
        let parameter = &found.parameters[at];
        let cycles = &found.life.cycles;
        let mut row = vec![
            parameter.name.clone(),
            number(parameter.value),
            parameter.unit.clone(),
            number(cycles.by[at]),
            if cycles.doubts[at].is_finite() { format!("{:.0e}", cycles.doubts[at]) } else { String::new() },
        ];
        row.extend(quantities.iter().map(|(_, of)| {
            found.elasticity(of, at).map_or_else(String::new, |elasticity| fixed(elasticity, 4))
        }));
        row
    };
    text.push_str(&table(&head, &(0..found.parameters.len()).map(row).collect::<Vec<_>>()));
    if let Some(random) = &found.random {
        text.push_str(&format!(
            "\nmean of {}: {} cycles, standard error {}; seed {}\n",
            plural(random.trajectories, "random life", "random lives"),
            number(random.mean.value),
            number(random.error),
            random.seed
        ));
    }
    let steps = format!("{} of {} s a turn", plural(found.steps, "step", "steps"), number(found.step));
    text.push_str(&match found.turns {
        0 => format!("\nin {steps} derivatives do not settle: those of wear are differences of turns beside it\n"),
        turns => format!(
            "\n{steps} at {}, settled after at most {}; wear differs from that by adaptive steps by at most {:.1e} of itself\n",
            plural(found.points as u64, "clearance", "clearances"),
            plural(turns.into(), "turn", "turns"),
            found.step_error
        ),
    });
    if found.life.is_by_lives {
        let why = if found.losses > 0 {
            format!("bodies come apart up to {} a turn", plural(found.losses.into(), "time", "times"))
        } else {
            "derivatives of turns do not settle, or a journal wears too".to_owned()
        };
        text.push_str(&format!(
            "{why}: the life and its derivatives are by lives of the dynamics, at 98 to 102 % of each parameter\n"
        ));
    }
    for one in &found.left_out {
        let reason = one.reason.lines().next().unwrap_or_default();
        text.push_str(&format!("left out: `{}`: {reason}\n", one.parameter));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensitivity::{LeftOut, LifeSensitivity, Varying};

    #[test]
    fn what_derivatives_are_worth_is_told_below_them() {
        let cycles = Derived { value: 25.0, by: vec![-5.0], doubts: vec![0.1] };
        let found = SensitivityResult {
            parameters: vec![Varying { name: "c".into(), value: 2.0, unit: "N m s".into() }],
            left_out: vec![LeftOut { parameter: "modes".into(), reason: "a whole number\nmore".into() }],
            joints: Vec::new(),
            life: LifeSensitivity { joint: "R1".into(), cycles, is_by_lives: true },
            random: None,
            steps: 1000,
            step: 5e-4,
            step_error: 2e-5,
            turns: 9,
            losses: 4,
            points: 5,
        };
        let told = text("m", &found);
        assert!(told.starts_with("m: R1 fails after 25.00 cycles on its mean path\n"), "{told}");
        assert!(told.contains("-5.000  1e-1          -0.4000\n"), "{told}");
        let rough = "bodies come apart up to 4 times a turn: the life and its derivatives are by lives of the dynamics, at 98 to 102 % of each \
                     parameter\n";
        assert!(told.ends_with(&format!("{rough}left out: `modes`: a whole number\n")), "{told}");
        assert!(
            text("m", &SensitivityResult { losses: 0, ..found.clone() })
                .contains("derivatives of turns do not settle, or a journal wears too: ")
        );
        let smooth = LifeSensitivity { is_by_lives: false, ..found.life.clone() };
        assert!(!text("m", &SensitivityResult { life: smooth, ..found }).contains("apart"));
    }
}
