//! What `identify` says. In: what was found. Out: one JSON object, or a page of text.

use std::fmt::Write as _;

use super::super::answer::Answer;
use super::super::answer::identify::{
    ClocksAnswer, CombinationAnswer, DirectionAnswer, GroupAnswer, IdentifyAnswer, IdentifyWarning,
    MinimumAnswer, MisfitAnswer, ParameterAnswer,
};
use super::super::table::{plural, table};
use crate::identify::{Clocks, Combination, Estimated, GroupFit, Identified, Minimum, State, probability};
use crate::number::{fixed, number};
use crate::provenance::Provenance;

/// What was found.
pub struct Told<'a> {
    pub name: &'a str,
    pub found: &'a Identified,
    /// Of each joint that was inspected.
    pub clocks: &'a [Clocks],
    /// Size of each parameter's unit in SI, and that SI unit.
    pub units: &'a [(f64, String)],
}

pub fn answer(told: &Told<'_>, provenance: &Provenance) -> Answer {
    let found = told.found;
    let size = |name: &str| {
        let named = found.parameters.iter().zip(told.units).find(|(one, _)| one.free.name == name);
        named.map_or(1.0, |(_, (size, _))| *size)
    };
    let minimum = |one: &Minimum| MinimumAnswer {
        values: one.values.iter().zip(told.units).map(|(value, (size, _))| value * size).collect(),
        over_best: one.over_best,
        searches: one.searches,
    };
    let json = IdentifyAnswer {
        name: told.name,
        parameters: found
            .parameters
            .iter()
            .zip(told.units)
            .map(|(one, unit)| ParameterAnswer::new(one, unit))
            .collect(),
        set: found.set_words(),
        correlations: &found.correlations,
        directions: found.directions.iter().map(DirectionAnswer::from).collect(),
        combinations: found.combinations.iter().map(|one| CombinationAnswer::new(one, size)).collect(),
        groups: found.groups.iter().map(GroupAnswer::from).collect(),
        misfit: found.misfit.map(|one| MisfitAnswer {
            chi_squared: one.chi_squared,
            degrees: one.degrees,
            p: one.p,
        }),
        minima: found.minima.iter().map(minimum).collect(),
        degrees_of_freedom: found.degrees,
        log_likelihood: found.log_likelihood,
        aic: found.aic,
        converged: found.converged,
        runs: found.runs,
        clocks: told.clocks.iter().map(ClocksAnswer::from).collect(),
        warnings: found.warnings.iter().map(|warning| IdentifyWarning::new(warning)).collect(),
    };
    Answer::new(text(told), json, Some(provenance))
}

fn text(told: &Told<'_>) -> String {
    let found = told.found;
    let readings: usize = found.groups.iter().map(|group| group.at.len()).sum();
    let mut text = format!(
        "{}: {} from {}, {}\n\n",
        told.name,
        plural(found.parameters.len() as u64, "parameter", "parameters"),
        plural(readings as u64, "reading", "readings"),
        plural(found.runs, "run", "runs"),
    );
    let rows: Vec<Vec<String>> = found.parameters.iter().map(row).collect();
    let head = ["parameter", "estimate", "std. error", "95 % interval", "unit"];
    text.push_str(&table(&head, &rows));
    for combination in &found.combinations {
        let _ = writeln!(text, "  known together: {}", combined(combination));
    }
    let _ = writeln!(
        text,
        "\n{}",
        table(&["readings of", "number", "unit", "noise", "", "residuals"], &groups(told)).trim_end()
    );
    if let Some(misfit) = found.misfit {
        let _ = writeln!(
            text,
            "  chi-squared {} of {} degrees of freedom, p {}",
            number(misfit.chi_squared),
            misfit.degrees,
            probability(misfit.p)
        );
    }
    correlations(&mut text, told);
    if found.minima.len() > 1 {
        let _ = writeln!(text, "\nminima, by the sum of squares over the best");
        let names = found.parameters.iter().map(|one| one.free.name.as_str());
        let head: Vec<&str> = names.chain(["squares", "searches"]).collect();
        let row = |one: &Minimum| {
            let values = one.values.iter().map(|value| number(*value));
            values.chain([number(one.over_best), one.searches.to_string()]).collect()
        };
        text.push_str(&table(&head, &found.minima.iter().map(row).collect::<Vec<_>>()));
    }
    for clocks in told.clocks {
        let _ = writeln!(
            text,
            "\nwear of {} by the physics: ln L {}, AIC {}; by a power law: ln L {}, AIC {}, exponent {} ({}); the physics is near \
             exponent {}: {}",
            clocks.joint,
            number(clocks.physics.log_likelihood),
            number(clocks.physics.aic),
            number(clocks.power.log_likelihood),
            number(clocks.power.aic),
            number(clocks.exponent),
            interval(clocks.interval),
            number(clocks.physics_exponent),
            clocks.verdict()
        );
    }
    for warning in &found.warnings {
        let _ = writeln!(text, "\nwarning: {warning}");
    }
    let words: Vec<String> = found.set_words().iter().map(|word| format!("--set \"{word}\"")).collect();
    if !words.is_empty() {
        let _ = write!(text, "\n{}", words.join(" "));
    }
    text
}

fn row(one: &Estimated) -> Vec<String> {
    let unit = if one.free.unit.is_empty() { "1".to_owned() } else { one.free.unit.clone() };
    let cells = match one.state {
        State::Estimated => {
            let mut ends = interval(one.interval);
            if one.by_profile {
                ends.push_str(", by profile");
            }
            [number(one.value), one.error.map_or_else(String::new, number), ends]
        }
        State::AtLower => [String::new(), String::new(), format!("at or below {}", number(one.free.lower))],
        State::AtUpper => [String::new(), String::new(), format!("at or above {}", number(one.free.upper))],
        State::NotIdentified => [String::new(), String::new(), "not identified".to_owned()],
    };
    [one.free.name.clone()].into_iter().chain(cells).chain([unit]).collect()
}

fn interval([lower, upper]: [Option<f64>; 2]) -> String {
    match (lower, upper) {
        (Some(lower), Some(upper)) => format!("{} to {}", number(lower), number(upper)),
        (Some(lower), None) => format!("from {}", number(lower)),
        (None, Some(upper)) => format!("to {}", number(upper)),
        (None, None) => "as wide as its bounds".to_owned(),
    }
}

/// `k^1 hardness^-1 = 2.9e-18 (2.8e-18 to 3.0e-18)`.
fn combined(one: &Combination) -> String {
    let part = |(name, part): &(String, f64)| {
        let rounded = (100.0 * part).round() / 100.0;
        match one.is_product {
            true if rounded == 1.0 => name.clone(),
            true => format!("{name}^{rounded}"),
            false => format!("{rounded} {name}"),
        }
    };
    let parts: Vec<String> = one.parts.iter().map(part).collect();
    let joined = parts.join(if one.is_product { " " } else { " + " });
    format!("{joined} = {} ({})", number(one.value), interval(one.interval.map(Some)))
}

fn groups(told: &Told<'_>) -> Vec<Vec<String>> {
    let row = |group: &GroupFit| {
        let given = if group.noise_is_given { "given" } else { "estimated" };
        let residuals = match group.whiteness.p {
            None => "too few to judge".to_owned(),
            Some(p) if group.whiteness.is_doubtful() => {
                format!(
                    "hang together (p {}), {} count as one",
                    probability(p),
                    number(group.whiteness.per_independent)
                )
            }
            Some(p) => format!("as noise (p {})", probability(p)),
        };
        let cells =
            [&group.name, &group.at.len().to_string(), &group.unit, &number(group.noise), given, &residuals];
        cells.map(str::to_owned).to_vec()
    };
    told.found.groups.iter().map(row).collect()
}

fn correlations(text: &mut String, told: &Told<'_>) {
    let estimated = |at: &usize| told.found.parameters[*at].state == State::Estimated;
    let places: Vec<usize> = (0..told.found.parameters.len()).filter(estimated).collect();
    if places.len() < 2 {
        return;
    }
    let name = |at: usize| told.found.parameters[at].free.name.clone();
    let row = |at: &usize| {
        let cells = places.iter().map(|other| {
            told.found.correlations[*at][*other].map_or_else(String::new, |value| fixed(value, 3))
        });
        [name(*at)].into_iter().chain(cells).collect::<Vec<_>>()
    };
    let head: Vec<String> =
        ["correlation".to_owned()].into_iter().chain(places.iter().map(|at| name(*at))).collect();
    let _ = writeln!(text, "\n{}", table(&head, &places.iter().map(row).collect::<Vec<_>>()).trim_end());
}
