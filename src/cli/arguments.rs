//! What can be asked: the definitions that clap reads, one for each subcommand. Never knows who answers.

mod measured;

use std::num::NonZero;
use std::path::PathBuf;

use crate::import::LengthUnit;
use crate::life::Shard;
use clap::{Args, Parser, Subcommand, ValueEnum};
use linkwear_codegen::render::TextFormat;

use super::diff::DiffArguments;
use super::identify::IdentifyArguments;
use super::options::{
    EquationsChoice, Input, LivesArguments, MotionArguments, Replace, RevolutionArguments, rows_help,
};
use super::sensitivity::SensitivityArguments;
use super::shipped_schemas::SCHEMAS;
use super::starters::Starter;
use super::study::StudyArguments;
#[cfg(feature = "page")]
use super::value::positive;
use super::value::{density, one_of, output, threads};
pub use measured::{FitArguments, PlanArguments, PredictArguments};

const NOTATIONS: [(&str, TextFormat); 3] =
    [("text", TextFormat::Text), ("markdown", TextFormat::Markdown), ("latex", TextFormat::Latex)];

/// Compiles a linkage into its life: specialised dynamics from a TOML file.
#[derive(Debug, Parser)]
#[command(name = "linkwear", version, arg_required_else_help = true)]
pub struct Arguments {
    /// `json`: one JSON object on stdout, nothing else there.
    #[arg(long, global = true, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    #[command(subcommand)]
    pub command: Command,
}

/// For whom the answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    Text,
    Json,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Read a mechanism and say what it is: mobility, redundant rows, idle freedoms, warnings.
    #[command(after_help = "Example:\n  linkwear check mechanisms/rssr_rigid.toml")]
    Check(Input),
    /// Print the symbolic equations, with operation counts before and after sharing.
    #[command(after_help = "Example:\n  linkwear equations mechanisms/pendulum.toml --only mass --as latex")]
    Equations(EquationsArguments),
    /// Count the operations of every entry point, and measure what they cost here on every back end.
    #[command(after_help = "Example:\n  linkwear cost mechanisms/rssr_rigid.toml")]
    Cost(Input),
    /// Write the specialised source code.
    #[command(after_help = "Examples:\n  linkwear generate mechanisms/rssr_rigid.toml -o rssr.rs\n  \
                      linkwear generate mechanisms/rssr_rigid.toml -o rssr.rs --check\n  \
                      linkwear generate mechanisms/rssr_rigid.toml --target c -o rssr")]
    Generate(GenerateArguments),
    /// Write a unit of FMI 3.0, for co-simulation and model exchange in tools of other makers.
    #[cfg(feature = "fmu")]
    #[command(after_help = "Example:\n  linkwear fmu mechanisms/rssr.toml -o rssr.fmu")]
    Fmu(FmuArguments),
    /// Turn the mechanism and record what happens.
    #[command(
        after_help = "Example:\n  linkwear simulate mechanisms/rssr_rigid.toml --turns 2 --out rssr.csv"
    )]
    Simulate(SimulateArguments),
    /// Wear the joints with clearance, cycle by cycle, until the first has failed.
    #[command(
        after_help = "Example:\n  linkwear life mechanisms/rssr.toml --trajectories 1000 --seed 7 --out lives\n  \
                      linkwear life examples/data/four_bar_duty.toml --mission shift"
    )]
    Life(LifeArguments),
    /// Write a page to look at in a browser: the mechanism moving in 3-D, curves, its life, tables; one file, without a network. FILE may be
    /// the folder of `life --out DIR`, whose life it then shows without living it again.
    #[cfg(feature = "page")]
    #[command(
        after_help = "Examples:\n  linkwear report mechanisms/rssr.toml -o rssr.html\n\nOf a life that is lived already:\n  \
                      linkwear life mechanisms/rssr.toml --out life\n  linkwear report life -o rssr.html"
    )]
    Report(ReportArguments),
    /// As `report`, of the motion alone.
    #[cfg(feature = "page")]
    #[command(after_help = "Example:\n  linkwear view mechanisms/six_bar.toml --turns 1 -o six_bar.html")]
    View(ViewArguments),
    /// Draw the mechanism (SVG), as in a paper.
    #[cfg(feature = "page")]
    #[command(after_help = "Example:\n  linkwear draw mechanisms/rssr_rigid.toml -o rssr.svg")]
    Draw(DrawArguments),
    /// Put the shards of a life or of a study together: the same files as if it had been undivided.
    #[command(after_help = "Example:\n  linkwear life mechanisms/rssr.toml --shard 1/2 --out a\n  \
                      linkwear life mechanisms/rssr.toml --shard 2/2 --out b\n  linkwear merge a b --out life\n\n\
                      Parts of a study are files: linkwear merge part1 part2 --out table.csv")]
    Merge(MergeArguments),
    /// Run and live a mechanism at many points: grids, lists and quasi-random samples over its parameters.
    #[command(
        after_help = "Examples:\n  linkwear study mechanisms/rssr_rigid.toml --vary speed=1Hz..4Hz:4 --of peak.R1.drive,max_loop_error_m\n  \
                      linkwear study mechanisms/rssr.toml --rigid --vary c0=5um..20um --vary k_wear=1e-8,2e-8 \\\n    \
                      --sample sobol:16 --of life.mean,life.p10 --out lives.csv"
    )]
    Study(StudyArguments),
    /// Find parameters from what was measured of the machine: a curve, inspections; with their errors, and with what they cannot tell.
    #[command(
        after_help = "Examples:\n  linkwear identify press.toml --free damping=\"0.01..1 N m s/rad\" --measured torque.csv\n  \
                      linkwear identify mechanisms/rssr.toml --free k_wear=1e-9..1e-7 --inspections R1=log.csv \\\n    \
                      --revolutions revolutions --wear wear --gauge 1um"
    )]
    Identify(IdentifyArguments),
    /// Say how wear and life vary with parameters: derivatives by tangents through the motion, the wear law and the draws.
    #[command(
        after_help = "Examples:\n  linkwear sensitivity mechanisms/rssr.toml --by c0,k_wear,c_rocker,L1\n  \
                      linkwear sensitivity mechanisms/rssr.toml --trajectories 1000 --format json"
    )]
    Sensitivity(SensitivityArguments),
    /// The paper's case study is a program of its own; this says how to run it.
    #[command(hide = true, disable_help_flag = true)]
    CaseStudy {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Predict the remaining life from a fit, and from inspections of the joint.
    #[command(after_help = "Examples:\n  linkwear predict fit.json --threshold 10 --current 5\n  \
                      linkwear predict fit.json --threshold 10 --inspections log.csv --time hours --wear um\n  \
                      linkwear predict fit.json --threshold 10 --quantile 1% --mission 0..2 --from 2026-11-23 --per-day 0.016")]
    Predict(PredictArguments),
    /// Plan replacements: the age of least cost, looks and the wear to replace from, spares, what a look is worth.
    #[command(
        after_help = "Examples:\n  linkwear plan fit.json --threshold 10 --preventive 200 --failure 1500 --inspection 30\n  \
                      linkwear plan life --preventive 200 --failure 1500 --parts 12 --horizon 40"
    )]
    Plan(PlanArguments),
    /// Fit a process of wear (Gamma, Wiener, inverse Gaussian) to measured data by maximum likelihood.
    #[command(
        after_help = "Example:\n  linkwear fit examples/data/sliding_wear_100g.csv \\\n    --unit unit \
                      --wear wear_um --exposure cycles --from-zero --power-law"
    )]
    Fit(FitArguments),
    /// Write a commented starter file to edit.
    #[command(after_help = "Examples:\n  linkwear new four_bar && linkwear check four_bar.toml\n  \
                      linkwear new press --starter slider-crank && linkwear life press.toml")]
    New(NewArguments),
    /// Make a mechanism file of a robot (URDF, MJCF), or of a part (STL) at a density; what is not carried over is listed.
    #[command(
        after_help = "Examples:\n  linkwear import examples/data/arm.urdf --out arm.toml && linkwear check arm.toml\n  \
                      linkwear import examples/data/press/press.xml --out press.toml\n  \
                      linkwear import examples/data/press/lever.stl --density \"7850 kg/m^3\" --out lever.toml"
    )]
    Import(ImportArguments),
    /// Say what two results of one kind, or two mechanism files, have different, and by how much.
    #[command(
        after_help = "Examples:\n  linkwear diff coarse.csv fine.csv --tolerance 1e-3\n  linkwear diff before.json after.json\n  \
                      linkwear diff mechanisms/rssr.toml mechanisms/rssr_rigid.toml"
    )]
    Diff(DiffArguments),
    /// Say what a code of a message means, with an example and its cure.
    #[command(after_help = "Examples:\n  linkwear explain E0602\n  linkwear explain C0008")]
    Explain {
        /// The code, as it stands in brackets in the message.
        code: String,
    },
    /// Print the JSON Schema of mechanism files, for editors, or of an output.
    #[command(after_help = "Examples:\n  linkwear schema > linkwear.schema.json\n  linkwear schema life")]
    Schema {
        /// An output: the JSON of a subcommand, `errors`, `fit-file` (fit --out), `table` (FILE-metadata.json), `parquet` (metadata
        /// within).
        #[arg(value_parser = one_of(SCHEMAS))]
        output: Option<&'static str>,
    },
    /// Print a completion script for a shell.
    #[command(after_help = "Example:\n  linkwear completions bash > \
                      ~/.local/share/bash-completion/completions/linkwear")]
    Completions {
        /// Which shell.
        shell: clap_complete::Shell,
    },
    /// Print a manual page (troff), or write all of them.
    #[command(
        after_help = "Examples:\n  linkwear man simulate | man -l -\n  linkwear man --out ~/.local/share/man/man1"
    )]
    Man {
        /// The subcommand the page is of [default: all in a survey].
        subcommand: Option<String>,
        /// Folder for linkwear.1 and a page for each subcommand.
        #[arg(long, value_name = "DIR", conflicts_with = "subcommand", value_parser = output())]
        out: Option<PathBuf>,
    },
}

#[derive(Debug, Args)]
pub struct EquationsArguments {
    #[command(flatten)]
    pub input: Input,
    /// Only these outputs or functions, separated by commas.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub only: Vec<String>,
    /// Notation.
    #[arg(long = "as", value_parser = one_of(NOTATIONS), default_value = "text")]
    pub notation: TextFormat,
}

#[derive(Debug, Args)]
pub struct GenerateArguments {
    #[command(flatten)]
    pub input: Input,
    /// File of rust, stem of c (STEM.c, STEM.h), folder of c-abi; without it Rust goes to stdout.
    #[arg(short, long, value_name = "OUT", value_parser = output())]
    pub out: Option<PathBuf>,
    /// Write nothing; fail if a file is not what would be written.
    #[arg(long, requires = "out")]
    pub check: bool,
    /// rust: source for build scripts and checked-in code. c: C99 source and header, for controllers where no Rust goes. c-abi: a
    /// crate that makes a library with a header.
    #[arg(long, value_enum, default_value_t = Target::Rust, requires_ifs = [("c", "out"), ("c-abi", "out")])]
    pub target: Target,
    /// For rust: with a consistent start as a static, for programs without std. C has it always.
    #[arg(long)]
    pub with_start: bool,
    #[command(flatten)]
    pub replace: Replace,
}

#[cfg(feature = "fmu")]
#[derive(Debug, Args)]
pub struct FmuArguments {
    #[command(flatten)]
    pub input: Input,
    /// File to write.
    #[arg(short, long, value_name = "X.fmu", value_parser = output())]
    pub out: PathBuf,
    #[command(flatten)]
    pub replace: Replace,
}

#[derive(Debug, Args)]
pub struct SimulateArguments {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub motion: MotionArguments,
    #[arg(long, value_name = "FILE", help = rows_help())]
    pub out: Option<PathBuf>,
    /// Draw forces, drive, contacts, deflections and motion of the joints as charts (SVG; PNG by the feature `png`).
    #[cfg(feature = "page")]
    #[arg(long, value_name = "FILE.svg|png", value_parser = output())]
    pub plot: Option<PathBuf>,
    #[command(flatten)]
    pub equations: EquationsChoice,
    #[command(flatten)]
    pub replace: Replace,
}

#[derive(Debug, Args)]
pub struct LifeArguments {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub lives: LivesArguments,
    #[command(flatten)]
    pub revolutions: RevolutionArguments,
    /// Folder for life.json, cycles.csv, lives.csv and the journal that --resume goes on from; must be new or empty.
    #[arg(long, value_name = "DIR", value_parser = output())]
    pub out: Option<PathBuf>,
    /// Draw density, reliability, and wear and clearance by cycles with their spread as charts (SVG; PNG by the feature `png`).
    #[cfg(feature = "page")]
    #[arg(long, value_name = "FILE.svg|png", value_parser = output())]
    pub plot: Option<PathBuf>,
    /// Go on with the run that was interrupted in --out, to the same bits as if it had not been; with more
    /// --trajectories, extend it.
    #[arg(long, requires = "out")]
    pub resume: bool,
    /// Live the I-th of N nearly equal parts of the random lives, I from 1, on a machine of its own; `merge` puts the folders
    /// together.
    #[arg(long, value_name = "I/N", requires = "out", conflicts_with = "mean")]
    pub shard: Option<Shard>,
    /// Threads that share the random lives [default: one per core].
    #[arg(long, value_name = "T", value_parser = threads)]
    pub threads: Option<NonZero<usize>>,
    #[command(flatten)]
    pub equations: EquationsChoice,
    #[cfg(feature = "page")]
    #[command(flatten)]
    pub replace: Replace,
}

#[cfg(feature = "page")]
#[derive(Debug, Args)]
pub struct ReportArguments {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub lives: LivesArguments,
    #[command(flatten)]
    pub revolutions: RevolutionArguments,
    /// Threads that share the random lives [default: one per core].
    #[arg(long, value_name = "T", value_parser = threads)]
    pub threads: Option<NonZero<usize>>,
    /// Turns that the moving picture shows [default: 1].
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true)]
    pub turns: Option<f64>,
    #[command(flatten)]
    pub equations: EquationsChoice,
    /// File to write.
    #[arg(short, long, value_name = "PAGE.html", value_parser = output())]
    pub out: PathBuf,
    #[command(flatten)]
    pub replace: Replace,
}

#[cfg(feature = "page")]
#[derive(Debug, Args)]
pub struct ViewArguments {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub motion: MotionArguments,
    #[command(flatten)]
    pub equations: EquationsChoice,
    /// File to write.
    #[arg(short, long, value_name = "PAGE.html", value_parser = output())]
    pub out: PathBuf,
    #[command(flatten)]
    pub replace: Replace,
}

#[cfg(feature = "page")]
#[derive(Debug, Args)]
pub struct DrawArguments {
    #[command(flatten)]
    pub input: Input,
    /// Turns that are drawn behind [default: 1].
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true)]
    pub turns: Option<f64>,
    #[command(flatten)]
    pub equations: EquationsChoice,
    /// File to write.
    #[arg(short, long, value_name = "PICTURE.svg|png", value_parser = output())]
    pub out: PathBuf,
    #[command(flatten)]
    pub replace: Replace,
}

#[derive(Debug, Args)]
pub struct MergeArguments {
    /// Folders of `life --shard I/N --out DIR`, or files of `study --shard I/N --out FILE`, one for each shard, in any order; the
    /// same one may be given again.
    #[arg(required = true, value_name = "DIR|FILE")]
    pub shards: Vec<PathBuf>,
    /// Of a life: folder for life.json, cycles.csv and lives.csv; must be new or empty. Of a study: file for the table.
    #[arg(long, value_name = "DIR|FILE", value_parser = output())]
    pub out: PathBuf,
    #[command(flatten)]
    pub replace: Replace,
}

/// What `generate` writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Target {
    Rust,
    C,
    CAbi,
}

#[derive(Debug, Args)]
pub struct NewArguments {
    /// Name of the mechanism; the file is NAME.toml in the current folder.
    pub name: String,
    /// What to start from.
    #[arg(long, value_name = "KIND", value_enum, default_value_t = Starter::FourBar)]
    pub starter: Starter,
}

#[derive(Debug, Args)]
pub struct ImportArguments {
    /// Robot (URDF, or MJCF of MuJoCo; of a xacro file what `xacro` makes of it), or a part (STL).
    pub file: PathBuf,
    /// Where the mechanism file goes; one that is there may have been edited, and is not replaced.
    #[arg(short, long, value_name = "FILE.toml", value_parser = output())]
    pub out: PathBuf,
    /// Let the root link of a URDF file move freely, as that of a robot that walks or flies; without it is the ground.
    #[arg(long)]
    pub floating: bool,
    /// Density of a part, or of what a URDF file gives shapes and no mass: --density "7850 kg/m^3".
    #[arg(long, value_name = "QUANTITY", value_parser = density)]
    pub density: Option<f64>,
    /// Unit of the coordinates of a part.
    #[arg(long, value_name = "UNIT", value_parser = one_of(LengthUnit::ALL.map(|unit| (unit.name(), unit))), default_value = LengthUnit::default().name())]
    pub unit: LengthUnit,
    /// Let the robot name meshes and included files outside its folder.
    #[arg(long)]
    pub allow_outside_data: bool,
    #[command(flatten)]
    pub replace: Replace,
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
        for command in Arguments::command().get_subcommands().filter(|command| !command.is_hide_set()) {
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(help.contains(&format!("linkwear {}", command.get_name())), "{}", command.get_name());
        }
    }
}
