//! Fits for people and for machines. In: analyses. Out: text and JSON. Never knows how they came about.

use std::fmt::Write as _;

use crate::number::{fixed, number};
use crate::provenance::Provenance;
use linkwear_gamma::fit::{Bootstrap, Fit, Heterogeneity, Interval, LikelihoodRatio};
use linkwear_gamma::process::Process;
use serde_json::{Map, Value, json};

use super::super::answer::Answer;
use super::super::answer::fit::{
    BootstrapAnswer, ComparedAnswer, CriteriaAnswer, FitAnswer, GoodnessAnswer, GroupsAnswer, OneFit,
    RatioAnswer,
};
use super::super::arguments::FitArguments;
use super::super::table::table;
use super::analysis::{Analysis, Compared, LEVEL, takes_as_exact};

/// The fit of all readings, and of each group where there are groups.
pub fn answer(
    arguments: &FitArguments,
    pooled: &Analysis,
    groups: &[Analysis],
    test: Option<LikelihoodRatio>,
    provenance: &Provenance,
) -> Answer {
    let of_groups = (!groups.is_empty()).then(|| GroupsAnswer {
        groups: groups.iter().map(|group| one(arguments, group)).collect(),
        group_test: test.map(|LikelihoodRatio { statistic, degrees, p_value }| RatioAnswer {
            statistic,
            degrees,
            p_value,
        }),
    });
    let told = FitAnswer { all: one(arguments, pooled), groups: of_groups };
    let mut text = String::new();
    for own in groups.iter().chain([pooled]) {
        if !groups.is_empty() {
            let _ = writeln!(text, "{}", own.name);
        }
        part(&mut text, arguments, own);
        text.push('\n');
    }
    if let Some(test) = test {
        let _ = writeln!(
            text,
            "one process for all groups: likelihood ratio {:.2} on {} degrees of freedom, p = {}",
            test.statistic,
            test.degrees,
            number(test.p_value)
        );
    }
    Answer::new(text, told, Some(provenance))
}

/// Probability of so bad a fit below which its reader is warned: a true process is called bad in one fit of a hundred.
const REJECTED: f64 = 0.01;

fn warnings(arguments: &FitArguments, own: &Analysis) -> Vec<String> {
    let one = own.file.units == 1;
    let mut warnings: Vec<String> =
        one.then(|| "one unit only; how units differ cannot be seen".to_owned()).into_iter().collect();
    if own.comments_like_rows > 0 {
        warnings.push(format!(
            "{} line(s) that look like readings begin with #, so they are comments; put names that begin with # in quotes",
            own.comments_like_rows
        ));
    }
    if let Some(first) = own.shared.first() {
        let more = match own.shared.len() - 1 {
            0 => String::new(),
            more => format!(" (and {more} more)"),
        };
        warnings.push(format!(
            "unit {first}{more} is in several groups: it is taken as another unit in each, and wear between them counts in none"
        ));
    }
    if own.enter_unseen {
        warnings.push(match own.units {
            None => "units that entered below a limit are followed from their entry on only: where units are alike their increments \
                     say the same of all; --random-effects counts what was selected, --from-zero what they wore before".to_owned(),
            Some(_) => "the goodness of fit does not count that units entered below a limit; with --bootstrap its p does".to_owned(),
        });
    }
    if own.bounds > 0 {
        warnings.push(format!("the goodness of fit passes over {} increment(s) with bounds", own.bounds));
    }
    let p = p_anderson_darling(own);
    // Transforms that leave the selection out say nothing of the fit, but for the bootstrap, which leaves it out alike.
    let is_comparable = !own.enter_unseen || own.units.is_none() || own.bootstrap.is_some();
    if p < REJECTED && is_comparable {
        let mut cures = Vec::new();
        if !arguments.power_law && arguments.lambda.is_none() {
            cures.push("wear that slows down or speeds up with exposure: --power-law");
        }
        if arguments.covariates().next().is_none() && arguments.groups.is_none() {
            cures.push("units that ran under different loads: --covariate COL or --groups COL");
        }
        if own.units.is_none() && !one {
            cures.push("units that differ: --random-effects");
        }
        if own.alternatives.is_empty() {
            cures.push("another process: --compare");
        }
        cures.push("readings that are wrong");
        let cures = cures.join("; ");
        warnings.push(format!(
            "the data reject this fit (A^2 = {:.3}, p = {}, below {REJECTED}): predictions from it are wrong. Look for: {cures}",
            own.goodness.anderson_darling,
            number(p)
        ));
    }
    warnings
}

fn one<'a>(arguments: &FitArguments, own: &'a Analysis) -> OneFit<'a> {
    let fit = &own.fit;
    let errors = fit.standard_errors();
    let by_name = fit.model.process.parameters().into_iter().zip(&errors);
    OneFit {
        file: own.file.to_json().as_object().cloned().unwrap_or_default(),
        name: &own.name,
        standard_errors_by_name: by_name.map(|(name, error)| (format!("se_{name}"), json!(error))).collect(),
        se_exponent: fit.exponent().map(|_| errors[2]),
        se_cv: fit.cv().and_then(|_| errors.last().copied()),
        aic: own.aic(),
        bic: own.bic(),
        parameters: own.file.names(),
        standard_errors: errors,
        profile_intervals: intervals(own, |at| own.intervals[at]),
        bootstrap_intervals: own
            .bootstrap
            .as_ref()
            .map(|drawn| intervals(own, |at| drawn.interval(&own.fit, at, LEVEL))),
        bootstrap: BootstrapAnswer {
            replicates: arguments.bootstrap,
            seed: arguments.seed,
            failed: own.bootstrap.as_ref().map(|drawn| drawn.failed),
        },
        level: LEVEL,
        first_order_bias: own.bias,
        goodness: GoodnessAnswer {
            kolmogorov_smirnov: own.goodness.kolmogorov_smirnov,
            anderson_darling: own.goodness.anderson_darling,
            p_kolmogorov_smirnov: p_values(own).map(|p| p.0),
            p_anderson_darling: p_anderson_darling(own),
            p_values_by: if own.bootstrap.is_some() { "bootstrap" } else { "asymptotic" },
            quantiles: &own.goodness.quantiles,
        },
        comparison: comparison(own),
        compare: own.compared.iter().map(|row| compared(row, own)).collect(),
        warnings: warnings(arguments, own),
    }
}

fn intervals(own: &Analysis, of: impl Fn(usize) -> Option<Interval>) -> Map<String, Value> {
    let end = |value: f64| value.is_finite().then_some(value);
    let pair = |at: usize| of(at).map(|interval| [end(interval.low), end(interval.high)]);
    own.file.names().into_iter().enumerate().map(|(at, name)| (name, json!(pair(at)))).collect()
}

fn p_values(own: &Analysis) -> Option<(f64, f64)> {
    own.bootstrap.as_ref().map(|drawn| {
        (
            Bootstrap::p_value(&drawn.kolmogorov_smirnov, own.goodness.kolmogorov_smirnov),
            Bootstrap::p_value(&drawn.anderson_darling, own.goodness.anderson_darling),
        )
    })
}

/// By bootstrap where there is one; otherwise for many increments.
fn p_anderson_darling(own: &Analysis) -> f64 {
    p_values(own).map_or_else(|| own.goodness.asymptotic_p(), |p| p.1)
}

fn compared(row: &Compared, own: &Analysis) -> CriteriaAnswer {
    let found = row.found.as_ref();
    CriteriaAnswer {
        process: row.process.name(),
        random: row.random,
        log_likelihood: found.ok().map(|found| found.log_likelihood),
        aic: found.ok().map(|found| found.aic),
        bic: found.ok().map(|found| found.bic),
        boundary: row.random.then(|| found.is_ok_and(|found| found.boundary)),
        exact_readings: takes_as_exact(row.process, &own.fit),
        why: found.err().map(ToString::to_string),
    }
}

fn comparison(own: &Analysis) -> Vec<ComparedAnswer> {
    if own.alternatives.is_empty() {
        return Vec::new();
    }
    let named = |process: &dyn Process| ComparedAnswer {
        process: process.title().to_owned(),
        log_likelihood: None,
        aic: None,
        parameters: Map::new(),
        shape: None,
        exact_readings: takes_as_exact(process, &own.fit),
        why: None,
    };
    let fitted = |process: &dyn Process, fit: &Fit| ComparedAnswer {
        log_likelihood: Some(fit.log_likelihood),
        aic: Some(fit.aic()),
        ..named(process)
    };
    let others = own.alternatives.iter().map(|(process, found)| match found {
        Ok(fit) => {
            let found = fit.parameters();
            let by_name = process.parameters().into_iter().zip(&found);
            ComparedAnswer {
                parameters: by_name.map(|(name, value)| (name.to_owned(), json!(value))).collect(),
                shape: found.get(2..).map(<[f64]>::to_vec),
                ..fitted(*process, fit)
            }
        }
        Err(error) => ComparedAnswer { why: Some(error.to_string()), ..named(*process) },
    });
    // Of units alike, as the others are: criteria of models with units that differ stand in `compare`.
    let alike = own.units.as_ref().map_or(&own.fit, |found| &found.plain);
    [fitted(own.fit.model.process, alike)].into_iter().chain(others).collect()
}

fn part(text: &mut String, arguments: &FitArguments, own: &Analysis) {
    let fit = &own.fit;
    let _ = writeln!(
        text,
        "{} process of {} over {}{}: {} increments of {} unit(s)\n",
        capital(fit.model.process.title()),
        own.file.wear_unit,
        own.file.exposure_unit,
        if arguments.power_law { "^exponent" } else { "" },
        fit.increments,
        own.file.units
    );
    let errors = fit.standard_errors();
    let span = |interval: Option<Interval>| {
        let end = |value: f64, open: &str| match value.is_finite() {
            true => number(value),
            false => open.to_owned(),
        };
        let ends =
            |i: Interval| format!("{} .. {}", end(i.low, "no lower bound"), end(i.high, "no upper bound"));
        interval.map_or_else(|| "not found".to_owned(), ends)
    };
    let rows: Vec<Vec<String>> = own
        .file
        .names()
        .into_iter()
        .zip(fit.parameters())
        .enumerate()
        .map(|(at, (name, value))| {
            let mut row = vec![name, fixed(value, 8), number(errors[at]), span(own.intervals[at])];
            row.extend(own.bootstrap.as_ref().map(|drawn| span(drawn.interval(&own.fit, at, LEVEL))));
            row
        })
        .collect();
    let mut head = vec!["parameter", "estimate", "std error", "95 % by profile"];
    head.extend(own.bootstrap.as_ref().map(|_| "95 % by bootstrap"));
    text.push_str(&table(&head, &rows));
    let _ = writeln!(
        text,
        "\nlog-likelihood {:.8}, AIC {:.4}, BIC {:.4}",
        fit.log_likelihood,
        own.aic(),
        own.bic()
    );
    if let Some(found) = &own.units {
        of_units(text, found);
    }
    fit_quality(text, own);
    for warning in warnings(arguments, own) {
        let _ = writeln!(text, "warning: {warning}");
    }
    if !own.compared.is_empty() {
        let row = |row: &Compared| {
            let units = match &row.found {
                _ if !row.random => "alike",
                Ok(found) if found.boundary => "no difference",
                _ => "differ",
            };
            let exact = if takes_as_exact(row.process, fit) { " (exact readings)" } else { "" };
            let mut cells = vec![format!("{}{exact}", row.process.title()), units.to_owned()];
            match &row.found {
                Ok(found) => {
                    cells.push(format!("{:.5}", found.log_likelihood));
                    cells.extend([found.aic, found.bic].map(|value| format!("{value:.3}")));
                }
                Err(_) => cells.extend([String::new(), "not for these data".to_owned(), String::new()]),
            }
            cells
        };
        let rows: Vec<Vec<String>> = own.compared.iter().map(row).collect();
        let _ = write!(text, "\n{}", table(&["process", "units", "log-likelihood", "AIC", "BIC"], &rows));
        if own.compared.iter().any(|row| takes_as_exact(row.process, fit)) {
            let _ = writeln!(
                text,
                "processes with exact readings do not know --resolution: the coarser it is, the less their criteria may be compared \
                 with those of the {} process",
                fit.model.process.title()
            );
        }
    }
}

/// How units differ, and whether they do.
fn of_units(text: &mut String, found: &Heterogeneity) {
    let fit = &found.fit;
    if let (Some(cv), Some(effect)) = (fit.cv(), fit.model.process.random_effect()) {
        let own = effect.numbers(fit.logs(), cv);
        let law = match (own.shape, own.rate) {
            (Some(shape), Some(rate)) => format!("shape {}, rate {}", number(shape), number(rate)),
            _ => format!("mean {}, standard deviation {}", number(own.mean), number(own.std)),
        };
        let _ = writeln!(
            text,
            "units differ: {} of a unit has a {} law, {law}: coefficient of variation {}",
            effect.parameter(),
            effect.law(),
            number(cv)
        );
    }
    let _ = match found.boundary {
        true => writeln!(
            text,
            "units: no difference found; the likelihood is largest where all {} are alike",
            found.units
        ),
        false => writeln!(
            text,
            "units alike: log-likelihood {:.8}, likelihood ratio {:.4}, p = {} (for many units {})",
            found.plain.log_likelihood,
            found.test.statistic,
            number(found.test.p_value),
            number(found.test.asymptotic_p)
        ),
    };
}

/// With a capital letter.
fn capital(title: &str) -> String {
    let mut letters = title.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn fit_quality(text: &mut String, own: &Analysis) {
    let (ks, ad) = (own.goodness.kolmogorov_smirnov, own.goodness.anderson_darling);
    let _ = match p_values(own) {
        Some((p_ks, p_ad)) => writeln!(
            text,
            "goodness of fit: D = {ks:.4} (p = {}), A^2 = {ad:.4} (p = {}), p by parametric bootstrap",
            number(p_ks),
            number(p_ad)
        ),
        None => writeln!(
            text,
            "goodness of fit: D = {ks:.4}, A^2 = {ad:.4} (p = {}), p for many increments; exact with --bootstrap N",
            number(p_anderson_darling(own))
        ),
    };
}
