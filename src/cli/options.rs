//! Options that several subcommands have, each said once. Never knows who asks.

use std::path::{Path, PathBuf};

use crate::backend::Backend;
use crate::life::Coupling;
use crate::table::FORMATS;
use clap::{Args, ValueEnum};
use linkwear_codegen::Closure;

use super::value::{accuracy, assignment, one_of, positive};

const BACKENDS: [(&str, Backend); 4] = [
    ("auto", Backend::Auto),
    ("compiled", Backend::Compiled),
    ("native", Backend::Native),
    ("interpreter", Backend::Interpreter),
];
pub const CLOSURES: [(&str, Closure); 2] = [("joint", Closure::Joint), ("log", Closure::Log)];
const COUPLINGS: [(&str, Coupling); 2] = [("table", Coupling::Table), ("full", Coupling::Full)];

/// The formats of tables as the program has them.
pub fn rows_help() -> String {
    let formats = FORMATS.iter().map(|format| format!(".{} ({})", format.extension, format.purpose));
    let formats = formats.collect::<Vec<_>>().join(", ");
    format!(
        "File for the rows: {formats}; any other name is taken as the first; `-` is stdout. It appears only when it is complete"
    )
}

/// A mechanism file and changes to it.
#[derive(Debug, Args)]
pub struct Input {
    /// Mechanism (TOML).
    pub file: PathBuf,
    /// Override a parameter; units as in the file: --set speed="10 Hz". Repeatable.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    pub overrides: Vec<(String, String)>,
    /// How loops are closed: only the rows a cut joint takes away, or six rows of a logarithm.
    #[arg(long, value_parser = one_of(CLOSURES))]
    pub closure: Option<Closure>,
    /// Let the mechanism name files of data outside its folder.
    #[arg(long)]
    pub allow_outside_data: bool,
}

/// Whether a file may be replaced whatever it is.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct Replace {
    /// Replace files that linkwear did not make, too.
    #[arg(long)]
    pub force: bool,
}

/// What runs the equations, and of which bodies.
#[derive(Clone, Copy, Debug, Args)]
pub struct EquationsChoice {
    /// What runs the equations, with the same results: machine code written now, code that was compiled in, the
    /// interpreter; `auto` takes the first that there is.
    #[arg(long, value_parser = one_of(BACKENDS), default_value = "auto")]
    pub backend: Backend,
    /// Take flexible bodies as rigid. No effect on a mechanism without flexible bodies.
    #[arg(long)]
    pub rigid: bool,
}

/// How well the wear of a revolution is known.
#[derive(Debug, Args)]
pub struct RevolutionArguments {
    /// Relative error of the wear integral of a revolution [default: 1e-6; 1e-5 with `profile = true`].
    #[arg(long, value_name = "E", value_parser = accuracy, allow_negative_numbers = true)]
    pub tol: Option<f64>,
    /// Fixed step of the fourth-order Runge-Kutta method [s], in place of --tol.
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with = "tol", allow_negative_numbers = true)]
    pub step: Option<f64>,
}

/// How a run is made.
#[derive(Debug, Args)]
pub struct MotionArguments {
    #[command(flatten)]
    pub length: LengthArguments,
    /// Rows of the output, evenly spaced over the run, both ends included.
    #[arg(long, default_value_t = 201, value_parser = clap::value_parser!(u32).range(2..=10_000_000), allow_negative_numbers = true)]
    pub samples: u32,
    /// Inputs over time: a CSV file with columns `t [s]` and `NAME [UNIT]` for inputs of [inputs]; others keep their defaults.
    #[arg(long, value_name = "FILE.csv")]
    pub inputs: Option<PathBuf>,
    /// Method [default: dopri5 or rodas5p, whichever takes less time; with clearance rk43; rk4 if --step
    /// is given].
    #[arg(long, value_enum)]
    pub integrator: Option<IntegratorName>,
    /// Step of rk4 and generalized-alpha [s] [default: 1e-4].
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with = "tol", allow_negative_numbers = true)]
    pub step: Option<f64>,
    /// Accuracy of dopri5, relative to every value, but where something is driven absolute below 1 m, rad, m/s or rad/s [default: 1e-9];
    /// with flexible bodies and of rodas5p, relative to their loads, so that joint forces have it [default: 1e-7]; of rk43, of the wear
    /// integral, 1e-4 or finer [default: 1e-6].
    #[arg(long, value_name = "E", value_parser = accuracy, allow_negative_numbers = true)]
    pub tol: Option<f64>,
}

impl MotionArguments {
    /// The file of the mechanism, and what is read beside it.
    pub fn read_beside<'a>(&'a self, file: &'a Path) -> Vec<&'a Path> {
        [file].into_iter().chain(self.inputs.as_deref()).collect()
    }
}

/// How lives are lived.
#[derive(Debug, Args)]
pub struct LivesArguments {
    /// Random lives to draw by the Gamma process of [wear] [default: 1000 with a table, else none].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000_000), conflicts_with = "mean", allow_negative_numbers = true)]
    pub trajectories: Option<u64>,
    /// Take alpha and beta from a fit instead of [wear]; its covariance enters the error budget. Wear and Lambda of its
    /// data must be in um, Lambda from `life` (`fit --lambda life.json`). With several wearing joints: once for each.
    #[arg(long, value_name = "[JOINT=]FIT.json")]
    pub fit: Vec<String>,
    /// Coefficient of variation of a random wear-rate factor (Gamma law, mean 1) common to all joints of a life.
    #[arg(long, value_name = "COV", value_parser = positive, conflicts_with = "mean", allow_negative_numbers = true)]
    pub shared_factor: Option<f64>,
    /// Seed of the random numbers; the same seed gives the same bits on any number of threads.
    #[arg(long, value_name = "S", default_value_t = 1, allow_negative_numbers = true)]
    pub seed: u64,
    /// Duty cycle of the mechanism's [missions] by which it is used [default: the only one, if there is one].
    #[arg(long, value_name = "NAME", conflicts_with = "no_mission")]
    pub mission: Option<String>,
    /// Live as if the mechanism had no [missions].
    #[arg(long)]
    pub no_mission: bool,
    /// Only the mean path: every increment of wear is its mean.
    #[arg(long)]
    pub mean: bool,
    /// Source of the wear per revolution: a table made once, or the dynamics at every wear step [default: table, or full where a worn profile is fed back].
    #[arg(long, value_parser = one_of(COUPLINGS))]
    pub coupling: Option<Coupling>,
    /// Wear does not open the clearance.
    #[arg(long)]
    pub no_feedback: bool,
    /// Revolutions to settle after each change of clearance, before measuring [default: until later ones would wear alike].
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub settle: Option<u32>,
    /// Revolutions to average, at least; of a motion that never settles more are taken, unless --settle is given.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000), allow_negative_numbers = true)]
    pub average: u32,
}

/// How long to run: at most one of the two.
#[derive(Debug, Args)]
#[group(multiple = false)]
pub struct LengthArguments {
    /// Turns of the first driven revolute joint [default: 1, if there is one].
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true)]
    pub turns: Option<f64>,
    /// Time [s] [default: 1, if no revolute joint is driven].
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    pub time: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum IntegratorName {
    Rk4,
    Dopri5,
    #[value(name = "rodas5p")]
    Rodas5P,
    Rk43,
    #[value(name = "generalized-alpha")]
    GeneralizedAlpha,
}
