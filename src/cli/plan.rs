//! `plan`: when to replace a part, when to look at it, how many spares to keep, what a look is worth.

use std::fmt::Write as _;
use std::path::Path;

use linkwear_gamma::FitFile;
use linkwear_gamma::life::{Estimate, LifeError, Lifetime, ObservedLives, OperatingState};
use linkwear_gamma::plan::{
    AgePlan, ConditionPlan, Costs, InUse, Looks, Monitored, PlanError, PlannedLife, Spares, Worth, best_age,
    best_inspection, spares, worth_of_a_look,
};
use serde_json::{Value, json};

use super::answer::Answer;
use super::answer::plan::{
    AtFailureAnswer, ByAgeAnswer, ByLooksAnswer, CountAnswer, LookAnswer, PlanAnswer, SparesAnswer,
};
use super::arguments::PlanArguments;
use super::failure::Failure;
use super::input::{covariates, read_fit};
use super::life::folder::{LIFE_OF_LIVES, LIVES};
use super::table::table;
use crate::checksum::sha256_of;
use crate::csv_table::CsvTable;
use crate::number::number;
use crate::provenance::Provenance;

/// Lives below which the best age is told with a warning: the cost of so few lies some percent too low.
const FEW: usize = 200;

/// What is planned for.
enum Source {
    Fit(Box<(Estimate, OperatingState, FitFile)>),
    Lives(ObservedLives, usize, String),
}

pub fn run(arguments: &PlanArguments) -> Result<Answer, Failure> {
    let source = source(arguments)?;
    let wrong = |error: PlanError| {
        Failure::data(&arguments.file, None, error, "see `linkwear plan --help` for what the options mean")
    };
    let costs = Costs::new(arguments.preventive, arguments.failure)
        .and_then(|costs| costs.taking(arguments.preventive_time, arguments.failure_time))
        .map_err(wrong)?;
    let plans = plans(arguments, &source, &costs).map_err(wrong)?;
    let (from, sha256, warnings) = match &source {
        Source::Fit(fit) => {
            let (.., fit) = &**fit;
            let warnings: Vec<String> = fit.warning().into_iter().map(str::to_owned).collect();
            ("fit", sha256_of(fit.text().as_bytes()), warnings)
        }
        Source::Lives(_, count, sha256) => {
            let few = (*count < FEW).then(|| {
                format!("{count} lives: the cheapest age of so few looks cheaper than it is; live more")
            });
            ("lives", sha256.clone(), few.into_iter().collect())
        }
    };
    let provenance = Provenance::new(sha256, None, options(arguments));
    let told = plans.told(arguments, from, warnings);
    Ok(Answer::new(text(arguments, &told), told, Some(&provenance)))
}

fn source(arguments: &PlanArguments) -> Result<Source, Failure> {
    let file = &arguments.file;
    let folder = file.is_dir().then(|| file.join(LIVES));
    let is_table = file.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv"));
    if let Some(table) = folder.as_deref().or(is_table.then_some(file.as_path())) {
        let needs_wear = [
            ("--threshold", arguments.threshold.is_some()),
            ("--inspection", arguments.inspection.is_some()),
            ("--look-at", arguments.look_at.is_some()),
        ];
        if let Some((option, _)) = needs_wear.iter().find(|(_, given)| *given) {
            let help = "lives tell nothing of the wear on the way: plan looks by a fit (`linkwear fit .. --out fit.json`)";
            return Err(Failure::usage(format!("{option} does not go with lives"), help));
        }
        return lives(table);
    }
    let Some(threshold) = arguments.threshold else {
        return Err(Failure::usage(
            "a fit needs --threshold",
            "give the wear at failure, in the unit of the fit",
        ));
    };
    let fit = read_fit(file)?;
    let estimate = fit.informed(&arguments.covariate).map_err(Failure::fit(file))?;
    let asked = |error: LifeError| {
        Failure::data(file, None, error, "see `linkwear plan --help` for what the options mean")
    };
    let state = OperatingState::of(&estimate, threshold, arguments.rate, (None, None)).map_err(asked)?;
    Ok(Source::Fit(Box::new((estimate, state, fit))))
}

fn lives(file: &Path) -> Result<Source, Failure> {
    let table = CsvTable::read(file)?;
    let lives = table.numbers(LIFE_OF_LIVES)?;
    let law = ObservedLives::of(&lives).map_err(|error| {
        let line = match error {
            LifeError::Life { row, .. } => table.lines().nth(row - 1),
            _ => None,
        };
        Failure::data(file, line, error, "it is the table `life --out` writes")
    })?;
    Ok(Source::Lives(law, lives.len(), table.sha256().to_owned()))
}

/// All that was asked for.
struct Plans {
    age: AgePlan,
    looks: Option<ConditionPlan>,
    look: Option<Worth>,
    spares: Option<(Spares, Option<Spares>)>,
}

fn plans(arguments: &PlanArguments, source: &Source, costs: &Costs) -> Result<Plans, PlanError> {
    let fresh;
    let life: &dyn Lifetime = match source {
        Source::Fit(fit) => {
            let (estimate, state, _) = &**fit;
            fresh = state.life(estimate)?;
            &fresh
        }
        Source::Lives(law, ..) => law,
    };
    let age = best_age(life, costs)?;
    let mut plans = Plans { age, looks: None, look: None, spares: None };
    if let Source::Fit(fit) = source {
        let (estimate, state, _) = &**fit;
        if let Some(inspection) = arguments.inspection {
            let looks = Looks::new(inspection, arguments.downtime)?;
            let (law, clock) = state.wear(estimate)?;
            let part = Monitored::new(law, clock, state.threshold())?;
            let (interval, threshold) = (arguments.interval, arguments.replace_from);
            plans.looks = Some(best_inspection(&part, costs, &looks, interval, threshold)?);
        }
        if let Some(at) = arguments.look_at {
            let now = (arguments.current, arguments.at);
            let used = OperatingState::of(estimate, state.threshold(), arguments.rate, now)?;
            let part = InUse::of(estimate, &used)?;
            plans.look = Some(worth_of_a_look(&part, costs, age.cost_rate, at)?);
        }
    }
    if let (Some(parts), Some(horizon)) = (arguments.parts, arguments.horizon) {
        let of = |age: Option<f64>| spares(&PlannedLife { life, age }, parts, horizon, arguments.confidence);
        let by_age = age.age.map(|at| of(Some(at))).transpose()?;
        plans.spares = Some((of(None)?, by_age));
    }
    Ok(plans)
}

impl Plans {
    fn told(&self, arguments: &PlanArguments, from: &'static str, mut warnings: Vec<String>) -> PlanAnswer {
        let Self { age, .. } = self;
        if self.looks.is_some_and(|plan| plan.at_an_end) {
            warnings.push(
                "the interval is at an end of what was tried, 1/64 to 3 mean lives: looking still more often, or never, may cost less"
                    .to_owned(),
            );
        }
        let count =
            |found: &Spares| CountAnswer { mean: found.mean, needed: found.needed, enough: found.enough };
        PlanAnswer {
            from,
            at_failure: AtFailureAnswer { cost_rate: age.failure_only },
            by_age: ByAgeAnswer {
                age: age.age,
                cost_rate: age.cost_rate,
                fail: age.fail,
                mean_use: age.mean_use,
            },
            by_looks: self.looks.map(|plan| ByLooksAnswer {
                failures: if arguments.downtime.is_none() { "at once" } else { "at a look" },
                interval: plan.interval,
                threshold: plan.threshold,
                cost_rate: plan.cost.rate,
                fail: plan.cost.fail,
                looks: plan.cost.looks,
                cycle: plan.cost.cycle,
                unnoticed: plan.cost.unnoticed,
            }),
            look: self.look.zip(arguments.look_at).map(|(worth, at)| LookAnswer {
                at,
                value: worth.value(),
                without: worth.without,
                with: worth.with,
                replace_after: worth.replace_after,
                fails_before: worth.fails_before,
                replaced_at_once: worth.replaced_at_once,
            }),
            spares: self.spares.as_ref().zip(arguments.parts.zip(arguments.horizon)).map(
                |((at_failure, by_age), (parts, horizon))| SparesAnswer {
                    parts,
                    horizon,
                    confidence: arguments.confidence,
                    at_failure: count(at_failure),
                    by_age: by_age.as_ref().map(count),
                },
            ),
            warnings,
        }
    }
}

/// What decides the numbers.
fn options(arguments: &PlanArguments) -> Value {
    json!({
        "threshold": arguments.threshold, "rate": arguments.rate,
        "covariates": covariates(&arguments.covariate),
        "preventive": arguments.preventive, "failure": arguments.failure,
        "preventive_time": arguments.preventive_time, "failure_time": arguments.failure_time,
        "inspection": arguments.inspection, "downtime": arguments.downtime,
        "interval": arguments.interval, "replace_from": arguments.replace_from,
        "look_at": arguments.look_at, "current": arguments.current, "at": arguments.at,
        "parts": arguments.parts, "horizon": arguments.horizon, "confidence": arguments.confidence,
    })
}

fn text(arguments: &PlanArguments, told: &PlanAnswer) -> String {
    let unit = if told.from == "lives" { "cycle" } else { "unit of time" };
    let mut text = format!("what replacements cost per {unit} in the long run, by {}\n\n", told.from);
    let percent = |part: f64| format!("{:.2} %", 100.0 * part);
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
        let plan =
            format!("look every {}, replace from wear {}", number(looks.interval), number(looks.threshold));
        rows.push(row(plan, looks.cost_rate, looks.fail));
    }
    text.push_str(&table(&["plan", "cost", "saved", "fail in use"], &rows));
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
