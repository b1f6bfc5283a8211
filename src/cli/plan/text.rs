//! Plans for people. In: what was found. Out: text. Never knows how.

use std::fmt::Write as _;

use super::super::answer::common::Ends;
use super::super::answer::plan::{ByLooksAnswer, CountAnswer, PlanAnswer};
use super::super::arguments::PlanArguments;
use super::super::table::table;
use crate::number::{fixed, number};

/// All of it.
pub fn text(arguments: &PlanArguments, told: &PlanAnswer) -> String {
    let unit = if told.from == "lives" { "cycle" } else { "unit of time" };
    let mut text = format!("what replacements cost per {unit} in the long run, by {}\n\n", told.from);
    let percent = |part: f64| format!("{} %", fixed(100.0 * part, 2));
    let waiting = told.at_failure.cost_rate;
    let row = |plan: String, rate: f64, fail: f64| {
        vec![plan, number(rate), percent(1.0 - rate / waiting), percent(fail)]
    };
    let mut rows = vec![row("replace at failure".to_owned(), waiting, 1.0)];
    match told.by_age.age {
        Some(age) => {
            rows.push(row(format!("replace at age {}", number(age)), told.by_age.cost_rate, told.by_age.fail))
        }
        None => rows.push(vec![
            "replace at an age".to_owned(),
            "does not pay".to_owned(),
            String::new(),
            String::new(),
        ]),
    }
    if let Some(looks) = &told.by_looks {
        let replaced = match (looks.threshold, looks.last_look) {
            (Some(wear), _) => format!("replace from wear {}", number(wear)),
            (None, Some(last)) => format!("replace what has failed, and all at look {last}"),
            (None, None) => "replace what has failed".to_owned(),
        };
        let plan = format!("look every {}, {replaced}", number(looks.interval));
        rows.push(row(plan, looks.cost_rate, looks.fail));
    }
    text.push_str(&table(&["plan", "cost", "saved", "fail in use"], &rows));
    bands(&mut text, told);
    if let Some(looks) = &told.by_looks {
        let _ = write!(
            text,
            "\nfailures are noticed {}; {} looks at a part",
            looks.failures,
            number(looks.looks)
        );
        if looks.unnoticed > 0.0 {
            let _ = write!(text, ", {} with a failure unnoticed", number(looks.unnoticed));
        }
        text.push('\n');
    }
    if let Some(look) = &told.look {
        let _ = writeln!(text, "\na look {} from now is worth {}", number(look.at), number(look.value));
        let then =
            look.replace_after.map_or("at failure".to_owned(), |at| format!("{} from now", number(at)));
        let _ = writeln!(
            text,
            "  without it the part is replaced {then}; until the look {} fail, and it has {} replaced at once",
            percent(look.fails_before),
            percent(look.replaced_at_once)
        );
    }
    if let Some(spares) = &told.spares {
        let _ = writeln!(
            text,
            "\nspares for {} part(s) over {}, enough with {}\n",
            spares.parts,
            number(spares.horizon),
            percent(arguments.confidence)
        );
        let row = |plan: &str, count: &CountAnswer| {
            vec![plan.to_owned(), number(count.mean), count.needed.to_string(), percent(count.enough)]
        };
        let mut rows = vec![row("replace at failure", &spares.at_failure)];
        rows.extend(spares.by_age.as_ref().map(|count| row("replace at the age above", count)));
        text.push_str(&table(&["plan", "mean", "spares", "enough with"], &rows));
    }
    for warning in &told.warnings {
        let _ = writeln!(text, "\nwarning: {warning}");
    }
    text
}

/// What the fit leaves open.
fn bands(text: &mut String, told: &PlanAnswer) {
    let span = |ends: &Ends| {
        let lower = ends.lower.map_or("never".to_owned(), number);
        format!("{lower} .. {}", ends.upper.map_or("never".to_owned(), number))
    };
    let mut rows = Vec::new();
    let mut add = |plan: &str, decision: String, cost: Option<&Ends>| {
        rows.extend(cost.map(|cost| vec![plan.to_owned(), decision, span(cost)]));
    };
    add("replace at failure", String::new(), told.at_failure.cost_rate_band.as_ref());
    let age = &told.by_age;
    if let Some(best) = &age.age_band {
        let of = age.cost_rate_band.as_ref().filter(|_| age.age.is_some());
        add("replace at that age", span(best), of);
    }
    let looks = told.by_looks.as_ref();
    let best = |looks: &ByLooksAnswer| {
        let every = looks.interval_band.as_ref().map(|ends| format!("every {}", span(ends)));
        let from = looks.threshold_band.as_ref().map(|ends| format!("from wear {}", span(ends)));
        every.into_iter().chain(from).collect::<Vec<_>>().join(", ")
    };
    let cost = looks.and_then(|looks| looks.cost_rate_band.as_ref());
    add("look as above", looks.map(best).unwrap_or_default(), cost);
    if rows.is_empty() {
        return;
    }
    text.push_str("\nwhat the fit leaves open, 95 %\n\n");
    text.push_str(&table(&["plan", "best", "cost"], &rows));
    if let Some(pays) = age.pays.filter(|pays| *pays < 1.0) {
        let _ = writeln!(text, "\nreplacement at an age pays with a probability of {:.0} %", 100.0 * pays);
    }
}
