//! A predicted life, for people and for machines. In: an [`Answer`]. Out: text or JSON. Never knows how it was found.

use std::fmt::Write as _;

use linkwear_gamma::life::{Band, Contribution, ErrorBudget};
use serde_json::{Value, json};

use super::predict::Answer;
use super::table::{number, table};

/// Every how many-th time is shown to people.
const STRIDE: usize = 5;

/// One JSON object.
pub fn machine(answer: &Answer) -> Value {
    let moments = answer.moments.as_ref();
    let names = ["p10", "p50", "p90"];
    let quantile = |at: usize| answer.quantiles[at].value;
    let bands: serde_json::Map<String, Value> =
        names.iter().zip(&answer.quantiles).map(|(name, band)| ((*name).to_owned(), ends(band))).collect();
    let reliability: Vec<Value> = answer
        .course
        .iter()
        .map(|(t, band, _)| {
            json!({ "time": t, "reliability": band.value, "lower": band.lower, "upper": band.upper })
        })
        .collect();
    let hazard: Vec<Value> =
        answer.course.iter().map(|(t, _, hazard)| json!({ "time": t, "hazard": hazard })).collect();
    json!({
        "from": answer.from,
        "threshold": answer.threshold,
        "current": answer.current,
        "mean": moments.map(|(moments, _)| moments.mean),
        "std": moments.map(|(moments, _)| moments.std),
        "cov": moments.map(|(moments, _)| moments.cov()),
        "mean_whole_cycles": answer.whole.map(|whole| whole.mean),
        "std_whole_cycles": answer.whole.map(|whole| whole.std),
        "quantiles": { "p10": quantile(0), "p50": quantile(1), "p90": quantile(2) },
        "interval95": { "lower": answer.interval.0, "upper": answer.interval.1 },
        "bands": { "mean": moments.map(|(_, band)| ends(band)), "quantiles": bands },
        "reliability": reliability,
        "hazard": hazard,
        "budget": answer.budget.as_ref().map(budget),
        "warnings": answer.warnings,
    })
}

fn ends(band: &Band) -> Value {
    json!({ "lower": band.lower, "upper": band.upper })
}

fn budget(budget: &ErrorBudget) -> Value {
    let entry = |part: Contribution| match part {
        Contribution::Random(half) => json!({ "half_width": half, "kind": "random" }),
        Contribution::Bound(half) => json!({ "half_width": half, "kind": "bound" }),
        Contribution::None(reason) => json!({ "half_width": 0.0, "kind": "none", "reason": reason }),
    };
    let mut object: serde_json::Map<String, Value> =
        budget.parts().into_iter().map(|(name, part)| (name.to_owned(), entry(part))).collect();
    object.insert("total".to_owned(), json!(budget.total()));
    Value::Object(object)
}

/// Text for people.
pub fn human(answer: &Answer) -> String {
    let mut text = format!(
        "remaining life from wear {} to {}, by {}\n\n",
        number(answer.current),
        number(answer.threshold),
        answer.from
    );
    let mut rows = Vec::new();
    let mut row = |name: &str, band: &Band| {
        rows.push(vec![
            name.to_owned(),
            format!("{:.6}", band.value),
            format!("{:.6}", band.lower),
            format!("{:.6}", band.upper),
        ]);
    };
    for (name, band) in ["B10", "B50", "B90"].into_iter().zip(&answer.quantiles) {
        row(name, band);
    }
    if let Some((_, band)) = &answer.moments {
        row("mean", band);
    }
    text.push_str(&table(&["", "time", "lower 95 %", "upper 95 %"], &rows));
    let (lower, upper) = answer.interval;
    let _ = writeln!(text, "\n95 % of lives end between {lower:.6} and {upper:.6}");
    if let (Some((moments, _)), Some(whole)) = (&answer.moments, &answer.whole) {
        let _ = writeln!(
            text,
            "standard deviation {:.6}, coefficient of variation {:.5}; in whole units of time: mean {:.4}",
            moments.std,
            moments.cov(),
            whole.mean
        );
    }
    let course: Vec<Vec<String>> = answer
        .course
        .iter()
        .step_by(STRIDE)
        .map(|(t, band, hazard)| {
            let share = |value: f64| format!("{value:.5}");
            vec![number(*t), share(band.value), share(band.lower), share(band.upper), number(*hazard)]
        })
        .collect();
    text.push('\n');
    text.push_str(&table(&["time", "reliability", "lower 95 %", "upper 95 %", "hazard"], &course));
    if let Some(budget) = &answer.budget {
        let _ = writeln!(text, "\nerror budget of the mean, half-widths at 95 %\n{budget}");
    }
    for warning in &answer.warnings {
        let _ = writeln!(text, "\nwarning: {warning}");
    }
    text.trim_end().to_owned()
}
