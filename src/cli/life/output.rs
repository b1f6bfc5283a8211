//! What `life` says. In: a life. Out: one JSON object, or a page of text.

use std::fmt::Write as _;

use linkwear_gamma::life::{Contribution, ErrorBudget, LifeStatistics, WithError};
use linkwear_runtime::life::{CycleRecord, FailureEvent, Summary};
use serde_json::{Value, json};

use super::super::input::Loaded;
use super::super::table::{number, table};
use super::lived::Lived;
use super::process::Process;

/// Cycles that are printed before long lives are thinned out.
const SHOWN: usize = 40;
/// Points of the reliability function.
const POINTS: usize = 40;

/// Statistics of the random lives.
struct Scatter {
    lives: LifeStatistics,
    budget: ErrorBudget,
    mean_whole_cycles: f64,
    /// Share of the lives that each joint ended.
    first: Vec<f64>,
}

impl Lived<'_> {
    /// The mean path as a distribution of one life, or that of the random lives.
    fn summary(&self) -> Summary {
        let own = [self.end];
        let ends: &[FailureEvent] = if self.lives.is_empty() { &own } else { &self.lives };
        Summary::of(ends, self.plan.arguments.seed, Vec::new()).expect("a life is not none")
    }

    fn scatter(&self) -> Option<Scatter> {
        let cycles: Vec<f64> = self.lives.iter().map(|end| end.cycles).collect();
        let lives = LifeStatistics::of(&cycles).ok()?;
        let count = cycles.len() as f64;
        let whole: f64 = self.lives.iter().map(|end| end.whole_cycles as f64).sum();
        let first = (0..self.plan.settings.joints.len())
            .map(|joint| self.lives.iter().filter(|end| end.joint == joint).count() as f64 / count);
        let budget =
            self.budget(lives.mean().value, ErrorBudget::monte_carlo(lives.mean()), self.parameter_error);
        Some(Scatter { budget, mean_whole_cycles: whole / count, first: first.collect(), lives })
    }

    /// Of a mean life, with its Monte-Carlo part and its standard error by the fits.
    fn budget(&self, mean: f64, monte_carlo: Contribution, by_fits: Option<f64>) -> ErrorBudget {
        let table = match self.table_error() {
            // A depth that is wrong everywhere by a part makes the life wrong by that part.
            Some(error) => Contribution::Bound(error * mean),
            None => Contribution::Bound(self.step_error),
        };
        let parameters = match (by_fits, &self.plan.process) {
            (Some(error), _) => ErrorBudget::random(error),
            (None, Some(process)) if process.is_fitted() => Contribution::None("the fit gives no covariance"),
            (None, Some(_)) => {
                Contribution::None("alpha and beta are taken as known from the mechanism's file")
            }
            (None, None) => Contribution::None("no Gamma process: wear is what physics says"),
        };
        ErrorBudget { monte_carlo, table, parameters }
    }

    /// Of the mean path.
    fn budget_of_mean_path(&self) -> ErrorBudget {
        let (joint, cycles) = (self.end.joint, self.end.cycles);
        let process = self.plan.process.as_ref();
        let by_fits = process.and_then(|process| process.uncertainty_of_mean_path(joint, cycles));
        self.budget(cycles, Contribution::None("one life, every increment its mean"), by_fits)
    }

    /// Largest relative error of the table, if there is one.
    fn table_error(&self) -> Option<f64> {
        let report = self.table.as_ref()?;
        let others = report.others.iter().flatten();
        Some(report.left_out.iter().chain(others).copied().fold(0.0, f64::max))
    }

    /// For machines.
    pub fn machine(&self, loaded: &Loaded, backend: &str) -> Value {
        let (names, summary) = (self.plan.names(), self.summary());
        let joint = &self.plan.settings.joints[self.end.joint];
        let of_run = self.warnings.iter().map(|text| json!({ "code": "life", "message": text }));
        let warnings: Vec<Value> = loaded.warnings().into_iter().chain(of_run).collect();
        let cycles: Vec<Value> = self.cycles.iter().map(|cycle| cycle_entry(&names, cycle)).collect();
        let mut answer = json!({
            "name": loaded.compiled.description().name,
            "backend": backend,
            "coupling": if self.table.is_some() { "table" } else { "full" },
            "mean": summary.mean, "std": summary.std, "cov": summary.cov,
            "quantiles": {
                "p10": summary.quantiles.p10, "p50": summary.quantiles.p50, "p90": summary.quantiles.p90,
            },
            "mean_whole_cycles": summary.mean_whole_cycles,
            "trajectories": summary.trajectories,
            "random": !self.lives.is_empty(),
            "seed": self.plan.arguments.seed,
            "mean_path": {
                "cycles": self.end.cycles, "whole_cycles": self.end.whole_cycles, "step_error": self.step_error,
            },
            "failed_joint": names[self.end.joint],
            "revolutions_per_cycle": joint.revolutions_per_cycle,
            "revolutions": summary.mean * joint.revolutions_per_cycle,
            "parameters": self.plan.process.as_ref().map(Process::machine),
            "shared_factor": self.plan.arguments.shared_factor,
            "table_error": self.table_error(),
            "measurements": self.measurements,
            "cycles": cycles,
            "warnings": warnings,
        });
        let more = match self.scatter() {
            Some(scatter) => scatter.machine(&names),
            None => [("error_budget".to_owned(), self.budget_of_mean_path().half_widths_json())]
                .into_iter()
                .collect(),
        };
        answer.as_object_mut().expect("an object").extend(more);
        answer
    }

    /// For people.
    pub fn human(&self, loaded: &Loaded, backend: &str) -> String {
        let names = self.plan.names();
        let joint = &self.plan.settings.joints[self.end.joint];
        let mut text = format!(
            "{}: on its mean path {} fails after {:.3} cycles ({} whole), {} revolutions; {backend}\n",
            loaded.compiled.description().name,
            names[self.end.joint],
            self.end.cycles,
            self.end.whole_cycles,
            number(self.end.cycles * joint.revolutions_per_cycle),
        );
        text.push_str(&self.plan.process.as_ref().map_or_else(String::new, Process::human));
        if let Some(scatter) = self.scatter() {
            text.push_str(&scatter.human(&names, self.plan.arguments.seed));
            if let Some(cov) = self.plan.arguments.shared_factor {
                let _ = writeln!(
                    text,
                    "\nin each life all wear runs by one factor, of coefficient of variation {cov}"
                );
            }
        }
        text.push('\n');
        text.push_str(&cycles_table(&names, &self.cycles));
        if let Some(error) = self.table_error() {
            let _ = writeln!(
                text,
                "\nwear per revolution from a table of {} measurements, good to {error:.1e} of itself",
                self.measurements
            );
        }
        if self.lives.is_empty() {
            let budget = self.budget_of_mean_path();
            let _ = writeln!(text, "\nerror of the mean path, half-widths at 95 % [cycles]\n{budget}");
            text.push_str(if self.plan.process.is_some() {
                "\nno random lives were drawn; --trajectories 16 draws some\n"
            } else {
                "\nno random lives: [wear] gives no alpha and beta of the Gamma process\n"
            });
        }
        for warning in &self.warnings {
            let _ = writeln!(text, "\nwarning: {warning}");
        }
        text.trim_end().to_owned()
    }
}

impl Scatter {
    /// Times from before the first failure to after the last.
    fn grid(&self) -> impl Iterator<Item = f64> {
        let sorted = self.lives.sorted();
        let (first, last) = (sorted[0].floor(), sorted[sorted.len() - 1].ceil());
        (0..=POINTS).map(move |at| first + (last - first) * at as f64 / POINTS as f64)
    }

    fn machine(&self, names: &[String]) -> serde_json::Map<String, Value> {
        let measured = |value: WithError| json!({ "value": value.value, "standard_error": value.error });
        let reliability: Vec<Value> = self
            .grid()
            .map(|cycles| {
                let part = self.lives.reliability(cycles);
                json!({ "cycles": cycles, "reliability": part.value, "standard_error": part.error })
            })
            .collect();
        let first: serde_json::Map<_, _> =
            names.iter().cloned().zip(self.first.iter().map(|part| json!(part))).collect();
        let mut more = serde_json::Map::new();
        more.insert("standard_errors".into(), json!({
            "mean": self.lives.mean().error, "std": self.lives.std().error, "cov": measured(self.lives.cov()),
        }));
        more.insert("reliability".into(), json!(reliability));
        more.insert("failed_first".into(), json!(first));
        more.insert("error_budget".into(), self.budget.half_widths_json());
        more
    }

    fn human(&self, names: &[String], seed: u64) -> String {
        let (mean, std, cov) = (self.lives.mean(), self.lives.std(), self.lives.cov());
        let quantile = |p: f64| {
            self.lives
                .quantile(p)
                .map_or_else(|_| String::new(), |q| format!("{:.3} +- {:.3}", q.value, q.error))
        };
        let rows = [
            ("mean", format!("{:.3} +- {:.3}", mean.value, mean.error)),
            ("mean, whole cycles", format!("{:.3}", self.mean_whole_cycles)),
            ("standard deviation", format!("{:.4} +- {:.4}", std.value, std.error)),
            ("coefficient of variation", format!("{:.3} % +- {:.3} %", 100.0 * cov.value, 100.0 * cov.error)),
            ("10 % fail before (B10)", quantile(0.1)),
            ("half fail before (B50)", quantile(0.5)),
            ("90 % fail before (B90)", quantile(0.9)),
        ];
        let rows: Vec<Vec<String>> =
            rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]).collect();
        let head = format!("{} random lives, seed {seed}", self.lives.count());
        let mut text = format!("\n{}", table(&[&head, "cycles, +- standard error"], &rows));
        let _ = writeln!(text, "\nerror of the mean, half-widths at 95 % [cycles]\n{}", self.budget);
        if names.len() > 1 {
            let parts: Vec<String> = names
                .iter()
                .zip(&self.first)
                .map(|(name, part)| format!("{name} {:.1} %", 100.0 * part))
                .collect();
            let _ = writeln!(text, "\nfirst to fail: {}", parts.join(", "));
        }
        text
    }
}

/// A cycle for machines.
pub fn cycle_entry(names: &[String], cycle: &CycleRecord) -> Value {
    let joints: Vec<Value> = names
        .iter()
        .zip(&cycle.joints)
        .map(|(name, joint)| {
            json!({
                "joint": name, "clearance_m": joint.clearance, "dLambda_m": joint.mean_increment,
                "wear_m": joint.wear, "wear_integral_J": joint.wear_integral,
                "mean_force_N": joint.mean_force, "peak_force_N": joint.peak_force,
                "contact_losses": joint.contact_losses,
            })
        })
        .collect();
    json!({ "cycle": cycle.cycle, "used": cycle.used, "joints": joints })
}

/// Cycles for people, thinned out.
pub fn cycles_table(names: &[String], cycles: &[CycleRecord]) -> String {
    let stride = cycles.len().div_ceil(SHOWN).max(1);
    let end = cycles.len().saturating_sub(1);
    let mut rows = Vec::new();
    for (at, cycle) in cycles.iter().enumerate() {
        if at % stride != 0 && at != end {
            continue;
        }
        for (name, joint) in names.iter().zip(&cycle.joints) {
            rows.push(vec![
                cycle.cycle.to_string(),
                name.clone(),
                format!("{:.3}", 1e6 * joint.clearance),
                format!("{:.4}", 1e6 * joint.mean_increment),
                format!("{:.3}", 1e6 * joint.wear),
                number(joint.peak_force),
                number(joint.contact_losses),
            ]);
        }
    }
    let head =
        ["cycle", "joint", "clearance [um]", "dLambda [um]", "wear [um]", "peak force [N]", "contact losses"];
    table(&head, &rows)
}
