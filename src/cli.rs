//! The command line: what can be asked (clap definitions), and who answers.
//! In: arguments. Out: text or one JSON object on stdout, everything else on stderr, an exit code
//! (0 done, 1 the input or the run failed, 2 wrong usage). Never knows how a stage works.

#[cfg(feature = "case-study")]
mod case_study;
mod check;
mod equations;
mod failure;
mod file;
mod fit;
mod fit_file;
mod generate;
mod input;
mod life;
mod new;
mod packaging;
mod plot;
mod predict;
mod prediction;
mod progress;
mod readings;
mod schema;
mod simulate;
mod summary;
mod table;

use std::ffi::OsString;
use std::num::NonZero;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};

use failure::Failure;

/// Compiles a linkage into its life: specialised dynamics from a TOML file.
#[derive(Debug, Parser)]
#[command(name = "linkwear", version, arg_required_else_help = true)]
struct Arguments {
    /// `json`: one JSON object on stdout, nothing else there.
    #[arg(long, global = true, value_enum, default_value_t = Format::Text)]
    format: Format,
    #[command(subcommand)]
    command: Command,
}

/// For whom the answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Json,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Read a mechanism and say what it is: mobility, redundant rows, idle freedoms, warnings.
    #[command(after_help = "Example:\n  linkwear check mechanisms/rssr_rigid.toml")]
    Check(Input),
    /// Print the symbolic equations, with operation counts before and after sharing.
    #[command(after_help = "Example:\n  linkwear equations mechanisms/pendulum.toml --only mass --as latex")]
    Equations(EquationsArguments),
    /// Write the specialised source code.
    #[command(after_help = "Examples:\n  linkwear generate mechanisms/rssr_rigid.toml -o rssr.rs\n  \
                      linkwear generate mechanisms/rssr_rigid.toml -o rssr.rs --check")]
    Generate(GenerateArguments),
    /// Turn the mechanism and record what happens.
    #[command(
        after_help = "Example:\n  linkwear simulate mechanisms/rssr_rigid.toml --turns 2 --out rssr.csv"
    )]
    Simulate(SimulateArguments),
    /// Wear the joints with clearance, cycle by cycle, until the first has failed.
    #[command(
        after_help = "Example:\n  linkwear life mechanisms/rssr.toml --trajectories 1000 --seed 7 --out lives"
    )]
    Life(LifeArguments),
    /// Recompute the figures and tables of the paper's case study, beside the paper's own numbers.
    #[cfg(feature = "case-study")]
    #[command(after_help = "Example:\n  linkwear case-study --out study")]
    CaseStudy(CaseStudyArguments),
    /// Tell the remaining life from a fit, and from inspections of the joint.
    #[command(after_help = "Examples:\n  linkwear predict fit.json --threshold 10 --current 5\n  \
                      linkwear predict fit.json --threshold 10 --inspections log.csv --time hours --wear um")]
    Predict(PredictArguments),
    /// Fit a Gamma process of wear to measured data by maximum likelihood.
    #[command(
        after_help = "Example:\n  linkwear fit examples/data/sliding_wear_100g.csv \\\n    --unit unit \
                      --wear wear_um --exposure cycles --from-zero --power-law"
    )]
    Fit(FitArguments),
    /// Write a commented starter file to edit.
    #[command(after_help = "Example:\n  linkwear new four_bar && linkwear check four_bar.toml")]
    New(NewArguments),
    /// Print the JSON Schema of mechanism files, for editors.
    #[command(after_help = "Example:\n  linkwear schema > linkwear.schema.json")]
    Schema,
    /// Print a completion script for a shell.
    #[command(after_help = "Example:\n  linkwear completions bash > \
                      ~/.local/share/bash-completion/completions/linkwear")]
    Completions {
        /// Which shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual page (troff).
    #[command(after_help = "Example:\n  linkwear man > linkwear.1")]
    Man,
}

/// A mechanism file and changes to it.
#[derive(Debug, Args)]
struct Input {
    /// Mechanism (TOML).
    file: PathBuf,
    /// Override a parameter; units as in the file: --set speed="10 Hz". Repeatable.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = input::assignment)]
    overrides: Vec<(String, String)>,
    /// How loops are closed: only the rows a cut joint takes away, or six rows of a logarithm.
    #[arg(long, value_enum)]
    closure: Option<ClosureName>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ClosureName {
    Joint,
    Log,
}

#[derive(Debug, Args)]
struct EquationsArguments {
    #[command(flatten)]
    input: Input,
    /// Only these outputs or functions, separated by commas.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    only: Vec<String>,
    /// Notation.
    #[arg(long = "as", value_enum, default_value_t = Notation::Text)]
    notation: Notation,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Notation {
    Text,
    Markdown,
    Latex,
}

#[derive(Debug, Args)]
struct GenerateArguments {
    #[command(flatten)]
    input: Input,
    /// File to write; without it the source goes to stdout.
    #[arg(short, long, value_name = "OUT.rs")]
    out: Option<PathBuf>,
    /// Write nothing; fail if OUT.rs is not what would be written.
    #[arg(long, requires = "out")]
    check: bool,
    /// Language.
    #[arg(long, value_enum, default_value_t = Target::Rust)]
    target: Target,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Target {
    Rust,
}

#[derive(Debug, Args)]
struct SimulateArguments {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    length: LengthArguments,
    /// Rows of the output, evenly spaced over the run, both ends included.
    #[arg(long, default_value_t = 201, value_parser = clap::value_parser!(u32).range(2..=10_000_000))]
    samples: u32,
    /// File for the rows (CSV). It appears only when it is complete.
    #[arg(long, value_name = "CSV")]
    out: Option<PathBuf>,
    /// Method [default: dopri5, or rk4 if --step is given].
    #[arg(long, value_enum)]
    integrator: Option<IntegratorName>,
    /// Step of rk4 and generalized-alpha [s] [default: 1e-4].
    #[arg(long, value_name = "S", value_parser = input::positive, conflicts_with = "tol")]
    step: Option<f64>,
    /// Error tolerance of dopri5 [default: 1e-9].
    #[arg(long, value_name = "E", value_parser = input::positive)]
    tol: Option<f64>,
    /// What runs the equations. `auto`: compiled if the file is a shipped mechanism, byte for byte, with
    /// no generation-time parameter set; else the interpreter.
    #[arg(long, value_enum, default_value_t = Backend::Auto)]
    backend: Backend,
    /// Take flexible bodies as rigid. No effect on a mechanism without flexible bodies.
    #[arg(long)]
    rigid: bool,
}

#[derive(Debug, Args)]
struct LifeArguments {
    #[command(flatten)]
    input: Input,
    /// Random lives to draw by the Gamma process of [wear] [default: 1000 with a table, else none].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000_000), conflicts_with = "mean")]
    trajectories: Option<u64>,
    /// Take alpha and beta from a fit instead of [wear]; its covariance enters the error budget. Wear and Lambda of its
    /// data must be in um, Lambda from `life` (`fit --lambda life.json`). With several wearing joints: once for each.
    #[arg(long, value_name = "[JOINT=]FIT.json")]
    fit: Vec<String>,
    /// Spread of a factor of mean 1, one for each life, by which all joints wear faster or slower together: its
    /// coefficient of variation, by a Gamma law.
    #[arg(long, value_name = "COV", value_parser = input::positive, conflicts_with = "mean")]
    shared_factor: Option<f64>,
    /// Picks the random numbers; the same seed gives the same bits on any number of threads.
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Only the mean path: every increment of wear is its mean.
    #[arg(long)]
    mean: bool,
    /// Wear per revolution from a table made once, or from the dynamics at every wear step [default: table, or full
    /// where a profile is fed back].
    #[arg(long, value_enum)]
    coupling: Option<Coupling>,
    /// Take flexible bodies as rigid.
    #[arg(long)]
    rigid: bool,
    /// Wear does not open the clearance.
    #[arg(long)]
    no_feedback: bool,
    /// Step of the fourth-order Runge-Kutta method [s].
    #[arg(long, value_name = "S", value_parser = input::positive, default_value = "2e-5")]
    step: f64,
    /// Revolutions after each change of a clearance before one is measured.
    #[arg(long, value_name = "N", default_value_t = 4)]
    settle: u32,
    /// Revolutions whose mean is taken; a motion that chatters needs 20 or more.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    average: u32,
    /// Folder for life.json, cycles.csv and lives.csv; one with something in it is refused.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads that share the random lives [default: one per core].
    #[arg(long, value_name = "T")]
    threads: Option<NonZero<usize>>,
    /// What runs the equations.
    #[arg(long, value_enum, default_value_t = Backend::Auto)]
    backend: Backend,
}

#[cfg(feature = "case-study")]
#[derive(Debug, Args)]
struct CaseStudyArguments {
    /// A rough study in less than a minute, to test the tool.
    #[arg(long)]
    quick: bool,
    /// Folder for figures, tables and results; must be new or empty.
    #[arg(long, value_name = "DIR", default_value = "case-study")]
    out: PathBuf,
    /// Seed of all random numbers.
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Threads [default: all processors]. Their number changes no result.
    #[arg(long, value_name = "T")]
    threads: Option<std::num::NonZeroU16>,
}

#[derive(Debug, Args)]
struct PredictArguments {
    /// Result of `linkwear fit .. --format json`.
    fit: PathBuf,
    /// Wear at failure, in the unit of the fit's data.
    #[arg(long, value_name = "W", value_parser = input::positive)]
    threshold: f64,
    /// Wear now [default: 0].
    #[arg(long, value_name = "W0", allow_negative_numbers = true)]
    current: Option<f64>,
    /// Exposure until now, as the fit counts it before any exponent; needed with --current for a power law.
    #[arg(long, value_name = "EXPOSURE", allow_negative_numbers = true)]
    at: Option<f64>,
    /// Value of a covariate of the fit, in the unit of the fit's data; one for each.
    #[arg(long, value_name = "NAME=VALUE", value_parser = input::covariate)]
    covariate: Vec<(String, f64)>,
    /// Exposure per unit of time from now on; lives are told in that time [default: 1].
    #[arg(long, value_name = "R", value_parser = input::positive)]
    rate: Option<f64>,
    /// Readings of this joint (CSV), time since it was new; the last one is the present.
    #[arg(long, value_name = "CSV", conflicts_with_all = ["current", "at"], requires_all = ["time", "wear"])]
    inspections: Option<PathBuf>,
    /// Column of the time of a reading.
    #[arg(long, value_name = "COL", requires = "inspections")]
    time: Option<String>,
    /// Column of the wear.
    #[arg(long, value_name = "COL", requires = "inspections")]
    wear: Option<String>,
    /// Standard error of the gauge, in the unit of wear: readings may fall.
    #[arg(long, value_name = "S", value_parser = input::positive, requires = "inspections")]
    gauge: Option<f64>,
    /// Take nothing from the fit but its form: the readings alone decide.
    #[arg(long, requires = "inspections", conflicts_with = "gauge")]
    flat_prior: bool,
    /// Particles that follow readings with gauge error.
    #[arg(long, value_name = "N", default_value_t = 5000, value_parser = clap::value_parser!(u32).range(200..=1_000_000))]
    particles: u32,
    /// Bands by this many drawn parameters [default: by the delta method].
    #[arg(long, value_name = "N", conflicts_with = "inspections", value_parser = draw_count)]
    draws: Option<usize>,
    /// Decides all random numbers.
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
}

/// Enough draws for the ends of a 95 % band.
fn draw_count(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if (100..=1_000_000).contains(&count) => Ok(count),
        _ => Err("a number from 100 to 1000000 is needed".to_owned()),
    }
}

#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("clock").required(true).multiple(true).args(["exposure", "lambda"]))]
struct FitArguments {
    /// Readings (CSV with a header; lines that begin with # are skipped).
    file: PathBuf,
    /// Column that names the unit (specimen) of a reading.
    #[arg(long, value_name = "COL")]
    unit: String,
    /// Column of wear.
    #[arg(long, value_name = "COL")]
    wear: String,
    /// Column of exposure: time, cycles, distance.
    #[arg(long, value_name = "COL")]
    exposure: Option<String>,
    /// Column of Lambda; or, with --exposure in cycles, a file that has Lambda by exposure: the JSON of `life`, taken in
    /// um, or a CSV of two columns.
    #[arg(long, value_name = "COL|FILE")]
    lambda: Option<String>,
    /// Estimate the exponent c of Lambda = exposure^c.
    #[arg(long, conflicts_with = "lambda")]
    power_law: bool,
    /// Column of groups: each is fitted alone, then all together.
    #[arg(long, value_name = "COL")]
    groups: Option<String>,
    /// Begin each unit at (0, 0).
    #[arg(long)]
    from_zero: bool,
    /// Step of the gauge: an increment of zero then means "less than this".
    #[arg(long, value_name = "R", value_parser = input::positive)]
    resolution: Option<f64>,
    /// Column of a covariate such as load, which multiplies Lambda as a power. Repeatable.
    #[arg(long, value_name = "COL")]
    covariate: Vec<String>,
    /// Accept data of one unit, which cannot tell how units differ.
    #[arg(long)]
    one_unit: bool,
    /// Compare with Wiener and inverse-Gaussian processes.
    #[arg(long)]
    compare: bool,
    /// Replicates of the parametric bootstrap: intervals, p-values of the goodness of fit.
    #[arg(long, value_name = "N", default_value_t = 0)]
    bootstrap: usize,
    /// Seed of the bootstrap.
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Write the fit (JSON) for `predict`.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Coupling {
    Table,
    Full,
}

/// How long to run: at most one of the two.
#[derive(Debug, Args)]
#[group(multiple = false)]
struct LengthArguments {
    /// Turns of the first driven revolute joint [default: 1, if there is one].
    #[arg(long, value_name = "N", value_parser = input::positive)]
    turns: Option<f64>,
    /// Time [s] [default: 1, if no revolute joint is driven].
    #[arg(long, value_name = "T", value_parser = input::positive)]
    time: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum IntegratorName {
    Rk4,
    Dopri5,
    #[value(name = "generalized-alpha")]
    GeneralizedAlpha,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Backend {
    Auto,
    Compiled,
    Jit,
    Interpreter,
}

#[derive(Debug, Args)]
struct NewArguments {
    /// Name of the mechanism; the file is NAME.toml in the current folder.
    name: String,
}

/// Reads the arguments of this process, answers, and says how it ended.
pub fn run() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let parsed = match Arguments::try_parse_from(&arguments) {
        Ok(parsed) => parsed,
        Err(error) => return failure::wrong_arguments(&error, wants_json(&arguments)),
    };
    let format = parsed.format;
    match answer(parsed) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(format),
    }
}

fn answer(arguments: Arguments) -> Result<(), Failure> {
    let format = arguments.format;
    match arguments.command {
        Command::Check(input) => check::run(&input, format),
        Command::Equations(arguments) => equations::run(&arguments, format),
        Command::Generate(arguments) => generate::run(&arguments, format),
        Command::Simulate(arguments) => simulate::run(&arguments, format),
        Command::Life(arguments) => life::run(&arguments, format),
        #[cfg(feature = "case-study")]
        Command::CaseStudy(arguments) => case_study::run(&arguments, format),
        Command::Predict(arguments) => predict::run(&arguments, format),
        Command::Fit(arguments) => fit::run(&arguments, format),
        Command::New(arguments) => new::run(&arguments, format),
        Command::Schema => schema::run(),
        Command::Completions { shell } => packaging::completions(shell, format),
        Command::Man => packaging::manual(format),
    }
}

/// Whether JSON was asked for, on a command line that clap could not read.
fn wants_json(arguments: &[OsString]) -> bool {
    let is = |argument: &OsString, text: &str| argument.to_str() == Some(text);
    arguments.iter().any(|argument| is(argument, "--format=json"))
        || arguments.windows(2).any(|pair| is(&pair[0], "--format") && is(&pair[1], "json"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn definitions_are_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn every_subcommand_shows_an_example() {
        for command in Arguments::command().get_subcommands() {
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(help.contains(&format!("linkwear {}", command.get_name())), "{}", command.get_name());
        }
    }
}
