//! Fits for people and for machines. In: analyses. Out: text and JSON. Never knows how they came about.

use std::fmt::Write as _;

use linkwear_gamma::fit::{Bootstrap, Fit, Interval, LikelihoodRatio};
use serde_json::{Value, json};

use super::super::arguments::FitArguments;
use super::super::table::{number, table};
use super::{Analysis, LEVEL};

pub fn machine(
    arguments: &FitArguments,
    pooled: &Analysis,
    parts: &[Analysis],
    test: Option<LikelihoodRatio>,
) -> Value {
    let mut value = one(arguments, pooled);
    if !parts.is_empty() {
        value["groups"] = parts.iter().map(|part| one(arguments, part)).collect();
        value["group_test"] = test.map_or(
            Value::Null,
            |test| json!({ "statistic": test.statistic, "degrees": test.degrees, "p_value": test.p_value }),
        );
    }
    value
}

/// What a prediction needs: the fit, and whether its exposure is Lambda already.
pub fn fitted(arguments: &FitArguments, fit: &Fit) -> Value {
    let mut value = json!(fit);
    value["over_lambda"] = json!(arguments.lambda.is_some());
    value
}

fn warnings(fit: &Fit) -> Vec<&'static str> {
    if fit.units == 1 { vec!["one unit only; how units differ cannot be seen"] } else { Vec::new() }
}

fn one(arguments: &FitArguments, own: &Analysis) -> Value {
    let fit = &own.fit;
    let errors = fit.standard_errors();
    let mut value = fitted(arguments, fit);
    let more = json!({
        "name": own.name,
        "se_alpha": errors[0], "se_beta": errors[1],
        "se_exponent": fit.exponent.map(|_| errors[2]),
        "aic": fit.aic(), "bic": fit.bic(),
        "parameters": own.parameters,
        "standard_errors": errors,
        "profile_intervals": intervals(own, |at| own.intervals[at]),
        "bootstrap_intervals": own.bootstrap.as_ref().map(|drawn| intervals(own, |at| drawn.interval(at, LEVEL))),
        "bootstrap": { "replicates": arguments.bootstrap, "seed": arguments.seed,
            "failed": own.bootstrap.as_ref().map(|drawn| drawn.failed) },
        "level": LEVEL,
        "first_order_bias": own.bias,
        "resolution": arguments.resolution,
        "goodness": {
            "kolmogorov_smirnov": own.goodness.kolmogorov_smirnov,
            "anderson_darling": own.goodness.anderson_darling,
            "p_kolmogorov_smirnov": p_values(own).map(|p| p.0),
            "p_anderson_darling": p_values(own).map(|p| p.1),
            "quantiles": own.goodness.quantiles,
        },
        "comparison": comparison(own),
        "warnings": warnings(fit),
    });
    for (key, entry) in more.as_object().into_iter().flatten() {
        value[key] = entry.clone();
    }
    value
}

fn intervals(own: &Analysis, of: impl Fn(usize) -> Option<Interval>) -> Value {
    let pair = |at: usize| of(at).map(|interval| [interval.low, interval.high]);
    own.parameters.iter().enumerate().map(|(at, name)| (name.clone(), json!(pair(at)))).collect()
}

fn p_values(own: &Analysis) -> Option<(f64, f64)> {
    own.bootstrap.as_ref().map(|drawn| {
        (
            Bootstrap::p_value(&drawn.kolmogorov_smirnov, own.goodness.kolmogorov_smirnov),
            Bootstrap::p_value(&drawn.anderson_darling, own.goodness.anderson_darling),
        )
    })
}

fn comparison(own: &Analysis) -> Vec<Value> {
    let of_rival = own.rivals.iter().map(|(name, rival)| match rival {
        Ok(rival) => json!({
            "process": name, "log_likelihood": rival.log_likelihood, "aic": rival.aic,
            "drift": rival.drift, "spread": rival.spread, "shape": rival.shape,
        }),
        Err(error) => json!({ "process": name, "log_likelihood": Value::Null, "why": error.to_string() }),
    });
    let of_rival: Vec<Value> = of_rival.collect();
    if of_rival.is_empty() {
        return of_rival;
    }
    let gamma = json!({ "process": "Gamma", "log_likelihood": own.fit.log_likelihood, "aic": own.fit.aic() });
    [vec![gamma], of_rival].concat()
}

pub fn human(
    arguments: &FitArguments,
    pooled: &Analysis,
    parts: &[Analysis],
    test: Option<LikelihoodRatio>,
) -> String {
    let mut text = String::new();
    for own in parts.iter().chain([pooled]) {
        if !parts.is_empty() {
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
    text.trim_end().to_owned()
}

fn part(text: &mut String, arguments: &FitArguments, own: &Analysis) {
    let fit = &own.fit;
    let _ = writeln!(
        text,
        "Gamma process of {} over {}{}: {} increments of {} unit(s)\n",
        fit.wear_unit,
        fit.exposure_unit,
        if arguments.power_law { "^exponent" } else { "" },
        fit.n,
        fit.units
    );
    let errors = fit.standard_errors();
    let span = |interval: Option<Interval>| {
        interval.map_or_else(|| "open".to_owned(), |i| format!("{} .. {}", number(i.low), number(i.high)))
    };
    let rows: Vec<Vec<String>> = (0..own.parameters.len())
        .map(|at| {
            let mut row = vec![
                own.parameters[at].clone(),
                format!("{:.8}", own.values[at]),
                number(errors[at]),
                span(own.intervals[at]),
            ];
            row.extend(own.bootstrap.as_ref().map(|drawn| span(drawn.interval(at, LEVEL))));
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
        fit.aic(),
        fit.bic()
    );
    fit_quality(text, own);
    for warning in warnings(fit) {
        let _ = writeln!(text, "warning: {warning}");
    }
    if !own.rivals.is_empty() {
        let mut rows =
            vec![vec!["Gamma".to_owned(), format!("{:.5}", fit.log_likelihood), format!("{:.3}", fit.aic())]];
        rows.extend(own.rivals.iter().map(|(name, rival)| match rival {
            Ok(rival) => {
                vec![(*name).to_owned(), format!("{:.5}", rival.log_likelihood), format!("{:.3}", rival.aic)]
            }
            Err(_) => vec![(*name).to_owned(), String::new(), "not for these data".to_owned()],
        }));
        let _ = write!(text, "\n{}", table(&["process", "log-likelihood", "AIC"], &rows));
    }
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
        None => writeln!(text, "goodness of fit: D = {ks:.4}, A^2 = {ad:.4}; p-values with --bootstrap N"),
    };
}
