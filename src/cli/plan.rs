//! `plan`: when to replace a part, when to look at it, how many spares to keep, what a look is worth.

#[cfg(feature = "page")]
mod drawn;
mod refused;
mod text;

use std::path::Path;

use linkwear_gamma::life::{Estimate, LifeError, Lifetime, ObservedLives, OperatingState, PossibleLives};
use linkwear_gamma::plan::{
    AgeBands, AgePlan, ConditionPlan, Costs, Ends as PlanEnds, HiddenPlan, InUse, LookBands, Looks,
    Monitored, PlanError, PlannedLife, Spares, Standstill, Worth, age_bands, best_age, best_hidden,
    best_inspection, look_bands, spares, worth_of_a_look,
};
use linkwear_gamma::{FitFile, Prediction};
use serde_json::{Value, json};

use self::refused::refused;
use super::answer::Answer;
use super::answer::common::Ends;
use super::answer::plan::{
    AtFailureAnswer, ByAgeAnswer, ByLooksAnswer, CountAnswer, LookAnswer, PlanAnswer, SparesAnswer,
};
use super::arguments::PlanArguments;
use super::failure::Failure;
use super::input::{covariates, read_fit};
use super::life::folder::{LIFE, LIFE_OF_LIVES, LIVES};
#[cfg(feature = "page")]
use super::picture;
use crate::checksum::sha256_of;
use crate::csv_table::CsvTable;
use crate::provenance::Provenance;

/// Lives below which the best age is told with a warning: the cost of so few lies some percent too low.
const FEW: usize = 200;

/// Laws of life that the fit leaves possible: ends of an interval of 95 % are the fifth from either side.
const POSSIBLE: usize = 200;
/// Of these for plans of looks, one of so many: each costs an integral for every look.
const OF_LOOKS: usize = 4;

/// What is planned for.
enum Source {
    Fit(Box<(Estimate, OperatingState, FitFile)>),
    Lives(ObservedLives, usize, String),
}

impl Source {
    /// An answer of the law of life.
    fn with_life<T>(&self, ask: &dyn Fn(&dyn Lifetime) -> Result<T, PlanError>) -> Result<T, PlanError> {
        match self {
            Self::Fit(fit) => {
                let (estimate, state, _) = &**fit;
                ask(&state.life(estimate)?)
            }
            Self::Lives(law, ..) => ask(law),
        }
    }
}

pub fn run(arguments: &PlanArguments) -> Result<Answer, Failure> {
    #[cfg(feature = "page")]
    picture::check_plot(&[&arguments.file], arguments.plot.as_deref(), arguments.replace)?;
    answer(arguments, source(arguments)?)
}

/// By the JSON of a fit, which is called as the file that is asked for.
pub fn by_fit(arguments: &PlanArguments, fit: FitFile) -> Result<Answer, Failure> {
    answer(arguments, of_fit(arguments, fit)?)
}

fn answer(arguments: &PlanArguments, source: Source) -> Result<Answer, Failure> {
    let wrong = |error: PlanError| refused(arguments, &error);
    let costs = Costs::new(arguments.preventive, arguments.failure)
        .and_then(|costs| costs.taking(arguments.preventive_time, arguments.failure_time))
        .map_err(wrong)?;
    let plans = plans(arguments, &source, &costs).map_err(wrong)?;
    #[cfg(feature = "page")]
    if arguments.plot.is_some() {
        let chart = plans.picture(&source, &costs).map_err(wrong)?;
        picture::write_plot(arguments.plot.as_deref(), || chart)?;
    }
    let (from, sha256, warnings) = match &source {
        Source::Fit(fit) => {
            let (.., fit) = &**fit;
            let of_fit = fit.warning().into_iter().map(str::to_owned);
            let warnings: Vec<String> = of_fit.chain(fit.far_covariates(&arguments.covariate)).collect();
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
    Ok(Answer::new(text::text(arguments, &told), told, Some(&provenance)))
}

fn source(arguments: &PlanArguments) -> Result<Source, Failure> {
    let file = &arguments.file;
    let folder = file.is_dir().then(|| file.join(LIVES));
    let is_table = file.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv"));
    if let Some(table) = folder.as_deref().or(is_table.then_some(file.as_path())) {
        let needs_wear = [
            ("--threshold", arguments.threshold.is_some()),
            ("--inspection", arguments.inspection.is_some() && arguments.downtime.is_none()),
            ("--replace-from", arguments.replace_from.is_some()),
            ("--look-at", arguments.look_at.is_some()),
        ];
        if let Some((option, _)) = needs_wear.iter().find(|(_, given)| *given) {
            let help = "lives tell nothing of the wear on the way: plan looks at it by a fit (`linkwear fit .. --out fit.json`); with --downtime, looks find what has failed";
            return Err(Failure::usage(format!("{option} does not go with lives"), help));
        }
        return lives(table);
    }
    if arguments.threshold.is_none() {
        return Err(no_threshold());
    }
    of_fit(arguments, read_fit(file)?)
}

fn no_threshold() -> Failure {
    Failure::usage("a fit needs --threshold", "give the wear at failure, in the unit of the fit")
}

fn of_fit(arguments: &PlanArguments, fit: FitFile) -> Result<Source, Failure> {
    let file = &arguments.file;
    let Some(threshold) = arguments.threshold else { return Err(no_threshold()) };
    let estimate = fit.informed(&arguments.covariate).map_err(Failure::fit(file))?;
    let state = OperatingState::of(&estimate, threshold, arguments.rate, (None, None))
        .map_err(|error| refused(arguments, &error.into()))?;
    Ok(Source::Fit(Box::new((estimate, state, fit))))
}

fn lives(file: &Path) -> Result<Source, Failure> {
    let folder = file.parent().filter(|folder| !file.exists() && folder.join(LIFE).exists());
    if let Some(folder) = folder {
        let help = "live it with random lives: `linkwear life .. --trajectories 1000 --out DIR`";
        let message = format!(
            "no random lives are in this folder ({LIVES}): its life has the mean path alone, which tells no scatter to plan for"
        );
        return Err(Failure::data(folder, None, message, help));
    }
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
    /// Looks that find what has failed.
    hidden: Option<HiddenPlan>,
    look: Option<Worth>,
    spares: Option<(Spares, Option<Spares>)>,
    /// Lives that the fit leaves possible; none where its parameters are taken as known, and of lives.
    possible: PossibleLives,
    open: Option<AgeBands>,
    open_of_looks: Option<LookBands>,
}

fn plans(arguments: &PlanArguments, source: &Source, costs: &Costs) -> Result<Plans, PlanError> {
    let age = source.with_life(&|life| best_age(life, costs))?;
    let mut plans = Plans {
        age,
        looks: None,
        hidden: None,
        look: None,
        spares: None,
        possible: PossibleLives::default(),
        open: None,
        open_of_looks: None,
    };
    if let Source::Fit(fit) = source {
        let (estimate, state, _) = &**fit;
        plans.possible = Prediction::possible_lives(estimate, state, POSSIBLE)?;
        plans.open = age_bands(plans.possible.as_slice(), costs, &plans.age, Prediction::LEVEL);
        if let Some(inspection) = arguments.inspection {
            let looks = Looks::new(inspection, arguments.downtime)?;
            let (law, clock) = state.wear(estimate)?;
            let part = Monitored::new(law, clock, state.threshold())?;
            let (interval, threshold) = (arguments.interval, arguments.replace_from);
            let best = best_inspection(&part, costs, &looks, interval, threshold)?;
            let some = plans.possible.one_of(OF_LOOKS);
            let given = [interval.is_some(), threshold.is_some()];
            let asked = (costs, &looks);
            plans.open_of_looks =
                look_bands(some.as_slice(), state.threshold(), asked, (&best, given), Prediction::LEVEL);
            plans.looks = Some(best);
        }
        if let Some(at) = arguments.look_at {
            let now = (arguments.current, arguments.at);
            let used = OperatingState::of(estimate, state.threshold(), arguments.rate, now)?;
            let part = InUse::of(estimate, &used)?;
            plans.look = Some(worth_of_a_look(&part, costs, age.cost_rate, at)?);
        }
    }
    if let (Source::Lives(law, ..), Some(inspection)) = (source, arguments.inspection) {
        let looks = Looks::new(inspection, arguments.downtime)?;
        plans.hidden = Some(best_hidden(law, costs, &looks, arguments.interval)?);
    }
    if let (Some(parts), Some(horizon)) = (arguments.parts, arguments.horizon) {
        let standstill = Standstill { preventive: costs.preventive_time, failure: costs.failure_time };
        let of = |age: Option<f64>| {
            let asked = (parts, horizon);
            source.with_life(&|life| {
                spares(&PlannedLife { life, age }, standstill, asked, arguments.confidence)
            })
        };
        let by_age = age.age.map(|at| of(Some(at))).transpose()?;
        plans.spares = Some((of(None)?, by_age));
    }
    Ok(plans)
}

impl Plans {
    fn told(&self, arguments: &PlanArguments, from: &'static str, mut warnings: Vec<String>) -> PlanAnswer {
        let Self { age, .. } = self;
        if from == "fit" && self.open.is_none() {
            let why = match self.possible.as_slice().is_empty() {
                true => {
                    "the fit holds neither its increments nor a covariance: what it leaves open is not told"
                }
                false => "what the fit leaves open is too much to plan for: no bands are told",
            };
            warnings.push(why.to_owned());
        }
        if self.looks.is_some_and(|plan| plan.at_an_end) || self.hidden.is_some_and(|plan| plan.at_an_end) {
            warnings.push(
                "the interval is at an end of what was tried, up to 3 mean lives: looking still more often, or never, may cost less"
                    .to_owned(),
            );
        }
        let count =
            |found: &Spares| CountAnswer { mean: found.mean, needed: found.needed, enough: found.enough };
        PlanAnswer {
            from,
            at_failure: AtFailureAnswer {
                cost_rate: age.failure_only,
                cost_rate_band: self.open.map(|open| ends(open.failure_only)),
            },
            by_age: ByAgeAnswer {
                age: age.age,
                age_band: self.open.map(|open| ends(open.age)),
                pays: self.open.map(|open| open.pays),
                cost_rate: age.cost_rate,
                cost_rate_band: self.open.map(|open| ends(open.cost_rate)),
                fail: age.fail,
                mean_use: age.mean_use,
            },
            by_looks: self.by_looks(arguments),
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

impl Plans {
    fn by_looks(&self, arguments: &PlanArguments) -> Option<ByLooksAnswer> {
        let of_wear = self.looks.map(|plan| (plan.interval, Some(plan.threshold), None, plan.cost));
        let of_lives = self.hidden.map(|plan| (plan.interval, None, plan.last, plan.cost));
        of_wear.or(of_lives).map(|(interval, threshold, last_look, cost)| ByLooksAnswer {
            failures: if arguments.downtime.is_none() { "at once" } else { "at a look" },
            interval,
            threshold,
            last_look,
            cost_rate: cost.rate,
            interval_band: self
                .open_of_looks
                .filter(|_| arguments.interval.is_none())
                .map(|open| ends(open.interval)),
            threshold_band: self
                .open_of_looks
                .filter(|_| arguments.replace_from.is_none())
                .map(|open| ends(open.threshold)),
            cost_rate_band: self.open_of_looks.map(|open| ends(open.cost_rate)),
            fail: cost.fail,
            looks: cost.looks,
            cycle: cost.cycle,
            unnoticed: cost.unnoticed,
        })
    }
}

/// Null for an end that is open.
fn ends((lower, upper): PlanEnds) -> Ends {
    let end = |value: f64| value.is_finite().then_some(value);
    Ends { lower: end(lower), upper: end(upper) }
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
