//! What can be asked of measurements of a machine: the definitions that clap reads. Never knows who answers.

use std::path::PathBuf;

use clap::Args;

#[cfg(feature = "page")]
use super::super::options::Replace;
use super::super::options::{EquationsChoice, Input, IntegratorName};
#[cfg(feature = "page")]
use super::super::value::output;
use super::super::value::{accuracy, assignment, from_zero, positive, sought};
use crate::study::Axis;

#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("measurements").required(true).multiple(true).args(["measured", "inspections"]))]
pub struct IdentifyArguments {
    #[command(flatten)]
    pub input: Input,
    /// A parameter that is sought, and its bounds; units as in the file. Repeatable. Between positive bounds it is sought by its
    /// logarithm.
    #[arg(long, value_name = "NAME=LO..HI", value_parser = sought, required = true)]
    pub free: Vec<Axis>,
    /// A measured curve: columns `t [s]` and others named as `simulate --out` names them, with their units: `R1.drive [N m]`.
    #[arg(long, value_name = "CURVE.csv")]
    pub measured: Option<PathBuf>,
    /// Columns of the curve that are compared, separated by commas [default: all but the time].
    #[arg(long, value_name = "LIST", value_delimiter = ',', requires = "measured")]
    pub of: Vec<String>,
    /// Standard deviation of the noise of a column, with its unit: --noise R1.drive="0.02 N m". Repeatable [default: estimated
    /// from the residuals].
    #[arg(long, value_name = "COL=S", value_parser = assignment, requires = "measured")]
    pub noise: Vec<(String, String)>,
    /// Turns that the machine had made before the time 0 of the curve.
    #[arg(long, value_name = "N", value_parser = from_zero, requires = "measured", allow_negative_numbers = true)]
    pub settle: Option<f64>,
    /// Inspections of a joint that began unworn: JOINT=FILE.csv. Repeatable.
    #[arg(long, value_name = "JOINT=CSV", value_parser = assignment, requires = "clock", requires = "wear")]
    pub inspections: Vec<(String, String)>,
    /// Column of the time of an inspection, with its unit in the header: `t [h]`.
    #[arg(long, value_name = "COL", group = "clock", requires = "inspections")]
    pub time: Option<String>,
    /// Column of the revolutions until an inspection.
    #[arg(long, value_name = "COL", group = "clock", requires = "inspections")]
    pub revolutions: Option<String>,
    /// Column of the wear, with its unit in the header: `wear [um]`.
    #[arg(long, value_name = "COL", requires = "inspections")]
    pub wear: Option<String>,
    /// Standard deviation of the gauge of the inspections, with its unit [default: estimated from the residuals].
    #[arg(long, value_name = "S", requires = "inspections")]
    pub gauge: Option<String>,
    /// Searches, each from another place within the bounds.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=1000), allow_negative_numbers = true)]
    pub starts: u32,
    /// Seed of the places that searches begin from.
    #[arg(long, value_name = "S", default_value_t = 1, allow_negative_numbers = true)]
    pub seed: u32,
    /// Intervals by standard errors, without the profile of the likelihood: wrong where it is no parabola, and faster.
    #[arg(long)]
    pub no_profile: bool,
    /// Method [default: dopri5, with clearance rk43; rk4 if --step is given].
    #[arg(long, value_enum)]
    pub integrator: Option<IntegratorName>,
    /// Step of rk4 and generalized-alpha [s].
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with = "tol", allow_negative_numbers = true)]
    pub step: Option<f64>,
    /// Accuracy of dopri5, relative to every value [default: 1e-9]; of rk43, of the wear integral [default: 1e-6].
    #[arg(long, value_name = "E", value_parser = accuracy, allow_negative_numbers = true)]
    pub tol: Option<f64>,
    /// Draw measured and predicted readings, and residuals (SVG; PNG by the feature `png`).
    #[cfg(feature = "page")]
    #[arg(long, value_name = "FILE.svg|png", value_parser = output())]
    pub plot: Option<PathBuf>,
    #[command(flatten)]
    pub equations: EquationsChoice,
    #[cfg(feature = "page")]
    #[command(flatten)]
    pub replace: Replace,
}
