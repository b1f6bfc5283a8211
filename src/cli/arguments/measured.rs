//! What can be asked of measured wear and of lives: fits, predictions, plans. Never knows who answers.

use std::path::PathBuf;

use clap::Args;
use clap::builder::RangedU64ValueParser;
use linkwear_gamma::plan::FLEET;
use linkwear_gamma::process::{PROCESSES, Process};

use super::super::calendar::Calendar;
use super::super::options::Replace;
use super::super::value::{
    OtherJoint, covariate, from_zero, limit, one_of, other_joint, output, part, positive, positive_range,
    range, within_one,
};

#[derive(Debug, Args)]
pub struct PredictArguments {
    /// Result of `linkwear fit .. --format json`.
    pub fit: PathBuf,
    /// Wear at failure, in the unit of the fit's data.
    #[arg(long, value_name = "W", value_parser = positive, allow_negative_numbers = true)]
    pub threshold: f64,
    /// Wear now [default: 0].
    #[arg(long, value_name = "W0", value_parser = from_zero, allow_negative_numbers = true)]
    pub current: Option<f64>,
    /// Exposure until now, as the fit counts it before any exponent; needed with --current for a power law.
    #[arg(long, value_name = "EXPOSURE", value_parser = from_zero, allow_negative_numbers = true)]
    pub at: Option<f64>,
    /// A unit of the fit's data, by its name there: what has been read of it says how it differs; its last reading is the present,
    /// or --current with --at. Without, a unit of which nothing is known.
    #[arg(long, value_name = "NAME", conflicts_with = "inspections")]
    pub unit: Option<String>,
    /// Value of a covariate of the fit, in the unit of the fit's data; one for each.
    #[arg(long, value_name = "NAME=VALUE", value_parser = covariate)]
    pub covariate: Vec<(String, f64)>,
    /// Exposure per unit of time from now on; lives are reported in that time [default: 1].
    #[arg(long, value_name = "R", value_parser = positive, allow_negative_numbers = true)]
    pub rate: Option<f64>,
    /// Readings of this joint (CSV), time since it was new; the last one is the present.
    #[arg(long, value_name = "CSV", conflicts_with_all = ["current", "at"], requires_all = ["time", "wear"])]
    pub inspections: Option<PathBuf>,
    /// Column of the time of a reading.
    #[arg(long, value_name = "COL", requires = "inspections")]
    pub time: Option<String>,
    /// Column of the wear.
    #[arg(long, value_name = "COL", requires = "inspections")]
    pub wear: Option<String>,
    /// Standard error of the gauge, in the unit of wear: readings may fall.
    #[arg(long, value_name = "S", value_parser = positive, requires = "inspections", allow_negative_numbers = true)]
    pub gauge: Option<f64>,
    /// Take nothing from the fit but its form: the readings alone decide.
    #[arg(long, requires = "inspections", conflicts_with = "gauge")]
    pub flat_prior: bool,
    /// Particles that follow readings with gauge error.
    #[arg(long, value_name = "N", default_value_t = 5000, value_parser = clap::value_parser!(u32).range(200..=1_000_000), allow_negative_numbers = true)]
    pub particles: u32,
    /// Beside the readings nothing is known but the mean wear per unit of exposure, which a catalogue gives as A to B; it lies
    /// within with 95 %. The fit gives the form.
    #[arg(long, value_name = "A..B", value_parser = positive_range, requires = "inspections", conflicts_with_all = ["gauge", "flat_prior"])]
    pub catalogue: Option<[f64; 2]>,
    /// For how long it has gone on since then without failing, its wear unseen: everything is told from the end of that time.
    #[arg(long, value_name = "TIME", value_parser = from_zero, default_value = "0", hide_default_value = true, allow_negative_numbers = true)]
    pub survived: f64,
    /// Part that has failed, by when is asked: 1% gives B1. Repeatable.
    #[arg(long, value_name = "P", value_parser = part, allow_negative_numbers = true)]
    pub quantile: Vec<f64>,
    /// Time at which reliability, hazard and the mean residual life of the survivors are asked. Repeatable.
    #[arg(long, value_name = "TIME", value_parser = from_zero, allow_negative_numbers = true)]
    pub reliability_at: Vec<f64>,
    /// A mission from A to B: how probable a part that begins it gets through. Repeatable.
    #[arg(long, value_name = "A..B", value_parser = range)]
    pub mission: Vec<[f64; 2]>,
    /// Another joint of the machine, with its own fit: file, wear at failure, wear now, exposure until now. The machine fails with
    /// the first of its joints. Repeatable.
    #[arg(long, value_name = "FIT.json:W[:W0[:EXPOSURE]]", value_parser = other_joint, conflicts_with = "inspections")]
    pub also: Vec<OtherJoint>,
    #[command(flatten)]
    pub calendar: Calendar,
    /// Bands by this many drawn parameters [default: by the delta method].
    #[arg(long, value_name = "N", conflicts_with = "inspections", value_parser = clap::value_parser!(u32).range(100..=1_000_000), allow_negative_numbers = true)]
    pub draws: Option<u32>,
    /// Seed of the random numbers.
    #[arg(long, value_name = "S", default_value_t = 0, allow_negative_numbers = true)]
    pub seed: u64,
    /// Draw reliability and hazard as charts (SVG; PNG by the feature `png`).
    #[cfg(feature = "page")]
    #[arg(long, value_name = "FILE.svg|png", value_parser = output())]
    pub plot: Option<PathBuf>,
    #[cfg(feature = "page")]
    #[command(flatten)]
    pub replace: Replace,
}

#[derive(Debug, Args)]
pub struct PlanArguments {
    /// Result of `linkwear fit .. --format json`; or lives, a folder of `life --out` or its lives.csv.
    pub file: PathBuf,
    /// Wear at failure, in the unit of the fit's data.
    #[arg(long, value_name = "W", value_parser = positive, allow_negative_numbers = true)]
    pub threshold: Option<f64>,
    /// Value of a covariate of the fit, in the unit of the fit's data; one for each.
    #[arg(long, value_name = "NAME=VALUE", value_parser = covariate)]
    pub covariate: Vec<(String, f64)>,
    /// Exposure per unit of time; times are in that time [default: 1].
    #[arg(long, value_name = "R", value_parser = positive, requires = "threshold", allow_negative_numbers = true)]
    pub rate: Option<f64>,
    /// Cost of a replacement in time, in any currency.
    #[arg(long, value_name = "COST", value_parser = positive, allow_negative_numbers = true)]
    pub preventive: f64,
    /// Cost of a failure with its replacement and all that it does.
    #[arg(long, value_name = "COST", value_parser = positive, allow_negative_numbers = true)]
    pub failure: f64,
    /// How long a replacement in time takes.
    #[arg(long, value_name = "TIME", value_parser = from_zero, default_value = "0", allow_negative_numbers = true)]
    pub preventive_time: f64,
    /// How long the standstill after a failure takes.
    #[arg(long, value_name = "TIME", value_parser = from_zero, default_value = "0", allow_negative_numbers = true)]
    pub failure_time: f64,
    /// Cost of a look at the wear: plan looks too. Of lives, with --downtime: of a look that finds whether a part has failed.
    #[arg(long, value_name = "COST", value_parser = positive, allow_negative_numbers = true)]
    pub inspection: Option<f64>,
    /// Only a look finds a failure, and until then each unit of time costs this; without it a failure shows at once.
    #[arg(long, value_name = "COST", value_parser = positive, requires = "inspection", allow_negative_numbers = true)]
    pub downtime: Option<f64>,
    /// Time from look to look [default: the best].
    #[arg(long, value_name = "TIME", value_parser = positive, requires = "inspection", allow_negative_numbers = true)]
    pub interval: Option<f64>,
    /// Wear from which a look has the part replaced [default: the best].
    #[arg(long, value_name = "W", value_parser = positive, requires = "inspection", allow_negative_numbers = true)]
    pub replace_from: Option<f64>,
    /// What one look at the part in use would be worth, this long from now.
    #[arg(long, value_name = "TIME", value_parser = positive, allow_negative_numbers = true)]
    pub look_at: Option<f64>,
    /// Wear of the part in use now [default: 0].
    #[arg(long, value_name = "W0", value_parser = from_zero, requires = "look_at", allow_negative_numbers = true)]
    pub current: Option<f64>,
    /// Exposure of the part in use until now; needed with --current for a power law.
    #[arg(long, value_name = "EXPOSURE", value_parser = from_zero, requires = "look_at", allow_negative_numbers = true)]
    pub at: Option<f64>,
    /// Parts in use, all new at the start: plan spares for them.
    #[arg(long, value_name = "N", requires = "horizon", value_parser = RangedU64ValueParser::<usize>::new().range(1..=FLEET as u64), allow_negative_numbers = true)]
    pub parts: Option<usize>,
    /// Time that spares are planned for.
    #[arg(long, value_name = "TIME", value_parser = positive, requires = "parts", allow_negative_numbers = true)]
    pub horizon: Option<f64>,
    /// Probability that the spares are enough.
    #[arg(long, value_name = "P", value_parser = within_one, default_value = "0.95", requires = "parts", allow_negative_numbers = true)]
    pub confidence: f64,
    /// Draw the cost over the age of replacement, with its best age and what the fit leaves open (SVG; PNG by the feature `png`).
    #[cfg(feature = "page")]
    #[arg(long, value_name = "FILE.svg|png", value_parser = output())]
    pub plot: Option<PathBuf>,
    #[cfg(feature = "page")]
    #[command(flatten)]
    pub replace: Replace,
}

#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("clock").required(true).multiple(true).args(["exposure", "lambda"]))]
pub struct FitArguments {
    /// Readings (CSV with a header; lines that begin with # are skipped).
    pub file: PathBuf,
    /// Column that names the unit (specimen) of a reading.
    #[arg(long, value_name = "COL")]
    pub unit: String,
    /// Column of wear; `>=0.8` for a part that had failed or left the gauge's range by then, `<0.05` for one below it.
    #[arg(long, value_name = "COL")]
    pub wear: String,
    /// Column of exposure: time, cycles, distance.
    #[arg(long, value_name = "COL")]
    pub exposure: Option<String>,
    /// Column of Lambda; or, with --exposure in cycles, a file that has Lambda by exposure: the JSON of `life`, taken in
    /// um, of several wearing joints with the one that is fitted, as R2=life.json; or a CSV of two columns.
    #[arg(long, value_name = "COL|[JOINT=]FILE")]
    pub lambda: Option<String>,
    /// Process of wear; `predict` goes by the one that was fitted.
    #[arg(long, value_name = "PROCESS", default_value = "gamma", value_parser = one_of(PROCESSES.map(|process| (process.name(), process))))]
    pub process: &'static dyn Process,
    /// Estimate the exponent c of Lambda = exposure^c.
    #[arg(long, conflicts_with = "lambda")]
    pub power_law: bool,
    /// Column of groups: each is fitted alone, then all together.
    #[arg(long, value_name = "COL")]
    pub groups: Option<String>,
    /// Begin each unit at (0, 0).
    #[arg(long)]
    pub from_zero: bool,
    /// Step of the gauge: readings are the nearest multiples of it; a first reading at exposure 0 is exact.
    #[arg(long, value_name = "R", value_parser = positive, allow_negative_numbers = true)]
    pub resolution: Option<f64>,
    /// Standard deviation of the normal error that readings have before they are rounded, up to 100 R; readings may then fall.
    #[arg(long, value_name = "S", value_parser = positive, requires = "resolution", allow_negative_numbers = true)]
    pub gauge: Option<f64>,
    /// Column of a covariate such as load, which multiplies Lambda as a power. Repeatable.
    #[arg(long, value_name = "COL")]
    pub covariate: Vec<String>,
    /// Column of a covariate such as hardness, which multiplies the size of increments as a power: beta of the Gamma process by its
    /// reciprocal, the drift of the others. May be one of --covariate, too. Repeatable.
    #[arg(long, value_name = "COL")]
    pub covariate_of_size: Vec<String>,
    /// Column of what was done to the part after a reading: `replaced` (age and wear begin anew at 0), `replaced=LEVEL`,
    /// `reground=LEVEL` (age goes on), `?` (to an unknown level); empty for nothing.
    #[arg(long, value_name = "COL")]
    pub reset: Option<String>,
    /// Units are among the data only because their wear was below this at their first reading: a number, or a column. What that
    /// selects is taken out, of units seen from new (--from-zero) and of rates that differ (--random-effects).
    #[arg(long, value_name = "D|COL", value_parser = limit, allow_negative_numbers = true)]
    pub entered_below: Option<String>,
    /// Accept data of one unit, which cannot tell how units differ.
    #[arg(long)]
    pub one_unit: bool,
    /// Let units differ: rates of the Gamma process by a Gamma law, drifts of the others by a normal one; says whether they do.
    #[arg(long, conflicts_with = "one_unit")]
    pub random_effects: bool,
    /// Compare with the other processes, each with units alike and with units that differ.
    #[arg(long)]
    pub compare: bool,
    /// Replicates of the parametric bootstrap, 40 at least: intervals, p-values of the goodness of fit; 0: none.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true)]
    pub bootstrap: usize,
    /// Seed of the random numbers.
    #[arg(long, value_name = "S", default_value_t = 1, allow_negative_numbers = true)]
    pub seed: u64,
    /// Draw probability paper, quantiles and residuals as charts (SVG; PNG by the feature `png`).
    #[cfg(feature = "page")]
    #[arg(long, value_name = "FILE.svg|png", value_parser = output())]
    pub plot: Option<PathBuf>,
    /// Write the fit (JSON) for `predict`.
    #[arg(long, value_name = "FILE", value_parser = output())]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub replace: Replace,
}

impl FitArguments {
    /// Columns of all covariates, those of size last.
    pub fn covariates(&self) -> impl Iterator<Item = &String> {
        self.covariate.iter().chain(&self.covariate_of_size)
    }
}
